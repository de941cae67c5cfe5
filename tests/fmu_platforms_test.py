#!/usr/bin/env python3
"""Tests of `bentaxis fmu --platforms` with a file that stands for the library of scripts/build_fmu_platforms, and that
scripts/try_fmu_platforms notices what it is for.

usage: fmu_platforms_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import importlib.machinery
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

PROGRAM = REPO = None  # set in main


def script():
    loader = importlib.machinery.SourceFileLoader("try_fmu_platforms", str(REPO / "scripts/try_fmu_platforms"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


class Archives(unittest.TestCase):
    """With an installation that has libraries for Windows and ARM."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.program = self.folder / "bin/bentaxis"
        self.program.parent.mkdir()
        try:
            os.link(PROGRAM, self.program)
        except OSError:  # another file system
            shutil.copy(PROGRAM, self.program)
        self.library = self.folder / "lib/bentaxis/fmu/x86_64-windows/bentaxis_pump.dll"
        self.library.parent.mkdir(parents=True)
        self.library.write_bytes(b"MZ library")
        (self.library.parent / "licences.txt").write_bytes(b"text of mingw-w64")
        arm = self.folder / "lib/bentaxis/fmu/aarch64-linux/bentaxis_pump.so"
        arm.parent.mkdir()
        arm.write_bytes(b"ELF GLIBC_2.17")

    def write(self, *arguments, program=None):
        return subprocess.run([str(program or self.program), "fmu", str(REPO / "cases/bap63_rated.toml"), "--out",
                               str(self.folder / "pump.fmu"), *map(str, arguments)], capture_output=True, text=True)

    def binaries(self, *arguments):
        done = self.write(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        with zipfile.ZipFile(self.folder / "pump.fmu") as archive:
            return {name: archive.read(name) for name in archive.namelist() if name.startswith("binaries/")}, done.stdout

    def test_all_installed_platforms_are_packed(self):
        linux = r"co-simulation, Linux on x86-64 with glibc \S+ or newer"
        for version, places, words in (
                (2, ("linux64/bentaxis_pump.so", "win64/bentaxis_pump.dll"), " and Windows on x86-64\n"),
                (3, ("x86_64-linux/bentaxis_pump.so", "x86_64-windows/bentaxis_pump.dll", "aarch64-linux/bentaxis_pump.so"),
                 ", Windows on x86-64 and Linux on 64-bit ARM with glibc 2.17 or newer\n")):
            found, said = self.binaries("--fmi", version)
            self.assertEqual(list(found), [f"binaries/{place}" for place in places])
            self.assertEqual(list(found.values())[1:], [b"MZ library", b"ELF GLIBC_2.17"][:len(places) - 1])
            self.assertRegex(said, linux + words)
        with zipfile.ZipFile(self.folder / "pump.fmu") as archive:
            self.assertIn("Windows on x86-64 and Linux on 64-bit ARM with", archive.read("documentation/index.html").decode())
            self.assertIn(b"text of mingw-w64", archive.read("documentation/licenses/third_party.txt"))

    def test_platforms_chooses(self):
        found, said = self.binaries("--platforms", "x86_64-windows")
        self.assertEqual(list(found), ["binaries/win64/bentaxis_pump.dll"])
        self.assertIn("co-simulation, Windows on x86-64\n", said)

    def test_the_library_for_linux_alone_gives_the_bytes_of_a_build_without_others(self):
        if (PROGRAM.parents[1] / "modules/fmu").exists():
            self.skipTest("this build has libraries for other platforms")
        self.binaries("--platforms", "x86_64-linux")
        alone = (self.folder / "pump.fmu").read_bytes()
        self.assertEqual(self.write(program=PROGRAM).returncode, 0)
        self.assertEqual((self.folder / "pump.fmu").read_bytes(), alone)

    def test_sources_are_packed_where_they_are_asked_for(self):
        sources = self.folder / "lib/bentaxis/fmu/sources"
        (sources / "bentaxis/core").mkdir(parents=True)
        (sources / "buildDescription.xml").write_bytes(b"<fmiBuildDescription/>")
        (sources / "bentaxis/core/b.cpp").write_bytes(b"int b;")
        (sources / "bentaxis/a.h").write_bytes(b"")
        self.assertEqual(self.write("--fmi", 3, "--sources").returncode, 0)
        with zipfile.ZipFile(self.folder / "pump.fmu") as archive:
            packed = [name for name in archive.namelist() if name.startswith("sources/")]
            self.assertEqual(packed, ["sources/bentaxis/a.h", "sources/bentaxis/core/b.cpp", "sources/buildDescription.xml"])
            self.assertEqual(archive.read("sources/bentaxis/core/b.cpp"), b"int b;")
        self.assertEqual(self.write("--fmi", 3).returncode, 0)
        with zipfile.ZipFile(self.folder / "pump.fmu") as archive:
            self.assertFalse([name for name in archive.namelist() if name.startswith("sources/")])

    def test_what_cannot_be_is_refused(self):
        refusals = [(("--platforms", "x86_64-linux,x86_64-linux"), "--platforms x86_64-linux: is specified more than once"),
                    (("--platforms", "x86_64-darwin"), "aarch64-linux"),
                    (("--fmi", "2", "--platforms", "aarch64-linux"), "--platforms aarch64-linux: FMI 2.0 has no folder for it")]
        refusals.append((("--fmi", "2", "--sources"), "--sources: source code of FMI 2.0 must be C"))
        if not (PROGRAM.parents[1] / "modules/fmu").exists():
            refusals.append((("--fmi", "3", "--sources"), "--sources: the sources are not installed; scripts/build_fmu_platforms collects them"))
            self.library.unlink()
            refusals.append((("--platforms", "x86_64-windows"), "--platforms x86_64-windows: its library is not installed; "
                             "scripts/build_fmu_platforms builds it"))
        for arguments, words in refusals:
            with self.subTest(arguments):
                done = self.write(*arguments)
                self.assertEqual(done.returncode, 2)
                self.assertIn(words, done.stderr)
                self.assertEqual(done.stderr.count("\nbentaxis: ") + done.stderr.startswith("bentaxis: "), 1, done.stderr)
                self.assertFalse((self.folder / "pump.fmu").exists())


class Script(unittest.TestCase):
    """What scripts/try_fmu_platforms must notice."""

    def test_a_difference_is_over_the_peak_of_its_reaction(self):
        names = ["time", "Rs_x1_N", "Rs_y1_N", "p1_bar"]
        rows = [[0.0, 100.0, 1.0, 5.0], [1.0, -50.0, 0.5, 4.0]]
        others = [[0.0, 100.0, 1.0 + 3e-10, 5.0], [1.0, -50.0, 0.5, 4.0]]
        worst, where = script().largest_difference(names, rows, others)
        self.assertAlmostEqual(worst, 3e-12, delta=1e-14)
        self.assertEqual(where, "Rs_y1_N")
        self.assertGreater(worst, script().LIMIT)
        self.assertEqual(script().largest_difference(names, rows, rows), (0.0, "-"))

    def test_what_vanishes_is_compared_with_the_largest_of_its_unit(self):
        names = ["Rs_x1_N", "Rcs_z4_N", "Td_Nm"]
        rows, others = [[1e4, 5e-14, 100.0]], [[1e4, -5e-14, 100.0]]
        self.assertLess(script().largest_difference(names, rows, others)[0], 1e-16)
        self.assertAlmostEqual(script().largest_difference(names, [[1e4, 2e-8, 100.0]], [[1e4, 4e-8, 100.0]])[0], 1)
        self.assertEqual(script().largest_difference(names, rows, [[1e4, 5e-14 + 1.0, 100.0]]), (1e-4, "Rcs_z4_N"))

    def test_a_value_that_one_platform_alone_has_is_a_difference(self):
        worst, where = script().largest_difference(["x"], [[1.0]], [[float("nan")]])
        self.assertEqual((worst, where), (float("inf"), "x"))
        self.assertEqual(script().largest_difference(["x"], [[0.0]], [[1e-300]])[0], float("inf"))

    def test_libraries_that_windows_has(self):
        for name in ("KERNEL32.dll", "msvcrt.dll", "api-ms-win-crt-math-l1-1-0.dll"):
            self.assertTrue(script().OF_WINDOWS.fullmatch(name), name)
        for name in ("libstdc++-6.dll", "libgcc_s_seh-1.dll", "libwinpthread-1.dll", "sundials_cvodes.dll"):
            self.assertFalse(script().OF_WINDOWS.fullmatch(name), name)


if __name__ == "__main__":
    PROGRAM, REPO = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
