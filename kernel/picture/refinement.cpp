#include "kernel/picture/refinement.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/picture/tolerances.hpp"

namespace grelha {
namespace {

bool all_from_0_on(const std::vector<float>& values) {
  return std::ranges::all_of(values, [](float v) { return v >= 0 && std::isfinite(v); });
}
template <class T>
bool lies(T value, T least, T most) {
  return value >= least && value <= most;  // NaN does not
}

/// True if blocks are there, each once: threads work on all blocks of a round at the same time.
template <class Blocks>
bool are_distinct(const Blocks& blocks, std::size_t count) {
  std::vector<bool> there(count);
  for (const std::uint32_t b : blocks) {
    if (b >= count || there[b])
      return false;
    there[b] = true;
  }
  return true;
}

bool is_new(const Refinement& r) {
  return r.rounds == 0 && std::ranges::count(r.log, 0) == std::ssize(r.log);
}

/// True if r.wanted lists blocks that can be doubled as often as their goals say, among them all
/// that have no samples.
bool is_round(const Refinement& r) {
  const auto can_take = [&](std::uint32_t b) {
    return r.log[b] == 0 ? r.goal[b] == kFirstLog
                         : r.goal[b] <= kMostLog && lies(r.goal[b] - r.log[b], 1, kMostDoublings);
  };
  const auto is_bare = [&](std::uint32_t b) { return r.log[b] == 0; };
  return are_distinct(r.wanted, r.log.size()) && std::ranges::all_of(r.wanted, can_take) &&
         (is_new(r) || std::ranges::count_if(r.wanted, is_bare) == std::ranges::count(r.log, 0));
}

/// True if the blocks of a check have samples, or nothing is checked.
bool is_check(const Refinement& r) {
  std::vector<std::uint32_t> blocks;
  for (const CheckedBlock& c : r.checking)
    blocks.push_back(c.block);
  return are_distinct(blocks, r.log.size()) &&
         std::ranges::all_of(r.checking, [&](const CheckedBlock& c) {
           return r.log[c.block] > 0 && lies(c.claim, 0.f, 1e30f) && lies(c.stands_for, 0.f, 1e9f);
         });
}

bool has_valid_numbers(const Refinement& r) {
  constexpr double kMost = 1e30;  // far from where sums and products of doubles end
  for (const double v : {r.variance_drop, r.variance_level, r.round_drop, r.round_level, r.seconds})
    if (!lies(v, 0.0, kMost))
      return false;
  const CheckSums& c = r.checked;
  for (const double v : {c.y, c.x, c.yy, c.xy, c.xx, c.ny, c.nyny, c.count})
    if (!lies(v, 0.0, kMost))
      return false;
  return lies(r.limit, Limit::kNone, Limit::kSeconds) && lies(r.variance_ratio, .1f, .6f) &&
         lies(r.share, 0.0, 1.0) && lies(r.forecast, 0.0, kMost) &&
         lies(r.repeats, 0, kMostRepeats) && lies(r.rounds, 0, 1 << 20) &&
         lies(r.checks, 0, 1 << 20);
}

std::size_t pixel_count(const Refinement& r) {
  return static_cast<std::size_t>(r.width) * static_cast<std::size_t>(r.height);
}

bool is_valid_sum(std::int64_t s) {
  constexpr std::int64_t kMost = std::int64_t{1} << 61;
  return lies(s, -kMost, kMost);
}

bool is_valid_log(std::uint8_t l) {
  return l == 0 || (l >= kFirstLog && l <= kMostLog);
}

bool has_valid_sizes(const Refinement& r) {
  const std::size_t pixels = pixel_count(r), blocks = r.blocks().count();
  for (const auto& level : r.squares)
    if (level.size() != pixels * 3)
      return false;
  return r.sums.size() == pixels * 3 && r.box.size() == pixels && r.log.size() == blocks &&
         r.goal.size() == blocks && r.missed.size() == blocks && r.cost.size() == blocks;
}

/// Its sides are in order; see packed().
bool is_valid_box(std::uint32_t box) {
  return (box & 255) <= (box >> 16 & 255) && (box >> 8 & 255) <= box >> 24;
}

bool has_valid_arrays(const Refinement& r) {
  if (!has_valid_sizes(r))
    return false;
  for (const auto& level : r.squares)
    if (!all_from_0_on(level))
      return false;
  return std::ranges::all_of(r.sums, is_valid_sum) && std::ranges::all_of(r.log, is_valid_log) &&
         std::ranges::all_of(r.box, is_valid_box) && all_from_0_on(r.missed) &&
         all_from_0_on(r.cost) && std::ranges::none_of(r.cost, [](float c) { return c < 1; });
}

/// True if what the picture was before is another of its size, between rounds.
bool is_before(const Refinement& r) {
  return r.before.empty() ||
         (r.before.size() == 1 && r.before[0].width == r.width && r.before[0].height == r.height &&
          r.before[0].before.empty() && r.before[0].wanted.empty() && is_valid(r.before[0]));
}

}  // namespace

double CheckSums::ratio() const {
  return x > 0 ? std::clamp(y / x, kLeastErrorRatio, kMaxErrorRatio) : 1;
}

Refinement make_refinement(const Camera& camera) {
  Refinement r;
  r.width = camera.width;
  r.height = camera.height;
  const std::size_t pixels = pixel_count(r), blocks = r.blocks().count();
  resize_to_fill(r.sums, pixels * 3);
  for (auto& level : r.squares)
    resize_to_fill(level, pixels * 3);
  resize_to_fill(r.box, pixels);
  resize_to_fill(r.missed, blocks);
  resize_to_fill(r.cost, blocks, 1.f);
  resize_to_fill(r.log, blocks);
  resize_to_fill(r.goal, blocks, std::uint8_t{kFirstLog});
  return r;
}

bool is_valid(const Refinement& r) {
  return r.width >= 1 && r.height >= 1 && has_valid_arrays(r) && has_valid_numbers(r) &&
         !(r.finished && !r.wanted.empty()) && is_round(r) && is_check(r) && is_before(r);
}

bool lift_limits(Refinement& r) {
  if (r.limited && r.before.empty())
    return false;
  if (r.limited) {
    Refinement before = std::move(r.before.front());
    r = std::move(before);
  }
  r.share = std::min(r.share, kMostForecast);
  r.finished = false;
  r.limit = Limit::kNone;
  return true;
}

std::uint64_t total_samples(const Refinement& r) {
  const Blocks blocks = r.blocks();
  std::uint64_t samples = 0;
  for (std::size_t b = 0; b < r.log.size(); ++b)
    samples += sample_count(r, b) * blocks.pixels(b);
  return samples;
}

Image picture_so_far(const Refinement& r) {
  Image image = image_to_fill(r.width, r.height);
  const Blocks blocks = r.blocks();
  for (std::size_t b = 0; b < r.log.size(); ++b)
    blocks.each_pixel(b, [&](std::size_t p) {
      for (std::size_t i = 3 * p; i < 3 * p + 3; ++i)
        image.rgb[i] = mean_so_far(r, i, 1u << r.log[b]);
    });
  return image;
}

}  // namespace grelha
