#include "protocol/daemon/stop_signal.hpp"

#include <csignal>

namespace counterpart {
namespace {

volatile std::sig_atomic_t g_stop = 0;

void on_signal(int signal) {
  g_stop = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_stop_signals() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool stop_requested() {
  return g_stop != 0;
}

}  // namespace counterpart
