// The web mirror, asked over real sockets as a browser asks.
#include "vhd_renderer/output/web_mirror.hpp"

#include <chrono>
#include <thread>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include "protocol/transport/address.hpp"
#include "protocol/transport/jpeg.hpp"

namespace counterpart {
namespace {

class Browser {
 public:
  explicit Browser(const WebMirror& mirror) : host_(mirror.address()) {
    socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
    const timeval limit{5, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    sockaddr_in where{};
    where.sin_family = AF_INET;
    where.sin_port = htons(parse_address(host_)->port);
    where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&where), sizeof where) == 0;
  }
  ~Browser() { ::close(socket_); }
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void say(const std::string& text) { static_cast<void>(::send(socket_, text.data(), text.size(), MSG_NOSIGNAL)); }

  void get(const std::string& target) { say("GET " + target + " HTTP/1.1\r\nHost: " + host_ + "\r\n\r\n"); }

  void post(const std::string& target, const std::string& body, const std::string& more = "") {
    say("POST " + target + " HTTP/1.1\r\nHost: " + host_ + "\r\nContent-Type: application/json\r\n" + more +
        "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
  }

  bool hear_more() {
    char buffer[65536];
    const ssize_t count = ::recv(socket_, buffer, sizeof buffer, 0);
    if (count > 0) heard_.append(buffer, static_cast<std::size_t>(count));
    return count > 0;
  }

  // Everything so far, once `text` is in it; what there is if it does not come within five seconds.
  std::string hear(const std::string& text) {
    while (heard_.find(text) == std::string::npos && hear_more()) {
    }
    return heard_;
  }

  // Everything, once so many boundaries are in it.
  std::string hear_parts(int parts) {
    std::size_t at = 0;
    for (int i = 0; i < parts; ++i) {
      while (heard_.find("--frame\r\n", at) == std::string::npos) {
        const std::size_t before = heard_.size();
        if (!hear_more() || heard_.size() == before) return heard_;
      }
      at = heard_.find("--frame\r\n", at) + 1;
    }
    return heard_;
  }

  // One whole answer with a Content-Length.
  std::string answer() {
    const std::string head = hear("\r\n\r\n");
    const std::size_t body = head.find("\r\n\r\n") + 4;
    const std::size_t at = head.find("Content-Length: ");
    const std::size_t size = at == std::string::npos ? 0 : std::stoul(head.substr(at + 16));
    while (heard_.size() < body + size && hear_more()) {
    }
    return std::exchange(heard_, "");
  }

  bool connected() const { return connected_; }

 private:
  std::string host_, heard_;
  int socket_ = -1;
  bool connected_ = false;
};

std::string body_of(const std::string& answer) {
  return answer.substr(answer.find("\r\n\r\n") + 4);
}

VideoFrame grey(int value) {
  VideoFrame picture;
  picture.width = 64;
  picture.height = 48;
  picture.stride = 192;
  picture.bytes.assign(192 * 48, static_cast<std::uint8_t>(value));
  return picture;
}

int value_of(const std::string& jpeg) {
  VideoFrame picture;
  picture.codec = PixelCodec::jpeg;
  picture.width = 64;
  picture.height = 48;
  picture.bytes.assign(jpeg.begin(), jpeg.end());
  const auto raw = convert(picture, PixelCodec::raw_bgr8);
  return raw ? raw->bytes[1000] : -1;
}

std::unique_ptr<WebMirror> open_mirror() {
  auto mirror = WebMirror::listen("127.0.0.1:0");
  return mirror ? std::move(*mirror) : nullptr;
}

TEST(WebMirror, ServesAPageThatNeedsNothingFromOutside) {
  const auto mirror = open_mirror();
  Browser browser(*mirror);
  browser.get("/");
  const std::string page = browser.answer();
  EXPECT_EQ(page.rfind("HTTP/1.1 200", 0), 0U);
  EXPECT_NE(page.find("text/html"), std::string::npos);
  EXPECT_NE(page.find("/stream.mjpg"), std::string::npos);
  for (const char* outside : {"src=\"http", "href=\"http", "url(http", "@import"}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
  browser.get("/nowhere");
  EXPECT_EQ(browser.answer().rfind("HTTP/1.1 404", 0), 0U);
  browser.say("DELETE / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(browser.answer().rfind("HTTP/1.1 405", 0), 0U);
}

TEST(WebMirror, TellsTheStateOnceAndWithEveryChange) {
  const auto mirror = open_mirror();
  BoardState board;
  board.squares = std::string(20, 'b') + std::string(10, 'e') + std::string(20, 'w');
  board.moves = {"32-28"};
  mirror->say(board);
  GameEvent event;
  event.kind = EventKind::illegal_move;
  event.code = "must_capture";
  mirror->event(event);
  Browser once(*mirror);
  once.get("/state.json");
  const auto state = nlohmann::json::parse(body_of(once.answer()));
  EXPECT_EQ(state["board"]["moves"][0], "32-28");
  EXPECT_EQ(state["events"][0]["code"], "must_capture");

  Browser always(*mirror);
  always.get("/events");
  EXPECT_NE(always.hear("must_capture").find("text/event-stream"), std::string::npos);
  mirror->subtitle("Your turn, I believe.");
  EXPECT_NE(always.hear("Your turn, I believe.").find("Your turn, I believe."), std::string::npos);
}

TEST(WebMirror, LetsBrowsersHearWhatIsSaid) {
  const auto mirror = open_mirror();
  Browser browser(*mirror);
  browser.get("/speech.wav");
  EXPECT_EQ(browser.answer().rfind("HTTP/1.1 404", 0), 0U);
  const auto sound = std::make_shared<const Sound>(Sound{22050, {5, -6, 7}});
  mirror->speech(sound);
  mirror->speech(sound);  // frame after frame the same
  browser.get("/state.json");
  EXPECT_EQ(nlohmann::json::parse(body_of(browser.answer()))["speech"], 1);
  browser.get("/speech.wav?1");
  const std::string wav = body_of(browser.answer());
  ASSERT_GE(wav.size(), 50U);
  EXPECT_EQ(wav.substr(0, 4), "RIFF");
  EXPECT_EQ(wav.substr(wav.size() - 6), std::string("\x05\0\xfa\xff\x07\0", 6));
  mirror->speech(nullptr);
  browser.get("/state.json");
  EXPECT_EQ(nlohmann::json::parse(body_of(browser.answer()))["speech"], 0);
}

TEST(WebMirror, StreamsTheNewestPicture) {
  const auto mirror = open_mirror();
  Browser early(*mirror);
  early.get("/frame.jpg");
  EXPECT_EQ(early.answer().rfind("HTTP/1.1 503", 0), 0U);
  mirror->show(grey(40));
  early.get("/frame.jpg");
  EXPECT_NEAR(value_of(body_of(early.answer())), 40, 3);

  Browser viewer(*mirror);
  viewer.get("/stream.mjpg");
  const std::string head = viewer.hear("multipart/x-mixed-replace; boundary=frame\r\n\r\n--frame\r\n");
  ASSERT_NE(head.find("--frame"), std::string::npos);
  for (int i = 0; i < 50 && !mirror->watched(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  mirror->show(grey(200));
  // The first picture, and the newest after it; each ends with a boundary.
  const std::string all = viewer.hear_parts(3);
  const std::size_t end = all.rfind("\r\n--frame"), start = all.rfind("\xFF\xD8", end);
  ASSERT_NE(start, std::string::npos);
  const int newest = value_of(all.substr(start, end - start));
  EXPECT_NEAR(newest, 200, 3);
}

TEST(WebMirror, PassesOnWhatPeopleAskFor) {
  const auto mirror = open_mirror();
  Browser browser(*mirror);
  browser.post("/control", R"({"kind":"corners","corners_px":[1,2,3,4,5,6,7,8.5]})");
  EXPECT_EQ(browser.answer().rfind("HTTP/1.1 202", 0), 0U);
  browser.post("/control", R"({"kind":"level","number":3})");
  browser.answer();
  const auto controls = mirror->take_controls();
  ASSERT_EQ(controls.size(), 2U);
  EXPECT_EQ(controls[0].kind, ControlKind::corners);
  EXPECT_EQ(controls[0].corners_px, (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8.5}));
  EXPECT_EQ(controls[1].number, 3);
  EXPECT_NE(controls[0].id, controls[1].id);
  EXPECT_TRUE(mirror->take_controls().empty());
}

TEST(WebMirror, RefusesWhatIsNotAControlAndWhatComesFromAnotherSite) {
  const auto mirror = open_mirror();
  for (const char* body : {"", "[]", "{", R"({"kind":"castle"})", R"({"kind":"corners","corners_px":[1]})"}) {
    Browser browser(*mirror);
    browser.post("/control", body);
    EXPECT_EQ(browser.answer().rfind("HTTP/1.1 400", 0), 0U) << body;
  }
  Browser foreign(*mirror);
  foreign.post("/control", R"({"kind":"resign"})", "Origin: http://elsewhere.example\r\n");
  EXPECT_EQ(foreign.answer().rfind("HTTP/1.1 403", 0), 0U);
  Browser form(*mirror);
  form.say(
      "POST /control HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/plain\r\nContent-Length: "
      "17\r\n\r\n{\"kind\":\"resign\"}");
  EXPECT_EQ(form.answer().rfind("HTTP/1.1 415", 0), 0U);
  Browser rebound(*mirror);
  rebound.say("GET /state.json HTTP/1.1\r\nHost: elsewhere.example\r\n\r\n");
  EXPECT_EQ(rebound.answer().rfind("HTTP/1.1 403", 0), 0U);
  Browser large(*mirror);
  large.say(
      "POST /control HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
      "99999999\r\n\r\n");
  EXPECT_EQ(large.answer().rfind("HTTP/1.1 413", 0), 0U);
  EXPECT_TRUE(mirror->take_controls().empty());
}

TEST(WebMirror, AViewerWhoNeverReadsHoldsNobodyUp) {
  const auto mirror = open_mirror();
  Browser sleeper(*mirror), second(*mirror);
  sleeper.get("/stream.mjpg");
  second.get("/events");
  for (int i = 0; i < 50 && !mirror->watched(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  ASSERT_TRUE(mirror->watched());
  for (int i = 0; i < 2000; ++i) {
    mirror->show(grey(i % 256));
    mirror->subtitle(std::to_string(i));
  }
  mirror->show(grey(123));
  Browser reader(*mirror);
  reader.get("/frame.jpg");
  EXPECT_NEAR(value_of(body_of(reader.answer())), 123, 3);
}

TEST(WebMirror, SaysThatAPortIsInUse) {
  const auto mirror = open_mirror();
  const auto second = WebMirror::listen(mirror->address());
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("in use"), std::string::npos);
  EXPECT_FALSE(WebMirror::listen("nonsense"));
}

}  // namespace
}  // namespace counterpart
