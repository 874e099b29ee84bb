#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fetches the models of a list that are missing in a folder: files with curl, repositories with git.

Usage: fetch.py FOLDER [--list LIST.toml] [--mirror URL]. The default list is files.toml. A file appears only if its SHA-256 is right, a repository only at its commit.

--mirror (or DELQUAD_MIRROR) is asked first, for URL/NAME; then the urls of the list. The exit code is 1 if a download is not the model,
and 0 if a model cannot be reached.
"""
import argparse
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import tomllib

LIST = pathlib.Path(__file__).with_name("files.toml")


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def download(url, path):
    """Returns why it failed, or an empty text."""
    if not shutil.which("curl"):
        return "curl is not installed"
    curl = ["curl", "--fail", "--silent", "--show-error", "--location", "--connect-timeout", "20", "--retry", "2"]
    run = subprocess.run([*curl, "--output", path, url], capture_output=True, text=True)
    if run.returncode == 0:
        return ""
    return (run.stderr.strip().splitlines() or [f"curl ended with exit code {run.returncode}"])[-1]


def fetch(file, folder, mirror):
    """Returns true if the file is there in the end, or could not be reached."""
    path = folder / file["name"]
    if path.exists():
        if digest(path) == file["sha256"]:
            print(f"{path}: is there")
            return True
        print(f"error: {path}: SHA-256 is {digest(path)}: expected {file['sha256']}; "
              "move it away to fetch it anew", file=sys.stderr)
        return False
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    reasons, is_wrong = [], False
    try:
        for url in ([f"{mirror.rstrip('/')}/{file['name']}"] if mirror else []) + file["urls"]:
            reason = download(url, part)
            if not reason and digest(part) != file["sha256"]:
                reason, is_wrong = f"SHA-256 is {digest(part)}", True
            if not reason:
                part.rename(path)
                print(f"{path}: fetched from {url}\n  {file['what']}; {file['licence']}")
                return True
            reasons.append(f"{url}: {reason}")
    finally:
        part.unlink(missing_ok=True)
    print(f"{'error: ' if is_wrong else ''}{path}: not fetched ({'; '.join(reasons)}). By hand: put the file of {file['urls'][0]} there "
          f"(SHA-256 {file['sha256']})", file=sys.stderr)
    return not is_wrong


def git(*arguments):
    run = subprocess.run(["git", *arguments], capture_output=True, text=True)
    return run.stdout.strip(), (run.stderr.strip().splitlines() or ["git failed"])[0] if run.returncode else ""


def clone(repository, folder, mirror):
    """Returns true if the repository is there in the end, or could not be reached."""
    path, commit = folder / repository["name"], repository["commit"]
    if path.exists():
        head = git("-C", path, "rev-parse", "HEAD")[0]
        if head == commit:
            print(f"{path}: is there")
            return True
        print(f"error: {path}: is not at commit {commit}; move it away to fetch it anew", file=sys.stderr)
        return False
    reasons = []
    for url in ([f"{mirror.rstrip('/')}/{repository['name']}"] if mirror else []) + [repository["url"]]:
        part = path.with_name(f".{path.name}.{os.getpid()}.part")
        try:
            for step in (["init", "--quiet"], ["fetch", "--quiet", "--depth", "1", url, commit], ["checkout", "--quiet", commit]):
                part.mkdir(parents=True, exist_ok=True)
                reason = git("-C", part, *step)[1]
                if reason:
                    break
            else:
                part.rename(path)
                print(f"{path}: fetched from {url}\n  {repository['what']}; {repository['licence']}")
                return True
            reasons.append(f"{url}: {reason}")
        finally:
            shutil.rmtree(part, ignore_errors=True)
    print(f"{path}: not fetched ({'; '.join(reasons)}). By hand: put commit {commit} of {repository['url']} there", file=sys.stderr)
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--mirror", default=os.environ.get("DELQUAD_MIRROR"))
    parser.add_argument("--list", type=pathlib.Path, default=LIST)
    arguments = parser.parse_args()
    models = tomllib.loads(arguments.list.read_text())
    try:
        right = [fetch(file, arguments.folder, arguments.mirror) for file in models.get("file", [])]
        right += [clone(repository, arguments.folder, arguments.mirror) for repository in models.get("repository", [])]
    except OSError as error:
        sys.exit(f"error: {error.filename or arguments.folder}: {error.strerror}")
    return 0 if all(right) else 1


if __name__ == "__main__":
    sys.exit(main())
