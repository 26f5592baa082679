#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include <boost/asio.hpp>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

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

constexpr auto kGoodbyeLimit = std::chrono::milliseconds(300);
constexpr std::size_t kMostAtOnce = 32;   // messages in one write
constexpr std::size_t kSmallBody = 1024;  // is cheaper to copy than to name
constexpr std::size_t kMostBytesAtOnce = 256U << 10;
constexpr int kMostReadsInARow = 64;
constexpr std::int64_t kLease = 2'000'000;
constexpr std::int64_t kLongestPatience = 1'000'000'000'000'000;  // eleven days; more would not fit

error_code last_error() {
  return {errno, boost::system::system_category()};
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

// Ends a poll from another thread.
class WakeUp {
 public:
  WakeUp() : file_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}
  ~WakeUp() { ::close(file_); }
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  int get() const { return file_; }
  void set() const { static_cast<void>(::eventfd_write(file_, 1)); }
  void clear() const {
    eventfd_t ignored = 0;
    static_cast<void>(::eventfd_read(file_, &ignored));
  }

 private:
  int file_;
};

// A connected socket. It is in Asio's event loop only while the endpoint's own thread has to wait for it: a socket that
// is in the loop wakes that thread with every message, whoever reads it.
struct Link {
  Link(asio::io_context& io, int connected, ConnectionId its_id) : socket(connected), id(its_id), watch(io) {}
  ~Link() {
    stop_watching();
    close();
  }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  void stop_watching() {
    if (watch.is_open()) watch.release();
    ++round;
    waiting_to_read = waiting_to_write = false;
  }

  void close() {
    if (socket < 0) return;
    ::shutdown(socket, SHUT_RDWR);
    ::close(std::exchange(socket, -1));
  }

  int socket;
  ConnectionId id;
  // The write in progress: headers and small bodies behind each other in `staging`, large bodies where they are.
  std::vector<WireMessage> writing;
  Bytes staging;
  std::vector<iovec> buffers;  // what is left to write
  bool blocked = false;        // the socket takes no more for now
  error_code broken;
  asio::posix::stream_descriptor watch;
  std::uint64_t round = 0;  // waits of an earlier round no longer count
  bool waiting_to_read = false;
  bool waiting_to_write = false;
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
        lease_timer_(io_),
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
    for (const auto& [id, link] : links_) link->stop_watching();
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
    const std::int64_t now_ns = monotonic_ns();
    hub_.send(peer, *outgoing, now_ns);
    after_send(now_ns);
  }

  void broadcast(const Message& message) override {
    auto outgoing = make_outgoing(message, options_.video_codec);
    const std::lock_guard lock(mutex_);
    if (!outgoing) return refuse(0, outgoing.error());
    const std::int64_t now_ns = monotonic_ns();
    hub_.broadcast(*outgoing, now_ns);
    after_send(now_ns);
  }

  // A program that waits here reads the sockets itself: a message then costs one wake-up less.
  std::vector<Inbound> receive(std::int64_t timeout_ns) override {
    std::unique_lock lock(mutex_);
    const std::int64_t deadline = monotonic_ns() + std::min(timeout_ns, kLongestPatience);
    while (!hub_.has_inbound()) {
      const std::int64_t left = deadline - monotonic_ns();
      if (left <= 0) break;
      read_in_place(lock, left);
    }
    auto taken = hub_.take_inbound();
    if (!leased()) wait_for_all();  // it may have been too full to read on
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
    after_change();
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
    links_[id] = std::make_shared<Link>(io_, socket.release(ignored), id);
    ++link_changes_;
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
    attempt->limit.expires_after(std::chrono::nanoseconds(hub_.dial_limit(monotonic_ns())));
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

  void after_send(std::int64_t now_ns) {
    bool over = hub_.has_inbound();
    for (const auto& [id, link] : links_) {
      flush(*link, now_ns);
      if (link->blocked) watch(link);
      over = over || link->broken || hub_.finished(id);
    }
    if (over) after_change();
  }

  // --- reading on the program's own thread ---
  //
  // While it lasts, and a moment longer, the endpoint's thread leaves reading alone; a program that does not come back
  // loses nothing but that moment.

  bool leased() const { return !leaving_ && (polling_ || monotonic_ns() < lease_ns_); }

  void read_in_place(std::unique_lock<std::mutex>& lock, std::int64_t timeout_ns) {
    polled_.assign(1, {wake_.get(), POLLIN, 0});
    polled_links_.assign(1, nullptr);
    for (const auto& [id, link] : links_) {
      link->stop_watching();
      const int wanted = (hub_.wants_read(id) ? POLLIN : 0) | (link->blocked ? POLLOUT : 0);
      if (link->broken || wanted == 0) continue;
      polled_.push_back({link->socket, static_cast<short>(wanted), 0});
      polled_links_.push_back(link);
    }
    polling_ = true;
    lock.unlock();
    const timespec limit{timeout_ns / 1'000'000'000, timeout_ns % 1'000'000'000};
    const int ready = ::ppoll(polled_.data(), polled_.size(), &limit, nullptr);
    lock.lock();
    polling_ = false;
    lease_ns_ = monotonic_ns() + kLease;
    end_lease_later();
    if (ready <= 0) return;
    if (polled_[0].revents != 0) wake_.clear();
    for (std::size_t i = 1; i < polled_.size(); ++i) {
      const std::shared_ptr<Link>& link = polled_links_[i];
      if ((polled_[i].revents & POLLOUT) != 0) link->blocked = false;
      if ((polled_[i].revents & ~POLLOUT) != 0 && links_.count(link->id) > 0 && !link->broken) read(*link);
    }
    after_change();
  }

  void end_lease_later() {
    if (lease_ending_) return;
    lease_ending_ = true;
    lease_timer_.expires_after(std::chrono::nanoseconds(kLease));
    lease_timer_.async_wait([this](const error_code& cancelled) {
      if (cancelled) return;
      const std::lock_guard lock(mutex_);
      lease_ending_ = false;
      if (polling_) return;
      if (leased()) return end_lease_later();
      wait_for_all();
    });
  }

  // Whatever happened: write what can be written, read what may be read, close what is over, set the alarm clock.
  void after_change() {
    if (!leaving_) {
      while (const auto lane = hub_.wants_to_dial(monotonic_ns())) dial(*lane);
    }
    const std::int64_t now_ns = monotonic_ns();
    std::vector<std::shared_ptr<Link>> over;
    for (const auto& [id, link] : links_) {
      flush(*link, now_ns);
      watch(link);
      if (is_over(*link, now_ns)) over.push_back(link);
    }
    for (const auto& link : over) reap(*link, now_ns);
    set_alarm(now_ns);
    if (hub_.has_inbound() || links_.empty()) changed_.notify_all();
    if (polling_ && (hub_.has_inbound() || link_changes_ != link_changes_seen_)) wake_.set();
    link_changes_seen_ = link_changes_;
  }

  void wait_for_all() {
    for (const auto& [id, link] : links_) watch(link);
  }

  void set_alarm(std::int64_t now_ns) {
    const std::int64_t next = hub_.next_tick(now_ns);
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

  // Has the endpoint's thread wait for what this link waits for, unless the program's thread does.
  void watch(const std::shared_ptr<Link>& link) {
    if (link->broken) return;
    if (polling_) {
      if (link->blocked) wake_.set();
      return;
    }
    if (link->blocked && !link->waiting_to_write) wait_to_write(link);
    if (!link->waiting_to_read && !leased() && hub_.wants_read(link->id)) wait_to_read(link);
  }

  void wait_to_read(const std::shared_ptr<Link>& link) {
    link->waiting_to_read = true;
    if (!link->watch.is_open()) link->watch.assign(link->socket);
    link->watch.async_wait(asio::posix::stream_descriptor::wait_read,
                           [this, link, round = link->round](const error_code& error) {
                             const std::lock_guard lock(mutex_);
                             if (error || round != link->round) return;
                             link->waiting_to_read = false;
                             if (!leased()) read(*link);
                             after_change();
                           });
  }

  void wait_to_write(const std::shared_ptr<Link>& link) {
    link->waiting_to_write = true;
    if (!link->watch.is_open()) link->watch.assign(link->socket);
    link->watch.async_wait(asio::posix::stream_descriptor::wait_write,
                           [this, link, round = link->round](const error_code& error) {
                             const std::lock_guard lock(mutex_);
                             if (error || round != link->round) return;
                             link->waiting_to_write = link->blocked = false;
                             after_change();
                           });
  }

  void read(Link& link) {
    for (int i = 0; i < kMostReadsInARow && !link.broken && hub_.wants_read(link.id); ++i) {
      const auto room = hub_.parser(link.id).room();
      const ssize_t count = ::recv(link.socket, room.data(), room.size(), MSG_DONTWAIT);
      if (count == 0) link.broken = asio::error::eof;
      if (count < 0 && errno != EAGAIN && errno != EINTR) link.broken = last_error();
      if (count <= 0) return;
      hub_.read(link.id, static_cast<std::size_t>(count), monotonic_ns());
      if (static_cast<std::size_t>(count) < room.size()) return;  // the socket is empty
    }
  }

  void flush(Link& link, std::int64_t now_ns) {
    while (!link.blocked && !link.broken) {
      if (link.buffers.empty() && !gather(link, now_ns)) return;
      const ssize_t count = write_some(link);
      if (count >= 0) {
        consume(link, static_cast<std::size_t>(count));
      } else if (errno == EAGAIN) {
        link.blocked = true;
      } else if (errno != EINTR) {
        link.broken = last_error();
      }
    }
  }

  static ssize_t write_some(Link& link) {
    constexpr int kFlags = MSG_DONTWAIT | MSG_NOSIGNAL;
    if (link.buffers.size() == 1) {
      return ::send(link.socket, link.buffers[0].iov_base, link.buffers[0].iov_len, kFlags);
    }
    msghdr message{};
    message.msg_iov = link.buffers.data();
    message.msg_iovlen = link.buffers.size();
    return ::sendmsg(link.socket, &message, kFlags);
  }

  bool gather(Link& link, std::int64_t now_ns) {
    link.writing.clear();
    link.staging.clear();
    link.staging.reserve(kMostAtOnce * (kHeaderSize + kSmallBody));  // so that it stays where it is
    std::size_t bytes = 0;
    for (std::size_t count = 0; count < kMostAtOnce && bytes < kMostBytesAtOnce; ++count) {
      auto message = hub_.next_to_write(link.id, now_ns);
      if (!message) break;
      bytes += kHeaderSize + message->body->size();
      stage(link, message->header);
      if (message->body->size() <= kSmallBody) {
        stage(link, *message->body);
      } else {
        // sendmsg only reads, but its type does not say so.
        link.buffers.push_back({const_cast<std::uint8_t*>(message->body->data()), message->body->size()});
        link.writing.push_back(std::move(*message));
      }
    }
    return !link.buffers.empty();
  }

  // Into the buffer before, if that is the end of what is staged.
  static void stage(Link& link, ByteView bytes) {
    std::uint8_t* const end = link.staging.data() + link.staging.size();
    link.staging.insert(link.staging.end(), bytes.begin(), bytes.end());
    const bool goes_on = !link.buffers.empty() &&
                         static_cast<std::uint8_t*>(link.buffers.back().iov_base) + link.buffers.back().iov_len == end;
    if (goes_on) {
      link.buffers.back().iov_len += bytes.size();
    } else {
      link.buffers.push_back({end, bytes.size()});
    }
  }

  static void consume(Link& link, std::size_t count) {
    std::size_t whole = 0;
    while (whole < link.buffers.size() && count >= link.buffers[whole].iov_len) count -= link.buffers[whole++].iov_len;
    link.buffers.erase(link.buffers.begin(), link.buffers.begin() + static_cast<std::ptrdiff_t>(whole));
    if (count == 0) return;
    link.buffers.front().iov_base = static_cast<char*>(link.buffers.front().iov_base) + count;
    link.buffers.front().iov_len -= count;
  }

  // Broken, or it has said all.
  bool is_over(const Link& link, std::int64_t now_ns) const {
    return link.broken || (hub_.finished(link.id) && link.buffers.empty()) || hub_.overdue(link.id, now_ns);
  }

  void reap(Link& link, std::int64_t now_ns) {
    if (!link.broken) link.broken = asio::error::eof;
    link.stop_watching();
    link.close();
    hub_.closed(link.id, network_error(link.broken, to_text(address_)), now_ns);
    links_.erase(link.id);
    ++link_changes_;
  }

  LinkOptions options_;
  std::unique_ptr<WireTap> recorder_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Hub hub_;
  HostPort address_;
  bool leaving_ = false;
  WakeUp wake_;
  bool polling_ = false;  // the program's thread waits on the sockets
  std::vector<pollfd> polled_;
  std::vector<std::shared_ptr<Link>> polled_links_;
  bool lease_ending_ = false;  // lease_timer_ runs
  std::int64_t lease_ns_ = 0;
  std::uint64_t link_changes_ = 0, link_changes_seen_ = 0;  // links that came or went
  bool alarm_set_ = false;
  std::int64_t alarm_ns_ = 0;
  asio::io_context io_;
  tcp::acceptor acceptor_;
  tcp::resolver resolver_;
  asio::steady_timer timer_, lease_timer_;
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
