#pragma once
/// \file
///
/// All of the library: `#include <grelha/grelha.hpp>`, `find_package(grelha)`, link
/// `grelha::kernel`.
///
/// Fill in a grelha::Scene, or a grelha::SceneSpans over arrays of your own; build a grelha::World
/// from it, or a grelha::OwningWorld, which keeps it. Ask with grelha::closest() and
/// grelha::occluded(), or grelha::render() a picture.

#include "grelha/all_hits.hpp"
#include "grelha/camera.hpp"
#include "grelha/coordinates.hpp"
#include "grelha/distance.hpp"
#include "grelha/geometry.hpp"
#include "grelha/image.hpp"
#include "grelha/inside.hpp"
#include "grelha/mesh_check.hpp"
#include "grelha/meshes.hpp"
#include "grelha/owning_world.hpp"
#include "grelha/query.hpp"
#include "grelha/render.hpp"
#include "grelha/scene_spans.hpp"
#include "grelha/stats.hpp"

/// A ray tracer on uniform grids.
namespace grelha {}
