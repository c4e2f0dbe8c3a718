#include "frontend/cli/option_values.hpp"

#include "frontend/files/atomic_file.hpp"
#include "frontend/files/text.hpp"
#include "frontend/images/image_file.hpp"
#include "grelha/coordinates.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <span>
#include <utility>

namespace grelha::option_values {
namespace {

constexpr double kMaxDensity = 1000;
constexpr double kMaxSeconds = 1e9;  ///< 30 years; a clock counts so far without rounding
constexpr double kMaxBytes = 1e18;
constexpr double kLeastError = 1e-6;

/// The kind of KIND:MORE that was probably meant.
std::string suggested_kind(const std::string& text, std::initializer_list<std::string_view> kinds) {
  const std::size_t end = std::min(text.find(':'), text.size());
  const std::string_view kind =
      nearest(std::string_view(text).substr(0, end), std::span(kinds.begin(), kinds.size()));
  return kind.empty() || text.starts_with(kind)
             ? ""
             : "; did you mean " + std::string(kind) + text.substr(end) + '?';
}

/// Parses the whole of `text` as a number, independent of the locale.
template <class T>
std::optional<T> number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    return {};
  return value;
}

/// Splits "a,b,c" at its commas; refuses fewer than `least` or more than `most` parts.
std::vector<std::string> parts(const std::string& option,
                               const std::string& text,
                               std::size_t least,
                               std::size_t most,
                               const char* expected) {
  std::vector<std::string> found(1);
  for (const char c : text) {
    if (c == ',')
      found.emplace_back();
    else
      found.back() += c;
  }
  if (found.size() < least || found.size() > most)
    reject(option, expected, text);
  return found;
}

/// Parses a number that fits(); refuses any other text.
template <class T>
T fitting(const std::string& option,
          const std::string& text,
          const std::string& expected,
          bool (*fits)(T)) {
  const auto value = number<T>(text);
  if (!value || !fits(*value))
    reject(option, expected, text);
  return *value;
}

/// Parses a length in a scene, from 0 to kLargestLength.
double not_negative(const std::string& option, const std::string& text, const char* what) {
  const std::string expected = std::string(what) + " from 0 to 1e18";
  return fitting<double>(
      option, text, expected, [](double v) { return v >= 0 && v <= kLargestLength; });
}

bool is_coordinate(double value) {
  return std::abs(value) <= kLargestLength;
}

template <class T>
bool is_share(T value) {
  return value >= 0 && value <= 1;
}

bool is_time(double value) {
  return value > 0 && value <= kMaxSeconds;
}

Subdivision subdivision(const std::string& text) {
  const auto p = parts("--aa", text, 2, 2, "adaptive:THRESHOLD,DEPTH");
  const float threshold = fitting<float>("--aa", p[0], "a threshold from 0 to 1", is_share);
  return {true, threshold, whole("--aa", p[1], 0, kMostSubdivisions)};
}

/// Parses N of `samples:N`.
std::uint64_t sample_count(const std::string& text, std::size_t begin) {
  const auto count = number<std::uint64_t>(std::string_view(text).substr(begin));
  if (!count || *count == 0)
    reject("--time", "samples:N with N from 1 to 2^64 - 1", text);
  return *count;
}

constexpr std::pair<std::string_view, std::uint32_t> kColors[] = {
    {"black", 0},          {"silver", 0xC0C0C0},  {"gray", 0x808080},   {"grey", 0x808080},
    {"white", 0xFFFFFF},   {"maroon", 0x800000},  {"red", 0xFF0000},    {"purple", 0x800080},
    {"fuchsia", 0xFF00FF}, {"magenta", 0xFF00FF}, {"green", 0x008000},  {"lime", 0x00FF00},
    {"olive", 0x808000},   {"yellow", 0xFFFF00},  {"orange", 0xFFA500}, {"navy", 0x000080},
    {"blue", 0x0000FF},    {"teal", 0x008080},    {"aqua", 0x00FFFF},   {"cyan", 0x00FFFF}};

/// The bytes of a colour of a screen as shares of 255.
std::optional<Float3> screen_color(const std::string& text) {
  const auto channels = [](std::uint32_t rgb, unsigned bits) {
    const std::uint32_t most = (1u << bits) - 1;
    const auto channel = [=](unsigned i) { return float(rgb >> (i * bits) & most) / float(most); };
    return Float3{channel(2), channel(1), channel(0)};
  };
  const std::string small = in_small_letters(text);
  for (const auto& [name, rgb] : kColors)
    if (small == name)
      return channels(rgb, 8);
  if (text.size() != 4 && text.size() != 7)
    return {};
  std::uint32_t rgb = 0;
  const char* const end = text.data() + text.size();
  const auto [past, error] = std::from_chars(text.data() + 1, end, rgb, 16);
  if (text[0] != '#' || error != std::errc() || past != end)
    return {};
  return channels(rgb, text.size() == 4 ? 4 : 8);
}

}  // namespace

void reject(const std::string& option,
            const std::string& expected,
            const std::string& found,
            const std::string& suggested) {
  throw UsageError(option + ": expected " + expected + ", found \"" + found + '"' + suggested);
}

int whole(const std::string& option, const std::string& text, int low, int high) {
  const auto value = number<int>(text);
  if (!value || *value < low || *value > high)
    reject(
        option, "a whole number from " + std::to_string(low) + " to " + std::to_string(high), text);
  return *value;
}

double min_weight(const std::string& text) {
  return fitting<double>("--min-weight", text, "a number from 0 to 1", is_share);
}

float density(const std::string& text) {
  const auto fits = [](double v) { return float(v) > 0 && v <= kMaxDensity; };
  return float(fitting<double>("--density", text, "a number above 0 and up to 1000", fits));
}

void parse_aa(const std::string& text, Effects& effects) {
  constexpr std::string_view kJitter = "jitter:", kAdaptive = "adaptive:";
  if (text == "off")
    effects.jitter = 1;
  else if (text.starts_with(kJitter))
    effects.jitter = whole("--aa", text.substr(kJitter.size()), 1, 256);
  else if (text.starts_with(kAdaptive))
    effects.adaptive = subdivision(text.substr(kAdaptive.size()));
  else
    reject("--aa",
           "off, jitter:N or adaptive:THRESHOLD,DEPTH",
           text,
           suggested_kind(text, {"off", "jitter", "adaptive"}));
}

void parse_shadows(const std::string& text, Effects& effects) {
  constexpr std::string_view kRandom = "random:", kArea = "area:";
  Effects::Shadows s;
  if (text == "hard") {
    s.hard = true;
  } else if (text.starts_with(kRandom)) {
    s.size = float(not_negative("--shadows", text.substr(kRandom.size()), "a size"));
  } else if (text.starts_with(kArea)) {
    const auto p = parts("--shadows", text.substr(kArea.size()), 2, 2, "area:SIZE,N");
    s.size = float(not_negative("--shadows", p[0], "a size"));
    s.positions = whole("--shadows", p[1], 1, 64);
  } else {
    reject("--shadows",
           "hard, random:SIZE or area:SIZE,N",
           text,
           suggested_kind(text, {"hard", "random", "area"}));
  }
  effects.shadows = s;
}

void parse_lens(const std::string& text, Effects& effects) {
  const auto p = parts("--lens", text, 1, 3, "APERTURE,FOCUS,N");
  Effects::Lens lens;
  lens.aperture = not_negative("--lens", p[0], "an aperture");
  if (p.size() > 1)
    lens.focus = not_negative("--lens", p[1], "a focal distance");
  if (p.size() > 2)
    lens.samples = whole("--lens", p[2], 1, kMostSamples);
  effects.lens = lens;
}

void parse_glossy(const std::string& text, Effects& effects) {
  const auto p = parts("--glossy", text, 1, 2, "ROUGHNESS,N");
  Effects::Glossy g;
  g.roughness = float(not_negative("--glossy", p[0], "a roughness"));
  if (p.size() > 1)
    g.rays = whole("--glossy", p[1], 1, 256);
  effects.glossy = g;
}

void parse_error_bound(const std::string& text, RefineOptions& refine) {
  const auto fits = [](double v) { return v >= kLeastError && v <= 1; };
  refine.error = fitting<double>("--error", text, "a number from 0.000001 to 1", fits);
}

void parse_time(const std::string& text, RefineOptions& refine) {
  constexpr std::string_view kSamples = "samples:";
  refine.seconds = 0;
  refine.samples = 0;
  if (text.starts_with(kSamples)) {
    refine.samples = sample_count(text, kSamples.size());
    return;
  }
  refine.seconds =
      fitting<double>("--time", text, "seconds above 0 and up to 1e9, or samples:N", is_time);
}

double rmse_bound(const std::string& text) {
  const auto fits = [](double v) { return v >= 0; };
  return fitting<double>("--max-rmse", text, "a number that is not negative", fits);
}

void parse_size(const std::string& text, int& width, int& height) {
  const auto cross = text.find_first_of("xX");
  const auto w = number<int>(std::string_view(text).substr(0, cross));
  const auto h = cross == std::string::npos ? std::nullopt
                                            : number<int>(std::string_view(text).substr(cross + 1));
  if (!w || !h || *w < 1 || *h < 1 || *w > kMaxSide || *h > kMaxSide)
    reject("--size",
           "WIDTHxHEIGHT, each from 1 to 65536",
           text,
           w && cross == std::string::npos ? "; did you mean " + text + 'x' + text + '?' : "");
  width = *w;
  height = *h;
}

Range range(const std::string& option, const std::string& text, int most) {
  const auto colon = text.find(':');
  const auto begin = number<int>(std::string_view(text).substr(0, colon));
  const auto end = colon == std::string::npos
                       ? std::nullopt
                       : number<int>(std::string_view(text).substr(colon + 1));
  if (!begin || !end || *begin < 0 || *begin >= *end || *end > most)
    reject(option,
           "A:B, whole numbers, 0 or more, A below B, B at most " + std::to_string(most),
           text);
  return {*begin, *end};
}

void parse_samples(const std::string& text, RenderCommand& command) {
  if (text.find(':') == std::string::npos) {
    command.effects.samples = whole("--samples", text, 1, kMostSamples);
    return;
  }
  const auto slash = text.find('/');
  if (slash != std::string::npos)
    command.effects.samples = whole("--samples", text.substr(slash + 1), 1, kMostSamples);
  command.work.samples =
      range("--samples", text.substr(0, slash), command.effects.samples.value_or(kMostSamples));
}

std::array<double, 3> point(const std::string& option, const std::string& text) {
  const auto p = parts(option, text, 3, 3, "X,Y,Z");
  std::array<double, 3> numbers{};
  for (std::size_t i = 0; i < 3; ++i)
    numbers[i] = fitting<double>(option, p[i], "numbers X,Y,Z within 1e18", is_coordinate);
  return numbers;
}

std::array<double, 3> direction(const std::string& option, const std::string& text) {
  const bool has_sign = text.starts_with('+') || text.starts_with('-');
  const std::string axis = in_small_letters(text.substr(has_sign ? 1 : 0));
  if (axis != "x" && axis != "y" && axis != "z") {
    if (text.find(',') == text.npos)
      reject(option, "X,Y,Z, or an axis such as z or -y", text);
    return point(option, text);
  }
  std::array<double, 3> found{};
  found[std::size_t(axis[0] - 'x')] = text[0] == '-' ? -1 : 1;
  return found;
}

double angle(const std::string& text) {
  const auto fits = [](double v) { return v > 0 && v < 180; };
  return fitting<double>("--angle", text, "degrees between 0 and 180", fits);
}

double picture_height(const std::string& text) {
  const auto fits = [](double v) { return v > 0 && v <= kLargestLength; };
  constexpr const char* kExpected = "auto, or a height above 0 and up to 1e18";
  return text == "auto" ? 0 : fitting<double>("--orthographic", text, kExpected, fits);
}

double point_radius(const std::string& text) {
  const auto fits = [](double v) { return v > 0 && v <= kLargestLength; };
  return text == "auto" ? 0 : fitting<double>("--points", text, "auto, or a radius above 0", fits);
}

double smoothness(const std::string& text) {
  const auto fits = [](double v) { return v > 0 && v <= 180; };
  return fitting<double>("--smooth", text, "degrees above 0 and up to 180", fits);
}

Orbit orbit(const std::string& text) {
  constexpr const char* kExpected = "AZIMUTH, AZIMUTH,ELEVATION or AZIMUTH,ELEVATION,ZOOM";
  const auto p = parts("--orbit", text, 1, 3, kExpected);
  const auto turn = [](double v) { return std::abs(v) <= kMostTurn; };
  const auto is_zoom = [](double v) { return v >= kLeastZoom && v <= kMostZoom; };
  return {fitting<double>("--orbit", p[0], "degrees, at most 100 turns", turn),
          p.size() < 2 ? 0 : fitting<double>("--orbit", p[1], "degrees, at most 100 turns", turn),
          p.size() < 3 ? 1 : fitting<double>("--orbit", p[2], "a zoom of .001 to 1000", is_zoom)};
}

void parse_background(const std::string& text, ViewOptions& view) {
  constexpr const char* kExpected = "R,G,B, #rrggbb or a name such as white";
  view.background_is_encoded = true;
  view.background = screen_color(text);
  if (view.background)
    return;
  const auto p = parts("--background", text, 1, 3, kExpected);
  if (p.size() == 2 ||
      !(text.starts_with('.') || (text[0] >= '0' && text[0] <= '9') || text.starts_with('-')))
    reject("--background", kExpected, text);
  const auto channel = [&](std::size_t i) {
    return float(not_negative("--background", p[std::min(i, p.size() - 1)], "light"));
  };
  view.background_is_encoded = false;
  view.background = Float3{channel(0), channel(1), channel(2)};
}

double interval(const std::string& option, const std::string& text) {
  return fitting<double>(option, text, "seconds above 0 and up to 1e9", is_time);
}

void check_image_name(const std::string& option, const std::string& path) {
  if (!image_format(path))
    reject(option, "a name ending in .png, .hdr, .pfm or .exr", path);
}

std::string file_name(const std::string& option, const std::string& text) {
  if (text.empty())
    reject(option, "a file name", text);
  return text;
}

std::string regular_file_name(const std::string& option, const std::string& text) {
  if (text == kStdout)
    reject(option, "a file that can be read again", text);
  return file_name(option, text);
}

LayerChoice layers(const std::string& text) {
  constexpr const char* kExpected = "some of depth,normal,id, each once";
  LayerChoice chosen;
  for (const std::string& word : parts("--layers", text, 1, 3, kExpected)) {
    bool* const one = word == "depth"    ? &chosen.depth
                      : word == "normal" ? &chosen.normal
                      : word == "id"     ? &chosen.id
                                         : nullptr;
    if (!one || *one)
      reject("--layers", kExpected, text);
    *one = true;
  }
  return chosen;
}

std::uint64_t memory_size(const std::string& text) {
  constexpr std::string_view kUnits = "KMGT";
  const auto unit = text.empty() ? std::string_view::npos : kUnits.find(text.back());
  const auto value = number<double>(
      std::string_view(text).substr(0, text.size() - (unit != std::string_view::npos)));
  const double bytes =
      value ? std::ldexp(*value, unit == std::string_view::npos ? 0 : 10 * (int(unit) + 1)) : 0;
  if (!(bytes >= 1 << 26) || bytes > kMaxBytes)
    reject("--max-memory", "a size from 64M to 1e18 bytes, such as 512M or 6G", text);
  return std::uint64_t(bytes);
}

}  // namespace grelha::option_values
