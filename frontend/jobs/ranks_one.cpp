// The build without MPI.
#include "frontend/jobs/ranks.hpp"

namespace grelha {

Ranks::Ranks(int&, char**&) {}
Ranks::~Ranks() = default;
Ranks::Managed Ranks::managed(bool here) const { return {here, here}; }
void Ranks::agree_on(const std::string&, const std::string&) const {}

bool Ranks::accumulate(const World& world,
                       const Camera& camera,
                       const RenderOptions& options,
                       Accumulator& a,
                       RenderStats& stats,
                       const std::function<bool()>&) {
  return grelha::accumulate(world, camera, options, a, stats);
}

}  // namespace grelha
