#!/usr/bin/env python3
"""`bentaxis fig34` from outside, on a grid of a few laws.

usage: fig34_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import csv
import json
import pathlib
import sys
import unittest

import command_line_test as program
from command_line_test import BAD_INPUT, ProgramTest


class Fig34Test(ProgramTest):
    def study(self, *options, status=0):
        result = self.run_program("fig34", *options, "--dissipations", "0.5,5", "--block-inertias-kg-mm2", "1500",
                                  "--exponents", "1", "--out", "out", status=status)
        with open(self.folder / "out/fig34.csv") as file:
            self.rows = list(csv.DictReader(file))
        self.report = json.loads((self.folder / "out/fig34.json").read_text())
        return result

    def law(self, **wanted):
        (row,) = [r for r in self.rows if all(float(r[k]) == v for k, v in wanted.items())]
        return {k: float(v) for k, v in row.items() if v != ""}

    def test_laws(self):
        result = self.study("--approaches-um", "0.5", "--backlashes-um", "0,20")
        self.assertEqual({p.name for p in (self.folder / "out").iterdir()},
                         {"fig34.html", "fig34.json", "fig34.csv", "fig34_curves.csv"})
        self.assertEqual(len(self.rows), 2 * 2 * 2)  # Cc, backlash, dissipation
        self.assertEqual({r["failure"] for r in self.rows}, {""})
        # Stiff teeth without backlash are rigid ones with ripples: inside, ten changes of sign.
        tight = self.law(drag=0, backlash_um=0, dissipation_s_per_m=5)
        self.assertEqual((tight["inside_axes"], tight["reverses"]), (1, 1))
        self.assertEqual(tight["sign_changes_per_turn"], 10)
        self.assertLess(tight["least_Rcs_x2_N"], -100)
        self.assertEqual(tight["share_without_contact"], 0)
        # With backlash they rattle; with drag they do not.
        loose = self.law(drag=0, backlash_um=20, dissipation_s_per_m=0.5)
        self.assertEqual(loose["inside_axes"], 0)
        self.assertGreater(loose["share_without_contact"], 0.5)
        held = self.law(drag=1, backlash_um=20, dissipation_s_per_m=0.5)
        self.assertEqual((held["share_without_contact"], held["reverses"]), (0, 0))
        self.assertLess(abs(held["least_Rcs_x2_N"] + 268), 5)
        # The words are those of the numbers.
        both = sum(r["inside_axes"] == r["reverses"] == "1" and r["drag"] == "0" for r in self.rows)
        self.assertIn(f"Without Cc {both} of 4 contact laws stay inside", result.out)
        self.assertRegex(result.out, r"backlash 20 um: of 2 laws 2 leave the printed axes, \d (does not|do not) change the sign in every pitch")
        titles = [s["title"] for s in self.report["runs"]]
        self.assertEqual(titles, ["Expectations", "By value"])
        self.assertEqual(len(self.report["rows"]), len(self.rows))
        (rigid,) = [r for r in self.report["runs"][0]["table"]["rows"] if r[0].endswith("without Cc, 0 deg")]
        self.assertEqual(rigid[-1], "inside")
        self.check_counts()
        self.check_points()
        self.check_windows(result)
        self.check_torque_that_keeps_the_sign()

    def test_another_pressure_is_not_judged(self):
        result = self.study("--approaches-um", "0.5", "--backlashes-um", "0", "--set", "pressure.delivery_bar=200")
        self.assertEqual(self.report["verdict"]["word"], "Not applicable")
        self.assertIn("Fig. 34 does not apply to this case: it is printed for the paper's pump at 275 bar and 1500 rpm "
                      "(delivery_bar is 200, there 274 to 276).", result.out)
        for word in ("rules out", "expected", "can be what is printed", "printed curve"):
            self.assertNotIn(word, result.out)
        self.assertEqual([s["title"] for s in self.report["runs"]], ["By value"])
        self.assertEqual(len(self.rows), 4)

    def check_counts(self):
        """The table by value, from the rows of the file."""
        table = self.report["runs"][1]["table"]["rows"]
        names = {"exponent": "exponent", "approach_at_100N_um": "approach at 100 N", "backlash_um": "backlash",
                 "dissipation_s_per_m": "dissipation", "block_inertia_kg_mm2": "block inertia"}
        self.assertEqual(len(table), 2 * (1 + 1 + 2 + 2 + 1))
        for drag, value, *found in table:
            (key,) = [k for k, name in names.items() if value.startswith(name)]
            number = float(value[len(names[key]):].split()[0])
            rows = [r for r in self.rows if drag == ("with Cc" if r["drag"] == "1" else "without Cc") and float(r[key]) == number]
            self.assertEqual(found, [len(rows), sum(r["inside_axes"] == "1" for r in rows), sum(r["reverses"] == "1" for r in rows),
                                     sum(r["inside_axes"] == r["reverses"] == "1" for r in rows)])

    def check_windows(self, result):
        """Chaotic motions do not repeat: the spread between windows is stated, and limits the digits."""
        for row in self.rows:
            least, greatest = (float(row[f"largest_Rcs_x2_N_{end}_window"]) for end in ("least", "greatest"))
            first = max(-float(row["least_Rcs_x2_N"]), float(row["greatest_Rcs_x2_N"]))
            self.assertLessEqual(least, first)
            self.assertLessEqual(first, greatest)
            self.assertEqual(row["inside_axes"] == "1", greatest <= 250)
        spread = {(r["drag"], float(r["backlash_um"]), float(r["dissipation_s_per_m"])):
                  1 - float(r["largest_Rcs_x2_N_least_window"]) / float(r["largest_Rcs_x2_N_greatest_window"]) for r in self.rows}
        self.assertGreater(spread["0", 20, 0.5], 0.05)  # rattles without a period
        self.assertLess(spread["1", 20, 5], 0.01)  # carried in one direction
        chaotic = sum(value > 0.01 for (drag, *_), value in spread.items() if drag == "0")
        self.assertIn(f"The motion of {chaotic} laws does not repeat", result.out)
        wide = 0
        for row in self.report["runs"][0]["table"]["rows"]:
            if row[7] is not None and row[7] > 1 and row[1] == "N":
                wide += 1
                for value in row[5:7]:
                    self.assertEqual(float(f"{value:.1e}"), value, row)
        self.assertGreater(wide, 0)

    def check_points(self):
        """The figure of all laws, from the rows of the file."""
        (figure,) = [f for f in self.report["figures"] if f["id"] == "fig34_laws"]
        axes, *series = figure["series"]
        self.assertEqual([p["y"] for p in axes["points"]], [250, 250])
        points = [(s["name"], p) for s in series for p in s["points"]]
        self.assertEqual(len(points), len(self.rows))
        for (name, point), row in zip(points, self.rows):
            r = {k: float(v) for k, v in row.items() if v != ""}
            self.assertEqual(name, f"0.5 um at 100 N, {'with' if r['drag'] else 'without'} Cc")
            self.assertAlmostEqual(point["x"], 100 * r["share_without_contact"], 9)
            self.assertAlmostEqual(point["y"], max(-r["least_Rcs_x2_N"], r["greatest_Rcs_x2_N"]), 9)
            self.assertEqual(point["note"],
                             f"e 1, j {r['backlash_um']:g} um, c {r['dissipation_s_per_m']:g} s/m, 1500 kg mm2, "
                             + ("reverses" if r["reverses"] else "does not reverse in every pitch"))

    def check_torque_that_keeps_the_sign(self):
        """A drag of the torque that is said leaves the least force of rigid teeth at 0."""
        (torque,) = [r[5] for r in self.report["runs"][0]["table"]["rows"] if r[0].startswith("drag Cc psi'")]
        self.run_program("run", program.REPO / "cases/bap63_rated.toml", "--model", "analytic",
                         "--set", f"friction.block_viscous_Nm_per_rpm={torque / 1500!r}",
                         "--set", "operation.samples_per_revolution=7200", "--out", "dragged")
        with open(self.folder / "dragged/analytic.csv") as file:
            least = min(float(row["Rcs_z4_N"]) for row in csv.DictReader(file))
        self.assertLess(abs(least), 0.02)  # of 100 N

    def test_one_window_states_no_spread(self):
        self.study("--approaches-um", "0.5", "--backlashes-um", "20", "--windows", "1")
        for row in self.rows:
            self.assertEqual(row["largest_Rcs_x2_N_least_window"], row["largest_Rcs_x2_N_greatest_window"])

    def test_a_case_without_drag(self):
        self.study(self.case(**{"friction.block_viscous_Nm_per_rpm": 0.0}), "--approaches-um", "5", "--backlashes-um", "0", "--windows", "1")
        self.assertEqual({r["drag"] for r in self.rows}, {"0"})
        self.assertNotIn("Compliant teeth with Cc", [g["title"] for g in self.report["summary"]["groups"]])

    def test_refusals(self):
        for options, text in ((("--approaches-um", "0"), "--approaches-um"), (("--backlashes-um", "-1"), "--backlashes-um"),
                              (("--exponents", "4"), "--exponents"),
                              (("--set", "operation.speed_rpm=0"), "speed_rpm = 0")):
            result = self.run_program("fig34", *options, "--out", "refused", status=BAD_INPUT)
            self.assertIn(text, result.err)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
