// Checkpoints of pictures that have no parts, by error or by subdivision.
#include <limits>
#include <optional>

#include "frontend/files/digest.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/jobs/checkpoint.hpp"
#include "kernel/picture/refinement.hpp"
#include "kernel/picture/picture.hpp"
#include "tests/frontend/jobs/job.hpp"
#include "tests/support/random.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace grelha::test {
namespace {

/// The picture of a refinement or subdivision after step `last` or at its end, and the number of
/// steps.
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
std::string saved(const Picture& picture) {
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
  Checkpoints() : job_(make_job({"balls", 1, "l"})) {
    if (GetParam())
      job_.options.refine.error = 1e-3;
    else
      job_.options.subdivision = {true, .05f, 8};  // tiles of 8 pixels
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
    Picture picture = parse_checkpoint("x", saved(half)).picture;
    RenderStats of_half;
    ASSERT_TRUE(half.advance(world, job_.file.camera, o, of_half));
    ASSERT_TRUE(picture.advance(world, job_.file.camera, o, stats));
    EXPECT_EQ(stats.rays.total(), of_half.rays.total()) << "or what was seen is seen again";
    EXPECT_TRUE(same_bits(picture.image(), whole));
    EXPECT_EQ(saved(parse_checkpoint("x", saved(picture)).picture), saved(picture))
        << "of what is finished as well";
  }
}

TEST_P(Checkpoints, AreRefusedWithAnyByteFlippedOrLost) {
  const std::string good = saved(half_done(job_, job_.options, 1));
  EXPECT_EQ(saved(parse_checkpoint("x", good).picture), good);
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
  const std::string good = saved(half_done(job_, job_.options, 1));
  Random random(9);
  int refused = 0, taken = 0;
  for (int turn = 0; turn < 120; ++turn) {
    std::string bad = good;
    if (random.chance(.2))
      bad.resize(bad.size() - 1 - random.below(60));
    // with probability 1/2 the changes are near the head of the file
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
  Job job = make_job({"balls", 1, "l"});
  job.options.refine.error = 1e-3;
  const World world(job.file.scene, {});
  Refinement good = make_refinement(job.file.camera);
  int left = 12;
  job.options.progress = [&](double) { return --left > 0; };
  RenderStats stats;
  ASSERT_FALSE(refine(world, job.file.camera, job.options, good, stats));
  ASSERT_GE(good.wanted.size(), 2u) << "stop it in a round of several blocks";
  const auto refused = [&](auto change) {
    Refinement bad = good;
    change(bad);
    try {
      parse_checkpoint("x", saved(bad));
    } catch (const FileError& error) {
      return std::string(error.what()) == "x: error: not a .grelha partial this program reads";
    }
    return false;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(refused([](Refinement&) {}));
  EXPECT_TRUE(refused([&](Refinement& r) { r.cost[5] = nan; })) << "blocks are sorted by it";
  EXPECT_TRUE(refused([](Refinement& r) { r.cost[5] = 0; }));
  EXPECT_TRUE(refused([&](Refinement& r) { r.squares[1][7] = nan; }));
  EXPECT_TRUE(refused([](Refinement& r) { r.goal[r.wanted[0]] = r.log[r.wanted[0]]; }))
      << "nothing to do";
  EXPECT_TRUE(refused([](Refinement& r) { r.goal[r.wanted[0]] = 17; }));
  EXPECT_TRUE(refused([](Refinement& r) { r.goal[r.wanted[0]] = 16; })) << "too many at once";
  EXPECT_TRUE(refused([](Refinement& r) { r.checking = {{10 * 8, 0, 1}}; }));
  EXPECT_TRUE(refused([&](Refinement& r) { r.checking = {{0, nan, 1}}; }));
  EXPECT_TRUE(refused([](Refinement& r) { r.limit = static_cast<Limit>(4); }));
  EXPECT_TRUE(refused([&](Refinement& r) { r.before = {good}; })) << "in the midst of a round";
  EXPECT_TRUE(refused([](Refinement& r) { r.variance_ratio = 1; }));
  EXPECT_TRUE(refused([](Refinement& r) { r.log[3] = 17; }));
  EXPECT_TRUE(refused([](Refinement& r) { r.log[3] = 2; }));
  EXPECT_TRUE(refused([](Refinement& r) { r.log[r.wanted[0]] = 16; })) << "it can take no more";
  EXPECT_TRUE(refused([](Refinement& r) { r.wanted[1] = r.wanted[0]; }))
      << "two threads would work on it";
  EXPECT_TRUE(refused([](Refinement& r) { r.wanted[1] = 10 * 8; }));
  EXPECT_FALSE(refused([](Refinement& r) { r.wanted.clear(); })) << "between two rounds";
  EXPECT_TRUE(refused([](Refinement& r) {
    r.wanted.clear();
    r.log[3] = 0;
  })) << "no round would sample it";
  EXPECT_TRUE(refused([](Refinement& r) { r.finished = true; }));
  EXPECT_TRUE(refused([](Refinement& r) { r.sums[8] = std::numeric_limits<std::int64_t>::max(); }));
  EXPECT_TRUE(refused([](Refinement& r) { r.seconds = -1; }));
  EXPECT_TRUE(refused([](Refinement& r) { r.missed.pop_back(); }));
  EXPECT_TRUE(refused([](Refinement& r) { r.missed[4] = -1; }));
  EXPECT_TRUE(refused([&](Refinement& r) { r.missed[4] = nan; }));
  EXPECT_TRUE(refused([](Refinement& r) { r.box[4] = 0x40304041; })) << "its left is right of it";
  EXPECT_TRUE(refused([](Refinement& r) { r.box[4] = 0x2F403010; })) << "its top is below it";
  EXPECT_FALSE(refused([](Refinement& r) { r.box[4] = 0x40303010; }));
  EXPECT_TRUE(refused([](Refinement& r) { r.box.pop_back(); }));
  EXPECT_TRUE(refused([](Refinement& r) { r.checked.y = -1; }));
  EXPECT_TRUE(refused([&](Refinement& r) { r.checked.count = std::nan(""); }));
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
