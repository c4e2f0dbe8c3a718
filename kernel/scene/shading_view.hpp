#pragma once
// The data that shading reads, as plain pointers.

#include <cstdint>

#include "grelha/camera.hpp"
#include "grelha/phase.hpp"

namespace grelha {

/// Sums of light are integers in units of 2^-32, so that they come out the same in whatever order
/// terms arrive.
inline constexpr double kLightUnit = 4294967296.0;
/// Terms are clamped to kMostLight divided by the samples a pixel, and to kMostTerm: then 64 of the
/// largest a sample still fit.
inline constexpr float kMostLight = 33554432.f;
inline constexpr float kMostTerm = 1048576.f;

/// A camera's frame: direction of a point (x, y) of the image, in pixels = forward + (x - w/2)
/// right + (h/2 - y) up. A ray through the point (a, b) of the unit disc of its lens starts at
/// eye + a lens_right + b lens_up. It goes to the point of that direction at depth `focus`. Where
/// rays are parallel, the same multiples of right and up move their origins instead.
struct FrameView {
  float eye[3] = {};
  float forward[3] = {};
  float right[3] = {};
  float up[3] = {};
  float lens_right[3] = {};
  float lens_up[3] = {};
  float focus = 1;
  int width = 0;
  int height = 0;
  bool lens = false;
  bool parallel = false;
};

/// The frame of a sound camera. Its tangent comes from a series of our own: libm's last bit depends
/// on the machine.
FrameView make_frame(const Camera& camera);

inline constexpr int kBatch = 512;     ///< rays shaded together
inline constexpr int kCacheLine = 16;  ///< floats
/// Length of an array of a batch: a cache line more than a power of two. A cache keeps few lines
/// whose addresses are equal modulo 4 KiB, and each hit writes to some thirty arrays side by side.
/// With the odd line all these stay in the cache.
inline constexpr int kBatchRow = kBatch + kCacheLine;
/// Vectors of a batch, an array per component.
struct Rows3 {
  alignas(64) float x[kBatchRow], y[kBatchRow], z[kBatchRow];
};

/// The same for longer arrays that stand elsewhere.
struct Columns3 {
  float *x, *y, *z;
};

/// Set in the depth of a waiting ray that was refracted.
inline constexpr std::uint32_t kRefracted = 1u << 31;

/// Rays waiting for their turn, last in first out. Arrays of `capacity` each.
struct RayStack {
  Columns3 org, dir, weight;
  float* share;  ///< only where keeps_shares()
  std::uint32_t *pixel, *depth;
  std::uint32_t *sample, *path;  ///< only when the plan is on
  int size, capacity;
};

/// The rays.
struct BatchRays {
  Rows3 org, dir;
  alignas(64) float t[kBatchRow];  ///< t of the hit, if its surface is computed from t
  Rows3 weight;
  alignas(64) float share[kBatchRow];
  std::uint32_t id[kBatchRow], pixel[kBatchRow], depth[kBatchRow];
  std::uint32_t sample[kBatchRow];  ///< of its pixel
  std::uint32_t path[kBatchRow];    ///< which bounces led here (0: none)
};

/// The hits of the rays, without the misses.
struct BatchHits {
  Rows3 point;                          ///< on the surface
  Rows3 normal;                         ///< geometric, unit, towards the viewer
  Rows3 shading;                        ///< normal for shading, unit, towards the viewer
  Rows3 viewer;                         ///< unit vector to it
  alignas(64) float offset[kBatchRow];  ///< how far along the normal a ray must start so as not to
                                        ///< hit its own surface
  alignas(64) float inside[kBatchRow];  ///< 1: hit from within
  Rows3 weight;                         ///< of the light from this point
  alignas(64) float share[kBatchRow];   ///< see split()
  std::uint32_t pixel[kBatchRow], depth[kBatchRow], material[kBatchRow];
  std::uint32_t sample[kBatchRow], path[kBatchRow];
  Rows3 color;  ///< of vertices, mixed: times diffuse and emission; only with ShadingView::colored
};

/// Shadow rays and the light each lets through.
struct BatchShadows {
  Rows3 org, dir;
  Rows3 light;
  std::uint32_t id[kBatchRow];  ///< a primitive in the way
  std::uint32_t pixel[kBatchRow];
};

/// One thread's arrays for one batch; the caller allocates one a thread.
struct Batch {
  BatchRays rays;
  BatchHits hits;
  BatchShadows shadows;
};

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
