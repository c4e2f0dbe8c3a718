#pragma once
// What pictures with a known answer are made with, and counted.

#include <functional>

#include "grelha/render.hpp"
#include "tests/stability/pictures.hpp"

namespace grelha::stability {

Image picture(const Scene& scene,
              const Camera& camera,
              const RenderOptions& options,
              float density = 0);

/// Counts pixels for which `right` does not hold of a value of theirs.
void count(PictureCounts& c,
           const Image& image,
           const char* what,
           const std::function<bool(std::size_t, float)>& right);
/// Pixels of two pictures that differ in a bit.
void count_same(PictureCounts& c, const Image& a, const Image& b, const char* what);
/// Those that differ by more.
void count_close(PictureCounts& c, const Image& a, const Image& b, const char* what, float by);

Camera camera(int size, const Float3& eye, const Float3& at, double angle = 60);
/// Options of so many samples a pixel.
RenderOptions samples(int n);
/// Sixty primitives, some of them mirrors.
Scene stage();

}  // namespace grelha::stability
