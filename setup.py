"""What pip builds the package `grelha` by: the Python module of CMakeLists.txt, see python/."""
import pathlib
import re
import sys

from skbuild import setup

project = pathlib.Path(__file__).with_name("CMakeLists.txt").read_text()

setup(
    name="grelha",
    version=re.search(r"project\(grelha VERSION (\S+)", project)[1],
    description="Rays through triangles and spheres, from numpy arrays",
    license="MIT",
    python_requires=">=3.9",
    install_requires=["numpy"],
    packages=["grelha"],
    package_dir={"": "python"},
    package_data={"grelha": ["*.pyi", "py.typed"]},
    cmake_install_dir="python",
    cmake_args=["-DCMAKE_BUILD_TYPE=Release", "-DGRELHA_PYTHON=ON", "-DGRELHA_PYTHON_FOLDER=.",
                "-DGRELHA_TESTS=OFF", "-DGRELHA_PERF=OFF", "-DGRELHA_INSTALL=OFF", "-DGRELHA_C=OFF",
                f"-DPython_EXECUTABLE={sys.executable}"],
)
