#include "tests/frontend/jobs/job.hpp"

#include <cstring>
#include <sstream>

#include "frontend/nff/nff_reader.hpp"
#include "scenes/generators.hpp"

namespace grelha::test {
namespace {

void apply(char effect, Job& job) {
  switch (effect) {
    case 'l':
      job.file.camera.aperture = .1;
      job.file.camera.focus = 3;
      break;
    case 'a':
      for (Light& l : job.file.scene.lights) {
        l.edge1 = {1, 0, 0};
        l.edge2 = {0, 1, .5f};
      }
      break;
    case 'n':
      job.options.sampling.glossy_rays = 3;
      [[fallthrough]];
    case 'g':
      for (Material& m : job.file.scene.materials)
        m.roughness = .2f;
      break;
    case 'j':
      job.options.sampling.sampler = Sampler::kJitter;
      break;
    case 'r':
      job.options.sampling.sampler = Sampler::kRandom;
      break;
    case 'b':
      job.options.sampling.sampler = Sampler::kBlue;
      break;
  }
}

}  // namespace

Job make_job(const Case& c) {
  std::ostringstream text;
  scenes::find_generator(c.scene)->write(text, {2, false, ""});
  Job job{read_nff(c.scene, text.str(), [](const std::string&) {}), {}};
  job.options.sampling.samples = c.samples;
  job.options.sampling.seed = 3;
  Camera& camera = job.file.camera;
  camera.width = 37;
  camera.height = 29;  // no multiple of tile, piece, packet or register
  for (const char* e = c.effects; *e; ++e)
    apply(*e, job);
  return job;
}

bool same_bits(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height &&
         std::memcmp(a.rgb.data(), b.rgb.data(), a.rgb.size() * sizeof(float)) == 0;
}

}  // namespace grelha::test
