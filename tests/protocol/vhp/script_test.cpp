#include <cstdio>
#include <fstream>
#include <future>
#include <iterator>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "protocol/capture/wire_writer.hpp"
#include "protocol/codec/codec.hpp"
#include "protocol/transport/endpoint.hpp"
#include "tests/protocol/samples.hpp"
#include "tests/support/link_options.hpp"
#include "tests/support/program.hpp"

namespace counterpart {
namespace {

using testing_support::options_of;
using testing_support::Outcome;
using testing_support::run;
using testing_support::TemporaryFolder;

constexpr std::int64_t kSecond = 1'000'000'000;

std::string write_file(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
  return path;
}

// A renderer that carries out commands one after the other; a clip called "unknown" fails.
std::vector<Command> perform(Endpoint& renderer, const std::future<Outcome>& until) {
  std::vector<Command> seen;
  while (until.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) {
    for (const Inbound& inbound : renderer.receive(kSecond / 50)) {
      const auto* received = std::get_if<Received>(&inbound);
      const auto* command = received == nullptr ? nullptr : std::get_if<Command>(&received->message);
      if (command == nullptr) continue;
      seen.push_back(*command);
      const auto* keyframe = std::get_if<Keyframe>(&command->action);
      const bool bad = keyframe != nullptr && keyframe->clip == "unknown";
      Feedback feedback;
      feedback.command_id = command->id;
      feedback.state = bad ? FeedbackState::failed : FeedbackState::finished;
      feedback.code = bad ? "unknown_clip" : "";
      renderer.send(received->peer, feedback);
    }
  }
  return seen;
}

TEST(VhpScript, ChainsLoopsAndExpects) {
  TemporaryFolder folder;
  auto renderer = listen_tcp("127.0.0.1:0", options_of(Role::renderer));
  auto tracker = listen_tcp("127.0.0.1:0", options_of(Role::tracker));
  const std::string script = write_file(folder.path("s.vhp"), R"(# a comment
hello: say "Good evening, stranger"
take: after hello grasp light_31 27 0.1,0.2
repeat 3
  keyframe nod --speed 2
end
expect take finished within 5
lost: keyframe unknown
expect lost failed unknown_clip
control level 3
expect phase real_to_move within 5
expect event move move=32-28
print done
)");
  auto game = std::async([&] {
    for (int i = 0; i < 100; ++i) {
      for (const Inbound& inbound : (*tracker)->receive(kSecond / 20)) {
        const auto* received = std::get_if<Received>(&inbound);
        if (received == nullptr || !std::holds_alternative<Control>(received->message)) continue;
        BoardState board;
        board.squares = std::string(50, 'e');
        board.phase = GamePhase::real_to_move;
        (*tracker)->broadcast(board);
        GameEvent event;
        event.kind = EventKind::move;
        event.move = "32-28";
        (*tracker)->broadcast(event);
        return std::get<Control>(received->message).number;
      }
    }
    return 0;
  });
  auto outcome = std::async([&] {
    return run("vhp", {"script", script, "--renderer", (*renderer)->address(), "--tracker", (*tracker)->address()},
               std::chrono::seconds(30));
  });
  const auto seen = perform(**renderer, outcome);
  const Outcome done = outcome.get();
  EXPECT_EQ(done.exit_code, 0) << done.out << done.err;
  EXPECT_EQ(game.get(), 3);
  ASSERT_EQ(seen.size(), 6U);
  EXPECT_EQ(std::get<Say>(seen[0].action).text, "Good evening, stranger");
  EXPECT_EQ(seen[1].after, std::vector<std::uint64_t>{seen[0].id});
  EXPECT_EQ(std::get<Keyframe>(seen[4].action).speed, 2);
  EXPECT_NE(done.out.find("done"), std::string::npos);
}

TEST(VhpScript, AnExpectationThatIsNotMetSaysWhereAndIsExitCodeOne) {
  TemporaryFolder folder;
  auto renderer = listen_tcp("127.0.0.1:0", options_of(Role::renderer));
  const std::string script = write_file(folder.path("s.vhp"), "\nlost: keyframe unknown\nexpect lost finished\n");
  auto outcome = std::async([&] {
    return run("vhp", {"script", script, "--renderer", (*renderer)->address()}, std::chrono::seconds(20));
  });
  perform(**renderer, outcome);
  const Outcome done = outcome.get();
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_NE(done.err.find("s.vhp:3: expect lost finished: lost failed: unknown_clip"), std::string::npos) << done.err;
}

TEST(VhpScript, NamesTheLineThatCannotBeMeant) {
  TemporaryFolder folder;
  const std::vector<std::pair<std::string, std::string>> bad{
      {"say hi\nfly away\n", ":2: "},
      {"repeat 2\nsay hi\n", "has no \"end\""},
      {"end\n", ":1: "},
      {"wait nobody\n", "called nobody"},
      {"sleep long\n", ":1: "},
      {"expect phase lunch\n", "real_to_move"},
      {"x: after y say hi\n", "called y"},
      {"grasp light_31 99\n", "\"99\""},
      {"repeat 0\nend\n", "repeat N"},
      {"expect event move colour=red\n", "colour=red"},
  };
  for (const auto& [text, problem] : bad) {
    const Outcome done = run("vhp", {"script", "--check", write_file(folder.path("bad.vhp"), text)});
    EXPECT_EQ(done.exit_code, 2) << text;
    EXPECT_NE(done.err.find(problem), std::string::npos) << text << " -> " << done.err;
  }
}

// A capture of a small game, as a tracker recorded it.
std::string small_capture(const std::string& path, const std::string& last_move) {
  auto writer = McapWriter::create(path);
  std::uint64_t seq = 0;
  std::int64_t time_ns = 0;
  const auto add = [&](const Message& message) {
    const Bytes body = *encode(message);
    Header header;
    header.type = static_cast<std::uint16_t>(type_of(message));
    header.seq = is_kept(type_of(message)) ? ++seq : 0;
    Bytes record;
    append_wire_record(record, false, false, 1, seal(header, body), body);
    add_wire_record(**writer, record, time_ns += 1'000'000);
    EXPECT_TRUE((*writer)->write_chunk());
  };
  Intrinsics lens{1, 720, 576, 700, 700, 359.5, 287.5, {}};
  add(lens);
  PoseEstimate pose;
  pose.status = TrackStatus::ok;
  pose.intrinsics_id = 1;
  // The camera one metre above the board's centre, looking down, its top towards +y.
  pose.X_CB = {{0, 1, 0, 0}, {0, 0, 1}};
  add(pose);
  BoardState board;
  board.squares = std::string(20, 'b') + std::string(10, 'e') + std::string(20, 'w');
  add(board);
  board.moves = {"32-28", last_move};
  board.result = GameResult::draw;
  add(board);
  EXPECT_TRUE((*writer)->close());
  return path;
}

TEST(VhpExport, WritesGamesPosesAndTheCamera) {
  TemporaryFolder folder;
  const std::string file = small_capture(folder.path("a.mcap"), "19-23");
  const Outcome pdn = run("vhp", {"export", "pdn", file});
  EXPECT_EQ(pdn.exit_code, 0) << pdn.err;
  EXPECT_NE(pdn.out.find("[GameType \"20\"]"), std::string::npos);
  EXPECT_NE(pdn.out.find("1. 32-28 19-23 1-1"), std::string::npos);
  const Outcome csv = run("vhp", {"export", "csv", file, "--out", folder.path("poses.csv")});
  EXPECT_EQ(csv.exit_code, 0);
  std::ifstream lines(folder.path("poses.csv"));
  std::string head, line;
  std::getline(lines, head);
  std::getline(lines, line);
  EXPECT_EQ(line, "0,0,0,0,0,1,0,1,0,0,ok,0");
  const Outcome track = run("vhp", {"export", "opentrackio", file});
  const auto sample = nlohmann::json::parse(track.out);
  const auto& transform = sample["transforms"][0];
  EXPECT_NEAR(transform["translation"]["z"].get<double>(), 1, 1e-9);
  EXPECT_NEAR(transform["rotation"]["tilt"].get<double>(), -90, 1e-6);
}

TEST(VhpCapture, DoctorRecoverAndDiff) {
  TemporaryFolder folder;
  const std::string whole = small_capture(folder.path("a.mcap"), "19-23");
  const std::string other = small_capture(folder.path("b.mcap"), "19-24");
  EXPECT_EQ(run("vhp", {"capture", "doctor", whole}).exit_code, 0);
  EXPECT_EQ(run("vhp", {"capture", "diff", whole, whole}).exit_code, 0);
  const Outcome differ = run("vhp", {"capture", "diff", whole, other});
  EXPECT_EQ(differ.exit_code, 1);
  EXPECT_NE(differ.out.find("19-24"), std::string::npos);

  std::ifstream in(whole, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  const std::string cut = folder.path("cut.mcap"), saved = folder.path("saved.mcap");
  std::ofstream(cut, std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  EXPECT_EQ(run("vhp", {"capture", "doctor", cut}).exit_code, 1);
  const Outcome recovered = run("vhp", {"capture", "recover", cut, saved, "--json"});
  EXPECT_EQ(recovered.exit_code, 0) << recovered.err;
  const auto messages = nlohmann::json::parse(recovered.out)["messages"].get<int>();
  EXPECT_GE(messages, 1);
  const Outcome info = run("vhp", {"capture", "info", saved, "--json"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_EQ(nlohmann::json::parse(info.out)["messages"], messages);
}

// The client in docs/ was written from the page alone; it talks to the real thing.
void expect_python_to_be_answered(const LinkOptions& options, const std::string& words) {
  auto renderer = listen_tcp("127.0.0.1:0", options);
  ASSERT_TRUE(renderer) << renderer.error().message;
  auto outcome = std::async([&] {
    Outcome done;
    const std::string line = "timeout 20 python3 " COUNTERPART_SOURCE_DIR "/docs/counterpart_client.py " +
                             (*renderer)->address() + words +
                             R"( --send '{"id": 77, "verb": "keyframe", "clip": "nod"}')";
    FILE* pipe = popen(line.c_str(), "r");
    char buffer[4096];
    while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, pipe)) done.out.append(buffer, count);
    done.exit_code = pclose(pipe);
    return done;
  });
  const auto seen = perform(**renderer, outcome);
  const Outcome done = outcome.get();
  EXPECT_EQ(done.exit_code, 0) << done.out;
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].id, 77U);
  EXPECT_EQ(std::get<Keyframe>(seen[0].action).clip, "nod");
  EXPECT_NE(done.out.find("\"state\": \"finished\""), std::string::npos);
}

TEST(PythonClient, SendsACommandAndHearsTheAnswer) {
  expect_python_to_be_answered(options_of(Role::renderer), "");
}

TEST(PythonClient, SpeaksTlsWithWhatVhpCertificateMakes) {
  TemporaryFolder folder;
  const Outcome made = run("vhp", {"certificate", folder.path("tls"), "--host", "left", "--host", "right"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  LinkOptions options = options_of(Role::renderer);
  options.tls_file = folder.path("tls/left.pem");
  expect_python_to_be_answered(options, " --tls-file " + folder.path("tls/right.pem"));
}

TEST(VhpSend, SpeaksTls) {
  TemporaryFolder folder;
  ASSERT_EQ(run("vhp", {"certificate", folder.path("tls")}).exit_code, 0);
  LinkOptions options = options_of(Role::renderer);
  options.tls_file = folder.path("tls/renderer.pem");
  auto renderer = listen_tcp("127.0.0.1:0", options);
  ASSERT_TRUE(renderer) << renderer.error().message;
  auto outcome = std::async([&] {
    return run("vhp", {"send", "--to", (*renderer)->address(), "--tls-file", folder.path("tls/tracker.pem"), "keyframe",
                       "nod"});
  });
  EXPECT_EQ(perform(**renderer, outcome).size(), 1U);
  EXPECT_EQ(outcome.get().exit_code, 0);
  const Outcome plain = run("vhp", {"send", "--to", (*renderer)->address(), "keyframe", "nod"});
  EXPECT_EQ(plain.exit_code, 1);
  EXPECT_NE(plain.err.find("--tls-file"), std::string::npos) << plain.err;
}

}  // namespace
}  // namespace counterpart
