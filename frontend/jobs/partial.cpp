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

}  // namespace

std::string part_text(const Part& part) {
  const auto range = [](const Range& r) {
    return std::to_string(r.begin) + ':' + std::to_string(r.end);
  };
  return "rows " + range(part.rows) + ", samples " + range(part.samples);
}

bool is_partial_name(std::string_view path) { return path.ends_with(".grelha"); }

void write_partial(const std::string& path, const Partial& partial, bool durable) {
  write_part(path, partial.identity, partial.sums, durable);
}

Partial parse_partial(const std::string& path, std::string_view bytes) {
  return part_of(path, parse_checkpoint(path, bytes));
}

Partial read_partial(const std::string& path) { return part_of(path, read_checkpoint(path)); }

}  // namespace grelha
