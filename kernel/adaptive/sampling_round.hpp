#pragma once
// A round of a refined picture: which pixels it doubles, how threads share them, and what their
// new samples add to the picture.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/adaptive/pixel_errors.hpp"
#include "kernel/adaptive/refinement.hpp"
#include "kernel/scene/shading_view.hpp"

namespace grelha {

/// Most pixels a thread takes at a time.
inline constexpr int kRunsOfChunk = 256;

/// Work handed to a thread.
struct Chunk {
  std::size_t begin, end;  ///< of the pixels wanted
  /// sums of squared differences, of halves of everything and of halves of the new half
  double variance_drop = 0;
  double variance_level = 0;
};

/// What a picture has cost so far.
struct Spent {
  std::uint64_t samples;  ///< of all pixels
  double seconds;
};

/// Wants the pixels of the next round, in the order of `order`, and says how far the picture is.
/// Returns whether there is a round. `first_log`: of the samples that a pixel begins with.
bool choose_round(Refinement& r,
                  const PixelErrors& errors,
                  const RefineOptions& asked,
                  const std::vector<std::uint32_t>& order,
                  const Spent& spent,
                  int first_log);

/// Samples that the next round gives a pixel.
std::uint32_t next_count(const Refinement& r, std::uint32_t pixel, int first_log);

/// Chunks of the pixels wanted. Cut anywhere between two of them, the rest of a round is cut into
/// the same chunks as in one go: what a sample costs is known by chunk.
std::vector<Chunk> cut_round(const Refinement& r, int first_log);

/// Adds a pixel's new samples, by their sums of kParts parts.
void add_run(
    Refinement& r, const PixelRun& run, const std::int64_t* sums, int first_log, Chunk& chunk);

/// Takes in the first `done` chunks of a round. Returns whether these were all: else the pixels of
/// the others stay wanted.
bool end_round(Refinement& r, const std::vector<Chunk>& chunks, std::size_t done);

}  // namespace grelha
