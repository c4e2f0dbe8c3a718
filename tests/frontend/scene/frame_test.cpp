// Scenes whose coordinates floats cannot hold: read in a frame of their own, each coordinate is
// what the file says to a float's last place in that frame, and pictures are those of the same
// scene at the origin.
#include "frontend/scene/scene_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "frontend/input/read_scene.hpp"
#include "grelha/render.hpp"
#include "tests/support/random.hpp"
#include "tests/support/reading.hpp"

namespace grelha::test {
namespace {

using Offset = std::array<double, 3>;
constexpr Offset kSurvey{512345.5, 4649776.25, -103.75};

std::string number(double x) {
  std::ostringstream text;
  text.precision(17);
  text << x;
  return text.str();
}

/// A text with each `<x y z>` moved and scaled, and each `[r]` scaled.
std::string placed_text(std::string_view text, const Offset& offset, double scale = 1) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '<' && text[i] != '[') {
      out += text[i];
      continue;
    }
    const std::size_t end = text.find(text[i] == '<' ? '>' : ']', i);
    std::istringstream numbers{std::string(text.substr(i + 1, end - i - 1))};
    double x = 0;
    for (std::size_t a = 0; numbers >> x; ++a)
      out += (a == 0 ? "" : " ") + number(scale * x + (text[i] == '<' ? offset[a] : 0));
    i = end;
  }
  return out;
}

constexpr std::string_view kEverything = R"(b .1 .2 .3
v
from <3 -5 4>
at <0 0 .5>
up 0 0 1
angle 40
hither 1
resolution 64 48
l <5 -5 9> 1 1 1
light punctual <-2 -4 6> .5 .5 .5
al <1 1 5> [1] 0 0 0 [1] 0 .2 .2 .2
al <-3 1 5> <0 0 0> [1] [1] .1 .1 .1
light quad <3 1 5> .1 .1 .1 <4 1 5> <3 2 5> 4
f .8 .3 .2 .7 .3 20 0 1
s <-.75 0 .5> [.4]
c <.8 .1 0> [.3] <.9 .3 1.1> [.1]
p 4 <-2 -2 0> <2 -2 0> <2 2 0> <-2 2 0>
pp 3 <-1 1 .2> 0 0 1 <-.5 1 .9> 0 -1 0 <-.2 1.2 .4> 0 -1 1
box <.1 -.9 0> <.5 -.6 .3>
aabb <-1.5 -1.2 .1> <-1.25 -1 .7>
pl <-9 9 0> <0 8.5 0> <0 8.5 1>
mesh 3 1
<1 1 0> <1.5 1 0> <1.25 1.25 1>
1 2 3
)";

SceneFile read_text(const TemporaryFolder& folder, const std::string& name, const std::string& s) {
  return read_scene(folder.add(name, s), nullptr);
}

std::vector<float> picture(const SceneFile& file) {
  RenderStats stats;
  return render(World(file.scene, {}), file.camera, {}, stats).rgb;
}

std::size_t different(const std::vector<float>& a, const std::vector<float>& b) {
  std::size_t n = a.size() != b.size();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    n += std::abs(a[i] - b[i]) > 1e-3f;
  return n;
}

TEST(Frame, KeepsWhatFloatsWouldLose) {
  const TemporaryFolder folder;
  const SceneFile here = read_text(folder, "here.nff", placed_text(kEverything, {}));
  const SceneFile far = read_text(folder, "far.nff", placed_text(kEverything, kSurvey));
  EXPECT_EQ(here.frame, Frame{});
  ASSERT_NE(far.frame, Frame{});
  const Triangles &a = here.scene.geometry.triangles, &b = far.scene.geometry.triangles;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.vertex_count(); ++i) {
    EXPECT_NEAR(far.frame.outside(b.x[i], 0), kSurvey[0] + double{a.x[i]}, 1e-6) << i;
    EXPECT_NEAR(far.frame.outside(b.y[i], 1), kSurvey[1] + double{a.y[i]}, 1e-6) << i;
    EXPECT_NEAR(far.frame.outside(b.z[i], 2), kSurvey[2] + double{a.z[i]}, 1e-6) << i;
  }
  EXPECT_EQ(different(picture(here), picture(far)), 0u);
}

/// normal . x + constant = 0, and pairs of bounds, are not three numbers of a place.
TEST(Frame, TakesPlanesAndPairsAlong) {
  const TemporaryFolder folder;
  const auto text = [](const Offset& o) {
    std::string s = placed_text(
        "v\nfrom <0 -6 2>\nat <0 0 0>\nup 0 0 1\nangle 40\nl <2 -5 9>\nf 1 1 1 1 0 1 0 0\n"
        "s <.5 0 .3> [.7]\n",
        o);
    s += "npl .6 0 .8 " + number(1.5 - (.6 * o[0] + .8 * o[2])) + "\naabb";
    for (std::size_t a = 0; a < 3; ++a)
      s += ' ' + number(o[a] - 1) + ' ' + number(o[a] - .5);
    return s + '\n';
  };
  const SceneFile here = read_text(folder, "here.nff", text({}));
  const SceneFile far = read_text(folder, "far.nff", text(kSurvey));
  EXPECT_EQ(here.box_order, BoxOrder::kPairs);
  EXPECT_EQ(far.box_order, BoxOrder::kPairs);
  EXPECT_NE(far.frame, Frame{});
  EXPECT_EQ(different(picture(here), picture(far)), 0u);
}

TEST(Frame, EnlargesWhatIsTiny) {
  const TemporaryFolder folder;
  const SceneFile here = read_text(folder, "here.nff", placed_text(kEverything, {}));
  for (const int power : {-45, -66, -80, -130}) {
    const std::string text = placed_text(kEverything, {}, std::ldexp(1, power));
    const SceneFile tiny = read_text(folder, "tiny.nff", text);
    EXPECT_GT(tiny.frame.scale, 1) << power;
    EXPECT_EQ(different(picture(here), picture(tiny)), 0u) << power;
  }
}

/// A mesh in a survey's coordinates, as text, in doubles of either byte order and as integers.
struct Ply {
  const char* name;
  const char* format;
  const char* type;
};

std::string bytes_of(double x, std::string_view type, bool swap) {
  std::string out;
  const auto add = [&](auto value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    out.assign(raw, sizeof value);
  };
  if (type == "double")
    add(x);
  else
    add(static_cast<std::int32_t>(x));
  if (swap)
    std::reverse(out.begin(), out.end());
  return out;
}

std::string ply_text(const Ply& ply, const Offset& offset) {
  std::string s = std::string("ply\nformat ") + ply.format + " 1.0\nelement vertex 60\n";
  for (const char axis : {'x', 'y', 'z'})
    s += std::string("property ") + ply.type + ' ' + axis + '\n';
  s += "element face 20\nproperty list uchar int vertex_indices\nend_header\n";
  const bool ascii = std::string_view(ply.format) == "ascii";
  const bool swap = std::string_view(ply.format) == "binary_big_endian";
  Random random(1);
  for (int i = 0; i < 60; ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      double x = offset[a] + static_cast<double>(random.below(64)) - 32;
      x = std::string_view(ply.type) == "int" ? std::floor(x) : x + random.below(8) * .125;
      s += ascii ? number(x) + ' ' : bytes_of(x, ply.type, swap);
    }
    s += ascii ? "\n" : "";
  }
  for (int i = 0; i < 20; ++i) {
    s += ascii ? "3 " : "\3";
    for (int k = 0; k < 3; ++k)
      s += ascii ? number(3 * i + k) + ' ' : bytes_of(3 * i + k, "int", swap);
  }
  return s;
}

TEST(Frame, KeepsMeshesInDoublesAndIntegers) {
  const TemporaryFolder folder;
  for (const Ply& ply : {Ply{"text", "ascii", "double"},
                         Ply{"text as floats", "ascii", "float"},
                         Ply{"little", "binary_little_endian", "double"},
                         Ply{"big", "binary_big_endian", "double"},
                         Ply{"integers", "binary_little_endian", "int"}}) {
    const Offset far{51234567, 464977633, -512};
    const SceneFile here = read_text(folder, "here.ply", ply_text(ply, {}));
    const SceneFile there = read_text(folder, "there.ply", ply_text(ply, far));
    const Triangles &a = here.scene.geometry.triangles, &b = there.scene.geometry.triangles;
    EXPECT_NE(there.frame, Frame{}) << ply.name;
    ASSERT_EQ(a.size(), b.size()) << ply.name;
    for (std::size_t i = 0; i < a.vertex_count(); ++i)
      ASSERT_EQ(there.frame.outside(Float3{b.x[i], b.y[i], b.z[i]}),
                (Offset{far[0] + double{a.x[i]}, far[1] + double{a.y[i]}, far[2] + double{a.z[i]}}))
          << ply.name;
  }
}

/// Primitives that have no area in floats say where to read them.
TEST(Frame, FindsWhatFloatsFlattenAltogether) {
  const TemporaryFolder folder;
  for (const std::string type : {"int", "uint", "double", "float"}) {
    const std::string text =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty " + type + " x\nproperty " + type +
        " y\nproperty " + type +
        " z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
        "1677721600 0 0\n1677721601 0 0\n1677721601 1 0\n1677721600 1 0\n3 0 1 2\n4 0 1 2 3\n";
    const SceneFile file = read_text(folder, "far.ply", text);
    EXPECT_EQ(file.scene.geometry.triangles.size(), 3u) << type;
    EXPECT_EQ(file.dropped.zero_area, 0u) << type;
    EXPECT_NE(file.frame, Frame{});
  }
  const std::string view =
      "v from 1677721600 0 9 at 1677721600 0 0 up 0 1 0 angle 30 hither 1 resolution 8 8\n";
  for (const std::string one : {"p 3 1677721600 0 0 1677721601 0 0 1677721600 1 0",
                                "p 4 1677721600 0 0 1677721601 0 0 1677721601 1 0 1677721600 1 0",
                                "c 1677721600 0 0 .1 1677721601 0 0 .1",
                                "box 1677721600 0 0 1677721601 1 0"})
    EXPECT_EQ(read_text(folder, "far.nff", view + one).dropped.zero_area, 0u) << one;
  const std::string flat = "p 3 1677721600 0 0 1677721601 0 0 1677721602 0 0";
  EXPECT_EQ(read_text(folder, "far.nff", view + flat).dropped.zero_area, 1u);
}

/// Meshes of one scene stay together, and with what the scene itself says.
TEST(Frame, IsOneForAScene) {
  const TemporaryFolder folder;
  const Ply ply{"little", "binary_little_endian", "double"};
  folder.add("a.ply", ply_text(ply, {500000.125, 4000000, 0}));
  folder.add("b.ply", ply_text(ply, {500080.125, 4000000, 0}));
  const SceneFile file =
      read_text(folder,
                "s.nff",
                "v\nfrom 500040 3999800 90\nat 500040 4000000 0\nup 0 0 1\nangle 40\n"
                "l 500040 3999800 290\nf 1 1 1 1 0 1 0 0\nply a.ply\nply b.ply\n"
                "s 500040.0625 4000000 10 5\n");
  const Geometry& g = file.scene.geometry;
  EXPECT_NE(file.frame, Frame{});
  EXPECT_EQ(g.triangles.x[60] - g.triangles.x[0], 80.f);
  EXPECT_EQ(file.frame.outside(g.spheres.x[0], 0), 500040.0625);
  EXPECT_EQ(file.frame.outside(file.camera.eye), (Offset{500040, 3999800, 90}));
  EXPECT_EQ(file.frame.outside(file.scene.lights[0].position), (Offset{500040, 3999800, 290}));
}

/// Coordinates that floats represent exactly are not translated, however large they are.
TEST(Frame, IsTheFilesOwnForFloats) {
  const TemporaryFolder folder;
  const Offset eighths{524288.125, -4194304.5, 1024};
  const SceneFile far = read_text(folder,
                                  "s.nff",
                                  placed_text("v\nfrom <0 0 9>\nat <0 0 0>\nup 0 1 0\nangle 40\n"
                                              "s <0 0 0> [1]\ns <1 1 1> [.5]\n",
                                              eighths));
  EXPECT_EQ(far.frame, Frame{});
  EXPECT_EQ(far.scene.geometry.spheres.x[0], 524288.125f);
}

}  // namespace
}  // namespace grelha::test
