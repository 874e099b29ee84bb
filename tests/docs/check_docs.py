#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks README and docs: links lead somewhere, messages exist, the reference of keys is up to date, and every block of code runs.
The site's tables lead to records, and tables of measurements are what `make doc-tables` writes.

Usage: check_docs.py links|messages|list|keys|blocks|tables|measured [--build FOLDER] [--slow] [PAGE ...]

`list` prints all messages of the sources with their places and ids.

A block is fenced, or indented by four spaces and more. The blocks of a page run in their order, in one empty folder that looks like the
repository: shell by bash, Python in one process, C++ as one program. TOML is checked against `delquad schema`. It is saved if its first
line is a comment that begins with the name of a file. A comment before a block, which readers do not see, says what is different:

    <!-- not run: why -->       it cannot be run in a test
    <!-- slow: why -->          it is run with --slow alone
    <!-- needs: ccx gmsh -->    it is run where these programs, or modules of Python, are
    <!-- before: x = 1 -->      what comes first, not shown
    <!-- output: of ... -->     it is part of the output of the block before; "..." stands for any text, numbers may differ
"""
import argparse
import concurrent.futures
import contextlib
import importlib.util
import io
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import textwrap
import tomllib
import traceback

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tests/support"))
import needs  # noqa: E402

NOT_OURS = {"build", "results", "data", ".git"}
SHELL = re.compile(r"(export|cat|mkdir|make|cmake|git|pip|cp|cd|ccx|rsvg-convert|awk|(\S*/)?(delquad|python3|own_strategy)) ")
MARK = re.compile(r"<!-- (not run|slow|needs|before|output): (.*?) -->", re.DOTALL)
SECONDS, SLOW_SECONDS = 300, 7200  # by the clock, on a busy machine
MANY_SECONDS = 3  # of CPU, worth telling


def files(*suffixes):
    for folder, folders, names in os.walk(ROOT):
        folders[:] = sorted(set(folders) - NOT_OURS)
        yield from (pathlib.Path(folder) / name for name in sorted(names) if name.endswith(suffixes))


# Links


def anchors(page):
    """As GitHub makes them of headings."""
    found = {}
    for heading in re.findall(r"^#+ (.*)", re.sub(r"^```.*?^```", "", page.read_text(), flags=re.DOTALL | re.MULTILINE), re.MULTILINE):
        text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
        name = re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
        found[name] = found.get(name, -1) + 1
    return {name if k == 0 else f"{name}-{k}" for name, count in found.items() for k in range(count + 1)}


def check_links():
    wrong, count = [], 0
    for page in files(".md"):
        text = page.read_text()
        for link in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`\n]*`", "", text)):
            if re.match(r"[a-z]+:", link):
                continue
            count += 1
            path, _, anchor = link.partition("#")
            target = (page.parent / path).resolve() if path else page
            if not target.exists():
                wrong.append(f"{page.relative_to(ROOT)}: {link}: there is no such file")
            elif anchor and anchor not in anchors(target):
                wrong.append(f"{page.relative_to(ROOT)}: {link}: there is no such heading")
    for source in files(".h", ".cpp", ".py", ".toml", ".md", "Makefile"):
        for name in re.findall(r"\bdocs/\w+\.md\b", source.read_text(errors="replace")):
            if not (ROOT / name).exists():
                wrong.append(f"{source.relative_to(ROOT)}: {name}: there is no such page")
    print(f"{count} links")
    return wrong


LITERAL = r'"(?:\\.|[^"\\\n])*"'
IDS = re.compile(r'\[([a-z]+(?:-[a-z]+)+)\](?=(?:\\n)?")')  # at the end of a literal
MAKER = r'(?:\b(?:throw \w*Error|refuse|fail|cannot_write|Warning \w+|warn\w*)\(|warnings\.\w+\(|fmt::print\(stderr)'
MOST_IDS = 90


def message_sources():
    for path in files(".h", ".cpp", ".py"):
        if path.relative_to(ROOT).parts[0] not in ("tests", "docs"):
            yield path, path.read_text(errors="replace")


def list_messages():
    """Print the place, the ids and the text of each message in the sources, as a table."""
    statement = re.compile(rf'{MAKER}(?:{LITERAL}|[^";])*;|(?:{LITERAL}\s*)*"[^"\n]*{IDS.pattern}.*?"')
    for path, text in message_sources():
        for m in statement.finditer(text):
            said = "".join(one[1:-1] for one in re.findall(LITERAL, m[0]))
            ids = IDS.findall(m[0])
            if ids or re.search(r"[a-z]+ [a-z]+", said):
                print(f"{path.relative_to(ROOT)}:{text.count(chr(10), 0, m.start()) + 1}", " ".join(ids) or "-", said, sep="\t")


def check_messages():
    """The sections of the page of troubleshooting have the ids that messages end with. Each quoted message stands in a source with the id of its
    section; "..." stands for names and numbers."""
    sources = [(re.sub(r'"\s*"', "", text).replace('\\"', '"'), set(IDS.findall(text))) for _, text in message_sources()]
    known = set()
    for section in re.split(r"^### ", (ROOT / "docs/troubleshooting.md").read_text(), flags=re.MULTILINE)[1:]:
        title = section.partition("\n")[0]
        id_ = title.lower().replace(" ", "-")
        quoted = [message for line in re.findall(r"^`.*`$", section, re.MULTILINE) for message in re.findall(r"`([^`]+)`", line)]
        known |= {id_} if quoted else set()
        for message in quoted:
            parts = [part.strip() for part in message.split("...")]
            if not any(id_ in ids and all(part in text for part in parts) for text, ids in sources):
                yield f"docs/troubleshooting.md: {message}: no source has this message and the id [{id_}]"
    for id_ in sorted(set().union(*(ids for _, ids in sources)) - known):
        yield f"docs/troubleshooting.md: no section for the id [{id_}]"
    if len(known) > MOST_IDS:
        yield f"docs/troubleshooting.md: {len(known)} ids: expected at most {MOST_IDS}"


def check_keys(build):
    made = subprocess.run([sys.executable, ROOT / "docs/site/make_keys.py", build / "delquad"], check=True, capture_output=True, text=True).stdout
    return [] if made == (ROOT / "docs/keys.md").read_text() else ["docs/keys.md: is not what `docs/site/make_keys.py build/release/delquad` writes"]


# Blocks


class Block:
    def __init__(self, page, line, language, text, marks):
        self.where = f"{page.relative_to(ROOT)}:{line}"
        self.text = textwrap.dedent(text)
        self.marks = dict(MARK.findall(marks))
        first = next((one for one in self.text.splitlines() if one.strip() and not one.startswith("#")), "")
        self.language = language or ("sh" if SHELL.match(first) else "python" if first.startswith("import ") else "toml")

    def why_not(self, slow):
        """Why it is not run."""
        if "not run" in self.marks:
            return "not run: " + self.marks["not run"]
        if "slow" in self.marks and not slow:
            return "slow: " + self.marks["slow"]
        for need in self.marks.get("needs", "").split():
            is_imported = re.search(rf"^import .*\b{need}\b", self.text, re.MULTILINE)
            if importlib.util.find_spec(need) is None and (is_imported or shutil.which(need) is None):
                return f"needs {need}"
        return None


def blocks(page):
    pattern = re.compile(r"(?P<marks>(?:^ *<!--.*?-->\n\n?)*)(?:^(?P<in>[ ]*)```(?P<language>\w+)\n(?P<fenced>.*?)^(?P=in)```$"
                         r"|(?:(?<=\n\n)|(?<=-->\n)|\A)(?P<indented>(?: {4,}\S.*\n(?:\n+(?= {4,}\S))?)+))", re.DOTALL | re.MULTILINE)
    pattern = re.compile(pattern.pattern.replace(r"\S.*\n", r"\S[^\n]*\n"), re.DOTALL | re.MULTILINE)
    text = page.read_text()
    for m in pattern.finditer(text):
        code = m["fenced"] if m["language"] else m["indented"]
        line = text.count("\n", 0, m.start("fenced" if m["language"] else "indented")) + 1
        yield Block(page, line, m["language"], code, m["marks"])


def workplace(folder, build):
    """A folder that looks like the repository, but in which nothing of it is overwritten."""
    (folder / "experiments").mkdir()
    for path in [*ROOT.iterdir(), *(ROOT / "experiments").iterdir()]:
        if path.name not in NOT_OURS | {"experiments", "studies"}:
            (folder / path.relative_to(ROOT)).symlink_to(path)
    shutil.copytree(ROOT / "experiments/studies", folder / "experiments/studies", ignore=shutil.ignore_patterns("models"))
    (folder / "build").mkdir()
    (folder / "build/release").symlink_to(build)
    (folder / "results").mkdir()


def cpu_seconds():
    return sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def said(result):
    return (result.stdout + result.stderr).strip()[-1500:]


def run_shell(block):
    code = "set -euo pipefail\n" + block.marks.get("before", "") + "\n" + block.text
    result = subprocess.run(["bash", "-c", code], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=SLOW_SECONDS if "slow" in block.marks else SECONDS)
    return (None if result.returncode == 0 else f"exit code {result.returncode}\n{result.stdout.strip()[-1500:]}"), result.stdout


def run_python(block, names):
    printed = io.StringIO()
    try:
        with contextlib.redirect_stdout(printed):
            exec(compile(block.marks.get("before", "") + "\n" + block.text, block.where, "exec"), names)
    except Exception:
        return traceback.format_exc(limit=-1), ""
    return None, printed.getvalue()


def check_output(block, printed):
    """Returns what is wrong with the shown part of the output. Numbers may differ."""
    pattern = ".*?".join(re.sub(r"\d+(\\\.\d+)?", r"\\d+(\\.\\d+)?", re.escape(part)) for part in block.text.strip().split("..."))
    return None if re.search(pattern, printed, re.DOTALL) else f"the block before prints:\n{printed.strip()[-1500:]}"


def statements(text):
    """TOML that gives a key several values, as alternatives: one after the other."""
    part = ""
    for line in text.splitlines(keepends=True):
        if line.startswith("["):
            break
        part += line
        with contextlib.suppress(tomllib.TOMLDecodeError):
            tomllib.loads(part)
            yield part
            part = ""
    yield part + text[text.index(line):] if line.startswith("[") else part


def check_toml(block, schema):
    name = re.match(r"# (\S+\.toml)\b", block.text)
    if name:
        pathlib.Path(name[1]).write_text(block.text)
    try:
        tables = [tomllib.loads(block.text)]
    except tomllib.TOMLDecodeError:
        tables = [tomllib.loads(part) for part in statements(block.text)]
    if importlib.util.find_spec("jsonschema") is None:  # check_blocks says so
        return None
    import jsonschema

    errors = [error.message for table in tables for error in jsonschema.Draft202012Validator(schema).iter_errors(table)]
    return "\n".join(errors)[:1500] or None


def run_cpp(found, build):
    """All of a page as one program: each block sees what those before it declare."""
    lines = "{\n".join(block.marks.get("before", "") + "\n" + block.text for block in found).splitlines()
    includes = [line for line in lines if line.startswith("#include")]
    body = [line for line in lines if not line.startswith("#include")]
    pathlib.Path("blocks.cpp").write_text("\n".join([*includes, "int main() {", *body, "}" * len(found), ""]))
    compiled = subprocess.run(["c++", "-std=c++20", f"-I{ROOT}/include", "blocks.cpp", "-o", "blocks", f"-L{build}", "-ldelquad", f"-Wl,-rpath,{build}"],
                              capture_output=True, text=True, timeout=SECONDS)
    result = compiled if compiled.returncode else subprocess.run(["./blocks"], capture_output=True, text=True, timeout=SECONDS)
    return None if result.returncode == 0 else said(result)


def run_block(block, names, schema):
    """Returns what is wrong, and what the block prints."""
    try:
        if block.language == "python":
            return run_python(block, names)
        if block.language == "toml":
            return check_toml(block, schema), ""
        return run_shell(block)
    except (subprocess.TimeoutExpired, tomllib.TOMLDecodeError) as error:
        return str(error), ""


def run_page(page, build, schema, slow):
    """Returns the problems, and what is said: why blocks were not run, and how long others took."""
    wrong, skipped, long, names, cpp = [], [], [], {"__name__": "__main__"}, []
    with tempfile.TemporaryDirectory() as home, contextlib.chdir(home):
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # what blocks print
        workplace(pathlib.Path(home), build)
        os.environ.update(HOME=home, PATH=f"{build}:{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}", PYTHONPATH=f"{build}/python", DELQUAD_CAD_WORKER=f"{build}/delquad-cad", PYTHONDONTWRITEBYTECODE="1")
        for display in ("DISPLAY", "WAYLAND_DISPLAY"):  # where `delquad view` would open a browser
            os.environ.pop(display, None)
        sys.path.insert(0, f"{build}/python")
        printed = None
        for block in blocks(page):
            if "output" in block.marks:
                problem = check_output(block, printed) if printed is not None else None
                wrong += [f"{block.where}: {problem}"] if problem else []
                continue
            skipped.append(block.why_not(slow))
            if skipped[-1]:
                printed = None
                continue
            if block.language == "cpp":
                cpp.append(block)
                continue
            begin = cpu_seconds()
            problem, printed = run_block(block, names, schema)
            if cpu_seconds() - begin > MANY_SECONDS:
                long.append(f"{block.where}: {cpu_seconds() - begin:.1f} s of CPU")
            if problem:
                wrong.append(f"{block.where}: {problem}")
        problem = run_cpp(cpp, build) if cpp else None
        if problem:
            wrong.append(f"{cpp[0].where}: {problem}")
    return wrong, skipped, long


def check_blocks(pages, build, slow):
    schema = json.loads(subprocess.run([build / "delquad", "schema"], check=True, capture_output=True, text=True).stdout)
    case = schema["properties"]["case"]["anyOf"][0]
    schema = {"anyOf": [{**schema, "anyOf": [{}]}, {**case, "required": []}]}  # a page may show a part of an experiment, or a model
    wrong, all_skipped, all_long = [], [], []
    with concurrent.futures.ProcessPoolExecutor(max_workers=os.cpu_count(), max_tasks_per_child=1) as pool:
        done = [(page, pool.submit(run_page, page, build, schema, slow)) for page in pages]
        for page, future in done:
            found, skipped, long = future.result()
            wrong += found
            all_skipped += skipped
            all_long += long
    print(*all_long, sep="\n")
    for why in sorted(set(filter(None, all_skipped))):
        (needs.leave_out if why.startswith("needs ") else print)(f"{all_skipped.count(why)} {why}")
    if importlib.util.find_spec("jsonschema") is None:
        needs.leave_out("python3-jsonschema: blocks of TOML are read, and not compared with the schema")
    print(f"{len(all_skipped)} blocks, {all_skipped.count(None)} of them run")
    return wrong


# Tables of results on the site

EXPERIMENT = """title = "A square"
pipelines = ["DB"]
[[case]]
name = "square"
size = 0.25

loop = [{ rectangle = [[0, 0], [1, 1]] }]
"""


def load(path):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def check_tables(build):
    make_site = load(ROOT / "docs/site/make_site.py")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "square.toml").write_text(EXPERIMENT)
        subprocess.run([build / "delquad", "run", folder / "square.toml", "-o", folder / "results/suite/run"], check=True, capture_output=True)
        (folder / "results/suite/ranking").mkdir()
        (folder / "results/suite/ranking/table.md").write_text("# Ranking\n")
        make_site.Site(build, folder / "results", folder / "site").tables()
        pages = folder / "site_pages"
        record = json.loads((folder / "results/suite/run/square/DB/record.json").read_text())
        seen, left = set(), [pages / "tables.md"]
        while left:
            page = left.pop()
            if page in seen or not page.is_file():
                yield from [] if page.is_file() else [f"no {page.relative_to(pages)}"]
                continue
            seen.add(page)
            if page.suffix == ".md":
                left += [page.parent / link for link in re.findall(r"\]\(([^)]*)\)", page.read_text())]
        if not any(page.suffix == ".json" and json.loads(page.read_text()) == record for page in seen):
            yield "the tables do not lead to the record"
        text = (pages / "tables/suite_run.md").read_text()
        for what in (record["versions"]["delquad"], record["versions"]["commit"], record["machine"]["cpu"], record["started"][:10]):
            if what not in text:
                yield f"the tables do not say {what}"
        if pages / "tables/suite_ranking.md" not in seen:
            yield "the tables do not lead to the ranking"


# Tables of measurements


def check_measured(build):
    make_tables = load(ROOT / "docs/make_tables.py")
    with tempfile.TemporaryDirectory() as name:
        results = pathlib.Path(name)
        for study in make_tables.CHEAP:
            command = [build / "delquad", "run", ROOT / f"experiments/studies/{study}.toml", "-o", results / "studies" / study, "--pictures", "none"]
            subprocess.run(command, check=True, capture_output=True)
        found = set()
        for page in make_tables.pages():
            before = page.read_text()
            after = make_tables.renewed(before, results)
            found |= {name for name, _ in make_tables.MARK.findall(before)}
            for old, new in zip(make_tables.MARK.finditer(before), make_tables.MARK.finditer(after)):
                if re.sub("^Made by .*", "", old[0], flags=re.MULTILINE) != re.sub("^Made by .*", "", new[0], flags=re.MULTILINE):
                    yield f"{page.relative_to(ROOT)}: table {old[1]} is not what `make doc-tables` writes:\n{new[0]}"
        yield from (f"no page has a table '{name}'" for name in set(make_tables.TABLES) - found)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("what", choices=["links", "messages", "list", "keys", "blocks", "tables", "measured"])
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--slow", action="store_true")
    parser.add_argument("pages", nargs="*", type=pathlib.Path)
    given = parser.parse_args()
    build = given.build.resolve()
    if given.what == "links":
        wrong = check_links()
    elif given.what == "messages":
        wrong = list(check_messages())
    elif given.what == "list":
        wrong = list_messages() or []
    elif given.what == "keys":
        wrong = check_keys(build)
    elif given.what == "tables":
        wrong = list(check_tables(build))
    elif given.what == "measured":
        wrong = list(check_measured(build))
    else:
        wrong = check_blocks([page.resolve() for page in given.pages] or list(files(".md")), build, given.slow)
    print(*wrong, sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
