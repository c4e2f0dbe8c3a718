#pragma once

#include <iosfwd>
#include <span>
#include <string>
#include <string_view>

namespace grelha::scenes {

struct SceneOptions {
  int size = 1;           ///< the scene's size factor, inside the generator's bounds
  bool spd = false;       ///< balls, mount: Haines' own form in place of the course's (below)
  std::string mesh_file;  ///< boat, knot, terrain: name of the mesh as the scene file states it
};

/// The scenes this project can make. Haines, "A Proposal for Standard Graphics Environments" (1987)
/// and the programs of his Standard Procedural Databases 3.14 have the constructions. distant,
/// boat, stadium, knot, terrain, discs, star and awning are our own. So are the colours of gears
/// and the heights of mount beyond size 7.
///
///  name     size     size n gives                                                   default
///  balls    1-7      (9^(n+1) - 1) / 8 spheres and one plane (--spd: a 4-gon)       4: 7381
///  mount    1-10     2 4^n triangles and 4 spheres                                  7: 32768
///  distant  1-100    n spheres over a plane, seen through a lens                    3
///  boat     4-40     46 n^2 + 10 n triangles of a PLY file, three planes            10: 4700
///  stadium  1-40     288 n^2 patches of three vertices, one 4-gon                   6: 10368
///  knot     1-40     288 n^2 triangles of a PLY file, one sphere, one plane         8: 18432
///  terrain  1-250    512 n^2 triangles of a binary PLY file, two spheres            20: 204800
///  tetra    1-10     4^n triangles                                                  6: 4096
///  gears    1-10     2 n^3 144-gons and 144 n^3 + 1 4-gons                          4: 128, 9217
///  rings    1-40     5n (n+1) (2n+1) spheres and as many cylinders, one 4-gon       7: 4200
///  tree     0-16     2^(n+1) - 1 cones and as many spheres, one 4-gon               11: 4095
///  lattice  1-50     (n+1)^3 spheres, 3n (n+1)^2 cylinders                          12: 2197, 6084
///  discs    1-512    n^2 spheres of a tenth of a pixel's radius at 512x512          64: 4096
///  star     2-1000   n spokes, a triangle each                                      36
///  awning   1-500    n^2 4-gons between an area light and a plane                   64: 4096
///
/// The course's form of balls and mount has lights of the colour 1 1 1 and an infinite plane for a
/// floor. Its glass has index 1.2, and three of its four balls shrink so that they do not touch.
struct Generator {
  std::string_view name, summary;
  int min_size, max_size, default_size;
  void (*write)(std::ostream& out, const SceneOptions& options);
  /// the PLY file the scene refers to, when it has one
  void (*write_mesh)(std::ostream& out, int size) = nullptr;
  bool has_spd_form = false;  ///< whether SceneOptions::spd makes another scene
};

std::span<const Generator> generators();
const Generator* find_generator(std::string_view name);  ///< null when there is none

void write_balls(std::ostream& out, const SceneOptions& options);
void write_mount(std::ostream& out, const SceneOptions& options);
void write_distant(std::ostream& out, const SceneOptions& options);
void write_boat(std::ostream& out, const SceneOptions& options);
void write_boat_mesh(std::ostream& out, int size);
void write_stadium(std::ostream& out, const SceneOptions& options);
void write_knot(std::ostream& out, const SceneOptions& options);
void write_knot_mesh(std::ostream& out, int size);
void write_terrain(std::ostream& out, const SceneOptions& options);
void write_terrain_mesh(std::ostream& out, int size);
void write_tetra(std::ostream& out, const SceneOptions& options);
void write_gears(std::ostream& out, const SceneOptions& options);
void write_rings(std::ostream& out, const SceneOptions& options);
void write_tree(std::ostream& out, const SceneOptions& options);
void write_lattice(std::ostream& out, const SceneOptions& options);
void write_discs(std::ostream& out, const SceneOptions& options);
void write_awning(std::ostream& out, const SceneOptions& options);
void write_star(std::ostream& out, const SceneOptions& options);

}  // namespace grelha::scenes
