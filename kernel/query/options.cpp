#include "kernel/query/options.hpp"

#include <stdexcept>

namespace grelha {

TraceOptions options_of(int packet) {
  if (packet != 1 && packet != 16 && packet != 64 && packet != 256)
    throw std::invalid_argument("a packet holds 1, 16, 64 or 256 rays");
  return {.packet = packet};
}

}  // namespace grelha
