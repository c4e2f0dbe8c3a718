#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "frontend/files/load_progress.hpp"
#include "frontend/scene/mesh.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// How the triangles lie in a binary STL file.
struct StlLayout {
  std::uint64_t triangles = 0;
  bool big_endian = false;
  bool has_lengths = false;  ///< the attribute of a triangle counts the bytes that follow it
  std::uint64_t end = 0;     ///< bytes before the end of the last triangle
};

/// Finds the layout by which a header of 80 bytes, a count and its triangles make up the whole
/// file. Counts of 0 and 2^32 - 1 are those of programs that do not know it when they begin: then
/// the size tells.
std::optional<StlLayout> exact_stl_layout(std::string_view bytes);

/// Finds the layout of a file with more bytes than its triangles take. None where the file is
/// shorter than its count says.
std::optional<StlLayout> loose_stl_layout(std::string_view bytes);

/// Returns whether the first triangle has coordinates as meshes have them, not all of them 0.
bool has_plausible_triangle(std::string_view bytes);

/// The number of triangles that the header says, and what follows it holds at most.
std::uint64_t promised_stl_triangles(std::string_view bytes);
std::uint64_t most_stl_triangles(std::string_view bytes);

/// Appends three vertices for each triangle.
void read_stl_binary(std::string_view bytes,
                     const StlLayout& layout,
                     ParseProgress& progress,
                     const Frame& frame,
                     Mesh& mesh);

}  // namespace grelha
