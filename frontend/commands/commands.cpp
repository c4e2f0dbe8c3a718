#include "frontend/commands/commands.hpp"

#include "frontend/files/atomic_file.hpp"
#include "frontend/images/image_file.hpp"

#include <algorithm>
#include <filesystem>

namespace grelha {

std::string sampler_name(Sampler sampler) {
  return std::string(std::ranges::find(kSamplers, sampler, &SamplerName::second)->first);
}

bool is_folder(const std::string& path) {
  std::error_code ignored;
  return path != kStdout && (path.ends_with('/') || std::filesystem::is_directory(path, ignored));
}

std::string default_image(const std::string& scene, std::optional<ImageFormat> format) {
  const std::filesystem::path file = std::filesystem::path(scene).filename();
  const std::filesystem::path name = file.extension() == ".gz" ? file.stem() : file;
  return name.stem().string() + '.' + std::string(ending_of(format.value_or(ImageFormat::png)));
}

std::optional<ImageFormat> format_of(const std::string& image, std::optional<ImageFormat> asked) {
  if (asked)
    return asked;
  return image == kStdout ? ImageFormat::png : image_format(image);
}

std::string filled_in(std::string pattern, const std::string& by) {
  for (std::size_t at = 0; (at = pattern.find(kPlaceholder, at)) != std::string::npos;
       at += by.size())
    pattern.replace(at, kPlaceholder.size(), by);
  return pattern;
}

bool writes_to_stdout(const RenderCommand& command) {
  return command.image == kStdout || command.stats == kStdout;
}

}  // namespace grelha
