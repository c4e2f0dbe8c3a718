#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "frontend/commands/commands.hpp"
#include "frontend/scene/scene_file.hpp"
#include "grelha/render.hpp"

namespace grelha {

struct Seconds {
  double load = 0, build = 0, render = 0, write = 0;
  double render_cpu = 0;  ///< of all threads together, independent of other load on the machine
};

/// The statistics of one run of `grelha render`.
struct RunReport {
  EntityCounts counts;
  std::size_t spheres = 0, triangles = 0, cones = 0, planes = 0;  ///< as the kernel holds them
  int width = 0, height = 0;
  int ranks = 1;  ///< processes that shared the work, `render.threads` of the first
  std::vector<GridStats> grids;
  RenderStats render;
  Seconds seconds;
  std::size_t geometry_bytes = 0, grid_bytes = 0;
};

/// Bytes that rendering a scene will take, by an estimate.
struct SceneMemory {
  std::uint64_t scene = 0, grids = 0;  ///< while it is rendered
  std::uint64_t peak = 0;              ///< at most, be it while reading, building or rendering
};

/// A warning where the picture does not meet the error that --error asks for, else nothing.
std::string unmet_error(const RenderCommand& command, const RunReport& report);

std::string stats_json(const RenderCommand& command, const RunReport& report);
/// `grids`: absent when they were not built; a mesh is not checked then.
std::string info_json(const SceneFile& file,
                      const SceneMemory& memory,
                      const std::optional<std::vector<GridStats>>& grids);
/// JSON of several scenes as one object, by file.
std::string info_json(const std::vector<std::pair<std::string, std::string>>& of_files);
std::string info_text(const std::string& path,
                      const SceneFile& file,
                      const SceneMemory& memory,
                      const std::optional<std::vector<GridStats>>& grids);
std::string report_line_of(const RenderCommand& command, const RunReport& report);

/// "balls of radius 0.1", or of several, for vertices without faces.
std::string balls_text(const SceneFile& file);

/// The features of a renderer by name, and whether the scene uses them. Materials that no primitive
/// has do not count.
using Needs = std::vector<std::pair<const char*, bool>>;

Needs needs_of(const SceneFile& file);

}  // namespace grelha
