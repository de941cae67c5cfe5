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
        missing = [name for name in ("mujoco", "dart", "bullet") if not (modules / f"bentaxis_engine_{name}.so").exists()]
        done = self.compare("mujoco,dart,bullet", COMPUTATION_FAILED if missing else DONE)
        for name in missing:
            self.assertIn(f"{name}: is not installed", done.err)
        if len(missing) == 3:
            self.skipTest("no engine is installed")
        section = self.section(done)
        self.assertIn("All engines agree. ", done.out)
        self.assertIn("curve: bap63_rated, 72 angles", done.out)
        columns = section["table"]["columns"]
        for name in {"mujoco", "dart", "bullet"} - set(missing):
            self.assertRegex(done.out, rf"{name}: \w+ [\d.]+, .*; given motion, tolerance 1e-09, ")
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
        for line in ("crashes: crashed (signal 6, Aborted): about to fail", "has interface 3, this program 2",
                     "leaves: ended before it had answered (exit status 7)"):
            self.assertIn(line, done.out)
            self.assertIn(line, done.err)
        self.assertTrue(done.report["verdict"]["agrees"])
        self.assertEqual(len(self.section(done)["table"]["rows"]), 10)

    def test_one_that_differs_is_out_of_tolerance(self):
        done = self.compare("gives_zero,crashes", OUT_OF_TOLERANCE)
        self.assertIn("Wrong by the stored curve: gives_zero.", done.out)
        self.assertTrue(done.out.splitlines()[1].startswith("Engines differ: "), done.out)
        self.assertTrue(done.report["verdict"]["headline"].startswith("Engines differ: "))
        self.assertFalse(done.report["verdict"]["agrees"])
        self.assertTrue(done.report["verdict"]["models_agree"])

    def test_an_engine_that_differs_says_nothing_of_a_reference(self):
        done = self.compare("gives_zero", OUT_OF_TOLERANCE, "--with", program.REPO / "reference_data/golden/bap63_rated")
        self.assertTrue(done.report["verdict"]["reference"]["agrees"])
        self.assertNotIn("differ from", done.report["verdict"]["headline"])
        self.assertEqual(done.report["verdict"]["word"], "An engine differs")
        self.assertRegex("\n".join(done.report["verdict"]["answers"]), r"bap63_rated agrees: (\d+) of \1 reactions")

    def test_time_against_error(self):
        """Of a module that gives zeros and has no settings: one run for each number of steps."""
        done = self.compare("gives_zero", OUT_OF_TOLERANCE, "--engine-sweep")
        self.assertIn("Engines: time against error", done.out)
        section = next(s for s in done.report["runs"] if s["title"] == "Engines: time against error")
        rows = [dict(zip(section["table"]["columns"], row)) for row in section["table"]["rows"]]
        self.assertEqual([row["steps per turn"] for row in rows], [180, 360, 720, 1440, 2880, 5760])
        for row in rows:
            self.assertEqual((row["engine"], row["setting"], row["not computed"]), ("gives_zero", "defaults", ""))
            self.assertAlmostEqual(row["error Rs"], 1, delta=0.1)

    def test_integrated_has_a_tolerance_of_its_own(self):
        done = self.compare("gives_zero", OUT_OF_TOLERANCE, "--engine-way", "integrated", "--engine-steps", "144")
        self.assertIn("gives_zero: a faulty engine; integrated, 144 steps per turn, tolerance 0.01", done.out)

    def test_simbody_refuses(self):
        """A piston just short of the limit of assembly: the engines are compared with the analytic model."""
        case = program.REPO / "reference_data/hard/assembly_1e-10/case.toml"
        done = self.run_program("compare", case, "--engine", "gives_zero", "--out", "out", status=OUT_OF_TOLERANCE,
                                env={**os.environ, "BENTAXIS_ENGINE_PATH": str(MODULES)})
        report = json.loads((self.folder / "out/report.json").read_text())
        self.assertIn("Simbody refuses the case", json.dumps(report["warnings"]))
        self.assertEqual([s["title"] for s in report["runs"]], ["Engines"])
        self.assertNotIn("multibody", report["runs"][0]["table"]["columns"])
        self.assertIn("bentaxis: ", done.err)
        self.assertEqual(sorted(p.name for p in (self.folder / "out").glob("*.csv")), ["analytic.csv", "gives_zero.csv"])

    def test_refusals(self):
        case = program.REPO / "cases/bap63_rated.toml"
        for engines in ("bulet", "mujoco,../crashes", "Mujoco"):
            with self.subTest(engines=engines):
                self.assert_mentions(self.refused("compare", case, "--engine", engines, "--out", "out"), "must be one of mujoco, dart, bullet")
        self.assert_mentions(self.refused("compare", case, "--engine", "mujoco", "--way", "integrated", "--out", "out"),
                             "--engine", "must be left out beside --way integrated")
        for kind, *more in (["tapered_pistons"], ["teeth"], ["cardan", "--engine-way", "integrated"], ["rated", "--engine-way", "integrated",
                                                                                                   "--set", "operation.speed_rpm=0"]):
            with self.subTest(kind=kind):
                self.assert_mentions(self.refused("compare", program.REPO / f"cases/bap63_{kind}.toml", *FEW, "--engine", "mujoco", "--out",
                                                  "out", *more), "--engine", {"tapered_pistons": "kind pistons", "teeth": "compliant contact",
                                                                              "cardan": "kind cardan", "rated": "speed_rpm = 0"}[kind])
        for setting in ("mujoco", "mujoco.a", "dart.solver=PGS", "mujoco.=1"):
            with self.subTest(setting=setting):
                self.refused("compare", case, "--engine", "mujoco", "--engine-way", "integrated", "--engine-setting", setting, "--out", "out")
        for setting, allowed in (("solver=FOO", "one of Newton, CG, PGS"), ("impedance=2", "a number in [0.0001, 0.9999]"),
                                 ("time_constant=-1", "a number in [0.01, 1000]"), ("iterations=1.5", "an integer in [1, 100000]")):
            with self.subTest(setting=setting):
                self.assert_mentions(self.refused("compare", case, "--engine", "mujoco", "--engine-way", "integrated", "--engine-setting",
                                                  f"mujoco.{setting}", "--out", "out"), f"mujoco.{setting}: must be {allowed}")
        self.assert_mentions(self.refused("compare", case, "--engine", "mujoco,mujoco", "--out", "out"), "mujoco: is specified more than once")

    def test_options_without_effect_are_refused(self):
        case = program.REPO / "cases/bap63_rated.toml"
        for options in (["--engine-steps", "360"], ["--engine-way", "integrated"], ["--engine-sweep"], ["--engine-setting", "mujoco.solver=PGS"]):
            with self.subTest(options=options):
                self.assert_mentions(self.refused("compare", case, *options, "--out", "out"), options[0], "must have --engine NAME beside it")
        for options in (["--engine-steps", "720"], ["--engine-setting", "mujoco.solver=PGS"]):
            with self.subTest(options=options):
                self.assert_mentions(self.refused("compare", case, "--engine", "mujoco", *options, "--out", "out"), options[0], "--engine-way integrated")


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    MODULES = pathlib.Path(sys.argv[3]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
