#pragma once

#include <fstream>
#include <string>

namespace grelha {

/// A file that appears whole or not at all: written beside its place under another name, then renamed onto it. What is
/// not a regular file (/dev/stdout, a pipe) is written directly, for renaming would replace it.
/// Every failure is a FileError that names `path`.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();  ///< without commit() nothing is left behind
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ostream& stream() { return stream_; }
  void commit();

 private:
  std::string path_, target_, beside_;  ///< beside_ is empty when written directly
  std::ofstream stream_;
};

void write_file(const std::string& path, const std::string& bytes);

/// Throws now what writing would throw later, as far as that can be known: better before a long render than after.
void check_writable(const std::string& path);

}  // namespace grelha
