#pragma once

namespace grelha {

/// The whole numbers begin, begin + 1, ..., end - 1.
struct Range {
  int begin = 0, end = 0;
  bool operator==(const Range&) const = default;  ///< the same ends
};

/// A part of a picture: some of its rows, row 0 on top, and some samples of each of their pixels.
struct Part {
  Range rows, samples;
  bool operator==(const Part&) const = default;  ///< the same rows and samples
};

}  // namespace grelha
