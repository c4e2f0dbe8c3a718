"""What pip builds: `grelha`, the Python module of CMakeLists.txt, see python/. With GRELHA_RAYS=1
in the environment `grelha-rays`: the same module without pictures and files, which needs no
library but those of the compiler."""
import os
import pathlib
import re
import sys

import pybind11
from skbuild import setup

project = pathlib.Path(__file__).with_name("CMakeLists.txt").read_text()
sdist = pathlib.Path(__file__).with_name("PKG-INFO")  # where pip builds of one, it says which
rays = (os.environ.get("GRELHA_RAYS", "0") == "1" or
        sdist.exists() and "Name: grelha-rays\n" in sdist.read_text())

setup(
    name="grelha-rays" if rays else "grelha",
    version=re.search(r"project\(grelha VERSION (\S+)", project)[1],
    description="Rays through triangles and spheres, from numpy arrays",
    license="MIT",
    python_requires=">=3.9",
    # pybind11 before 2.12 cannot read arrays of numpy 2
    install_requires=["numpy" if pybind11.version_info >= (2, 12) else "numpy<2"],
    packages=["grelha"],
    package_dir={"": "python"},
    package_data={"grelha": ["*.pyi", "py.typed"]},
    cmake_install_dir="python",
    cmake_args=["-DCMAKE_BUILD_TYPE=Release", "-DGRELHA_PYTHON=ON", "-DGRELHA_PYTHON_FOLDER=.",
                "-DGRELHA_TESTS=OFF", "-DGRELHA_PERF=OFF", "-DGRELHA_INSTALL=OFF", "-DGRELHA_C=OFF",
                f"-DGRELHA_FRONTEND={'OFF' if rays else 'ON'}",
                f"-DPython_EXECUTABLE={sys.executable}",
                f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"],
)
