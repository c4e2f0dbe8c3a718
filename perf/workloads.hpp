#pragma once
// Scenes and rays to time, made once and shared by all methods.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "frontend/scene/scene_file.hpp"
#include "grelha/render.hpp"
#include "kernel/query/variants.hpp"

namespace grelha::perf {

/// Rays as arrays, with room for their answers.
struct RayBuffer {
  std::vector<float> ox, oy, oz, dx, dy, dz, t_min, t_max;
  std::size_t size() const { return ox.size(); }
  void add(const float (&org)[3], const float (&dir)[3], float t_end);
};

struct Answers {
  std::vector<float> t;
  std::vector<std::uint32_t> id;
  bool operator==(const Answers&) const = default;
};

/// A scene of the project's own generators, read back through the readers: "balls", 4.
SceneFile make_scene(const std::string& name, int size);

/// One ray through the centre of every pixel, in tiles of 8 x 8 pixels as a render traces them.
RayBuffer camera_rays(const Camera& camera);

/// Answers of rays [first, first + count) by one method of one instruction set.
void trace(const World& world,
           const Variant& variant,
           const TraceSettings& settings,
           const RayBuffer& rays,
           std::size_t first,
           std::size_t count,
           Answers& answers,
           TraceCounts& counts);

}  // namespace grelha::perf
