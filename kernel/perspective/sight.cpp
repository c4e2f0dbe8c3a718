#include "kernel/perspective/sight.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "kernel/perspective/thrown.hpp"
#include "kernel/perspective/tolerances.hpp"

namespace grelha {
namespace {

/// Looks at primitives, in turns of a thousand that any thread takes.
class Onlooker {
 public:
  Onlooker(const Primitives& p,
           std::span<const std::uint32_t> ids,
           std::span<const std::uint32_t> large,
           const Viewpoint& from,
           Sight& to)
      : p_(p), ids_(ids), large_(large), from_(from), to_(to) {}

  void look_in_one_thread() {
    constexpr std::size_t kTurn = 1024;
    Window window[kFaces];
    std::vector<std::uint32_t> around;
    SeenPages::Writer writer(to_.seen);
    Seen* next = &writer.next();
    for (std::size_t first; (first = turns_.fetch_add(kTurn)) < ids_.size();)
      for (const std::uint32_t id : ids_.subspan(first, std::min(kTurn, ids_.size() - first))) {
        const Box box = p_.box(id);
        const double distance = distance_of(p_, from_, id, box);
        if (distance > kNearest * from_.pad)
          look_at(id, box, distance, window, writer, next);
        else
          around.push_back(id);
      }
    const std::lock_guard lock(mutex_);
    to_.around.insert(to_.around.end(), around.begin(), around.end());
    for (int f = 0; f < kFaces; ++f)
      to_.window[f].add(window[f]);
  }

 private:
  void look_at(std::uint32_t id,
               const Box& box,
               double distance,
               Window (&window)[kFaces],
               SeenPages::Writer& writer,
               Seen*& next) {
    const bool large = std::binary_search(large_.begin(), large_.end(), id);
    for (int f = 0; f < kFaces; ++f) {
      if (!may_be_seen(box, f) || !see(p_, from_, id, f, distance, next->outline))
        continue;
      if (!large)
        window[f].add(next->outline);
      window[f].near = std::min(window[f].near, next->outline.near);
      next->id = id;
      next->face = f;
      next->large = large;
      next = &writer.next();
    }
  }

  /// Whether anything of a box, or within pads of it, lies in the pyramid of a face.
  bool may_be_seen(const Box& box, int face) const {
    const int a = face / 2;
    const double out = face % 2 == 0 ? box.hi[a] - from_.at[a] : from_.at[a] - box.lo[a];
    const double deepest = out + 4 * from_.pad;
    for (const int b : {(a + 1) % 3, (a + 2) % 3})
      if (std::max(box.lo[b] - from_.at[b], from_.at[b] - box.hi[b]) > deepest)
        return false;
    return deepest > 0;
  }

  const Primitives& p_;
  std::span<const std::uint32_t> ids_, large_;
  const Viewpoint& from_;
  Sight& to_;
  std::mutex mutex_;
  std::atomic<std::size_t> turns_ = 0;
};

}  // namespace

void look(const Primitives& primitives,
          std::span<const std::uint32_t> ids,
          std::span<const std::uint32_t> large,
          const Viewpoint& from,
          int threads,
          Sight& to) {
  Onlooker onlooker(primitives, ids, large, from, to);
  Thrown thrown;
#pragma omp parallel num_threads(threads)
  thrown.in([&] { onlooker.look_in_one_thread(); });
  thrown.on();
  std::sort(to.around.begin(), to.around.end());
}

}  // namespace grelha
