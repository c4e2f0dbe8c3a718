#pragma once
// Options of a caller's queries, checked.

#include "kernel/query/variants.hpp"

namespace grelha {

/// Throws std::invalid_argument for a packet of another size than 1, 16, 64 or 256.
TraceOptions options_of(const QueryOptions& options);

}  // namespace grelha
