#include "frontend/input/read_scene.hpp"

#include <algorithm>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <utility>

#include "frontend/files/load_file.hpp"
#include "frontend/files/load_progress.hpp"
#include "frontend/files/memory_limit.hpp"
#include "frontend/input/view.hpp"
#include "frontend/nff/nff_reader.hpp"
#include "frontend/ply/mesh_file.hpp"
#include "frontend/scene/scene_builder.hpp"
#include "frontend/scene/scene_file.hpp"
#include "frontend/scene/warnings.hpp"

namespace grelha {
namespace {

SceneFile read_mesh_only(const std::string& path,
                         std::string bytes,
                         const Warn& warn,
                         const ReadOptions& options,
                         LoadProgress& progress) {
  SceneFile file;
  file.frame = options.frame;
  file.source_bytes = bytes.size();
  const bool stl = mesh_format(path, bytes) == MeshFormat::kStl;
  Mesh mesh = read_mesh(path, bytes, warn, &progress, options.frame, options.meshes.colors);
  std::string().swap(bytes);  // they are as large as the mesh
  (stl ? file.counts.mesh : file.counts.ply) = mesh.face_count();
  file.scene.materials.push_back(default_mesh_material(!mesh.red.empty()));
  const CrossedFaces crossed = SceneBuilder(file, options.meshes).mesh(std::move(mesh), 0);
  if (const std::string text = crossed.text(); !text.empty() && warn)
    warn(path + ": warning: " + text);
  add_default_view(file, stl ? std::optional(Float3{0, 0, 1}) : std::nullopt);  // of CAD
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
        validate_mesh_or_scene(path, text, fresh);
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
  return mesh_format(path, bytes) != MeshFormat::kNone
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
