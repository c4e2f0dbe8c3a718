#include "frontend/nff/nff_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "frontend/scene/double3.hpp"
#include "frontend/scene/scene_builder.hpp"

namespace grelha {
namespace {

int pixels(NffInput& input) {
  const std::string_view word = input.words.next();
  std::int64_t value = 0;
  if (!to_integer(word, value) || value < 1 || value > kMostSide)
    input.fail(word, "a resolution from 1 to 65536 pixels a side");
  return int(value);
}

}  // namespace

std::span<const std::string_view> NffView::words() {
  static constexpr std::string_view kWords[] = {"v",
                                                "camera",
                                                "from",
                                                "eye",
                                                "at",
                                                "up",
                                                "angle",
                                                "hither",
                                                "resolution",
                                                "aperture",
                                                "focal",
                                                "view"};
  return kWords;
}

bool NffView::read(std::string_view word, NffInput& input, LensHint& lens) {
  if (word == "v" || word == "camera")
    begin(word, input);
  else if (word == "from" || word == "eye") {
    from_ = word;
    camera_.eye = input.bounded_framed_point("the view's eye");
  } else if (word == "at") {
    at_ = word;
    camera_.at = input.bounded_framed_point("the point looked at");
  } else if (word == "up") {
    up_ = word;
    camera_.up = input.bounded_point("the view's up direction");
  } else if (word == "angle")
    read_angle(input);
  else if (word == "hither")
    input.number("the hither distance");
  else if (word == "resolution") {
    resolution_ = word;
    read_resolution(input);
  } else if (word == "aperture" || word == "apperture")
    read_aperture(input, lens);
  else if (word == "focal") {
    lens.present = true;
    lens.focal = double(input.bounded("the focal ratio"));
  } else if (word == "view")
    input.number("the view distance");
  else
    return false;
  return true;
}

void NffView::begin(std::string_view word, NffInput& input) {
  if (!view_.empty())
    input.warn_once("second view", word, "a second view; the last one counts");
  view_ = word;
}

void NffView::read_angle(NffInput& input) {
  const std::string_view word = input.words.next();
  double value = 0;
  if (!to_number(word, value))
    input.fail(word, "a number for the view's angle");
  if (!(value > 0 && value < 180))
    input.fail(word, "an angle between 0 and 180 degrees");
  angle_ = word;
  camera_.angle_deg = value;
}

void NffView::read_resolution(NffInput& input) {
  camera_.width = pixels(input);
  camera_.height = pixels(input);
}

void NffView::read_aperture(NffInput& input, LensHint& lens) {
  lens.present = true;
  lens.aperture = double(input.bounded("the lens aperture"));
}

Camera NffView::finish(NffInput& input, std::string_view end) const {
  if (view_.empty() && from_.empty())
    input.fail(end, "a view (\"v\" or \"camera\")");
  const std::string_view start = view_.empty() ? from_ : view_;
  const auto need = [&](std::string_view word, const char* name) {
    if (word.empty())
      throw ParseError(input.position(start),
                       std::string("expected \"") + name + "\" in the view, found none");
  };
  need(from_, "from");
  need(at_, "at");
  need(up_, "up");
  need(angle_, "angle");
  if (resolution_.empty())
    input.warn_once("resolution", start, "the view has no resolution; 512 512 is taken");

  const Double3 view = difference(camera_.at, camera_.eye), up = in_double(camera_.up);
  if (length(view) == 0)
    throw ParseError(input.position(at_),
                     "expected a point to look at apart from the eye, found the same point");
  if (length(up) == 0)
    throw ParseError(input.position(up_), "expected an up direction, found 0 0 0");
  // Floats of a nearly parallel pair leave no digits for the picture's horizon below about 1e-6.
  constexpr double kLeastSine = 1e-6;
  if (!(length(cross(view, up)) > kLeastSine * length(view) * length(up)))
    throw ParseError(input.position(up_),
                     "expected an up direction that is not along the view, found one that is");
  return camera_;
}

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

Light parallelogram(const Float3& corner,
                    const Float3& edge1,
                    const Float3& edge2,
                    const Float3& color) {
  return {corner + 0.5f * (edge1 + edge2), color, edge1, edge2};
}

/// A rectangle centered at a position, facing `at`.
Light facing(
    const Float3& center, const Float3& at, float width, float height, const Float3& color) {
  const Float3 view = unit(at - center);
  const Float3 side =
      unit(cross(view, std::abs(view.z) < 0.9f ? Float3{0, 0, 1} : Float3{0, 1, 0}));
  return {center, color, width * side, height * cross(side, view)};
}

}  // namespace

void NffLights::add(NffInput& input, std::string_view keyword, const Light& light) {
  if (!is_finite_float(light.position))
    throw ParseError(input.position(keyword),
                     "expected an area light within 1e18, found a larger one");
  file_.scene.lights.push_back(light);
  ++file_.counts.lights;
}

/// The color that follows on this line, if one does.
std::optional<Float3> NffLights::color_on_line(NffInput& input) {
  if (!looks_like_number(input.words.peek_on_line()))
    return {};
  float color[3];
  for (float& part : color) {
    const std::string_view word = input.words.peek_on_line();
    if (word.empty())
      throw ParseError(input.position(word), "a number for the light's color", "end of line");
    part = input.bounded("the light's color");
  }
  return Float3{color[0], color[1], color[2]};
}

/// A seventh number makes an intensity of the fourth: ENFF.
void NffLights::read_point(NffInput& input, std::string_view keyword) {
  const Float3 position = input.bounded_framed_point("the light's position");
  std::optional<Float3> color = color_on_line(input);
  if (!color)
    colorless_.push_back(file_.scene.lights.size());
  else if (looks_like_number(input.words.peek_on_line()))
    color = color->x * Float3{color->y, color->z, input.bounded("the light's color")};
  add(input, keyword, {position, color.value_or(Float3{}), {}, {}});
}

void NffLights::read_light(NffInput& input, std::string_view keyword) {
  const std::string_view kind = input.words.next();
  if (kind == "punctual") {
    const Float3 position = input.bounded_framed_point("the light's position");
    add(input, keyword, {position, input.bounded_point("the light's color"), {}, {}});
  } else if (kind == "quad") {
    const Float3 corner = input.bounded_framed_point("the light's corner");
    const Float3 color = input.bounded_point("the light's color");
    const Float3 second = input.bounded_framed_point("the light's second corner"),
                 third = input.bounded_framed_point("the light's third corner");
    const std::string_view samples = input.words.next();
    std::int64_t count = 0;
    if (!to_integer(samples, count) || count < 0 || count > 1000000)
      input.fail(samples, "a whole number, at most 1000000, for the light's samples");
    add(input, keyword, parallelogram(corner, second - corner, third - corner, color));
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
    add(input,
        keyword,
        facing(framed_point(frame, n, 0), framed_point(frame, n, 3), width, height, triple(n, 8)));
    return;
  }
  add(input,
      keyword,
      parallelogram(
          framed_point(frame, n, 0), vector(frame, n, 3), vector(frame, n, 6), triple(n, 9)));
}

/// Of programs in which light falls off with distance.
void NffLights::add_scaled(NffInput& input, std::string_view keyword, const Light& light) {
  input.warn_once(
      "power of light",
      keyword,
      "light does not fall off here: the brightest light of \"L\", \"la\" and \"ls\" gets "
      "the power 1");
  scaled_.push_back(file_.scene.lights.size());
  add(input, keyword, light);
}

/// `la`: corner and two edges; `ls`: radius and centre; then a color, or white.
void NffLights::read_shape(NffInput& input, std::string_view keyword) {
  const std::size_t enough = keyword == "la" ? 9 : 4;
  const std::vector<NumberWord> n = input.numbers(enough, "the light");
  if (n.size() != enough && n.size() != enough + 3)
    input.fail(
        input.words.peek(),
        std::to_string(enough) + " or " + std::to_string(enough + 3) + " numbers for the light");
  const Float3 color = n.size() == enough ? Float3{1, 1, 1} : triple(n, enough);
  const Frame& frame = input.frame;
  if (keyword == "la") {
    add_scaled(
        input,
        keyword,
        parallelogram(framed_point(frame, n, 0), vector(frame, n, 3), vector(frame, n, 6), color));
    return;
  }
  input.warn_once("ls", keyword, "a light that is a ball is drawn as a point");
  add_scaled(input, keyword, {framed_point(frame, n, 1), color, {}, {}});
}

/// `r g b power`, and perhaps `atten` and three numbers of how the light falls off.
void NffLights::read_glow(NffInput& input) {
  const Float3 color = input.bounded_point("the light's color");
  const float power = input.bounded("the light's power");
  if (input.words.peek_on_line() == "atten") {
    input.words.next();
    input.bounded_point("the light's falloff");
  }
  glow_ = power * color;
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
  add_scaled(input, keyword, parallelogram(a, b - a, d - a, glow_));
  return true;
}

/// Scales lights to a largest component of 1.
void NffLights::finish_scaled() {
  float most = 0;
  for (const std::size_t i : scaled_) {
    const Float3& color = file_.scene.lights[i].color;
    most = std::max({most, color.x, color.y, color.z});
  }
  for (const std::size_t i : scaled_) {
    Float3& color = file_.scene.lights[i].color;
    if (most > 0)
      color = {color.x / most, color.y / most, color.z / most};
  }
}

/// No intensity is prescribed for lights without color; SPD's own writers use 1/sqrt(N).
void NffLights::finish() {
  const auto even = float(1 / std::sqrt(double(file_.scene.lights.size())));
  for (const std::size_t i : colorless_)
    file_.scene.lights[i].color = {even, even, even};
  finish_scaled();
}

}  // namespace grelha
