#!/usr/bin/env python3
"""Plants known faults, one at a time, in a copy of the sources: the test named must turn red.

  tests/plant.py [--only PART OF A NAME] [--folder FOLDER] [--list]

A fault is a piece of text and what replaces it; one that is not found exactly once ends the script,
so that no fault is thought planted that is not. All are built without SIMD copies and with -O1, but
the one that wants copies, and -O3, where products and sums are contracted. Exits 1 when a test
stayed green. Takes some ten minutes; the list with its last outcome is in docs/numerics.md.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass

ROOT = pathlib.Path(__file__).resolve().parent.parent


@dataclass
class Fault:
    name: str
    file: str
    old: str
    new: str
    test: str           # the program, without _test
    cases: str          # --gtest_filter
    simd: bool = False  # wants copies of more than one width


def tolerance(name, room, constant, value, planted, test, cases):
    """A constant of a room's tolerances set to what breaks its promise."""
    return Fault(name, f"kernel/{room}/tolerances.hpp", f"{constant} = {value};",
                 f"{constant} = {planted};", test, cases)


def adaptive(name, file, old, new, cases):
    return Fault(name, f"kernel/adaptive/{file}.cpp", old, new, "small_things", cases)


ROW = "Rows/Stability.NothingIsLostFalseOrMetAgain/"
FAULTS = [
    Fault("no growth of boxes", "kernel/world/plan.cpp", "return reach * 256 / 16777216;",
          "return reach * 0;", "grid", "Pads.*"),
    Fault("t from afar taken for exact", "kernel/trace/afar.hpp",
          "kAfarSlack = 0x1p-16;", "kAfarSlack = 0;", "walk", "Isa/RaysFromAfar.*"),
    Fault("boxes from afar where they are", "kernel/walk/abreast.hpp",
          "return kFromAfar ? at - Block(grid_.lo_f[axis]) : at;", "return at;",
          "walk", "Isa/RaysFromAfar.*"),
    Fault("doubles taken for exact", "kernel/world/plan.cpp",
          "kDoublesOff = 0x1p-46;", "kDoublesOff = 0;", "walk", "Isa/RaysFromAfar.*"),
    Fault("nothing beside a beam from afar", "kernel/features/beam_search.hpp",
          "kBesideSlack * terms", "kBesideSlack * terms + 1e30f", "beam", "*MeshFromAfar*"),
    Fault("< for <= in the walk", "kernel/walk/packet_traversal.hpp", "slice <= last;",
          "slice < last;", "walk", "Isa/Walk.*"),
    Fault("adding up instead of computing again", "kernel/walk/course.hpp",
          "return (plane - place[axis]) * inverse[axis];",
          """return [&] {
        const float from = place[axis], to = plane, step = inverse[axis];
        float k = to > from ? __builtin_ceilf(from) : __builtin_floorf(from);
        float sum = (k - from) * step;
        for (; k < to; ++k) sum += step;
        for (; k > to; --k) sum -= step;
        return sum;
      }();""", "walk", "Isa/Walk.*"),
    Fault("contraction", "CMakeLists.txt", "-Wshadow -ffp-contract=off",
          "-Wshadow -ffp-contract=fast", "variants", "*ReturnTheScalarBits*", simd=True),
    Fault("unshuffled light samples", "kernel/render/sampling.hpp",
          "if (plan.kind == SamplePlan::kUnshuffled) return",
          "if (plan.kind != SamplePlan::kSobol) return", "stability",
          "Rows/StabilityOfPictures.NoPixelIsWrong/correlated_samples"),
    Fault("skipping a slice too far", "kernel/walk/packet_traversal.hpp", ": nearest - 1;",
          ": nearest;", "walk", "Isa/Walk.*"),
    Fault("a mailbox that is kept for the next packet", "kernel/walk/packet_traversal.hpp",
          "if (mailbox) held_.clear();", "", "walk", "Isa/Walk.*"),
    Fault("outlines without room beside them", "kernel/perspective/in_tiles.hpp",
          "const Real margin = s.margin + rounding * (magnitude(s.a) + magnitude(s.b));",
          "const Real margin = Real(1e-9) * (s.margin + rounding * (magnitude(s.a) + "
          "magnitude(s.b)));",
          "point_grid", "*AnswerAsTheScenesGridsDo*"),
    Fault("sides without their rounding", "kernel/perspective/tolerances.hpp",
          "kOutlineRounding = 0x1p-21;", "kOutlineRounding = 0x1p-26;", "point_grid",
          "*HoldWhatLiesOnThem*"),
    Fault("sides from afar without their rounding", "kernel/perspective/tolerances.hpp",
          "kSpanRounding = 2;", "kSpanRounding = 0;", "point_grid", "*HoldWhatLiesOnThem*"),
    Fault("normals without their rounding", "kernel/perspective/tolerances.hpp",
          "kNormalRounding = 0x1p-49;", "kNormalRounding = 0;", "point_grid",
          "*HoldTrianglesByTheirSides*"),
    Fault("sides of cones that are seen too thin", "kernel/perspective/tolerances.hpp",
          "kNarrowestCone = 1e-6;", "kNarrowestCone = 0;", "point_grid",
          "*Outlines.HoldCones*"),
    Fault("places of parts without their rounding", "kernel/perspective/tolerances.hpp",
          "kPlaceRounding = 0x1p-22;", "kPlaceRounding = 0;", "point_grid",
          "Boxes.*"),
    Fault("outlines up to the point itself", "kernel/perspective/tolerances.hpp",
          "kNearest = 8;", "kNearest = 0;", "point_grid",
          "*AnswerAsTheScenesGridsDo*"),
    Fault("no room in depth for rays from near", "kernel/perspective/tolerances.hpp",
          "kNearPads = 1;", "kNearPads = 0;", "point_grid",
          "*AnswerAsTheScenesGridsDo*"),
    Fault("no room in depth for rays from afar", "kernel/perspective/tolerances.hpp",
          "kFarPads = 2;", "kFarPads = 0;", "point_grid",
          "*AnswerAsTheScenesGridsDo*"),
    Fault("no room beside for rays from near", "kernel/perspective/tolerances.hpp",
          "kNearAside = 1. / 16;", "kNearAside = 0;", "point_grid",
          "*PointReach*"),
    Fault("no room beside for rays from afar", "kernel/perspective/tolerances.hpp",
          "kFarAside = 1;", "kFarAside = 0;", "point_grid",
          "*PointReach*"),
    Fault("no rays from afar", "kernel/world/world.cpp",
          "kPointReach = 128;", "kPointReach = 1;", "point_grid",
          "*PointReach*"),
    Fault("rays from afar where the origin is far", "kernel/world/world.cpp",
          "kPointOffset = 6;", "kPointOffset = 12;", "point_grid",
          "*PointReach*"),
    Fault("room for rays from afar around specks", "kernel/world/world.cpp",
          "kFarRoom = 32;", "kFarRoom = 0;",
          "point_grid", "*StayFewWherePrimitivesAreSmall*"),
    Fault("outlines without room in depth", "kernel/perspective/outline.hpp",
          "o.near = greater(o.near - pad, look.distance - pad);",
          "o.near = greater(o.near + pad, look.distance + pad);",
          "point_grid", "*AnswerAsTheScenesGridsDo*"),
    Fault("triangles met for sure at their sides", "kernel/perspective/view.hpp",
          "kSurelyInside = 2;", "kSurelyInside = 0;", "point_grid", "*AnswerAsTheScenesGridsDo*"),
    Fault("lone rays that stop before a list of another tile", "kernel/trace/point_alone.hpp",
          "((near & listed) == listed)", "(near == 255)", "point_grid",
          "*AnswerAsTheScenesGridsDo*"),
    Fault("no room for what lone rays are to be tested against", "kernel/trace/point_alone.hpp",
          "if (due_ >= kMost) settle();", "if (due_ >= kMost) due_ = 0;", "point_grid",
          "*AnswerAsTheScenesGridsDo*", simd=True),
    Fault("triangles met for sure in front of a lone ray's start",
          "kernel/trace/listed.hpp",
          "both(inside >= Block(kSurelyInside), load<Block>(b.far + i) <= depth)",
          "inside >= Block(kSurelyInside)", "point_grid", "*AnswerAsTheScenesGridsDo*"),
    Fault("triangles met for sure in front of a ray's start", "kernel/trace/listed.hpp",
          "both(inside >= Lanes(kSurelyInside), Lanes(b.far[k]) <= depth)",
          "both(inside >= Lanes(kSurelyInside), Lanes(b.near[k]) <= depth)", "point_grid",
          "*AnswerAsTheScenesGridsDo*", simd=True),
    Fault("tiles left out that a side passes through", "kernel/perspective/in_tiles.hpp",
          "o - select(up, room, never)", "o - select(up, Real(-.02), never)", "point_grid",
          "*AnswerAsTheScenesGridsDo*"),
    Fault("the last of eight primitives for one of fewer", "kernel/perspective/look.hpp",
          "to.seen &= (1u << few.count) - 1;", "", "point_grid", "*Looks*", simd=True),
    Fault("primitives of one depth in any order", "kernel/perspective/look.hpp",
          "other == depth ? first : none", "none", "point_grid",
          "*AnswerAsTheScenesGridsDo*:*PointGridLists*"),
    Fault("ends of cones that face away", "kernel/perspective/outline.hpp",
          "both(touches, same_side)", "touches", "point_grid", "*Outlines.HoldCones*"),
    Fault("a gap between faces", "kernel/perspective/outline.hpp",
          "o.hi[j] = lesser(o.hi[j] + grow, Real(1));",
          "o.hi[j] = lesser(o.hi[j] + grow, Real(1 - 1e-6));",
          "point_grid", "*AnswerAsTheScenesGridsDo*"),
    Fault("a sphere by the textbook", "kernel/shapes/sphere.hpp",
          "inside = rr - dot(gap, gap);",
          "inside = middle * middle / inv_dd - (dot(to_center, to_center) - rr);",
          "stability", ROW + "specks_in_a_large_scene"),
    Fault("a sphere's power without slack", "kernel/shapes/sphere.hpp", "kPowerError = 0x1p-21f;",
          "kPowerError = 0;", "sphere", "SphereOracle.MeasuresShortWays"),
    Fault("a sphere's chord without slack", "kernel/shapes/sphere.hpp", "kChordError = 0x1p-20f;",
          "kChordError = 0;", "sphere", "SphereOracle.MeasuresShortWays"),
    Fault("floats for short ways to a sphere", "kernel/shapes/sphere.hpp", "kFarPower = 0x1p-4f;",
          "kFarPower = 0;", "sphere", "SphereOracle.MeasuresShortWays"),
    Fault("a sphere's place by t", "kernel/shapes/sphere.hpp",
          "return rounded_sphere_place<Real>(met.org, met.dir, met.t, c, r);",
          "return sphere_place<Real>(c, r, met.org + met.t * met.dir);", "leaving",
          "Leaving.MirrorRaysOf*"),
    Fault("epsilon 1e-4 instead of bounds", "kernel/triangle/triangle_surface.hpp",
          "Real(4 * kEps) * largest(point) + Real(kWideEps) * corners,", "Real(1e-4f),",
          "stability", ROW + "lost_contacts:" + ROW + "self_hits_of_triangles"),
    Fault("no filter of edges", "kernel/triangle/triangle.hpp", "kEdgeError = 0x1p-19f",
          "kEdgeError = 0", "watertight", "*"),
    Fault("floats for any depth", "kernel/triangle/triangle.hpp", "kMostSpread = 2;",
          "kMostSpread = 1e30f;", "triangle", "TriangleOracle.FloorsOfAnySizeAreMetWhereTheyAre"),
    Fault("past planes without slack", "kernel/triangle/triangle_crossing.hpp",
          "kProductError = 0x1p-20f", "kProductError = 0", "triangle",
          "TriangleCrossing.RaysPastAPlaneAreBehindIt"),
    Fault("past planes by products that underflow", "kernel/triangle/triangle_crossing.hpp",
          "kLeastProduct = 0x1p-100f", "kLeastProduct = 0", "triangle",
          "TriangleCrossing.RaysPastAPlaneAreBehindIt"),
    Fault("normals of needles taken for exact", "kernel/triangle/triangle_touch.hpp",
          "kNormalError = 0x1p-51", "kNormalError = 0", "triangle", "TriangleTouch.*"),
    Fault("boxes of blocks without room", "kernel/grid/block_box.cpp", "kSlabRoom = .25",
          "kSlabRoom = 0", "walk", "*Walk*"),
    Fault("no headway at all", "kernel/walk/tolerances.hpp", "kLeastHeadway = 1e-12f",
          "kLeastHeadway = 0", "walk", "*Walk*"),
    Fault("headway where there is none", "kernel/walk/tolerances.hpp", "kLeastHeadway = 1e-12f",
          "kLeastHeadway = 1e-4f", "walk", "*Walk*"),
    Fault("floats next to doubles as they come", "kernel/simd/lanes.hpp", "DoubleLanes(0x1p-23)",
          "DoubleLanes(0)", "rounding", "*StoresFloatsBesideDoubles*"),
    Fault("behind without slack", "kernel/triangle/triangle.hpp", "kDepthError = 0x1p-17f",
          "kDepthError = 0", "triangle", "TriangleOracle.FloorsOfAnySizeAreMetWhereTheyAre"),
    Fault("spheres without a bulge", "kernel/shapes/sphere.hpp", "kBulge = 0x1p-42f;",
          "kBulge = 0;", "leaving", "*LargeSpheresAtTheOrigin"),
    Fault("triangles without what double takes", "kernel/primitive/surface_place.hpp",
          "kWideEps = 0x1p-48f;", "kWideEps = 0;", "leaving", "*LargeTrianglesAtTheOrigin"),
    Fault("rays that leave cones where they met them", "kernel/shapes/cone.hpp",
          "Real(32 * kRounding<Real>)", "Real(0 * kRounding<Real>)", "leaving", "Leaving.Cones"),
    Fault("rays that leave planes where they met them", "kernel/shapes/plane.hpp",
          "Real(8 * kRounding<Real>)", "Real(0 * kRounding<Real>)", "leaving", "Leaving.Planes"),
    Fault("ends of a search without rounding", "kernel/triangle/triangle.hpp",
          "kDepthRounding = 0x1p-20f;", "kDepthRounding = 0;", "triangle",
          "TriangleOracle.EndsOfASearchDecideAsTDoes"),
    Fault("rows that are not counted", "kernel/walk/abreast.hpp",
          "count_rows<Triangle>(n_, due, kBlock);", "n_.tests[kNumber<Triangle>] += 8u * due;",
          "variants", "*CountRowsOfLoneRays*"),
    Fault("lights' grids for few primitives", "kernel/render/setup.cpp", "kFewestSeen = 32;",
          "kFewestSeen = 0;", "point_grid", "LightGrids.AreNotBuiltForFew"),
    Fault("no room for the blocks that a ray is due at", "kernel/walk/abreast.hpp",
          "settle(due); due = 0;", "due = 0;", "walk", "*Walk*layers", simd=True),
    Fault("no room for the spheres that a ray is due at", "kernel/walk/abreast.hpp",
          "test_rows<Shape>(list, due); due = 0;", "due = 0;", "walk", "*Walk*layers"),
    Fault("ties by arrival", "kernel/walk/packet.hpp",
          "if ((ties >> k & 1) && (held == kNoPrimitive || held <= id)) return;",
          "if (ties >> k & 1) return;", "walk", "Isa/Ties.*"),
    tolerance("rays without headway", "walk", "kLeastProgress", ".15f", "0", "frustum",
              "Isa/Frusta.*"),
    tolerance("slopes of a thin stay", "walk", "kThinStay", "1e-3f", "0", "frustum",
              "Isa/Frusta.*"),
    tolerance("a frustum without rounding", "walk", "kSideRounding", "2.3e-6f", "0", "frustum",
              "Isa/Frusta.*"),
    tolerance("planes without rounding", "walk", "kPlaneRounding", "1e-6f", "0", "frustum",
              "Isa/Frusta.*"),
    tolerance("no room for balls beside planes", "walk", "kPadOfBalls", ".5f", "0", "frustum",
              "Isa/Frusta.*"),
    tolerance("a near plane without slack", "walk", "kNearSlack", "6e-6f", "0", "frustum",
              "Isa/Frusta.*"),
    tolerance("gradients without slack", "walk", "kReachSlack", "1.00001f", "1", "frustum",
              "Isa/Frusta.*"),
    tolerance("one surface at any angle", "features", "kOneSurfaceSquared", ".64f", "0", "beam",
              "*DoubtsASteepTip*"),
    tolerance("normals at any angle", "features", "kOneSurface", ".8f", "-2", "beam",
              "*DoubtsASurfaceThatTurns*"),
    tolerance("edges of the inner third alone", "features", "kEdgeInside", ".95f", ".3f", "beam",
              "*DoubtsASlitNear*"),
    tolerance("shadows of the first nine tenths alone", "features", "kBeforeSurface", ".9999f",
              ".9f", "beam", "*ShadowOfWhatIsNear*"),
    tolerance("mirrors of no weight", "features", "kLeastMirror", "1.f / 64", "0", "beam",
              "*LeavesOutMirrors*"),
    tolerance("beams as wide as their pixels", "features", "kPixelGrowth", "1.0625f", "1", "beam",
              "*SpeckOnlyTouches*"),
    tolerance("beams as wide as their squares", "features", "kSquareGrowth", "1.25f", "1", "beam",
              "*AsksThePixels*"),
    tolerance("no variance of what hides", "adaptive", "kHiddenVariance", ".15f", "0",
              "refinement", "*ReckonsWith*"),
    tolerance("no width of what hides", "adaptive", "kHiddenWidth", "6", "0", "refinement",
              "*ReckonsWith*"),
    tolerance("no trust below 1", "adaptive", "kVarianceInflation", "1.12 * 1.12", "1",
              "refinement", "*IsNotFooled*"),
    tolerance("beams of any width", "features", "kNarrow", ".998f", "0", "beam", "*IsThereFor*"),
    tolerance("no apex of parallel rays", "features", "kFarthestApex", "1e4f", "0",
              "beam", "BeamFrame.HoldsParallel*"),
    tolerance("beams that begin on their mirrors", "features", "kDepthMargin", ".1f", "0",
              "beam", "BeamFrame.BeginsBehind*"),
    tolerance("balls aimed at inside", "features", "kRimShare", ".9f", "0", "beam", "*MeetsABall*"),
    tolerance("balls aimed past", "features", "kRimShare", ".9f", "1.8f", "beam", "*MeetsABall*"),
    Fault("origins that are left where they are", "kernel/features/beam_frame.hpp",
          "const Vec3f across = away - (dot(away, f.unit) / along) * b.dir[i];",
          "const Vec3f across = away;", "beam", "BeamFrame.HasItsApex*"),
    Fault("nothing at the corners of pixels", "kernel/features/doubt.hpp",
          "if (differ) found = found + at_corners(f, met, front, weight);", "", "beam",
          "*BeamBoxes.HoldSpecksInEach*"),
    Fault("lamps no brighter than white", "kernel/features/doubt.hpp",
          "return greater(1.f, largest(own) + sent_on * shading_.brightest);", "return 1;", "beam",
          "*BeamBoxes.Weigh*"),
    Fault("things as grids find them", "kernel/features/beam_search.hpp", "met.sort();", "", "beam",
          "*BeamBoxes.AreTheSame*"),
    Fault("boxes of what lies beside the pixel", "kernel/features/beam_clip.hpp",
          "constexpr float kSide = 1 / kPixelGrowth;", "constexpr float kSide = 2;", "beam",
          "*BeamBoxes.AreThoseOfSpecksInThe*"),
    Fault("no samples in boxes", "kernel/render/band.hpp", "if (work.boxes)", "if (false)",
          "sampling", "*PixelBoxes.GetHalf*"),
    Fault("samples in boxes that weigh as all", "kernel/render/band.hpp",
          "return select(has, weight, one);", "return one;", "sampling", "*PixelBoxes.Move*"),
    tolerance("no disc", "adaptive", "kDiscInBox", ".7853982f", "0", "refinement", "*InABox*"),
    adaptive("things of a pixel and more taken for large", "small_things", "kThin = 2;",
             "kThin = 1;", "SmallThings.AreMarkedWhereTheyAreSeen"),
    adaptive("shadows of cones on themselves", "small_things", "way_out(rod, part, ray, length);",
             "rod.reach;", "SmallThings.AreMarkedWhereTheirShadowsFall"),
    adaptive("gaps in long shadows", "small_things", "(near || id[i] == id[i - 1])", "near",
             "SmallThings.AreMarkedWhereShadowsOfLong*"),
    adaptive("meshes of any materials", "mesh_rims", "+ triangles_.material[i]", "",
             "MeshRims.AreAroundHoles*"),
    adaptive("places by the sign of their zeros", "mesh_rims", "(x + 0.f)", "(x)",
             "MeshRims.AreWhereEdges*"),
    adaptive("meshes without outlines", "mesh_rims",
             "turns |= sides_[first] == (kFront | kBack);", "", "MeshRims.AreTheOutlines*"),
    Fault("cones met by their balls alone", "kernel/features/beam.hpp", "which < places.kCount;",
          "which < 0;", "beam", "*MeetsCones*"),
    tolerance("none as far", "features", "kBehindHit", "1.0001f", "1", "beam", "*MissesNoTri*"),
    tolerance("one difference too few of the young", "adaptive", "kYoung", "3", "2",
              "refinement", "PixelErrors.EstimateThe*"),
    tolerance("one difference too few of the old", "adaptive", "kOld", "7", "6",
              "refinement", "PixelErrors.EstimateThe*"),
    tolerance("no intervals", "adaptive", "kNormal", "1.96f", "0", "refinement", "*MakeIntervals*"),
    tolerance("intervals of twice the width", "adaptive", "kNormal", "1.96f", "3.92f",
              "refinement", "PixelErrors.MakeIntervals*"),
    tolerance("bounds without spread", "adaptive", "kNormalOneSided", "1.645", "0",
              "refinement", "PixelErrors.BoundThe*"),
    tolerance("bounds with twice the spread", "adaptive", "kNormalOneSided", "1.645", "3.29",
              "refinement", "PixelErrors.BoundThe*"),
    tolerance("none agree", "adaptive", "kAgreement", ".005f", "0", "refinement", "*SeeASample*"),
    tolerance("samples agree too easily", "adaptive", "kAgreement", ".005f", ".01f",
              "refinement", "PixelErrors.SeeASample*"),
]


def run(command, log, **more):
    with open(log, "ab") as out:
        return subprocess.run(command, stdout=out, stderr=subprocess.STDOUT, **more).returncode


def configure(source, build, simd, log):
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    how = ["-DGRELHA_SIMD=OFF", "-DCMAKE_BUILD_TYPE=None", "-DCMAKE_CXX_FLAGS=-O1"]
    if simd:
        how = ["-DGRELHA_SIMD=ON", "-DCMAKE_BUILD_TYPE=Release"]
    command = ["cmake", "-S", source, "-B", build, "-G", "Ninja", "-DGRELHA_TESTS=ON",
               "-DGRELHA_PERF=OFF", *how, *launcher]
    if run(command, log):
        sys.exit(f"plant: {log}: no build can be set up")


def copy_sources(to):
    """All but builds and history; a file that is there already keeps its time, so that it is not
    built again."""
    def left_out(folder, names):
        return {"build", ".git"} & set(names) if pathlib.Path(folder) == ROOT else set()

    def copy(file, place):
        file, place = pathlib.Path(file), pathlib.Path(place)
        if not place.exists() or file.read_bytes() != place.read_bytes():
            shutil.copy(file, place)

    shutil.copytree(ROOT, to, dirs_exist_ok=True, ignore=left_out, copy_function=copy)


def outcome(source, fault, log):
    """Whether the fault's test passes on what the folder holds."""
    build = source / ("build-simd" if fault.simd else "build")
    if not build.exists():
        configure(source, build, fault.simd, log)
    if run(["ninja", "-C", build, f"{fault.test}_test"], log):
        sys.exit(f"plant: {log}: does not compile with '{fault.name}'")
    # A walk that has lost its way may not end: that is as red.
    try:
        command = [build / "tests" / f"{fault.test}_test", f"--gtest_filter={fault.cases}",
                   "--gtest_brief=1"]
        return run(command, log, timeout=300) == 0
    except subprocess.TimeoutExpired:
        return False


def place_of(fault):
    """The fault's text, however lines are broken: between words and signs any white space may
    stand."""
    return re.compile(r"\s*".join(
        re.escape(word) for word in re.findall(r"\w+|[^\w\s]", fault.old)))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="faults whose name holds this")
    parser.add_argument(
        "--folder", type=pathlib.Path,
        help="where to copy to and build; a second run finds it built [a temporary one]")
    parser.add_argument("--list", action="store_true",
                        help="name the faults and their tests, and check that each can be planted")
    asked = parser.parse_args()
    faults = [f for f in FAULTS if asked.only in f.name]
    for f in faults:
        if (n := len(place_of(f).findall((ROOT / f.file).read_text()))) != 1:
            sys.exit(f"plant: '{f.name}': the text is found {n} times in {f.file}, not once")
        if asked.list:
            print(f"{f.name}: {f.file}; {f.test}_test {f.cases}")
    if asked.list:
        return 0
    with tempfile.TemporaryDirectory() as temporary:
        source = asked.folder or pathlib.Path(temporary)
        copy_sources(source)
        green = []
        for f in faults:
            log, file = source / "plant.log", source / f.file
            sound = file.read_text()
            if not outcome(source, f, log):
                sys.exit(f"plant: {log}: {f.test}_test {f.cases} is red without '{f.name}'")
            file.write_text(place_of(f).sub(lambda _: f.new, sound))
            passed = outcome(source, f, log)
            file.write_text(sound)
            print(f"{'GREEN' if passed else 'red'}: {f.name}: {f.test}_test {f.cases}", flush=True)
            green += [f.name] * passed
        print(f"{len(faults) - len(green)} of {len(faults)} faults were noticed")
        return 1 if green else 0


if __name__ == "__main__":
    sys.exit(main())
