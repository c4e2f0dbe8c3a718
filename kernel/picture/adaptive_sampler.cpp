// Spends samples where they help most; refinement.hpp holds the state between runs.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>

#include <omp.h>

#include "kernel/world/world_impl.hpp"
#include "kernel/picture/sampling_round.hpp"
#include "kernel/picture/block_errors.hpp"
#include "kernel/picture/tolerances.hpp"
#include "kernel/shade/strips.hpp"
#include "kernel/shade/workspace.hpp"
#include "kernel/base/pages.hpp"

namespace grelha {
namespace {

/// Share that the first samples are taken to be before anything is known: half of a coarse
/// picture, less the finer the error.
constexpr double kFirstShare = .5, kErrorOfAll = 20;

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
    errors_.estimate();
    if (r_.wanted.empty() && !r_.finished)
      r_.finished = !plan();
    while (!r_.finished && (!progress_.stopped() || resume()))
      if (take_round()) {
        close();
        errors_.estimate();
        r_.finished = !plan();
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
    e.met = r_.finished && r_.limit == Limit::kError;
    e.ended = r_.finished ? r_.limit : Limit::kNone;
    e.checks = r_.checks;
    e.check_samples = r_.check_samples;
    e.rounds = r_.rounds;
    e.samples = samples_;
    e.least = kMostSamples;
    if (maps) {
      maps->samples.resize(r_.box.size());
      maps->error.resize(r_.box.size());
    }
    for (std::size_t b = 0; b < blocks_.count(); ++b) {
      const std::uint32_t samples = sample_count(r_, b);
      e.least = std::min(e.least, samples);
      e.most = std::max(e.most, samples);
      blocks_.each_pixel(b, [&](std::size_t p) {
        if (!maps)
          return;
        maps->samples[p] = samples;
        maps->error[p] = std::sqrt(errors_.variance(b));
      });
    }
  }

 private:
  /// Wants the blocks of what comes next: the first samples, a check, or a round. Returns false if
  /// nothing does.
  bool plan() {
    if (samples_ == 0) {
      r_.wanted = order_;
      return true;
    }
    const RefineOptions& asked = options_.refine;
    r_.seconds = seconds();
    const Spent spent{samples_, r_.seconds};
    return (is_check_due(r_, errors_, asked, samples_) &&
            plan_check(r_, errors_, asked, order_, spent, setup_.plan.seed)) ||
           plan_round(r_, errors_, asked, order_, spent);
  }

  /// Takes what a check or a round told.
  void close() {
    if (!r_.checking.empty())
      close_check(r_, samples_);
    else if (r_.rounds++ == 0)
      mark_small_objects(world_, setup_.frame, r_);
    close_round(r_);
  }

  /// The bound as reported to the caller. Runs stop where their bound happens to be low; the error
  /// asked for is met all the same.
  double stated(double bound) const {
    return std::min(kBoundedLow * bound, std::max(bound, options_.refine.error));
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
        const RayCounts before = rays;
        take_chunk(chunks[c], space, trace, rays);
        report_progress(rays.total() - before.total(), rays.primary - before.primary);
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
    }
  }

  /// Counts rays and samples that were taken, and tells how far the picture is.
  void report_progress(std::uint64_t rays, std::uint64_t samples) {
#pragma omp critical(grelha_progress)
    {
      r_.rays += rays;
      samples_ += samples;
      r_.share = std::max(r_.share, std::min(share_now(), kMostForecast));
      if (!progress_.stopped())
        progress_.report(r_.share);
    }
  }

  double share_now() const {
    const RefineOptions& asked = options_.refine;
    const double timed = asked.seconds > 0 ? seconds() / asked.seconds : 0;
    if (r_.forecast > 0)
      return std::max(timed, static_cast<double>(r_.rays) / r_.forecast);
    const auto first = static_cast<double>(r_.box.size() << kFirstLog);
    const double all = asked.error > 0 ? first / std::min(kFirstShare, asked.error * kErrorOfAll)
                                       : static_cast<double>(asked.samples);
    return std::max(timed, all > 0 ? static_cast<double>(samples_) / all : 0);
  }

  /// The next samples of each pixel of a chunk; the space gets their names and boxes, sum by sum.
  int runs_of(const Chunk& chunk, PixelRun* runs, Workspace& space) const {
    int count = 0;
    for (std::size_t w = chunk.begin; w < chunk.end; ++w) {
      const std::uint32_t b = r_.wanted[w];
      blocks_.each_pixel(b, [&](std::size_t p) {
        const auto pixel = static_cast<std::uint32_t>(p);
        std::uint32_t first = sample_count(r_, b);
        for (int k = doublings(r_, b); k > 0; --k) {
          const std::uint32_t more = first == 0 ? 1u << kFirstLog : first;
          name_sums(count, pixel, space);
          runs[count++] = {pixel, first, more};
          first += more;
        }
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
      r_.log[b] = r_.goal[b];
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
