#!/usr/bin/env python3
"""Tests of `bentaxis tradeoff` and of `--error`, from outside. Counts and ratios only: no time is judged.

usage: tradeoff_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import json
import pathlib
import sys
import unittest

import command_line_test as program
from command_line_test import BAD_INPUT, COMPUTATION_FAILED, ProgramTest

# Fixed orders of the methods. The exponent found varies with what the error control makes of a pressure with edges.
ORDERS = {"rk-merson": 4, "rk3": 3, "verlet": 2}
ORDER_TOLERANCE = 1.2


class TradeoffTest(ProgramTest):
    def tradeoff(self, *options, **changes):
        result = self.run_program("tradeoff", self.case(**changes), "--out", ".", *options)
        self.report = json.loads((self.folder / "tradeoff.json").read_text())
        return result

    def rows(self, **wanted):
        return [r for r in self.report["rows"] if all(r[k] == v for k, v in wanted.items())]

    def test_every_way_is_measured(self):
        result = self.tradeoff("--integrators", "rk-merson,rk3,verlet", "--accuracies", "1e-4,1e-5,1e-6,1e-7")
        for name in ("tradeoff.html", "tradeoff.json", "tradeoff.csv"):
            self.assertIn(name, result.out)
        for pressure in ("smooth", "step"):
            for row in self.rows(pressure=pressure, model="analytic"):
                self.assertLess(row["error_worst"], 1e-13)  # round-off
            driven = self.rows(pressure=pressure, method="driven")
            self.assertIn("full, residual", [r["variant"] for r in driven])
            for row in driven:
                self.assertLess(row["error_worst"], 1e-12, row)
            for integrator, order in ORDERS.items():
                rows = self.rows(pressure=pressure, variant=integrator)
                self.assertEqual([r["accuracy"] for r in rows], [1e-4, 1e-5, 1e-6, 1e-7])
                self.assertTrue(all(r["status"] == "done" for r in rows))
                self.assertLess(rows[-1]["error_worst"], rows[0]["error_worst"] / 10)
                for row in rows:
                    self.assertGreaterEqual(row["error_worst"], row["error_Rs"])
                    self.assertGreater(row["position_drift_m"], 0)
        self.assertIn("For 1e-4 use ", result.out)
        self.assertIn("no integrated run is accurate enough", result.out)

        # What a turn needs, not what it takes.
        (row,) = self.rows(pressure="smooth", variant="rk-merson", accuracy=1e-6)
        self.assertLess(row["evaluations"], 900)
        self.assertLess(row["steps"], 150)

    def test_the_front_is_not_beaten(self):
        self.tradeoff("--integrators", "rk-merson,rk3", "--accuracies", "1e-3,1e-5")
        for pressure in ("smooth", "step"):
            rows = self.rows(pressure=pressure, method="integrated")
            self.assertTrue(any(r["on_front"] for r in rows))
            for row in rows:
                beaten = any(o["error_worst"] <= row["error_worst"] and o["seconds_per_turn"] < row["seconds_per_turn"]
                             for o in rows)
                self.assertEqual(row["on_front"], not beaten, row)

    def test_methods_have_their_order(self):
        self.tradeoff("--integrators", "rk-merson,rk3,verlet", "--accuracies", "1e-5,1e-6,1e-7,1e-8")
        tables = [t for t in self.report["runs"] if t["title"] == "Convergence, smooth pressure"]
        found = {row[0]: row[3] for row in tables[0]["table"]["rows"]}
        for integrator, order in ORDERS.items():
            self.assertLess(abs(found[integrator] - order), ORDER_TOLERANCE, found)

    def test_what_takes_too_long_is_listed_with_its_reason(self):
        self.tradeoff("--integrators", "verlet", "--accuracies", "1e-3,1e-6", "--max-seconds-per-run", "0.0001")
        first, second = self.rows(pressure="smooth", method="integrated")
        self.assertEqual([first["status"], second["status"]], ["failed", "failed"])
        self.assertIn("stopped after", first["reason"])
        self.assertIn("not tried", second["reason"])
        self.assertIsNone(second["error_worst"])
        status = self.column("tradeoff.csv", "status")
        self.assertEqual(sum(s.startswith("failed: ") for s in status), 4)

    def test_refusals(self):
        self.assert_mentions(self.refused("tradeoff", self.case(**{"operation.speed_rpm": 0}), "--out", "o"), "speed_rpm")
        self.assert_mentions(self.refused("tradeoff", self.case(), "--integrators", "euler"), "euler")
        self.assert_mentions(self.refused("tradeoff", self.case(), "--accuracies", "0"), "accuracies")
        self.assert_mentions(self.refused("tradeoff", self.case(), "--angles", "0"), "angles")


class ErrorTest(ProgramTest):
    INTEGRATED = ("--model", "multibody", "--way", "integrated", "--out", ".")

    def test_run_meets_the_error_it_was_asked_for(self):
        case = self.case()
        for error in (1e-3, 1e-6):
            result = self.run_program("run", case, *self.INTEGRATED, "--error", error)
            self.assertRegex(result.err, r"^chosen for an error of .* at accuracy .*; verified: .*\n$")
            self.run_program("run", case, "--model", "analytic", "--out", ".")
            heading, rows = self.read_csv("multibody.csv")
            for channel in ("Rs_1_x2_N", "Rc_1_x2_N", "Rcs_z4_N", "Td_z1_Nm", "Rb1_y1_N"):
                found = [float(v) for v in self.column("multibody.csv", channel)]
                right = [float(v) for v in self.column("analytic.csv", channel)]
                # The peak of a component is at most that of its vector, so this allows for more than was asked.
                self.assertLess(max(abs(a - b) for a, b in zip(found, right)), 3 * error * max(map(abs, right)), channel)

    def test_compare_judges_by_it(self):
        result = self.run_program("compare", self.case(), "--way", "integrated", "--error", "1e-5", "--out", ".")
        self.assertIn("chosen for an error of 1e-05", result.out)
        report = json.loads((self.folder / "report.json").read_text())
        self.assertEqual(report["verdict"]["tolerance"], 1e-5)
        self.assertTrue(any(name == "chosen" for name, _ in report["runs"][0]["facts"]))

    def test_only_the_integrator_given_is_tried(self):
        result = self.run_program("run", self.case(), *self.INTEGRATED, "--error", "1e-2", "--integrator", "verlet")
        self.assertIn(": verlet at accuracy", result.err)

    def test_what_cannot_be_reached_is_a_failed_computation(self):
        line = self.refused("run", self.case(), *self.INTEGRATED, "--error", "1e-11", "--integrator", "rk-feldberg",
                            status=COMPUTATION_FAILED)
        self.assert_mentions(line, "1e-11", "closest")

    def test_refusals(self):
        self.assert_mentions(self.refused("run", self.case(), "--model", "multibody", "--error", "1e-6"), "--way integrated")
        self.assert_mentions(self.refused("run", self.case(), "--model", "analytic", "--error", "1e-6"), "--way integrated")
        self.assert_mentions(self.refused("compare", self.case(), "--error", "1e-6"), "--way integrated")
        self.refused("run", self.case(), *self.INTEGRATED, "--error", "1e-6", "--accuracy", "1e-3", status=BAD_INPUT)
        self.refused("run", self.case(), *self.INTEGRATED, "--error", "0", status=BAD_INPUT)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
