"""Scenes that break adaptive samplers, written as NFF: KINDS by name, twenty variants of each.

`scene(kind, variant)` tells the text and the options of `render` that belong to it. Sizes are meant
for pictures of SIDE x SIDE pixels. `bare` omits the tiny objects that are counted.
The rest of the scene shows how bright their pixels are without them.
"""
import math
import random

from nff_text import SIDE, Scene, add, cross, dot, log_uniform, unit, words

VARIANTS = 20


def cones(rng, bare):
    s = Scene(rng, bare, eye=(0, 6, -20))
    for _ in range(rng.randint(1, 3)):
        s.light([rng.uniform(-15, 15), rng.uniform(8, 20), rng.uniform(-20, -5)], .6, .6, .6)
    if rng.random() < .5:
        s.matter(s.some(), .5)
        s.floor(-3)
    long, thick, count = rng.uniform(.25, .8), rng.uniform(.08, .3), rng.randint(40, 200)
    glows = rng.random() < .3
    for _ in range(count):
        depth = rng.uniform(14, 19)
        base = s.place(rng.uniform(1, 63), rng.uniform(1, 63), depth)
        way = unit([rng.gauss(0, 1) for _ in range(3)])
        step, colour, top = s.pixel(depth), s.bright(rng.uniform(1, 3)), rng.choice((0, .5, 1))
        if bare:
            continue
        s.glow(colour) if glows else s.matter(colour, .8, 1, 20)
        s.cone(base, thick / 2 * step, add(base, way, long * step), top * thick / 2 * step)
    return s


def specks(rng, bare):
    s = Scene(rng, bare)
    if rng.random() < .5:
        s.shadow_edge(40)
    else:
        s.stripes(40)
    s.specks(30, 160, (12, 28))
    return s


def pane(rng, bare):
    s = Scene(rng, bare)
    if rng.random() < .5:
        s.shadow_edge(40)
    else:
        s.stripes(40)
    s.specks(30, 160, (16, 28))
    s.matter([1, 1, 1], .05, rng.choice((0, .1)), 20, rng.uniform(.5, .9),
             rng.choice((1, 1, 1.1, 1.3, 1.5)))
    form = rng.choice(("polygon", "polygon", "box", "ball"))
    if form == "polygon":
        s.screen(10, -20, rng.uniform(-20, 20), SIDE + 20, SIDE + 20)
    elif form == "box":
        s.lines.append(f"box {words(-9, -9, -9.5, 9, rng.uniform(0, 9), -9.3)}")
    else:
        s.ball(s.place(32, 32, 9), rng.uniform(15, 28) * s.pixel(9))
    return s


def slit(rng, bare):
    size, height = rng.uniform(2, 8), rng.uniform(6, 14)
    part = log_uniform(rng, 1 / 1000, 1 / 20)
    s = Scene(rng, bare, eye=(0, 8, -16), background=[.02, .02, .03])
    wall = max(3.2, height * rng.uniform(.3, .6))
    # what a point of the floor sees of the light through the slit
    seen = part * height / wall
    strong = log_uniform(rng, .05, .5) / seen
    s.light([0, height, 2], strong, strong, strong * .9)
    s.matter(s.some())
    s.floor(0)
    s.matter(s.some())
    gap = part * size / 2
    s.quad([-60, wall, -60], [0, 0, 120], [60 - gap, 0, 0])
    s.quad([gap, wall, -60], [0, 0, 120], [60 - gap, 0, 0])
    s.lines[1:3] = ["from 0 2.5 -12", "at 0 0 2"]
    s.options = ["--shadows", f"random:{size:.4g}"]
    return s


def penumbrae(rng, bare):
    s = Scene(rng, bare, eye=(0, 9, -16))
    s.light([rng.uniform(-6, 6), rng.uniform(7, 16), rng.uniform(-6, 6)], 1, 1, 1)
    s.matter(s.some())
    s.floor(-1)
    for _ in range(rng.randint(3, 60)):
        s.matter(s.some(), rng.uniform(.6, 1), rng.choice((0, .2)), 20)
        s.ball([rng.uniform(-6, 6), rng.uniform(-.5, 4), rng.uniform(-5, 8)],
               log_uniform(rng, .03, 1.2))
    s.options = ["--shadows", f"random:{log_uniform(rng, .3, 8):.4g}"]
    return s


def lights32(rng, bare):
    s = Scene(rng, bare, eye=(0, 9, -16), background=[.05, .05, .1])
    wide = rng.random() < .5
    for _ in range(32):
        x, y, z = rng.uniform(-12, 12), rng.uniform(5, 14), rng.uniform(-8, 12)
        strong = log_uniform(rng, .01, .12)
        if wide:
            edge = log_uniform(rng, .1, 3)
            s.lines.append(f"al {words(x, y, z, edge, 0, 0, 0, 0, edge, strong, strong, strong)}")
        else:
            s.light([x, y, z], strong, strong * rng.uniform(.5, 1), strong)
    s.matter(s.some())
    s.floor(-1)
    for _ in range(rng.randint(4, 25)):
        s.matter(s.some())
        x, y, z = rng.uniform(-7, 7), rng.uniform(-1, 4), rng.uniform(-5, 8)
        if rng.random() < .5:
            s.ball([x, y, z], rng.uniform(.1, 1))
        else:
            s.quad([x, y, z], [rng.uniform(.1, 3), 0, 0], [0, 0, rng.uniform(.1, 3)])
    return s


def checks(s, rng, y, least=8, most=24):
    count, reach = rng.randint(least, most), 12.
    a, b, step = s.some(), s.some(), 2 * reach / count
    for k in range(2):
        s.matter(b if k else a)
        for i in range(count):
            for j in range(count):
                if (i + j) % 2 == k:
                    s.quad([-reach + i * step, y, -reach + j * step], [0, 0, step], [step, 0, 0])


def glass(rng, bare):
    s = Scene(rng, bare, eye=(0, 5, -14), at=(0, -.5, 0))
    s.light([5, 12, -8], 1, 1, 1)
    checks(s, rng, -1)
    for _ in range(rng.randint(1, 9)):
        s.matter([1, 1, 1], .05, rng.choice((0, .1, .3)), 50, rng.uniform(.7, .95),
                 rng.uniform(1.1, 1.8))
        radius = log_uniform(rng, .2, 1.8)
        s.ball([rng.uniform(-3, 3), radius - .9, rng.uniform(-3, 3)], radius)
    if rng.random() < .4:
        s.options = ["--depth", str(rng.randint(6, 9))]
    return s


def rough(rng, bare):
    s = Scene(rng, bare, eye=(0, 4, -14), background=[.02, .02, .05])
    s.light([3, 12, -8], .5, .5, .5)
    s.matter([.9, .9, .9], .2, rng.uniform(.5, .9), 20)
    s.floor(-1)
    s.ball([rng.uniform(-2, 2), .5, 1], 1.5)
    for _ in range(rng.randint(2, 20)):
        s.glow(s.bright(rng.uniform(1, 12)))
        s.ball([rng.uniform(-5, 5), rng.uniform(0, 5), rng.uniform(2, 9)],
               log_uniform(rng, .02, .4))
    s.options = ["--glossy", f"{log_uniform(rng, .01, .4):.3g}"]
    return s


def graze(rng, bare):
    high = log_uniform(rng, .1, 3)
    s = Scene(rng, bare, eye=(rng.uniform(-2, 2), high, 0), at=(rng.uniform(-3, 3), high * .8, 20),
              background=[.5, .6, .8])
    s.light([100, 200, -50], 1, 1, 1)
    wide, form = log_uniform(rng, .1, 2) * high, rng.choice(("along", "across", "slanted"))
    a, b = s.some(), s.some()
    s.matter(a)
    s.floor(0, 2000.)
    s.matter(b)
    for k in range(-200, 200):
        x = 2 * k * wide
        if form == "across":
            s.quad([-800, .001 * high, x], [0, 0, wide], [1600, 0, 0])
        else:
            lean = rng.uniform(.9, 1.1) * 300 if form == "slanted" else 0
            s.quad([x, .001 * high, -1], [lean, 0, 900], [wide, 0, 0])
    return s


def bokeh(rng, bare):
    s = Scene(rng, bare)
    if rng.random() < .5:
        s.stripes(60)
    for _ in range(rng.randint(10, 120)):
        depth = rng.uniform(8, 50)
        s.glow(s.bright(log_uniform(rng, 2, 200)))
        s.ball(s.place(rng.uniform(0, SIDE), rng.uniform(0, SIDE), depth),
               log_uniform(rng, .05, 1) * s.pixel(depth))
    s.options = ["--lens", f"{log_uniform(rng, 4, 40):.3g},{rng.uniform(14, 26):.3g}"]
    return s


def hairs(rng, bare):
    s = Scene(rng, bare)
    s.light([10, 20, -20], 1, 1, 1)
    if rng.random() < .4:
        s.stripes(40)
    for _ in range(rng.randint(20, 150)):
        depth, wide, long = rng.uniform(14, 26), log_uniform(rng, .02, .5), rng.uniform(10, 70)
        x, y, turn = rng.uniform(0, SIDE), rng.uniform(0, SIDE), rng.uniform(0, 2 * math.pi)
        dx, dy = math.cos(turn), math.sin(turn)
        a, b = s.place(x, y, depth), s.place(x + long * dx, y + long * dy, depth)
        if rng.random() < .5:
            s.glow(s.bright(max(1, .3 / wide)))
            s.polygon([a, s.place(x - wide * dy, y + wide * dx, depth), b])
        else:
            s.matter(s.bright(), .9, .5, 30)
            s.cone(a, wide / 2 * s.pixel(depth), b, wide / 2 * s.pixel(depth))
    return s


def glints(rng, bare):
    s = Scene(rng, bare, eye=(0, 4, -20))
    strong = log_uniform(rng, 2, 20)
    s.light([rng.uniform(-10, 10), rng.uniform(8, 20), rng.uniform(-30, -10)], *[strong] * 3)
    s.matter([.4 / strong] * 3)
    s.floor(-4)
    for _ in range(rng.randint(20, 120)):
        depth, radius = rng.uniform(14, 20), log_uniform(rng, .4, 5)
        shine = log_uniform(rng, 50, 3000)
        s.matter([1, 1, rng.uniform(.5, 1)], .1 / strong, 0 if bare else .5, shine)
        s.ball(s.place(rng.uniform(0, SIDE), rng.uniform(0, SIDE), depth), radius * s.pixel(depth))
    return s


def mirrorspecks(rng, bare):
    s = Scene(rng, bare)
    normal = unit([rng.choice((-1, 1)) * rng.uniform(.7, 1.3), rng.uniform(-.3, .3), -1])
    middle = s.place(32, 32, 12)
    side = unit(cross([0, 1, 0], normal))
    up = cross(normal, side)

    def turned(point):
        return add(point, normal, -2 * dot(add(point, middle, -1), normal))

    s.matter([1, 1, 1], .02, rng.uniform(.7, 1), 10)
    reach = rng.uniform(3, 8)
    corner = add(add(middle, side, -reach), up, -reach)
    s.quad(corner, [2 * reach * x for x in side], [2 * reach * x for x in up])
    s.light([0, 10, -30], .5, .5, .5)
    s.specks(40, 160, (22, 34), turned)
    return s


def dark(rng, bare):
    s = Scene(rng, bare, eye=(0, 7, -14), background=[0, 0, 0])
    strong = rng.uniform(.3, 1.5)
    s.light([rng.uniform(-3, 3), rng.uniform(8, 14), rng.uniform(-3, 6)], *[strong] * 3)
    s.matter(s.some())
    s.floor(-1)
    high = rng.uniform(2.5, 6)
    for _ in range(rng.randint(8, 40)):
        s.matter(s.some())
        s.quad([rng.uniform(-9, 5), high + rng.uniform(0, .5), rng.uniform(-7, 7)],
               [rng.uniform(1, 5), 0, 0], [0, 0, rng.uniform(1, 5)])
    s.lines[1] = "from 0 1.5 -12"
    s.options = ["--shadows", f"random:{log_uniform(rng, 1, 10):.4g}"]
    return s


KINDS = {f.__name__: f for f in (
    cones, specks, pane, slit, penumbrae, lights32, glass, rough, graze, bokeh, hairs, glints,
    mirrorspecks, dark)}
COUNTED = ("cones", "specks", "pane", "glints", "mirrorspecks")


def scene(kind, variant, bare=False):
    """NFF, and the options of `render` that go with it."""
    made = KINDS[kind](random.Random(variant), bare)
    return "\n".join(made.lines) + "\n", made.options
