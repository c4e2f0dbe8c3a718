#include "frontend/files/load_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>

#include "frontend/files/load_progress.hpp"
#include "frontend/files/other_formats.hpp"
#include "frontend/files/parse_error.hpp"

namespace grelha {
namespace {

constexpr double kInflating = 10;  ///< times as long as reading

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

using File = std::unique_ptr<std::FILE, CloseFile>;

bool is_gzip(std::string_view data) {
  return data.size() >= 2 && static_cast<unsigned char>(data[0]) == 0x1f &&
         static_cast<unsigned char>(data[1]) == 0x8b;
}

/// A buffer that grows with the bytes that arrive, a piece at a time, whatever size was promised.
class Growing {
 public:
  Growing(const Validate& validate, std::size_t promised) : validate_(validate) {
    bytes_.reserve(promised);
  }

  /// Space for up to `most` bytes more; at least one, unless `most` is none.
  std::span<char> space(std::size_t most) {
    if (have_ == bytes_.size())
      bytes_.resize(have_ + std::min(most, std::clamp(have_, kLeast, kMostAtOnce)));
    return {bytes_.data() + have_, std::min(most, bytes_.size() - have_)};
  }
  /// So many bytes of the space were filled.
  void filled(std::size_t count) {
    have_ += count;
    if (have_ - validated_ >= kPart)
      validate();
  }
  std::size_t size() const { return have_; }
  std::string finish() {
    if (have_ > validated_)
      validate();
    bytes_.resize(have_);
    return std::move(bytes_);
  }

 private:
  static constexpr std::size_t kLeast = std::size_t(1) << 16;
  /// the cleared memory is still in the cache when the bytes arrive
  static constexpr std::size_t kMostAtOnce = std::size_t(1) << 18;

  void validate() {
    const std::string_view all(bytes_.data(), have_);
    if (validate_ && !is_gzip(all))
      validate_(all, validated_);
    validated_ = have_;
  }

  const Validate& validate_;
  std::string bytes_;
  std::size_t have_ = 0, validated_ = 0;
};

/// Reads a pipe to its end, which may never come: checks for a stop every kLookUp milliseconds.
std::string read_pipe(const std::string& path, LoadProgress* progress, const Validate& validate) {
  constexpr int kLookUp = 100;  // ms
  const int handle = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (handle < 0)
    throw FileError(path, std::string("cannot open: ") + std::strerror(errno));
  const File file(fdopen(handle, "rb"));
  Growing bytes(validate, 0);
  for (;;) {
    if (pollfd asked{handle, POLLIN, 0}; poll(&asked, 1, kLookUp) <= 0) {
      if (progress)
        progress->waiting();
      continue;
    }
    const std::span<char> space = bytes.space(kPart);
    const ssize_t got = read(handle, space.data(), space.size());
    if (got < 0 && errno != EAGAIN && errno != EINTR)
      throw FileError(path, std::string("cannot read: ") + std::strerror(errno));
    if (got == 0)
      break;
    bytes.filled(std::size_t(std::max<ssize_t>(got, 0)));
  }
  if (progress)
    progress->expect(kParsing * double(bytes.size()));
  return bytes.finish();
}

std::string read_bytes(const std::string& path,
                       LoadProgress* progress,
                       bool pipe_too,
                       const Validate& validate) {
  struct stat about {};
  if (stat(path.c_str(), &about) != 0)
    throw FileError(path, std::string("cannot open: ") + std::strerror(errno));
  if (S_ISDIR(about.st_mode))
    throw FileError(path, std::string("cannot read: ") + std::strerror(EISDIR));
  if (pipe_too && S_ISFIFO(about.st_mode))
    return read_pipe(path, progress, validate);
  if (!S_ISREG(about.st_mode))
    throw FileError(path, "cannot read: not a regular file");
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file)
    throw FileError(path, std::string("cannot open: ") + std::strerror(errno));
  const auto promised = std::size_t(about.st_size);
  if (progress)
    progress->expect((1 + kParsing) * double(promised));
  Growing bytes(validate, promised);
  for (std::size_t got = 1; got > 0 && bytes.size() < promised;) {
    const std::span<char> space = bytes.space(promised - bytes.size());
    got = std::fread(space.data(), 1, space.size(), file.get());
    bytes.filled(got);
    if (progress)
      progress->done(double(got));
  }
  if (std::ferror(file.get()))
    throw FileError(path, std::string("cannot read: ") + std::strerror(errno));
  return bytes.finish();
}

/// Owns zlib's state. Feeds it 16 MiB at a time, because its counters have 32 bits, and reports
/// progress after each piece.
class Inflater {
 public:
  Inflater(const std::string& path, std::string_view data, LoadProgress* progress)
      : path_(path), data_(data), progress_(progress) {
    if (inflateInit2(&stream_, 15 + 16) != Z_OK)
      throw std::bad_alloc();
  }
  Inflater(const Inflater&) = delete;
  ~Inflater() { inflateEnd(&stream_); }

  std::string run(std::size_t limit, const Validate& validate) {
    Growing out(validate, std::min(limit, 4 * data_.size()));
    while (!step(out, limit)) {
    }
    return out.finish();
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw ParseError(Position{path_, 0, 0, consumed_}, message);
  }

  /// One call of inflate; true when the last member has ended.
  bool step(Growing& out, std::size_t limit) {
    const std::size_t give = std::min(kPart, data_.size() - consumed_);
    const std::span<char> space = out.space(limit - out.size());
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data_.data() + consumed_));
    stream_.avail_in = uInt(give);
    char beyond = 0;  // with no space left the end may still come
    stream_.next_out = reinterpret_cast<Bytef*>(space.empty() ? &beyond : space.data());
    stream_.avail_out = space.empty() ? 1 : uInt(space.size());
    const int result = inflate(&stream_, Z_NO_FLUSH);
    consumed_ += give - stream_.avail_in;
    if (space.empty() && stream_.avail_out == 0)
      fail("expected data that inflate to at most " + std::to_string(limit) + " bytes, found more");
    if (!space.empty())
      out.filled(space.size() - stream_.avail_out);
    if (progress_)
      progress_->done(kInflating * double(give - stream_.avail_in));
    if (result == Z_STREAM_END) {
      // bytes behind the last member are ignored, as gzip does
      if (!is_gzip(data_.substr(consumed_)))
        return true;
      inflateReset(&stream_);
      return false;
    }
    if (result == Z_MEM_ERROR)
      throw std::bad_alloc();
    if (result != Z_OK && result != Z_BUF_ERROR)
      fail(std::string("expected sound gzip data, found ") +
           (stream_.msg ? stream_.msg : "broken ones"));
    if (consumed_ == data_.size() && stream_.avail_out != 0)
      fail("expected more gzip data, found end of file");
    return false;
  }

  const std::string& path_;
  std::string_view data_;
  LoadProgress* progress_;
  std::size_t consumed_ = 0;
  z_stream stream_{};
};

}  // namespace

std::string inflate_gzip(const std::string& path,
                         std::string_view data,
                         std::size_t limit,
                         LoadProgress* progress,
                         const Validate& validate) {
  return Inflater(path, data, progress).run(limit, validate);
}

// Half of the machine's memory, at most 8 GiB: a scene beyond that could not be built anyway.
std::size_t inflate_limit(std::size_t bytes) {
  constexpr std::size_t kMost = std::size_t(8) << 30, kAlways = std::size_t(1) << 28, kTimes = 64;
  const std::size_t most =
      std::min(kMost, bytes < kMost / kTimes ? kAlways + kTimes * bytes : kMost);
  const long pages = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGE_SIZE);
  if (pages <= 0 || page_size <= 0)
    return most;
  return std::min(most, std::size_t(pages) / 2 * std::size_t(page_size));
}

std::string load_file(const std::string& path,
                      LoadProgress* progress,
                      bool pipe_too,
                      const Validate& validate) {
  std::string bytes = read_bytes(path, progress, pipe_too, validate);
  if (!is_gzip(bytes))
    return bytes;
  if (progress)
    progress->expect(kInflating * double(bytes.size()));
  std::string inflated = inflate_gzip(path, bytes, inflate_limit(bytes.size()), progress, validate);
  if (progress)
    progress->expect(kParsing * (double(inflated.size()) - double(bytes.size())));
  return inflated;
}

}  // namespace grelha
