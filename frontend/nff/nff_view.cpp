#include "frontend/nff/nff_view.hpp"

#include "frontend/scene/double3.hpp"

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

}  // namespace grelha
