#include "frontend/cli/compare_images.hpp"

#include <cstdio>
#include <string>
#include <utility>

#include "frontend/commands/console.hpp"
#include "frontend/commands/outputs.hpp"
#include "frontend/images/compare.hpp"
#include "frontend/images/image_file.hpp"
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

}  // namespace

int compare_images(const CompareCommand& command) {
  if (!command.diff.empty())
    check_not_read({{"--diff", command.diff}}, {command.a, command.b});
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
  print(text_of(c) + '\n');
  return command.max_rmse && !(c.rmse <= *command.max_rmse) ? kAboveBound : kOk;
}

}  // namespace grelha
