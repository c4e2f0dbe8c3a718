#!/usr/bin/env python3
"""summary.py LOG: what ends a run of all tests, from ctest's log: the tests that failed, with what
they said last, and why others were skipped, with how many there are of each."""
import collections
import re
import sys

SAID = 12  # lines of a failed test
REASON = re.compile(r"skipped|SKIPPED|: Skipped$", re.I)


def tests(text):
    """Name, output and result of each."""
    for part in re.split(r"^\d+/\d+ Testing: ", text, flags=re.M)[1:]:
        name, _, rest = part.partition("\n")
        output = re.search(r"^Output:\n-+\n(.*?)^<end of output>", rest, re.S | re.M)
        result = re.search(r"^Test (Passed|Failed|Skipped|Not Run|Timeout)|^Test time = .*$", rest,
                           re.M)
        yield name, output.group(1) if output else "", result.group(0) if result else "no result"


def reason(output):
    """The line behind GoogleTest's "Skipped", or the one that says so itself."""
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    for line, following in zip(lines, lines[1:]):
        if line.endswith(": Skipped"):
            return following
    own = [line for line in lines if REASON.search(line) and not line.startswith("[")]
    return own[-1] if own else "no reason given"


def main():
    failed, skipped = [], collections.defaultdict(list)
    with open(sys.argv[1], errors="replace") as f:
        for name, output, result in tests(f.read()):
            if result == "Test Skipped":
                skipped[reason(output)].append(name)
            elif result != "Test Passed":
                failed.append((name, output))
    for why, names in skipped.items():
        print(f"skipped: {why}: {', '.join(names[:3])}" +
              (f" and {len(names) - 3} more" if len(names) > 3 else ""))
    for name, output in failed:
        print(f"FAILED: {name}")
        for line in output.rstrip().splitlines()[-SAID:]:
            print(f"    {line}")


if __name__ == "__main__":
    main()
