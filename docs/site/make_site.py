#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the documentation as pages with a search, which need no network: build/site.

Usage: make_site.py BUILD RESULTS SITE. BUILD has the program and the Python module. RESULTS are folders of `delquad run`, whose tables are shown where
there are any. Needs Debian's mkdocs, mkdocs-material and doxygen.
"""
import ast
import inspect
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
HOME = {"README.md": "index.md", "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changes.md"}


class Site:
    def __init__(self, build, results, site):
        self.build, self.results, self.site = build, results, site
        self.pages = site.with_name(site.name + "_pages")
        shutil.rmtree(self.pages, ignore_errors=True)
        self.pages.mkdir(parents=True)

    def write(self, name, text):
        path = self.pages / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    # Pages of the repository

    def place(self, source):
        """Returns the place of a file or folder of the repository among the pages."""
        name = source.relative_to(ROOT).as_posix()
        if name in HOME:
            return HOME[name]
        if name.startswith("docs/"):
            return name.removeprefix("docs/")
        return f"source/{name}" + ("/index.md" if source.is_dir() else "" if source.suffix == ".md" else ".md")

    def take(self, source):
        """Copies a page, with the links in it, or shows a file or the files of a folder."""
        place = self.pages / self.place(source)
        if place.exists():
            return
        place.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            place.touch()
            files = [path for path in sorted(source.iterdir()) if path.is_file()]
            text = f"# {source.relative_to(ROOT)}\n\n" + "".join(f"* [{path.name}]({path})\n" for path in files)
            text = re.sub(r"\]\((/[^)]*)\)", lambda m: f"]({self.link(pathlib.Path(m[1]), place)})", text)
        elif source.suffix == ".md":
            place.touch()
            text = re.sub(r"(\]\()([^)#\s]+)", lambda m: m[1] + self.linked(m[2], source, place), source.read_text())
        elif source.suffix in (".png", ".svg", ".bib"):
            shutil.copy(source, place.with_name(source.name))
            return
        else:
            language = {".cpp": "cpp", ".h": "cpp", ".py": "python", ".toml": "toml", ".sh": "sh"}.get(source.suffix, "text")
            text = f"# {source.relative_to(ROOT)}\n\n```{language}\n{source.read_text(errors='replace')}\n```\n"
        place.write_text(text)

    def linked(self, link, source, place):
        target = (source.parent / link).resolve()
        return link if re.match(r"[a-z]+:", link) or not target.exists() else self.link(target, place)

    def link(self, target, place):
        self.take(target)
        name = self.place(target)
        if target.suffix in (".png", ".svg", ".bib"):
            name = name.removesuffix(".md")
        return os.path.relpath(self.pages / name, place.parent)

    # Pages that are made

    def commands(self):
        program = self.build / "delquad"
        said = subprocess.run([program, "help"], check=True, capture_output=True, text=True).stdout
        names = re.findall(r"^  ([a-z]+)  ", said.partition("Subcommands:")[2], re.MULTILINE)
        text = f"# Commands\n\nThe output of `delquad help`.\n\n```text\n{said}```\n"
        for name in names:
            said = subprocess.run([program, "help", name], check=True, capture_output=True, text=True).stdout.partition("\nExit codes")[0]
            text += f"\n## delquad {name}\n\n```text\n{said.replace(str(program), 'delquad')}```\n"
        self.write("commands.md", text.replace(str(program), "delquad"))

    def python(self):
        """Writes the reference of Python: signatures from the stub, texts from the module."""
        sys.path.insert(0, str(self.build / "python"))
        import delquad

        text = "# Python\n\n[python.md](python.md) is the guide.\n\n```text\n" + inspect.getdoc(delquad) + "\n```\n"
        for node in ast.parse((ROOT / "program/python/delquad/__init__.pyi").read_text()).body:
            if not isinstance(node, (ast.FunctionDef, ast.ClassDef)) or node.name.startswith("_"):
                continue
            shown = [node] if isinstance(node, ast.FunctionDef) else [one for one in node.body if isinstance(one, ast.FunctionDef) and one.name != "__init__"]
            signatures = "\n".join(re.sub(r"\n?    \.\.\.$| \.\.\.$", "", ast.unparse(one)).removesuffix(":") for one in shown).replace("@property\n", "").replace("_Floats", "ndarray").replace("_Integers", "ndarray")
            text += f"\n## {node.name}\n\n```python\n{signatures}\n```\n\n" if signatures else f"\n## {node.name}\n\n"
            text += "```text\n" + inspect.cleandoc(getattr(delquad, node.name).__doc__ or "") + "\n```\n"
        self.write("python_reference.md", text.replace("```text\n\n```\n", ""))

    def gallery(self):
        text = "# Gallery\n\nEach picture has the commands that made it. Colors show `eta`; lines join pairs of irregular vertices. `delquad` is `build/release/delquad`, called in the folder of the repository.\n"
        environment = {**os.environ, "PATH": f"{self.build}:{os.environ['PATH']}"}
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "experiments").symlink_to(ROOT / "experiments")
            for picture in tomllib.loads((HERE / "gallery.toml").read_text())["picture"]:
                name = picture["name"]
                text += f"\n## {picture['title']}\n\n![{picture['title']}](gallery/{name}.svg)\n\n"
                if "file" in picture:
                    (pathlib.Path(folder) / f"{name}.toml").write_text(picture["file"])
                    text += f"```toml\n# {name}.toml\n{picture['file'].strip()}\n```\n\n"
                text += f"```sh\n{picture['run'].strip()}\n```\n"
                subprocess.run(["bash", "-euc", picture["run"]], cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                (self.pages / "gallery").mkdir(exist_ok=True)
                shutil.copy(pathlib.Path(folder) / f"{name}.svg", self.pages / "gallery")
        self.write("gallery.md", text)

    def tables(self):
        """Writes the tables of folders of results, with version, machine and date, and links to the records."""
        text, pages = "# Tables\n\n", {}
        for study in sorted(self.results.rglob("study.json")):
            folder = study.parent
            records = sorted(folder.glob("*/*/record.json"))
            if not records or not (folder / "table.md").exists():
                continue
            name = folder.relative_to(self.results).as_posix().replace("/", "_")
            page = ""
            for kind in ("table", "hypotheses", "summary", "pairs"):
                if (folder / f"{kind}.md").exists():
                    page += (folder / f"{kind}.md").read_text().replace("\n# ", "\n## ") + "\n"
            made = set()
            links = "\n## Records\n\n"
            for path in records:
                record = json.loads(path.read_text())
                versions, machine = record.get("versions", {}), record.get("machine", {})
                made.add(f"delquad {versions.get('delquad')} ({versions.get('commit')}), {machine.get('cpu')}, {machine.get('processors')} processors, {record.get('started', '')[:10]}")
                cell = path.relative_to(folder).as_posix().replace("@", "_")
                (self.pages / "tables" / name / cell).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(path, self.pages / "tables" / name / cell)
                links += f"* [{path.parent.relative_to(folder)}]({name}/{cell})\n"
            title = json.loads(study.read_text())["title"]
            head, _, rest = page.partition("\n")
            self.write(f"tables/{name}.md", head + "\n\nMade by " + "; ".join(sorted(made)) + ".\n" + rest + links)
            pages[folder] = f"* [{title}](tables/{name}.md)\n"
        for table in sorted(self.results.rglob("ranking/table.md")):  # of a suite, from all runs beside it
            suite = table.parents[1]
            name = "_".join((*suite.relative_to(self.results).parts, "ranking"))
            runs = "".join(page.replace("](tables/", "](") for folder, page in pages.items() if suite in folder.parents)
            self.write(f"tables/{name}.md", table.read_text() + "\n## Runs\n\n" + runs)
            text += f"* [{table.read_text().partition(chr(10))[0].lstrip('# ')}](tables/{name}.md)\n"
        text += "".join(pages.values()) or "`make paper` or `make suite` make them; `make site` then shows them here.\n"
        self.write("tables.md", text)

    # All of it

    def config(self):
        names = {
            "Use": "packages criteria anisotropy adaptation source/examples/solvers/README library python",
            "Compare": "experiments own_strategy results statistics suite public_cases",
            "Measured": "tables measurements ablation which_quality",
            "Inside": "algorithms matching architecture glossary paper contributing changes",
            "Reference": "meshing models formats keys commands python_reference",
        }
        nav = [f"{page}.md" for page in "index getting_started tutorials how_do_i troubleshooting gallery".split()]
        nav += [{title: [f"{page}.md" for page in pages.split()]} for title, pages in names.items()]
        nav[-1]["Reference"].append({"C++": "cpp/index.html"})
        return {
            "site_name": "Delquad", "docs_dir": str(self.pages), "site_dir": str(self.site), "use_directory_urls": False, "nav": nav,
            "theme": {"name": "material", "font": False, "custom_dir": str(HERE / "theme"), "features": ["navigation.tabs", "navigation.top", "toc.follow"],
                      "palette": [{"scheme": "default", "primary": "blue grey", "toggle": {"icon": "material/weather-night", "name": "dark"}},
                                  {"scheme": "slate", "primary": "blue grey", "toggle": {"icon": "material/weather-sunny", "name": "light"}}]},
            "plugins": ["search"],
            "markdown_extensions": ["tables", "sane_lists", {"toc": {"permalink": True}}, "pymdownx.highlight", "pymdownx.superfences"],
        }

    def cpp(self):
        settings = {"PROJECT_NAME": "Delquad", "INPUT": ROOT / "include/delquad", "OUTPUT_DIRECTORY": self.site, "HTML_OUTPUT": "cpp", "GENERATE_LATEX": "NO", "EXTRACT_ALL": "YES",
                    "QUIET": "YES", "WARN_IF_UNDOCUMENTED": "NO", "WARNINGS": "NO", "HAVE_DOT": "NO", "JAVADOC_AUTOBRIEF": "YES", "FULL_PATH_NAMES": "NO", "SOURCE_BROWSER": "YES", "GENERATE_TREEVIEW": "YES"}
        text = "".join(f"{key} = {value}\n" for key, value in settings.items())
        subprocess.run(["doxygen", "-"], input=text, text=True, check=True, stdout=subprocess.DEVNULL)

    def make(self):
        self.take(ROOT / "README.md")
        for page in [*sorted((ROOT / "docs").glob("*.md")), ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md"]:
            self.take(page)
        self.commands()
        self.python()
        self.gallery()
        self.tables()
        (self.pages / "cpp").mkdir()
        (self.pages / "cpp/index.html").touch()  # doxygen's comes in its place
        with tempfile.NamedTemporaryFile("w", suffix=".yml") as config:
            json.dump(self.config(), config)  # which is YAML
            config.flush()
            subprocess.run(["mkdocs", "build", "--quiet", "--strict", "--config-file", config.name], check=True)
        self.cpp()
        index = (self.site / "search/search_index.json").read_text()
        offline = (HERE / "offline.js").read_text()
        (self.site / "search/offline.js").write_text(offline.replace("INDEX", index))


if __name__ == "__main__":
    Site(*(pathlib.Path(argument).resolve() for argument in sys.argv[1:4])).make()
    print(f"{sys.argv[3]}/index.html")
