#!/usr/bin/env python3
"""[gear] contact = "teeth" from outside: run, compare, simulate.

usage: teeth_command_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import csv
import json
import math
import pathlib
import sys
import unittest

import command_line_test as program
from command_line_test import BAD_INPUT, ProgramTest

FEW = ("--set", "operation.samples_per_revolution=36")


class TeethTest(ProgramTest):
    @classmethod
    def case_file(cls):
        return program.REPO / "cases" / "bap63_teeth.toml"

    def rows(self, name):
        with open(self.folder / "out" / name) as file:
            return list(csv.DictReader(file))

    def report(self):
        return json.loads((self.folder / "out/report.json").read_text())

    def test_warns_of_pairs_that_are_not_looked_at(self):
        soft = ("--set", "gear.youngs_modulus_GPa=0.5", "--set", "drive.duration_s=0.002", "--set", "drive.samples=40")
        self.run_program("simulate", self.case_file(), *soft, "--model", "analytic", "--out", "out")
        self.assertEqual([w["name"] for w in self.report()["warnings"]], ["further pairs of teeth touch"])
        self.run_program("simulate", self.case_file(), *soft[2:], "--model", "analytic", "--out", "out")
        self.assertEqual(self.report()["warnings"], [])

    def test_teeth_that_do_not_mesh_are_refused_with_their_file(self):
        for command in (("run", "--model", "multibody"), ("compare",), ("simulate",)):
            result = self.run_program(command[0], self.case_file(), *command[1:], "--set", "gear.addendum_mm=1",
                                      "--out", "out", status=BAD_INPUT)
            self.assertIn("bap63_teeth.toml: [gear] addendum_mm = 1: contact ratio", result.err)

    def test_given_states(self):
        (self.folder / "states.csv").write_text(
            "theta_deg,psi_deg,theta_rpm,psi_rpm,theta_rad_per_s2,psi_rad_per_s2\n"
            "0,0,1500,1500,0,0\n20,20,1500,1490,0,-5000\n400,400,-1500,-1500,0,0\n")
        for model in ("analytic", "multibody"):
            self.run_program("run", self.case_file(), "--model", model, "--states", "states.csv", "--out", "out")
            teeth, reactions = self.rows(f"teeth_{model}.csv"), self.rows(f"{model}.csv")
            self.assertEqual([row["theta_deg"] for row in teeth], ["0", "20", "400"])
            for row, reaction in zip(teeth, reactions):
                direction = math.copysign(1, float(reaction["theta_rpm"]))
                tooth = direction * float(reaction["Rcs_z4_N"])
                self.assertEqual(float(row["plus_force_N"]) > 0, tooth > 0)
                self.assertEqual(float(row["minus_force_N"]) > 0, tooth < 0)

    def test_compare(self):
        result = self.run_program("compare", self.case_file(), *FEW, "--out", "out")
        self.assertIn("The two models agree", result.out)
        self.assertEqual({p.name for p in (self.folder / "out").iterdir()},
                         {"report.html", "report.json", "analytic.csv", "multibody.csv", "teeth_analytic.csv",
                          "teeth_multibody.csv", "budget_analytic.csv", "budget_multibody.csv"})
        analytic, multibody = self.rows("teeth_analytic.csv"), self.rows("teeth_multibody.csv")
        self.assertEqual(analytic[0].keys(), multibody[0].keys())
        reactions = self.rows("analytic.csv")
        arm = 0.106466 / 2 * math.cos(math.radians(20))
        for teeth, row in zip(analytic, reactions):
            forces = [float(teeth[f"{flank}_{which}_force_N"]) for flank in ("plus", "minus")
                      for which in ("at", "before", "after")]
            self.assertAlmostEqual(sum(forces[:3]), float(teeth["plus_force_N"]), 9)
            self.assertAlmostEqual(float(teeth["transmission_error_um"]), arm * float(teeth["lag_urad"]), 9)
            # Flank + where the block is pushed, flank - where it is held back; never both with backlash.
            tooth = float(row["Rcs_z4_N"])
            self.assertEqual(float(teeth["plus_force_N"]) > 0, tooth > 0)
            self.assertEqual(float(teeth["minus_force_N"]) > 0, tooth < 0)
            # Beyond half the backlash of 50 um, and by no more than microns.
            self.assertTrue(25 < math.copysign(1, tooth) * float(teeth["transmission_error_um"]) < 27)
            for flank in ("plus", "minus"):
                for which in ("at", "before", "after"):
                    carries = float(teeth[f"{flank}_{which}_force_N"]) > 0
                    self.assertEqual(teeth[f"{flank}_{which}_x1_mm"] != "", carries)
        report = self.report()
        (drawing,) = [f for f in report["figures"] if f["kind"] == "drawing"]
        self.assertEqual(len(drawing["frames"]), 36)
        for frame, teeth in zip(drawing["frames"], analytic):
            carrying = sum(float(v) > 0 for k, v in teeth.items() if k.endswith("_share"))
            self.assertEqual(len(frame["arrows"]), carrying)
            self.assertEqual(frame["theta_deg"], float(teeth["theta_deg"]))
        self.assertIn("Teeth in contact", [s["title"] for s in report["runs"]])
        self.assertIn("flexibility of a slice of teeth", [line["input"] for line in report["common"]])

    def test_octoids_are_told_apart(self):
        result = self.run_program("compare", self.case_file(), *FEW, "--set", "assumptions.multibody.flank_shape=octoid",
                                  "--out", "out")
        self.assertIn("Explained", result.out)
        (row,) = self.report()["assumptions"]["rows"]
        self.assertEqual(row["name"], "flanks of the teeth")
        # Torque does not tell where the teeth touch; the pin does.
        split = {c["name"]: c for c in self.report()["channels"]}
        self.assertLess(split["Rcs_z4_N"]["max_over_peak"], 1e-10)
        self.assertGreater(split["Rcn_y2_N"]["max_over_peak"], 1e-4)

    def test_run_of_one_model(self):
        for model in ("analytic", "multibody"):
            self.run_program("run", self.case_file(), *FEW, "--model", model, "--out", "out")
            self.assertEqual(len(self.rows(f"teeth_{model}.csv")), 36)

    def test_simulate(self):
        result = self.run_program("simulate", self.case_file(), "--set", "drive.duration_s=0.002", "--set", "drive.samples=40",
                                  "--out", "out")
        self.assertIn("Both models move alike", result.out)
        rows = self.rows("teeth_analytic.csv")
        self.assertEqual(len(rows), 41)
        self.assertEqual(float(rows[0]["lag_urad"]), 0)
        self.assertGreater(max(float(r["plus_force_N"]) for r in rows), 0)

    def test_refusals(self):
        for options, text in (
                (("compare", "--set", "gear.tooth_number=5"), "[gear] addendum_mm"),
                (("compare", "--set", "gear.face_width_mm=200"), "[gear] face_width_mm = 200"),
                (("compare", "--set", "gear.dedendum_mm=1"), "no clearance"),
                (("compare", "--set", "gear.flanks=one"), "flanks"),
                (("compare", "--way", "integrated"), "contact = \"teeth\""),
                (("simulate", "--steady"), "--steady"),
                (("run", "--model", "analytic", "--set", "gear.pitch_error_file=none.csv"), "no such file")):
            result = self.run_program(options[0], self.case_file(), *options[1:], "--out", "refused", status=BAD_INPUT)
            self.assertIn(text, result.err)
            self.assertFalse((self.folder / "refused").exists())


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
