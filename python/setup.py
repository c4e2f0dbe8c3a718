"""Builds the package by the project's CMakeLists.txt, which lies one folder up."""
import pathlib
import re
import sys

from skbuild import setup

here = pathlib.Path(__file__).resolve().parent
project = (here.parent / "CMakeLists.txt").read_text()

setup(
    name="grelha",
    version=re.search(r"project\(grelha VERSION (\S+)", project)[1],
    description="Rays through triangles and spheres, from numpy arrays",
    license="MIT",
    python_requires=">=3.9",
    install_requires=["numpy"],
    packages=["grelha"],
    package_data={"grelha": ["*.pyi", "py.typed"]},
    cmake_source_dir="..",
    cmake_args=["-DCMAKE_BUILD_TYPE=Release", "-DGRELHA_PYTHON=ON", "-DGRELHA_PYTHON_FOLDER=.",
                "-DGRELHA_TESTS=OFF", "-DGRELHA_PERF=OFF", "-DGRELHA_INSTALL=OFF", "-DGRELHA_C=OFF",
                f"-DPython_EXECUTABLE={sys.executable}"],
)
