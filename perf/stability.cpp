// Counts the errors of ray tracers in hard cases: the rows of tests/stability/ with many rays, for
// Grelha and for Embree in its default and its robust mode.
//
// stability [--rays N] [--pixels N] [--rows NAME] [--seed N]
//
// Prints JSON: for each row and tracer the number of answers, of missed hits, of false hits and of
// hits on the surface that the ray had left; pictures, for Grelha alone; and the cost of rays with
// NaN or along axes relative to ordinary rays. Exits with 1 if an answer of Grelha is wrong.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "perf/embree.hpp"
#include "tests/stability/grelha_tracer.hpp"
#include "tests/stability/pictures.hpp"
#include "tests/stability/rows.hpp"

namespace {

using namespace grelha;
using namespace grelha::stability;
using Json = nlohmann::ordered_json;

/// Embree, asked as Grelha is: rays side by side and one by one.
class EmbreeTracer final : public Tracer {
 public:
  explicit EmbreeTracer(bool robust) : robust_(robust) {}
  void build(const Trial& trial) override {
    scene_ = perf::make_embree_scene(trial.scene, robust_);
  }
  int ways() const override { return 2; }
  const char* way_name(int way) const override { return way == 0 ? "8 coherent" : "single"; }
  Answers closest(const RayList& rays, int way) override {
    const perf::Answers a = ask(rays, false, way);
    return {a.t, a.id, {}};
  }
  Answers occluded(const RayList& rays, int way) override {
    Answers out;
    out.block(rays, ask(rays, true, way).blocked);
    return out;
  }

 private:
  perf::Answers ask(const RayList& rays, bool any, int way) {
    const perf::EmbreeMode mode =
        way == 0 ? perf::EmbreeMode{"", 8, true} : perf::EmbreeMode{"", 1, false};
    scene_->trace(
        {rays.ox, rays.oy, rays.oz, rays.dx, rays.dy, rays.dz, rays.t_min, rays.t}, any, mode);
    return scene_->answers();
  }
  bool robust_;
  std::unique_ptr<perf::EmbreeScene> scene_;
};

struct Options {
  std::size_t rays = 1000000;
  int pixels = 128;
  std::string rows;  ///< those whose name holds this
  std::uint64_t seed = 1;
};

struct Column {
  const char* name;
  std::unique_ptr<Tracer> tracer;
};

std::vector<Column> columns() {
  std::vector<Column> all;
  all.push_back({"grelha", std::make_unique<GrelhaTracer>(*find_variant("best"))});
  if (perf::embree_modes().empty())
    return all;
  all.push_back({"embree", std::make_unique<EmbreeTracer>(false)});
  all.push_back({"embree robust", std::make_unique<EmbreeTracer>(true)});
  return all;
}

/// Validates in a process of its own, as an assertion of Debian's Embree may end it. False: it did.
bool judge_apart(Tracer& tracer, const Trial& trial, Counts& counts) {
  int ends[2];
  if (pipe(ends) != 0)
    throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child < 0)
    throw std::runtime_error("no process");
  if (child == 0) {
    close(ends[0]);
    if (!std::freopen("/dev/null", "w", stderr))
      _exit(1);
    const Counts c = judge(tracer, trial);
    const std::uint64_t numbers[4] = {c.answers, c.lost, c.false_, c.self};
    bool good = write(ends[1], numbers, sizeof numbers) == static_cast<ssize_t>(sizeof numbers);
    good = good &&
           write(ends[1], c.first.data(), c.first.size()) == static_cast<ssize_t>(c.first.size());
    _exit(good ? 0 : 1);
  }
  close(ends[1]);
  std::uint64_t numbers[4] = {};
  const bool answered =
      read(ends[0], numbers, sizeof numbers) == static_cast<ssize_t>(sizeof numbers);
  char text[1000] = {};
  if (answered && read(ends[0], text, sizeof text - 1) < 0)
    text[0] = 0;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!answered || status != 0)
    return false;
  Counts c;
  c.answers = numbers[0];
  c.lost = numbers[1];
  c.false_ = numbers[2];
  c.self = numbers[3];
  c.first = text;
  counts += c;
  return true;
}

/// Every tracer on a row, trial by trial, so that rays and truth are made once.
Json run_row(const Row& row, std::vector<Column>& all, const Options& o, bool& failed) {
  std::vector<Counts> counts(all.size());
  std::vector<std::uint64_t> aborts(all.size());
  Random random(o.seed);
  row.make(random, o.rays, [&](const Trial& trial) {
    counts[0] += judge(*all[0].tracer, trial);
    for (std::size_t i = 1; i < all.size(); ++i)
      aborts[i] += !judge_apart(*all[i].tracer, trial, counts[i]);
  });
  Json out{{"name", row.name}, {"condition", row.condition}, {"truth", row.truth}};
  for (std::size_t i = 0; i < all.size(); ++i)
    out["tracers"][all[i].name] = {{"answers", counts[i].answers},
                                   {"lost", counts[i].lost},
                                   {"false", counts[i].false_},
                                   {"self", counts[i].self},
                                   {"aborts", aborts[i]},
                                   {"first", counts[i].first}};
  failed |= counts[0].wrong() > 0;
  return out;
}

/// Ordinary rays at a cluster, and the same with something odd about each.
RayList odd_rays(const std::string& kind, std::size_t count) {
  Random random(3);
  RayList rays;
  for (std::size_t i = 0; i < count; ++i) {
    Float3 org = test::at({0, 0, 0}, 4, random.direction()),
           dir = test::minus(random.point(1), org);
    if (kind == "NaN")
      test::component(random.chance(.5) ? org : dir, random.below(3)) = test::kNaN;
    if (kind == "infinity")
      test::component(random.chance(.5) ? org : dir, random.below(3)) =
          random.chance(.5) ? test::kInf : -test::kInf;
    if (kind == "zero direction")
      dir = {};
    if (kind == "along an axis") {
      const std::uint32_t a = random.below(3);
      const Float3 aim = random.point(1);
      org = aim;
      dir = {};
      test::component(org, a) = -4;
      test::component(dir, a) = 1;
    }
    if (kind == "denormal directions")
      test::component(dir, random.below(3)) = 1e-40f;
    if (kind == "from 1e6 away") {
      const Float3 aim = random.point(1);
      org = test::at(aim, 1e6, random.direction());
      dir = test::minus(aim, org);
    }
    rays.add(org, dir);
  }
  return rays;
}

/// ns a ray, least of five.
double ns_of(Tracer& tracer, const RayList& rays, int way) {
  double least = 1e300;
  for (int k = 0; k < 5; ++k) {
    const auto start = std::chrono::steady_clock::now();
    tracer.closest(rays, way);
    least = std::min(
        least,
        std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count());
  }
  return least / static_cast<double>(rays.size());
}

Json costs(std::vector<Column>& all, const Options& o) {
  Trial trial;
  trial.scene.materials.resize(1);
  Random random(5);
  for (int i = 0; i < 5000; ++i)
    trial.scene.geometry.spheres.add(
        random.point(1), static_cast<float>(random.log_in(.005, .05)), 0);
  for (Column& c : all)
    c.tracer->build(trial);
  const std::size_t count = std::clamp<std::size_t>(o.rays, 1000, 200000);
  const RayList ordinary = odd_rays("", count);
  Json out = Json::array();
  for (const char* const kind : {"NaN",
                                 "infinity",
                                 "zero direction",
                                 "along an axis",
                                 "denormal directions",
                                 "from 1e6 away"}) {
    const RayList rays = odd_rays(kind, count);
    Json row{{"name", kind}};
    const bool number = std::strcmp(kind, "NaN") != 0 && std::strcmp(kind, "infinity") != 0 &&
                        std::strcmp(kind, "zero direction") != 0;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (i == 0 || number)
        for (int way = 0; way < 2; ++way) {
          Tracer& tracer = *all[i].tracer;
          row["ratio"][all[i].name].push_back(ns_of(tracer, rays, way) /
                                              ns_of(tracer, ordinary, way));
        }
    out.push_back(row);
  }
  return out;
}

/// False: a word is not understood.
bool parse(int argc, char** argv, Options& o) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (++i == argc)
      return false;
    if (word == "--rays")
      o.rays = static_cast<std::size_t>(std::atoll(argv[i]));
    else if (word == "--pixels")
      o.pixels = std::atoi(argv[i]);
    else if (word == "--rows")
      o.rows = argv[i];
    else if (word == "--seed")
      o.seed = static_cast<std::uint64_t>(std::atoll(argv[i]));
    else
      return false;
  }
  return o.rays >= 100 && o.pixels >= 8;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  if (!parse(argc, argv, o)) {
    std::fprintf(stderr,
                 "usage: stability [--rays N] [--pixels N] [--rows PART OF A NAME] [--seed N]\n");
    return 2;
  }
  bool failed = false;
  std::vector<Column> all = columns();
  Json out{{"rays", o.rays}, {"pixels", o.pixels}, {"seed", o.seed}};
  const auto chosen = [&](const char* name) {
    return std::string(name).find(o.rows) != std::string::npos;
  };
  for (const Row& row : all_rows()) {
    if (!chosen(row.name))
      continue;
    std::fprintf(stderr, "%s\n", row.name);
    out["rows"].push_back(run_row(row, all, o, failed));
  }
  for (const PictureRow& row : picture_rows()) {
    if (!chosen(row.name))
      continue;
    std::fprintf(stderr, "%s\n", row.name);
    const PictureCounts c = row.run(o.pixels);
    out["pictures"].push_back({{"name", row.name},
                               {"condition", row.condition},
                               {"truth", row.truth},
                               {"pixels", c.pixels},
                               {"wrong", c.wrong},
                               {"first", c.first}});
    failed |= c.wrong > 0;
  }
  if (o.rows.empty())
    out["costs"] = costs(all, o);
  std::printf("%s\n", out.dump(1).c_str());
  return failed ? 1 : 0;
}
