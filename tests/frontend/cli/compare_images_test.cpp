// What `grelha compare` says and writes. A part of program_test.
#include "frontend/images/image_file.hpp"
#include "tests/frontend/cli/program.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

namespace grelha {
namespace {

using test::kBall;
using test::Outcome;
using test::Program;

/// The number behind a name on what compare prints.
double said(const Outcome& outcome, const std::string& name) {
  const std::size_t at = outcome.out.find(name);
  return at == std::string::npos ? -1 : std::atof(outcome.out.c_str() + at + name.size());
}

TEST_F(Program, ComparesAndSetsItsStatus) {
  ASSERT_EQ(run("render ball.nff -o a.pfm --quiet").status, 0);
  ASSERT_EQ(run("render ball.nff -o b.png --quiet").status, 0);
  ASSERT_EQ(run("render ball.nff -o c.png --quiet --size 8x8").status, 0);
  EXPECT_EQ(run("compare a.pfm a.pfm --max-rmse 0").out,
            "RMSE 0, PSNR inf dB, largest difference 0 at (0, 0), 0 of 384 pixels differ\n"
            "relative MSE 0, SSIM 1, FLIP 0\n");
  EXPECT_EQ(run("compare a.pfm a.pfm --max-rmse 0").status, 0);
  EXPECT_EQ(run("compare a.pfm b.png --max-rmse 0.01").status, 0) << "half a byte at most";
  EXPECT_EQ(run("compare a.pfm b.png --max-rmse 0 --diff d.png").status, 1);
  EXPECT_EQ(folder_.read("d.png").substr(1, 3), "PNG");
  const Outcome sizes = run("compare a.pfm c.png");
  EXPECT_EQ(sizes.status, 2);
  EXPECT_EQ(sizes.err, "grelha: error: the pictures have unequal sizes, 24x16 and 8x8\n");
  EXPECT_EQ(run("compare a.pfm no.png").status, 1);
}

TEST_F(Program, WritesWhatOneSeesOfTwoPictures) {
  ASSERT_EQ(run("render ball.nff -o a.pfm --quiet").status, 0);
  ASSERT_EQ(run("render ball.nff -o b.pfm --quiet --samples 4").status, 0);
  const Outcome outcome = run("compare a.pfm b.pfm --error-map m.pfm --diff d.pfm");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const Image map = read_image(folder_.file("m.pfm"));
  double sum = 0;
  for (std::size_t i = 0; i < map.rgb.size(); i += 3)
    sum += map.rgb[i];
  EXPECT_NEAR(said(outcome, "FLIP "), sum / (24 * 16), 1e-6);
  EXPECT_GT(said(outcome, "FLIP "), 0);
  EXPECT_LT(said(outcome, "SSIM "), 1);
  ASSERT_EQ(run("compare a.pfm a.pfm --error-map m.PNG").status, 0);
  EXPECT_EQ(read_image(folder_.file("m.PNG")).rgb[2], 4 / 255.f) << "where magma begins";
}

/// Light goes through the curve, colours as authored do not. A PNG of gamma 1 holds light.
TEST_F(Program, SeesLightThroughTheCurve) {
  using namespace std::string_literals;
  std::string other = kBall;
  other.replace(other.find("b 0 0 1"), 7, "b 0 0 .2");
  folder_.write("other.nff", other);
  for (const char* picture : {"a.png --srgb", "a.hdr"})
    ASSERT_EQ(run(std::string("render ball.nff --quiet -o ") + picture).status, 0);
  for (const char* picture : {"b.png --srgb", "b.hdr"})
    ASSERT_EQ(run(std::string("render other.nff --quiet -o ") + picture).status, 0);
  const auto make_linear = [&](const std::string& scene, const std::string& picture) {
    ASSERT_EQ(run("render " + scene + " --quiet -o " + picture).status, 0);
    folder_.write(picture,
                  folder_.read(picture).insert(
                      33, "\0\0\0\4gAMA\0\1\x86\xa0\x31\xe8\x96\x5f"s));  // behind IHDR
  };
  make_linear("ball.nff", "c.png");
  make_linear("other.nff", "d.png");
  for (const char* number : {"SSIM ", "FLIP "}) {
    const double light = said(run("compare a.png b.png"), number);
    EXPECT_NEAR(said(run("compare a.png b.hdr"), number), light, .005) << number;
    EXPECT_NEAR(said(run("compare a.hdr b.png"), number), light, .005) << number;
    EXPECT_NEAR(said(run("compare c.png d.png"), number), light, .005) << number;
    EXPECT_GT(std::abs(said(run("compare a.hdr b.hdr"), number) - light), .02) << number;
  }
}

TEST_F(Program, ComparesWhatAScreenShows) {
  using namespace std::string_literals;
  folder_.write("two.pfm", "PF\n1 1\n-1\n\0\0\0\x40\0\0\0\x40\0\0\0\x40"s);
  folder_.write("four.pfm", "PF\n1 1\n-1\n\0\0\x80\x40\0\0\x80\x40\0\0\x80\x40"s);
  EXPECT_EQ(run("compare two.pfm four.pfm --max-rmse 1").status, 1);
  EXPECT_EQ(run("compare two.pfm four.pfm --max-rmse 0 --display").status, 0);
  EXPECT_NE(run("compare two.pfm four.pfm").out.find(", SSIM -, FLIP 0\n"), std::string::npos);
}

}  // namespace
}  // namespace grelha
