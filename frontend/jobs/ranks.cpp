#include "frontend/jobs/ranks.hpp"

#include <exception>

namespace grelha {

bool Ranks::collective(const std::function<void()>& work) {
  std::exception_ptr failure;
  try {
    work();
  } catch (...) {
    failure = std::current_exception();
  }
  const Managed well = managed(!failure);
  in_step_ = !well.all;
  if (failure && (first() || well.first))
    std::rethrow_exception(failure);
  return well.all;
}

#ifndef GRELHA_MPI  // else ranks_mpi.cpp has these

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

#endif

}  // namespace grelha
