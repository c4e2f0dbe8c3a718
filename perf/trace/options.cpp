#include "perf/trace/options.hpp"

#include <algorithm>
#include <cstdlib>

#include "perf/ray_sets.hpp"

namespace grelha::perf {
namespace {

const std::vector<Row> kRows{
    {"balls 4", "", "balls", 4},
    {"balls 5", "", "balls", 5},
    {"balls 6", "", "balls", 6},
    {"mount 6", "", "mount", 6},
    {"mount 8", "", "mount", 8},
    {"mount 9", "", "mount", 9},
    {"bunny", "ply/bunny.ply", "knot", 15},
    {"dragon", "ply/dragon.ply", "knot", 18},
    {"armadillo", "ply/armadillo.ply", "knot", 11},
    {"lucy", "ply/lucy.ply", "knot", 18},
    {"blade", "ply/turbineblade.ply", "knot", 25},
    {"horse", "ply/horse.ply", "knot", 18},
    {"teapot", "spd/teapot.nff", "knot", 3},
    {"gears", "", "gears", 4},
    {"rings", "", "rings", 7},
    {"stadium", "", "stadium", 6},
    {"distant", "", "distant", 3},
};

/// A row of the table, `GENERATOR SIZE`, or a file.
Row row_named(const std::string& name) {
  for (const Row& row : kRows)
    if (row.name == name)
      return row;
  const auto space = name.find(' ');
  if (space != std::string::npos)
    return {name, "", name.substr(0, space), std::atoi(name.c_str() + space)};
  return {name, name, "", 0};
}

bool set_option(const std::string& word, const std::string& value, Options& o) {
  if (word == "--scene") {
    o.rows.push_back(row_named(value));
  } else if (word == "--kind") {
    const auto found = std::find(kRayKinds.begin(), kRayKinds.end(), value);
    if (found == kRayKinds.end())
      return false;
    o.kinds.push_back(static_cast<std::size_t>(found - kRayKinds.begin()));
  } else if (word == "--size") {
    o.size = std::atoi(value.c_str());
  } else if (word == "--rounds") {
    o.rounds = std::atoi(value.c_str());
  } else if (word == "--scenes") {
    o.scenes = value;
  } else {
    return false;
  }
  return true;
}

}  // namespace

bool parse(int argc, char** argv, Options& o) {
  for (int i = 1; i < argc; i += 2)
    if (i + 1 == argc || !set_option(argv[i], argv[i + 1], o))
      return false;
  if (o.rows.empty())
    o.rows = kRows;
  if (o.kinds.empty())
    for (std::size_t k = 0; k < kRayKinds.size(); ++k)
      o.kinds.push_back(k);
  return o.size >= 32 && o.size <= 16384 && o.rounds >= 1;
}

}  // namespace grelha::perf
