#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "frontend/load_progress.hpp"
#include "frontend/text.hpp"

namespace grelha {
namespace {

constexpr double kInflating = 10;  ///< times as long as reading

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

using File = std::unique_ptr<std::FILE, CloseFile>;

/// What a pipe holds is known when it ends, which may be never: whoever waits looks up now and then.
std::string read_pipe(const std::string& path, LoadProgress* progress) {
  constexpr int kLookUp = 100;  // ms
  const int handle = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (handle < 0) throw FileError(path, std::string("cannot open: ") + std::strerror(errno));
  const File file(fdopen(handle, "rb"));
  std::string bytes(1 << 16, '\0');
  std::size_t have = 0;
  for (;;) {
    if (pollfd asked{handle, POLLIN, 0}; poll(&asked, 1, kLookUp) <= 0) {
      if (progress) progress->waiting();
      continue;
    }
    if (have == bytes.size()) bytes.resize(2 * have);
    const ssize_t got = read(handle, bytes.data() + have, bytes.size() - have);
    if (got < 0 && errno != EAGAIN && errno != EINTR) throw FileError(path, std::string("cannot read: ") + std::strerror(errno));
    if (got == 0) break;
    have += std::size_t(std::max<ssize_t>(got, 0));
  }
  bytes.resize(have);
  if (progress) progress->expect(kParsing * double(have));
  return bytes;
}

std::string read_bytes(const std::string& path, LoadProgress* progress, bool pipe_too) {
  struct stat about {};
  if (stat(path.c_str(), &about) != 0) throw FileError(path, std::string("cannot open: ") + std::strerror(errno));
  if (S_ISDIR(about.st_mode)) throw FileError(path, std::string("cannot read: ") + std::strerror(EISDIR));
  if (pipe_too && S_ISFIFO(about.st_mode)) return read_pipe(path, progress);
  if (!S_ISREG(about.st_mode)) throw FileError(path, "cannot read: not a regular file");
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) throw FileError(path, std::string("cannot open: ") + std::strerror(errno));
  std::string bytes(std::size_t(about.st_size), '\0');
  if (progress) progress->expect((1 + kParsing) * double(bytes.size()));
  constexpr std::size_t kPiece = std::size_t(1) << 24;
  std::size_t have = 0;
  for (std::size_t got = 1; got > 0 && have < bytes.size(); have += got) {
    got = std::fread(bytes.data() + have, 1, std::min(kPiece, bytes.size() - have), file.get());
    if (progress) progress->done(double(got));
  }
  bytes.resize(have);
  if (std::ferror(file.get())) throw FileError(path, std::string("cannot read: ") + std::strerror(errno));
  return bytes;
}

bool is_gzip(std::string_view data) {
  return data.size() >= 2 && static_cast<unsigned char>(data[0]) == 0x1f && static_cast<unsigned char>(data[1]) == 0x8b;
}

/// Owns zlib's state; feeds it 16 MiB at a time: its counters have 32 bits, and progress is told of each.
class Inflater {
 public:
  Inflater(const std::string& path, std::string_view data, LoadProgress* progress) : path_(path), data_(data), progress_(progress) {
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
  static constexpr std::size_t kChunk = std::size_t(1) << 24;

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
    if (progress_) progress_->done(kInflating * double(give - stream_.avail_in));
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
  LoadProgress* progress_;
  std::size_t taken_ = 0;
  z_stream stream_{};
};

}  // namespace

std::string inflate_gzip(const std::string& path, std::string_view data, std::size_t limit, LoadProgress* progress) {
  return Inflater(path, data, progress).run(limit);
}

// Half of the machine's memory, at most 8 GiB: a scene beyond that could not be built anyway.
std::size_t inflate_limit(std::size_t bytes) {
  constexpr std::size_t kMost = std::size_t(8) << 30, kAlways = std::size_t(1) << 28, kTimes = 64;
  const std::size_t most = std::min(kMost, bytes < kMost / kTimes ? kAlways + kTimes * bytes : kMost);
  const long pages = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGE_SIZE);
  if (pages <= 0 || page_size <= 0) return most;
  return std::min(most, std::size_t(pages) / 2 * std::size_t(page_size));
}

std::string load_file(const std::string& path, LoadProgress* progress, bool pipe_too) {
  std::string bytes = read_bytes(path, progress, pipe_too);
  if (!is_gzip(bytes)) return bytes;
  if (progress) progress->expect(kInflating * double(bytes.size()));
  std::string inflated = inflate_gzip(path, bytes, inflate_limit(bytes.size()), progress);
  if (progress) progress->expect(kParsing * (double(inflated.size()) - double(bytes.size())));
  return inflated;
}

}  // namespace grelha
