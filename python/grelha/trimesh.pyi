from typing import Any, Literal, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Rows = NDArray[np.int64]

class RayMeshIntersector:
    mesh: Any
    def __init__(self, mesh: Any = ..., geometry: Any = ..., **kwargs: Any) -> None: ...
    @overload
    def intersects_id(self, ray_origins: ArrayLike, ray_directions: ArrayLike,
                      multiple_hits: bool = ..., max_hits: int | None = ...,
                      return_locations: Literal[False] = ...,
                      **kwargs: Any) -> tuple[_Rows, _Rows]: ...
    @overload
    def intersects_id(self, ray_origins: ArrayLike, ray_directions: ArrayLike,
                      multiple_hits: bool = ..., max_hits: int | None = ..., *,
                      return_locations: Literal[True],
                      **kwargs: Any) -> tuple[_Rows, _Rows, NDArray[np.float64]]: ...
    def intersects_location(self, ray_origins: ArrayLike, ray_directions: ArrayLike,
                            multiple_hits: bool = ...,
                            **kwargs: Any) -> tuple[NDArray[np.float64], _Rows, _Rows]: ...
    def intersects_first(self, ray_origins: ArrayLike, ray_directions: ArrayLike,
                         **kwargs: Any) -> _Rows: ...
    def intersects_any(self, ray_origins: ArrayLike, ray_directions: ArrayLike,
                       **kwargs: Any) -> NDArray[np.bool_]: ...
    def contains_points(self, points: ArrayLike) -> NDArray[np.bool_]: ...
