"""trimesh's own tests of rays and nearest points, after grelha.trimesh.install().

They run where trimesh is installed and TRIMESH_TESTS names the folder of its tests, or that folder
lies beside the package, as in a checkout.
"""
import importlib.util
import os
import pathlib
import subprocess
import sys
import unittest

FILES = "test_ray", "test_proximity", "test_sample", "test_primitives"
RUN = """
import sys, unittest
import grelha.trimesh
grelha.trimesh.install()
import trimesh
assert isinstance(trimesh.primitives.Box().ray, grelha.trimesh.RayMeshIntersector)
sys.path.insert(0, sys.argv.pop(1))
unittest.main(module=None)
"""
PYTEST = RUN.replace("unittest.main(module=None)", """import pytest
sys.exit(pytest.main(["-q", *sys.argv[1:]]))""")


def tests_of_trimesh():
    """The folder, or why there is none."""
    spec = importlib.util.find_spec("trimesh")
    if spec is None:
        return None, "trimesh is not installed"
    beside = pathlib.Path(spec.origin).resolve().parent.parent / "tests"
    folder = pathlib.Path(os.environ.get("TRIMESH_TESTS", beside))
    if not (folder / "generic.py").is_file():
        return None, f"TRIMESH_TESTS: no tests of trimesh in {folder}"
    return folder, ""


class Own(unittest.TestCase):
    def test_own_tests_pass(self):
        folder, why = tests_of_trimesh()
        if folder is None:
            self.skipTest(why)
        files = [name for name in FILES if (folder / f"{name}.py").is_file()]
        self.assertTrue(files)
        if importlib.util.find_spec("pytest"):  # newer ones are functions
            run, names = PYTEST, [str(folder / f"{name}.py") for name in files]
        else:
            run, names = RUN, files
        done = subprocess.run([sys.executable, "-c", run, str(folder), *names], cwd=folder,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout[-4000:] + done.stderr[-4000:])
        print(done.stdout[-200:] + done.stderr[-200:])


if __name__ == "__main__":
    unittest.main()
