#!/usr/bin/env python3
"""What earlier versions wrote is read: cases, reference folders, curves, report.json.

usage: compatibility_test.py BENTAXIS REPO_ROOT [options of unittest]      (Debian's python3, with jsonschema)
"""

import csv
import gzip
import json
import pathlib
import sys
import unittest

import jsonschema

import command_line_test as program
from command_line_test import ProgramTest


def kept():
    return program.REPO / "tests" / "compatibility"


def header(path):
    with open(path, newline="", encoding="utf-8") as file:
        return next(csv.reader(file))


class CompatibilityTest(ProgramTest):
    def versions(self):
        found = sorted(path for path in kept().iterdir() if path.is_dir())
        self.assertGreaterEqual(len(found), 2)
        return found

    def test_cases_run(self):
        for version in self.versions():
            cases = sorted((version / "cases").glob("*.toml"))
            self.assertGreaterEqual(len(cases), 4)
            for case in cases:
                with self.subTest(case=case):
                    self.run_program("run", case, "--model", "analytic", "--set", "operation.samples_per_revolution=12", "--out",
                                     self.folder / version.name / case.stem)

    def test_reference_folders_agree(self):
        for version in self.versions():
            with self.subTest(version=version.name):
                said = self.run_program("regress", version / "reference_data")
                self.assertIn("agree", said.out)

    def test_columns_are_still_there_in_their_order(self):
        old = kept() / "0.2.0" / "results"
        case = program.REPO / "cases" / "bap63_rated.toml"
        motor = program.REPO / "cases" / "bap63_motor_start.toml"
        self.run_program("compare", case, "--set", "operation.samples_per_revolution=12", "--out", self.folder / "compare")
        self.run_program("simulate", motor, "--set", "drive.samples=10", "--model", "analytic", "--out", self.folder / "simulate")
        for name, now in (("analytic.csv", "compare"), ("budget_analytic.csv", "compare"), ("simulation_analytic.csv", "simulate")):
            with self.subTest(name=name):
                was, today = header(old / name), header(self.folder / now / name)
                self.assertEqual([column for column in today if column in was], was)

    def test_reports_fit_the_schema(self):
        schema = json.loads((program.REPO / "docs" / "report.schema.json").read_text())
        validator = jsonschema.Draft202012Validator(schema)
        reports = sorted(kept().glob("*/results/*.json.gz"))
        self.assertGreaterEqual(len(reports), 3)
        for report in reports:
            with self.subTest(report=report.name):
                document = json.loads(gzip.decompress(report.read_bytes()))
                self.assertEqual([error.message for error in validator.iter_errors(document)][:3], [])

    def test_keys_of_a_report_are_still_there(self):
        # Of a comparison: every object's keys, by where it stands, lists as one place.
        def places(value, at, found):
            if isinstance(value, dict):
                for key, inner in value.items():
                    found.add(f"{at}.{key}")
                    places(inner, f"{at}.{key}", found)
            elif isinstance(value, list):
                for inner in value:
                    places(inner, at + "[]", found)
            return found

        old = json.loads(gzip.decompress((kept() / "0.2.0" / "results" / "compare.json.gz").read_bytes()))
        self.run_program("compare", program.REPO / "cases" / "bap63_rated.toml", "--set", "operation.samples_per_revolution=12",
                    "--out", self.folder)
        now = json.loads((self.folder / "report.json").read_text())
        self.assertEqual(sorted(places(old, "", set()) - places(now, "", set())), [])

    def test_a_sweep_gives_the_table_it_gave(self):
        self.run_program("sweep", program.REPO / "cases" / "bap63_rated.toml", "--vary", "pump.tilt_deg=30:40:10", "--output", "mean:Td",
                    "--out", self.folder)
        old, now = ((path / "sweep.csv").read_text().splitlines() for path in (kept() / "0.2.0" / "results", self.folder))
        self.assertEqual(old[0], now[0])
        for was, is_now in zip(old[1:], now[1:], strict=True):
            for a, b in zip(was.split(","), is_now.split(","), strict=True):
                self.assertEqual(a == "", b == "")
                self.assertAlmostEqual(float(a or 0), float(b or 0), delta=1e-9 * abs(float(a or 0)))


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
