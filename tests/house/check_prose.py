#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Check prose against the style of CONTRIBUTING.md: pages, comments, docstrings, and messages in .cpp files.

Usage: check_prose.py [FOLDER]

Each problem is a line of output; the exit code is 1 if there is any.
"""
import argparse
import io
import pathlib
import re
import subprocess
import sys
import textwrap
import tokenize

MOST_WORDS = 25  # of a sentence
LICENSE_LINE = "SPDX-License-Identifier: GPL-3.0-or-later"
GENERATED = ("docs/keys.md", "experiments/report/three/", "tests/fuzz/corpus/")
SUFFIXES = (".md", ".h", ".cpp", ".py", ".toml", ".cmake", "CMakeLists.txt", "Makefile")
MESSAGES, PROSE, TERSE, COMMENT, DOC = range(5)  # terse: headings and tables

BANNED = [  # pattern, replacement, kinds of text that may have it
    (r"whiskers?", "dangling curve", ()),
    (r"twins", "duplicate edges", (COMMENT, DOC)),  # half-edges have twins
    (r"mend(s|ed|ing)?", "repair", ()),
    (r"doors?", "public API", ()),
    (r"house", "structure", ()),
    (r"rooms|(a|the|each|every) room(?! (for|to|left|between))", "module", ()),
    (r"words? (?=`)", "pipeline", ()),
    (r"letters? (?=`)|(each|every|later) letters?", "stage", ()),
    (r"(those|that) of", "the NOUN of", ()),
]
BRITISH = [  # beginning, American beginning
    ("colour", "color"), ("centre", "center"), ("neighbour", "neighbor"), ("behaviour", "behavior"), ("favour", "favor"), ("grey", "gray"),
    ("licence", "license"), ("analys(?=e[ds]?\\b|ing)", "analyz"), ("labell", "label"), ("modell", "model"),
    ("millimetre", "millimeter"), ("metre", "meter"), ("artefact", "artifact"), ("defence", "defense"), ("programme(?=s?\\b)", "program"),
    *((f"{stem}s(?=[ei]\\w|ation)", f"{stem}z") for stem in "optimi minimi maximi normali organi recogni summari initiali generali parametri discreti".split()),
]
NOT_CODE = r"(?<![\w/.\-]){}(?![/(]|[._\-]\w)"  # no part of a path, a name or a call
RULES = [(re.compile(NOT_CODE.format(rf"(?:{p})(?!\w)"), re.I), f"expected '{new}'", but) for p, new, but in BANNED]
RULES += [(re.compile(NOT_CODE.format(rf"{old}\w*"), re.I), f"expected '{new}...', as in American English", ()) for old, new in BRITISH]
RULES += [(re.compile(r"(?<![\w.)\]])\.\d+(?![\w.])"), "expected a zero before the point", ())]
ENDS = re.compile(r"(?<!e\.g)(?<!i\.e)(?<!cf)(?<!Fig)(?<!al)[.!?][\"')\]*]*\s+(?=[A-Z`\"'(\[*0-9])")


def pages(text, first=1, kind=PROSE):
    """Return (line, text, kind) of the paragraphs of Markdown; leave out code and HTML comments."""
    blank = lambda m: "\n" * m[0].count("\n")
    text = re.sub(r"<!--.*?-->|\A---\n.*?^---$|^( *)```.*?^\1```$", blank, text, flags=re.S | re.M)
    parts, before = [], ""
    for number, line in enumerate(text.split("\n"), first):
        item = re.match(r"\s*([*+-]|\d+\.) ", line) or kind == DOC and re.match(r"\s*[a-z_]\w*(, \w+){0,3}: ", line)
        if line.startswith("    ") and not item and not before:
            continue  # code
        if line.strip():
            terse = re.match(r"\s*(#+ |\|)", line)
            if terse or item or not before or parts[-1][2] == TERSE:
                parts.append([number, "", TERSE if terse else kind])
            parts[-1][1] += re.sub(r"^\s*([*+>-]|\d+\.|#+) ", "", line) + "\n"
        before = line.strip()
    return parts


def cpp(text):
    """Yield the comments of C++, and its string literals that are messages."""
    token = re.compile(r'R"(\w*)\(.*?\)\1"|(?P<text>"(?:\\.|[^"\\\n])*")|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\'|(?P<comment>//[^\n]*|/\*.*?\*/)', re.S)
    found, end, line, at = [], 0, 1, 0
    for m in token.finditer(text):
        line, at = line + text.count("\n", at, m.start()), m.start()
        gap, end = text[end:at], m.end()
        kind, body, key, put, joins = None, "", None, "", False
        if m["comment"]:
            marker = re.match(r"//[/!]?<?|/\*+", m[0])[0]
            body = re.sub(r"^\s*\*(?!/) ?|\*/$", "", m[0][len(marker) :], flags=re.M)
            kind = DOC if re.match("//[/!]", marker) else COMMENT
            joins = not text[text.rfind("\n", 0, at) + 1 : at].strip()  # stands on a line of its own
            key, put, joins = (marker, joins), "\n", joins and gap.count("\n") == 1
        elif m["text"]:
            kind, body, key = MESSAGES, m["text"][1:-1].replace("\\n", "  ").replace('\\"', '"'), MESSAGES
            put, joins = "\n" * gap.count("\n"), True
        if joins and found and found[-1][3] == key and not gap.strip():
            found[-1][1] += put + body
        else:
            found.append([line, body, kind, key])
    for first, body, kind, _ in found:
        if kind in (COMMENT, DOC):
            yield from pages(textwrap.dedent(re.sub(r"^ ", "", body, flags=re.M)), first, kind)
        body = re.sub(r"\{[^{}]*\}", "…", body)  # values, which are no words
        if kind == MESSAGES and re.search(r"[A-Za-z]+ [a-z]+ [a-z]+", body) and not re.search(r"[=<>{}\\]|://", body):
            yield first, body, kind


def python(text):
    """Yield the comments and docstrings of Python."""
    comments, before = [], None
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            comments.append((token.start[0], token.line[: token.start[1]].strip() == "", token.string[1:]))
        if token.type == tokenize.STRING and before in (None, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT) and token.string.endswith('"""'):
            head, _, rest = token.string.lstrip("rf")[3:-3].partition("\n")
            yield from pages(head + "\n" + textwrap.dedent(rest), token.start[0], DOC)
        if token.type not in (tokenize.COMMENT, tokenize.NL):
            before = token.type
    yield from hashes(comments)


def hashes(comments):
    """Yield the paragraphs of comments behind #: (line, whether it stands alone, text)."""
    runs = []
    for line, alone, body in comments:
        if runs and alone and runs[-1][2] and runs[-1][0] + runs[-1][1].count("\n") + 1 == line:
            runs[-1][1] += "\n" + body
        else:
            runs.append([line, body, alone])
    for line, body, _ in runs:
        yield from pages(re.sub(r"^ ", "", body, flags=re.M), line, COMMENT)


def settings(text):
    """Yield the comments of TOML, CMake and Makefiles."""
    found = []
    for number, line in enumerate(text.split("\n"), 1):
        m = re.match(r"""((?:[^#"']|"[^"]*"|'[^']*'|(?<=\S)#)*?)(?:(?<=\s)|^)#(.*)""", line)
        if m:
            found.append((number, not m[1].strip(), m[2]))
    return hashes(found)


def problems(first, text, kind):
    """Yield (line, problem, its words) for a paragraph."""
    same_lines = lambda put: lambda m: put + "\n" * m[0].count("\n")
    text = re.sub(r"`[^`]*`", same_lines("`"), text)
    text = re.sub(r"\]\([^)]*\)|\]\[[^\]]*\]", same_lines("]"), text)
    text = re.sub(r"\w+://\S+|\[@[^\]]*\]", "", text)
    begin = 0
    for end in [m.end() for m in ENDS.finditer(text)] + [len(text)]:
        sentence = text[begin:end].rstrip()
        offset = len(sentence) - len(sentence.lstrip())
        line = lambda at: first + text.count("\n", 0, begin + at)
        words = [w for w in sentence.split() if re.search(r"\w", w)]
        shown = " ".join(words[:6]) + " ..."
        if kind != TERSE and len(words) > MOST_WORDS:
            yield line(offset), f"a sentence of {len(words)} words: expected at most {MOST_WORDS}", shown
        fronted = re.match(r"\W*(Of|What|Those)\b" if kind == DOC else r"\W*(Of)\b", sentence)
        if fronted and kind != TERSE and not sentence.endswith("?"):
            yield line(offset), f"begins with '{fronted[1]}': expected subject, verb, object", shown
        for pattern, problem, exempt in RULES:
            for m in pattern.finditer(sentence) if kind not in exempt else ():
                yield line(m.start()), problem, " ".join(sentence[max(0, m.start() - 15) : m.end() + 15].split())
        begin = end


def check(name, text):
    """Yield (line, message) for each problem of a file."""
    if name.endswith(".md"):
        parts = pages(text)
    elif name.endswith((".h", ".cpp")):
        parts = [p for p in cpp(text) if p[2] != MESSAGES or name.endswith(".cpp") and not name.startswith("tests/")]
    else:
        parts = python(text) if name.endswith(".py") else settings(text)
    for part in parts:
        for line, problem, words in problems(*part):
            yield line, f"{name}:{line}: {problem}: {words}"


def check_tree(root):
    """Yield the problems of the files that git does not ignore."""
    listed = ["git", "-C", root, "-c", "core.quotePath=false", "ls-files", "-co", "--exclude-standard"]
    for name in sorted(set(subprocess.run(listed, check=True, capture_output=True, text=True).stdout.splitlines())):
        if name.endswith(SUFFIXES) and not name.startswith(GENERATED) and (root / name).is_file():
            yield from (text for _, text in sorted(check(name, (root / name).read_text(errors="replace").replace(LICENSE_LINE, ""))))


def main():
    parser = argparse.ArgumentParser(description="Check prose against the style of CONTRIBUTING.md.")
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    given = parser.parse_args()
    try:
        wrong = list(check_tree(given.folder))
    except (OSError, subprocess.CalledProcessError):
        print(f"check_prose.py: prose not checked: {given.folder} is no folder of git")
        return 0
    print(*wrong, sep="\n", end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
