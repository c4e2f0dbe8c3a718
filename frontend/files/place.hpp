#pragma once

#include <compare>
#include <cstdint>
#include <string>

namespace grelha {

/// Where a name leads to, whatever it is written like: ./, links of both kinds. Equal places are
/// one file, there or yet to be written.
struct Place {
  /// of the file or, where there is none, of the folder it would lie in
  std::uint64_t device = 0, inode = 0;
  /// the last of the name where there is no file; all of it where there is no folder either
  std::string name;
  auto operator<=>(const Place&) const = default;
};

Place place_of(const std::string& path);

/// The name behind symbolic links, also those to a file that is not there yet.
std::string behind_links(const std::string& path);

/// Returns whether something is there that is written to directly and cannot be lost, such as
/// /dev/null or a pipe.
bool is_special_file(const std::string& path);

}  // namespace grelha
