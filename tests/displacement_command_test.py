#!/usr/bin/env python3
"""`bentaxis pressure --derived-displacement` from outside: every method computed again from the file, answers, refusals, failed points.

usage: displacement_command_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import csv
import json
import pathlib
import sys
import unittest

import command_line_test as program
from command_line_test import BAD_INPUT, COMPUTATION_FAILED, ProgramTest

FAST = ("--set", "operation.samples_per_revolution=36")
# Leakage of half the chambers takes all that the pump displaces: at 150 rpm between 20 and 60 bar.
LEAK = ("--set", "hydraulics.leakage_l_per_min_per_bar=0.15", "--set", "pressure.delivery_bar=100")
TEST = ("--derived-displacement", "--test-speeds", "500:1500:#3", "--test-pressures", "25:275:#4")


def line_through(points):
    """Value at 0 and slope of the least-squares line."""
    mean_x, mean_y = (sum(column) / len(points) for column in zip(*points))
    slope = sum((x - mean_x) * (y - mean_y) for x, y in points) / sum((x - mean_x) ** 2 for x, _ in points)
    return mean_y - slope * mean_x, slope


def derived(points):
    """cm3 by each method from (rpm, delivery bar, difference bar, l/min)."""
    speeds = sorted({p[0] for p in points})
    at_zero = {n: line_through([(p[2], p[3]) for p in points if p[0] == n])[0] for n in speeds}
    slopes = []
    for bar in sorted({p[1] for p in points}):
        here = [p for p in points if p[1] == bar]
        slopes.append((sum(p[2] for p in here) / len(here), line_through([(p[0], p[3]) for p in here])[1]))
    nn, pp, np = (sum(p[i] * p[k] for p in points) for i, k in ((0, 0), (2, 2), (0, 2)))
    qn, qp = (sum(p[3] * p[i] for p in points) for i in (0, 2))
    litres = {"ISO 8426": at_zero[speeds[-1]] / speeds[-1], "Toet": line_through(slopes)[0],
              "Wilson": (qn * pp - qp * np) / (nn * pp - np * np),
              "zero-pressure line": sum(n * q for n, q in at_zero.items()) / sum(n * n for n in speeds)}
    return {name: 1000 * value for name, value in litres.items()}


class DisplacementTest(ProgramTest):
    def case(self, name="bap63_rated_timed_plate"):
        return program.REPO / "cases" / f"{name}.toml"

    def report(self):
        return json.loads((self.folder / "out" / "pressure.json").read_text())

    def section(self, title):
        return next(s for s in self.report()["runs"] if s["title"] == title)

    def rows(self):
        with open(self.folder / "out" / "derived_displacement.csv", newline="") as file:
            return list(csv.DictReader(file))

    def test_every_method_is_what_the_points_say(self):
        result = self.run_program("pressure", self.case(), *FAST, *TEST, "--out", "out")
        rows = self.rows()
        self.assertEqual([r["speed_rpm"] for r in rows], [n for n in ("500", "1000", "1500") for _ in range(4)])
        for r, bar in zip(rows, 3 * [25, 325 / 3, 575 / 3, 275]):
            self.assertAlmostEqual(float(r["delivery_bar"]), bar, 9)
        section = self.section("Derived displacement")
        geometric = next(d["value"] for d in self.report()["derived"] if d["name"] == "displacement")
        table = {(row[0], row[1]): row for row in section["table"]["rows"]}
        self.assertEqual(len(table), 8)
        for meter, column in (("at delivery pressure", "flow_at_delivery_l_per_min"), ("at suction pressure", "flow_l_per_min")):
            points = [tuple(float(r[k]) for k in ("speed_rpm", "delivery_bar", "pressure_difference_bar", column)) for r in rows]
            for method, volume in derived(points).items():
                row = table[method, meter]
                self.assertAlmostEqual(row[2] / volume, 1, 9, (method, meter))
                efficiencies = [100 * p[3] * 1000 / p[0] / volume for p in points]
                self.assertEqual(row[4], sum(e > 100.0001 for e in efficiencies))
                self.assertAlmostEqual(row[5], max(efficiencies), 6)
                highest = points[efficiencies.index(max(efficiencies))]
                self.assertAlmostEqual(row[6], highest[0], 6)
                self.assertAlmostEqual(row[7], highest[1], 6)
        # The bias is against the displacement that the report states.
        self.assertIn("cm3", dict(section["facts"])["geometric displacement"])
        stated = float(dict(section["facts"])["geometric displacement"].split()[0])
        self.assertAlmostEqual(stated / geometric, 1, 4)
        for row in table.values():
            self.assertAlmostEqual(row[3], 100 * (row[2] / stated - 1), 3)
        # Efficiencies of every point, and the answers on console and page.
        points = self.section("Volumetric efficiency by derived displacement")["table"]
        self.assertEqual(len(points["rows"]), len(rows))
        for shown, row in zip(points["rows"], rows):
            self.assertAlmostEqual(shown[4], float(row["efficiency_iso_8426_percent"]), 9)
        answers = self.report()["verdict"]["answers"]
        lines = result.out.splitlines()
        for answer in answers:
            self.assertIn(answer, lines)
        self.assertLess(lines.index(answers[-1]), 6)
        self.assertRegex(answers[-2], r"^Derived displacement, flow at delivery pressure: ISO 8426 [\d.]+ cm3 \(-\d\.\d\d %\), Toet ")
        self.assertEqual({f["id"] for f in self.report()["figures"]} & {"displacement_flow", "displacement_bias"},
                         {"displacement_flow", "displacement_bias"})

    def test_where_an_efficiency_exceeds_100_percent_is_said(self):
        self.run_program("pressure", self.case(), *FAST, "--derived-displacement", "--out", "out")
        rows = self.rows()
        self.assertEqual(len(rows), 30)
        above = [r for r in rows if float(r["efficiency_wilson_percent"]) > 100.0001]
        self.assertGreater(len(above), 0)
        answer = self.report()["verdict"]["answers"][-1]
        self.assertIn(f"by Wilson at {len(above)} of 30 points", answer)
        # Of both readings of the flow, as the table counts them.
        table = self.section("Derived displacement")["table"]
        counted = [(row[0], row[1], next(row[i] for i, column in enumerate(table["columns"]) if "points above" in column)) for row in table["rows"]]
        for method, meter, count in counted:
            other = "" if meter == counted[0][1] else f", flow {meter}"
            self.assertEqual(f"by {method}{other} at {count} of 30 points" in answer, bool(count), (method, meter, count, answer))
        facts = dict(self.section("Derived displacement")["facts"])
        places = facts["above 100 % by Wilson, at delivery pressure"]
        for row in above:
            self.assertIn(f"{float(row['speed_rpm']):g} rpm at ", places)
            self.assertIn(f"{float(row['delivery_bar']):g}", places)
        self.assertFalse([r for r in rows if float(r["efficiency_geometric_percent"]) > 100])

    def test_a_motor_runs_backwards_and_speeds_stay_positive(self):
        out = self.run_program("pressure", self.case("bap63_motoring"), *FAST, *TEST, "--out", "out").out
        # Of a motor the flow that it takes is the larger one.
        self.assertRegex(out, r"Takes 10\d\.\d l/min \(at suction density\) at .*: volumetric efficiency as a motor 9\d\.\d+ %")
        rows = self.rows()
        self.assertTrue(all(float(r["speed_rpm"]) > 0 and float(r["flow_l_per_min"]) > 0 for r in rows))
        volume = derived([tuple(float(r[k]) for k in ("speed_rpm", "delivery_bar", "pressure_difference_bar",
                                                      "flow_at_delivery_l_per_min")) for r in rows])["Wilson"]
        for row in rows:
            used = float(row["flow_at_delivery_l_per_min"]) * 1000 / float(row["speed_rpm"])
            self.assertAlmostEqual(float(row["efficiency_wilson_percent"]), 100 * volume / used, 6)

    def test_failed_points_are_left_out_and_named(self):
        result = self.run_program("pressure", self.case("bap63_rated_hydraulic"), *FAST, *LEAK, "--derived-displacement", "--test-speeds",
                                  "150:1500:#2", "--test-pressures", "20:100:#3", "--out", "out", status=COMPUTATION_FAILED)
        rows = self.rows()
        failed = [r for r in rows if r["reason"]]
        self.assertEqual((len(rows), len(failed)), (6, 2))
        for row in failed:
            self.assertIn("speed_rpm = 150", row["reason"])
            self.assertEqual({v for k, v in row.items() if k != "reason"}, {""})
        self.assertIn("2 of 6 points could not be computed", result.err)
        # Toet's lines lack the second speed at two of three pressures.
        table = {(row[0], row[1]): row for row in self.section("Derived displacement")["table"]["rows"]}
        self.assertIsNone(table["Toet", "at delivery pressure"][2])
        self.assertIn("not determined: ", result.out)
        self.assertIsNotNone(table["ISO 8426", "at delivery pressure"][2])

    def test_refusals(self):
        case = self.case()
        for options, words in ((["--test-speeds", "500:1500:500"], "--derived-displacement"),
                               (["--derived-displacement", "--test-pressures", "100"], "two pressures"),
                               (["--derived-displacement", "--test-pressures", "-5:100:#3"], "--test-pressures"),
                               (["--derived-displacement", "--test-speeds", "0:1500:#3"], "--test-speeds"),
                               (["--derived-displacement", "--test-speeds", "fast"], "--test-speeds")):
            with self.subTest(options=options):
                self.assert_mentions(self.refused("pressure", case, *options, "--out", "out", status=BAD_INPUT), words)
                self.assertFalse((self.folder / "out").exists())
        given = ("--set", "load.kind=orifice", "--set", "load.area_mm2=20")
        self.assert_mentions(self.refused("pressure", case, *given, "--derived-displacement", "--out", "out"), "[load]")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
