// Pictures rendered in parts, interrupted, kept in files and joined: the bits of the whole.
#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <sstream>

#include "frontend/files/digest.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/jobs/checkpoint.hpp"
#include "frontend/jobs/merge.hpp"
#include "frontend/jobs/partial.hpp"
#include "frontend/nff/nff_reader.hpp"
#include "grelha/accumulator.hpp"
#include "kernel/adaptive/adaptive_sampler.hpp"
#include "kernel/picture/picture.hpp"
#include "scenes/generators.hpp"
#include "tests/support/random.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace grelha::test {
namespace {

/// A scene with effects, and how it is rendered.
struct Case {
  const char* scene;
  int samples;
  /// letters: l lens, a area lights, g rough mirrors, n rays around the mirror direction, j
  /// jittered, r random
  const char* effects;
};

struct Job {
  SceneFile file;
  RenderOptions options;
};

Job make(const Case& c) {
  std::ostringstream text;
  scenes::find_generator(c.scene)->write(text, {2, false, ""});
  Job job{read_nff(c.scene, text.str(), [](const std::string&) {}), {}};
  job.options.sampling.samples = c.samples;
  job.options.sampling.seed = 3;
  Camera& camera = job.file.camera;
  camera.width = 37;
  camera.height = 29;  // no multiple of tile, piece, packet or register
  for (const char* e = c.effects; *e; ++e)
    switch (*e) {
      case 'l':
        camera.aperture = .1;
        camera.focus = 3;
        break;
      case 'a':
        for (Light& l : job.file.scene.lights) {
          l.edge1 = {1, 0, 0};
          l.edge2 = {0, 1, .5f};
        }
        break;
      case 'n':
        job.options.sampling.gloss_rays = 3;
        [[fallthrough]];
      case 'g':
        for (Material& m : job.file.scene.materials)
          m.roughness = .2f;
        break;
      case 'j':
        job.options.sampling.sampler = Sampler::kJitter;
        break;
      case 'r':
        job.options.sampling.sampler = Sampler::kRandom;
        break;
    }
  return job;
}

bool same_bits(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height &&
         std::memcmp(a.rgb.data(), b.rgb.data(), a.rgb.size() * sizeof(float)) == 0;
}

/// Random cuts of a rectangle into rectangles.
void split(Random& random, const Part& whole, int times, std::vector<Part>& parts) {
  const bool of_rows = random.chance(.5);
  const Range r = of_rows ? whole.rows : whole.samples;
  if (times == 0 || r.end - r.begin < 2)
    return parts.push_back(whole);
  const int at =
      r.begin + 1 + static_cast<int>(random.below(static_cast<std::uint32_t>(r.end - r.begin - 1)));
  Part a = whole, b = whole;
  (of_rows ? a.rows : a.samples).end = at, (of_rows ? b.rows : b.samples).begin = at;
  split(random, a, times - 1, parts);
  split(random, b, times - 1, parts);
}

class Parts : public testing::TestWithParam<Case> {};

TEST_P(Parts, RandomSplitsJoinToTheBitsOfTheWhole) {
  const Job job = make(GetParam());
  const World world(job.file.scene, {});
  RenderStats stats;
  const Image whole = render(world, job.file.camera, job.options, stats);
  const TemporaryFolder folder;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::vector<Part> parts;
    split(random, {{0, job.file.camera.height}, {0, job.options.sampling.samples}}, 3, parts);
    std::vector<std::string> files;
    for (const Part& part : parts) {
      RenderOptions options = job.options;
      options.packet = random.chance(.5) ? 64 : 16;
      Partial p{{"scene", "settings"}, make_accumulator(job.file.camera, options, part)};
      ASSERT_TRUE(accumulate(world, job.file.camera, options, p.sums, stats));
      files.push_back(folder.file(std::to_string(files.size()) + ".grelha"));
      write_partial(files.back(), p);
    }
    for (std::size_t i = files.size(); i > 1; --i)
      std::swap(files[i - 1], files[random.below(static_cast<std::uint32_t>(i))]);
    EXPECT_TRUE(same_bits(picture_so_far(merge_parts(files).sums), whole));
  }
}

TEST_P(Parts, StoppedAnywhereGoesOnToTheSameBits) {
  const Job job = make(GetParam());
  const World world(job.file.scene, {});
  RenderStats stats;
  const Image whole = render(world, job.file.camera, job.options, stats);
  Random random(7);
  RenderOptions options = job.options;
  int left = 0, calls = 0;
  options.progress = [&](double) { return ++calls, --left > 0; };
  Partial p{{"scene", "settings"}, make_accumulator(job.file.camera, options)};
  for (bool complete = false; !complete;) {
    left = 1 + static_cast<int>(random.below(3));
    options.threads = 1 + static_cast<int>(random.below(3));
    complete = accumulate(world, job.file.camera, options, p.sums, stats);
    const TemporaryFolder folder;
    write_partial(folder.file("x"), p, true);
    EXPECT_EQ(folder.list(), "x");
    p = read_partial(folder.file("x"));
  }
  EXPECT_EQ(static_cast<std::size_t>(calls), p.sums.done.size()) << "every piece once";
  EXPECT_TRUE(same_bits(picture_so_far(p.sums), whole));
}

INSTANTIATE_TEST_SUITE_P(Scenes,
                         Parts,
                         testing::Values(Case{"balls", 1, ""},
                                         Case{"balls", 150, ""},
                                         Case{"balls", 20, "lan"},
                                         Case{"gears", 16, "j"},
                                         Case{"rings", 9, "agr"},
                                         Case{"mount", 1, ""},
                                         Case{"rings", 70, "lj"}),
                         [](const auto& c) {
                           return std::string(c.param.scene) + std::to_string(c.param.samples) +
                                  c.param.effects;
                         });

TEST(PictureSoFar, IsTheMeanOfWhatIsThereAndBlackElsewhere) {
  const Job job = make({"balls", 150, ""});
  const World world(job.file.scene, {});
  Accumulator a = make_accumulator(job.file.camera, job.options);
  ASSERT_EQ(a.done.size(), 12u) << "four bands of rows, three of samples";
  RenderOptions options = job.options;
  int left = 6;
  options.threads = 1;
  options.progress = [&](double) { return --left > 0; };
  RenderStats stats;
  EXPECT_FALSE(accumulate(world, job.file.camera, options, a, stats));
  EXPECT_EQ(share_done(a), .5);
  const Image image = picture_so_far(a);
  for (int y = 0; y < 29; ++y) {
    const double sum =
        static_cast<double>(a.sums[static_cast<std::size_t>(y) * 111 + 40]) / 4294967296.0;
    EXPECT_EQ(image.row(y)[40], static_cast<float>(sum / (y < 16 ? 128 : 64))) << y;
  }
  left = 2;
  a = make_accumulator(job.file.camera, job.options);
  accumulate(world, job.file.camera, options, a, stats);
  const Image begun = picture_so_far(a);
  EXPECT_EQ(*std::max_element(begun.row(16), begun.row(28)), 0);
  EXPECT_GT(*std::max_element(begun.row(0), begun.row(16)), 0);
}

// --- files

/// A small part with sums that show where they belong.
Partial part_of(const Range& rows, const Range& samples) {
  Partial p{{"0123", "seed=0 depth=5"}, {3, 10, 8, {rows, samples}, {}, {}}};
  p.sums.sums.resize(static_cast<std::size_t>(rows.end - rows.begin) * 9,
                     samples.end - samples.begin);
  p.sums.done.assign(piece_count(p.sums.part), 1);
  return p;
}

class Merge : public testing::Test {
 protected:
  void put(const std::string& name, const Partial& p) { write_partial(folder_.file(name), p); }
  /// What merging the named files says, their folder left out.
  std::string complaint(const std::vector<std::string>& names) const {
    std::vector<std::string> files;
    for (const std::string& n : names)
      files.push_back(folder_.file(n));
    std::string text;
    try {
      merge_parts(files);
    } catch (const std::runtime_error& error) {
      text = error.what();
    }
    for (std::size_t at; (at = text.find(folder_.path().string() + '/')) != text.npos;)
      text.erase(at, folder_.path().string().size() + 1);
    return text;
  }
  TemporaryFolder folder_;
};

TEST_F(Merge, JoinsToALargerPart) {
  put("a", part_of({2, 5}, {0, 4})), put("b", part_of({2, 5}, {4, 8})),
      put("c", part_of({5, 9}, {0, 8}));
  const Partial all = merge_parts({folder_.file("c"), folder_.file("a"), folder_.file("b")});
  EXPECT_EQ(all.sums, part_of({2, 9}, {0, 8}).sums);
  EXPECT_EQ(complaint({"a"}), "");
}

TEST_F(Merge, NamesFilesThatOverlapAndWhere) {
  put("a", part_of({0, 5}, {0, 8})), put("b", part_of({5, 10}, {0, 5})),
      put("c", part_of({3, 10}, {4, 8}));
  EXPECT_EQ(complaint({"a", "b", "c"}), "c and a both have rows 3:5, samples 4:8");
  EXPECT_EQ(complaint({"b", "c"}), "c and b both have rows 5:10, samples 4:5");
  EXPECT_EQ(complaint({"a", "a"}), "a and a both have rows 0:5, samples 0:8");
}

TEST_F(Merge, NamesWhatIsMissing) {
  put("a", part_of({0, 3}, {0, 8})), put("b", part_of({3, 10}, {0, 5})),
      put("c", part_of({6, 10}, {5, 8})), put("d", part_of({9, 10}, {0, 8}));
  EXPECT_EQ(complaint({"a", "b", "c"}), "no part has rows 3:6, samples 5:8");
  put("e", part_of({0, 10}, {0, 2})), put("f", part_of({0, 10}, {5, 8}));
  EXPECT_EQ(complaint({"f", "e"}), "no part has rows 0:10, samples 2:5");
  EXPECT_EQ(complaint({"a", "d"}), "no part has rows 3:9, samples 0:8");
  EXPECT_EQ(complaint({"a", "b"}), "no part has rows 3:10, samples 5:8");
  EXPECT_EQ(complaint({"b", "c"}), "no part has rows 3:6, samples 5:8");
}

TEST_F(Merge, RefusesOtherPictures) {
  put("a", part_of({0, 5}, {0, 8}));
  Partial p = part_of({5, 10}, {0, 8});
  p.identity.scene = "4567";
  put("scene", p);
  p = part_of({5, 10}, {0, 8}), p.identity.settings = "seed=1 depth=5", put("seed", p);
  p = part_of({5, 10}, {0, 8}), p.identity.settings = "seed=0 depth=5 shadows=2", put("shadows", p);
  p = part_of({5, 10}, {0, 8}), p.sums.done[0] = 0, put("begun", p);
  p = part_of({5, 10}, {0, 8}), p.sums.width = 1, p.sums.sums.resize(15), put("narrow", p);
  EXPECT_EQ(complaint({"a", "scene"}), "scene is of another scene than a");
  EXPECT_EQ(complaint({"a", "seed"}), "seed has seed=1, a has seed=0");
  EXPECT_EQ(complaint({"a", "shadows"}), "shadows has shadows=2, a has no shadows=");
  EXPECT_EQ(complaint({"shadows", "a"}), "a has no shadows=, shadows has shadows=2");
  folder_.write("squeezed", "\x1F\x8B\x08");
  EXPECT_EQ(complaint({"a", "squeezed"}), "squeezed: error: damaged: its gzip data are broken");
  EXPECT_EQ(complaint({"a", "narrow"}), "narrow is of a picture of another size than a");
  EXPECT_EQ(complaint({"a", "begun"}),
            "begun is not finished, 0 % are done: the command that made it goes on");
  EXPECT_EQ(complaint({"a", "gone"}), "gone: error: cannot open: No such file or directory");
}

/// 103 GB, were all of the picture kept: of rows that no part has nothing is.
TEST_F(Merge, TakesTheMemoryOfWhatIsThere) {
  Partial p = part_of({0, 5}, {0, 8});
  const int rows[][2] = {{40000, 40001}, {40001, 40003}};
  for (const auto& [begin, end] : rows) {
    p.sums.width = p.sums.height = 65536;
    p.sums.part.rows = {begin, end};
    p.sums.sums.assign(std::size_t(end - begin) * 65536 * 3, begin);
    p.sums.done.assign(piece_count(p.sums.part), 1);
    put(std::to_string(begin), p);
  }
  EXPECT_EQ(merge_parts({folder_.file("40001"), folder_.file("40000")}).sums.part,
            (Part{{40000, 40003}, {0, 8}}));
}

TEST_F(Merge, RefusesAFileWithAnyByteFlippedOrLost) {
  const Partial p = part_of({0, 5}, {0, 8});
  put("a", p);
  const std::string good = folder_.read("a");
  EXPECT_EQ(parse_partial("a", good).sums, p.sums);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ (1 << i % 8));
    EXPECT_THROW(parse_partial("a", bad), FileError) << "byte " << i;
    EXPECT_THROW(parse_partial("a", std::string_view(good).substr(0, i)), FileError)
        << "cut at " << i;
  }
  EXPECT_THROW(parse_partial("a", good + '\0'), FileError);
  folder_.write("b", good.substr(0, good.size() - 1) + '!');
  EXPECT_EQ(complaint({"b"}), "b: error: damaged: its checksum is wrong");
  folder_.write("c", "P6\n1 1\n255\n...");
  EXPECT_EQ(complaint({"c"}), "c: error: not a .grelha partial this program reads");
}

/// A head that lies, under a checksum that does not.
TEST_F(Merge, RefusesSizesThatCannotBe) {
  const std::pair<const char*, Accumulator> wrong[] = {
      {"sums too few", {3, 10, 8, {{0, 5}, {0, 8}}, std::vector<std::int64_t>(44), {1}}},
      {"huge", {65536, 65536, 65536, {{0, 65536}, {0, 65536}}, {}, {}}},
      {"no rows", {3, 10, 8, {{5, 5}, {0, 8}}, {}, {}}},
      {"rows outside", {3, 10, 8, {{6, 11}, {0, 8}}, std::vector<std::int64_t>(45), {1}}},
      {"negative", {3, 10, 8, {{-1, 4}, {0, 8}}, std::vector<std::int64_t>(45), {1}}},
      {"no width", {0, 10, 8, {{0, 5}, {0, 8}}, {}, {1}}},
      {"piece half done", {3, 10, 8, {{0, 5}, {0, 8}}, std::vector<std::int64_t>(45), {2}}}};
  for (const auto& [name, sums] : wrong) {
    put("x", {{"s", "t"}, sums});
    EXPECT_EQ(complaint({"x"}), "x: error: not a .grelha partial this program reads") << name;
  }
}

/// Written bytes must be the same everywhere and for ever: a digest that changes makes parts of one
/// picture strangers.
TEST(Partial, BytesAreAsTheyEverWere) {
  const TemporaryFolder folder;
  write_partial(folder.file("a"), part_of({2, 3}, {0, 4}));
  using namespace std::string_literals;
  std::string wanted =
      "grelha partial 1\nscene 0123\nsettings seed=0 depth=5\npicture 3 10 8\n"
      "rows 2 3\nsamples 0 4\n\1"s;
  for (int i = 0; i < 9; ++i)
    wanted += "\4\0\0\0\0\0\0\0"s;
  const std::string found = folder.read("a");
  EXPECT_EQ(found.substr(0, wanted.size()), wanted);
  ASSERT_EQ(found.size(), wanted.size() + 8);
  std::uint64_t checksum = 0;
  for (int i = 7; i >= 0; --i)
    checksum = checksum << 8 |
               static_cast<unsigned char>(found[wanted.size() + static_cast<std::size_t>(i)]);
  EXPECT_EQ(checksum, 4836196064112502952u) << "the lower half of XXH128";
}

// --- checkpoints of pictures that have no parts

/// What refinement or subdivision makes until it is done, or until step `last`; counts the steps.
struct Steps {
  std::optional<Picture> picture;
  int count = 0;
  bool done = false;
};

Steps steps_until(int last, const Job& job, const RenderOptions& options) {
  const World world(job.file.scene, {});
  Steps s;
  RenderOptions o = options;
  o.threads = 1;
  o.progress = [&](double) { return ++s.count < last; };
  RenderStats stats;
  s.picture.emplace(job.file.camera, o);
  s.done = s.picture->advance(world, job.file.camera, o, stats);
  return s;
}

/// Stopped in the middle, with something in every array; early, for what follows looks at each
/// byte.
Picture half_done(const Job& job, const RenderOptions& options, std::uint64_t seed) {
  constexpr int first = 3;
  constexpr int last = 33;
  const int all = steps_until(last, job, options).count;
  EXPECT_GT(all, first);
  const int choices = all - first;
  const int stop = first + static_cast<int>(Random(seed).below(static_cast<unsigned>(choices)));
  Steps half = steps_until(stop, job, options);
  EXPECT_FALSE(half.done) << "step " << stop << " of " << all;
  return std::move(*half.picture);
}

/// In a file, as bytes.
std::string kept(const Picture& picture) {
  const TemporaryFolder folder;
  write_checkpoint(folder.file("x"), {"scene", "settings"}, picture, true);
  EXPECT_EQ(folder.list(), "x");
  return folder.read("x");
}

/// With a checksum that fits.
std::string signed_anew(std::string bytes) {
  Digest digest;
  digest.bytes(bytes.data(), bytes.size() - 8);
  for (std::size_t i = 0; i < 8; ++i)
    bytes[bytes.size() - 8 + i] = static_cast<char>(digest.low64() >> 8 * i);
  return bytes;
}

class Checkpoints : public testing::TestWithParam<bool> {
 protected:
  Checkpoints() : job_(make({"balls", 1, "l"})) {
    if (GetParam())
      job_.options.refine.error = 1e-3;
    else
      job_.options.subdivision = {true, .05f, 8};  // tiles of 16 pixels: six
  }
  Job job_;
};

TEST_P(Checkpoints, GoOnFromAFileToTheSameBits) {
  const World world(job_.file.scene, {});
  RenderStats stats;
  RenderOptions o = job_.options;
  o.refine.error *= 4;
  o.subdivision.depth /= 2;
  const Image whole = render(world, job_.file.camera, o, stats);
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    Picture half = half_done(job_, o, seed);
    Picture picture = parse_checkpoint("x", kept(half)).picture;
    RenderStats of_half;
    ASSERT_TRUE(half.advance(world, job_.file.camera, o, of_half));
    ASSERT_TRUE(picture.advance(world, job_.file.camera, o, stats));
    EXPECT_EQ(stats.rays.total(), of_half.rays.total()) << "or what was seen is seen again";
    EXPECT_TRUE(same_bits(picture.image(), whole));
    EXPECT_EQ(kept(parse_checkpoint("x", kept(picture)).picture), kept(picture))
        << "of what is finished as well";
  }
}

TEST_P(Checkpoints, AreRefusedWithAnyByteFlippedOrLost) {
  const std::string good = kept(half_done(job_, job_.options, 1));
  EXPECT_EQ(kept(parse_checkpoint("x", good).picture), good);
  for (std::size_t i = 0; i < good.size(); i += 1 + i / 16) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ (1 << i % 8));
    EXPECT_THROW(parse_checkpoint("x", bad), FileError) << "byte " << i;
    EXPECT_THROW(parse_checkpoint("x", std::string_view(good).substr(0, i)), FileError)
        << "cut at " << i;
  }
  EXPECT_THROW(parse_partial("x", good), FileError) << "it is no part";
}

/// What lies under a checksum that fits is refused, or can be gone on with: nothing breaks, and
/// work comes to an end.
TEST_P(Checkpoints, OfHostileBytesBreakNothing) {
  const World world(job_.file.scene, {});
  const std::string good = kept(half_done(job_, job_.options, 1));
  Random random(9);
  int refused = 0, taken = 0;
  for (int turn = 0; turn < 120; ++turn) {
    std::string bad = good;
    if (random.chance(.2))
      bad.resize(bad.size() - 1 - random.below(60));
    // half of them near the head
    const std::size_t most = random.chance(.5) ? 400 : bad.size() - 8;
    for (int k = 0; k < 3; ++k)
      bad[random.below(static_cast<std::uint32_t>(most))] =
          static_cast<char>(random.chance(.5) ? 255 : random.below(256));
    try {
      Picture picture = parse_checkpoint("x", signed_anew(bad)).picture;
      RenderOptions o = job_.options;
      int left = 20;
      o.progress = [&](double) { return --left > 0; };
      RenderStats stats;
      picture.advance(world, job_.file.camera, o, stats);
      ++taken;
    } catch (const FileError&) {
      ++refused;
    } catch (const std::invalid_argument&) {  // sound, but of another size
      ++refused;
    }
  }
  EXPECT_GT(refused, 10);
  EXPECT_GT(taken, 10);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Checkpoints, testing::Bool(), [](const auto& kind) {
  return kind.param ? "ByError" : "BySubdivision";
});

TEST(Checkpoint, OfImpossibleNumbersIsRefused) {
  Job job = make({"balls", 1, "l"});
  job.options.refine.error = 1e-3;
  const World world(job.file.scene, {});
  Refinement good = make_refinement(job.file.camera);
  int left = 20;
  job.options.progress = [&](double) { return --left > 0; };
  RenderStats stats;
  ASSERT_FALSE(refine(world, job.file.camera, job.options, good, stats));
  const auto refused = [&](auto change) {
    Refinement bad = good;
    change(bad);
    try {
      parse_checkpoint("x", kept(bad));
    } catch (const FileError& error) {
      return std::string(error.what()) == "x: error: not a .grelha partial this program reads";
    }
    return false;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(refused([](Refinement&) {}));
  EXPECT_TRUE(refused([&](Refinement& r) { r.cost[5] = nan; })) << "pixels are sorted by it";
  EXPECT_TRUE(refused([](Refinement& r) { r.cost[5] = 0; }));
  EXPECT_TRUE(refused([&](Refinement& r) { r.squares[1][7] = nan; }));
  EXPECT_TRUE(refused([&](Refinement& r) { r.gain_threshold = nan; }))
      << "it would never be low enough";
  EXPECT_TRUE(
      refused([](Refinement& r) { r.gain_threshold = std::numeric_limits<float>::infinity(); }));
  EXPECT_TRUE(refused([](Refinement& r) { r.variance_ratio = 1; }));
  EXPECT_TRUE(refused([](Refinement& r) { r.log[3] = 17; }));
  EXPECT_TRUE(refused([](Refinement& r) { r.log[3] = 1; }));
  EXPECT_TRUE(refused([](Refinement& r) { r.log[r.wanted[0]] = 16; })) << "it can take no more";
  EXPECT_TRUE(refused([](Refinement& r) { r.wanted[1] = r.wanted[0]; }))
      << "two threads would work on it";
  EXPECT_TRUE(refused([](Refinement& r) { r.wanted[1] = 37 * 29; }));
  EXPECT_TRUE(refused([](Refinement& r) { r.wanted.clear(); })) << "neither finished nor begun";
  EXPECT_TRUE(refused([](Refinement& r) { r.finished = true; }));
  EXPECT_TRUE(refused([](Refinement& r) { r.sums[8] = std::numeric_limits<std::int64_t>::max(); }));
  EXPECT_TRUE(refused([](Refinement& r) { r.seconds = -1; }));
  EXPECT_TRUE(refused([](Refinement& r) {
    r.inside.pop_back();
    r.inside.push_back(-1);
  }));
}

TEST(Checkpoint, OfBrokenGzipDataIsDamaged) {
  const TemporaryFolder folder;
  folder.write("x", "\x1F\x8B\x08");
  try {
    read_checkpoint(folder.file("x"));
    FAIL();
  } catch (const FileError& error) {
    EXPECT_TRUE(std::string(error.what()).ends_with("x: error: damaged: its gzip data are broken"))
        << error.what();
  }
}

}  // namespace
}  // namespace grelha::test
