// The one file that compiles stb, so that its warnings and its macros stay here.
#include <zlib.h>

#include <cstdlib>

namespace {

// stb asks for 8: five times the time for 7 % fewer bytes (ready scene balls at 640x480)
constexpr int kLevel = 4;

/// zlib's deflate in place of stb's own, which is slower and packs worse.
unsigned char* deflate_by_zlib(unsigned char* data, int size, int* packed_size, int) {
  uLongf length = compressBound(uLong(size));
  auto* const packed = static_cast<unsigned char*>(std::malloc(length));
  if (packed && compress2(packed, &length, data, uLong(size), kLevel) != Z_OK)
    *packed = 0;
  *packed_size = int(length);
  return packed;
}

unsigned checksum_by_zlib(const unsigned char* data, int size) {
  return unsigned(crc32(0, data, uInt(size)));
}

}  // namespace

#define STBIW_ZLIB_COMPRESS deflate_by_zlib
#define STBIW_CRC32 checksum_by_zlib
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

#define STBI_ONLY_PNG
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>
