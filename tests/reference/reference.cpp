// A namespace of its own: the linker must not take functions of the kernel's scalar copy for these.
#define GRELHA_ISA reference
#define GRELHA_ISA_reference GRELHA_ISA_scalar
#include "tests/reference/reference.hpp"

#include "kernel/query/span.hpp"
#include "tests/reference/walk.hpp"

namespace grelha {
namespace {

template <bool kAny, class Real>
void loop(const SceneView& scene,
          const RaySpan& rays,
          const TraceSettings& settings,
          TraceCounts& counts) {
  Counters n;
  reference::trace_reference<kAny, Real>(scene, rays, settings.mailbox, n);
  reference::add(n, counts);
}

bool always() { return true; }

}  // namespace

const Variant& reference_walk() {
  static const VariantLoops loops = [] {
    VariantLoops l{};
    l.closest = loop<false, float>;
    l.occluded = loop<true, float>;
    l.in_double.closest = loop<false, double>;
    l.in_double.occluded = loop<true, double>;
    return l;
  }();
  static const Variant variant{"reference", 1, always, loops};
  return variant;
}

}  // namespace grelha
