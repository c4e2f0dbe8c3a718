#include "kernel/query/options.hpp"

#include <stdexcept>

namespace grelha {

TraceOptions options_of(const QueryOptions& options) {
  const int packet = options.packet;
  if (packet != 1 && packet != 16 && packet != 64 && packet != 256)
    throw std::invalid_argument("a packet holds 1, 16, 64 or 256 rays");
  return {.packet = packet, .masks = options.mask.empty() ? nullptr : options.mask.data()};
}

}  // namespace grelha
