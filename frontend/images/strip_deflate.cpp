#include "frontend/images/strip_deflate.hpp"

#include <omp.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <new>
#include <vector>

#include "kernel/base/pages.hpp"
#include "kernel/base/parallel_for.hpp"

namespace grelha {
namespace {

constexpr std::size_t kWindow = 32768;  ///< a deflated stream refers back so far
constexpr int kRaw = -15;               ///< that window, and neither header nor checksum

/// A part of the stream and the checksum of its data. An empty part means that memory ran out.
struct Strip {
  std::string packed;
  uLong checksum = 0;
};

const Bytef* bytes_of(std::string_view text) {
  return reinterpret_cast<const Bytef*>(text.data());
}

/// Owns zlib's state, for one strip after another.
class StripDeflater {
 public:
  explicit StripDeflater(int level)
      : ready_(deflateInit2(&stream_, level, Z_DEFLATED, kRaw, 8, Z_DEFAULT_STRATEGY) == Z_OK) {}
  StripDeflater(const StripDeflater&) = delete;
  ~StripDeflater() { deflateEnd(&stream_); }

  Strip strip(std::string_view data, std::size_t begin) noexcept try {
    if (!ready_)
      return {};
    const std::string_view strip = data.substr(begin, kStripBytes);
    const std::size_t back = std::min(begin, kWindow);
    return {pack(data.substr(begin - back, back), strip, begin + strip.size() == data.size()),
            adler32(1, bytes_of(strip), uInt(strip.size()))};
  } catch (const std::bad_alloc&) {
    return {};
  }

 private:
  /// Every part but the last ends on a whole byte, ready for the next.
  std::string pack(std::string_view before, std::string_view strip, bool last) {
    constexpr std::size_t kFlush = 16;  // end of a part that is not the last, and some spare bytes
    deflateReset(&stream_);
    deflateSetDictionary(&stream_, bytes_of(before), uInt(before.size()));
    buffer_.resize(deflateBound(&stream_, uLong(strip.size())) + kFlush);
    stream_.next_in = const_cast<Bytef*>(bytes_of(strip));
    stream_.avail_in = uInt(strip.size());
    stream_.next_out = reinterpret_cast<Bytef*>(buffer_.data());
    stream_.avail_out = uInt(buffer_.size());
    deflate(&stream_, last ? Z_FINISH : Z_SYNC_FLUSH);
    return buffer_.substr(0, buffer_.size() - stream_.avail_out);
  }

  z_stream stream_{};
  std::string buffer_;  ///< of one strip after another
  bool ready_;
};

constexpr std::size_t kMostAround = 8;  ///< bytes of header and checksum, and to spare

/// A window of 32 KiB, and a compression level that readers ignore.
std::string zlib_header() {
  return "\x78\x5e";
}

std::string zlib_checksum(uLong adler) {
  const auto sum = std::uint32_t(adler);
  return {char(sum >> 24), char(sum >> 16), char(sum >> 8), char(sum)};
}

}  // namespace

std::string deflate_in_strips(std::string_view data, int level) {
  const std::size_t count = std::max<std::size_t>(1, (data.size() + kStripBytes - 1) / kStripBytes);
  std::vector<Strip> strips(count);
  const auto pack = [&](std::size_t i, StripDeflater& deflater) {
    strips[i] = deflater.strip(data, i * kStripBytes);
  };
  each_turn(
      count, omp_get_max_threads(), [level] { return StripDeflater(level); }, pack);
  std::size_t bytes = kMostAround;
  for (const Strip& strip : strips)
    bytes += strip.packed.size();
  std::string stream = zlib_header();
  reserve_to_fill(stream, bytes);
  uLong checksum = 1;
  for (std::size_t i = 0; i < count; ++i) {
    if (strips[i].packed.empty())
      throw std::bad_alloc();
    stream += strips[i].packed;
    const std::size_t size = std::min(kStripBytes, data.size() - i * kStripBytes);
    checksum = adler32_combine(checksum, strips[i].checksum, z_off_t(size));
  }
  stream += zlib_checksum(checksum);
  return stream;
}

}  // namespace grelha
