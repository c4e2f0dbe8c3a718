// Fuzzes .grelha partials: the input is one, or several in a row, each from "grelha partial" to the next. As they are and with their
// checksums put right, which no mutation would: what reads is written again, read again and must be the same, and all of them are merged.
#include <cstring>
#include <vector>

#include "frontend/digest.hpp"
#include "frontend/merge.hpp"
#include "frontend/options.hpp"
#include "frontend/parse_error.hpp"
#include "frontend/partial.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace grelha;

constexpr std::string_view kMagic = "grelha partial";
constexpr std::size_t kChecksum = 8;

std::vector<std::string> pieces_of(std::string_view bytes) {
  std::vector<std::string> pieces;
  while (!bytes.empty()) {
    const std::size_t end = bytes.find(kMagic, 1);
    pieces.emplace_back(bytes.substr(0, end));
    if (end == std::string_view::npos) break;
    bytes.remove_prefix(end);
  }
  return pieces;
}

/// The last eight bytes as a writer would have them.
std::string put_right(std::string bytes) {
  if (bytes.size() < kChecksum) return bytes;
  Digest digest;
  digest.bytes(bytes.data(), bytes.size() - kChecksum);
  std::uint64_t sum = digest.low64();
  for (std::size_t i = bytes.size() - kChecksum; i < bytes.size(); ++i, sum >>= 8) bytes[i] = char(sum & 255);
  return bytes;
}

void try_partial(const std::string& file, const std::string& bytes) {
  try {
    const Partial read = parse_partial("x.grelha", bytes);
    write_partial(file, read);
    const Partial again = read_partial(file);
    fuzz::promise(again.identity == read.identity && again.sums == read.sums, "what is written is what was read");
  } catch (const FileError&) {
  }
}

void try_merge(const std::vector<std::string>& files) {
  try {
    const Accumulator a = merge_parts(files).sums;
    if (a.part == Part{{0, a.height}, {0, a.samples}}) picture_so_far(a);
  } catch (const UsageError&) {
  } catch (const FileError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder;
  constexpr std::size_t kMostParts = 4;
  std::vector<std::string> files;
  for (const std::string& piece : pieces_of(fuzz::text_of(data, size))) {
    if (files.size() == kMostParts) break;
    try_partial(folder.path() / "again.grelha", piece);
    const std::string right = put_right(piece);
    try_partial(folder.path() / "again.grelha", right);
    files.push_back(folder.write(std::to_string(files.size()) + ".grelha", right));
  }
  if (!files.empty()) try_merge(files);
  return 0;
}
