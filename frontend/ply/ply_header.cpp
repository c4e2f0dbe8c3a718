#include "frontend/ply/ply_header.hpp"

#include <algorithm>
#include <optional>
#include <unordered_set>
#include <utility>

#include "frontend/files/text.hpp"

namespace grelha {
namespace {

std::optional<PlyType> type_named(std::string_view name) {
  static constexpr std::pair<std::string_view, PlyType> kNames[] = {{"char", PlyType::kInt8},
                                                                    {"int8", PlyType::kInt8},
                                                                    {"uchar", PlyType::kUint8},
                                                                    {"uint8", PlyType::kUint8},
                                                                    {"short", PlyType::kInt16},
                                                                    {"int16", PlyType::kInt16},
                                                                    {"ushort", PlyType::kUint16},
                                                                    {"uint16", PlyType::kUint16},
                                                                    {"int", PlyType::kInt32},
                                                                    {"int32", PlyType::kInt32},
                                                                    {"uint", PlyType::kUint32},
                                                                    {"uint32", PlyType::kUint32},
                                                                    {"float", PlyType::kFloat32},
                                                                    {"float32", PlyType::kFloat32},
                                                                    {"double", PlyType::kFloat64},
                                                                    {"float64", PlyType::kFloat64}};
  for (const auto& [known, type] : kNames)
    if (known == name)
      return type;
  return std::nullopt;
}

class HeaderReader {
 public:
  HeaderReader(const std::string& path,
               std::string_view bytes,
               WarningList& warning_list,
               LoadProgress* progress)
      : bytes_(bytes),
        whole_(path, bytes, 0, Comments::kNone),
        warning_list_(warning_list),
        progress_(progress, bytes.data()) {}

  PlyHeader read();

 private:
  [[noreturn]] void fail(std::string_view word, const std::string& expected) const {
    const bool at_end = word.data() == bytes_.data() + bytes_.size();
    throw ParseError(
        whole_.position(word), expected, word.empty() && !at_end ? "end of line" : quoted(word));
  }
  void find_line_end();
  void skip_stray(std::string_view keyword);
  void warn_nul() const;
  bool next_line();
  std::string_view word();
  PlyType type(const char* what);
  void read_format();
  void read_element();
  void read_property();
  void check_counts() const;

  std::string_view bytes_;
  Words whole_;  ///< only to name positions
  WarningList& warning_list_;
  ParseProgress progress_;
  char line_end_ = '\n';
  std::size_t next_ = 0;   ///< first byte of the next line
  std::string_view line_;  ///< what is left of the present one
  bool has_format_ = false;
  PlyHeader header_;
  std::unordered_set<std::string_view> names_;  ///< of elements
  std::vector<std::string_view> count_words_;   ///< [elements]
};

/// Takes the line end behind `ply` for all lines. Binary data may begin with 0x0A or 0x0D, so a CR
/// alone must not swallow an LF.
void HeaderReader::find_line_end() {
  const std::size_t end = bytes_.find_first_of("\r\n");
  const std::string_view found = bytes_.substr(std::min(end, bytes_.size()), 2);
  if (found.starts_with('\r') && found != "\r\n")
    line_end_ = '\r';
}

bool HeaderReader::next_line() {
  if (next_ >= bytes_.size()) {
    line_ = bytes_.substr(bytes_.size());
    return false;
  }
  const std::size_t end = std::min(bytes_.find(line_end_, next_), bytes_.size());
  line_ = bytes_.substr(next_, end - next_);
  next_ = std::min(end + 1, bytes_.size());
  progress_.at(bytes_.data() + next_);
  return true;
}

std::string_view HeaderReader::word() {
  const auto blank = [](char c) { return static_cast<unsigned char>(c) <= ' '; };
  const auto first = std::find_if_not(line_.begin(), line_.end(), blank);
  const auto last = std::find_if(first, line_.end(), blank);
  const std::string_view found =
      line_.substr(std::size_t(first - line_.begin()), std::size_t(last - first));
  line_.remove_prefix(std::size_t(last - line_.begin()));
  return found;
}

PlyType HeaderReader::type(const char* what) {
  const std::string_view name = word();
  const auto found = type_named(name);
  if (!found)
    fail(name, std::string("a type such as uchar, int or float for ") + what);
  return *found;
}

void HeaderReader::read_format() {
  has_format_ = true;
  const std::string_view name = word();
  if (name == "ascii")
    header_.format = PlyFormat::kAscii;
  else if (name == "binary_little_endian")
    header_.format = PlyFormat::kLittleEndian;
  else if (name == "binary_big_endian")
    header_.format = PlyFormat::kBigEndian;
  else
    fail(name, "ascii, binary_little_endian or binary_big_endian");
  const std::string_view version = word();
  if (version != "1.0")
    fail(version, "format version 1.0");
}

void HeaderReader::read_element() {
  PlyElement element;
  const std::string_view name = word();
  if (name.empty())
    fail(name, "the element's name");
  element.name = name;
  element.position = whole_.position(name);
  const std::string_view count = word();
  std::int64_t value = 0;
  if (!to_integer(count, value) || value < 0)
    fail(count, "a whole number of rows");
  if (!names_.insert(name).second)
    fail(name, "each element once");
  element.count = std::uint64_t(value);
  header_.elements.push_back(element);
  count_words_.push_back(count);
}

void HeaderReader::read_property() {
  if (header_.elements.empty())
    fail(line_.substr(0, 0), "an element before its properties");
  PlyElement& element = header_.elements.back();
  PlyProperty property;
  std::string_view rest = line_;
  if (word() == "list") {
    property.is_list = true;
    rest = line_;
    property.count_type = type("the list's count");
    if (property.count_type >= PlyType::kFloat32) {
      line_ = rest;
      fail(word(), "an integer type for the list's count");
    }
  } else {
    line_ = rest;
  }
  property.type = type("the property");
  const std::string_view name = word();
  if (name.empty())
    fail(name, "the property's name");
  property.name = name;
  element.has_lists = element.has_lists || property.is_list;
  const bool ascii = header_.format == PlyFormat::kAscii;
  element.row_bytes += ascii ? 2 : size_of(property.is_list ? property.count_type : property.type);
  element.properties.push_back(std::move(property));
}

/// Refuses counts of rows that the file cannot hold, given the smallest size of a row, before
/// memory is allocated for them.
void HeaderReader::check_counts() const {
  std::uint64_t left =
      bytes_.size() - header_.data_begin + (header_.format == PlyFormat::kAscii ? 1 : 0);
  for (std::size_t i = 0; i < header_.elements.size(); ++i) {
    const PlyElement& element = header_.elements[i];
    if (element.row_bytes == 0)
      continue;
    const std::uint64_t most = left / element.row_bytes;
    if (element.count > most || element.count > 0xFFFFFFFEu)
      throw ParseError(whole_.position(count_words_[i]),
                       "expected at most " +
                           std::to_string(std::min<std::uint64_t>(most, 0xFFFFFFFEu)) +
                           " rows of \"" + element.name + "\" (the file ends before), found " +
                           quoted(count_words_[i]));
    left -= element.count * element.row_bytes;
  }
}

/// Skips lines that exporters add, such as a continued comment. Binary data are no line.
void HeaderReader::skip_stray(std::string_view keyword) {
  const auto is_text = [](char c) {
    return static_cast<unsigned char>(c) >= ' ' || c == '\t' || c == '\r';
  };
  const std::string_view line{keyword.data(),
                              std::size_t(line_.data() + line_.size() - keyword.data())};
  if (!std::all_of(line.begin(), line.end(), is_text))
    fail(keyword,
         "a word of the header (format, comment, obj_info, element, property, end_header)");
  if (warning_list_.first("line " + std::string(keyword)))
    warning_list_.add_line(
        whole_.position(keyword),
        "no line of a PLY header begins with " + quoted(keyword) + "; it is skipped");
}

/// Warns of NUL bytes: they separate words as spaces do, which is seldom intended.
void HeaderReader::warn_nul() const {
  const bool ascii = header_.format == PlyFormat::kAscii;
  const std::size_t nul = bytes_.substr(0, ascii ? bytes_.size() : header_.data_begin).find('\0');
  if (nul != std::string_view::npos)
    warning_list_.add_line(whole_.position(bytes_.substr(nul)), kNulIsSpace);
}

PlyHeader HeaderReader::read() {
  find_line_end();
  next_ = byte_order_mark(bytes_);
  next_line();
  const std::string_view magic = word();
  if (magic != "ply")
    fail(magic, "\"ply\" on the first line");
  for (;;) {
    if (!next_line())
      fail(line_, "\"end_header\"");
    const std::string_view keyword = word();
    if (keyword.empty() || keyword == "comment" || keyword == "obj_info")
      continue;
    if (keyword == "format") {
      if (has_format_)
        fail(keyword, "\"format\" once");  // rows were measured by the first
      read_format();
    } else if (keyword == "end_header") {
      if (!has_format_)
        fail(keyword, "\"format\" before the end of the header");
      break;
    } else if (keyword == "element" || keyword == "property") {
      if (!has_format_)
        fail(keyword, "\"format\" before elements");
      keyword == "element" ? read_element() : read_property();
    } else {
      skip_stray(keyword);
    }
  }
  header_.data_begin = next_;
  check_counts();
  warn_nul();
  return std::move(header_);
}

}  // namespace

PlyHeader read_ply_header(const std::string& path,
                          std::string_view bytes,
                          WarningList& warning_list,
                          LoadProgress* progress) {
  return HeaderReader(path, bytes, warning_list, progress).read();
}

}  // namespace grelha
