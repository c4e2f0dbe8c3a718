#pragma once
// What the host and the copies of the kernel say to each other: plain arrays and functions of C. A
// type of Grelha may have another layout in the other tree.

#include <cstddef>
#include <cstdint>

namespace grelha::perf {

/// Arrays of a scene's geometry, which outlive its worlds.
struct PlainScene {
  std::size_t spheres = 0, vertices = 0, triangles = 0, cones = 0, planes = 0, objects = 0;
  const float* sphere[4] = {};          ///< x, y, z, radius
  const float* vertex[3] = {};          ///< x, y, z
  const std::uint32_t* corner[3] = {};  ///< of triangles
  const float* cone[8] = {};            ///< base x, y, z, radius; apex x, y, z, radius
  const float* plane[6] = {};           ///< point, normal
  const std::uint32_t* object[2] = {};  ///< first triangle, number of triangles
};

struct PlainRays {
  const float *org[3] = {}, *dir[3] = {}, *t_min = nullptr, *t_max = nullptr;
  std::size_t count = 0;
};

/// Where answers go: t and id of closest hits, or, if `blocked` is not null, occlusion alone.
struct PlainAnswers {
  float* t = nullptr;  ///< null: not wanted
  std::uint32_t* id = nullptr;
  std::uint8_t* blocked = nullptr;
};

/// How rays are asked.
enum Way : int {
  kAsRender,  ///< all, as a render traces them
  kCalls,     ///< a call of the library for each
  kStreams,   ///< a call of the library for each eight
  kWithoutT,  ///< as a render, but ids alone
};

// Each copy has these.
#define GRELHA_AB extern "C" __attribute__((visibility("default")))
GRELHA_AB void* ab_world(const PlainScene* scene);
GRELHA_AB void ab_free(void* world);
GRELHA_AB void ab_run(void* world, int way, const PlainRays* rays, const PlainAnswers* answers);
#undef GRELHA_AB

}  // namespace grelha::perf
