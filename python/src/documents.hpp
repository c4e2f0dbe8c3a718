#pragma once
// The docstrings.

namespace grelha::python::documents {

inline constexpr const char* kModule = R"(Rays through triangles and spheres, from numpy arrays.

World answers closest hits, occlusion, all hits, inside tests and distances. Scene renders
pictures. t counts lengths of the ray's direction; all other lengths are in the units of the
vertices. docs/python.md has examples.)";

inline constexpr const char* kWorld = R"(World(vertices, faces, *, threads=0)

Triangles, ready for queries. It does not change, but by update(); threads may share it.

vertices   (n, 3) numbers. float32 is taken as it is. float64 is rounded to float32 after an
           offset is subtracted: the middle of the bounding box, on a grid of a power of two; 0
           near the origin if float32 holds every coordinate. Rays and points are shifted by it in
           double, and points are given back in double with the offset added.
faces      (m, 3) whole numbers, indices of vertices, counter-clockwise from the front
threads    to build with; 0: one for each processor

The arrays are copied: they may change or go afterwards.

Raises TypeError or ValueError that names the argument, for numbers that are not finite or beyond
1e18 in a vertex that a face uses, and for indices out of range. KeyboardInterrupt on Ctrl-C.)";

inline constexpr const char* kSpheres = R"(spheres(centers, radii, *, threads=0) -> World

A World of spheres in place of triangles.

centers   (n, 3) numbers, float64 as vertices of World
radii     (n,) numbers above 0, or one for all)";

inline constexpr const char* kClosest =
    R"(closest(origins, directions, t_min=0, t_max=inf, skip=None, *, threads=0) -> Hits

The nearest hit of each ray strictly between t_min and t_max.

origins      (..., 3) in units of the vertices, within 1e18; or (3,) for all rays
directions   (..., 3) of any length from 1e-18 to 1e18; or (3,) for all rays
t_min, t_max numbers or arrays of shape (...), in lengths of the direction
skip         id or array of shape (...) of ids of a primitive that the ray does not hit; -1: none
threads      0: one for each processor. The number changes no bit of an answer.

Returns Hits(t, id, u, v, face), arrays of shape (...), plain numbers for one ray of shape (3,):

t      float32, the hit point is origin + t direction; inf without a hit
id     int64, the primitive: of a mesh the face, of spheres the sphere; -1 without a hit
u, v   float32, the point is (1 - u - v) a + u b + v c of the face with the corners a, b, c
face   int64, the triangle's row in faces, -1 without one. In a World of triangles alone it is the
       same array as id.

Rays that are not finite hit nothing. Of two hits at equal t the lower id is returned. float32 rays
in rows are read where they lie.)";

inline constexpr const char* kOccluded =
    R"(occluded(origins, directions, t_min=0, t_max=inf, skip=None, *, threads=0) -> bool array

True for each ray that hits anything strictly between t_min and t_max. Faster than closest(), which
describes the arguments. Returns an array of shape (...), a bool for one ray.)";

inline constexpr const char* kAllHits =
    R"(all_hits(origins, directions, t_min=0, t_max=inf, skip=None, *, threads=0) -> HitLists

All hits of each ray, in order of (t, id). closest() describes the arguments.

Returns HitLists(offsets, t, id). The hits of ray i, rays being counted in rows, are
t[offsets[i]:offsets[i + 1]] and id[offsets[i]:offsets[i + 1]].

offsets   int64 (rays + 1,)
t         float32 (hits,)
id        int64 (hits,)

An edge or a vertex belongs to each triangle that has it. Exact copies of a triangle count once. A
ray that enters and leaves a sphere hits it twice.)";

inline constexpr const char* kCountHits =
    R"(count_hits(origins, directions, t_min=0, t_max=inf, skip=None, *, threads=0) -> int64 array

The number of hits that all_hits() finds for each ray: shape (...), an int for one ray.)";

inline constexpr const char* kContains = R"(contains(points, *, threads=0) -> bool array

True for each point inside an odd number of closed meshes. The triangles must form closed meshes;
spheres do not count. Exact: it does not depend on a choice of ray.

points   (..., 3), or (3,) for one point, which gives a bool. Points that are not finite are
         outside.)";

inline constexpr const char* kClosestPoints =
    R"(closest_points(points, radius=inf, *, threads=0) -> ClosestPoints

The nearest point of all surfaces within a radius of each point, the radius included.

points   (..., 3), or (3,) for one point
radius   a number, 0 or more

Returns ClosestPoints(points, distance, id):

points     (..., 3), float64 if the vertices or the points were, else float32; the point given where
           there is none
distance   float32 (...); inf where there is none
id         int64 (...), as of closest(); -1 where there is none)";

inline constexpr const char* kSignedDistance =
    R"(signed_distance(points, *, threads=0) -> float32 array

The distance to the nearest surface, negative inside closed meshes; see contains(). Shape (...) for
points of shape (..., 3), a float for one point. inf if the World is empty.)";

inline constexpr const char* kUpdate = R"(update(vertices, *, threads=0)

Moves the vertices and builds anew. vertices has the shape of those before; the faces stay. Calls
that run in other threads meanwhile answer for the vertices before.)";

inline constexpr const char* kScene = R"(Scene(vertices, faces, *, threads=0)

A scene with a camera, lights and materials. read() makes one of a file. This constructor shows a
mesh in light grey with three lights, as the program shows a bare PLY file.

Its members: world, vertices, faces, camera (a dict of eye, at, up, angle, width and height).)";

inline constexpr const char* kRender =
    R"(render(width=None, height=None, *, samples=None, error=None, seed=0, depth=5, eye=None,
       at=None, up=None, angle=None, threads=0) -> float32 array (height, width, 3)

A picture, linear RGB, row 0 on top. The same bits for any number of threads.

width, height   pixels; None: as the scene says
samples         rays for each pixel; None: as the scene needs
error           in place of samples: as many as take the estimated RMSE below it, above 0, at most 1
seed            of the samples
depth           longest path, in rays
eye, at, up     (3,) where the camera is, what it looks at, what is up; None: as the scene says
angle           vertical field of view, degrees)";

inline constexpr const char* kRead = R"(read(path, *, threads=0) -> Scene

Reads an NFF, P3F or PLY file, each also gzipped. Its warnings are UserWarnings. Raises OSError for
what cannot be read, ValueError with file, line and column for what is no scene.)";

inline constexpr const char* kWrite = R"(write_image(path, image)

Writes an array of shape (h, w) or (h, w, 3), 0 black and 1 white, as .png, .hdr, .pfm or .exr by
the path's ending. Raises OSError where that fails.)";

}  // namespace grelha::python::documents
