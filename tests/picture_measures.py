#!/usr/bin/env python3
"""What `grelha compare` says of two pictures, computed again: slowly, from the papers' formulas, by
whole squares of weights. SSIM: Wang et al. 2004. FLIP: Andersson et al. 2020.

  picture_measures.py PROGRAM
"""
import array
import math
import operator
import random
import re
import subprocess
import sys
import tempfile

# More rows than the program filters at a time; small, for this is no numpy.
WIDTH, HEIGHT = 14, 70
PIXELS_PER_DEGREE = .7 * 3840 / .7 * math.pi / 180
XYZ = ((10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794),
       (2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897),
       (1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382))
RGB = ((3.241003275, -1.537398934, -.498615861), (-.969224334, 1.875930071, .041554224),
       (.055639423, -.204011202, 1.057148933))
WHITE = (.950428545, 1, 1.088900371)


def times(matrix, vector):
    return [sum(map(operator.mul, row, vector)) for row in matrix]


def cut(value):
    return min(max(value, 0), 1)


def square(radius, weight):
    """Row by row."""
    around = range(-radius, radius + 1)
    return [weight(x, y) for y in around for x in around]


def sums(plane, weights):
    """Of the neighbours of each pixel; beyond the picture the nearest of its own."""
    radius = math.isqrt(len(weights)) // 2
    columns = [[cut_to(x + i, WIDTH) for i in range(-radius, radius + 1)] for x in range(WIDTH)]
    for y in range(HEIGHT):
        rows = [plane[cut_to(y + i, HEIGHT)] for i in range(-radius, radius + 1)]
        yield [sum(map(operator.mul, weights, (r[c] for r in rows for c in at))) for at in columns]


def cut_to(place, size):
    return min(max(place, 0), size - 1)


def mapped(function, *pictures):
    return [[function(*pixels) for pixels in zip(*rows)] for rows in zip(*pictures)]


def relative_mse(a, b):
    errors = [(p - q) ** 2 / (q * q + .01) for r, s in zip(a, b) for x, y in zip(r, s)
              for p, q in zip(x, y)]
    return sum(errors) / len(errors)


def ssim(a, b):
    weights = square(5, lambda x, y: math.exp(-(x * x + y * y) / (2 * 1.5 ** 2)))
    weights = [w / sum(weights) for w in weights]
    a, b = (mapped(lambda rgb: sum(map(operator.mul, map(cut, rgb), (.299, .587, .114))), picture)
            for picture in (a, b))

    def mean(function):
        return [row[5:-5] for row in list(sums(mapped(function, a, b), weights))[5:-5]]

    def similarity(x, y, xx, yy, xy):
        c1, c2 = .01 ** 2, .03 ** 2
        return ((2 * x * y + c1) * (2 * (xy - x * y) + c2) /
                ((x * x + y * y + c1) * (xx - x * x + yy - y * y + c2)))

    similar = mapped(similarity, mean(lambda x, y: x), mean(lambda x, y: y),
                     mean(lambda x, y: x * x), mean(lambda x, y: y * y), mean(lambda x, y: x * y))
    return sum(map(sum, similar)) / ((WIDTH - 10) * (HEIGHT - 10))


def opponents(rgb):
    light = [v / 12.92 if v <= .04045 else ((v + .055) / 1.055) ** 2.4 for v in map(cut, rgb)]
    x, y, z = map(operator.truediv, times(XYZ, light), WHITE)
    return 116 * y - 16, 500 * (x - y), 200 * (y - z)


def hunt_lab(light):
    def root(t):
        return t ** (1 / 3) if t > (6 / 29) ** 3 else t / (3 * (6 / 29) ** 2) + 4 / 29

    x, y, z = (root(t / white) for t, white in zip(times(XYZ, light), WHITE))
    lightness = 116 * y - 16
    return lightness, .01 * lightness * 500 * (x - y), .01 * lightness * 200 * (y - z)


def hyab(p, q):
    return (abs(p[0] - q[0]) + math.hypot(p[1] - q[1], p[2] - q[2])) ** .7


def contrast(*bells):
    def weight(x, y):
        z = (x * x + y * y) / PIXELS_PER_DEGREE ** 2
        return sum(a * math.sqrt(math.pi / b) * math.exp(-math.pi ** 2 * z / b) for a, b in bells)

    widest = math.ceil(3 * math.sqrt(.04 / (2 * math.pi ** 2)) * PIXELS_PER_DEGREE)
    weights = square(widest, weight)
    return [w / sum(weights) for w in weights]


def seen_colours(planes):
    filters = contrast((1, .0047)), contrast((1, .0053)), contrast((34.1, .04), (13.5, .025))
    filtered = [sums(plane, weights) for plane, weights in zip(planes, filters)]

    def lab(luma, red_green, blue_yellow):
        y = (luma + 16) / 116
        xyz = map(operator.mul, (y + red_green / 500, y, y - blue_yellow / 200), WHITE)
        return hunt_lab(list(map(cut, times(RGB, list(xyz)))))

    return mapped(lab, *filtered)


def strengths(luma, derivative):
    sigma = .5 * .082 * PIXELS_PER_DEGREE
    radius = math.ceil(3 * sigma)

    def balanced(weights):
        up, down = (sum(abs(w) for w in weights if sign * w > 0) for sign in (1, -1))
        return [w / (up if w > 0 else down) for w in weights]

    def weight(x, y):
        return derivative(x, sigma) * math.exp(-(x * x + y * y) / (2 * sigma * sigma))

    return mapped(math.hypot, sums(luma, balanced(square(radius, weight))),
                  sums(luma, balanced(square(radius, lambda x, y: weight(y, x)))))


def flip(a, b):
    seen = []
    for picture in (a, b):
        planes = [mapped(lambda rgb, i=i: opponents(rgb)[i], picture) for i in range(3)]
        luma = mapped(lambda y: (y + 16) / 116, planes[0])
        seen.append((seen_colours(planes), strengths(luma, lambda x, sigma: -x),
                     strengths(luma, lambda x, sigma: (x / sigma) ** 2 - 1)))
    largest = hyab(hunt_lab((0, 1, 0)), hunt_lab((0, 0, 1)))
    knee = .4 * largest

    def error(colour_a, colour_b, edge_a, edge_b, point_a, point_b):
        apart = hyab(colour_a, colour_b)
        colours = (.95 * apart / knee if apart < knee
                   else .95 + .05 * (apart - knee) / (largest - knee))
        features = max(abs(edge_a - edge_b), abs(point_a - point_b)) / math.sqrt(2)
        return colours ** (1 - math.sqrt(features))

    return mapped(error, *(seen[i][part] for part in range(3) for i in range(2)))


def write_pfm(path, picture):
    values = array.array("f", (v for row in reversed(picture) for rgb in row for v in rgb))
    if sys.byteorder == "big":
        values.byteswap()
    with open(path, "wb") as file:
        file.write(b"PF\n%d %d\n-1\n" % (WIDTH, HEIGHT) + values.tobytes())


def read_pfm(path):
    with open(path, "rb") as file:
        values = array.array("f", file.read().split(b"\n", 3)[3])
    if sys.byteorder == "big":
        values.byteswap()
    rows = [values[3 * WIDTH * y:3 * WIDTH * (y + 1)] for y in reversed(range(HEIGHT))]
    return [list(zip(row[::3], row[1::3], row[2::3])) for row in rows]


def pictures():
    """A ramp with stripes and a box, noisy and beyond 0 and 1; another box, other noise."""
    rng = random.Random(1)

    def colour(x, y, box):
        base = (x / WIDTH, .6 if y % 9 < 3 else .3, y / HEIGHT * 1.3 - .1)
        inside = abs(x - box) < 3 and abs(y - 30 - box) < 8
        return tuple((1 - v if inside else v) + rng.uniform(-.1, .1) for v in base)

    return [[[colour(x, y, box) for x in range(WIDTH)] for y in range(HEIGHT)] for box in (5, 7)]


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        files = [f"{folder}/{name}.pfm" for name in ("a", "b", "map")]
        for path, picture in zip(files, pictures()):
            write_pfm(path, picture)
        said = subprocess.run([program, "compare", *files[:2], "--error-map", files[2]],
                              check=True, capture_output=True, text=True).stdout
        a, b, error_map = map(read_pfm, files)
    found = map(float, re.search(r"relative MSE (\S+), SSIM (\S+), FLIP (\S+)\n", said).groups())
    errors = flip(a, b)
    expected = relative_mse(a, b), ssim(a, b), sum(map(sum, errors)) / (WIDTH * HEIGHT)
    print(said + "expected %.9g, %.9g, %.9g" % expected)
    # six digits are printed
    wrong = [pair for pair in zip(found, expected) if abs(pair[0] - pair[1]) > 1e-5 * pair[1]]
    # the map holds floats; the inverse of the matrix has nine digits here
    farthest = max(abs(v - e) for row, of_row in zip(error_map, errors)
                   for rgb, e in zip(row, of_row) for v in rgb)
    print(f"the map is off by {farthest:.2g} at most")
    return 1 if wrong or farthest > 1e-6 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
