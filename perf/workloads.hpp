#pragma once
// Scenes and rays to time, made once and shared by all methods.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "frontend/scene/scene_file.hpp"
#include "grelha/query.hpp"
#include "grelha/render.hpp"
#include "kernel/query/variants.hpp"

namespace grelha::perf {

/// Rays as arrays, with room for their answers.
struct RayBuffer {
  std::vector<float> ox, oy, oz, dx, dy, dz, t_min, t_max;
  std::size_t size() const { return ox.size(); }
  void add(const float (&org)[3], const float (&dir)[3], float t_end);
  /// Rays [first, first + count).
  Rays view(std::size_t first, std::size_t count) const;
  Rays view() const { return view(0, size()); }
};

struct Answers {
  std::vector<float> t;               ///< of closest hits
  std::vector<std::uint32_t> id;      ///< the same
  std::vector<std::uint8_t> blocked;  ///< of occlusion
  /// Makes room for `count`, of occlusion with `any`.
  void resize(std::size_t count, bool any);
  std::size_t size() const { return std::max(t.size(), blocked.size()); }
  /// Returns true if ray i hits something.
  bool met(std::size_t i) const { return t.empty() ? blocked[i] != 0 : id[i] != kNoPrimitive; }
  /// Returns true if answer i equals the k-th of `others` bit for bit.
  bool same(std::size_t i, const Answers& others, std::size_t k) const;
  bool operator==(const Answers&) const = default;
};

/// A scene of the project's own generators, read back through the readers: "balls", 4.
SceneFile make_scene(const std::string& name, int size);
/// A file, or what `GENERATOR SIZE` says.
SceneFile scene_named(const std::string& name);

/// One ray through the centre of every pixel, in tiles of 8 x 8 pixels as a render traces them.
RayBuffer camera_rays(const Camera& camera);

/// Answers by the functions a caller has: a call for each ray.
void call_each(const World& world, const RayBuffer& rays, bool any, Answers& answers);
/// The same in streams of so many rays.
void ask_in_streams(const World& world,
                    const RayBuffer& rays,
                    bool any,
                    std::size_t each,
                    const QueryOptions& options,
                    Answers& answers);

/// Calls set(word, value) for each option of a command line. Returns false if a value is missing or
/// `set` does not know an option.
template <class Set>
bool set_options(int argc, char** argv, const Set& set) {
  for (int i = 1; i < argc; i += 2)
    if (i + 1 == argc || !set(argv[i], argv[i + 1]))
      return false;
  return true;
}

/// Answers to rays by one method of one instruction set; `any`: occlusion.
void trace(const World& world,
           const Variant& variant,
           const TraceOptions& settings,
           const Rays& rays,
           bool any,
           Answers& answers,
           TraceCounts& counts);

}  // namespace grelha::perf
