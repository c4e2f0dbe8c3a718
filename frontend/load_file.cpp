#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "frontend/text.hpp"

namespace grelha {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// Half of the machine's memory, at most 8 GiB: a scene beyond that could not be built anyway.
std::size_t inflate_limit() {
  constexpr std::size_t kMost = std::size_t(8) << 30;
  const long pages = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGE_SIZE);
  if (pages <= 0 || page_size <= 0) return kMost;
  return std::min(kMost, std::size_t(pages) / 2 * std::size_t(page_size));
}

std::string read_bytes(const std::string& path) {
  struct stat about {};
  if (stat(path.c_str(), &about) != 0) throw FileError(path, std::string("cannot open: ") + std::strerror(errno));
  if (S_ISDIR(about.st_mode)) throw FileError(path, std::string("cannot read: ") + std::strerror(EISDIR));
  if (!S_ISREG(about.st_mode)) throw FileError(path, "cannot read: not a regular file");
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) throw FileError(path, std::string("cannot open: ") + std::strerror(errno));
  std::string bytes(std::size_t(about.st_size), '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
  if (std::ferror(file.get())) throw FileError(path, std::string("cannot read: ") + std::strerror(errno));
  return bytes;
}

bool is_gzip(std::string_view data) {
  return data.size() >= 2 && static_cast<unsigned char>(data[0]) == 0x1f && static_cast<unsigned char>(data[1]) == 0x8b;
}

/// Owns zlib's state; feeds it at most 1 GiB at a time because its counters have 32 bits.
class Inflater {
 public:
  Inflater(const std::string& path, std::string_view data) : path_(path), data_(data) {
    if (inflateInit2(&stream_, 15 + 16) != Z_OK) throw std::bad_alloc();
  }
  Inflater(const Inflater&) = delete;
  ~Inflater() { inflateEnd(&stream_); }

  std::string run(std::size_t limit) {
    std::string out(std::min(limit, std::max<std::size_t>(4 * data_.size(), 4096)), '\0');
    std::size_t made = 0;
    while (!step(out, made)) {
      if (made < out.size()) continue;
      if (out.size() >= limit)
        fail("wanted data that inflate to at most " + std::to_string(limit) + " bytes, found more");
      out.resize(std::min(limit, 2 * out.size()));
    }
    out.resize(made);
    return out;
  }

 private:
  static constexpr std::size_t kChunk = std::size_t(1) << 30;

  [[noreturn]] void fail(const std::string& message) const { throw ParseError(Position{path_, 0, 0, taken_}, message); }

  /// One call of inflate; true when the last member has ended.
  bool step(std::string& out, std::size_t& made) {
    const std::size_t give = std::min(kChunk, data_.size() - taken_), room = std::min(kChunk, out.size() - made);
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data_.data() + taken_));
    stream_.avail_in = uInt(give);
    stream_.next_out = reinterpret_cast<Bytef*>(out.data() + made);
    stream_.avail_out = uInt(room);
    const int result = inflate(&stream_, Z_NO_FLUSH);
    taken_ += give - stream_.avail_in;
    made += room - stream_.avail_out;
    if (result == Z_STREAM_END) {
      if (!is_gzip(data_.substr(taken_))) return true;  // bytes behind the last member are ignored, as gzip does
      inflateReset(&stream_);
      return false;
    }
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    if (result != Z_OK && result != Z_BUF_ERROR)
      fail(std::string("wanted sound gzip data, found ") + (stream_.msg ? stream_.msg : "broken ones"));
    if (taken_ == data_.size() && stream_.avail_out != 0) fail("wanted more gzip data, found end of file");
    return false;
  }

  const std::string& path_;
  std::string_view data_;
  std::size_t taken_ = 0;
  z_stream stream_{};
};

}  // namespace

std::string inflate_gzip(const std::string& path, std::string_view data, std::size_t limit) {
  return Inflater(path, data).run(limit);
}

std::string load_file(const std::string& path) {
  std::string bytes = read_bytes(path);
  if (is_gzip(bytes)) return inflate_gzip(path, bytes, inflate_limit());
  return bytes;
}

}  // namespace grelha
