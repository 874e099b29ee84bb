#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests the fetching of models, with servers on this machine.

Usage: test_fetch.py FETCH.PY [unittest's arguments]
"""
import hashlib
import http.server
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import tomllib
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import needs  # noqa: E402

FETCH = pathlib.Path(sys.argv[1])
CONTENT = b"a model\n" * 1000
needs.program("curl", "curl")
needs.program("git", "git")


class Server(http.server.BaseHTTPRequestHandler):
    """/good: the file. /other: another one. /short: it breaks off. Else: 404."""

    asked = []

    def do_GET(self):
        Server.asked.append(self.path)
        known = {"/good": CONTENT, "/other": b"something else", "/short": CONTENT[:100],
                 "/mirror/cad/part.step": CONTENT}
        self.send_response(200 if self.path in known else 404)
        body = known.get(self.path, b"")
        self.send_header("Content-Length", str(len(CONTENT) if self.path == "/short" else len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_):
        pass


class Fetch(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        try:
            cls.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Server)
        except OSError as error:
            needs.skip(f"no server can listen on this machine: {error}")
        threading.Thread(target=cls.server.serve_forever, daemon=True).start()
        cls.base = f"http://127.0.0.1:{cls.server.server_port}"

    @classmethod
    def tearDownClass(cls):
        cls.server.shutdown()
        cls.server.server_close()

    def setUp(self):
        Server.asked.clear()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.list = pathlib.Path(folder.name) / "list.toml"
        self.data = pathlib.Path(folder.name) / "data"

    def fetch(self, *paths, arguments=(), base=None, path=os.environ["PATH"]):
        urls = [(base or self.base) + path for path in paths]
        self.list.write_text(
            f'[[file]]\nname = "cad/part.step"\nwhat = "a part"\nlicence = "free"\nurls = {urls}\n'
            f'sha256 = "{hashlib.sha256(CONTENT).hexdigest()}"\n')
        return subprocess.run([sys.executable, FETCH, self.data, "--list", self.list, *arguments],
                              capture_output=True, text=True, env={"PATH": path})  # without proxies and the like

    def files(self):
        return sorted(p.name for p in self.data.rglob("*") if p.is_file())

    def is_told(self, run, code, *parts):
        """In one line."""
        self.assertEqual(run.returncode, code)
        self.assertEqual(run.stderr.count("\n"), 1, run.stderr)
        self.assertEqual(run.stderr.startswith("error: "), code == 1, run.stderr)
        self.assertEqual(self.files(), [])
        for part in (*parts, "By hand: put the file of"):
            self.assertIn(part, run.stderr)

    def test_good_file(self):
        run = self.fetch("/good")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual((self.data / "cad/part.step").read_bytes(), CONTENT)
        self.assertEqual(self.files(), ["part.step"])
        self.assertIn("free", run.stdout)

    def test_is_not_fetched_again(self):
        self.fetch("/good")
        Server.asked.clear()
        run = self.fetch("/good")
        self.assertEqual((run.returncode, Server.asked), (0, []))
        self.assertIn("is there", run.stdout)

    def test_wrong_checksum(self):
        self.is_told(self.fetch("/other"), 1, "SHA-256 is")
        self.is_told(self.fetch("/other", "/nothing"), 1, "SHA-256 is", "404")

    def test_truncated(self):
        self.is_told(self.fetch("/short"), 0, "/short: ")

    def test_not_found_then_next_url(self):
        run = self.fetch("/nothing", "/other", "/good")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.assertEqual(Server.asked, ["/nothing", "/other", "/good"])
        self.assertEqual(self.files(), ["part.step"])

    def test_mirror_first(self):
        run = self.fetch("/nothing", arguments=["--mirror", self.base + "/mirror/"])
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(Server.asked, ["/mirror/cad/part.step"])

    def test_offline(self):
        self.is_told(self.fetch("/good", base="http://127.0.0.1:1"), 0, "curl: ")

    def test_without_curl(self):
        self.is_told(self.fetch("/good", path=""), 0, "curl is not installed")

    def test_another_file_stays(self):
        (self.data / "cad").mkdir(parents=True)
        (self.data / "cad/part.step").write_text("mine")
        run = self.fetch("/good")
        self.assertEqual((run.returncode, Server.asked), (1, []))
        self.assertIn("move it away", run.stderr)
        self.assertEqual((self.data / "cad/part.step").read_text(), "mine")

    def test_folder_that_cannot_be_made(self):
        self.data.write_text("a file")
        run = self.fetch("/good")
        self.assertEqual(run.returncode, 1)
        self.assertIn("error: ", run.stderr)
        self.assertNotIn("Traceback", run.stderr)


class Repository(unittest.TestCase):
    def test_is_there_at_its_commit(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            origin, data, models = folder / "origin", folder / "data", folder / "list.toml"

            def git(*arguments):
                return subprocess.run(["git", "-C", origin, "-c", "user.name=a", "-c", "user.email=a@b", *arguments],
                                      check=True, capture_output=True, text=True).stdout.strip()

            def fetch(url, commit):
                models.write_text(f'[[repository]]\nname = "parts"\nwhat = "parts"\nurl = "{url}"\ncommit = "{commit}"\nlicence = "free"\n')
                return subprocess.run([sys.executable, FETCH, data, "--list", models], capture_output=True, text=True)

            origin.mkdir()
            git("init", "--quiet")
            (origin / "part.step").write_bytes(CONTENT)
            git("add", "part.step")
            git("commit", "--quiet", "--message", "A part")
            commit = git("rev-parse", "HEAD")
            for absent in (fetch(folder / "nothing", commit), fetch(origin, "0" * 40)):
                self.assertEqual(absent.returncode, 0)
                self.assertIn("not fetched", absent.stderr)
            self.assertEqual(list(data.iterdir()), [])
            self.assertEqual(fetch(origin, commit).returncode, 0)
            self.assertEqual((data / "parts/part.step").read_bytes(), CONTENT)
            self.assertIn("is there", fetch(folder / "nothing", commit).stdout)
            self.assertIn("move it away", fetch(origin, "0" * 40).stderr)


class List(unittest.TestCase):
    def test_is_complete(self):
        files = tomllib.loads((FETCH.parent / "files.toml").read_text())["file"]
        for file in files:
            self.assertEqual(sorted(file), ["licence", "name", "sha256", "urls", "what"])
            self.assertRegex(file["sha256"], "^[0-9a-f]{64}$")
        for repository in tomllib.loads((FETCH.parent / "public.toml").read_text())["repository"]:
            self.assertEqual(sorted(repository), ["commit", "licence", "name", "url", "what"])
            self.assertRegex(repository["commit"], "^[0-9a-f]{40}$")
        names = {file["name"] for file in files}
        used = set()
        for experiment in (file for folder in ("paper", "studies", "peers") for file in (FETCH.parent.parent / folder).glob("*.toml")):
            for case in tomllib.loads(experiment.read_text()).get("case", []):
                used |= {case["data"]} if "data" in case else set()
        self.assertEqual(names, used)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
