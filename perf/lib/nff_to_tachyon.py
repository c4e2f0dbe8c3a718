"""NFF of the project's generators as a scene for Tachyon.

They write spheres, polygons of three corners, planes and point lights: cones, which Tachyon has
not, and other polygons are refused. The same camera, lights, colours, mirrors and depth; what is
clear bends no light there. Its pictures are mirrored, so x is turned around.
"""
import math

from nff_to_pov import Vector, cross


def texture(f):
    """Kd C for diffuse, Ks for the highlight and the mirror, T for what passes."""
    r, g, b, kd, ks, shine, t, _ = f
    return (f"TEXTURE AMBIENT 0 DIFFUSE {kd:.9g} SPECULAR {ks:.9g} OPACITY {1 - t:.9g}\n"
            f"PHONG METAL {ks:.9g} PHONG_SIZE {max(shine, 1):.9g}\n"
            f"COLOR {r:.9g} {g:.9g} {b:.9g} TEXFUNC 0\n")


def camera(view, depth):
    width, height = view.get("resolution", (512, 512))
    forward = (view["at"] - view["from"]).unit()
    # a picture as high as 1 / zoom, in front of the eye by 1
    zoom = .5 / math.tan(math.radians(view["angle"]) / 2)
    return (f"RESOLUTION {width} {height}\nCAMERA ZOOM {zoom:.9g} ASPECTRATIO 1 ANTIALIASING 0 "
            f"RAYDEPTH {depth}\nCENTER {place(view['from'])}\nVIEWDIR {place(forward)}\n"
            f"UPDIR {place(view['up'])}\nEND_CAMERA\n")


def words(vector):
    return " ".join(f"{a:.9g}" for a in vector)


def place(values):
    x, y, z = map(float, values)
    return words((-x, y, z))


def convert(text, depth):
    lines = iter(text.split("\n"))
    view, things, lights, look, background = {}, [], [], "", "0 0 0"
    numbers = lambda w: [float(x) for x in w]
    for line in lines:
        w = line.split()
        if not w or w[0] in ("#", "v", "hither"):
            continue
        if w[0] == "b":
            background = words(numbers(w[1:4]))
        elif w[0] in ("from", "at", "up"):
            view[w[0]] = Vector(*numbers(w[1:4]))
        elif w[0] == "angle":
            view["angle"] = float(w[1])
        elif w[0] == "resolution":
            view["resolution"] = (int(w[1]), int(w[2]))
        elif w[0] == "l":
            colour = words(numbers(w[4:7])) if len(w) > 4 else "1 1 1"
            lights.append(f"LIGHT CENTER {place(w[1:4])} RAD 1e-6 COLOR {colour}\n")
        elif w[0] == "f":
            look = texture(numbers(w[1:9]))
        elif w[0] == "s":
            things.append(f"SPHERE CENTER {place(w[1:4])} RAD {w[4]}\n{look}")
        elif w[0] == "p" and w[1] == "3":
            a, b, c = (place(next(lines).split()[:3]) for _ in range(3))
            things.append(f"TRI V0 {a} V1 {b} V2 {c}\n{look}")
        elif w[0] == "pl":
            a, b, c = (Vector(*numbers(w[i:i + 3])) for i in (1, 4, 7))
            things.append(f"PLANE CENTER {place(a)} NORMAL {place(cross(b - a, c - a).unit())}\n"
                          f"{look}")
        elif w[0] not in ("aperture", "focal"):
            raise ValueError(f"no conversion for {line!r}")
    return ("BEGIN_SCENE\n" + camera(view, depth) + f"BACKGROUND {background}\n" +
            "".join(lights) + "".join(things) + "END_SCENE\n")
