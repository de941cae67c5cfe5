#!/usr/bin/env python3
"""What `simulate` answers with as outputs of many designs: the same numbers, by every command that takes outputs.

usage: motion_outputs_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import csv
import json
import pathlib
import re
import sys
import unittest

import command_line_test as program
from command_line_test import BAD_INPUT, ProgramTest

NAMES = ["motion.reached_s", "motion.last_rpm", "motion.peak_torque_Nm", "motion.peak_torque_s", "motion.drive_work_J"]
OIL = ["motion.peak_delivery_bar", "motion.peak_delivery_s", "motion.end_delivery_bar", "motion.overshoot_bar"]
SHORT = ("--set", "drive.duration_s=0.05", "--set", "drive.samples=100", "--set", "operation.samples_per_revolution=36")


class MotionOutputsTest(ProgramTest):
    def case(self, name):
        return program.REPO / "cases" / f"{name}.toml"

    def rows(self, folder, name):
        with open(self.folder / folder / name, newline="") as file:
            return list(csv.DictReader(file))

    def stated(self, case, model):
        """What simulate says: numbers of its answers and of its curves."""
        self.run_program("simulate", case, *SHORT, "--model", model, "--out", "simulated")
        answers = " ".join(json.loads((self.folder / "simulated" / "report.json").read_text())["verdict"]["answers"])
        return answers, self.rows("simulated", f"simulation_{model}.csv")

    def swept(self, case, names, *options):
        self.run_program("sweep", case, *SHORT, "--vary", "shaft.mass_kg=2", "--output", ",".join(names), *options, "--out", "swept")
        (row,) = self.rows("swept", "sweep.csv")
        return {name: float(row[name]) for name in names}

    def held(self, case, names, model="analytic"):
        answers, curves = self.stated(case, model)
        found = self.swept(case, names, "--model", model)
        torque = [float(row["Td_z1_Nm"]) for row in curves]
        largest = max(torque, key=abs)
        # Simbody's run is the same to its last digit but one from process to process, the analytic one to the last.
        same = self.assertEqual if model == "analytic" else lambda a, b: self.assertAlmostEqual(a / b, 1, 12)
        same(found["motion.peak_torque_Nm"], largest)
        self.assertEqual(found["motion.peak_torque_s"], float(curves[torque.index(largest)]["time_s"]))
        speed = [float(row["shaft_rpm"]) for row in curves]
        same(found["motion.last_rpm"], speed[-1])
        # As the answers print them.
        self.assertIn(f"at most {largest:.4g} Nm at", answers)
        self.assertRegex(answers, rf"work of the drive(, which turns its own inertia too,)? {re.escape(format(found['motion.drive_work_J'] / 1e3, '.4g'))} kJ")
        said = re.search(r"Speed: 95 % of .* after ([\d.]+) ms", answers)
        self.assertIsNotNone(said, answers)
        self.assertAlmostEqual(1e3 * found["motion.reached_s"] / float(said.group(1)), 1, 3)
        return answers, found

    def test_a_start_without_oil(self):
        for model in ("analytic", "multibody"):
            with self.subTest(model):
                self.held(self.case("bap63_motor_start"), NAMES, model)

    def test_a_start_with_oil(self):
        case = self.case("bap63_start_up")
        answers, found = self.held(case, NAMES + OIL)
        self.assertIn(f"at most {found['motion.peak_delivery_bar']:.4g} bar at", answers)
        self.assertIn(f"{found['motion.overshoot_bar']:.3g} bar above its mean", answers)
        self.assertIn(f"{found['motion.end_delivery_bar']:.4g} bar", answers)
        pressures = [float(row["p_delivery_bar"]) for row in self.rows("simulated", "oil_analytic.csv")]
        self.assertEqual(found["motion.peak_delivery_bar"], max(pressures))

    def test_are_listed_and_refused_where_there_are_none(self):
        listed = self.run_program("outputs", self.case("bap63_start_up")).out
        for name in NAMES + OIL + ["motion.beyond_plate_percent"]:
            self.assertIn(name + " ", listed)
        without_oil = self.run_program("outputs", self.case("bap63_motor_start")).out
        self.assertIn("motion.reached_s", without_oil)
        self.assertNotIn("motion.overshoot_bar", without_oil)
        for case, name, words in (("bap63_rated", "motion.reached_s", "[drive]"), ("bap63_motor_start", "motion.overshoot_bar", "hydraulic"),
                                  ("bap63_start_up", "motion.reached_ms", "motion.reached_s")):
            result = self.run_program("sweep", self.case(case), "--vary", "shaft.mass_kg=2", "--output", name, "--out", "out", status=BAD_INPUT)
            self.assert_mentions(result.err, name, words)

    def test_sensitivity_and_optimise_take_them(self):
        case = self.case("bap63_motor_start")
        self.run_program("sensitivity", case, *SHORT, "--output", "motion.drive_work_J", "--parameter", "drive.rotor_inertia_kg_m2", "--out", "s")
        (row,) = self.rows("s", "sensitivity.csv")
        self.assertGreater(float(row["derivative"]), 0)  # a heavier rotor takes more energy to the same time
        self.run_program("optimise", case, *SHORT, "--vary", "drive.rotor_inertia_kg_m2=0.05:0.3", "--minimise", "motion.reached_s", "--subject-to",
                         "motion.drive_work_J >= 1", "--population", "8", "--generations", "0", "--restarts", "1", "--no-refinement", "--out", "o")
        rows = self.rows("o", "evaluations.csv")
        self.assertEqual(len(rows), 8)
        self.assertTrue(all(row["motion.reached_s"] for row in rows), rows)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
