#include "vhd_renderer/output/web_mirror.hpp"

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include "protocol/transport/address.hpp"
#include "protocol/transport/jpeg.hpp"
#include "vhd_renderer/output/mirror_page.hpp"
#include "vhd_renderer/output/mirror_state.hpp"
#include "vhd_renderer/voice/wav.hpp"

namespace counterpart {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using boost::system::error_code;

constexpr auto kRequestLimit = std::chrono::seconds(15);  // for a whole request, and between two
constexpr auto kWriteLimit = std::chrono::seconds(10);    // a client that takes nothing for so long is gone
constexpr std::size_t kMostClients = 64;
constexpr std::size_t kMostControls = 256;
constexpr std::uint64_t kMostBody = 16U << 10;
constexpr std::uint32_t kMostHeader = 8U << 10;

constexpr std::string_view kAfterPicture = "\r\n--frame\r\n";

using Jpeg = std::shared_ptr<const std::vector<std::uint8_t>>;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;

std::string without_port(std::string_view host) {
  const std::size_t bracket = host.rfind(']');
  const std::size_t colon = host.rfind(':');
  if (colon == std::string_view::npos || (bracket != std::string_view::npos && colon < bracket))
    return std::string(host);
  return std::string(host.substr(0, colon));
}

}  // namespace

class WebMirror::Server {
 public:
  Server() : acceptor_(io_) {}

  ~Server() {
    // Closing everything ends everything that waits, and with it the thread.
    asio::post(io_, [this] {
      error_code ignored;
      acceptor_.close(ignored);
      pause_.cancel();
      for (Client* client : clients_) client->close();
    });
    if (thread_.joinable()) thread_.join();
  }

  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  Result<void> listen(const HostPort& address) {
    error_code error;
    tcp::resolver resolver(io_);
    const auto found = resolver.resolve(address.host, std::to_string(address.port), error);
    if (error || found.empty()) {
      return failure(ErrorCode::not_found, "the host \"" + address.host + "\" is not known: " + error.message());
    }
    const tcp::endpoint where = found.begin()->endpoint();
    loopback_only_ = where.address().is_loopback();
    acceptor_.open(where.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_.bind(where, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (error == asio::error::address_in_use) {
      return failure(ErrorCode::unavailable,
                     to_text(address) + " is in use: another program listens there; choose another port with --web");
    }
    if (error) {
      return failure(ErrorCode::io, "the mirror cannot listen on " + to_text(address) + ": " + error.message());
    }
    address_ = to_text({acceptor_.local_endpoint().address().to_string(), acceptor_.local_endpoint().port()});
    accept();
    thread_ = std::thread([this] { io_.run(); });
    return {};
  }

  void show(VideoFrame picture) {
    {
      const std::lock_guard lock(mutex_);
      state_.set_picture_size(picture.width, picture.height);
      picture_ = std::move(picture);
      ++picture_number_;
    }
    if (watchers_ > 0) wake();
  }

  template <class Change>
  void change(Change&& what) {
    {
      const std::lock_guard lock(mutex_);
      what(state_);
    }
    wake();
  }

  void hear(const std::shared_ptr<const Sound>& sound) {
    {
      const std::lock_guard lock(mutex_);
      if (sound == heard_now_) return;
      heard_now_ = sound;
      if (sound != nullptr) {
        heard_last_ = sound;
        ++speeches_;
      }
      state_.set_speech(sound != nullptr ? speeches_ : 0);
    }
    wake();
  }

  std::vector<Control> take_controls() {
    const std::lock_guard lock(mutex_);
    return std::exchange(controls_, {});
  }

  bool watched() const { return watchers_ > 0; }
  const std::string& address() const { return address_; }

 private:
  // One browser's connection: a request and its answer, again and again, or a stream without end.
  class Client : public std::enable_shared_from_this<Client> {
   public:
    Client(tcp::socket socket, Server& server) : stream_(std::move(socket)), server_(server) {
      server_.clients_.insert(this);
    }
    ~Client() {
      if (kind_ == Kind::pictures) --server_.watchers_;
      server_.clients_.erase(this);
    }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    void read() {
      parser_.emplace();
      parser_->body_limit(kMostBody);
      parser_->header_limit(kMostHeader);
      stream_.expires_after(kRequestLimit);
      http::async_read(stream_, buffer_, *parser_,
                       [self = shared_from_this()](const error_code& error, std::size_t) { self->answer(error); });
    }

    // Something is new: streams that are not still writing the last thing write the newest.
    void wake() {
      if (busy_ || kind_ == Kind::requests) return;
      if (kind_ == Kind::pictures) {
        send_picture();
      } else {
        send_state();
      }
    }

    void close() { stream_.close(); }

   private:
    enum class Kind { requests, pictures, states };

    void answer(const error_code& error) {
      if (error == http::error::body_limit || error == http::error::header_limit) {
        return reply(http::status::payload_too_large, "text/plain", "too large\n");
      }
      if (error) return;
      const Request request = parser_->release();
      keep_alive_ = request.keep_alive();
      const std::string target(request.target().substr(0, request.target().find('?')));
      if (!server_.is_for_us(request)) return reply(http::status::forbidden, "text/plain", "not from there\n");
      if (target == "/control") {
        if (request.method() != http::verb::post) return wrong_method("POST");
        return control(request);
      }
      if (request.method() != http::verb::get && request.method() != http::verb::head) return wrong_method("GET, HEAD");
      head_only_ = request.method() == http::verb::head;
      if (target == "/") return reply(http::status::ok, "text/html; charset=utf-8", std::string(kMirrorPage));
      if (target == "/state.json") return reply(http::status::ok, "application/json", server_.state().second);
      if (target == "/healthz") return reply(http::status::ok, "text/plain", "fine\n");
      if (target == "/frame.jpg") return frame();
      if (target == "/speech.wav") return speech();
      if (target == "/stream.mjpg" && !head_only_)
        return stream(Kind::pictures, "multipart/x-mixed-replace; boundary=frame");
      if (target == "/events" && !head_only_) return stream(Kind::states, "text/event-stream");
      reply(http::status::not_found, "text/plain", "there is nothing here; the mirror is at /\n");
    }

    void frame() {
      const auto [number, jpeg] = server_.jpeg();
      if (jpeg == nullptr) return reply(http::status::service_unavailable, "text/plain", "no picture yet\n");
      reply(http::status::ok, "image/jpeg", std::string(jpeg->begin(), jpeg->end()));
    }

    void speech() {
      const auto sound = server_.speech();
      if (sound == nullptr) return reply(http::status::not_found, "text/plain", "nothing was said yet\n");
      reply(http::status::ok, "audio/wav", encode_wav(*sound));
    }

    void control(const Request& request) {
      const auto type = request[http::field::content_type];
      if (!type.starts_with("application/json")) {
        return reply(http::status::unsupported_media_type, "text/plain", "send application/json\n");
      }
      if (const auto error = server_.take(request.body())) {
        return reply(http::status::bad_request, "text/plain", error->message + "\n");
      }
      reply(http::status::accepted, "application/json", "{}\n");
    }

    void wrong_method(const char* allowed) {
      reply(http::status::method_not_allowed, "text/plain", std::string("use ") + allowed + "\n");
    }

    void reply(http::status status, const char* type, std::string body) {
      const auto response = std::make_shared<Response>(status, 11);
      response->set(http::field::server, "counterpart");
      response->set(http::field::content_type, type);
      response->set(http::field::cache_control, "no-store");
      response->set("X-Content-Type-Options", "nosniff");
      response->set("X-Frame-Options", "DENY");
      response->set("Content-Security-Policy",
                    "default-src 'self'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src 'self' data:");
      response->keep_alive(keep_alive_);
      const std::size_t size = body.size();
      if (!head_only_) response->body() = std::move(body);
      response->content_length(size);
      stream_.expires_after(kWriteLimit);
      const auto done = [self = shared_from_this(), response](const error_code& error, std::size_t) {
        if (error || !response->keep_alive()) return self->shut();
        self->head_only_ = false;
        self->read();
      };
      if (!head_only_) {
        http::async_write(stream_, *response, done);
        return;
      }
      const auto serializer = std::make_shared<http::response_serializer<http::string_body>>(*response);
      http::async_write_header(
          stream_, *serializer,
          [done, serializer](const error_code& error, std::size_t size_written) { done(error, size_written); });
    }

    void shut() {
      error_code ignored;
      stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    }

    void stream(Kind kind, const char* type) {
      kind_ = kind;
      if (kind == Kind::pictures) ++server_.watchers_;
      write(std::string("HTTP/1.1 200 OK\r\nServer: counterpart\r\nCache-Control: no-store\r\nConnection: close\r\n") +
            "Content-Type: " + type + "\r\n\r\n" + (kind == Kind::pictures ? "--frame\r\n" : ""));
    }

    void send_picture() {
      auto [number, jpeg] = server_.jpeg();
      if (jpeg == nullptr || number == shown_) return;
      shown_ = number;
      write("Content-Type: image/jpeg\r\nContent-Length: " + std::to_string(jpeg->size()) + "\r\n\r\n", jpeg);
    }

    void send_state() {
      auto [version, json] = server_.state();
      if (version == shown_) return;
      shown_ = version;
      write("id: " + std::to_string(version) + "\ndata: " + json + "\n\n");
    }

    void write(std::string text, Jpeg jpeg = nullptr) {
      busy_ = true;
      text_ = std::move(text);
      jpeg_ = std::move(jpeg);
      std::vector<asio::const_buffer> buffers{asio::buffer(text_)};
      if (jpeg_ != nullptr) {
        buffers.push_back(asio::buffer(*jpeg_));
        buffers.push_back(asio::buffer(kAfterPicture));  // at once: browsers show a picture when the next one begins
      }
      stream_.expires_after(kWriteLimit);
      asio::async_write(stream_, buffers, [self = shared_from_this()](const error_code& error, std::size_t) {
        self->busy_ = false;
        if (error) return self->close();
        self->stream_.expires_never();
        self->watch_for_the_end();
        self->wake();
      });
    }

    // A stream says nothing back; when the browser leaves, the read ends and the client goes with it.
    void watch_for_the_end() {
      if (std::exchange(watching_, true)) return;
      stream_.socket().async_read_some(asio::buffer(scrap_),
                                       [self = shared_from_this()](const error_code& error, std::size_t) {
                                         self->watching_ = false;
                                         if (error) return self->close();
                                         self->watch_for_the_end();
                                       });
    }

    beast::tcp_stream stream_;
    Server& server_;
    beast::flat_buffer buffer_{64U << 10};
    std::optional<http::request_parser<http::string_body>> parser_;
    Kind kind_ = Kind::requests;
    bool keep_alive_ = false;
    bool head_only_ = false;
    bool busy_ = false;
    bool watching_ = false;
    std::uint64_t shown_ = 0;
    std::string text_;
    Jpeg jpeg_;
    std::array<char, 256> scrap_{};
  };

  void accept() {
    acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
      if (error == asio::error::operation_aborted || !acceptor_.is_open()) return;
      if (!error && clients_.size() < kMostClients) {
        error_code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        std::make_shared<Client>(std::move(socket), *this)->read();
      }
      if (!error) return accept();
      pause_.expires_after(std::chrono::milliseconds(200));  // out of descriptors, most likely: do not spin
      pause_.async_wait([this](const error_code& cancelled) {
        if (!cancelled) accept();
      });
    });
  }

  void wake() {
    if (wake_posted_.exchange(true)) return;
    asio::post(io_, [this] {
      wake_posted_ = false;
      std::vector<std::shared_ptr<Client>> all;
      for (Client* client : clients_) all.push_back(client->shared_from_this());
      for (const auto& client : all) client->wake();
    });
  }

  // A page of another site must not play here, nor a name that was pointed at this machine behind the user's back.
  bool is_for_us(const Request& request) const {
    const std::string host(request[http::field::host]);
    const std::string origin(request[http::field::origin]);
    if (!origin.empty() && origin != "http://" + host) return false;
    if (!loopback_only_) return true;
    const std::string name = without_port(host);
    return name == "localhost" || name == "127.0.0.1" || name == "[::1]" || name.empty();
  }

  std::pair<std::uint64_t, std::string> state() {
    const std::lock_guard lock(mutex_);
    return {state_.version(), state_.json()};
  }

  std::shared_ptr<const Sound> speech() {
    const std::lock_guard lock(mutex_);
    return heard_last_;
  }

  // The newest picture as JPEG, compressed once whoever asks.
  std::pair<std::uint64_t, Jpeg> jpeg() {
    std::uint64_t number = 0;
    std::optional<VideoFrame> raw;
    {
      const std::lock_guard lock(mutex_);
      if (jpeg_number_ == picture_number_ || !picture_) return {jpeg_number_, jpeg_};
      number = picture_number_;
      raw = *picture_;
    }
    const auto compressed = convert(*raw, PixelCodec::jpeg);
    const std::lock_guard lock(mutex_);
    if (!compressed) return {jpeg_number_, jpeg_};
    jpeg_number_ = number;
    jpeg_ = std::make_shared<const std::vector<std::uint8_t>>(compressed->bytes);
    return {jpeg_number_, jpeg_};
  }

  std::optional<Error> take(const std::string& text) {
    auto control = read_control(text);
    if (!control) return control.error();
    const std::lock_guard lock(mutex_);
    if (controls_.size() >= kMostControls) {
      return Error{ErrorCode::limit_exceeded, "too many requests wait already"};
    }
    if (control->id == 0) control->id = ++last_control_;
    controls_.push_back(*control);
    return std::nullopt;
  }

  asio::io_context io_;
  tcp::acceptor acceptor_;
  asio::steady_timer pause_{io_};
  std::string address_;
  bool loopback_only_ = true;
  std::set<Client*> clients_;  // of the server's thread alone
  std::atomic<int> watchers_{0};
  std::atomic<bool> wake_posted_{false};
  std::mutex mutex_;
  MirrorState state_;
  std::optional<VideoFrame> picture_;
  std::uint64_t picture_number_ = 0, jpeg_number_ = 0;
  Jpeg jpeg_;
  std::shared_ptr<const Sound> heard_now_, heard_last_;
  std::uint64_t speeches_ = 0;
  std::vector<Control> controls_;
  // Ids of controls are unique for their sender; this one starts afresh with every run.
  std::uint64_t last_control_ = static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
          .count());
  std::thread thread_;
};

WebMirror::WebMirror(std::unique_ptr<Server> server) : server_(std::move(server)) {}

WebMirror::~WebMirror() = default;

Result<std::unique_ptr<WebMirror>> WebMirror::listen(const std::string& address) {
  const auto host_port = parse_address(address);
  if (!host_port) return tl::make_unexpected(host_port.error());
  auto server = std::make_unique<Server>();
  if (auto listening = server->listen(*host_port); !listening) return tl::make_unexpected(listening.error());
  return std::unique_ptr<WebMirror>(new WebMirror(std::move(server)));
}

void WebMirror::show(VideoFrame picture) {
  server_->show(std::move(picture));
}

bool WebMirror::watched() const {
  return server_->watched();
}

void WebMirror::say(const BoardState& state) {
  server_->change([&](MirrorState& mirror) { mirror.set(state); });
}

void WebMirror::event(const GameEvent& event) {
  server_->change([&](MirrorState& mirror) { mirror.add(event); });
}

void WebMirror::feedback(const Feedback& feedback) {
  server_->change([&](MirrorState& mirror) { mirror.set(feedback); });
}

void WebMirror::subtitle(const std::string& text) {
  server_->change([&](MirrorState& mirror) { mirror.set_subtitle(text); });
}

void WebMirror::speech(const std::shared_ptr<const Sound>& sound) {
  server_->hear(sound);
}

void WebMirror::status(const MirrorStatus& status) {
  server_->change([&](MirrorState& mirror) { mirror.set(status); });
}

std::vector<Control> WebMirror::take_controls() {
  return server_->take_controls();
}

std::string WebMirror::address() const {
  return server_->address();
}

}  // namespace counterpart
