#pragma once

#include <optional>

#include "tests/stability/rows.hpp"

namespace grelha::stability {

/// Grelha, by one copy of its loops: rays in packets, on their own, and to lights by their grids.
class GrelhaTracer final : public Tracer {
 public:
  explicit GrelhaTracer(const Variant& variant) : variant_(variant) {}
  void build(const Trial& trial) override {
    grid_.reset();
    world_.emplace(trial.scene, BuildOptions{.density = trial.density});
    if (trial.light)
      grid_.emplace(*world_, *trial.light);
  }
  int ways() const override { return grid_ ? 3 : 2; }
  const char* way_name(int way) const override {
    return way == 0 ? "packets" : way == 1 ? "single" : "point grid";
  }
  Answers closest(const RayList& rays, int way) override {
    return trace(variant_, *world_, rays, settings(way), test::Query::kClosest);
  }
  Answers occluded(const RayList& rays, int way) override {
    if (way == 2)
      return by_grid(rays);
    return trace(variant_, *world_, rays, settings(way), test::Query::kOccluded);
  }

 private:
  Answers by_grid(const RayList& rays) {
    const Points points{.at = {rays.ox.data(), rays.oy.data(), rays.oz.data()},
                        .count = rays.size()};
    std::vector<std::uint8_t> blocked(rays.size());
    grelha::occluded(*grid_, points, blocked.data(), {.isa = variant_.name});
    Answers out;
    out.block(rays, blocked);
    return out;
  }
  static TraceOptions settings(int way) {
    return way == 0 ? TraceOptions{256, true} : TraceOptions{1, true};
  }
  const Variant& variant_;
  std::optional<World> world_;
  std::optional<PointGrid> grid_;
};

}  // namespace grelha::stability
