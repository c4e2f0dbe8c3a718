#pragma once
// From a file to what rays need, with a bar to look at, an end when a signal asks for it, and no
// more memory than there may be.

#include <cstdint>
#include <stdexcept>
#include <string>

#include "frontend/commands/commands.hpp"
#include "frontend/commands/report.hpp"
#include "frontend/scene/scene_file.hpp"
#include "grelha/render.hpp"

namespace grelha {

/// SIGHUP, SIGINT or SIGTERM came while a scene was read or built. what() is one line.
struct Interrupted : std::runtime_error {
  Interrupted(int number, const std::string& during);
  int signal;
};

/// read_scene() with `shown`, a bar on stderr. Throws Interrupted while StopSignals live.
SceneFile load_scene(const std::string& path,
                     const Warn& warn,
                     const ReadOptions& options,
                     bool shown);

/// The grids of a scene that `later` more bytes are wanted for. Throws Interrupted, and FileError
/// (in the scene's name) when by its estimate it would take more than there may be.
World build_world(const std::string& path,
                  const Scene& scene,
                  const BuildOptions& options,
                  std::uint64_t later,
                  bool shown);

/// Bytes of the picture that a command makes, or of the part of it: --rows.
struct PictureMemory {
  std::uint64_t sums = 0;  ///< of work that is kept: taken before the grids are built
  std::uint64_t rest = 0;  ///< the program, what its threads work in, the picture, and its file
};

PictureMemory picture_memory(const RenderCommand& command, const Camera& camera);

/// Throws FileError, in the scene's name, when there are not so many bytes left.
void want_memory(const std::string& path, std::uint64_t bytes);

/// What rendering a scene at its own size, one sample a pixel, takes.
SceneMemory memory_of(const SceneFile& file, const BuildOptions& options);

}  // namespace grelha
