// Insides and signed distances, by Grelha's rules and by others.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "grelha/inside.hpp"
#include "grelha/mesh_check.hpp"
#include "perf/distance/others.hpp"
#include "perf/timing.hpp"

namespace grelha::perf {
namespace {

constexpr double kDiffer = 1e-3;  ///< share of points that others may sort elsewhere: by rounding

struct Column {
  std::function<void()> ask;
  int rounds;  ///< at most
  double us = 1e300;
};

void measure(std::vector<Column>& columns, int rounds, std::size_t count) {
  for (int round = 0; round < rounds; ++round)
    for (Column& column : columns)
      if (column.ask && round < column.rounds) {
        const double from = cpu_ns();
        column.ask();
        column.us = std::min(column.us, (cpu_ns() - from) / 1e3 / static_cast<double>(count));
      }
}

std::size_t differing(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    count += a[i] != b[i];
  return count;
}

}  // namespace

bool print_insides(const std::string& name,
                   const Scene& scene,
                   const std::string& points,
                   std::span<const Float3> asked,
                   int rounds) {
  const World world(scene, {});
  const bool closed = check_mesh(world).is_closed();
  const std::size_t count = asked.size();
  std::vector<std::uint8_t> inside(count), wound(count), of_cgal(count), of_vtk(count);
  std::vector<float> signed_distance(count);
  std::vector<double> number(count), vtk_distance(count);
  const auto cgal = closed ? make_cgal_inside(scene.geometry.triangles) : nullptr;
  const auto vtk = make_vtk_inside(scene.geometry.triangles);
  const InsideRule rule = closed ? InsideRule::kClosed : InsideRule::kWinding;
  constexpr int kMany = 1000, kFew = 2;  // VTK takes long
  std::vector<Column> columns(8, Column{{}, kMany});
  if (closed)
    columns[0].ask = [&] { contains(world, asked, inside, {.threads = 1}); };
  columns[1].ask = [&] {
    contains(world, asked, wound, {.threads = 1, .inside = InsideRule::kWinding});
  };
  columns[2].ask = [&] { winding_numbers(world, asked, number, .01, {.threads = 1}); };
  columns[3].ask = [&] { winding_numbers(world, asked, number, .001, {.threads = 1}); };
  columns[4].ask = [&] {
    signed_distances(world, asked, signed_distance, {.threads = 1, .inside = rule});
  };
  if (cgal)
    columns[5].ask = [&] { cgal->contains(asked, of_cgal); };
  if (vtk) {
    columns[6] = {[&] { vtk->contains(asked, of_vtk); }, kFew};
    columns[7] = {[&] { vtk->distances(asked, vtk_distance); }, kFew};
  }
  measure(columns, rounds, count);
  std::printf("| %s | %s |", name.c_str(), points.c_str());
  for (const Column& column : columns)
    column.ask ? std::printf(" %.2f |", column.us) : std::printf(" - |");
  const std::size_t from_vtk = vtk ? differing(closed ? inside : wound, of_vtk) : 0;
  vtk ? std::printf(" %zu |\n", from_vtk) : std::printf(" - |\n");
  std::fflush(stdout);
  if (cgal && differing(inside, of_cgal) > 0) {
    std::printf("%s: CGAL: %zu others\n", points.c_str(), differing(inside, of_cgal));
    return false;
  }
  return !closed || differing(inside, wound) <= kDiffer * static_cast<double>(count);
}

}  // namespace grelha::perf
