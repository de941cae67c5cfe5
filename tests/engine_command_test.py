#!/usr/bin/env python3
"""`bentaxis compare --engine` from outside: exit statuses, lines, report.

usage: engine_command_test.py BENTAXIS REPO_ROOT MODULES [options of unittest]
"""

import json
import os
import pathlib
import sys
import unittest

import command_line_test as program
from command_line_test import BAD_INPUT, COMPUTATION_FAILED, DONE, OUT_OF_TOLERANCE, ProgramTest

FEW = ("--set", "operation.samples_per_revolution=72")
MODULES = None  # set below


class EngineTest(ProgramTest):
    def compare(self, engines, status, *more):
        environment = {**os.environ, "BENTAXIS_ENGINE_PATH": str(MODULES)}
        done = self.run_program("compare", program.REPO / "cases/bap63_rated.toml", *FEW, "--engine", engines, "--out", "out", *more,
                                status=status, env=environment)
        report = self.folder / "out/report.json"
        done.report = json.loads(report.read_text()) if report.exists() else None
        return done

    def section(self, done):
        return next(section for section in done.report["runs"] if section["title"] == "Engines")

    def test_engines_agree(self):
        modules = pathlib.Path(program.PROGRAM).parents[1] / "modules"
        missing = [name for name in ("mujoco", "dart") if not (modules / f"bentaxis_engine_{name}.so").exists()]
        done = self.compare("mujoco,dart", COMPUTATION_FAILED if missing else DONE)
        for name in missing:
            self.assertIn(f"{name}: is not installed", done.err)
        if len(missing) == 2:
            self.skipTest("neither MuJoCo nor DART is installed")
        section = self.section(done)
        self.assertIn("All engines agree. ", done.out)
        self.assertIn("curve: bap63_rated, 72 angles", done.out)
        columns = section["table"]["columns"]
        for name in {"mujoco", "dart"} - set(missing):
            self.assertRegex(done.out, rf"{name}: \w+ [\d.]+, \w+, tolerance 1e-09")
            for column in (name, f"{name}, curve"):
                digits = [row[columns.index(column)] for row in section["table"]["rows"]]
                self.assertEqual([digit for digit in digits if digit and float(digit) < 9], [])
                self.assertGreaterEqual(sum(digit != "" for digit in digits), 9)
        groups = [row[0] for row in section["table"]["rows"]]
        self.assertEqual(groups, ["Rs", "Rc", "Fh", "Th", "Rcn", "Rcs", "Rb1", "Rb2", "Td", "Tcs"])
        self.assertIn("not given: follows from Fh and Th", json.dumps(section["facts"]))

    def test_none_unless_asked_for(self):
        self.run_program("compare", program.REPO / "cases/bap63_rated.toml", *FEW, "--out", "out")
        report = json.loads((self.folder / "out/report.json").read_text())
        self.assertNotIn("Engines", [section["title"] for section in report["runs"]])

    def test_one_that_fails_ends_nothing_else(self):
        done = self.compare("crashes,old,leaves", COMPUTATION_FAILED)
        for line in ("crashes: crashed (signal 6, Aborted): about to fail", "has interface 2, this program 1",
                     "leaves: ended before it had answered (exit status 7)"):
            self.assertIn(line, done.out)
            self.assertIn(line, done.err)
        self.assertTrue(done.report["verdict"]["agrees"])
        self.assertEqual(len(self.section(done)["table"]["rows"]), 10)

    def test_one_that_differs_is_out_of_tolerance(self):
        done = self.compare("gives_zero,crashes", OUT_OF_TOLERANCE)
        self.assertIn("Wrong by the stored curve: gives_zero.", done.out)
        self.assertFalse(done.report["verdict"]["agrees"])
        self.assertTrue(done.report["verdict"]["models_agree"])

    def test_refusals(self):
        case = program.REPO / "cases/bap63_rated.toml"
        for engines in ("bulet", "mujoco,../crashes", "Mujoco"):
            with self.subTest(engines=engines):
                self.assert_mentions(self.refused("compare", case, "--engine", engines, "--out", "out"), "must be one of mujoco, dart")
        self.assert_mentions(self.refused("compare", case, "--engine", "mujoco", "--way", "integrated", "--out", "out"),
                             "--engine", "must be left out beside --way integrated")
        self.assert_mentions(self.refused("compare", program.REPO / "cases/bap63_cardan.toml", "--engine", "mujoco", "--out", "out"),
                             "--engine", "transfer of kind cardan")


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    MODULES = pathlib.Path(sys.argv[3]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
