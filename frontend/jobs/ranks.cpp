#include "frontend/jobs/ranks.hpp"

#include <exception>

namespace grelha {

bool Ranks::together(const std::function<void()>& work) {
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

}  // namespace grelha
