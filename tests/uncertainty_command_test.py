#!/usr/bin/env python3
"""Tests of `bentaxis uncertainty` and of `compare --uncertainty` from outside.

usage: uncertainty_command_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import csv
import json
import math
import pathlib
import statistics
import sys
import unittest

import command_line_test as program
from command_line_test import ProgramTest

FILES = {"report.html", "report.json", "outputs.csv", "samples.csv", "bands.csv"}
TABLE = """
[uncertainty]
"pump.tilt_deg" = "normal(0.1)"
"bearings.tapered_z_mm" = "normal(-26, 0.5)"
"pressure.delivery_bar" = "uniform(270, 280)"
correlation = [["pump.tilt_deg", "bearings.tapered_z_mm", 0.5]]
"""


class UncertaintyTest(ProgramTest):
    def uncertain(self, table=TABLE, case="bap63_rated"):
        text = (program.REPO / "cases" / f"{case}.toml").read_text()
        lines = ["samples_per_revolution = 90" if line.startswith("samples_per_revolution") else line
                 for line in text.splitlines()]
        path = self.folder / "my.toml"
        path.write_text("\n".join(lines) + "\n" + table)
        return path

    def files(self, out="out"):
        return {path.name for path in (self.folder / out).iterdir()}

    def table(self, name, out="out"):
        with open(self.folder / out / name, newline="") as file:
            return list(csv.DictReader(file))

    def report(self, out="out"):
        return json.loads((self.folder / out / "report.json").read_text())

    def test_files_and_numbers(self):
        case = self.uncertain()
        self.run_program("uncertainty", case, "--output", "mean:Td,peak:Rb1", "--samples", 400, "--out", "out")
        self.assertEqual(self.files(), FILES)
        samples = self.table("samples.csv")
        self.assertEqual(len(samples), 400)
        outputs = {row["output"]: row for row in self.table("outputs.csv")}
        for name, row in outputs.items():
            values = [float(sample[name]) for sample in samples]
            self.assertAlmostEqual(float(row["mean"]), statistics.fmean(values), delta=1e-9 * abs(values[0]))
            self.assertAlmostEqual(float(row["deviation"]), statistics.stdev(values), delta=1e-9 * abs(values[0]))
            # Nearly linear over this width: both ways agree within what 400 samples show.
            self.assertAlmostEqual(float(row["first_order_deviation"]), float(row["deviation"]),
                                   delta=4 * float(row["deviation_error"]))
            edges = [float(row[key]) for key in ("low_from", "low", "low_to", "median", "high_from", "high", "high_to")]
            self.assertEqual(edges, sorted(edges))
        # Parameters are correlated as asked: r of 400 samples has a standard error of 0.04.
        tilt, place = ([float(s[key]) for s in samples] for key in ("pump.tilt_deg", "bearings.tapered_z_mm"))
        self.assertAlmostEqual(statistics.correlation(tilt, place), 0.5, delta=0.15)
        # A sample is the pump that --set makes.
        sample = samples[17]
        changes = [word for key in ("pump.tilt_deg", "bearings.tapered_z_mm", "pressure.delivery_bar")
                   for word in ("--set", f"{key}={sample[key]}")]
        self.run_program("run", case, "--model", "analytic", *changes, "--out", "one")
        torque = statistics.fmean(float(row["Td_z1_Nm"]) for row in self.table("analytic.csv", "one"))
        self.assertAlmostEqual(float(sample["mean:Td"]), torque, delta=1e-11 * torque)
        # Bands.
        for row in self.table("bands.csv"):
            self.assertLessEqual(float(row["Rb1_y1_N_low"]), float(row["Rb1_y1_N_median"]))
            self.assertLessEqual(float(row["Rb1_y1_N_median"]), float(row["Rb1_y1_N_high"]))
        figures = {figure["id"]: figure for figure in self.report()["figures"]}
        self.assertEqual(len(figures["band_Rb1"]["bands"]), 3)
        self.assertEqual(len(figures["contributions_1"]["bars"]), 2)  # the bearing's place moves no torque

    def test_the_report_says_what_the_files_say(self):
        case = self.uncertain()
        result = self.run_program("uncertainty", case, "--output", "mean:Td,peak:Rb1", "--samples", 300, "--level", 0.9,
                                  "--out", "out")
        tables = {}
        for section in self.report()["runs"]:
            table = section["table"]
            tables[section["title"]] = [dict(zip(table["columns"], row)) for row in table["rows"]]
        near = lambda text, value: self.assertAlmostEqual(float(text), float(value), delta=2e-3 * abs(float(value)))
        for said, row in zip(tables["Outputs"], self.table("outputs.csv"), strict=True):
            self.assertEqual(said["output"], row["output"])
            near(said["nominal"], row["nominal"])
            for words, key in (("mean", "mean"), ("standard deviation", "deviation")):
                value, error = said[words].split(" +- ")
                near(value, row[key])
                self.assertAlmostEqual(float(error), float(row[key + "_error"]), delta=0.06 * float(error))
            for words, key in (("5 % quantile", "low"), ("median", "median"), ("95 % quantile", "high")):
                numbers = said[words].replace("(", "").replace(")", "").replace("..", "").split()
                for text, end in zip(numbers, ("", "_from", "_to"), strict=True):
                    near(text, row[key + end])
        for said, row in zip(tables["First order beside it"], self.table("outputs.csv"), strict=True):
            self.assertEqual([said[c] for c in ("value at the means", "combined standard uncertainty", "of Monte Carlo",
                                                "standard error of that")],
                             [float(row[k]) for k in ("first_order_value", "first_order_deviation", "deviation",
                                                      "deviation_error")])
        deviations = {row["parameter"]: row["standard deviation"] for row in tables["What is not known"]}
        self.assertAlmostEqual(deviations["pressure.delivery_bar"], 10 / math.sqrt(12), 12)
        parts = {}
        for row in tables["Contributions of the parameters, to first order"]:
            parts[row["output"], row["parameter"]] = row["contribution"]
            self.assertAlmostEqual(row["contribution"], row["derivative"] * deviations[row["parameter"]],
                                   delta=1e-12 * abs(row["contribution"]))
        for row in tables["First order beside it"]:
            tilt, place, bar = (parts[row["output"], p] for p in ("pump.tilt_deg", "bearings.tapered_z_mm", "pressure.delivery_bar"))
            self.assertAlmostEqual(row["combined standard uncertainty"],
                                   math.sqrt(tilt**2 + place**2 + bar**2 + 2 * 0.5 * tilt * place), 9)
        bands = self.table("bands.csv")
        rows = {s["title"]: s for s in self.report()["runs"]}["Bands on reactions"]["table"]["rows"]
        self.assertEqual(len(rows), len([c for c in bands[0] if c.endswith("_low")]))
        shares = {}
        for name, _, peak, half, share, _, edge_share, within in rows:
            wide = max(float(row[f"{name}_high"]) - float(row[f"{name}_low"]) for row in bands) / 2
            self.assertAlmostEqual(half, wide, delta=1e-9 * wide)
            self.assertAlmostEqual(share, 100 * half / peak, delta=1e-9 * share)
            self.assertLess(edge_share, max(share, 1e-9))
            self.assertTrue(60 < within <= 90, f"{name}: {within} % within throughout")  # of each angle by itself 90 are
            shares[name] = share
        self.assert_mentions(result.out, "90 % of the pumps in", f"widest band: {max(shares, key=shares.get)}, ")

    def test_the_same_whatever_the_threads(self):
        case = self.uncertain()
        for threads in (1, 2):
            self.run_program("uncertainty", case, "--samples", 150, "--threads", threads, "--out", f"out{threads}")
        for name in ("samples.csv", "outputs.csv", "bands.csv"):
            self.assertEqual(*((self.folder / f"out{n}" / name).read_bytes() for n in (1, 2)), name)
        self.run_program("uncertainty", case, "--samples", 150, "--seed", 2, "--no-curves", "--out", "out")
        self.assertEqual(self.files(), FILES - {"bands.csv"})
        self.assertNotEqual(*((self.folder / out / "outputs.csv").read_bytes() for out in ("out", "out1")))

    def test_few_samples_have_no_quantiles(self):
        case = self.uncertain()
        for samples, level, given, words in ((20, 0.95, False, ("known to about 16 % (to 10 % from 51 on)", "need 146 (--samples)")),
                                             (100, 0.95, False, ("need 146 (--samples)",)), (20, 0.5, True, ("known to about 16 %",))):
            with self.subTest(samples=samples, level=level):
                result = self.run_program("uncertainty", case, "--samples", samples, "--level", level, "--out", "out")
                self.assert_mentions(result.out, f"{samples} samples are too few for reliable statistics: ", *words)
                self.assertEqual("of the pumps in" in result.out, given)
                self.assertEqual("bands.csv" in self.files(), given)
                [warning] = self.report()["warnings"]
                self.assertEqual(warning["name"], "Few samples")
                for row in self.table("outputs.csv"):
                    self.assertTrue(row["mean"] and row["deviation"] and row["median"])
                    self.assertEqual([bool(row[key]) for key in ("low", "low_from", "high", "high_to")], [given] * 4)
        result = self.run_program("uncertainty", case, "--samples", 146, "--no-curves", "--out", "out")
        self.assertNotIn("too few", result.out)
        self.assertFalse(self.report().get("warnings"))

    def test_samples_that_are_no_pump(self):
        case = self.uncertain("")
        result = self.run_program("uncertainty", case, "--vary", "port_plate.delivery_arc_deg.2=normal(189.5, 0.5)",
                                  "--vary", "pump.tilt_deg=normal(0.1)", "--samples", 300, "--no-curves", "--out", "out")
        rows = len(self.table("samples.csv"))
        self.assertLess(rows, 300)
        self.assertIn(f"{300 - rows} of 300 samples are infeasible pumps", result.out)
        section = {s["title"]: s for s in self.report()["runs"]}["Samples that are no pump"]
        self.assertIn("port_plate", section["table"]["rows"][0][0])
        # What it does to the statistics: the arc's end is cut at its beginning, 189 deg, the tilt is not.
        self.assert_mentions(result.out, f"({100 * (300 - rows) / 300:.3g} %)", "those of the other samples alone")
        [warning] = self.report()["warnings"]
        self.assertEqual(warning["name"], "Samples left out")
        self.assertIn("left out", self.report()["verdict"]["headline"])
        kept = {s["title"]: s for s in self.report()["runs"]}["Parameters of the remaining samples"]["table"]
        self.assertEqual(kept["columns"][2:], ["stated mean", "mean", "standard error of it", "stated standard deviation",
                                               "standard deviation", "standard error of it"])
        samples = self.table("samples.csv")
        for name, _, stated_mean, mean, mean_error, stated, deviation, error in kept["rows"]:
            values = [float(sample[name]) for sample in samples]
            self.assertAlmostEqual(mean, statistics.fmean(values), 9)
            self.assertAlmostEqual(deviation, statistics.stdev(values), 9)
            cut = name.startswith("port_plate")
            self.assertEqual(abs(mean - stated_mean) > 4 * mean_error, cut, name)
            self.assertEqual(abs(deviation - stated) > 4 * error, cut, name)

    def test_samples_that_a_comparison_leaves_out(self):
        case = self.uncertain('\n[uncertainty]\n"port_plate.delivery_arc_deg.2" = "normal(189.5, 0.5)"\n')
        result = self.run_program("compare", case, "--uncertainty", 200, "--out", "out")
        self.assert_mentions(result.out, "of 200 samples are infeasible pumps", "u_input is that of the other samples alone")
        self.assertIn("Samples left out", [warning["name"] for warning in self.report()["warnings"]])

    def test_sobol_indices(self):
        self.run_program("uncertainty", self.uncertain(), "--samples", 150, "--no-curves", "--out", "plain")
        self.assert_mentions(self.refused("uncertainty", self.uncertain(), "--sobol", 15), "--sobol: 15: must be at least 16, or 0: none")
        version = dict(self.report("plain")["program"])
        case = self.uncertain(TABLE.split("correlation")[0])
        command = ("uncertainty", case, "--output", "peak:Rb1", "--no-curves", "--samples", 150, "--sobol", 256)
        if version["OpenTURNS"] == "none":
            self.assert_mentions(self.refused(*command), "libopenturns-dev")
            return
        self.run_program(*command, "--out", "out")
        section = {s["title"]: s for s in self.report()["runs"]}["Sobol indices"]
        firsts = [row[2] for row in section["table"]["rows"]]
        self.assertAlmostEqual(sum(firsts), 1, delta=0.1)  # nearly linear
        for _, _, first, low, high, total, _, _ in section["table"]["rows"]:
            self.assertLess(low, first)
            self.assertLess(first, high)
            self.assertAlmostEqual(total, first, delta=0.1)
        # Displacement depends on the tilt alone: indices are 0 or 1, not a round-off from them, and no 0 has a sign.
        for seed in range(1, 5):
            result = self.run_program("uncertainty", case, "--output", "displacement_cm3,mean:Td", "--no-curves", "--samples", 150,
                                      "--sobol", 64, "--seed", seed, "--out", "out")
            self.assertNotIn("-0.000", result.out)
            rows = {s["title"]: s for s in self.report()["runs"]}["Sobol indices"]["table"]["rows"]
            for output, name, first, low, high, total, total_low, total_high in rows:
                self.assertTrue(low <= first <= high and total_low <= total <= total_high, (output, name, seed))
                if output == "displacement_cm3":
                    exact = (first, low, high) if name == "pump.tilt_deg" else (total, total_low, total_high)
                    self.assertEqual(set(exact), {1 if name == "pump.tilt_deg" else 0}, name)

    def test_refusals(self):
        plain = self.uncertain("").rename(self.folder / "plain.toml")
        case = self.uncertain()
        for arguments, words in (
            ((plain,), ["needs [uncertainty]"]),
            ((case, "--samples", 9), ["--samples", "9", "10"]),
            ((case, "--output", "most:Td"), ["most:Td"]),
            ((case, "--vary", "pump.tilt_deg"), ["--vary pump.tilt_deg", "NAME=DISTRIBUTION"]),
            ((case, "--vary", "pump.tilt=normal(1)"), ["pump.tilt", "pump.tilt_deg"]),
            ((case, "--vary", "pump.tilt_deg=normal(1, -1)"), ["normal(1, -1)", "> 0"]),
            ((case, "--vary", "pump.tilt_deg=normal(1)", "--vary", "pump.tilt_deg=normal(2)"), ["normal(2)", "more than once"]),
            ((case, "--sobol", 64), ["independent"]),
            ((case, "--level", 2), ["--level"]),
        ):
            with self.subTest(words):
                self.assert_mentions(self.refused("uncertainty", *arguments, "--out", "out"), *words)
        self.assert_mentions(self.refused("compare", plain, "--uncertainty", 200, "--out", "out"), "needs [uncertainty]")
        self.assert_mentions(self.refused("compare", case, "--uncertainty", 20, "--out", "out"), "at least 146")

    def test_comparison_errors(self):
        case = self.uncertain()
        golden = self.folder / "golden"
        self.run_program("reference", "golden", case, "--out", golden)
        self.run_program("compare", case, "--uncertainty", 200, "--with", golden, "--out", "out")
        self.assertIn("bands.csv", self.files())
        sections = {s["title"]: s for s in self.report()["runs"]}
        rows = {(row[0], row[1]): row for row in sections["Comparison errors of printed numbers"]["table"]["rows"]}
        (torque,) = [row for (name, at), row in rows.items() if name == "mean torque, measured"]
        simulation, data, error, numerical, by_input, of_data, validation, verdict = torque[4:]
        self.assertEqual(data, 295.5)
        self.assertAlmostEqual(error, simulation - data, 12)
        self.assertAlmostEqual(of_data, 3 / math.sqrt(3), 12)  # printed as measured, +- 3 Nm
        self.assertAlmostEqual(validation, math.hypot(numerical, by_input, of_data), 12)
        self.assertGreater(by_input, 2)  # 10 bar wide: 2.9 bar of 275, and the tilt
        self.assertLess(by_input, 4)
        self.assertLess(numerical, 1e-9)
        self.assertEqual(verdict, "could be 0" if abs(error) <= 2 * validation else "is not 0")
        (tooth,) = [row for (name, at), row in rows.items() if name.startswith("Rcs at 0 deg")]
        self.assertEqual(tooth[-1], "is not 0")  # 284 against 329.7 N
        (curves,) = [s for title, s in sections.items() if title.startswith("Comparison errors of the curves")]
        for row in curves["table"]["rows"]:  # they are its own
            self.assertEqual((row[-2], row[-1]), ("could be 0", 100), row)
        figure = {figure["id"]: figure for figure in self.report()["figures"]}["band_Rb2"]
        self.assertEqual(len(figure["lines"]), 4)  # nominal and stored


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
