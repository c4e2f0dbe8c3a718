#pragma once

#include <string>
#include <string_view>

#include "frontend/scene/mesh.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

class LoadProgress;

/// The vertices and faces of a PLY file; whatever else it holds is stepped over. `tristrips` become
/// triangles, without those that repeat a vertex: they only stitch. Every index is checked.
/// Vertices come in the frame. Throws ParseError, which names the byte inside binary data.
Mesh read_ply_mesh(const std::string& path,
                   std::string_view bytes,
                   const Warn& warn = {},
                   LoadProgress* progress = nullptr,
                   const Frame& frame = {});

}  // namespace grelha
