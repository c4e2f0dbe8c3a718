#pragma once
// Small scenes with effects, as work for parts and checkpoints.

#include "frontend/scene/scene_file.hpp"
#include "grelha/render.hpp"

namespace grelha::test {

/// A scene with effects, and how it is rendered.
struct Case {
  const char* scene;
  int samples;
  /// letters: l lens, a area lights, g rough mirrors, n rays around the mirror direction, j
  /// jittered, r random
  const char* effects;
};

struct Job {
  SceneFile file;
  RenderOptions options;
};

Job make_job(const Case& c);

bool same_bits(const Image& a, const Image& b);

}  // namespace grelha::test
