#pragma once
// Colours in a PLY file, by the names and the ranges that programs give them.

#include <array>

#include "frontend/ply/ply_header.hpp"
#include "frontend/scene/mesh.hpp"
#include "frontend/scene/warnings.hpp"

namespace grelha {

struct PlyColors {
  const PlyElement* element = nullptr;  ///< that has them, or null
  std::array<int, 3> columns{};
  std::array<PlyType, 3> types{};
  /// sRGB, and read as such; other numbers wait for scale_colors()
  bool is_bytes() const {
    return types == std::array{PlyType::kUint8, PlyType::kUint8, PlyType::kUint8};
  }
};

/// Finds the colours of vertices, or else of faces.
PlyColors find_colors(const PlyHeader& header);

/// Makes light of 0 to 1 of numbers as the file has them, by their type and the largest of them.
/// Warns where these two do not agree, and where numbers are cut.
void scale_colors(Mesh& mesh, const PlyColors& colors, WarningList& warning_list);

/// The light of a byte of sRGB, or of a number that rounds to one.
float light_of_byte(double byte);

}  // namespace grelha
