#pragma once
/// \file
///
/// All of the library: `#include <grelha/grelha.hpp>`, `find_package(grelha)`, link
/// `grelha::kernel`.
///
/// Fill in a grelha::Scene, or a grelha::SceneSpans over arrays of your own; build a grelha::World
/// from it; ask with grelha::closest() and grelha::occluded(), or grelha::render() a picture.

#include "kernel/camera.hpp"
#include "kernel/geometry.hpp"
#include "kernel/image.hpp"
#include "kernel/query.hpp"
#include "kernel/render.hpp"
#include "kernel/scene_spans.hpp"
#include "kernel/stats.hpp"

/// A ray tracer on uniform grids.
namespace grelha {}
