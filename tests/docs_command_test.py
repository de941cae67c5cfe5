#!/usr/bin/env python3
"""Tests of `bentaxis docs`: which site it finds, what it starts, what it says.

usage: docs_command_test.py BENTAXIS REPO_ROOT [options of unittest]
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = REPO = None  # set in main


class DocsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name).resolve()
        # As installed: the program in bin/, the site in share/doc/.
        self.program = self.folder / "bin/bentaxis"
        self.program.parent.mkdir()
        shutil.copy(PROGRAM, self.program)
        self.page = self.folder / "share/doc/bentaxis/site/index.html"
        self.page.parent.mkdir(parents=True)
        self.page.write_text("<p>")
        self.environment = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")}

    def run_docs(self, *arguments, status=0):
        done = subprocess.run([self.program, "docs", *arguments], capture_output=True, text=True, env=self.environment, timeout=60)
        self.assertEqual(done.returncode, status, done.stderr)
        return done

    def start_by(self, script):
        opener = self.folder / "tools/xdg-open"
        opener.parent.mkdir()
        opener.write_text(f"#!/bin/sh\n{script}\n")
        opener.chmod(0o755)
        self.environment |= {"PATH": f"{opener.parent}:{self.environment['PATH']}", "DISPLAY": ":0"}

    def test_the_path_is_printed_and_nothing_started(self):
        self.start_by(f"touch {self.folder}/started")
        done = self.run_docs("--print")
        self.assertEqual((done.stdout, done.stderr), (f"{self.page}\n", ""))
        self.assertFalse((self.folder / "started").exists())

    def test_the_browser_gets_the_page(self):
        self.start_by(f'printf "%s" "$*" > {self.folder}/started')
        done = self.run_docs()
        self.assertEqual((done.stdout, done.stderr), (f"{self.page}\n", ""))
        self.assertEqual((self.folder / "started").read_text(), str(self.page))

    def test_without_a_browser_it_says_what_to_do(self):
        self.assertIn("open this file", self.run_docs().stderr)
        self.start_by("exit 3")
        done = self.run_docs()
        self.assertEqual(done.stdout, f"{self.page}\n")
        self.assertRegex(done.stderr, "^bentaxis: no browser could be started; open this file in one\n$")

    def test_without_a_site_it_says_what_builds_it(self):
        shutil.rmtree(self.page.parent)
        done = self.run_docs("--print", status=2)
        self.assertEqual(done.stdout, "")
        named = re.findall(r"scripts/\w+", done.stderr)
        self.assertEqual(named, ["scripts/setup", "scripts/build_site"])
        for script in named:
            self.assertTrue(os.access(REPO / script, os.X_OK))
        self.assertNotIn("as text", done.stderr)

    def test_without_a_site_it_names_the_pages_as_text(self):
        shutil.rmtree(self.page.parent)
        texts = self.folder / "share/doc/bentaxis/docs/README.md"
        texts.parent.mkdir()
        texts.write_text("# Documentation\n")
        self.assertIn(f"; its pages as text: {texts}\n", self.run_docs("--print", status=2).stderr)

    def test_a_build_has_that_of_its_source_tree(self):
        """An installed program knows nothing of the tree where it was built."""
        page = REPO / "site/index.html"
        done = subprocess.run([PROGRAM, "docs", "--print"], capture_output=True, text=True, env=self.environment, timeout=60)
        self.assertEqual((done.returncode, done.stdout.strip()), (0, str(page)) if page.exists() else (2, ""), done.stderr)


def main():
    global PROGRAM, REPO
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    PROGRAM, REPO = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    del sys.argv[1:3]
    unittest.main()


if __name__ == "__main__":
    main()
