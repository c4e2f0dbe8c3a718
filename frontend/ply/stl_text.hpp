#pragma once

#include <string>
#include <string_view>

#include "frontend/files/load_progress.hpp"
#include "frontend/files/text.hpp"
#include "frontend/scene/mesh.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// Returns whether the word `vertex` stands in the text, before a number.
bool has_stl_vertex(std::string_view text);
/// Returns whether the text begins with a solid, or a facet, and has a vertex.
bool begins_stl_text(std::string_view text);

/// Reads STL in text: `solid`, `facet`, `outer loop`, `vertex x y z`, and the ends of these, in
/// letters of any case. Each corner becomes a vertex. Loops of more than three vertices are
/// polygons.
class StlText {
 public:
  StlText(const std::string& path,
          std::string_view bytes,
          const Warn& warn,
          ParseProgress& progress,
          const Frame& frame,
          Mesh& mesh);
  void read();

 private:
  /// Words of one meaning are one: `end loop`, `ENDLOOP`. kNone: of no meaning.
  enum class Keyword {
    kNone,
    kSolid,
    kFacet,
    kOuter,
    kVertex,
    kColor,
    kEndLoop,
    kEndFacet,
    kEndSolid
  };

  Keyword keyword_of(std::string_view word) const;
  void take(Keyword keyword, std::string_view word);
  void take_unknown(std::string_view word);
  void skip_comment(std::string_view word);
  void skip_rest();
  void skip_name();
  bool content_begins() const;
  double coordinate();
  void read_vertex();
  void end_loop(std::string_view word);
  void expect_no_loop(std::string_view word) const;
  void finish();

  std::string_view bytes_;
  Words words_;
  const Warn& warn_;
  ParseProgress& progress_;
  const Frame& frame_;
  Mesh& mesh_;
  std::size_t loop_ = 0;  ///< the first vertex of the loop
  bool in_loop_ = false, in_solid_ = false, ended_ = false;
  std::string_view skipped_;  ///< the first word of no meaning
};

}  // namespace grelha
