#include "frontend/ply/ply_faces.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "frontend/files/text.hpp"
#include "frontend/images/tone.hpp"

namespace grelha {
namespace {

using Names = std::array<std::string_view, 3>;
constexpr Names kChannelNames[] = {{"red", "green", "blue"},
                                   {"r", "g", "b"},
                                   {"diffuse_red", "diffuse_green", "diffuse_blue"},
                                   {"diffuse_r", "diffuse_g", "diffuse_b"}};

std::optional<PlyColors> colors_in(const PlyElement& element, const Names& names) {
  PlyColors found{&element, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto property = std::ranges::find_if(element.properties, [&](const PlyProperty& p) {
      return !p.is_list && in_small_letters(p.name) == names[i];
    });
    if (property == element.properties.end())
      return {};
    found.columns[i] = int(property - element.properties.begin());
    found.types[i] = property->type;
  }
  return found;
}

/// Signed bytes are mostly unsigned ones under a wrong name.
void wrap_signed_bytes(Mesh& mesh, const PlyColors& colors) {
  std::vector<float>* const channels[] = {&mesh.red, &mesh.green, &mesh.blue};
  for (std::size_t i = 0; i < 3; ++i)
    for (float& c : *channels[i])
      if (colors.types[i] == PlyType::kInt8 && c < 0)
        c += 256;
}

struct Range {
  float most = 0;
  bool is_whole = true;
};

Range range_of(const Mesh& mesh) {
  Range range;
  for (const std::vector<float>* const channel : {&mesh.red, &mesh.green, &mesh.blue})
    for (const float c : *channel)
      if (std::isfinite(c)) {
        range.most = std::max(range.most, c);
        range.is_whole &= c == std::floor(c);
      }
  return range;
}

constexpr double kByte = 255, kShort = 65535;

/// The number that is white.
double white_of(const PlyColors& colors, const Range& range) {
  constexpr float kBrightest = 16;  // light may be brighter than white, but not so much
  const bool is_float =
      std::ranges::any_of(colors.types, [](PlyType type) { return type >= PlyType::kFloat32; });
  const double own = is_float ? 1 : colors.types[0] == PlyType::kUint16 ? kShort : 0;
  if (range.most <= 1)
    return range.most == 0 && own > 0 ? own : 1;
  if (is_float && !range.is_whole && range.most <= kBrightest)
    return 1;
  if (range.most <= kByte)
    return kByte;
  if (range.most <= kShort)
    return kShort;
  return is_float ? 1 : colors.types[0] == PlyType::kUint32 ? 4294967295. : 2147483647.;
}

const char* expected_of(PlyType type) {
  return type >= PlyType::kFloat32  ? "from 0 to 1 as float"
         : type == PlyType::kUint16 ? "from 0 to 65535 as ushort"
                                    : "as uchar, ushort or float";
}

}  // namespace

PlyColors find_colors(const PlyHeader& header) {
  for (const std::string_view name : {"vertex", "face"})
    for (const PlyElement& element : header.elements)
      for (const Names& names : kChannelNames)
        if (element.name == name && element.count > 0)
          if (const auto found = colors_in(element, names))
            return *found;
  return {};
}

void scale_colors(Mesh& mesh, const PlyColors& colors, WarningList& warning_list) {
  if (!colors.element || colors.is_bytes())
    return;
  wrap_signed_bytes(mesh, colors);
  const Range range = range_of(mesh);
  const double white = white_of(colors, range);
  const bool as_expected = colors.types[0] >= PlyType::kFloat32
                               ? white == 1
                               : colors.types[0] == PlyType::kUint16 && white == kShort;
  if (!as_expected)
    warning_list.add_line(colors.element->position,
                          "expected colours " + std::string(expected_of(colors.types[0])) +
                              "; found numbers up to " +
                              std::to_string(std::int64_t(std::ceil(range.most))) +
                              ", and read them as " + (white == kByte ? "sRGB" : "light") +
                              " from 0 to " + std::to_string(std::int64_t(white)));
  std::size_t cut = 0;
  for (std::vector<float>* const channel : {&mesh.red, &mesh.green, &mesh.blue})
    for (float& c : *channel) {
      cut += !(c >= 0 && c <= float(white));
      const double inside = c > 0 ? std::min(double{c}, white) : 0;
      c = white == kByte ? light_of_byte(inside) : float(inside / white);
    }
  if (cut > 0)
    warning_list.add_line(colors.element->position,
                          std::to_string(cut) +
                              " numbers of colours are cut: expected them from 0 to " +
                              std::to_string(std::int64_t(white)));
}

float light_of_byte(double byte) {
  static const auto light = [] {
    std::array<float, 256> all{};
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = float(light_of_srgb(double(i) / 255));
    return all;
  }();
  return light[std::size_t(byte >= 0 ? std::min(byte + .5, 255.) : 0)];
}

}  // namespace grelha
