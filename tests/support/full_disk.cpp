// Preloaded into the program (LD_PRELOAD): files in folders called "full" do not grow, as on a full
// disk. Their existing bytes can be overwritten.
#include <dlfcn.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <string_view>

namespace {

bool is_full(int file, std::size_t bytes) {
  struct stat about {};
  if (fstat(file, &about) != 0 || !S_ISREG(about.st_mode))
    return false;
  char path[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(file);
  const ssize_t length = readlink(link.c_str(), path, sizeof path);
  if (std::string_view(path, length > 0 ? std::size_t(length) : 0).find("/full/") ==
      std::string_view::npos)
    return false;
  return lseek(file, 0, SEEK_CUR) + off_t(bytes) > about.st_size;
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" ssize_t write(int file, const void* bytes, std::size_t count) {
  if (is_full(file, count)) {
    errno = ENOSPC;
    return -1;
  }
  return next<ssize_t (*)(int, const void*, std::size_t)>("write")(file, bytes, count);
}

extern "C" ssize_t writev(int file, const iovec* parts, int count) {
  std::size_t bytes = 0;
  for (int i = 0; i < count; ++i)
    bytes += parts[i].iov_len;
  if (is_full(file, bytes)) {
    errno = ENOSPC;
    return -1;
  }
  return next<ssize_t (*)(int, const iovec*, int)>("writev")(file, parts, count);
}
