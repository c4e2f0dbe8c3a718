#!/usr/bin/env python3
"""No sentence of the pages and of the public headers' comments is longer than 30 words. No line
of a paragraph begins as an item of a list does, by a number and a full stop: a site makes it one.

    sentences.py ROOT [FILE...]   lists longer sentences as FILE:LINE; without FILE all of PAGES
    sentences.py --self-test      of planted sentences, finds the long ones and no others

A sentence ends at a full stop, a question or an exclamation mark, at a colon before a list or a
block, and with its paragraph, list item, table cell or heading. Code in backticks, a link and a
formula between spaces count as one word each. Blocks of code are left out.
"""
import pathlib
import re
import sys
import tempfile

MOST = 30
PAGES = ("README.md", "CONTRIBUTING.md", "docs/*.md", "include/grelha/*.hpp", "include/*.h")

END = re.compile(r"(?<=[.!?])[)\"'*_]*\s+")
# Full stops that end no sentence
ABBREVIATION = re.compile(r"\b(?:e\.g|i\.e|vs|ca|no|cf|pp|ch|Fig|et al|etc)\.(?=\s)")


def words_of(sentence):
    return [w for w in sentence.split() if re.search(r"\w", w)]


def plain(text):
    """Text without the marks of Markdown and Doxygen; code and links are one word each."""
    text = re.sub(r"<!--.*?-->", "", text)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", lambda m: m[1], text)
    text = re.sub(r"`[^`]*`", "Code", text)
    text = re.sub(r"[\\@](?:file|brief|p|c|ref)\b", "", text)
    return ABBREVIATION.sub(lambda m: m[0][:-1], text)


def blocks_of_page(lines):
    """(line, text) of each paragraph, list item, table cell and heading."""
    block, start, code = [], 0, False

    def end():
        nonlocal block
        done, block = block, []
        return [(start, " ".join(done))] if done else []

    for number, line in enumerate(lines, 1):
        words = line.strip()
        if words.startswith("```"):
            code = not code
            yield from end()
        elif code or not words or words.startswith("<!--"):
            yield from end()
        elif line.startswith("    ") and not block:
            continue  # a formula
        elif words.startswith("|"):
            yield from end()
            yield from ((number, cell) for cell in re.split(r"(?<!\\)\|", words) if cell.strip())
        elif re.match(r"#+ |[-*] |\d+\. ", words):
            yield from end()
            start, block = number, [re.sub(r"^(?:#+|[-*]|\d+\.) ", "", words)]
            if words.startswith("#"):
                yield from end()
        else:
            start = start if block else number
            block.append(words)
    yield from end()


def blocks_of_source(lines):
    """(line, text) of each comment: lines of `//` that follow each other, or one behind code."""
    page, first = [], 0
    for number, line in enumerate([*lines, ""], 1):
        alone = re.match(r"\s*///?<?( .*|$)", line)
        if alone:
            first = first if page else number
            page.append(alone[1][1:])
            continue
        yield from ((first + at - 1, text) for at, text in blocks_of_page(page))
        page = []
        behind = re.search(r"[;{,)}]\s*///?<? (.*)", line)
        if behind:
            page, first = [behind[1]], number


def long_sentences(file):
    lines = file.read_text().split("\n")
    blocks = blocks_of_page if file.suffix == ".md" else blocks_of_source
    for line, text in blocks(lines):
        for sentence in END.split(plain(text)):
            count = len(words_of(sentence))
            if count > MOST:
                yield line, count, " ".join(words_of(sentence)[:8])


def accidental_items(file):
    """Lines within a paragraph of a page that a site takes for an item."""
    before = ""
    for number, line in enumerate(file.read_text().split("\n"), 1):
        in_text = before and not re.match(r"[ |#<]|```|([-*]|\d+\.) ", before)
        if file.suffix == ".md" and in_text and re.match(r"\d+\. ", line):
            yield number
        before = line


def self_test():
    long = " ".join(["word"] * 31)
    page = (f"# Title\n\nShort one. {long}. {' '.join(['word'] * 30)}.\n\n"
            f"- {long}\n- `{long}` is code\n"
            f"\n```\n{long}\n```\n\n| {long} | short |\n")
    source = f"/// {long[:40]}\n/// {long[40:]}.\nint a;  ///< {long}\nint b;\n// Short.\n"
    with tempfile.TemporaryDirectory() as folder:
        for name, text, wanted in (("a.md", page, [3, 5, 12]), ("a.hpp", source, [1, 3])):
            file = pathlib.Path(folder) / name
            file.write_text(text)
            found = [line for line, *_ in long_sentences(file)]
            if found != wanted:
                sys.exit(f"{name}: expected long sentences in lines {wanted}, found {found}")
        file = pathlib.Path(folder) / "b.md"
        file.write_text("ends with\n129 or\n143. After any\n\n1. item\n2. item\n")
        if list(accidental_items(file)) != [3]:
            sys.exit("expected an item by accident in line 3")


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    root = pathlib.Path(sys.argv[1])
    files = [root / f for f in sys.argv[2:]] or [f for p in PAGES for f in sorted(root.glob(p))]
    found = 0
    for file in files:
        for line, count, start in long_sentences(file):
            print(f"{file.relative_to(root)}:{line}: {count} words: {start} ...")
            found += 1
        for line in accidental_items(file):
            print(f"{file.relative_to(root)}:{line}: a site makes an item of a list of this line")
            found += 1
    if found:
        sys.exit(f"{found} sentences of more than {MOST} words, or items by accident")
    print(f"{len(files)} files, no sentence of more than {MOST} words")


if __name__ == "__main__":
    main()
