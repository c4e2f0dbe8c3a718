#pragma once

#include <string_view>
#include <vector>

#include "frontend/files/load_progress.hpp"
#include "frontend/files/text.hpp"
#include "frontend/ply/ply_faces.hpp"

namespace grelha {

/// Rows of an ASCII file as words. Rows may be broken over lines or share one. A line may hold more
/// words than its row has properties. The rest is dropped if there are lines enough left for the
/// rows to come.
class PlyAscii {
 public:
  PlyAscii(const std::string& path,
           std::string_view bytes,
           const PlyHeader& header,
           LoadProgress* progress)
      : words_(path, bytes, header.data_begin, Comments::kNone),
        header_(header),
        progress_(progress, bytes.data()) {}
  void read(const PlyElement& element, const PlyPlan& plan, Mesh& mesh, PlyFaces& faces);

 private:
  enum class Extra { kUnknown, kDropped, kNextRow };

  std::string_view word(const PlyElement& element, std::uint64_t row);
  void read_list(const PlyElement& element,
                 const PlyProperty& list,
                 std::uint64_t row,
                 PlyFaces* faces);
  std::int64_t read_index(const PlyElement& element, std::uint64_t row, const PlyFaces& faces);
  void read_number(const PlyElement& element,
                   const PlyProperty& property,
                   std::uint64_t row,
                   const PlyColumn& target);  ///< of nothing: steps over it
  void end_row(const PlyElement& element, std::uint64_t row);
  Extra extra_of(const PlyElement& element, std::uint64_t row) const;

  Words words_;
  const PlyHeader& header_;
  ParseProgress progress_;
  Extra extra_ = Extra::kUnknown;
};

}  // namespace grelha
