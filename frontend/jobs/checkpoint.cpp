#include "frontend/jobs/checkpoint.hpp"

#include <charconv>
#include <ostream>

#include "frontend/files/atomic_file.hpp"
#include "frontend/files/little_endian.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/files/load_file.hpp"
#include "frontend/files/text.hpp"

namespace grelha {
namespace {

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

}  // namespace grelha
