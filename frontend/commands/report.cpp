#include "frontend/commands/report.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

#include "frontend/commands/json.hpp"
#include "frontend/files/atomic_file.hpp"
#include "frontend/files/memory_limit.hpp"
#include "frontend/files/text.hpp"
#include "frontend/scene/scene_file.hpp"
#include "grelha/mesh_check.hpp"
#include "grelha/scene_spans.hpp"

#include <sys/resource.h>

namespace grelha {
namespace {

// ---- whether a mesh is closed, oriented and manifold ----

std::string place_of(const SceneFile& file, std::uint32_t vertex) {
  const Triangles& t = file.scene.geometry.triangles;
  const auto at = file.frame.outside(Float3{t.x[vertex], t.y[vertex], t.z[vertex]});
  std::ostringstream text;
  text.precision(9);
  text << '(' << at[0] << ", " << at[1] << ", " << at[2] << ')';
  return text.str();
}

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + ' ' + what + (count == 1 ? "" : "s");
}

/// The number of edges of a kind, and where the first is.
std::string edges_text(const SceneFile& file, const Findings<MeshEdge>& found, const char* what) {
  const MeshEdge& first = found.first[0];
  return counted(found.count, what) + (found.count > 1 ? ", the first from " : ", from ") +
         place_of(file, first.from) + " to " + place_of(file, first.to);
}

Json to_json(const Findings<MeshEdge>& found) {
  Json first = Json::array();
  for (const MeshEdge& e : found.first)
    first.push_back({{"triangle", e.id}, {"from", e.from}, {"to", e.to}});
  return {{"count", found.count}, {"first", first}};
}
Json to_json(const Findings<std::uint32_t>& found) {
  return {{"count", found.count}, {"first", found.first}};
}

/// A line, or two: closed or where it is open, and other defects.
std::string mesh_text(const SceneFile& file) {
  const MeshCheck mesh = check_mesh(file.scene);
  std::string text = "mesh          ";
  text += mesh.is_closed() ? "closed" : edges_text(file, mesh.open_edges, "open edge");
  text += mesh.is_oriented()
              ? "; oriented"
              : "; " + edges_text(file, mesh.inconsistent_edges, "inconsistent edge");
  std::string others;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0)
      others += (others.empty() ? "" : ", ") + counted(count, what);
  };
  add(mesh.nonmanifold_edges.count, "non-manifold edge");
  add(mesh.duplicate_triangles.count, "duplicate triangle");
  add(mesh.degenerate_triangles.count, "degenerate triangle");
  add(mesh.nonfinite_triangles.count, "non-finite triangle");
  return text + (mesh.is_edge_manifold() ? "; edge-manifold\n" : "\n") +
         (others.empty() ? "" : "              " + others + '\n');
}

Json mesh_json(const SceneFile& file) {
  const MeshCheck mesh = check_mesh(file.scene);
  return {{"closed", mesh.is_closed()},
          {"oriented", mesh.is_oriented()},
          {"edge_manifold", mesh.is_edge_manifold()},
          {"vertices", mesh.vertices},
          {"edges", mesh.edges},
          {"open_edges", to_json(mesh.open_edges)},
          {"inconsistent_edges", to_json(mesh.inconsistent_edges)},
          {"nonmanifold_edges", to_json(mesh.nonmanifold_edges)},
          {"duplicate_triangles", to_json(mesh.duplicate_triangles)},
          {"degenerate_triangles", to_json(mesh.degenerate_triangles)},
          {"nonfinite_triangles", to_json(mesh.nonfinite_triangles)}};
}

// ---- text and JSON of reports ----

std::uint64_t peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::uint64_t(usage.ru_maxrss) * 1024;
}

__attribute__((format(printf, 1, 2))) std::string print(const char* format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

void list_count(std::string& text, std::uint64_t count, const char* name) {
  const std::string before = text.empty() ? "" : ", ";
  if (count > 0)
    text += before + std::to_string(count) + ' ' + name + (count == 1 ? "" : "s");
}

std::string grids_text(const std::vector<GridStats>& grids) {
  if (grids.empty())
    return "no grid";
  const auto& cells = grids.front().cells;
  const std::string first = print("%ux%ux%u", cells[0], cells[1], cells[2]);
  if (grids.size() == 1)
    return "grid " + first;
  return std::to_string(grids.size()) + " grids (" + first + ", ...)";
}

/// A point in the file's frame, with as many digits as floats have from the middle of the scene.
std::string point_text(const Frame& frame, const Float3& v) {
  const auto [x, y, z] = frame.outside(v);
  const char* const form = frame == Frame{} ? "(%g, %g, %g)" : "(%.10g, %.10g, %.10g)";
  return print(form, x, y, z);
}

void list_entities(std::string& text, const SceneFile& file) {
  const EntityCounts& c = file.counts;
  const std::pair<const char*, std::uint64_t> entities[] = {{"s", c.s},
                                                            {"p", c.p},
                                                            {"pp", c.pp},
                                                            {"c", c.c},
                                                            {"pl", c.pl},
                                                            {"box", c.box},
                                                            {"mesh faces", c.mesh},
                                                            {"ply faces", c.ply},
                                                            {"points", file.points.count}};
  std::string line;
  for (const auto& [name, count] : entities)
    if (count > 0)
      line += (line.empty() ? "" : ", ") + std::to_string(count) + ' ' + name;
  text += "in the file   " + (line.empty() ? "no primitives" : line) + '\n';
}

bool has_mesh(const EntityCounts& counts) {
  return counts.ply + counts.mesh > 0;
}

const char* box_order_name(BoxOrder order) {
  return order == BoxOrder::kPairs ? "pairs" : "corners";
}

std::string primitives_text(std::size_t spheres,
                            std::size_t triangles,
                            std::size_t cones,
                            std::size_t planes) {
  std::string text;
  list_count(text, spheres, "sphere");
  list_count(text, triangles, "triangle");
  list_count(text, cones, "cone");
  list_count(text, planes, "plane");
  return text.empty() ? "no primitives" : text;
}

Json options_json(const RenderCommand& command) {
  const SampleOptions& sampling = command.render.sampling;
  return {{"depth", command.render.depth},
          {"min_weight", command.render.min_weight},
          {"density", simplify(command.build.density)},
          {"accel", command.build.grid ? "grid" : "none"},
          {"isa", command.render.isa},
          {"packet", command.render.packet},
          {"samples", sampling.samples},
          {"sampler", sampler_name(sampling.sampler)},
          {"seed", sampling.seed},
          {"adaptive", to_json(command.render.subdivision)},
          {"light_rays", sampling.light_rays},
          {"gloss_rays", sampling.glossy_rays},
          {"threads", command.render.threads}};
}

const char* limit_name(Limit limit) {
  return limit == Limit::kError     ? "error"
         : limit == Limit::kSamples ? "samples"
         : limit == Limit::kSeconds ? "time"
                                    : "nothing";
}

Json error_json(const RefineOptions& asked, const ErrorStats& e) {
  return {{"asked", asked.error},
          {"seconds", asked.seconds},
          {"rmse", e.rmse},
          {"rmse_bound", e.rmse_bound},
          {"checks", e.checks},
          {"check_samples", e.check_samples},
          {"rounds", e.rounds},
          {"samples", e.samples},
          {"met", e.met},
          {"ended", limit_name(e.ended)},
          {"least", e.least},
          {"most", e.most}};
}

Json to_json(const Seconds& seconds) {
  return {{"load", seconds.load},
          {"build", seconds.build},
          {"render", seconds.render},
          {"write", seconds.write},
          {"render_cpu", seconds.render_cpu}};
}

/// The phases of all threads together.
Json phases_json(const RenderStats& render) {
  static constexpr const char* kPhaseNames[kPhases] = {
      "camera", "primary", "bounce", "surface", "light", "shadow", "children", "sums"};
  Json json;
  for (std::size_t i = 0; i < kPhases; ++i)
    json[kPhaseNames[i]] = render.phases[i];
  return json;
}

/// In ASCII: a file may have a name that is no Unicode, and a terminal obeys some characters.
std::string text_of(const Json& json) {
  return json.dump(2, ' ', true, Json::error_handler_t::replace);
}

std::string size_text(const Camera& camera) {
  return std::to_string(camera.width) + 'x' + std::to_string(camera.height);
}

std::string ranks_text(int ranks) {
  return ranks > 1 ? print("%d ranks, ", ranks) : "";
}

std::string dropped_text(const Dropped& dropped) {
  const std::uint64_t all = dropped.not_finite + dropped.zero_area;
  return all == 0 ? "" : "dropped       " + std::to_string(all) + " that cannot be drawn\n";
}

std::string bounds_text(const Frame& frame, const SceneBounds& bounds) {
  return bounds.empty ? ""
                      : "bounds        " + point_text(frame, bounds.low) + " to " +
                            point_text(frame, bounds.high) + '\n';
}

/// A line for each solid, up to some.
std::string solids_text(const std::vector<NamedObject>& solids) {
  constexpr std::size_t kMost = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, solids.size()); ++i)
    text += (i == 0 ? "solids        " : "              ") + counted(solids[i].faces, "face") +
            (solids[i].name.empty() ? "" : ": " + solids[i].name) + '\n';
  if (solids.size() > kMost)
    text += "              and " + std::to_string(solids.size() - kMost) + " more\n";
  return text;
}

Json solids_json(const std::vector<NamedObject>& solids) {
  Json all = Json::array();
  for (const NamedObject& solid : solids)
    all.push_back({{"name", solid.name}, {"faces", solid.faces}});
  return all;
}

std::string memory_text(const SceneMemory& memory) {
  return print(
      "memory        about %.1f MB to render: scene %.1f, grids %.1f, the rest to read, build and "
      "draw\n",
      double(memory.peak) / 1e6,
      double(memory.scene) / 1e6,
      double(memory.grids) / 1e6);
}

std::string colors_text(const ColorCounts& colors) {
  if (!colors.any())
    return "";
  return std::string("colors        of ") +
         (!colors.of_faces     ? "vertices"
          : colors.of_vertices ? "vertices and faces"
                               : "faces") +
         (colors.alpha ? ", without their alpha\n" : "\n");
}

std::string view_text(const SceneFile& file) {
  std::string text;
  for (const std::string& line : lines_of(view_of(file), file.frame))
    text += (text.empty() ? "view          " : "              ") + line + '\n';
  return text;
}

std::string grid_text(const GridStats& grid) {
  return print("grid          %u x %u x %u cells, %llu occupied, %llu references, %.1f MB\n",
               grid.cells[0],
               grid.cells[1],
               grid.cells[2],
               static_cast<unsigned long long>(grid.occupied),
               static_cast<unsigned long long>(grid.references),
               double(grid.bytes) / 1e6);
}

std::string needs_text(const SceneFile& file) {
  std::string needs;
  for (const auto& [name, needed] : needs_of(file))
    if (needed)
      needs += (needs.empty() ? "" : ", ") + std::string(name);
  return "needs         " + (needs.empty() ? "nothing but the background" : needs) + '\n';
}

/// Rounds up to two digits, so that the printed bound still holds.
std::string rounded_up(double value) {
  const std::string text = print("%.1e", value);
  int tens = 10 * (text[0] - '0') + (text[2] - '0'), power = std::atoi(text.c_str() + 4) - 1;
  if (!(value > 0) || std::strtod(text.c_str(), nullptr) >= value)
    return print("%.2g", value);
  return print("%.2g", std::strtod(print("%de%d", ++tens, power).c_str(), nullptr));
}

const char* limit_text(Limit limit) {
  return limit == Limit::kError     ? "the error asked for"
         : limit == Limit::kSamples ? "the number of samples"
                                    : "the time";
}

std::string error_text(const ErrorStats& e, const RunReport& report) {
  std::string text =
      print("; RMSE about %.2g, at most ", e.rmse) + rounded_up(e.rmse_bound) + " (95 %)";
  if (e.checks > 0)
    text += print(", checked by %.1f %% of the samples",
                  100 * double(e.check_samples) / double(e.samples));
  text += print("; %llu samples, %.1f a pixel, %u to %u",
                static_cast<unsigned long long>(e.samples),
                double(e.samples) / report.width / report.height,
                e.least,
                e.most);
  if (e.ended != Limit::kNone)
    text += print("; ended by %s", limit_text(e.ended));
  return text;
}

}  // namespace

std::string balls_text(const SceneFile& file) {
  const auto& [count, least, most] = file.points;
  return print("balls of radius %g", least / file.frame.scale) +
         (most > least ? print(" to %g", most / file.frame.scale) : "");
}

std::string unmet_error(const RenderCommand& command, const RunReport& report) {
  const ErrorStats& e = report.render.error;
  const double asked = command.render.refine.error;
  if (asked <= 0 || e.met)
    return "";
  return command.scene +
         print(": warning: --error %g is not met: RMSE about %.2g, at most ", asked, e.rmse) +
         rounded_up(e.rmse_bound) +
         print(" (95 %%), with up to %u samples in a pixel; %s ended it",
               e.most,
               limit_text(e.ended));
}

std::string stats_json(const RenderCommand& command, const RunReport& report) {
  const RenderStats& render = report.render;
  Json json;
  json["version"] = GRELHA_VERSION;
  json["file"] = command.scene;
  json["isa"] = render.isa;
  json["threads"] = render.threads;
  json["ranks"] = report.ranks;
  json["size"] = {report.width, report.height};
  json["options"] = options_json(command);
  json["scene"] = to_json(report.counts);
  json["grids"] = to_json(report.grids);
  json["rays"] = to_json(render.rays);
  if (command.render.refine.on())
    json["error"] = error_json(command.render.refine, render.error);
  json["tests"] = to_json(render.trace.tests);
  json["seconds"] = to_json(report.seconds);
  json["phases"] = phases_json(render);
  json["bytes"] = {
      {"geometry", report.geometry_bytes}, {"grids", report.grid_bytes}, {"peak", peak_bytes()}};
  return text_of(json) + '\n';
}

std::string info_json(const SceneFile& file,
                      const SceneMemory& memory,
                      const std::optional<std::vector<GridStats>>& grids) {
  const Geometry& geometry = file.scene.geometry;
  Json json;
  json["scene"] = to_json(file.counts);
  json["kernel"] = {{"spheres", geometry.spheres.size()},
                    {"triangles", geometry.triangles.size()},
                    {"vertices", geometry.triangles.vertex_count()},
                    {"cones", geometry.cones.size()},
                    {"planes", geometry.planes.size()},
                    {"objects", geometry.objects.size()}};
  json["points"] = nullptr;
  if (file.points.count > 0)
    json["points"] = {{"count", file.points.count},
                      {"radius", file.points.most / file.frame.scale}};
  json["solids"] = solids_json(file.solids);
  json["dropped"] = {{"not_finite", file.dropped.not_finite},
                     {"zero_area", file.dropped.zero_area}};
  json["aabb"] = nullptr;
  if (file.box_order != BoxOrder::kNone)
    json["aabb"] = box_order_name(file.box_order);
  json["resolution"] = {file.camera.width, file.camera.height};
  json["bounds"] = to_json(file.frame, bounds_of(geometry));
  json["frame"] = {{"offset", file.frame.offset}, {"scale", file.frame.scale}};
  json["memory"] = {{"scene", memory.scene}, {"grids", memory.grids}, {"peak", memory.peak}};
  json["grids"] = grids ? to_json(*grids) : nullptr;
  json["mesh"] = grids && has_mesh(file.counts) ? mesh_json(file) : nullptr;
  for (const auto& [name, needed] : needs_of(file))
    json["needs"][name] = needed;
  const Camera& camera = file.camera;
  json["view"] = {{"eye", file.frame.outside(camera.eye)},
                  {"at", file.frame.outside(camera.at)},
                  {"up", to_json(camera.up)},
                  {"angle", camera.angle_deg},
                  {"orthographic", camera.orthographic_height / file.frame.scale}};
  json["made_up"] = {{"camera", file.default_camera}, {"light", file.default_light}};
  return text_of(json) + '\n';
}

std::string info_json(const std::vector<std::pair<std::string, std::string>>& of_files) {
  Json all;
  for (const auto& [file, text] : of_files)
    all[file] = Json::parse(text);
  return text_of(all) + '\n';
}

std::string info_text(const std::string& path,
                      const SceneFile& file,
                      const SceneMemory& memory,
                      const std::optional<std::vector<GridStats>>& grids) {
  const Geometry& g = file.scene.geometry;
  std::string text = printable_line(path) + ": " + size_text(file.camera) + '\n';
  list_entities(text, file);
  text += "primitives    " +
          primitives_text(g.spheres.size(), g.triangles.size(), g.cones.size(), g.planes.size()) +
          '\n';
  if (file.points.count > 0)
    text += "points        " + balls_text(file) + '\n';
  text += solids_text(file.solids) + dropped_text(file.dropped);
  text += "lights        " + std::to_string(file.counts.lights) +
          (file.default_light ? " (and made-up ones)\n" : "\n");
  if (file.box_order != BoxOrder::kNone)
    text += std::string("aabb          read as ") + box_order_name(file.box_order) + '\n';
  text += view_text(file);
  text += "materials     " + std::to_string(file.counts.materials) + '\n';
  text += colors_text(file.colors) + bounds_text(file.frame, bounds_of(g));
  if (file.frame != Frame{})
    text += "coordinates   " + text_of(file.frame) + '\n';
  text += memory_text(memory);
  if (!grids)
    text += "grid          not built: it would take more than " + available_memory() + '\n';
  for (const GridStats& grid : grids.value_or(std::vector<GridStats>{}))
    text += grid_text(grid);
  if (grids && has_mesh(file.counts))
    text += mesh_text(file);
  return text + needs_text(file);
}

std::string report_line_of(const RenderCommand& command, const RunReport& report) {
  const Seconds& s = report.seconds;
  const double rays = double(report.render.rays.total());
  const std::string times =
      print("load %.2f, build %.2f, render %.2f, write %.2f s", s.load, s.build, s.render, s.write);
  const double speed = s.render > 0 ? rays / s.render / 1e6 : 0;
  const ErrorStats& e = report.render.error;
  const std::string error = e.samples == 0 ? "" : error_text(e, report);
  return printable_line(name_of_file(command.image)) + ": " +
         primitives_text(report.spheres, report.triangles, report.cones, report.planes) + "; " +
         grids_text(report.grids) + "; " + print("%.3f Mrays in ", rays / 1e6) + times +
         print("; %.2f Mrays/s (%s, ", speed, report.render.isa) + ranks_text(report.ranks) +
         print("%d thread%s%s)",
               report.render.threads,
               report.render.threads == 1 ? "" : "s",
               report.ranks > 1 ? " each" : "") +
         error + '\n';
}

namespace {

bool any(Float3 v) {
  return v.x != 0 || v.y != 0 || v.z != 0;
}

bool any(const std::vector<float>& values) {
  return std::ranges::any_of(values, [](float value) { return value != 0; });
}

bool has_normals(const Triangles& t) {
  return any(t.nx) || any(t.ny) || any(t.nz);
}

/// The materials that primitives have.
std::vector<Material> materials_in_use(const Scene& scene) {
  const std::vector<char> used = used_materials(scene);
  std::vector<Material> found;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i])
      found.push_back(scene.materials[i]);
  return found;
}

}  // namespace

Needs needs_of(const SceneFile& file) {
  const Geometry& geometry = file.scene.geometry;
  const std::vector<Material> materials = materials_in_use(file.scene);
  const auto some = [&](bool (*has)(const Material&)) {
    return std::ranges::any_of(materials, has);
  };
  const bool glass = some([](const Material& m) { return m.transmission > 0; });
  return {{"spheres", geometry.spheres.size() > 0},
          {"triangles", geometry.triangles.size() > 0},
          {"cones", geometry.cones.size() > 0},
          {"planes", geometry.planes.size() > 0},
          {"smooth_normals", has_normals(geometry.triangles)},
          {"colors", file.colors.any()},
          {"reflection", glass || some([](const Material& m) { return any(m.mirror); })},
          {"refraction", glass},
          {"fresnel", some([](const Material& m) { return m.fresnel && m.transmission > 0; })},
          {"emission", some([](const Material& m) { return any(m.emission); })},
          {"roughness", some([](const Material& m) { return m.roughness > 0; })},
          {"area_lights", std::ranges::any_of(file.scene.lights, &Light::is_area)},
          {"lens", file.lens.present && file.lens.aperture > 0},
          {"environment", !file.environment.empty()}};
}

}  // namespace grelha
