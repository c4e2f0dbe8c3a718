#include "perf/trace/caller_ways.hpp"

namespace grelha::perf {

void CallerWays::enter(const RayBuffer& rays, Cell& cell) {
  cell.first_caller = cell.ways.size();
  const auto add = [&](const char* name, std::function<void()> trace) {
    cell.ways.push_back({kGrelha, name, std::move(trace), {}});
  };
  add("call", [this, &rays] { call_each(world_, rays, any_, answers_); });
  add("streams of 8", [this, &rays] { ask_in_streams(world_, rays, any_, 8, {}, answers_); });
  add("default", [this, &rays] { ask_in_streams(world_, rays, any_, rays.size(), {}, answers_); });
}

}  // namespace grelha::perf
