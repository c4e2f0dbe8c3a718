#pragma once

#include <string>

#include "frontend/commands/commands.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// What two parts must have in common to be parts of one picture.
struct Identity {
  std::string scene;  ///< digest of what a ray can see of the scene as read, and of the view
  /// all else that pixels depend on, as words: version=0.1.0 size=512x512 samples=16 ...
  std::string settings;
  /// what the first of them calls the scene, printable; parts need not agree on it
  std::string name{};
  bool operator==(const Identity&) const = default;
};

/// `file`: before apply_effects().
std::string scene_digest(const SceneFile& file);

/// `camera` and `prepared.render`: after apply_effects(). What changes no bit (threads, isa,
/// packet, grid ...) is left out.
std::string settings_text(const RenderCommand& prepared, const Camera& camera);

/// The note that every picture has.
extern const Note kSoftware;

/// What a picture's file says of it: Software, Title, Scene, Settings. Nothing that changes no bit
/// of the picture.
Notes notes_of(const Identity& identity);

/// `dir/balls.nff.gz` is called balls.
std::string scene_name(const std::string& path);

/// The words in which they differ: `seed=1, NAME has seed=0`.
std::string difference(const std::string& settings,
                       const std::string& other,
                       const std::string& name);

}  // namespace grelha
