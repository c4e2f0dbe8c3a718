#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "grelha/camera.hpp"
#include "grelha/coordinates.hpp"
#include "grelha/geometry.hpp"

namespace grelha {

/// The coordinate frame of a scene. A coordinate in the file is offset + coordinate in the scene /
/// scale.
///
/// Floats have seven digits: for a survey in metres from the equator they resolve decimetres. The
/// coordinates of such a scene count from near its middle, and are doubles until the offset is
/// subtracted. A scene so small that squares of its lengths underflow is enlarged. The scale is a
/// power of two and the offset a multiple of one, so they cost no digit.
struct Frame {
  std::array<double, 3> offset{};
  double scale = 1;

  bool operator==(const Frame&) const = default;
  /// A coordinate of the file, in the scene.
  float inside(double coordinate, std::size_t axis) const {
    return static_cast<float>((coordinate - offset[axis]) * scale);
  }
  Float3 inside(const std::array<double, 3>& p) const {
    return {inside(p[0], 0), inside(p[1], 1), inside(p[2], 2)};
  }
  /// The distance of the plane normal . p = distance from the origin, in the scene.
  double distance(const std::array<double, 3>& normal, double distance) const {
    for (std::size_t a = 0; a < 3; ++a)
      distance -= offset[a] * normal[a];
    return distance * scale;
  }
  float length(double length) const { return static_cast<float>(length * scale); }
  /// A coordinate of the scene, in the file.
  double outside(float coordinate, std::size_t axis) const {
    return offset[axis] + static_cast<double>(coordinate) / scale;
  }
  std::array<double, 3> outside(const Float3& p) const {
    return {outside(p.x, 0), outside(p.y, 1), outside(p.z, 2)};
  }
};

/// "1000 0 0", and the scale: for messages.
std::string text_of(const Frame& frame);

/// Counts of entities as written in the file: a polygon is one `p`, for any number of triangles;
/// `mesh` and `ply` count faces.
struct EntityCounts {
  std::uint64_t s = 0, p = 0, pp = 0, c = 0, pl = 0, box = 0, mesh = 0, ply = 0, lights = 0,
                materials = 0;
  bool operator==(const EntityCounts&) const = default;
};

/// Primitives left out because they cannot be drawn.
struct Dropped {
  std::uint64_t not_finite = 0, zero_area = 0;
  PointBounds flat;  ///< of the corners of those without area, which may have some in double
};

/// A solid of a text STL file. Its triangles are an object of the scene.
struct NamedObject {
  std::string name;
  std::uint64_t faces = 0;  ///< in the file
  Object triangles;
  std::uint32_t first_vertex = 0;  ///< vertices up to the next solid's are its own
};

/// Vertices of meshes without faces, which are drawn as balls.
struct Points {
  std::uint64_t count = 0;
  float least = 0, most = 0;  ///< radii
};

/// Lens fields as the file states them; `present` if the file has any.
struct LensHint {
  bool present = false;
  double aperture = 0;  ///< lens diameter in pixels of the view plane at `at`; 0: pinhole
  double focal = 1;     ///< focal distance as a multiple of the distance from eye to `at`
};

/// The order in which the six numbers of a file's `aabb` were read.
enum class BoxOrder : std::uint8_t {
  kNone,      ///< the file has no `aabb`
  kVertices,  ///< two opposite corners
  kPairs,     ///< xmin xmax ymin ymax zmin zmax
};

/// The kinds of colours that meshes have. Alpha is not used.
struct ColorCounts {
  bool of_vertices = false, of_faces = false, alpha = false;
  bool any() const { return of_vertices || of_faces; }
};

/// Size of a mesh, for pictures of any format and from any side.
struct MeshExtent {
  Float3 center;                ///< of a box around it
  double margin = 0;            ///< radius of balls about its points
  double low = 0, high = 0;     ///< from the center along the up direction
  std::vector<double> radii{};  ///< about that axis, of equal slabs from low to high; -1: of none
  bool is_known() const { return !radii.empty(); }
  /// around the point that its made-up camera looks at, across the view and along it
  double half_width = 0, half_depth = 0;
};

/// A scene file after all checks: everything the kernel needs and what the file said besides.
struct SceneFile {
  Scene scene;
  Camera camera;
  Frame frame;  ///< in which all lies
  EntityCounts counts;
  ColorCounts colors;
  Dropped dropped;
  Points points;
  std::vector<NamedObject> solids;
  LensHint lens;
  std::string accelerator;    ///< `accel` hint as written, or empty
  int samples_per_pixel = 0;  ///< `spp` hint, 0: none
  BoxOrder box_order = BoxOrder::kNone;
  std::string environment;  ///< `env` folder as written, or empty
  /// of text or binary input in memory at once
  std::uint64_t source_bytes = 0;
  std::vector<std::string> meshes;                     ///< files it named
  bool default_camera = false, default_light = false;  ///< made up, for a bare PLY
  MeshExtent extent;                                   ///< of a bare mesh
};

/// Called with one line per warning, `file:line:column: warning: ...`.
using Warn = std::function<void(const std::string&)>;

/// Options of meshes.
struct MeshOptions {
  bool colors = true;  ///< are read
  /// of balls in place of vertices, where there are no faces, in the file's units; 0: such that
  /// they leave few gaps
  double point_radius = 0;
  double smooth_deg = 0;  ///< of smooth_normals(), where no vertex has a normal; 0: none
};

struct ReadOptions {
  bool allow_outside = false;  ///< a scene may name files outside its own folder
  MeshOptions meshes{};
  Frame frame{};  ///< to read it in
  /// Receives the share done, 0 to 1, never less than before. If it returns false, reading throws
  /// Stopped.
  std::function<bool(double)> progress{};
};

/// Returns a more precise frame for a scene that was read in the file's own frame, if there is one.
std::optional<Frame> find_frame(const SceneFile& file);

/// Returns true if the file's own frame loses precision: a coordinate read in `file.frame` is not a
/// float there.
bool needs_frame(const SceneFile& file);

/// The bounding box of all finite primitives. Vertices count if a triangle uses them.
struct SceneBounds {
  bool empty = true;
  Float3 low, high;
};

SceneBounds bounds_of(const Geometry& geometry);

}  // namespace grelha
