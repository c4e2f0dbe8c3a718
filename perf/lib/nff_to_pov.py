"""NFF of the project's generators as a scene for POV-Ray.

They write spheres, polygons of three corners, planes and point lights.
The same camera, lights, colours, mirrors and depth; POV-Ray knows the highlight (`specular` is
Blinn's) and refraction too. Two rules differ: glass lets POV-Ray's shadow rays through, and its
paths end in black where ours end in the background. Its textures share no code with ours, so
pictures agree to a few hundredths, not in bits.
"""
import math


class Vector(tuple):
    def __new__(cls, x, y, z):
        return super().__new__(cls, (x, y, z))

    def __add__(self, o):
        return Vector(*(a + b for a, b in zip(self, o)))

    def __sub__(self, o):
        return Vector(*(a - b for a, b in zip(self, o)))

    def __rmul__(self, s):
        return Vector(*(s * a for a in self))

    def length(self):
        return math.sqrt(sum(a * a for a in self))

    def unit(self):
        return (1 / self.length()) * self

    def __str__(self):
        return "<" + ",".join(f"{a:.9g}" for a in self) + ">"


def cross(a, b):
    return Vector(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def material(name, f):
    """Our rules: Kd C for diffuse, Ks C for highlights, Ks for the mirror, T for what passes."""
    r, g, b, kd, ks, shine, t, ior = f
    # POV-Ray lets 1 - transmit of the diffuse light come back
    diffuse = kd / (1 - t) if t < 1 else 0
    highlight = ""
    if ks > 0 and shine > 0:
        highlight = f" specular {ks} metallic roughness {1 / max(shine, .01):.6g}"
    mirror = f" reflection {{ {ks} }}" if ks > 0 else ""
    interior = f" interior {{ ior {ior} }}" if t > 0 else ""
    return (f"#declare {name} = material {{ texture {{ pigment {{ color rgbt <{r},{g},{b},{t}> }} "
            f"finish {{ ambient 0 diffuse {diffuse:.6g}{highlight}{mirror} }} }}{interior} }}\n")


def area_axes(light, at, size):
    """Edges of the square a point light becomes with --shadows, as frontend/input/effects.cpp
    chooses them (Duff et al. 2017)."""
    x, y, z = (at - light).unit()
    sign = -1 if z < 0 else 1
    a = -1 / (sign + z)
    b = x * y * a
    return (size * Vector(1 + sign * x * x * a, sign * b, -sign * x),
            size * Vector(b, sign + y * y * a, -y))


def convert(text, depth, area=None, lens=None):
    """area: (side, N) squares of N x N points; lens: (aperture in pixels, focal distance,
    samples)."""
    words = iter(text.split("\n"))
    view, out, meshes, lights, materials = {}, [], {}, [], 0
    background = "<0,0,0>"
    numbers = lambda line: [float(w) for w in line]
    for line in words:
        w = line.split()
        if not w or w[0] == "#":
            continue
        key = w[0]
        if key == "b":
            background = Vector(*numbers(w[1:4]))
        elif key in ("from", "at", "up"):
            view[key] = Vector(*numbers(w[1:4]))
        elif key in ("angle", "aperture", "focal"):
            view[key] = float(w[1])
        elif key == "resolution":
            view[key] = (int(w[1]), int(w[2]))
        elif key == "l":
            colour = Vector(*numbers(w[4:7])) if len(w) > 4 else Vector(1, 1, 1)
            lights.append((Vector(*numbers(w[1:4])), colour))
        elif key == "f":
            materials += 1
            out.append(material(f"M{materials}", numbers(w[1:9])))
        elif key == "s":
            out.append(f"sphere {{ <{w[1]},{w[2]},{w[3]}>,{w[4]} material {{ M{materials} }} }}\n")
        elif key == "p" and w[1] == "3":
            corners = meshes.setdefault(materials, [])
            corners.append([next(words).split() for _ in range(3)])
        elif key == "pl":
            a, b, c = (Vector(*numbers(w[i:i + 3])) for i in (1, 4, 7))
            n = cross(b - a, c - a).unit()
            out.append(f"plane {{ {n}, {dot(n, a):.9g} material {{ M{materials} }} }}\n")
        elif key not in ("v", "hither"):
            raise ValueError(f"no conversion for {line!r}")
    for number, faces in meshes.items():
        points, indices = {}, []
        for face in faces:
            indices.append([points.setdefault(tuple(p), len(points)) for p in face])
        vectors = ",\n".join("<" + ",".join(p) + ">" for p in points)
        corners_of_faces = ",\n".join(f"<{a},{b},{c}>" for a, b, c in indices)
        out.append(f"mesh2 {{ vertex_vectors {{ {len(points)},\n{vectors}\n}}\n"
                   f"face_indices {{ {len(indices)},\n{corners_of_faces}\n}}\n"
                   f"material {{ M{number} }} }}\n")
    for position, colour in lights:
        spread = ""
        if area:
            u, v = area_axes(position, view["at"], area[0])
            spread = f" area_light {u}, {v}, {area[1]}, {area[1]}"
        out.append(f"light_source {{ {position}, rgb {colour}{spread} }}\n")
    eye, at, half = view["from"], view["at"], math.tan(math.radians(view["angle"]) / 2)
    forward = (at - eye).unit()
    right = cross(forward, view["up"]).unit()
    up = cross(right, forward)
    width, height = view.get("resolution", (512, 512))
    blur = ""
    if lens:
        aperture, focus, samples = lens
        diameter = aperture * 2 * (at - eye).length() * half / height
        # twice: found by comparing pictures, as its manual names no unit
        blur = (f" aperture {2 * diameter:.9g} focal_point {eye + focus * forward}"
                f" blur_samples {samples} variance 0 confidence 0.9")
    head = (
        "#version 3.7;\n"
        f"global_settings {{ assumed_gamma 1 max_trace_level {depth} adc_bailout 0 }}\n"
        f"background {{ rgb {background} }}\n"
        f"camera {{ location {eye} direction {forward} right {2 * half * width / height * right} "
        f"up {2 * half * up}{blur} }}\n")
    return head + "".join(out)
