// The program vhp, run as its users run it.
#include <array>
#include <cstdio>
#include <fstream>
#include <future>
#include <memory>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include "protocol/transport/endpoint.hpp"
#include "tests/support/link_options.hpp"
#include "tests/support/program.hpp"

namespace counterpart {
namespace {

using testing_support::options_of;

constexpr std::int64_t kSecond = 1'000'000'000;

struct Ran {
  int code = -1;
  std::string out;  // stdout and stderr
};

Ran vhp(const std::string& arguments) {
  const std::string line = "timeout 20 " COUNTERPART_BIN_DIR "/vhp " + arguments + " 2>&1";
  Ran ran;
  FILE* pipe = popen(line.c_str(), "r");
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe))
    ran.out.append(buffer.data(), count);
  const int status = pclose(pipe);
  ran.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return ran;
}

// Answers every command the way a renderer does, until one was finished or failed.
std::vector<Command> answer_one(Endpoint& renderer, FeedbackState last) {
  for (int i = 0; i < 100; ++i) {
    for (const Inbound& inbound : renderer.receive(kSecond / 10)) {
      const auto* received = std::get_if<Received>(&inbound);
      const auto* command = received == nullptr ? nullptr : std::get_if<Command>(&received->message);
      if (command == nullptr) continue;
      for (const FeedbackState state : {FeedbackState::accepted, FeedbackState::started, last}) {
        Feedback feedback;
        feedback.command_id = command->id;
        feedback.state = state;
        feedback.code = state == FeedbackState::failed ? "unknown_piece" : "";
        renderer.send(received->peer, feedback);
      }
      return {*command};
    }
  }
  return {};
}

TEST(Vhp, WrongUsageIsExitCodeTwoWithASentence) {
  for (const char* arguments :
       {"", "fly", "send", "send say", "send grasp light_31 nowhere", "send express smile --weight 3",
        "monitor nonsense", "replay /etc/passwd --as tracker", "replay /nowhere --as tracker --listen a",
        "send control castle", "capture", "send control corners 1,2"}) {
    const Ran ran = vhp(arguments);
    EXPECT_EQ(ran.code, 2) << arguments << ": " << ran.out;
    EXPECT_GT(ran.out.size(), 10U) << arguments;
  }
  EXPECT_EQ(vhp("--help").code, 0);
  EXPECT_EQ(vhp("--version").out, "vhp " COUNTERPART_VERSION "\n");
}

// The words that bash offers after these.
std::string completed(const std::string& words) {
  const std::string line = "PATH=" COUNTERPART_BIN_DIR ":$PATH bash -c 'eval \"$(vhp completion)\"; COMP_WORDS=(" +
                           words + "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _vhp; echo \"${COMPREPLY[*]}\"'";
  std::string out;
  FILE* pipe = popen(line.c_str(), "r");
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) out.append(buffer.data(), count);
  pclose(pipe);
  return out;
}

TEST(Vhp, BashCompletesItsWords) {
  EXPECT_EQ(completed("vhp cap"), "capture\n");
  EXPECT_EQ(completed("vhp capture rec"), "recover\n");
  EXPECT_EQ(completed("vhp send grasp --st"), "--style\n");
  EXPECT_EQ(completed("vhp send control res"), "resign resume\n");
}

TEST(Vhp, NobodyThereIsExitCodeOneWithASentence) {
  for (const char* arguments : {"monitor 127.0.0.1:1", "send say hello --to 127.0.0.1:1", "capture info /nowhere.mcap",
                                "record 127.0.0.1:1 /nowhere/at/all.mcap"}) {
    const Ran ran = vhp(arguments);
    EXPECT_EQ(ran.code, 1) << arguments << ": " << ran.out;
    EXPECT_EQ(ran.out.rfind("vhp: ", 0), 0U) << ran.out;
  }
}

TEST(Vhp, SendWaitsForTheFinalAnswer) {
  auto renderer = listen_tcp("127.0.0.1:0", options_of(Role::renderer));
  ASSERT_TRUE(renderer);
  auto run =
      std::async([&] { return vhp("send grasp light_31 27 0.1,-0.2 --hand left --to " + (*renderer)->address()); });
  const auto commands = answer_one(**renderer, FeedbackState::finished);
  const Ran ran = run.get();
  EXPECT_EQ(ran.code, 0) << ran.out;
  EXPECT_NE(ran.out.find("finished"), std::string::npos);
  ASSERT_EQ(commands.size(), 1U);
  const auto grasp = std::get<Grasp>(commands[0].action);
  EXPECT_EQ(grasp.piece, "light_31");
  EXPECT_EQ(grasp.hand, Hand::left);
  ASSERT_EQ(grasp.path_B.size(), 2U);
  EXPECT_EQ(grasp.path_B[0], centre_of_square_B(27, BoardGeometry{}));
  EXPECT_EQ(grasp.path_B[1], (Point3{0.1, -0.2, 0}));

  auto failing = std::async([&] { return vhp("send --json say hello --to " + (*renderer)->address()); });
  answer_one(**renderer, FeedbackState::failed);
  const Ran failed = failing.get();
  EXPECT_EQ(failed.code, 1);
  const auto last = nlohmann::json::parse(failed.out.substr(failed.out.rfind('{')));
  EXPECT_EQ(last["code"], "unknown_piece");
}

TEST(Vhp, ControlsAreTakenAndMonitorCounts) {
  auto tracker = listen_tcp("127.0.0.1:0", options_of(Role::tracker));
  ASSERT_TRUE(tracker);
  const std::string address = (*tracker)->address();
  EXPECT_EQ(vhp("send control corners 1,2 3,4 5,6 7,8.5 --to " + address).code, 0);
  bool seen = false;
  for (const Inbound& inbound : (*tracker)->receive(kSecond)) {
    const auto* received = std::get_if<Received>(&inbound);
    const auto* control = received == nullptr ? nullptr : std::get_if<Control>(&received->message);
    seen |= control != nullptr && control->corners_px == std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8.5};
  }
  EXPECT_TRUE(seen);

  auto run = std::async([&] { return vhp("monitor --json --for 0.5 " + address); });
  for (int i = 0; i < 40 && run.wait_for(std::chrono::milliseconds(25)) != std::future_status::ready; ++i) {
    PoseEstimate pose;
    pose.stamp.frame_id = static_cast<FrameId>(i);
    (*tracker)->broadcast(pose);
  }
  const Ran ran = run.get();
  EXPECT_EQ(ran.code, 0) << ran.out;
  const auto summary = nlohmann::json::parse(ran.out);
  EXPECT_GE(summary["messages"]["pose"]["total"].get<int>(), 5);
}

// What a tracker said is played from a capture to a renderer that has never seen it.
TEST(Vhp, ReplaysATrackerFromACapture) {
  const testing_support::TemporaryFolder folder;
  const std::string file = folder.path("replay.mcap");
  std::vector<Command> sent;
  {
    auto tracker = listen_tcp("127.0.0.1:0", options_of(Role::tracker));
    auto record =
        std::async([&, address = (*tracker)->address()] { return vhp("record --for 1.5 " + address + " " + file); });
    for (int i = 0; i < 50 && (*tracker)->stats().empty(); ++i) static_cast<void>((*tracker)->receive(kSecond / 10));
    for (std::uint64_t id = 1; id <= 20; ++id) {
      Command command;
      command.id = id;
      command.action = Say{"hello", "en", ""};
      (*tracker)->broadcast(command);
      sent.push_back(command);
    }
    EXPECT_EQ(record.get().code, 0);
  }
  const Ran info = vhp("capture info --json " + file);
  EXPECT_EQ(info.code, 0) << info.out;
  EXPECT_EQ(nlohmann::json::parse(info.out)["types"]["in/command"], 20);
  EXPECT_EQ(vhp("capture cat --type command --limit 3 " + file).out.substr(0, 1), "{");

  auto probe = listen_tcp("127.0.0.1:0", options_of(Role::tracker));
  const std::string address = (*probe)->address();
  probe->reset();
  auto replay = std::async([&] { return vhp("replay " + file + " --as tracker --speed 0 --listen " + address); });
  auto renderer = connect_tcp(address, options_of(Role::renderer), 5 * kSecond);
  ASSERT_TRUE(renderer) << renderer.error().message;
  std::vector<Command> got;
  while (replay.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) {
    for (const Inbound& inbound : (*renderer)->receive(kSecond / 50)) {
      const auto* received = std::get_if<Received>(&inbound);
      if (received == nullptr) continue;
      if (const auto* command = std::get_if<Command>(&received->message)) got.push_back(*command);
    }
  }
  EXPECT_EQ(replay.get().code, 0);
  EXPECT_EQ(got, sent);

  std::ofstream(file, std::ios::app | std::ios::binary).close();
  const std::string cut = file + ".cut";
  std::ifstream whole(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(whole)), {});
  std::ofstream(cut, std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  const Ran damaged = vhp("capture info " + cut);
  EXPECT_EQ(damaged.code, 1);
  EXPECT_NE(damaged.out.find("vhp: "), std::string::npos);
}

}  // namespace
}  // namespace counterpart
