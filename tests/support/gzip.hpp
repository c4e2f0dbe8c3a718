#pragma once

#include <zlib.h>

#include <string>
#include <string_view>

namespace grelha::test {

/// One gzip member that inflates to the text.
inline std::string gzip(std::string_view text) {
  constexpr int kBest = 9, kGzipWindow = 15 + 16, kUsualMemory = 8;
  z_stream stream{};
  deflateInit2(&stream, kBest, Z_DEFLATED, kGzipWindow, kUsualMemory, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = uInt(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = uInt(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

}  // namespace grelha::test
