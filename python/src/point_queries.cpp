#include <cmath>
#include <span>
#include <vector>

#include "grelha/all_hits.hpp"
#include "grelha/distance.hpp"
#include "src/hear.hpp"
#include "src/queries.hpp"

namespace grelha::python {
namespace {

constexpr double kLargestRadius = 1e19;  ///< more than from one end of space to the other

/// The points of one call as the kernel reads them.
class PointBatch {
 public:
  PointBatch(const Model& model, py::handle given) : frame_(model.frame), given_(given, "points") {}

  const Shape& shape() const { return given_.shape(); }
  const Triples& given() const { return given_; }
  std::size_t count() const { return given_.count(); }

  /// Copies where the points do not lie so. Needs no lock.
  std::span<const Float3> points() {
    if (count() == 0)
      return {};
    if (frame_ == Frame{} && given_.is_dense())
      return {reinterpret_cast<const Float3*>(given_.floats(0)), count()};
    copy_ = given_.in_frame(frame_);
    return copy_;
  }

 private:
  const Frame& frame_;
  Triples given_;
  std::vector<Float3> copy_;
};

QueryOptions options_of_points(int threads, const Progress& progress) {
  QueryOptions options;
  options.threads = threads;
  options.progress = progress;
  return options;
}

/// The points found, outside; where there is none, the points given.
template <class T>
py::array_t<T> found_points(const Model& model,
                            const Triples& given,
                            const std::vector<ClosestPoint>& found) {
  py::array_t<T> points(given.full_shape());
  T* to = points.mutable_data();
  for (std::size_t i = 0; i < found.size(); ++i) {
    const bool any{found[i]};
    const float p[3] = {found[i].point.x, found[i].point.y, found[i].point.z};
    for (std::size_t a = 0; a < 3; ++a)
      *to++ = static_cast<T>(any ? model.frame.outside(p[a], a) : given.points().at(i, a));
  }
  return points;
}

}  // namespace

py::object inside_points(const Model& model, py::handle given, py::handle wanted) {
  const int threads = threads_in(wanted);
  PointBatch batch(model, given);
  py::array_t<bool> inside(batch.shape());
  auto* const to = reinterpret_cast<std::uint8_t*>(inside.mutable_data());
  hear_signals(batch.count(), [&](const Progress& progress) {
    contains(model.world(),
             batch.points(),
             std::span(to, batch.count()),
             options_of_points(threads, progress));
  });
  return plain(inside, batch.shape());
}

py::object nearest_points(const Model& model,
                          py::handle given,
                          py::handle within,
                          py::handle wanted) {
  const int threads = threads_in(wanted);
  const double radius = number_in(within, "radius");
  if (!(radius >= 0 && (radius <= kLargestRadius || std::isinf(radius))))
    wrong_value("radius", "0 to 1e19, or inf", std::string(py::str(within)));
  PointBatch batch(model, given);
  const double scale = model.frame.scale;
  std::vector<ClosestPoint> found(batch.count());
  hear_signals(batch.count(), [&](const Progress& progress) {
    closest_points(model.world(),
                   batch.points(),
                   found,
                   as_float(radius * scale),
                   options_of_points(threads, progress));
  });
  const Shape& shape = batch.shape();
  py::array_t<float> distance(shape);
  py::array_t<std::int64_t> id(shape);
  float* const to_distance = distance.mutable_data();
  std::int64_t* const to_id = id.mutable_data();
  for (std::size_t i = 0; i < found.size(); ++i) {
    to_distance[i] = scale == 1 ? found[i].distance : as_float(found[i].distance / scale);
    to_id[i] = found[i] ? std::int64_t{found[i].id} : -1;
  }
  const bool in_double = model.in_double || batch.given().in_double();
  const py::object points = in_double
                                ? py::object(found_points<double>(model, batch.given(), found))
                                : py::object(found_points<float>(model, batch.given(), found));
  return result_class("ClosestPoints")(points, plain(distance, shape), plain(id, shape));
}

py::object signed_distances_of(const Model& model, py::handle given, py::handle wanted) {
  const int threads = threads_in(wanted);
  PointBatch batch(model, given);
  py::array_t<float> distances(batch.shape());
  float* const to = distances.mutable_data();
  hear_signals(batch.count(), [&](const Progress& progress) {
    signed_distances(model.world(),
                     batch.points(),
                     std::span(to, batch.count()),
                     options_of_points(threads, progress));
    if (model.frame.scale != 1)
      for (std::size_t i = 0; i < batch.count(); ++i)
        to[i] = as_float(to[i] / model.frame.scale);
  });
  return plain(distances, batch.shape());
}

}  // namespace grelha::python
