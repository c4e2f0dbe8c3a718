#include "perf/trace/tables.hpp"

#include <cstdio>

#include "perf/embree.hpp"
#include "perf/ray_sets.hpp"
#include "perf/timing.hpp"

namespace grelha::perf {
namespace {

using CellText = std::function<std::string(const Row&, std::size_t, const Cell&)>;

void print_head(const std::vector<std::size_t>& kinds, const std::string& title) {
  std::printf("\n%s\n\n| %-8s |", title.c_str(), "");
  for (const std::size_t k : kinds)
    std::printf(" %s |", kRayKinds[k]);
  std::printf("\n|---|");
  for (std::size_t i = 0; i < kinds.size(); ++i)
    std::printf("--:|");
}

void print_table(const Options& options,
                 const std::vector<std::size_t>& kinds,
                 const Results& results,
                 const std::string& title,
                 const CellText& text) {
  print_head(kinds, title);
  for (const Row& row : options.rows) {
    if (!results.count(row.name))
      continue;
    std::printf("\n| %-8s |", row.name.c_str());
    for (const std::size_t k : kinds) {
      const auto& cells = results.at(row.name);
      const auto found = cells.find(k);
      std::printf(" %s |", found == cells.end() ? "" : text(row, k, found->second).c_str());
    }
  }
  std::printf("\n");
}

std::string format(const char* form, double a, double b = 0, double c = 0, double d = 0) {
  char text[96];
  std::snprintf(text, sizeof text, form, a, b, c, d);
  return text;
}

/// Grelha's time over that of a side, by the render's choice or by the best there is.
CellText against(Side side, bool choice) {
  return [=](const Row&, std::size_t, const Cell& c) {
    return format("%.2f", c.ratio(choice ? c.chosen : c.best[kGrelha], c.best[side]));
  };
}

std::string time_text(const Row&, std::size_t, const Cell& c) {
  return format("%.1f", median(c.ways[c.chosen].ns));
}

std::string counts_text(const Row&, std::size_t, const Cell& c) {
  return format("%.0f %%; %.1f; %.1f; %.0f %%",
                100 * c.lanes_busy(),
                c.tests(),
                c.cells(),
                100 * c.packet_fallbacks());
}

std::string caller_text(const Row&, std::size_t, const Cell& c) {
  const std::vector<double> r = c.caller_ratios();
  return format("%.2f; %.2f; %.2f", r[0], r[1], r[2]);
}

}  // namespace

void print_tables(const Options& options, const Results& results) {
  const auto print = [&](const std::string& title, const CellText& text) {
    print_table(options, options.kinds, results, title, text);
  };
  if (embree_modes().empty()) {
    std::printf("\nBuilt without Embree: no ratios.\n");
  } else {
    print("Time of Grelha, packets as a render forms them / time of Embree's best mode, robust",
          against(kRobust, true));
    print("Grelha's best / Embree's best, robust", against(kRobust, false));
    print("As a render forms them / Embree's best, not robust", against(kFast, true));
    print(
        "As a caller asks, robust: one ray a call / rtcIntersect1; streams of 8 / rtcIntersect8; "
        "one stream with the library's own options / Embree's best",
        caller_text);
  }
  print("ns a ray, as a render forms packets", time_text);
  print("Lanes busy; tests a ray; cells a ray; packets that fell back", counts_text);
}

}  // namespace grelha::perf
