#pragma once

#include "frontend/jobs/checkpoint.hpp"

namespace grelha {

inline void write_partial(const std::string& path, const Partial& p, bool durable = false) {
  write_checkpoint(path, p.identity, Picture(p.sums), durable);
}

}  // namespace grelha
