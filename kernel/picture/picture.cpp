#include "kernel/picture/picture.hpp"

#include "grelha/render.hpp"
#include "kernel/picture/adaptive_sampler.hpp"
#include "kernel/picture/subdivision.hpp"
#include "kernel/shade/strips.hpp"
#include "kernel/base/fork.hpp"
#include "kernel/shade/workspace.hpp"

namespace grelha {
namespace {

bool is_size(int width, int height) {
  return width >= 1 && height >= 1 && width <= kMostSide && height <= kMostSide;
}

std::uint64_t size_of(const Range& r) {
  return static_cast<std::uint64_t>(r.end - r.begin);
}

bool is_range(const Range& r, int most) {
  return r.begin >= 0 && r.begin < r.end && r.end <= most;
}

// Each question about a picture, asked of every kind: the same name, told apart by the state.

bool advance_state(const World& world,
                   const Camera& camera,
                   const RenderOptions& options,
                   Accumulator& a,
                   RenderStats& stats,
                   SampleMaps*,
                   const ShouldContinue& should_continue) {
  return accumulate(world, camera, options, a, stats, {}, should_continue);
}
bool advance_state(const World& world,
                   const Camera& camera,
                   const RenderOptions& options,
                   Refinement& r,
                   RenderStats& stats,
                   SampleMaps* maps,
                   const ShouldContinue& should_continue) {
  return refine(world, camera, options, r, stats, maps, should_continue);
}
bool advance_state(const World& world,
                   const Camera& camera,
                   const RenderOptions& options,
                   SubdivisionState& s,
                   RenderStats& stats,
                   SampleMaps*,
                   const ShouldContinue& should_continue) {
  return render_subdivided(world, camera, options, s, stats, should_continue);
}

int width_of(const Accumulator& a) {
  return a.width;
}
int width_of(const Refinement& r) {
  return r.width;
}
int width_of(const SubdivisionState& s) {
  return s.image.width;
}

int height_of(const Accumulator& a) {
  return a.height;
}
int height_of(const Refinement& r) {
  return r.height;
}
int height_of(const SubdivisionState& s) {
  return s.image.height;
}

double share_of(const Accumulator& a) {
  return share_done(a);
}
double share_of(const Refinement& r) {
  return r.share;
}
double share_of(const SubdivisionState& s) {
  return s.share;
}

bool finished(const Accumulator& a) {
  return is_complete(a);
}
bool finished(const Refinement& r) {
  return r.finished;
}
bool finished(const SubdivisionState& s) {
  return s.share == 1;
}

Image image_of(const Accumulator& a) {
  return picture_so_far(a);
}
Image image_of(const Refinement& r) {
  return picture_so_far(r);
}
Image image_of(const SubdivisionState& s) {
  return s.image;
}

std::uint64_t samples_of(const Accumulator& a) {
  std::uint64_t samples = 0;
  for (std::size_t i = 0; i < a.done.size(); ++i) {
    const Part piece = piece_of(a.part, i);
    if (a.done[i] != 0)
      samples += size_of(piece.rows) * size_of(piece.samples);
  }
  return samples * static_cast<std::uint64_t>(a.width);
}
std::uint64_t samples_of(const Refinement& r) {
  return total_samples(r);
}
std::uint64_t samples_of(const SubdivisionState&) {
  return 0;
}

Part part_of(const Accumulator& a) {
  return a.part;
}
template <class State>
Part part_of(const State& whole) {
  return {{0, height_of(whole)}, {0, 1}};
}

bool numbers_are_valid(const Accumulator& a) {
  return a.samples >= 1 && a.samples <= kMostSamples && is_range(a.part.rows, a.height) &&
         is_range(a.part.samples, a.samples);
}
template <class State>
bool numbers_are_valid(const State&) {
  return true;
}

Picture make_picture(const Camera& camera, const RenderOptions& options, const Part& part) {
  check_options(camera, options);
  if (options.refine.on())
    return make_refinement(camera);
  if (options.subdivision.on)
    return make_subdivision(camera.width, camera.height);
  return make_accumulator(camera, options, part);
}

}  // namespace

Picture::Picture(const Camera& camera, const RenderOptions& options)
    : Picture(camera, options, {{0, camera.height}, {0, options.sampling.samples}}) {}

Picture::Picture(const Camera& camera, const RenderOptions& options, const Part& part)
    : Picture(make_picture(camera, options, part)) {}

bool Picture::advance(const World& world,
                      const Camera& camera,
                      const RenderOptions& options,
                      RenderStats& stats,
                      SampleMaps* maps,
                      const ShouldContinue& should_continue) {
  bool done = false;
  const auto advance_any = [&](auto& state) {
    done = advance_state(world, camera, options, state, stats, maps, should_continue);
  };
  run_fork_safe([&] { std::visit(advance_any, state_); });
  return done;
}

bool Picture::lift_limits() {
  Refinement* const r = std::get_if<Refinement>(&state_);
  return r && grelha::lift_limits(*r);
}

int Picture::width() const {
  return std::visit([](const auto& state) { return width_of(state); }, state_);
}

int Picture::height() const {
  return std::visit([](const auto& state) { return height_of(state); }, state_);
}

double Picture::share_done() const {
  return std::visit([](const auto& state) { return share_of(state); }, state_);
}

bool Picture::is_finished() const {
  return std::visit([](const auto& state) { return finished(state); }, state_);
}

Image Picture::image() const {
  return std::visit([](const auto& state) { return image_of(state); }, state_);
}

std::uint64_t Picture::total_samples() const {
  return std::visit([](const auto& state) { return samples_of(state); }, state_);
}

std::string_view Picture::kind() const {
  return std::visit([]<class State>(const State&) -> std::string_view { return kKindOf<State>; },
                    state_);
}

Part Picture::part() const {
  return std::visit([](const auto& state) { return part_of(state); }, state_);
}

bool Picture::is_valid() const {
  return std::visit([](const auto& state) { return grelha::is_valid(state); }, state_);
}

bool Picture::has_valid_numbers() const {
  return is_size(width(), height()) &&
         std::visit([](const auto& state) { return numbers_are_valid(state); }, state_);
}

std::vector<Isa> isas() {
  std::vector<Isa> out;
  for (const std::string_view name : {"scalar", "sse2", "avx2", "avx512", "neon"}) {
    const Variant* const v = find_variant(name);
    out.push_back({name, v != nullptr, v != nullptr && v->is_supported()});
  }
  return out;
}

Image render(const World& world,
             const Camera& camera,
             const RenderOptions& options,
             RenderStats& stats,
             SampleMaps* maps) {
  Picture picture(camera, options);
  picture.advance(world, camera, options, stats, maps);
  return picture.image();
}

std::uint64_t thread_bytes(const Camera& camera, const RenderOptions& options) {
  const auto strips = static_cast<std::size_t>((camera.height + kStripRows - 1) / kStripRows);
  const std::size_t sums = static_cast<std::size_t>(camera.width) * kStripRows;
  const auto threads = static_cast<std::uint64_t>(thread_count(options, strips));
  return threads * Workspace::bytes(sums, options.depth, options.sampling.glossy_rays);
}

}  // namespace grelha
