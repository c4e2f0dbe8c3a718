#include "src/ray_batch.hpp"

#include <algorithm>
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
  if (skip)
    skip_ = skip.repeat<std::uint32_t>(
        shape_, "-1 or ids below " + std::to_string(model.primitives()), -1, model.primitives());
  if (mask)
    mask_ = mask.repeat<std::uint8_t>(shape_, "numbers from 0 to 255", 0, 256);
  if (given.masks.is_none())
    return;
  const auto masks = py::reinterpret_borrow<py::array>(given.masks);  // the caller holds it
  // add_mesh() in another thread makes masks longer before primitives
  masks_ = {static_cast<const std::uint8_t*>(masks.data()),
            std::min(std::size_t(masks.size()), std::size_t(model.primitives()))};
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
    const PointArray& lies = given.points();
    for (std::size_t a = 0; a < 3; ++a)
      axes[a] = reinterpret_cast<const float*>(lies.data + std::ptrdiff_t(a) * lies.axis_stride);
    stride = lies.stride / std::ptrdiff_t{sizeof(float)};
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
  const bool many = !t_min_.each.empty() || !t_max_.each.empty();
  const auto place = [&](Numbers& t, float unless) -> const float* {
    if (scale != 1)
      for (float& one : t.each)
        one = as_float(one * scale);
    const float all = as_float(t.all * scale);
    if (t.each.empty() && all != unless)
      t.each.assign(many ? count_ : 1, all);
    return t.each.empty() ? nullptr : t.each.data();
  };
  rays.t_min = place(t_min_, 0);
  rays.t_max = place(t_max_, kInfinity);
  rays.t_stride = many ? 1 : 0;
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
