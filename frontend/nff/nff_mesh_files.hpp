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
  /// `scene`: the scene's file.
  NffMeshFiles(const std::string& scene,
               const Warn& warn,
               const ReadOptions& options,
               LoadProgress* progress);

  /// Returns the path of the file with that name. Throws ParseError at the name if the file does
  /// not exist, or lies where the scene may not read.
  std::string path(const NffInput& input, std::string_view name) const;

  /// Reads the mesh in a file, checks that it fits into the scene, and records its memory.
  Mesh read(const NffInput& input,
            std::string_view name,
            const std::string& path,
            SceneFile& scene) const;

 private:
  bool is_outside(const std::string& path) const;

  std::filesystem::path folder_;
  const Warn& warn_;
  bool allow_outside_, colors_;
  LoadProgress* load_;
};

}  // namespace grelha
