#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "frontend/files/load_progress.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/scene/warnings.hpp"

namespace grelha {

enum class PlyType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kFloat32,
  kFloat64
};
constexpr std::size_t size_of(PlyType type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[std::size_t(type)];
}

enum class PlyFormat : std::uint8_t { kAscii, kLittleEndian, kBigEndian };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;  ///< of the items, for a list
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  ///< an integer type
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  /// in binary: all properties, lists with no item; in ASCII: two for each
  std::size_t row_bytes = 0;
  bool has_lists = false;
  Position position;  ///< of the name
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  std::size_t data_begin = 0;  ///< bytes before the first row
};

/// Everything up to `end_header` and its one line end. Counts are checked against the rest of the
/// file, so that memory may be taken for them. Warns of a line of text that does not belong to a
/// header, and skips it. Throws ParseError, and Stopped.
PlyHeader read_ply_header(const std::string& path,
                          std::string_view bytes,
                          WarningList& warning_list,
                          LoadProgress* progress);

}  // namespace grelha
