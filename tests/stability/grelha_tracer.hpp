#pragma once

#include <optional>

#include "tests/stability/rows.hpp"

namespace grelha::stability {

/// Grelha, by one copy of its loops: rays in packets and on their own.
class GrelhaTracer final : public Tracer {
 public:
  explicit GrelhaTracer(const Variant& variant) : variant_(variant) {}
  void build(const Trial& trial) override {
    world_.emplace(trial.scene, BuildOptions{.density = trial.density});
  }
  int ways() const override { return 2; }
  const char* way_name(int way) const override { return way == 0 ? "packets" : "single"; }
  Answers closest(const RayList& rays, int way) override {
    return trace(variant_, *world_, rays, settings(way), test::Query::kClosest);
  }
  Answers occluded(const RayList& rays, int way) override {
    return trace(variant_, *world_, rays, settings(way), test::Query::kOccluded);
  }

 private:
  static TraceOptions settings(int way) {
    return way == 0 ? TraceOptions{256, true} : TraceOptions{1, true};
  }
  const Variant& variant_;
  std::optional<World> world_;
};

}  // namespace grelha::stability
