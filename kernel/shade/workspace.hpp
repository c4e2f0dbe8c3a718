#pragma once
// Working memory of one thread; allocated before the first ray, never grown.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "grelha/render_options.hpp"
#include "kernel/base/pages.hpp"
#include "kernel/scene/shading_view.hpp"
#include "kernel/query/variants.hpp"

namespace grelha {

/// Measures how one thread spends its time. It reads the clock some ten times per batch of 512 rays
/// and their shadow rays.
class PhaseClock : public Observer {
 public:
  PhaseClock()
      : Observer{[](Observer& o, Phase next, const Rays*) {
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

class Workspace {
 public:
  /// `sums`: how many sums of light it holds.
  Workspace(std::size_t sums, int depth, const SamplePlan& plan)
      : batch_(std::make_unique<Batch>()),
        plan_(plan),
        take_(take_of(depth, plan.glossy_rays)),
        capacity_(capacity_of(depth, plan.glossy_rays)),
        sums_(array_to_fill<std::vector<std::int64_t>>(sums * 3)),
        pixels_(sums),
        boxes_(sums) {
    resize_to_fill(floats_, static_cast<std::size_t>(capacity_) * kStackFloats);
    resize_to_fill(words_, static_cast<std::size_t>(capacity_) * kStackWords);
  }

  /// Bytes of a workspace.
  static std::uint64_t bytes(std::size_t sums, int depth, int glossy_rays) {
    constexpr std::uint64_t ray =
        kStackFloats * sizeof(float) + kStackWords * sizeof(std::uint32_t);
    constexpr std::uint64_t sum = 3 * sizeof(std::int64_t) + 2 * sizeof(std::uint32_t);
    return sizeof(Batch) + ray * static_cast<std::uint64_t>(capacity_of(depth, glossy_rays)) +
           sum * sums;
  }

  /// Empty sums for pixels first_pixel, first_pixel + 1, ... or, if `named`, for the pixels that
  /// pixels() lists; if `boxed`, with the boxes that boxes() lists.
  StripWork work(const RenderOptions& options,
                 std::uint32_t first_pixel,
                 bool named = false,
                 bool boxed = false) {
    if (options.phases)
      clock_.start(Phase::sums);
    std::fill(sums_.begin(), sums_.end(), 0);
    if (options.phases)
      clock_.go_on(Phase::camera);
    return {
        .batch = batch_.get(),
        .stack = stack(),
        .sums = sums_.data(),
        .depth = options.depth,
        .packet = options.packet,
        .min_weight = static_cast<float>(options.min_weight),
        .take = take_,
        .mailbox = options.mailbox,
        .first_pixel = first_pixel,
        .most_light = std::min(kMostTerm, kMostLight / static_cast<float>(plan_.samples)),
        .plan = plan_,
        .pixels = named ? pixels_.data() : nullptr,
        .boxes = boxed ? boxes_.data() : nullptr,
        .observer = observer(options),
    };
  }
  /// Call when the sums of a work() are used up.
  void done(const RenderOptions& options) {
    if (options.phases)
      clock_.go_on(Phase::sums);
  }
  const PhaseSeconds& phases() const { return clock_.seconds(); }
  const std::vector<std::int64_t>& sums() const { return sums_; }
  std::vector<std::uint32_t>& pixels() { return pixels_; }
  std::vector<std::uint32_t>& boxes() { return boxes_; }

 private:
  /// of a ray that waits, see RayStack
  static constexpr std::size_t kStackFloats = 10;
  static constexpr std::size_t kStackWords = 4;
  static int take_of(int depth, int glossy_rays) {
    return std::clamp(65536 / (depth * (glossy_rays + 1)), 16, kBatch);
  }
  static int capacity_of(int depth, int glossy_rays) {
    // the line: see kBatchRow
    return (glossy_rays + 2) * (kBatch + take_of(depth, glossy_rays) * depth) + kCacheLine;
  }

  float* floats(std::size_t k) { return floats_.data() + k * static_cast<std::size_t>(capacity_); }
  Columns3 vectors(std::size_t k) { return {floats(k), floats(k + 1), floats(k + 2)}; }
  std::uint32_t* words(std::size_t k) {
    return words_.data() + k * static_cast<std::size_t>(capacity_);
  }

  /// An empty stack.
  RayStack stack() {
    return {
        .org = vectors(0),
        .dir = vectors(3),
        .weight = vectors(6),
        .share = floats(9),
        .pixel = words(0),
        .depth = words(1),
        .sample = words(2),
        .path = words(3),
        .size = 0,
        .capacity = capacity_,
    };
  }

  /// Returns the observer that hears of phases: the caller's, the clock or null.
  Observer* observer(const RenderOptions& options) {
    if (options.observer)
      return options.observer;
    return options.phases ? &clock_ : nullptr;
  }

  std::unique_ptr<Batch> batch_;
  PhaseClock clock_;
  SamplePlan plan_;
  int take_, capacity_;
  std::vector<float> floats_;
  std::vector<std::uint32_t> words_;
  std::vector<std::int64_t> sums_;
  std::vector<std::uint32_t> pixels_;
  std::vector<std::uint32_t> boxes_;
};

}  // namespace grelha
