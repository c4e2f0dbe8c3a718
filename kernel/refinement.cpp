#include "kernel/refinement.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include <omp.h>

#include "kernel/workspace.hpp"

namespace grelha {
namespace {

constexpr int kRunsOfChunk = 256, kSamplesOfChunk = 4096;  ///< work handed to a thread at a time: at most so much
constexpr int kMostLog = 16;                               ///< kMostSamples = 2^16
constexpr int kBouncesWatched = 2;                         ///< mirrors
constexpr float kStep = .5f;                               ///< the bar falls by this a round: two or three rounds double all samples
static_assert(1 << kMostLog == kMostSamples);

/// Differences a pixel holds after its first round, and later.
constexpr float kYoung = 3, kOld = 7;

/// One rate for the whole picture, and pixels that stop when their differences are small, leave estimates up to 15 % too low (measured:
/// docs/sampling.md); the bound allows for 12 %, its spread for the rest.
constexpr double kTrust = 1.12 * 1.12;
constexpr float kNormal = 1.96f;  ///< 97.5 % point: with what neighbours tell, Student's t is no wider

/// Pixels in the order their samples are taken: tile by tile of 8 x 8, along a Z in each, so that neighbours share packets.
std::vector<std::uint32_t> pixel_order(int width, int height) {
  std::vector<std::uint32_t> order;
  order.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int ty = 0; ty < height; ty += 8)
    for (int tx = 0; tx < width; tx += 8)
      for (int i = 0; i < 64; ++i) {
        const int x = tx + ((i & 1) | (i >> 1 & 2) | (i >> 2 & 4)), y = ty + ((i >> 1 & 1) | (i >> 2 & 2) | (i >> 3 & 4));
        if (x < width && y < height) order.push_back(static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(width) + static_cast<std::uint32_t>(x));
      }
  return order;
}

struct Chunk {
  std::size_t begin, end;     ///< of the round's list
  double fall = 0, level = 0; ///< sums of squared differences, of halves of everything and of halves of the new half
};

class Refinement {
 public:
  Refinement(const World::Impl& world, const Camera& camera, const FrameView& frame, const SamplePlan& plan, const Variant& variant,
             const RenderOptions& options, RenderStats& stats)
      : world_(world), camera_(camera), frame_(frame), variant_(variant), options_(options), stats_(stats),
        count_(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height)),
        effects_(plan.lens >= 0 || plan.light >= 0 || plan.gloss >= 0), first_log_(effects_ ? 3 : 2),
        order_(pixel_order(camera.width, camera.height)), sums_(count_ * 3), squares_{std::vector<float>(count_ * 3), std::vector<float>(count_ * 3), std::vector<float>(count_ * 3)},
        own_(count_), variance_(count_), widest_(count_), cost_(count_, 1), log_(count_, 0), inside_(count_, 0), around_(count_, 1) {
    wanted_.reserve(count_);
    const int threads = std::max(1, options.threads > 0 ? options.threads : omp_get_num_procs());
    for (int i = 0; i < threads; ++i)
      spaces_.push_back(std::make_unique<Workspace>(std::size_t{kRunsOfChunk} * kParts, options.depth, plan, loops_of(variant, options.precision)));
    stats_ = {};
    stats_.threads = threads;
    stats_.isa = variant.name.data();
  }

  Image run(SampleMaps* maps) {
    const RefineOptions& o = options_.refine;
    wanted_ = order_;
    take_round();
    watch();
    judge();
    float bar = .25f;
    int rounds = 1;
    for (bool last = false; !last && !stopped_;) {
      const Totals totals = sum_up();
      const bool met = o.error > 0 && totals.bound <= o.error;
      wanted_.clear();
      if (met) {
        want([&](std::size_t p) { return widest_[p] > 8 * o.error; });
      } else {
        bar *= kStep;
        want([&](std::size_t p) { return gain(p) > bar; });
      }
      if (wanted_.empty()) {
        last = met || bar < 1e-20f;
        continue;
      }
      if (o.error > 0 && !met) {  // no more of the round than the error takes
        const double excess = totals.sum * (1 - o.error * o.error / (totals.bound * totals.bound));
        double fall = 0;
        keep_best([&](std::size_t p) { return fall < excess ? (fall += variance_[p] * (1 - rho_), true) : false; });
      } else if (o.seconds > 0 || o.samples > 0) {  // the round that would not fit is the last
        const double a_ray = seconds() / static_cast<double>(stats_.rays.total());
        double left = o.seconds > 0 ? o.seconds - seconds() : static_cast<double>(o.samples) - static_cast<double>(stats_.rays.primary);
        last = keep_best([&](std::size_t p) { return (left -= next_count(p) * (o.seconds > 0 ? cost_[p] * a_ray : 1)) >= 0; });
        if (wanted_.empty()) break;
      }
      take_round();
      judge();
      ++rounds;
      report(totals);
    }
    sum_up();
    stats_.error.rounds = rounds;
    for (const auto& space : spaces_) stats_.phases += space->phases();
    return finish(maps);
  }

 private:
  struct Totals {
    double sum, bound;  ///< of the variances; of the RMSE
  };

  /// Goes through the wanted pixels by falling gain while `take` says yes; the others are wanted no more. Whether there were any.
  template <class Take>
  bool keep_best(const Take& take) {
    rank_.resize(wanted_.size());
    for (std::size_t i = 0; i < rank_.size(); ++i) rank_[i] = {gain(wanted_[i]), static_cast<std::uint32_t>(i)};
    std::sort(rank_.begin(), rank_.end(), [](const Rank& a, const Rank& b) { return a.gain != b.gain ? a.gain > b.gain : a.place < b.place; });
    std::size_t kept = 0;
    while (kept < rank_.size() && take(wanted_[rank_[kept].place])) ++kept;
    if (kept == rank_.size()) return false;
    rank_.resize(kept);
    std::sort(rank_.begin(), rank_.end(), [](const Rank& a, const Rank& b) { return a.place < b.place; });
    for (std::size_t i = 0; i < kept; ++i) wanted_[i] = wanted_[rank_[i].place];
    wanted_.resize(kept);
    return true;
  }

  float samples(std::size_t p) const { return static_cast<float>(1u << log_[p]); }
  float gain(std::size_t p) const { return log_[p] < kMostLog ? variance_[p] * (1 - rho_) / (samples(p) * cost_[p]) : 0; }
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  template <class Test>
  void want(const Test& test) {
    for (const std::uint32_t p : order_)
      if (log_[p] < kMostLog && test(p)) wanted_.push_back(p);
  }

  std::uint32_t next_count(std::uint32_t p) const { return 1u << (log_[p] == 0 ? first_log_ : log_[p]); }

  /// Doubles the samples of the wanted pixels (or takes the first ones).
  void take_round() {
    std::vector<Chunk> chunks;
    std::uint64_t in_chunk = 0;
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
      const std::uint32_t n = next_count(wanted_[i]);
      if (chunks.empty() || chunks.back().end - chunks.back().begin == kRunsOfChunk || in_chunk + n > kSamplesOfChunk) {
        chunks.push_back({i, i});
        in_chunk = 0;
      }
      ++chunks.back().end, in_chunk += n;
    }
#pragma omp parallel num_threads(stats_.threads)
    {
      Workspace& space = *spaces_[static_cast<std::size_t>(omp_get_thread_num())];
      TraceCounts trace;
      RayCounts rays;
#pragma omp for schedule(dynamic)
      for (std::size_t c = 0; c < chunks.size(); ++c) take_chunk(chunks[c], space, trace, rays);
#pragma omp critical(grelha_stats)
      stats_.trace += trace, stats_.rays += rays;
    }
    double fall = 0, level = 0;
    for (const Chunk& c : chunks) fall += c.fall, level += c.level;
    fall_ = .5 * fall_ + fall, level_ = .5 * level_ + level;
    if (level_ > 0) rho_ = static_cast<float>(std::clamp(fall_ / level_, .1, .6));
  }

  void take_chunk(Chunk& chunk, Workspace& space, TraceCounts& trace, RayCounts& rays) {
    PixelRun runs[kRunsOfChunk];
    const std::size_t count = chunk.end - chunk.begin;
    for (std::size_t r = 0; r < count; ++r) {
      const std::uint32_t p = wanted_[chunk.begin + r];
      runs[r] = {p, log_[p] == 0 ? 0u : 1u << log_[p], next_count(p)};
      std::fill_n(space.pixels().begin() + static_cast<std::ptrdiff_t>(r * kParts), kParts, p);
    }
    const RayCounts before = rays;
    variant_.loops.render_runs(world_.view, world_.shading, frame_, runs, static_cast<int>(count), space.work(options_, 0, true), trace, rays);
    for (std::size_t r = 0; r < count; ++r) add_run(runs[r], space.sums().data() + r * kParts * 3, chunk);
    space.done(options_);
    const float cost = static_cast<float>(rays.total() - before.total()) / static_cast<float>(rays.primary - before.primary);
    for (std::size_t r = 0; r < count; ++r) cost_[runs[r].pixel] = cost;
  }

  void add_run(const PixelRun& run, const std::int64_t* sums, Chunk& chunk) {
    const std::size_t p = run.pixel;
    const bool first = run.first == 0;
    const double part = kParts / (kLightUnit * run.count);
    for (std::size_t c = 0; c < 3; ++c) {
      double m[kParts];
      std::int64_t all = 0;
      for (std::size_t k = 0; k < kParts; ++k) m[k] = static_cast<double>(sums[k * 3 + c]) * part, all += sums[k * 3 + c];
      const double a = .5 * (m[0] + m[1]), b = .5 * (m[2] + m[3]);
      const auto squared = [](double x) { return static_cast<float>(x * x); };
      const float halves = squared(a - b), quarters = squared(m[0] - m[1]) + squared(m[2] - m[3]);
      const std::size_t i = p * 3 + c;
      if (first) {
        squares_[0][i] = halves, squares_[1][i] = quarters;
        chunk.fall += halves, chunk.level += .5 * static_cast<double>(quarters);
      } else {
        squares_[2][i] = squares_[1][i] + quarters;
        squares_[1][i] = squares_[0][i] + halves;
        squares_[0][i] = squared(static_cast<double>(sums_[i]) / (kLightUnit * run.count) - .5 * (a + b));
        chunk.fall += static_cast<double>(squares_[0][i]), chunk.level += static_cast<double>(halves);
      }
      sums_[i] += all;
    }
    log_[p] = static_cast<std::uint8_t>(first ? first_log_ : log_[p] + 1);
  }

  /// Asks of every pixel whose samples agree whether anything can hide there.
  void watch() {
    const int columns = (camera_.width + 7) / 8, rows = (camera_.height + 7) / 8;
#pragma omp parallel num_threads(stats_.threads)
    {
      TraceCounts trace;
#pragma omp for schedule(dynamic, 4)
      for (int tile = 0; tile < columns * rows; ++tile) {
        const int x0 = tile % columns * 8, y0 = tile / columns * 8;
        const int x1 = std::min(x0 + 8, camera_.width), y1 = std::min(y0 + 8, camera_.height);
        std::uint64_t agree = 0;
        const auto bit = [&](int x, int y) { return std::uint64_t{1} << ((y - y0) * kTile + (x - x0)); };
        for (int y = y0; y < y1; ++y)
          for (int x = x0; x < x1; ++x)
            if (agrees(own_variance(at(x, y)), at(x, y))) agree |= bit(x, y);
        if (agree == 0) continue;
        float inside[kTile * kTile], around[kTile * kTile];
        variant_.loops.doubt(world_.view, world_.shading, frame_, x0, y0, kBouncesWatched, agree, inside, around, trace);
        for (int y = y0; y < y1; ++y)
          for (int x = x0; x < x1; ++x) {
            if (!(agree & bit(x, y))) continue;  // what varies was met; should it agree later, its neighbours tell
            const std::size_t i = static_cast<std::size_t>((y - y0) * kTile + (x - x0));
            inside_[at(x, y)] = inside[i], around_[at(x, y)] = around[i];
          }
      }
#pragma omp critical(grelha_stats)
      stats_.trace += trace;
    }
  }

  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width) + static_cast<std::size_t>(x); }
  /// What none of n samples met covers at most 3 / n of the pixel, at 95 % confidence (the rule of three), on either side.
  float doubt_width(float doubt, std::size_t p) const { return 6 * doubt / samples(p); }
  bool watched(std::size_t p) const { return effects_ || inside_[p] > 0 || around_[p] > 0; }

  /// The greatest difference a channel of a pixel shows to one around it, on a screen.
  float contrast(int x, int y) const {
    const auto shown = [&](std::size_t i) { return std::clamp(mean(i), 0.f, 1.f); };
    float most = 0;
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, camera_.height - 1); ++j)
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, camera_.width - 1); ++i)
        for (std::size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(shown(at(i, j) * 3 + c) - shown(at(x, y) * 3 + c)));
    return most;
  }

  /// Whether no sample of a pixel differed: one of n that does so by .1 shows as a variance of .005 / n^2.
  bool agrees(float variance, std::size_t p) const { return variance <= .005f / (samples(p) * samples(p)); }

  /// Variance of a pixel, mean of its channels, from its own differences: of the three levels there are 1, 2 and 4.
  float own_variance(std::size_t p) const {
    float sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t i = p * 3 + c;
      const float fall = (squares_[0][i] + rho_ * (squares_[1][i] + rho_ * squares_[2][i])) / (4 * held(p));
      const float v = fall * rho_ / (1 - rho_);
      if (!(mean(i) - 3 * std::sqrt(v) > 1)) sum += v;  // else white on any screen
    }
    return sum / 3;
  }
  float held(std::size_t p) const { return log_[p] == first_log_ ? kYoung : kOld; }

  /// Variance and interval of every pixel. Few differences tell little: pixels that may hold more than one surface, or an effect,
  /// borrow from their neighbours of the same kind, so that chance stops no pixel and drives none on.
  void judge() {
    float scale[2 * kMostLog + 1];  // rho^(i - kMostLog)
    scale[kMostLog] = 1;
    for (int i = 0; i < kMostLog; ++i) scale[kMostLog + i + 1] = scale[kMostLog + i] * rho_, scale[kMostLog - i - 1] = scale[kMostLog - i] / rho_;
    const int width = camera_.width, height = camera_.height;
#pragma omp parallel num_threads(stats_.threads)
    {
#pragma omp for schedule(static)
      for (std::size_t p = 0; p < count_; ++p) own_[p] = own_variance(p);
#pragma omp for schedule(static)
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const std::size_t p = at(x, y);
          float v = own_[p];
          if (watched(p)) {
            float sum = 0, count = 0;
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j)
              for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i) {
                const std::size_t q = at(i, j);
                if (q == p || !watched(q)) continue;
                sum += own_[q] * scale[kMostLog + log_[p] - log_[q]], count += 1;
              }
            const float mine = held(p), theirs = mine * count / 8;
            if (count > 0) v = (v * mine + sum / count * theirs) / (mine + theirs);
          }
          float wide = 2 * kNormal * std::sqrt(v);
          // What none of n samples met has a share of the pixel of Beta(1, n + 1), whose second moment is 2 / n^2; it differs from
          // what they met by the doubt at most, by about a quarter of it in the mean.
          if ((inside_[p] > 0 || around_[p] > 0) && agrees(own_[p], p)) {
            // An edge that comes in from a neighbour leaves no room among n samples of a net for more than about 1 / n.
            const float doubt = std::max(inside_[p], around_[p] * contrast(x, y) / 3), miss = doubt / samples(p);
            v = std::max(v, .15f * miss * miss), wide = std::max(wide, doubt_width(doubt, p));
          }
          variance_[p] = v, widest_[p] = wide;
        }
    }
  }

  float mean(std::size_t i) const {
    return static_cast<float>(static_cast<double>(sums_[i]) / (kLightUnit * static_cast<double>(1u << log_[i / 3])));
  }

  Totals sum_up() {
    double sum = 0, spread = 0, widest = 0;
    for (std::size_t p = 0; p < count_; ++p) {
      const double v = variance_[p];
      sum += v, spread += v * v;
      widest = std::max(widest, static_cast<double>(widest_[p]));
    }
    const double n = static_cast<double>(count_);
    // A pixel's estimate has the spread of chi squared with about 7 degrees of freedom: variance 2 v^2 / 7.
    const double bound = kTrust * (sum + 1.645 * std::sqrt(spread * 2 / 7));
    stats_.error.rmse = std::sqrt(sum / n), stats_.error.rmse_bound = std::sqrt(bound / n), stats_.error.widest = widest;
    return {sum, stats_.error.rmse_bound};
  }

  void report(const Totals& totals) {
    if (!options_.progress) return;
    const RefineOptions& o = options_.refine;
    double share = 0;
    if (o.error > 0) share = totals.bound > 0 ? std::min(1.0, o.error / totals.bound) : 1;
    else if (o.seconds > 0) share = std::min(1.0, seconds() / o.seconds);
    if (!options_.progress(share)) stopped_ = true;
  }

  Image finish(SampleMaps* maps) {
    Image image(camera_.width, camera_.height);
    ErrorStats& e = stats_.error;
    e.least = kMostSamples;
    for (std::size_t p = 0; p < count_; ++p) {
      for (std::size_t c = 0; c < 3; ++c) image.rgb[p * 3 + c] = mean(p * 3 + c);
      const std::uint32_t n = 1u << log_[p];
      e.samples += n, e.least = std::min(e.least, n), e.most = std::max(e.most, n);
    }
    if (maps) {
      maps->samples.resize(count_), maps->error.resize(count_), maps->width = widest_;
      for (std::size_t p = 0; p < count_; ++p) maps->samples[p] = 1u << log_[p], maps->error[p] = std::sqrt(variance_[p]);
    }
    return image;
  }

  using Clock = std::chrono::steady_clock;
  const Clock::time_point start_ = Clock::now();
  const World::Impl& world_;
  const Camera& camera_;
  const FrameView& frame_;
  const Variant& variant_;
  const RenderOptions& options_;
  RenderStats& stats_;
  std::size_t count_;
  bool effects_;   ///< there is more to sample than the pixel
  int first_log_;
  std::vector<std::uint32_t> order_, wanted_;
  struct Rank {
    float gain;
    std::uint32_t place;
  };
  std::vector<Rank> rank_;
  std::vector<std::int64_t> sums_;   ///< [pixels][3]
  std::vector<float> squares_[3];    ///< [pixels][3] squared differences of halves, quarters, eighths, summed by level
  std::vector<float> own_, variance_, widest_;  ///< by pixel: mean over channels, the same with its neighbours', width of the 95 % interval
  std::vector<float> cost_;                     ///< rays a sample takes, of the part of the picture last sampled with the pixel
  std::vector<std::uint8_t> log_;    ///< of a pixel's samples; 0: none yet
  std::vector<float> inside_, around_;  ///< [pixels] weights of what may hide from the samples, see Doubt
  std::vector<std::unique_ptr<Workspace>> spaces_;
  double fall_ = 0, level_ = 0;
  float rho_ = .4f;
  bool stopped_ = false;
};

}  // namespace

Image refine(const World::Impl& world, const Camera& camera, const FrameView& frame, const SamplePlan& plan, const Variant& variant,
             const RenderOptions& options, RenderStats& stats, SampleMaps* maps) {
  return Refinement(world, camera, frame, plan, variant, options, stats).run(maps);
}

}  // namespace grelha
