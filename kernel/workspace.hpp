#pragma once
// What one thread works in; allocated before the first ray, never grown.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/render.hpp"
#include "kernel/shading_view.hpp"

namespace grelha {

class Workspace {
 public:
  /// `sums`: how many sums of light it holds.
  Workspace(std::size_t sums, int depth, const SamplePlan& plan)
      : batch_(std::make_unique<Batch>()),
        plan_(plan),
        take_(std::clamp(65536 / (depth * (plan.gloss_rays + 1)), 16, kBatch)),
        capacity_((plan.gloss_rays + 2) * (kBatch + take_ * depth) + kCacheLine),  // the line: see kBatchRow
        floats_(static_cast<std::size_t>(capacity_) * 9),
        words_(static_cast<std::size_t>(capacity_) * 4),
        sums_(sums * 3),
        pixels_(sums) {}

  /// Empty sums, of pixels first_pixel, first_pixel + 1, ... or, when `named`, of those that pixels() is filled with.
  BandWork work(const RenderOptions& options, std::uint32_t first_pixel, bool named = false) {
    std::fill(sums_.begin(), sums_.end(), 0);
    float* f[9];
    for (std::size_t i = 0; i < 9; ++i) f[i] = floats_.data() + i * static_cast<std::size_t>(capacity_);
    std::uint32_t* w[4];
    for (std::size_t i = 0; i < 4; ++i) w[i] = words_.data() + i * static_cast<std::size_t>(capacity_);
    const RayStack stack{f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8], w[0], w[1], w[2], w[3], 0, capacity_};
    const float most = std::min(1048576.f, kMostLight / static_cast<float>(plan_.samples));
    return {batch_.get(), stack, sums_.data(), options.depth, options.packet, take_, options.mailbox, first_pixel, most, plan_,
            named ? pixels_.data() : nullptr};
  }
  const std::vector<std::int64_t>& sums() const { return sums_; }
  std::vector<std::uint32_t>& pixels() { return pixels_; }

 private:
  std::unique_ptr<Batch> batch_;
  SamplePlan plan_;
  int take_, capacity_;
  std::vector<float> floats_;
  std::vector<std::uint32_t> words_;
  std::vector<std::int64_t> sums_;
  std::vector<std::uint32_t> pixels_;
};

}  // namespace grelha
