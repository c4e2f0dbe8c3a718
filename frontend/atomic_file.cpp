#include "frontend/atomic_file.hpp"

#include "frontend/parse_error.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace grelha {

namespace {

constexpr int kNamesToTry = 100;

[[noreturn]] void fail(const std::string& path, const char* what, int error) {
  throw FileError(path, std::string(what) + ": " + std::strerror(error));
}

/// The file behind a symbolic link: the link stays, what it points to is replaced.
std::string resolve(const std::string& path) {
  std::error_code error;
  const auto canonical = std::filesystem::canonical(path, error);
  return error ? path : canonical.string();
}

/// Whether something stands at `path` that renaming must not replace.
bool is_special(const std::string& path) {
  struct stat info;
  if (stat(path.c_str(), &info) != 0) {
    if (errno == ENOENT) return false;
    fail(path, "cannot write", errno);
  }
  if (S_ISDIR(info.st_mode)) fail(path, "cannot write", EISDIR);
  return !S_ISREG(info.st_mode);
}

/// Has what was written to a file, or the names in a folder, reach the disk.
void sync(const std::string& path, const std::string& file) {
  const int handle = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (handle < 0) fail(path, "cannot write", errno);
  const int error = fsync(handle) == 0 ? 0 : errno;
  close(handle);
  if (error != 0 && error != EINVAL) fail(path, "cannot write", error);  // EINVAL: nothing that could be synchronised
}

/// Creates an empty file nobody else has, in the same folder so that renaming cannot cross file systems.
std::string create_beside(const std::string& path, const std::string& target) {
  static std::atomic<unsigned> serial{0};
  const auto folder = std::filesystem::path(target).parent_path();
  for (int attempt = 0; attempt < kNamesToTry; ++attempt) {
    const auto name = ".grelha-" + std::to_string(getpid()) + '-' + std::to_string(serial++) + ".tmp";
    const std::string beside = (folder / name).string();
    const int file = open(beside.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (file >= 0) {
      close(file);
      return beside;
    }
    if (errno != EEXIST) fail(path, "cannot write", errno);
  }
  fail(path, "cannot write", EEXIST);
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path, bool durable) : path_(path), target_(resolve(path)), durable_(durable) {
  if (!is_special(target_)) beside_ = durable ? target_ + ".new" : create_beside(path_, target_);
  errno = 0;
  stream_.open(beside_.empty() ? target_ : beside_, std::ios::binary);
  if (!stream_) fail(path_, "cannot write", errno);
}

AtomicFile::~AtomicFile() {
  if (!beside_.empty()) unlink(beside_.c_str());
}

void AtomicFile::commit() {
  if (stream_) errno = 0;  // else it tells why an earlier write failed
  stream_.flush();
  const int error = errno ? errno : EIO;
  stream_.close();
  if (!stream_) fail(path_, "cannot write", error);
  if (beside_.empty()) return;
  if (durable_) sync(path_, beside_);
  if (std::rename(beside_.c_str(), target_.c_str()) != 0) fail(path_, "cannot write", errno);
  beside_.clear();
  const std::string folder = std::filesystem::path(target_).parent_path().string();
  if (durable_) sync(path_, folder.empty() ? "." : folder);
}

void write_file(const std::string& path, const std::string& bytes) {
  AtomicFile file(path);
  file.stream().write(bytes.data(), std::streamsize(bytes.size()));
  file.commit();
}

void check_writable(const std::string& path) { AtomicFile probe(path); }

}  // namespace grelha
