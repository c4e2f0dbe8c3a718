// What a ray costs, by kind and scene, beside Embree 3 on the same rays: one thread, one process,
// taking turns.
//
// trace [--scene NAME]... [--kind NAME]... [--size N] [--rounds N] [--scenes DIR] [Google Benchmark
// options]
//
// One benchmark a scene and kind, `balls 4/mirror`; its iterations are rounds, in each of which
// every way of tracing takes the whole set of rays once. Ratios are made within a round and their
// median is told. No way is timed whose answers are wrong: Grelha's must be the same bits as each
// other's and, on a sample of rays, as the reference walk's; Embree's may differ in kDisagree of
// them. A scene is a row of the table, `GENERATOR SIZE`, or a file.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <time.h>

#include "kernel/grid/world_impl.hpp"
#include "perf/embree.hpp"
#include "perf/ray_sets.hpp"
#include "tests/reference/reference.hpp"
#include "tests/support/oracle.hpp"

namespace {

using namespace grelha;
using namespace grelha::perf;

/// share of rays that may meet something else in Embree: grazed edges
constexpr double kDisagree = .005;
constexpr double kClose = 1e-5;  ///< relative difference of t of one and the same place
/// On cones t alone tells little: a ray that starts beside one has a t as small as what its start
/// was rounded by, and one that grazes it may be anywhere along the touch. There a point also is
/// the same place where it lies on the side within what kernel/shapes/cone.hpp promises, in eps
/// (|org - base| + height + wider radius).
constexpr double kConeUnits = 32;

struct Row {
  std::string name, file;  ///< file, below the folder of real scenes; if it is not there:
  std::string generator;
  int size;
  std::vector<double> target;  ///< ratios to stay below, by kind; empty: none is set
};

const std::vector<double> kBalls{.2, .2, .5, .9, .5, .35, .9}, kMesh{.75, .7, .9, .9, 1.2, 1., 1.3},
    kStadium{.8, .7, 1., 1.1, 1.3, 1.2, 1.3}, kDistant{.4, .4, .4, .4, .4, .4, .5};
const std::vector<Row> kRows{
    {"balls 4", "", "balls", 4, kBalls},
    {"balls 5", "", "balls", 5, kBalls},
    {"balls 6", "", "balls", 6, kBalls},
    {"mount 6", "", "mount", 6, {}},
    {"mount 8", "", "mount", 8, kMesh},
    {"mount 9", "", "mount", 9, kMesh},
    {"bunny", "ply/bunny.ply", "knot", 15, kMesh},
    {"teapot", "spd/teapot.nff", "knot", 3, kMesh},
    {"gears", "", "gears", 4, {}},
    {"rings", "", "rings", 7, {}},
    {"stadium", "", "stadium", 6, kStadium},
    {"distant", "", "distant", 3, kDistant},
};

struct Options {
  std::vector<Row> rows;
  std::vector<std::size_t> kinds;
  int size = 1024, rounds = 5;
  std::string scenes = GRELHA_SHARED_SCENES;
};

/// One scene, as Grelha and Embree hold it. Scenes are large: only the last one asked for is kept.
struct Place {
  std::string name;
  SceneFile file;
  World world;
  RayMaker maker;
  std::unique_ptr<EmbreeScene> robust, fast;
  Place(std::string n, SceneFile f, int size)
      : name(std::move(n)),
        file(std::move(f)),
        world(file.scene, {}),
        maker(file, world, size),
        robust(make_embree_scene(file.scene, true)),
        fast(make_embree_scene(file.scene, false)) {}
};

Place& place(const Row& row, const Options& options) {
  static std::unique_ptr<Place> last;
  if (last && last->name == row.name)
    return *last;
  last.reset();
  std::string path = row.file;
  if (!path.empty() && !std::filesystem::exists(path))
    path = options.scenes + "/" + row.file;
  const bool real = !row.file.empty() && std::filesystem::exists(path);
  if (!real && row.generator.empty())
    throw std::invalid_argument("no scene " + row.name);
  if (!real && !row.file.empty())
    std::printf("%s: %s is not there; %s %d in its place\n",
                row.name.c_str(),
                row.file.c_str(),
                row.generator.c_str(),
                row.size);
  SceneFile file =
      real ? read_scene(path, [](const std::string&) {}) : make_scene(row.generator, row.size);
  last = std::make_unique<Place>(row.name, std::move(file), options.size);
  return *last;
}

enum Side { kGrelha, kRobust, kFast, kSides };

/// One way of tracing a set of rays, and what it took in each round.
struct Way {
  Side side;
  std::string name;
  std::function<void()> trace;
  std::vector<double> ns;  ///< a ray, by round
};

/// Whether that is a cone, and the point at t lies on its side.
bool on_its_cone(const Place& p, const RayBuffer& rays, std::size_t i, std::uint32_t id, float t) {
  const std::uint32_t first = p.world.impl().view.geometry.ids.begin(PrimitiveKind::kCone);
  const Cones& c = p.file.scene.geometry.cones;
  if (id < first || id - first >= c.size())
    return false;
  const std::size_t k = id - first;
  const test::oracle::V base = Float3{c.base_x[k], c.base_y[k], c.base_z[k]};
  const test::oracle::V apex = Float3{c.apex_x[k], c.apex_y[k], c.apex_z[k]};
  const test::oracle::Frustum side{base, apex, c.base_radius[k], c.apex_radius[k]};
  const test::oracle::Ray ray{Float3{rays.ox[i], rays.oy[i], rays.oz[i]},
                              Float3{rays.dx[i], rays.dy[i], rays.dz[i]}};
  const auto wider = std::max(std::abs(side.r0), std::abs(side.r1));
  const auto unit = test::oracle::kEps * (length(ray.org - base) + side.height() + wider);
  return side.distance(ray.point(t)) <= kConeUnits * unit;
}

struct GrelhaMode {
  const char* name;
  TraceSettings settings;
};
const GrelhaMode kModes[] = {{"packets 256", {.method = Method::kPackets, .packet = 256}},
                             {"packets 64", {.method = Method::kPackets, .packet = 64}},
                             {"packets 16", {.method = Method::kPackets, .packet = 16}},
                             {"single", {.method = Method::kSingle}}};
/// What a render takes: of one ray a pixel or point, only those from the camera in packets of 256;
/// see options_for() in shader.hpp.
std::size_t renders(RayKind kind) {
  return kind == RayKind::kShadow || kind == RayKind::kMirror || kind == RayKind::kIncoherent ? 1
                                                                                              : 0;
}

void trace_all(const Variant& variant,
               const Place& p,
               const RayBuffer& r,
               bool any,
               const TraceSettings& settings,
               Answers& a,
               TraceCounts& counts) {
  a.t = r.t_max;
  a.id.resize(r.size());
  const VariantLoops& loops = variant.loops;
  (any ? loops.occluded : loops.closest)(p.world.impl().view,
                                         {r.ox.data(),
                                          r.oy.data(),
                                          r.oz.data(),
                                          r.dx.data(),
                                          r.dy.data(),
                                          r.dz.data(),
                                          r.t_min.data(),
                                          a.t.data(),
                                          a.id.data(),
                                          static_cast<int>(r.size())},
                                         settings,
                                         counts);
}

double cpu_ns() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

double share_of(std::uint64_t part, std::uint64_t all) {
  return static_cast<double>(part) / static_cast<double>(std::max<std::uint64_t>(all, 1));
}

double median(std::vector<double> v) {
  if (v.empty())
    return 0;
  std::sort(v.begin(), v.end());
  return (v[(v.size() - 1) / 2] + v[v.size() / 2]) / 2;
}

/// What is told of one scene and kind.
struct Cell {
  std::size_t rays = 0;
  double hit_share = 0, disagree = 0;
  std::vector<Way> ways;
  std::size_t best[kSides] = {}, chosen = 0;
  TraceCounts counts;  ///< of the render's choice
  double tests() const {
    const TestCounts& t = counts.tests;
    return share_of(t.sphere + t.triangle + t.cone + t.plane, rays);
  }
  double cells() const { return share_of(counts.visits, rays); }
  double lanes_busy() const {
    return share_of(counts.packets.lanes_busy, counts.packets.lanes_issued);
  }
  double fell_back() const {
    return share_of(counts.packets.fell_back, counts.packets.fell_back + counts.packets.formed);
  }
  bool has_embree() const { return ways[best[kRobust]].side == kRobust; }
  /// Median over rounds of the times of one way over those of another.
  double ratio(std::size_t a, std::size_t b) const {
    std::vector<double> r;
    for (std::size_t i = 0; i < std::min(ways[a].ns.size(), ways[b].ns.size()); ++i)
      r.push_back(ways[a].ns[i] / ways[b].ns[i]);
    return median(r);
  }
};

/// Whether Grelha met a plane where Embree's stand-in for it has ended.
bool past_the_planes(const SceneView& scene, const RayBuffer& r, std::size_t i, const Answers& a) {
  if (!scene.geometry.ids.has(PrimitiveKind::kPlane, a.id[i]))
    return false;
  double width = 0, away = 0;
  const float *const org[] = {r.ox.data(), r.oy.data(), r.oz.data()}, *const dir[] = {r.dx.data(),
                                                                                      r.dy.data(),
                                                                                      r.dz.data()};
  for (int k = 0; k < 3; ++k) {
    width = std::max(width, double(scene.box_hi[k]) - scene.box_lo[k]);
    const double d =
        org[k][i] + double(a.t[i]) * dir[k][i] - .5 * (double(scene.box_hi[k]) + scene.box_lo[k]);
    away += d * d;
  }
  return std::sqrt(away) > .99 * kPlaneReach * width;
}

bool blocked(float t) { return t == -__builtin_inff(); }

/// Empty when all is well; else what is wrong.
std::string check(const Place& p, const RayBuffer& rays, bool any, Cell& cell) {
  TraceCounts unused;
  Answers truth, again;
  trace_all(*find_variant("best"), p, rays, any, kModes[0].settings, truth, unused);
  const auto same = [&](const Answers& a, std::size_t i, std::size_t k) {
    return std::memcmp(&a.t[i], &truth.t[k], 4) == 0 && (any || a.id[i] == truth.id[k]);
  };
  for (const GrelhaMode& mode : kModes) {
    trace_all(*find_variant("best"), p, rays, any, mode.settings, again, unused);
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (!same(again, i, i))
        return std::string("wrong hits: ") + mode.name + " against " + kModes[0].name;
  }
  RayBuffer some;
  const std::size_t step = std::max<std::size_t>(1, rays.size() / 16384);
  for (std::size_t i = 0; i < rays.size(); i += step)
    some.add(
        {rays.ox[i], rays.oy[i], rays.oz[i]}, {rays.dx[i], rays.dy[i], rays.dz[i]}, rays.t_max[i]);
  trace_all(reference_walk(), p, some, any, {}, again, unused);
  for (std::size_t i = 0; i < some.size(); ++i)
    if (!same(again, i, i * step))
      return "wrong hits: packets against the reference walk";

  std::size_t hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    hits += any ? blocked(truth.t[i]) : truth.id[i] != kNoPrimitive;
  cell.hit_share = static_cast<double>(hits) / static_cast<double>(rays.size());
  for (EmbreeScene* const e : {p.robust.get(), p.fast.get()})
    for (const EmbreeMode& mode : e ? embree_modes() : std::vector<EmbreeMode>{}) {
      e->trace(rays, any, mode);
      const Answers a = e->answers();
      std::size_t other = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        if (any)
          other += blocked(a.t[i]) != blocked(truth.t[i]);
        else if (a.id[i] == kNoPrimitive || truth.id[i] == kNoPrimitive)
          other += a.id[i] != truth.id[i] && !past_the_planes(p.world.impl().view, rays, i, truth);
        else {  // one of two that meet or overlap there is no error
          const bool close =
              std::abs(a.t[i] - truth.t[i]) <= static_cast<float>(kClose) * truth.t[i];
          other += !close && !on_its_cone(p, rays, i, a.id[i], a.t[i]);
        }
      }
      const double share = static_cast<double>(other) / static_cast<double>(rays.size());
      if (e == p.robust.get())
        cell.disagree = std::max(cell.disagree, share);
      if (share > kDisagree) {
        char text[160];
        std::snprintf(text,
                      sizeof text,
                      "Embree %s, %s: %.2f %% of rays meet something else",
                      e == p.robust.get() ? "robust" : "fast",
                      mode.name,
                      100 * share);
        return text;
      }
    }
  return "";
}

std::map<std::string, std::map<std::size_t, Cell>> results;
bool failed = false;

void run(benchmark::State& state, const Row& row, std::size_t kind, const Options& options) {
  const auto fail = [&](const std::string& why) {
    std::printf("%s, %s: %s\n", row.name.c_str(), kRayKinds[kind], why.c_str());
    failed = true;
    state.SkipWithError(why.c_str());
  };
  Place& p = place(row, options);
  const bool any = RayMaker::any_hit(static_cast<RayKind>(kind));
  const RayBuffer rays = p.maker.make(static_cast<RayKind>(kind));
  if (rays.size() == 0)
    return fail("no such rays");
  Cell cell;
  cell.rays = rays.size();
  if (const std::string wrong = check(p, rays, any, cell); !wrong.empty())
    return fail(wrong);

  Answers answers;
  TraceCounts unused;
  for (const GrelhaMode& m : kModes)
    cell.ways.push_back({kGrelha,
                         m.name,
                         [&, settings = m.settings] {
                           trace_all(
                               *find_variant("best"), p, rays, any, settings, answers, unused);
                         },
                         {}});
  cell.chosen = renders(static_cast<RayKind>(kind));
  for (const Side side : {kRobust, kFast})
    for (const EmbreeMode& m : embree_modes()) {
      EmbreeScene* const e = side == kRobust ? p.robust.get() : p.fast.get();
      cell.ways.push_back({side, m.name, [=, &rays] { e->trace(rays, any, m); }, {}});
    }
  const auto find_best = [&] {
    for (std::size_t side = 0; side < kSides; ++side) {
      double least = 1e300;
      for (std::size_t i = 0; i < cell.ways.size(); ++i)
        if (const Way& w = cell.ways[i]; w.side == side && !w.ns.empty() && median(w.ns) < least) {
          least = median(w.ns);
          cell.best[side] = i;
        }
    }
  };
  // After two rounds those a third slower than the best of their side are known to be, and dropped.
  std::vector<bool> in(cell.ways.size(), true);
  int round = 0;
  for (auto _ : state) {
    const double start = cpu_ns();
    if (round++ == 2) {
      find_best();
      for (std::size_t i = 0; i < in.size(); ++i)
        in[i] = i == cell.chosen ||
                median(cell.ways[i].ns) < 1.33 * median(cell.ways[cell.best[cell.ways[i].side]].ns);
    }
    for (std::size_t i = 0; i < cell.ways.size(); ++i) {
      if (!in[i])
        continue;
      const double from = cpu_ns();
      cell.ways[i].trace();
      cell.ways[i].ns.push_back((cpu_ns() - from) / static_cast<double>(rays.size()));
    }
    state.SetIterationTime(1e-9 * (cpu_ns() - start));
  }
  find_best();
  trace_all(
      *find_variant("best"), p, rays, any, kModes[cell.chosen].settings, answers, cell.counts);

  constexpr const char* kSideNames[] = {"grelha ", "embree robust ", "embree fast "};
  for (const Way& w : cell.ways)
    state.counters[kSideNames[w.side] + w.name + " ns"] = median(w.ns);
  state.counters["rays"] = static_cast<double>(rays.size());
  state.counters["hits"] = cell.hit_share;
  state.counters["disagree"] = cell.disagree;
  state.counters["ns/ray"] = median(cell.ways[cell.chosen].ns);
  state.counters["tests/ray"] = cell.tests();
  state.counters["cells/ray"] = cell.cells();
  state.counters["lanes busy"] = cell.lanes_busy();
  state.counters["fell back"] = cell.fell_back();
  const Way &chosen = cell.ways[cell.chosen], &best = cell.ways[cell.best[kGrelha]];
  std::printf("%-8s %-11s %6.1f ns %5.1f Mrays/s %s",
              row.name.c_str(),
              kRayKinds[kind],
              median(chosen.ns),
              1e3 / median(chosen.ns),
              chosen.name.c_str());
  if (&best != &chosen)
    std::printf(" (%s: %.1f ns)", best.name.c_str(), median(best.ns));
  if (cell.has_embree()) {
    const Way &robust = cell.ways[cell.best[kRobust]], &fast = cell.ways[cell.best[kFast]];
    state.counters["ratio"] = cell.ratio(cell.chosen, cell.best[kRobust]);
    state.counters["ratio of the best"] = cell.ratio(cell.best[kGrelha], cell.best[kRobust]);
    state.counters["ratio to fast"] = cell.ratio(cell.chosen, cell.best[kFast]);
    if (!row.target.empty())
      state.counters["target"] = row.target[kind];
    std::printf(
        "; Embree robust %.1f ns %s, fast %.1f ns %s; ratio %.2f; %.2g %% meet something else",
        median(robust.ns),
        robust.name.c_str(),
        median(fast.ns),
        fast.name.c_str(),
        cell.ratio(cell.chosen, cell.best[kRobust]),
        100 * cell.disagree);
  }
  std::printf("\n");
  std::fflush(stdout);
  results[row.name][kind] = cell;
}

/// run() prints what there is to say.
class Silent : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>&) override {}
};

using CellText = std::function<std::string(const Row&, std::size_t, const Cell&)>;

void print_table(const Options& options, const std::string& title, const CellText& text) {
  std::printf("\n%s\n\n| %-8s |", title.c_str(), "");
  for (const std::size_t k : options.kinds)
    std::printf(" %s |", kRayKinds[k]);
  std::printf("\n|---|");
  for (std::size_t i = 0; i < options.kinds.size(); ++i)
    std::printf("--:|");
  for (const Row& row : options.rows) {
    if (!results.count(row.name))
      continue;
    std::printf("\n| %-8s |", row.name.c_str());
    for (const std::size_t k : options.kinds) {
      const auto& cells = results.at(row.name);
      const auto found = cells.find(k);
      std::printf(" %s |", found == cells.end() ? "" : text(row, k, found->second).c_str());
    }
  }
  std::printf("\n");
}

std::string format(const char* form, double a, double b = 0, double c = 0, double d = 0) {
  char text[96];
  std::snprintf(text, sizeof text, form, a, b, c, d);
  return text;
}

void print_tables(const Options& options) {
  const auto against = [&](Side side, bool choice) {
    return [=](const Row& row, std::size_t kind, const Cell& c) {
      const double r = c.ratio(choice ? c.chosen : c.best[kGrelha], c.best[side]);
      const bool missed = side == kRobust && !row.target.empty() && r > row.target[kind];
      return format(missed ? "%.2f (> %g)" : "%.2f", r, missed ? row.target[kind] : 0.);
    };
  };
  if (!embree_modes().empty()) {
    print_table(options,
                "Time of Grelha, packets as a render forms them / time of Embree's best mode, "
                "robust (> target, where missed)",
                against(kRobust, true));
    print_table(options, "Grelha's best / Embree's best, robust", against(kRobust, false));
    print_table(
        options, "As a render forms them / Embree's best, not robust", against(kFast, true));
  } else {
    std::printf("\nBuilt without Embree: no ratios.\n");
  }
  print_table(
      options, "ns a ray, as a render forms packets", [](const Row&, std::size_t, const Cell& c) {
        return format("%.1f", median(c.ways[c.chosen].ns));
      });
  print_table(options,
              "Lanes busy; tests a ray; cells a ray; packets that fell back",
              [](const Row&, std::size_t, const Cell& c) {
                return format("%.0f %%; %.1f; %.1f; %.0f %%",
                              100 * c.lanes_busy(),
                              c.tests(),
                              c.cells(),
                              100 * c.fell_back());
              });
}

/// A row of the table, `GENERATOR SIZE`, or a file.
Row row_named(const std::string& name) {
  for (const Row& row : kRows)
    if (row.name == name)
      return row;
  const auto space = name.find(' ');
  if (space != std::string::npos)
    return {name, "", name.substr(0, space), std::atoi(name.c_str() + space), {}};
  return {name, name, "", 0, {}};
}

/// False: a word is not understood.
bool parse(int argc, char** argv, Options& o) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (i + 1 == argc)
      return false;
    const std::string value = argv[++i];
    if (word == "--scene") {
      o.rows.push_back(row_named(value));
    } else if (word == "--kind") {
      const auto found = std::find(kRayKinds.begin(), kRayKinds.end(), value);
      if (found == kRayKinds.end())
        return false;
      o.kinds.push_back(static_cast<std::size_t>(found - kRayKinds.begin()));
    } else if (word == "--size") {
      o.size = std::atoi(value.c_str());
    } else if (word == "--rounds") {
      o.rounds = std::atoi(value.c_str());
    } else if (word == "--scenes") {
      o.scenes = value;
    } else {
      return false;
    }
  }
  if (o.rows.empty())
    o.rows = kRows;
  if (o.kinds.empty())
    for (std::size_t k = 0; k < kRayKinds.size(); ++k)
      o.kinds.push_back(k);
  return o.size >= 32 && o.size <= 16384 && o.rounds >= 1;
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  Options options;
  if (!parse(argc, argv, options)) {
    std::fprintf(
        stderr,
        "usage: trace [--scene NAME]... [--kind NAME]... [--size N] [--rounds N] [--scenes DIR] "
        "[Google Benchmark options]\n"
        "  scenes: a row of the table, GENERATOR SIZE, or a file; size: 32 to 16384; kinds:");
    for (const char* k : kRayKinds)
      std::fprintf(stderr, " '%s'", k);
    std::fprintf(stderr, "\n");
    return 2;
  }
  for (const Row& row : options.rows)
    for (const std::size_t kind : options.kinds)
      benchmark::RegisterBenchmark((row.name + "/" + kRayKinds[kind]).c_str(),
                                   [&, kind](benchmark::State& s) { run(s, row, kind, options); })
          ->Iterations(options.rounds)
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
  try {
    Silent silent;
    benchmark::RunSpecifiedBenchmarks(&silent);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "trace: %s\n", e.what());
    return 1;
  }
  if (!results.empty())
    print_tables(options);
  return failed ? 1 : 0;
}
