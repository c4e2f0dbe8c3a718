#!/usr/bin/env python3
"""make_site.py [FOLDER]: the site of all pages and of the references of C++, C and Python, in
FOLDER/html (build/docs/html). Pages are rendered as GitHub renders them, by cmark-gfm.

Fails on a link or an anchor that leads nowhere, on a page that the list leaves out, and on
anything that Doxygen warns of: every type and function of the library is documented. Ends with 77
without the tools.
"""
import ast
import html
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES = {  # users' pages first, by task
    "": ["README.md"],
    "Render": ["docs/usage.md", "docs/ply.md", "docs/nff.md", "docs/images.md",
               "docs/sampling.md", "docs/accuracy.md", "docs/parts.md"],
    "Trace rays": ["docs/python.md", "docs/python-reference.md", "docs/library.md",
                   "reference/index.html"],
    "Understand": ["docs/others.md", "docs/numerics.md", "docs/proofs.md", "docs/performance.md",
                   "docs/architecture.md", "docs/shapes.md", "docs/decisions.md",
                   "docs/glossary.md"],
    "Work on it": ["CONTRIBUTING.md", "CHANGELOG.md"],
}
MODULES = {  # of the Python reference: sources in order
    "grelha": ["_world.py", "_scene.py", "_results.py"],
    "grelha.open3d": ["open3d.py"],
    "grelha.trimesh": ["trimesh.py"],
}
FIRST_OF_REFERENCE = """# C++ and C

[The library](../docs/library.html) shows what to call for which task. Here is every

- [function of C](grelha_8h.html) (`grelha.h`),
- [function of C++](namespacegrelha.html) (`grelha/grelha.hpp`),
- [type](annotated.html), and [header](files.html).
"""
TOOLS = ("cmark-gfm", "doxygen")


def file_of(page):
    """Where a page of Markdown lies on the site."""
    return "index.html" if page == "README.md" else re.sub(r"\.md$", ".html", page)


def anchor(heading, taken):
    """The name that GitHub gives a heading."""
    words = html.unescape(re.sub("<[^>]*>", "", heading)).lower()
    name = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
    taken[name] = taken.get(name, -1) + 1
    return f"{name}-{taken[name]}" if taken[name] else name


def body_of(markdown):
    made = subprocess.run(["cmark-gfm", "-e", "table", "-e", "autolink", "--unsafe"],
                          input=markdown, capture_output=True, text=True, check=True).stdout
    taken = {}
    made = re.sub(r"<h(\d)>(.*?)</h\1>",
                  lambda h: f'<h{h[1]} id="{anchor(h[2], taken)}">{h[2]}</h{h[1]}>', made)
    made = re.sub(r"<table>(.*?)</table>", r'<div class="table"><table>\1</table></div>', made,
                  flags=re.S)
    # options are not broken at their hyphens
    made = re.sub(r"<code>([^<\n]*)</code>",
                  lambda c: "<code>" + re.sub(r"[^\s|,]{1,30}[|,]?", r"<span>\g<0></span>", c[1]) +
                  "</code>", made)
    return re.sub(r'(href="(?!\w+:)[^"#]*)\.md(["#])', r"\1.html\2", made).replace(
        "README.html", "index.html")


def title_of(page, texts):
    if page.startswith("reference/"):
        return "C++ and C reference"
    return re.search(r"^# (.*)", texts[page], re.M)[1]


def navigation(here, texts):
    up = os.path.relpath(".", os.path.dirname(file_of(here)) or ".")
    lines = []
    for group, pages in PAGES.items():
        lines += [f"<h2>{group}</h2>"] * bool(group) + ["<ul>"]
        for page in pages:
            current = ' aria-current="page"' * (page == here)
            lines.append(f'<li><a href="{up}/{file_of(page)}"{current}>'
                         f"{html.escape(title_of(page, texts))}</a></li>")
        lines.append("</ul>")
    return "\n".join(lines), up


def page_of(here, texts):
    links, up = navigation(here, texts)
    title = html.escape(title_of(here, texts))
    name = title if title == "Grelha" else f"{title} - Grelha"
    return f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{name}</title><link rel="stylesheet" href="{up}/site.css"></head><body>
<nav><details><summary>Grelha: all pages</summary>
{links}
</details></nav>
<script>if (innerWidth >= 960) document.querySelector("nav details").open = true;</script>
<main>
{body_of(texts[here])}</main></body></html>
"""


def signature(function):
    args = ast.unparse(function.args)
    return re.sub(r"^(self|cls)(, )?", "", args)


def documented(body):
    """Public classes and functions with a docstring, in order."""
    for thing in body:
        if isinstance(thing, (ast.ClassDef, ast.FunctionDef)) and not thing.name.startswith("_"):
            if ast.get_docstring(thing):
                yield thing


def prose_of(docstring):
    """Markdown of a docstring: arguments, aligned in two columns, become a list."""
    out = []
    for paragraph in docstring.split("\n\n"):
        lines = paragraph.splitlines()
        if lines[0].startswith("    "):
            out.append("```\n" + "\n".join(line[4:] for line in lines) + "\n```")
        elif re.match(r"[\w*]+(?:, [\w*]+)* {2,}\S", lines[0]):
            items = re.sub(r"(?m)^([\w*]+(?:, [\w*]+)*) +(?=\S)", r"- `\1`: ",
                           re.sub(r"\n {2,}", " ", paragraph))
            out.append(items)
        else:
            out.append(paragraph)
    return "\n\n".join(out)


def entry(heading, call, docstring):
    return [heading, f"```\n{call}\n```", prose_of(docstring)]


def class_text(thing, module):
    init = [f for f in thing.body if isinstance(f, ast.FunctionDef) and f.name == "__init__"]
    call = f"{module}.{thing.name}" + (f"({signature(init[0])})" if init else "")
    text = entry(f"### {thing.name}", call, ast.get_docstring(thing))
    for member in documented(thing.body):
        kinds = [ast.unparse(d) for d in member.decorator_list]
        if any(kind.endswith(".setter") for kind in kinds):
            continue
        call = member.name if "property" in kinds else f"{member.name}({signature(member)})"
        text += entry(f"#### {thing.name}.{member.name}", call, ast.get_docstring(member))
    return text


def python_reference():
    text = ["# Python reference", "What `help()` says, for all of the module. "
            "[Python](python.md) shows what to call for which task."]
    for module, sources in MODULES.items():
        text.append(f"## {module}")
        for source in sources:
            tree = ast.parse((ROOT / "python/grelha" / source).read_text())
            if not source.startswith("_"):
                text.append(prose_of(ast.get_docstring(tree)))
            for thing in documented(tree.body):
                if isinstance(thing, ast.ClassDef):
                    text += class_text(thing, module)
                else:
                    call = f"{module}.{thing.name}({signature(thing)})"
                    text += entry(f"### {thing.name}", call, ast.get_docstring(thing))
    return "\n\n".join(text) + "\n"


def make_reference(out):
    """Doxygen's pages; what it warns of."""
    settings = (ROOT / "docs/Doxyfile").read_text()
    first = out.parent / "first.md"
    first.write_text(FIRST_OF_REFERENCE)
    settings += (f'OUTPUT_DIRECTORY="{out}"\nWARN_LOGFILE="{out.parent}/warnings"\n'
                 f'INPUT += "{first}"\nUSE_MDFILE_AS_MAINPAGE="{first}"\n')
    subprocess.run(["doxygen", "-"], input=settings, text=True, cwd=ROOT, check=True)
    # members that share a line share its comment, which Doxygen does not see
    shared = re.compile(r"Member .* \(variable\) of .* is not documented")
    warnings = (out.parent / "warnings").read_text().splitlines()
    missing = [name for name in ("classgrelha_1_1World", "structgrelha_1_1Rays",
                                 "structgrelha__hits", "grelha_8h", "namespacegrelha")
               if not (out / f"reference/{name}.html").exists()]
    return [w for w in warnings if not shared.search(w)] + [
        f"no page {name}: a folder of headers is missing" for name in missing]


def dead_links(out):
    """Links of our pages, and the anchors in them, that lead nowhere."""
    ids = {}

    def ids_of(path):
        if path not in ids:
            ids[path] = set(re.findall(r'\b(?:id|name)="([^"]+)"', path.read_text()))
        return ids[path]

    for page in (*out.glob("*.html"), *out.glob("docs/*.html")):
        for link in re.findall(r'(?:href|src)="([^"]*)"', page.read_text()):
            if re.match(r"\w+:", link):
                continue
            file, _, name = html.unescape(link).partition("#")
            target = (page.parent / file).resolve() if file else page
            if not target.exists():
                yield f"{page.relative_to(out)} links to {link}, which is not there"
            elif name and name not in ids_of(target):
                yield f"{page.relative_to(out)}: {link} has no such heading"


def copy_files(out):
    """What pages link to, where they look for it."""
    for folder in ("docs/images", "examples", "python/recipes"):
        shutil.copytree(ROOT / folder, out / folder, dirs_exist_ok=True)
    for pattern in ("docs/*.csv", "docs/*.sh", "LICENSE", "CMakePresets.json"):
        for file in ROOT.glob(pattern):
            shutil.copy(file, out / file.relative_to(ROOT))
    shutil.copy(ROOT / "docs/site.css", out)


def main():
    missing = [tool for tool in TOOLS if not shutil.which(tool)]
    if missing:
        print(f"skipped: no {' and no '.join(missing)}")
        return 77
    out = pathlib.Path(sys.argv[1] if sys.argv[1:] else ROOT / "build/docs").resolve() / "html"
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    listed = [page for pages in PAGES.values() for page in pages]
    texts = {page: (ROOT / page).read_text() for page in listed if (ROOT / page).exists()}
    texts["docs/python-reference.md"] = python_reference()
    wrong = make_reference(out)
    copy_files(out)
    for page in texts:
        (out / file_of(page)).parent.mkdir(exist_ok=True)
        (out / file_of(page)).write_text(page_of(page, texts))
    wrong += [f"{page.relative_to(ROOT)} is not in the list of pages"
              for page in (*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"))
              if str(page.relative_to(ROOT)) not in listed]
    wrong += dead_links(out)
    for what in wrong:
        print(f"docs/make_site.py: {what}", file=sys.stderr)
    print(out / "index.html")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
