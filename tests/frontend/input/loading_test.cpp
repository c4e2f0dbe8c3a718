// How far reading is, for every kind of file: the share never falls, says something on the way,
// comes to 1, and stops when told.
#include "frontend/input/read_scene.hpp"
#include "grelha/render.hpp"
#include "scenes/generators.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <sstream>

namespace grelha {
namespace {

class Loading : public testing::TestWithParam<const char*> {
 protected:
  Loading() {
    std::ostringstream mesh, scene, balls;
    scenes::find_generator("terrain")->write_mesh(mesh, 25);
    scenes::find_generator("terrain")->write(scene, {25, false, "binary.ply"});
    scenes::find_generator("balls")->write(balls, {5, false, {}});
    folder_.write("binary.ply", mesh.str());
    folder_.write("names.nff", scene.str());
    folder_.write("text.nff", balls.str());
    folder_.write("ascii.ply", ascii());
    folder_.write("inline.nff", inline_mesh());
    const gzFile packed = gzopen(folder_.file("packed.nff.gz").c_str(), "wb1");
    gzwrite(packed, balls.str().data(), unsigned(balls.str().size()));
    gzclose(packed);
  }
  static constexpr int kRows = 150000;
  static std::string vertices(int count) {
    std::ostringstream out;
    for (int i = 0; i < count; ++i)
      out << i << ' ' << i % 7 << ' ' << i % 5 << '\n';
    return out.str();
  }
  static std::string ascii() {
    std::string rows;
    for (int i = 0; i < kRows; ++i)
      rows += "3 0 1 " + std::to_string(2 + i % 10) + '\n';
    return "ply\nformat ascii 1.0\nelement vertex 12\nproperty float x\nproperty float y\nproperty "
           "float z\nelement face " +
           std::to_string(kRows) + "\nproperty list uchar int vertex_indices\nend_header\n" +
           vertices(12) + rows;
  }
  static std::string inline_mesh() {
    return "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 24 16\nf 1 0 0 1 0 1 "
           "0 1\nmesh " +
           std::to_string(kRows) + " 1\n" + vertices(kRows) + "1 2 3\n";
  }
  SceneFile read(const std::function<bool(double)>& progress) {
    ReadOptions options;
    options.progress = progress;
    return read_scene(
        folder_.file(GetParam()), [](const std::string&) {}, options);
  }
  TemporaryFolder folder_;
};

TEST_P(Loading, TellsHowFarItIs) {
  double last = 0, widest = 0;
  bool ascends = true;
  read([&](double share) {
    ascends &= share >= last && share <= 1;
    widest = std::max(widest, share - last);
    last = share;
    return true;
  });
  EXPECT_TRUE(ascends);
  EXPECT_EQ(last, 1);
  EXPECT_LT(widest, .75) << "a million bytes are a part of every file here";
}

TEST_P(Loading, StopsWhenTold) {
  int all = 0;
  read([&](double) { return ++all > 0; });
  for (int stop = 1; stop <= all; ++stop) {
    int calls = 0;
    EXPECT_THROW(read([&](double) { return ++calls < stop; }), Stopped) << stop << " of " << all;
    EXPECT_EQ(calls, stop);
  }
}

INSTANTIATE_TEST_SUITE_P(Files,
                         Loading,
                         testing::Values("binary.ply",
                                         "ascii.ply",
                                         "names.nff",
                                         "text.nff",
                                         "inline.nff",
                                         "packed.nff.gz"));

}  // namespace
}  // namespace grelha
