#!/usr/bin/env python3
"""Every source has the form that CONTRIBUTING.md asks for.

    form.py text ROOT        lines of at most 100 columns, one assignment a statement, files of at
                             most 700 lines
    form.py functions ROOT   functions of at most 60 lines and 15 branches; needs universal-ctags
    form.py format ROOT      what clang-format 14 makes of .clang-format
    form.py --self-test FOLDER   plants an offence against each rule there, and wants it found

Exits 77 where the tool is missing, and says how to get it.
"""
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

FOLDERS = ("include", "kernel", "frontend", "c", "scenes", "tests", "perf", "examples", "cmake",
           "docs", "python")
CPP = (".hpp", ".cpp", ".h", ".c")
SOURCES = (*CPP, ".py", ".pyi", ".sh", ".cmake", ".in")
NAMES = ("CMakeLists.txt", "run")
WIDTH, FILE_LINES, FUNCTION_LINES, BRANCHES = 100, 700, 60, 15
CLANG_FORMAT = "14"  # each version has its own taste

LINK = re.compile(r"https?://")
STRING = re.compile(r'"(?:\\.|[^"\\\n])*"')
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
# The content of a pair of brackets, after the pairs inside it are blanked
BRACES, BRACKETS = re.compile(r"\{[^{};]*\}"), re.compile(r"\([^(){};]*\)|\[[^\[\]{};]*\]")
PLACE = r"\*?\w[\w:]*(?:(?:->|\.)\w+|\(\s*\)|\[\s*\])*"
ASSIGNED = rf"{PLACE}\s*(?:[-+*/|&^]|<<|>>)?=(?!=)"
TWO_ASSIGNMENTS = re.compile(
    rf"(?<=[;{{}})])\s*(?:else\s+)?{ASSIGNED}(?:[^;{{}}()]|\(\s*\))*?,\s*{ASSIGNED}"
    r"(?=(?:[^;{}()]|\(\s*\))*[;{])")
BRANCH = re.compile(r"\b(?:if|for|while|case)\b|&&|\|\||\?")


def sources(root, suffixes=SOURCES):
    """Paths below the root, without those that fuzzers found."""
    files = [p for p in root.iterdir() if p.is_file()]
    for folder in FOLDERS:
        files += [p for p in (root / folder).rglob("*") if p.is_file()]
    wanted = [p.relative_to(root) for p in files
              if p.suffix in suffixes or (suffixes == SOURCES and p.name in NAMES)]
    return sorted(p for p in wanted if "corpus" not in p.parts)


def code_of(text):
    """The text without comments and what strings hold; its lines stay where they are."""
    text = STRING.sub('""', text)
    return COMMENT.sub(lambda match: "\n" * match[0].count("\n"), text)


def blank(match):
    """The pair alone; lines stay where they are."""
    inner = "\n" * match[0].count("\n")
    return "(" + inner + ")" if match[0][0] == "{" else match[0][0] + inner + match[0][-1]


def double_assignments(text):
    """Lines where a statement begins that assigns twice."""
    before, text = "", code_of(text)
    while before != text:
        before, text = text, BRACKETS.sub(blank, BRACES.sub(blank, text))
    for match in TWO_ASSIGNMENTS.finditer(text):
        yield 1 + text.count("\n", 0, match.end()) - match[0].lstrip().count("\n")


def text_offences(root):
    for file in sources(root):
        text = (root / file).read_text(errors="replace")
        lines = text.splitlines()
        if len(lines) > FILE_LINES:
            yield f"{file}: {len(lines)} lines, at most {FILE_LINES}"
        for number, line in enumerate(lines, 1):
            if len(line) > WIDTH and not LINK.search(line):
                yield f"{file}:{number}: {len(line)} columns, at most {WIDTH}"
        for number in double_assignments(text) if file.suffix in CPP else ():
            yield f"{file}:{number}: two assignments in one statement"


def function_offences(root):
    files = sources(root, CPP)
    command = ["ctags", "--languages=C++", "--langmap=C++:+.hpp.h.c", "--kinds-C++=f",
               "--fields=+ne", "--output-format=json", "-f", "-", "-L", "-"]
    tags = subprocess.run(command, cwd=root, input="\n".join(map(str, files)), check=True,
                          capture_output=True, text=True).stdout
    code = {str(f): code_of((root / f).read_text(errors="replace")).splitlines() for f in files}
    for tag in map(json.loads, tags.splitlines()):
        if "end" not in tag:
            continue
        file, begin, end = tag["path"], tag["line"], tag["end"]
        where = f"{file}:{begin}: {tag['name']}"
        if (length := end - begin + 1) > FUNCTION_LINES:
            yield f"{where} has {length} lines, at most {FUNCTION_LINES}"
        branches = len(BRANCH.findall("\n".join(code[file][begin - 1:end])))
        if branches > BRANCHES:
            yield f"{where} has {branches} branches, at most {BRANCHES}"


def clang_format():
    """The program of the version that formatted these sources, or None."""
    for name in filter(shutil.which, (f"clang-format-{CLANG_FORMAT}", "clang-format")):
        said = subprocess.run([name, "--version"], capture_output=True, text=True).stdout
        if f"version {CLANG_FORMAT}." in said:
            return name
    return None


def format_offences(root):
    def said(files):
        return subprocess.run([clang_format(), "--dry-run", "-Werror", *files], cwd=root,
                              capture_output=True, text=True).stderr

    files = sources(root, CPP)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        text = "\n".join(pool.map(said, (files[i:i + 16] for i in range(0, len(files), 16))))
    found = re.findall(r"^(.+?):(\d+:\d+): error:", text, re.M)
    for file, place in dict(reversed(found)).items():  # the first of each
        yield f"{file}:{place}: not as .clang-format says: `./run format` mends it"


RULES = {"text": text_offences, "functions": function_offences, "format": format_offences}


def missing(kind):
    if kind == "format" and not clang_format():
        return f"clang-format {CLANG_FORMAT} (`./run format` installs and runs it)"
    if kind == "functions" and not shutil.which("ctags"):
        return "universal-ctags (apt-get install universal-ctags)"
    return None


LONG_FUNCTION = "void longer() {\n" + "  f();\n" * FUNCTION_LINES + "}\n"
BRANCHED = "bool branched(int x) {\n  return " + " || ".join(["x"] * (BRANCHES + 2)) + ";\n}\n"
# File, its text, and how the complaint about it begins in each kind; all else is sound.
PLANTED = [
    ("kernel/wide.hpp", "// " + "x" * WIDTH + "\n", {"text": "kernel/wide.hpp:1: 103 columns"}),
    ("run", "echo " + "x" * WIDTH + "\n", {"text": "run:1: 105 columns"}),
    ("docs/link.py", "# https://" + "x" * WIDTH + "\n", {}),
    ("docs/page.md", "x" * (WIDTH + 1) + "\n", {}),
    ("tests/long.py", "\n" * (FILE_LINES + 1), {"text": "tests/long.py: 701 lines"}),
    ("tests/full.py", "\n" * FILE_LINES, {}),
    ("kernel/comma.cpp", """int a = 0, b = 1;  // one declaration; a = 1, b = 2;
enum E { kA = 1, kB = 2 };
void f(C c, int* x) {
  for (a = 0, b = 1; a < b; a += 1, b += 1) c = {.a = 1, .b = 2};
  c.a(1) = {1, 2}, x[a + 1] += 2;
}
""", {"text": "kernel/comma.cpp:5: two assignments"}),
    ("kernel/long.cpp", LONG_FUNCTION + LONG_FUNCTION.replace("  f();\n", "", 2),
     {"functions": "kernel/long.cpp:1: longer has 62 lines"}),
    ("kernel/branched.cpp", BRANCHED + BRANCHED.replace("x || ", "", 1),
     {"functions": "kernel/branched.cpp:1: branched has 16 branches"}),
    ("kernel/format.cpp", "int  a;\n", {"format": "kernel/format.cpp:1:4"}),
]


def self_test(root):
    shutil.rmtree(root, ignore_errors=True)
    for name, text, _ in PLANTED:
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    (root / ".clang-format").write_text("BasedOnStyle: Google\nColumnLimit: 100\n")
    wrong = []
    for kind in RULES:
        if missing(kind):
            print(f"not tried: {kind}, for want of {missing(kind)}")
            continue
        found = list(RULES[kind](root))
        wanted = [begins[kind] for *_, begins in PLANTED if kind in begins]
        wrong += [f"planted, not found: {w}" for w in wanted
                  if not any(f.startswith(w) for f in found)]
        wrong += [f"found, not planted: {f}" for f in found
                  if not any(f.startswith(w) for w in wanted)]
    for line in wrong:
        print(line)
    return bool(wrong)


def main():
    kind, root = sys.argv[1], pathlib.Path(sys.argv[2])
    if kind == "--self-test":
        return self_test(root)
    if tool := missing(kind):
        print(f"skipped: there is no {tool}")
        return 77
    found = list(RULES[kind](root))
    for line in found:
        print(line)
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
