#include "frontend/files/atomic_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>

#include <fcntl.h>
#include <unistd.h>
#include <sys/file.h>
#include <sys/stat.h>

namespace grelha {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;  // as many as Linux follows

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

}  // namespace

std::string resolve_links(const std::string& path) {
  std::error_code error;
  fs::path at = fs::canonical(path, error);
  if (!error)
    return at.string();
  at = path;
  for (int i = 0; i < kMostLinks && fs::is_symlink(fs::symlink_status(at, error)); ++i) {
    const fs::path to = fs::read_symlink(at, error);
    // there, but by no name: what /dev/stdout leads to may be a pipe
    if (error || fs::exists(at, error))
      return path;
    at = to.is_absolute() ? to : folder_of(at) / to;
  }
  return at.string();
}

Location location_of(const std::string& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) == 0)
    return {info.st_dev, info.st_ino, ""};
  const fs::path target = resolve_links(path);
  if (stat(folder_of(target).c_str(), &info) == 0)
    return {info.st_dev, info.st_ino, target.filename().string()};
  std::error_code ignored;
  return {0, 0, fs::absolute(target, ignored).lexically_normal().string()};
}

bool is_special_file(const std::string& path) {
  struct stat info {};
  return stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

namespace {

constexpr int kNamesToTry = 100;
// bytes of the target's name in the temporary name: file systems limit names to 255 bytes
constexpr std::size_t kLongestSaved = 200;

[[noreturn]] void fail(const std::string& path, const std::string& what, int error) {
  throw FileError(path, what + ": " + std::strerror(error));
}

/// Sends what is left for stdout. An earlier write that failed has left its error.
void flush_stdout() {
  std::cout << std::flush;
  if (std::cout)
    return;
  if (errno == EPIPE)
    throw ReaderGone("stdout", std::string("cannot write: ") + std::strerror(EPIPE));
  fail("stdout", "cannot write", errno ? errno : EIO);
}

/// Returns true if renaming must not replace the file at `path`. A rename would replace even a file
/// that cannot be written.
bool is_special(const std::string& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) {
    if (errno == ENOENT)
      return false;
    fail(path, "cannot write", errno);
  }
  if (S_ISDIR(info.st_mode))
    fail(path, "cannot write", EISDIR);
  if (access(path.c_str(), W_OK) != 0)
    fail(path, "cannot write", errno);
  return !S_ISREG(info.st_mode);
}

/// Flushes the data of a file, or the names in a folder, to the disk.
void sync(const std::string& path, const std::string& file) {
  const int handle = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (handle < 0)
    fail(path, "cannot write", errno);
  const int error = fsync(handle) == 0 ? 0 : errno;
  close(handle);
  // EINVAL: nothing that could be synchronised
  if (error != 0 && error != EINVAL)
    fail(path, "cannot write", error);
}

/// Returns true if an open file is a regular file and still has this name: its previous writer may
/// have renamed it.
bool exists_at(int file, const std::string& name) {
  using Stat = struct stat;
  Stat opened{}, there{};
  return fstat(file, &opened) == 0 && S_ISREG(opened.st_mode) && stat(name.c_str(), &there) == 0 &&
         opened.st_dev == there.st_dev && opened.st_ino == there.st_ino;
}

bool path_exists(const std::string& name) {
  struct stat info {};
  return lstat(name.c_str(), &info) == 0;
}

/// Gives a file the mode of the one that it replaces.
void take_mode(int file, const std::string& from) {
  struct stat info {};
  if (stat(from.c_str(), &info) == 0)
    fchmod(file, info.st_mode & 07777);
}

}  // namespace

/// Creates a file in the same folder, so that renaming cannot cross file systems. Its name derives
/// from the target's, so that it replaces the file that a killed program left. The writing process
/// holds a lock, which dies with it; another writer of the same target takes the next name.
void AtomicFile::create_temp() {
  const CreatesFile creates;
  const auto target = std::filesystem::path(target_);
  const std::string name = target.filename().string().substr(0, kLongestSaved);
  for (int attempt = 0; attempt < kNamesToTry; ++attempt) {
    const std::string temp = (target.parent_path() / ('.' + name + ".grelha-tmp" +
                                                      (attempt > 0 ? std::to_string(attempt) : "")))
                                 .string();
    lock_ = open(temp.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    const int error = errno;
    if (lock_ < 0 && path_exists(temp))
      continue;  // someone else's, or no file
    if (lock_ < 0)
      fail(path_, "cannot write", error);
    // no locks here: then one program at a time
    const bool locked = flock(lock_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
    if (locked && exists_at(lock_, temp)) {
      temp_ = temp;
      unfinished_.emplace(temp_.c_str());
      return take_mode(lock_, target_);
    }
    close(lock_);
    lock_ = -1;
  }
  fail(path_, "cannot write", EEXIST);
}

AtomicFile::AtomicFile(const std::string& path, bool durable)
    : path_(path), target_(path == kStdout ? path : resolve_links(path)), durable_(durable) {
  errno = 0;
  if (is_stdout())
    return;
  const bool special = is_special(target_);
  if (durable && special)
    throw FileError(path, "cannot write: not a regular file");
  if (!special)
    create_temp();
  errno = 0;
  stream_.open(temp_.empty() ? target_ : temp_, std::ios::binary);
  if (!stream_)
    fail(path_, "cannot write", errno);
}

AtomicFile::~AtomicFile() {
  if (!temp_.empty())
    unlink(temp_.c_str());
  if (lock_ >= 0)
    close(lock_);
}

std::ostream& AtomicFile::stream() {
  return is_stdout() ? std::cout : stream_;
}

void AtomicFile::commit() {
  if (is_stdout())
    return flush_stdout();
  if (stream_)
    errno = 0;  // else it tells why an earlier write failed
  stream_.flush();
  const int error = errno ? errno : EIO;
  stream_.close();
  if (!stream_)
    fail(path_, "cannot write", error);
  if (temp_.empty())
    return;
  if (durable_)
    sync(path_, temp_);
  if (std::rename(temp_.c_str(), target_.c_str()) != 0)
    fail(path_, "cannot write", errno);
  unfinished_.reset();
  temp_.clear();
  const std::string folder = std::filesystem::path(target_).parent_path().string();
  if (durable_)
    sync(path_, folder.empty() ? "." : folder);
}

std::string name_of_file(const std::string& path) {
  return path == kStdout ? "stdout" : path;
}

void write_file(const std::string& path, const std::string& bytes) {
  AtomicFile file(path);
  file.stream().write(bytes.data(), std::streamsize(bytes.size()));
  file.commit();
}

void check_writable(const std::string& path, bool durable) {
  // opening a pipe waits for a reader, and closing it ends that reader
  if (path != kStdout && (durable || !is_special(path)))
    AtomicFile probe(path, durable);
}

}  // namespace grelha
