#include "frontend/cli/compare_images.hpp"

#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "frontend/commands/console.hpp"
#include "frontend/commands/outputs.hpp"
#include "frontend/images/compare.hpp"
#include "frontend/images/image_file.hpp"
#include "frontend/images/likeness.hpp"
#include "frontend/images/tone.hpp"
#include "frontend/jobs/identity.hpp"

namespace grelha {
namespace {

constexpr int kAboveBound = 1;  ///< exit status: the pictures differ by more

std::string size_text(const Image& image) {
  return std::to_string(image.width) + 'x' + std::to_string(image.height);
}

void write_difference(const CompareCommand& command,
                      const Image& a,
                      const Image& b,
                      double largest) {
  const bool stretch =
      image_format(command.diff) == ImageFormat::png && largest > 0 && largest <= 1e30;
  write_image(command.diff,
              difference(a, b, stretch ? 1 / largest : 1),
              {.notes = {kSoftware, {"Comment", "difference of two pictures"}}});
}

void write_error_map(const std::string& path, const Similarity& similarity) {
  const auto picture = image_format(path) == ImageFormat::png ? in_colors : in_numbers;
  write_image(
      path, picture(similarity), {.notes = {kSoftware, {"Comment", "FLIP of two pictures"}}});
}

void check_outputs(const CompareCommand& command) {
  const Output diff{"--diff", command.diff}, map{"--error-map", command.error_map};
  for (const Output& output : {diff, map})
    if (!output.second.empty())
      check_not_read({output}, {command.a, command.b});
  if (!command.diff.empty() && !command.error_map.empty())
    check_distinct(diff, map);
}

/// Returns the sRGB values that a screen shows. Light passes through the sRGB curve; other numbers
/// are sRGB values or authored colours already, and stay.
Image on_screen(Image image, const Encoding& encoding, bool is_light) {
  if (encoding.kind == Encoding::Kind::power && !is_light) {
    image = as_light(std::move(image), encoding);
    is_light = true;
  }
  image = displayed(std::move(image));
  return is_light ? as_srgb(std::move(image)) : image;
}

std::string text_of(const Comparison& c) {
  char text[256];
  std::snprintf(
      text,
      sizeof text,
      "RMSE %.6g, PSNR %.4g dB, largest difference %.6g at (%d, %d), %llu of %llu pixels differ\n"
      "relative MSE %.6g",
      c.rmse,
      c.psnr_db,
      c.largest,
      c.largest_x,
      c.largest_y,
      static_cast<unsigned long long>(c.different),
      static_cast<unsigned long long>(c.pixels),
      c.relative_mse);
  return text;
}

/// Returns "-" for an absent number.
std::string text_of(std::optional<double> number) {
  if (!number)
    return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", *number);
  return text;
}

}  // namespace

int compare_images(const CompareCommand& command) {
  check_outputs(command);
  Encoding of_a, of_b;
  Image a = read_image(command.a, &of_a), b = read_image(command.b, &of_b);
  if (a.width != b.width || a.height != b.height)
    throw UsageError("the pictures have unequal sizes, " + size_text(a) + " and " + size_text(b));
  const bool as_light_both = of_a != of_b;
  if (as_light_both) {
    warn(command.a + " holds " + encoding_text(of_a) + ", " + command.b + ' ' +
         encoding_text(of_b) + ": compared as light");
    a = as_light(std::move(a), of_a);
    b = as_light(std::move(b), of_b);
  }
  if (command.display) {
    a = displayed(std::move(a));
    b = displayed(std::move(b));
  }
  const Comparison c = compare(a, b);
  if (!command.diff.empty())
    write_difference(command, a, b, c.largest);
  const Similarity l = compare_similarity(on_screen(std::move(a), of_a, as_light_both),
                                          on_screen(std::move(b), of_b, as_light_both));
  if (!command.error_map.empty())
    write_error_map(command.error_map, l);
  print(text_of(c) + ", SSIM " + text_of(l.ssim) + ", FLIP " + text_of(l.flip) + '\n');
  return command.max_rmse && !(c.rmse <= *command.max_rmse) ? kAboveBound : kOk;
}

}  // namespace grelha
