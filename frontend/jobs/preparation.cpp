#include "frontend/jobs/preparation.hpp"

#include "frontend/commands/console.hpp"
#include "frontend/commands/progress.hpp"
#include "frontend/files/memory_limit.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/input/read_scene.hpp"
#include "frontend/jobs/checkpoint.hpp"
#include "frontend/jobs/stop_signals.hpp"

#include <algorithm>
#include <cstdio>
#include <thread>

namespace grelha {

namespace {

constexpr std::uint64_t kPixel = 12;  ///< bytes of a picture's pixel: three floats
/// and of its file's, before that is written: .pfm and .hdr; a .png takes half of it
constexpr std::uint64_t kFilePixel = 12;
constexpr std::uint64_t kAlpha = 8;             ///< in the picture and in its file
constexpr std::uint64_t kSum = 24;              ///< three sums of light
constexpr std::uint64_t kBlueIndex = 4;         ///< where its samples begin
constexpr std::uint64_t kRefined = 80;          ///< docs/architecture.md, and 9 a pixel for blocks
constexpr std::uint64_t kTilePoint = 56;        ///< of a tile that is subdivided, with its squares
constexpr std::uint64_t kMaps = 12;             ///< samples, errors and widths
constexpr std::uint64_t kProgram = 12'000'000;  ///< bytes of the program itself: libraries, stacks

std::uint64_t geometry_bytes(const Scene& scene) {
  const Geometry& g = scene.geometry;
  const Triangles& t = g.triangles;
  return 20 * g.spheres.size() + 16 * t.size() +
         (12 + (t.nx.empty() ? 0 : 12) + (t.red.empty() ? 0 : 12)) * t.vertex_count() +
         36 * g.cones.size() + 28 * g.planes.size() + sizeof(Material) * scene.materials.size();
}

/// `work(progress)` with a bar; a signal stops it.
template <class Work>
auto watched(const char* name, bool visible, const Work& work) {
  ProgressBar bar(visible, 0, name);
  return work([&](double share) {
    bar.update(share);
    return StopSignals::seen() == 0;
  });
}

/// The same; what came after the last question counts as well.
template <class Work>
auto with_interrupt(const char* name, const std::string& during, bool visible, const Work& work) {
  try {
    auto made = watched(name, visible, work);
    if (StopSignals::seen() == 0)
      return made;
  } catch (const Stopped&) {
  }
  throw Interrupted(StopSignals::seen(), during);
}

[[noreturn]] void reject(const std::string& path, std::uint64_t need) {
  throw FileError(path,
                  "expected about " + gigabytes(own_memory().owned + need) +
                      " of memory to render it, found " + available_memory());
}

}  // namespace

Interrupted::Interrupted(int number, const std::string& during)
    : std::runtime_error("grelha: stopped by " + std::string(signal_name(number)) + " while " +
                         during),
      signal(number) {}

SceneFile load_scene(const std::string& path,
                     const Warn& warn,
                     const ReadOptions& options,
                     bool visible) {
  SceneFile file = with_interrupt(
      "load", "reading " + path, visible, [&](const std::function<bool(double)>& progress) {
        ReadOptions watched_options = options;
        watched_options.progress = progress;
        return read_scene(path, warn, watched_options);
      });
  if (file.frame != Frame{})
    grelha::warn(path + ": note: coordinates do not fit floats; they are " + text_of(file.frame));
  return file;
}

void check_memory(const std::string& path, std::uint64_t bytes) {
  if (bytes >= own_memory().left())
    reject(path, bytes);
}

World build_world(const std::string& path,
                  const Scene& scene,
                  const BuildOptions& options,
                  std::uint64_t later,
                  bool visible) {
  check_memory(path, later);
  try {
    return with_interrupt("build",
                          "building the grids of " + path,
                          visible,
                          [&](const std::function<bool(double)>& progress) {
                            BuildOptions watched_options = options;
                            watched_options.progress = progress;
                            watched_options.most_bytes = own_memory().left() - later;
                            return World(scene, watched_options);
                          });
  } catch (const TooLarge& error) {
    reject(path, error.need.peak + later);
  }
}

PictureMemory picture_memory(const RenderCommand& command, const Camera& camera) {
  const bool part = is_partial_name(command.image), refined = command.render.refine.on(),
             subdivided = command.effects.adaptive.on;
  const auto width = std::uint64_t(camera.width), pixels = width * std::uint64_t(camera.height);
  const Range rows = command.work.rows.value_or(Range{0, camera.height});
  // rows outside the picture are refused later
  const auto height = std::uint64_t(std::clamp(rows.end - rows.begin, 1, camera.height));
  const bool refinable = command.render.refine.error > 0 && !command.work.checkpoint.empty();
  const std::uint64_t sum_bytes = refined      ? (refinable ? 2 : 1) * kRefined * pixels
                                  : subdivided ? kPixel * pixels
                                               : kSum * width * height;
  const auto threads = static_cast<std::uint64_t>(
      command.render.threads > 0 ? command.render.threads : std::thread::hardware_concurrency());
  // of 32 pixels a side and three divisions, or 8 and more than five
  const std::uint64_t tile_points = 1ull << std::max(16, 6 + 2 * command.render.subdivision.depth);
  PictureMemory memory;
  memory.sums = sum_bytes;
  memory.other = kProgram + thread_bytes(camera, command.render) +
                 (refined      ? kMaps * pixels
                  : subdivided ? kTilePoint * tile_points * threads
                               : 0);
  if (!part)
    memory.other += (kPixel + kFilePixel) * pixels;
  if (command.transparent)
    memory.other += (kPixel + kAlpha) * pixels;
  if (command.render.sampling.sampler == Sampler::kBlue)
    memory.other += kBlueIndex * pixels;
  return memory;
}

SceneMemory memory_of(const SceneFile& file, const BuildOptions& options) {
  const BuildMemory build = World::estimate(file.scene, options);
  const PictureMemory picture = picture_memory({}, file.camera);
  SceneMemory memory;
  memory.scene = geometry_bytes(file.scene);
  memory.grids = build.kept;
  memory.peak = memory.scene + std::max(kProgram + std::max(file.source_bytes, build.peak),
                                        build.kept + picture.sums + picture.other);
  return memory;
}

}  // namespace grelha
