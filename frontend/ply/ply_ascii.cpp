#include "frontend/ply/ply_ascii.hpp"

#include <algorithm>

namespace grelha {

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

}  // namespace grelha
