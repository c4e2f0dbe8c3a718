#include "frontend/cli/compare_images.hpp"

#include <cstdio>
#include <string>
#include <utility>

#include "frontend/commands/console.hpp"
#include "frontend/images/compare.hpp"
#include "frontend/images/image_file.hpp"
#include "frontend/images/tone.hpp"

namespace grelha {
namespace {

constexpr int kAboveBound = 1;  ///< exit status: the pictures differ by more

std::string size_text(const Image& image) {
  return std::to_string(image.width) + 'x' + std::to_string(image.height);
}

std::string text_of(const Comparison& c) {
  char text[256];
  std::snprintf(text,
                sizeof text,
                "RMSE %.6g, largest difference %.6g at (%d, %d), %llu of %llu pixels differ\n",
                c.rmse,
                c.largest,
                c.largest_x,
                c.largest_y,
                static_cast<unsigned long long>(c.different),
                static_cast<unsigned long long>(c.pixels));
  return text;
}

}  // namespace

int compare_images(const CompareCommand& command) {
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
  print(text_of(c));
  return command.max_rmse && !(c.rmse <= *command.max_rmse) ? kAboveBound : kOk;
}

}  // namespace grelha
