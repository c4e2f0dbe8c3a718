#include "frontend/cli/view_files.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "frontend/commands/outputs.hpp"
#include "frontend/images/image_file.hpp"
#include "frontend/jobs/preparation.hpp"

namespace grelha {
namespace {

bool is_sheet(const RenderCommand& command) {
  return command.turntable == 0 || command.image.find(kPlaceholder) == std::string::npos;
}

int columns_of(int views) {
  int columns = 1;
  while (columns * columns < views)
    ++columns;
  return columns;
}

std::string number_text(int number, int views) {
  const std::string text = std::to_string(number);
  return std::string(std::to_string(views - 1).size() - text.size(), '0') + text;
}

}  // namespace

void check_sheet(const RenderCommand& command, const Camera& camera) {
  if (!is_sheet(command))
    return;
  const int columns = columns_of(command.turntable);
  const std::int64_t width = std::int64_t{columns} * camera.width,
                     height =
                         std::int64_t{(command.turntable + columns - 1) / columns} * camera.height;
  if (width > kMostSide || height > kMostSide)
    throw UsageError("--turntable: expected a sheet of at most 65536 pixels a side, found " +
                     std::to_string(width) + 'x' + std::to_string(height) +
                     "; {} in -o makes a file of each view");
  check_image_size(
      format_of(command.image, command.format), int(width), int(height), command.transparent);
  constexpr std::uint64_t kPixel = 32;  // bytes: floats, and those of the file
  check_memory(command.scene, kPixel * std::uint64_t(width) * std::uint64_t(height));
}

void ViewFiles::add(int number, const Image& view, const ImageStyle& style) {
  const int views = std::max(command_.turntable, 1);
  if (!is_sheet(command_)) {
    write_image(filled_in(command_.image, number_text(number, views)), view, style);
    return;
  }
  const int columns = columns_of(views);
  if (number == 0) {
    style_ = style;
    sheet_ = Image(columns * view.width, (views + columns - 1) / columns * view.height);
    if (command_.transparent)
      style_.alpha.assign(sheet_.rgb.size() / 3, 0);
    else
      for (std::size_t i = 0; i < sheet_.rgb.size(); i += 3)
        std::ranges::copy(std::array{background_.x, background_.y, background_.z}, &sheet_.rgb[i]);
  }
  const auto width = std::size_t(view.width), left = std::size_t(number % columns) * width;
  for (int y = 0; y < view.height; ++y) {
    const int row = number / columns * view.height + y;
    std::copy_n(view.row(y), 3 * width, sheet_.row(row) + 3 * left);
    if (command_.transparent)
      std::copy_n(&style.alpha[std::size_t(y) * width],
                  width,
                  &style_.alpha[std::size_t(row) * std::size_t(sheet_.width) + left]);
  }
}

void ViewFiles::finish() const {
  if (is_sheet(command_))
    write_image(command_.image, sheet_, style_);
}

}  // namespace grelha
