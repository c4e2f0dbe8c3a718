#pragma once
// Scenes from text in the test itself, with the warnings they caused.

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "frontend/files/parse_error.hpp"
#include "frontend/nff/nff_reader.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha::test {

/// The header of a PLY file of three vertices and two faces.
inline const std::string kAsciiTriangle =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 2\nproperty list uchar int vertex_indices\nend_header\n";

inline const std::string kView =
    "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 8 6\n";

inline const std::string kFill = "f 1 .5 0 .8 .2 10 0 1\n";

struct Reading {
  SceneFile file;
  std::vector<std::string> warnings;
};

/// `text` as scene.nff.
inline Reading read_text(std::string_view text) {
  Reading result;
  result.file = read_nff(
      "scene.nff", text, [&](const std::string& line) { result.warnings.push_back(line); });
  return result;
}
/// The same behind a view of seven lines: the text's first line is line 8.
inline Reading read_with_view(std::string_view text) {
  return read_text(kView + std::string(text));
}

/// Returns the message of the exception that `read` throws, or "" if it throws none.
template <class Read>
std::string message_of(Read&& read) {
  try {
    read();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

/// A folder of its own that is gone at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "grelha-test-XXXXXX").string();
    if (mkdtemp(name.data()))
      path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  std::string add(const std::string& name, std::string_view bytes) const {
    const std::string file = (path_ / name).string();
    std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
    return file;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace grelha::test
