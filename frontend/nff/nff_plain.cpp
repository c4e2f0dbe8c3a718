#include "frontend/nff/nff_plain.hpp"

#include <algorithm>

namespace grelha {
namespace {

constexpr const char* kWhat = "the material";
using Fields = std::vector<NumberWord>;

Float3 scaled(const Fields& f, std::size_t color, float weight) {
  return {f[color].value * weight, f[color + 1].value * weight, f[color + 2].value * weight};
}

void need_fields(NffInput& input, const Fields& fields, std::size_t least) {
  if (fields.size() >= least)
    return;
  const std::string_view word = input.words.peek();
  input.fail(word,
             std::string("a number for ") + kWhat + " (field " + std::to_string(fields.size() + 1) +
                 " of " + std::to_string(least) + ")");
}

/// Highlight exponent, transmission and index of refraction: three fields in a row in every
/// dialect.
void read_common(NffInput& input, const Fields& f, std::size_t first, Material& m) {
  m.shine = std::max(0.0f, f[first].value);
  m.transmission = std::max(0.0f, f[first + 1].value);
  if (m.transmission > 0 && !(f[first + 2].value > 0))
    input.fail(f[first + 2].word,
               "an index of refraction above 0 for a material that transmits light");
  m.ior = f[first + 2].value;
}

Material one_color(NffInput& input, const Fields& f) {
  Material m;
  const float ks = f[4].value;
  m.diffuse = scaled(f, 0, f[3].value);
  m.specular = scaled(f, 0, ks);
  m.mirror = {ks, ks, ks};
  read_common(input, f, 5, m);
  return m;
}

Material two_colors(NffInput& input, const Fields& f) {
  Material m;
  m.diffuse = scaled(f, 0, f[3].value);
  m.specular = m.mirror = scaled(f, 4, f[7].value);
  read_common(input, f, 8, m);
  m.fresnel = m.transmission > 0;
  if (f.size() == 12 || f.size() == 13)
    m.roughness = std::max(0.0f, f[11].value);
  if (f.size() >= 14)
    m.emission = {f[11].value, f[12].value, f[13].value};
  return m;
}

/// A word behind the fields on their line that is no entity: assimp's variant names a texture
/// there.
void skip_texture(NffInput& input) {
  const std::string_view word = input.words.peek_on_line();
  if (word.size() <= 3)
    return;  // may be the next entity's keyword
  input.warn_once("texture", word, "texture " + quoted(word) + " is left out");
  input.words.skip_line();
}

void warn_fields(NffInput& input, std::string_view keyword, std::size_t found) {
  const std::string count = std::to_string(found);
  const std::string said = count + " fields, where 8, 11, 12 or 14 are known";
  input.warn_once("fields" + count, keyword, "a material with " + said);
}

}  // namespace

Material read_nff_fill(NffInput& input, std::string_view keyword) {
  Fields fields = input.numbers(keyword == "material" ? 11 : 8, kWhat);
  need_fields(input, fields, 3);
  const std::size_t count = fields.size();
  if (count != 8 && count != 11 && count != 12 && count != 14)
    warn_fields(input, keyword, count);
  // A color alone is a dull surface: Kd 1, Ks 0, shine 0, T 0, index 1.
  constexpr float kDefaults[] = {1, 1, 1, 1, 0, 0, 0, 1};
  for (std::size_t i = count; i < 8; ++i)
    fields.push_back({kDefaults[i], keyword});
  skip_texture(input);
  return count < 11 ? one_color(input, fields) : two_colors(input, fields);
}

Material read_nff_mat(NffInput& input, std::string_view keyword) {
  const Fields fields = input.numbers(11, kWhat);
  need_fields(input, fields, 11);
  if (fields.size() == 13 || fields.size() > 14)
    warn_fields(input, keyword, fields.size());
  return two_colors(input, fields);
}

Material default_material() {
  Material m;
  m.diffuse = {0.8f, 0.8f, 0.8f};
  return m;
}

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
