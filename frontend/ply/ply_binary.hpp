#pragma once

#include <string_view>

#include "frontend/files/load_progress.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/ply/ply_faces.hpp"

namespace grelha {

/// Rows of a binary file of either byte order. Nothing is read before it is known to lie in the
/// file.
class PlyBinary {
 public:
  PlyBinary(const std::string& path,
            std::string_view bytes,
            const PlyHeader& header,
            LoadProgress* progress);
  void read(const PlyElement& element, const PlyPlan& plan, Mesh& mesh, PlyFaces& faces);

 private:
  void read_fixed(const PlyElement& element, const PlyPlan& plan, Mesh& mesh);
  void read_rows(const PlyElement& element, const PlyPlan& plan, Mesh& mesh, PlyFaces& faces);
  void read_list(const PlyElement& element,
                 const PlyProperty& list,
                 std::uint64_t row,
                 PlyFaces* faces);
  const char* take(std::size_t bytes, const PlyElement& element, std::uint64_t row);
  [[noreturn]] void fail(const char* at,
                         const std::string& expected,
                         const std::string& found) const;

  const std::string& path_;
  const char *begin_, *end_, *at_;
  ParseProgress progress_;
  bool swap_;  ///< the file's byte order is not the machine's
};

}  // namespace grelha
