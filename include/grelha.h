#ifndef GRELHA_H
#define GRELHA_H
/// @file
/// Every function of C.
//
// The C interface of Grelha: exact ray queries against triangles or spheres. C99; also C++.
//
//     grelha_world* world;
//     if (grelha_new_triangles(vertices, 12, 8, indices, 12, 0, &world) != GRELHA_OK)
//       puts(grelha_last_error());
//     grelha_rays ray = {.count = 1, .org = org, .org_stride = 12, .dir = dir, .dir_stride = 12};
//     grelha_closest(world, &ray, &(grelha_hits){.t = &t, .id = &id}, 1);
//     grelha_free(world);
//
// Shapes    Points and directions are three floats x y z. A stride is the number of bytes from one
//           to the next: 12 if they follow each other. All counts are numbers of elements.
// Units     Lengths are in the caller's units, within 1e18. t counts multiples of the direction.
// Ids       The id of a triangle is its place in the caller's indices, that of a sphere its place
//           in the caller's arrays.
// Threads   Queries do not change a world, so any number of threads may ask one. While a function
//           that takes a world without const runs, no other call may use that world. The argument
//           `threads` says how many share one call: 1: the calling thread alone; 0: one per
//           processor. The number changes no bit of an answer.
// Errors    Functions that can fail return a grelha_status. They then say why by
//           grelha_last_error(). No exception leaves a function. Nothing is printed.
// Answers   They go to arrays of the caller. After an error their contents are unspecified.
#include <stddef.h>
#include <stdint.h>

/// @def GRELHA_API
/// Marks what libgrelha.so exports.
#if defined(__GNUC__)
#define GRELHA_API __attribute__((visibility("default")))
#else
#define GRELHA_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/// What became of a call.
typedef enum grelha_status {
  GRELHA_OK = 0,          ///< done
  GRELHA_INVALID = 1,     ///< an argument is wrong: null, out of range, or not a number
  GRELHA_TOO_MANY = 2,    ///< more primitives than ids, or more hits than there is room for
  GRELHA_NO_MEMORY = 3,   ///< the memory ran out
  GRELHA_FAILED = 4,      ///< anything else, for example threads that could not be started
  GRELHA_NOT_CLOSED = 5,  ///< a mesh is not closed, or not oriented, as an inside rule asks
  GRELHA_STOPPED = 6      ///< the function of grelha_set_progress() ended it
} grelha_status;

/// The id where there is no primitive.
#define GRELHA_NONE 0xFFFFFFFFu
/// The stride of an array with one element that all rays share.
#define GRELHA_SHARED ((ptrdiff_t)-1)

/// Triangles or spheres, ready for queries. It owns copies of all it needs.
typedef struct grelha_world grelha_world;

/// Rays in arrays of the caller. Members that are left out of an initializer are 0 or null.
///
/// A ray hits nothing where t_max <= t_min, where its direction is shorter than 1e-18 or longer
/// than 1e18, and where one of its numbers is NaN.
typedef struct grelha_rays {
  size_t count;      ///< number of rays
  const float* org;  ///< [count] x y z of the origins, within 1e18
  /// bytes from one origin to the next, a multiple of 4; GRELHA_SHARED; anything for one ray
  ptrdiff_t org_stride;
  const float* dir;      ///< [count] x y z of the directions; they need not have unit length
  ptrdiff_t dir_stride;  ///< as org_stride
  const float* t_min;    ///< [count] hits at or before it do not count; null: 0 for all
  const float* t_max;    ///< [count] hits at or behind it do not count; null: infinity for all
  const uint32_t* skip;  ///< [count] id that the ray does not hit, or GRELHA_NONE; null: no id
  /// [count] masks, see grelha_set_masks(); null: 255 for all
  const uint8_t* mask;
} grelha_rays;

/// Arrays of the caller for the nearest hits. Those that are null are not wanted.
typedef struct grelha_hits {
  float* t;      ///< [count] out: hit point is org + t dir; without a hit, the ray's t_max
  uint32_t* id;  ///< [count] out: id of the primitive; GRELHA_NONE without a hit
  /// [count] out: the point on the triangle a b c is (1 - u - v) a + u b + v c. u and v are never
  /// negative, and together at most 1. They are 0 for spheres and without a hit.
  float* u;
  float* v;  ///< [count] out: see u
} grelha_hits;

/// Is called with a hit: the number of the ray, t and the id. Returns 0 if this ray needs no more
/// hits, else another number. It must return: no longjmp.
typedef int (*grelha_visit)(void* context, size_t ray, float t, uint32_t id);

/// Is called with the fraction done, from 0 to 1. Returns 0 to end the call, else another number.
/// It must return: no longjmp. It must not call functions that take a world.
typedef int (*grelha_progress)(void* context, double done);

/// Returns the version of the library, for example "0.1.0".
GRELHA_API const char* grelha_version(void);

/// Returns one line that says why the last failed call of this thread failed; "" if none did. The
/// text stays until the next call of this thread fails. It is cut after 255 bytes.
GRELHA_API const char* grelha_last_error(void);

/// Lets further calls of this thread report how far they are, and end early. Functions that take
/// `threads`, and grelha_each_hit(), call `progress` from time to time, from one thread at a time,
/// which need not be the caller's. Where it returns 0 they soon return GRELHA_STOPPED, and a world
/// that they were changing is as it was. What the first call of grelha_contains() prepares does not
/// end early. `context` is passed on. Null: calls are not reported, as at first.
GRELHA_API void grelha_set_progress(grelha_progress progress, void* context);

/// Makes a world of triangles from a copy of the arrays. Stores it in *world, null after an error.
///
/// Shapes    vertices: vertex_count points, vertex_stride bytes apart, which may be any number but
///           0. indices: three for each triangle, counter-clockwise from the front.
/// Requires  finite vertices within 1e18, where a triangle names them; indices below vertex_count;
///           fewer than 2^32 - 1 triangles and at most 2^32 vertices.
/// Errors    GRELHA_INVALID, GRELHA_TOO_MANY, GRELHA_NO_MEMORY, GRELHA_FAILED.
/// Ensures   no ray slips between triangles that share an edge with the same coordinates. Nothing
///           depends on `threads`.
GRELHA_API grelha_status grelha_new_triangles(const float* vertices,
                                              ptrdiff_t vertex_stride,
                                              size_t vertex_count,
                                              const uint32_t* indices,
                                              size_t triangle_count,
                                              int threads,
                                              grelha_world** world);

/// The same of vertices in double, three doubles x y z each. The world chooses an offset near their
/// middle. It subtracts the offset in double, then rounds to float. The offset is 0 if that middle
/// is at most four sizes of the mesh from the origin. Rays, points and answers count from the
/// offset: see grelha_offset().
GRELHA_API grelha_status grelha_new_triangles_double(const double* vertices,
                                                     ptrdiff_t vertex_stride,
                                                     size_t vertex_count,
                                                     const uint32_t* indices,
                                                     size_t triangle_count,
                                                     int threads,
                                                     grelha_world** world);

/// Makes a world of spheres from a copy of the arrays. Stores it in *world, null after an error.
///
/// Shapes    centers: `count` points, center_stride bytes apart, which may be any number but 0.
///           radii: `count` floats.
/// Requires  finite centers within 1e18; radii above 0 and within 1e18; fewer than 2^32 - 1
///           spheres.
/// Errors    GRELHA_INVALID, GRELHA_TOO_MANY, GRELHA_NO_MEMORY, GRELHA_FAILED.
GRELHA_API grelha_status grelha_new_spheres(const float* centers,
                                            ptrdiff_t center_stride,
                                            const float* radii,
                                            size_t count,
                                            int threads,
                                            grelha_world** world);

/// The same of centers and radii in double, with an offset as grelha_new_triangles_double().
GRELHA_API grelha_status grelha_new_spheres_double(const double* centers,
                                                   ptrdiff_t center_stride,
                                                   const double* radii,
                                                   size_t count,
                                                   int threads,
                                                   grelha_world** world);

/// Stores the x y z that the world subtracted from coordinates in double; 0 0 0 for a world of
/// floats. A point p of the caller is p - offset for the world. Fails with GRELHA_INVALID for null.
GRELHA_API grelha_status grelha_offset(const grelha_world* world, double offset[3]);

/// Moves the vertices of a world of triangles, or the centers of one of spheres. Indices and radii
/// stay. The grids are built anew: answers are those of a new world, bit for bit.
///
/// Shapes    points: as many as the world has, of all meshes one after the other, `stride` bytes
///           apart, not 0. They count from grelha_offset().
/// Errors    as for the function that made the world. The world is then as it was before.
GRELHA_API grelha_status grelha_update(
    grelha_world* world, const float* points, ptrdiff_t stride, size_t count, int threads);

/// The same of points in double, three doubles x y z each. They count from 0. grelha_offset() then
/// changes if it is more than four sizes of the points' box from the box's middle.
GRELHA_API grelha_status grelha_update_double(
    grelha_world* world, const double* points, ptrdiff_t stride, size_t count, int threads);

/// Gives each primitive a mask, by id. A ray hits only primitives p with (masks[p] & its own mask)
/// != 0. Points are not masked. Copies the array; null and a count of 0 take the masks away.
///
/// Threads   as grelha_update(): no other call may use the world meanwhile.
/// Errors    GRELHA_INVALID if `count` is neither 0 nor the number of primitives.
GRELHA_API grelha_status grelha_set_masks(grelha_world* world, const uint8_t* masks, size_t count);

/// Edges of a kind, and the first of them: the triangle with the lowest id that has one, and the
/// vertices from which and to which it goes, as that triangle names them.
typedef struct grelha_edges {
  size_t count;
  uint32_t id, from, to;  ///< GRELHA_NONE if there are none
} grelha_edges;

/// Triangles of a kind, and the lowest id.
typedef struct grelha_ids {
  size_t count;
  uint32_t id;  ///< GRELHA_NONE if there are none
} grelha_ids;

/// Properties of a world's triangles as a mesh. Vertices at one place are one vertex, whatever
/// their indices; triangles with two corners at one place have no edges. Triangles that are not
/// finite are left out, as queries do.
typedef struct grelha_mesh_check {
  size_t triangles;  ///< finite ones
  size_t vertices;   ///< places of corners
  size_t edges;
  grelha_edges open;  ///< of an odd number of triangles; none: the mesh is closed
  /// of an even number of triangles that do not go each way by halves; none: the mesh is oriented
  grelha_edges inconsistent;
  grelha_edges nonmanifold;  ///< of more than two triangles
  grelha_ids duplicate;      ///< with the corners of one before, in any order
  grelha_ids degenerate;     ///< without area, exactly
  grelha_ids nonfinite;      ///< with a NaN or an infinity
} grelha_mesh_check;

/// Checks the visible triangles of a world. Exact; takes time in proportion to their number once,
/// and keeps the answer. Triangles that cross each other are not looked for. Fails with
/// GRELHA_INVALID for null.
GRELHA_API grelha_status grelha_check_mesh(const grelha_world* world, grelha_mesh_check* found);

/// One mesh among several. Members that are left out of an initializer are 0 or null.
typedef struct grelha_mesh {
  const float* vertices;    ///< [vertex_count] x y z; null if they are in double
  const double* doubles;    ///< [vertex_count] x y z; null if they are floats
  ptrdiff_t stride;         ///< bytes from one vertex to the next, not 0
  size_t vertex_count;      ///< number of vertices
  const uint32_t* indices;  ///< three for each triangle, counter-clockwise from the front
  size_t triangle_count;    ///< number of triangles
} grelha_mesh;

/// Makes a world of copies of meshes, as grelha_new_triangles() does of one, with its errors. Ids
/// count the triangles of all, mesh after mesh. Vertices in double in one of them give the world an
/// offset (grelha_offset()), which is subtracted from all.
GRELHA_API grelha_status grelha_new_meshes(const grelha_mesh* meshes,
                                           size_t count,
                                           int threads,
                                           grelha_world** world);

/// Stores the number of meshes of a world of triangles: 1 unless it was made of several, or some
/// were added. Fails with GRELHA_INVALID for null.
GRELHA_API grelha_status grelha_mesh_count(const grelha_world* world, size_t* count);

/// Finds whose triangles [count] ids are: mesh[i] is the number of the mesh, triangle[i] that of
/// the triangle in it; each may be null. Both are GRELHA_NONE for GRELHA_NONE and for spheres.
/// Fails with GRELHA_INVALID for null, and for an id that no primitive has.
GRELHA_API grelha_status grelha_mesh_of(const grelha_world* world,
                                        const uint32_t* ids,
                                        size_t count,
                                        uint32_t* mesh,
                                        uint32_t* triangle);

/// Moves the vertices of one mesh, as many as before; the indices are not read. Floats count from
/// grelha_offset(), doubles from 0: they change it as grelha_update_double() of all would. Answers
/// are those of a new world; grids of others mostly stay. Errors are those of making the world, and
/// GRELHA_INVALID for a number that no mesh has and for spheres; the world is then as before.
GRELHA_API grelha_status grelha_update_mesh(grelha_world* world,
                                            size_t number,
                                            const grelha_mesh* mesh,
                                            int threads);

/// The same of [count] meshes, number numbers[i] by meshes[i], which must differ.
GRELHA_API grelha_status grelha_update_meshes(grelha_world* world,
                                              const size_t* numbers,
                                              const grelha_mesh* meshes,
                                              size_t count,
                                              int threads);

/// Appends a mesh to a world of triangles, and stores its number unless the pointer is null.
/// Numbers and ids of the others stay. With masks, its triangles have 255. Vertices and errors are
/// those of grelha_update_mesh().
GRELHA_API grelha_status grelha_add_mesh(grelha_world* world,
                                         const grelha_mesh* mesh,
                                         int threads,
                                         size_t* number);

/// Leaves a mesh out of all queries with 0, and takes it in again with another number. Ids and
/// arrays stay, and its own grid. Errors are those of grelha_update_mesh().
GRELHA_API grelha_status grelha_set_visible(grelha_world* world,
                                            size_t number,
                                            int visible,
                                            int threads);

/// Takes a mesh out of a world, with its arrays and masks. The numbers of later meshes become less
/// by one, and the ids of their triangles by the number of its triangles; those before it keep
/// theirs. Grids of later meshes are built anew. To keep ids, hide it by grelha_set_visible().
/// Errors are those of grelha_update_mesh().
GRELHA_API grelha_status grelha_remove_mesh(grelha_world* world, size_t number, int threads);

/// Frees a world. Null is allowed.
GRELHA_API void grelha_free(grelha_world* world);

/// Finds the nearest hit of each ray. Of two hits at equal t the one with the lower id is found.
///
/// Errors    GRELHA_INVALID for null and for strides that are no multiple of 4.
/// Ensures   hit or miss, id, and t rounded once are those of real arithmetic on the floats given
///           for triangles; spheres are decided with 106 bits.
GRELHA_API grelha_status grelha_closest(const grelha_world* world,
                                        const grelha_rays* rays,
                                        const grelha_hits* hits,
                                        int threads);

/// Tests if a ray hits anything: blocked[i] is 1 or 0 for ray i. Faster than grelha_closest(), with
/// the same errors.
GRELHA_API grelha_status grelha_occluded(const grelha_world* world,
                                         const grelha_rays* rays,
                                         uint8_t* blocked,
                                         int threads);

/// The surface at a hit, or at another place of a primitive.
typedef struct grelha_surface {
  float point[3];   ///< computed on the primitive; more accurate than org + t dir
  float normal[3];  ///< unit length, outwards: to where the vertices are counter-clockwise
  float offset;     ///< distance along the normal where a point is certainly off the surface
} grelha_surface;

/// Computes the surfaces where rays hit: surfaces[i] is that of ray i. hits->t and hits->id are
/// those that grelha_closest() stored for these rays; u and v are not read. Without a hit the point
/// is NaN, and the normal 0. Errors as for grelha_closest(), and GRELHA_INVALID for an id that no
/// primitive has.
GRELHA_API grelha_status grelha_surfaces(const grelha_world* world,
                                         const grelha_rays* rays,
                                         const grelha_hits* hits,
                                         grelha_surface* surfaces,
                                         int threads);

/// Computes the surfaces at known places of triangles: the points (1 - u - v) a + u b + v c of
/// triangles a b c, [count] ids, u and v, as grelha_closest() stores them. For GRELHA_NONE the
/// point is NaN, and the normal 0. Fails with GRELHA_INVALID for null, for an id that is no
/// triangle, and where u or v is less than 0, or their sum greater than 1, by more than 1e-6.
GRELHA_API grelha_status grelha_surfaces_at(const grelha_world* world,
                                            const uint32_t* ids,
                                            const float* u,
                                            const float* v,
                                            size_t count,
                                            grelha_surface* surfaces,
                                            int threads);

/// Computes where rays start that leave [count] surfaces: origins[3 i] is the x of the one that
/// leaves surface i in direction i. Traced with t_min = 0 it does not hit the surface again if it
/// points away from it, and misses nothing that is farther from it than twice its offset. No
/// epsilon is needed. A NaN point has a NaN start, and rays from there hit nothing.
///
/// Shapes    dir: `count` directions of any length, dir_stride as in grelha_rays. origins:
///           [count] x y z without gaps.
/// Errors    GRELHA_INVALID for null, and for a stride that is no multiple of 4.
GRELHA_API grelha_status grelha_start(const grelha_surface* surfaces,
                                      size_t count,
                                      const float* dir,
                                      ptrdiff_t dir_stride,
                                      float* origins);

/// Counts the hits of each ray: counts[i] is the number that grelha_all_hits() finds for ray i.
/// Errors as for grelha_closest().
GRELHA_API grelha_status grelha_count_hits(const grelha_world* world,
                                           const grelha_rays* rays,
                                           uint32_t* counts,
                                           int threads);

/// Finds all hits of each ray, in order of t, then of the id. The hits of ray i are elements
/// offset[i] to offset[i + 1] - 1 of `t` and `id`.
///
/// A ray that enters and leaves a sphere hits it twice. An edge or a vertex belongs to each
/// triangle that has it. Each exact copy of a triangle or a sphere counts.
///
/// Shapes    offset: rays->count + 1 elements, always filled. t, id: `capacity` elements each, or
///           null if not wanted.
/// Usage     Call with `t` and `id` null, allocate offset[count] elements, call again.
/// Errors    GRELHA_TOO_MANY if there are more hits than `capacity` and an array is not null; as
///           for grelha_closest() otherwise. After GRELHA_TOO_MANY `offset` is right.
GRELHA_API grelha_status grelha_all_hits(const grelha_world* world,
                                         const grelha_rays* rays,
                                         size_t* offset,
                                         float* t,
                                         uint32_t* id,
                                         size_t capacity,
                                         int threads);

/// Finds the triangles that each ray crosses, in the order in which it does. Spheres do not count.
/// A ray through an edge or a vertex is treated as if it passed at an infinitesimal distance. It
/// crosses one triangle where it passes through a surface, none or two where it touches one. From
/// inside a closed mesh the number of crossings is odd, from outside even, for every ray.
///
/// Shapes    offset, t, id: as for grelha_all_hits(). enters: `capacity` elements, or null: 1 where
///           the ray comes from the side on which the vertices are counter-clockwise, else 0.
/// Usage     and errors are those of grelha_all_hits().
GRELHA_API grelha_status grelha_crossings(const grelha_world* world,
                                          const grelha_rays* rays,
                                          size_t* offset,
                                          float* t,
                                          uint32_t* id,
                                          uint8_t* enters,
                                          size_t capacity,
                                          int threads);

/// Calls `visit` with each hit of ray 0, then of ray 1 and so on, each in the order of
/// grelha_all_hits(), on the calling thread. If it returns 0, the next ray follows. `context` is
/// passed on to it. Errors as for grelha_closest().
GRELHA_API grelha_status grelha_each_hit(const grelha_world* world,
                                         const grelha_rays* rays,
                                         grelha_visit visit,
                                         void* context);

/// Which points count as inside of triangles.
typedef enum grelha_inside {
  GRELHA_CLOSED = 0,   ///< as GRELHA_ODD, of closed meshes alone
  GRELHA_ODD = 1,      ///< in an odd number of meshes; of an open one, by the crossings of one ray
  GRELHA_NONZERO = 2,  ///< around which closed and oriented meshes wind at all: unions
  /// with a winding number above 1/2, or below -1/2: open meshes, loose triangles
  GRELHA_WINDING = 3
} grelha_inside;

/// Tests if points lie inside a sphere, or inside the triangles by a rule: inside[i] is 1 or 0 for
/// point i. By every rule but GRELHA_WINDING the answer is exact: where the mesh is closed, it
/// depends on no choice of a ray. The first call checks the mesh, or for GRELHA_WINDING puts it
/// into clusters, and the world keeps what it found.
///
/// Shapes    points: `count` points, `stride` bytes apart, not 0.
/// Errors    GRELHA_NOT_CLOSED if the rule does not take the mesh: grelha_last_error() names the
///           first edge. GRELHA_INVALID for null, a stride of 0 and no rule. A point with a NaN is
///           outside.
GRELHA_API grelha_status grelha_contains(const grelha_world* world,
                                         const float* points,
                                         ptrdiff_t stride,
                                         size_t count,
                                         grelha_inside rule,
                                         uint8_t* inside,
                                         int threads);

/// Stores the generalized winding number of the triangles around each point, within `error` and the
/// rounding of doubles: the sum of their solid angles over 4 pi. It is how often a closed mesh
/// winds around the point; of an open one, how much of all directions it covers. A point that is
/// nearer to an edge than 2^-24 of its length may be further off. The less error is allowed, the
/// longer it takes; .01 is a good start. NaN for a point with a NaN.
///
/// Shapes    as for grelha_contains(). numbers: [count].
/// Errors    GRELHA_INVALID for null, a stride of 0, and an error that is not above 0.
GRELHA_API grelha_status grelha_winding_numbers(const grelha_world* world,
                                                const float* points,
                                                ptrdiff_t stride,
                                                size_t count,
                                                double error,
                                                double* numbers,
                                                int threads);

/// Finds the point of all surfaces that is closest to each point, if it is within `radius`, which
/// may be infinity. Of two primitives at equal distance the one with the lower id is found.
///
/// Shapes    points: as for grelha_contains(). Each of the other arrays may be null.
///           found: [count] x y z without gaps; the point itself if there is none.
///           distance: [count] infinity if there is none. id: [count] GRELHA_NONE if there is none.
/// Errors    GRELHA_INVALID for null, a stride of 0, and a radius that is negative or NaN.
/// Ensures   distances are computed in double, with a relative error of at most 2^-40 of the larger
///           of distance and coordinates, then rounded.
GRELHA_API grelha_status grelha_closest_points(const grelha_world* world,
                                               const float* points,
                                               ptrdiff_t stride,
                                               size_t count,
                                               float radius,
                                               float* found,
                                               float* distance,
                                               uint32_t* id,
                                               int threads);

/// Stores for each point the distance to the closest surface, negative inside by a rule, as
/// grelha_contains() says. It is infinity if the world is empty. Shapes and errors are those of
/// grelha_contains().
GRELHA_API grelha_status grelha_signed_distances(const grelha_world* world,
                                                 const float* points,
                                                 ptrdiff_t stride,
                                                 size_t count,
                                                 grelha_inside rule,
                                                 float* distance,
                                                 int threads);

#ifdef __cplusplus
}
#endif

#endif  // GRELHA_H
