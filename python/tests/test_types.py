"""The types that editors and mypy read are those of the module."""
import ast
import importlib
import inspect
import pathlib
import shutil
import subprocess
import unittest

HERE = pathlib.Path(__file__).resolve().parent.parent
STUBS = {"grelha": "__init__.pyi", "grelha.open3d": "open3d.pyi", "grelha.trimesh": "trimesh.pyi"}
ONE_AND_MANY = """
import grelha
import numpy as np
w = grelha.World(np.zeros((3, 3)), [[0, 1, 2]])
one: float = w.closest((0, 0, 1), (0, 0, -1)).t
many: int = w.closest(np.zeros((5, 3)), (0, 0, -1)).t.size
inside: bool = w.contains((0, 0, 0))
wrong: float = w.closest(np.zeros((5, 3)), (0, 0, -1)).t
"""


def functions(stub):
    """Class or None, name and arguments of each function of a stub, without private ones."""
    for thing in ast.parse((HERE / "grelha" / stub).read_text()).body:
        body, owner = ([thing], None) if isinstance(thing, ast.FunctionDef) else (
            getattr(thing, "body", []), getattr(thing, "name", None))
        for function in body:
            private = (owner or "").startswith("_") or getattr(function, "name", "_") == "_"
            if isinstance(function, ast.FunctionDef) and not private:
                yield owner, function



class Types(unittest.TestCase):
    def test_stubs_have_the_arguments_of_the_module(self):
        checked = 0
        for module, stub in STUBS.items():
            for owner, function in functions(stub):
                there = importlib.import_module(module)
                there = inspect.getattr_static(getattr(there, owner) if owner else there,
                                               function.name)
                there = getattr(there, "__func__", getattr(there, "fget", there))
                if function.name == "create_rays_pinhole":  # two ways to call it, by *args
                    continue
                names = list(inspect.signature(there).parameters)
                stated = [a.arg for a in (*function.args.args, *function.args.kwonlyargs)]
                if function.args.kwarg:
                    stated.append(function.args.kwarg.arg)
                setter = any(".setter" in ast.unparse(d) for d in function.decorator_list)
                if not setter:
                    self.assertEqual(sorted(stated), sorted(names), f"{module}: {function.name}")
                    checked += 1
        self.assertGreater(checked, 50)

    def test_every_public_name_has_a_stub(self):
        for module, stub in STUBS.items():
            stated = {(owner, function.name) for owner, function in functions(stub)}
            for name, thing in vars(importlib.import_module(module)).items():
                if name[0] != "_" and inspect.isclass(thing) and thing.__module__ == module:
                    for member, value in vars(thing).items():
                        if inspect.isfunction(value) and not member.startswith("_"):
                            self.assertIn((name, member), stated, module)

    @unittest.skipUnless(shutil.which("mypy"), "no mypy")
    def test_mypy_passes_the_recipes_and_tells_one_ray_from_many(self):
        def mypy(*arguments):
            return subprocess.run(["mypy", "--strict", "--cache-dir=/dev/null", *arguments],
                                  cwd=HERE, capture_output=True, text=True)

        done = mypy(*map(str, sorted(HERE.glob("recipes/*.py"))))
        self.assertEqual(done.returncode, 0, done.stdout)
        done = mypy("-c", ONE_AND_MANY)
        self.assertEqual([line.split(":")[1] for line in done.stdout.splitlines()
                          if ": error:" in line], ["8"], done.stdout)


if __name__ == "__main__":
    unittest.main()
