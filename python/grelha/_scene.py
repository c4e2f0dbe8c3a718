"""Scene: what is rendered, and the functions that read and write files."""
import math

from . import _grelha
from ._geometry import flag, shown
from ._world import World, _expect_unmade, _joined


def _restored(cls, state, masks=None):
    """A Scene as it was pickled."""
    return cls._of(_grelha.scene_of(state), masks)


class Scene:
    """A scene with a camera, lights and materials. read() makes one of a file.

    Scene(vertices, faces) shows a mesh in light grey with three lights, as the program shows a bare
    PLY file. The arguments are those of World.

    colors   (vertices, 3), or (faces, 3) where that is another shape: uint8 is sRGB, other numbers
             are light from 0 to 1. A picture of them is light as well:
             write_image(path, image, srgb=True).
    smooth   degrees, up to 180: vertices get normals, but for edges that turn by more, where
             `vertices` has them twice
    material a dict of what differs from light grey: diffuse, specular, mirror and emission (a
             number or (3,)), shine, transmission, ior, roughness
    """

    __slots__ = ("_first", "_shown", "_world", "__weakref__")

    def __init__(self, vertices, faces, *, colors=None, smooth=None, material=None, threads=0):
        _expect_unmade(self)
        self._begin(_grelha.scene_of_mesh(vertices, faces, colors, smooth, material, threads))

    @staticmethod
    def of(meshes, *, materials=None, threads=0):
        """A Scene of several meshes, in light grey or each with its material.

        meshes      as World.of takes them
        materials   a sequence with a dict for each mesh, as of Scene, or None in its place

        scene.world.update_mesh() and set_visible() move a mesh and hide it. Camera and lights stay.
        With materials it takes no add_mesh().
        Raises TypeError or ValueError that names the argument.
        """
        joined = _joined(meshes)
        count = len(joined[2])
        if materials is not None and not isinstance(materials, (list, tuple)):
            raise TypeError(f"materials: expected a list of dicts, found {shown(materials)}")
        if materials is not None and len(materials) != count:
            raise ValueError(f"materials: expected {count}, one for each mesh, found "
                             f"{len(materials)}")
        return Scene._of(_grelha.scene_of_meshes(*joined, list(materials or []), threads))

    @classmethod
    def _of(cls, core, masks=None):
        scene = cls.__new__(cls)
        scene._begin(core, masks)
        return scene

    def _begin(self, core, masks=None):
        self._first = core
        self._world = World._of(core.core(), masks)
        self._shown = self._world._core, core  # what was asked of which World

    @property
    def _core(self):
        """The scene with its World as it is now."""
        world, core = self._shown
        if self._world._core is not world:
            world = self._world._core
            core = self._first.of_world(world)
            self._shown = world, core
        return core

    def __getattr__(self, name):  # only what is not there
        if name in Scene.__slots__:
            raise TypeError("Scene: __init__() was not called")
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    def __reduce__(self):
        return _restored, (type(self), self._core.state(), self.world.masks)

    def __repr__(self):
        view = self._core.camera()
        return (f"<grelha.Scene: {self._core.core().text()}; "
                f"{view['width']} x {view['height']} pixels>")

    @property
    def world(self):
        """The World of all primitives, always the same one.

        Pictures, surfaces() and camera_rays() show it as update(), update_mesh() and set_visible()
        leave it; camera and lights stay where they are, and normals become those of smooth=180. Its
        masks are for queries: pictures show all.
        """
        return self._world

    @property
    def vertices(self):
        """As of World."""
        return self._world.vertices

    @property
    def faces(self):
        """As of World."""
        return self._world.faces

    @property
    def colors(self):
        """Light of the vertices, float32 (vertices, 3), or None."""
        return self._core.colors()

    @property
    def solids(self):
        """The solids of a text STL file as it was read: a list of (name, faces).

        `faces` is the range of their rows in scene.faces; solid k is mesh k of scene.world. Solids
        without a facet are left out.
        """
        return [(name, range(first, first + count)) for name, first, count in self._core.solids()]

    @property
    def camera(self):
        """A dict of eye, at, up (tuples), angle (degrees), width and height (pixels)."""
        return self._core.camera()

    @property
    def lights(self):
        """Positions and colours, float64 (n, 2, 3). Area lights are at their centres."""
        return self._core.lights()

    def render(self, width=None, height=None, *, samples=None, error=None, seed=0, depth=5,
               eye=None, at=None, up=None, angle=None, orbit=None, orthographic=None, lights=None,
               background=None, transparent=False, threads=0):
        """A picture, linear RGB, row 0 on top: float32 (height, width, 3).

        width, height   pixels; None: as the scene says
        samples         rays for each pixel; None: as the scene needs
        error           as many samples, where they help most, as take the estimated RMSE below
                        it, above 0, at most 1; `samples` is then the most that a pixel gets, 8 at
                        least
        seed            of the samples
        depth           longest path, in rays
        eye, at, up     (3,) where the camera is, what it looks at, what is up; None: as the scene
                        says. `up` alone frames a bare mesh anew.
        angle           vertical field of view, degrees
        orbit           azimuth, (azimuth, elevation) or (azimuth, elevation, zoom): from there so
                        many degrees to the right and up around what the view shows; zoom divides
                        the angle
        orthographic    parallel rays: the height that the picture shows, scene units; "auto": that
                        which shows a bare mesh
        lights          (n, 2, 3), a position and a colour each; []: none; None: the scene's. Those
                        of a bare mesh move with the camera, unless lights=scene.lights holds them.
        background      (3,) light of rays that hit nothing, or one number: grey
        transparent     True leaves the background out: (height, width, 4), the colours times alpha,
                        the share of samples that hit something. Not with error=.
        threads         0: one for each processor. The number changes no bit of the picture.

        Raises TypeError or ValueError that names the argument, and KeyboardInterrupt.
        """
        view = (width, height, eye, at, up, angle, orbit, orthographic, lights, background)
        transparent = flag(transparent, "transparent")
        return self._core.render(view, samples, error, seed, depth, transparent, threads)

    def camera_rays(self, width=None, height=None, *, eye=None, at=None, up=None, angle=None,
                    orbit=None, orthographic=None):
        """The rays through the centres of pixels, row 0 on top: (origins, directions).

        The arguments are those of render(). Both have the shape (height, width, 3); directions are
        float32 of length 1. A picture of samples=1 is made of these rays.
        """
        return self._core.camera_rays((width, height, eye, at, up, angle, orbit, orthographic,
                                       None, None))

    def surfaces(self, origins, directions, *, threads=0):
        """What rays hit first: Surfaces(points, normals, colors, id).

        origins, directions   as of World.closest

        points    (..., 3) in the units of the vertices; NaN without a hit
        normals   float32 (..., 3), unit: those of vertices mixed, else of the face, on the side
                  from which its corners run counter-clockwise; NaN without a hit
        colors    float32 (..., 3), the share of light that is scattered: the material's diffuse
                  times the mixed colours of vertices; NaN without a hit
        id        int64 (...), as of World.closest
        """
        return self._core.core().surfaces(origins, directions, 0.0, math.inf, None, None, None,
                                          threads)


def read(path, *, colors=True, points=None, smooth=None, material=None, threads=0):
    """Reads an NFF, P3F, PLY or STL file, each also gzipped: a Scene.

    colors     False leaves out those of meshes
    points     the vertices of a mesh without faces become spheres of this radius; None or "auto":
               of one that leaves few gaps
    smooth     degrees, up to 180: meshes without normals get some, but for edges that turn by more
    material   of a PLY or STL file, as of Scene

    Its warnings are UserWarnings. Raises OSError for what cannot be read, ValueError with file,
    line and column for what is no scene.
    """
    colors = flag(colors, "colors")
    return Scene._of(_grelha.scene_of_file(path, colors, points, smooth, material, threads))


def write_image(path, image, *, srgb=False):
    """Writes an array of shape (h, w), (h, w, 3) or (h, w, 4), floats from 0, black, to 1, white.

    The fourth is alpha, which the colours are multiplied by, for .png and .exr. uint8 is sRGB, not
    multiplied by alpha: a .png has these bytes, other files their light.

    path   ends with .png, .hdr, .pfm or .exr
    srgb   a .png shows floats as light, through the sRGB curve; False: as bytes from 0 to 255

    Raises OSError where that fails, TypeError or ValueError for what is no picture.
    """
    _grelha.write_image(path, image, flag(srgb, "srgb"))
