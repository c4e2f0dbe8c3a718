// Pictures rendered in parts, interrupted, kept in files and joined: the bits of the whole.
#include <algorithm>
#include <chrono>
#include <thread>

#include "frontend/jobs/merge.hpp"
#include "grelha/accumulator.hpp"
#include "tests/frontend/jobs/job.hpp"
#include "tests/support/random.hpp"
#include "tests/support/partials.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace grelha::test {
namespace {

/// Random cuts of a rectangle into rectangles.
void split(Random& random, const Part& whole, int times, std::vector<Part>& parts) {
  const bool of_rows = random.chance(.5);
  const Range r = of_rows ? whole.rows : whole.samples;
  if (times == 0 || r.end - r.begin < 2)
    return parts.push_back(whole);
  const int at =
      r.begin + 1 + static_cast<int>(random.below(static_cast<std::uint32_t>(r.end - r.begin - 1)));
  Part a = whole, b = whole;
  (of_rows ? a.rows : a.samples).end = at;
  (of_rows ? b.rows : b.samples).begin = at;
  split(random, a, times - 1, parts);
  split(random, b, times - 1, parts);
}

class Parts : public testing::TestWithParam<Case> {};

TEST_P(Parts, RandomSplitsJoinToTheBitsOfTheWhole) {
  const Job job = make_job(GetParam());
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

/// A thread that saves the work holds up no other: a render that is told to go on ends complete.
TEST(LongParts, InterruptedByEveryPieceEndsComplete) {
  Job job = make_job({"balls", 1, ""});
  job.file.camera.width = 8;
  job.file.camera.height = 4096;
  const World world(job.file.scene, {});
  job.options.threads = 4;
  job.options.progress = [](double) { return false; };
  const auto go_on = [] {
    std::this_thread::sleep_for(std::chrono::microseconds(100));
    return true;
  };
  RenderStats stats;
  for (int i = 0; i < 20; ++i) {
    Accumulator a = make_accumulator(job.file.camera, job.options);
    ASSERT_TRUE(accumulate(world, job.file.camera, job.options, a, stats, {}, go_on)) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes,
                         Parts,
                         testing::Values(Case{"balls", 1, ""},
                                         Case{"balls", 150, ""},
                                         Case{"balls", 20, "lan"},
                                         Case{"gears", 16, "j"},
                                         Case{"balls", 12, "lab"},
                                         Case{"rings", 9, "agr"},
                                         Case{"mount", 1, ""},
                                         Case{"rings", 70, "lj"}),
                         [](const auto& c) {
                           return std::string(c.param.scene) + std::to_string(c.param.samples) +
                                  c.param.effects;
                         });

TEST(PictureSoFar, IsTheMeanOfWhatIsThereAndBlackElsewhere) {
  const Job job = make_job({"balls", 150, ""});
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

}  // namespace
}  // namespace grelha::test
