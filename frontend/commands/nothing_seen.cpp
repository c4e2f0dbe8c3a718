#include "frontend/commands/nothing_seen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>

#include "frontend/scene/bounds.hpp"
#include "frontend/commands/report.hpp"
#include "grelha/scene_spans.hpp"

namespace grelha {
namespace {

struct Direction {
  double x = 0;
  double y = 0;
  double z = 0;
};

Direction operator+(const Direction& a, const Direction& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Direction operator*(double s, const Direction& a) {
  return {s * a.x, s * a.y, s * a.z};
}
Direction between(const Float3& from, const Float3& to) {
  return {double(to.x) - from.x, double(to.y) - from.y, double(to.z) - from.z};
}
double inner(const Direction& a, const Direction& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Direction outer(const Direction& a, const Direction& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Direction of_length_one(const Direction& a) {
  return 1 / std::sqrt(inner(a, a)) * a;
}

/// Bit i: beyond side i of the view.
using Sides = unsigned;
constexpr std::size_t kSides = 5;
constexpr Sides kBehind = 1;
constexpr Sides kAllSides = (1 << kSides) - 1;

/// The pyramid that a picture shows; with a lens only the half space before the eye, which holds
/// all of its rays.
class View {
 public:
  explicit View(const Camera& camera) : eye_(camera.eye), lens_(camera.aperture > 0) {
    const double half_height = pixel_size(camera) * camera.height / 2;
    const double half_width = pixel_size(camera) * camera.width / 2;
    const Direction forward = of_length_one(between(camera.eye, camera.at));
    const Direction right = of_length_one(outer(forward, {camera.up.x, camera.up.y, camera.up.z}));
    const Direction up = outer(right, forward);
    inward_ = {forward,
               half_width * forward + right,
               half_width * forward + -1 * right,
               half_height * forward + up,
               half_height * forward + -1 * up};
    for (const double across : {-half_width, half_width})
      for (const double upward : {-half_height, half_height})
        corners_.push_back(forward + across * right + upward * up);
  }

  /// The sides that a ball, or a point, lies wholly beyond.
  Sides beyond(const Float3& center, double radius = 0) const {
    const Direction d = between(eye_, center);
    Sides sides = 0;
    for (std::size_t i = 0; i < (lens_ ? 1 : kSides); ++i)
      if (inner(d, inward_[i]) < -radius * std::sqrt(inner(inward_[i], inward_[i])))
        sides |= 1u << i;
    return sides;
  }
  /// Returns whether some ray of the view may hit an endless plane.
  bool meets(const Float3& point, const Float3& normal) const {
    const Direction n{normal.x, normal.y, normal.z};
    const double side = inner(between(eye_, point), n);
    return lens_ || std::any_of(corners_.begin(), corners_.end(), [&](const Direction& d) {
             return inner(d, n) * side > 0;
           });
  }

 private:
  Float3 eye_;
  bool lens_;
  std::array<Direction, kSides> inward_;  ///< normals of the sides: eye, left, right, below, above
  std::vector<Direction> corners_;
};

/// `common`: the sides that all primitives lie beyond. `all`: every primitive lies beyond some
/// side.
struct Unseen {
  Sides common = kAllSides;
  bool all = true;
  bool add(Sides sides) {
    common &= sides;
    all = all && sides != 0;
    return all;
  }
};

/// Stops at the first primitive that may be seen.
Unseen unseen(const Geometry& g, const View& view) {
  Unseen found;
  for (std::size_t i = 0; i < g.planes.size(); ++i)
    if (!found.add(view.meets({g.planes.x[i], g.planes.y[i], g.planes.z[i]},
                              {g.planes.nx[i], g.planes.ny[i], g.planes.nz[i]})
                       ? 0
                       : kAllSides & ~kBehind))
      return found;
  const Spheres& s = g.spheres;
  for (std::size_t i = 0; i < s.size(); ++i)
    if (!found.add(view.beyond({s.x[i], s.y[i], s.z[i]}, std::abs(double(s.radius[i])))))
      return found;
  const Cones& c = g.cones;
  for (std::size_t i = 0; i < c.size(); ++i)
    if (!found.add(view.beyond({c.base_x[i], c.base_y[i], c.base_z[i]},
                               std::abs(double(c.base_radius[i]))) &
                   view.beyond({c.apex_x[i], c.apex_y[i], c.apex_z[i]},
                               std::abs(double(c.apex_radius[i])))))
      return found;
  const Triangles& t = g.triangles;
  const auto at = [&](std::uint32_t v) { return view.beyond({t.x[v], t.y[v], t.z[v]}); };
  for (std::size_t i = 0; i < t.size(); ++i)
    if (!found.add(at(t.a[i]) & at(t.b[i]) & at(t.c[i])))
      return found;
  return found;
}

bool is_empty(const Geometry& g) {
  return g.planes.size() + g.spheres.size() + g.cones.size() + g.triangles.size() == 0;
}

bool is_lit(const Scene& scene) {
  const auto shines = [](const Light& light) { return light.color != Float3{}; };
  if (std::any_of(scene.lights.begin(), scene.lights.end(), shines))
    return true;
  const std::vector<char> used = used_materials(scene);
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i] && scene.materials[i].emission != Float3{})
      return true;
  return false;
}

std::string point_words(const Frame& frame, const Float3& at) {
  const auto [x, y, z] = frame.outside(at);
  char text[96];
  std::snprintf(text, sizeof text, frame == Frame{} ? "%g %g %g" : "%.10g %.10g %.10g", x, y, z);
  return text;
}

Float3 middle_of(const SceneBounds& b) {
  return {b.low.x + (b.high.x - b.low.x) / 2,
          b.low.y + (b.high.y - b.low.y) / 2,
          b.low.z + (b.high.z - b.low.z) / 2};
}

std::string outside_text(const SceneFile& file, const Unseen& found) {
  if (found.common & kBehind)
    return "everything lies behind the eye: exchange \"from\" and \"at\", or turn the view round";
  const SceneBounds bounds = bounds_of(file.scene.geometry);
  return "everything lies outside the view: widen \"angle\"" +
         (bounds.empty ? ""
                       : ", or look \"at " + point_words(file.frame, middle_of(bounds)) +
                             "\", the middle of the scene");
}

}  // namespace

void warn_empty_image(const std::string& path,
                      const SceneFile& file,
                      const Camera& camera,
                      const Warn& warn) {
  const auto add_warning = [&](const std::string& message) {
    warn(path + ": warning: " + message);
  };
  const Scene& scene = file.scene;
  if (file.points > 0)
    add_warning(std::to_string(file.points) + (file.points == 1 ? " point has" : " points have") +
                " no faces and will not be drawn: make a mesh of them, or spheres");
  if (is_empty(scene.geometry)) {
    if (file.points == 0)
      add_warning("nothing to draw: add an object, such as \"s 0 0 0 1\"");
    return;
  }
  if (!is_lit(scene))
    add_warning("no light: surfaces will show no color of their own; add one, such as \"l " +
                point_words(file.frame, camera.eye) + '"');
  if (const Unseen found = unseen(scene.geometry, View(camera)); found.all)
    add_warning(outside_text(file, found));
}

}  // namespace grelha
