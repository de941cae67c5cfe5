#!/usr/bin/env python3
"""Tests of `bentaxis identify` from outside: files, refusals, what is written.

usage: identify_command_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import csv
import json
import math
import os
import pathlib
import pty
import re
import select
import signal
import subprocess
import sys
import time
import unittest

import command_line_test as program
from command_line_test import BAD_INPUT, OUT_OF_TOLERANCE, ProgramTest

DATA = """schema = 1
[[condition]]
name = "low"
set = ["pressure.delivery_bar=100"]
[[unknown]]
parameter = "pump.bore_diameter_mm"
between = [20, 25]
[[number]]
output = "mean:Td"
value = 292.5
uncertainty = 1
[[number]]
output = "mean:Td"
value = 120
uncertainty = 1
condition = "low"
use = "predicted"
[[window]]
output = "max:Rs_z2"
below = 12000
uncertainty = 50
"""


BETWEEN = """schema = 1
[[condition]]
name = "low"
set = ["operation.speed_rpm=1000", "pressure.delivery_bar=95"]
[[unknown]]
parameter = "friction.shaft_torque_factor"
between = [0.9, 1]
[[unknown]]
parameter = "friction.piston_coulomb_N"
between = [20, HIGH]
[[unknown]]
parameter = "pressure.delivery_bar"
condition = "low"
between = [90, 110]
[[number]]
output = "mean:Td"
value = 520
uncertainty = 0.5
[[number]]
output = "mean:Td"
value = 180
uncertainty = 0.5
condition = "low"
[[number]]
output = "peak:Rb1"
value = 17400
uncertainty = 40
condition = "low"
[[number]]
output = "displacement_cm3"
value = 100.5
uncertainty = 0.2
"""


class IdentifyTest(ProgramTest):
    def case(self):
        return program.REPO / "cases" / "bap63_rated.toml"

    def write(self, text, name="data.toml"):
        (self.folder / name).write_text(text)
        return name

    def identify(self, text, *options, **others):
        return self.run_program("identify", self.case(), "--set", "operation.samples_per_revolution=60", "--data",
                                self.write(text), "--starts", 1, "--out", "out",
                                *(() if "--fit-only" in options else ("--steps", 20, "--draws", 10)), *options, **others)

    def test_a_long_fit_says_how_far_it_is_and_can_be_interrupted(self):
        """Of oil a single fit takes a minute: it says so from its first evaluations on, and ends at once."""
        case = program.REPO / "cases" / "studies" / "nine_pistons.toml"
        terminal, stderr = pty.openpty()
        self.addCleanup(os.close, terminal)
        process = subprocess.Popen([program.PROGRAM, "identify", case, "--data", self.write(DATA), "--out", "out"],
                                   cwd=self.folder, stdout=subprocess.DEVNULL, stderr=stderr)
        os.close(stderr)
        self.addCleanup(process.kill)
        said, until = "", time.monotonic() + program.SECONDS
        while not re.search(r"fit +[1-9]\d* %, [^\r]* left", said) and time.monotonic() < until:
            if select.select([terminal], [], [], 1)[0]:
                said += os.read(terminal, 4096).decode()
        self.assertIsNone(process.poll(), said)
        self.assertRegex(said, r"fit +[1-9]\d* %, [^\r]* left")
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(20), program.INTERRUPTED)
        self.assertFalse((self.folder / "out" / "report.html").exists())

    def test_files_and_tables(self):
        result = self.identify(DATA)
        self.assertIn("1 of 1 predicted data are outside their 95 % bands", result.out)
        self.assertEqual({path.name for path in (self.folder / "out").iterdir()},
                         {"report.html", "report.json", "identified.toml", "unknowns.csv", "bands.csv"})
        report = json.loads((self.folder / "out" / "report.json").read_text())
        tables = {run["title"]: run["table"]["rows"] for run in report["runs"]}
        self.assertEqual(len(tables["Data that unknowns are fitted to"]), 2)
        [predicted] = tables["Data that are predicted"]
        self.assertEqual(predicted[-1], "no")  # the pump fitted to 292.5 Nm takes about 114 Nm at 100 bar, not 120
        with open(self.folder / "out" / "unknowns.csv", newline="") as file:
            [row] = csv.DictReader(file)
        self.assertEqual(row["unknown"], "pump.bore_diameter_mm")
        self.assertLess(float(row["profile_low"]), float(row["identified"]))
        # The case's bore, 22.5 mm, gives 292.5 Nm; 1 Nm is 0.04 mm.
        self.assertAlmostEqual(float(row["identified"]), 22.5, delta=0.05)

    def test_what_a_bound_costs_counts_what_the_other_unknowns_make_up_for(self):
        """By how much chi-square would fall is how much it falls with a wider range: here all but what no unknown can change."""
        case = program.REPO / "cases" / "studies" / "nine_pistons.toml"
        chi_square = {}
        for high in (60, 120):
            # An unknown of a condition stands for the setting of that condition.
            (self.folder / "data.toml").write_text(BETWEEN.replace("HIGH", str(high)))
            out = self.run_program("identify", case, "--set", "pressure.kind=ideal", "--data", "data.toml", "--fit-only", "--out", "out").out
            chi_square[high] = float(re.search(r"chi-square ([\d.]+)", out)[1])
            if high == 60:
                self.assertIn("friction.piston_coulomb_N ends at the upper bound 60", out)
                promised = float(re.search(r"fall by about ([\d.]+) there", out)[1])
        self.assertNotIn("bound 120", out)
        self.assertGreater(promised, 5)
        self.assertAlmostEqual(promised, chi_square[60] - chi_square[120], delta=0.02 * promised)

    def test_an_unknown_at_its_bound_is_not_called_undetermined(self):
        """The data want a bore of 22.5 mm, which the range leaves out: by how much chi-square would fall is the square of the residual."""
        data = DATA.replace("[20, 25]", "[20, 22.4]")
        for options in (["--fit-only"], []):
            out = self.identify(data, *options).out
            report = json.loads((self.folder / "out" / "report.json").read_text())
            ends = "pump.bore_diameter_mm ends at the upper bound 22.4 of its range 20 to 22.4"
            self.assertIn(ends + ": the value that the data want lies outside of it, or the bound is wrong", out)
            self.assertIn("pump.bore_diameter_mm = 22.4 mm, its upper bound (case: 22.5", out)
            self.assertIn(ends, report["verdict"]["headline"])
            self.assertNotIn("do not determine", out)
            self.assertNotIn("standard deviation", out)
            self.assertNotRegex(out, r"reactions are known (to|roughly)")
            self.assertNotIn("most useful further measurement", out)
            self.assertIn("# " + ends, (self.folder / "out" / "identified.toml").read_text())
            self.assertIn("Unknown at its bound", [w["name"] for w in report["warnings"]])
            tables = {run["title"]: [dict(zip(run["table"]["columns"], row)) for row in run["table"]["rows"]] for run in report["runs"]}
            self.assertEqual([row["ends at"] for row in tables["Unknowns"]], ["its upper bound"])
            gain = float(re.search(r"fall by about ([\d.]+) there", out).group(1))
            self.assertAlmostEqual(gain, tables["Data that unknowns are fitted to"][0]["residual"] ** 2, delta=0.02 * gain)
        self.assertIn("how well reactions are known is not stated", out)
        # Within its range nothing of it is said.
        self.assertNotIn("bound", self.identify(DATA, "--fit-only").out.replace("half as wide as the bounds", ""))

    def test_curves_are_counted_with_their_points(self):
        """As the degrees of freedom are."""
        self.run_program("run", self.case(), "--set", "operation.samples_per_revolution=60", "--model", "analytic", "--out", "rig")
        curve = '[[curve]]\nfile = "rig/analytic.csv"\nchannels = ["Td_z1_Nm", "Rb1_x1_N"]\nuncertainty = 1\n'
        head = DATA[:DATA.index("[[number]]")]
        out = self.identify(head + curve, "--fit-only").out
        self.assertIn("119 degrees of freedom", out)
        self.assertIn("data they are fitted to: 2 curves with 120 points;", out)
        self.assertIn("data they are fitted to: 4, of which 2 curves with 120 points;", self.identify(DATA + curve, "--fit-only").out)

    def test_the_report_says_what_the_files_say(self):
        result = self.identify(DATA)
        report = json.loads((self.folder / "out" / "report.json").read_text())
        tables = {run["title"]: [dict(zip(run["table"]["columns"], row)) for row in run["table"]["rows"]] for run in report["runs"]}
        with open(self.folder / "out" / "unknowns.csv", newline="") as file:
            [row] = csv.DictReader(file)
        [said] = tables["Unknowns"]
        for column, key in (("identified", "identified"), ("linear", "linear_deviation"), ("profile from", "profile_low"),
                            ("profile to", "profile_high"), ("2.5 % from", "q025"), ("97.5 % to", "q975")):
            self.assertEqual(said[column], float(row[key]), column)
        self.assertEqual((said["unknown"], said["unit"], said["bounds"]), ("pump.bore_diameter_mm", "mm", "20 to 25"))
        share = (float(row["q975"]) - float(row["q025"])) / 5
        self.assertGreater(said["share of bounds left"], 0)
        self.assertLessEqual(said["share of bounds left"], 1.1 * share)
        # One unknown, one number: torque goes with the bore's area, 1 Nm of 292.5 is half of 1/292.5 of the bore, and the
        # bounds, 5 mm over the root of 12, count as a prior.
        alone = 22.5 / (2 * 292.5)
        spread = 5 / math.sqrt(12)
        self.assertAlmostEqual(said["linear"], 1 / math.hypot(1 / alone, 1 / spread), delta=0.06 * alone)
        [direction] = tables["What the data determine"]
        self.assertAlmostEqual(direction["times narrower than the bounds"], spread / said["linear"], delta=1e-6 * spread / said["linear"])
        self.assertEqual(direction["mostly along"], "+1.00 pump.bore_diameter_mm")
        number, window = tables["Data that unknowns are fitted to"]
        self.assertEqual((number["given"], number["model"], window["given"], window["residual"]),
                         ("292.5 +- 1", "292.5", "below 12000", 0))
        self.assertLess(abs(number["residual"]), 1e-6)
        # Without the number the window alone is left: the whole width of the bounds.
        self.assertAlmostEqual(number["+-"], spread / alone, delta=0.08 * spread / alone)
        with open(self.folder / "out" / "bands.csv", newline="") as file:
            bands = list(csv.DictReader(file))
        widths = {}
        for known in tables["Uncertainty of each reaction"]:
            name = known["reaction"]
            low, middle, high = ([float(b[f"{name}_{q}"]) for b in bands] for q in ("q025", "q500", "q975"))
            peak = max(abs(v) for v in middle)
            width = max(h - l for l, h in zip(low, high)) / 2
            widths[name] = known["half width, % of peak"]
            self.assertAlmostEqual(widths[name], 100 * width / peak, delta=1e-9 * widths[name], msg=name)
        least, most = min(widths, key=widths.get), max(widths, key=widths.get)
        self.assertIn(f"{widths[least]:.2g} % ({least}) .. {widths[most]:.2g} % ({most}) of peak", result.out)
        self.assertRegex(result.out, rf"pump\.bore_diameter_mm = {float(row['identified']):.6g} mm")
        best = tables["Most useful further measurements"]
        # What every rig measures first, what none does last; of each kind the most useful first.
        kinds = ["the torque meter of a test rig measures it", "force sensors in the seats of the shaft's bearings measure it",
                 "no test rig measures it"]
        ranks = [(kinds.index(m["on a test rig"]), -m["all bands narrower by, %"]) for m in best]
        self.assertEqual(ranks, sorted(ranks))
        self.assertEqual({m["measurement"].split(":")[1].split("_")[0] for m in best if m["on a test rig"] == kinds[0]}, {"Td"})
        self.assertIn(f"The most useful further measurement is {best[0]['measurement']}: {kinds[0]}. It would narrow", result.out)

    def test_the_identified_pump_is_a_case_that_runs(self):
        self.identify(DATA, "--fit-only")
        self.run_program("run", "out/identified.toml", "--model", "analytic", "--out", "run")
        self.assertIn("identified", (self.folder / "out" / "identified.toml").read_text())

    def test_a_record_of_the_case_itself_gives_its_values_back(self):
        self.run_program("run", self.case(), "--set", "operation.samples_per_revolution=60", "--model", "analytic", "--channels", "Rs_1_z2_N", "--out", "rig")
        text = DATA.split("[[number]]")[0] + '[[curve]]\nfile = "rig/analytic.csv"\nrelative_uncertainty = 0.01\n'
        self.identify(text, "--fit-only", "--set", "pump.bore_diameter_mm=21")
        with open(self.folder / "out" / "unknowns.csv", newline="") as file:
            [row] = csv.DictReader(file)
        self.assertAlmostEqual(float(row["identified"]), 22.5, delta=1e-4)

    # Mean torques at six operating points of the pump with 120 N of piston friction, fitted with the 25 N of the case.
    REFUTED = """schema = 1
[[unknown]]
parameter = "pump.axis_offset_mm"
between = [0, 1]
[[unknown]]
parameter = "pump.tilt_deg"
between = [38, 42]
"""

    def rig(self, coulomb, uncertainty=0.4):
        text = self.REFUTED
        for speed in (1000, 2000):
            for bar in (100, 200, 300):
                settings = [f"operation.speed_rpm={speed}", f"pressure.delivery_bar={bar}"]
                changes = [*settings, f"friction.piston_coulomb_N={coulomb}", "operation.samples_per_revolution=60"]
                self.run_program("run", self.case(), *(word for change in changes for word in ("--set", change)), "--model",
                                 "analytic", "--channels", "Td", "--out", "rig")
                with open(self.folder / "rig" / "analytic.csv", newline="") as file:
                    torques = [float(row["Td_z1_Nm"]) for row in csv.DictReader(file)]
                # Noise of half the uncertainty, the same whatever the friction.
                noise = 0.5 * uncertainty * math.cos(speed * bar)
                text += (f'[[condition]]\nname = "{speed} rpm, {bar} bar"\nset = {json.dumps(settings)}\n[[number]]\n'
                         f'output = "mean:Td"\nvalue = {sum(torques) / len(torques) + noise}\nuncertainty = {uncertainty}\n'
                         f'condition = "{speed} rpm, {bar} bar"\n')
        return text

    def test_a_refuted_fit(self):
        result = self.identify(self.rig(120), status=OUT_OF_TOLERANCE)
        self.assertRegex(result.out, r"(?m)^the model does not fit the data: chi-square [\d.]+ with 5 degrees of freedom, p ")
        self.assertRegex(result.out, r"largest residuals:\n  mean:Td \(\d000 rpm, \d00 bar\): -\d+\.\d sigma \(data ")
        self.assertRegex(result.out, r"improve the fit most: friction\.piston_coulomb_N \(1[12]\d\.?\d* N instead of 25\)")
        self.assertIn("withheld", result.out)
        for claim in ("known to", "most useful further measurement"):
            self.assertNotIn(claim, result.out)
        self.assertEqual({path.name for path in (self.folder / "out").iterdir()},
                         {"report.html", "report.json", "identified.toml", "unknowns.csv"})
        report = json.loads((self.folder / "out" / "report.json").read_text())
        self.assertIs(report["verdict"]["agrees"], False)
        self.assertEqual(report["verdict"]["word"], "Refuted")
        fit = report["verdict"]["fit"]
        self.assertTrue(fit["refuted"])
        # Six data less the tilt: of the offset they say nothing.
        self.assertEqual(fit["degrees_of_freedom"], 5)
        half = fit["chi_square"] / 2
        p = math.erfc(math.sqrt(half)) + math.sqrt(4 * half / math.pi) * math.exp(-half) * (1 + 2 * half / 3)
        self.assertGreater(p, 0)
        self.assertAlmostEqual(fit["p_value"], p, delta=1e-9 * p)
        tables = {run["title"]: [dict(zip(run["table"]["columns"], row)) for row in run["table"]["rows"]] for run in report["runs"]}
        self.assertEqual(tables["Goodness of fit"][0]["chi-square"], fit["chi_square"])
        best = tables["Which further unknown would improve the fit most"][0]
        self.assertEqual((best["parameter"], best["refuted"]), ("friction.piston_coulomb_N", False))
        self.assertAlmostEqual(best["fitted"], 120, delta=5)
        self.assertGreater(abs(tables["Largest residuals"][0]["residual, sigma"]), 3)
        self.assertNotIn("Uncertainty of each reaction", tables)
        with open(self.folder / "out" / "unknowns.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            self.assertEqual((row["profile_low"], row["q500"]), ("", ""))
            self.assertAlmostEqual(float(row["widened_by"]), math.sqrt(fit["chi_square"] / 5), 9)
        text = (self.folder / "out" / "identified.toml").read_text()
        self.assertTrue(text.startswith("# Identified values. the model does not fit the data: chi-square "))
        # What is made from it says so too.
        shown = self.run_program("show", "out/identified.toml", "--out", "shown")
        self.assertIn("fit refuted", shown.out + (self.folder / "shown" / "report.json").read_text())

    def test_a_fit_that_is_not_refuted(self):
        result = self.identify(self.rig(25), "--fit-only")
        self.assertRegex(result.out, r"(?m)^fit: chi-square [\d.]+ with 5 degrees of freedom, p = 0\.\d+: not refuted; ")
        report = json.loads((self.folder / "out" / "report.json").read_text())
        self.assertIs(report["verdict"]["agrees"], True)
        self.assertEqual(report["verdict"]["word"], "Not refuted")
        with open(self.folder / "out" / "unknowns.csv", newline="") as file:
            self.assertEqual({row["widened_by"] for row in csv.DictReader(file)}, {"1"})
        self.assertIn("degrees of freedom", (self.folder / "out" / "identified.toml").read_text().splitlines()[0])

    def test_a_fit_without_degrees_of_freedom_is_not_tested(self):
        result = self.identify(DATA, "--fit-only")
        self.assertRegex(result.out, "(?m)^no test of the fit: chi-square [^ ]+ with 0 degrees of freedom; ")
        verdict = json.loads((self.folder / "out" / "report.json").read_text())["verdict"]
        self.assertEqual((verdict["agrees"], verdict["word"], verdict["fit"]["p_value"]), (None, "Not tested", None))

    def refused_with(self, text, *words):
        line = self.identify(text, status=BAD_INPUT).err.strip().splitlines()[-1]
        for word in words:
            self.assertIn(word, line)
        self.assertFalse((self.folder / "out" / "report.json").exists())

    def test_data_that_determine_nothing_are_said_first(self):
        """The torque does not depend on where the centre of mass of the block is."""
        text = DATA.replace("pump.bore_diameter_mm", "block.centre_of_mass_z_mm").replace("between = [20, 25]", "between = [20, 60]")
        self.assertRegex(self.identify(text, "--fit-only").out, "(?m)^the data determine none of the unknowns: none of 1 directions")
        self.assertNotIn("determine none", self.identify(DATA, "--fit-only").out)

    def test_bounds_that_the_parameter_may_not_have(self):
        text = DATA.replace("pump.bore_diameter_mm", "friction.shaft_torque_factor")
        for bounds, value in (("[0.5, 1.2]", "1.2"), ("[-0.1, 0.9]", "-0.1")):
            wrong = text.replace("between = [20, 25]", f"between = {bounds}")
            error = self.identify(wrong, "--fit-only", status=BAD_INPUT).err
            self.assert_mentions(error, "data.toml:", "between", "friction.shaft_torque_factor", value, "(0, 1]")
        error = self.identify(DATA, "--fit-only", "--vary", "pump.tilt_deg=30:95", status=BAD_INPUT).err
        self.assert_mentions(error, "--vary", "pump.tilt_deg", "95", "[0, 90)")

    def test_the_file_of_data_is_named(self):
        known = re.sub(r"(?s)\[\[unknown.*?(?=\[\[number)", "", DATA)
        for text, more, words in ((known, (), ("nothing is unknown",)),
                                  (DATA, ("--vary", "pump.bore_diameter_mm=20:25"), ("bore_diameter_mm", "twice")),
                                  (DATA[:DATA.index("[[number]]")], (), ("nothing to which",))):
            self.assert_mentions(self.identify(text, "--fit-only", *more, status=BAD_INPUT).err, "data.toml", *words)

    def test_options_without_effect_are_refused(self):
        for option in ("--steps", "--draws", "--measured"):
            self.assertIn(option, self.refused("identify", self.case(), "--data", self.write(DATA), "--fit-only", option,
                                               "0.5" if option == "--measured" else 20, "--out", "out"))

    def test_refusals_name_file_line_and_key(self):
        self.refused_with(DATA.replace("bore_diameter_mm", "bore_diametre_mm"), "data.toml:6", "bore_diametre_mm",
                          "bore_diameter_mm")
        self.refused_with(DATA.replace("[20, 25]", "[25, 20]"), "data.toml:7", "below")
        self.refused_with(DATA.replace('"max:Rs_z2"', '"max:Rs_z9"'), "data.toml", "max:Rs_z9")
        self.refused_with(DATA.replace('condition = "low"', 'condition = "lwo"'), "lwo", "low")
        without = DATA.replace('[[condition]]\nname = "low"\nset = ["pressure.delivery_bar=100"]\n', "")
        self.assertNotIn("allowed", self.refused("identify", self.case(), "--data", self.write(without), "--out", "out"))
        self.refused_with(DATA.replace("uncertainty = 1\n", "uncertainty = 0\n"), "uncertainty", "0")
        self.refused_with(DATA.replace('use = "predicted"', 'use = "guessed"'), "guessed")
        self.refused_with(DATA.replace("below = 12000\n", ""), "above")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
