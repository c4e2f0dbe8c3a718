#pragma once
// A World with the arrays that it refers to, made from arrays of a caller.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "grelha/coordinates.hpp"
#include "grelha/geometry.hpp"
#include "grelha/world.hpp"

namespace grelha {

/// Thrown for a number that no scene can have: "NAME: expected ..., found NUMBER in triangle 3".
struct BadNumber : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
  std::string found{};                  ///< the number
  std::size_t row = 0;                  ///< the point, triangle or sphere that has it
  std::optional<std::size_t> column{};  ///< the axis of a point, the corner of a triangle
};

/// A scene that counts from an offset: a point of the caller is its own + offset.
struct OffsetScene : Scene {
  std::array<double, 3> offset{};  ///< scene units
  /// of several meshes (meshes.hpp) the first vertex of each, and the number of vertices;
  /// geometry.objects are their triangles then; empty: one mesh
  std::vector<std::uint32_t> first_vertices{};
  /// of several meshes in double x y z of all vertices as they were given: another offset rounds
  /// them anew; empty: the offset + geometry.triangles
  std::vector<double> doubles{};
};

/// Copies faces, each three indices below `vertices`, counter-clockwise from the front: triangles
/// without vertices, for scene_of(). Throws BadNumber for other indices. Index is std::uint32_t or
/// std::int64_t.
template <class Index>
Geometry triangles_of(std::span<const std::array<Index, 3>> faces, std::size_t vertices);

/// Copies radii above 0 and within 1e18: spheres without centers, for scene_of(). Throws BadNumber
/// for others. Number is float or double, which is rounded.
template <class Number>
Geometry spheres_of(std::span<const Number> radii);

/// A scene of triangles alone with these vertices, or of spheres alone with these centers. Doubles
/// get the offset of the PointBounds of those that are used: it is subtracted in double, then the
/// difference is rounded to float. Floats have the offset 0. Rays and points of queries must have
/// it subtracted too. Vertices that no triangle names may be anything. Throws BadNumber for another
/// point that is not finite and within 1e18, and std::invalid_argument for too few points and for
/// other shapes.
OffsetScene scene_of(const PointArray& points, Geometry shapes);

/// The coordinates of points, x y z of each.
std::vector<double> doubles_of(const PointArray& points);

/// A World and the scene that it refers to. Threads may share it while nobody moves or masks it.
class OwningWorld {
 public:
  /// Builds the grids. Throws what World's constructor throws.
  OwningWorld(OffsetScene scene, const BuildOptions& options)
      : scene_(std::move(scene)), world_(scene_, options) {}
  /// The same where the triangles of some objects moved since `before`, and nothing else changed:
  /// World's constructor shares grids of the others. Masks are not taken over.
  OwningWorld(OffsetScene scene,
              const BuildOptions& options,
              const OwningWorld& before,
              std::span<const Object> moved)
      : scene_(std::move(scene)), world_(scene_, options, before.world_, moved) {}

  /// Replaces the points that scene_of() was given, by as many: the same as building a new World
  /// with this offset, bit for bit. Of doubles the offset is PointBounds::offset(offset before), so
  /// it stays unless floats from there would be too coarse; it is subtracted. Floats count from it.
  /// Throws what scene_of() and World's constructor throw. The world is then as it was.
  void move(const PointArray& points, const BuildOptions& options);
  /// Replaces the scene by one where the triangles of some objects moved or were added, or some
  /// objects were hidden or shown, and nothing else changed: World's constructor shares grids of
  /// the others. Masks stay, those of what was added are 255. Throws what that throws, and then
  /// nothing has changed. Functions of meshes.hpp do the same without a copy of the scene.
  void replace(OffsetScene scene, const BuildOptions& options, std::span<const Object> moved);
  /// Gives each primitive a mask (QueryOptions::mask), or none takes the masks away. Throws
  /// std::invalid_argument for another number.
  void set_masks(std::span<const std::uint8_t> masks);

  const World& world() const { return world_; }                   ///< for queries
  const OffsetScene& scene() const { return scene_; }             ///< what the World refers to
  std::span<const std::uint8_t> masks() const { return masks_; }  ///< [primitives], or empty

 private:
  friend class MeshEdit;  // of meshes.cpp
  OffsetScene scene_;
  World world_;
  std::vector<std::uint8_t> masks_;
};

}  // namespace grelha
