#pragma once

#include <compare>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

#include "frontend/files/parse_error.hpp"
#include "frontend/files/unfinished.hpp"

namespace grelha {

/// The file that a name leads to, however it is written: with ./, symbolic or hard links. Equal
/// locations are one file, existing or not.
struct Location {
  /// of the file or, if it does not exist, of its folder
  std::uint64_t device = 0, inode = 0;
  /// the last part of the name if the file does not exist; the whole name if its folder does not
  /// exist
  std::string name;
  auto operator<=>(const Location&) const = default;
};

Location location_of(const std::string& path);

/// The name behind symbolic links, also those to a file that is not there yet.
std::string resolve_links(const std::string& path);

/// Returns true if the path is written to directly and cannot be lost, such as /dev/null or a pipe.
bool is_special_file(const std::string& path);

/// The name that stands for stdout, as in other tools.
inline constexpr const char* kStdout = "-";

/// A file that appears whole or not at all. It is written under a temporary name in the same
/// folder, then renamed, with the mode of the file it replaces. A symbolic link stays, even a
/// dangling one. A target that is not a regular file (/dev/stdout, a pipe) is written directly,
/// because renaming would replace it. Every failure throws a FileError that names `path`.
///
/// A durable file is on the disk when commit() returns: a crash a moment later leaves the old file
/// or the new one. It must be a regular file.
class AtomicFile {
 public:
  /// `path`: kStdout writes to stdout.
  explicit AtomicFile(const std::string& path, bool durable = false);
  ~AtomicFile();  ///< without commit() nothing is left behind
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ostream& stream();
  void commit();

 private:
  void create_temp();
  bool is_stdout() const { return path_ == kStdout; }

  std::string path_, target_, temp_;      ///< temp_ is empty when written directly
  std::optional<Unfinished> unfinished_;  ///< temp_
  bool durable_;
  int lock_ = -1;  ///< on the file named temp_
  std::ofstream stream_;
};

/// Whoever read from stdout has closed it.
struct ReaderGone : FileError {
  using FileError::FileError;
};

/// Returns the name of a file for messages: its own, or stdout.
std::string name_of_file(const std::string& path);

void write_file(const std::string& path, const std::string& bytes);

/// Throws now the errors that writing would throw later, as far as they can be known before a long
/// render.
void check_writable(const std::string& path, bool durable = false);

}  // namespace grelha
