// Fuzzes the picture formats that `compare` reads, except those that only stb parses: OpenEXR, PFM
// and the metadata of PNG. A picture that is read must not be empty, and must keep every bit when
// it is written and read as OpenEXR. The message for an invalid file must be a single line.
#include <cstring>

#include "frontend/files/parse_error.hpp"
#include "frontend/images/hdr_file.hpp"
#include "frontend/images/image_file.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace grelha;

bool same_bits(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height &&
         std::memcmp(a.rgb.data(), b.rgb.data(), a.rgb.size() * sizeof(float)) == 0;
}

void try_one(const std::string& file) {
  constexpr std::size_t kMostValues = 3 * 4096;
  try {
    const Image image = read_image(file);
    fuzz::promise(image.width > 0 && image.height > 0, "a picture has a size");
    fuzz::promise(image.rgb.size() == std::size_t(image.width) * std::size_t(image.height) * 3,
                  "as many values as its size says");
    if (image.rgb.size() > kMostValues)
      return;
    fuzz::promise(same_bits(read_exr("again.exr", encode_exr(image)), image),
                  "what is written is what was read");
  } catch (const FileError& error) {
    const std::string message = error.what();
    fuzz::promise(message.find('\n') == message.npos, "a message is one line");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder;
  const std::string_view bytes = fuzz::text_of(data, size);
  if (bytes.starts_with("\x89PNG")) {
    encoding_text(png_encoding(bytes));
    return 0;
  }
  try_one(folder.write(bytes.starts_with("P") ? "a.pfm" : "a.exr", bytes));
  return 0;
}
