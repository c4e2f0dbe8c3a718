#!/usr/bin/env python3
"""Every file that docs and comments name is there, and every heading and test case of the pages.

    references.py ROOT            lists references to what is not there, as FILE:LINE
    references.py --self-test     of planted references, finds the wrong ones and no others

References are links of a page, [words](file#heading); paths that begin with a folder of the project
(kernel/grid.hpp, with * or <word> for any letters); bare names of sources (plan.cpp), in pages in
backticks; and in pages a `Suite.Case` of any test.
"""
import fnmatch
import pathlib
import re
import sys
import tempfile

FOLDERS = "include|kernel|frontend|c|scenes|tests|perf|examples|cmake|docs|python"
SOURCES = "hpp|cpp|py|sh|cmake"
COMMENT = {".hpp": "//", ".cpp": "//", ".h": "//", ".c": "//", ".py": "#", ".sh": "#",
           ".cmake": "#", "": "#", ".txt": "#"}
LEFT_OUT = {"tests/references.py", "CHANGELOG.md"}  # its own examples; what once was

LINK = re.compile(r"\]\(([^)#:\s]*)(?:#([^)\s]*))?\)")
HEADING = re.compile(r"^#+ (.*)", re.M)
NAME = re.compile(
    rf"(?<![\w/.<-])((?:{FOLDERS})/(?:[\w.-]+/)*[\w.*<>-]+\.(?:{SOURCES}|md|csv|txt|html))\b")
BARE = re.compile(rf"(?<![\w/.<*-])([\w*-]+\.(?:{SOURCES}))\b")
STRING = re.compile(r'"(?:\\.|[^"\\])*"')
CASE = re.compile(r"`([A-Z]\w+\.[A-Z]\w+)`")
DEFINED = re.compile(r"TEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\)")


def is_there(name, near, files):
    """Whether a file is meant: from the root, in the folder that names it, or of that bare name."""
    pattern = re.sub(r"<\w+>", "*", name)
    return "NAME" in name or fnmatch.filter(files, pattern) or fnmatch.filter(
        files, f"{near}/{pattern}") or "/" not in name and fnmatch.filter(files, f"*/{pattern}")


def headings_of(file):
    """As links name them."""
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
            for heading in HEADING.findall(file.read_text())}


def complaints(root):
    paths = [p for folder in FOLDERS.split("|") for p in (root / folder).rglob("*") if p.is_file()]
    files = [str(p.relative_to(root)) for p in (*paths, *root.iterdir())]
    cases = {".".join(case) for f in files if f.endswith("_test.cpp")
             for case in DEFINED.findall((root / f).read_text())}
    for file in sorted(set(files) - LEFT_OUT):
        page, mark = file.endswith(".md"), COMMENT.get(pathlib.Path(file).suffix)
        if not page and not mark or (root / file).is_dir():
            continue
        near = pathlib.Path(file).parent
        for number, line in enumerate((root / file).read_text(errors="replace").splitlines(), 1):
            code = STRING.sub("", line) + f" {mark}"
            said = line if page else re.split(rf"(?:^|\s){mark}", code, maxsplit=1)[1]
            bare = re.findall(r"`([^`]*)`", said) if page else [said]
            names = NAME.findall(said) + [n for text in bare for n in BARE.findall(text)]
            wrong = [f"no file {n}" for n in names if not is_there(n, near, files)]
            for target, heading in LINK.findall(said) if page else ():
                to = root / near / target if target else root / file
                if not to.exists():
                    wrong.append(f"no file {target}")
                elif heading and heading not in headings_of(to):
                    wrong.append(f"no heading {heading} in {to.relative_to(root)}")
            wrong += [f"no test {c}" for c in CASE.findall(said) if page and c not in cases]
            yield from (f"{file}:{number}: {w}" for w in wrong)


PLANTED = {  # a file and its text; wrong are those that hold "gone"
    "kernel/plan.cpp": "int a;  // see town.cmake\nu = \" // docs/gone.md\";\n// see gone.hpp\n"
                       "// docs/page.md, NAME.hpp, docs/gone.md\n",
    "kernel/town.cmake": "# of plan.cpp, not gone.cpp\n",
    "tests/plan_test.cpp": "TEST(Plan, HasGrids) {}\n",
    "docs/page.md": "[a](page.md#a-part), [b](gone.md), [c](#gone), [d](https://x/y.md) gone.cpp\n"
                    "`plan.cpp`, `gone.cpp`, kernel/*.cpp\nkernel/gone.hpp, `Plan.HasGrids`\n"
                    "`Plan.IsGone`\n\n# A part\n"}
WRONG = ["docs/page.md:1: no file gone.md", "docs/page.md:1: no heading gone in docs/page.md",
         "docs/page.md:2: no file gone.cpp", "docs/page.md:3: no file kernel/gone.hpp",
         "docs/page.md:4: no test Plan.IsGone", "kernel/plan.cpp:3: no file gone.hpp",
         "kernel/plan.cpp:4: no file docs/gone.md", "kernel/town.cmake:1: no file gone.cpp"]


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        for name, text in PLANTED.items():
            path = pathlib.Path(folder) / name
            path.parent.mkdir(exist_ok=True)
            path.write_text(text)
        found = list(complaints(pathlib.Path(folder)))
    return [f"planted, found otherwise: {line}" for line in sorted({*found} ^ {*WRONG})]


if __name__ == "__main__":
    FOUND = list(self_test() if sys.argv[1] == "--self-test" else
                 complaints(pathlib.Path(sys.argv[1])))
    print(*FOUND, sep="\n", end="\n" * bool(FOUND))
    sys.exit(bool(FOUND))
