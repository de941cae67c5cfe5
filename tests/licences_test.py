#!/usr/bin/env python3
"""Licences: every part of other projects has an entry and a text, and what carries it shows the text.

usage: licences_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

PROGRAM = REPO = None  # set in main
MIT = "The above copyright notice and this permission notice shall be"
LIBRARY_GROUPS = ("libraries", "ceres", "hdf5", "mpi", "openturns", "search", "python")


def run(*command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=120, **options)


def flat(text):
    return " ".join(re.sub(r"(?m)^ ?\.$", "", text).split())


class LicencesTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="bentaxis_test_")))
        self.parts = json.loads((REPO / "LICENSES/parts.json").read_text())["parts"]

    def carried_by(self, carrier):
        return [part for part in self.parts if carrier in part["carried_by"]]

    def test_every_library_package_is_a_part(self):
        lines = (line.split() for line in (REPO / "scripts/packages.txt").read_text().splitlines() if line and line[0] != "#")
        named = {package for part in self.parts for package in part["packages"]}
        needed = {line[1] for line in lines if line[0] in LIBRARY_GROUPS}
        self.assertGreater(len(needed), 20)
        self.assertEqual(needed - named, set())

    def test_every_text_is_used_and_there(self):
        named = {text for part in self.parts for text in part["texts"]}
        self.assertEqual({file.name for file in (REPO / "LICENSES").glob("*.txt")}, named)
        for part in self.parts:
            self.assertRegex(part["spdx"], r"^[A-Za-z0-9.+-]+( (OR|AND|WITH) [A-Za-z0-9.+-]+)*$")

    def check(self, linked, root=None):
        return run("cmake", f"-DCHECK_LINKED={linked}", "-P", (root or REPO) / "scripts/cmake/BentaxisLicences.cmake")

    def test_a_library_without_an_entry_ends_the_build(self):
        self.assertEqual(self.check("Eigen3::Eigen;TBB::tbb;/usr/lib/x86_64-linux-gnu/libpagmo.so").returncode, 0)
        for linked in ("Eigen3::Eigen;Foo::foo", "/usr/lib/libfoo.so", "Eigen3::Eigenvalues"):
            done = self.check(linked)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn("LICENSES/parts.json", done.stderr)

    def test_a_missing_text_ends_the_build(self):
        shutil.copytree(REPO / "LICENSES", self.folder / "LICENSES")
        (self.folder / "scripts/cmake").mkdir(parents=True)
        shutil.copy(REPO / "scripts/cmake/BentaxisLicences.cmake", self.folder / "scripts/cmake")
        self.assertEqual(self.check("Eigen3::Eigen", self.folder).returncode, 0)
        for spoil in ((lambda file: file.write_text("")), (lambda file: file.unlink())):
            spoil(self.folder / "LICENSES/SUNDIALS.txt")
            done = self.check("Eigen3::Eigen", self.folder)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn("licence text of SUNDIALS", " ".join(done.stderr.split()))

    def test_shared_libraries_that_are_needed_are_parts(self):
        build = PROGRAM.parent.parent
        binaries = [PROGRAM, build / "fmu/bentaxis_fmu.so", *build.glob("python/bentaxis/_bentaxis*.so"),
                    *build.glob("modules/bentaxis_*")]
        known = [soname for part in self.parts for soname in part["sonames"]]
        for binary in binaries:
            needed = re.findall(r"\(NEEDED\).*\[(.+)\]", run("readelf", "-d", binary).stdout)
            self.assertGreater(len(needed), 0, binary)
            for library in needed:
                if not re.match(r"lib(a|t|ub)san|libclang", library):  # of instrumented builds
                    self.assertIn(library.split(".so")[0], known, f"{binary} needs {library}")

    def test_the_command_lists_all_and_prints_each(self):
        done = run(PROGRAM, "licenses")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for part in self.parts:
            self.assertRegex(done.stdout, rf"(?m)^  {re.escape(part['name'])} .*{re.escape(part['spdx'])}")
            text = run(PROGRAM, "licenses", part["name"].lower()).stdout
            for file in part["texts"]:
                self.assertIn((REPO / "LICENSES" / file).read_text(), text)
        self.assertIn("Apache License", run(PROGRAM, "licenses", "bentaxis").stdout)
        done = run(PROGRAM, "licenses", "sundails")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn('did you mean "SUNDIALS"?', done.stderr)

    def test_pages_hold_the_notices_of_what_they_hold(self):
        few = ["--set", "operation.samples_per_revolution=36", "--out"]
        run(PROGRAM, "show", "bap63_rated", *few, self.folder / "scene")
        run(PROGRAM, "sensitivity", "bap63_rated", "--output", "mean:Td", "--vary", "pump.tilt_deg", *few, self.folder / "plain")
        for page in sorted(self.folder.rglob("*.html")):
            text = page.read_text()
            notices = text[text.index('<details id="notices"'):].split("</details>")[0]
            carried = [name for name, mark in (("dygraphs", "Dygraph=t()"), ("three.js", "factory(global.THREE={}")) if mark in text]
            self.assertEqual(re.findall("<h2>(.+)</h2>", notices), carried, page)
            self.assertEqual(flat(notices).count(MIT), len(carried))
        self.assertIn("<h2>three.js</h2>", (self.folder / "scene/report.html").read_text())
        self.assertEqual([part["name"] for part in self.carried_by("page")], ["three.js", "dygraphs"])

    def test_fmus_hold_the_notices_of_what_they_hold(self):
        run(PROGRAM, "fmu", "bap63_rated", "--out", self.folder / "pump.fmu")
        with zipfile.ZipFile(self.folder / "pump.fmu") as archive:
            text = archive.read("documentation/licenses/third_party.txt").decode()
        for part in self.carried_by("fmu"):
            self.assertRegex(text, rf"(?m)^  {re.escape(part['name'])} .*: {re.escape(part['spdx'])}")
            for file in part["texts"]:
                self.assertIn((REPO / "LICENSES" / file).read_text(), text)

    def test_texts_are_those_of_the_installed_packages(self):
        done = run(sys.executable, REPO / "scripts/update_licenses", "--check")
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    PROGRAM, REPO = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    del sys.argv[1:3]
    unittest.main()
