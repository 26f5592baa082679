// What the system has measured of a TCP connection.
#pragma once

namespace counterpart {

// Bytes a second at which the newest data reached the peer; it may be able to take more. 0: not known.
double delivery_rate(int socket);

}  // namespace counterpart
