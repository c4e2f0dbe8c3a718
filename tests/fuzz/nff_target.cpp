// Fuzzes NFF: the bytes are a scene in a folder with meshes, links that lead out of it and links
// that lead nowhere.
#include <sstream>

#include "frontend/input/read_scene.hpp"
#include "frontend/files/parse_error.hpp"
#include "tests/fuzz/render_small.hpp"
#include "tests/fuzz/target.hpp"
#include "tests/fuzz/watched_files.hpp"

namespace {

using namespace grelha;

/// A sheet of n x n squares over [-1, 1]^2, wavy.
std::string sheet(int n, bool smooth) {
  std::ostringstream out;
  out << "ply\nformat ascii 1.0\nelement vertex " << (n + 1) * (n + 1)
      << "\nproperty float x\nproperty float y\nproperty float z\n";
  if (smooth)
    out << "property float nx\nproperty float ny\nproperty float nz\n";
  out << "element face " << n * n << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      out << 2. * i / n - 1 << ' ' << 2. * j / n - 1 << ' ' << (i * 7 + j * 5) % 4 * .1
          << (smooth ? " 0 0 1\n" : "\n");
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      out << "4 " << a << ' ' << a + 1 << ' ' << a + n + 2 << ' ' << a + n + 1 << '\n';
    }
  return out.str();
}

void furnish(const fuzz::Folder& folder) {
  folder.write("home/a.ply", sheet(2, false));
  folder.write("home/b.ply", sheet(2, true));
  folder.write("home/large.ply", sheet(12, false));  // enough triangles for a grid of its own
  folder.write("home/empty.ply", "");
  folder.write("home/broken.ply", sheet(2, false).substr(0, 200));
  folder.write("home/sub/c.ply", sheet(1, true));
  folder.write("outside.ply", sheet(1, false));
  folder.write("home2/d.ply", sheet(1, false));
  const std::filesystem::path home = folder.path() / "home";
  std::filesystem::create_symlink("../outside.ply", home / "out.ply");
  std::filesystem::create_symlink("..", home / "up");
  std::filesystem::create_symlink("a.ply", home / "in.ply");
  std::filesystem::create_symlink("loop.ply", home / "loop.ply");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder;
  static const bool furnished = (furnish(folder), true);
  const std::string_view bytes = fuzz::text_of(data, size);
  const std::string scene = folder.write("home/scene.nff", bytes);
  const auto one_line = [](const std::string& line) {
    fuzz::promise(line.find('\n') == std::string::npos, "a message is one line");
  };
  SceneFile file;
  try {
    const fuzz::WatchedFiles watched(folder.path() / "home");
    file = read_scene(scene, one_line);
  } catch (const ParseError& error) {
    return one_line(error.what()), 0;
  } catch (const FileError& error) {
    return one_line(error.what()), 0;
  }
  fuzz::render_small(std::move(file), fuzz::Choices(bytes));
  return furnished ? 0 : 1;
}
