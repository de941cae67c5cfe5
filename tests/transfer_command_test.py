#!/usr/bin/env python3
"""[transfer] from outside: key figures, columns, two transfers compared, variables of designs, refusals.

usage: transfer_command_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import json
import math
import pathlib
import re
import sys
import unittest

import command_line_test as program
from command_line_test import ProgramTest

FEW = ("--set", "operation.samples_per_revolution=72")
# Of cases/bap63_tapered_pistons_oil.toml: file, column, row of 20 within 0.01 s. Made by this program.
STORED_WITH_OIL = {
    ("simulation", "lag_deg", 10): 1.1012962,
    ("simulation", "block_rpm", 10): 1548.45498,
    ("simulation", "Rw_1_x2_N", 10): 871.50843,
    ("simulation", "Rb1_x1_N", 10): -8130.24180,
    ("simulation", "psi_deg", 20): 89.0555842,
    ("simulation", "Td_z1_Nm", 20): 225.960644,
    ("oil", "p_4_bar", 10): 274.886788,
    ("oil", "p_1_bar", 20): -0.21270612,
}


class TransferTest(ProgramTest):
    def case_of(self, name):
        return program.REPO / "cases" / f"bap63_{name}.toml"

    def figures(self, report):
        """Key figures of a report by quantity: values of the models."""
        rows = json.loads((self.folder / report / "report.json").read_text())["key_figures"]["rows"]
        return {row["quantity"]: row["values"] for row in rows}

    def test_console_says_first_what_the_block_does(self):
        said = self.run_program("run", self.case_of("cardan"), *FEW, "--model", "analytic", "--out", "joint").out
        tilt = math.radians(20)
        ripple = re.search(r"ripple ([0-9.]+) % of the mean", said)
        self.assertAlmostEqual(float(ripple[1]), 100 * (1 / math.cos(tilt) - math.cos(tilt)), delta=0.1)
        self.assertRegex(said, r"Side couple of the joint: up to [0-9.]+ Nm on the block")
        self.assertRegex(said, r"Dead centres of the pistons, by the angle psi_k of the bore: -?[0-9.]+ to")
        said = self.run_program("run", self.case_of("double_cardan"), *FEW, "--model", "analytic", "--out", "two").out
        self.assertRegex(said, r"Side force of the joint on block and shaft: up to [0-9.]+ N at")
        self.assertNotIn("ripple", said)
        said = self.run_program("run", self.case_of("tapered_pistons"), *FEW, "--model", "analytic", "--out", "walls").out
        self.assertRegex(said, r"Block: [0-9.]+ to [0-9.]+ deg behind the shaft\.")
        self.assertRegex(said, r"Walls: largest force [0-9.]+ N at [0-9.]+ deg \(piston \d\); \d+ hand-overs per turn")
        self.assertRegex(said, r"Free play of the block: [0-9.]+ to [0-9.]+ deg\.")
        said = self.run_program("run", self.case_of("rated"), *FEW, "--model", "analytic", "--out", "gear").out
        self.assertNotRegex(said, "Dead centres|Walls|Side couple|Free play")

    def test_both_models_and_commands_state_the_same_figures(self):
        for name in ("constant_velocity", "cardan", "double_cardan", "tapered_pistons"):
            with self.subTest(name):
                self.run_program("compare", self.case_of(name), *FEW, "--out", name)
                figures = self.figures(name)
                self.assertIn("inner dead centre, earliest of the pistons", figures)
                for quantity, values in figures.items():
                    self.assertEqual(len(values), 2, quantity)
                    self.assertAlmostEqual(values[0], values[1], delta=1e-6 * (1 + abs(values[0])), msg=quantity)
                self.run_program("show", self.case_of(name), *FEW, "--out", f"{name}_shown")
                for quantity, values in self.figures(f"{name}_shown").items():
                    self.assertAlmostEqual(values[0], figures[quantity][0], delta=1e-9 * (1 + abs(values[0])), msg=quantity)

    def test_displacement_is_one_number_in_all_commands(self):
        """The sum of all strokes, with a universal joint of 20 deg and an axis offset."""
        case = self.case_of("cardan")
        shown = self.start("show", case, *FEW, "--out", "shown")
        shown.out, shown.err = shown.communicate(timeout=program.SECONDS)
        said = float(re.search(r"pump: ([0-9.]+) cm3/rev", shown.err)[1])
        derived = {row["name"]: row["value"] for row in json.loads((self.folder / "shown" / "report.json").read_text())["derived"]}
        self.run_program("sweep", case, *FEW, "--vary", "transfer.phase_deg=0:90:#2", "--output", "displacement_cm3", "--out", "swept")
        swept = [float(x) for x in self.column("swept/sweep.csv", "displacement_cm3")]
        self.assertAlmostEqual(swept[0], derived["displacement"], delta=1e-9 * swept[0])
        self.assertAlmostEqual(said, derived["displacement"], delta=1e-3 * said)
        self.assertNotEqual(swept[0], swept[1])
        # By the places of B that a run has.
        self.run_program("run", case, "--set", "operation.samples_per_revolution=720", "--model", "analytic", "--out", "run")
        strokes = 0
        for k in range(1, 6):
            z = [float(x) for x in self.column("run/analytic.csv", f"zB_{k}_z2_mm")]
            strokes += max(z) - min(z)
        self.assertAlmostEqual(math.pi / 4 * 22.5**2 * strokes * 1e-3, swept[0], delta=1e-4 * swept[0])

    def test_torque_from_outside_is_a_column_of_given_states_alone(self):
        case = self.case_of("tapered_pistons")
        (self.folder / "states.csv").write_text("theta_deg,psi_deg,theta_rpm,psi_rpm,theta_rad_per_s2,psi_rad_per_s2\n10,9.5,1500,1500,0,100\n")
        self.run_program("run", case, "--model", "analytic", "--states", "states.csv", "--out", "states")
        heading, rows = self.read_csv("states/analytic.csv")
        self.assertNotEqual(rows[0][heading.index("Tb_z2_Nm")], "")
        for model in ("analytic", "multibody"):
            self.run_program("run", case, *FEW, "--model", model, "--out", "turn")
            heading, _ = self.read_csv(f"turn/{model}.csv")
            self.assertNotIn("Tb_z2_Nm", heading)
            at = heading.index("lag_deg")
            self.assertEqual(heading[at - 1:at + 2], ["psi_deg", "lag_deg", "p_1_bar"])

    def test_two_transfers_are_an_assumption(self):
        case = self.case_of("rated")
        self.run_program("compare", case, *FEW, "--multibody", "transfer=constant_velocity", "--out", "split")
        report = json.loads((self.folder / "split" / "report.json").read_text())
        self.assertEqual(report["verdict"]["word"], "Explained")
        # The same block with another law of its angle; what the pump's gear does not know has to be there.
        self.run_program("compare", case, *FEW, "--multibody", "transfer=cardan", "inertia=lumped", "--out", "cardan")
        self.run_program("compare", self.case_of("constant_velocity"), *FEW, "--analytic", "transfer=cardan", "piston_friction=off",
                         "--out", "both")
        # Two crosses beside a constant-velocity joint: what the force at O2 does.
        self.run_program("compare", self.case_of("double_cardan"), *FEW, "--multibody", "transfer=constant_velocity", "--out", "crosses")
        report = json.loads((self.folder / "crosses" / "report.json").read_text())
        self.assertEqual(report["verdict"]["word"], "Explained")
        line = self.refused("compare", case, *FEW, "--multibody", "transfer=double_cardan", "--out", "none")
        self.assert_mentions(line, "[transfer]", "cross_distance_mm")
        # A wrong parameter is no part of the assumption.
        line = self.refused("compare", case, *FEW, "--multibody", "transfer=pistons", "--out", "none")
        self.assert_mentions(line, "[transfer]", "contact_from_joint_mm")
        line = self.refused("compare", self.case_of("cardan"), *FEW, "--multibody", "transfer=gear", "--out", "none")
        self.assert_mentions(line, "[gear]")
        line = self.refused("compare", case, "--multibody", "transfer=chain", "--out", "none")
        self.assert_mentions(line, "--multibody transfer=chain", "transfer=gear|constant_velocity|cardan|pistons|double_cardan")
        line = self.refused("compare", case, "--multibody", "transfer=cardan", "--multibody-case", case, "--out", "none")
        self.assert_mentions(line, "--multibody-case", "transfer=")

    def test_transfer_is_varied_by_all_studies(self):
        walls, joint = self.case_of("tapered_pistons"), self.case_of("cardan")
        few = ("--set", "operation.samples_per_revolution=36")
        self.run_program("sweep", walls, *few, "--vary", "transfer.clearance_mm=1.5:1.7:#3", "--output", "mean:Td,max:lag_deg", "--out", "sweep")
        lags = [float(x) for x in self.column("sweep/sweep.csv", "max:lag_deg")]
        self.assertEqual(lags, sorted(lags))
        self.assertGreater(lags[2], lags[0] + 1)
        self.run_program("sensitivity", walls, *few, "--vary", "transfer.clearance_mm,transfer.stiffness_N_per_um", "--output", "mean:Td",
                         "--out", "sensitivity")
        self.assertTrue(all(math.isfinite(float(x)) for x in self.column("sensitivity/sensitivity.csv", "derivative")))
        self.assertEqual(set(self.column("sensitivity/sensitivity.csv", "found_by")), {"differences"})
        self.run_program("uncertainty", joint, *few, "--vary", "transfer.phase_deg=uniform(0, 90)", "--samples", 150, "--output",
                         "mean:Td,displacement_cm3", "--out", "uncertainty")
        self.run_program("optimise", joint, *few, "--vary", "transfer.phase_deg=0:90", "--minimise", "peak:Rb1", "--population", 8,
                         "--generations", 2, "--restarts", 1, "--comparison", "no", "--out", "optimise")
        two = self.case_of("double_cardan")
        self.run_program("sweep", two, *few, "--vary", "transfer.cross_distance_mm=10:30:#3", "--output", "max:Fcs_y2_N,mean:Td", "--out", "two")
        forces = [float(x) for x in self.column("two/sweep.csv", "max:Fcs_y2_N")]
        self.assertAlmostEqual(forces[0] / forces[2], 3, 9)
        self.run_program("sensitivity", two, *few, "--vary", "transfer.cross_distance_mm,transfer.phase_deg", "--output",
                         "peak:Rcn,peak:Fcs", "--check-derivatives", "--out", "by_distance")
        self.assertEqual(self.column("by_distance/sensitivity.csv", "found_by"), ["exact"] * 2 + ["differences"] * 2)
        # A design that cannot be is one line, the others go on.
        self.run_program("sweep", walls, *few, "--vary", "transfer.kind=gear,pistons", "--output", "mean:Td", "--out", "kinds")
        reasons = self.column("kinds/sweep.csv", "reason")
        self.assertIn("[gear]", reasons[0])
        self.assertEqual(reasons[1], "")

    def test_pistons_with_oil_in_time(self):
        """The shipped case: both models agree, its motion is the stored one, and the FMU is that pump."""
        case = self.case_of("tapered_pistons_oil")
        short = ("--set", "drive.duration_s=0.01", "--set", "drive.samples=20")
        said = self.run_program("simulate", case, *short, "--out", "oil").out
        self.assertIn("The trajectories agree", said)
        self.assertTrue((self.folder / "oil/oil_multibody.csv").exists())
        for model in ("analytic", "multibody"):
            for (file, column, row), stored in STORED_WITH_OIL.items():
                found = float(self.column(f"oil/{file}_{model}.csv", column)[row])
                self.assertAlmostEqual(found, stored, delta=1e-5 * abs(stored), msg=f"{model} {column}")
        self.run_program("fmu", case, *short, "--out", "pump.fmu")
        self.assertTrue((self.folder / "pump.fmu").exists())

    def test_lives_of_every_transfer(self):
        """Both models agree on the lives under a duty cycle, and a map of lives has those of its points."""
        case = program.REPO / "cases/studies/four_transfers.toml"
        (self.folder / "duty.csv").write_text("share,speed_rpm,pressure.delivery_bar\n3,1500,275\n1,1000,150\n")
        few = ("--set", "operation.samples_per_revolution=36")
        kinds = ("gear", "constant_velocity", "cardan", "pistons")
        lives = {}
        for kind in kinds:
            with self.subTest(kind):
                chosen = (*few, "--set", f"transfer.kind={kind}")
                said = self.run_program("life", case, *chosen, "--duty", "duty.csv", "--out", f"life_{kind}").out
                self.assertIn("The loads by both models agree", said)
                self.run_program("sweep", case, *chosen, "--vary", "operation.speed_rpm=1000,1500", "--vary",
                                 "pressure.delivery_bar=150,275", "--output", "life.system_h,life.tapered_h", "--out", f"map_{kind}")
                heading, rows = self.read_csv(f"map_{kind}/sweep.csv")
                of = {}
                for row in rows:
                    at = dict(zip(heading, row))
                    of[float(at["operation.speed_rpm"]), float(at["pressure.delivery_bar"])] = (
                        float(at["life.system_h"]), float(at["life.tapered_h"]))
                # The cycle uses up what its points do.
                report = json.loads((self.folder / f"life_{kind}/life.json").read_text())
                table = next(s for s in report["runs"] if s["title"] == "Bearings")["table"]
                tapered = table["rows"][0][table["columns"].index("L10h, h")]
                self.assertAlmostEqual(tapered * (0.75 / of[1500, 275][1] + 0.25 / of[1000, 150][1]), 1, 9)
                self.assertLess(of[1500, 275][0], of[1000, 275][0])
                self.assertLess(of[1500, 275][0], of[1500, 150][0])
                lives[kind] = of[1500, 275][0]
        # Pressure loads the bearings, the transfer hardly does (tutorial 7), and no two are the same.
        self.assertLess(max(lives.values()) / min(lives.values()), 1.05)
        self.assertEqual(len(set(lives.values())), len(kinds))

    def test_trajectories_of_every_transfer_are_compared(self):
        """A pump without a gear has an empty column Rcs_z4_N: no reason to compare nothing."""
        for name in ("constant_velocity", "cardan", "double_cardan", "tapered_pistons"):
            with self.subTest(name):
                case = self.folder / f"{name}.toml"
                case.write_text(self.case_of(name).read_text() + "\n[drive]\nkind = \"speed\"\nduration_s = 0.01\nsamples = 20\n")
                said = self.run_program("simulate", case, "--set", "block.axial_inertia_kg_mm2=2000", "--out", name).out
                self.assertIn("The trajectories agree", said)
                groups = json.loads((self.folder / name / "report.json").read_text())
                self.assertTrue(groups["verdict"]["agrees"])

    def test_rattle_of_pistons(self):
        walls = self.case_of("tapered_pistons")
        said = self.run_program("rattle", walls, "--set", "block.axial_inertia_kg_mm2=2000", "--speeds", "500,1500", "--delivery-bar", "150",
                                "--check-points", 2, "--threads", 1, "--out", "rattle").out
        self.assertRegex(said, r"avoid|the pistons are loaded throughout")
        self.assertIn("Simbody agrees at 2 of 2 points", said)
        self.assertNotIn("each sweep has one start", said)
        one = self.run_program("rattle", walls, "--speeds", "1500", "--delivery-bar", "275", "--out", "one").out
        self.assertIn("With one speed each sweep has one start", one)
        page = (self.folder / "rattle/report.html").read_text()
        self.assertIn("sum of the wall forces", page)
        self.assertNotIn("tooth force", page)
        line = self.refused("rattle", self.case_of("cardan"), "--speeds", "500", "--delivery-bar", "150", "--out", "none")
        self.assert_mentions(line, "[transfer] kind", "a joint has no play")

    def test_what_pistons_do_not_have_is_refused(self):
        walls = self.case_of("tapered_pistons")
        line = self.refused("run", walls, "--model", "multibody", "--way", "integrated", "--out", "none")
        self.assert_mentions(line, "pistons")
        (self.folder / "plays.csv").write_text("piston,deviation_um\n1,20\n3,0\n2,-15\n4,5\n5,0\n6,0\n7,-1\n")
        own = ("--set", f'transfer.clearance_deviation_file="{self.folder / "plays.csv"}"')
        self.run_program("compare", walls, *FEW, *own, "--out", "own")
        inputs = json.loads((self.folder / "own/report.json").read_text())
        self.assertIn("plays.csv", json.dumps(inputs["inputs"] if "inputs" in inputs else inputs))
        self.run_program("simulate", walls, *own, "--set", "drive.kind=speed", "--set", "drive.duration_s=0.005", "--set", "drive.samples=10",
                         "--set", "block.axial_inertia_kg_mm2=2000", "--out", "moving")
        line = self.refused("simulate", self.case_of("tapered_pistons_oil"), "--set",
                            f'transfer.clearance_deviation_file="{self.folder / "plays.csv"}"', "--steady", "--out", "none")
        self.assert_mentions(line, "--steady", "clearance_deviation_file")
        line = self.refused("simulate", self.case_of("rated_hydraulic"), "--set", "transfer.kind=cardan", "--set", "pump.tilt_deg=20", "--set",
                            "pump.bore_circle_radius_mm=24.17", "--set", "drive.kind=speed", "--set", "drive.duration_s=0.01", "--set",
                            "drive.samples=10", "--steady", "--out", "none")
        self.assert_mentions(line, "--steady", 'kind = "cardan"')
        line = self.refused("rattle", walls, *own, "--set", "block.axial_inertia_kg_mm2=2000", "--speeds", "500", "--delivery-bar", "150",
                            "--out", "none")
        self.assert_mentions(line, "clearance_deviation_file", "rattle")
        (self.folder / "plays.csv").write_text("piston,deviation_um\n1,20\n2,0\n2,-15\n4,5\n5,0\n6,0\n7,-1\n")
        line = self.refused("run", walls, *FEW, *own, "--model", "analytic", "--out", "none")
        self.assert_mentions(line, "plays.csv:4", "piston = 2")
        line = self.refused("run", self.case_of("rated_hydraulic"), "--model", "analytic", "--set", "transfer.kind=cardan", "--out", "none")
        self.assert_mentions(line, "[pressure] kind", "cardan")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
