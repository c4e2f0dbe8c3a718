#include "perf/trace/modes.hpp"

#include "kernel/grid/world_impl.hpp"

namespace grelha::perf {

void trace_all(const Variant& variant,
               const World& world,
               const RayBuffer& r,
               bool any,
               const TraceSettings& settings,
               Answers& a,
               TraceCounts& counts) {
  a.t = r.t_max;
  a.id.resize(r.size());
  const VariantLoops& loops = variant.loops;
  (any ? loops.occluded : loops.closest)(world.impl().view,
                                         {r.ox.data(),
                                          r.oy.data(),
                                          r.oz.data(),
                                          r.dx.data(),
                                          r.dy.data(),
                                          r.dz.data(),
                                          r.t_min.data(),
                                          a.t.data(),
                                          a.id.data(),
                                          static_cast<int>(r.size())},
                                         settings,
                                         counts);
}

}  // namespace grelha::perf
