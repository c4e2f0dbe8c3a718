// Text read in chunks against the same text read word by word: scene, warnings and errors. A part
// of nff_reader_test.
#include "frontend/nff/nff_chunks.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <bit>
#include <random>

#include "frontend/nff/nff_reader.hpp"
#include "tests/support/reading.hpp"

namespace grelha {
namespace {

using test::kFill;
using test::kView;
using Lines = std::vector<std::string>;

constexpr ChunkSizes kNoChunks{std::size_t(1) << 40, 1};

const NffChunks::Report kTellNobody = [](const char*) {};

/// More threads than one, wherever this runs.
class SeveralThreads {
 public:
  SeveralThreads() { omp_set_num_threads(3); }
  ~SeveralThreads() { omp_set_num_threads(before_); }

 private:
  int before_ = omp_get_max_threads();
};

/// All that reading says and makes, as text: floats by their bits.
class Told {
 public:
  template <class T>
  Told& operator<<(const T& value) {
    if constexpr (std::is_same_v<T, float>)
      text += std::to_string(std::bit_cast<std::uint32_t>(value)) + ' ';
    else if constexpr (std::is_same_v<T, double>)
      text += std::to_string(std::bit_cast<std::uint64_t>(value)) + ' ';
    else if constexpr (std::is_convertible_v<T, std::string>)
      text += value + std::string("\n");
    else
      text += std::to_string(value) + ' ';
    return *this;
  }
  Told& operator<<(const Float3& v) { return *this << v.x << v.y << v.z; }
  template <class T>
  Told& operator<<(const std::vector<T>& values) {
    *this << values.size();
    for (const T& value : values)
      *this << value;
    text += '\n';
    return *this;
  }
  Told& operator<<(const Material& m) {
    return *this << m.diffuse << m.specular << m.mirror << m.transmission << m.shine << m.ior
                 << int(m.fresnel) << m.emission << m.roughness;
  }
  Told& operator<<(const Light& l) { return *this << l.position << l.color << l.edge1 << l.edge2; }
  Told& operator<<(const Object& o) { return *this << o.first_triangle << o.triangle_count; }
  Told& operator<<(const AreaLight& l) {
    return *this << l.corner << l.edge1 << l.edge2 << l.color << l.samples << l.light;
  }
  std::string text;
};

void tell_geometry(Told& told, const Geometry& g) {
  told << g.spheres.x << g.spheres.y << g.spheres.z << g.spheres.radius << g.spheres.material;
  const Triangles& t = g.triangles;
  told << t.x << t.y << t.z << t.nx << t.ny << t.nz << t.a << t.b << t.c << t.material;
  const Cones& c = g.cones;
  told << c.base_x << c.base_y << c.base_z << c.base_radius << c.apex_x << c.apex_y << c.apex_z
       << c.apex_radius << c.material;
  const Planes& p = g.planes;
  told << p.x << p.y << p.z << p.nx << p.ny << p.nz << p.material << g.objects;
}

void tell_scene(Told& told, const SceneFile& file) {
  tell_geometry(told, file.scene.geometry);
  told << file.scene.materials << file.scene.lights << file.scene.background;
  const EntityCounts& n = file.counts;
  told << n.s << n.p << n.pp << n.c << n.pl << n.box << n.mesh << n.ply << n.lights << n.materials;
  told << file.dropped.not_finite << file.dropped.zero_area << file.points;
  told << file.camera.angle_deg << file.camera.width << file.camera.height << file.area_lights;
  told << file.accelerator << file.samples_per_pixel << int(file.box_order) << file.environment
       << file.source_bytes << file.meshes;
}

std::string all_told(const std::string& text, const ChunkSizes& chunks) {
  Told told;
  const auto warn = [&](const std::string& line) { told << line; };
  const std::string error = test::message_of(
      [&] { tell_scene(told, read_nff("scene.nff", text, warn, {}, nullptr, chunks)); });
  return told.text + error;
}

/// Makes texts of entities of every kind.
class Author {
 public:
  explicit Author(unsigned seed) : random_(seed) {}

  /// `odd`: of a thousand entities, how many are none that a chunk takes.
  std::string text(int entities, int odd) {
    text_ = below(8) == 0 ? "" : kView;
    if (below(4) != 0)
      text_ += kFill;
    for (int i = 0; i < entities; ++i) {
      below(1000) < odd ? odd_entity() : plain_entity();
      end_line();
    }
    if (below(3) == 0)
      text_.resize(text_.size() - std::size_t(below(12)));
    return text_;
  }

 private:
  int below(int n) { return int(random_() % unsigned(n)); }

  void end_line() {
    constexpr const char* kEnds[] = {
        "\n", "\r\n", "\r", "\n\n", " # p 3 here\n", "\n# s 1 2 3 4\n", " ", "\t\n", "// s 1\n"};
    text_ += kEnds[below(9)];
  }
  /// Between the words of an entity, mostly a blank.
  void gap() {
    constexpr const char* kGaps[] = {"\n", "\r\n", "\t", "  ", " # s 1 1 1 1\n", "\r"};
    text_ += below(6) > 0 ? " " : kGaps[below(6)];
  }
  void number() {
    constexpr const char* kOthers[] = {
        "1e-3", "-0", "nan", "inf", "1e30", "+2", "0.12345678901234567", ".5", "3.", "1e-50"};
    gap();
    if (below(40) == 0)
      text_ += kOthers[below(10)];
    else
      text_ +=
          std::to_string(below(2000) - 1000) + (below(3) ? "." + std::to_string(below(9)) : "");
  }
  void numbers(int count) {
    for (int i = 0; i < count; ++i)
      number();
  }
  /// A polygon around the origin; some of its corners may be repeated or moved.
  void polygon(bool patch) {
    const int corner_count = 3 + (below(3) == 0 ? below(7) : 0);
    text_ += patch ? "pp" : "p";
    gap();
    text_ += std::to_string(corner_count);
    const bool flat = below(4) == 0;
    for (int i = 0; i < corner_count; ++i) {
      if (flat)
        text_ += " 0 " + std::to_string(i * (corner_count - i)) + ' ' + std::to_string(i / 2 * 3);
      else
        numbers(3);
      if (patch && below(9) == 0)
        text_ += " 0 0 0";
      else if (patch)
        numbers(3);
    }
  }
  void plain_entity() {
    switch (below(12)) {
      case 0:
        text_ += "c";
        return numbers(8);
      case 1:
        return polygon(patches_ = patches_ || below(20) == 0);
      case 2:
        text_ += below(2) ? "f 1 .5 0 .8 .2 10 0 1" : "f 1 1 1 .5 1 0 0 .2 5 0 1";
        return;
      case 3:
      case 4:
      case 5:
        return polygon(false);
      default:
        text_ += "s";
        return numbers(4);
    }
  }
  void odd_entity() {
    static const Lines kOdd = {"s 1 1 1 1 7 7",
                               "sphere 1 2",
                               "12 13",
                               "p 2 0 0 0 1 1 1",
                               "s 0 0 zero 1",
                               "s 1 1",
                               "f 1 1",
                               "f 1 1 1",
                               "f 1 .5 0 .8 .2 10 0 1 brick",
                               "p 99999999 0 0 0",
                               "p -3 0",
                               "l 1 2 3",
                               "b 0 0 0",
                               "pl 0 0 0 1 0 0 0 1 0",
                               "box 0 0 0 1 1 1",
                               "aabb 0 0 0 1 1 1",
                               "/* a ball\ns 1 1 1 1\n*/ s 2 2 2 2",
                               "s 0 0 /* z */ 0 1",
                               "s 0 0 0 1 /*",
                               "s 1.#IND 0 0 1",
                               "st 0 0 0 1",
                               "pt 3 0 0 0 0 0 1 0 0 1 0 0 1 0 0 1",
                               "L 1 1 1 2\np 4 0 0 0 1 0 0 1 1 0 0 1 0",
                               "L 0 0 0 0",
                               "mesh 3 1 0 0 0 1 0 0 0 1 0 1 2 3",
                               "mat 1 1 1 .5 1 0 0 .2 5 0 1",
                               "spp 4",
                               "env p 3",
                               "f 1 1 1 1 1 1 1 0",
                               "npl 0 0 1 2",
                               "accel s 1",
                               "x\n",
                               "pp 3 0 0 0",
                               "f 2 2 2 2 2 2 2 2 2"};
    text_ += kOdd[std::size_t(below(int(kOdd.size())))];
  }

  std::mt19937 random_;
  std::string text_;
  bool patches_ = false;
};

TEST(NffChunks, ReadWhatWordsInTurnDo) {
  const SeveralThreads threads;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    constexpr int kOdd[] = {0, 0, 1, 3, 10, 100};
    const std::string text = Author(seed).text(20 + int(seed % 300), kOdd[seed % 6]);
    const std::string wanted = all_told(text, kNoChunks);
    for (const ChunkSizes sizes :
         {ChunkSizes{16 + seed % 60, 1 + seed % 9}, ChunkSizes{200 + seed % 700, 2 + seed % 5}})
      ASSERT_EQ(all_told(text, sizes), wanted)
          << "seed " << seed << ", chunks of " << sizes.bytes << '\n'
          << text;
  }
}

/// A long text that is odd nowhere but in the place given.
std::string long_text(std::string_view odd, std::size_t line) {
  std::string text = kView + kFill;
  for (std::size_t i = 0; i < 400; ++i)
    text += i == line ? std::string(odd) + '\n' : "s 0 0 " + std::to_string(i) + " 1\n";
  return text;
}

/// Every place of a chunk, and of its border.
TEST(NffChunks, OddLinesMayStandAnywhere) {
  const SeveralThreads threads;
  for (const char* odd :
       {"s 0 0 0 1 1", "p 2 0 0 0", "pl 0 0 0 1 0 0 0 1 0", "f 1 1 1 1", "s 1", "q"})
    for (std::size_t line = 0; line < 400; line += 1 + line % 3) {
      const std::string text = long_text(odd, line);
      ASSERT_EQ(all_told(text, {150, 5}), all_told(text, kNoChunks)) << odd << ' ' << line;
    }
}

TEST(NffChunks, TakeAllThatIsPlain) {
  const SeveralThreads threads;
  const std::string text = long_text("s 1 1 1 1", 7);
  NffChunks chunks("scene.nff", text, {100, 3});
  SceneFile file;
  file.scene.materials.resize(1);
  const char* const begin = text.data() + text.find("s 0 0");
  ASSERT_TRUE(chunks.due(begin));
  const NffChunks::ParsedChunks taken = chunks.read_run(begin, file, kTellNobody);
  EXPECT_EQ(file.counts.s, 400u);
  EXPECT_EQ(taken.end, text.data() + text.size() - 1);
  EXPECT_EQ(taken.last_entity.data(), text.data() + text.rfind('s'));
}

TEST(NffChunks, EndBeforeWhatIsOddAndLeaveItsSurroundings) {
  const SeveralThreads threads;
  const std::string text = long_text("s 1 1 1 zero", 60);
  NffChunks chunks("scene.nff", text, {100, 20});
  SceneFile file;
  file.scene.materials.resize(1);
  const NffChunks::ParsedChunks taken =
      chunks.read_run(text.data() + text.find("s 0 0"), file, kTellNobody);
  EXPECT_EQ(file.counts.s, 60u);
  const char* const odd = text.data() + text.find("s 1 1 1 zero");
  EXPECT_EQ(taken.end, odd - 1);
  EXPECT_FALSE(chunks.due(odd));
  EXPECT_FALSE(chunks.due(odd + 1900));
  EXPECT_TRUE(chunks.due(odd + 2000));
}

TEST(NffChunks, AreOnlyForSeveralThreads) {
  const std::string text = long_text("s 1 1 1 1", 7);
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  EXPECT_FALSE(NffChunks("scene.nff", text, {100, 20}).due(text.data()));
  omp_set_num_threads(2);
  EXPECT_TRUE(NffChunks("scene.nff", text, {100, 20}).due(text.data()));
  omp_set_num_threads(before);
}

}  // namespace
}  // namespace grelha
