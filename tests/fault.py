"""What plant.py plants, and the test that notices it."""
from dataclasses import dataclass


@dataclass
class Fault:
    name: str
    file: str
    old: str
    new: str
    test: str           # the program, without _test
    cases: str          # --gtest_filter
    simd: bool = False  # wants copies of more than one width


def tolerance(name, file, constant, value, planted, test, cases):
    """A constant among the tolerances of a file of the kernel set to what breaks its promise."""
    return Fault(name, f"kernel/{file}", f"{constant} = {value};",
                 f"{constant} = {planted};", test, cases)
