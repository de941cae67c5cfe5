#!/usr/bin/python3
"""Tests of scripts/make_release on a finished build: what it makes, and that its checks notice what is wrong.

usage: release_test.py BUILD REPO_ROOT [options of unittest]

A small release (the wheel and the sources) is packed once; each test plants one fault in a copy.
"""

import gzip
import hashlib
import importlib.machinery
import importlib.util
import io
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest
import zipfile

sys.dont_write_bytecode = True
BUILD = REPO = release = None  # set in main


def load(file):
    loader = importlib.machinery.SourceFileLoader("make_release", str(file))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("make_release", loader))
    loader.exec_module(module)
    return module


def make_release(*options):
    return subprocess.run([sys.executable, "-B", REPO / "scripts/make_release", *map(str, options)], capture_output=True, text=True,
                          env={**os.environ, "SOURCE_DATE_EPOCH": "1700000000"})


class ReleaseTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="bentaxis_test_")))
        cls.whole = cls.scratch / "whole"
        done = make_release("--build", BUILD, "--only", "wheel,sdist", "--out", cls.whole)
        assert done.returncode == 0, done.stderr
        cls.said = done.stdout
        with zipfile.ZipFile(cls.file_of(cls.whole, "*.whl")) as archive:
            cls.wheel = {entry.filename: archive.read(entry) for entry in archive.infolist()}

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="bentaxis_test_")))
        self.copy = self.folder / "copy"
        shutil.copytree(self.whole, self.copy)

    @staticmethod
    def file_of(folder, pattern):
        file, = folder.glob(pattern)
        return file

    def refused(self, *words):
        done = make_release("--check", self.copy)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)

    def sbom(self, folder):
        return json.loads((folder / "bentaxis.spdx.json").read_text())

    def rewrite(self, content):
        """A list of parts that was changed, with checksums that agree with it."""
        (self.copy / "bentaxis.spdx.json").write_text(json.dumps(content))
        release.write_sums(self.copy)

    # ---- A good release ------------------------------------------------------------------------------

    def test_what_is_made(self):
        self.assertIn("twice the same bytes; all checks held", self.said)
        self.assertEqual({path.suffix for path in self.whole.iterdir()}, {".whl", ".gz", ".json", ""})
        done = subprocess.run(["sha256sum", "-c", "SHA256SUMS"], cwd=self.whole, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout.count(": OK")), (0, 3), done.stdout)
        self.assertEqual(list(release.differences(self.whole, self.copy)), [])
        self.assertEqual(make_release("--check", self.copy).returncode, 0)

    def test_the_list_of_parts(self):
        content = self.sbom(self.whole)
        self.assertEqual((content["spdxVersion"], content["creationInfo"]["created"]), ("SPDX-2.3", "2023-11-14T22:13:20Z"))
        packages = {package["name"]: package for package in content["packages"]}
        for name in ("libsimbody3.7", "libtbb12", "libc6", "libstdc++6"):  # linked, by what dpkg calls them
            found = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", name], capture_output=True, text=True).stdout
            self.assertEqual(packages[name]["versionInfo"], found)
            self.assertTrue(packages[name]["externalRefs"][0]["referenceLocator"].startswith(f"pkg:deb/debian/{name}@{found}"))
        self.assertEqual(packages["libeigen3-dev"]["licenseDeclared"], "MPL-2.0")  # headers: carried, linked by nobody
        how = {(relation["relationshipType"], relation["relatedSpdxElement"]) for relation in content["relationships"]}
        self.assertIn(("DYNAMIC_LINK", packages["libsimbody3.7"]["SPDXID"]), how)
        self.assertIn(("STATIC_LINK", packages["libeigen3-dev"]["SPDXID"]), how)

    def test_no_path_of_this_machine_is_in_the_wheel(self):
        # A compiler writes short texts as numbers of eight bytes into the code: their beginning is looked for too.
        fragments = [str(path).encode()[:8] for path in (REPO, BUILD) if not str(path).startswith(("/usr/", "/opt/", "/home/"))]
        for name, content in self.wheel.items():
            self.assertFalse(str(REPO).encode() in content or str(BUILD).encode() in content, name)
            if content.startswith(b"\x7fELF"):
                self.assertFalse(any(fragment in content for fragment in fragments), name)

    # ---- Faults --------------------------------------------------------------------------------------

    def test_a_changed_byte(self):
        file = self.file_of(self.copy, "*.whl")
        content = bytearray(file.read_bytes())
        content[len(content) // 2] ^= 1
        file.write_bytes(content)
        self.refused(f"{file.name}: differs from its checksum")
        # The same with a checksum that agrees: then by the list of parts, or by the archive itself.
        release.write_sums(self.copy)
        self.refused(file.name)

    def test_a_missing_and_an_additional_file(self):
        file = self.file_of(self.copy, "*.tar.gz")
        file.rename(self.copy / "other.tar.gz")
        self.refused(f"{file.name}: is listed in SHA256SUMS, but not there", "other.tar.gz: is not listed in SHA256SUMS")

    def test_a_library_that_is_not_listed(self):
        content = self.sbom(self.copy)
        identifier, = (package["SPDXID"] for package in content["packages"] if package["name"] == "libtbb12")
        content["packages"] = [package for package in content["packages"] if package["SPDXID"] != identifier]
        content["relationships"] = [relation for relation in content["relationships"] if identifier not in relation.values()]
        self.rewrite(content)
        self.refused("libtbb12", "is linked, but listed is nothing")

    def test_a_wrong_version_in_the_list(self):
        content = self.sbom(self.copy)
        package, = (package for package in content["packages"] if package["name"] == "libsimbody3.7")
        package["versionInfo"] = "0.1"
        self.rewrite(content)
        self.refused("libsimbody3.7", "listed is 0.1")

    def test_a_wheel_that_does_not_run(self):
        file = self.file_of(self.copy, "*.whl")
        with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, content in self.wheel.items():
                if not name.endswith("/scripts/bentaxis"):
                    archive.writestr(name, content)
        release.write_sums(self.copy)
        self.refused(f"{file.name}: ")

    # ---- Comparing two releases ----------------------------------------------------------------------

    def test_a_difference_is_named_down_to_the_member(self):
        file = self.file_of(self.copy, "*.tar.gz")
        with tarfile.open(file) as archive:
            entries = [(entry, archive.extractfile(entry).read()) for entry in archive]
        for what, change in (("time", lambda entry: setattr(entry, "mtime", 1700000000)), ("rights", lambda entry: setattr(entry, "mode", 0o600))):
            with self.subTest(what):
                planted = entries[7][0].name
                with open(file, "wb") as raw, gzip.GzipFile("", "wb", mtime=0, fileobj=raw) as packed, tarfile.open(fileobj=packed, mode="w") as archive:
                    for entry, content in entries:
                        new = tarfile.TarInfo(entry.name)
                        new.size, new.mode = len(content), entry.mode
                        if entry.name == planted:
                            change(new)
                        archive.addfile(new, io.BytesIO(content))
                self.assertEqual(list(release.differences(self.whole, self.copy)), [f"{file.name}: differs: {planted}"])

    def test_a_difference_in_a_wheel_and_a_file_that_is_made_once(self):
        file = self.file_of(self.copy, "*.whl")
        name = next(name for name in self.wheel if name.endswith("bap63_rated.toml"))
        with zipfile.ZipFile(file) as archive:
            infos = archive.infolist()
        with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
            for info in infos:
                archive.writestr(info, self.wheel[info.filename] + (b"# planted\n" if info.filename == name else b""))
        (self.copy / "more.txt").write_text("x")
        self.assertEqual(list(release.differences(self.whole, self.copy)),
                         [f"{file.name}: differs: {name}", "more.txt: made only the second time"])

    # ---- Refusals ------------------------------------------------------------------------------------

    def test_bad_options(self):
        (self.folder / "other.txt").write_text("not a release")
        for options, words in ((("--only", "wheels"), ("wheels", "deb, wheel")), (("--build", self.folder), (str(self.folder), "not the folder of a build")),
                               (("--build", BUILD, "--out", self.folder), ("holds other files than a release",)),
                               (("--check", self.folder / "none"), ("is not a directory",))):
            with self.subTest(options):
                done = make_release(*options)
                self.assertEqual(done.returncode, 2)
                for word in words:
                    self.assertIn(word, done.stderr.splitlines()[-1])
        self.assertEqual(hashlib.sha256((self.folder / "other.txt").read_bytes()).hexdigest(), hashlib.sha256(b"not a release").hexdigest())


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    BUILD, REPO = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
    release = load(REPO / "scripts/make_release")
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
