"""Every block of Python of every page runs, pasted in order into a fresh interpreter."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PASTE = """
import sys
blocks, names = sys.stdin.read().split("\\0"), {"__name__": "__main__"}
for i, block in enumerate(blocks):
    exec(compile(block, f"block {i + 1}", "exec"), names)
"""


def blocks_of(page):
    """The blocks of Python of a page, in order."""
    return re.findall(r"^```(?:python|py)\n(.*?)^```$", page.read_text(), re.M | re.S)


class Pages(unittest.TestCase):
    def paste(self, blocks):
        """Runs blocks where the pages' files are, and gives what Python said of an error."""
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(ROOT / "scenes", os.path.join(folder, "scenes"))
            done = subprocess.run([sys.executable, "-W", "error", "-c", PASTE], cwd=folder,
                                  input="\0".join(blocks), capture_output=True, text=True,
                                  check=False, timeout=250)
        return (done.stderr or f"status {done.returncode}") if done.returncode else ""

    def test_each_page(self):
        pages = [*sorted((ROOT / "docs").glob("*.md")), *sorted(ROOT.glob("*.md"))]
        count = 0
        for page in pages:
            blocks = blocks_of(page)
            count += len(blocks)
            with self.subTest(page.name):
                self.assertEqual(self.paste(blocks) if blocks else "", "")
        self.assertGreater(count, 6)

    def test_a_name_that_is_missing_is_told(self):
        self.assertRegex(self.paste(["a = 1", "b = a + c"]), 'File "block 2".*\n.*NameError')
        self.assertEqual(self.paste(["import os; os.kill(os.getpid(), 9)"]), "status -9")

    def test_recipes_and_scripts_named_are_there(self):
        text = (ROOT / "docs" / "python.md").read_text()
        for name in re.findall(r"\((\.\./python/recipes/\w+\.py)\)", text):
            self.assertTrue((ROOT / "docs" / name).exists(), name)


if __name__ == "__main__":
    unittest.main()
