#include "kernel/picture/refiner.hpp"
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>

#include <omp.h>

#include "kernel/picture/pixel_errors.hpp"
#include "kernel/picture/pixel_order.hpp"
#include "kernel/render/setup.hpp"
#include "kernel/picture/told.hpp"
#include "kernel/render/workspace.hpp"
#include "kernel/grid/world_impl.hpp"

namespace grelha {
namespace {

/// work handed to a thread at a time: at most so much
constexpr int kRunsOfChunk = 256, kSamplesOfChunk = 4096;
constexpr int kBouncesWatched = 2;  ///< mirrors
/// the bar falls by this a round: two or three rounds double all samples
constexpr float kStep = .5f;

struct Chunk {
  std::size_t begin, end;  ///< of the pixels wanted
  /// sums of squared differences, of halves of everything and of halves of the new half
  double fall = 0, level = 0;
};

/// Goes on with a Refinement.
class Refiner {
 public:
  Refiner(const World::Impl& world,
          const Setup& setup,
          const RenderOptions& options,
          Refinement& r,
          RenderStats& stats)
      : world_(world),
        frame_(setup.frame),
        variant_(setup.variant),
        options_(options),
        r_(r),
        stats_(stats),
        seconds_before_(r.seconds),
        first_log_(has_effects(setup.plan) ? 3 : 2),
        order_(pixel_order(r.width, r.height)),
        errors_(r, has_effects(setup.plan), first_log_, thread_count(options, r.log.size())) {
    stats_ = {};
    stats_.threads = thread_count(options, r.log.size());
    stats_.isa = variant_.name.data();
    for (int i = 0; i < stats_.threads; ++i)
      spaces_.push_back(std::make_unique<Workspace>(std::size_t{kRunsOfChunk} * kParts,
                                                    options.depth,
                                                    setup.plan,
                                                    loops_of(variant_, options.precision)));
    for (std::size_t p = 0; p < order_.size(); ++p)
      taken_ += sample_count(r, p);
  }

  void run(const std::function<bool()>& rest) {
    if (r_.wanted.empty() && !r_.finished)
      r_.wanted = order_;
    bool judged = false;
    while (!r_.finished && (!stopped_ || goes_on(rest))) {
      judged = take_round();
      if (!judged)
        continue;
      if (r_.rounds++ == 0)
        watch();
      errors_.judge();
      r_.finished = !choose_round();
    }
    if (!judged)
      errors_.judge();
    if (r_.finished)
      r_.share = 1;
    r_.seconds = seconds();
    for (const auto& space : spaces_)
      stats_.phases += space->phases();
  }

  /// Of the picture as it is.
  void tell(SampleMaps* maps) const {
    const PixelErrors::Totals totals = errors_.totals();
    ErrorStats& e = stats_.error;
    e.rmse = totals.rmse;
    e.rmse_bound = totals.bound;
    e.widest = totals.widest;
    e.rounds = r_.rounds;
    e.samples = taken_;
    e.least = kMostSamples;
    for (std::size_t p = 0; p < order_.size(); ++p) {
      e.least = std::min(e.least, sample_count(r_, p));
      e.most = std::max(e.most, sample_count(r_, p));
    }
    if (!maps)
      return;
    maps->samples.resize(order_.size());
    maps->error.resize(order_.size());
    maps->width = errors_.widths();
    for (std::size_t p = 0; p < order_.size(); ++p) {
      maps->samples[p] = sample_count(r_, p);
      maps->error[p] = std::sqrt(errors_.variance(p));
    }
  }

 private:
  bool goes_on(const std::function<bool()>& rest) {
    r_.seconds = seconds();
    stopped_ = !rest || !rest();
    return !stopped_;
  }

  static bool has_effects(const SamplePlan& plan) {
    return plan.lens >= 0 || plan.light >= 0 || plan.gloss >= 0;
  }

  /// Wants the pixels of the next round; whether there is one.
  bool choose_round() {
    if (r_.last)
      return false;
    const RefineOptions& o = options_.refine;
    const PixelErrors::Totals totals = errors_.totals();
    const bool met = o.error > 0 && totals.bound <= o.error;
    // the bound may rise at first
    if (o.error > 0)
      r_.share = met ? 1 : std::max(r_.share, o.error / totals.bound);
    if (o.samples > 0)
      r_.share = std::min(1.0, static_cast<double>(taken_) / static_cast<double>(o.samples));
    if (met) {
      want([&](std::size_t p) { return errors_.widths()[p] > 8 * o.error; });
    } else {
      do {
        r_.bar *= kStep;
        want([&](std::size_t p) { return errors_.gain(p) > r_.bar; });
      } while (r_.wanted.empty() && r_.bar >= 1e-20f);
    }
    if (o.error > 0 && !met) {  // no more of the round than the error takes
      const double excess = totals.sum * (1 - o.error * o.error / (totals.bound * totals.bound));
      double fall = 0;
      keep_best([&](std::size_t p) {
        return fall < excess ? (fall += errors_.variance(p) * (1 - r_.rho), true) : false;
      });
    } else if (o.seconds > 0 || o.samples > 0) {  // the round that would not fit is the last
      const double a_ray = seconds() / static_cast<double>(r_.rays);
      double left = o.seconds > 0 ? o.seconds - seconds()
                                  : static_cast<double>(o.samples) - static_cast<double>(taken_);
      r_.last = keep_best([&](std::size_t p) {
        return (left -= next_count(p) * (o.seconds > 0 ? r_.cost[p] * a_ray : 1)) >= 0;
      });
    }
    return !r_.wanted.empty();
  }

  template <class Test>
  void want(const Test& test) {
    r_.wanted.clear();
    for (const std::uint32_t p : order_)
      if (r_.log[p] < kMostLog && test(p))
        r_.wanted.push_back(p);
  }

  /// Goes through the wanted pixels by falling gain while `take` says yes; the others are wanted no
  /// more. Whether there were any.
  template <class Take>
  bool keep_best(const Take& take) {
    rank_.resize(r_.wanted.size());
    for (std::size_t i = 0; i < rank_.size(); ++i)
      rank_[i] = {errors_.gain(r_.wanted[i]), static_cast<std::uint32_t>(i)};
    std::sort(rank_.begin(), rank_.end(), [](const Rank& a, const Rank& b) {
      return a.gain != b.gain ? a.gain > b.gain : a.place < b.place;
    });
    std::size_t kept = 0;
    while (kept < rank_.size() && take(r_.wanted[rank_[kept].place]))
      ++kept;
    if (kept == rank_.size())
      return false;
    rank_.resize(kept);
    std::sort(
        rank_.begin(), rank_.end(), [](const Rank& a, const Rank& b) { return a.place < b.place; });
    for (std::size_t i = 0; i < kept; ++i)
      r_.wanted[i] = r_.wanted[rank_[i].place];
    r_.wanted.resize(kept);
    return true;
  }

  std::uint32_t next_count(std::uint32_t p) const {
    return 1u << (r_.log[p] == 0 ? first_log_ : r_.log[p]);
  }
  double seconds() const {
    return seconds_before_ + std::chrono::duration<double>(Clock::now() - start_).count();
  }

  /// Cut anywhere between two of them, the rest of a round is cut into the same chunks as in one
  /// go: what a sample costs is known by chunk.
  std::vector<Chunk> cut_round() const {
    std::vector<Chunk> chunks;
    std::uint64_t in_chunk = 0;
    for (std::size_t i = 0; i < r_.wanted.size(); ++i) {
      const std::uint32_t n = next_count(r_.wanted[i]);
      if (chunks.empty() || chunks.back().end - chunks.back().begin == kRunsOfChunk ||
          in_chunk + n > kSamplesOfChunk) {
        chunks.push_back({i, i});
        in_chunk = 0;
      }
      ++chunks.back().end, in_chunk += n;
    }
    return chunks;
  }

  /// Doubles the samples of the wanted pixels (or takes the first ones). Whether it came to the
  /// end: else what is left stays wanted.
  bool take_round() {
    std::vector<Chunk> chunks = cut_round();
    std::atomic<std::size_t> begun = 0;
#pragma omp parallel num_threads(stats_.threads)
    {
      Workspace& space = *spaces_[static_cast<std::size_t>(omp_get_thread_num())];
      TraceCounts trace;
      RayCounts rays;
      while (!stopped_) {
        // what has a number is done, so that what is done is the first so many
        const std::size_t c = begun++;
        if (c >= chunks.size())
          break;
        take_chunk(chunks[c], space, trace, rays);
        if (options_.progress)
          tell_progress();
      }
#pragma omp critical(grelha_stats)
      stats_.trace += trace, stats_.rays += rays, r_.rays += rays.total(), taken_ += rays.primary;
    }
    const std::size_t done = std::min(begun.load(), chunks.size());
    for (std::size_t c = 0; c < done; ++c) {
      r_.round_fall += chunks[c].fall;
      r_.round_level += chunks[c].level;
    }
    if (done < chunks.size()) {
      r_.wanted.erase(r_.wanted.begin(),
                      r_.wanted.begin() + static_cast<std::ptrdiff_t>(chunks[done].begin));
      return false;
    }
    r_.wanted.clear();
    r_.fall = .5 * r_.fall + r_.round_fall;
    r_.level = .5 * r_.level + r_.round_level;
    r_.round_fall = r_.round_level = 0;
    if (r_.level > 0)
      r_.rho = static_cast<float>(std::clamp(r_.fall / r_.level, .1, .6));
    return true;
  }

  void tell_progress() {
#pragma omp critical(grelha_progress)
    {
      if (options_.refine.seconds > 0)
        r_.share = std::min(1.0, seconds() / options_.refine.seconds);
      if (!stopped_ && !options_.progress(r_.share))
        stopped_ = true;
    }
  }

  void take_chunk(Chunk& chunk, Workspace& space, TraceCounts& trace, RayCounts& rays) {
    PixelRun runs[kRunsOfChunk];
    const std::size_t count = chunk.end - chunk.begin;
    for (std::size_t r = 0; r < count; ++r) {
      const std::uint32_t p = r_.wanted[chunk.begin + r];
      runs[r] = {p, sample_count(r_, p), next_count(p)};
      std::fill_n(space.pixels().begin() + static_cast<std::ptrdiff_t>(r * kParts), kParts, p);
    }
    const RayCounts before = rays;
    variant_.loops.render_runs(world_.view,
                               world_.shading,
                               frame_,
                               runs,
                               static_cast<int>(count),
                               space.work(options_, 0, true),
                               trace,
                               rays);
    for (std::size_t r = 0; r < count; ++r)
      add_run(runs[r], space.sums().data() + r * kParts * 3, chunk);
    space.done(options_);
    const float cost = static_cast<float>(rays.total() - before.total()) /
                       static_cast<float>(rays.primary - before.primary);
    for (std::size_t r = 0; r < count; ++r)
      r_.cost[runs[r].pixel] = cost;
  }

  void add_run(const PixelRun& run, const std::int64_t* sums, Chunk& chunk) {
    const std::size_t p = run.pixel;
    const bool first = run.first == 0;
    const double part = kParts / (kLightUnit * run.count);
    for (std::size_t c = 0; c < 3; ++c) {
      double m[kParts];
      std::int64_t all = 0;
      for (std::size_t k = 0; k < kParts; ++k) {
        m[k] = static_cast<double>(sums[k * 3 + c]) * part;
        all += sums[k * 3 + c];
      }
      const double a = .5 * (m[0] + m[1]), b = .5 * (m[2] + m[3]);
      const auto squared = [](double x) { return static_cast<float>(x * x); };
      const float halves = squared(a - b), quarters = squared(m[0] - m[1]) + squared(m[2] - m[3]);
      const std::size_t i = p * 3 + c;
      if (first) {
        r_.squares[0][i] = halves;
        r_.squares[1][i] = quarters;
        chunk.fall += halves;
        chunk.level += .5 * static_cast<double>(quarters);
      } else {
        r_.squares[2][i] = r_.squares[1][i] + quarters;
        r_.squares[1][i] = r_.squares[0][i] + halves;
        r_.squares[0][i] =
            squared(static_cast<double>(r_.sums[i]) / (kLightUnit * run.count) - .5 * (a + b));
        chunk.fall += static_cast<double>(r_.squares[0][i]);
        chunk.level += static_cast<double>(halves);
      }
      r_.sums[i] += all;
    }
    r_.log[p] = static_cast<std::uint8_t>(first ? first_log_ : r_.log[p] + 1);
  }

  /// Asks of every pixel whose samples agree whether anything can hide there.
  void watch() {
    const int columns = (r_.width + 7) / 8, rows = (r_.height + 7) / 8;
#pragma omp parallel num_threads(stats_.threads)
    {
      TraceCounts trace;
#pragma omp for schedule(dynamic, 4)
      for (int tile = 0; tile < columns * rows; ++tile)
        watch_tile(tile % columns * 8, tile / columns * 8, trace);
#pragma omp critical(grelha_stats)
      stats_.trace += trace;
    }
  }

  void watch_tile(int x0, int y0, TraceCounts& trace) {
    std::uint64_t agree = 0;
    for (int i = 0; i < kTile * kTile; ++i) {
      const int x = x0 + i % kTile, y = y0 + i / kTile;
      if (x < r_.width && y < r_.height && errors_.agrees(at(x, y)))
        agree |= std::uint64_t{1} << i;
    }
    if (agree == 0)
      return;
    float inside[kTile * kTile], around[kTile * kTile];
    variant_.loops.doubt(
        world_.view, world_.shading, frame_, x0, y0, kBouncesWatched, agree, inside, around, trace);
    for (int i = 0; i < kTile * kTile; ++i) {
      // what varies was met; should it agree later, its neighbours tell
      if (!(agree >> i & 1))
        continue;
      const std::size_t p = at(x0 + i % kTile, y0 + i / kTile);
      r_.inside[p] = inside[i];
      r_.around[p] = around[i];
    }
  }

  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(r_.width) +
           static_cast<std::size_t>(x);
  }

  using Clock = std::chrono::steady_clock;
  const Clock::time_point start_ = Clock::now();
  const World::Impl& world_;
  const FrameView& frame_;
  const Variant& variant_;
  const RenderOptions& options_;
  Refinement& r_;
  RenderStats& stats_;
  const double seconds_before_;
  const int first_log_;
  const std::vector<std::uint32_t> order_;
  std::uint64_t taken_ = 0;  ///< samples, of all pixels
  struct Rank {
    float gain;
    std::uint32_t place;
  };
  std::vector<Rank> rank_;
  PixelErrors errors_;
  std::vector<std::unique_ptr<Workspace>> spaces_;
  std::atomic<bool> stopped_ = false;
};

}  // namespace

bool refine(const World& world,
            const Camera& camera,
            const RenderOptions& given,
            Refinement& r,
            RenderStats& stats,
            SampleMaps* maps,
            const std::function<bool()>& rest) {
  const Told told(given);
  const RenderOptions& options = told.options();
  Setup setup = set_up(world, camera, options);
  if (!options.refine.on())
    throw std::invalid_argument("this picture is one whose samples are spent by error");
  if (r.width != camera.width || r.height != camera.height)
    throw std::invalid_argument("this picture has another size than the camera's");
  setup.plan.on = true;
  setup.plan.samples = kMostSamples;
  Refiner refiner(world.impl(), setup, options, r, stats);
  refiner.run([&] { return !told.threw() && rest && rest(); });
  told.rethrow();
  refiner.tell(maps);
  return r.finished;
}

}  // namespace grelha
