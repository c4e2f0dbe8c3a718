#pragma once

#include <string>
#include <string_view>

#include "frontend/scene/frame.hpp"
#include "frontend/scene/mesh.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

class LoadProgress;

/// Reads an STL file, binary or text. Corners with the same coordinates become one vertex; vertices
/// come in the frame, in the order in which the file names them first. Normals of facets and
/// attributes are not used. Throws ParseError, which names the byte inside binary data.
Mesh read_stl_mesh(const std::string& path,
                   std::string_view bytes,
                   const Warn& warn,
                   LoadProgress* progress,
                   const Frame& frame);

}  // namespace grelha
