"""Builds the hot loops of a tree as a shared library, for ab_host to load."""
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
# Those of kernel/CMakeLists.txt, and what Linux says of processors that have them
ISAS = {
    "scalar": ([], []),
    "sse2": (["-msse2"], ["sse2"]),
    "avx2": (["-mavx2"], ["avx2"]),
    "avx512": (["-mavx512f", "-mavx512bw", "-mavx512dq", "-mavx512vl", "-mavx512cd", "-mavx2",
                "-mprefer-vector-width=512"],
               ["avx512f", "avx512bw", "avx512dq", "avx512vl", "avx512cd", "avx2", "bmi2"]),
}
# Those of a release; hidden, as the library is, so that neither copy takes a function of the other.
FLAGS = ["-std=c++20", "-O3", "-DNDEBUG", "-g1", "-w", "-fopenmp", "-fPIC", "-ffp-contract=off",
         "-fno-tree-slp-vectorize", "-fvisibility=hidden", "-fvisibility-inlines-hidden"]
# Rooms of the kernel that queries do without; see kernel/CMakeLists.txt.
PICTURES = ("shade", "picture", "isa")
# Functions of templates of the standard library would else be shared by both copies.
EXPORTED = "{ global: ab_*; local: *; };\n"


def runs(isa):
    """Whether this processor has the instruction set."""
    for line in open("/proc/cpuinfo"):
        if line.startswith("flags"):
            return set(ISAS[isa][1]) <= set(line.split())
    return not ISAS[isa][1]


def compiler(build):
    """The words that call the one that CMake chose for a build folder, and where xsimd lies."""
    cache = dict(re.findall(r"^(\w+):\w+=(.*)$", (build / "CMakeCache.txt").read_text(), re.M))
    xsimd = cache.get("XSIMD_INCLUDE_DIR", "/usr/include")
    launcher = cache.get("CMAKE_CXX_COMPILER_LAUNCHER")
    return ([launcher] if launcher else []) + [cache["CMAKE_CXX_COMPILER"]], \
        [] if xsimd == "/usr/include" else ["-isystem", xsimd]


def newest(*folders):
    return max(p.stat().st_mtime for f in folders for p in f.rglob("*"))  # a folder's: files went


class Copy:
    """The library of one tree: its steps, for which there may be turns with another's."""

    def __init__(self, tree, folder, isa, build):
        self.tree, self.folder, self.isa = tree, folder, isa
        self.shared_object = folder / "kernel.so"
        self.compiler, self.flags = compiler(build)
        self.flags = [f"-I{tree}/include", f"-I{tree}", *FLAGS, *self.flags]
        self.told = f"{tree} {isa} {' '.join(self.compiler + self.flags)}\n"

    def fresh(self):
        how = self.folder / "how"
        return (self.shared_object.exists() and how.exists() and how.read_text() == self.told and
                self.shared_object.stat().st_mtime >
                newest(self.tree / "kernel", self.tree / "include", HERE))

    def prepare(self):
        """Writes what is compiled in one piece: all that is not a hot loop."""
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        kernel = self.tree / "kernel"
        rooms = sorted(p for p in kernel.rglob("*.cpp")
                       if p.relative_to(kernel).parts[0] not in PICTURES)
        (self.folder / "rest.cpp").write_text("".join(f'#include "{p}"\n' for p in rooms))
        (self.folder / "exported.map").write_text(EXPORTED)

    def objects(self):
        """Sources, and options of their own."""
        known = [f"-DGRELHA_{self.isa.upper()}"]
        hot = [*ISAS[self.isa][0], f"-DGRELHA_ISA={self.isa}"]
        yield HERE / "hot_loops.cpp", hot
        yield self.folder / "rest.cpp", known
        yield HERE / "plugin.cpp", []
        if self.isa != "scalar":
            yield HERE / "no_loops.cpp", []

    def compile(self, source, options):
        self.call([*self.compiler, *self.flags, *options, "-c", source, "-o",
                   self.folder / f"{source.stem}.o"])

    def link(self):
        self.call([self.compiler[-1], "-shared", "-fopenmp", "-Wl,-Bsymbolic", "-Wl,-z,defs",
                   f"-Wl,--version-script={self.folder}/exported.map", "-o", self.shared_object,
                   *sorted(self.folder.glob("*.o"))])
        (self.folder / "how").write_text(self.told)

    def call(self, words):
        done = subprocess.run(list(map(str, words)), stderr=subprocess.PIPE, text=True)
        if done.returncode:
            raise RuntimeError(f"{self.tree} does not compile:\n{done.stderr}")


def build_copies(trees, folder, isa, build):
    """The libraries of two trees, in turns on all cores; of one tree twice, one and its double."""
    names = ("other", "this") if trees[0] != trees[1] else ("this",)
    copies = [Copy(tree, folder / f"{name}-{isa}", isa, build)
              for name, tree in zip(names, trees[-len(names):])]
    stale = [c for c in copies if not c.fresh()]
    if stale:
        print(f"building {' and '.join(str(c.tree) for c in stale)}, {isa}", file=sys.stderr)
    for c in stale:
        c.prepare()
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        jobs = [pool.submit(c.compile, *o) for c in stale for o in c.objects()]
        try:
            for job in jobs:
                job.result()
        except RuntimeError as error:
            pool.shutdown(cancel_futures=True)
            sys.exit(str(error))
    for c in stale:
        c.link()
    if len(copies) == 2:
        return [c.shared_object for c in copies]
    double = copies[0].shared_object.with_name("double.so")  # by one name it would be loaded once
    shutil.copy(copies[0].shared_object, double)
    return [double, copies[0].shared_object]
