#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include <boost/asio.hpp>

#include "protocol/capture/recorder.hpp"
#include "protocol/session/hub.hpp"
#include "protocol/transport/address.hpp"
#include "protocol/transport/endpoint.hpp"
#include "protocol/transport/monotonic_clock.hpp"
#include "protocol/transport/outgoing.hpp"

namespace counterpart {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr auto kDialLimit = std::chrono::seconds(3);
constexpr auto kGoodbyeLimit = std::chrono::milliseconds(300);
constexpr std::size_t kMostAtOnce = 32;  // messages in one write; two buffers each, and sendmsg takes 64
constexpr std::size_t kMostBytesAtOnce = 256U << 10;
constexpr int kMostReadsInARow = 64;

bool would_block(const error_code& error) {
  return error == asio::error::would_block || error == asio::error::try_again;
}

Error network_error(const error_code& error, const std::string& address) {
  if (error == asio::error::connection_refused) {
    return {ErrorCode::unavailable, "nothing listens at " + address +
                                        " (connection refused): start the other program first, or check the port"};
  }
  if (error == asio::error::eof || error == asio::error::connection_reset || error == asio::error::broken_pipe) {
    return {ErrorCode::closed, "the peer closed the connection"};
  }
  return {ErrorCode::io, address + ": " + error.message()};
}

struct Link {
  Link(tcp::socket s, ConnectionId i) : socket(std::move(s)), id(i) {}

  tcp::socket socket;
  ConnectionId id;
  std::vector<WireMessage> writing;  // the messages of the write in progress
  std::vector<asio::const_buffer> buffers;
  bool waiting_to_read = false;
  bool waiting_to_write = false;
  error_code broken;
};

// Sockets are touched only with the mutex held; handlers run on the endpoint's own thread.
class TcpEndpoint : public Endpoint {
 public:
  TcpEndpoint(Hub::End end, const LinkOptions& options, std::string token, std::unique_ptr<WireTap> recorder)
      : options_(options),
        recorder_(std::move(recorder)),
        hub_(end, options, std::move(token), recorder_.get()),
        acceptor_(io_),
        resolver_(io_),
        timer_(io_),
        work_(asio::make_work_guard(io_)) {}

  ~TcpEndpoint() override {
    {
      std::unique_lock lock(mutex_);
      leaving_ = true;
      error_code ignored;
      acceptor_.close(ignored);
      resolver_.cancel();
      hub_.leave(monotonic_ns());
      after_change();
      changed_.wait_for(lock, kGoodbyeLimit, [&] { return links_.empty(); });
    }
    io_.stop();
    if (thread_.joinable()) thread_.join();
  }

  TcpEndpoint(const TcpEndpoint&) = delete;
  TcpEndpoint& operator=(const TcpEndpoint&) = delete;

  Result<void> listen(const HostPort& address, bool has_token) {
    error_code error;
    const auto found = resolver_.resolve(address.host, std::to_string(address.port), error);
    if (error || found.empty()) {
      return failure(ErrorCode::not_found, "the host \"" + address.host + "\" is not known: " + error.message());
    }
    const tcp::endpoint where = found.begin()->endpoint();
    if (!where.address().is_loopback() && !has_token) {
      return failure(ErrorCode::refused, to_text(address) +
                                             " can be reached from other hosts: give a token file (--token-file), or "
                                             "listen on 127.0.0.1");
    }
    acceptor_.open(where.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_.bind(where, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (error == asio::error::address_in_use) {
      return failure(ErrorCode::unavailable, to_text(address) +
                                                 " is in use: another program listens there; stop it or choose another "
                                                 "port with --listen");
    }
    if (error) return failure(ErrorCode::io, "cannot listen on " + to_text(address) + ": " + error.message());
    const tcp::endpoint bound = acceptor_.local_endpoint();
    address_ = {bound.address().to_string(), bound.port()};
    accept();
    return {};
  }

  void connect(const HostPort& address) { address_ = address; }

  void start() {
    {
      const std::lock_guard lock(mutex_);
      after_change();
    }
    thread_ = std::thread([this] { io_.run(); });
  }

  // Empty: a session was opened.
  std::optional<Error> wait_for_session(std::int64_t wait_ns) {
    std::unique_lock lock(mutex_);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::nanoseconds(wait_ns);
    const auto settled = [&] {
      const auto& refusal = hub_.last_refusal();
      const bool final_refusal =
          refusal && (refusal->code == ErrorCode::version_mismatch || refusal->code == ErrorCode::refused ||
                      refusal->code == ErrorCode::not_found);
      return final_refusal || !hub_.stats(monotonic_ns()).empty();
    };
    changed_.wait_until(lock, deadline, settled);
    if (!hub_.stats(monotonic_ns()).empty()) return std::nullopt;
    if (hub_.last_refusal()) return hub_.last_refusal();
    return Error{ErrorCode::timeout, to_text(address_) + " did not answer in time"};
  }

  void send(PeerId peer, const Message& message) override {
    auto outgoing = make_outgoing(message, options_.video_codec);
    const std::lock_guard lock(mutex_);
    if (!outgoing) return refuse(peer, outgoing.error());
    hub_.send(peer, *outgoing, monotonic_ns());
    after_change();
  }

  void broadcast(const Message& message) override {
    auto outgoing = make_outgoing(message, options_.video_codec);
    const std::lock_guard lock(mutex_);
    if (!outgoing) return refuse(0, outgoing.error());
    hub_.broadcast(*outgoing, monotonic_ns());
    after_change();
  }

  std::vector<Inbound> receive(std::int64_t timeout_ns) override {
    std::unique_lock lock(mutex_);
    if (timeout_ns > 0) {
      changed_.wait_for(lock, std::chrono::nanoseconds(timeout_ns), [&] { return hub_.has_inbound(); });
    }
    auto taken = hub_.take_inbound();
    if (!taken.empty()) wait_for_all();
    return taken;
  }

  std::vector<PeerStats> stats() const override {
    const std::lock_guard lock(mutex_);
    return hub_.stats(monotonic_ns());
  }

  std::string address() const override { return to_text(address_); }

 private:
  void refuse(PeerId peer, const Error& error) {
    hub_.report(peer, error, monotonic_ns());
    changed_.notify_all();
  }

  // --- everything below is called with the mutex held ---

  void accept() {
    acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
      const std::lock_guard lock(mutex_);
      if (leaving_ || error == asio::error::operation_aborted) return;
      if (!error) welcome(std::move(socket));
      if (error) return pause_accepting();  // out of descriptors, most likely: do not spin
      accept();
    });
  }

  void pause_accepting() {
    auto pause = std::make_shared<asio::steady_timer>(io_, std::chrono::milliseconds(200));
    pause->async_wait([this, pause](const error_code&) {
      const std::lock_guard lock(mutex_);
      if (!leaving_) accept();
    });
  }

  void welcome(tcp::socket socket) {
    if (const auto id = hub_.accepted(monotonic_ns())) {
      add_link(std::move(socket), *id);
      return;
    }
    const WireMessage refusal = hub_.refusal(monotonic_ns());
    error_code ignored;
    socket.non_blocking(true, ignored);
    const std::array<asio::const_buffer, 2> buffers{asio::buffer(refusal.header), asio::buffer(*refusal.body)};
    socket.write_some(buffers, ignored);
  }

  void add_link(tcp::socket socket, ConnectionId id) {
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    socket.non_blocking(true, ignored);
    const auto link = std::make_shared<Link>(std::move(socket), id);
    links_[id] = link;
    after_change();
  }

  void dial(Hub::LaneName lane) {
    struct Attempt {
      explicit Attempt(asio::io_context& io) : socket(io), limit(io) {}
      tcp::socket socket;
      asio::steady_timer limit;
      bool done = false;
    };
    const auto attempt = std::make_shared<Attempt>(io_);
    const auto finish = [this, attempt, lane](const error_code& error) {
      if (attempt->done || leaving_) return;
      attempt->done = true;
      attempt->limit.cancel();
      if (error) {
        hub_.dial_failed(lane, network_error(error, to_text(address_)), monotonic_ns());
      } else {
        add_link(std::move(attempt->socket), hub_.dialled(lane, monotonic_ns()));
      }
      after_change();
    };
    attempt->limit.expires_after(kDialLimit);
    attempt->limit.async_wait([this, attempt, finish](const error_code& cancelled) {
      if (cancelled) return;
      const std::lock_guard lock(mutex_);
      finish(asio::error::timed_out);
      error_code ignored;
      attempt->socket.close(ignored);
    });
    resolver_.async_resolve(address_.host, std::to_string(address_.port),
                            [this, attempt, finish](const error_code& error, const tcp::resolver::results_type& found) {
                              const std::lock_guard lock(mutex_);
                              if (error || attempt->done)
                                return finish(error ? error : error_code(asio::error::timed_out));
                              asio::async_connect(attempt->socket, found,
                                                  [this, finish](const error_code& failed, const tcp::endpoint&) {
                                                    const std::lock_guard inner(mutex_);
                                                    finish(failed);
                                                  });
                            });
  }

  // Whatever happened: write what can be written, read what may be read, close what is over, set the alarm clock.
  void after_change() {
    if (!leaving_) {
      while (const auto lane = hub_.wants_to_dial(monotonic_ns())) dial(*lane);
    }
    for (const auto& link : std::vector<std::shared_ptr<Link>>(all_links())) {
      flush(link);
      wait_to_read(link);
      reap(link);
    }
    set_alarm();
    if (hub_.has_inbound() || links_.empty()) changed_.notify_all();
  }

  std::vector<std::shared_ptr<Link>> all_links() const {
    std::vector<std::shared_ptr<Link>> all;
    for (const auto& [id, link] : links_) all.push_back(link);
    return all;
  }

  void wait_for_all() {
    for (const auto& [id, link] : links_) wait_to_read(link);
  }

  void set_alarm() {
    const std::int64_t next = hub_.next_tick(monotonic_ns());
    if (alarm_set_ && alarm_ns_ <= next) return;
    alarm_set_ = true;
    alarm_ns_ = next;
    timer_.expires_at(std::chrono::steady_clock::time_point(std::chrono::nanoseconds(next)));
    timer_.async_wait([this](const error_code& cancelled) {
      if (cancelled) return;
      const std::lock_guard lock(mutex_);
      alarm_set_ = false;
      hub_.tick(monotonic_ns());
      if (recorder_ != nullptr) {
        if (const auto error = recorder_->take_error()) hub_.report(0, *error, monotonic_ns());
      }
      after_change();
    });
  }

  void wait_to_read(const std::shared_ptr<Link>& link) {
    if (link->waiting_to_read || link->broken || !hub_.wants_read(link->id)) return;
    link->waiting_to_read = true;
    link->socket.async_wait(tcp::socket::wait_read, [this, link](const error_code& error) {
      const std::lock_guard lock(mutex_);
      link->waiting_to_read = false;
      if (error) {
        break_link(link, error);
      } else {
        read(link);
      }
      after_change();
    });
  }

  void read(const std::shared_ptr<Link>& link) {
    for (int i = 0; i < kMostReadsInARow && hub_.wants_read(link->id); ++i) {
      const auto room = hub_.parser(link->id).room();
      error_code error;
      const std::size_t count = link->socket.read_some(asio::buffer(room.data(), room.size()), error);
      if (count > 0) hub_.read(link->id, count, monotonic_ns());
      if (would_block(error)) return;
      if (error) return break_link(link, error);
      if (count < room.size()) return;  // the socket is empty
    }
  }

  void flush(const std::shared_ptr<Link>& link) {
    while (!link->waiting_to_write && !link->broken) {
      if (link->buffers.empty() && !gather(*link)) return;
      error_code error;
      const std::size_t count = link->socket.write_some(link->buffers, error);
      if (error && !would_block(error)) return break_link(link, error);
      consume(*link, count);
      if (!link->buffers.empty()) wait_to_write(link);
    }
  }

  bool gather(Link& link) {
    link.writing.clear();
    std::size_t bytes = 0;
    while (link.writing.size() < kMostAtOnce && bytes < kMostBytesAtOnce) {
      auto message = hub_.next_to_write(link.id, monotonic_ns());
      if (!message) break;
      bytes += kHeaderSize + message->body->size();
      link.writing.push_back(std::move(*message));
    }
    for (const WireMessage& message : link.writing) {
      link.buffers.push_back(asio::buffer(message.header));
      if (!message.body->empty()) link.buffers.push_back(asio::buffer(*message.body));
    }
    return !link.buffers.empty();
  }

  static void consume(Link& link, std::size_t count) {
    std::size_t whole = 0;
    while (whole < link.buffers.size() && count >= link.buffers[whole].size()) count -= link.buffers[whole++].size();
    link.buffers.erase(link.buffers.begin(), link.buffers.begin() + static_cast<std::ptrdiff_t>(whole));
    if (count > 0) link.buffers.front() += count;
  }

  void wait_to_write(const std::shared_ptr<Link>& link) {
    link->waiting_to_write = true;
    link->socket.async_wait(tcp::socket::wait_write, [this, link](const error_code& error) {
      const std::lock_guard lock(mutex_);
      link->waiting_to_write = false;
      if (error) break_link(link, error);
      after_change();
    });
  }

  void break_link(const std::shared_ptr<Link>& link, const error_code& error) {
    if (!link->broken) link->broken = error;
  }

  // Closes a link that is broken or has said all, and forgets it once no handler holds it any more.
  void reap(const std::shared_ptr<Link>& link) {
    const bool flushed = link->buffers.empty() && !link->waiting_to_write;
    const bool over = link->broken || (hub_.finished(link->id) && flushed) || hub_.overdue(link->id, monotonic_ns());
    if (!over) return;
    if (!link->broken) link->broken = asio::error::eof;
    error_code ignored;
    if (link->socket.is_open()) {
      link->socket.shutdown(tcp::socket::shutdown_both, ignored);
      link->socket.close(ignored);
    }
    if (link->waiting_to_read || link->waiting_to_write) return;
    hub_.closed(link->id, network_error(link->broken, to_text(address_)), monotonic_ns());
    links_.erase(link->id);
  }

  LinkOptions options_;
  std::unique_ptr<WireTap> recorder_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Hub hub_;
  HostPort address_;
  bool leaving_ = false;
  bool alarm_set_ = false;
  std::int64_t alarm_ns_ = 0;
  asio::io_context io_;
  tcp::acceptor acceptor_;
  tcp::resolver resolver_;
  asio::steady_timer timer_;
  asio::executor_work_guard<asio::io_context::executor_type> work_;
  std::map<ConnectionId, std::shared_ptr<Link>> links_;
  std::thread thread_;
};

struct Prepared {
  HostPort address;
  std::string token;
  std::unique_ptr<WireTap> recorder;
};

Result<Prepared> prepare(const std::string& address, const LinkOptions& options) {
  auto host_port = parse_address(address);
  if (!host_port) return tl::make_unexpected(host_port.error());
  Prepared prepared{*host_port, "", nullptr};
  if (!options.token_file.empty()) {
    auto token = read_token(options.token_file);
    if (!token) return tl::make_unexpected(token.error());
    prepared.token = *token;
  }
  if (!options.record_file.empty()) {
    auto recorder = Recorder::open(options.record_file, options.role, options.software);
    if (!recorder) return tl::make_unexpected(recorder.error());
    prepared.recorder = std::move(*recorder);
  }
  return prepared;
}

}  // namespace

Result<std::unique_ptr<Endpoint>> listen_tcp(const std::string& address, const LinkOptions& options) {
  auto prepared = prepare(address, options);
  if (!prepared) return tl::make_unexpected(prepared.error());
  const bool has_token = !prepared->token.empty();
  auto endpoint = std::make_unique<TcpEndpoint>(Hub::End::server, options, std::move(prepared->token),
                                                std::move(prepared->recorder));
  if (auto listening = endpoint->listen(prepared->address, has_token); !listening) {
    return tl::make_unexpected(listening.error());
  }
  endpoint->start();
  return endpoint;
}

Result<std::unique_ptr<Endpoint>> connect_tcp(const std::string& address, const LinkOptions& options,
                                              std::int64_t wait_ns) {
  auto prepared = prepare(address, options);
  if (!prepared) return tl::make_unexpected(prepared.error());
  auto endpoint = std::make_unique<TcpEndpoint>(Hub::End::client, options, std::move(prepared->token),
                                                std::move(prepared->recorder));
  endpoint->connect(prepared->address);
  endpoint->start();
  if (wait_ns > 0) {
    if (auto error = endpoint->wait_for_session(wait_ns)) return tl::make_unexpected(*error);
  }
  return endpoint;
}

}  // namespace counterpart
