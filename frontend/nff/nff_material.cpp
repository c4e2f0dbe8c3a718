#include "frontend/nff/nff_material.hpp"

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

}  // namespace grelha
