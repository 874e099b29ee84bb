# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of check_prose.py: each rule finds a bad sentence and lets a good one pass."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))
import check_prose  # noqa: E402

LONG = "The mesher puts one vertex after another into the domain until each triangle is small enough for the size that the user gave at this place"


def found(name, text):
    return [problem for _, problem in check_prose.check(name, text)]


class Prose(unittest.TestCase):
    def finds(self, name, text, words, line=1):
        wrong = found(name, text)
        self.assertEqual(len(wrong), 1, wrong)
        self.assertTrue(wrong[0].startswith(f"{name}:{line}: "), wrong)
        self.assertIn(words, wrong[0])

    def passes(self, name, text):
        self.assertEqual(found(name, text), [])

    def test_long_sentences(self):
        self.assertEqual(len(LONG.split()), 26)
        self.finds("a.md", LONG + ".", "a sentence of 26 words")
        self.passes("a.md", LONG.replace("one vertex after another", "a further vertex") + ".")
        self.passes("a.md", LONG.replace(" until", ". It ends if") + ".")
        self.finds("a.md", "Short. " + LONG.replace(" until", "\nuntil") + ". Short.", "a sentence of 26 words")
        self.finds("a.md", LONG.replace("enough", "enough, e.g. `h`,") + ".", "a sentence of 27 words")

    def test_no_sentences(self):
        self.passes("a.md", f"# {LONG}\n\n| {LONG} |\n\n    {LONG}\n\n```sh\n{LONG}\n```\n\n<!-- {LONG} -->\n\nRun `{LONG}`.\n")
        self.passes("a.md", "\n".join(f"* {LONG[:70]}" for _ in range(3)))

    def test_fronted_of(self):
        self.finds("a.md", "All is well. Of a quad, it has the angles.", "begins with 'Of'")
        self.passes("a.md", "All is well. It has the angles of a quad.")

    def test_fragments(self):
        self.finds("a.h", "/// What it costs.\nint cost();", "begins with 'What'")
        self.finds("a.h", "int cost();  ///< Those in use.", "begins with 'Those'")
        self.finds("a.py", 'def cost():\n    """What it costs."""\n', "begins with 'What'", 2)
        self.passes("a.h", "/// Returns the cost.\nint cost();  // What does it cost?")
        self.passes("a.md", "What does it cost? It costs a second.")

    def test_banned_words(self):
        for bad, good in [("A whisker ends here.", "dangling curve"), ("It mends quads.", "repair"), ("The faces have twins.", "duplicate edges"),
                          ("It is the door.", "public API"), ("The house holds.", "structure"), ("The rooms below it.", "module"),
                          ("A room links others.", "module"), ("The word `DB` is fast.", "pipeline"), ("The letter `C` cleans.", "stage"),
                          ("The nodes are those of the face.", "the NOUN of")]:
            self.finds("a.md", bad, f"expected '{good}'")
        self.passes("a.md", "There is no room for an edge. A word of two letters names `mend` in tests/house/check_house.py, mend() and part_twins.")
        self.passes("a.h", "// The half-edges have twins.")
        self.passes("a.md", "A dangling curve, duplicate edges and a pipeline need repair.")

    def test_spelling(self):
        self.finds("a.md", "The colours differ.", "expected 'color...'")
        self.finds("a.md", "It optimises shapes.", "expected 'optimiz...'")
        self.finds("a.md", "It analyses shapes.", "expected 'analyz...'")
        self.passes("a.md", "The color of the neighbor is optimized in smoothing/optimisation/ by `centre`; the analysis is programmed.")

    def test_decimals(self):
        self.finds("a.md", "It is .25 long.", "expected a zero")
        self.finds("a.md", "| -.25 |", "expected a zero")
        self.passes("a.md", "It is 0.25 long, version 1.2.5, in a .3mf or .7z file, see part.5.")

    def test_comments(self):
        self.finds("a.h", "int a;\n/* One.\n * It mends. */\nint b;", "'repair'", 3)
        self.finds("a.cpp", "// It is good\n// and mends.\nint b;", "'repair'", 2)
        self.finds("a.cpp", "int a = 1'000'000;  // It mends.", "'repair'")
        self.finds("a.py", "a = '#'  # It mends.\n", "'repair'")
        self.finds("a.toml", 'a = "# b"  # It mends.\n', "'repair'")
        self.finds("CMakeLists.txt", "# It is good\n# and mends.\n", "'repair'", 2)
        self.passes("a.cpp", 'call("// mends");\nauto r = R"(// mends)"; mend();')
        self.passes("a.toml", 'mend = "whisker"\n')

    def test_messages(self):
        self.finds("a.cpp", 'throw InputError("the quad {} is "\n  "mended by hand");', "'repair'", 2)
        self.passes("a.cpp", 'throw InputError("the quad {} is repaired by hand");')
        self.passes("a.cpp", f'throw InputError("{LONG.replace("vertex", "{}")}");')
        self.passes("a.cpp", 'text = "<b>the quad is mended</b>"; key = "mended";')
        self.passes("tests/a.cpp", 'text = "the quad is mended by hand";')


class Tree(unittest.TestCase):
    def setUp(self):
        home = tempfile.TemporaryDirectory()
        self.addCleanup(home.cleanup)
        self.root = pathlib.Path(home.name)

    def put(self, name, text):
        (self.root / name).parent.mkdir(exist_ok=True)
        (self.root / name).write_text(text)

    def test_files_that_git_does_not_ignore(self):
        subprocess.run(["git", "-C", self.root, "init", "-q"], check=True)
        self.put(".gitignore", "build/\n")
        self.put("a.md", "It is good.\n\nIt mends.\n")
        subprocess.run(["git", "-C", self.root, "add", "."], check=True)
        for name in ("docs/keys.md", "build/b.md", "new file.md"):
            self.put(name, "It mends.\n")
        self.assertEqual(list(check_prose.check_tree(self.root)), ["a.md:3: expected 'repair': It mends.", "new file.md:1: expected 'repair': It mends."])

    def test_no_git(self):
        result = subprocess.run([sys.executable, check_prose.__file__, self.root], capture_output=True, text=True)
        self.assertEqual((result.returncode, result.stdout.count("\n")), (0, 1), result)
        self.assertIn("prose not checked", result.stdout)


if __name__ == "__main__":
    unittest.main()
