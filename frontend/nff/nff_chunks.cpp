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
#include "kernel/base/thread_pool.hpp"

namespace grelha {
namespace {

/// A chunk that was read on its own: entities up to the first irregular one.
struct Fragment {
  const char *begin = nullptr, *stop = nullptr;  ///< entities that begin between belong to it
  SceneFile file;
  NffChunks::ParsedChunks taken;
  const char* next = nullptr;  ///< the first word that is not taken
};

/// Most corners of a polygon in a fragment: a larger one may take seconds, which are lost if it
/// gives a warning.
constexpr std::size_t kMostVertices = 4096;

/// Thrown in place of a warning, which a fragment must not give.
struct WouldWarn {};

void read_entities(const std::string& path,
                   const char* end,
                   const Frame& frame,
                   Fragment& fragment) {
  const Warn stop = [](const std::string&) { throw WouldWarn(); };
  WarningList warning_list(stop);
  // a `/*` ends the fragment, because its end may lie far outside
  Words words(path, {fragment.begin, std::size_t(end - fragment.begin)}, 0, Comments::kOfLines);
  NffInput input(words, warning_list, frame);
  NffSimple simple(input, fragment.file, kMostVertices);
  fragment.file.scene.materials.resize(1);  // the last one before it
  for (;;) {
    const std::string_view word = words.next();
    fragment.next = word.data();
    if (word.data() >= fragment.stop || !simple.read(word))
      return;
    fragment.taken = {words.cursor(), word};
  }
}

/// Drops errors and warnings: the sequential reader reads the same text again, and knows its line.
void read_fragment(const std::string& path,
                   const char* end,
                   const Frame& frame,
                   Fragment& fragment) noexcept try {
  fragment.next = fragment.begin;
  read_entities(path, end, frame, fragment);
} catch (const WouldWarn&) {
} catch (const ParseError&) {
} catch (...) {  // memory ran out at an unknown position
  fragment.taken = {};
}

bool begins_line(const char* p) {
  return p[-1] == '\n' || p[-1] == '\r';
}

/// Returns true if a simple entity's keyword and a space stand at `p`.
bool starts_keyword(const char* p, const char* end) {
  constexpr std::size_t kLongest = 2;
  const std::string_view ahead(p, std::min(kLongest + 1, std::size_t(end - p)));
  const std::size_t length = ahead.find_first_of(" \t\r\n");
  return length != ahead.npos && is_simple_word(ahead.substr(0, length));
}

/// Cuts the text from an entity on into chunks.
class Splitter {
 public:
  Splitter(const char* begin, const char* end, std::size_t bytes)
      : begin_(begin), end_(end), bytes_(bytes) {}

  std::size_t count() const { return (std::size_t(end_ - begin_) + bytes_ - 1) / bytes_; }

  /// Returns the beginnings of chunk `i` and of the next one. If no line in it seems to begin an
  /// entity, the chunk has no beginning, and the chunk before it includes its text.
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
      while (p != stop && !(begins_line(p) && starts_keyword(p, end_)))
        ++p;
    return p;
  }

  const char *begin_, *end_;
  std::size_t bytes_;
};

/// Threads take chunks in order. The thread that has read the next missing chunk of the scene
/// appends it, and the chunks that wait behind it. Other threads wait only if they are too far
/// ahead.
class Run {
 public:
  Run(const std::string& path,
      const Splitter& splitter,
      const char* begin,
      const char* end,
      std::size_t ahead,
      SceneFile& file)
      : path_(path),
        splitter_(splitter),
        end_(end),
        slots_(ahead),
        file_(file),
        parsed_end_(begin) {}

  /// The work of each thread. The thread that is given `report` calls it.
  void work(const NffChunks::Report* report) noexcept try {
    for (std::size_t chunk = 0; take_chunk(chunk);) {
      Fragment fragment = splitter_.cut(chunk);
      if (fragment.begin)
        read_fragment(path_, end_, file_.frame, fragment);
      submit_fragment(chunk, std::move(fragment));
      if (report)
        (*report)(here());
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    error_ = std::current_exception();
  }

  /// After all work: returns the result, or rethrows the error.
  NffChunks::ParsedChunks finish() const {
    if (error_)
      std::rethrow_exception(error_);
    return parsed_;
  }
  const char* here() const {
    const std::lock_guard lock(mutex_);
    return parsed_end_;
  }

 private:
  struct Slot {
    bool is_full = false;
    Fragment fragment;
  };

  bool take_chunk(std::size_t& chunk) {
    for (;; std::this_thread::yield()) {
      const std::lock_guard lock(mutex_);
      if (is_over_ || taken_chunks_ == splitter_.count())
        return false;
      if (taken_chunks_ - joined_ < slots_.size()) {
        chunk = taken_chunks_++;
        return true;
      }
    }
  }

  Slot& slot(std::size_t chunk) { return slots_[chunk % slots_.size()]; }

  void submit_fragment(std::size_t chunk, Fragment&& fragment) {
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
    if (fragment.begin != parsed_end_ || !fragment.taken.end) {
      is_over_ = true;
      return;
    }
    lock.unlock();
    if (!parsed_.end &&
        fragment.next >= fragment.stop)  // the rest is probably like the first chunk
      reserve_for_parts(
          file_, fragment.file, double(end_ - parsed_end_) / double(fragment.next - parsed_end_));
    append_part(file_, fragment.file);
    lock.lock();
    parsed_ = fragment.taken;
    parsed_end_ = fragment.next;
  }

  const std::string& path_;
  const Splitter& splitter_;
  const char* const end_;
  mutable std::mutex mutex_;
  std::vector<Slot> slots_;
  std::size_t taken_chunks_ = 0, joined_ = 0;  ///< chunks
  bool is_joining_ = false, is_over_ = false;
  SceneFile& file_;
  const char* parsed_end_;  ///< the text that the scene lacks begins here
  NffChunks::ParsedChunks parsed_;
  std::exception_ptr error_;
};

}  // namespace

NffChunks::NffChunks(std::string path, std::string_view text, const ChunkSizes& sizes)
    : path_(std::move(path)),
      end_(text.data() + text.size()),
      next_(omp_get_max_threads() > 1 ? text.data() : end_),
      sizes_(sizes) {}

NffChunks::ParsedChunks NffChunks::read_run(const char* begin,
                                            SceneFile& file,
                                            const Report& report) {
  const Splitter splitter(begin, end_, sizes_.bytes);
  Run run(path_, splitter, begin, end_, sizes_.ahead, file);
  const std::thread::id here = std::this_thread::get_id();
  by_threads(omp_get_max_threads(),
             [&] { run.work(std::this_thread::get_id() == here ? &report : nullptr); });
  const ParsedChunks taken = run.finish();
  report(run.here());  // others may have read on since it was told
  if (run.here() != end_)
    next_ = run.here() + std::min(sizes_.ahead * sizes_.bytes, std::size_t(end_ - run.here()));
  return taken;
}

}  // namespace grelha
