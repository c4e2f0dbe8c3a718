// Meshes with colours, and views of them from several sides, by the built program.
#include "tests/frontend/cli/program.hpp"

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

}  // namespace
}  // namespace grelha::test
