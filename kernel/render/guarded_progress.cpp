#include "kernel/render/guarded_progress.hpp"

namespace grelha {

void GuardedProgress::tell(double share) {
  if (thrown_ || !progress_)
    return;
  try {
    if (!progress_(share))
      stopped_ = true;
  } catch (...) {
    thrown_ = std::current_exception();
    stopped_ = true;
  }
}

bool GuardedProgress::resume() {
  if (ended_)
    return false;
  try {
    stopped_ = thrown_ || !should_continue_ || !should_continue_();
  } catch (...) {
    thrown_ = std::current_exception();
    stopped_ = true;
  }
  ended_ = stopped_;
  return !ended_;
}

void GuardedProgress::rethrow() const {
  if (thrown_)
    std::rethrow_exception(thrown_);
}

}  // namespace grelha
