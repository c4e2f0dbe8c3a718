#include "frontend/input/read_scene.hpp"

#include <algorithm>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <utility>

#include "frontend/files/load_progress.hpp"
#include "frontend/files/memory_limit.hpp"
#include "frontend/files/plausible.hpp"
#include "frontend/files/load_file.hpp"
#include "frontend/files/text.hpp"
#include "frontend/input/default_view.hpp"
#include "frontend/nff/nff_reader.hpp"
#include "frontend/ply/ply_reader.hpp"
#include "frontend/ply/stl_reader.hpp"
#include "frontend/scene/choose_frame.hpp"
#include "frontend/scene/scene_builder.hpp"
#include "frontend/scene/warnings.hpp"

namespace grelha {
namespace {

/// Extension in small letters, without a ".gz" behind it.
std::string extension(const std::string& path) {
  std::string name = path.substr(path.find_last_of('/') + 1);
  std::transform(name.begin(), name.end(), name.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? char(c + 32) : c;
  });
  if (name.ends_with(".gz"))
    name.resize(name.size() - 3);
  const std::size_t point = name.find_last_of('.');
  return point == std::string::npos ? "" : name.substr(point);
}

/// Returns true for the extension .ply, or for a file that begins with `ply` alone: NFF's `ply` has
/// a name behind it.
bool is_ply(const std::string& path, std::string_view bytes) {
  if (extension(path) == ".ply")
    return true;
  bytes.remove_prefix(byte_order_mark(bytes));
  return bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
}

bool is_stl(const std::string& path) {
  return extension(path) == ".stl";
}

SceneFile read_mesh_only(const std::string& path,
                         std::string bytes,
                         const Warn& warn,
                         const ReadOptions& options,
                         LoadProgress& progress) {
  SceneFile file;
  file.frame = options.frame;
  file.source_bytes = bytes.size();
  const bool stl = !is_ply(path, bytes);
  Mesh mesh =
      stl ? read_stl_mesh(path, bytes, warn, &progress, options.frame)
          : read_ply_mesh(path, bytes, warn, &progress, options.frame, options.meshes.colors);
  std::string().swap(bytes);  // they are as large as the mesh
  (stl ? file.counts.mesh : file.counts.ply) = mesh.face_count();
  if (mesh.face_count() == 0 && !options.meshes.point_radius)
    file.points = mesh.vertex_count();
  file.scene.materials.push_back(default_mesh_material(!mesh.red.empty()));
  const CrossedFaces crossed = SceneBuilder(file, options.meshes).mesh(std::move(mesh), 0);
  if (const std::string text = crossed.text(); !text.empty() && warn)
    warn(path + ": warning: " + text);
  add_default_view(file);
  return file;
}

void warn_of_dropped(const std::string& path, const Dropped& dropped, const Warn& warn) {
  const std::uint64_t all = dropped.not_finite + dropped.zero_area;
  if (all == 0 || !warn)
    return;
  warn(path + ": warning: " + std::to_string(all) +
       (all == 1 ? " primitive is" : " primitives are") +
       " left out: " + std::to_string(dropped.not_finite) + " not finite (or beyond 1e18), " +
       std::to_string(dropped.zero_area) + " without area");
}

std::string load_scene(const std::string& path, LoadProgress& progress) {
  std::string bytes =
      load_file(path, &progress, true, [&](std::string_view text, std::size_t fresh) {
        if (!is_stl(path))
          validate_start(path, is_ply(path, text), text, fresh);
      });
  if (bytes.empty())
    throw ParseError(Position{path, 1, 1, 0}, "expected a scene, found an empty file");
  return bytes;
}

SceneFile parse_scene(const std::string& path,
                      std::string bytes,
                      const Warn& warn,
                      const ReadOptions& options,
                      LoadProgress& progress) {
  return is_ply(path, bytes) || is_stl(path)
             ? read_mesh_only(path, std::move(bytes), warn, options, progress)
             : read_nff(path, bytes, warn, options, &progress);
}

/// Reads the scene again in a frame, from the first bytes if the file cannot be read again. The
/// first reading has already given the warnings.
SceneFile read_in_frame(const std::string& path,
                        std::string bytes,
                        const Frame& frame,
                        ReadOptions options) {
  const auto progress = std::move(options.progress);
  options.progress = [&](double) { return !progress || progress(1); };
  options.frame = frame;
  LoadProgress again(options.progress);
  if (bytes.empty())
    bytes = load_scene(path, again);
  return parse_scene(
      path, std::move(bytes), [](const std::string&) {}, options, again);
}

}  // namespace

SceneFile read_scene(const std::string& path, const Warn& warn, const ReadOptions& options) try {
  LoadProgress progress(options.progress);
  std::string bytes = load_scene(path, progress);
  std::string copy = std::filesystem::is_regular_file(path) ? std::string() : bytes;
  SceneFile file = parse_scene(path, std::move(bytes), warn, options, progress);
  progress.finish();
  if (const std::optional<Frame> frame = find_frame(file)) {
    SceneFile framed = read_in_frame(path, std::move(copy), *frame, options);
    if (needs_frame(framed))
      file = std::move(framed);
  }
  warn_of_dropped(path, file.dropped, warn);
  return file;
} catch (const std::bad_alloc&) {
  throw OutOfMemory(path);
} catch (const std::length_error&) {  // a vector beyond its largest size
  throw OutOfMemory(path);
}

}  // namespace grelha
