#pragma once

#include <compare>
#include <cstdint>
#include <string>

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

}  // namespace grelha
