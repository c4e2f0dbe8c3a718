#pragma once

#include "kernel/render.hpp"
#include "kernel/shading_view.hpp"
#include "kernel/variants.hpp"
#include "kernel/world.hpp"

namespace grelha {

/// Renders with samples spent by error, see RefineOptions; docs/sampling.md has the derivations.
///
/// Every pixel starts with a few samples; each round then doubles those of the pixels whose variance would fall most for each
/// new sample. A pixel's samples are one Owen-scrambled sequence: E[(A - B)^2] / 4 of the means A, B of its halves is V(n/2) -
/// V(n), without a model; that V falls by `rho` a doubling, measured over the picture, gives V(n).
Image refine(const World::Impl& world, const Camera& camera, const FrameView& frame, const SamplePlan& plan, const Variant& variant,
             const RenderOptions& options, RenderStats& stats, SampleMaps* maps);

}  // namespace grelha
