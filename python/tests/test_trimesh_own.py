"""trimesh's own tests of rays and nearest points, after grelha.trimesh.install().

They run where trimesh and pytest are installed and TRIMESH_TESTS names the folder of its tests, or
that folder lies beside the package, as in a checkout. What fails without Grelha may fail with it.
"""
import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

FILES = ("test_ray", "test_proximity", "test_sample", "test_thickness", "test_voxel",
         "test_primitives", "test_section", "test_registration", "test_copy")
INSTALL = """
import grelha.trimesh
grelha.trimesh.install()
import trimesh
assert isinstance(trimesh.primitives.Box().ray, grelha.trimesh.RayMeshIntersector)
"""
RUN = """
import sys
import pytest
sys.exit(pytest.main(["-q", "-rfE", "-p", "no:cacheprovider", *sys.argv[1:]]))
"""


def tests_of_trimesh():
    """Their files, or why there are none."""
    spec = importlib.util.find_spec("trimesh")
    if spec is None or not importlib.util.find_spec("pytest"):
        return [], "trimesh and pytest are not both installed"
    beside = pathlib.Path(spec.origin).resolve().parent.parent / "tests"
    folder = pathlib.Path(os.environ.get("TRIMESH_TESTS", beside))
    files = [folder / f"{name}.py" for name in FILES]
    return [str(f) for f in files if f.is_file()], f"TRIMESH_TESTS: no tests of rays in {folder}"


def outcome(program, files):
    """How many tests passed, and the names of the others."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([sys.executable, "-c", program, *files], cwd=folder,
                              capture_output=True, text=True)
    passed = re.search(r"(\d+) passed", done.stdout)
    names = re.findall(r"^(?:FAILED|ERROR) \S*?(\w+\.py\S*)", done.stdout, re.M)
    return int(passed[1]) if passed else 0, set(names), done.stdout + done.stderr


class Own(unittest.TestCase):
    def test_no_other_test_fails_than_without(self):
        files, why = tests_of_trimesh()
        if not files:
            self.skipTest(why)
        passed, failed, told = outcome(INSTALL + RUN, files)
        _, failed_before, _ = outcome(RUN, files)
        self.assertGreater(passed, 0, told)
        self.assertEqual(failed - failed_before, set(), told)
        print(f"{passed} tests of trimesh pass, {len(failed)} fail with and without Grelha")


if __name__ == "__main__":
    unittest.main()
