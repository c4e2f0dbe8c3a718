"""What World's methods give back."""
from typing import Any, NamedTuple


class Hits(NamedTuple):
    """Nearest hits: arrays with one element for each ray, or plain numbers for one ray."""
    t: Any  # float32; inf without a hit
    id: Any  # int64; -1 without a hit
    u: Any  # float32
    v: Any  # float32
    face: Any  # int64; -1 without a triangle


class HitLists(NamedTuple):
    """All hits: those of ray i are t[offsets[i]:offsets[i + 1]], and the same of id."""
    offsets: Any  # int64 (rays + 1,)
    t: Any  # float32 (hits,)
    id: Any  # int64 (hits,)


class CrossingLists(NamedTuple):
    """All crossings: those of ray i are t[offsets[i]:offsets[i + 1]], and the same of the rest."""
    offsets: Any  # int64 (rays + 1,)
    t: Any  # float32 (crossings,)
    id: Any  # int64 (crossings,)
    enters: Any  # bool (crossings,)


class ClosestPoints(NamedTuple):
    """Closest points: arrays with one element for each point, or plain numbers for one point."""
    points: Any  # float64 or float32 (..., 3)
    distance: Any  # float32; inf where there is none
    id: Any  # int64; -1 where there is none
