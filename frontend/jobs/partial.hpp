#pragma once

#include <string>
#include <string_view>

#include "frontend/jobs/checkpoint.hpp"

namespace grelha {

/// A part of a picture, finished or not, as `merge` reads it from .grelha files.
struct Partial {
  Identity identity;
  Accumulator sums;
};

bool is_partial_name(std::string_view path);

/// `rows 0:8, samples 16:32`
std::string part_text(const Part& part);

/// Throws FileError for a file that is damaged, has another format, or is of a picture without
/// parts.
Partial read_partial(const std::string& path);
Partial parse_partial(const std::string& path, std::string_view bytes);

}  // namespace grelha
