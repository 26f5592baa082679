#include "protocol/daemon/picture_memory.hpp"

#include <malloc.h>

namespace counterpart {

void keep_picture_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
#endif
}

}  // namespace counterpart
