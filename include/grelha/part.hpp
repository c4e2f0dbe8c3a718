#pragma once

namespace grelha {

/// begin, begin + 1, ..., end - 1.
struct Range {
  int begin = 0, end = 0;
  bool operator==(const Range&) const = default;  ///< the same ends
};

/// Of a picture: these rows, row 0 on top, and of each of their pixels these samples.
struct Part {
  Range rows, samples;
  bool operator==(const Part&) const = default;  ///< the same rows and samples
};

}  // namespace grelha
