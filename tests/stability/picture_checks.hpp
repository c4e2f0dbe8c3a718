#pragma once
// Helpers that render pictures with known results and count their wrong pixels.

#include <functional>

#include "grelha/render.hpp"
#include "tests/stability/pictures.hpp"

namespace grelha::stability {

Image picture(const Scene& scene,
              const Camera& camera,
              const RenderOptions& options,
              float density = 0);

/// Counts pixels that have a value for which `right` returns false.
void count(PictureCounts& c,
           const Image& image,
           const char* what,
           const std::function<bool(std::size_t, float)>& right);
/// Counts pixels of two pictures that differ in a bit.
void count_same(PictureCounts& c, const Image& a, const Image& b, const char* what);
/// Counts pixels that differ by more than `by`.
void count_close(PictureCounts& c, const Image& a, const Image& b, const char* what, float by);

Camera camera(int size, const Float3& eye, const Float3& at, double angle = 60);
/// Options with n samples per pixel.
RenderOptions samples(int n);
/// Returns a scene of sixty primitives, including mirrors.
Scene stage();

}  // namespace grelha::stability
