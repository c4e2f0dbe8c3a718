#include "c/world.hpp"

namespace grelha::c {
namespace {

struct Listener {
  grelha_progress progress = nullptr;
  void* context = nullptr;
};
constinit thread_local Listener listener;

}  // namespace

std::function<bool(double)> progress_of(Part part) {
  if (!listener.progress)
    return {};
  return [to = listener, part](double done) {  // other threads have listeners of their own
    const double elements =
        static_cast<double>(part.first) + done * static_cast<double>(part.end - part.first);
    return to.progress(to.context, elements / static_cast<double>(part.count)) != 0;
  };
}

}  // namespace grelha::c

void grelha_set_progress(grelha_progress progress, void* context) {
  grelha::c::listener = {progress, context};
}
