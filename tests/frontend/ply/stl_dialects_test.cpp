// STL as programs write it: every dialect gives the triangles of the plain file. A part of
// ply_reader_test.
#include <array>
#include <cmath>
#include <set>

#include "frontend/files/text.hpp"
#include "frontend/ply/mesh_file.hpp"
#include "tests/support/random.hpp"
#include "tests/support/reading.hpp"

#include <gtest/gtest.h>

namespace grelha::test {
namespace {

using Corner = std::array<float, 3>;
/// Of numbers that every way of writing below keeps.
const std::vector<std::array<Corner, 3>> kFacets{
    {Corner{0, 0, 0}, Corner{1.5f, 0, 0}, Corner{0, 2, 0}},
    {Corner{0, 0, 0}, Corner{0, 2, 0}, Corner{0, 0, -12.25f}},
    {Corner{1.5f, 0, 0}, Corner{0, 0, 0}, Corner{0, 0, -12.25f}}};

Mesh plain() {
  Mesh mesh;
  mesh.x = {0, 1.5f, 0, 0};
  mesh.y = {0, 0, 2, 0};
  mesh.z = {0, 0, 0, -12.25f};
  mesh.indices = {0, 1, 2, 0, 2, 3, 1, 0, 3};
  return mesh;
}

/// What differs between writers of text. Each is a list of choices, the first of which is plain.
enum Axis {
  kBefore,
  kSolid,
  kNormal,
  kOuter,
  kNumber,
  kAfterVertex,
  kEndLoop,
  kEndFacet,
  kEndSolid,
  kLine,
  kCase,
  kIndent,
  kAxes
};
const std::vector<std::string> kChoices[kAxes] = {
    {"",
     " ",
     "\n",
     "\t\n",
     "# by a program\n",
     "// by a program\n",
     "; by a program\n",
     "/* by\na program */\n",
     "\xEF\xBB\xBF",
     "\xEF\xBB\xBF\n\n",
     "color 1 0 0\n"},
    {"solid part",
     "solid",
     "solid" + std::string(100, '\0'),
     "solid facet",
     "solid facet normal",
     "solid vertex 1",
     "solid a # b",
     "solid end loop",
     "solid C:\\a\\b.stl",
     "solid g\xC3\xA9om\xE9trie",
     "solid a/*b",
     "solid part COLOR=1 0 0\ncolor 1 0 0",
     "solid a name that is longer than the eighty bytes before the count of a binary file, and "
     "ends"},
    {" normal 0 0 1",
     "",
     " normal",
     " normal nan nan nan",
     " normal -nan(ind) 0 1.#QNAN",
     " normal 0. 0.D0 1e+0",
     " normal\n0 0 1",
     " 0 0 1",
     " normal 0 0 1 # up"},
    {"outer loop", "outer  loop", "outerloop_", "loop", "outer loop # 3"},
    {"%g", "%.9g", "%.6e", "%.4E", "%+.3f", "%.3fD0", "%.3f,", "%.2f;comma", "%10.4f"},
    {"", " ", " # a corner", " // a corner", "#a corner", " 255 0 0", " ; the first vertex of 3"},
    {"endloop", "end loop", "endloop # 3", "end  loop"},
    {"endfacet",
     "end facet",
     "endfacet color 31744",
     "endfacet 7",
     "endfacet\ncolor 1 0 0",
     "endfacet\n\n"},
    {"endsolid part",
     "endsolid",
     "end solid",
     "end solid part",
     "",
     "endsolid facet normal\n# end",
     "endsolid\nmade by a program",
     "endsolid\n\x1A"},
    {"\n", "\r\n", "\r", "\n\n", " \n"},
    {"small", "CAPITAL", "Mixed"},
    {"", "  ", "\t"}};

std::string in_case(std::string text, const std::string& which) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool first = i == 0 || text[i - 1] == ' ';
    if (text[i] >= 'a' && text[i] <= 'z' && (which == "CAPITAL" || (which == "Mixed" && first)))
      text[i] = char(text[i] - 32);
  }
  return text;
}

std::string number_text(float v, std::string format) {
  const std::size_t comma = format.find(";comma");
  char text[64];
  std::snprintf(text, sizeof text, format.substr(0, comma).c_str(), double{v});
  std::string number = text;
  if (comma != format.npos)
    number[number.find('.')] = ',';
  return number;
}

struct Writer {
  std::array<std::size_t, kAxes> choice{};

  const std::string& of(Axis axis) const { return kChoices[axis][choice[axis]]; }
  std::string keyword(const std::string& text) const { return in_case(text, of(kCase)); }
  /// A piece of one line or several.
  std::string line(const std::string& text) const {
    std::string out = of(kIndent);
    for (const char c : text)
      out += c == '\n' ? of(kLine) + of(kIndent) : std::string(1, c);
    return out + of(kLine);
  }
  std::string facet(const std::array<Corner, 3>& corners) const {
    std::string text = line(keyword("facet" + of(kNormal)));
    if (of(kOuter) != "outerloop_")
      text += line(keyword(of(kOuter)));
    for (const Corner& corner : corners) {
      std::string vertex = keyword("vertex");
      for (const float c : corner)
        vertex += ' ' + number_text(c, of(kNumber));
      text += line(vertex + of(kAfterVertex));
    }
    return text + line(keyword(of(kEndLoop))) + line(keyword(of(kEndFacet)));
  }
  std::string solid() const {
    std::string text;
    for (const char c : of(kBefore))
      text += c == '\n' ? of(kLine) : std::string(1, c);
    text += line(of(kSolid));
    for (const auto& corners : kFacets)
      text += facet(corners);
    return text + line(keyword(of(kEndSolid)));
  }
};

/// Every two choices of two kinds, and each alone.
std::set<std::string> text_dialects() {
  std::set<std::string> all{Writer{}.solid()};
  for (int a = 0; a < kAxes; ++a)
    for (int b = 0; b < a; ++b)
      for (std::size_t i = 0; i < kChoices[a].size(); ++i)
        for (std::size_t j = 0; j < kChoices[b].size(); ++j) {
          Writer writer;
          writer.choice[std::size_t(a)] = i;
          writer.choice[std::size_t(b)] = j;
          all.insert(writer.solid());
        }
  return all;
}

std::string bytes_of(const void* from, std::size_t size, bool turned) {
  std::string bytes(static_cast<const char*>(from), size);
  return turned ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

struct Binary {
  std::string header = "by a program";
  std::uint32_t count = 3;
  std::uint16_t attribute = 0;
  bool has_lengths = false, big_endian = false;
  Corner normal{0, 0, 1};

  std::string bytes() const {
    std::string all = header;
    all.resize(80, header.ends_with(' ') ? ' ' : '\0');
    all += bytes_of(&count, 4, big_endian);
    for (const auto& corners : kFacets) {
      for (const float c : normal)
        all += bytes_of(&c, 4, big_endian);
      for (const Corner& corner : corners)
        for (const float c : corner)
          all += bytes_of(&c, 4, big_endian);
      all += bytes_of(&attribute, 2, big_endian);
      if (has_lengths)
        all += std::string(attribute, '\x7F');
    }
    return all;
  }
};

std::set<std::string> binary_dialects() {
  std::set<std::string> all;
  for (const char* const header : {"",
                                   " ",
                                   "solid",
                                   "solid part ",
                                   "solid\nfacet normal 0 0 1 ",
                                   "SOLID by a program",
                                   "COLOR=\xFF\x80\x01\xFF,MATERIAL=",
                                   "\xEF\xBB\xBFsolid",
                                   "ply of a part",
                                   "v 1 2 3 "})
    for (const Corner& normal : {Corner{0, 0, 0}, Corner{.6f, .48f, .64f}, Corner{0, 0, NAN}}) {
      Binary one{header};
      one.normal = normal;
      for (const std::uint32_t count : {3u, 0u, 0xFFFFFFFFu}) {
        one.count = count;
        for (const std::uint16_t attribute : {0, 1, 31744, 0xFFFF}) {
          one.attribute = attribute;
          all.insert(one.bytes());
        }
        for (const std::uint16_t length : {1, 4, 50, 300}) {
          Binary longer = one;
          longer.attribute = length;
          longer.has_lengths = true;
          all.insert(longer.bytes());
          all.insert(longer.bytes() + '\n');
        }
      }
      one.count = 3;
      one.attribute = 0;
      for (const std::string& more : {std::string(1, '\0'),
                                      std::string("\n"),
                                      std::string(49, 'x'),
                                      std::string(50, ' '),
                                      std::string(1000, '\x1A')})
        all.insert(one.bytes() + more);
      one.attribute = 1;  // a length that happens to end with the file
      all.insert(one.bytes() + "end");
      one.attribute = 0;
      one.big_endian = true;
      all.insert(one.bytes());
    }
  return all;
}

std::string shown(const std::string& bytes) {
  return printable(bytes.substr(0, 40)) + " of " + std::to_string(bytes.size()) + " bytes";
}

void expect_plain(const std::string& bytes) {
  Mesh mesh;
  const std::string message =
      message_of([&] { mesh = read_stl_mesh("m.stl", bytes, nullptr, nullptr, {}); });
  ASSERT_EQ(message, "") << bytes;
  EXPECT_EQ(mesh.indices, plain().indices) << shown(bytes) << '\n' << bytes;
  EXPECT_EQ(mesh.x, plain().x) << bytes;
  EXPECT_EQ(mesh.y, plain().y) << bytes;
  EXPECT_EQ(mesh.z, plain().z) << bytes;
  const bool begins_otherwise = bytes.find("/* by") < 5 || bytes.find("color") < 5;
  EXPECT_NE(is_stl(bytes), begins_otherwise) << "by any name: " << shown(bytes);
}

TEST(StlDialects, OfText) {
  const auto all = text_dialects();
  EXPECT_GT(all.size(), 1500u);
  for (const std::string& bytes : all) {
    expect_plain(bytes);
    if (HasFatalFailure() || HasNonfatalFailure())
      return;
  }
}

TEST(StlDialects, OfBinary) {
  const auto all = binary_dialects();
  EXPECT_GT(all.size(), 500u);
  for (const std::string& bytes : all) {
    expect_plain(bytes);
    if (HasFatalFailure() || HasNonfatalFailure())
      return;
  }
}

using Channels = std::array<int, 3>;

/// sRGB of bytes, as its standard has it.
float light_of(double byte) {
  const double c = byte / 255;
  return float(c <= .04045 ? c / 12.92 : std::pow((c + .055) / 1.055, 2.4));
}

/// Words of three facets behind a header.
std::string colored(const std::string& header,
                    const std::array<std::uint16_t, 3>& words,
                    bool big_endian = false) {
  Binary plain{header};
  plain.big_endian = big_endian;
  std::string bytes = plain.bytes();
  for (std::size_t i = 0; i < 3; ++i)
    bytes.replace(84 + 50 * i + 48, 2, bytes_of(&words[i], 2, big_endian));
  return bytes;
}

/// Expects colours in bytes; those of 5 bits may be one byte off before they become light.
void expect_colors(const std::string& bytes, const std::vector<Channels>& expected) {
  expect_plain(bytes);
  const Mesh mesh = read_stl_mesh("m.stl", bytes, nullptr, nullptr, {});
  ASSERT_EQ(mesh.red.size(), expected.size()) << shown(bytes);
  for (std::size_t f = 0; f < expected.size(); ++f)
    for (const auto& [channel, byte] : {std::pair(&mesh.red, expected[f][0]),
                                        std::pair(&mesh.green, expected[f][1]),
                                        std::pair(&mesh.blue, expected[f][2])})
      EXPECT_NEAR((*channel)[f], light_of(byte), .5 / 255 * 3) << shown(bytes) << " face " << f;
  EXPECT_TRUE(read_stl_mesh("m.stl", bytes, nullptr, nullptr, {}, false).red.empty());
}

/// Red in the low bits or in the high ones, bit 15 for "valid" or for "as the object", colours of
/// objects: random words, written by the rules of each program.
TEST(StlDialects, OfColors) {
  const std::string color("COLOR=\xFF\x80\x01\xFF", 10);
  const std::string material =
      "MATERIAL=" + std::string("\x10\x20\x30\xFF\x01\x02\x03\x04\x05\x06\x07\x08", 12);
  const Channels object{255, 128, 1}, finer{16, 32, 48}, white{255, 255, 255};
  const auto words = [](int r, int g, int b) {
    return std::pair(std::uint16_t(r | g << 5 | b << 10), std::uint16_t(b | g << 5 | r << 10));
  };
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    const auto five = [&] { return 1 + int(random.below(30)); };
    const Channels one{five(), five(), five()}, two{one[1], 31 - one[0], one[2]};
    const auto [low1, high1] = words(one[0], one[1], one[2]);
    const auto [low2, high2] = words(two[0], two[1], two[2]);
    const auto flag = [](std::uint16_t word) { return std::uint16_t(word | 0x8000); };
    const auto in_bytes = [](Channels c) {
      for (int& channel : c)
        channel = int(std::lround(channel * 255. / 31));
      return c;
    };
    const Channels first = in_bytes(one), second = in_bytes(two);
    for (const bool turned : {false, true})
      expect_colors(colored("by VisCAM", {flag(high1), high2, flag(high2)}, turned),
                    {first, white, second});
    expect_colors(colored("by Magics " + color, {low1, flag(0), low2}), {first, object, second});
    expect_colors(colored(color + ',' + material, {0x8000, low1, 0xFFFF}), {finer, first, finer});
    expect_colors(colored(color + ',' + material, {0x8000, 0, 0x8000}), {finer, {0, 0, 0}, finer});
    expect_colors(colored("by MeshLab " + color, {flag(low1), flag(low2), flag(low1)}),
                  {first, second, first});
  }
  expect_colors(colored(color, {0, 0, 0}), {object, object, object});
  expect_colors(colored(color, {0xFFFF, 0xFFFF, 0xFFFF}), {object, object, object});
  expect_colors(colored(material, {0, 0, 0}), {finer, finer, finer});
  expect_colors(colored("plain", {0, 0x7FFF, 1}), {});
  expect_colors(colored(std::string(76, ' ') + "COLOR=", {0, 0, 0}), {});
}

}  // namespace
}  // namespace grelha::test
