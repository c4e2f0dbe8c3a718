#include "kernel/base/fork.hpp"

#include <future>

#include <unistd.h>

namespace grelha {
namespace {

const pid_t kLoadedBy = getpid();

bool is_forked() {
  return getpid() != kLoadedBy;
}

}  // namespace

void run_fork_safe(const std::function<void()>& work) {
  if (is_forked())
    std::async(std::launch::async, work).get();
  else
    work();
}

}  // namespace grelha
