#!/usr/bin/env python3
"""Tests of importing foreign records: tests/imports holds files that LibreOffice, Octave and scipy have written.

usage: import_test.py BENTAXIS REPO_ROOT [options of unittest]
BENTAXIS_MAKE_EXPORTS=1 has make_exports.py write the files anew first (packages of the slow group).
"""

import csv
import json
import math
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

import command_line_test as base
from command_line_test import BAD_INPUT, DONE, OUT_OF_TOLERANCE, Case, ProgramTest

EXPORTS = pathlib.Path(__file__).resolve().parent / "imports"


class ImportTest(ProgramTest):
    def new(self, file, *arguments, status=DONE):
        return self.run_program("reference", "new", base.REPO / "cases" / "bap63_rated.toml", "--from", file, "--out",
                                "ref", *arguments, status=status)

    def regress(self, status):
        result = self.run_program("regress", "ref", status=status)
        return result.out + result.err

    def description(self):
        return (self.folder / "ref" / "description.toml").read_text()


class ExportTest(ImportTest):
    @classmethod
    def setUpClass(cls):
        cls.exports = EXPORTS
        if os.environ.get("BENTAXIS_MAKE_EXPORTS"):
            cls.exports = pathlib.Path(tempfile.mkdtemp())
            subprocess.run(["/usr/bin/python3", EXPORTS / "make_exports.py", cls.exports], check=True)

    def files(self, kind):
        files = sorted((self.exports / kind).iterdir())
        self.assertGreaterEqual(len(files), {"good": 6, "bad": 10}[kind])
        return files

    def test_what_is_right_agrees(self):
        for file in self.files("good"):
            with self.subTest(file.name):
                shutil.rmtree(self.folder / "ref", ignore_errors=True)
                out = self.new(file, "--accept").out
                correlations = [float(c) for c in re.findall(r" (-?[01]\.\d{7}) ", out)]
                self.assertGreaterEqual(len(correlations), 2)
                self.assertGreater(min(correlations), 0.999999)
                report = self.regress(DONE)
                # A tight tolerance, and what was guessed is said.
                self.assertLessEqual(float(re.search(r"^relative = (\S+)", self.description(), re.M)[1]), 1e-4)
                self.assert_mentions(report, "assumed", "phase shift of the whole file", "times")

    def test_the_report_shows_what_agrees(self):
        self.new(self.exports / "good" / "bench.csv", "--accept")
        self.run_program("regress", "ref", "--json-file", "r.json")
        figures = json.loads((self.folder / "r.json").read_text())["figures"]
        self.assertEqual({name for figure in figures for name in figure["channels"]},
                         {f"Rs_1_{axis}2_N" for axis in "xyz"} | {f"Rb1_{axis}1_N" for axis in "xyz"} | {"Rb2_x1_N", "Rb2_y1_N"}
                         | {"Rc_1_x2_N", "Rc_1_y2_N", "Td_z1_Nm"})
        self.assertEqual([figure["id"] for figure in figures], [f"held-{i}" for i in range(1, 6)])

    def test_what_is_wrong_differs(self):
        for file in self.files("bad"):
            with self.subTest(file.name):
                shutil.rmtree(self.folder / "ref", ignore_errors=True)
                if file.name == "swapped_pistons.xlsx":
                    # The names and the curves contradict each other: what the columns are must be said.
                    error = self.new(file, "--accept", status=BAD_INPUT).err
                    self.assert_mentions(error, "not recognised", "Cylinder 1 Fx", "Cylinder 2 wall Fy", "--mapping")
                    self.assertFalse((self.folder / "ref").exists())
                    self.new(self.exports / "good" / "results.xlsx")
                    mapping = self.folder / "ref_mapping.toml"
                    mapping.write_text(mapping.read_text().replace("results.xlsx", file.name))
                    self.new(file, "--mapping", mapping)
                else:
                    self.new(file, "--accept")
                self.regress(OUT_OF_TOLERANCE)

    def test_truncated_files_are_refused(self):
        for file in self.files("good"):
            content = file.read_bytes()
            for percent in (3, 30, 50, 70, 90, 95, 97, 98):
                cut = self.folder / f"cut{file.suffix}"
                cut.write_bytes(content[:len(content) * percent // 100])
                with self.subTest(file=file.name, percent=percent):
                    self.assert_mentions(self.new(cut, "--accept", status=BAD_INPUT).err, cut.name)
                    self.assertFalse((self.folder / "ref").exists())

    def test_a_number_cut_at_the_end_is_refused(self):
        file = self.exports / "good" / "pump.req"
        for cut in (1, 2, 3, 5, 8, 12, 20):
            (self.folder / "cut.req").write_bytes(file.read_bytes().rstrip()[:-cut])
            with self.subTest(cut):
                self.new(self.folder / "cut.req", "--accept", status=BAD_INPUT)
        lines = [f"{10 * i},{100 + 3 * (i % 7)}.{i:02}50,{5 + i % 5}.{i:02}25" for i in range(36)]
        text = "\n".join(["angle [deg],Rb1_x [N],Rb1_y [N]", *lines])
        (self.folder / "cut.csv").write_text(text[:-2])
        self.assert_mentions(self.new(self.folder / "cut.csv", status=BAD_INPUT).err, "cut.csv:37", "truncated")
        (self.folder / "cut.csv").write_text(text)  # whole, without an end of its last line
        self.assertNotIn("truncated", self.new(self.folder / "cut.csv", status=BAD_INPUT).err)

    def test_proposal_is_confirmed_or_edited(self):
        file = self.exports / "good" / "bench.csv"
        out = self.new(file).out
        self.assertFalse((self.folder / "ref").exists())
        mapping = self.folder / "ref_mapping.toml"
        self.assert_mentions(out, "Antriebsmoment", "Td_z1_Nm", "correlation", str(mapping.name))
        # Worst first.
        differences = [float(d) for d in re.findall(r"\d\.\d{7} +(\d\.\de[+-]\d\d)", out)]
        self.assertEqual(differences, sorted(differences, reverse=True))
        self.assert_mentions(self.new(file, status=BAD_INPUT).err, mapping.name, "exists")
        text = mapping.read_text()
        mapping.write_text(re.sub("guessed = true.*\n", "", text))
        self.new(file, "--mapping", mapping)
        self.assertNotIn("assumed", self.regress(DONE))
        shutil.rmtree(self.folder / "ref")
        mapping.write_text(text.replace("offset_deg = -37", "offset_deg = -36.9"))
        self.new(file, "--mapping", mapping)
        self.regress(OUT_OF_TOLERANCE)
        self.assert_mentions(self.new(file, "--mapping", mapping, "--accept", status=BAD_INPUT).err, "--mapping")

    def test_a_column_that_no_curve_resembles_must_be_decided(self):
        file = self.exports / "good" / "bench.csv"
        self.new(file)
        mapping = self.folder / "ref_mapping.toml"
        text = mapping.read_text()
        self.assertNotIn("undecided", text)
        # The torque, late by a seventh of a turn: an error of the record, or of another kind than it says.
        lines = (self.folder / "late.csv")
        rows = file.read_text().splitlines()
        first = next(i for i, row in enumerate(rows) if re.match(r"[0-9.]+;", row))
        column = next(row for row in rows if "Antriebsmoment" in row).split(";").index('"Antriebsmoment"')
        cells = [row.split(";") for row in rows[first:]]
        torque = [row[column] for row in cells]
        shift = len(torque) // 7
        for i, row in enumerate(cells):
            row[column] = torque[i - shift]
        lines.write_text("\n".join(rows[:first] + [";".join(row) for row in cells]) + "\n")
        mapping.unlink()
        out = self.new(lines).out
        self.assert_mentions(out, "Antriebsmoment", "not recognised", "state in it what the undecided columns are")
        self.assertNotIn("--accept", out)
        self.assert_mentions(self.new(lines, "--mapping", mapping, status=BAD_INPUT).err, "undecided", "Antriebsmoment", "ignore")
        text = mapping.read_text()
        mapping.write_text(re.sub("undecided = .*\n", "", text).replace("ignore = [", 'ignore = ["Antriebsmoment", '))
        self.new(lines, "--mapping", mapping)
        self.regress(DONE)

    def test_sheets(self):
        book = self.exports / "good" / "results.xlsx"
        self.assert_mentions(self.new(book, "--sheet", "Absent", status=BAD_INPUT).err, "Absent", "Info, Results")
        self.assert_mentions(self.new(book, "--sheet", "Info", status=BAD_INPUT).err, "Info", "no table")
        self.new(book, "--sheet", "Results", "--accept")
        self.assertIn('sheet = "Results"', self.description())
        self.assert_mentions(self.new(self.exports / "good" / "run.mat", "--sheet", "absent", status=BAD_INPUT).err,
                             "absent", "run", "comment")


class OwnRecordTest(ImportTest):
    """Records made of the program's own curves, so that what a mapping must say is known."""

    def test_matlab_4(self):
        # 20 bytes (little-endian doubles, full), name, values: no word in it says what it is.
        self.run_program("run", base.REPO / "cases" / "bap63_rated.toml", "--model", "analytic", "--out", "own")
        with (self.folder / "own" / "analytic.csv").open() as file:
            rows = list(csv.DictReader(file))
        with (self.folder / "old.mat").open("wb") as file:
            for name, column in (("angle_deg", "theta_deg"), ("torque_Nm", "Td_z1_Nm"), ("Rb1_y_N", "Rb1_y1_N"), ("Rb2_y_N", "Rb2_y1_N")):
                file.write(struct.pack("<5i", 0, len(rows), 1, 0, len(name) + 1) + name.encode() + b"\0")
                file.write(struct.pack(f"<{len(rows)}d", *(float(row[column]) for row in rows)))
        self.new(self.folder / "old.mat", "--accept")
        self.assert_mentions(self.regress(DONE), "torque_Nm", "Rb1_y_N")

    def record(self, heading, columns, shift_deg=0, digits=17):
        """Writes columns (names with their signs) of the analytic turn, begun shift_deg later."""
        self.run_program("run", base.REPO / "cases" / "bap63_rated.toml", "--model", "analytic", "--out", "own")
        with (self.folder / "own" / "analytic.csv").open() as file:
            rows = list(csv.DictReader(file))
        first = rows.index(next(r for r in rows if float(r["theta_deg"]) == shift_deg))
        lines = [",".join(["angle [deg]", *heading])]
        for i, row in enumerate(rows):
            at = rows[(first + i) % len(rows)]
            lines.append(",".join([row["theta_deg"], *(f"{sign * float(at[name]):.{digits}g}" for name, sign in columns)]))
        file = self.folder / "record.csv"
        file.write_text("\n".join(lines) + "\n")
        return file

    def test_torque_on_the_other_body_has_its_sign(self):
        file = self.record(["torque [Nm]", "tooth [N]"], [("Td_z1_Nm", -1), ("Rcs_z4_N", 1)])
        self.new(file, "--accept")
        signs = dict(re.findall(r'^ours = "(\w+)".*\n(?:.*\n)*?sign = (-?1)', self.description(), re.M))
        self.assertEqual(signs.get("Td_z1_Nm"), "-1", self.description())
        self.regress(DONE)

    def test_a_heading_that_its_values_contradict_is_stated_as_long_as_it_stands(self):
        """In the description, by regress and by compare --with, not by the proposal alone."""
        said = "its heading says kN, its values fit the model in N: tooth [kN]"
        out = self.new(self.record(["torque [Nm]", "tooth [kN]"], [("Td_z1_Nm", 1), ("Rcs_z4_N", 1)]), "--accept").out
        self.assertIn("the file says kN", out)
        self.assertIn(said, out)
        self.assertEqual(re.findall(r'unit = "(.*)"\nfile_says = "(.*)"', self.description()), [("N", "kN")])
        self.assertIn(said, self.regress(DONE))
        self.run_program("compare", "ref/case.toml", "--with", "ref", "--out", "out")
        self.assertIn(said, (self.folder / "out" / "report.json").read_text())
        shutil.rmtree(self.folder / "ref")
        self.assertNotIn("heading", self.new(self.record(["torque [Nm]", "tooth [N]"], [("Td_z1_Nm", 1), ("Rcs_z4_N", 1)]), "--accept").out)

    def test_the_tolerance_proposed_is_that_of_the_digits(self):
        for digits in (3, 4):
            shutil.rmtree(self.folder / "ref", ignore_errors=True)
            self.new(self.record(["torque [Nm]", "tooth [N]"], [("Td_z1_Nm", 1), ("Rcs_z4_N", 1)], digits=digits), "--accept")
            relative = float(re.search(r"^relative = (\S+)", self.description(), re.M)[1])
            # Half a unit of the last digit is 0.5 to 5 times 10^-digits of the peak; and some room.
            self.assertTrue(0.5 <= relative * 10 ** digits <= 20, relative)

    def test_vectors_in_axes_at_any_angle(self):
        self.run_program("run", base.REPO / "cases" / "bap63_rated.toml", "--model", "analytic", "--out", "own")
        axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        for letter, angle in zip("XYZ", (17.3, 41.9, -8.2)):
            a, b = ("XYZ".index(letter) + 1) % 3, ("XYZ".index(letter) + 2) % 3
            c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
            axes[a], axes[b] = ([c * p + s * q for p, q in zip(axes[a], axes[b])], [c * q - s * p for p, q in zip(axes[a], axes[b])])
        lines = ["angle [deg]," + ",".join(f"{name} {axis} [N]" for name in ("front", "rear") for axis in "XYZ")]
        with (self.folder / "own" / "analytic.csv").open() as file:
            for row in csv.DictReader(file):
                vectors = [[float(row.get(f"{name}_{axis}1_N") or 0) for axis in "xyz"] for name in ("Rb1", "Rb2")]
                turned = [sum(p * q for p, q in zip(axis, vector)) for vector in vectors for axis in axes]
                lines.append(",".join([row["theta_deg"], *(f"{value:.17g}" for value in turned)]))
        file = self.folder / "record.csv"
        file.write_text("\n".join(lines) + "\n")
        self.assert_mentions(self.new(file, "--accept").out, "turned by 17.3, 41.9, -8.2 deg about XYZ")
        self.assert_mentions(self.description(), "euler_deg = [17.3, 41.9, -8.2]")
        self.regress(DONE)

    def test_a_coarse_record_is_shown_at_its_own_angles(self):
        """36 angles of the case itself: nothing differs, however little a spline between them would be worth."""
        self.run_program("run", base.REPO / "cases" / "bap63_rated.toml", "--model", "analytic", "--set",
                         "operation.samples_per_revolution=36", "--channels", "Rb1_x1_N,Rb1_y1_N,Rb1_z1_N,Td_z1_Nm,Rs_1_z2_N", "--out", "run")
        out = self.new(self.folder / "run" / "analytic.csv").out
        differences = [float(d) for d in re.findall(r"\d\.\d{7} +(\d\.\de[+-]\d\d)", out)]
        self.assertGreaterEqual(len(differences), 3)
        self.assertLess(max(differences), 1e-10)

    def test_one_of_two_vectors_in_turned_axes_is_wrong(self):
        """Two vectors do not show which of them has the wrong sign; with a third one they do."""
        self.run_program("run", base.REPO / "cases" / "bap63_rated.toml", "--model", "analytic", "--set",
                         "operation.samples_per_revolution=180", "--out", "run")
        with open(self.folder / "run" / "analytic.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        c, s = math.cos(math.radians(40)), math.sin(math.radians(40))
        vectors = {"A": [f"Rb1_{axis}1_N" for axis in "xyz"], "B": [f"Rs_1_{axis}2_N" for axis in "xyz"],
                   "C": [f"Rs_3_{axis}2_N" for axis in "xyz"]}

        def turned(v, of_s2):
            if of_s2:  # into S1
                v = [v[0], c * v[1] + s * v[2], -s * v[1] + c * v[2]]
            a, b = math.radians(25), math.radians(-50)
            v = [v[0] * math.cos(a) + v[1] * math.sin(a), v[1] * math.cos(a) - v[0] * math.sin(a), v[2]]
            return [v[0], v[1] * math.cos(b) + v[2] * math.sin(b), v[2] * math.cos(b) - v[1] * math.sin(b)]

        def record(names, wrong, axis):
            lines = ["angle [deg]," + ",".join(f"{name}{axis} [N]" for name in names for axis in "xyz")]
            for row in rows:
                values = []
                for name in names:
                    v = turned([float(row[column]) for column in vectors[name]], name != "A")
                    if name == wrong:
                        v[axis] = -v[axis]
                    values += v
                lines.append(",".join(map(repr, [float(row["theta_deg"]), *values])))
            (self.folder / "record.csv").write_text("\n".join(lines) + "\n")
            (self.folder / "ref_mapping.toml").unlink(missing_ok=True)
            return self.new("record.csv").out

        ours = {"A": "Rb1", "B": "Rs_1"}
        for wrong in ours:
            for axis in range(3):
                out = record("AB", wrong, axis)
                self.assert_mentions(out, "not decided: a component of Rb1 or Rs_1 has the wrong sign")
                self.assertIn("one_is_wrong = [\"Rb1\", \"Rs_1\"]", (self.folder / "ref_mapping.toml").read_text())
                out = record("ABC", wrong, axis)
                self.assertNotIn("not decided", out)
                worst = out.splitlines()[1]
                self.assertIn(f" {ours[wrong]} ", worst)
        self.assertNotIn("not decided", record("AB", "", 0))

    def test_the_number_behind_the_piston_counts(self):
        names = [(k, axis) for k in range(1, 6) for axis in "xyz"]
        file = self.record([f"probe2 piston{k} Rs F{axis.upper()} [N]" for k, axis in names],
                           [(f"Rs_{k}_{axis}2_N", 1) for k, axis in names], shift_deg=72)
        self.new(file, "--accept")
        self.assertRegex(self.description(), r"offset_deg = 72")
        self.regress(DONE)


class RefusalTest(ImportTest):
    def refused_file(self, text, *words):
        file = self.folder / "record.csv"
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
        error = self.new(file, status=BAD_INPUT).err
        self.assertEqual(error.count("\n"), 1, error)
        self.assert_mentions(error, "record.csv", *words)

    def test_refusals(self):
        rows = [f"{10 * i};{i % 7},5;{i % 5},25" for i in range(36)]
        table = lambda: "\n".join(["Angle [deg];a;b", *rows]) + "\n"
        self.refused_file("", "empty")
        self.refused_file("only words\nand more\n", "no table")
        self.refused_file(b"PK\x03\x04 no archive", "zip")
        self.refused_file(b"\xd0\xcf\x11\xe0 old", ".xls")
        self.refused_file(b"# Created by Octave 7\n", "-v7")
        self.refused_file(b"MATLAB 5.0 MAT-file, cut", "MATLAB")
        rows[10] = "100;nan;1,5"
        self.refused_file(table(), ":12:", "a = ", "nan", "finite")
        rows[10] = "100;1,5"
        self.refused_file(table(), ":12:", "2 fields")
        rows[10] = "100;1.5;1,5"
        self.refused_file(table(), ":12:", "1.5")
        rows[10] = "oops"
        self.refused_file(table(), ":12:", "oops")
        rows[10] = "100;1,5;1,5"
        self.refused_file("\n".join(rows[:20]), "330 deg")


class PressureCurveTest(ImportTest):
    PLAIN = "theta_deg,pressure_bar\n0,5\n90,6\n180,100\n270,90\n"

    def curve(self, text, name="curve.csv"):
        (self.folder / name).write_bytes(text if isinstance(text, bytes) else text.encode())
        Case(**{"pressure.kind": '"curve"', "pressure.file": f'"{name}"',
                "operation.samples_per_revolution": 24}).write(self.folder / "case.toml")
        return "run", "case.toml", "--model", "analytic"

    def torque(self, text, name="curve.csv"):
        shutil.rmtree(self.folder / "out", ignore_errors=True)
        self.run_program(*self.curve(text, name), "--out", "out")
        return next((self.folder / "out").glob("*.csv")).read_text()

    def test_formats(self):
        plain = self.torque(self.PLAIN)
        self.assertEqual(plain, self.torque(self.PLAIN + "360,5\n"), "the end point comes again")
        self.assertEqual(plain, self.torque("Chamber 1\n\nPressure;Angle\n[bar];[deg]\n5;0\n6;90\n100;180\n90;270\n"))
        self.assertEqual(plain, self.torque("﻿\"theta [turn]\"\t\"p [bar]\"\r\n0\t5\r\n0,25\t6\r\n0,5\t100\r\n0,75\t90\r\n"))

    def test_refusals(self):
        for text, *words in ((self.PLAIN + "360,5.5\n", ":6:", "5.5", "periodic"),
                             (self.PLAIN + "361,5\n", ":6:", "361", "turn after the first"),
                             ("theta_deg,pressure\n0,5\n90,6\n180,7\n", "pressure", "unit"),
                             ("t [s],p [bar]\n0,5\n90,6\n180,7\n", "angle")):
            with self.subTest(text):
                self.assert_mentions(self.refused(*self.curve(text)), *words)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    base.PROGRAM, base.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
