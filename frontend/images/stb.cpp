// The one file that compiles stb, so that its warnings and its macros stay here.
#include "frontend/images/strip_deflate.hpp"

#include <zlib.h>

#include <cstdlib>
#include <cstring>
#include <new>
#include <string>

#include "kernel/base/pages.hpp"

namespace {

// stb asks for 8: five times the time for 7 % fewer bytes (ready scene balls at 640x480)
constexpr int kLevel = 4;

/// zlib's deflate in place of stb's own, which is slower and packs worse.
unsigned char* deflate_by_zlib(unsigned char* data, int size, int* packed_size, int) try {
  const std::string packed =
      grelha::deflate_in_strips({reinterpret_cast<const char*>(data), std::size_t(size)}, kLevel);
  auto* const copy = static_cast<unsigned char*>(std::malloc(packed.size()));
  if (copy)
    std::memcpy(copy, packed.data(), packed.size());
  *packed_size = int(packed.size());
  return copy;
} catch (const std::bad_alloc&) {
  return nullptr;
}

unsigned checksum_by_zlib(const unsigned char* data, int size) {
  return unsigned(crc32(0, data, uInt(size)));
}

/// For rows of a picture, which are soon written.
void* memory_to_fill(std::size_t bytes) {
  void* const memory = std::malloc(bytes);
  if (memory)
    grelha::populate_pages(memory, bytes);
  return memory;
}

}  // namespace

#define STBIW_MALLOC memory_to_fill
#define STBIW_REALLOC std::realloc
#define STBIW_FREE std::free
#define STBIW_ZLIB_COMPRESS deflate_by_zlib
#define STBIW_CRC32 checksum_by_zlib
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

#define STBI_ONLY_PNG
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>
