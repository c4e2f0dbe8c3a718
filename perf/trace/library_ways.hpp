#pragma once
// Rays as a caller of the library asks them: more ways of Grelha's.

#include "perf/trace/cell.hpp"

namespace grelha::perf {

class LibraryWays {
 public:
  /// `any`: occlusion.
  LibraryWays(const World& world, bool any) : world_(world), any_(any) {}
  /// Enters calls of one ray, streams of eight, and one stream of all with the library's own
  /// options as ways of the cell that traces these rays, which must outlive the cell as this must.
  void enter(const RayBuffer& rays, Cell& cell);

 private:
  void call(const RayBuffer& rays);
  /// In streams of so many.
  void stream(const RayBuffer& rays, std::size_t each);

  const World& world_;
  bool any_;
  Answers answers_;
};

}  // namespace grelha::perf
