#pragma once
// What one thread works in; allocated before the first ray, never grown.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "grelha/render_options.hpp"
#include "kernel/scene/shading_view.hpp"
#include "kernel/query/variants.hpp"

namespace grelha {

/// Where one thread's time goes. It looks at the clock some ten times a batch of 512 rays and their
/// shadow rays.
class PhaseClock : public Observer {
 public:
  PhaseClock()
      : Observer{[](Observer& o, Phase next, const ObservedRays*) {
          static_cast<PhaseClock&>(o).go_on(next);
        }} {}
  void start(Phase first) {
    since_ = Clock::now();
    phase_ = first;
  }
  void go_on(Phase next) {
    const Clock::time_point now = Clock::now();
    seconds_[static_cast<std::size_t>(phase_)] +=
        std::chrono::duration<double>(now - since_).count();
    since_ = now;
    phase_ = next;
  }
  const PhaseSeconds& seconds() const { return seconds_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point since_;
  Phase phase_ = Phase::sums;
  PhaseSeconds seconds_;
};

/// What traces for this copy's shading: null when that does.
inline const TraceLoops* loops_of(const Variant& v, Precision p) {
  return p == Precision::kDouble ? &v.in_double.trace : nullptr;
}

class Workspace {
 public:
  /// `sums`: how many sums of light it holds.
  Workspace(std::size_t sums, int depth, const SamplePlan& plan, const TraceLoops* in_double)
      : batch_(std::make_unique<Batch>()),
        plan_(plan),
        in_double_(in_double),
        take_(take_of(depth, plan.gloss_rays)),
        capacity_(capacity_of(depth, plan.gloss_rays)),
        floats_(static_cast<std::size_t>(capacity_) * kStackFloats),
        words_(static_cast<std::size_t>(capacity_) * kStackWords),
        sums_(sums * 3),
        pixels_(sums) {}

  /// What one takes.
  static std::uint64_t bytes(std::size_t sums, int depth, int gloss_rays) {
    constexpr std::uint64_t ray =
        kStackFloats * sizeof(float) + kStackWords * sizeof(std::uint32_t);
    constexpr std::uint64_t sum = 3 * sizeof(std::int64_t) + sizeof(std::uint32_t);
    return sizeof(Batch) + ray * static_cast<std::uint64_t>(capacity_of(depth, gloss_rays)) +
           sum * sums;
  }

  /// Empty sums, of pixels first_pixel, first_pixel + 1, ... or, when `named`, of those that
  /// pixels() is filled with.
  BandWork work(const RenderOptions& options, std::uint32_t first_pixel, bool named = false) {
    if (options.phases)
      clock_.start(Phase::sums);
    std::fill(sums_.begin(), sums_.end(), 0);
    float* f[kStackFloats];
    for (std::size_t i = 0; i < kStackFloats; ++i)
      f[i] = floats_.data() + i * static_cast<std::size_t>(capacity_);
    std::uint32_t* w[kStackWords];
    for (std::size_t i = 0; i < kStackWords; ++i)
      w[i] = words_.data() + i * static_cast<std::size_t>(capacity_);
    const RayStack stack{f[0],
                         f[1],
                         f[2],
                         f[3],
                         f[4],
                         f[5],
                         f[6],
                         f[7],
                         f[8],
                         f[9],
                         f[10],
                         f[11],
                         f[12],
                         w[0],
                         w[1],
                         w[2],
                         w[3],
                         0,
                         capacity_};
    const float most = std::min(1048576.f, kMostLight / static_cast<float>(plan_.samples));
    if (options.phases)
      clock_.go_on(Phase::camera);
    return {batch_.get(),
            stack,
            sums_.data(),
            options.depth,
            options.packet,
            static_cast<float>(options.min_weight),
            take_,
            options.mailbox,
            first_pixel,
            most,
            plan_,
            named ? pixels_.data() : nullptr,
            options.observer ? options.observer
            : options.phases ? &clock_
                             : nullptr,
            in_double_};
  }
  /// Call when the sums of a work() are used up.
  void done(const RenderOptions& options) {
    if (options.phases)
      clock_.go_on(Phase::sums);
  }
  const PhaseSeconds& phases() const { return clock_.seconds(); }
  const std::vector<std::int64_t>& sums() const { return sums_; }
  std::vector<std::uint32_t>& pixels() { return pixels_; }

 private:
  /// of a ray that waits, see RayStack
  static constexpr std::size_t kStackFloats = 13, kStackWords = 4;
  static int take_of(int depth, int gloss_rays) {
    return std::clamp(65536 / (depth * (gloss_rays + 1)), 16, kBatch);
  }
  static int capacity_of(int depth, int gloss_rays) {
    // the line: see kBatchRow
    return (gloss_rays + 2) * (kBatch + take_of(depth, gloss_rays) * depth) + kCacheLine;
  }

  std::unique_ptr<Batch> batch_;
  PhaseClock clock_;
  SamplePlan plan_;
  const TraceLoops* in_double_;
  int take_, capacity_;
  std::vector<float> floats_;
  std::vector<std::uint32_t> words_;
  std::vector<std::int64_t> sums_;
  std::vector<std::uint32_t> pixels_;
};

}  // namespace grelha
