// The build without MPI.
#include "frontend/jobs/ranks.hpp"

namespace grelha {

Ranks::Ranks(int&, char**&) {}
Ranks::~Ranks() = default;
Ranks::Managed Ranks::managed(bool here) const {
  return {here, here};
}
void Ranks::check_all_ranks(const std::string&, const std::string&) const {}

bool Ranks::advance(const World& world,
                    const Camera& camera,
                    const RenderOptions& options,
                    Picture& picture,
                    RenderStats& stats,
                    SampleMaps& maps,
                    const ShouldContinue& should_continue,
                    const std::function<bool()>&) {
  return picture.advance(world, camera, options, stats, &maps, should_continue);
}

}  // namespace grelha
