#pragma once
// Reads a scene and builds its grids, with a progress bar, a stop on signals, and a limit on
// memory.

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

/// read_scene() with `visible`, a bar on stderr. Throws Interrupted while StopSignals live.
SceneFile load_scene(const std::string& path,
                     const Warn& warn,
                     const ReadOptions& options,
                     bool visible);

/// Builds the grids of a scene that needs `later` more bytes for rendering. Throws Interrupted, and
/// FileError (in the scene's name) when the estimate exceeds the memory limit.
World build_world(const std::string& path,
                  const Scene& scene,
                  const BuildOptions& options,
                  std::uint64_t later,
                  bool visible);

/// Bytes for the picture of a command, or for the part of it that --rows selects.
struct PictureMemory {
  std::uint64_t sums = 0;   ///< of the sums in memory: allocated before the grids are built
  std::uint64_t other = 0;  ///< the program, buffers of its threads, the picture, and its file
};

PictureMemory picture_memory(const RenderCommand& command, const Camera& camera);

/// Throws FileError, in the scene's name, when there are not so many bytes left.
void check_memory(const std::string& path, std::uint64_t bytes);

/// Estimates the memory for rendering a scene at its own size with one sample a pixel.
SceneMemory memory_of(const SceneFile& file, const BuildOptions& options);

}  // namespace grelha
