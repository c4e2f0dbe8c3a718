#pragma once

#include <string>
#include <vector>

#include "frontend/jobs/checkpoint.hpp"

namespace grelha {

/// Joins parts of one picture into the least part that holds them all. Throws UsageError when they
/// are not of one picture, one is not finished, two overlap or some are missing, and FileError when
/// one cannot be read; each says which.
Partial merge_parts(const std::vector<std::string>& files);

}  // namespace grelha
