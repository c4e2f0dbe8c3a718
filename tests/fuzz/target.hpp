#pragma once
// What the fuzz targets share. A target is LLVMFuzzerTestOneInput() in a file of its own: libFuzzer
// calls it with bytes it makes up, tests/fuzz/replay.cpp with those of tests/fuzz/corpus. Errors
// that a file or a command line may cause end it in peace; anything else that is thrown, any
// signal, any report of a sanitizer and any promise found broken is a fault.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace grelha::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

inline void promise(bool kept, const std::string& what) {
  if (kept)
    return;
  std::fprintf(stderr, "broken promise: %s\n", what.c_str());
  std::abort();
}

/// Choices that are not in the file itself, from its bytes, so that the same file always takes the
/// same ones (FNV-1a).
class Choices {
 public:
  explicit Choices(std::string_view bytes) {
    for (const char c : bytes)
      state_ = (state_ ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  }
  /// From 0 to n - 1.
  std::size_t below(std::size_t n) {
    state_ = (state_ ^ state_ >> 29) * 0x9E3779B97F4A7C15u + 1;
    return std::size_t(state_ >> 33) % n;
  }
  template <class T, std::size_t N>
  const T& of(const T (&all)[N]) {
    return all[below(N)];
  }

 private:
  std::uint64_t state_ = 0xCBF29CE484222325u;
};

/// A folder in memory where there is such a thing; it goes when the process ends in peace.
class Folder {
 public:
  Folder() {
    const std::filesystem::path shared = "/dev/shm";
    std::error_code none;
    const bool in_memory = std::filesystem::is_directory(shared, none);
    std::string name =
        ((in_memory ? shared : std::filesystem::temp_directory_path()) / "grelha-fuzz-XXXXXX")
            .string();
    promise(mkdtemp(name.data()) != nullptr, "a folder to work in");
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;

  std::string write(const std::string& name, std::string_view bytes) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
    return file.string();
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace grelha::fuzz
