// A small sailing boat, a mesh with normals, between three mirrors: one below and two walls.
#include <cmath>

#include "scenes/generators.hpp"
#include "scenes/mesh.hpp"
#include "scenes/nff_writer.hpp"

namespace grelha::scenes {

namespace {

// Bow towards +x, mast along +z, scene units. Along the hull u runs from 0 at the stern to 1 at the
// bow.
constexpr double kLength = 3.2, kBeam = 1.0, kDraught = 0.55, kMastX = 0.25, kMastTop = 3.4;

double hull_x(double u) {
  return kLength * (u - 0.5);
}

/// Half the hull's width: a stern cut off, widest behind the middle, almost sharp at the bow.
double half_beam(double u) {
  return kBeam / 2 * (0.02 + 0.98 * (1 - u * u * u) * (0.62 + 0.9 * u * (1 - u / 2)));
}

/// Height of the hull's edge: the sheer rises towards both ends.
double edge_z(double u) {
  return 0.62 + 0.45 * (u - 0.35) * (u - 0.35);
}

/// A section of the hull, `angle` from -90 (right edge) to 90 degrees (left edge).
Vec hull_point(double u, double angle_rad) {
  const double depth = kDraught * (1 - 0.55 * u * u * u);
  return {hull_x(u) + 0.25 * u * u * (1 - std::cos(angle_rad)),
          half_beam(u) * std::sin(angle_rad),
          edge_z(u) - depth * std::cos(angle_rad)};
}

void add_hull(Mesh& mesh, int n) {
  add_surface(
      mesh, 4 * n, 2 * n, [](double u, double v) { return hull_point(u, kPi * (0.5 - v)); });
  // the stern in level strips, stopping short of the very keel
  add_surface(mesh, 1, n, [](double u, double v) {
    const double down = 0.97 * v * kPi / 2;
    return Vec{hull_x(0),
               (2 * u - 1) * half_beam(0) * std::cos(down),
               edge_z(0) - kDraught * std::sin(down)};
  });
  // the deck, arched and a little below the edge
  add_surface(mesh, 2 * n, n, [](double u, double v) {
    const double across = 2 * v - 1;
    return Vec{hull_x(u), 0.98 * half_beam(u) * across, edge_z(u) - 0.05 * across * across};
  });
}

void add_cabin(Mesh& mesh, int n) {
  add_surface(mesh, 2 * n, n, [](double u, double v) {  // half an ellipsoid, open at its very top
    const double around = 2 * kPi * u, up = (0.01 + 0.98 * v) * kPi / 2;
    return Vec{-0.45 + 0.55 * std::cos(around) * std::cos(up),
               0.27 * std::sin(around) * std::cos(up),
               0.58 + 0.32 * std::sin(up)};
  });
}

/// A round bar that tapers from `from` to `to`.
void add_bar(Mesh& mesh, int n, Vec from, Vec to, double from_radius, double to_radius) {
  const Vec axis = normalise(to - from);
  const Vec side = normalise(cross(std::abs(axis.z) < 0.9 ? Vec{0, 0, 1} : Vec{1, 0, 0}, axis));
  add_surface(mesh, n, n / 2 > 0 ? n / 2 : 1, [=](double u, double v) {
    const Vec out = turn(side, axis, 2 * kPi * u);
    return from + v * (to - from) + (from_radius + v * (to_radius - from_radius)) * out;
  });
}

/// A three-cornered sail between tack, clew (the loose corner) and head, blown out to +y by
/// `belly`.
void add_sail(Mesh& mesh, int nu, int nv, Vec tack, Vec clew, Vec head, double belly) {
  add_surface(mesh, nu, nv, [=](double u, double v) {
    const double up = 0.98 * v;  // stops short of the head, where the net would shrink to a point
    const Vec luff = tack + up * (head - tack), leech = clew + up * (head - clew);
    const double bow =
        belly * std::sin(kPi * u) * (0.35 + 0.65 * std::sin(kPi * up)) * (1 - 0.8 * up);
    return luff + u * (leech - luff) + Vec{0, bow, 0};
  });
}

void add_pennant(Mesh& mesh, int n) {
  add_surface(mesh, n, 4, [](double u, double v) {
    const double height = 0.09 * (1 - 0.9 * u) * (2 * v - 1);
    return Vec{kMastX - 0.55 * u, 0.06 * u * std::sin(9 * u), kMastTop - 0.1 + height};
  });
}

Mesh boat_mesh(int n) {
  Mesh mesh;
  add_hull(mesh, n);
  add_cabin(mesh, n);
  add_bar(mesh, n, {kMastX, 0, 0.5}, {kMastX, 0, kMastTop}, 0.045, 0.025);
  add_bar(mesh, n, {kMastX, 0, 1.0}, {-1.45, 0.25, 1.05}, 0.03, 0.02);
  add_sail(mesh,
           3 * n,
           2 * n,
           {kMastX - 0.03, 0, 1.06},
           {-1.4, 0.25, 1.11},
           {kMastX - 0.03, 0, 3.2},
           0.38);
  add_sail(mesh, 2 * n, 2 * n, {1.68, 0, 0.86}, {0.35, 0.22, 1.0}, {kMastX + 0.05, 0, 2.9}, 0.3);
  add_pennant(mesh, n);
  return mesh;
}

}  // namespace

void write_boat_mesh(std::ostream& out, int size) {
  write_ply(out, boat_mesh(size));
}

void write_boat(std::ostream& out, const SceneOptions& options) {
  NffWriter nff(out);
  nff.comment("A sailing boat between three mirrors.");
  nff.background({0.38, 0.58, 0.84});
  nff.view({.from = {4.6, 5.2, 3.2}, .at = {-0.3, 0, 1.5}});
  nff.light({4, 6, 8}, {1, 1, 1});
  nff.surface({.color = {0.75, 0.9, 1}, .kd = 0.35, .ks = 0.5, .shine = 300, .ior = 1});
  nff.plane({1, 0, 0}, {0, 1, 0}, {-1, -1, 0});         // water
  nff.plane({-4, 0, 0}, {-4, 1, 0}, {-4, 0, 1});        // wall behind the stern, faces +x
  nff.plane({0, -3.5, 0}, {0, -3.5, 1}, {1, -3.5, 0});  // wall to the right, faces +y
  nff.surface({.color = {0.85, 0.5, 0.25}, .kd = 0.8, .ks = 0.05, .shine = 20, .ior = 1});
  nff.ply(options.mesh_file);
}

}  // namespace grelha::scenes
