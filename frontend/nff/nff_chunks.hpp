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
  std::size_t ahead = 64;                    ///< most chunks read before the first is taken
};

/// Reads runs of simple entities (NffSimple) with all threads, in chunks, into the same scene that
/// sequential reading makes. A chunk begins where a line seems to begin an entity. It counts only
/// if the text before it, read on its own, ends right there. The first irregular entity ends a run
/// before it. The sequential reader reads that entity, and gives its errors and warnings.
class NffChunks {
 public:
  /// Called by the thread of read_run() with a position up to which all text is read; may throw.
  using Report = std::function<void(const char* here)>;

  /// The part of a file that a run has read into the scene.
  struct ParsedChunks {
    const char* end = nullptr;     ///< of the last entity; nullptr: there was none
    std::string_view last_entity;  ///< its keyword
  };

  /// `text` is the whole file: entities are held against how much of it is left.
  NffChunks(std::string path, std::string_view text, const ChunkSizes& sizes);

  /// Returns true if a run pays from the entity at `begin`: there are threads, enough text is left,
  /// and the position where the last run ended early is far enough behind.
  bool due(const char* begin) const {
    return begin >= next_ && std::size_t(end_ - begin) > 2 * sizes_.bytes;
  }

  /// Reads on from a simple entity's keyword. `file` has a material. Throws std::bad_alloc, and
  /// what `report` throws.
  ParsedChunks read_run(const char* begin, SceneFile& file, const Report& report);

 private:
  std::string path_;
  const char *end_, *next_;
  ChunkSizes sizes_;
};

}  // namespace grelha
