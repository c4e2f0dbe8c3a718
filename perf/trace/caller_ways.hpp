#pragma once
// Rays as a caller of the kernel as a library asks them: more ways of Grelha's.

#include "perf/trace/cell.hpp"

namespace grelha::perf {

class CallerWays {
 public:
  /// `any`: occlusion.
  CallerWays(const World& world, bool any) : world_(world), any_(any) {}
  /// Enters calls of one ray, streams of eight, and one stream of all with no options as ways of
  /// the cell that traces these rays, which must outlive the cell as this must.
  void enter(const RayBuffer& rays, Cell& cell);

 private:
  const World& world_;
  bool any_;
  Answers answers_;
};

}  // namespace grelha::perf
