#include "frontend/ply/mesh_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string_view>
#include <vector>

#include "frontend/files/load_progress.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/files/text.hpp"
#include "frontend/ply/ply_faces.hpp"

namespace grelha {
namespace {

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

/// Returns the next word, which the row needs.
std::string_view PlyAscii::word(const PlyElement& element, std::uint64_t row) {
  const std::string_view found = words_.next();
  if (found.empty())
    throw ParseError(words_.position(found),
                     "row " + std::to_string(row + 1) + " of " + std::to_string(element.count) +
                         " of \"" + element.name + '"',
                     quoted(found));
  return found;
}

std::int64_t PlyAscii::read_index(const PlyElement& element,
                                  std::uint64_t row,
                                  const PlyFaces& faces) {
  std::int64_t index = 0;
  const std::string_view item = word(element, row);
  if (!to_integer(item, index) || !faces.accepts(index))
    throw ParseError(words_.position(item),
                     "the index of a vertex, 0 or more and below their number",
                     quoted(item));
  return index;
}

void PlyAscii::read_number(const PlyElement& element,
                           const PlyProperty& property,
                           std::uint64_t row,
                           const PlyColumn& target) {
  const std::string_view found = word(element, row);
  if (!target.to)
    return;
  float value = 0;
  double wide = 0;
  if (target.is_identity() ? !to_number(found, value) : !to_number(found, wide))
    throw ParseError(words_.position(found),
                     "a number for \"" + property.name + "\" of \"" + element.name + '"',
                     quoted(found));
  target.to->push_back(target.is_identity() ? value : target.value(wide));
}

void PlyAscii::read_list(const PlyElement& element,
                         const PlyProperty& list,
                         std::uint64_t row,
                         PlyFaces* faces) {
  const std::string_view size_word = word(element, row);
  std::int64_t size = 0;
  if (!to_integer(size_word, size) || size < 0)
    throw ParseError(words_.position(size_word),
                     "a whole number of items for \"" + list.name + '"',
                     quoted(size_word));
  const std::size_t most = (words_.bytes_left() + 1) / 2;  // an item takes a digit and a space
  if (std::uint64_t(size) > most)
    throw ParseError(words_.position(size_word),
                     "at most " + std::to_string(most) + " items for \"" + list.name +
                         "\" (the file ends before)",
                     quoted(size_word));
  for (std::int64_t i = 0; i < size; ++i) {
    if (!faces) {
      word(element, row);
      continue;
    }
    faces->add(read_index(element, row, *faces));
    progress_.at(words_.cursor());
  }
  if (faces)
    faces->end(std::uint32_t(size));
}

/// Rows that are too long, or several rows on a line? Lines enough for one row each say the former.
PlyAscii::Extra PlyAscii::extra_of(const PlyElement& element, std::uint64_t row) const {
  std::uint64_t rows = element.count - row - 1;
  bool later = false;
  for (const PlyElement& other : header_.elements) {
    if (later && !other.properties.empty())
      rows += other.count;
    later = later || &other == &element;
  }
  std::uint64_t lines = 0;
  Words ahead = words_;
  for (ahead.skip_line(); lines < rows && !ahead.next().empty(); ahead.skip_line())
    ++lines;
  return lines >= rows ? Extra::kDropped : Extra::kNextRow;
}

void PlyAscii::end_row(const PlyElement& element, std::uint64_t row) {
  if (words_.peek_on_line().empty())
    return;
  if (extra_ == Extra::kUnknown)
    extra_ = extra_of(element, row);
  if (extra_ == Extra::kDropped)
    words_.skip_line();
}

void PlyAscii::read(const PlyElement& element, const PlyPlan& plan, Mesh& mesh, PlyFaces& faces) {
  if (element.properties.empty())
    return;
  std::vector<PlyColumn> targets(element.properties.size());
  for (int i = 0; i < PlyPlan::kColumns; ++i)
    if (plan.columns[i] >= 0)
      targets[std::size_t(plan.columns[i])] = column(mesh, plan, i);
  for (std::uint64_t row = 0; row < element.count; ++row) {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (property.is_list) {
        read_list(element, property, row, int(i) == plan.list ? &faces : nullptr);
        continue;
      }
      read_number(element, property, row, targets[i]);
    }
    end_row(element, row);
    progress_.at(words_.cursor());
  }
}

template <class T>
T load(const char* p, bool swap) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), p, sizeof(T));
  if (swap)
    std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

/// Calls `use` with a value of the C++ type, to choose code by it once and not per value.
template <class Use>
decltype(auto) with_type(PlyType type, Use&& use) {
  switch (type) {
    case PlyType::kInt8:
      return use(std::int8_t());
    case PlyType::kUint8:
      return use(std::uint8_t());
    case PlyType::kInt16:
      return use(std::int16_t());
    case PlyType::kUint16:
      return use(std::uint16_t());
    case PlyType::kInt32:
      return use(std::int32_t());
    case PlyType::kUint32:
      return use(std::uint32_t());
    case PlyType::kFloat32:
      return use(float());
    case PlyType::kFloat64:
      break;
  }
  return use(double());
}

std::int64_t load_integer(PlyType type, const char* p, bool swap) {
  return with_type(type, [&](auto t) { return std::int64_t(load<decltype(t)>(p, swap)); });
}

void append_column(PlyType type,
                   const char* p,
                   std::size_t stride,
                   std::size_t rows,
                   bool swap,
                   const PlyColumn& out) {
  const std::size_t before = out.to->size();
  out.to->resize(before + rows);
  with_type(type, [&](auto t) {
    float* to = out.to->data() + before;
    for (std::size_t i = 0; i < rows && out.is_identity(); ++i, p += stride)
      to[i] = float(load<decltype(t)>(p, swap));
    for (std::size_t i = 0; i < rows && !out.is_identity(); ++i, p += stride)
      to[i] = out.value(double(load<decltype(t)>(p, swap)));
  });
}

PlyBinary::PlyBinary(const std::string& path,
                     std::string_view bytes,
                     const PlyHeader& header,
                     LoadProgress* progress)
    : path_(path),
      begin_(bytes.data()),
      end_(bytes.data() + bytes.size()),
      at_(bytes.data() + header.data_begin),
      progress_(progress, bytes.data()),
      swap_((header.format == PlyFormat::kBigEndian) != (std::endian::native == std::endian::big)) {
}

void PlyBinary::fail(const char* at, const std::string& expected, const std::string& found) const {
  throw ParseError(Position{path_, 0, 0, std::uint64_t(at - begin_)}, expected, found);
}

/// Steps over `bytes` bytes, which must be there, and returns where they begin.
const char* PlyBinary::take(std::size_t bytes, const PlyElement& element, std::uint64_t row) {
  if (std::size_t(end_ - at_) < bytes) [[unlikely]]
    fail(end_,
         "row " + std::to_string(row + 1) + " of " + std::to_string(element.count) + " of \"" +
             element.name + '"',
         "end of file");
  const char* const here = at_;
  at_ += bytes;
  return here;
}

/// Rows of one size: each wanted property is copied as a column, in blocks that stay in the cache.
void PlyBinary::read_fixed(const PlyElement& element, const PlyPlan& plan, Mesh& mesh) {
  constexpr std::uint64_t kBlock = 4096;
  const std::size_t stride = element.row_bytes;
  if (stride == 0)
    return;
  const std::uint64_t whole = std::uint64_t(end_ - at_) / stride;
  if (whole < element.count) {
    at_ += whole * stride;
    take(stride, element, whole);
  }
  std::vector<std::size_t> offsets;
  std::size_t offset = 0;
  for (const PlyProperty& property : element.properties) {
    offsets.push_back(offset);
    offset += size_of(property.type);
  }
  for (std::uint64_t row = 0; row < element.count; row += kBlock) {
    const std::size_t rows = std::size_t(std::min(kBlock, element.count - row));
    for (int i = 0; i < PlyPlan::kColumns; ++i) {
      if (plan.columns[i] < 0)
        continue;
      const auto k = std::size_t(plan.columns[i]);
      append_column(
          element.properties[k].type, at_ + offsets[k], stride, rows, swap_, column(mesh, plan, i));
    }
    at_ += rows * stride;
    progress_.at(at_);
  }
}

void PlyBinary::read_list(const PlyElement& element,
                          const PlyProperty& list,
                          std::uint64_t row,
                          PlyFaces* faces) {
  const char* const count_at = take(size_of(list.count_type), element, row);
  const std::int64_t size = load_integer(list.count_type, count_at, swap_);
  if (size < 0)
    fail(count_at, "0 or more items for \"" + list.name + '"', std::to_string(size));
  const std::size_t item = size_of(list.type);
  const char* p = take(std::size_t(size) * item, element, row);
  if (!faces)
    return;
  with_type(list.type, [&](auto t) {
    for (std::int64_t i = 0; i < size; ++i, p += item) {
      const auto index = std::int64_t(load<decltype(t)>(p, swap_));
      if (!faces->accepts(index))
        fail(p, "the index of a vertex, 0 or more and below their number", std::to_string(index));
      faces->add(index);
    }
  });
  faces->end(std::uint32_t(size));
}

void PlyBinary::read_rows(const PlyElement& element,
                          const PlyPlan& plan,
                          Mesh& mesh,
                          PlyFaces& faces) {
  std::vector<PlyColumn> targets(element.properties.size());
  for (int i = 0; i < PlyPlan::kColumns; ++i)
    if (plan.columns[i] >= 0)
      targets[std::size_t(plan.columns[i])] = column(mesh, plan, i);
  for (std::uint64_t row = 0; row < element.count; ++row) {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (property.is_list) {
        read_list(element, property, row, int(i) == plan.list ? &faces : nullptr);
        continue;
      }
      const char* const p = take(size_of(property.type), element, row);
      if (targets[i].to)
        append_column(property.type, p, 0, 1, swap_, targets[i]);
    }
    progress_.at(at_);
  }
}

void PlyBinary::read(const PlyElement& element, const PlyPlan& plan, Mesh& mesh, PlyFaces& faces) {
  if (element.has_lists)
    read_rows(element, plan, mesh, faces);
  else
    read_fixed(element, plan, mesh);
}

int find_property(const PlyElement& element, std::string_view name) {
  const auto& all = element.properties;
  const auto found = std::ranges::find(all, name, &PlyProperty::name);
  return found == all.end() ? -1 : int(found - all.begin());
}

PlyPlan plan_vertex(const PlyElement& element, const Frame& frame) {
  static constexpr std::string_view kNames[] = {"x", "y", "z", "nx", "ny", "nz"};
  PlyPlan plan;
  plan.frame = frame;
  for (int i = 0; i < 6; ++i) {
    const int found = find_property(element, kNames[i]);
    const bool scalar = found >= 0 && !element.properties[std::size_t(found)].is_list;
    if (scalar)
      plan.columns[i] = found;
    else if (i < 3 && element.count > 0)
      throw ParseError(
          element.position,
          "expected a property \"" + std::string(kNames[i]) + "\" of \"vertex\", found none");
  }
  const bool normals = plan.columns[3] >= 0 && plan.columns[4] >= 0 && plan.columns[5] >= 0;
  if (!normals)
    std::fill(plan.columns + 3, plan.columns + 6, -1);
  return plan;
}

PlyPlan plan_faces(const PlyElement& element) {
  PlyPlan plan;
  plan.list = find_property(element, "vertex_indices");
  if (plan.list < 0)
    plan.list = find_property(element, "vertex_index");
  const bool sound = plan.list >= 0 && element.properties[std::size_t(plan.list)].is_list &&
                     element.properties[std::size_t(plan.list)].type < PlyType::kFloat32;
  if (sound)
    return plan;
  if (element.count > 0)
    throw ParseError(
        element.position,
        "expected a list of integers \"vertex_indices\" in \"" + element.name + "\", found none");
  return PlyPlan{};
}

/// Gives an element that some programs call otherwise its name, unless another one has it.
void use_common_name(std::string_view name, std::string_view plural, PlyHeader& header) {
  if (std::ranges::find(header.elements, name, &PlyElement::name) != header.elements.end())
    return;
  for (PlyElement& element : header.elements)
    if (const std::string small = in_small_letters(element.name);
        small == name || small == plural) {
      element.name = name;
      return;
    }
}

/// Corners of as many triangles as there are rows, if the file can hold them: most meshes are of
/// triangles.
std::size_t expected_vertices(const PlyHeader& header,
                              const PlyElement& element,
                              int list,
                              std::size_t bytes) {
  if (list < 0)
    return 0;
  const bool ascii = header.format == PlyFormat::kAscii;
  const std::size_t item = ascii ? 2 : size_of(element.properties[std::size_t(list)].type);
  return std::min(std::size_t(3 * element.count), bytes / item);
}

template <class Rows>
Mesh read_rows(const PlyHeader& header,
               const PlyColors& colors,
               std::size_t bytes,
               const Frame& frame,
               Rows& rows) {
  Mesh mesh;
  std::uint64_t vertices = 0;
  for (const PlyElement& element : header.elements)
    if (element.name == "vertex")
      vertices = element.count;
  PlyFaces polygons(mesh, vertices, false), strips(mesh, vertices, true);
  for (const PlyElement& element : header.elements) {
    const bool is_strips = element.name == "tristrips";
    PlyPlan plan;
    if (element.name == "vertex")
      plan = plan_vertex(element, frame);
    if (element.name == "face" || is_strips)
      plan = plan_faces(element);
    if (&element == colors.element) {
      std::ranges::copy(colors.columns, plan.columns + 6);
      plan.colors_are_bytes = colors.is_bytes();
      mesh.colors_of_faces = element.name == "face";
      mesh.has_alpha = find_property(element, "alpha") >= 0;
    }
    for (int i = 0; i < PlyPlan::kColumns; ++i)
      if (plan.columns[i] >= 0)
        column(mesh, plan, i).to->reserve(std::size_t(element.count));
    if (element.name == "face")
      mesh.indices.reserve(expected_vertices(header, element, plan.list, bytes));
    rows.read(element, plan, mesh, is_strips ? strips : polygons);
  }
  return mesh;
}

}  // namespace

Mesh read_ply_mesh(const std::string& path,
                   std::string_view bytes,
                   const Warn& warn,
                   LoadProgress* progress,
                   const Frame& frame,
                   bool with_colors) {
  WarningList warning_list(warn);
  PlyHeader header = read_ply_header(path, bytes, warning_list, progress);
  use_common_name("vertex", "vertices", header);
  use_common_name("face", "faces", header);
  const PlyColors colors = with_colors ? find_colors(header) : PlyColors{};
  const auto read = [&](auto rows) { return read_rows(header, colors, bytes.size(), frame, rows); };
  Mesh mesh = header.format == PlyFormat::kAscii ? read(PlyAscii(path, bytes, header, progress))
                                                 : read(PlyBinary(path, bytes, header, progress));
  scale_colors(mesh, colors, warning_list);
  return mesh;
}

}  // namespace grelha
