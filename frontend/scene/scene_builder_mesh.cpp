// Meshes in a scene, as SceneBuilder puts them there.
#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "frontend/scene/mesh.hpp"
#include "frontend/scene/scene_builder.hpp"

namespace grelha {

/// Moves the vertices behind those already there. Vertices that cannot be drawn stay, at the
/// origin, so that indices hold; their faces are left out by the caller.
void SceneBuilder::append_vertices(Mesh& mesh) {
  Triangles& t = file_.scene.geometry.triangles;
  const std::size_t before = t.x.size(), count = mesh.vertex_count();
  const auto append = [before](std::vector<float>& all, std::vector<float>& more) {
    if (before == 0)
      all = std::move(more);
    else
      all.insert(all.end(), more.begin(), more.end());
  };
  // `otherwise`: of vertices without any, where others have some
  const auto append_some =
      [&](bool has, std::vector<float>& all, std::vector<float>& more, float otherwise) {
        if (has || !all.empty())
          all.resize(before, otherwise);
        if (has)
          append(all, more);
        else if (!all.empty())
          all.resize(before + count, otherwise);
      };
  bool any_normal = false;
  for (std::size_t i = 0; i < mesh.nx.size(); ++i) {
    const Float3 n = valid_normal({mesh.nx[i], mesh.ny[i], mesh.nz[i]});
    mesh.nx[i] = n.x;
    mesh.ny[i] = n.y;
    mesh.nz[i] = n.z;
    any_normal = any_normal || n != Float3{};
  }
  append_some(any_normal, t.nx, mesh.nx, 0);
  append_some(any_normal, t.ny, mesh.ny, 0);
  append_some(any_normal, t.nz, mesh.nz, 0);
  const bool colors = !mesh.red.empty() && !mesh.colors_of_faces;
  append_some(colors, t.red, mesh.red, 1);
  append_some(colors, t.green, mesh.green, 1);
  append_some(colors, t.blue, mesh.blue, 1);
  append(t.x, mesh.x);
  append(t.y, mesh.y);
  append(t.z, mesh.z);
}

/// Keeps triangles without area: they join what lies along a longer side, and number the faces.
SceneBuilder::Result SceneBuilder::mesh_face(std::span<const std::uint32_t> indices,
                                             std::uint32_t first_vertex,
                                             std::uint32_t material) {
  if (indices.size() == 3) {
    const std::uint32_t a = first_vertex + indices[0], b = first_vertex + indices[1],
                        c = first_vertex + indices[2];
    add_triangle(a, b, c, material);
    return Result::kCut;
  }
  face_.clear();
  face_vertices_.clear();
  for (const std::uint32_t i : indices) {
    const std::uint32_t v = first_vertex + i;
    face_.push_back(point(v));
    face_vertices_.push_back(v);
  }
  triangles_.clear();
  const Result result = splitter_.cut(face_, triangles_);
  if (indices.size() < 3)
    drop_flat(face_);
  for (std::uint32_t i = 2; result == Result::kNoArea && i < indices.size(); ++i)
    triangles_.push_back({0, i - 1, i});
  add_intersections();
  for (const auto& [i, j, k] : triangles_)
    add_triangle(face_vertices_[i], face_vertices_[j], face_vertices_[k], material);
  return result;
}

/// Values of vertices at the face's corners; of none: zeros.
std::vector<Float3> SceneBuilder::at_corners(const std::vector<float>& x,
                                             const std::vector<float>& y,
                                             const std::vector<float>& z) const {
  std::vector<Float3> values(face_.size());
  for (std::size_t i = 0; i < face_.size() && !x.empty(); ++i) {
    const std::uint32_t v = face_vertices_[i];
    values[i] = {x[v], y[v], z[v]};
  }
  return values;
}

/// Adds vertices where sides of the face cross.
void SceneBuilder::add_intersections() {
  if (splitter_.intersections().empty())
    return;
  const Triangles& t = file_.scene.geometry.triangles;
  const std::vector<Float3> normals = at_corners(t.nx, t.ny, t.nz);
  const std::vector<Float3> colors = at_corners(t.red, t.green, t.blue);
  for (const SideCrossing& crossing : splitter_.intersections())
    face_vertices_.push_back(add_vertex(at_crossing(face_, crossing),
                                        valid_normal(at_crossing(normals, crossing)),
                                        at_crossing(colors, crossing)));
}

std::vector<std::uint32_t> materials_of_colors(const Mesh& mesh,
                                               std::vector<Material>& all,
                                               std::uint32_t of) {
  const Material plain = all[of];
  std::map<std::array<float, 3>, std::uint32_t> found;
  std::vector<std::uint32_t> materials(mesh.red.size());
  for (std::size_t f = 0; f < materials.size(); ++f) {
    const std::array color{mesh.red[f], mesh.green[f], mesh.blue[f]};
    const auto [at, is_new] = found.try_emplace(color, std::uint32_t(all.size()));
    materials[f] = at->second;
    if (!is_new)
      continue;
    all.push_back(plain);
    for (Float3* const c : {&all.back().diffuse, &all.back().emission})
      *c = {c->x * color[0], c->y * color[1], c->z * color[2]};
  }
  all.push_back(plain);
  return materials;
}

/// Those of a mesh that has a colour for each of `count` faces or points; else none.
std::vector<std::uint32_t> SceneBuilder::materials_of(const Mesh& mesh,
                                                      std::size_t count,
                                                      std::uint32_t of) {
  if (mesh.red.empty() || mesh.red.size() != count)
    return {};
  return materials_of_colors(mesh, file_.scene.materials, of);
}

/// Draws vertices as balls. Of those in a row at one place the first one is seen: some scanners
/// write zeros for what they did not see.
void SceneBuilder::points(const Mesh& mesh, std::uint32_t material) {
  const float asked = file_.frame.length(options_.point_radius);
  const float radius = asked > 0 ? asked : radius_for(mesh.x, mesh.y, mesh.z);
  const auto materials = materials_of(mesh, mesh.vertex_count(), material);
  const auto place = [&](std::size_t i) { return Float3{mesh.x[i], mesh.y[i], mesh.z[i]}; };
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i)
    if (i == 0 || place(i) != place(i - 1))
      sphere(place(i), radius, materials.empty() ? material : materials[i]);
  Points& all = file_.points;
  all.least = all.count == 0 ? radius : std::min(all.least, radius);
  all.most = std::max(all.most, radius);
  all.count += mesh.vertex_count();
}

namespace {

/// The solids of a mesh as meshes of their own, one after the other.
class SolidsInTurn {
 public:
  explicit SolidsInTurn(const Mesh& all) : all_(all) {}

  Mesh next(const Solid& solid) {
    Mesh one;
    one.indices.assign(all_.indices.begin() + at(corner_),
                       all_.indices.begin() + at(corner_ + solid.corners));
    const std::size_t end = 1 + *std::ranges::max_element(one.indices);
    for (std::uint32_t& index : one.indices)
      index -= std::uint32_t(vertex_);
    const auto copy = [&](const std::vector<float>& from, std::vector<float>& to) {
      to.assign(from.begin() + at(vertex_), from.begin() + at(end));
    };
    copy(all_.x, one.x);
    copy(all_.y, one.y);
    copy(all_.z, one.z);
    if (!all_.sizes.empty())
      one.sizes.assign(all_.sizes.begin() + at(face_),
                       all_.sizes.begin() + at(face_ + solid.faces));
    vertex_ = end;
    corner_ += solid.corners;
    face_ += solid.faces;
    return one;
  }

 private:
  static std::ptrdiff_t at(std::size_t i) { return std::ptrdiff_t(i); }

  const Mesh& all_;
  std::size_t vertex_ = 0, corner_ = 0, face_ = 0;
};

}  // namespace

CrossedFaces SceneBuilder::mesh(Mesh mesh, std::uint32_t material) {
  file_.colors.of_faces |= mesh.colors_of_faces;
  file_.colors.of_vertices |= !mesh.colors_of_faces && !mesh.red.empty();
  file_.colors.alpha |= mesh.has_alpha;
  if (mesh.face_count() == 0) {
    if (mesh.vertex_count() > 0)
      points(mesh, material);
    return {};
  }
  if (mesh.solids.empty())
    return object(std::move(mesh), material, options_.smooth_deg > 0);
  CrossedFaces crossed;
  std::uint64_t faces = 0;
  const Triangles& t = file_.scene.geometry.triangles;
  SolidsInTurn solids(mesh);
  for (const Solid& solid : mesh.solids) {
    const auto first_triangle = std::uint32_t(t.size()),
               first_vertex = std::uint32_t(t.vertex_count());
    crossed.add(object(solids.next(solid), material, false), faces);
    faces += solid.faces;
    const Object own{first_triangle, std::uint32_t(t.size()) - first_triangle};
    if (own.triangle_count == 0)
      file_.scene.geometry.objects.push_back(own);
    file_.solids.push_back({solid.name, solid.faces, own, first_vertex});
  }
  if (options_.smooth_deg > 0)
    smooth_solids(std::span(file_.solids).last(mesh.solids.size()));
  return crossed;
}

/// Smooths over the seams between solids. What that doubles are the last vertices: they move behind
/// those of their solid.
void SceneBuilder::smooth_solids(std::span<NamedObject> solids) {
  Triangles& t = file_.scene.geometry.triangles;
  const auto first = solids.front().first_vertex, end = std::uint32_t(t.vertex_count());
  smooth_normals(t, solids.front().triangles.first_triangle, options_.smooth_deg);
  std::vector<std::uint32_t> order, moved(t.vertex_count() - first, 0);
  const auto put = [&](std::uint32_t vertex) {
    order.push_back(vertex);
    moved[vertex - first] = first + std::uint32_t(order.size()) - 1;
  };
  for (std::size_t s = 0; s < solids.size(); ++s) {
    const std::uint32_t begin = solids[s].first_vertex;
    solids[s].first_vertex = first + std::uint32_t(order.size());
    for (std::uint32_t v = begin; v < (s + 1 < solids.size() ? solids[s + 1].first_vertex : end);
         ++v)
      put(v);
    const Object& own = solids[s].triangles;
    for (std::uint32_t i = own.first_triangle; i < own.first_triangle + own.triangle_count; ++i)
      for (auto* const corner : {&t.a, &t.b, &t.c}) {
        if ((*corner)[i] >= end && moved[(*corner)[i] - first] == 0)
          put((*corner)[i]);
        (*corner)[i] = moved[(*corner)[i] - first];
      }
  }
  for (auto* const of : {&t.x, &t.y, &t.z, &t.nx, &t.ny, &t.nz, &t.red, &t.green, &t.blue}) {
    const std::vector<float> before = *of;
    for (std::size_t i = 0; i < order.size() && !of->empty(); ++i)
      (*of)[first + i] = before[order[i]];
  }
}

CrossedFaces SceneBuilder::object(Mesh mesh, std::uint32_t material, bool smooth) {
  Triangles& t = file_.scene.geometry.triangles;
  const auto first_vertex = std::uint32_t(t.vertex_count()),
             first_triangle = std::uint32_t(t.size());
  std::vector<bool> bad;  // empty when every vertex can be drawn
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    if (is_finite_float(Float3{mesh.x[i], mesh.y[i], mesh.z[i]}))
      continue;
    bad.resize(mesh.vertex_count());
    bad[i] = true;
    mesh.x[i] = mesh.y[i] = mesh.z[i] = 0;
  }
  const bool has_normals = !mesh.nx.empty();
  append_vertices(mesh);
  const std::vector<std::uint32_t> materials =
      materials_of(mesh, mesh.colors_of_faces ? mesh.face_count() : 0, material);
  const std::size_t wanted = t.size() + mesh.face_count();
  // at least twice as much as before: a scene may name thousands of small meshes
  if (wanted > t.a.capacity()) {
    const std::size_t capacity = std::max(wanted, 2 * t.a.capacity());
    t.a.reserve(capacity);
    t.b.reserve(capacity);
    t.c.reserve(capacity);
    t.material.reserve(capacity);
  }
  CrossedFaces crossed;
  if (mesh.sizes.empty() && bad.empty() && materials.empty())
    mesh_triangles(mesh.indices, first_vertex, material);
  else
    crossed = mesh_faces(mesh, bad, first_vertex, material, materials);
  if (smooth && !has_normals)
    smooth_normals(t, first_triangle, options_.smooth_deg);
  const auto count = std::uint32_t(t.size()) - first_triangle;
  if (count > 0)
    file_.scene.geometry.objects.push_back({first_triangle, count});
  return crossed;
}

/// The common case, without a look at each face's size.
void SceneBuilder::mesh_triangles(std::span<const std::uint32_t> indices,
                                  std::uint32_t first_vertex,
                                  std::uint32_t material) {
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    add_triangle(first_vertex + indices[i],
                 first_vertex + indices[i + 1],
                 first_vertex + indices[i + 2],
                 material);
}

CrossedFaces SceneBuilder::mesh_faces(const Mesh& mesh,
                                      const std::vector<bool>& bad,
                                      std::uint32_t first_vertex,
                                      std::uint32_t material,
                                      std::span<const std::uint32_t> materials) {
  CrossedFaces crossed;
  std::size_t at = 0;
  for (std::size_t f = 0, faces = mesh.face_count(); f < faces; ++f) {
    const std::size_t size = mesh.sizes.empty() ? 3 : mesh.sizes[f];
    const std::span<const std::uint32_t> indices(mesh.indices.data() + at, size);
    at += size;
    if (!bad.empty() &&
        std::any_of(indices.begin(), indices.end(), [&](std::uint32_t v) { return bad[v]; })) {
      ++file_.dropped.not_finite;
      continue;
    }
    crossed.add(mesh_face(indices, first_vertex, materials.empty() ? material : materials[f]), f);
  }
  return crossed;
}

void CrossedFaces::add(PolygonSplitter::Result result, std::uint64_t face) {
  using Result = PolygonSplitter::Result;
  if (result == Result::kFolded) {
    if (++folded == 1)
      first_folded = face;
  } else if (result == Result::kFilled || result == Result::kCutLimit) {
    if (filled + left_out == 0)
      first = face;
    ++(result == Result::kFilled ? filled : left_out);
  }
}

void CrossedFaces::add(const CrossedFaces& more, std::uint64_t faces) {
  if (filled + left_out == 0)
    first = more.first + faces;
  if (folded == 0)
    first_folded = more.first_folded + faces;
  filled += more.filled;
  left_out += more.left_out;
  folded += more.folded;
}

/// `face 3 from 0 crosses itself`, or the same of several.
static std::string faces_that(std::uint64_t count,
                              std::uint64_t first,
                              const std::string& one,
                              const std::string& several) {
  const std::string which = "face " + std::to_string(first) + " from 0";
  return count == 1 ? which + one
                    : std::to_string(count) + " faces" + several + ", " + which + " is the first";
}

std::string CrossedFaces::text() const {
  std::string text;
  if (filled + left_out > 0)
    text = faces_that(filled + left_out, first, " crosses itself", " cross themselves") +
           ": filled by the even-odd rule";
  if (left_out > 0)
    text += ", but " + std::to_string(left_out) + " that cross themselves too often are left out";
  if (folded > 0)
    text += (text.empty() ? "" : "; ") +
            faces_that(folded, first_folded, " folds over itself", " fold over themselves") +
            ": what is seen along the normal is filled";
  return text;
}

}  // namespace grelha
