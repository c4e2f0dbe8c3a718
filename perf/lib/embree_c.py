"""Closest hits by Embree 3 through its C interface, on arrays of numpy."""
import ctypes
import ctypes.util

import numpy as np

# RTCRayHit, with one level of instances
RAY_HIT = np.dtype([("origin", "f4", 3), ("t_near", "f4"), ("direction", "f4", 3), ("time", "f4"),
                    ("t_far", "f4"), ("mask", "u4"), ("id", "u4"), ("flags", "u4"),
                    ("normal", "f4", 3), ("u", "f4"), ("v", "f4"), ("primitive", "u4"),
                    ("geometry", "u4"), ("instance", "u4")])
ROBUST, TRIANGLES, INDEX, VERTEX, UINT3, FLOAT3 = 4, 0, 0, 1, 0x5003, 0x9003
NONE = 2**32 - 1


class Context(ctypes.Structure):
    """RTCIntersectContext: rays without order, no filter, no instance."""
    _fields_ = [("flags", ctypes.c_int), ("filter", ctypes.c_void_p), ("instance", ctypes.c_uint)]


def load():
    """The library, or None where there is no Embree 3."""
    try:
        library = ctypes.CDLL("libembree3.so.3")
    except OSError:
        return None
    for name in ("rtcNewDevice", "rtcNewScene", "rtcNewGeometry", "rtcSetNewGeometryBuffer"):
        getattr(library, name).restype = ctypes.c_void_p
    return library


def room(count):
    """Zeroed RTCRayHits, on 16 bytes as Embree asks."""
    raw = np.zeros(count * RAY_HIT.itemsize + 16, np.uint8)
    begin = -raw.ctypes.data % 16
    return raw[begin:begin + count * RAY_HIT.itemsize].view(RAY_HIT)


class Scene:
    """One mesh; `robust` is Embree's flag of that name. Used until the program ends."""

    def __init__(self, library, vertices, faces, robust):
        self.embree = library
        device = ctypes.c_void_p(library.rtcNewDevice(b"threads=1"))
        self.scene = ctypes.c_void_p(library.rtcNewScene(device))
        library.rtcSetSceneFlags(self.scene, ROBUST if robust else 0)
        geometry = ctypes.c_void_p(library.rtcNewGeometry(device, TRIANGLES))
        for kind, form, array in ((VERTEX, FLOAT3, np.float32(vertices)),
                                  (INDEX, UINT3, np.uint32(faces))):
            to = library.rtcSetNewGeometryBuffer(geometry, kind, 0, form, ctypes.c_size_t(12),
                                                 ctypes.c_size_t(len(array)))
            array = np.ascontiguousarray(array)
            ctypes.memmove(to, array.ctypes.data, array.nbytes)
        library.rtcCommitGeometry(geometry)
        library.rtcAttachGeometry(self.scene, geometry)
        library.rtcCommitScene(self.scene)
        if library.rtcGetDeviceError(device):
            raise RuntimeError("Embree refuses the mesh")

    def met(self, origins, directions, t_max):
        """Whether each ray hits anything, by closest hits of its rtcIntersect1M."""
        hits = room(len(origins))
        hits["origin"], hits["direction"], hits["t_far"] = origins, directions, t_max
        hits["mask"], hits["geometry"], hits["instance"] = NONE, NONE, NONE
        context = Context(0, None, NONE)
        self.embree.rtcIntersect1M(self.scene, ctypes.byref(context),
                                   ctypes.c_void_p(hits.ctypes.data), ctypes.c_uint(len(hits)),
                                   ctypes.c_size_t(RAY_HIT.itemsize))
        return hits["geometry"] != NONE
