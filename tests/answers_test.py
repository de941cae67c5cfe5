#!/usr/bin/env python3
"""Answers: what a study is asked is said first, on the console and in the report alike, and is what its files hold.

usage: answers_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import csv
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAM = REPO = None  # set in main


class AnswersTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="bentaxis_test_")))

    def answers(self, *arguments, report="report.json"):
        """Those of the report, which the console has too, after the name of the case and the headline."""
        result = subprocess.run([PROGRAM, *map(str, arguments), "--out", "out"], cwd=self.folder, capture_output=True,
                                text=True, timeout=300)
        self.assertIn(result.returncode, (0, 1), result.stderr)
        verdict = json.loads((self.folder / "out" / report).read_text())["verdict"]
        lines = result.stdout.splitlines()[:12]
        for answer in verdict["answers"]:
            # uncertainty says more of each output on the console
            self.assertTrue(any(line.startswith(answer[:60]) for line in lines), (answer, lines))
        return verdict["answers"]

    def verdict(self):
        return json.loads((self.folder / "out" / "report.json").read_text())["verdict"]

    def rows(self, name):
        with open(self.folder / "out" / name, newline="") as file:
            return list(csv.DictReader(file))

    def case(self, name):
        return REPO / "cases" / f"{name}.toml"

    def test_sensitivity(self):
        (answer,) = self.answers("sensitivity", self.case("bap63_rated"), "--output", "peak:Rb1", report="sensitivity.json")
        rows = {row["parameter"]: row["elasticity"] for row in self.rows("sensitivity.csv")}
        named = re.findall(r"([+-][\d.e-]+) % (?:per % )?of ([\w.]+)", answer)
        self.assertGreaterEqual(len(named), 2)
        sizes = [abs(float(share)) for share, _ in named]
        self.assertEqual(sizes, sorted(sizes, reverse=True))
        for share, parameter in named:
            self.assertAlmostEqual(float(share), float(rows[parameter]), delta=5e-3 * abs(float(share)))
        largest = max((abs(float(value)), name) for name, value in rows.items() if value)
        self.assertEqual(largest[1], named[0][1])

    def test_sweep(self):
        sweep = ["sweep", self.case("bap63_rated"), "--set", "operation.samples_per_revolution=36", "--vary",
                 "pump.tilt_deg=20:40:10", "--vary", "pressure.delivery_bar=50:350:#3", "--output", "max:Rb1_z1,mean:Td"]
        answers = self.answers(*sweep)
        for answer, output in zip(answers, ("max:Rb1_z1_N", "mean:Td")):
            values = [float(row[next(name for name in row if name.startswith(output))]) for row in self.rows("sweep.csv")]
            low, where, high, there = re.search(
                r"lowest ([\d.]+) Nm? \(design (\d+), .*; highest ([\d.]+) Nm? \(design (\d+), ", answer).groups()
            self.assertAlmostEqual(float(low), min(values), delta=1e-3 * min(values))
            self.assertAlmostEqual(float(high), max(values), delta=1e-3 * max(values))
            self.assertEqual([int(where), int(there)], [values.index(min(values)), values.index(max(values))])
        answers = self.answers(*sweep, "--minimise", "max:Rb1_z1", "--maximise", "displacement_cm3")
        self.assertRegex(answers[-1], r"^Trade-off: [1-9] designs of 9 ")
        self.assertTrue(any(answer.startswith("max:Rb1_z1_N: best, lowest ") for answer in answers))
        self.assertTrue(any(answer.startswith("displacement_cm3: best, highest ") for answer in answers))

    def test_uncertainty(self):
        (answer,) = self.answers("uncertainty", self.case("bap63_rated"), "--set", "operation.samples_per_revolution=36",
                                 "--output", "mean:Td", "--vary", "pump.tilt_deg=normal(40,0.1)", "--vary",
                                 "pressure.delivery_bar=uniform(270,280)", "--samples", "200")
        shares = dict(re.findall(r"([\w.]+) ([\d.]+) %(?:[,.]|$)", answer.split("of its variance ")[1]))
        self.assertEqual(list(shares), ["pressure.delivery_bar", "pump.tilt_deg"])
        self.assertAlmostEqual(sum(map(float, shares.values())), 100, delta=1)

    def test_life(self):
        answers = self.answers("life", self.case("bap63_bearing_life"), "--set", "operation.samples_per_revolution=60",
                               "--duty", REPO / "cases" / "curves" / "duty_cycle.csv", report="life.json")
        self.assertRegex(answers[0], r"^The tapered bearing sets the life \(\d+ h; both together \d+ h\)\.$")
        self.assertRegex(answers[1], r"^Most of its life is consumed by row 2: .*: 44\.\d % of its life in 30 % of the time\.$")

    def test_rattle(self):
        answers = self.answers("rattle", self.case("bap63_tooth_rattle"), "--speeds", "300:900:#2", "--delivery-bar",
                               "10:350:#2", "--turns", "6", "--discard", "3")
        self.assertRegex(answers[0], r"^At 350 bar, .* the case's 275 bar: avoid 300 to 900 rpm: ")

    def test_start_up(self):
        answers = self.answers("simulate", self.case("bap63_start_up"), "--model", "analytic", "--set",
                               "drive.duration_s=0.2", "--set", "drive.samples=100")
        rows = self.rows("simulation_analytic.csv")
        # Over the last fifth of a turn, of five pistons: by the time that it takes.
        end = float(rows[-1]["theta_deg"])
        points = [(float(row["theta_deg"]), float(row["time_s"])) for row in rows]
        a, b = next((a, b) for a, b in zip(points[-2::-1], points[::-1]) if end - a[0] >= 72)
        start = a[1] + (end - 72 - a[0]) / (b[0] - a[0]) * (b[1] - a[1])
        last = 72 / 6 / (float(rows[-1]["time_s"]) - start)
        speed, after = map(float, re.search(r"95 % of ([\d.]+) rpm after ([\d.]+) ms", answers[0]).groups())
        self.assertAlmostEqual(speed, last, delta=0.1)
        before = max(float(row["time_s"]) for row in rows if float(row["shaft_rpm"]) < 0.95 * last)  # for good
        self.assertTrue(before <= after / 1e3 <= before + 0.002 + 1e-6, (before, after))
        torque = max((abs(float(row["Td_z1_Nm"])) for row in rows))
        self.assertAlmostEqual(float(re.search(r"at most ([\d.]+) Nm", answers[1])[1]), torque, delta=1e-3 * torque)
        self.held_to_limits(answers, {
            "Fh <= 0": lambda row: float(row["Fh_z2_N"]) > 0,
            "<= r4": lambda row: math.hypot(float(row["xh_x2_mm"]), float(row["yh_y2_mm"])) > 27,
            "Rcs >= 0": lambda row: float(row["Rcs_z4_N"]) < 0,
            "Rb1_z1 >= 0": lambda row: float(row["Rb1_z1_N"]) < 0,
            "its power is not positive": lambda row: float(row["Td_z1_Nm"]) * float(row["shaft_rpm"]) < 0})

    def held_to_limits(self, answers, beyond):
        """Every limit that rows violate is named with their share, and no other; any of them together are the verdict's."""
        rows = self.rows("simulation_analytic.csv")
        share = lambda violated: f"{100 * sum(map(violated, rows)) / len(rows):.3g}"  # noqa: E731
        said = {}
        for answer in answers:
            if answer.startswith("Not valid"):
                percent, limit = re.match(r"Not valid in ([\d.]+) % of the rows, where this does not hold: (.*) \(worst \S+ \S+ at [\d.]+ ms\)\.$", answer).groups()
                said[limit] = percent
        report = json.loads((self.folder / "out" / "report.json").read_text())
        violated = {limit["limit"]: f"{limit['share_percent']:.3g}" for limit in report["validity"] if limit["violated"]}
        self.assertEqual(said, violated)
        for words, row_is_beyond in beyond.items():
            (named,) = [limit["limit"] for limit in report["validity"] if words in limit["limit"]] or [None]
            if named:
                self.assertEqual(said.get(named, "0"), share(row_is_beyond), named)
        self.assertTrue(said)
        self.assertEqual(report["verdict"]["not_valid"], f"in {share(lambda row: any(of(row) for of in beyond.values()))} % of the rows")

    def test_pressure(self):
        answers = self.answers("pressure", self.case("bap63_rated_hydraulic"), "--set", "operation.samples_per_revolution=60",
                               report="pressure.json")
        self.assertRegex(answers[0], r"^Delivers 90\.5\d l/min \(at suction density\) at a mean of 275 bar and 1500 rpm: volumetric efficiency 94\.7")
        report = json.loads((self.folder / "out" / "pressure.json").read_text())
        flagged = [row for row in report["timing"] if row["flagged"]]
        limited = [row for row in report["timing"] if row["limit"] is not None]
        self.assertEqual([row["code"] for row in report["timing"] if row not in limited], ["connected-area"])
        self.assertTrue(answers[1].startswith(f"Port timing: {len(flagged)} of {len(limited)} quantities with a limit do not keep it: "))

    def test_turn(self):
        """compare, show and run say the same of the same turn, and it is what the curves hold."""
        small = ("--set", "operation.samples_per_revolution=36")
        answers = self.answers("compare", self.case("bap63_rated"), *small)
        rows = self.rows("analytic.csv")
        torque = [float(row["Td_z1_Nm"]) for row in rows]
        mean, least, greatest = map(float, re.search(
            r"^Drive torque: mean ([\d.]+) Nm, from ([\d.]+) to ([\d.]+) Nm\.$", answers[0]).groups())
        self.assertAlmostEqual(mean, sum(torque) / len(torque), delta=1e-3 * mean)
        self.assertAlmostEqual(least, min(torque), delta=1e-3 * mean)
        self.assertAlmostEqual(greatest, max(torque), delta=1e-3 * mean)
        value, at = map(float, re.search(r"Rb1 ([\d.]+) kN at ([\d.]+) deg", answers[1]).groups())
        size = [sum(float(v) ** 2 for k, v in row.items() if k.startswith("Rb1_")) ** 0.5 for row in rows]
        self.assertAlmostEqual(1e3 * value, max(size), delta=1e-3 * max(size))
        self.assertAlmostEqual(size[round(at / 10)], max(size), delta=1e-6 * max(size))
        self.assertEqual(self.answers("show", self.case("bap63_rated"), *small), answers)
        for model in ("analytic", "multibody"):
            done = subprocess.run([PROGRAM, "run", self.case("bap63_rated"), "--model", model, *small, "--out", "run"],
                                  cwd=self.folder, capture_output=True, text=True, timeout=300)
            self.assertEqual(done.stdout.splitlines()[1:-1], answers)

    def share_beyond(self):
        """Angles at which any limit is violated, from the curves; percent."""
        rows = self.rows("analytic.csv")
        return 100 / len(rows) * sum(
            float(row["Fh_z2_N"]) > 0 or math.hypot(float(row["xh_x2_mm"] or 0), float(row["yh_y2_mm"] or 0)) > 26
            or float(row["Rcs_z4_N"]) < 0 or float(row["Rb1_z1_N"]) < 0 for row in rows)

    def test_turn_of_a_smaller_scene(self):
        """What one model alone has computed has agreed with nothing."""
        small = ("--set", "operation.samples_per_revolution=36")
        answers = self.answers("compare", self.case("bap63_rated"), "--scene", "piston", *small)
        self.assertTrue(all(answer.startswith("By the analytic model alone: ") for answer in answers[:2]), answers)
        self.assertRegex(self.verdict()["headline"], r"^The two models agree on what both computed: Rs, Rc, .*\. Largest difference ")
        self.assertNotIn("Rb1", self.verdict()["headline"])
        self.assertEqual(self.verdict()["word"], "Agrees in part")
        whole = self.answers("compare", self.case("bap63_rated"), *small)
        self.assertEqual([answer.removeprefix("By the analytic model alone: ") for answer in answers[:2]], whole[:2])
        self.assertRegex(self.verdict()["headline"], r"^The two models agree\. Largest difference ")
        self.assertNotIn("word", self.verdict())

    def test_turn_beyond_two_limits_at_different_angles(self):
        self.answers("compare", self.case("bap63_rated"), "--set", "operation.speed_rpm=0", "--set", "operation.samples_per_revolution=72",
                     "--set", "block.bottom_area_mm2=140")
        limits = json.loads((self.folder / "out" / "report.json").read_text())["validity"]
        shares = [limit["share_percent"] for limit in limits if limit["violated"]]
        self.assertGreater(self.share_beyond(), max(shares) + 1, limits)
        self.assertEqual(self.verdict()["not_valid"], f"over {self.share_beyond():.3g} % of the turn")

    def test_turn_beyond_a_limit(self):
        # Not enough spring to hold the block on its plate without pressure: the film would have to pull.
        unloaded = ("--set", "pressure.delivery_bar=1", "--set", "block.spring_force_N=0", "--set",
                    "operation.samples_per_revolution=72")
        answers = self.answers("compare", self.case("bap63_rated"), *unloaded)
        limits = json.loads((self.folder / "out" / "report.json").read_text())["validity"]
        violated = [limit for limit in limits if limit["violated"]]
        self.assertGreaterEqual(len(violated), 1)
        said = [answer for answer in answers if answer.startswith("Not valid over ")]
        self.assertEqual(len(said), len(violated))
        for answer, limit in zip(said, violated):
            share = float(re.match(r"Not valid over ([\d.e+-]+) % of the turn", answer)[1])
            self.assertAlmostEqual(share, limit["share_percent"], delta=0.01 * limit["share_percent"])
            self.assertIn(limit["limit"], answer)
        self.assertEqual(self.verdict()["not_valid"], f"over {self.share_beyond():.3g} % of the turn")
        self.answers("compare", self.case("bap63_rated"), "--set", "operation.samples_per_revolution=72")
        self.assertNotIn("not_valid", self.verdict())
        done = subprocess.run([PROGRAM, "run", self.case("bap63_rated"), "--model", "analytic", *unloaded, "--out", "run"],
                              cwd=self.folder, capture_output=True, text=True, timeout=300)
        for answer in said:
            self.assertIn(answer, done.stdout.splitlines())

    def test_references(self):
        """What differs is said first, the worst before the others; what agrees says how near it is to its limit."""
        for name, change in (("good", ()), ("bad", ("--set", "piston.mass_kg=0.0918")), ("worse", ("--set", "pump.tilt_deg=41"))):
            made = subprocess.run([PROGRAM, "reference", "golden", self.case("bap63_rated"), "--angles", "36", *change, "--out",
                                   f"data/{name}"], cwd=self.folder, capture_output=True, text=True, timeout=300)
            self.assertEqual(made.returncode, 0, made.stderr)
            for file in (self.folder / "data" / name).rglob("case.toml"):  # the pump as it should be
                file.write_text(file.read_text().replace("mass_kg = 0.0918", "mass_kg = 0.09").replace(
                    "tilt_deg = 41\n", "tilt_deg = 40\n").replace("tilt_deg = 41.0", "tilt_deg = 40"))
        done = subprocess.run([PROGRAM, "regress", "data", "--json", "regress.json"], cwd=self.folder, capture_output=True,
                              text=True, timeout=300)
        self.assertEqual(done.returncode, 1, done.stderr)
        verdict = json.loads((self.folder / "regress.json").read_text())["verdict"]
        self.assertEqual(done.stdout.splitlines()[0], verdict["headline"])
        self.assertEqual(done.stdout.splitlines()[1:5], verdict["answers"])
        starts = [re.match(r"\S*(bad|worse)\S*(?: differs)?: ", answer)[0] for answer in verdict["answers"]]
        self.assertEqual(["differs" in start for start in starts], [True, False, True, False])
        self.assertTrue("worse" in starts[0] and "bad" in starts[2], starts)
        self.assertIn("piston.mass_kg 0.09 -> 0.0918", verdict["answers"][3])
        done = subprocess.run([PROGRAM, "regress", "data/good"], cwd=self.folder, capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout.splitlines()[1], r"^Nearest to its limit: ")

    def test_one_model_is_not_two(self):
        self.answers("simulate", self.case("bap63_start_up"), "--model", "analytic", "--set", "drive.duration_s=0.02", "--set",
                     "drive.samples=20")
        page = (self.folder / "out" / "report.html").read_text()
        self.assertNotIn("Two derivations", page)
        self.assertIn("One model's motion", page)

    def test_inertia(self):
        answers = self.answers("inertia", self.case("bap63_rated"), "--set", "operation.samples_per_revolution=36", "--speeds",
                               "1500", "--map-size", "2", report="inertia.json")
        errors = [row for row in self.rows("inertia_errors.csv")]
        self.assertRegex(answers[0], r"^Two masses change the joint force Rs of a piston by up to [\d.]+ N without load at 1500 rpm")
        self.assertRegex(answers[-1], r"^Smallest error at 1500 rpm: .*, [\d.e+-]+ N in Rs and [\d.e+-]+ N in Rc\.$")
        self.assertTrue(errors)

    def test_hard_cases(self):
        answers = self.answers("hardcases", "--filter", "bearings", report="hardcases.json")
        rows = self.rows("hardcases.csv")
        for answer in answers:
            model, digits, group, case = re.match(r"Fewest digits by (\w+): ([\d.]+) of (\w+) in (\w+) ", answer).groups()
            known = [row for row in rows if row["model"] == model and row["digits"]]
            self.assertEqual(float(digits), min(float(row["digits"]) for row in known))
            self.assertTrue(any(row["case"] == case and row["group"] == group for row in known))

    def test_trade_off(self):
        answers = self.answers("tradeoff", self.case("bap63_rated"), "--accuracies", "1e-2,1e-4", "--max-seconds-per-run", "2",
                               "--samples", "8", report="tradeoff.json")
        times = [(float(row["seconds_per_turn"]), row) for row in self.rows("tradeoff.csv")
                 if row["seconds_per_turn"] and row["method"] != "integrated"]
        self.assertIn(" pressure: fastest of all is " + min(times, key=lambda t: t[0])[1]["model"], answers[0])

    def test_index(self):
        self.answers("compare", self.case("bap63_rated"), "--set", "operation.samples_per_revolution=36")
        self.folder.joinpath("out").rename(self.folder / "good")
        self.answers("compare", self.case("bap63_rated"), "--set", "operation.samples_per_revolution=36", "--tolerance", "1e-17")
        done = subprocess.run([PROGRAM, "index", "."], cwd=self.folder, capture_output=True, text=True, timeout=300)
        headline = json.loads((self.folder / "index.json").read_text())["headline"]
        self.assertEqual(done.stdout.splitlines()[0], headline)
        self.assertIn(headline, (self.folder / "index.html").read_text())
        self.assertRegex(headline, r"^2 reports, 1 differ.*\. Worst: .*\(out/report\.html\): ")


if __name__ == "__main__":
    PROGRAM, REPO = sys.argv[1], pathlib.Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
