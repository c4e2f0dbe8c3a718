#pragma once
// Three programs as a user writes them, by Grelha and by Embree: what a library asks of its users,
// and what it gives. programs.py counts the lines of each between its heading and the next.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "grelha/geometry.hpp"

namespace grelha::perf {

/// A mesh as files hold it.
struct Mesh {
  std::vector<Float3> vertices;
  std::vector<std::array<std::uint32_t, 3>> faces;
  Float3 center(std::size_t face) const {
    const auto& [a, b, c] = faces[face];
    return (1 / 3.f) * (vertices[a] + vertices[b] + vertices[c]);
  }
};

/// A pinhole camera. Direction of a pixel: corner + x right + y down.
struct View {
  Float3 eye, corner, right, down;
  std::size_t width, height;
  Float3 toward(std::size_t x, std::size_t y) const {
    return corner + static_cast<float>(x) * right + static_cast<float>(y) * down;
  }
};

/// What a click on a pixel picks.
struct Picked {
  std::uint32_t face = 0xFFFFFFFF, vertex = 0xFFFFFFFF;  ///< the vertex that is nearest
  Float3 point;
};

/// Returns a point on the unit sphere, the same for the same number.
inline Float3 on_sphere(std::uint64_t number) {
  const auto next = [&number] {
    number = (number ^ (number >> 31)) * 0x9E3779B97F4A7C15u + 0xD1B54A32D192ED03u;
    return static_cast<float>(number >> 40) * 0x1p-23f - 1;
  };
  for (;;) {
    const Float3 p{next(), next(), next()};
    const float squared = dot(p, p);
    if (squared > .01f && squared < 1)
      return normalized(p);
  }
}

constexpr std::size_t kRaysPerFace = 16;
constexpr int kBounces = 5;
constexpr float kAlbedo = .7f;

namespace by_grelha {
/// The share of the sky that each face sees.
std::vector<float> ambient_occlusion(const Mesh& mesh);
std::vector<Picked> pick(const Mesh& mesh, const View& view, std::size_t clicks);
/// Radiance of pixels under a white sky, one path a pixel, one ray a call.
std::vector<float> path_trace(const Mesh& mesh, const View& view);
}  // namespace by_grelha

namespace by_embree {
std::vector<float> ambient_occlusion(const Mesh& mesh);
std::vector<Picked> pick(const Mesh& mesh, const View& view, std::size_t clicks);
std::vector<float> path_trace(const Mesh& mesh, const View& view);
}  // namespace by_embree

}  // namespace grelha::perf
