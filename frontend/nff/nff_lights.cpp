#include "frontend/nff/nff_lights.hpp"

#include "frontend/scene/double3.hpp"
#include "frontend/scene/scene_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace grelha {
namespace {

Float3 triple(const std::vector<NumberWord>& n, std::size_t first) {
  return {n[first].value, n[first + 1].value, n[first + 2].value};
}
/// The same of a position in the scene, and of a length along each axis.
Float3 framed_point(const Frame& frame, const std::vector<NumberWord>& n, std::size_t first) {
  std::array<double, 3> p{};
  for (std::size_t a = 0; a < 3; ++a)
    to_number(n[first + a].word, p[a]);
  return frame.inside(p);
}
Float3 vector(const Frame& frame, const std::vector<NumberWord>& n, std::size_t first) {
  return framed_point({{}, frame.scale}, n, first);
}
Float3 unit(const Float3& a) {
  const double l = length(in_double(a));
  return l > 0 ? Float3{float(a.x / l), float(a.y / l), float(a.z / l)} : Float3{0, 0, 1};
}

/// A rectangle centered at a position, facing `at`.
AreaLight facing(
    const Float3& center, const Float3& at, float width, float height, const Float3& color) {
  const Float3 view = unit(at - center);
  const Float3 side =
      unit(cross(view, std::abs(view.z) < 0.9f ? Float3{0, 0, 1} : Float3{0, 1, 0}));
  AreaLight light;
  light.edge1 = width * side;
  light.edge2 = height * cross(side, view);
  light.corner = center - 0.5f * (light.edge1 + light.edge2);
  light.color = color;
  return light;
}

}  // namespace

void NffLights::add_point(Float3 position, Float3 color) {
  file_.scene.lights.push_back({position, color, {}, {}});
  ++file_.counts.lights;
}

void NffLights::read_point(NffInput& input) {
  const Float3 position = input.bounded_framed_point("the light's position");
  if (!looks_like_number(input.words.peek_on_line())) {
    colorless_.push_back(file_.scene.lights.size());
    add_point(position, {});
    return;
  }
  float color[3];
  for (float& part : color) {
    const std::string_view word = input.words.peek_on_line();
    if (word.empty())
      throw ParseError(input.position(word), "a number for the light's color", "end of line");
    part = input.bounded("the light's color");
  }
  add_point(position, {color[0], color[1], color[2]});
}

void NffLights::add_area(NffInput& input, std::string_view keyword, AreaLight light) {
  const Float3 center = light.corner + 0.5f * (light.edge1 + light.edge2);
  if (!is_finite_float(center))
    throw ParseError(input.position(keyword),
                     "expected an area light within 1e18, found a larger one");
  light.light = std::uint32_t(file_.scene.lights.size());
  file_.area_lights.push_back(light);
  add_point(center, light.color);
  file_.scene.lights.back().edge1 = light.edge1;
  file_.scene.lights.back().edge2 = light.edge2;
}

void NffLights::read_light(NffInput& input, std::string_view keyword) {
  const std::string_view kind = input.words.next();
  if (kind == "punctual") {
    const Float3 position = input.bounded_framed_point("the light's position");
    add_point(position, input.bounded_point("the light's color"));
  } else if (kind == "quad") {
    AreaLight light;
    light.corner = input.bounded_framed_point("the light's corner");
    light.color = input.bounded_point("the light's color");
    light.edge1 = input.bounded_framed_point("the light's second corner") - light.corner;
    light.edge2 = input.bounded_framed_point("the light's third corner") - light.corner;
    const std::string_view samples = input.words.next();
    std::int64_t count = 0;
    if (!to_integer(samples, count) || count < 0 || count > 1000000)
      input.fail(samples, "a whole number, at most 1000000, for the light's samples");
    light.samples = int(count);
    add_area(input, keyword, light);
  } else {
    input.fail(kind, "\"punctual\" or \"quad\" after \"light\"");
  }
}

void NffLights::read_area(NffInput& input, std::string_view keyword) {
  const std::vector<NumberWord> n = input.numbers(11, "the area light");
  if (n.size() < 11)
    input.fail(
        input.words.peek(),
        "a number for the area light (field " + std::to_string(n.size() + 1) + " of 11 or 12)");
  const Frame& frame = input.frame;
  if (n.size() == 11) {
    const float width = frame.length(double{n[6].value});
    const float height = frame.length(double{n[7].value});
    add_area(
        input,
        keyword,
        facing(framed_point(frame, n, 0), framed_point(frame, n, 3), width, height, triple(n, 8)));
    return;
  }
  AreaLight light;
  light.corner = framed_point(frame, n, 0);
  light.edge1 = vector(frame, n, 3);
  light.edge2 = vector(frame, n, 6);
  light.color = triple(n, 9);
  add_area(input, keyword, light);
}

/// `r g b power`, and perhaps `atten` and three numbers of how the light falls off.
void NffLights::read_glow(NffInput& input, std::string_view keyword) {
  const Float3 color = input.bounded_point("the light's color");
  const float power = input.bounded("the light's power");
  if (input.words.peek_on_line() == "atten") {
    input.words.next();
    input.bounded_point("the light's falloff");
  }
  glow_ = power * color;
  if (glows())
    input.warn_once("L",
                    keyword,
                    "polygons behind \"L\" are area lights; light does not fall off here, so the "
                    "brightest of them gets the power 1");
}

bool NffLights::read_glowing(NffInput& input, std::string_view keyword) {
  const char* const before = input.words.cursor();
  const std::size_t size = input.count("the polygon's corners", keyword == "pp" ? 12 : 6);
  Float3 corners[4];
  for (std::size_t i = 0; size == 4 && i < size; ++i) {
    corners[i] = input.framed_point("the polygon's corner");
    if (keyword == "pp")
      input.point("the corner's normal");
  }
  const auto& [a, b, c, d] = corners;
  const Float3 across = c - a, gap = (b + d) - (a + c);
  if (size != 4 || !is_finite_float(across) ||
      !(length(in_double(gap)) <= 1e-3 * length(in_double(across)))) {
    input.words.go_on_at(before);
    input.warn_once("glowing polygon",
                    keyword,
                    "a polygon behind \"L\" that is no parallelogram; "
                    "it does not shine");
    return false;
  }
  AreaLight light;
  light.corner = a;
  light.edge1 = b - a;
  light.edge2 = d - a;
  light.color = glow_;
  glowing_.push_back(file_.area_lights.size());
  add_area(input, keyword, light);
  return true;
}

/// Scales the lights of `L` to a largest component of 1: their powers assume light that falls off
/// with distance.
void NffLights::finish_glowing() {
  float most = 0;
  for (const std::size_t i : glowing_) {
    const Float3& color = file_.area_lights[i].color;
    most = std::max({most, color.x, color.y, color.z});
  }
  for (const std::size_t i : glowing_) {
    AreaLight& light = file_.area_lights[i];
    if (most > 0)
      light.color = {light.color.x / most, light.color.y / most, light.color.z / most};
    file_.scene.lights[light.light].color = light.color;
  }
}

/// No intensity is prescribed for lights without color; SPD's own writers use 1/sqrt(N).
void NffLights::finish() {
  const auto even = float(1 / std::sqrt(double(file_.scene.lights.size())));
  for (const std::size_t i : colorless_)
    file_.scene.lights[i].color = {even, even, even};
  finish_glowing();
}

}  // namespace grelha
