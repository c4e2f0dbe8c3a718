// OpenEXR.
#include "frontend/images/hdr_file.hpp"

#include "frontend/images/image_file.hpp"
#include "grelha/rays.hpp"
#include "tests/support/file_error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>

namespace grelha {
namespace {

using test::error_of;

TEST(Exr, ComesBackBitForBit) {
  TemporaryFolder folder;
  Image image(70, 37);  // blocks of 16 rows, the last of 5
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    image.rgb[i] = float(i * i % 1000) / 7 - 20;
  image.rgb[4] = std::numeric_limits<float>::quiet_NaN();
  image.rgb[5] = std::numeric_limits<float>::infinity();
  image.rgb[6] = -0.f;
  write_image(folder.file("a.exr"), image, {.notes = {{"Software", "grelha"}}});
  const Image back = read_image(folder.file("a.exr"));
  ASSERT_EQ(back.width, image.width);
  ASSERT_EQ(back.height, image.height);
  EXPECT_EQ(std::memcmp(back.rgb.data(), image.rgb.data(), image.rgb.size() * sizeof(float)), 0);
  EXPECT_NE(folder.read("a.exr").find(std::string("software\0string\0\6\0\0\0grelha", 26)),
            std::string::npos);
  EXPECT_EQ(folder.read("a.exr"), encode_exr(image, {}, {{"Software", "grelha"}}))
      << "the same bytes each time";
}

/// A block that would not shrink is stored as it is: row by row, the channels by name, each value
/// little endian.
TEST(Exr, HoldsLayersAsChannelsByName) {
  Image image(2, 1);
  image.rgb = {1.37f, 2.91f, 3.53f, 4.19f, 5.71f, 6.83f};
  const Layers layers{{7.13f, 8.39f},
                      {.313f, .517f, .719f, -.911f, -.127f, -.229f},
                      {0x89abcdef, kNoPrimitive - 0x13579b}};
  const std::string bytes = encode_exr(image, layers);
  std::string wanted;
  const auto append = [&wanted](auto value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int shift = 0; shift < 32; shift += 8)
      wanted += char(bits >> shift & 0xff);
  };
  for (const std::size_t colour : {2, 1, 0}) {  // B, G, R
    append(image.rgb[colour]);
    append(image.rgb[3 + colour]);
  }
  for (const float depth : layers.depth)
    append(depth);
  for (const std::uint32_t id : layers.id)
    append(id);
  for (const std::size_t axis : {0, 1, 2}) {
    append(layers.normal[axis]);
    append(layers.normal[3 + axis]);
  }
  EXPECT_TRUE(bytes.ends_with(wanted));
  const std::string names[] = {"B", "G", "R", "Z", "id", "normal.X", "normal.Y", "normal.Z"};
  std::size_t at = 0;
  for (const std::string& name : names) {
    const char type = name == "id" ? 0 : 2;  // whole numbers, floats
    at = bytes.find(name + '\0' + type + std::string(3, '\0'), at);
    ASSERT_NE(at, bytes.npos) << name;
  }
}

/// small.exr, written again by OpenImageIO.
TEST(Exr, FilesOfAnotherProgramHoldTheSamePicture) {
  const std::string folder = GRELHA_SOURCE_DIR "/tests/fuzz/corpus/picture/";
  const Image small = read_image(folder + "small.exr");
  for (const char* name : {"none", "rle", "zips", "piz", "tiled"})
    EXPECT_EQ(read_image(folder + name + ".exr").rgb, small.rgb) << name;
  const Image lossy = read_image(folder + "dwa.exr");
  ASSERT_EQ(lossy.rgb.size(), small.rgb.size());
  for (std::size_t i = 0; i < lossy.rgb.size(); ++i)
    EXPECT_NEAR(lossy.rgb[i], small.rgb[i], 1e-3) << i;
  const Image grey = read_image(folder + "grey-half.exr");
  ASSERT_EQ(grey.rgb.size(), small.rgb.size());
  for (std::size_t i = 0; i < grey.rgb.size(); ++i) {
    const float red = small.rgb[i - i % 3];
    EXPECT_NEAR(grey.rgb[i], red, red * 0x1p-11f) << "half a step of eleven bits";
  }
}

/// windows.exr shows 9 x 9 pixels from (-1, -1): small.exr and black around it.
TEST(Exr, WhatLiesOutsideTheDataIsBlack) {
  const std::string folder = GRELHA_SOURCE_DIR "/tests/fuzz/corpus/picture/";
  const Image small = read_image(folder + "small.exr"),
              displayed = read_image(folder + "windows.exr");
  ASSERT_EQ(displayed.width, 9);
  ASSERT_EQ(displayed.height, 9);
  for (int y = 0; y < displayed.height; ++y)
    for (int x = 0; x < displayed.width; ++x) {
      const bool inside = x >= 1 && x <= small.width && y >= 1 && y <= small.height;
      for (int c = 0; c < 3; ++c)
        EXPECT_EQ(displayed.row(y)[3 * x + c], inside ? small.row(y - 1)[3 * (x - 1) + c] : 0);
    }
}

TEST(Exr, WrongFilesAreRefusedAndTakeNoMemory) {
  TemporaryFolder folder;
  const std::string whole = encode_exr(Image(70, 37));
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    const auto path = folder.write("cut.exr", whole.substr(0, size));
    EXPECT_TRUE(error_of([&] { read_image(path); }).starts_with(path + ": error: ")) << size;
  }
  std::string claims = whole;
  const char* const window = "displayWindow";
  const std::size_t at = claims.find(window) + std::strlen(window) + sizeof "box2i" + 1 + 4 +
                         8;  // behind type, size and minimum
  claims.replace(at, 8, std::string("\xff\xff\0\0\xff\xff\0\0", 8));
  const auto path = folder.write("claims.exr", claims);
  EXPECT_EQ(
      error_of([&] { read_image(path); }),
      path + ": error: cannot read the picture: it claims more pixels than its bytes can hold");
}

/// Every byte of the head changed, and many of the rest: read or refused, never a crash.
TEST(Exr, DamagedFilesAreReadOrRefused) {
  TemporaryFolder folder;
  const std::string whole = encode_exr(Image(20, 20), {}, {{"Software", "grelha"}});
  for (std::size_t i = 4; i < whole.size(); ++i)
    for (const int bit : {1, 16, 128}) {
      std::string bytes = whole;
      bytes[i] = char(bytes[i] ^ bit);
      const auto path = folder.write("a.exr", bytes);
      error_of([&] { read_image(path); });
    }
}

}  // namespace
}  // namespace grelha
