#include "frontend/images/image_file.hpp"

#include "frontend/images/hdr_file.hpp"
#include "frontend/images/tone.hpp"
#include "tests/support/file_error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace grelha {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Image odd_image() {
  Image image(3, 2);
  const float values[] = {0,
                          1,
                          0.5f,
                          -1,
                          2,
                          0.25f,
                          1e-30f,
                          1e30f,
                          0.1f,
                          -0.0f,
                          kNan,
                          kInfinity,
                          3,
                          4,
                          5,
                          1.0f / 3,
                          7,
                          8};
  std::copy(std::begin(values), std::end(values), image.rgb.begin());
  return image;
}

using test::error_of;

TEST(ToByte, RoundsToNearestAndClamps) {
  for (int k = 0; k < 256; ++k)
    EXPECT_EQ(to_byte(float(k) / 255, Tone::authored), k);
  EXPECT_EQ(to_byte(0.4999f / 255, Tone::authored), 0);
  EXPECT_EQ(to_byte(0.5001f / 255, Tone::authored), 1);
  EXPECT_EQ(to_byte(254.4999f / 255, Tone::authored), 254);
  for (const Tone tone : {Tone::authored, Tone::srgb}) {
    EXPECT_EQ(to_byte(-1, tone), 0);
    EXPECT_EQ(to_byte(7, tone), 255);
    EXPECT_EQ(to_byte(kInfinity, tone), 255);
    EXPECT_EQ(to_byte(-kInfinity, tone), 0);
    EXPECT_EQ(to_byte(kNan, tone), 0);
  }
}

/// IEC 61966-2-1, evaluated in long double.
TEST(ToByte, FollowsTheSrgbCurve) {
  for (int i = 0; i <= 4000; ++i) {
    const float light = float(i) / 4000;
    const long double encoded = light <= 0.0031308L
                                    ? 12.92L * light
                                    : 1.055L * std::pow((long double)light, 1 / 2.4L) - 0.055L;
    const long double exact = 255 * encoded;
    EXPECT_LE(std::abs(exact - to_byte(light, Tone::srgb)), 0.5L + 1e-4L) << light;
  }
  EXPECT_EQ(to_byte(0.5f, Tone::srgb), 188);
}

TEST(Png, HoldsTheBytesOfKnownColours) {
  TemporaryFolder folder;
  Image image(2, 2);
  const float values[] = {1, 0, 0, 0, 0.5f, 0, 0, 0, 2, 0.25f, kNan, -1};
  std::copy(std::begin(values), std::end(values), image.rgb.begin());
  write_image(folder.file("a.png"), image);
  EXPECT_EQ(folder.read("a.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
  const Image back = read_image(folder.file("a.png"));
  ASSERT_EQ(back.width, 2);
  ASSERT_EQ(back.height, 2);
  const int expected[] = {255, 0, 0, 0, 128, 0, 0, 0, 255, 64, 0, 0};
  for (std::size_t i = 0; i < back.rgb.size(); ++i)
    EXPECT_EQ(back.rgb[i], float(expected[i]) / 255) << i;
}

TEST(Png, SrgbBendsTheBytes) {
  TemporaryFolder folder;
  Image image(1, 1);
  image.rgb = {0.5f, 0, 1};
  write_image(folder.file("a.png"), image, {.tone = Tone::srgb});
  EXPECT_EQ(read_image(folder.file("a.png")).rgb, (std::vector{188 / 255.0f, 0.0f, 1.0f}));
}

TEST(Pfm, ComesBackBitForBit) {
  TemporaryFolder folder;
  const Image image = odd_image();
  write_image(folder.file("a.pfm"), image);
  const Image back = read_image(folder.file("a.pfm"));
  ASSERT_EQ(back.width, image.width);
  ASSERT_EQ(back.height, image.height);
  EXPECT_EQ(std::memcmp(back.rgb.data(), image.rgb.data(), image.rgb.size() * sizeof(float)), 0);
}

TEST(Pfm, IsLittleEndianFromTheBottom) {
  Image image(1, 2);
  image.rgb = {1, 1, 1, 2, 2, 2};
  const std::string two("\x00\x00\x00\x40", 4), one("\x00\x00\x80\x3f", 4);
  EXPECT_EQ(encode_pfm(image), "PF\n1 2\n-1.0\n" + two + two + two + one + one + one);
}

TEST(Pfm, BigEndianAndGreyAreRead) {
  TemporaryFolder folder;
  const auto path =
      folder.write("a.pfm", "Pf\n2 1\n1\n" + std::string("\x3f\x80\x00\x00\x40\x00\x00\x00", 8));
  EXPECT_EQ(read_image(path).rgb, (std::vector<float>{1, 1, 1, 2, 2, 2}));
}

TEST(Pfm, WrongFilesSayWhatIsWrong) {
  TemporaryFolder folder;
  const std::pair<std::string, const char*> wrong[] = {
      {"", "expected PF or Pf at the start"},
      {"PX\n1 1\n-1\n", "expected PF or Pf at the start"},
      {"PF\n1", "the header ends early"},
      {"PF\n0 1\n-1\n", "width and height must be 1 to 65536"},
      {"PF\n1 x\n-1\n", "width and height must be 1 to 65536"},
      {"PF\n99999 1\n-1\n", "width and height must be 1 to 65536"},
      {"PF\n1 1\n0\n", "the scale is no number but 0"},
      {"PF\n1 1\n-1\nabc", "too few floats"},
      {"PF\n65536 65536\n-1\nabc", "too few floats"}};
  for (const auto& [bytes, message] : wrong) {
    const auto path = folder.write("a.pfm", bytes);
    const std::string wanted = bytes.empty() ? "the header ends early" : message;
    EXPECT_EQ(error_of([&] { read_image(path); }), path + ": error: not a PFM picture: " + wanted);
  }
}

/// Half a step of the mantissa is .5/128 of the pixel's largest channel at most; 1/255.5 where that
/// rounds up to the next exponent. Errors of both signs cancel: the mean of 120,000 uniform ones
/// within 1/255 is within 5 sigma of nought.
TEST(Hdr, RoundsToNearest) {
  TemporaryFolder folder;
  Image image(400, 100);
  std::uint32_t state = 1;
  for (float& v : image.rgb) {
    state = state * 1664525u + 1013904223u;
    v = float(state >> 8) * 0x1p-24f * 4;
  }
  write_image(folder.file("a.hdr"), image);
  const Image back = read_image(folder.file("a.hdr"));
  ASSERT_EQ(back.rgb.size(), image.rgb.size());
  double bias = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    const float most = std::max({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
    for (std::size_t k = i; k < i + 3; ++k) {
      ASSERT_NEAR(back.rgb[k], image.rgb[k], most / 255) << k;
      bias += (double(back.rgb[k]) - image.rgb[k]) / most;
    }
  }
  EXPECT_LT(std::abs(bias / double(image.rgb.size())), 5 / 255. / std::sqrt(3. * 120000));
}

/// Runs, dumps, rows too short or too long to be packed; mantissas that round up to the next
/// exponent.
TEST(Hdr, ComesBackFromRowsOfEveryKind) {
  TemporaryFolder folder;
  for (const int width : {1, 7, 8, 9, 127, 128, 129, 260, 1000, 32767, 32768}) {
    Image image(width, 2);
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        image.row(0)[3 * x + c] = x % 140 < 135 ? 0.5f : float(1 + (x * 7 + c) % 13) / 16;
        image.row(1)[3 * x + c] = 0x1.fffffep-1f * float(1 << (x % 5));
      }
    write_image(folder.file("a.hdr"), image);
    const Image back = read_image(folder.file("a.hdr"));
    ASSERT_EQ(back.width, width);
    for (int x = 0; x < 3 * width; ++x) {
      ASSERT_EQ(back.row(0)[x], image.row(0)[x]) << width << ' ' << x;
      ASSERT_EQ(back.row(1)[x], float(1 << (x / 3 % 5))) << width << ' ' << x;
    }
  }
}

/// A chunk is a length, a type, data and a checksum; zlib's is the oracle.
TEST(Png, SaysWhatItIsInChunksBeforeThePixels) {
  TemporaryFolder folder;
  const Image image(4, 3);
  const Notes notes{{"Software", "grelha"}, {"Title", "balls"}};
  const std::string plain = encode_png(image, Tone::authored),
                    told = encode_png(image, Tone::srgb, notes);
  const std::string chunks("\0\0\0\1sRGB\0\xae\xce\x1c\xe9\0\0\0\xftEXtSoftware\0grelha", 36);
  EXPECT_EQ(told.substr(33, chunks.size()), chunks);
  EXPECT_EQ(told.substr(0, 33), plain.substr(0, 33));
  EXPECT_TRUE(told.ends_with(plain.substr(33)));
  EXPECT_EQ(plain.find("sRGB"), plain.npos);
  EXPECT_EQ(read_image(folder.write("a.png", told)).rgb, image.rgb);
  Encoding encoding;
  read_image(folder.file("a.png"), &encoding);
  EXPECT_EQ(encoding_text(encoding), "sRGB values");
  const std::string gamma("\0\0\0\4gAMA\0\0\xb1\x8f\x0b\xfc\x61\x05", 16);
  read_image(folder.write("b.png", plain.substr(0, 33) + gamma + plain.substr(33)), &encoding);
  EXPECT_EQ(encoding_text(encoding), "values of gamma 0.45455");
  read_image(folder.write("c.png", plain), &encoding);
  EXPECT_EQ(encoding_text(encoding), "light");
}

TEST(Hdr, SaysWhatItIsInComments) {
  TemporaryFolder folder;
  const std::string bytes = encode_hdr(Image(4, 3), {{"Software", "grelha"}, {"Title", "balls"}});
  EXPECT_TRUE(bytes.starts_with(
      "#?RADIANCE\n# Software: grelha\n# Title: balls\nFORMAT=32-bit_rle_rgbe\n\n-Y 3 +X 4\n"))
      << bytes;
  EXPECT_EQ(read_image(folder.write("a.hdr", bytes)).width, 4);
}

TEST(AsLight, UndoesTheCurve) {
  Image image(1, 1);
  image.rgb = {188 / 255.f, 0, 1};
  // half a step of 1/255 where the curve has slope 1.3
  EXPECT_NEAR(as_light(image, {Encoding::Kind::srgb}).rgb[0], .5f, .003f);
  EXPECT_NEAR(
      as_light(image, {Encoding::Kind::power, .5}).rgb[0], image.rgb[0] * image.rgb[0], 1e-6f);
  EXPECT_EQ(as_light(image, {}).rgb, image.rgb);
}

TEST(Hdr, SurvivesWhatIsNoLight) {
  TemporaryFolder folder;
  write_image(folder.file("a.hdr"), odd_image());
  const std::vector<float> back = read_image(folder.file("a.hdr")).rgb;
  for (const float value : back)
    EXPECT_TRUE(value >= 0 && value < kInfinity);
  EXPECT_EQ(back[3], 0) << "from -1";
  EXPECT_EQ(back[10], 0) << "from NaN";
  EXPECT_GT(back[11], 9e37f) << "from infinity";
}

TEST(ReadImage, RefusesWhatItIsNot) {
  TemporaryFolder folder;
  for (const char* name : {"a.png", "a.hdr", "a.pfm", "a.exr"}) {
    EXPECT_EQ(error_of([&] { read_image(folder.file(name)); }),
              folder.file(name) + ": error: cannot open: No such file or directory");
    const auto path = folder.write(name, "GIF89a, not what the name says");
    EXPECT_NE(error_of([&] { read_image(path); }).find(": error: not a "), std::string::npos);
  }
  Image image(8, 8);
  write_image(folder.file("b.png"), image);
  const auto cut = folder.write("cut.png", folder.read("b.png").substr(0, 50));
  EXPECT_NE(error_of([&] { read_image(cut); }).find(": error: cannot read the picture: "),
            std::string::npos);
  std::filesystem::create_directory(folder.file("d.png"));
  EXPECT_EQ(error_of([&] { read_image(folder.file("d.png")); }),
            folder.file("d.png") + ": error: cannot read: Is a directory");
  const auto other = folder.write("x.jpg", "");
  EXPECT_EQ(error_of([&] { read_image(other); }),
            other + ": error: not a picture this program reads (.png, .hdr, .pfm, .exr)");
  EXPECT_EQ(error_of([&] { read_image("/nothere"); }),
            "/nothere: error: cannot open: No such file or directory");
}

TEST(ImageFormat, GoesByTheEnding) {
  EXPECT_EQ(image_format("a.png"), ImageFormat::png);
  EXPECT_EQ(image_format("a.b.HDR"), ImageFormat::hdr);
  EXPECT_EQ(image_format(".pfm"), ImageFormat::pfm);
  for (const char* name : {"", "png", "a.jpg", "a.png.gz", "a.pn"})
    EXPECT_FALSE(image_format(name)) << name;
}

TEST(ImageFits, KnowsTheWritersLimits) {
  EXPECT_TRUE(image_fits(ImageFormat::png, 65536, 10000));
  EXPECT_FALSE(image_fits(ImageFormat::png, 65536, 65536));
  EXPECT_FALSE(image_fits(ImageFormat::hdr, 65536, 65536));
  EXPECT_TRUE(image_fits(ImageFormat::pfm, 65536, 65536));
  EXPECT_FALSE(image_fits(ImageFormat::pfm, 65537, 1));
  EXPECT_FALSE(image_fits(ImageFormat::png, 0, 1));
}

}  // namespace
}  // namespace grelha
