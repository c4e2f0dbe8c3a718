from os import PathLike
from typing import (Any, Iterable, Literal, Mapping, NamedTuple, Sequence, SupportsIndex,
                    TypedDict, Union, overload)

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

_Path = Union[str, bytes, PathLike[str], PathLike[bytes]]
_Inside = Literal["closed", "odd", "nonzero", "winding"]
_Point = Union[Sequence[float], NDArray[Any]]
_One = Sequence[float]  # of shape (3,); an array of that shape counts as many here

class Hits(NamedTuple):
    t: NDArray[np.float32]
    id: NDArray[np.int64]
    u: NDArray[np.float32]
    v: NDArray[np.float32]
    face: NDArray[np.int64]
    @overload  # type: ignore[override]
    def __getitem__(self, index: SupportsIndex) -> NDArray[Any]: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[NDArray[Any], ...]: ...
    @overload
    def __getitem__(self, index: NDArray[Any] | list[Any] | tuple[Any, ...]) -> Hits: ...
    def points(self, origins: ArrayLike, directions: ArrayLike) -> NDArray[Any]: ...

class _Hit(NamedTuple):  # Hits of one ray
    t: float
    id: int
    u: float
    v: float
    face: int
    def points(self, origins: ArrayLike, directions: ArrayLike) -> NDArray[Any]: ...

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
    distance: NDArray[np.float32]
    id: NDArray[np.int64]
    @overload  # type: ignore[override]
    def __getitem__(self, index: SupportsIndex) -> NDArray[Any]: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[NDArray[Any], ...]: ...
    @overload
    def __getitem__(self, index: NDArray[Any] | list[Any] | tuple[Any, ...]) -> ClosestPoints: ...

class _ClosestPoint(NamedTuple):  # ClosestPoints of one point
    points: NDArray[Any]
    distance: float
    id: int

class Findings(NamedTuple):
    count: int  # type: ignore[assignment]  # hides that of tuple
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
    nonfinite_triangles: Findings
    @property
    def closed(self) -> bool: ...
    @property
    def oriented(self) -> bool: ...
    @property
    def manifold(self) -> bool: ...
    @property
    def edge_manifold(self) -> bool: ...

class Surfaces(NamedTuple):
    points: NDArray[Any]
    normals: NDArray[np.float32]
    colors: NDArray[np.float32]
    id: NDArray[np.int64]
    @overload  # type: ignore[override]
    def __getitem__(self, index: SupportsIndex) -> NDArray[Any]: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[NDArray[Any], ...]: ...
    @overload
    def __getitem__(self, index: NDArray[Any] | list[Any] | tuple[Any, ...]) -> Surfaces: ...

class World:
    def __init__(self, vertices: ArrayLike, faces: ArrayLike, *, threads: int = ...) -> None: ...
    @staticmethod
    def spheres(centers: ArrayLike, radii: ArrayLike, *, threads: int = ...) -> World: ...
    def update(self, vertices: ArrayLike, radii: ArrayLike | None = ..., *,
               threads: int = ...) -> None: ...
    @staticmethod
    def of(meshes: Iterable[Any], *, threads: int = ...) -> World: ...
    def update_mesh(self, mesh: int, vertices: ArrayLike, *, threads: int = ...) -> None: ...
    def update_meshes(self, vertices: Mapping[int, ArrayLike], *, threads: int = ...) -> None: ...
    def remove_mesh(self, mesh: int, *, threads: int = ...) -> None: ...
    def add_mesh(self, vertices: ArrayLike, faces: ArrayLike, *, threads: int = ...) -> int: ...
    def set_visible(self, mesh: int, visible: bool, *, threads: int = ...) -> None: ...
    def is_visible(self, mesh: int) -> bool: ...
    @property
    def meshes(self) -> int: ...
    @overload  # type: ignore[misc]
    def mesh_of(self, ids: int) -> tuple[int, int]: ...
    @overload
    def mesh_of(self, ids: ArrayLike) -> tuple[NDArray[np.int64], NDArray[np.int64]]: ...
    @property
    def masks(self) -> NDArray[np.uint8] | None: ...
    @masks.setter
    def masks(self, masks: ArrayLike | None) -> None: ...
    @property
    def vertices(self) -> NDArray[Any]: ...
    @property
    def faces(self) -> NDArray[np.int64]: ...
    @property
    def offset(self) -> NDArray[np.float64]: ...
    @overload  # type: ignore[misc]
    def closest(self, origins: _One, directions: _One, t_min: float = ...,
                t_max: float = ..., skip: int | None = ..., *,
                mask: int | None = ..., threads: int = ...) -> _Hit: ...
    @overload
    def closest(self, origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = ...,
                t_max: ArrayLike = ..., skip: ArrayLike | None = ..., *,
                mask: ArrayLike | None = ..., threads: int = ...) -> Hits: ...
    @overload  # type: ignore[misc]
    def occluded(self, origins: _One, directions: _One, t_min: float = ...,
                 t_max: float = ..., skip: int | None = ..., *,
                 mask: int | None = ..., threads: int = ...) -> bool: ...
    @overload
    def occluded(self, origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = ...,
                 t_max: ArrayLike = ..., skip: ArrayLike | None = ..., *,
                 mask: ArrayLike | None = ..., threads: int = ...) -> NDArray[np.bool_]: ...
    def all_hits(self, origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = ...,
                 t_max: ArrayLike = ..., skip: ArrayLike | None = ..., *,
                 mask: ArrayLike | None = ..., threads: int = ...) -> HitLists: ...
    @overload  # type: ignore[misc]
    def count_hits(self, origins: _One, directions: _One, t_min: float = ...,
                   t_max: float = ..., skip: int | None = ..., *,
                   mask: int | None = ..., threads: int = ...) -> int: ...
    @overload
    def count_hits(self, origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = ...,
                   t_max: ArrayLike = ..., skip: ArrayLike | None = ..., *,
                   mask: ArrayLike | None = ..., threads: int = ...) -> NDArray[np.int64]: ...
    def crossings(self, origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = ...,
                  t_max: ArrayLike = ..., skip: ArrayLike | None = ..., *,
                  mask: ArrayLike | None = ..., threads: int = ...) -> CrossingLists: ...
    @overload  # type: ignore[misc]
    def count_crossings(self, origins: _One, directions: _One, t_min: float = ...,
                        t_max: float = ..., skip: int | None = ..., *,
                        mask: int | None = ..., threads: int = ...) -> int: ...
    @overload
    def count_crossings(self, origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = ...,
                        t_max: ArrayLike = ..., skip: ArrayLike | None = ..., *,
                        mask: ArrayLike | None = ..., threads: int = ...) -> NDArray[np.int64]: ...
    def surfaces(self, origins: ArrayLike, directions: ArrayLike, t_min: ArrayLike = ...,
                 t_max: ArrayLike = ..., skip: ArrayLike | None = ..., *,
                 mask: ArrayLike | None = ..., threads: int = ...) -> Surfaces: ...
    def start(self, face: ArrayLike, u: ArrayLike, v: ArrayLike,
              directions: ArrayLike) -> NDArray[Any]: ...
    def check(self) -> MeshCheck: ...
    @overload  # type: ignore[misc]
    def contains(self, points: _One, *, inside: _Inside = ..., threads: int = ...) -> bool: ...
    @overload
    def contains(self, points: ArrayLike, *, inside: _Inside = ...,
                 threads: int = ...) -> NDArray[np.bool_]: ...
    @overload  # type: ignore[misc]
    def winding_number(self, points: _One, error: float = ..., *, threads: int = ...) -> float: ...
    @overload
    def winding_number(self, points: ArrayLike, error: float = ..., *,
                       threads: int = ...) -> NDArray[np.float64]: ...
    @overload  # type: ignore[misc]
    def closest_points(self, points: _One, radius: float = ..., *,
                       threads: int = ...) -> _ClosestPoint: ...
    @overload
    def closest_points(self, points: ArrayLike, radius: float = ..., *,
                       threads: int = ...) -> ClosestPoints: ...
    @overload  # type: ignore[misc]
    def signed_distance(self, points: _One, *, inside: _Inside = ...,
                        threads: int = ...) -> float: ...
    @overload
    def signed_distance(self, points: ArrayLike, *, inside: _Inside = ...,
                        threads: int = ...) -> NDArray[np.float32]: ...

class _Camera(TypedDict):
    eye: tuple[float, float, float]
    at: tuple[float, float, float]
    up: tuple[float, float, float]
    angle: float
    width: int
    height: int

class Scene:
    def __init__(self, vertices: ArrayLike, faces: ArrayLike, *, colors: ArrayLike | None = ...,
                 smooth: float | None = ..., material: dict[str, Any] | None = ...,
                 threads: int = ...) -> None: ...
    @staticmethod
    def of(meshes: Iterable[Any], *, materials: Sequence[dict[str, Any] | None] | None = ...,
           threads: int = ...) -> Scene: ...
    @property
    def world(self) -> World: ...
    @property
    def vertices(self) -> NDArray[Any]: ...
    @property
    def faces(self) -> NDArray[np.int64]: ...
    @property
    def colors(self) -> NDArray[np.float32] | None: ...
    @property
    def solids(self) -> list[tuple[str, range]]: ...
    @property
    def camera(self) -> _Camera: ...
    @property
    def lights(self) -> NDArray[np.float64]: ...
    def render(self, width: int | None = ..., height: int | None = ..., *,
               samples: int | None = ..., error: float | None = ..., seed: int = ...,
               depth: int = ..., eye: _Point | None = ..., at: _Point | None = ...,
               up: _Point | None = ..., angle: float | None = ...,
               orbit: tuple[float, float] | tuple[float, float, float] | None = ...,
               orthographic: float | Literal["auto"] | None = ..., lights: ArrayLike | None = ...,
               background: _Point | None = ..., transparent: bool = ...,
               threads: int = ...) -> NDArray[np.float32]: ...
    def camera_rays(self, width: int | None = ..., height: int | None = ..., *,
                    eye: _Point | None = ..., at: _Point | None = ..., up: _Point | None = ...,
                    angle: float | None = ...,
                    orbit: tuple[float, float] | tuple[float, float, float] | None = ...,
                    orthographic: float | Literal["auto"] | None = ...
                    ) -> tuple[NDArray[Any], NDArray[np.float32]]: ...
    def surfaces(self, origins: ArrayLike, directions: ArrayLike, *,
                 threads: int = ...) -> Surfaces: ...

def read(path: _Path, *, colors: bool = ..., points: float | str | None = ...,
         smooth: float | None = ..., material: dict[str, Any] | None = ...,
         threads: int = ...) -> Scene: ...
def write_image(path: _Path, image: ArrayLike, *, srgb: bool = ...) -> None: ...
