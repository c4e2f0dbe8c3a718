#pragma once
// Faces and colours of a PLY file; colours by the names and the ranges that programs give them.

#include <array>
#include <cstdint>
#include <vector>

#include "frontend/ply/ply_header.hpp"
#include "frontend/scene/mesh.hpp"
#include "frontend/scene/scene_file.hpp"
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

/// Takes the indices of a list of `face` or `tristrips`, one after the other.
class PlyFaces {
 public:
  PlyFaces(Mesh& mesh, std::uint64_t vertices, bool strips)
      : mesh_(mesh), vertices_(vertices), strips_(strips) {}

  bool accepts(std::int64_t index) const {
    return (index >= 0 && std::uint64_t(index) < vertices_) || (strips_ && index == -1);
  }
  void add(std::int64_t index) {
    if (strips_)
      add_to_strip(index);
    else
      mesh_.indices.push_back(std::uint32_t(index));
  }
  void end(std::uint32_t size) {
    run_ = 0;
    if (!strips_)
      mesh_.close_face(size);
  }

 private:
  /// -1 starts anew. The winding alternates, so every second triangle is turned.
  void add_to_strip(std::int64_t index) {
    if (index == -1) {
      run_ = 0;
      return;
    }
    const auto c = std::uint32_t(index);
    if (++run_ >= 3 && a_ != b_ && b_ != c && c != a_) {
      const bool turned = run_ % 2 == 0;
      mesh_.indices.insert(mesh_.indices.end(), {turned ? b_ : a_, turned ? a_ : b_, c});
      mesh_.close_face(3);
    }
    a_ = b_;
    b_ = c;
  }

  Mesh& mesh_;
  std::uint64_t vertices_;
  bool strips_;
  std::uint64_t run_ = 0;  ///< vertices of this strip so far
  std::uint32_t a_ = 0, b_ = 0;
};

/// The properties used of one element: -1, or the index of a property.
struct PlyPlan {
  static constexpr int kColumns = 9;
  /// x y z nx ny nz of `vertex`; red green blue of it, or of `face`
  int columns[kColumns] = {-1, -1, -1, -1, -1, -1, -1, -1, -1};
  int list = -1;  ///< the indices of `face` or `tristrips`
  Frame frame{};  ///< of x y z
  bool colors_are_bytes = false;
};

/// The array that receives the numbers of a property, and their transformation.
struct PlyColumn {
  std::vector<float>* to = nullptr;
  double minus = 0, times = 1;
  bool is_srgb = false;
  bool is_identity() const { return minus == 0 && times == 1 && !is_srgb; }
  float value(double number) const {
    return is_srgb ? light_of_byte(number) : static_cast<float>((number - minus) * times);
  }
};

/// Returns the column for an element of PlyPlan::columns.
inline PlyColumn column(Mesh& mesh, const PlyPlan& plan, int i) {
  std::vector<float>* const all[] = {
      &mesh.x, &mesh.y, &mesh.z, &mesh.nx, &mesh.ny, &mesh.nz, &mesh.red, &mesh.green, &mesh.blue};
  if (i >= 6)
    return {all[i], 0, 1, plan.colors_are_bytes};
  if (i >= 3)
    return {all[i]};
  return {all[i], plan.frame.offset[std::size_t(i)], plan.frame.scale};
}

}  // namespace grelha
