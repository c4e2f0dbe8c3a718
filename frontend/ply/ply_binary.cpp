#include "frontend/ply/ply_binary.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace grelha {
namespace {

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

}  // namespace

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

}  // namespace grelha
