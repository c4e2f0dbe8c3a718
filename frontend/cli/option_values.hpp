#pragma once
// Parsers for the values of options. Each throws a UsageError that says what was expected and what
// was found.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "frontend/commands/commands.hpp"
#include "frontend/files/text.hpp"

namespace grelha::option_values {

inline constexpr int kMaxSide = 65536;  ///< of a picture

[[noreturn]] void reject(const std::string& option,
                         const std::string& expected,
                         const std::string& found,
                         const std::string& suggested = "");

int whole(const std::string& option, const std::string& text, int low, int high);
float density(const std::string& text);
double min_weight(const std::string& text);
void parse_aa(const std::string& text, Effects& effects);
void parse_shadows(const std::string& text, Effects& effects);
void parse_lens(const std::string& text, Effects& effects);
void parse_glossy(const std::string& text, Effects& effects);
void parse_error_bound(const std::string& text, RefineOptions& refine);
void parse_time(const std::string& text, RefineOptions& refine);
double rmse_bound(const std::string& text);
void parse_size(const std::string& text, int& width, int& height);
/// "A:B": A from 0, B above A and at most `most`.
Range range(const std::string& option, const std::string& text, int most);
/// "N", "I:J" or "I:J/N"
void parse_samples(const std::string& text, RenderCommand& command);
std::array<double, 3> point(const std::string& option, const std::string& text);
/// "X,Y,Z", or an axis: "z", "+Z", "-x".
std::array<double, 3> direction(const std::string& option, const std::string& text);
double angle(const std::string& text);
double picture_height(const std::string& text);  ///< 0: auto
Orbit orbit(const std::string& text);
double point_radius(const std::string& text);  ///< 0: auto
double smoothness(const std::string& text);
/// "R,G,B", or one number for all three.
/// Of R,G,B, one number, #rgb, #rrggbb, or a name of CSS 2.
void parse_background(const std::string& text, ViewOptions& view);
/// Seconds.
double interval(const std::string& option, const std::string& text);

void check_image_name(const std::string& option, const std::string& path);
std::string file_name(const std::string& option, const std::string& text);
std::string regular_file_name(const std::string& option, const std::string& text);

/// "depth,normal,id", or some of these words.
LayerChoice layers(const std::string& text);

/// A number of bytes; a suffix K, M, G or T multiplies it by a power of 1024.
std::uint64_t memory_size(const std::string& text);

/// Returns the value of the word that stands behind an option.
template <class T, std::size_t N>
T choice(const std::string& option,
         const std::string& text,
         const std::array<std::pair<std::string_view, T>, N>& words) {
  std::string expected;
  std::vector<std::string_view> all;
  for (const auto& [word, value] : words) {
    if (word == text)
      return value;
    expected += (expected.empty() ? "" : ", ") + std::string(word);
    all.push_back(word);
  }
  throw UsageError(option + ": expected one of " + expected + ", found \"" + text + '"' +
                   suggest(text, all));
}

}  // namespace grelha::option_values
