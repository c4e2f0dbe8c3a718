#pragma once

#include <string>
#include <string_view>

#include "frontend/scene/mesh.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

class LoadProgress;

/// Returns whether bytes are STL, in a file that may be of any kind: binary of a size that tells or
/// with a triangle, or text with a vertex.
bool is_stl(std::string_view bytes);

/// Reads an STL file, binary or text: whichever the bytes can be. Corners with the same coordinates
/// become one vertex; vertices come in the frame, in the order in which the file names them first.
/// Normals of facets, colours and attributes are not used. Throws ParseError, which names the byte
/// inside binary data.
Mesh read_stl_mesh(const std::string& path,
                   std::string_view bytes,
                   const Warn& warn,
                   LoadProgress* progress,
                   const Frame& frame);

}  // namespace grelha
