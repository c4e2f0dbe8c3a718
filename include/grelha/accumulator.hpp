#pragma once
// Sums of light of a picture or of a part of one. The work can be interrupted, saved, resumed, and
// split over machines. The result has the same bits as a single render(). Only for pictures with a
// fixed number of samples a pixel (neither RefineOptions nor Subdivision).

#include <cstdint>
#include <functional>
#include <vector>

#include "grelha/camera.hpp"
#include "grelha/image.hpp"
#include "grelha/part.hpp"
#include "grelha/render_options.hpp"
#include "grelha/stats.hpp"
#include "grelha/world.hpp"

namespace grelha {

/// Integer sums of light for a part of a picture. A sample depends neither on the thread nor on the
/// machine that takes it, so the sums of parts add up to the sums of the whole.
///
/// The part is divided into pieces of at most kPieceRows rows and kPieceSamples samples. The sums
/// contain a piece completely or not at all. Pieces are numbered in the order in which they are
/// rendered: all rows of the first samples, then all rows of the next.
struct Accumulator {
  int width = 0, height = 0, samples = 0;  ///< of the whole picture; samples per pixel
  Part part;                               ///< the rows and samples that this covers
  /// [rows of the part][width][3] linear RGB in units of 2^-32
  std::vector<std::int64_t> sums;
  std::vector<std::uint8_t> done;  ///< [piece_count()] 1 if the sums contain the piece, else 0

  bool operator==(const Accumulator&) const = default;  ///< the same part, sums and pieces
};

inline constexpr int kPieceRows = 8, kPieceSamples = 64;

/// Empty sums for `part` of a picture. Throws std::invalid_argument when the picture has no such
/// part.
Accumulator make_accumulator(const Camera& camera, const RenderOptions& options, const Part& part);
/// The same for a whole picture.
Accumulator make_accumulator(const Camera& camera, const RenderOptions& options);

/// Returns true if every element of `done` is 0 or 1. Check an accumulator that was read from a
/// file with this before accumulate() resumes it.
bool is_valid(const Accumulator& a);

/// Returns the number of pieces that a part is divided into.
std::size_t piece_count(const Part& part);
/// Returns the fraction of the part's pieces that the sums contain, 0 to 1.
double share_done(const Accumulator& a);
/// Returns true if the sums contain every piece of the part.
inline bool is_complete(const Accumulator& a) {
  return share_done(a) == 1;
}

/// Returns the rows and samples of piece i.
Part piece_of(const Part& part, std::size_t i);

/// Returns the number of a piece that is not done, each piece once. Returns piece_count() or more
/// when no piece is left. All threads call it, possibly at the same time.
using NextPiece = std::function<std::size_t()>;

/// Renders the pieces that are not done and returns true if all pieces are done then. One thread at
/// a time calls options.progress, between additions to the sums. The callback may read the
/// accumulator and save a copy, from which another call can resume, on this machine or another.
/// When progress returns false, `should_continue` is called. It may read the accumulator too, and
/// the call goes on if it returns true. `next` selects the pieces of this call when several calls
/// share the work; without it the call renders all of them. Throws what render() throws, and
/// std::invalid_argument if `a` was made for another size or number of samples.
bool accumulate(const World& world,
                const Camera& camera,
                const RenderOptions& options,
                Accumulator& a,
                RenderStats& stats,
                const NextPiece& next = {},
                const std::function<bool()>& should_continue = {});

/// Adds a complete part to the sums of a larger part that do not contain it yet. Does not change
/// `whole.done`, because the pieces of the two may differ; the caller tracks which parts it has
/// added. Throws std::invalid_argument if the sizes or sample counts of the pictures differ, `part`
/// is incomplete, or it lies outside `whole`.
void add(Accumulator& whole, const Accumulator& part);

/// Returns the mean of the samples taken so far; pixels without samples are black. For a complete
/// whole picture the result has the same bits as that of render().
Image picture_so_far(const Accumulator& a);

/// Computes the rows `rows` of the image from the sums of `samples` samples per pixel.
void mean_light(const std::int64_t* sums, int samples, Image& image, const Range& rows);

}  // namespace grelha
