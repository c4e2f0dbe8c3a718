#include "perf/trace/library_ways.hpp"

#include <algorithm>

#include "grelha/query.hpp"

namespace grelha::perf {

void LibraryWays::enter(const RayBuffer& rays, Cell& cell) {
  answers_.resize(rays.size(), any_);
  cell.library = cell.ways.size();
  const auto add = [&](const char* name, std::function<void()> trace) {
    cell.ways.push_back({kGrelha, name, std::move(trace), {}});
  };
  add("call", [this, &rays] { call(rays); });
  add("streams of 8", [this, &rays] { stream(rays, 8); });
  add("default", [this, &rays] { stream(rays, rays.size()); });
}

void LibraryWays::call(const RayBuffer& r) {
  for (std::size_t i = 0; i < r.size(); ++i) {
    const Ray ray{{r.ox[i], r.oy[i], r.oz[i]}, {r.dx[i], r.dy[i], r.dz[i]}, r.t_min[i], r.t_max[i]};
    if (any_) {
      answers_.blocked[i] = occluded(world_, ray);
      continue;
    }
    const Hit hit = closest(world_, ray);
    answers_.t[i] = hit.t;
    answers_.id[i] = hit.id;
  }
}

void LibraryWays::stream(const RayBuffer& rays, std::size_t each) {
  for (std::size_t i = 0; i < rays.size(); i += each) {
    const Rays some = rays.view(i, std::min(each, rays.size() - i));
    if (any_)
      occluded(world_, some, answers_.blocked.data() + i);
    else
      closest(world_, some, {answers_.t.data() + i, answers_.id.data() + i});
  }
}

}  // namespace grelha::perf
