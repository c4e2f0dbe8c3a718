#include <cmath>
#include <span>
#include <vector>

#include "grelha/all_hits.hpp"
#include "grelha/distance.hpp"
#include "src/hear.hpp"
#include "src/queries.hpp"

namespace grelha::python {
namespace {

constexpr std::pair<const char*, InsideRule> kRules[] = {{"closed", InsideRule::kClosed},
                                                         {"odd", InsideRule::kOdd},
                                                         {"nonzero", InsideRule::kNonzero},
                                                         {"winding", InsideRule::kWinding}};
constexpr std::size_t kFewTriangles = 100'000;  ///< are checked in less than .05 s
constexpr double kLargestRadius = 1e19;         ///< more than from one end of space to the other

InsideRule rule_in(py::handle given) {
  if (!py::isinstance<py::str>(given))
    wrong_type("inside", "\"closed\", \"odd\", \"nonzero\" or \"winding\"", given);
  const auto name = given.cast<std::string>();
  for (const auto& [known, rule] : kRules)
    if (name == known)
      return rule;
  wrong_value("inside", "\"closed\", \"odd\", \"nonzero\" or \"winding\"", name);
}

/// Lets a large mesh be checked, or put into clusters, while signals are heard: asked for no point,
/// the kernel does nothing else.
void prepare(const SharedModel& model, InsideRule rule) {
  if (rule != InsideRule::kOdd && model->geometry().triangles.size() > kFewTriangles)
    hear_signals_beside([model, rule] { contains(model->world(), {}, {}, {.inside = rule}); });
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

py::object inside_points(const SharedModel& model,
                         py::handle given,
                         py::handle rule,
                         py::handle wanted) {
  const int threads = threads_in(wanted);
  const InsideRule inside_rule = rule_in(rule);
  const Triples asked(given, "points");
  std::vector<Float3> copy;
  py::array_t<bool> inside(asked.shape());
  auto* const to = reinterpret_cast<std::uint8_t*>(inside.mutable_data());
  prepare(model, inside_rule);
  hear_signals(asked.count(), [&](const Progress& progress) {
    contains(model->world(),
             asked.in_frame(model->frame, copy),
             std::span(to, asked.count()),
             {.threads = threads, .inside = inside_rule, .progress = progress});
  });
  return plain(inside, asked.shape());
}

py::object nearest_points(const SharedModel& shared,
                          py::handle given,
                          py::handle within,
                          py::handle wanted) {
  const Model& model = *shared;
  const int threads = threads_in(wanted);
  const double radius = number_in(within, "radius");
  if (!(radius >= 0 && (radius <= kLargestRadius || std::isinf(radius))))
    wrong_value("radius", "0 to 1e19, or inf", std::string(py::str(within)));
  const Triples asked(given, "points");
  std::vector<Float3> copy;
  const double scale = model.frame.scale;
  std::vector<ClosestPoint> found(asked.count());
  hear_signals(asked.count(), [&](const Progress& progress) {
    closest_points(model.world(),
                   asked.in_frame(model.frame, copy),
                   found,
                   as_float(radius * scale),
                   {.threads = threads, .progress = progress});
  });
  const Shape& shape = asked.shape();
  py::array_t<float> distance(shape);
  py::array_t<std::int64_t> id(shape);
  float* const to_distance = distance.mutable_data();
  std::int64_t* const to_id = id.mutable_data();
  for (std::size_t i = 0; i < found.size(); ++i) {
    to_distance[i] = scale == 1 ? found[i].distance : as_float(found[i].distance / scale);
    to_id[i] = found[i] ? std::int64_t{found[i].id} : -1;
  }
  const bool in_double = model.in_double || asked.in_double();
  const py::object points = in_double ? py::object(found_points<double>(model, asked, found))
                                      : py::object(found_points<float>(model, asked, found));
  return result_class("ClosestPoints")(points, plain(distance, shape), plain(id, shape));
}

py::object signed_distances_of(const SharedModel& model,
                               py::handle given,
                               py::handle rule,
                               py::handle wanted) {
  const int threads = threads_in(wanted);
  const InsideRule inside_rule = rule_in(rule);
  const Triples asked(given, "points");
  std::vector<Float3> copy;
  py::array_t<float> distances(asked.shape());
  float* const to = distances.mutable_data();
  prepare(model, inside_rule);
  hear_signals(asked.count(), [&](const Progress& progress) {
    signed_distances(model->world(),
                     asked.in_frame(model->frame, copy),
                     std::span(to, asked.count()),
                     {.threads = threads, .inside = inside_rule, .progress = progress});
    if (model->frame.scale != 1)
      for (std::size_t i = 0; i < asked.count(); ++i)
        to[i] = as_float(to[i] / model->frame.scale);
  });
  return plain(distances, asked.shape());
}

py::object winding_numbers_of(const SharedModel& model,
                              py::handle given,
                              py::handle within,
                              py::handle wanted) {
  const int threads = threads_in(wanted);
  const double error = number_in(within, "error");
  if (!(error > 0))
    wrong_value("error", "a number above 0", std::string(py::str(within)));
  const Triples asked(given, "points");
  std::vector<Float3> copy;
  py::array_t<double> numbers(asked.shape());
  double* const to = numbers.mutable_data();
  prepare(model, InsideRule::kWinding);
  hear_signals(asked.count(), [&](const Progress& progress) {
    winding_numbers(model->world(),
                    asked.in_frame(model->frame, copy),
                    std::span(to, asked.count()),
                    error,
                    {.threads = threads, .progress = progress});
  });
  return plain(numbers, asked.shape());
}

}  // namespace grelha::python
