#include "frontend/commands/report.hpp"
#include "frontend/scene/scene_file.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <set>

namespace grelha {
namespace {

using Json = nlohmann::json;

std::set<std::string> keys(const Json& json) {
  std::set<std::string> names;
  for (const auto& item : json.items())
    names.insert(item.key());
  return names;
}

template <class Change>
Material material_with(Change change) {
  Material material;
  change(material);
  return material;
}

/// One ball of that material, beside a material that has everything and is on nothing.
SceneFile one_ball(const Material& material) {
  SceneFile file;
  file.scene.materials = {material, material_with([](Material& m) {
                            m.transmission = m.roughness = 1;
                            m.fresnel = true;
                            m.emission = m.mirror = {1, 1, 1};
                          })};
  file.scene.geometry.spheres.add({1, 2, 3}, 0.5f, 0);
  return file;
}

bool needs(const SceneFile& file, std::string_view name) {
  for (const auto& [feature, needed] : needs_of(file))
    if (feature == name)
      return needed;
  ADD_FAILURE() << name;
  return false;
}

template <class Change>
bool ball_needs(Change change, std::string_view name) {
  return needs(one_ball(material_with(change)), name);
}

TEST(Needs, AskNothingForAMaterialNobodyUses) {
  const SceneFile file = one_ball(material_with([](Material& m) {
    m.diffuse = {1, 1, 1};
    m.ior = 2;
  }));
  for (const auto& [feature, needed] : needs_of(file))
    EXPECT_EQ(needed, feature == std::string_view("spheres")) << feature;
}

TEST(Needs, FollowTheMaterialsInUse) {
  const auto mirror = [](Material& m) { m.mirror = {0, 0, 0.1f}; };
  EXPECT_TRUE(ball_needs(mirror, "reflection"));
  EXPECT_FALSE(ball_needs(mirror, "refraction"));
  const auto glass = [](Material& m) { m.transmission = 0.5f; };
  EXPECT_TRUE(ball_needs(glass, "refraction"));
  EXPECT_TRUE(ball_needs(glass, "reflection")) << "total reflection";
  EXPECT_FALSE(ball_needs(glass, "fresnel"));
  const auto fresnel_glass = [](Material& m) {
    m.transmission = 0.5f;
    m.fresnel = true;
  };
  EXPECT_TRUE(ball_needs(fresnel_glass, "fresnel"));
  EXPECT_FALSE(ball_needs([](Material& m) { m.fresnel = true; }, "fresnel")) << "opaque";
  EXPECT_TRUE(ball_needs([](Material& m) { m.emission = {0, 1, 0}; }, "emission"));
  EXPECT_TRUE(ball_needs([](Material& m) { m.roughness = 0.1f; }, "roughness"));
}

TEST(Needs, FollowGeometryAndCamera) {
  SceneFile file;
  Triangles& t = file.scene.geometry.triangles;
  t.x = t.y = t.z = {0, 1, 2};
  t.nx = t.ny = t.nz = {0, 0, 0};
  t.a = {0};
  t.b = {1};
  t.c = {2};
  t.material = {0};
  file.scene.materials = {{}};
  file.lens = {true, 0, 1};
  EXPECT_FALSE(needs(file, "smooth_normals")) << "normals of length zero are none";
  EXPECT_FALSE(needs(file, "lens")) << "a lens without width is a pinhole";
  t.nz[1] = 1;
  file.lens.aperture = 2;
  file.scene.lights = {{{}, {}, {1, 0, 0}, {0, 1, 0}}};
  EXPECT_TRUE(needs(file, "smooth_normals"));
  EXPECT_TRUE(needs(file, "lens"));
  EXPECT_TRUE(needs(file, "area_lights"));
}

TEST(Bounds, HoldEveryKindButPlanes) {
  Geometry geometry;
  geometry.planes.add({1000, 0, 0}, {1, 0, 0}, 0);
  EXPECT_TRUE(bounds_of(geometry).empty);
  geometry.spheres.add({1, 2, 3}, -0.5f, 0);
  SceneBounds bounds = bounds_of(geometry);
  EXPECT_EQ(bounds.low, (Float3{0.5f, 1.5f, 2.5f}));
  EXPECT_EQ(bounds.high, (Float3{1.5f, 2.5f, 3.5f}));
  geometry.cones.add({0, 0, 0}, 2, {0, 0, 4}, 1, 0);
  bounds = bounds_of(geometry);
  EXPECT_EQ(bounds.low, (Float3{-2, -2, 0}));
  EXPECT_EQ(bounds.high, (Float3{2, 2.5f, 4}));
  Triangles& t = geometry.triangles;  // the last vertex belongs to no triangle
  t.x = t.y = t.z = {0, 5, 0, 100};
  t.a = {0};
  t.b = {1};
  t.c = {2};
  t.material = {0};
  EXPECT_EQ(bounds_of(geometry).high, (Float3{5, 5, 5}));
}

TEST(Bounds, TiltedDiscsReachAsFarAsTheyDo) {
  Geometry geometry;
  geometry.cones.add({0, 0, 0}, 1, {3, 3, 0}, 1, 0);
  const SceneBounds bounds = bounds_of(geometry);
  EXPECT_FLOAT_EQ(bounds.low.x, -std::sqrt(0.5f));
  EXPECT_FLOAT_EQ(bounds.high.y, 3 + std::sqrt(0.5f));
  EXPECT_EQ(bounds.low.z, -1);
}

RunReport some_run() {
  RunReport report;
  report.counts = {.s = 1,
                   .p = 2,
                   .pp = 3,
                   .c = 4,
                   .pl = 5,
                   .box = 6,
                   .mesh = 7,
                   .ply = 8,
                   .lights = 9,
                   .materials = 10};
  report.spheres = 1;
  report.triangles = 30;
  report.width = 4;
  report.height = 3;
  report.grids = {{{2, 3, 4}, 5, 6, 7}};
  report.render.rays = {12, 13, 14, 15};
  report.render.trace.tests = {17, 18, 19, 20};
  report.render.threads = 2;
  report.render.isa = "avx2";
  report.seconds = {1, 2, 3, 4};
  report.geometry_bytes = 100;
  report.grid_bytes = 200;
  return report;
}

TEST(Stats, HoldWhatWasCounted) {
  RenderCommand command;
  command.scene = "x.nff";
  const Json json = Json::parse(stats_json(command, some_run()));
  EXPECT_EQ(json["scene"],
            Json::parse(R"({"s":1,"p":2,"pp":3,"c":4,"pl":5,"box":6,"mesh":7,"ply":8,)"
                        R"("lights":9,"materials":10})"));
  EXPECT_EQ(json["grids"],
            Json::parse(R"([{"cells":[2,3,4],"occupied":5,"references":6,"bytes":7}])"));
  EXPECT_EQ(json["rays"],
            Json::parse(R"({"primary":12,"shadow":13,"reflection":14,"refraction":15})"));
  EXPECT_EQ(json["tests"], Json::parse(R"({"sphere":17,"triangle":18,"cone":19,"plane":20})"));
  EXPECT_EQ(json["seconds"],
            Json::parse(R"({"load":1.0,"build":2.0,"render":3.0,"write":4.0,"render_cpu":0.0})"));
  EXPECT_EQ(json["bytes"]["geometry"], 100);
  EXPECT_EQ(json["bytes"]["grids"], 200);
  EXPECT_GT(json["bytes"]["peak"], 100000);
  EXPECT_EQ(json["size"], Json::parse("[4,3]"));
  EXPECT_EQ(json["isa"], "avx2");
  EXPECT_EQ(json["threads"], 2);
  EXPECT_EQ(json["options"]["accel"], "grid");
  EXPECT_TRUE(json["options"]["adaptive"].is_null());
}

TEST(Stats, RecordSubdivision) {
  RenderCommand command;
  command.render.subdivision = {true, .1f, 3};
  EXPECT_EQ(Json::parse(stats_json(command, {}))["options"]["adaptive"],
            Json::parse(R"({"threshold":0.1,"depth":3})"));
}

TEST(Info, JsonSaysWhatTheSceneHolds) {
  SceneFile file = one_ball(material_with([](Material& m) { m.transmission = 0.5f; }));
  file.counts = {.s = 1, .lights = 2, .materials = 1};
  file.dropped = {3, 4, {}};
  file.camera.width = 640;
  const Json json = Json::parse(info_json(file, {1, 2, 3}, std::vector<GridStats>{}));
  EXPECT_EQ(keys(json),
            (std::set<std::string>{"scene",
                                   "kernel",
                                   "aabb",
                                   "dropped",
                                   "resolution",
                                   "bounds",
                                   "frame",
                                   "memory",
                                   "grids",
                                   "mesh",
                                   "needs",
                                   "view",
                                   "made_up",
                                   "points",
                                   "solids"}));
  EXPECT_EQ(json["scene"]["s"], 1);
  EXPECT_EQ(json["kernel"]["spheres"], 1);
  EXPECT_EQ(json["dropped"], Json::parse(R"({"not_finite":3,"zero_area":4})"));
  EXPECT_EQ(json["resolution"], Json::parse("[640,512]"));
  EXPECT_EQ(json["bounds"], Json::parse(R"({"min":[0.5,1.5,2.5],"max":[1.5,2.5,3.5]})"));
  EXPECT_EQ(json["grids"], Json::array());
  EXPECT_TRUE(Json::parse(info_json(file, {}, {}))["grids"].is_null()) << "not built";
  EXPECT_EQ(json["memory"], Json::parse(R"({"scene":1,"grids":2,"peak":3})"));
  EXPECT_EQ(json["needs"]["refraction"], true);
  EXPECT_EQ(json["needs"]["cones"], false);
}

/// A file's name is bytes, JSON is Unicode.
TEST(Info, NamesOfAnyBytes) {
  const Json json = Json::parse(info_json(
      {{"\xFF.nff", info_json(SceneFile{}, {}, {})}, {"b.nff", info_json(SceneFile{}, {}, {})}}));
  EXPECT_TRUE(json.contains("\xEF\xBF\xBD.nff") && json.contains("b.nff"));
}

TEST(Info, NothingHasNoBounds) {
  EXPECT_TRUE(Json::parse(info_json({}, {}, {}))["bounds"].is_null());
}

TEST(Info, SaysHowBoxesAreRead) {
  SceneFile file = one_ball(material_with([](Material&) {}));
  EXPECT_TRUE(Json::parse(info_json(file, {}, {}))["aabb"].is_null());
  EXPECT_EQ(info_text("x.nff", file, {}, {}).find("aabb"), std::string::npos);
  file.box_order = BoxOrder::kPairs;
  EXPECT_EQ(Json::parse(info_json(file, {}, {}))["aabb"], "pairs");
  EXPECT_NE(info_text("x.nff", file, {}, {}).find("\naabb          read as pairs\n"),
            std::string::npos);
  file.box_order = BoxOrder::kVertices;
  EXPECT_EQ(Json::parse(info_json(file, {}, {}))["aabb"], "corners");
}

/// A tetrahedron without its last face, and with one turned over and repeated.
TEST(Info, ChecksMeshes) {
  SceneFile file;
  Triangles& t = file.scene.geometry.triangles;
  t.x = {0, 1, 0, 0};
  t.y = {0, 0, 1, 0};
  t.z = {0, 0, 0, 1};
  t.a = {0, 0, 0, 1};
  t.b = {2, 1, 3, 2};
  t.c = {1, 3, 2, 3};
  EXPECT_TRUE(Json::parse(info_json(file, {}, {}))["mesh"].is_null());
  file.counts.ply = 4;
  const std::vector<GridStats> grids;
  const auto mesh_line = [&] {
    const std::string text = info_text("x.ply", file, {}, grids);
    const std::size_t from = text.find("mesh  ");
    return text.substr(from, text.find("needs") - from);
  };
  EXPECT_EQ(mesh_line(), "mesh          closed; oriented; edge-manifold\n");
  file.counts = {.mesh = 4};  // of STL
  EXPECT_EQ(mesh_line(), "mesh          closed; oriented; edge-manifold\n");
  EXPECT_EQ(Json::parse(info_json(file, {}, grids))["mesh"]["closed"], true);
  t.a = {0, 0, 3, 3, 0};
  t.b = {2, 1, 0, 0, 0};
  t.c = {1, 3, 2, 2, 1};
  EXPECT_EQ(
      mesh_line(),
      "mesh          4 open edges, the first from (0, 0, 0) to (0, 1, 0); 1 inconsistent edge, "
      "from (0, 1, 0) to (0, 0, 1)\n"
      "              2 non-manifold edges, 1 duplicate triangle, 1 degenerate triangle\n");
  const Json json = Json::parse(info_json(file, {}, grids))["mesh"];
  EXPECT_EQ(json["closed"], false);
  EXPECT_EQ(json["open_edges"]["count"], 4);
  EXPECT_EQ(json["open_edges"]["first"][0], Json::parse(R"({"triangle":0,"from":0,"to":2})"));
  EXPECT_EQ(json["duplicate_triangles"]["first"], Json::parse("[3]"));
  EXPECT_EQ(json["degenerate_triangles"]["first"], Json::parse("[4]"));
}

TEST(Info, TextListsTheSame) {
  SceneFile file = one_ball(material_with([](Material& m) { m.mirror = {1, 1, 1}; }));
  file.counts = {.s = 1, .lights = 2, .materials = 1};
  const SceneMemory memory{100000, 200000, 1250000};
  EXPECT_EQ(info_text("x.nff", file, memory, std::vector<GridStats>{{{2, 3, 4}, 5, 6, 7}}),
            "x.nff: 512x512\n"
            "in the file   1 s\n"
            "primitives    1 sphere\n"
            "lights        2\n"
            "view          --eye 0,0,1 --at 0,0,0 --up 0,1,0 --angle 45\n"
            "              v from 0 0 1 at 0 0 0 up 0 1 0 angle 45 resolution 512 512\n"
            "materials     1\n"
            "bounds        (0.5, 1.5, 2.5) to (1.5, 2.5, 3.5)\n"
            "memory        about 1.2 MB to render: scene 0.1, grids 0.2, the rest to read, build "
            "and draw\n"
            "grid          2 x 3 x 4 cells, 5 occupied, 6 references, 0.0 MB\n"
            "needs         spheres, reflection\n");
}

TEST(Summary, IsOneLine) {
  RenderCommand command;
  command.image = "x.png";
  EXPECT_EQ(report_line_of(command, some_run()),
            "x.png: 1 sphere, 30 triangles; grid 2x3x4; 0.000 Mrays in load 1.00, build 2.00, "
            "render 3.00, write 4.00 s; "
            "0.00 Mrays/s (avx2, 2 threads)\n");
}

/// mpirun binds each of two ranks to one processor unless told otherwise: whoever reads this sees
/// it.
TEST(Summary, SaysHowManyRanksAndThreadsEach) {
  RunReport shared = some_run();
  shared.ranks = 4;
  EXPECT_NE(report_line_of({}, shared).find("(avx2, 4 ranks, 2 threads each)\n"),
            std::string::npos);
  EXPECT_EQ(Json::parse(stats_json({}, shared))["ranks"], 4);
}

/// The printed error bound and the statement that it was reached agree in every digit.
TEST(Summary, SaysOfAnErrorWhetherItIsMet) {
  RenderCommand command;
  command.image = "x.png";
  command.render.refine.error = .01;
  const auto said = [&](double bound, int checks, Limit ended = Limit::kNone) {
    RunReport report;
    report.width = report.height = 10;
    ErrorStats& e = report.render.error;
    e.samples = 1000;
    e.rmse = .007;
    e.rmse_bound = bound;
    e.checks = checks;
    e.check_samples = 50;
    e.ended = ended;
    e.least = 4;
    e.most = 128;
    const std::string line = report_line_of(command, report);
    return line.substr(line.find("; RMSE"));
  };
  const std::string samples = " (95 %); 1000 samples, 10.0 a pixel, 4 to 128";
  EXPECT_EQ(said(.01, 0), "; RMSE about 0.007, at most 0.01" + samples + '\n');
  EXPECT_EQ(said(.01001, 0), "; RMSE about 0.007, at most 0.011" + samples + '\n');
  EXPECT_EQ(said(.00999, 1),
            "; RMSE about 0.007, at most 0.01 (95 %), checked by 5.0 % of the samples" +
                samples.substr(samples.find(';')) + '\n');
  EXPECT_EQ(said(.01, 0, Limit::kSeconds),
            "; RMSE about 0.007, at most 0.01" + samples + "; ended by the time\n");
  command.render.refine.error = .1;
  EXPECT_EQ(said(.0991, 0), "; RMSE about 0.007, at most 0.1" + samples + '\n');
  EXPECT_EQ(said(1e-8, 0), "; RMSE about 0.007, at most 1e-08" + samples + '\n');
  EXPECT_EQ(said(0, 0), "; RMSE about 0.007, at most 0" + samples + '\n');
}

}  // namespace
}  // namespace grelha
