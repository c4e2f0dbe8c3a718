#include "scenes/mesh.hpp"

#include <cstdio>
#include <ostream>

namespace grelha::scenes {

void write_ply(std::ostream& out, const Mesh& mesh) {
  out << "ply\nformat ascii 1.0\nelement vertex " << mesh.vertices.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty "
         "float ny\nproperty float "
         "nz\n"
      << "element face " << mesh.faces.size()
      << "\nproperty list uchar uint vertex_indices\nend_header\n";
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec &p = mesh.vertices[i], &n = mesh.normals[i];
    char line[160];
    std::snprintf(
        line, sizeof line, "%.6g %.6g %.6g %.6g %.6g %.6g\n", p.x, p.y, p.z, n.x, n.y, n.z);
    out << line;
  }
  for (const auto& [a, b, c] : mesh.faces)
    out << "3 " << a << ' ' << b << ' ' << c << '\n';
}

}  // namespace grelha::scenes
