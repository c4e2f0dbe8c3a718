// Fuzzes STL: the bytes are a mesh, binary or text, shown as one is that comes with no scene.
#include "frontend/input/read_scene.hpp"
#include "frontend/files/parse_error.hpp"
#include "tests/fuzz/render_small.hpp"
#include "tests/fuzz/target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace grelha;
  static const fuzz::Folder folder;
  const std::string_view bytes = fuzz::text_of(data, size);
  const std::string mesh = folder.write("mesh.stl", bytes);
  const auto one_line = [](const std::string& line) {
    fuzz::promise(line.find('\n') == std::string::npos, "a message is one line");
  };
  SceneFile file;
  try {
    file = read_scene(mesh, one_line);
  } catch (const ParseError& error) {
    return one_line(error.what()), 0;
  } catch (const FileError& error) {
    return one_line(error.what()), 0;
  }
  fuzz::render_small(std::move(file), fuzz::Choices(bytes));
  return 0;
}
