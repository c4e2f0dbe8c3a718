from os import PathLike
from typing import Any, Iterable, Literal, NamedTuple, Sequence, TypedDict, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

_Path = Union[str, bytes, PathLike[str], PathLike[bytes]]
_Inside = Literal["closed", "odd", "nonzero", "winding"]
_Point = Union[Sequence[float], NDArray[Any]]

class Hits(NamedTuple):
    t: Any
    id: Any
    u: Any
    v: Any
    face: Any

class HitLists(NamedTuple):
    offsets: NDArray[np.int64]
    t: NDArray[np.float32]
    id: NDArray[np.int64]

class CrossingLists(NamedTuple):
    offsets: NDArray[np.int64]
    t: NDArray[np.float32]
    id: NDArray[np.int64]
    enters: NDArray[np.bool_]

class ClosestPoints(NamedTuple):
    points: NDArray[Any]
    distance: Any
    id: Any

class Findings(NamedTuple):
    count: int
    first: NDArray[np.int64]

class MeshCheck(NamedTuple):
    triangles: int
    vertices: int
    edges: int
    open_edges: Findings
    inconsistent_edges: Findings
    nonmanifold_edges: Findings
    duplicate_triangles: Findings
    degenerate_triangles: Findings
    @property
    def closed(self) -> bool: ...
    @property
    def oriented(self) -> bool: ...
    @property
    def edge_manifold(self) -> bool: ...

class Surfaces(NamedTuple):
    points: NDArray[Any]
    normals: NDArray[np.float32]
    colors: NDArray[np.float32]
    id: NDArray[np.int64]

class World:
    def __init__(self, vertices: ArrayLike, faces: ArrayLike, *, threads: int = ...) -> None: ...
    @staticmethod
    def spheres(centers: ArrayLike, radii: ArrayLike, *, threads: int = ...) -> World: ...
    def update(self, vertices: ArrayLike, radii: ArrayLike | None = ..., *,
               threads: int = ...) -> None: ...
    @staticmethod
    def of(meshes: Iterable[Any], *, threads: int = ...) -> World: ...
    def update_mesh(self, mesh: int, vertices: ArrayLike, *, threads: int = ...) -> None: ...
    @property
    def meshes(self) -> int: ...
    def mesh_of(self, ids: ArrayLike) -> tuple[Any, Any]: ...
    @property
    def masks(self) -> Any: ...  # uint8 or None
    @masks.setter
    def masks(self, masks: Any) -> None: ...
    @property
    def vertices(self) -> NDArray[Any]: ...
    @property
    def faces(self) -> NDArray[np.int64]: ...
    @property
    def offset(self) -> NDArray[np.float64]: ...
    def closest(self, origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = ...,
                t_max: ArrayLike = ..., skip: ArrayLike | None = ..., *,
                mask: ArrayLike | None = ..., threads: int = ...) -> Hits: ...
    def occluded(self, origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = ...,
                 t_max: ArrayLike = ..., skip: ArrayLike | None = ..., *,
                 mask: ArrayLike | None = ..., threads: int = ...) -> Any: ...
    def all_hits(self, origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = ...,
                 t_max: ArrayLike = ..., skip: ArrayLike | None = ..., *,
                 mask: ArrayLike | None = ..., threads: int = ...) -> HitLists: ...
    def count_hits(self, origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = ...,
                   t_max: ArrayLike = ..., skip: ArrayLike | None = ..., *,
                   mask: ArrayLike | None = ..., threads: int = ...) -> Any: ...
    def crossings(self, origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = ...,
                  t_max: ArrayLike = ..., skip: ArrayLike | None = ..., *,
                  mask: ArrayLike | None = ..., threads: int = ...) -> CrossingLists: ...
    def count_crossings(self, origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = ...,
                        t_max: ArrayLike = ..., skip: ArrayLike | None = ..., *,
                        mask: ArrayLike | None = ..., threads: int = ...) -> Any: ...
    def start(self, face: ArrayLike, u: ArrayLike, v: ArrayLike,
              directions: ArrayLike) -> NDArray[Any]: ...
    def check(self) -> MeshCheck: ...
    def contains(self, points: ArrayLike, *, inside: _Inside = ...,
                 threads: int = ...) -> Any: ...
    def winding_number(self, points: ArrayLike, error: float = ..., *,
                       threads: int = ...) -> Any: ...
    def closest_points(self, points: ArrayLike, radius: float = ..., *,
                       threads: int = ...) -> ClosestPoints: ...
    def signed_distance(self, points: ArrayLike, *, inside: _Inside = ...,
                        threads: int = ...) -> Any: ...

class _Camera(TypedDict):
    eye: tuple[float, float, float]
    at: tuple[float, float, float]
    up: tuple[float, float, float]
    angle: float
    width: int
    height: int

class Scene:
    def __init__(self, vertices: ArrayLike, faces: ArrayLike, *, colors: ArrayLike | None = ...,
                 material: dict[str, Any] | None = ..., threads: int = ...) -> None: ...
    @property
    def world(self) -> World: ...
    @property
    def vertices(self) -> NDArray[Any]: ...
    @property
    def faces(self) -> NDArray[np.int64]: ...
    @property
    def colors(self) -> NDArray[np.float32] | None: ...
    @property
    def camera(self) -> _Camera: ...
    @property
    def lights(self) -> NDArray[np.float64]: ...
    def render(self, width: int | None = ..., height: int | None = ..., *,
               samples: int | None = ..., error: float | None = ..., seed: int = ...,
               depth: int = ..., eye: _Point | None = ..., at: _Point | None = ...,
               up: _Point | None = ..., angle: float | None = ...,
               orbit: tuple[float, float] | tuple[float, float, float] | None = ...,
               orthographic: float | None = ..., lights: ArrayLike | None = ...,
               background: _Point | None = ...,
               threads: int = ...) -> NDArray[np.float32]: ...
    def camera_rays(self, width: int | None = ..., height: int | None = ..., *,
                    eye: _Point | None = ..., at: _Point | None = ..., up: _Point | None = ...,
                    angle: float | None = ...,
                    orbit: tuple[float, float] | tuple[float, float, float] | None = ...,
                    orthographic: float | None = ...
                    ) -> tuple[NDArray[Any], NDArray[np.float32]]: ...
    def surfaces(self, origins: ArrayLike, directions: ArrayLike, *,
                 threads: int = ...) -> Surfaces: ...

def read(path: _Path, *, colors: bool = ..., points: float | str | None = ...,
         smooth: float | None = ..., material: dict[str, Any] | None = ..., threads: int = ...) -> Scene: ...
def write_image(path: _Path, image: ArrayLike, *, srgb: bool = ...) -> None: ...
