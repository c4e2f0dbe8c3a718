// Runs a fuzz target on files, with any compiler: replay_NAME FILE-OR-FOLDER... A fault ends the
// process, and the last name it printed is the file. Each has ten seconds (sanitizers make it slow)
// and a gibibyte.
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "frontend/files/memory_limit.hpp"
#include "tests/fuzz/target.hpp"

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(int argc, char** argv) {
  std::vector<fs::path> files;
  for (int i = 1; i < argc; ++i) {
    if (!fs::is_directory(argv[i]))
      files.emplace_back(argv[i]);
    else
      for (const auto& entry : fs::recursive_directory_iterator(argv[i]))
        files.push_back(entry.path());
  }
  std::erase_if(files, [](const fs::path& p) { return !fs::is_regular_file(p); });
  for (fs::path& file : files)
    file = fs::absolute(file);  // a target may change the folder
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr unsigned kSeconds = 10;
  const std::vector<fs::path> files = files_of(argc, argv);
  grelha::limit_memory(std::uint64_t{1} << 30);
  for (const fs::path& file : files) {
    std::printf("%s\n", file.c_str());
    std::fflush(stdout);
    std::ifstream in(file, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    alarm(kSeconds);
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    alarm(0);
  }
  std::printf("%zu files\n", files.size());
  return files.empty() ? 1 : 0;
}
