"""World: what is asked of triangles and spheres."""
from collections.abc import Iterable, Mapping

import numpy as np

from . import _grelha
from ._geometry import flag, shown


def _expect_unmade(thing):
    """Raises TypeError for a second __init__(), which would change what threads share."""
    try:
        thing._core
    except TypeError:
        return
    raise TypeError(f"{type(thing).__name__}: it is made already")


def _restored(cls, state, masks):
    """A World as it was pickled."""
    return cls._of(_grelha.core_of(state), masks)


def _arrays_of(mesh, name):
    """Vertices and faces of a mesh, which form a World."""
    try:
        vertices, faces = (mesh.vertices, mesh.faces) if hasattr(mesh, "vertices") else mesh
    except (AttributeError, TypeError, ValueError):
        raise TypeError(f"{name}: expected vertices and faces, found {shown(mesh)}") from None
    try:
        _grelha.check_mesh(vertices, faces)
    except (TypeError, ValueError) as error:
        raise type(error)(f"{name}: {error}") from None
    return np.asarray(vertices), np.asarray(faces).astype(np.int64)


def _joined(meshes):
    """Vertices and faces of several meshes one after the other, and how many each has."""
    if not isinstance(meshes, Iterable):
        raise TypeError(f"meshes: expected a sequence of meshes, found {shown(meshes)}")
    pairs = [_arrays_of(mesh, f"mesh {i}") for i, mesh in enumerate(meshes)]
    counts = np.array([(len(v), len(f)) for v, f in pairs], np.int64).reshape(-1, 2)
    firsts = np.cumsum(counts[:, 0]) - counts[:, 0]
    vertices = [np.zeros((0, 3), np.float32), *(v for v, _ in pairs)]
    faces = [np.zeros((0, 3), np.int64), *(f + k for (_, f), k in zip(pairs, firsts))]
    return np.concatenate(vertices), np.concatenate(faces), counts


class World:
    """Triangles, ready for queries.

    It does not change, but by update(), update_mesh(), update_meshes(), add_mesh(), remove_mesh(),
    set_visible() and masks.

    vertices   (n, 3) numbers. float32 is taken as it is. float64 is rounded to float32 after an
               offset is subtracted: the middle of the bounding box, on a grid of a power of two; 0
               near the origin if float32 holds every coordinate. Rays and points are shifted by it
               in double, and points are given back in double with the offset added.
    faces      (m, 3) whole numbers, indices of vertices, counter-clockwise from the front
    threads    to build with; 0: one for each processor

    The arrays are copied: they may change or go afterwards. Threads may share a World.

    Raises TypeError or ValueError that names the argument, for numbers that are not finite or
    beyond 1e18 in a vertex that a face uses, for indices out of range, and for masked arrays.
    KeyboardInterrupt on Ctrl-C.
    """

    __slots__ = ("_core", "_masks", "__weakref__")

    def __init__(self, vertices, faces, *, threads=0):
        _expect_unmade(self)
        self._core = _grelha.mesh(vertices, faces, threads)
        self._masks = None

    @classmethod
    def _of(cls, core, masks=None):
        world = cls.__new__(cls)
        world._core = core
        world._masks = None if masks is None else core.masks_in(masks)
        return world

    @staticmethod
    def spheres(centers, radii, *, threads=0):
        """A World of spheres in place of triangles.

        centers   (n, 3) numbers, float64 as vertices of World
        radii     (n,) numbers above 0, or one for all
        """
        return World._of(_grelha.spheres(centers, radii, threads))

    @staticmethod
    def of(meshes, *, threads=0):
        """A World of several meshes, of which update_mesh() moves one at a time.

        meshes   a sequence of pairs (vertices, faces), or of things that have .vertices and .faces,
                 as trimesh and Scene have

        It is the World of their arrays one after the other: ids and masks count the faces of all.
        mesh_of() tells whose they are. float64 in one makes all float64. Raises as World does, with
        the number of the mesh.
        """
        return World._of(_grelha.meshes(*_joined(meshes), threads))

    def __getattr__(self, name):  # only what is not there
        if name in ("_core", "_masks"):
            raise TypeError("World: __init__() was not called")
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    def __reduce__(self):
        return _restored, (type(self), self._core.state(), self._masks)

    def __repr__(self):
        return f"<grelha.World: {self._core.text()}>"

    def update(self, vertices, radii=None, *, threads=0):
        """Moves the vertices and builds anew.

        vertices   as many as before, (n, 3); the faces stay. Of a World of spheres the centers, of
                   several meshes the vertices of all.
        radii      of spheres, (n,) or one for all; None: as before
        threads    to build with; 0: one for each processor

        Calls that run in other threads meanwhile answer for the vertices before. Raises TypeError
        or ValueError, and then nothing has changed.
        """
        self._core = self._core.moved(vertices, radii, threads)

    def update_mesh(self, mesh, vertices, *, threads=0):
        """Moves the vertices of one mesh: those of the others stay, and mostly their grids too.

        mesh       its number among those that of() was given
        vertices   as many as the mesh had before, (n, 3). float64 makes all float64.
        threads    to build with; 0: one for each processor

        Answers are those of a new World. The offset stays, and grids with it, unless the middle of
        the box around all is more than four of its sizes away: then it is chosen anew. Where a new
        World would have this offset too, answers have its bits. Calls that run in other threads
        meanwhile answer for the vertices before; of two updates at once one is lost. Raises
        TypeError or ValueError, and then nothing has changed.
        """
        self._core = self._core.meshes_moved([(mesh, vertices)], "update_mesh", threads)

    def update_meshes(self, vertices, *, threads=0):
        """Moves the vertices of some meshes at once, as update_mesh() does of one.

        vertices   a dict from numbers of meshes to their vertices, (n, 3)
        threads    to build with; 0: one for each processor

        Takes the time of one update. Raises TypeError or ValueError, and then nothing has changed.
        """
        if not isinstance(vertices, Mapping):
            raise TypeError("vertices: expected a dict from numbers of meshes to vertices, found "
                            f"{shown(vertices)}")
        self._core = self._core.meshes_moved(list(vertices.items()), "update_meshes", threads)

    def add_mesh(self, vertices, faces, *, threads=0):
        """Appends a mesh. The others keep their numbers, ids and mostly their grids.

        vertices, faces   as those of World; of the offset see update_mesh()
        threads           to build with; 0: one for each processor

        Returns its number. With masks, its faces have 255. Raises TypeError or ValueError, and then
        nothing has changed.
        """
        core = self._core.mesh_added(vertices, faces, threads)
        if self._masks is not None:
            more = np.full(len(core.faces()) - len(self._masks), 255, np.uint8)
            self._masks = np.concatenate([self._masks, more])
        self._core = core
        return core.meshes() - 1

    def remove_mesh(self, mesh, *, threads=0):
        """Takes a mesh out, with its faces, vertices and masks.

        mesh      its number
        threads   to build with; 0: one for each processor

        Numbers of later meshes become less by one, and the ids of their faces by the number of its
        faces; those before it keep theirs. set_visible() leaves all ids as they are. With masks no
        query may run meanwhile. Raises TypeError or ValueError, and then nothing has changed.
        """
        core, masks = self._core.mesh_removed(mesh, threads), self._masks
        if masks is not None:
            masks = masks[self._core.mesh_of(np.arange(len(masks)))[0] != mesh]
        self._core, self._masks = core, masks

    def set_visible(self, mesh, visible, *, threads=0):
        """Leaves a mesh out of all queries, or takes it in again.

        mesh      its number
        visible   False: its faces keep their ids, but no query finds them, and insides and check()
                  do not count them
        threads   to build with; 0: one for each processor

        The mesh keeps its arrays, and its grid if it has one of its own: mostly nothing is built.
        Raises TypeError or ValueError, and then nothing has changed.
        """
        self._core = self._core.mesh_shown(mesh, flag(visible, "visible"), threads)

    def is_visible(self, mesh):
        """False for a mesh that set_visible() left out."""
        return self._core.is_visible(mesh)

    @property
    def meshes(self):
        """The number of meshes that of() and add_mesh() were given, or of the solids of a text STL
        file; 1 in other Worlds."""
        return self._core.meshes()

    def mesh_of(self, ids):
        """The meshes that faces belong to, by the ids that queries give.

        ids   whole numbers, (...); -1 for none

        Returns (mesh, face), int64 arrays of shape (...), ints for one id: the number of the mesh
        among those that of() was given or among solids, and the row of its own faces. Both are -1
        for -1 and for what is no triangle. Raises ValueError for ids that are none.
        """
        return self._core.mesh_of(ids)

    @property
    def vertices(self):
        """The vertices as they were rounded: a copy, (n, 3) float32; float64 if given so."""
        return self._core.vertices()

    @property
    def faces(self):
        """The triangles' vertices: a copy, (m, 3) int64."""
        return self._core.faces()

    @property
    def offset(self):
        """What was subtracted from the vertices before they were rounded: (3,) float64."""
        return self._core.offset()

    @property
    def masks(self):
        """Masks of the primitives: a copy, uint8 (primitives,); None: 255 for all.

        A ray with a `mask` hits the primitives with (masks[id] & mask) != 0 alone. Queries of
        points do not read it. Set it to an array of whole numbers from 0 to 255, or to None.
        """
        return None if self._masks is None else self._masks.copy()

    @masks.setter
    def masks(self, masks):
        self._masks = None if masks is None else self._core.masks_in(masks)

    def closest(self, origins, directions, t_min=0.0, t_max=np.inf, skip=None, *, mask=None,
                threads=0):
        """The nearest hit of each ray strictly between t_min and t_max.

        origins      (..., 3) in units of the vertices, within 1e18
        directions   (..., 3) of any length from 1e-18 to 1e18
        t_min, t_max numbers or arrays of shape (...), in lengths of the direction
        skip         ids of a primitive that the ray does not hit, (...); -1 or None: none
        mask         0 to 255, (...): the ray hits the primitives with (masks[id] & mask) != 0
                     alone; None: 255
        threads      0: one for each processor. The number changes no bit of an answer.

        The shapes (...) are broadcast with each other as numpy does it.

        Returns Hits(t, id, u, v, face), arrays of shape (...), plain numbers for one ray of shape
        (3,):

        t      float32, the hit point is origin + t direction; inf without a hit
        id     int64, the primitive: of a mesh the face, of spheres the sphere; -1 without a hit
        u, v   float32, the point is (1 - u - v) a + u b + v c of the face with the corners a, b, c
        face   int64, the triangle's row in faces, -1 without one. In a World of triangles alone it
               is the same array as id.

        Rays that are not finite hit nothing. Of two hits at equal t the lower id is returned.
        float32 rays in rows are read where they lie. Raises TypeError or ValueError that names the
        argument, and KeyboardInterrupt.
        """
        return self._core.closest(origins, directions, t_min, t_max, skip, mask, self._masks,
                                  threads)

    def occluded(self, origins, directions, t_min=0.0, t_max=np.inf, skip=None, *, mask=None,
                 threads=0):
        """True for each ray that hits anything strictly between t_min and t_max.

        Faster than closest(), which describes the arguments. Returns a bool array of shape (...),
        a bool for one ray.
        """
        return self._core.occluded(origins, directions, t_min, t_max, skip, mask, self._masks,
                                   threads)

    def all_hits(self, origins, directions, t_min=0.0, t_max=np.inf, skip=None, *, mask=None,
                 threads=0):
        """All hits of each ray, in order of (t, id). closest() describes the arguments.

        Returns HitLists(offsets, t, id). The hits of ray i, rays being counted in rows, are
        t[offsets[i]:offsets[i + 1]] and id[offsets[i]:offsets[i + 1]].

        offsets   int64 (rays + 1,)
        t         float32 (hits,)
        id        int64 (hits,)

        An edge or a vertex belongs to each triangle that has it: crossings() pass it once. Each
        exact copy of a primitive counts. A ray that enters and leaves a sphere hits it twice.
        """
        return self._core.all_hits(origins, directions, t_min, t_max, skip, mask, self._masks,
                                   threads)

    def count_hits(self, origins, directions, t_min=0.0, t_max=np.inf, skip=None, *, mask=None,
                   threads=0):
        """The number of hits that all_hits() finds for each ray.

        Returns an int64 array of shape (...), an int for one ray.
        """
        return self._core.count_hits(origins, directions, t_min, t_max, skip, mask, self._masks,
                                     threads)

    def crossings(self, origins, directions, t_min=0.0, t_max=np.inf, skip=None, *, mask=None,
                  threads=0):
        """The triangles that each ray crosses, in order. closest() describes the arguments.

        Returns CrossingLists(offsets, t, id, enters). Those of ray i, rays being counted in rows,
        are t[offsets[i]:offsets[i + 1]], and the same of id and enters.

        offsets   int64 (rays + 1,)
        t         float32 (crossings,)
        id        int64 (crossings,), of the triangle
        enters    bool (crossings,): through the side from which the corners are counter-clockwise

        Other primitives do not count, exact copies of a triangle do. A ray that passes through a
        surface at an edge or a vertex crosses one triangle there. One that touches it there crosses
        none, or two at equal t. Of closed meshes the number is odd from inside and even from
        outside, for every ray.
        """
        return self._core.crossings(origins, directions, t_min, t_max, skip, mask, self._masks,
                                    threads)

    def count_crossings(self, origins, directions, t_min=0.0, t_max=np.inf, skip=None, *,
                        mask=None, threads=0):
        """The number of crossings that crossings() finds for each ray.

        Returns an int64 array of shape (...), an int for one ray.
        """
        return self._core.count_crossings(origins, directions, t_min, t_max, skip, mask,
                                          self._masks, threads)

    def surfaces(self, origins, directions, t_min=0.0, t_max=np.inf, skip=None, *, mask=None,
                 threads=0):
        """What each ray hits first: Surfaces(points, normals, colors, id).

        closest() describes the arguments, and t, u and v.

        points    (..., 3), float64 if the vertices were, else float32; NaN without a hit
        normals   float32 (..., 3), unit: of spheres outwards, of faces on the side from which their
                  corners run counter-clockwise, those of vertices mixed where the World of a Scene
                  has them; NaN without a hit
        colors    float32 (..., 3): of a Scene's materials, light grey without; NaN without a hit
        id        int64 (...), as of closest()
        """
        return self._core.surfaces(origins, directions, t_min, t_max, skip, mask, self._masks,
                                   threads)

    def start(self, face, u, v, directions):
        """Where rays start that leave points of faces, so that they do not hit them again.

        face         rows of faces, (...)
        u, v         numbers, (...): the point is (1 - u - v) a + u b + v c of the corners a, b, c
        directions   (..., 3) in which the rays leave

        The shapes (...) are broadcast with each other. Returns origins (..., 3), float64 if the
        vertices were, else float32. They lie off the face by what float32 rounds, on the side that
        the direction points to: trace from there with t_min = 0. NaN for a face without area.
        Raises ValueError for rows that are none and for u and v of points beside the face.
        """
        return self._core.start(face, u, v, directions)

    def check(self):
        """Whether the faces form closed, oriented, manifold meshes, and where they do not.

        Returns MeshCheck(triangles, vertices, edges, open_edges, inconsistent_edges,
        nonmanifold_edges, duplicate_triangles, degenerate_triangles, nonfinite_triangles), with the
        properties closed, oriented and manifold: no edge has more than two triangles. The last six
        members are Findings(count, first):

        count   how many there are
        first   int64 (k,): the eight lowest faces of that kind. Of edges (k, 3): the first face
                that has it, and the vertices from which and to which it goes there

        Exact. Vertices at one place are one vertex, whatever their indices; triangles with two
        corners at one place have no edges. Triangles that cross each other are not looked for.
        Takes time in proportion to their number once, and keeps the answer.
        """
        return self._core.check()

    def contains(self, points, *, inside="closed", threads=0):
        """True for each point inside a ball, or inside the mesh by a rule.

        points   (..., 3), or (3,) for one point, which gives a bool. Points that are not finite
                 are outside.
        inside   "closed": in an odd number of closed meshes.
                 "odd": the same without a check; of an open mesh the parity of crossings along one
                 ray.
                 "nonzero": where closed and oriented meshes wind around the point at all, as those
                 that overlap or lie double do.
                 "winding": where the winding number is above 1/2, or below -1/2; of open meshes
                 and loose faces.

        By every rule but "winding" the answer is exact: where the mesh is closed, it does not
        depend on a choice of ray. Returns a bool array of shape (...). Raises ValueError that names
        the first edge where the mesh is not closed, or not oriented, as the rule asks. The first
        call checks the mesh, or puts it into clusters, and the World keeps what it found.
        """
        return self._core.contains(points, inside, threads)

    def winding_number(self, points, error=0.01, *, threads=0):
        """The generalized winding number around each point: solid angles of the faces over 4 pi.

        points   (..., 3), or (3,) for one point, which gives a float
        error    a number above 0: the answers are within it, and most nearer by far. The less, the
                 longer it takes. Points nearer to an edge than 2^-24 of its length may be further
                 off.

        It is how often a closed mesh winds around the point; of an open one, how much of all
        directions it covers. Returns float64 of shape (...), nan for points that are not finite.
        """
        return self._core.winding_number(points, error, threads)

    def closest_points(self, points, radius=np.inf, *, threads=0):
        """The nearest point of all surfaces within a radius of each point, the radius included.

        points   (..., 3), or (3,) for one point
        radius   a number from 0 to 1e19, or inf

        Returns ClosestPoints(points, distance, id):

        points     (..., 3), float64 if the vertices or the points were, else float32; the point
                   given where there is none
        distance   float32 (...); inf where there is none
        id         int64 (...), as of closest(); -1 where there is none
        """
        return self._core.closest_points(points, radius, threads)

    def signed_distance(self, points, *, inside="closed", threads=0):
        """The distance to the nearest surface, negative inside by a rule.

        inside   "closed", "odd", "nonzero" or "winding", as contains() describes. "winding" jumps
                 from -d to +d in holes, where the winding number passes 1/2.

        Returns float32 of shape (...) for points of shape (..., 3), a float for one point. inf if
        the World is empty. Raises as contains() does.
        """
        return self._core.signed_distance(points, inside, threads)
