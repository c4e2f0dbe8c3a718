#pragma once
// A picture, or a part of one, as sums of light: rendered bit by bit, interrupted, kept, joined,
// with the bits of one that was rendered whole. For pictures with a fixed number of samples a pixel
// (neither RefineOptions nor Subdivision).

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

/// Sums of light are integers, and a sample is the same whoever takes it, so that sums of parts add
/// up to the sums of the whole.
///
/// The part is cut into pieces, kPieceRows rows high and kPieceSamples samples deep, of which a sum
/// holds all or nothing. Pieces stand in the order in which they are rendered: all rows of the
/// first samples, then all rows of the next.
struct Accumulator {
  int width = 0, height = 0, samples = 0;  ///< of the whole picture; samples: a pixel
  Part part;                               ///< the rows and samples of it that this holds
  /// [rows of the part][width][3] linear RGB, units of 2^-32
  std::vector<std::int64_t> sums;
  std::vector<std::uint8_t> done;  ///< [piece_count()] 1: in the sums

  bool operator==(const Accumulator&) const = default;  ///< the same part, sums and pieces
};

inline constexpr int kPieceRows = 8, kPieceSamples = 64;

/// Empty sums for `part` of a picture. Throws std::invalid_argument when the picture has no such
/// part.
Accumulator make_accumulator(const Camera& camera, const RenderOptions& options, const Part& part);
/// The same for a whole picture.
Accumulator make_accumulator(const Camera& camera, const RenderOptions& options);

/// Whether every mark of a piece is one that accumulate() can leave behind: what a file says must
/// pass this before it is gone on with.
bool is_sound(const Accumulator& a);

/// Pieces a part is cut into.
std::size_t piece_count(const Part& part);
/// Share of the part that is in the sums, 0 to 1.
double share_done(const Accumulator& a);
/// True where all of the part is in the sums.
inline bool is_complete(const Accumulator& a) {
  return share_done(a) == 1;
}

/// The part that piece i is.
Part piece_of(const Part& part, std::size_t i);

/// Names a piece that is not done, each once; piece_count() or more: none is left. Called by all
/// threads, two at a time as well.
using NextPiece = std::function<std::size_t()>;

/// Renders the pieces that are not done. Returns whether all are done now. One thread at a time
/// calls options.progress, between additions. It may read the accumulator, and keep a copy that
/// another call goes on from, here or on another machine. Where progress says to stop,
/// `should_continue` may read the accumulator as well, and returns whether to go on all the same.
/// `next` names the pieces for this call
/// where several share the work; without it all are. Throws like render().
bool accumulate(const World& world,
                const Camera& camera,
                const RenderOptions& options,
                Accumulator& a,
                RenderStats& stats,
                const NextPiece& next = {},
                const std::function<bool()>& should_continue = {});

/// Adds a complete part to sums of a larger one that lack it. Marks nothing done: the pieces of the
/// two need not be the same, and whoever adds parts knows when all are there.
void add(Accumulator& whole, const Accumulator& part);

/// The mean of the samples taken so far; pixels without samples are black. A complete whole picture
/// gives the bits of render().
Image picture_so_far(const Accumulator& a);

/// Rows `rows` of the image from their sums of so many samples.
void mean_light(const std::int64_t* sums, int samples, Image& image, const Range& rows);

}  // namespace grelha
