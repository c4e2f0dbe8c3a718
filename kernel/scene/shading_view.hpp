#pragma once
// The data that shading reads, as plain pointers.

#include <cstdint>

#include "kernel/scene/batch.hpp"
#include "kernel/scene/frame.hpp"
#include "kernel/scene/light_unit.hpp"
#include "grelha/phase.hpp"

namespace grelha {

enum MaterialField {
  kDiffuseR,
  kDiffuseG,
  kDiffuseB,
  kSpecularR,
  kSpecularG,
  kSpecularB,
  kMirrorR,
  kMirrorG,
  kMirrorB,
  kEmissionR,
  kEmissionG,
  kEmissionB,
  kTransmission,
  kShine,
  kIor,
  kFresnel,
  kRoughness,
  kMaterialFields
};

struct MaterialView {
  const float* field[kMaterialFields] = {};  ///< [materials] each; kFresnel holds 0 or 1
};

/// The scene's light and colour, and which of its effects exist at all: effects that no material
/// asks for are never computed.
struct ShadingView {
  MaterialView materials;
  const float* lights = nullptr;  ///< [kLightFloats * light_count] centre, colour, edge, edge
  int light_count = 0;
  float background[3] = {};
  bool smooth = false;
  bool colored = false;  ///< vertices have colours
  bool reflects = false;
  bool refracts = false;
  bool fresnel = false;
  bool emits = false;
  bool highlights = false;
  bool area = false;
  bool glossy = false;
  bool gains = false;  ///< some material sends on more than it gets: see split()
  /// a point, what its mirror and glass show left out, or the background: sends an eye at most so
  /// much
  float brightest = 0;
};

inline constexpr int kLightFloats = 12;

/// A near-square grid for `count` jittered samples, of no fewer cells.
struct Strata {
  std::uint32_t columns = 1;
  std::uint32_t rows = 1;
  std::uint32_t count = 1;
};

/// Which samples a picture takes. Only effects that are there get dimensions: pixel 2, then lens,
/// light, gloss 2 each.
struct SamplePlan {
  enum Kind : int { kSobol, kJitter, kRandom, kBlue };
  bool on = false;  ///< false: one ray through each pixel's centre and nothing to sample
  int samples = 1;  ///< a pixel
  Kind kind = kSobol;
  std::uint32_t seed = 0;
  int lens = -1, light = -1, glossy = -1;  ///< first of the effect's two dimensions
  int light_rays = 1;                      ///< shadow rays a hit sends to an area light
  /// rays around the mirror direction, added to that direction itself; 0: one ray in its place
  int glossy_rays = 0;
  Strata pixel_strata, light_strata, glossy_strata;
  const std::uint32_t* places = nullptr;  ///< [pixels] of kBlue, see drawing_places()
};

/// image rows a thread takes at a time: one row of 8 x 8 packets
inline constexpr int kStripRows = 8;
inline constexpr int kTile = 8;
/// Pixel k of a tile, along Morton's curve: any 4, 16 or 64 in a row from a multiple of that are a
/// square.
constexpr int tile_x(int k) {
  return (k & 1) | (k >> 1 & 2) | (k >> 2 & 4);
}
constexpr int tile_y(int k) {
  return tile_x(k >> 1);
}

/// Consecutive samples of one pixel, in kParts parts of equal size with a sum each.
struct PixelRun {
  std::uint32_t pixel, first, count;  ///< count: a multiple of kParts
};
inline constexpr int kParts = 4;

struct StripWork {
  Batch* batch = nullptr;
  RayStack stack = {};
  /// [rows of the strip][width][3], units of 1 / kLightUnit, zero on entry
  std::int64_t* sums = nullptr;
  int depth = 1;
  int packet = 64;
  float min_weight = 0;  ///< see RenderOptions
  int take = kBatch;     ///< rays taken off the stack at a time, at most kBatch
  bool mailbox = true;
  std::uint32_t first_pixel = 0;  ///< of the strip, counted through the picture
  float most_light = 0;           ///< bound of a term
  SamplePlan plan = {};
  /// [sums] the pixel each sum belongs to; null: sum i to first_pixel + i
  const std::uint32_t* pixels = nullptr;
  /// [sums] the PixelBox of each sum's pixel, which gets half of the samples besides its share of
  /// the others; null: none has one
  const std::uint32_t* boxes = nullptr;
  Observer* observer = nullptr;  ///< null: no observer
};

/// Points of the picture in pixels from its upper left corner, neighbours next to each other; point
/// i has sum i.
struct PointList {
  const float *x, *y;  ///< [count]
  int count;
};

}  // namespace grelha
