#include "frontend/partial.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cstring>

#include "frontend/atomic_file.hpp"
#include "frontend/digest.hpp"
#include "frontend/parse_error.hpp"
#include "frontend/text.hpp"

namespace grelha {
namespace {

constexpr std::string_view kMagic = "grelha partial 1\n";
constexpr std::size_t kChecksum = 8;

std::string head_of(const Partial& p) {
  const Accumulator& a = p.sums;
  const auto range = [](const Range& r) { return std::to_string(r.begin) + ' ' + std::to_string(r.end) + '\n'; };
  return std::string(kMagic) + "scene " + p.identity.scene + "\nsettings " + p.identity.settings + "\npicture " + std::to_string(a.width) + ' ' +
         std::to_string(a.height) + ' ' + std::to_string(a.samples) + "\nrows " + range(a.part.rows) + "samples " + range(a.part.samples);
}

/// Numbers in little-endian order.
std::int64_t swapped_if_big(std::int64_t v) {
  if constexpr (std::endian::native == std::endian::big) return std::int64_t(__builtin_bswap64(std::uint64_t(v)));
  return v;
}

/// Writes and digests alike.
class Sink {
 public:
  explicit Sink(std::ostream& out) : out_(out) {}
  void put(const void* data, std::size_t size) {
    digest_.bytes(data, size);
    out_.write(static_cast<const char*>(data), std::streamsize(size));
  }
  void put(const std::vector<std::int64_t>& values) {
    if constexpr (std::endian::native == std::endian::little) return put(values.data(), values.size() * sizeof(std::int64_t));
    for (const std::int64_t v : values) {
      const std::int64_t little = swapped_if_big(v);
      put(&little, sizeof little);
    }
  }
  void finish() {
    const std::int64_t checksum = swapped_if_big(std::int64_t(digest_.low64()));
    out_.write(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  }

 private:
  std::ostream& out_;
  Digest digest_;
};

/// The lines of the head, and what lies behind them.
class Head {
 public:
  Head(const std::string& path, std::string_view bytes) : path_(path), left_(bytes) {}

  std::string_view line(std::string_view word) {
    const std::size_t end = left_.find('\n');
    if (end == left_.npos || end < word.size() || left_.substr(0, word.size()) != word) refuse();
    const std::string_view text = left_.substr(word.size(), end - word.size());
    left_.remove_prefix(end + 1);
    return text;
  }
  template <std::size_t N>
  std::array<int, N> numbers(std::string_view word) {
    std::array<int, N> values{};
    const std::string_view text = line(word);
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t i = 0; i < N; ++i) {
      if (i > 0 && (at == end || *at++ != ' ')) refuse();
      const auto [next, error] = std::from_chars(at, end, values[i]);
      if (error != std::errc()) refuse();
      at = next;
    }
    if (at != end) refuse();
    return values;
  }
  Range range(std::string_view word, int most) {
    const auto [begin, end] = numbers<2>(word);
    if (begin < 0 || begin >= end || end > most) refuse();
    return {begin, end};
  }
  std::string_view rest() const { return left_; }
  [[noreturn]] void refuse() const { throw FileError(path_, "not a .grelha partial this program reads"); }

 private:
  const std::string& path_;
  std::string_view left_;
};

std::uint64_t digest_of(std::string_view bytes) {
  Digest digest;
  digest.bytes(bytes.data(), bytes.size());
  return digest.low64();
}

std::int64_t number_at(const char* bytes) {
  std::int64_t v;
  std::memcpy(&v, bytes, sizeof v);
  return swapped_if_big(v);
}

Partial parse_body(const std::string& path, std::string_view body) {
  Head head(path, body);
  Partial p;
  p.identity.scene = head.line("scene "), p.identity.settings = head.line("settings ");
  Accumulator& a = p.sums;
  const auto [width, height, samples] = head.numbers<3>("picture ");
  if (width < 1 || height < 1 || samples < 1 || width > kMostSide || height > kMostSide || samples > kMostSamples) head.refuse();
  a.width = width, a.height = height, a.samples = samples;
  a.part.rows = head.range("rows ", height), a.part.samples = head.range("samples ", samples);
  const std::size_t pieces = piece_count(a.part);
  const std::size_t sums = std::size_t(a.part.rows.end - a.part.rows.begin) * std::size_t(width) * 3;
  if (head.rest().size() != pieces + sums * sizeof(std::int64_t)) head.refuse();  // before anything is allocated
  const char* data = head.rest().data();
  a.done.assign(data, data + pieces);
  for (const std::uint8_t d : a.done)
    if (d > 1) head.refuse();
  a.sums.resize(sums);
  data += pieces;
  for (std::size_t i = 0; i < sums; ++i) a.sums[i] = number_at(data + i * sizeof(std::int64_t));
  return p;
}

}  // namespace

std::string part_text(const Part& part) {
  const auto range = [](const Range& r) { return std::to_string(r.begin) + ':' + std::to_string(r.end); };
  return "rows " + range(part.rows) + ", samples " + range(part.samples);
}

bool is_partial_name(std::string_view path) { return path.ends_with(".grelha"); }

void write_partial(const std::string& path, const Partial& partial, bool durable) {
  AtomicFile file(path, durable);
  Sink sink(file.stream());
  const std::string head = head_of(partial);
  sink.put(head.data(), head.size());
  sink.put(partial.sums.done.data(), partial.sums.done.size());
  sink.put(partial.sums.sums);
  sink.finish();
  file.commit();
}

Partial parse_partial(const std::string& path, std::string_view bytes) {
  if (!bytes.starts_with(kMagic)) throw FileError(path, "not a .grelha partial this program reads");
  if (bytes.size() < kMagic.size() + kChecksum) throw FileError(path, "damaged: it ends early");
  const std::string_view body = bytes.substr(0, bytes.size() - kChecksum);
  if (digest_of(body) != std::uint64_t(number_at(body.data() + body.size()))) throw FileError(path, "damaged: its checksum is wrong");
  return parse_body(path, body.substr(kMagic.size()));
}

Partial read_partial(const std::string& path) { return parse_partial(path, load_file(path)); }

}  // namespace grelha
