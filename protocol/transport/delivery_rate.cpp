#include "protocol/transport/delivery_rate.hpp"

#include <cstddef>

// The kernel's own header: the C library's does not know the rate. Both in one unit would clash, so this file is
// compiled alone.
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace counterpart {

double delivery_rate(int socket) {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (::getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return 0;
  const bool known = size >= offsetof(tcp_info, tcpi_delivery_rate) + sizeof info.tcpi_delivery_rate;
  return known ? static_cast<double>(info.tcpi_delivery_rate) : 0;
}

}  // namespace counterpart
