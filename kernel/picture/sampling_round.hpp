#pragma once
// A round of a refined picture: which blocks it doubles, how threads share them, and what their
// new samples add to the picture.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "grelha/render_options.hpp"
#include "grelha/stats.hpp"
#include "kernel/picture/block_errors.hpp"
#include "kernel/picture/refinement.hpp"
#include "kernel/scene/shading_view.hpp"
#include "kernel/shade/strips.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {

/// Most blocks a thread takes at a time.
inline constexpr int kBlocksOfChunk = 16;

/// Work handed to a thread.
struct Chunk {
  std::size_t begin, end;  ///< of the blocks wanted
  /// sums of squared differences, of halves of everything and of halves of the new half
  double variance_drop = 0;
  double variance_level = 0;
};

/// The cost of a picture so far.
struct Spent {
  std::uint64_t samples;  ///< of all pixels
  double seconds;
};

/// Wants the blocks of the next round, in the order of `order`, and says how far the picture is.
/// Returns whether there is a round.
bool choose_round(Refinement& r,
                  const BlockErrors& errors,
                  const RefineOptions& asked,
                  const std::vector<std::uint32_t>& order,
                  const Spent& spent);

/// Samples that the next round gives each pixel of a block.
std::uint32_t next_count(const Refinement& r, std::size_t block);

/// Cuts the wanted blocks into chunks. After an interruption between two chunks, the rest of the
/// round is cut into the same chunks as without it: the cost of a sample is measured by chunk.
std::vector<Chunk> cut_round(const Refinement& r);

/// Adds a pixel's new samples, by their sums of kParts parts.
void add_run(Refinement& r, const PixelRun& run, const std::int64_t* sums, Chunk& chunk);

/// Adds the first `done` chunks of a round. Returns true if these were all; otherwise the blocks of
/// the other chunks stay wanted.
bool end_round(Refinement& r, const std::vector<Chunk>& chunks, std::size_t done);

// A second opinion on a refined picture: some pixels once more, with other samples. Estimates that
// decided where to stop cannot be wrong in the same way twice.

/// Samples some pixels of a picture once more, by another sequence: others each time. The same for
/// any number of threads. `stats` gets the rays, r.check_samples stays as it is.
CheckSums check_error(const World::Impl& world,
                      const Setup& setup,
                      const RenderOptions& options,
                      const BlockErrors& errors,
                      const Refinement& r,
                      RenderStats& stats);

}  // namespace grelha
