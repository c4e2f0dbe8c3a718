#include "src/ray_batch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grelha::python {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Broadcasts the rays' shape with that of one more argument.
void add_shape(Shape& shape, const Shape& with, const char* name) {
  if (!broadcast(shape, with))
    wrong_value(name,
                "a number or a shape that broadcasts with " + text_of(shape) + " of the rays",
                text_of(with));
}

template <class T, class Check>
std::vector<T> checked(const Wholes& given, const Shape& shape, const Check& check) {
  if (!given)
    return {};
  const py::array_t<std::int64_t> numbers = given.repeat(shape);
  std::vector<T> all(std::size_t(numbers.size()));
  std::transform(numbers.data(), numbers.data() + numbers.size(), all.begin(), check);
  return all;
}

/// Ids of primitives to skip: -1 is none.
std::vector<std::uint32_t> skips_for(const Wholes& given, const Model& model, const Shape& shape) {
  return checked<std::uint32_t>(given, shape, [&](std::int64_t id) {
    if (id < -1 || id >= std::int64_t{model.primitives()})
      wrong_value(
          "skip", "-1 or ids below " + std::to_string(model.primitives()), std::to_string(id));
    return id < 0 ? kNoPrimitive : std::uint32_t(id);
  });
}

std::vector<std::uint8_t> masks_for(const Wholes& given, const Shape& shape) {
  return checked<std::uint8_t>(given, shape, [&](std::int64_t mask) {
    if (mask < 0 || mask > 255)
      wrong_value("mask", "numbers from 0 to 255", std::to_string(mask));
    return std::uint8_t(mask);
  });
}

}  // namespace

RayBatch::RayBatch(const Model& model, const RayArguments& given)
    : model_(model),
      origins_{Triples(given.origins, "origins")},
      directions_{Triples(given.directions, "directions")},
      t_min_(given.t_min, "t_min"),
      t_max_(given.t_max, "t_max") {
  const Wholes skip(given.skip, "skip");
  const Wholes mask(given.mask, "mask");
  share_shape(skip, mask);
  skip_ = skips_for(skip, model, shape_);
  mask_ = masks_for(mask, shape_);
  if (given.masks.is_none())
    return;
  const auto masks = py::reinterpret_borrow<py::array>(given.masks);  // the caller holds it
  masks_ = {static_cast<const std::uint8_t*>(masks.data()), std::size_t(masks.size())};
}

void RayBatch::share_shape(const Wholes& skip, const Wholes& mask) {
  shape_ = origins_.given.shape();
  if (!broadcast(shape_, directions_.given.shape()))
    wrong_value(
        "directions",
        "a shape that broadcasts with " + text_of(origins_.given.full_shape()) + " of origins",
        text_of(directions_.given.full_shape()));
  add_shape(shape_, t_min_.shape(), "t_min");
  add_shape(shape_, t_max_.shape(), "t_max");
  add_shape(shape_, skip.shape(), "skip");
  add_shape(shape_, mask.shape(), "mask");
  count_ = size_of(shape_);
  origins_.given.repeat(shape_);
  directions_.given.repeat(shape_);
  t_min_.repeat(shape_);
  t_max_.repeat(shape_);
}

void RayBatch::Column::place(const Frame& frame, const float* (&axes)[3], std::ptrdiff_t& stride) {
  if (frame == Frame{} && given.lies_as_floats()) {
    for (std::size_t a = 0; a < 3; ++a)
      axes[a] = given.floats(a);
    stride = given.stride();
    return;
  }
  copy = given.in_frame(frame);
  if (copy.empty())
    return;
  axes[0] = &copy[0].x;
  axes[1] = &copy[0].y;
  axes[2] = &copy[0].z;
  stride = given.shape().empty() ? 0 : 3;
}

void RayBatch::place_range(Rays& rays) {
  const double scale = model_.frame.scale;
  for (Numbers* const n : {&t_min_, &t_max_})
    if (scale != 1)
      for (float& t : n->each)
        t = as_float(t * scale);
  const float low = as_float(t_min_.all * scale);
  const float high = as_float(t_max_.all * scale);
  const bool many = !t_min_.each.empty() || !t_max_.each.empty();
  if (many) {
    if (t_min_.each.empty() && low != 0)
      t_min_.each.assign(count_, low);
    if (t_max_.each.empty() && high != kInfinity)
      t_max_.each.assign(count_, high);
    rays.t_min = t_min_.each.empty() ? nullptr : t_min_.each.data();
    rays.t_max = t_max_.each.empty() ? nullptr : t_max_.each.data();
    return;
  }
  if (low == 0 && high == kInfinity)
    return;
  t_min_.each.assign(1, low);
  t_max_.each.assign(1, high);
  rays.t_min = t_min_.each.data();
  rays.t_max = t_max_.each.data();
  rays.t_stride = 0;
}

Rays RayBatch::rays() {
  Rays rays;
  rays.count = count_;
  origins_.place(model_.frame, rays.org, rays.org_stride);
  directions_.place({}, rays.dir, rays.dir_stride);
  place_range(rays);
  rays.skip = skip_.empty() ? nullptr : skip_.data();
  rays.mask = mask_.empty() ? nullptr : mask_.data();
  return rays;
}

}  // namespace grelha::python
