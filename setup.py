"""Builds the Python module of CMakeLists.txt; pyproject.toml describes it."""
import pathlib
import re
import sys

import pybind11
from skbuild import setup

project = pathlib.Path(__file__).with_name("CMakeLists.txt").read_text()

setup(
    version=re.search(r"project\(grelha VERSION (\S+)", project)[1],
    packages=["grelha"],
    package_dir={"": "python"},
    package_data={"grelha": ["*.pyi", "py.typed"]},
    cmake_install_dir="python",
    cmake_args=["-DCMAKE_BUILD_TYPE=Release", "-DGRELHA_PYTHON=ON", "-DGRELHA_PYTHON_FOLDER=.",
                "-DGRELHA_TESTS=OFF", "-DGRELHA_PERF=OFF", "-DGRELHA_INSTALL=OFF", "-DGRELHA_C=OFF",
                "-DGRELHA_FRONTEND=AUTO", f"-DPython_EXECUTABLE={sys.executable}",
                f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"],
)
