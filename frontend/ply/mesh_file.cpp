#include "frontend/ply/mesh_file.hpp"

#include "frontend/files/other_formats.hpp"
#include "frontend/files/text.hpp"

namespace grelha {
namespace {

/// Extension in small letters, without a ".gz" behind it.
std::string extension(const std::string& path) {
  std::string name = in_small_letters(path.substr(path.find_last_of('/') + 1));
  if (name.ends_with(".gz"))
    name.resize(name.size() - 3);
  const std::size_t point = name.find_last_of('.');
  return point == std::string::npos ? "" : name.substr(point);
}

/// Returns true if a file begins with `ply` alone: NFF's `ply` has a name behind it.
bool begins_as_ply(std::string_view bytes) {
  bytes.remove_prefix(byte_order_mark(bytes));
  return bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
}

}  // namespace

MeshFormat mesh_format(const std::string& path, std::string_view bytes) {
  const std::string ending = extension(path);
  if (ending == ".ply" || begins_as_ply(bytes))
    return MeshFormat::kPly;
  return ending == ".stl" || is_stl(bytes) ? MeshFormat::kStl : MeshFormat::kNone;
}

void validate_mesh_or_scene(const std::string& path, std::string_view bytes, std::size_t fresh) {
  constexpr std::size_t kLook = std::size_t(1) << 16;  // the rest may still arrive
  const MeshFormat format = mesh_format(path, bytes.substr(0, kLook));
  if (format != MeshFormat::kStl)
    validate_start(path, format == MeshFormat::kPly, bytes, fresh);
}

Mesh read_mesh(const std::string& path,
               std::string_view bytes,
               const Warn& warn,
               LoadProgress* progress,
               const Frame& frame,
               bool with_colors) {
  return mesh_format(path, bytes) == MeshFormat::kStl
             ? read_stl_mesh(path, bytes, warn, progress, frame, with_colors)
             : read_ply_mesh(path, bytes, warn, progress, frame, with_colors);
}

}  // namespace grelha
