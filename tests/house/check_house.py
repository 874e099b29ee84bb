#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Check the structure of the sources: modules and their links, the public API, and conventions.

Usage: check_house.py FOLDER. Prints a line for each problem; the exit code is 1 if there is any.
"""
import pathlib
import re
import sys

MOST_LINES = 60  # of a function
MOST_PUBLIC_HEADERS = 12
BINDINGS = "program/python"
LAST_OF_LIBRARY = "mesher/adapt"
# Modules up to LAST_OF_LIBRARY have no text formats, no streams and no processes.
NOT_IN_LIBRARY = [
    r"#include <(toml|nlohmann|CLI|iostream|muParser)",
    r"\b(stderr|stdout)\b",
    r"std::(cerr|cout|clog)\b",
    r"\b(signal|sigaction|fork|setlocale|setenv)\(",
]
# Exception: the module that reads model files.
READS_TEXTS = "io/cases"
# READS_TEXTS and modules above the library include headers of include/delquad, and none of these folders.
INSIDE = ("mesher/", "geometry/patches/", "features/")
# This file may fork: HDF5 crashes at the end of a process in which a write failed, so its writers get a child process.
FORKS = "base/process.cpp"
# Only these files may use the operating system.
SYSTEM_HEADER = r"#include <(sys/|(dlfcn|fcntl|malloc|poll|pthread|signal|spawn|time|unistd)\.h)|__int128|/proc/"
SYSTEM = """base/system.cpp base/process.cpp base/worker_process.cpp base/matching/wide.h experiments/console/interrupt.cpp
    experiments/sweep/folders.cpp experiments/sweep/process_tree.cpp experiments/sweep/run_program.cpp
    experiments/sweep/variant_work.cpp""".split()
# Code that exists once: its pattern, the function to use, and the header of the function.
PRIMITIVES = [
    (r"std::clamp\(-?dot\(", "nearest_part()", "base/segment.h"),
    (r"turn <= 0\) turn \+= 2 \*", "into_corner()", "base/segment.h"),
    (r"\(\{:\.6g\}, \{:\.6g\}", "show_point()", "base/text.h"),
    (r"istreambuf_iterator<char>\(in\), \{\}|<< in\.rdbuf\(\)", "file_bytes()", "base/text.h"),
    (r"find_last_not_of\(\"?[ k]", "trimmed()", "base/text.h"),
    (r"(line_curve|triangle_region)\[kept\+\+\]", "keep_lines(), keep_triangles()", "geometry/mesh/keep_elements.h"),
    (r"while \((parent|root|leader)_?\[\w+\] != ", "DisjointSets", "base/disjoint_sets.h"),
]
# Headers of the standard library and their names. A header that uses a name includes the header of the name.
STANDARD = {
    "algorithm": "clamp copy fill find max min nth_element sort lower_bound upper_bound",
    "array": "array",
    "atomic": "atomic",
    "chrono": "chrono",
    "cmath": "abs atan2 copysign cos hypot isfinite isnan log pow sin sqrt",
    "complex": "complex polar",
    "cstddef": "ptrdiff_t size_t",
    "cstdint": "int32_t int64_t uint8_t uint16_t uint32_t uint64_t",
    "filesystem": "filesystem",
    "functional": "function",
    "initializer_list": "initializer_list",
    "limits": "numeric_limits",
    "map": "map multimap",
    "memory": "make_shared make_unique shared_ptr unique_ptr weak_ptr",
    "mutex": "mutex lock_guard unique_lock",
    "numbers": "numbers",
    "numeric": "accumulate iota",
    "optional": "nullopt optional",
    "random": "mt19937_64",
    "set": "set multiset",
    "span": "span",
    "stdexcept": "invalid_argument runtime_error",
    "stop_token": "stop_token",
    "string": "string to_string",
    "string_view": "string_view",
    "tuple": "tuple tie",
    "unordered_map": "unordered_map",
    "unordered_set": "unordered_set",
    "utility": "exchange forward move pair swap",
    "variant": "get_if holds_alternative variant visit",
    "vector": "vector",
}
HEADER_OF = {name: header for header, names in STANDARD.items() for name in names.split()}


def module_links(root):
    """Return the folder of each module -> the modules that it links, in the order of the build."""
    links = {}
    for call in re.findall(r"^ *delquad_module\(([^)]*)\)", (root / "cmake/modules.cmake").read_text(), re.MULTILINE):
        if call.split()[0] == "folder":  # the function itself
            continue
        linked = re.search(r"LINKS((?:\s+[a-z_/]+)*)", call)
        links[call.split()[0]] = set(linked[1].split()) if linked else set()
    return links


def sources(root, module, modules):
    """Yield the files of a module, without the files of modules inside its folder."""
    inner = [root / m for m in [*modules, BINDINGS] if m.startswith(module + "/")]
    for path in sorted((root / module).rglob("*")):
        if path.suffix in (".h", ".cpp") and not any(i in path.parents for i in inner):
            yield path


def module_of(header, modules):
    folder = header.rpartition("/")[0]
    while folder and folder not in modules:
        folder = folder.rpartition("/")[0]
    return folder


def check_links(root, links):
    order = list(links)
    for module, linked in links.items():
        for other in sorted(linked):
            if other not in links:
                yield f"{module}: links '{other}', which is no module"
            elif order.index(other) >= order.index(module):
                yield f"{module}: links {other}, which is not below it"
        used = {}
        for path in sources(root, module, links):
            for header in re.findall(r'#include "([^"]+)"', path.read_text()):
                other = module_of(header, links)
                if other and other != module:
                    used.setdefault(other, path)
        for other, path in sorted(used.items()):
            if other not in linked:
                yield f"{path.relative_to(root)}: includes a header of {other}, which {module} does not link"


def check_library(root, links):
    order = list(links)
    for module in order[: order.index(LAST_OF_LIBRARY) + 1]:
        if module == READS_TEXTS:
            continue
        for path in sources(root, module, links):
            for number, line in enumerate(path.read_text().splitlines(), 1):
                code = line.split("//")[0]
                if path == root / FORKS:
                    code = code.replace("fork()", "")
                if any(re.search(pattern, code) for pattern in NOT_IN_LIBRARY):
                    yield f"{path.relative_to(root)}:{number}: not in a library: {code.strip()}"


def check_system(root, links):
    used = set()
    for path in [*(p for module in links for p in sources(root, module, links)), *sorted((root / "include").rglob("*.h"))]:
        name = str(path.relative_to(root))
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if re.search(SYSTEM_HEADER, line):
                used.add(name)
                if name not in SYSTEM:
                    yield f"{name}:{number}: {line.strip()}: expected base/system.h or base/process.h"
    for name in sorted(set(SYSTEM) - used):
        yield f"{name}: does not use the system: expected it not to be listed"


def check_primitives(root, links):
    for module in links:
        for path in sources(root, module, links):
            for number, line in enumerate(path.read_text().splitlines(), 1):
                for shape, name, header in PRIMITIVES:
                    if re.search(shape, line) and path.with_suffix(".h") != root / header:
                        yield f"{path.relative_to(root)}:{number}: expected {name} of {header}"


def check_public_api(root, links):
    order = list(links)
    above = order[order.index(LAST_OF_LIBRARY) + 1 :]
    for module in [READS_TEXTS, *above, BINDINGS, "examples"]:
        for path in sources(root, module, links):
            for header in re.findall(r'#include "([^"]+)"', path.read_text()):
                if header.startswith(INSIDE):
                    yield f"{path.relative_to(root)}: includes {header}: expected a header of include/delquad"


def check_public_headers(root):
    headers = [h for h in sorted((root / "include/delquad").glob("*.h")) if h.name != "bench.h"]
    if not 0 < len(headers) <= MOST_PUBLIC_HEADERS:
        yield f"include/delquad: {len(headers)} headers: expected at most {MOST_PUBLIC_HEADERS}"
    names = {f"delquad/{h.name}" for h in headers}
    for path in headers:
        for header in re.findall(r'#include ["<]([^">]+)[">]', path.read_text()):
            if header not in names and not re.fullmatch(r"[a-z_]+", header):
                yield f"{path.relative_to(root)}: includes {header}: expected the standard library or delquad/"


def check_standard_headers(root, links):
    """Check that headers include the headers of the standard library that they use."""
    headers = [path for module in links for path in sources(root, module, links) if path.suffix == ".h"]
    for path in [*headers, *sorted((root / "include/delquad").glob("*.h"))]:
        text = path.read_text()
        included = set(re.findall(r"#include <([a-z_]+)>", text))
        used = re.findall(r"\bstd::(\w+)", re.sub(r"//.*", "", text))
        for header in sorted({HEADER_OF[name] for name in used if name in HEADER_OF} - included):
            names = ", ".join(sorted({f"std::{name}" for name in used if HEADER_OF.get(name) == header}))
            yield f"{path.relative_to(root)}: uses {names}: expected <{header}>"


def check_licenses(root, links):
    tree = (p for folder in [*{m.partition("/")[0] for m in links}, "include", "tests"] for p in (root / folder).rglob("*"))
    for path in sorted(p for p in tree if p.suffix in (".h", ".cpp") and "corpus" not in p.parts):
        with path.open() as file:
            if "SPDX-License-Identifier: " not in file.readline():
                yield f"{path.relative_to(root)}:1: expected a line with SPDX-License-Identifier"


def check_lengths(root, links):
    opening = re.compile(r"^( *)[^ #/}].*[)a-z\]] \{$")
    for module in links:
        for path in sources(root, module, links):
            lines = path.read_text().splitlines()
            for first, line in enumerate(lines):
                start = opening.match(line)
                if not start or len(start[1]) > 2 or re.match(r" *(namespace|class|struct|enum|union)\b", line):
                    continue
                end = re.compile(start[1] + r"\}([^a-z]|$)")
                for last in range(first + 1, len(lines)):
                    if end.match(lines[last]):
                        if last - first > MOST_LINES:
                            yield f"{path.relative_to(root)}:{first + 1}: a function of {last - first} lines"
                        break


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    links = module_links(root)
    checks = (check_links, check_library, check_public_api, check_system, check_primitives, check_standard_headers, check_lengths, check_licenses)
    wrong = [*check_public_headers(root), *(line for check in checks for line in check(root, links))]
    for line in wrong:
        print(line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
