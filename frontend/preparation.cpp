#include "frontend/preparation.hpp"

#include "frontend/memory_limit.hpp"
#include "frontend/parse_error.hpp"
#include "frontend/partial.hpp"
#include "frontend/progress.hpp"
#include "frontend/stop_signals.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>

namespace grelha {

namespace {

constexpr std::uint64_t kPictureBytes = 12;  ///< a pixel: three floats
constexpr std::uint64_t kProgram = 12'000'000;  ///< bytes of the program itself: libraries, stacks, threads' batches

std::string gigabytes(std::uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g GB", double(bytes) / 1e9);
  return text;
}

std::uint64_t geometry_bytes(const Scene& scene) {
  const Geometry& g = scene.geometry;
  const Triangles& t = g.triangles;
  return 20 * g.spheres.size() + 16 * t.size() + (12 + (t.nx.empty() ? 0 : 12)) * t.vertex_count() + 36 * g.cones.size() + 28 * g.planes.size() +
         sizeof(Material) * scene.materials.size();
}

/// `work(progress)` with a bar; a signal stops it.
template <class Work>
auto watched(const char* name, bool shown, const Work& work) {
  ProgressBar bar(shown, 0, name);
  const auto signals = std::make_unique<StopSignals>();
  return work([&](double share) {
    bar.update(share);
    return StopSignals::seen() == 0;
  });
}

/// The same; what came after the last question counts as well.
template <class Work>
auto interruptible(const char* name, const std::string& during, bool shown, const Work& work) {
  try {
    auto made = watched(name, shown, work);
    if (StopSignals::seen() == 0) return made;
  } catch (const Stopped&) {
  }
  throw Interrupted(StopSignals::seen(), during);
}

}  // namespace

Interrupted::Interrupted(int number, const std::string& during)
    : std::runtime_error("grelha: stopped by " + std::string(signal_name(number)) + " while " + during), signal(number) {}

SceneFile load_scene(const std::string& path, const Warn& warn, const ReadOptions& options, bool shown) {
  return interruptible("load", "reading " + path, shown, [&](const std::function<bool(double)>& progress) {
    ReadOptions watched_options = options;
    watched_options.progress = progress;
    return read_scene(path, warn, watched_options);
  });
}

World build_world(const std::string& path, const Scene& scene, const BuildOptions& options, std::uint64_t later, bool shown) {
  const OwnMemory memory = own_memory();
  const std::uint64_t left = memory.left();
  const auto refuse = [&](std::uint64_t need) {
    throw FileError(path, "wanted about " + gigabytes(memory.owned + need) + " of memory to render it, found " + gigabytes(memory.limit) +
                              " (--max-memory)");
  };
  if (later >= left) refuse(later);
  try {
    return interruptible("build", "building the grids of " + path, shown, [&](const std::function<bool(double)>& progress) {
      BuildOptions watched_options = options;
      watched_options.progress = progress;
      watched_options.most_bytes = left - later;
      return World(scene, watched_options);
    });
  } catch (const TooLarge& error) {
    refuse(error.need.peak + later);
    throw;
  }
}

std::uint64_t picture_bytes(const RenderCommand& command, const Camera& camera) {
  constexpr std::uint64_t kSums = 24, kRefined = 90;  // docs/architecture.md
  const bool sums = !command.work.checkpoint.empty() || is_partial_name(command.image) || command.work.show_every > 0;
  const std::uint64_t pixels = std::uint64_t(camera.width) * std::uint64_t(camera.height);
  return pixels * (kPictureBytes + (sums ? kSums : 0) + (command.render.refine.on() ? kRefined : 0));
}

SceneMemory memory_of(const SceneFile& file, const BuildOptions& options, std::uint64_t pixels) {
  const BuildMemory build = World::estimate(file.scene, options);
  SceneMemory memory;
  memory.scene = geometry_bytes(file.scene), memory.grids = build.kept;
  memory.peak = kProgram + memory.scene + std::max({file.source_bytes, build.peak, build.kept + kPictureBytes * pixels});
  return memory;
}

}  // namespace grelha
