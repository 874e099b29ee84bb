#!/usr/bin/env python3
"""The rooms of the house and their doors, as the build files say and as the code does.

Usage: check_house.py FOLDER. Prints what is wrong, a line each; exit code 1 when there is anything.
"""
import pathlib
import re
import sys

MOST_LINES = 60  # of a function
MOST_PUBLIC_HEADERS = 12
LAST_OF_LIBRARY = "adapt"
# Below and in the last room of the library: no formats of text, no streams, no process of its own.
NOT_IN_LIBRARY = [
    r"#include <(toml|nlohmann|CLI|iostream|muParser)",
    r"\b(stderr|stdout)\b",
    r"std::(cerr|cout|clog)\b",
    r"\b(signal|sigaction|fork|setlocale|setenv)\(",
]
# But for the room that reads what people write.
READS_TEXTS = "io/cases"
# What is above the library, and that room, goes through include/delquad: never into these.
INSIDE = ("mesher/", "curves/", "patches/", "features/")
# But for this: HDF5 crashes at the end of a process in which it could not write, so its writers get one of their own.
FORKS = "base/process.cpp"
# The only ones that know the system: the library's three, and what runs experiments, each in processes of its own.
SYSTEM_HEADER = r"#include <(sys/|(dlfcn|fcntl|malloc|poll|pthread|signal|spawn|time|unistd)\.h)|__int128|/proc/"
SYSTEM = """base/system.cpp base/process.cpp base/worker_process.cpp base/matching/wide.h experiments/console/interrupt.cpp
    experiments/sweep/folders.cpp experiments/sweep/process_tree.cpp experiments/sweep/run_program.cpp
    experiments/sweep/variant_work.cpp""".split()
# What is written once: its shape, the function to use, and the header of that.
PRIMITIVES = [
    (r"std::clamp\(-?dot\(", "nearest_part()", "base/segment.h"),
    (r"turn <= 0\) turn \+= 2 \*", "into_corner()", "base/segment.h"),
    (r"\(\{:\.6g\}, \{:\.6g\}", "show_point()", "base/text.h"),
    (r"istreambuf_iterator<char>\(in\), \{\}|<< in\.rdbuf\(\)", "file_bytes()", "base/text.h"),
    (r"find_last_not_of\(\"?[ k]", "trimmed()", "base/text.h"),
    (r"(line_curve|triangle_region)\[kept\+\+\]", "keep_lines(), keep_triangles()", "geometry/mesh/keep_elements.h"),
    (r"while \((parent|root|leader)_?\[\w+\] != ", "DisjointSets", "base/disjoint_sets.h"),
]
# Names of the standard library and the header that a header which uses them includes itself.
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


def rooms(root):
    """Folder of each module -> the modules that it links, in the order of the build."""
    links = {}
    for call in re.findall(r"^ *delquad_module\(([^)]*)\)", (root / "cmake/modules.cmake").read_text(), re.MULTILINE):
        if call.split()[0] == "folder":  # the function itself
            continue
        linked = re.search(r"LINKS((?:\s+[a-z_/]+)*)", call)
        links[call.split()[0]] = set(linked[1].split()) if linked else set()
    return links


def sources(root, room, all_rooms):
    """Files of a room, those of rooms inside of its folder left out."""
    inner = [root / r for r in all_rooms if r.startswith(room + "/")]
    for path in sorted((root / room).rglob("*")):
        if path.suffix in (".h", ".cpp") and not any(i in path.parents for i in inner):
            yield path


def room_of(header, all_rooms):
    folder = header.rpartition("/")[0]
    while folder and folder not in all_rooms:
        folder = folder.rpartition("/")[0]
    return folder


def check_links(root, links):
    order = list(links)
    for room, linked in links.items():
        for other in sorted(linked):
            if other not in links:
                yield f"{room}: links '{other}', which is no room"
            elif order.index(other) >= order.index(room):
                yield f"{room}: links {other}, which does not stand below it"
        used = {}
        for path in sources(root, room, links):
            for header in re.findall(r'#include "([^"]+)"', path.read_text()):
                other = room_of(header, links)
                if other and other != room:
                    used.setdefault(other, path)
        for other, path in sorted(used.items()):
            if other not in linked:
                yield f"{path.relative_to(root)}: includes a header of {other}, which {room} does not link"


def check_library(root, links):
    order = list(links)
    for room in order[: order.index(LAST_OF_LIBRARY) + 1]:
        if room == READS_TEXTS:
            continue
        for path in sources(root, room, links):
            for number, line in enumerate(path.read_text().splitlines(), 1):
                code = line.split("//")[0]
                if path == root / FORKS:
                    code = code.replace("fork()", "")
                if any(re.search(pattern, code) for pattern in NOT_IN_LIBRARY):
                    yield f"{path.relative_to(root)}:{number}: not in a library: {code.strip()}"


def check_system(root, links):
    used = set()
    for path in [*(p for room in links for p in sources(root, room, links)), *sorted((root / "include").rglob("*.h"))]:
        name = str(path.relative_to(root))
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if re.search(SYSTEM_HEADER, line):
                used.add(name)
                if name not in SYSTEM:
                    yield f"{name}:{number}: {line.strip()}: expected base/system.h or base/process.h"
    for name in sorted(set(SYSTEM) - used):
        yield f"{name}: knows nothing of the system: expected it not to be listed"


def check_primitives(root, links):
    for room in links:
        for path in sources(root, room, links):
            for number, line in enumerate(path.read_text().splitlines(), 1):
                for shape, name, header in PRIMITIVES:
                    if re.search(shape, line) and path.with_suffix(".h") != root / header:
                        yield f"{path.relative_to(root)}:{number}: expected {name} of {header}"


def check_door(root, links):
    order = list(links)
    above = order[order.index(LAST_OF_LIBRARY) + 1 :]
    for room in [READS_TEXTS, *above, "bindings", "examples"]:
        for path in sources(root, room, links):
            for header in re.findall(r'#include "([^"]+)"', path.read_text()):
                if header.startswith(INSIDE):
                    yield f"{path.relative_to(root)}: includes {header}: expected a header of include/delquad"


def check_public(root):
    headers = [h for h in sorted((root / "include/delquad").glob("*.h")) if h.name != "bench.h"]
    if not 0 < len(headers) <= MOST_PUBLIC_HEADERS:
        yield f"include/delquad: {len(headers)} headers: expected at most {MOST_PUBLIC_HEADERS}"
    names = {f"delquad/{h.name}" for h in headers}
    for path in headers:
        for header in re.findall(r'#include ["<]([^">]+)[">]', path.read_text()):
            if header not in names and not re.fullmatch(r"[a-z_]+", header):
                yield f"{path.relative_to(root)}: includes {header}: expected the standard library or delquad/"


def check_standard_headers(root, links):
    """Headers include what they use of the standard library, whoever includes them."""
    headers = [path for room in links for path in sources(root, room, links) if path.suffix == ".h"]
    for path in [*headers, *sorted((root / "include/delquad").glob("*.h"))]:
        text = path.read_text()
        included = set(re.findall(r"#include <([a-z_]+)>", text))
        used = re.findall(r"\bstd::(\w+)", re.sub(r"//.*", "", text))
        for header in sorted({HEADER_OF[name] for name in used if name in HEADER_OF} - included):
            names = ", ".join(sorted({f"std::{name}" for name in used if HEADER_OF.get(name) == header}))
            yield f"{path.relative_to(root)}: uses {names}: expected <{header}>"


def check_lengths(root, links):
    opening = re.compile(r"^( *)[^ #/}].*[)a-z\]] \{$")
    for room in links:
        for path in sources(root, room, links):
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
    links = rooms(root)
    checks = (check_links, check_library, check_door, check_system, check_primitives, check_standard_headers, check_lengths)
    wrong = [*check_public(root), *(line for check in checks for line in check(root, links))]
    for line in wrong:
        print(line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
