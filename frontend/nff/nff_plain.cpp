#include "frontend/nff/nff_plain.hpp"

#include "frontend/nff/nff_material.hpp"

namespace grelha {

void NffSimple::read(std::string_view keyword) {
  if (keyword == "p" || keyword == "pt")
    read_polygon(keyword, false, keyword == "pt");
  else if (keyword == "pp" || keyword == "ppt")
    read_polygon(keyword, true, keyword == "ppt");
  else if (keyword == "s" || keyword == "st")
    read_sphere(keyword);
  else if (keyword == "c")
    read_cone(keyword);
  else
    read_fill(keyword);
}

std::uint32_t NffSimple::material(std::string_view keyword) {
  std::vector<Material>& all = file_.scene.materials;
  if (all.empty()) {
    input_.warn_once(
        "no material", keyword, "an object before the first \"f\"; it is drawn dull white");
    all.push_back(default_material());
  }
  return std::uint32_t(all.size() - 1);
}

void NffSimple::leave_out_texture(std::string_view keyword) {
  input_.warn_once(
      "texture", keyword, "textures are left out: the material is seen in their place");
}

void NffSimple::read_sphere(std::string_view keyword) {
  if (keyword == "st")
    leave_out_texture(keyword);
  const Float3 center = input_.framed_point("the sphere's center");
  build_.sphere(center, input_.length("the sphere's radius"), material(keyword));
  ++file_.counts.s;
}

void NffSimple::read_polygon(std::string_view keyword, bool patch, bool textured) {
  if (textured)
    leave_out_texture(keyword);
  const char* const before = input_.words.cursor();
  const std::size_t numbers = (patch ? 6 : 3) + (textured ? 2 : 0);
  const std::size_t size = input_.count("the polygon's corners", 2 * numbers);
  if (size < 3) {
    input_.words.go_on_at(before);
    input_.fail(input_.words.peek(), "at least 3 corners of a polygon");
  }
  corner_points_.clear();
  normals_.clear();
  for (std::size_t i = 0; i < size; ++i) {
    corner_points_.push_back(input_.framed_point("the polygon's corner"));
    if (patch)
      normals_.push_back(input_.point("the corner's normal"));
    for (int k = 0; textured && k < 2; ++k)
      input_.number("the corner's place in the texture");
  }
  build_.polygon(corner_points_, normals_, material(keyword), [&](SceneBuilder::Result result) {
    if (result == SceneBuilder::Result::kFilled)
      input_.warn_once(
          "crossed", keyword, "a polygon that crosses itself; it is filled by the even-odd rule");
    else if (result == SceneBuilder::Result::kFolded)
      input_.warn_once("folded",
                       keyword,
                       "a polygon that folds over itself; what is seen along its normal is filled");
    else
      input_.warn_once("crossed too often",
                       keyword,
                       "a polygon that crosses itself too often to be filled; it is left out");
  });
  ++(patch ? file_.counts.pp : file_.counts.p);
}

void NffSimple::read_cone(std::string_view keyword) {
  const Float3 base = input_.framed_point("the cone's base");
  const float base_radius = input_.length("the cone's base radius");
  const Float3 apex = input_.framed_point("the cone's apex");
  build_.cone(base, base_radius, apex, input_.length("the cone's apex radius"), material(keyword));
  ++file_.counts.c;
}

void NffSimple::read_fill(std::string_view keyword) {
  file_.scene.materials.push_back(read_nff_fill(input_, keyword));
  ++file_.counts.materials;
}

}  // namespace grelha
