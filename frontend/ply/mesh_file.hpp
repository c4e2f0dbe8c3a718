#pragma once

#include <cstdint>
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

/// Returns whether bytes are STL, in a file that may be of any kind: binary of a size that tells or
/// with a triangle, or text with a vertex.
bool is_stl(std::string_view bytes);

/// Reads an STL file, binary or text: whichever the bytes can be. Corners with the same coordinates
/// of a solid become one vertex; vertices come in the frame, in the order in which the file names
/// them first. Colours are those of stl_colors.hpp. Normals of facets are not used. Throws
/// ParseError, which names the byte inside binary data.
Mesh read_stl_mesh(const std::string& path,
                   std::string_view bytes,
                   const Warn& warn,
                   LoadProgress* progress,
                   const Frame& frame,
                   bool with_colors = true);

enum class MeshFormat : std::uint8_t { kNone, kPly, kStl };

/// The format of a file of a mesh, by its name or else by what it holds, or by its first bytes.
MeshFormat mesh_format(const std::string& path, std::string_view bytes);

/// Refuses bytes that cannot begin a mesh or scene; they arrive as for validate_start().
void validate_mesh_or_scene(const std::string& path, std::string_view bytes, std::size_t fresh);

/// Reads a mesh in PLY or STL. Throws ParseError.
Mesh read_mesh(const std::string& path,
               std::string_view bytes,
               const Warn& warn,
               LoadProgress* progress,
               const Frame& frame,
               bool with_colors);

}  // namespace grelha
