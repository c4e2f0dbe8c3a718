#pragma once
// The files of meshes that a scene names.

#include <filesystem>
#include <string>
#include <string_view>

#include "frontend/nff/nff_input.hpp"
#include "frontend/scene/mesh.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

class LoadProgress;

class NffMeshFiles {
 public:
  /// Of the scene in that file.
  NffMeshFiles(const std::string& scene,
               const Warn& warn,
               const ReadOptions& options,
               LoadProgress* progress);

  /// Where the file of that name lies. Throws ParseError at the name when there is none, or where
  /// the scene may not look.
  std::string path(const NffInput& input, std::string_view name) const;

  /// The mesh in a file, small enough to join those of the scene; notes what it took of memory.
  Mesh read(const NffInput& input,
            std::string_view name,
            const std::string& path,
            SceneFile& scene) const;

 private:
  bool is_outside(const std::string& path) const;

  std::filesystem::path folder_;
  const Warn& warn_;
  bool allow_outside_;
  LoadProgress* load_;
};

}  // namespace grelha
