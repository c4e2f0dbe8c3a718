// A namespace of its own: the linker must not take functions of the kernel's scalar copy for these.
#define GRELHA_ISA reference
#define GRELHA_ISA_reference GRELHA_ISA_scalar
#include "tests/reference/reference.hpp"

#include "kernel/query/loops.hpp"
#include "tests/reference/walk.hpp"

namespace grelha {
namespace {

void walk_closest(const SceneView& scene,
                  const Rays& rays,
                  const Hits& hits,
                  const TraceOptions& settings,
                  TraceCounts& counts) {
  reference::closest(scene, rays, settings.mailbox, counts, hits);
}

void walk_occluded(const SceneView& scene,
                   const Rays& rays,
                   std::uint8_t* blocked,
                   const TraceOptions& settings,
                   TraceCounts& counts) {
  reference::occluded(scene, rays, settings.mailbox, counts, blocked);
}

bool always() {
  return true;
}

}  // namespace

const Variant& reference_walk() {
  static const VariantLoops loops = [] {
    VariantLoops l{};
    l.closest = walk_closest;
    l.occluded = walk_occluded;
    return l;
  }();
  static const Variant variant{"reference", 1, always, loops};
  return variant;
}

}  // namespace grelha
