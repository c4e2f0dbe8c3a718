#pragma once
// What shading sees, as plain pointers; and the memory one thread works in.

#include <cstdint>

namespace grelha {

enum MaterialField {
  kDiffuseR, kDiffuseG, kDiffuseB, kSpecularR, kSpecularG, kSpecularB, kMirrorR, kMirrorG, kMirrorB,
  kEmissionR, kEmissionG, kEmissionB, kTransmission, kShine, kIor, kFresnel, kMaterialFields
};

struct MaterialView {
  const float* field[kMaterialFields] = {};  ///< [materials] each; kFresnel holds 0 or 1
};

/// The scene's light and colour, and which of its effects exist at all: what no material asks for is never computed.
struct ShadingView {
  MaterialView materials;
  const float* lights = nullptr;  ///< [6 * light_count] position, colour
  int light_count = 0;
  float background[3] = {};
  bool smooth = false, reflects = false, refracts = false, fresnel = false, emits = false, highlights = false;
};

/// A pinhole camera's frame: direction of a point (x, y) of the image, in pixels = forward + (x - w/2) right + (h/2 - y) up.
struct FrameView {
  float eye[3] = {}, forward[3] = {}, right[3] = {}, up[3] = {};
  int width = 0, height = 0;
};

/// Sums of light are integers in units of 2^-32, so that they come out the same in whatever order terms arrive.
inline constexpr double kLightUnit = 4294967296.0;
/// Terms are clamped to this, so that 2^11 of the largest still fit.
inline constexpr float kMostLight = 1048576.f;

inline constexpr int kBatch = 512;     ///< rays shaded together
inline constexpr int kBandRows = 8;    ///< image rows a thread takes at a time: one row of 8 x 8 packets
inline constexpr int kTile = 8;

/// Set in the depth of a waiting ray that was refracted.
inline constexpr std::uint32_t kRefracted = 1u << 31;

/// Rays waiting for their turn, last in first out. Arrays of `capacity` floats each.
struct RayStack {
  float *ox, *oy, *oz, *dx, *dy, *dz, *wr, *wg, *wb;
  std::uint32_t *pixel, *depth;
  int size, capacity;
};

/// One thread's arrays for one batch; the caller allocates one a thread.
struct Batch {
  // the rays
  alignas(64) float ox[kBatch], oy[kBatch], oz[kBatch], dx[kBatch], dy[kBatch], dz[kBatch], t_min[kBatch], t[kBatch];
  alignas(64) float wr[kBatch], wg[kBatch], wb[kBatch];
  std::uint32_t id[kBatch], pixel[kBatch], depth[kBatch];
  // what they met, misses left out
  alignas(64) float px[kBatch], py[kBatch], pz[kBatch];     ///< point on the surface
  alignas(64) float gx[kBatch], gy[kBatch], gz[kBatch];     ///< geometric normal, unit, towards the viewer
  alignas(64) float nx[kBatch], ny[kBatch], nz[kBatch];     ///< shading normal, unit, towards the viewer
  alignas(64) float vx[kBatch], vy[kBatch], vz[kBatch];     ///< unit vector to the viewer
  alignas(64) float away[kBatch];                           ///< how far along g a ray must start so as not to meet its own surface
  alignas(64) float inside[kBatch];                         ///< 1: met from within
  alignas(64) float hr[kBatch], hg[kBatch], hb[kBatch];     ///< weight of what this point sends
  std::uint32_t hit_pixel[kBatch], hit_depth[kBatch], material[kBatch];
  // shadow rays and the light each lets through
  alignas(64) float lox[kBatch], loy[kBatch], loz[kBatch], ldx[kBatch], ldy[kBatch], ldz[kBatch], lt_min[kBatch], lt[kBatch];
  alignas(64) float lr[kBatch], lg[kBatch], lb[kBatch];
  std::uint32_t lid[kBatch], light_pixel[kBatch];
};

struct BandWork {
  Batch* batch;
  RayStack stack;
  std::int64_t* sums;  ///< [rows of the band][width][3], units of 1 / kLightUnit, zero on entry
  int depth, packet;   ///< packet 0: chosen by kind of ray
  int take;            ///< rays taken off the stack at a time, at most kBatch
  bool mailbox;
};

}  // namespace grelha
