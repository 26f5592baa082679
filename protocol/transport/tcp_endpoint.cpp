#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <map>
#include <mutex>
#include <thread>

#include <boost/asio.hpp>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "protocol/capture/recorder.hpp"
#include "protocol/session/hub.hpp"
#include "protocol/session/rate_limit.hpp"
#include "protocol/transport/address.hpp"
#include "protocol/transport/body_pool.hpp"
#include "protocol/transport/delivery_rate.hpp"
#include "protocol/transport/endpoint.hpp"
#include "protocol/transport/monotonic_clock.hpp"
#include "protocol/transport/network_error.hpp"
#include "protocol/transport/outgoing.hpp"
#include "protocol/transport/socket_set.hpp"
#include "protocol/transport/tcp_connect.hpp"
#include "protocol/transport/tcp_link.hpp"
#include "protocol/transport/tls.hpp"
#include "protocol/transport/video_choice.hpp"

namespace counterpart {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr auto kGoodbyeLimit = std::chrono::milliseconds(300);
constexpr std::size_t kPosesReused = 16384;  // whose memory is used again
constexpr std::size_t kPicturesReused = 4;
constexpr std::int64_t kLease = 5'000'000;
constexpr std::int64_t kLongestPatience = 1'000'000'000'000'000;  // eleven days; more would not fit

// Messages of one connection that follow each other faster than this, for longer than this, are a flood. A game's never
// come near it.
constexpr std::int64_t kFloodPerSecond = 100'000;
constexpr std::int64_t kFloodBegins = 64;
constexpr int kMostHeld = 32;                                  // messages of a flood that one write carries
constexpr auto kLongestHeld = std::chrono::microseconds(200);  // where no more follow

// What the system may hold of a link to another host beyond what is under way: where it holds seconds of pictures, no
// newer one can replace them.
constexpr int kMostUnsent = 32 << 10;

void limit_unsent(int socket) {
  static_cast<void>(::setsockopt(socket, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kMostUnsent, sizeof kMostUnsent));
}

// What the options name, read and opened.
struct Prepared {
  HostPort address;
  std::string token;
  TlsIdentity identity;
  std::unique_ptr<WireTap> recorder;
};

// A link is in Asio's event loop only while the endpoint's own thread has to wait for it: a socket that is in the loop
// wakes that thread with every message, whoever reads it.
struct Watch {
  Watch(asio::io_context& io, int connected, ConnectionId id, std::unique_ptr<TlsStream> tls, bool to_this_host)
      : link(connected, id, std::move(tls)), local(to_this_host), descriptor(io) {}
  ~Watch() { stop(); }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  void stop() {
    if (descriptor.is_open()) descriptor.release();
    ++round;
    reading = writing = false;
  }

  TcpLink link;
  bool local;  // the peer is on this host
  asio::posix::stream_descriptor descriptor;
  std::uint64_t round = 0;  // waits of an earlier round no longer count
  bool reading = false, writing = false;
  RateLimit pace{kFloodPerSecond, kFloodBegins};  // of what is sent
  int held = 0;                                   // messages of a flood that wait to be written together
};

// Who sees pictures that build on each other.
struct Viewers {
  ConnectionId newest = 0;  // its video connection
  std::uint64_t dropped = 0;

  friend bool operator==(const Viewers&, const Viewers&) = default;
};

// Sockets are touched only with the mutex held; handlers run on the endpoint's own thread.
class TcpEndpoint : public Endpoint {
 public:
  TcpEndpoint(Hub::End end, const LinkOptions& options, Prepared prepared)
      : options_(options),
        end_(end),
        identity_(std::move(prepared.identity)),
        recorder_(std::move(prepared.recorder)),
        hub_(end, options, std::move(prepared.token), recorder_.get()),
        video_choice_(options.video_codec),
        h264_encoder_(options.h264.encoder ? options.h264.encoder() : nullptr),
        acceptor_(io_),
        timer_(io_),
        lease_timer_(io_),
        holding_timer_(io_),
        work_(asio::make_work_guard(io_)) {}

  ~TcpEndpoint() override {
    {
      std::unique_lock lock(mutex_);
      leaving_ = true;
      error_code ignored;
      acceptor_.close(ignored);
      hub_.leave(monotonic_ns());
      after_change();
      changed_.wait_for(lock, kGoodbyeLimit, [&] { return links_.empty(); });
    }
    io_.stop();
    if (thread_.joinable()) thread_.join();
    for (const auto& watched : links_) watched->stop();
  }

  TcpEndpoint(const TcpEndpoint&) = delete;
  TcpEndpoint& operator=(const TcpEndpoint&) = delete;

  Result<void> listen(const HostPort& address, bool has_token) {
    auto acceptor = open_acceptor(io_, address, has_token);
    if (!acceptor) return tl::make_unexpected(acceptor.error());
    acceptor_ = std::move(*acceptor);
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
    std::unique_lock lock(mutex_);
    auto outgoing = prepare(message, lock);
    if (!outgoing) return refuse(peer, outgoing.error());
    const std::int64_t now_ns = monotonic_ns();
    const MessageType type = outgoing->type;
    hub_.send(peer, std::move(*outgoing), now_ns);
    const auto& carrier = find(hub_.carrier(peer, type));
    if (carrier != nullptr && !(hub_.keeps(peer, type) && holds_back(*carrier, now_ns)) &&
        is_over_after_writing(carrier, now_ns)) {
      return after_change();
    }
    if (changed()) after_change();
  }

  void broadcast(const Message& message) override {
    std::unique_lock lock(mutex_);
    if (!hub_.wanted(type_of(message))) return;
    auto outgoing = prepare(message, lock);
    if (!outgoing) return refuse(0, outgoing.error());
    const std::int64_t now_ns = monotonic_ns();
    hub_.broadcast(*outgoing, now_ns);
    after_change();
  }

  // A program that waits here reads the sockets itself: a message then costs one wake-up less.
  std::vector<Inbound> receive(std::int64_t timeout_ns) override {
    std::unique_lock lock(mutex_);
    if (held_) after_change();  // a program that comes here has no more to send for now
    std::int64_t now_ns = monotonic_ns();
    const std::int64_t deadline_ns = now_ns + std::min(timeout_ns, kLongestPatience);
    while (!hub_.has_inbound() && now_ns < deadline_ns) now_ns = read_in_place(lock, now_ns, deadline_ns);
    if (timeout_ns > 0) take_lease(now_ns);
    auto taken = hub_.take_inbound();
    if (!leased(now_ns)) wait_for_all();  // it may have been too full to read on
    if (options_.h264.decoder) expand(taken, lock);
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

  // A message as it waits to be sent. What takes a while to turn into bytes keeps nobody waiting.
  Result<Outgoing> prepare(const Message& message, std::unique_lock<std::mutex>& lock) {
    const bool at_once = std::holds_alternative<PoseEstimate>(message);
    const VideoForm form = form_for(message);
    const bool afresh = form.codec == PixelCodec::h264 && breaks_chain();
    auto memory = memory_for(message);
    if (!at_once) lock.unlock();
    auto outgoing = form.codec == PixelCodec::h264 ? make_chained(message, {afresh, form.bits_a_picture}, memory)
                                                   : make_outgoing(message, form, memory);
    if (!at_once) lock.lock();
    return outgoing;
  }

  // Without the mutex.
  Result<Outgoing> make_chained(const Message& message, const VideoEncoder::Wish& wish, std::shared_ptr<Bytes> memory) {
    auto coded = h264_encoder_->encode(std::get<VideoFrame>(message), wish);
    if (!coded) {
      h264_encoder_.reset();  // JPEG will do
      return tl::make_unexpected(coded.error());
    }
    return make_outgoing(std::move(*coded), {}, std::move(memory));
  }

  // Somebody lacks pictures that the next one would build on.
  bool breaks_chain() {
    Viewers now{0, hub_.dropped_pictures()};
    for (const auto& watched : links_) {
      if (hub_.carries_video(watched->link.id())) now.newest = watched->link.id();
    }
    return std::exchange(chained_for_, now) != now;
  }

  // What came in H.264, raw. What builds on a picture that did not come is left out; decoding keeps nobody waiting.
  void expand(std::vector<Inbound>& inbound, std::unique_lock<std::mutex>& lock) {
    lock.unlock();
    std::vector<PeerId> useless;
    const auto is_useless = [&](Inbound& one) {
      if (const auto* left = std::get_if<PeerLeft>(&one)) h264_decoders_.erase(left->peer);
      auto* received = std::get_if<Received>(&one);
      auto* picture = received == nullptr ? nullptr : std::get_if<VideoFrame>(&received->message);
      if (picture == nullptr || picture->codec != PixelCodec::h264) return false;
      auto& decoder = h264_decoders_[received->peer];
      if (decoder == nullptr) decoder = options_.h264.decoder();
      auto raw = decoder->decode(*picture);
      if (raw && *raw) {
        *picture = std::move(**raw);
        return false;
      }
      useless.push_back(received->peer);
      return true;
    };
    inbound.erase(std::remove_if(inbound.begin(), inbound.end(), is_useless), inbound.end());
    lock.lock();
    for (const PeerId peer : useless) hub_.count_dropped(peer);
  }

  std::shared_ptr<Bytes> memory_for(const Message& message) {
    if (std::holds_alternative<PoseEstimate>(message)) return poses_.take();
    if (std::holds_alternative<VideoFrame>(message)) return pictures_.take();
    return std::make_shared<Bytes>();
  }

  VideoForm form_for(const Message& message) {
    const auto* picture = std::get_if<VideoFrame>(&message);
    if (picture == nullptr || picture->codec != PixelCodec::raw_bgr8) return {};
    VideoLinks links = video_links();
    if (!options_.lockstep) return video_choice_.choose(picture->bytes.size(), links, monotonic_ns());
    links.slowest_bytes_per_second = 0;  // two runs must give the same bytes
    return video_choice_.choose(picture->bytes.size(), links, picture->stamp.capture_ns);
  }

  VideoLinks video_links() const {
    VideoLinks all;
    all.dropped = hub_.dropped_pictures();
    all.waiting = hub_.waiting_pictures();
    all.slowest_bytes_per_second = std::numeric_limits<double>::max();
    all.h264 = h264_encoder_ != nullptr && hub_.all_take_h264();
    for (const auto& watched : links_) {
      if (!hub_.carries_video(watched->link.id())) continue;
      all.all_local = all.all_local && watched->local;
      all.slowest_bytes_per_second = std::min(all.slowest_bytes_per_second, delivery_rate(watched->link.socket()));
    }
    return all;
  }

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
    const bool local = socket.remote_endpoint(ignored).address().is_loopback();
    const int connected = socket.release(ignored);
    if (!local) limit_unsent(connected);
    links_.push_back(std::make_shared<Watch>(io_, connected, id, tls_over(connected), local));
    after_change();
  }

  std::unique_ptr<TlsStream> tls_over(int connected) {
    if (!identity_) return nullptr;
    const auto end = end_ == Hub::End::client ? TlsStream::End::client : TlsStream::End::server;
    return std::make_unique<TlsStream>(*identity_, connected, end);
  }

  void dial(Hub::LaneName lane) {
    connect_socket(io_, address_, hub_.dial_limit(monotonic_ns()),
                   [this, lane](const error_code& error, tcp::socket socket) {
                     const std::lock_guard lock(mutex_);
                     if (leaving_) return;
                     if (error) {
                       hub_.dial_failed(lane, network_error(error, to_text(address_)), monotonic_ns());
                       after_change();
                     } else {
                       add_link(std::move(socket), hub_.dialled(lane, monotonic_ns()));
                     }
                   });
  }

  // Ids grow, so the links lie in their order. Null: it is gone.
  const std::shared_ptr<Watch>& find(ConnectionId id) const {
    static const std::shared_ptr<Watch> nobody;
    const auto found = std::lower_bound(links_.begin(), links_.end(), id,
                                        [](const auto& watched, ConnectionId one) { return watched->link.id() < one; });
    return found != links_.end() && (*found)->link.id() == id ? *found : nobody;
  }

  // Connections or sessions came, went or changed since after_change.
  bool changed() const { return hub_.changes() != changes_seen_; }

  // Of a flood, several messages are written at a time: a system call costs more than all the rest of a small message.
  // Every other message is written when it is sent, and so is what a newer one might push out while it waits.
  bool holds_back(Watch& watched, std::int64_t now_ns) {
    const bool flood = watched.pace.count(now_ns) > now_ns;
    if (!flood || ++watched.held >= kMostHeld) return false;
    if (!held_) write_held_soon();
    return true;
  }

  void write_held_soon() {
    held_ = true;
    if (holding_ends_) return;
    holding_ends_ = true;
    holding_timer_.expires_after(kLongestHeld);
    holding_timer_.async_wait([this](const error_code& cancelled) {
      if (cancelled) return;
      const std::lock_guard lock(mutex_);
      holding_ends_ = false;
      if (held_) after_change();
    });
  }

  bool is_over_after_writing(const std::shared_ptr<Watch>& watched, std::int64_t now_ns) {
    write(*watched, now_ns);
    if (watched->link.blocked()) watch(watched, now_ns);
    return is_over(watched->link, now_ns);
  }

  // --- reading on the program's own thread ---
  //
  // While it lasts, and a moment longer, the endpoint's thread leaves reading alone; a program that does not come back
  // loses nothing but that moment.

  bool leased(std::int64_t now_ns) const { return !leaving_ && (polling_ || now_ns < lease_ns_); }

  // Returns what time it is then.
  std::int64_t read_in_place(std::unique_lock<std::mutex>& lock, std::int64_t now_ns, std::int64_t deadline_ns) {
    for (const auto& watched : links_) {
      TcpLink& link = watched->link;
      watched->stop();
      const bool reads = !link.broken() && hub_.wants_read(link.id());
      sockets_.want(link.socket(), link.id(), reads, link.blocked(), link.waited_for);
    }
    polling_ = true;
    lock.unlock();
    const auto ready = sockets_.wait(now_ns, deadline_ns);
    lock.lock();
    polling_ = false;
    now_ns = monotonic_ns();
    take_lease(now_ns);
    bool over = false;
    for (const SocketSet::Ready& one : ready) {
      const auto& watched = find(one.id);
      if (watched == nullptr) continue;
      if (one.write) watched->link.unblock();
      if (one.read) watched->link.read(hub_, now_ns);
      over = is_over_after_writing(watched, now_ns) || over;
      set_alarm(hub_.next_tick(one.id, now_ns));
    }
    if (over || changed()) after_change();
    return now_ns;
  }

  void take_lease(std::int64_t now_ns) {
    lease_ns_ = now_ns + kLease;
    end_lease_later();
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
      if (leased(monotonic_ns())) return end_lease_later();
      wait_for_all();
    });
  }

  void write(Watch& watched, std::int64_t now_ns) {
    watched.held = 0;
    watched.link.flush(hub_, now_ns);
  }

  // Whatever happened: write what can be written, read what may be read, close what is over, set the alarm clock.
  void after_change() {
    const std::int64_t now_ns = monotonic_ns();
    if (!leaving_) {
      while (const auto lane = hub_.wants_to_dial(now_ns)) dial(*lane);
    }
    held_ = false;
    std::vector<std::shared_ptr<Watch>> over;
    for (const auto& watched : links_) {
      write(*watched, now_ns);
      watch(watched, now_ns);
      if (is_over(watched->link, now_ns)) over.push_back(watched);
    }
    for (const auto& watched : over) reap(watched, now_ns);
    set_alarm(hub_.next_tick(now_ns));
    if (hub_.has_inbound() || links_.empty()) changed_.notify_all();
    if (polling_ && (hub_.has_inbound() || changed())) sockets_.ring();
    changes_seen_ = hub_.changes();
  }

  void wait_for_all() {
    for (const auto& watched : links_) watch(watched, monotonic_ns());
  }

  void set_alarm(std::int64_t when_ns) {
    if (alarm_set_ && alarm_ns_ <= when_ns) return;
    alarm_set_ = true;
    alarm_ns_ = when_ns;
    timer_.expires_at(std::chrono::steady_clock::time_point(std::chrono::nanoseconds(when_ns)));
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
  void watch(const std::shared_ptr<Watch>& watched, std::int64_t now_ns) {
    const TcpLink& link = watched->link;
    if (link.broken()) return;
    if (polling_) {
      const bool again = (link.waited_for & EPOLLIN) == 0 && hub_.wants_read(link.id());
      if (link.blocked() || again) sockets_.ring();
      return;
    }
    if (link.blocked() && !watched->writing) {
      wait_until(asio::posix::stream_descriptor::wait_write, watched, watched->writing,
                 [watched](std::int64_t) { watched->link.unblock(); });
    }
    if (!watched->reading && !leased(now_ns) && hub_.wants_read(link.id())) {
      wait_until(asio::posix::stream_descriptor::wait_read, watched, watched->reading,
                 [this, watched](std::int64_t then) {
                   if (!leased(then)) watched->link.read(hub_, then);
                 });
    }
  }

  // waiting: the flag of `watched` that says so.
  template <class Ready>
  void wait_until(asio::posix::stream_descriptor::wait_type what, const std::shared_ptr<Watch>& watched, bool& waiting,
                  Ready ready) {
    waiting = true;
    if (!watched->descriptor.is_open()) watched->descriptor.assign(watched->link.socket());
    watched->descriptor.async_wait(what,
                                   [this, watched, &waiting, ready, round = watched->round](const error_code& error) {
                                     const std::lock_guard lock(mutex_);
                                     if (error || round != watched->round) return;
                                     waiting = false;
                                     ready(monotonic_ns());
                                     after_change();
                                   });
  }

  // Broken, or it has said all.
  bool is_over(const TcpLink& link, std::int64_t now_ns) const {
    if (link.broken()) return true;
    if (hub_.listens(link.id())) return false;
    return (hub_.finished(link.id()) && !link.writing()) || hub_.overdue(link.id(), now_ns);
  }

  void reap(const std::shared_ptr<Watch>& watched, std::int64_t now_ns) {
    TcpLink& link = watched->link;
    const error_code why = link.broken() ? link.broken() : error_code(asio::error::eof);
    watched->stop();
    link.close();
    hub_.closed(link.id(), link.tls_error().value_or(network_error(why, to_text(address_))), now_ns);
    links_.erase(std::find(links_.begin(), links_.end(), watched));
  }

  LinkOptions options_;
  Hub::End end_;
  TlsIdentity identity_;  // null: no TLS
  std::unique_ptr<WireTap> recorder_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Hub hub_;
  VideoChoice video_choice_;
  std::unique_ptr<VideoEncoder> h264_encoder_;  // null: none
  std::map<PeerId, std::unique_ptr<VideoDecoder>> h264_decoders_;
  Viewers chained_for_;  // the last picture in H.264
  BodyPool poses_{kPosesReused}, pictures_{kPicturesReused};
  HostPort address_;
  bool leaving_ = false;
  SocketSet sockets_;
  bool polling_ = false;       // the program's thread waits on the sockets
  bool lease_ending_ = false;  // lease_timer_ runs
  bool held_ = false;          // messages of a flood may be waiting
  bool holding_ends_ = false;  // holding_timer_ runs
  std::int64_t lease_ns_ = 0;
  std::uint64_t changes_seen_ = 0;  // of hub_.changes()
  bool alarm_set_ = false;
  std::int64_t alarm_ns_ = 0;
  asio::io_context io_;
  tcp::acceptor acceptor_;
  asio::steady_timer timer_, lease_timer_, holding_timer_;
  asio::executor_work_guard<asio::io_context::executor_type> work_;
  std::vector<std::shared_ptr<Watch>> links_;  // by id
  std::thread thread_;
};

Result<Prepared> prepare(const std::string& address, const LinkOptions& options) {
  auto host_port = parse_address(address);
  if (!host_port) return tl::make_unexpected(host_port.error());
  Prepared prepared;
  prepared.address = *host_port;
  if (!options.token_file.empty()) {
    auto token = read_token(options.token_file);
    if (!token) return tl::make_unexpected(token.error());
    prepared.token = *token;
  }
  if (!options.tls_file.empty()) {
    auto identity = read_tls_identity(options.tls_file);
    if (!identity) return tl::make_unexpected(identity.error());
    prepared.identity = std::move(*identity);
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
  const HostPort where = prepared->address;
  const bool has_token = !prepared->token.empty();
  auto endpoint = std::make_unique<TcpEndpoint>(Hub::End::server, options, std::move(*prepared));
  if (auto listening = endpoint->listen(where, has_token); !listening) {
    return tl::make_unexpected(listening.error());
  }
  endpoint->start();
  return endpoint;
}

Result<std::unique_ptr<Endpoint>> connect_tcp(const std::string& address, const LinkOptions& options,
                                              std::int64_t wait_ns) {
  auto prepared = prepare(address, options);
  if (!prepared) return tl::make_unexpected(prepared.error());
  const HostPort where = prepared->address;
  auto endpoint = std::make_unique<TcpEndpoint>(Hub::End::client, options, std::move(*prepared));
  endpoint->connect(where);
  endpoint->start();
  if (wait_ns > 0) {
    if (auto error = endpoint->wait_for_session(wait_ns)) return tl::make_unexpected(*error);
  }
  return endpoint;
}

}  // namespace counterpart
