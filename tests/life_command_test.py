#!/usr/bin/env python3
"""Tests of `bentaxis life` from outside: files, duty cycles, what is refused.

usage: life_command_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import csv
import json
import pathlib
import re
import sys
import unittest

import command_line_test as program
from command_line_test import OUT_OF_TOLERANCE, ProgramTest

FILES = {"life.html", "life.json", "life.csv", "life_loads.csv"}
IDEAL = ("--set", "pressure.kind=ideal", "--set", "operation.samples_per_revolution=72")


class LifeTest(ProgramTest):
    def life(self, *options, out="out", case=None):
        return ("life", case or program.REPO / "cases" / "bap63_bearing_life.toml", *IDEAL, "--out", out, *options)

    def duty(self, text):
        (self.folder / "duty.csv").write_text(text)
        return "--duty", "duty.csv"

    def rows(self, name, out="out"):
        with open(self.folder / out / name, newline="") as file:
            return list(csv.DictReader(file))

    def hours(self, out="out"):
        """L10h of both bearings and of both together, from the report."""
        report = json.loads((self.folder / out / "life.json").read_text())
        section = {s["title"]: s for s in report["runs"]}["Bearings"]
        column = section["table"]["columns"].index("L10h, h")
        return [row[column] for row in section["table"]["rows"]], report

    def test_files_and_numbers_of_the_case_itself(self):
        result = self.run_program(*self.life())
        self.assertEqual({path.name for path in (self.folder / "out").iterdir()}, FILES)
        (tapered, cylindrical), report = self.hours()
        self.assertTrue(report["verdict"]["agrees"])
        self.assertIn("The loads by both models agree", result.out)
        # From the loads it wrote, by the definition.
        loads = [row for row in self.rows("life_loads.csv") if row["model"] == "multibody"]
        self.assertEqual(len(loads), 72)
        for column, rating, life in (("tapered_P_N", 105000, tapered), ("cylindrical_P_N", 106000, cylindrical)):
            used = sum((float(row[column]) / rating) ** (10 / 3) for row in loads) / len(loads)
            self.assertAlmostEqual(life * used * 60 * 1500 / 1e6, 1, 9)
        for row in loads:
            fr, fa = float(row["tapered_Fr_N"]), float(row["tapered_Fa_N"])
            self.assertAlmostEqual(float(row["tapered_P_N"]), fr if fa <= 0.83 * fr else 0.4 * fr + 0.73 * fa, 6)

    def test_shares_are_in_proportion_however_large(self):
        """Their sum, and shares times speeds, would leave the range of numbers."""
        said = []
        for out, shares in (("a.out", (3, 1, 2)), ("b.out", (1.5e308, 5e307, 1e308))):
            said.append(self.run_program(*self.life(*self.duty("share,speed_rpm\n" + "".join(
                f"{share},{speed}\n" for share, speed in zip(shares, (1500, 500, 2000)))), out=out)).out.replace(out, "out"))
            self.assertIn(f"{(3 * 1500 + 500 + 2 * 2000) / 6:.4g} rpm on average", said[-1])
        self.assertEqual(*said)
        self.assertEqual(self.rows("life.csv", "a.out")[0].keys(), self.rows("life.csv", "b.out")[0].keys())
        for small, large in zip(self.rows("life.csv", "a.out"), self.rows("life.csv", "b.out")):
            self.assertEqual((small.pop("reason"), large.pop("reason")), ("", ""))
            for name, value in small.items():
                self.assertAlmostEqual(float(large[name]) / float(value), 1, 12, name)

    def test_a_duty_cycle_uses_up_what_its_rows_do(self):
        self.run_program(*self.life(*self.duty("share,speed_rpm,pressure.delivery_bar\n3,1500,275\n1,2000,120\n")))
        both, _ = self.hours()
        used = [0, 0]
        for share, speed, bar in ((0.75, 1500, 275), (0.25, 2000, 120)):
            out = f"row_{speed}"
            self.run_program(*self.life("--set", f"operation.speed_rpm={speed}", "--set", f"pressure.delivery_bar={bar}", out=out))
            for i, hours in enumerate(self.hours(out)[0]):
                used[i] += share / hours
        for i in range(2):
            self.assertAlmostEqual(both[i] * used[i], 1, 9)
        rows = self.rows("life.csv")
        self.assertEqual([row["operation.speed_rpm"] for row in rows], ["1500", "2000"])
        self.assertAlmostEqual(sum(float(row["tapered_life_share"]) for row in rows), 1, 12)
        self.assertAlmostEqual(float(rows[1]["revolution_share"]), 500 / (500 + 1125), 12)

    def test_loads_carry_the_name_of_their_model(self):
        unequal = ("--set", "assumptions.analytic.inertia=real", "--set", "assumptions.multibody.inertia=lumped")
        self.run_program(*self.life(*unequal), status=OUT_OF_TOLERANCE)
        report = json.loads((self.folder / "out" / "life.json").read_text())
        table = {s["title"]: s for s in report["runs"]}["Bearings"]["table"]
        tapered = dict(zip(table["columns"], table["rows"][0]))
        self.assertGreater(abs(tapered["P_m, N"] / tapered["P_m by Simbody, N"] - 1), 1e-6)
        for model, column in (("analytic", "P_m, N"), ("multibody", "P_m by Simbody, N")):
            loads = [float(row["tapered_P_N"]) for row in self.rows("life_loads.csv") if row["model"] == model]
            mean = (sum(load ** (10 / 3) for load in loads) / len(loads)) ** 0.3
            self.assertAlmostEqual(tapered[column], mean, delta=1e-9 * mean)

    def test_what_is_not_valid_is_said_in_report_and_index(self):
        out = self.run_program(*self.life()).out
        said = re.search(r"Not valid (over [\d.]+ % of the revolutions)", out).group(1)
        report = json.loads((self.folder / "out" / "life.json").read_text())
        self.assertEqual(report["verdict"]["not_valid"], said)
        self.assertIn("1 report, 1 agree; 1 not valid throughout", self.run_program("index", "out").out)
        self.assertIn("not valid " + said, (self.folder / "out" / "index.html").read_text())

    def test_a_file_of_another_kind_is_no_list_of_parameters(self):
        """A curve of the pressure: what it lacks is the share, and no parameter is proposed."""
        line = self.refused(*self.life(*self.duty("theta_deg,pressure_bar\n0,1\n")))
        self.assertNotIn("no such parameter", line)
        self.assertLess(len(line), 300)

    def test_the_missing_rating_alone_is_named(self):
        text = (program.REPO / "cases" / "bap63_bearing_life.toml").read_text()
        for missing in (["tapered_dynamic_rating_kN"], ["cylindrical_static_rating_kN"], ["tapered_Y", "cylindrical_dynamic_rating_kN"]):
            (self.folder / "case.toml").write_text(
                "".join(line + "\n" for line in text.splitlines() if line.split(" ")[0] not in missing))
            line = self.refused(*self.life(case="case.toml"))
            self.assertIn(f"case.toml: [bearings] {', '.join(missing)}: {'is' if len(missing) == 1 else 'are'} missing, and must be given", line)

    def test_at_rest_every_angle_counts(self):
        out = self.run_program(*self.life("--set", "operation.speed_rpm=0")).out
        shares = [float(share) for share in re.findall(r"exceeded over ([\d.]+) % of the angles", out)]
        self.assertTrue(shares)
        self.assertTrue(all(0 < share < 100 for share in shares), out)

    def test_the_report_says_what_the_files_say(self):
        result = self.run_program(*self.life(*self.duty("share,speed_rpm,pressure.delivery_bar\n3,1500,275\n1,2000,120\n")))
        report = json.loads((self.folder / "out" / "life.json").read_text())
        sections = {s["title"]: s for s in report["runs"]}
        tables = {name: [dict(zip(s["table"]["columns"], row)) for row in s["table"]["rows"]] for name, s in sections.items()}
        rows, bearings = self.rows("life.csv"), tables["Bearings"]
        said = result.out.splitlines()
        lives = []
        for name, bearing in zip(("tapered", "cylindrical"), bearings, strict=True):
            # Mean load and life of the rows by the definition, exponent 10/3, by shares of revolutions.
            mean = sum(float(r["revolution_share"]) * float(r[f"{name}_P_N"]) ** (10 / 3) for r in rows) ** 0.3
            self.assertAlmostEqual(bearing["P_m, N"], mean, delta=1e-9 * mean)
            self.assertAlmostEqual(bearing["P_m by Simbody, N"], mean, delta=1e-9 * mean)
            self.assertAlmostEqual(bearing["C / P_m"], bearing["C, N"] / mean, 9)
            life = (bearing["C, N"] / mean) ** (10 / 3)
            self.assertAlmostEqual(bearing["L10, million revolutions"], life, delta=1e-9 * life)
            self.assertAlmostEqual(bearing["L10h, h"], life * 1e6 / 60 / 1625, delta=1e-9 * bearing["L10h, h"])
            worst = max(float(r["tapered_P0_N" if name == "tapered" else "cylindrical_P_N"]) for r in self.rows("life_loads.csv"))
            self.assertAlmostEqual(bearing["static safety C0 / P0"], bearing["C0, N"] / worst, delta=1e-9)
            lives.append(life)
            line = next(text for text in said if text.startswith(f"{name} ("))
            for word, number in zip(line.split()[-6:], (105 if name == "tapered" else 106, bearing["C0, N"] / 1e3, mean / 1e3, life,
                                                        bearing["L10h, h"], bearing["static safety C0 / P0"]), strict=True):
                self.assertAlmostEqual(float(word), number, delta=1e-3 * number)
        # Both together, by the exponent of roller bearings, 9/8.
        both = sum(life ** (-9 / 8) for life in lives) ** (-8 / 9)
        facts = dict(sections["Bearings"]["facts"])
        self.assertAlmostEqual(float(facts["both together, million revolutions"]), both, delta=3e-3 * both)
        self.assertAlmostEqual(float(facts["both together"].split()[0]), both * 1e6 / 60 / 1625, delta=3e-3 * both * 1e6 / 60 / 1625)
        self.assertEqual(facts["mean speed"], "1625 rpm")
        for row, stored in zip(tables["Duty cycle"], rows, strict=True):
            for column, key, factor in (("time, %", "time_share", 100), ("revolutions, %", "revolution_share", 100),
                                        ("tapered P_m, N", "tapered_P_N", 1), ("tapered life, %", "tapered_life_share", 100),
                                        ("cylindrical P_m, N", "cylindrical_P_N", 1), ("cylindrical life, %", "cylindrical_life_share", 100)):
                self.assertAlmostEqual(row[column], factor * float(stored[key]), delta=1e-12 * abs(row[column]))
            self.assertEqual(row["operation.speed_rpm, rpm"], stored["operation.speed_rpm"])
            words = next(text for text in said if text.endswith(f"row {row['row']}: speed_rpm {stored['operation.speed_rpm']}, "
                                                                f"delivery_bar {stored['pressure.delivery_bar']}")).split()
            for word, column in zip(words, ("time, %", "revolutions, %", "tapered life, %", "cylindrical life, %")):
                self.assertAlmostEqual(float(word), row[column], delta=6e-3 * row[column])

    def test_standstill_wears_nothing(self):
        result = self.run_program(*self.life("--set", "operation.speed_rpm=0"))
        self.assertIn("no rating life", result.out)
        self.assertEqual(self.hours()[0], [None, None])

    def test_what_is_refused(self):
        for text, *words in (("speed_rpm\n1500\n", "duty.csv", "share"),
                             ("theta_deg,pressure_bar\n0,1\n", "duty.csv:1: columns theta_deg, pressure_bar: the column \"share\" is missing"), ("share,speed_rpm\n1,1500\n0,1500\n", "duty.csv:3", "share = 0"),
                             ("share,tilt_deg\n1,95\n", "duty.csv:2", "tilt_deg = 95", "[0, 90)"), ("share,kind\n1,0\n", "several tables"),
                             ("share,speed_rpm,operation.speed_rpm\n1,1,2\n", "duty.csv:1", "operation.speed_rpm", "duplicate column"), ("share,share\n1,1\n", "duty.csv:1", "duplicate column"),
                             ("share\n", "no row"), ("share,backlash_um\n1,2\n", "backlash_um")):
            with self.subTest(text):
                (self.folder / "duty.csv").write_text(text)
                self.assert_mentions(self.refused(*self.life("--duty", "duty.csv")), *words)
        self.assert_mentions(self.refused(*self.life("--duty", "nowhere.csv")), "nowhere.csv: cannot be read: no such file")
        rated = program.REPO / "cases" / "bap63_rated.toml"
        self.assert_mentions(self.refused("life", rated), "tapered_dynamic_rating_kN", "bearings")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
