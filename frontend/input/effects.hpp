#pragma once

#include <optional>

#include "frontend/scene/scene_file.hpp"
#include "grelha/render.hpp"

namespace grelha {

/// Effects of the command line, which override the scene's.
struct Effects {
  struct Shadows {
    bool hard = false;  ///< area lights of the scene shine from their centre
    float size = 0;     ///< side of the square that each point light becomes; scene units
    int positions = 1;  ///< N: a pixel's samples together see N x N positions of it
  };
  struct Lens {
    /// diameter in pixels of the view plane at the point looked at; 0: pinhole
    double aperture = 0;
    /// distance along the view, scene units; 0: the scene's, or the point looked at
    double focus = 0;
    int samples = 0;  ///< lens points for each subpixel; 0: one for each sample
  };
  struct Glossy {
    float roughness = 0;  ///< of every mirror
    int rays = 0;         ///< around the mirror direction, averaged with it; 0: one sampled ray
  };

  std::optional<int> samples;  ///< a pixel
  int jitter = 0;              ///< N x N jittered subpixels; 0: none
  /// on: squares that share their corners, in place of samples within pixels
  Subdivision adaptive;
  std::optional<Sampler> sampler;
  std::uint32_t seed = 0;
  std::optional<Shadows> shadows;
  std::optional<Lens> lens;
  std::optional<Glossy> glossy;
};

/// Applies effects to scene, camera and options. Without --samples or --aa, a scene with a lens, an
/// area light or a rough mirror takes its own `spp`, or 16 rays a pixel; any other scene takes one.
/// A point of a subdivided picture takes one ray, or the number of --samples or of a lens with N
/// points.
void apply_effects(const Effects& effects, SceneFile& file, RenderOptions& options);

}  // namespace grelha
