#include "perf/trace/cell.hpp"

#include <algorithm>
#include <limits>

#include "perf/timing.hpp"

namespace grelha::perf {
namespace {

double share_of(std::uint64_t part, std::uint64_t all) {
  return static_cast<double>(part) / static_cast<double>(std::max<std::uint64_t>(all, 1));
}

}  // namespace

double Cell::tests() const {
  const TestCounts& t = counts.tests;
  return share_of(t.sphere + t.triangle + t.cone + t.plane, rays);
}

double Cell::cells() const {
  return share_of(counts.visits, rays);
}

double Cell::lanes_busy() const {
  return share_of(counts.packets.lanes_busy, counts.packets.lanes_issued);
}

double Cell::packet_fallbacks() const {
  return share_of(counts.packets.packet_fallbacks,
                  counts.packets.packet_fallbacks + counts.packets.formed);
}

double Cell::ratio(std::size_t a, std::size_t b) const {
  std::vector<double> r;
  for (std::size_t i = 0; i < std::min(ways[a].ns.size(), ways[b].ns.size()); ++i)
    r.push_back(ways[a].ns[i] / ways[b].ns[i]);
  return median(r);
}

std::vector<double> Cell::caller_ratios() const {
  const auto best_of = [&](const std::string& name) {
    std::size_t found = best[kRobust];
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < ways.size(); ++i)
      if (ways[i].side == kRobust && ways[i].name.starts_with(name) && median(ways[i].ns) < least) {
        least = median(ways[i].ns);
        found = i;
      }
    return found;
  };
  return {ratio(first_caller, best_of("single")),
          ratio(first_caller + 1, best_of("8")),
          ratio(first_caller + 2, best[kRobust])};
}

void Cell::find_best() {
  for (std::size_t side = 0; side < kSides; ++side) {
    double least = 1e300;
    for (std::size_t i = 0; i < ways.size(); ++i)
      if (const Way& w = ways[i]; w.side == side && !w.ns.empty() && median(w.ns) < least) {
        least = median(w.ns);
        best[side] = i;
      }
  }
}

}  // namespace grelha::perf
