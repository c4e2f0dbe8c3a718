#include "frontend/images/hdr_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "frontend/files/parse_error.hpp"

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>

namespace grelha {
namespace {

constexpr int kMostExrSide = 65536;
/// deflate packs a thousandfold at most, so a file may claim no more
constexpr std::uint64_t kMostPixelsAByte = 1024;
constexpr int kExrZipLevel = 4;  ///< as for PNG
constexpr std::size_t kOne = sizeof(float), kThree = 3 * sizeof(float);

class MemoryOut : public Imf::OStream {
 public:
  MemoryOut() : OStream("picture.exr") {}
  void write(const char bytes[], int count) override {
    const std::size_t end = at_ + std::size_t(count);
    data.resize(std::max(data.size(), end));
    std::memcpy(data.data() + at_, bytes, std::size_t(count));
    at_ = end;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = at; }

  std::string data;

 private:
  std::size_t at_ = 0;
};

class MemoryIn : public Imf::IStream {
 public:
  MemoryIn(const std::string& path, const std::string& data) : IStream(path.c_str()), data_(data) {}
  bool read(char bytes[], int count) override {
    if (at_ > data_.size() || std::size_t(count) > data_.size() - at_)
      throw Iex::InputExc("it ends early");
    std::memcpy(bytes, data_.data() + at_, std::size_t(count));
    at_ += std::size_t(count);
    return at_ < data_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t at) override { at_ = at; }

 private:
  const std::string& data_;
  std::size_t at_ = 0;
};

/// The channels to write, and where they lie.
class Channels {
 public:
  Channels(Imf::Header& header, int width) : header_(header), width_(std::size_t(width)) {}

  template <class T>
  void add(const char* name, const T* values, std::size_t stride) {
    const Imf::PixelType type = std::is_same_v<T, float> ? Imf::FLOAT : Imf::UINT;
    char* const base = reinterpret_cast<char*>(const_cast<T*>(values));
    header_.channels().insert(name, Imf::Channel(type));
    buffer.insert(name, Imf::Slice(type, base, stride, stride * width_));
  }

  Imf::FrameBuffer buffer;

 private:
  Imf::Header& header_;
  std::size_t width_;
};

void add_layers(const Layers& layers, Channels& channels) {
  if (!layers.depth.empty())
    channels.add("Z", layers.depth.data(), kOne);
  if (!layers.id.empty())
    channels.add("id", layers.id.data(), kOne);
  if (layers.normal.empty())
    return;
  channels.add("normal.X", layers.normal.data(), kThree);
  channels.add("normal.Y", layers.normal.data() + 1, kThree);
  channels.add("normal.Z", layers.normal.data() + 2, kThree);
}

std::string attribute_name(std::string key) {
  for (char& c : key)
    c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return key;
}

bool has(const Imf::ChannelList& channels, const char* name) {
  const Imf::Channel* const found = channels.findChannel(name);
  return found && found->xSampling == 1 && found->ySampling == 1;
}

bool is_deep(const Imf::Header& header) {
  return header.hasType() && Imf::isDeepData(header.type());
}

std::int64_t side(int from, int to) {
  const std::int64_t size = std::int64_t(to) - from + 1;
  if (size < 1 || size > kMostExrSide)
    throw Iex::InputExc("width and height must be 1 to 65536");
  return size;
}

/// A black picture of the size of a window.
Image image_of(const Imath::Box2i& window, std::size_t bytes) {
  const std::int64_t width = side(window.min.x, window.max.x),
                     height = side(window.min.y, window.max.y);
  if (std::uint64_t(width * height) > bytes * kMostPixelsAByte)
    throw Iex::InputExc("it claims more pixels than its bytes can hold");
  return Image(int(width), int(height));
}

/// Reads the data window of a part.
Image read_part(Imf::MultiPartInputFile& file, int number, std::size_t bytes) {
  const Imath::Box2i window = file.header(number).dataWindow();
  Image data = image_of(window, bytes);
  const bool is_grey = has(file.header(number).channels(), "Y");
  const auto row = std::size_t(data.width) * kThree;
  const std::ptrdiff_t first =
      window.min.x * std::ptrdiff_t(kThree) + window.min.y * std::ptrdiff_t(row);
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < (is_grey ? 1 : 3); ++c) {
    char* const base = reinterpret_cast<char*>(data.rgb.data() + c) - first;
    const std::string name(1, is_grey ? 'Y' : "RGB"[c]);
    buffer.insert(name, Imf::Slice(Imf::FLOAT, base, kThree, row));
  }
  const auto pixels = std::size_t(data.width) * std::size_t(data.height);
  Alpha alpha(has(file.header(number).channels(), "A") ? pixels : 0);
  if (!alpha.empty())
    buffer.insert("A",
                  Imf::Slice(Imf::FLOAT,
                             reinterpret_cast<char*>(alpha.data()) - first / 3,
                             kOne,
                             kOne * std::size_t(data.width)));
  Imf::InputPart part(file, number);
  part.setFrameBuffer(buffer);
  part.readPixels(window.min.y, window.max.y);
  if (std::ranges::any_of(alpha, [](float a) { return a != 1; }))
    throw Iex::InputExc(kTransparent);
  for (std::size_t i = 0; is_grey && i < data.rgb.size(); ++i)
    data.rgb[i] = data.rgb[i - i % 3];
  return data;
}

/// Copies what the display window shows of the data.
void show(const Image& data, int left, int top, Image& image) {
  for (int y = std::max(0, -top); y < data.height && top + y < image.height; ++y)
    for (int x = std::max(0, -left); x < data.width && left + x < image.width; ++x)
      std::copy_n(data.row(y) + 3 * x, 3, image.row(top + y) + 3 * (left + x));
}

int colored_part(const Imf::MultiPartInputFile& file) {
  for (int i = 0; i < file.parts(); ++i) {
    const Imf::ChannelList& channels = file.header(i).channels();
    const bool is_colored = has(channels, "R") && has(channels, "G") && has(channels, "B");
    if (!is_deep(file.header(i)) && (has(channels, "Y") || is_colored))
      return i;
  }
  throw Iex::InputExc("no flat part of it has the channels R, G and B");
}

}  // namespace

std::string encode_exr(const Image& image,
                       const Layers& layers,
                       const Notes& notes,
                       const Alpha& alpha) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = kExrZipLevel;
  for (const auto& [key, text] : notes)
    header.insert(attribute_name(key), Imf::StringAttribute(text));
  Channels channels(header, image.width);
  channels.add("R", image.rgb.data(), kThree);
  channels.add("G", image.rgb.data() + 1, kThree);
  channels.add("B", image.rgb.data() + 2, kThree);
  if (!alpha.empty())
    channels.add("A", alpha.data(), kOne);
  add_layers(layers, channels);
  MemoryOut out;
  {
    Imf::OutputFile file(out, header, 0);
    file.setFrameBuffer(channels.buffer);
    file.writePixels(image.height);
  }  // the table of blocks is written last
  return std::move(out.data);
}

Image read_exr(const std::string& path, const std::string& bytes) try {
  if (!bytes.starts_with("\x76\x2f\x31\x01"))
    throw FileError(path, "not a picture in the OpenEXR format");
  MemoryIn in(path, bytes);
  Imf::MultiPartInputFile file(in, 0, false);
  const int part = colored_part(file);
  const Imath::Box2i display = file.header(part).displayWindow();
  const Imath::Box2i window = file.header(part).dataWindow();
  Image image = image_of(display, bytes.size());
  const Image data = read_part(file, part, bytes.size());
  show(data, window.min.x - display.min.x, window.min.y - display.min.y, image);
  return image;
} catch (const Iex::BaseExc& error) {
  // the library may quote names from the file, with any bytes
  std::string message = error.what();
  std::ranges::replace_if(
      message, [](char c) { return c < ' ' || c > '~'; }, '?');
  throw FileError(path, "cannot read the picture: " + message);
}

namespace {

using Rgbe = std::array<std::uint8_t, 4>;

constexpr int kMantissa = 8, kExponentBias = 128;
constexpr float kMinValue = 1e-38f, kMaxValue = 1e38f;  ///< range of the shared exponent
constexpr int kLeastPacked = 8, kMostPacked = 32767;    ///< widths of rows that may be packed
constexpr int kLongestRun = 127, kLongestDump = 128, kWorthARun = 4;

float light(float value) {
  return value > 0 ? std::min(value, kMaxValue) : 0;
}  // a NaN is none

/// To the nearest mantissa: cut off, a picture would lose a quarter of a percent of its light.
Rgbe shared_exponent(const float* rgb) {
  const float r = light(rgb[0]), g = light(rgb[1]), b = light(rgb[2]);
  const float most = std::max({r, g, b});
  if (most < kMinValue)
    return {};
  int exponent = 0;
  std::frexp(most, &exponent);
  const auto mantissa = [&](float value) {
    return std::lround(std::ldexp(value, kMantissa - exponent));
  };
  if (mantissa(most) == 1 << kMantissa)
    ++exponent;
  const auto byte = [&](float value) { return std::uint8_t(mantissa(value)); };
  return {byte(r), byte(g), byte(b), std::uint8_t(exponent + kExponentBias)};
}

/// One component of a row: runs of equal bytes, and dumps of others between them.
void pack(const std::vector<std::uint8_t>& row, std::string& bytes) {
  const std::size_t size = row.size();
  const auto run_at = [&](std::size_t i) {
    std::size_t n = 1;
    while (i + n < size && n < kLongestRun && row[i + n] == row[i])
      ++n;
    return n;
  };
  std::size_t at = 0;
  while (at < size) {
    const std::size_t run = run_at(at);
    if (run >= kWorthARun) {
      bytes += char(kLongestDump + run);
      bytes += char(row[at]);
      at += run;
      continue;
    }
    std::size_t end = at;
    while (end < size && end - at < kLongestDump && run_at(end) < kWorthARun)
      ++end;
    bytes += char(end - at);
    bytes.append(row.begin() + std::ptrdiff_t(at), row.begin() + std::ptrdiff_t(end));
    at = end;
  }
}

bool is_packed(int width) {
  return width >= kLeastPacked && width <= kMostPacked;
}

void append_row(const float* rgb, int width, std::string& bytes) {
  const bool packed = is_packed(width);
  std::array<std::vector<std::uint8_t>, 4> components;
  for (int x = 0; x < width; ++x) {
    const Rgbe pixel = shared_exponent(rgb + 3 * x);
    if (!packed)
      bytes.append(pixel.begin(), pixel.end());
    for (std::size_t i = 0; packed && i < pixel.size(); ++i)
      components[i].push_back(pixel[i]);
  }
  if (!packed)
    return;
  bytes += {2, 2, char(width >> 8), char(width & 0xff)};
  for (const auto& component : components)
    pack(component, bytes);
}

}  // namespace

std::string encode_hdr(const Image& image, const Notes& notes) {
  std::string bytes = "#?RADIANCE\n";
  for (const auto& [key, text] : notes)
    bytes += "# " + key + ": " + text + '\n';
  bytes += "FORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(image.height) + " +X " +
           std::to_string(image.width) + '\n';
  for (int y = 0; y < image.height; ++y)
    append_row(image.row(y), image.width, bytes);
  return bytes;
}

}  // namespace grelha
