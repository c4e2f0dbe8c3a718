#!/usr/bin/env python3
"""summary.py PRINTED LOG: what ends a run of all tests, from what ctest printed and its
LastTest.log: why tests were skipped, and those that failed with what they said last.

    summary.py --self-test
"""
import collections
import re
import sys

SAID = 12  # lines of a failed test
RESULT = re.compile(r"^\s*\d+/\d+ Test\s+#\d+: (.*?) \.*\*\*\*(\w[\w ]*?)\s", re.M)
TESTING = re.compile(
    r"^\d+/\d+ Testing: (.*)\n(?:.*\n)*?Output:\n-+\n((?:.*\n)*?)<end of output>", re.M)
WHY = re.compile(r"skipped|not looked at|no [\w/]+ here", re.I)
SAMPLE = """ 1/4 Test #1: one ....   Passed    0.01 sec
 2/4 Test #2: Isa/Two.Is/avx512  # GetParam() = avx512 ...***Skipped   0.01 sec
 3/4 Test #3: docs .....***Skipped   0.01 sec
 4/4 Test #4: four .....***Failed    0.02 sec
"""
SAMPLE_LOG = """1/4 Testing: one
1/4 Test: one
Output:
----------
fine
<end of output>
Test Passed.
2/4 Testing: Isa/Two.Is/avx512  # GetParam() = avx512
Output:
----------
[ RUN      ] Two
tests/two.cpp:1: Skipped
this processor has no avx512

[  SKIPPED ] Two
<end of output>
Test Passed.
3/4 Testing: docs
Output:
----------
skipped: no doxygen
<end of output>
4/4 Testing: four
Output:
----------
expected 1, found 2
<end of output>
Test Failed.
"""
SAMPLE_SAID = """skipped: this processor has no avx512: Isa/Two.Is/avx512
skipped: no doxygen: docs
FAILED: four
    expected 1, found 2"""


def reason(output):
    """The line behind GoogleTest's "Skipped", or the one that says so itself."""
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    for line, following in zip(lines, lines[1:]):
        if line.endswith(": Skipped"):
            return following
    own = [line for line in lines if WHY.search(line) and not line.startswith("[")]
    return own[-1].removeprefix("skipped: ") if own else "no reason given"


def summary(printed, log):
    said = dict(TESTING.findall(log))
    failed, skipped = [], collections.defaultdict(list)
    for name, result in RESULT.findall(printed):
        output = said.get(name, "")
        if result == "Skipped":
            skipped[reason(output)].append(name.partition("  # ")[0])
        else:
            failed += [f"FAILED: {name}"]
            failed += [f"    {line}" for line in output.rstrip().splitlines()[-SAID:]]
    for why, names in skipped.items():
        more = f" and {len(names) - 3} more" if len(names) > 3 else ""
        yield f"skipped: {why}: {', '.join(names[:3])}{more}"
    yield from failed


def main():
    if sys.argv[1] == "--self-test":
        found = "\n".join(summary(SAMPLE, SAMPLE_LOG))
        if found != SAMPLE_SAID:
            sys.exit(f"expected\n{SAMPLE_SAID}\nfound\n{found}")
        return
    texts = [open(path, errors="replace").read() for path in sys.argv[1:3]]
    print("\n".join(summary(*texts)))


if __name__ == "__main__":
    main()
