#include "frontend/ply/ply_reader.hpp"

#include <algorithm>

#include "frontend/files/text.hpp"
#include "frontend/ply/ply_ascii.hpp"
#include "frontend/ply/ply_binary.hpp"
#include "frontend/ply/ply_colors.hpp"

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

/// Gives an element that some programs call otherwise its name, unless another one has it.
void use_common_name(std::string_view name, std::string_view plural, PlyHeader& header) {
  if (std::ranges::find(header.elements, name, &PlyElement::name) != header.elements.end())
    return;
  for (PlyElement& element : header.elements)
    if (const std::string small = in_small_letters(element.name);
        small == name || small == plural) {
      element.name = name;
      return;
    }
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
      plan.colors_are_bytes = colors.is_bytes();
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

Mesh read_ply_mesh(const std::string& path,
                   std::string_view bytes,
                   const Warn& warn,
                   LoadProgress* progress,
                   const Frame& frame,
                   bool with_colors) {
  WarningList warning_list(warn);
  PlyHeader header = read_ply_header(path, bytes, warning_list, progress);
  use_common_name("vertex", "vertices", header);
  use_common_name("face", "faces", header);
  const PlyColors colors = with_colors ? find_colors(header) : PlyColors{};
  const auto read = [&](auto rows) { return read_rows(header, colors, bytes.size(), frame, rows); };
  Mesh mesh = header.format == PlyFormat::kAscii ? read(PlyAscii(path, bytes, header, progress))
                                                 : read(PlyBinary(path, bytes, header, progress));
  scale_colors(mesh, colors, warning_list);
  return mesh;
}

}  // namespace grelha
