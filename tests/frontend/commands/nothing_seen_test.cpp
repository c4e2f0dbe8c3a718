// Tests the warnings of scenes and pictures that show nothing, and that no others get them.
#include "frontend/commands/nothing_seen.hpp"

#include <gtest/gtest.h>

#include "tests/support/reading.hpp"

namespace grelha {
namespace {

using test::read_text;
using Lines = std::vector<std::string>;

const std::string kEye = "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 8 6\n";
const std::string kLit = kEye + "l 0 0 9 1 1 1\nf 1 1 1 1 0 1 0 1\n";

Lines said(const SceneFile& file) {
  Lines lines;
  warn_empty_scene("x.nff", file, [&](const std::string& line) { lines.push_back(line); });
  return lines;
}

Lines said(const std::string& text) {
  return said(read_text(text).file);
}

TEST(NothingSeen, NoPrimitives) {
  EXPECT_EQ(said(kLit),
            Lines{"x.nff: warning: nothing to draw: add an object, such as \"s 0 0 0 1\""});
  EXPECT_EQ(said(kLit + "s 0 0 0 1"), Lines{});
}

TEST(NothingSeen, NoLight) {
  const Lines dark{"x.nff: warning: no light: surfaces will show no color of their own"};
  EXPECT_EQ(said(kEye + "s 0 0 0 1"), dark);
  EXPECT_EQ(said(kEye + "l 0 0 9 0 0 0\ns 0 0 0 1"), dark) << "a black light is none";
  const std::string emission = "f 1 1 1 1 1 1 1 0 1 0 1 .5 0 0\n", dull = "f 1 1 1 1 0 1 0 1\n";
  EXPECT_EQ(said(kEye + emission + "s 0 0 0 1"), Lines{});
  EXPECT_EQ(said(kEye + emission + dull + "s 0 0 0 1"), dark) << "what shines is on nothing";
}

TEST(NothingSeen, BackgroundAlone) {
  const SceneFile file = read_text("b .1 .2 .3\n" + kLit + "s 0 0 9 1").file;
  for (const bool seen : {false, true}) {
    Image image(8, 6);
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
      image.rgb[i] = .1f + .1f * float(i % 3);
    image.rgb[20] += seen ? .01f : 0;
    Lines lines;
    warn_empty_image(
        "x.nff", file.scene.geometry, file.scene.background, image, [&](const std::string& line) {
          lines.push_back(line);
        });
    EXPECT_EQ(lines.size(), seen ? 0u : 1u);
  }
}

}  // namespace
}  // namespace grelha
