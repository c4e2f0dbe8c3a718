#pragma once

#include <string>
#include <string_view>

#include "frontend/scene/mesh.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

class LoadProgress;

/// Reads the vertices and faces of a PLY file, and skips all other data. `tristrips` become
/// triangles, without those that repeat a vertex, which only stitch strips. Every index is checked.
/// Vertices come in the frame. Colours are those of vertices, or else of faces: bytes are sRGB,
/// other numbers light. Throws ParseError, which names the byte inside binary data.
Mesh read_ply_mesh(const std::string& path,
                   std::string_view bytes,
                   const Warn& warn = {},
                   LoadProgress* progress = nullptr,
                   const Frame& frame = {},
                   bool with_colors = true);

}  // namespace grelha
