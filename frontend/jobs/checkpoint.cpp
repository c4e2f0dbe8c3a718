#include "frontend/jobs/checkpoint.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <ostream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "frontend/files/atomic_file.hpp"
#include "frontend/files/digest.hpp"
#include "frontend/files/load_file.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/files/text.hpp"
#include "frontend/images/image_file.hpp"

namespace grelha {
namespace {

// Numbers in little-endian order, written and read by the same words: f(Sink) and f(Source) of one
// template are two sides of a format.

/// Writes and digests alike.
class Sink {
 public:
  explicit Sink(std::ostream& out) : out_(out) {}

  void text(std::string_view text) { put(text.data(), text.size()); }
  template <class... T>
  void values(const T&... v) {
    (one(v), ...);
  }
  template <class T>
  void list(const std::vector<T>& values, std::size_t) {
    if constexpr (std::endian::native == std::endian::little || sizeof(T) == 1)
      put(values.data(), values.size() * sizeof(T));
    else
      for (const T& v : values)
        one(v);
  }
  /// How many there are; whoever calls this writes them.
  template <class T>
  void size(const std::vector<T>& values, std::size_t) {
    one(std::uint64_t(values.size()));
  }
  /// The lower half of the digest of all before.
  void finish() {
    flush();
    const std::uint64_t checksum = swapped_if_big(digest_.low64());
    out_.write(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  }

 private:
  template <class T>
  void one(T value) {
    const T little = swapped_if_big(value);
    put(&little, sizeof little);
  }
  void put(const void* data, std::size_t size) {
    constexpr std::size_t kLarge = 65536;
    buffer_.append(static_cast<const char*>(data), size < kLarge ? size : 0);
    if (size >= kLarge || buffer_.size() >= kLarge)
      flush();
    if (size >= kLarge)
      pass(data, size);
  }
  void flush() {
    pass(buffer_.data(), buffer_.size());
    buffer_.clear();
  }
  void pass(const void* data, std::size_t size) {
    digest_.bytes(data, size);
    out_.write(static_cast<const char*>(data), std::streamsize(size));
  }

  std::ostream& out_;
  Digest digest_;
  std::string buffer_;
};

/// Thrown where a file is not one of ours.
struct NotOurs {};

/// Throws NotOurs where the bytes end early, before anything is allocated for what is not there.
class Source {
 public:
  explicit Source(std::string_view bytes) : left_(bytes) {}

  template <class... T>
  void values(T&... v) {
    (one(v), ...);
  }
  template <class T>
  void list(std::vector<T>& values, std::size_t count) {
    require_bytes(count, sizeof(T));
    values.resize(count);
    if (count > 0)
      std::memcpy(values.data(), left_.data(), count * sizeof(T));
    left_.remove_prefix(count * sizeof(T));
    for (T& v : values)
      v = swapped_if_big(v);
  }
  /// Makes `values` as long as was written; each has `bytes` at least.
  template <class T>
  void size(std::vector<T>& values, std::size_t bytes) {
    std::uint64_t count = 0;
    one(count);
    require_bytes(count, bytes);
    values.resize(count);
  }
  /// There must be nothing left.
  void finish() const {
    if (!left_.empty())
      throw NotOurs();
  }

 private:
  template <class T>
  void one(T& value) {
    require_bytes(1, sizeof value);
    std::memcpy(&value, left_.data(), sizeof value);
    value = swapped_if_big(value);
    left_.remove_prefix(sizeof value);
  }
  void require_bytes(std::uint64_t count, std::size_t bytes) const {
    if (count > left_.size() / bytes)
      throw NotOurs();
  }

  std::string_view left_;
};

constexpr std::string_view kMagic = "grelha partial 1\n";
constexpr std::size_t kChecksum = 8;

/// Writes the lines of the header.
class HeadWriter {
 public:
  std::string text;

  template <class... Number>
  void numbers(std::string_view name, Number... values) {
    text += name;
    ((text += ' ' + std::to_string(values)), ...);
    text += '\n';
  }
};

/// Reads the lines of the header; tail() is the data behind them.
class HeadReader {
 public:
  explicit HeadReader(std::string_view bytes) : left_(bytes) {}

  std::string_view tail() const { return left_; }

  /// Returns true if the next line begins with this word.
  bool next_is(std::string_view word) const {
    return left_.starts_with(word) && left_.substr(word.size()).starts_with(' ');
  }

  /// Consumes the next line, which must begin with this word, and returns the text behind it.
  std::string_view line(std::string_view word) {
    const std::size_t end = left_.find('\n');
    expect_that(end != left_.npos && end > word.size() && next_is(word));
    const std::string_view text = left_.substr(word.size() + 1, end - word.size() - 1);
    left_.remove_prefix(end + 1);
    return text;
  }

  template <class... Number>
  void numbers(std::string_view word, Number&... values) {
    std::string_view text = line(word);
    bool first = true;
    ((read(text, first, values), first = false), ...);
    expect_that(text.empty());
  }

  static void expect_that(bool holds) {
    if (!holds)
      throw NotOurs();
  }

 private:
  /// Takes a number from the front of a text.
  static int take(std::string_view& text, bool first) {
    if (!first) {
      expect_that(text.starts_with(' '));
      text.remove_prefix(1);
    }
    int number = 0;
    const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    expect_that(error == std::errc());
    text.remove_prefix(static_cast<std::size_t>(next - text.data()));
    return number;
  }
  static void read(std::string_view& text, bool first, int& to) { to = take(text, first); }
  static void read(std::string_view& text, bool first, bool& to) {
    const int number = take(text, first);
    expect_that(number == 0 || number == 1);
    to = number != 0;
  }
  static void read(std::string_view& text, bool first, std::size_t& to) {
    const int number = take(text, first);
    expect_that(number >= 0);
    to = static_cast<std::size_t>(number);
  }

  std::string_view left_;
};

Checkpoint parse_body(std::string_view body) {
  HeadReader head(body);
  Identity identity;
  if (head.next_is("name"))
    identity.name = printable(head.line("name"));
  identity.scene = head.line("scene");
  identity.settings = head.line("settings");
  Checkpoint c{std::move(identity), Picture::load_numbers(head)};
  HeadReader::expect_that(c.picture.has_valid_numbers());
  Source source(head.tail());
  c.picture.load_arrays(source);
  source.finish();
  HeadReader::expect_that(c.picture.is_valid());
  return c;
}

std::uint64_t checksum_at(std::string_view bytes, std::size_t at) {
  std::uint64_t v = 0;
  Source(bytes.substr(at)).values(v);
  return v;
}

std::uint64_t digest_of(std::string_view bytes) {
  Digest digest;
  digest.bytes(bytes.data(), bytes.size());
  return digest.low64();
}

}  // namespace

void write_checkpoint(const std::string& path,
                      const Identity& identity,
                      const Picture& picture,
                      bool durable) {
  AtomicFile file(path, durable);
  Sink sink(file.stream());
  HeadWriter head;
  picture.save_numbers(head);
  const std::string name = identity.name.empty() ? "" : "name " + identity.name + '\n';
  sink.text(std::string(kMagic) + name + "scene " + identity.scene + "\nsettings " +
            identity.settings + '\n' + head.text);
  picture.save_arrays(sink);
  sink.finish();
  file.commit();
}

Checkpoint parse_checkpoint(const std::string& path, std::string_view bytes) {
  constexpr char kNotOurs[] = "not a .grelha partial this program reads";
  if (!bytes.starts_with(kMagic))
    throw FileError(path, kNotOurs);
  if (bytes.size() < kMagic.size() + kChecksum)
    throw FileError(path, "damaged: it ends early");
  const std::size_t end = bytes.size() - kChecksum;
  if (digest_of(bytes.substr(0, end)) != checksum_at(bytes, end))
    throw FileError(path, "damaged: its checksum is wrong");
  try {
    return parse_body(bytes.substr(kMagic.size(), end - kMagic.size()));
  } catch (const NotOurs&) {
    throw FileError(path, kNotOurs);
  }
}

Checkpoint read_checkpoint(const std::string& path) {
  try {
    return parse_checkpoint(path, load_file(path));
  } catch (const ParseError&) {  // load_file() reads for scenes as well
    throw FileError(path, "damaged: its gzip data are broken");
  }
}

namespace {

Partial part_of(const std::string& path, Checkpoint&& c) {
  Accumulator* const sums = c.picture.sums();
  if (!sums)
    throw FileError(
        path,
        "the checkpoint of a picture by --error, --time or --aa adaptive, which has no parts");
  return {std::move(c.identity), std::move(*sums)};
}

std::string range_text(const Range& range) {
  return std::to_string(range.begin) + ':' + std::to_string(range.end);
}

}  // namespace

std::string part_text(const Part& part) {
  return "rows " + range_text(part.rows) + ", samples " + range_text(part.samples);
}

bool is_partial_name(std::string_view path) {
  return path.ends_with(".grelha");
}

Partial parse_partial(const std::string& path, std::string_view bytes) {
  return part_of(path, parse_checkpoint(path, bytes));
}

Partial read_partial(const std::string& path) {
  return part_of(path, read_checkpoint(path));
}

namespace {

namespace fs = std::filesystem;

constexpr int kMaxSavedNames = 10;

/// The picture's name, or the one it would have in this folder.
std::string picture_name(const RenderCommand& command) {
  if (command.image != kStdout && !is_special_file(command.image))
    return command.image;
  return default_image(command.scene, format_of(command.image, command.format));
}

bool path_exists(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

constexpr std::string_view kFreshFolder = "grelha-XXXXXX";  // X: any letter or digit

}  // namespace

void remove_kept(const std::string& work) {
  std::error_code none;
  fs::remove(work, none);
  const fs::path folder = fs::absolute(work, none).parent_path();
  const std::string name = folder.filename().string();
  if (name.size() == kFreshFolder.size() && name.starts_with(kFreshFolder.substr(0, 7)))
    fs::remove(folder, none);  // where it is empty
}

SavedNames saved_names(const RenderCommand& command,
                       const std::function<bool(const std::string&)>& fits) {
  const fs::path name = picture_name(command);
  const auto format = format_of(name.string(), command.format);
  SavedNames names;
  for (int i = 0; i < kMaxSavedNames; ++i) {
    const std::string stem = (name.parent_path() / name.stem()).string() + ".partial" +
                             (i == 0 ? "" : std::to_string(i));
    names.picture = format ? stem + '.' + std::string(ending_of(*format)) : "";
    names.work = stem + ".grelha";
    if (!path_exists(names.work) || fits(names.work))
      return names;
  }
  return {};
}

std::string write_fallback(const std::string& work,
                           const std::function<void(const std::string&)>& write) {
  std::error_code none;
  const fs::path own = fs::absolute(work, none).parent_path(), name = fs::path(work).filename();
  // a new folder, into which no other user can have put a file
  std::string fresh = (fs::temp_directory_path(none) / kFreshFolder).string();
  const bool is_fresh = mkdtemp(fresh.data()) != nullptr;
  for (const fs::path& folder : {fs::path(is_fresh ? fresh : ""), fs::current_path(none)}) {
    const fs::path target = folder / name;
    if (folder.empty() || path_exists(target) || fs::equivalent(folder, own, none))
      continue;
    try {
      write(target.string());
      return target.string();
    } catch (const FileError&) {  // there is no room either
      fs::remove(fresh, none);    // where it is empty
    }
  }
  return "";
}

}  // namespace grelha
