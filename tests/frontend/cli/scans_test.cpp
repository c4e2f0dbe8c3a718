// Meshes with colours, and views of them from several sides, by the built program.
#include "tests/frontend/cli/program.hpp"
#include "tests/support/reading.hpp"

namespace grelha::test {
namespace {

class Scans : public Program {
 protected:
  Scans() {
    folder_.write("scan.ply",
                  "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                  "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar "
                  "blue\n"
                  "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
                  "0 0 0 255 0 0\n1 0 0 0 200 0\n0 1 0 0 0 255\n0 0 1 255 255 255\n"
                  "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  }
  void expect_fine(const std::string& arguments) {
    const Outcome made = run(arguments);
    EXPECT_EQ(made.status, 0) << arguments << '\n' << made.err;
  }
};

/// Colours are light, so a PNG says that its bytes are sRGB; also where parts of it are joined.
TEST_F(Scans, ColorsGoThroughTheCurveInPartsAsWell) {
  const std::string render = "render scan.ply --size 20x20 --samples ";
  expect_fine(render + "4 -o whole.png");
  expect_fine(render + "0:1/4 -o a.grelha");
  expect_fine(render + "1:4/4 -o b.grelha");
  expect_fine("merge a.grelha b.grelha -o joined.png");
  EXPECT_EQ(folder_.read("joined.png"), folder_.read("whole.png"));
  EXPECT_NE(folder_.read("whole.png").find("sRGB"), std::string::npos);
  expect_fine(render + "4 -o grey.png --no-colors");
  EXPECT_EQ(folder_.read("grey.png").find("sRGB"), std::string::npos);
  EXPECT_NE(run("info scan.ply").out.find("colors        of vertices\n"), std::string::npos);
  EXPECT_EQ(run("info scan.ply --no-colors").out.find("colors"), std::string::npos);
}

/// Every view is the picture that its own command makes, notes and all.
TEST_F(Scans, ViewsOfATurntableAreThoseOfTheirCommands) {
  const std::string effects = " --size 20x14 --samples 4 --shadows random:.5 --lens 2";
  for (const std::string lights : {"", " --lights mesh"}) {
    expect_fine("render scan.ply --turntable 12 --orbit 7,10,1.2 -o out/v{}.png" + effects +
                lights);
    for (int k = 0; k < 12; ++k) {
      expect_fine("render scan.ply --orbit " + std::to_string(7 + 30 * k) + ",10,1.2 -o one.png" +
                  effects + lights);
      const std::string number = (k < 10 ? "0" : "") + std::to_string(k);
      EXPECT_EQ(folder_.read("out/v" + number + ".png"), folder_.read("one.png")) << number;
    }
  }
  EXPECT_NE(folder_.read("out/v00.png"), folder_.read("out/v06.png"));
}

/// A sheet has the views row by row, and the background where there is none.
TEST_F(Scans, ASheetHasAllViews) {
  expect_fine("render scan.ply --turntable 5 --size 8x6 -o sheet.pfm");
  expect_fine("render scan.ply --turntable 5 --size 8x6 -o v{}.pfm");
  const auto pixels = [&](const std::string& name, std::size_t count) {
    const std::string bytes = folder_.read(name);
    return bytes.substr(bytes.size() - 12 * count);
  };
  const std::string sheet = pixels("sheet.pfm", 24 * 12);
  for (int k = 0; k < 5; ++k) {
    const std::string view = pixels("v" + std::to_string(k) + ".pfm", 8 * 6);
    for (int y = 0; y < 6; ++y) {  // from below
      const std::size_t row = std::size_t(y + (k < 3 ? 6 : 0)), left = std::size_t(8 * (k % 3));
      EXPECT_EQ(sheet.substr(12 * (24 * row + left), 12 * 8),
                view.substr(12 * 8 * std::size_t(y), 12 * 8))
          << "view " << k << ", row " << y;
    }
  }
  EXPECT_EQ(sheet.substr(12 * 16, 12), sheet.substr(12 * 23, 12)) << "no sixth view";
  for (const auto& [views, size] : {std::pair<int, const char*>{1, "8 6"},
                                    {3, "24 6"},
                                    {7, "32 12"},
                                    {8, "32 12"},
                                    {12, "32 18"},
                                    {24, "48 24"},
                                    {36, "48 36"}}) {
    expect_fine("render scan.ply --samples 1 --size 8x6 -o n.pfm --turntable " +
                std::to_string(views));
    EXPECT_TRUE(folder_.read("n.pfm").starts_with("PF\n" + std::string(size) + '\n')) << views;
  }
}

/// Alone, on a turntable and on its sheet; a picture says how it was made.
TEST_F(Scans, TransparentPicturesAreThoseOfTheirViews) {
  const std::string render = "render scan.ply --size 12x9 --transparent ";
  expect_fine(render + "--turntable 2 -o v{}.png");
  for (const int k : {0, 1}) {
    expect_fine(render + "-o one.png --orbit " + std::to_string(180 * k) + ",0");
    EXPECT_EQ(folder_.read("one.png"), folder_.read("v" + std::to_string(k) + ".png"));
  }
  EXPECT_NE(folder_.read("one.png").find(" transparent colors=light"), std::string::npos);
  expect_fine(render + "--turntable 1 -o sheet.png");
  EXPECT_EQ(folder_.read("sheet.png"), folder_.read("v0.png"));
  expect_fine(render + "-o a.exr --layers id --stats stats.json -j 1");
  EXPECT_EQ(run("compare a.exr one.png").status, 1);
  const Outcome away = run(render + "--eye 9,9,9 --at 10,10,10 --strict -o away.png");
  EXPECT_EQ(away.status, 2);
  EXPECT_NE(away.err.find("shows the background alone"), std::string::npos) << away.err;
  folder_.write("black.nff",
                "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\n"
                "resolution 8 8\nb 1 1 1\nl 5 5 5\nf 0 0 0 0 0 0 0 0\ns 0 0 0 1\n");
  expect_fine("render black.nff --transparent --strict -o black.png");
}

/// Without any option; a line says their radius, which is no warning.
TEST_F(Scans, PointsAreSeen) {
  folder_.write("cloud.ply",
                "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                "property float z\nend_header\n0 0 0\n0 0 0\n2 0 0\n0 2 0\n");
  folder_.write("scene.nff", kView + "l 0 0 9 1 1 1\n" + kFill + "ply cloud.ply\n");
  for (const std::string scene : {"cloud.ply", "scene.nff"}) {
    const Outcome made = run("render " + scene + " --size 20x20 --strict -o seen.png");
    EXPECT_EQ(made.status, 0) << made.err;
    EXPECT_NE(made.out.find(scene + ": points without faces are drawn as balls of radius 1.3, "
                                    "--points RADIUS sets another\n"),
              std::string::npos)
        << made.out;
    EXPECT_NE(made.out.find("3 spheres"), std::string::npos) << "one of those in a row";
  }
  EXPECT_EQ(run("render cloud.ply -q --size 8x8 -o seen.png").out, "");
  EXPECT_EQ(run("render cloud.ply --points 1 --size 8x8 -o seen.png").out.find("radius"),
            std::string::npos);
  const std::string info = run("info cloud.ply").out;
  EXPECT_NE(info.find("in the file   4 points\n"), std::string::npos) << info;
  EXPECT_NE(info.find("points        balls of radius 1.3\n"), std::string::npos) << info;
}

TEST_F(Scans, TurntablesThatCannotBe) {
  const auto error = [&](const std::string& arguments) {
    const Outcome made = run("render scan.ply " + arguments);
    EXPECT_EQ(made.status, 2) << made.err;
    return made.err;
  };
  EXPECT_EQ(error("--turntable 0"),
            "grelha: error: --turntable: expected a whole number from 1 to 3600, found \"0\"\n");
  EXPECT_EQ(error("--turntable 3 ball.nff"), "grelha: error: --turntable: expected one scene\n");
  EXPECT_EQ(
      error("--turntable 3 -o a.grelha"),
      "grelha: error: --turntable makes whole pictures: no --rows, I:J, --checkpoint, --preview "
      "or .grelha\n");
  EXPECT_EQ(error("--turntable 3 --stats -"),
            "grelha: error: --turntable: no --layers, --stats, --time SECONDS, --samples-map or "
            "--error-map\n");
  EXPECT_EQ(error("--turntable 9 -o a.pfm --size 65536x1"),
            "grelha: error: --turntable: expected a sheet of at most 65536 pixels a side, found "
            "196608x3; {} in -o makes a file of each view\n");
}

}  // namespace
}  // namespace grelha::test
