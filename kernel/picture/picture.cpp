#include "kernel/picture/picture.hpp"

#include "grelha/render.hpp"
#include "kernel/picture/subdivision.hpp"
#include "kernel/shade/strips.hpp"
#include "kernel/base/fork.hpp"

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

/// What has the width and height of a picture.
template <class State>
const auto& sized(const State& state) {
  if constexpr (requires { state.image; })
    return state.image;
  else
    return state;
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
  const auto advance_any = [&]<class State>(State& state) {
    if constexpr (std::is_same_v<State, Accumulator>)
      done = accumulate(world, camera, options, state, stats, {}, should_continue);
    else if constexpr (std::is_same_v<State, Refinement>)
      done = refine(world, camera, options, state, stats, maps, should_continue);
    else
      done = render_subdivided(world, camera, options, state, stats, should_continue);
  };
  run_fork_safe([&] { std::visit(advance_any, state_); });
  return done;
}

bool Picture::lift_limits() {
  Refinement* const r = std::get_if<Refinement>(&state_);
  return r && grelha::lift_limits(*r);
}

int Picture::width() const {
  return std::visit([](const auto& state) { return sized(state).width; }, state_);
}

int Picture::height() const {
  return std::visit([](const auto& state) { return sized(state).height; }, state_);
}

double Picture::share_done() const {
  const auto share = []<class State>(const State& state) {
    if constexpr (std::is_same_v<State, Accumulator>)
      return grelha::share_done(state);
    else
      return state.share;
  };
  return std::visit(share, state_);
}

bool Picture::is_finished() const {
  const Refinement* const r = std::get_if<Refinement>(&state_);
  return r ? r->finished : share_done() == 1;
}

Image Picture::image() const {
  return std::visit(
      [](const auto& state) {
        if constexpr (requires { state.image; })
          return state.image;
        else
          return picture_so_far(state);
      },
      state_);
}

std::uint64_t Picture::total_samples() const {
  return std::visit([](const auto& state) { return samples_of(state); }, state_);
}

std::string_view Picture::kind() const {
  return std::visit([]<class State>(const State&) -> std::string_view { return kKindOf<State>; },
                    state_);
}

Part Picture::part() const {
  const Accumulator* const a = sums();
  return a ? a->part : Part{{0, height()}, {0, 1}};
}

bool Picture::is_valid() const {
  return std::visit([](const auto& state) { return grelha::is_valid(state); }, state_);
}

bool Picture::has_valid_numbers() const {
  const Accumulator* const a = sums();
  return is_size(width(), height()) &&
         (!a || (a->samples >= 1 && a->samples <= kMostSamples &&
                 is_range(a->part.rows, a->height) && is_range(a->part.samples, a->samples)));
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

}  // namespace grelha
