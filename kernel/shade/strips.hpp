#pragma once
// How pictures are set up, in which order their pixels come, and how strips of rows are rendered.

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "grelha/part.hpp"
#include "grelha/render_options.hpp"
#include "grelha/world.hpp"
#include "kernel/scene/shading_view.hpp"
#include "kernel/scene/tables.hpp"
#include "kernel/query/variants.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {

/// The order in which the pixels of a picture draw runs of one sequence: along Morton's curve, with
/// the quarters of each square in random order. Runs of neighbours lie next to each other. Together
/// they are as even as each alone, so the errors of neighbours differ as much as errors can: blue
/// noise.
///
/// Returns   [width * height] positions, as in a picture whose sides are a power of two; they begin
///           anew after 2^32 positions.
/// Source    Ahmed & Wonka, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via
///           Hierarchical Ordering of Pixels", 2020.
std::vector<std::uint32_t> drawing_places(int width, int height, std::uint32_t seed);

/// Starting state of every way of rendering.
struct Setup {
  const Variant& variant;
  FrameView frame;
  SamplePlan plan;
  ShadingView shading;
  std::vector<std::uint32_t> places;  ///< the plan points to these
  std::optional<LightTable> lights;   ///< `shading` points to these; absent: to the World's
};

/// Throws std::invalid_argument for a bad camera or option.
void check_options(const Camera& camera, const RenderOptions& options);

/// Throws std::invalid_argument for an instruction set that is unknown or does not run here, or a
/// bad camera or option.
Setup set_up(const World& world, const Camera& camera, const RenderOptions& options);

/// Threads for `pieces` of work.
int thread_count(const RenderOptions& options, std::size_t pieces);

/// A part of a picture, at most kStripRows rows, and the number its renderer knows it by.
struct Strip {
  std::size_t number;
  Part part;
};

/// Sets `strip` to number `turn` of the strips to render; returns false when none is left. Called
/// by all threads, possibly at the same time.
using NextStrip = std::function<bool(std::size_t turn, Strip&)>;

/// Handed the sums of a strip, [rows][width][3] in units of 1 / kLightUnit, by the thread that
/// rendered it, while others do the same; returns false to stop.
using TakeStrip = std::function<bool(const Strip&, const std::int64_t* sums)>;

/// Renders at most `most` strips in parallel, each by the thread that is free next (OpenMP, dynamic
/// schedule over strips of rows). An exception from one of the functions ends the program.
void render_strips(const World::Impl& world,
                   const Setup& setup,
                   const RenderOptions& options,
                   std::size_t most,
                   const NextStrip& next,
                   const TakeStrip& take,
                   RenderStats& stats);

}  // namespace grelha
