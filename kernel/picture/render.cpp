#include "grelha/render.hpp"

#include "kernel/picture/picture.hpp"
#include "kernel/shade/strips.hpp"
#include "kernel/shade/workspace.hpp"

namespace grelha {

std::vector<Isa> isas() {
  std::vector<Isa> out;
  for (const std::string_view name : {"scalar", "sse2", "avx2", "avx512", "neon"}) {
    const Variant* const v = find_variant(name);
    out.push_back({name, v != nullptr, v != nullptr && v->is_supported()});
  }
  return out;
}

Image render(const World& world,
             const Camera& camera,
             const RenderOptions& options,
             RenderStats& stats,
             SampleMaps* maps) {
  Picture picture(camera, options);
  picture.advance(world, camera, options, stats, maps);
  return picture.image();
}

std::uint64_t thread_bytes(const Camera& camera, const RenderOptions& options) {
  const auto strips = static_cast<std::size_t>((camera.height + kStripRows - 1) / kStripRows);
  const std::size_t sums = static_cast<std::size_t>(camera.width) * kStripRows;
  const auto threads = static_cast<std::uint64_t>(thread_count(options, strips));
  return threads * Workspace::bytes(sums, options.depth, options.sampling.glossy_rays);
}

}  // namespace grelha
