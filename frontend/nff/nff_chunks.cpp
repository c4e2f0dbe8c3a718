#include "frontend/nff/nff_chunks.hpp"

#include <omp.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "frontend/nff/nff_plain.hpp"
#include "frontend/scene/scene_parts.hpp"
#include "kernel/scene/crew.hpp"

namespace grelha {
namespace {

/// A chunk as it was read on its own: entities up to the first that is odd.
struct Fragment {
  const char *begin = nullptr, *stop = nullptr;  ///< entities that begin between belong to it
  SceneFile file;
  NffChunks::Taken taken;
  const char* next = nullptr;  ///< the first word that is not taken
};

/// Of a polygon in a fragment: a larger one may take seconds, for nothing where it is warned of.
constexpr std::size_t kMostCorners = 4096;

/// What a fragment must not say.
struct WouldWarn {};

void read_entities(const std::string& path,
                   const char* end,
                   const Frame& frame,
                   Fragment& fragment) {
  const Warn stop = [](const std::string&) { throw WouldWarn(); };
  Warnings warnings(stop);
  // a `/*` ends the fragment: how far it reaches is not this fragment's to find out
  Words words(path, {fragment.begin, std::size_t(end - fragment.begin)}, 0, Comments::kOfLines);
  NffInput input(words, warnings, frame);
  NffPlain plain(input, fragment.file, kMostCorners);
  fragment.file.scene.materials.resize(1);  // the last one before it
  for (;;) {
    const std::string_view word = words.next();
    fragment.next = word.data();
    if (word.data() >= fragment.stop || !plain.read(word))
      return;
    fragment.taken = {words.cursor(), word};
  }
}

/// Errors and warnings are for whoever reads the same place again, and knows the place's line.
void read_fragment(const std::string& path,
                   const char* end,
                   const Frame& frame,
                   Fragment& fragment) noexcept try {
  fragment.next = fragment.begin;
  read_entities(path, end, frame, fragment);
} catch (const WouldWarn&) {
} catch (const ParseError&) {
} catch (...) {  // memory ran out: nobody knows where
  fragment.taken = {};
}

bool begins_line(const char* p) {
  return p[-1] == '\n' || p[-1] == '\r';
}

/// Returns whether a plain entity's keyword stands at `p`, and a blank behind it.
bool is_keyword_at(const char* p, const char* end) {
  constexpr std::size_t kLongest = 2;
  const std::string_view ahead(p, std::min(kLongest + 1, std::size_t(end - p)));
  const std::size_t length = ahead.find_first_of(" \t\r\n");
  return length != ahead.npos && is_plain(ahead.substr(0, length));
}

/// The text from an entity on, cut.
class Cutter {
 public:
  Cutter(const char* begin, const char* end, std::size_t bytes)
      : begin_(begin), end_(end), bytes_(bytes) {}

  std::size_t count() const { return (std::size_t(end_ - begin_) + bytes_ - 1) / bytes_; }

  /// Where chunk `i` begins and the next one does. Where no line seems to begin an entity, it has
  /// no beginning; what is before such a chunk ends with it.
  Fragment cut(std::size_t i) const {
    Fragment fragment;
    const char* const begin = find_start(i);
    if (begin != border(i + 1) || i == 0)
      fragment.begin = begin;
    fragment.stop = find_start(i + 1);
    return fragment;
  }

 private:
  const char* border(std::size_t i) const {
    return begin_ + std::min(i * bytes_, std::size_t(end_ - begin_));
  }
  const char* find_start(std::size_t i) const {
    const char *p = border(i), *const stop = border(i + 1);
    if (i > 0)
      while (p != stop && !(begins_line(p) && is_keyword_at(p, end_)))
        ++p;
    return p;
  }

  const char *begin_, *end_;
  std::size_t bytes_;
};

/// Threads take chunks as they can. Whoever has read the next one that the scene lacks puts it
/// there, and those that wait behind it; nobody else waits for that unless all are too far ahead.
class Run {
 public:
  Run(const std::string& path,
      const Cutter& cutter,
      const char* begin,
      const char* end,
      std::size_t ahead,
      SceneFile& file)
      : path_(path), cutter_(cutter), end_(end), slots_(ahead), file_(file), here_(begin) {}

  /// What each thread does; the one that `tell` is given to calls it.
  void work(const NffChunks::Tell* tell) noexcept try {
    for (std::size_t chunk = 0; claim(chunk);) {
      Fragment fragment = cutter_.cut(chunk);
      if (fragment.begin)
        read_fragment(path_, end_, file_.frame, fragment);
      deliver(chunk, std::move(fragment));
      if (tell)
        (*tell)(here());
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    error_ = std::current_exception();
  }

  /// After all work: what came of it, or what was thrown.
  NffChunks::Taken finish() const {
    if (error_)
      std::rethrow_exception(error_);
    return taken_;
  }
  const char* here() const {
    const std::lock_guard lock(mutex_);
    return here_;
  }

 private:
  struct Slot {
    bool is_full = false;
    Fragment fragment;
  };

  bool claim(std::size_t& chunk) {
    for (;; std::this_thread::yield()) {
      const std::lock_guard lock(mutex_);
      if (is_over_ || claimed_ == cutter_.count())
        return false;
      if (claimed_ - joined_ < slots_.size()) {
        chunk = claimed_++;
        return true;
      }
    }
  }

  Slot& slot(std::size_t chunk) { return slots_[chunk % slots_.size()]; }

  void deliver(std::size_t chunk, Fragment&& fragment) {
    std::unique_lock lock(mutex_);
    slot(chunk) = {true, std::move(fragment)};
    if (std::exchange(is_joining_, true))
      return;
    for (; !is_over_ && slot(joined_).is_full; ++joined_) {
      const Slot next = std::exchange(slot(joined_), Slot());
      if (next.fragment.begin)
        join(next.fragment, lock);
    }
    is_joining_ = false;
  }

  void join(const Fragment& fragment, std::unique_lock<std::mutex>& lock) {
    if (fragment.begin != here_ || !fragment.taken.end) {
      is_over_ = true;
      return;
    }
    lock.unlock();
    if (!taken_.end &&
        fragment.next >= fragment.stop)  // what follows may well be as the first chunk is
      reserve_for_parts(file_, fragment.file, double(end_ - here_) / double(fragment.next - here_));
    append_part(file_, fragment.file);
    lock.lock();
    taken_ = fragment.taken;
    here_ = fragment.next;
  }

  const std::string& path_;
  const Cutter& cutter_;
  const char* const end_;
  mutable std::mutex mutex_;
  std::vector<Slot> slots_;
  std::size_t claimed_ = 0, joined_ = 0;  ///< chunks
  bool is_joining_ = false, is_over_ = false;
  SceneFile& file_;
  const char* here_;  ///< what the scene lacks begins here
  NffChunks::Taken taken_;
  std::exception_ptr error_;
};

}  // namespace

NffChunks::NffChunks(std::string path, std::string_view text, const ChunkSizes& sizes)
    : path_(std::move(path)),
      end_(text.data() + text.size()),
      next_(omp_get_max_threads() > 1 ? text.data() : end_),
      sizes_(sizes) {}

NffChunks::Taken NffChunks::read_run(const char* begin, SceneFile& file, const Tell& tell) {
  const Cutter cutter(begin, end_, sizes_.bytes);
  Run run(path_, cutter, begin, end_, sizes_.ahead, file);
  const std::thread::id here = std::this_thread::get_id();
  by_crew(omp_get_max_threads(),
          [&] { run.work(std::this_thread::get_id() == here ? &tell : nullptr); });
  const Taken taken = run.finish();
  tell(run.here());  // others may have read on since it was told
  if (run.here() != end_)
    next_ = run.here() + std::min(sizes_.ahead * sizes_.bytes, std::size_t(end_ - run.here()));
  return taken;
}

}  // namespace grelha
