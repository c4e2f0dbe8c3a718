// Three programs as a user writes them, by Grelha and by Embree (robust), one thread, taking turns:
// ambient occlusion of a mesh, picking, and a path tracer of one ray a call. Times are whole: of
// the mesh's arrays to answers.
//
// programs [--mesh FILE]... [--rounds N]
//
// Prints CSV: mesh, faces, program, seconds of Grelha and of Embree (least of the rounds), and the
// share of answers in which both agree.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "frontend/input/read_scene.hpp"
#include "perf/programs/programs.hpp"
#include "perf/workloads.hpp"

namespace {

using namespace grelha;
using namespace grelha::perf;

constexpr std::size_t kClicks = 10'000;

template <class Answer>
using Program = std::function<std::vector<Answer>()>;

template <class Answer>
double seconds(const Program<Answer>& program, std::vector<Answer>& answers) {
  const auto start = std::chrono::steady_clock::now();
  answers = program();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The triangles of a file, scaled to a box of 1: both libraries get the same floats.
Mesh mesh_of(const Triangles& t) {
  Float3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
  for (std::size_t i = 0; i < t.vertex_count(); ++i) {
    low = {std::min(low.x, t.x[i]), std::min(low.y, t.y[i]), std::min(low.z, t.z[i])};
    high = {std::max(high.x, t.x[i]), std::max(high.y, t.y[i]), std::max(high.z, t.z[i])};
  }
  const Float3 size = high - low;
  const float scale = 1 / std::max({size.x, size.y, size.z});
  Mesh mesh;
  for (std::size_t i = 0; i < t.vertex_count(); ++i)
    mesh.vertices.push_back(scale * (Float3{t.x[i], t.y[i], t.z[i]} - low));
  for (std::size_t i = 0; i < t.size(); ++i)
    mesh.faces.push_back({t.a[i], t.b[i], t.c[i]});
  return mesh;
}

/// Looks at the box of 1 from the side.
View view_of(std::size_t size) {
  const float step = 1.2f / static_cast<float>(size);
  return {{.5f, .5f, 3}, {-.6f, .6f, -2.5f}, {step, 0, 0}, {0, -step, 0}, size, size};
}

/// Runs a program by both libraries, in turns.
template <class Answer, class Same>
void compare(const std::string& name,
             int rounds,
             const Program<Answer>& grelha,
             const Program<Answer>& embree,
             const Same& same) {
  double own = 1e300, other = 1e300;
  std::vector<Answer> mine, theirs;
  for (int i = 0; i < rounds; ++i) {
    own = std::min(own, seconds(grelha, mine));
    if (embree)
      other = std::min(other, seconds(embree, theirs));
  }
  std::size_t agreed = 0;
  for (std::size_t i = 0; i < theirs.size(); ++i)
    agreed += same(mine[i], theirs[i]) ? 1 : 0;
  std::printf("%s,%.4f,", name.c_str(), own);
  if (embree)
    std::printf(
        "%.4f,%.5f\n", other, static_cast<double>(agreed) / static_cast<double>(mine.size()));
  else
    std::printf(",\n");
  std::fflush(stdout);
}

void run(const std::string& file, int rounds) {
  const Mesh mesh = mesh_of(scene_named(file).scene.geometry.triangles);
  const View view = view_of(256);
  const std::string head =
      std::filesystem::path(file).stem().string() + "," + std::to_string(mesh.faces.size()) + ",";
  Program<float> open, paths;
  Program<Picked> picks;
#ifdef GRELHA_EMBREE
  open = [&] { return by_embree::ambient_occlusion(mesh); };
  picks = [&] { return by_embree::pick(mesh, view, kClicks); };
  paths = [&] { return by_embree::path_trace(mesh, view); };
#endif
  const auto near = [](float a, float b) { return std::abs(a - b) < .01f; };
  compare<float>(
      head + "ambient occlusion",
      rounds,
      [&] { return by_grelha::ambient_occlusion(mesh); },
      open,
      near);
  compare<Picked>(
      head + "picking",
      rounds,
      [&] { return by_grelha::pick(mesh, view, kClicks); },
      picks,
      [](const Picked& a, const Picked& b) { return a.face == b.face; });
  compare<float>(
      head + "path tracer", rounds, [&] { return by_grelha::path_trace(mesh, view); }, paths, near);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> meshes;
  int rounds = 5;
  if (!set_options(argc, argv, [&](const std::string& word, const char* value) {
        if (word == "--mesh")
          meshes.emplace_back(value);
        else if (word == "--rounds")
          rounds = std::atoi(value);
        return word == "--mesh" || word == "--rounds";
      })) {
    std::fprintf(stderr, "programs [--mesh FILE]... [--rounds N]\n");
    return 2;
  }
  if (meshes.empty()) {
    meshes = {"mount 7"};
    for (const char* const scan : {"armadillo", "dragon"}) {
      const std::string path = std::string(GRELHA_SHARED_SCENES "/ply/") + scan + ".ply";
      if (std::filesystem::exists(path))
        meshes.push_back(path);
      else
        std::fprintf(stderr, "skipped: there is no %s\n", path.c_str());
    }
  }
  std::printf("mesh,faces,program,grelha,embree,agree\n");
  for (const std::string& mesh : meshes)
    run(mesh, rounds);
  return 0;
}
