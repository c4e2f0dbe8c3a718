// OpenEXR. A part of image_file_test.
#include "frontend/exr_file.hpp"

#include "frontend/image_file.hpp"
#include "frontend/parse_error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>

namespace grelha {
namespace {

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Exr, ComesBackBitForBit) {
  TemporaryFolder folder;
  Image image(70, 37);  // blocks of 16 rows, the last of 5
  for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = float(i * i % 1000) / 7 - 20;
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

TEST(Exr, WrongFilesAreRefusedAndTakeNoMemory) {
  TemporaryFolder folder;
  const std::string whole = encode_exr(Image(70, 37));
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    const auto path = folder.write("cut.exr", whole.substr(0, size));
    EXPECT_TRUE(error_of([&] { read_image(path); }).starts_with(path + ": error: ")) << size;
  }
  std::string claims = whole;
  for (const char* window : {"dataWindow", "displayWindow"}) {
    const std::size_t at = claims.find(window) + std::strlen(window) + sizeof "box2i" + 1 + 4 +
                           8;  // behind type, size and minimum
    claims.replace(at, 8, std::string("\xff\xff\0\0\xff\xff\0\0", 8));
  }
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
