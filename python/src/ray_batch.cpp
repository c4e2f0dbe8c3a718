#include "src/ray_batch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grelha::python {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// One origin serves many directions, and the other way round.
Shape shared_shape(const Triples& origins, const Triples& directions) {
  if (origins.shape().empty())
    return directions.shape();
  if (!directions.shape().empty() && directions.shape() != origins.shape())
    wrong_value("directions",
                "shape " + text_of(origins.full_shape()) + " as of origins, or (3,)",
                text_of(directions.full_shape()));
  return origins.shape();
}

}  // namespace

std::vector<std::uint32_t> skips_for(py::handle given, const Model& model, const Shape& shape) {
  if (given.is_none())
    return {};
  const py::array_t<std::int64_t> ids = whole_numbers(given, "skip", text_of(shape).c_str());
  const Shape found(ids.shape(), ids.shape() + ids.ndim());
  if (!found.empty() && found != shape)
    wrong_value("skip", "a number or shape " + text_of(shape), text_of(found));
  const auto checked = [&](std::int64_t id) {
    if (id < -1 || id >= std::int64_t{model.primitives()})
      wrong_value(
          "skip", "-1 or ids below " + std::to_string(model.primitives()), std::to_string(id));
    return id < 0 ? kNoPrimitive : std::uint32_t(id);
  };
  std::size_t count = 1;
  for (const py::ssize_t n : shape)
    count *= std::size_t(n);
  if (found.empty())
    return std::vector<std::uint32_t>(count, checked(*ids.data()));
  std::vector<std::uint32_t> skips(count);
  std::transform(ids.data(), ids.data() + ids.size(), skips.begin(), checked);
  return skips;
}

RayBatch::RayBatch(const Model& model, const RayArguments& given)
    : model_(model),
      origins_{Triples(given.origins, "origins")},
      directions_{Triples(given.directions, "directions")},
      shape_(shared_shape(origins_.given, directions_.given)),
      t_min_(numbers_for(given.t_min, "t_min", shape_)),
      t_max_(numbers_for(given.t_max, "t_max", shape_)),
      skip_(skips_for(given.skip, model, shape_)) {
  for (const py::ssize_t n : shape_)
    count_ *= std::size_t(n);
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
  return rays;
}

}  // namespace grelha::python
