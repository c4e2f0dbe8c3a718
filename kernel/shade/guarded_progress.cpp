#include "kernel/shade/guarded_progress.hpp"

namespace grelha {

void GuardedProgress::report(double share) {
  if (thrown_ || !progress_)
    return;
  try {
    if (!progress_(share))
      cancelled_ = true;
  } catch (...) {
    thrown_ = std::current_exception();
    cancelled_ = true;
  }
}

bool GuardedProgress::resume() {
  if (ended_)
    return false;
  try {
    cancelled_ = thrown_ || !should_continue_ || !should_continue_();
  } catch (...) {
    thrown_ = std::current_exception();
    cancelled_ = true;
  }
  ended_ = cancelled_;
  return !ended_;
}

void GuardedProgress::rethrow() const {
  if (thrown_)
    std::rethrow_exception(thrown_);
}

}  // namespace grelha
