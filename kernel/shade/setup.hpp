#pragma once

#include <optional>
#include <vector>

#include "kernel/scene/frame.hpp"
#include "kernel/scene/lights.hpp"
#include "grelha/render_options.hpp"
#include "grelha/world.hpp"
#include "kernel/query/variants.hpp"

namespace grelha {

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

}  // namespace grelha
