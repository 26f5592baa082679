#include "tests/support/relay.hpp"

#include <array>
#include <atomic>
#include <future>
#include <set>
#include <thread>

#include <boost/asio.hpp>

namespace counterpart {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

struct Pair : std::enable_shared_from_this<Pair> {
  Pair(tcp::socket near_socket, asio::io_context& io, const std::atomic<bool>& is_silent)
      : near(std::move(near_socket)), far(io), silent(is_silent) {}

  void pump(tcp::socket& from, tcp::socket& to, std::array<char, 65536>& buffer) {
    from.async_read_some(asio::buffer(buffer),
                         [self = shared_from_this(), &from, &to, &buffer](error_code error, std::size_t count) {
                           if (!error && !self->silent) asio::write(to, asio::buffer(buffer.data(), count), error);
                           if (error) return self->close();
                           self->pump(from, to, buffer);
                         });
  }

  void close() {
    error_code ignored;
    near.close(ignored);
    far.close(ignored);
  }

  tcp::socket near, far;
  const std::atomic<bool>& silent;
  std::array<char, 65536> up{}, down{};
};

}  // namespace

struct Relay::State {
  asio::io_context io;
  tcp::acceptor acceptor{io, tcp::endpoint(asio::ip::address_v4::loopback(), 0)};
  std::uint16_t to_port = 0;
  std::atomic<bool> silent{false};
  std::set<std::shared_ptr<Pair>> pairs;
  std::thread thread;

  void accept() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
      if (error) return;
      const auto pair = std::make_shared<Pair>(std::move(socket), io, silent);
      pair->far.connect(tcp::endpoint(asio::ip::address_v4::loopback(), to_port), error);
      if (!error) {
        pairs.insert(pair);
        pair->pump(pair->near, pair->far, pair->up);
        pair->pump(pair->far, pair->near, pair->down);
      }
      accept();
    });
  }
};

Relay::Relay(std::uint16_t to_port) : state_(std::make_unique<State>()) {
  state_->to_port = to_port;
  state_->accept();
  state_->thread = std::thread([this] { state_->io.run(); });
}

Relay::~Relay() {
  state_->io.stop();
  state_->thread.join();
}

std::string Relay::address() const {
  return "127.0.0.1:" + std::to_string(state_->acceptor.local_endpoint().port());
}

void Relay::cut() {
  std::promise<void> done;
  asio::post(state_->io, [&] {
    for (const auto& pair : state_->pairs) pair->close();
    state_->pairs.clear();
    done.set_value();
  });
  done.get_future().wait();
}

void Relay::silence(bool silent) {
  state_->silent = silent;
}

}  // namespace counterpart
