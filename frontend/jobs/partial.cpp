#include "frontend/jobs/partial.hpp"

#include "frontend/files/parse_error.hpp"

namespace grelha {
namespace {

Partial part_of(const std::string& path, Checkpoint&& c) {
  Accumulator* const sums = c.picture.sums();
  if (!sums)
    throw FileError(
        path,
        "the checkpoint of a picture by --error, --time or --aa adaptive, which has no parts");
  return {std::move(c.identity), std::move(*sums)};
}

std::string range_text(const Range& range) {
  return std::to_string(range.begin) + ':' + std::to_string(range.end);
}

}  // namespace

std::string part_text(const Part& part) {
  return "rows " + range_text(part.rows) + ", samples " + range_text(part.samples);
}

bool is_partial_name(std::string_view path) {
  return path.ends_with(".grelha");
}

Partial parse_partial(const std::string& path, std::string_view bytes) {
  return part_of(path, parse_checkpoint(path, bytes));
}

Partial read_partial(const std::string& path) {
  return part_of(path, read_checkpoint(path));
}

}  // namespace grelha
