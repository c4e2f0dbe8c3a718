#!/usr/bin/env python3
"""Every file that docs and comments name is there; every symbol in a file is in that file's code.

    references.py ROOT            lists references to what is not there, as FILE:LINE
    references.py --self-test     of planted references, finds the wrong ones and no others

The following count as references:
  - a link of a page, [words](file), [words](file#heading), [words](#heading);
  - a path that begins with a folder of the project (kernel/grid.hpp), with * or <word> for any
    letters (NAME: none in particular); a bare name of a source (plan.cpp), in pages in backticks;
  - a symbol in a file: `symbol` in `file`, `symbol` of `file`, `one` and `other` (`file`), or a
    table's `symbol`, `file`; in comments the backticks may be left out where the symbol looks like
    one (two_words, TwoWords, kConstant);
  - a test and its case: `walk_test` Suite.Case, or tests/walk_test.cpp, Suite.Case, or
    `walk_test`: `Case`; in pages, a `Suite.Case` of any test;
  - a page's `two_words` or `Type::member`, which must be in the code somewhere.
"""
import pathlib
import re
import sys
import tempfile

FOLDERS = ("include", "kernel", "frontend", "c", "scenes", "tests", "perf", "examples", "cmake",
           "docs", "python")
SOURCES = ("hpp", "cpp", "py", "sh", "cmake")
COMMENT = {".hpp": "//", ".cpp": "//", ".h": "//", ".c": "//",
           ".py": "#", ".sh": "#", ".cmake": "#"}
# Of the system's kernel, of its C library, and of words
SYSTEM = {"clear_page_erms", "mmap_threshold", "trim_threshold", "snake_case"}
LEFT_OUT = {"tests/references.py", "CHANGELOG.md"}  # its own examples; what once was

NAME = r"[A-Za-z_][\w]*(?:::~?\w+)*"
FILE = r"(?:[\w.-]+/)*[\w.*<>-]+\.(?:hpp|cpp|py|sh|cmake|md|csv|txt)"
SYMBOLS = rf"`{NAME}(?:\(\))?`(?:(?:, and|,| and| or) `{NAME}(?:\(\))?`)*"
LOOKS_LIKE_CODE = r"(?:[A-Za-z]\w*_\w+|[A-Z][a-z]\w*[A-Z]\w*|k[A-Z]\w+)"
LINK = re.compile(r"\]\(([^)#:\s]*)(?:#([^)\s]*))?\)")
HEADING = re.compile(r"^#+ (.*)", re.M)
PATH = re.compile(
    rf"(?<![\w/.<-])(?:{'|'.join(FOLDERS)})/(?:[\w.-]+/)*"
    rf"[\w.*<>-]+\.(?:{'|'.join(SOURCES)}|md|csv|txt|html)\b")
BARE_IN_COMMENT = re.compile(rf"(?<![\w/.<*-])([\w*-]+\.(?:{'|'.join(SOURCES)}))\b")
BARE = re.compile(rf"`([\w*<>-]+\.(?:{'|'.join(SOURCES)}))`")
PLACED = re.compile(rf"({SYMBOLS})(?: in | of | \(|, )`({FILE})`")
PLACED_IN_COMMENT = re.compile(rf"\b({LOOKS_LIKE_CODE})(?:\(\))? (?:in|of) `?({FILE})`?")
CASE = re.compile(r"(?:`(\w+_test)`|tests/(?:\w+/)*(\w+_test)\.cpp,?) ([A-Z]\w+)\.([A-Z]\w+)")
CASE_ALONE = re.compile(r"`([A-Z]\w+)\.([A-Z]\w+)`")
PART_OF_TEST = re.compile(r"`(\w+_test)`: `(\w+)`")
ANYWHERE = re.compile(r"`([a-z]\w*_[a-z]+(?:\(\))?|[A-Z]\w+::\w+)`")


def mark_of(file):
    return "#" if file.name in ("CMakeLists.txt", "run") else COMMENT.get(file.suffix)


def split(line, mark):
    """Code and comment of a line; a mark within quotes begins no comment."""
    if mark:
        for match in re.finditer(rf"(?:^|(?<=\s)){mark}", line):
            if line.count('"', 0, match.start()) % 2 == 0:
                return line[:match.start()], line[match.end():]
    return line, ""


class Tree:
    def __init__(self, root):
        self.root = root
        self.files = sorted(
            p.relative_to(root)
            for folder in FOLDERS
            for p in (root / folder).rglob("*")
            if p.is_file())
        self.files += sorted(p.relative_to(root) for p in root.iterdir() if p.is_file())
        self.words = {}
        self.found = {}

    def find(self, name, near):
        if (name, near) not in self.found:
            self.found[name, near] = self.look_for(name, near)
        return self.found[name, near]

    def look_for(self, name, near):
        """Files a reference may mean: from the root, in the folder that names it, or anywhere."""
        pattern = re.compile(
            re.sub(r"\\\*|<\w+>", r"[^/]*",
                   re.escape(name).replace(r"\<", "<").replace(r"\>", ">")))
        whole = [f for f in self.files if f.name[-3:] == name[-3:] and pattern.fullmatch(str(f))]
        beside = [f for f in self.files if f.parent == near and pattern.fullmatch(f.name)]
        return whole or beside or [
            f for f in self.files if "/" not in name and pattern.fullmatch(f.name)
        ]

    def words_of(self, file):
        """Those of its code, without comments."""
        if file not in self.words:
            text = (self.root / file).read_text(errors="replace")
            code = (split(line, mark_of(file))[0] for line in text.splitlines())
            self.words[file] = {word for line in code for word in re.findall(r"\w+", line)}
        return self.words[file]

    def holds(self, file, symbol):
        parts = symbol.removesuffix("()").replace("~", "").split("::")
        return all(part in self.words_of(file) for part in parts)

    def headings_of(self, file):
        """As links name them."""
        return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
                for heading in HEADING.findall((self.root / file).read_text())}

    def anywhere(self, symbol):
        sources = [f for f in self.files if mark_of(f) and str(f) not in LEFT_OUT]
        return any(f.stem == symbol or self.holds(f, symbol) for f in sources)


def paragraphs(tree, file):
    """Line and text of each: of a page, or of comments on lines one after the other."""
    lines = (tree.root / file).read_text(errors="replace").splitlines()
    mark, start, found = mark_of(file), 0, []
    for number, line in enumerate([*lines, ""], 1):
        said = split(line, mark)[1].lstrip("/!<") if mark else line
        if said.strip():
            start = start or number
            found.append(said.strip())
        elif found:
            yield start, found
            start, found = 0, []


def complaints_of(tree, file):
    page = file.suffix == ".md"
    for start, lines in paragraphs(tree, file):
        text = " ".join(lines)
        ends = [sum(len(line) + 1 for line in lines[:i + 1]) for i in range(len(lines))]

        def at(match):
            return f"{file}:{start + sum(match.start() >= end for end in ends)}"

        for match in LINK.finditer(text) if page else ():
            target = file.parent / match[1] if match[1] else file
            if not (tree.root / target).exists():
                yield f"{at(match)}: no file {match[1]}"
            elif match[2] and match[2] not in tree.headings_of(target):
                yield f"{at(match)}: no heading {match[2]} in {target}"
        for match in (*PATH.finditer(text), *(BARE if page else BARE_IN_COMMENT).finditer(text)):
            name = match[match.lastindex or 0]
            if "NAME" not in name and not tree.find(name, file.parent):
                yield f"{at(match)}: no file {name}"
        placed = [(m, name, m[2])
                  for m in PLACED.finditer(text)
                  for name in re.findall(rf"`({NAME})", m[1])]
        placed += [(m, m[1], m[2]) for m in PLACED_IN_COMMENT.finditer(text)] if not page else []
        for match, symbol, name in placed:
            files = tree.find(name, file.parent)
            if files and not any(tree.holds(f, symbol) for f in files):
                yield f"{at(match)}: no {symbol} in {name}"
        for match in CASE.finditer(text):
            name = f"{match[1] or match[2]}.cpp"
            if not any(
                    tree.holds(f, match[3]) and tree.holds(f, match[4])
                    for f in tree.find(name, file.parent)):
                yield f"{at(match)}: no {match[3]}.{match[4]} in {name}"
        for match in PART_OF_TEST.finditer(text):
            if not any(tree.holds(f, match[2]) for f in tree.find(f"{match[1]}.cpp", file.parent)):
                yield f"{at(match)}: no {match[2]} in {match[1]}.cpp"
        for match in CASE_ALONE.finditer(text) if page else ():
            if not any(
                    tree.holds(f, match[1]) and tree.holds(f, match[2])
                    for f in tree.find("*_test.cpp", file.parent)):
                yield f"{at(match)}: no {match[1]}.{match[2]} in any test"
        for match in ANYWHERE.finditer(text) if page else ():
            if match[1] not in SYSTEM and not tree.anywhere(match[1]):
                yield f"{at(match)}: no {match[1]} anywhere"


def complaints(root):
    tree = Tree(root)
    for file in tree.files:
        if str(file) not in LEFT_OUT and (file.suffix == ".md" or mark_of(file)):
            yield from complaints_of(tree, file)


# File, its text, and what is wrong with it
PLANTED = [
    ("kernel/plan.cpp", """void add_grids();  // not pad
constexpr double kDensity = .7;  // add_crowds in crowds.cpp is elsewhere
void cells();  // kDensity in kernel/plan.cpp
auto url = "http://x";  // see docs/none.md, and tests/plan_test.cpp Plan.HasGrids
""", ["kernel/plan.cpp:2: no add_crowds in crowds.cpp", "kernel/plan.cpp:4: no file docs/none.md"]),
    ("kernel/crowds.cpp", """int other;  // see town.hpp, not NAME.hpp
// far_away of
// plan.cpp wraps over a line
""", ["kernel/crowds.cpp:1: no file town.hpp", "kernel/crowds.cpp:2: no far_away in plan.cpp"]),
    ("tests/plan_test.cpp", """TEST(Plan, HasGrids) {}
""", []),
    ("docs/page.md",
     """[a link](page.md#a-part), [one](none.md), [two](#no-part), [out](https://x/y.md). `plan.cpp` is,
`plans.cpp` is not, nor is kernel/gone.hpp; `kernel/*.cpp` are.

(`add_grids` in
`kernel/plan.cpp`), `add_grids` in `kernel/crowds.cpp`, `pad` of `plan.cpp`,
`cells` and `rows` (`kernel/plan.cpp`).

| where | `pad`, `kernel/plan.cpp` |
|---|---|
| `plan_test` Plan.HasGrids | `plan_test` Plan.HasNone |
| `Plan.HasGrids`, `plan_test`: `HasGrids` | `Plan.HasLess`, `plan_test`: `HasMore` |

`kDensity` is; `add_grids` is; `no_such` is not, nor `Plan::none`.

# A part
""", [
         "docs/page.md:1: no file none.md", "docs/page.md:1: no heading no-part in docs/page.md",
         "docs/page.md:2: no file kernel/gone.hpp",
         "docs/page.md:2: no file plans.cpp", "docs/page.md:5: no add_grids in kernel/crowds.cpp",
         "docs/page.md:5: no pad in plan.cpp", "docs/page.md:6: no rows in kernel/plan.cpp",
         "docs/page.md:8: no pad in kernel/plan.cpp",
         "docs/page.md:10: no Plan.HasNone in plan_test.cpp",
         "docs/page.md:11: no Plan.HasLess in any test",
         "docs/page.md:11: no HasMore in plan_test.cpp", "docs/page.md:13: no no_such anywhere",
         "docs/page.md:13: no Plan::none anywhere"
     ]),
]


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text, _ in PLANTED:
            (root / name).parent.mkdir(exist_ok=True)
            (root / name).write_text(text)
        found, expected = set(complaints(root)), {line for *_, lines in PLANTED for line in lines}
    for line in sorted(found ^ expected):
        print("planted, not found:" if line in expected else "found, not planted:", line)
    sys.exit(found != expected)


def main():
    if sys.argv[1:] == ["--self-test"]:
        self_test()
        return
    found = list(dict.fromkeys(complaints(pathlib.Path(sys.argv[1]))))
    for line in found:
        print(line)
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
