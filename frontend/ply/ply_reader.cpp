#include "frontend/ply/ply_reader.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "frontend/images/tone.hpp"
#include "frontend/ply/ply_ascii.hpp"
#include "frontend/ply/ply_binary.hpp"

namespace grelha {
namespace {

int find_property(const PlyElement& element, std::string_view name) {
  const auto& all = element.properties;
  const auto found = std::ranges::find(all, name, &PlyProperty::name);
  return found == all.end() ? -1 : int(found - all.begin());
}

PlyPlan plan_vertex(const PlyElement& element, const Frame& frame) {
  static constexpr std::string_view kNames[] = {"x", "y", "z", "nx", "ny", "nz"};
  PlyPlan plan;
  plan.frame = frame;
  for (int i = 0; i < 6; ++i) {
    const int found = find_property(element, kNames[i]);
    const bool scalar = found >= 0 && !element.properties[std::size_t(found)].is_list;
    if (scalar)
      plan.columns[i] = found;
    else if (i < 3 && element.count > 0)
      throw ParseError(
          element.position,
          "expected a property \"" + std::string(kNames[i]) + "\" of \"vertex\", found none");
  }
  const bool normals = plan.columns[3] >= 0 && plan.columns[4] >= 0 && plan.columns[5] >= 0;
  if (!normals)
    std::fill(plan.columns + 3, plan.columns + 6, -1);
  return plan;
}

struct PlyColors {
  const PlyElement* element = nullptr;  ///< that has them, or null
  std::array<int, 3> columns{};
  PlyType type{};
};

/// Finds three numbers of an element, of one type.
std::optional<PlyColors> colors_in(const PlyElement& element,
                                   const std::array<std::string_view, 3>& names) {
  PlyColors found{&element, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    found.columns[i] = find_property(element, names[i]);
    if (found.columns[i] < 0)
      return {};
    const PlyProperty& property = element.properties[std::size_t(found.columns[i])];
    if (property.is_list || (i > 0 && property.type != found.type))
      return {};
    found.type = property.type;
  }
  return found;
}

/// Finds the colours of vertices, or else of faces.
PlyColors find_colors(const PlyHeader& header, WarningList& warning_list) {
  for (const std::string_view name : {"vertex", "face"})
    for (const PlyElement& element : header.elements)
      for (const auto& names : {std::array<std::string_view, 3>{"red", "green", "blue"},
                                {"diffuse_red", "diffuse_green", "diffuse_blue"}}) {
        if (element.name != name || element.count == 0)
          continue;
        const auto found = colors_in(element, names);
        if (found && (found->type == PlyType::kUint8 || found->type == PlyType::kUint16 ||
                      found->type >= PlyType::kFloat32))
          return *found;
        if (found)
          warning_list.add_line(element.position,
                                "colours are left out: expected them as uchar, ushort or float");
      }
  return {};
}

/// Cuts colours to what surfaces reflect.
void cut_colors(Mesh& mesh, const PlyColors& colors, WarningList& warning_list) {
  std::size_t cut = 0;
  for (std::vector<float>* const channel : {&mesh.red, &mesh.green, &mesh.blue})
    for (float& c : *channel)
      if (!(c >= 0 && c <= 1)) {
        c = c > 1 ? 1 : 0;
        ++cut;
      }
  if (cut > 0)
    warning_list.add_line(
        colors.element->position,
        std::to_string(cut) + " numbers of colours are cut: expected them from 0 to 1");
}

PlyPlan plan_faces(const PlyElement& element) {
  PlyPlan plan;
  plan.list = find_property(element, "vertex_indices");
  if (plan.list < 0)
    plan.list = find_property(element, "vertex_index");
  const bool sound = plan.list >= 0 && element.properties[std::size_t(plan.list)].is_list &&
                     element.properties[std::size_t(plan.list)].type < PlyType::kFloat32;
  if (sound)
    return plan;
  if (element.count > 0)
    throw ParseError(
        element.position,
        "expected a list of integers \"vertex_indices\" in \"" + element.name + "\", found none");
  return PlyPlan{};
}

/// Corners of as many triangles as there are rows, if the file can hold them: most meshes are of
/// triangles.
std::size_t expected_vertices(const PlyHeader& header,
                              const PlyElement& element,
                              int list,
                              std::size_t bytes) {
  if (list < 0)
    return 0;
  const bool ascii = header.format == PlyFormat::kAscii;
  const std::size_t item = ascii ? 2 : size_of(element.properties[std::size_t(list)].type);
  return std::min(std::size_t(3 * element.count), bytes / item);
}

template <class Rows>
Mesh read_rows(const PlyHeader& header,
               const PlyColors& colors,
               std::size_t bytes,
               const Frame& frame,
               Rows& rows) {
  Mesh mesh;
  std::uint64_t vertices = 0;
  for (const PlyElement& element : header.elements)
    if (element.name == "vertex")
      vertices = element.count;
  PlyFaces polygons(mesh, vertices, false), strips(mesh, vertices, true);
  for (const PlyElement& element : header.elements) {
    const bool is_strips = element.name == "tristrips";
    PlyPlan plan;
    if (element.name == "vertex")
      plan = plan_vertex(element, frame);
    if (element.name == "face" || is_strips)
      plan = plan_faces(element);
    if (&element == colors.element) {
      std::ranges::copy(colors.columns, plan.columns + 6);
      plan.color_type = colors.type;
      mesh.colors_of_faces = element.name == "face";
      mesh.has_alpha = find_property(element, "alpha") >= 0;
    }
    for (int i = 0; i < PlyPlan::kColumns; ++i)
      if (plan.columns[i] >= 0)
        column(mesh, plan, i).to->reserve(std::size_t(element.count));
    if (element.name == "face")
      mesh.indices.reserve(expected_vertices(header, element, plan.list, bytes));
    rows.read(element, plan, mesh, is_strips ? strips : polygons);
  }
  return mesh;
}

}  // namespace

float light_of_byte(double byte) {
  static const auto light = [] {
    std::array<float, 256> all{};
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = float(light_of_srgb(double(i) / 255));
    return all;
  }();
  return light[std::size_t(byte >= 0 ? std::min(byte + .5, 255.) : 0)];
}

Mesh read_ply_mesh(const std::string& path,
                   std::string_view bytes,
                   const Warn& warn,
                   LoadProgress* progress,
                   const Frame& frame,
                   bool with_colors) {
  WarningList warning_list(warn);
  const PlyHeader header = read_ply_header(path, bytes, warning_list, progress);
  const PlyColors colors = with_colors ? find_colors(header, warning_list) : PlyColors{};
  const auto read = [&](auto rows) { return read_rows(header, colors, bytes.size(), frame, rows); };
  Mesh mesh = header.format == PlyFormat::kAscii ? read(PlyAscii(path, bytes, header, progress))
                                                 : read(PlyBinary(path, bytes, header, progress));
  cut_colors(mesh, colors, warning_list);
  return mesh;
}

}  // namespace grelha
