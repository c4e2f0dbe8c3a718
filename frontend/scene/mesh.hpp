#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "grelha/coordinates.hpp"
#include "grelha/geometry.hpp"

namespace grelha {

/// Returns true if a coordinate or radius is drawn. False for NaN as well.
inline bool is_finite_float(float v) {
  return v >= -kLargestLength && v <= kLargestLength;
}
inline bool is_finite_float(const Float3& v) {
  return is_finite_float(v.x) && is_finite_float(v.y) && is_finite_float(v.z);
}

/// A part of a mesh that its file names.
struct Solid {
  std::string name{};
  std::size_t faces = 0, corners = 0;
};

/// Faces over shared vertices as a file gives them, indices already checked.
struct Mesh {
  std::vector<float> x, y, z;           ///< [vertices]
  std::vector<float> nx, ny, nz;        ///< [vertices] or empty
  std::vector<float> red, green, blue;  ///< light [vertices], or [faces], or empty
  bool colors_of_faces = false, has_alpha = false;
  std::vector<std::uint32_t> indices;  ///< vertices of all faces, one face after the other
  std::vector<std::uint32_t> sizes;    ///< [faces] corners of each, or empty: all are triangles
  /// of all faces, one after the other, with vertices of their own that lie in this order; or empty
  std::vector<Solid> solids;
  std::size_t vertex_count() const { return x.size(); }
  std::size_t face_count() const { return sizes.empty() ? indices.size() / 3 : sizes.size(); }
  void add_vertex(const Float3& p) {
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
  }
  /// Ends the face whose `size` corners were just appended.
  void close_face(std::uint32_t size) {
    if (sizes.empty() && size != 3)
      sizes.assign((indices.size() - size) / 3, 3);
    if (size != 3 || !sizes.empty())
      sizes.push_back(size);
  }
};

/// Gives triangles from `first` on normals at their corners, in arrays where no vertex has one yet.
/// A corner's is the mean of the normals of those triangles at its place that are turned by at
/// most some degrees from its own, so sharper edges stay. Vertices at one place count as one; those
/// whose corners differ are doubled.
///
/// Source    Max, "Weights for Computing Vertex Normals from Facet Normals", JGT 4(2), 1999: exact
///           where the corners lie on a sphere.
void smooth_normals(Triangles& triangles, std::uint32_t first, double most_deg);

/// Returns a radius by which balls about points of a surface leave few gaps: a share of the median
/// distance to the third neighbour. A few points far out do not change it. Points that are not
/// finite do not count; 1 where there are no two places.
float radius_for(const std::vector<float>& x,
                 const std::vector<float>& y,
                 const std::vector<float>& z);

}  // namespace grelha
