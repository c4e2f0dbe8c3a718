#include "kernel/picture/adaptive_sampler.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>

#include <omp.h>

#include "kernel/world/world_impl.hpp"
#include "kernel/picture/target_rays.hpp"
#include "kernel/picture/sampling_round.hpp"
#include "kernel/picture/block_errors.hpp"
#include "kernel/picture/tolerances.hpp"
#include "kernel/shade/strips.hpp"
#include "kernel/shade/workspace.hpp"
#include "kernel/base/pages.hpp"

namespace grelha {
namespace {

using Spaces = std::vector<std::unique_ptr<Workspace>>;

/// A workspace a thread, for a chunk of runs.
Spaces run_spaces(const Setup& setup, const RenderOptions& options, int threads) {
  const std::size_t sums = std::size_t{kBlocksOfChunk} * kBlockPixels * kParts;
  Spaces spaces;
  for (int i = 0; i < threads; ++i)
    spaces.push_back(std::make_unique<Workspace>(sums, options.depth, setup.plan));
  return spaces;
}

/// Goes on with a Refinement: round by round.
class AdaptiveSampler {
 public:
  AdaptiveSampler(const World::Impl& world,
                  Setup& setup,
                  const RenderOptions& options,
                  GuardedProgress& progress,
                  Refinement& r,
                  RenderStats& stats)
      : world_(world),
        setup_(setup),
        options_(options),
        progress_(progress),
        r_(r),
        stats_(stats),
        seconds_before_(r.seconds),
        blocks_(r.blocks()),
        order_(blocks_.by_tiles()),
        samples_(total_samples(r)),
        errors_(r, thread_count(options, r.log.size())),
        spaces_(run_spaces(setup, options, thread_count(options, r.log.size()))) {
    stats_ = {};
    stats_.threads = thread_count(options, r.log.size());
    stats_.isa = setup.variant.name.data();
  }

  void run() {
    reserve_to_fill(r_.wanted, order_.size());
    if (r_.wanted.empty() && !r_.finished)
      r_.wanted = order_;
    errors_.estimate();
    while (!r_.finished && (!progress_.stopped() || resume())) {
      if (!take_round())
        continue;
      if (r_.rounds++ == 0)
        trace_targets();
      errors_.estimate();
      if (options_.refine.error > 0 && is_check_due()) {
        check();
        errors_.estimate();
      }
      r_.finished = !choose_round(r_, errors_, options_.refine, order_, {samples_, seconds()});
    }
    if (r_.finished)
      r_.share = 1;
    r_.seconds = seconds();
    for (const auto& space : spaces_)
      stats_.phases += space->phases();
  }

  /// Describes the picture as it is.
  void report(SampleMaps* maps) const {
    const BlockErrors::Totals totals = errors_.totals();
    ErrorStats& e = stats_.error;
    e.rmse = totals.rmse;
    e.rmse_bound = stated(totals.bound);
    e.met = options_.refine.error > 0 && totals.judged(r_.checks > 0) <= options_.refine.error;
    e.checks = r_.checks;
    e.check_samples = r_.check_samples;
    e.rounds = r_.rounds;
    e.samples = samples_;
    e.least = kMostSamples;
    for (std::size_t b = 0; b < blocks_.count(); ++b) {
      e.least = std::min(e.least, sample_count(r_, b));
      e.most = std::max(e.most, sample_count(r_, b));
    }
    if (maps)
      fill(*maps);
  }

 private:
  /// Targets objects that samples may miss, unless all such objects together could not matter.
  void trace_targets() {
    const double error = options_.refine.error, pixels = static_cast<double>(r_.box.size());
    if (std::min(static_cast<double>(object_count(world_)), pixels) <= error * error * pixels)
      return;
    target_small_objects(world_, setup_, stats_.threads, r_, stats_.trace);
  }

  /// The bound as reported to the caller. Runs stop where their bound happens to be low; the error
  /// asked for is met all the same.
  double stated(double bound) const {
    return std::min(kBoundedLow * bound, std::max(bound, options_.refine.error));
  }

  void fill(SampleMaps& maps) const {
    maps.samples.resize(static_cast<std::size_t>(r_.width) * static_cast<std::size_t>(r_.height));
    maps.error.resize(maps.samples.size());
    for (std::size_t b = 0; b < blocks_.count(); ++b)
      blocks_.each_pixel(b, [&](std::size_t p) {
        maps.samples[p] = sample_count(r_, b);
        maps.error[p] = std::sqrt(errors_.variance(b));
      });
  }

  /// True when the error asked for seems to be met, and no check says so that is recent.
  bool is_check_due() const {
    const bool recent = r_.checks > 0 && static_cast<double>(samples_) <
                                             kCheckGrowth * static_cast<double>(r_.checked_at);
    return r_.checks < kMaxChecks && !recent &&
           errors_.totals().judged(r_.checks > 0) <= options_.refine.error;
  }

  /// Checks the picture's error. Sums of earlier checks count for half.
  void check() {
    const RayCounts before = stats_.rays;
    r_.checked = .5 * r_.checked + check_error(world_, setup_, options_, errors_, r_, stats_);
    ++r_.checks;
    r_.checked_at = samples_;
    r_.rays += stats_.rays.total() - before.total();
    r_.check_samples += stats_.rays.primary - before.primary;
  }

  bool resume() {
    r_.seconds = seconds();
    return progress_.resume();
  }

  double seconds() const {
    return seconds_before_ + std::chrono::duration<double>(Clock::now() - start_).count();
  }

  /// Doubles the samples of the wanted blocks, or takes the first ones. Returns whether it came to
  /// the end.
  bool take_round() {
    std::vector<Chunk> chunks = cut_round(r_);
    std::atomic<std::size_t> begun = 0;
#pragma omp parallel num_threads(stats_.threads)
    {
      Workspace& space = *spaces_[static_cast<std::size_t>(omp_get_thread_num())];
      TraceCounts trace;
      RayCounts rays;
      while (!progress_.stopped()) {
        // a numbered chunk is always finished, so the finished chunks are the first so many
        const std::size_t c = begun++;
        if (c >= chunks.size())
          break;
        take_chunk(chunks[c], space, trace, rays);
        report_progress();
      }
      collect(trace, rays);
    }
    return end_round(r_, chunks, std::min(begun.load(), chunks.size()));
  }

  /// Adds what one thread has counted.
  void collect(const TraceCounts& trace, const RayCounts& rays) {
#pragma omp critical(grelha_stats)
    {
      stats_.trace += trace;
      stats_.rays += rays;
      r_.rays += rays.total();
      samples_ += rays.primary;
    }
  }

  void report_progress() {
#pragma omp critical(grelha_progress)
    {
      if (options_.refine.seconds > 0)
        r_.share = std::min(1.0, seconds() / options_.refine.seconds);
      if (!progress_.stopped())
        progress_.report(r_.share);
    }
  }

  /// The next samples of each pixel of a chunk; the space gets their names and boxes, sum by sum.
  int runs_of(const Chunk& chunk, PixelRun* runs, Workspace& space) const {
    int count = 0;
    for (std::size_t w = chunk.begin; w < chunk.end; ++w) {
      const std::uint32_t b = r_.wanted[w];
      blocks_.each_pixel(b, [&](std::size_t p) {
        const auto pixel = static_cast<std::uint32_t>(p);
        name_sums(count, pixel, space);
        runs[count++] = {pixel, sample_count(r_, b), next_count(r_, b)};
      });
    }
    return count;
  }

  /// Names the pixel and box that the sums of a run are of.
  void name_sums(int run, std::uint32_t pixel, Workspace& space) const {
    const auto sum = static_cast<std::ptrdiff_t>(run) * kParts;
    std::fill_n(space.pixels().begin() + sum, kParts, pixel);
    std::fill_n(space.boxes().begin() + sum, kParts, r_.box[pixel]);
  }

  void take_chunk(Chunk& chunk, Workspace& space, TraceCounts& trace, RayCounts& rays) {
    PixelRun runs[kBlocksOfChunk * kBlockPixels];
    const int count = runs_of(chunk, runs, space);
    const RayCounts before = rays;
    const StripWork work = space.work(options_, 0, true, r_.rounds > 0);
    setup_.variant.loops.render_runs(
        world_.view, setup_.shading, setup_.frame, runs, count, work, trace, rays);
    const std::int64_t* const sums = space.sums().data();
    for (int r = 0; r < count; ++r)
      add_run(r_, runs[r], sums + r * kParts * 3, chunk);
    space.done(options_);
    const float cost = static_cast<float>(rays.total() - before.total()) /
                       static_cast<float>(rays.primary - before.primary);
    for (std::size_t w = chunk.begin; w < chunk.end; ++w) {
      const std::uint32_t b = r_.wanted[w];
      r_.cost[b] = cost;
      r_.missed[b] = 0;
      r_.log[b] = static_cast<std::uint8_t>(r_.log[b] == 0 ? kFirstLog : r_.log[b] + 1);
    }
  }

  using Clock = std::chrono::steady_clock;
  const Clock::time_point start_ = Clock::now();
  const World::Impl& world_;
  Setup& setup_;
  const RenderOptions& options_;
  GuardedProgress& progress_;
  Refinement& r_;
  RenderStats& stats_;
  const double seconds_before_;
  const Blocks blocks_;
  const std::vector<std::uint32_t> order_;
  std::uint64_t samples_;  ///< taken, of all pixels
  BlockErrors errors_;
  const Spaces spaces_;
};

}  // namespace

bool refine(const World& world,
            const Camera& camera,
            const RenderOptions& options,
            Refinement& r,
            RenderStats& stats,
            SampleMaps* maps,
            const ShouldContinue& should_continue) {
  Setup setup = set_up(world, camera, options);
  if (!options.refine.on())
    throw std::invalid_argument("this picture is one whose samples are spent by error");
  if (r.width != camera.width || r.height != camera.height)
    throw std::invalid_argument("this picture has another size than the camera's");
  setup.plan.on = true;
  setup.plan.samples = kMostSamples;
  GuardedProgress progress(options.progress, should_continue);
  AdaptiveSampler sampler(world.impl(), setup, options, progress, r, stats);
  sampler.run();
  progress.rethrow();
  sampler.report(maps);
  return r.finished;
}

}  // namespace grelha
