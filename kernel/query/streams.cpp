#include "kernel/query/streams.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <omp.h>
#include <stdexcept>
#include <string>
#include <utility>

#include "grelha/rays.hpp"
#include "kernel/world/world_impl.hpp"
#include "kernel/base/parallel_for.hpp"

namespace grelha {

void expect_arrays(const Rays& rays) {
  if (rays.count > std::size_t{PTRDIFF_MAX})
    throw std::invalid_argument("rays: expected a count that memory can hold, found " +
                                std::to_string(rays.count));
  if (rays.count == 0)
    return;
  for (int a = 0; a < 3; ++a)
    if (!rays.org[a] || !rays.dir[a])
      throw std::invalid_argument(std::string("rays: expected an array of ") + "xyz"[a] + " of " +
                                  (rays.org[a] ? "directions" : "origins") + ", found null");
}

void expect_masks(const World& world, std::span<const std::uint8_t> masks) {
  const std::size_t count = world.impl().primitives.ids.end();
  if (!masks.empty() && masks.size() != count)
    throw std::invalid_argument("masks: expected one for each of " + std::to_string(count) +
                                " primitives, found " + std::to_string(masks.size()));
}

namespace {
float element(const float* array, std::ptrdiff_t stride, std::size_t i, float instead) {
  return array ? array[static_cast<std::ptrdiff_t>(i) * stride] : instead;
}
const float* moved(const float* array, std::ptrdiff_t stride, std::size_t by) {
  return array ? array + static_cast<std::ptrdiff_t>(by) * stride : nullptr;
}
}  // namespace

Ray Rays::operator[](std::size_t i) const {
  const auto three = [i](const float* const(&of)[3], std::ptrdiff_t stride) {
    return Float3{
        element(of[0], stride, i, 0), element(of[1], stride, i, 0), element(of[2], stride, i, 0)};
  };
  return {three(org, org_stride),
          three(dir, dir_stride),
          element(t_min, t_stride, i, 0),
          element(t_max, t_stride, i, Ray{}.t_max)};
}

Rays Rays::part(std::size_t first, std::size_t end) const {
  Rays part = *this;
  for (int a = 0; a < 3; ++a) {
    part.org[a] = moved(org[a], org_stride, first);
    part.dir[a] = moved(dir[a], dir_stride, first);
  }
  part.t_min = moved(t_min, t_stride, first);
  part.t_max = moved(t_max, t_stride, first);
  part.skip = skip ? skip + first : nullptr;
  part.mask = mask ? mask + first : nullptr;
  part.count = end - first;
  return part;
}

Hits part_of(const Hits& hits, std::size_t first) {
  Hits part = hits;
  const auto by = static_cast<std::ptrdiff_t>(first);
  part.t = hits.t ? hits.t + by * hits.stride : nullptr;
  part.id = hits.id ? hits.id + by * hits.stride : nullptr;
  part.t_double = hits.t_double ? hits.t_double + first : nullptr;
  part.u = hits.u ? hits.u + first : nullptr;
  part.v = hits.v ? hits.v + first : nullptr;
  return part;
}

TraceOptions options_of(const QueryOptions& options) {
  const int packet = options.packet;
  if (packet != 1 && packet != 16 && packet != 64 && packet != 256)
    throw std::invalid_argument("a packet holds 1, 16, 64 or 256 rays");
  return {.packet = packet, .masks = options.mask.empty() ? nullptr : options.mask.data()};
}

namespace {

/// Floats, or words of four bytes, from one element of an array to the next.
template <class Element>
constexpr std::ptrdiff_t words_of() {
  static_assert(sizeof(Element) % sizeof(float) == 0);
  return sizeof(Element) / sizeof(float);
}

void expect_directions(std::size_t origins, std::size_t directions) {
  if (origins != directions)
    throw std::invalid_argument("rays: expected as many directions as origins, found " +
                                std::to_string(directions) + " and " + std::to_string(origins));
}

}  // namespace

Rays Rays::of(std::span<const Ray> rays) {
  static_assert(offsetof(Ray, dir) == 3 * sizeof(float) &&
                offsetof(Ray, t_min) == 6 * sizeof(float));
  static_assert(offsetof(Ray, t_max) == 7 * sizeof(float));
  constexpr std::ptrdiff_t kStride = words_of<Ray>();
  const auto* const p = reinterpret_cast<const float*>(rays.data());
  if (rays.empty())
    return {};
  return {.org = {p, p + 1, p + 2},
          .dir = {p + 3, p + 4, p + 5},
          .t_min = p + 6,
          .t_max = p + 7,
          .count = rays.size(),
          .org_stride = kStride,
          .dir_stride = kStride,
          .t_stride = kStride};
}

Rays Rays::of(std::span<const Float3> org, std::span<const Float3> dir) {
  expect_directions(org.size(), dir.size());
  constexpr std::ptrdiff_t kStride = words_of<Float3>();
  if (org.empty())
    return {};
  const auto* const o = reinterpret_cast<const float*>(org.data());
  const auto* const d = reinterpret_cast<const float*>(dir.data());
  return {.org = {o, o + 1, o + 2},
          .dir = {d, d + 1, d + 2},
          .count = org.size(),
          .org_stride = kStride,
          .dir_stride = kStride};
}

Hits Hits::of(std::span<Hit> hits) {
  static_assert(offsetof(Hit, t) == 0 && offsetof(Hit, id) == sizeof(float));
  if (hits.empty())
    return {};
  auto* const p = reinterpret_cast<char*>(hits.data());
  return {.t = reinterpret_cast<float*>(p),
          .id = reinterpret_cast<std::uint32_t*>(p + offsetof(Hit, id)),
          .stride = words_of<Hit>()};
}

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kOneThread = 4096;  ///< elements that are not worth a second thread
/// Runs get longer below the first, and shorter beyond the second.
constexpr std::chrono::milliseconds kShort{1};
constexpr std::chrono::milliseconds kLong{10};

int thread_count(int threads) {
  if (threads < 0)
    throw std::invalid_argument("threads: expected 0 or more, found " + std::to_string(threads));
  return threads > 0 ? threads : omp_get_num_procs();
}

/// Tells the caller how far the runs are, one thread at a time.
class RunProgress {
 public:
  RunProgress(std::size_t count, const std::function<bool(double)>& report)
      : count_(count), report_(report) {}

  void add(std::size_t elements) {
    if (!report_ || elements == 0)
      return;
    const std::lock_guard lock(mutex_);
    done_ += elements;
    if (!stopped_ && !report_(static_cast<double>(done_) / static_cast<double>(count_)))
      stopped_ = true;
  }
  bool stopped() const { return stopped_; }
  void throw_if_stopped() const {
    if (stopped_)
      throw Stopped();
  }

 private:
  std::size_t count_, done_ = 0;
  const std::function<bool(double)>& report_;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
};

/// How many elements a thread takes at once: the more, the faster they are.
class RunLength {
 public:
  explicit RunLength(RunLengths lengths) : length_(lengths.first), most_(lengths.most) {}

  std::size_t elements() const { return length_; }
  void took(Clock::duration time) {
    if (time < kShort)
      length_ = std::min(most_, 4 * length_);
    else if (time > kLong)
      length_ = std::max<std::size_t>(1, length_ / 4);
  }

 private:
  std::size_t length_, most_;
};

}  // namespace

void each_run(std::size_t count,
              const QueryOptions& options,
              const std::function<void(std::size_t first, std::size_t end)>& work,
              RunLengths lengths) {
  const int threads = thread_count(options.threads);
  if (!options.progress && (threads == 1 || count <= kOneThread)) {
    if (count > 0)
      work(0, count);
    return;
  }
  RunProgress progress(count, options.progress);
  std::atomic<std::size_t> next = 0;
  const auto take_runs = [&](std::size_t) {
    RunLength length(lengths);
    std::size_t unreported = 0;
    Clock::time_point began = Clock::now();
    Clock::time_point last_report = began;
    while (!progress.stopped()) {
      const std::size_t first = next.fetch_add(length.elements());
      if (first >= count)
        break;
      const std::size_t end = std::min(count, first + length.elements());
      work(first, end);
      unreported += end - first;
      const Clock::time_point now = Clock::now();
      length.took(now - began);
      began = now;
      if (now - last_report < kShort)
        continue;
      progress.add(std::exchange(unreported, 0));
      last_report = now;
    }
    progress.add(unreported);
  };
  const std::size_t useful = (count + kOneThread - 1) / kOneThread;
  const std::size_t workers = std::min(static_cast<std::size_t>(threads), useful);
  each_turn(workers, static_cast<int>(workers), take_runs);
  progress.throw_if_stopped();
}

void expect_same_size(std::size_t count, std::size_t answers, const char* things) {
  if (count != answers)
    throw std::invalid_argument("expected an answer for each of " + std::to_string(count) + ' ' +
                                things + ", found room for " + std::to_string(answers));
}

}  // namespace grelha
