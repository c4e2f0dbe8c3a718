#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "grelha/all_hits.hpp"
#include "grelha/query.hpp"
#include "src/hear.hpp"
#include "src/queries.hpp"

namespace grelha::python {
namespace {

using Ids = py::array_t<std::int64_t>;

QueryOptions options_of(const RayBatch& batch, int threads, const Progress& progress) {
  return {.threads = threads, .mask = batch.masks(), .progress = progress};
}

/// t in the caller's units.
void unscale(float* t, std::size_t count, double scale) {
  if (scale != 1)
    for (std::size_t i = 0; i < count; ++i)
      t[i] = as_float(t[i] / scale);
}

std::int64_t signed_id(std::uint32_t id) {
  return id == kNoPrimitive ? -1 : std::int64_t{id};
}

/// The answers of closest(), in the arrays that are given back.
struct Answers {
  py::array_t<float> t, u, v;
  Ids id, face;

  Answers(const Model& model, const Shape& shape)
      : t(shape), u(shape), v(shape), id(shape), face(model.is_one_mesh() ? id : Ids(shape)) {}
};

/// Where the answers lie; needs no lock.
struct AnswerArrays {
  float *t, *u, *v;
  std::int64_t *id, *face;
};

struct AnswerOfOne {
  float t, u, v;
  std::int64_t id, face;
};

/// Turns the kernel's ids to the caller's, and t of misses to infinity.
void finish(const Model& model,
            const std::uint32_t* ids,
            std::size_t count,
            const AnswerArrays& to) {
  const std::int64_t first = model.first_triangle();
  const std::int64_t end = first + std::int64_t(model.geometry().triangles.size());
  const bool is_one_mesh = to.face == to.id;
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t id = signed_id(ids[i]);
    to.id[i] = id;
    if (id < 0)
      to.t[i] = std::numeric_limits<float>::infinity();
    if (!is_one_mesh)
      to.face[i] = id >= first && id < end ? id - first : -1;
  }
  unscale(to.t, count, model.frame.scale);
}

}  // namespace

py::object result_class(const char* name) {
  // never destroyed: the interpreter may be gone before it
  static const auto* const results =
      new py::dict(py::module_::import("grelha._results").attr("__dict__"));
  return (*results)[name];
}

namespace {

/// The answer for one ray as plain numbers.
py::object closest_hit(const Model& model, RayBatch& batch) {
  AnswerOfOne one;
  std::uint32_t id;
  const Hits hits{.t = &one.t, .id = &id, .u = &one.u, .v = &one.v};
  closest(model.world(), batch.rays(), hits, options_of(batch, 1, {}));
  finish(model, &id, 1, {&one.t, nullptr, nullptr, &one.id, &one.face});
  return result_class("Hits")(one.t, one.id, one.u, one.v, one.face);
}

}  // namespace

py::object closest_hits(const Model& model, const RayArguments& given, py::handle wanted) {
  const int threads = threads_in(wanted);
  RayBatch batch(model, given);
  if (batch.shape().empty())
    return closest_hit(model, batch);
  Answers answers(model, batch.shape());
  const AnswerArrays to{answers.t.mutable_data(),
                        answers.u.mutable_data(),
                        answers.v.mutable_data(),
                        answers.id.mutable_data(),
                        answers.face.mutable_data()};
  hear_signals(batch.count(), [&](const Progress& progress) {
    const auto ids = std::make_unique_for_overwrite<std::uint32_t[]>(batch.count());
    const Hits hits{.t = to.t, .id = ids.get(), .u = to.u, .v = to.v};
    closest(model.world(), batch.rays(), hits, options_of(batch, threads, progress));
    finish(model, ids.get(), batch.count(), to);
  });
  return result_class("Hits")(answers.t, answers.id, answers.u, answers.v, answers.face);
}

py::object occluded_rays(const Model& model, const RayArguments& given, py::handle wanted) {
  const int threads = threads_in(wanted);
  RayBatch batch(model, given);
  py::array_t<bool> blocked(batch.shape());
  static_assert(sizeof(bool) == sizeof(std::uint8_t));
  auto* const to = reinterpret_cast<std::uint8_t*>(blocked.mutable_data());
  hear_signals(batch.count(), [&](const Progress& progress) {
    occluded(model.world(), batch.rays(), to, options_of(batch, threads, progress));
  });
  return plain(blocked, batch.shape());
}

namespace {

/// Lists of hits or crossings as the arrays that are given back.
struct ListArrays {
  Ids offsets, id;
  py::array_t<float> t;

  template <class Item>
  ListArrays(const std::vector<std::size_t>& offset, const std::vector<Item>& items, double scale)
      : offsets(py::ssize_t(offset.size())),
        id(py::ssize_t(items.size())),
        t(py::ssize_t(items.size())) {
    std::copy(offset.begin(), offset.end(), offsets.mutable_data());
    std::int64_t* const to_id = id.mutable_data();
    float* const to_t = t.mutable_data();
    for (std::size_t i = 0; i < items.size(); ++i) {
      to_id[i] = items[i].id;
      to_t[i] = items[i].t;
    }
    unscale(to_t, items.size(), scale);
  }
};

/// The counts of one of the kernel's functions.
template <class Count>
py::object counted(const Model& model,
                   const RayArguments& given,
                   py::handle wanted,
                   const Count& count) {
  const int threads = threads_in(wanted);
  RayBatch batch(model, given);
  Ids counts(batch.shape());
  std::int64_t* const to = counts.mutable_data();
  hear_signals(batch.count(), [&](const Progress& progress) {
    const auto found = std::make_unique_for_overwrite<std::uint32_t[]>(batch.count());
    count(batch.rays(), found.get(), options_of(batch, threads, progress));
    std::copy(found.get(), found.get() + batch.count(), to);
  });
  return plain(counts, batch.shape());
}

}  // namespace

py::object all_ray_hits(const Model& model, const RayArguments& given, py::handle wanted) {
  const int threads = threads_in(wanted);
  RayBatch batch(model, given);
  HitLists lists;
  hear_signals(batch.count(), [&](const Progress& progress) {
    lists = all_hits(model.world(), batch.rays(), options_of(batch, threads, progress));
  });
  const ListArrays arrays(lists.offset, lists.hits, model.frame.scale);
  return result_class("HitLists")(arrays.offsets, arrays.t, arrays.id);
}

py::object ray_crossings(const Model& model, const RayArguments& given, py::handle wanted) {
  const int threads = threads_in(wanted);
  RayBatch batch(model, given);
  CrossingLists lists;
  hear_signals(batch.count(), [&](const Progress& progress) {
    lists = crossings(model.world(), batch.rays(), options_of(batch, threads, progress));
  });
  const ListArrays arrays(lists.offset, lists.crossings, model.frame.scale);
  py::array_t<bool> enters(py::ssize_t(lists.crossings.size()));
  std::transform(lists.crossings.begin(),
                 lists.crossings.end(),
                 enters.mutable_data(),
                 [](const Crossing& crossing) { return crossing.enters; });
  return result_class("CrossingLists")(arrays.offsets, arrays.t, arrays.id, enters);
}

py::object hit_counts(const Model& model, const RayArguments& given, py::handle wanted) {
  return counted(model, given, wanted, [&](const Rays& rays, auto* counts, const auto& options) {
    count_hits(model.world(), rays, counts, options);
  });
}

py::object crossing_counts(const Model& model, const RayArguments& given, py::handle wanted) {
  return counted(model, given, wanted, [&](const Rays& rays, auto* counts, const auto& options) {
    count_crossings(model.world(), rays, counts, options);
  });
}

}  // namespace grelha::python
