#include "frontend/nff/nff_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "frontend/files/load_progress.hpp"
#include "frontend/files/other_formats.hpp"
#include "frontend/files/text.hpp"
#include "frontend/nff/nff_input.hpp"
#include "frontend/nff/nff_mesh_files.hpp"
#include "frontend/nff/nff_plain.hpp"
#include "frontend/nff/nff_view.hpp"
#include "frontend/scene/scene_builder.hpp"
#include "frontend/scene/scene_file.hpp"
#include "grelha/render.hpp"

namespace grelha {
namespace {

/// Determines the order of the six numbers of every `aabb` in a file. Two orders are in use, and
/// only the numbers tell them apart. The numbers of one box often allow both, so this reads all
/// boxes of the file.
///
/// Pairs have every minimum before its maximum; corners ascend, or descend, on every axis. Pairs
/// when all boxes are in pairs and some cannot be corners; corners otherwise, which any six numbers
/// can be. `words` stands behind the first `aabb` and is left there.
BoxOrder aabb_order(Words words);

using Six = std::array<float, 6>;

/// Returns false if reading the box gives an error or drops it.
bool read_six(Words& words, Six& numbers) {
  const auto reads = [&](float& number) { return to_number(words.next(), number); };
  const auto is_finite = [](float number) { return std::isfinite(number); };
  return std::ranges::all_of(numbers, reads) && std::ranges::all_of(numbers, is_finite);
}

bool are_pairs(const Six& n) {
  return n[0] <= n[1] && n[2] <= n[3] && n[4] <= n[5];
}

bool are_vertices(const Six& n) {
  const bool ascend = n[0] <= n[3] && n[1] <= n[4] && n[2] <= n[5];
  const bool descend = n[0] >= n[3] && n[1] >= n[4] && n[2] >= n[5];
  return ascend || descend;
}

BoxOrder aabb_order(Words words) {
  bool all_corners = true;
  Six numbers;
  for (std::string_view word = "aabb"; !word.empty(); word = words.next()) {
    if (word != "aabb" || !read_six(words, numbers))
      continue;
    if (!are_pairs(numbers))
      return BoxOrder::kVertices;
    all_corners = all_corners && are_vertices(numbers);
  }
  return all_corners ? BoxOrder::kVertices : BoxOrder::kPairs;
}

class NffReader {
 public:
  NffReader(const std::string& path,
            std::string_view text,
            const Warn& warn,
            const ReadOptions& options,
            LoadProgress* progress)
      : progress_(progress, text.data()),
        words_(path, text, byte_order_mark(text), Comments::kAll),
        warning_list_(warn),
        meshes_(path, warn, options, progress),
        input_(words_, warning_list_, options.frame),
        build_(file_, options.meshes),
        simple_(input_, file_),
        lights_(file_) {
    file_.source_bytes = text.size();
    file_.frame = options.frame;
  }

  SceneFile read(std::string_view text);

 private:
  using Entity = void (NffReader::*)(std::string_view keyword);
  struct Named {
    std::string_view name;
    Entity read;
  };
  static const Named kEntities[];

  void warn_nul(std::string_view text);
  static const Named* entity_named(std::string_view word);
  bool read_entity(std::string_view word);
  void skip_other(std::string_view word, std::string_view last_entity);
  static std::string suggested(std::string_view word);
  void reject_sense8();
  std::uint32_t material(std::string_view keyword) { return simple_.material(keyword); }
  std::vector<std::uint32_t> mesh_vertices(std::size_t faces, std::size_t vertices);

  void read_simple(std::string_view keyword);
  void read_texture(std::string_view keyword);
  void read_mat(std::string_view keyword);
  void read_l(std::string_view keyword) { lights_.read_point(input_, keyword); }
  void read_b(std::string_view) {
    file_.scene.background = input_.bounded_point("the background's color");
  }
  void read_pl(std::string_view keyword);
  void read_npl(std::string_view keyword);
  void read_box(std::string_view keyword);
  void read_aabb(std::string_view keyword);
  void read_mesh(std::string_view keyword);
  void read_ply(std::string_view keyword);
  void read_light(std::string_view keyword) { lights_.read_light(input_, keyword); }
  void read_al(std::string_view keyword) { lights_.read_area(input_, keyword); }
  void read_shape(std::string_view keyword) { lights_.read_shape(input_, keyword); }
  void read_glow(std::string_view) { lights_.read_glow(input_); }
  void read_beam(std::string_view keyword);
  void read_env(std::string_view keyword);
  void read_accel(std::string_view keyword);
  void read_spp(std::string_view keyword);

  ParseProgress progress_;
  SceneFile file_;
  Words words_;
  WarningList warning_list_;
  NffMeshFiles meshes_;
  NffInput input_;
  SceneBuilder build_;
  NffSimple simple_;
  NffView view_;
  NffLights lights_;
};

// The frequent ones first: the search is linear.
const NffReader::Named NffReader::kEntities[] = {
    {"s", &NffReader::read_simple},    {"p", &NffReader::read_simple},
    {"pp", &NffReader::read_simple},   {"c", &NffReader::read_simple},
    {"f", &NffReader::read_simple},    {"mat", &NffReader::read_mat},
    {"l", &NffReader::read_l},         {"b", &NffReader::read_b},
    {"bclr", &NffReader::read_b},      {"pl", &NffReader::read_pl},
    {"npl", &NffReader::read_npl},     {"box", &NffReader::read_box},
    {"aabb", &NffReader::read_aabb},   {"mesh", &NffReader::read_mesh},
    {"ply", &NffReader::read_ply},     {"light", &NffReader::read_light},
    {"al", &NffReader::read_al},       {"env", &NffReader::read_env},
    {"accel", &NffReader::read_accel}, {"spp", &NffReader::read_spp},
    {"L", &NffReader::read_glow},      {"material", &NffReader::read_simple},
    {"t", &NffReader::read_texture},   {"ppt", &NffReader::read_simple},
    {"pt", &NffReader::read_simple},   {"st", &NffReader::read_simple},
    {"la", &NffReader::read_shape},    {"ls", &NffReader::read_shape},
    {"lf", &NffReader::read_beam},     {"ld", &NffReader::read_beam},
    {"B", &NffReader::read_env},
};

/// Warns of NUL bytes: they separate words as spaces do, which is seldom intended.
void NffReader::warn_nul(std::string_view text) {
  const std::size_t nul = text.find('\0');
  if (nul != text.npos)
    warning_list_.add_line(words_.position(text.substr(nul)), kNulIsSpace);
}

SceneFile NffReader::read(std::string_view text) {
  reject_sense8();
  warn_nul(text);
  std::string_view last_entity;
  for (;;) {
    const std::string_view word = words_.next();
    if (word.empty()) {
      file_.camera = view_.finish(input_, word);
      lights_.finish();
      return std::move(file_);
    }
    progress_.at(words_.cursor());
    if (read_entity(word))
      last_entity = word;
    else
      skip_other(word, last_entity);
  }
}

const NffReader::Named* NffReader::entity_named(std::string_view word) {
  const Named* const found = std::ranges::find(kEntities, word, &Named::name);
  return found == std::end(kEntities) ? nullptr : found;
}

bool NffReader::read_entity(std::string_view word) {
  // a word of headings as well
  if (word == "material" && !looks_like_number(words_.peek_on_line()))
    return false;
  const Named* const entity = entity_named(word);
  if (!entity)
    return view_.read(word, input_, file_.lens);
  (this->*entity->read)(word);
  return true;
}

/// ` (did you mean "angle"?)`, or nothing.
std::string NffReader::suggested(std::string_view word) {
  std::vector<std::string_view> known(NffView::words().begin(), NffView::words().end());
  for (const Named& entity : kEntities)
    known.push_back(entity.name);
  const std::string_view near = nearest(word, known);
  return near.empty() ? "" : " (did you mean " + grelha::quoted(near) + "?)";
}

/// Skips a word that begins no entity, with the rest of its line, and warns once per kind. A file
/// may hold millions of such words, so only the first of a kind is compared with the keywords.
void NffReader::skip_other(std::string_view word, std::string_view last_entity) {
  if (!looks_like_number(word)) {
    if (warning_list_.first("word " + std::string(word)))
      warning_list_.add_line(
          input_.position(word),
          "unknown word " + quoted(word) + suggested(word) + "; its line is skipped");
  } else if (words_.at_line_start() || last_entity.empty()) {
    input_.warn_once("stray", word, "numbers that belong to no entity; their line is skipped");
  } else if (warning_list_.first("surplus " + std::string(last_entity))) {
    warning_list_.add_line(
        input_.position(word),
        "more numbers than " + quoted(last_entity) + " takes; the rest of the line is skipped");
  }
  words_.skip_line();
}

/// Rejects another format named NFF (WorldToolKit): those letters stand alone on its first line,
/// and the next line has no keyword of Haines' format.
void NffReader::reject_sense8() {
  Words ahead = words_;
  const std::string_view word = ahead.next();
  if ((word != "nff" && word != "NFF") || !ahead.peek_on_line().empty())
    return;
  const std::string_view next = ahead.next();
  const auto view_words = NffView::words();
  if (!entity_named(next) && std::ranges::find(view_words, next) == view_words.end())
    throw ParseError(input_.position(word),
                     "expected Haines' Neutral File Format, found Sense8's (WorldToolKit) NFF");
}

void NffReader::read_simple(std::string_view keyword) {
  const bool is_polygon = keyword == "p" || keyword == "pp";
  if (!is_polygon || !lights_.glows() || !lights_.read_glowing(input_, keyword))
    simple_.read(keyword);
}

void NffReader::read_texture(std::string_view keyword) {
  const std::string_view name = words_.tail_of_line();
  input_.warn_once("texture", keyword, "texture " + quoted(name) + " is left out");
}

void NffReader::read_mat(std::string_view keyword) {
  file_.scene.materials.push_back(read_nff_mat(input_, keyword));
  ++file_.counts.materials;
}

void NffReader::read_pl(std::string_view keyword) {
  const Float3 a = input_.framed_point("the plane's first point");
  const Float3 b = input_.framed_point("the plane's second point");
  build_.plane(a, b, input_.framed_point("the plane's third point"), material(keyword));
  ++file_.counts.pl;
}

/// The plane normal . x + constant = 0, as in the only other reader known to accept `npl`.
void NffReader::read_npl(std::string_view keyword) {
  std::array<double, 3> n;
  for (double& component : n)
    component = input_.wide_number("the plane's normal");
  const double constant = input_.wide_number("the plane's constant");
  const double distance = input_.frame.distance(n, 0 - constant);  // 0 - 0 is no -0
  build_.plane({static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])},
               static_cast<float>(distance),
               material(keyword));
  ++file_.counts.pl;
}

void NffReader::read_box(std::string_view keyword) {
  const Float3 corner = input_.framed_point("the box's first corner");
  build_.box(corner, input_.framed_point("the box's second corner"), material(keyword));
  ++file_.counts.box;
}

void NffReader::read_aabb(std::string_view keyword) {
  if (file_.box_order == BoxOrder::kNone)
    file_.box_order = aabb_order(words_);
  std::array<double, 6> v;
  for (double& bound : v)
    bound = input_.wide_number("the box's bounds");
  if (file_.box_order == BoxOrder::kPairs)
    v = {v[0], v[2], v[4], v[1], v[3], v[5]};
  const Frame& frame = input_.frame;
  build_.box(frame.inside({v[0], v[1], v[2]}), frame.inside({v[3], v[4], v[5]}), material(keyword));
  ++file_.counts.box;
}

/// Counted from 1, or from -1 for the last vertex backwards.
std::vector<std::uint32_t> NffReader::mesh_vertices(std::size_t faces, std::size_t vertices) {
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * faces);
  const auto last = std::int64_t(vertices);
  for (std::size_t i = 0; i < 3 * faces; ++i) {
    progress_.at(words_.cursor());
    const std::string_view word = words_.next();
    std::int64_t index = 0;
    if (!to_integer(word, index) || index == 0 || index > last || index < -last)
      input_.fail(word,
                  "a vertex of the mesh, from 1 to " + std::to_string(last) + " or -" +
                      std::to_string(last) + " to -1");
    indices.push_back(std::uint32_t(index > 0 ? index - 1 : last + index));
  }
  return indices;
}

void NffReader::read_mesh(std::string_view keyword) {
  Mesh mesh;
  const std::size_t vertices = input_.count("the mesh's vertices", 6);
  const std::size_t faces = input_.count("the mesh's faces", 6);
  mesh.x.reserve(vertices);
  mesh.y.reserve(vertices);
  mesh.z.reserve(vertices);
  for (std::size_t i = 0; i < vertices; ++i) {
    progress_.at(words_.cursor());
    const Float3 p = input_.framed_point("the mesh's vertex");
    mesh.x.push_back(p.x);
    mesh.y.push_back(p.y);
    mesh.z.push_back(p.z);
  }
  mesh.indices = mesh_vertices(faces, vertices);
  build_.mesh(std::move(mesh), material(keyword));
  file_.counts.mesh += faces;
}

void NffReader::read_ply(std::string_view keyword) {
  const std::string_view name = words_.tail_of_line();
  const std::string path = meshes_.path(input_, name);
  Mesh mesh = meshes_.read(input_, name, path, file_);
  const std::size_t faces = mesh.face_count();
  const CrossedFaces crossed = build_.mesh(std::move(mesh), material(keyword));
  if (const std::string text = crossed.text(); !text.empty() && warning_list_.first("of " + path))
    warning_list_.add_line(path + ": warning: " + text);
  file_.counts.ply += faces;
  file_.meshes.push_back(path);
}

/// Spotlights and light from one direction.
void NffReader::read_beam(std::string_view keyword) {
  words_.tail_of_line();
  input_.warn_once(
      keyword, keyword, "lights of " + quoted(keyword) + " are left out: they shine one way");
}

void NffReader::read_env(std::string_view keyword) {
  file_.environment = std::string(words_.tail_of_line());
  input_.warn_once(
      "env", keyword, "environment maps are not rendered; the background color is seen instead");
}

void NffReader::read_accel(std::string_view) {
  file_.accelerator = std::string(words_.tail_of_line());
}

/// Reads a hint for the samples a pixel; a larger number is clamped, with a warning.
void NffReader::read_spp(std::string_view) {
  const std::string_view word = words_.next();
  const std::string most = std::to_string(kMostSamples);
  std::int64_t samples = 0;
  if (!to_integer(word, samples) || samples < 0)
    input_.fail(word, "a whole number of samples per pixel, from 0 to " + most);
  if (samples > kMostSamples)
    input_.warn_once(
        "spp",
        word,
        quoted(word) + " samples per pixel are more than " + most + ", which are taken");
  file_.samples_per_pixel = int(std::min<std::int64_t>(samples, kMostSamples));
}

}  // namespace

SceneFile read_nff(const std::string& path,
                   std::string_view text,
                   const Warn& warn,
                   const ReadOptions& options,
                   LoadProgress* progress) {
  return NffReader(path, text, warn, options, progress).read(text);
}

}  // namespace grelha
