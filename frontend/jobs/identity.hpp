#pragma once

#include <string>

#include "frontend/commands/commands.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// The properties that two parts of one picture must share.
struct Identity {
  std::string scene;  ///< digest of the scene as read, as far as rays see it, and of the view
  /// the other settings that pixels depend on, as words: version=0.1.0 size=512x512 samples=16 ...
  std::string settings;
  /// the scene's name in the first part, printable; parts need not agree on it
  std::string name{};
  bool operator==(const Identity&) const = default;
};

/// `file`: before apply_effects().
std::string scene_digest(const SceneFile& file);

/// `camera` and `resolved.render`: after apply_effects(). Options that change no bit (threads, isa,
/// packet, grid ...) are left out.
std::string settings_text(const RenderCommand& resolved, const Camera& camera);

/// Returns true for a picture of colours that are light: a PNG of it takes the sRGB curve.
bool is_colored(const Identity& identity);

/// The note that every picture has.
extern const Note kSoftware;

/// The notes of a picture's file: Software, Title, Scene, Settings. Options that change no bit of
/// the picture are left out.
Notes notes_of(const Identity& identity);

/// `dir/balls.nff.gz` is called balls.
std::string scene_name(const std::string& path);

/// Settings without the words for where a picture by error ends: other limits may go on from it.
std::string without_limits(const std::string& settings);

/// The words in which they differ: `seed=1, NAME has seed=0`.
std::string difference(const std::string& settings,
                       const std::string& other,
                       const std::string& name);

}  // namespace grelha
