#pragma once
// A round of a refined picture: which blocks it doubles (round_plan.cpp), how threads share them,
// and what their new samples add to the picture.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "grelha/render_options.hpp"
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

/// Wants the blocks of the next round, in the order of `order`, or sets r.limit. Returns whether
/// there is a round.
bool plan_round(Refinement& r,
                const BlockErrors& errors,
                const RefineOptions& asked,
                const std::vector<std::uint32_t>& order,
                const Spent& spent);

/// True when the error asked for seems to be met and no recent check says so; also right after a
/// check that found far more, which may rest on a hit or two.
bool is_check_due(const Refinement& r,
                  const BlockErrors& errors,
                  const RefineOptions& asked,
                  std::uint64_t samples);

/// Makes the next round a check of the picture's error: it doubles blocks drawn at random, whatever
/// they claim, and those that claim most. What decided where to stop cannot be wrong in the same
/// way twice. Returns false, and sets r.limit, if the limits leave too little for it.
bool plan_check(Refinement& r,
                const BlockErrors& errors,
                const RefineOptions& asked,
                const std::vector<std::uint32_t>& order,
                const Spent& spent,
                std::uint32_t seed);

/// Takes what the check in work found into r.checked. Sums of earlier checks count for half.
void close_check(Refinement& r, std::uint64_t samples);

/// Times that the round in work doubles a block's samples.
int doublings(const Refinement& r, std::size_t block);
/// Samples that it gives each pixel of a block.
std::uint32_t new_count(const Refinement& r, std::size_t block);

/// Projects spheres, cones and small meshes that look thinner than a pixel into a picture, straight
/// and by flat mirrors, whatever stands before them. Their pixels get boxes that later samples
/// favour; until then r.missed holds the variances that they may add to blocks.
void mark_small_objects(const World::Impl& world, const FrameView& frame, Refinement& r);

/// Cuts the wanted blocks into chunks. After an interruption between two chunks, the rest of the
/// round is cut into the same chunks as without it: the cost of a sample is measured by chunk.
std::vector<Chunk> cut_round(const Refinement& r);

/// Adds a pixel's new samples, by their sums of kParts parts.
void add_run(Refinement& r, const PixelRun& run, const std::int64_t* sums, Chunk& chunk);

/// Adds the first `done` chunks of a round. Returns true if these were all; otherwise the blocks of
/// the other chunks stay wanted.
bool end_round(Refinement& r, const std::vector<Chunk>& chunks, std::size_t done);

/// Takes what the round measured of the variances into what earlier ones did.
void close_round(Refinement& r);

}  // namespace grelha
