// Pictures in files, of arrays.
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "frontend/files/atomic_file.hpp"
#include "frontend/images/hdr_file.hpp"
#include "frontend/images/image_file.hpp"
#include "frontend/ply/ply_faces.hpp"
#include "src/file_scene.hpp"
#include "src/hear.hpp"

namespace grelha::python {

std::string path_in(py::handle given) {
  const py::module_ os = py::module_::import("os");
  return os.attr("fsencode")(given).cast<std::string>();
}

namespace {

struct Picture {
  Image image;
  ImageFormat format;
  Tone tone;
  Alpha alpha;
  std::vector<std::uint8_t> bytes{};  ///< of a PNG, in place of the image's pixels and alpha
};

std::string encoded(const Picture& p) {
  switch (p.format) {
    case ImageFormat::png:
      return p.bytes.empty() ? encode_png(p.image, p.tone, {}, p.alpha)
                             : encode_png(p.bytes, p.image.width, p.image.height, p.tone);
    case ImageFormat::hdr:
      return encode_hdr(p.image);
    case ImageFormat::pfm:
      return encode_pfm(p.image);
    case ImageFormat::exr:
      return encode_exr(p.image, {}, {}, p.alpha);
  }
  return {};
}

/// Encodes a picture, which may take seconds, beside a thread that hears signals; then writes it.
void write_encoded(const std::string& name, Picture picture) {
  check_writable(name);
  const auto work = std::make_shared<std::pair<Picture, std::string>>(std::move(picture), "");
  hear_signals_beside([work] { work->second = encoded(work->first); });
  const Unlocked unlocked;
  write_file(name, work->second);
}

/// Channels of an array (h, w), (h, w, 3) or (h, w, 4). Throws ValueError for other shapes.
std::size_t channels_of(const Shape& shape) {
  const auto channels = std::size_t(shape.size() == 3 ? shape[2] : 1);
  if (shape.size() != 2 && !(shape.size() == 3 && (channels == 3 || channels == 4)))
    wrong_value("image", "shape (h, w), (h, w, 3) or (h, w, 4)", text_of(shape));
  for (const std::size_t side : {0, 1})
    if (shape[side] < 1 || shape[side] > kMostSide)
      wrong_value("image", "sides of 1 to " + std::to_string(kMostSide), text_of(shape));
  return channels;
}

/// Fills in pixels, rows of 1, 3 or 4 channels.
void put_pixels(const float* from, std::size_t channels, Picture& picture) {
  std::vector<float>& rgb = picture.image.rgb;
  for (std::size_t i = 0; i < rgb.size(); ++i)
    rgb[i] = from[channels == 1 ? i / 3 : i / 3 * channels + i % 3];
  for (std::size_t i = 0; channels == 4 && i < rgb.size() / 3; ++i)
    picture.alpha.push_back(from[4 * i + 3]);
}

/// The same of bytes, whose colours are sRGB and not multiplied by alpha.
void put_pixels(const std::uint8_t* from, std::size_t channels, Picture& picture) {
  const std::size_t count = picture.image.rgb.size() / 3;
  if (picture.format == ImageFormat::png) {
    for (std::size_t i = 0; i < count * (channels == 1 ? 3 : channels); ++i)
      picture.bytes.push_back(from[channels == 1 ? i / 3 : i]);
    return;
  }
  std::vector<float> light;
  for (std::size_t i = 0; i < count * channels; ++i) {
    const float alpha = channels == 4 ? float(from[i - i % 4 + 3]) / 255 : 1;
    light.push_back(channels == 4 && i % 4 == 3 ? alpha : alpha * light_of_byte(from[i]));
  }
  put_pixels(light.data(), channels, picture);
}

/// An image as an array of floats, or of bytes.
py::array image_in(py::handle given) {
  constexpr const char* kShape = "(h, w), (h, w, 3) or (h, w, 4)";
  const auto is_whole = [](const py::array& array) {
    return array.dtype().kind() == 'i' || array.dtype().kind() == 'u';
  };
  const py::array floats = numbers_in(given, "image", kShape);  // refuses what are no numbers
  const py::array array = py::array::ensure(given);
  if (!is_whole(array))
    return floats;
  channels_of(shape_of(array));
  if (array.itemsize() != 1 || array.dtype().kind() != 'u')
    wrong_type("image", "floats from 0 to 1, or uint8", array);
  return array;
}

}  // namespace

void write_picture(py::handle path, py::handle given, bool srgb) {
  const std::string name = path_in(path);
  const std::optional<ImageFormat> format = image_format(name);
  if (!format)
    wrong_value("path", "a name that ends with .png, .hdr, .pfm or .exr", '"' + name + '"');
  const py::array array = image_in(given);
  const Shape shape = shape_of(array);
  const std::size_t channels = channels_of(shape);
  if (srgb && *format != ImageFormat::png)
    wrong_value("srgb", "a .png, other pictures hold light as it is", '"' + name + '"');
  if (channels == 4 && *format != ImageFormat::png && *format != ImageFormat::exr)
    wrong_value("image", "three channels for .hdr and .pfm, which hold no alpha", text_of(shape));
  Picture picture{
      Image(int(shape[1]), int(shape[0])), *format, srgb ? Tone::srgb : Tone::authored, {}};
  if (!image_fits(*format, picture.image.width, picture.image.height, channels == 4 ? 4 : 3))
    wrong_value("image", "a picture that this format holds", text_of(shape));
  const auto put = [&](const auto& rows) { put_pixels(rows.data(), channels, picture); };
  constexpr int kRows = py::array::c_style | py::array::forcecast;
  if (array.itemsize() == 1)
    put(py::array_t<std::uint8_t, kRows>(array));
  else
    put(py::array_t<float, kRows>(array));
  write_encoded(name, std::move(picture));
}

}  // namespace grelha::python
