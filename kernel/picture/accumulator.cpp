#include "grelha/accumulator.hpp"

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <string>

#include "kernel/shade/guarded_progress.hpp"
#include "kernel/shade/strips.hpp"
#include "kernel/base/fork.hpp"
#include "kernel/base/pages.hpp"

namespace grelha {
namespace {

static_assert(kPieceRows == kStripRows);

int size(const Range& r) {
  return r.end - r.begin;
}
int pieces(const Range& r, int piece) {
  return (size(r) + piece - 1) / piece;
}

/// Piece k of a range.
Range cut(const Range& r, int piece, std::size_t k) {
  const int begin = r.begin + static_cast<int>(k) * piece;
  return {begin, std::min(begin + piece, r.end)};
}

/// Sums of rows of a picture.
std::size_t sum_count(const Range& rows, int width) {
  return static_cast<std::size_t>(size(rows)) * static_cast<std::size_t>(width) * 3;
}

std::size_t first_sum(const Accumulator& a, int row) {
  return static_cast<std::size_t>(row - a.part.rows.begin) * static_cast<std::size_t>(a.width) * 3;
}

/// Sums that a file made up may be of any size: adding these wraps around.
std::int64_t wrapped_sum(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

void add_rows(Accumulator& to, const Range& rows, const std::int64_t* sums) {
  std::int64_t* const out = to.sums.data() + first_sum(to, rows.begin);
  const std::size_t n = sum_count(rows, to.width);
  for (std::size_t i = 0; i < n; ++i)
    out[i] = wrapped_sum(out[i], sums[i]);
}

[[noreturn]] void refuse(const char* what, const Range& r, int most) {
  throw std::invalid_argument(std::string(what) + ' ' + std::to_string(r.begin) + ':' +
                              std::to_string(r.end) + " are not among 0:" + std::to_string(most));
}

bool within(const Range& r, const Range& all) {
  return r.begin >= all.begin && r.end <= all.end;
}
bool within(const Range& r, int most) {
  return r.begin < r.end && within(r, Range{0, most});
}

void check(const Accumulator& a, const Camera& camera, const RenderOptions& options) {
  if (options.subdivision.on || options.refine.on())
    throw std::invalid_argument("sums are kept of pictures with a fixed number of samples alone");
  if (a.width != camera.width || a.height != camera.height || a.samples != options.sampling.samples)
    throw std::invalid_argument("these sums are of a picture of another size or number of samples");
}

}  // namespace

Accumulator make_accumulator(const Camera& camera, const RenderOptions& options, const Part& part) {
  const int samples = options.sampling.samples;
  if (!within(part.rows, camera.height))
    refuse("rows", part.rows, camera.height);
  if (!within(part.samples, samples))
    refuse("samples", part.samples, samples);
  Accumulator a{camera.width, camera.height, samples, part, {}, {}};
  resize_to_fill(a.sums, sum_count(part.rows, camera.width));
  a.done.resize(piece_count(part));
  return a;
}

Accumulator make_accumulator(const Camera& camera, const RenderOptions& options) {
  return make_accumulator(camera, options, {{0, camera.height}, {0, options.sampling.samples}});
}

bool is_valid(const Accumulator& a) {
  return std::all_of(a.done.begin(), a.done.end(), [](std::uint8_t d) { return d <= 1; });
}

std::size_t piece_count(const Part& part) {
  return static_cast<std::size_t>(pieces(part.rows, kPieceRows)) *
         static_cast<std::size_t>(pieces(part.samples, kPieceSamples));
}

Part piece_of(const Part& part, std::size_t i) {
  const std::size_t strips = static_cast<std::size_t>(pieces(part.rows, kPieceRows));
  return {cut(part.rows, kPieceRows, i % strips), cut(part.samples, kPieceSamples, i / strips)};
}

double share_done(const Accumulator& a) {
  const auto done = std::count(a.done.begin(), a.done.end(), std::uint8_t{1});
  return static_cast<double>(done) / static_cast<double>(a.done.size());
}

namespace {

/// Pieces that are not done, and who renders which.
class Pieces {
 public:
  Pieces(const Accumulator& a, const NextPiece& next) : next_(next) {
    for (std::size_t i = 0; i < a.done.size(); ++i)
      if (a.done[i] == 0)
        left_.push_back(i);
  }
  std::size_t left() const { return left_.size(); }

  /// Which to render in a turn, or one past the last.
  std::size_t take(std::size_t turn) const { return next_ ? next_() : left_[turn]; }

 private:
  const NextPiece& next_;
  std::vector<std::size_t> left_;
};

}  // namespace

bool accumulate(const World& world,
                const Camera& camera,
                const RenderOptions& options,
                Accumulator& a,
                RenderStats& stats,
                const NextPiece& next,
                const std::function<bool()>& should_continue) {
  const Setup setup = set_up(world, camera, options);
  check(a, camera, options);
  const Pieces to_render(a, next);
  GuardedProgress progress(options.progress, should_continue);
  const auto next_strip = [&](std::size_t turn, Strip& strip) {
    strip.number = to_render.take(turn);
    if (strip.number >= a.done.size())
      return false;
    strip.part = piece_of(a.part, strip.number);
    return true;
  };
  std::size_t done = a.done.size() - to_render.left();
  const auto take_strip = [&](const Strip& strip, const std::int64_t* sums) {
    bool stopped = false;
#pragma omp critical(grelha_progress)
    {
      add_rows(a, strip.part.rows, sums);
      a.done[strip.number] = 1;
      ++done;
      progress.report(static_cast<double>(done) / static_cast<double>(a.done.size()));
      if (progress.stopped())
        progress.resume();  // no thread changes the sums meanwhile
      stopped = progress.stopped();
    }
    return !stopped;
  };
  run_fork_safe([&] {
    render_strips(world.impl(), setup, options, to_render.left(), next_strip, take_strip, stats);
  });
  progress.rethrow();
  return is_complete(a);
}

void add(Accumulator& whole, const Accumulator& part) {
  if (whole.width != part.width || whole.height != part.height || whole.samples != part.samples)
    throw std::invalid_argument("these sums are of a picture of another size or number of samples");
  if (!within(part.part.rows, whole.part.rows) || !within(part.part.samples, whole.part.samples))
    throw std::invalid_argument("a part lies outside what it is added to");
  if (!is_complete(part))
    throw std::invalid_argument("a part is not complete");
  add_rows(whole, part.part.rows, part.sums.data());
}

Image picture_so_far(const Accumulator& a) {
  Image image = image_to_fill(a.width, a.height);
  const std::size_t strips = static_cast<std::size_t>(pieces(a.part.rows, kPieceRows));
  for (std::size_t b = 0; b < strips; ++b) {
    int samples = 0;
    for (std::size_t i = b; i < a.done.size(); i += strips)
      if (a.done[i] != 0)
        samples += size(piece_of(a.part, i).samples);
    const Range rows = piece_of(a.part, b).rows;
    if (samples > 0)
      mean_light(a.sums.data() + first_sum(a, rows.begin), samples, image, rows);
  }
  return image;
}

void mean_light(const std::int64_t* sums, int samples, Image& image, const Range& rows) {
  const double share = 1 / (kLightUnit * samples);
  float* const out = image.row(rows.begin);
  const std::size_t n = sum_count(rows, image.width);
  for (std::size_t i = 0; i < n; ++i)
    out[i] = static_cast<float>(static_cast<double>(sums[i]) * share);
}

}  // namespace grelha
