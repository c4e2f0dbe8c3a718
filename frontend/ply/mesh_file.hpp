#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "frontend/scene/mesh.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

class LoadProgress;

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
