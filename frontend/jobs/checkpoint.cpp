#include "frontend/jobs/checkpoint.hpp"

#include <array>
#include <charconv>

#include "frontend/files/atomic_file.hpp"
#include "frontend/files/little_endian.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/files/text.hpp"

namespace grelha {
namespace {

constexpr std::string_view kMagic = "grelha partial 1\n";
constexpr std::size_t kChecksum = 8;

template <class... Number>
std::string line(const char* word, Number... numbers) {
  std::string text = word;
  ((text += ' ' + std::to_string(numbers)), ...);
  return text + '\n';
}

/// The lines of the head, and what lies behind them.
class Head {
 public:
  explicit Head(std::string_view bytes) : left_(bytes) {}

  bool begins_with(std::string_view word) const { return left_.starts_with(word); }
  std::string_view line(std::string_view word) {
    const std::size_t end = left_.find('\n');
    want(end != left_.npos && end >= word.size() && begins_with(word));
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
      want(i == 0 || (at != end && *at++ == ' '));
      const auto [next, error] = std::from_chars(at, end, values[i]);
      want(error == std::errc());
      at = next;
    }
    want(at == end);
    return values;
  }
  Range range(std::string_view word, int most) {
    const auto [begin, end] = numbers<2>(word);
    want(begin >= 0 && begin < end && end <= most);
    return {begin, end};
  }
  std::string_view rest() const { return left_; }
  static void want(bool holds) {
    if (!holds)
      throw NotOurs();
  }
  static void want_size(int width, int height) {
    want(width >= 1 && height >= 1 && width <= kMostSide && height <= kMostSide);
  }

 private:
  std::string_view left_;
};

std::size_t pixels_of(int width, int height) { return std::size_t(width) * std::size_t(height); }

// --- a part

std::string head_of(const Accumulator& a) {
  return line("picture", a.width, a.height, a.samples) +
         line("rows", a.part.rows.begin, a.part.rows.end) +
         line("samples", a.part.samples.begin, a.part.samples.end);
}

template <class Stream, class A>
void pass(Stream& stream, A& a) {
  stream.list(a.done, piece_count(a.part));
  stream.list(a.sums, pixels_of(a.width, a.part.rows.end - a.part.rows.begin) * 3);
}

Accumulator read_part(Head& head) {
  Accumulator a;
  const auto [width, height, samples] = head.numbers<3>("picture ");
  Head::want_size(width, height);
  Head::want(samples >= 1 && samples <= kMostSamples);
  a.width = width;
  a.height = height;
  a.samples = samples;
  a.part.rows = head.range("rows ", height);
  a.part.samples = head.range("samples ", samples);
  return a;
}

bool is_sound(const Accumulator& a) {
  for (const std::uint8_t d : a.done)
    if (d > 1)
      return false;
  return true;
}

// --- a picture by error

std::string head_of(const Refinement& r) {
  return line("refined", r.width, r.height, r.rounds, int(r.last), int(r.finished));
}

template <class Stream, class R>
void pass_refined(Stream& stream, R& r) {
  const std::size_t pixels = pixels_of(r.width, r.height);
  stream.values(
      r.fall, r.level, r.round_fall, r.round_level, r.seconds, r.share, r.rays, r.rho, r.bar);
  stream.list(r.log, pixels);
  stream.list(r.sums, pixels * 3);
  for (auto& level : r.squares)
    stream.list(level, pixels * 3);
  stream.list(r.cost, pixels);
  stream.list(r.inside, pixels);
  stream.list(r.around, pixels);
  stream.size(r.wanted, sizeof r.wanted[0]), stream.list(r.wanted, r.wanted.size());
}
void pass(Sink& sink, const Refinement& r) { pass_refined(sink, r); }
void pass(Source& source, Refinement& r) { pass_refined(source, r); }

Refinement read_refined(Head& head) {
  Refinement r;
  const auto [width, height, rounds, last, finished] = head.numbers<5>("refined ");
  Head::want_size(width, height);
  Head::want((last | finished) >> 1 == 0);
  r.width = width;
  r.height = height;
  r.rounds = rounds;
  r.last = last != 0;
  r.finished = finished != 0;
  return r;
}

// --- a picture by subdivision

std::string head_of(const Subdivided& s) {
  return line("subdivided", s.image.width, s.image.height, s.tiles);
}

template <class Stream, class Border>
void pass_border(Stream& stream, Border& border) {
  stream.size(border, 20);
  for (auto& [key, colour] : border)
    stream.values(key, colour.x, colour.y, colour.z);
}

template <class Stream, class S>
void pass_subdivided(Stream& stream, S& s) {
  stream.values(s.share);
  stream.list(s.image.rgb, pixels_of(s.image.width, s.image.height) * 3);
  stream.size(s.above, 8);
  for (auto& border : s.above)
    pass_border(stream, border);
  pass_border(stream, s.left);
  stream.size(s.colours, 12);
  for (auto& c : s.colours)
    stream.values(c.x, c.y, c.z);
}
void pass(Sink& sink, const Subdivided& s) { pass_subdivided(sink, s); }
void pass(Source& source, Subdivided& s) { pass_subdivided(source, s); }

Subdivided read_subdivided(Head& head) {
  Subdivided s;
  const auto [width, height, tiles] = head.numbers<3>("subdivided ");
  Head::want_size(width, height);
  Head::want(tiles >= 0);
  s.image.width = width;
  s.image.height = height;
  s.tiles = std::size_t(tiles);
  return s;
}

// --- all of them

Work read_head(Head& head) {
  if (head.begins_with("refined "))
    return read_refined(head);
  if (head.begins_with("subdivided "))
    return read_subdivided(head);
  return read_part(head);
}

Checkpoint parse_body(std::string_view body) {
  Head head(body);
  Checkpoint c;
  if (head.begins_with("name "))
    c.identity.name = printable(head.line("name "));
  c.identity.scene = head.line("scene ");
  c.identity.settings = head.line("settings ");
  c.work = read_head(head);
  Source source(head.rest());
  std::visit(
      [&](auto& work) {
        pass(source, work);
        source.finish();
        Head::want(is_sound(work));
      },
      c.work);
  return c;
}

template <class W>
void write(const std::string& path, const Identity& identity, const W& work, bool durable) {
  AtomicFile file(path, durable);
  Sink sink(file.stream());
  const std::string name = identity.name.empty() ? "" : "name " + identity.name + '\n';
  sink.text(std::string(kMagic) + name + "scene " + identity.scene + "\nsettings " +
            identity.settings + '\n' + head_of(work));
  pass(sink, work);
  sink.finish();
  file.commit();
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
                      const Work& work,
                      bool durable) {
  std::visit([&](const auto& w) { write(path, identity, w, durable); }, work);
}

void write_part(const std::string& path,
                const Identity& identity,
                const Accumulator& part,
                bool durable) {
  write(path, identity, part, durable);
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
