#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// How text is cut for threads to read. The scene is the same for any values.
struct ChunkSizes {
  std::size_t bytes = std::size_t(1) << 16;  ///< of a chunk, about
  std::size_t ahead = 64;  ///< so many are read at most before the first of them is taken
};

/// Reads runs of plain entities (NffPlain) by all threads, in chunks, into the scene that reading
/// one word after the other would make. A chunk begins where a line seems to begin an entity. It
/// counts only when what is before it, read on its own, ends right there. The first entity that is
/// odd in any way ends a run before it. Whatever is to be said of it, whoever reads one word after
/// the other says it.
class NffChunks {
 public:
  /// Called, by the thread that reads a run, with places that all before is read to; may throw.
  using Tell = std::function<void(const char* here)>;

  /// What a run has read, and the scene has.
  struct Taken {
    const char* end = nullptr;     ///< of the last entity; nullptr: there was none
    std::string_view last_entity;  ///< its keyword
  };

  /// `text` is the whole file: entities are held against how much of it is left.
  NffChunks(std::string path, std::string_view text, const ChunkSizes& sizes);

  /// Returns whether a run is worth while from the entity at `begin`: there are threads, text for
  /// them is left, and where the last run ended early is some way behind.
  bool due(const char* begin) const {
    return begin >= next_ && std::size_t(end_ - begin) > 2 * sizes_.bytes;
  }

  /// Reads on from a plain entity's keyword. `file` has a material. Throws std::bad_alloc, and what
  /// `tell` throws.
  Taken read_run(const char* begin, SceneFile& file, const Tell& tell);

 private:
  std::string path_;
  const char *end_, *next_;
  ChunkSizes sizes_;
};

}  // namespace grelha
