"""NFF written piece by piece, with places and sizes in pixels of the picture: what
hostile_scenes is made with."""
import math

SIDE = 64


def add(a, b, scale=1.):
    return [x + scale * y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(dot(a, a))
    return [x / length for x in a]


def words(*numbers):
    return " ".join(f"{x:.9g}" for x in numbers)


def log_uniform(rng, least, most):
    return math.exp(rng.uniform(math.log(least), math.log(most)))


class Scene:
    """Text that grows, and the camera that tells where a pixel lies and how large it is."""

    def __init__(self, rng, bare, eye=(0, 0, -20), at=(0, 0, 0), angle=None, background=None):
        self.rng, self.bare = rng, bare
        angle = angle or rng.uniform(20, 40)
        if background is None:
            background = [rng.uniform(0, .4) for _ in range(3)]
        self.eye, self.slope = list(eye), 2 * math.tan(math.radians(angle) / 2) / SIDE
        self.forward = unit(add(at, eye, -1))
        self.right = unit(cross([0, 1, 0], self.forward))
        self.up = cross(self.forward, self.right)
        self.options = []
        self.lines = [
            "v", f"from {words(*eye)}", f"at {words(*at)}", "up 0 1 0", f"angle {words(angle)}",
            "hither .01", f"resolution {SIDE} {SIDE}", f"b {words(*background)}"]

    def pixel(self, depth):
        return self.slope * depth

    def place(self, x, y, depth):
        """The point that pixel coordinates x, y show at this depth."""
        step = self.pixel(depth)
        point = add(self.eye, self.forward, depth)
        return add(add(point, self.right, (x - SIDE / 2) * step), self.up, (SIDE / 2 - y) * step)

    def light(self, where, *colour):
        self.lines.append(f"l {words(*where, *colour)}")

    def matter(self, colour, kd=1., ks=0., shine=0., through=0., ior=1.):
        self.lines.append(f"f {words(*colour, kd, ks, shine, through, ior)}")

    def glow(self, colour):
        self.lines.append(f"f 0 0 0 0 0 0 0 0 0 0 1 {words(*colour)}")

    def polygon(self, corners):
        self.lines.append(f"p {len(corners)}")
        self.lines += [words(*corner) for corner in corners]

    def quad(self, corner, a, b):
        self.polygon([corner, add(corner, a), add(add(corner, a), b), add(corner, b)])

    def ball(self, centre, radius):
        self.lines.append(f"s {words(*centre, radius)}")

    def cone(self, base, r0, apex, r1):
        self.lines.append(f"c {words(*base, r0, *apex, r1)}")

    def floor(self, y, reach=200.):
        self.polygon([[-reach, y, -reach], [-reach, y, reach], [reach, y, reach],
                      [reach, y, -reach]])

    def screen(self, depth, x0, y0, x1, y1):
        """A rectangle of pixels, towards the eye."""
        self.polygon([self.place(x, y, depth) for x, y in ((x0, y0), (x0, y1), (x1, y1), (x1, y0))])

    def disc(self, centre, radius):
        """A 12-gon, tilted by up to 75 degrees away from the eye."""
        normal = unit(add(self.eye, centre, -1))
        side = unit(cross([.3, 1, .2], normal))
        up = cross(normal, side)
        turn, tilt = self.rng.uniform(0, 2 * math.pi), math.radians(self.rng.uniform(0, 75))
        along = add([math.cos(turn) * x for x in side], up, math.sin(turn))
        across = cross(normal, along)
        short = add([math.cos(tilt) * x for x in across], normal, math.sin(tilt))
        angles = [2 * math.pi * k / 12 for k in range(12)]
        return [add(add(centre, along, radius * math.cos(t)), short, radius * math.sin(t))
                for t in angles]

    def bright(self, most=1.):
        colour = [self.rng.uniform(.2, 1) for _ in range(3)]
        colour[self.rng.randrange(3)] = 1.
        return [most * x for x in colour]

    def some(self):
        return [self.rng.uniform(.1, .9) for _ in range(3)]

    def speck(self, x, y, depth, turned=lambda point: point):
        """A glowing disc or ball of .02 to .3 pixels; `turned` moves its points."""
        size = log_uniform(self.rng, .02, .3)
        glow = self.bright(max(1, min(60, .25 / size ** 2)) * self.rng.uniform(1, 1.5))
        centre, radius = self.place(x, y, depth), size / 2 * self.pixel(depth)
        corners = self.disc(centre, radius) if self.rng.random() < .6 else None
        if self.bare:
            return
        self.glow(glow)
        if corners:
            self.polygon([turned(corner) for corner in corners])
        else:
            self.ball(turned(centre), radius)

    def specks(self, least, most, depths, turned=lambda point: point):
        for _ in range(self.rng.randint(least, most)):
            self.speck(self.rng.uniform(1, SIDE - 1), self.rng.uniform(1, SIDE - 1),
                       self.rng.uniform(*depths), turned)

    def stripes(self, depth):
        """Slanted stripes behind everything, each a few pixels wide."""
        wide, slant = self.rng.uniform(1.5, 9), self.rng.uniform(-40, 40)
        a, b, x, k = self.some(), self.some(), -50., 0
        while x < SIDE + 50:
            self.glow(a if k % 2 else b)
            self.polygon([self.place(*p, depth) for p in (
                (x, -2), (x + slant, SIDE + 2), (x + slant + wide, SIDE + 2), (x + wide, -2))])
            x, k = x + wide, k + 1

    def shadow_edge(self, depth):
        """A wall that fills the picture, and what throws a large shadow on part of it."""
        self.matter(self.some())
        self.screen(depth, -40, -40, SIDE + 40, SIDE + 40)
        self.light(self.place(-200, -150, depth * .5), .8, .8, .8)
        self.light(self.eye, .2, .2, .2)
        self.matter(self.some())
        edge, lean, low = (self.rng.uniform(*r) for r in ((-40, -10), (-15, 15), (-30, 40)))
        self.polygon([self.place(*p, depth * .8) for p in (
            (-200, -200), (-200, low), (edge + lean, low + lean), (edge - lean, -200))])
        across = self.rng.uniform(20, 44)
        self.screen(depth * .9, across, self.rng.uniform(20, 40), across + 3, SIDE + 60)
