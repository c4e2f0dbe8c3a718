#include "frontend/nff/nff_mesh_files.hpp"

#include <algorithm>
#include <limits>
#include <new>

#include "frontend/files/load_file.hpp"
#include "frontend/files/memory_limit.hpp"
#include "frontend/files/other_formats.hpp"
#include "frontend/ply/mesh_file.hpp"

namespace grelha {
namespace {

void check_image_size(const NffInput& input,
                      std::string_view name,
                      const Mesh& mesh,
                      const Triangles& triangles) {
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (mesh.vertex_count() > kMost - triangles.vertex_count() ||
      mesh.indices.size() > kMost - triangles.size())
    throw ParseError(input.position(name),
                     "expected fewer than 2^32 vertices and triangles in all, found more");
}

/// Converts a name that a Windows program wrote: removes quotes, and puts `/` between folders.
std::string from_windows(std::string_view name) {
  const bool is_quoted = name.size() > 2 && (name[0] == '"' || name[0] == '\'');
  if (is_quoted && name.front() == name.back())
    name = name.substr(1, name.size() - 2);
  std::string here(name);
  std::ranges::replace(here, '\\', '/');
  return here;
}

}  // namespace

NffMeshFiles::NffMeshFiles(const std::string& scene,
                           const Warn& warn,
                           const ReadOptions& options,
                           LoadProgress* progress)
    : folder_(std::filesystem::path(scene).parent_path()),
      warn_(warn),
      allow_outside_(options.allow_outside),
      colors_(options.meshes.colors),
      load_(progress) {}

/// Returns true if a file lies outside the scene's folder, after following all links. The reader
/// checks this before it opens the file, so a scene cannot even probe for files.
bool NffMeshFiles::is_outside(const std::string& path) const {
  std::error_code error;
  const std::filesystem::path home =
      std::filesystem::canonical(folder_.empty() ? "." : folder_, error);
  if (error)
    return true;
  // weakly_canonical() would leave a relative path where nothing is there.
  const std::filesystem::path file =
      std::filesystem::weakly_canonical(std::filesystem::absolute(path), error);
  if (error)
    return true;
  return std::mismatch(home.begin(), home.end(), file.begin(), file.end()).first != home.end();
}

std::string NffMeshFiles::path(const NffInput& input, std::string_view name) const {
  if (name.empty())
    throw ParseError(input.position(name), "a file name after \"ply\"", "end of line");
  // the system ignores the text behind a NUL, but checks would not
  if (name.find('\0') != name.npos)
    input.fail(name, "a file name after \"ply\"");
  std::string path = (folder_ / std::string(name)).string();
  std::error_code ignored;
  const auto may_look = [&] { return allow_outside_ || !is_outside(path); };
  if (may_look() && !std::filesystem::exists(path, ignored))
    path = (folder_ / from_windows(name)).string();
  if (!may_look())
    throw ParseError(
        input.position(name),
        "expected a file in the scene's folder or below it (or --allow-outside), found " +
            quoted(name));
  return path;
}

Mesh NffMeshFiles::read(const NffInput& input,
                        std::string_view name,
                        const std::string& path,
                        SceneFile& scene) const {
  try {
    const auto validate = [&](std::string_view text, std::size_t fresh) {
      if (mesh_format(path, text) != MeshFormat::kStl)
        validate_start(path, true, text, fresh);
    };
    const std::string bytes = load_file(path, load_, false, validate);
    Mesh mesh = read_mesh(path, bytes, warn_, load_, scene.frame, colors_);
    const std::uint64_t held = input.words.size() + bytes.size();
    scene.source_bytes = std::max(scene.source_bytes, held);
    check_image_size(input, name, mesh, scene.scene.geometry.triangles);
    return mesh;
  } catch (const std::bad_alloc&) {
    throw OutOfMemory(path);
  } catch (const FileError& error) {
    const std::string reason =
        std::string(error.what()).substr(path.size() + std::string_view(": error: ").size());
    throw FileError(path, reason + " (named at " + input.position(name).text() + ')');
  }
}

}  // namespace grelha
