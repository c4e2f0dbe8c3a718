#pragma once

#include <fstream>
#include <string>

namespace grelha {

/// The name that stands for stdout, as in other tools.
inline constexpr const char* kStdout = "-";

/// A file that appears whole or not at all: written beside its place under another name, then
/// renamed onto it, with the mode of the file it replaces. A symbolic link stays, also one to
/// nothing yet. What is not a regular file (/dev/stdout, a pipe) is written directly, for renaming
/// would replace it. Every failure is a FileError that names `path`.
///
/// A durable one is on the disk when commit() returns, so that a machine that stops a moment later
/// finds the old file or the new one. It must be a regular file.
class AtomicFile {
 public:
  /// `path`: kStdout is none, then stdout is written.
  explicit AtomicFile(const std::string& path, bool durable = false);
  ~AtomicFile();  ///< without commit() nothing is left behind
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ostream& stream();
  void commit();

 private:
  void create_beside();
  bool is_stdout() const { return path_ == kStdout; }

  std::string path_, target_, beside_;  ///< beside_ is empty when written directly
  bool durable_;
  int lock_ = -1;  ///< of what stands under beside_
  std::ofstream stream_;
};

/// The name of a file in messages: its own, or stdout.
std::string name_of_file(const std::string& path);

void write_file(const std::string& path, const std::string& bytes);

/// Throws now what writing would throw later, as far as that can be known: better before a long
/// render than after.
void check_writable(const std::string& path, bool durable = false);

}  // namespace grelha
