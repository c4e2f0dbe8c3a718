// Fuzzes .grelha files. The input is one file or several, each from "grelha partial" to the next.
// Each file is tested unchanged and with corrected checksums, which a mutation would not produce. A
// file that can be read is written, read and written again, which must give the same bytes; if its
// picture is small, rendering is resumed from it. Then the files are merged.
#include <vector>

#include "frontend/commands/commands.hpp"
#include "frontend/files/digest.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/jobs/checkpoint.hpp"
#include "frontend/jobs/merge.hpp"
#include "kernel/picture/picture.hpp"
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
    if (end == std::string_view::npos)
      break;
    bytes.remove_prefix(end);
  }
  return pieces;
}

/// The last eight bytes as a writer would have them.
std::string put_right(std::string bytes) {
  if (bytes.size() < kChecksum)
    return bytes;
  Digest digest;
  digest.bytes(bytes.data(), bytes.size() - kChecksum);
  std::uint64_t sum = digest.low64();
  for (std::size_t i = bytes.size() - kChecksum; i < bytes.size(); ++i, sum >>= 8)
    bytes[i] = char(sum & 255);
  return bytes;
}

const World& small_world() {
  static const Scene scene = [] {
    Scene s;
    s.materials.emplace_back().diffuse = {1, 1, 1};
    s.geometry.spheres.add({0, 0, 0}, .5f, 0);
    s.lights.push_back({{1, 2, 3}, {1, 1, 1}, {}, {}});
    return s;
  }();
  static const World world(scene, {});
  return world;
}

constexpr std::uint64_t kMostWork = 4096;       ///< samples of a picture that is gone on with
constexpr std::uint64_t kSamplesOfOthers = 16;  ///< a pixel, where their number is not fixed

/// Options for a picture of this kind.
RenderOptions options_for(const Picture& picture, std::uint64_t pixels) {
  RenderOptions options;
  options.threads = 1;
  if (const Accumulator* const sums = picture.sums())
    options.sampling.samples = sums->samples;
  else if (picture.kind() == kKindOf<Refinement>)
    options.refine.samples = pixels * kSamplesOfOthers;
  else
    options.subdivision = {true, .1f, 2};
  return options;
}

/// Goes on with a picture that is small.
void go_on(Picture& picture) {
  Camera camera;
  camera.width = picture.width();
  camera.height = picture.height();
  const std::uint64_t pixels = std::uint64_t(camera.width) * std::uint64_t(camera.height);
  const RenderOptions options = options_for(picture, pixels);
  const auto samples = picture.sums() ? std::uint64_t(options.sampling.samples) : kSamplesOfOthers;
  if (pixels > kMostWork / samples)
    return;
  RenderStats stats;
  SampleMaps maps;
  picture.advance(small_world(), camera, options, stats, &maps);
}

std::string bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void try_one(const std::string& file, const std::string& bytes) {
  try {
    Checkpoint read = parse_checkpoint("x.grelha", bytes);
    write_checkpoint(file, read.identity, read.picture, false);
    const std::string once = bytes_of(file);
    const Checkpoint again = read_checkpoint(file);
    write_checkpoint(file, again.identity, again.picture, false);
    fuzz::promise(bytes_of(file) == once, "what is written is what was read");
    go_on(read.picture);
  } catch (const FileError&) {
    // a file that is sound by itself, of another picture than the one that goes on
  } catch (const std::invalid_argument&) {
  }
}

void try_merge(const std::vector<std::string>& files) {
  try {
    const Accumulator a = merge_parts(files).sums;
    if (a.part == Part{{0, a.height}, {0, a.samples}})
      picture_so_far(a);
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
    if (files.size() == kMostParts)
      break;
    const std::string again = folder.path() / "again.grelha", right = put_right(piece);
    try_one(again, piece);
    try_one(again, right);
    files.push_back(folder.write(std::to_string(files.size()) + ".grelha", right));
  }
  if (!files.empty())
    try_merge(files);
  return 0;
}
