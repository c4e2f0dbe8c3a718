// Fuzzes the command line: a line of the input is a word. Nothing is read but folders and names,
// nothing written.
#include <unistd.h>

#include <vector>

#include "frontend/cli/command_line.hpp"
#include "frontend/commands/outputs.hpp"
#include "frontend/files/parse_error.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace grelha;

/// Some names exist: a folder with scenes, one without, files, a link that leads to itself.
void enter_folder() {
  static const fuzz::Folder folder;
  folder.write("scene.nff", "");
  folder.write("scenes/a.nff", "");
  folder.write("scenes/b.p3f.gz", "");
  folder.write("meshes/a.ply", "");
  folder.write("empty/readme", "");
  std::filesystem::create_symlink("loop", folder.path() / "loop");
  fuzz::promise(chdir(folder.path().c_str()) == 0, "the folder can be entered");
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words{"grelha"};
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    words.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos)
      break;
    text.remove_prefix(end + 1);
  }
  return words;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const bool entered = (enter_folder(), true);
  const std::vector<std::string> words = words_of(fuzz::text_of(data, size));
  std::vector<const char*> argv;
  for (const std::string& word : words)
    argv.push_back(word.c_str());
  argv.push_back(nullptr);
  try {
    const Command command = parse_command(int(words.size()), argv.data());
    if (const auto* render = std::get_if<RenderCommand>(&command))
      for (const RenderCommand& one : commands_for(*render))
        fuzz::promise(!one.image.empty(), "a picture for each scene");
    if (const auto* info = std::get_if<InfoCommand>(&command))
      scene_files(info->scenes);
    if (const auto* text = std::get_if<TextCommand>(&command))
      fuzz::promise(!text->text.empty(), "help says something");
  } catch (const UsageError& error) {
    fuzz::promise(std::string_view(error.what()).find('\n') == std::string_view::npos,
                  "an error is one line");
  } catch (const FileError&) {
  }
  return entered ? 0 : 1;
}
