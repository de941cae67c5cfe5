#!/usr/bin/env python3
"""`bentaxis sensitivity` from outside.

usage: sensitivity_command_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import csv
import json
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = REPO = None  # set in main
DONE, BAD_INPUT = 0, 2
SECONDS = 120


def rows_of(path):
    with path.open() as file:
        return list(csv.DictReader(file))


class Sensitivity(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="bentaxis_test_"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.out = self.folder / "out"

    def run_program(self, *options, status=DONE, case="bap63_rated"):
        done = subprocess.run([PROGRAM, "sensitivity", REPO / f"cases/{case}.toml", "--out", self.out,
                               "--set", "operation.samples_per_revolution=40", *options],
                              capture_output=True, text=True, timeout=SECONDS)
        self.assertEqual(done.returncode, status, done.stderr)
        return done

    def test_every_pair_is_written_and_the_check_agrees(self):
        # What is named twice is there once.
        done = self.run_program("--output", "mean:Td,peak:Rb1,mean:Td", "--vary",
                                "pump.tilt_deg,pressure.delivery_bar,pump.tilt_deg", "--check-derivatives")
        rows = rows_of(self.out / "sensitivity.csv")
        self.assertEqual([(r["output"], r["parameter"]) for r in rows],
                         [(o, p) for o in ("mean:Td", "peak:Rb1") for p in ("pump.tilt_deg", "pressure.delivery_bar")])
        for row in rows:
            self.assertEqual(row["found_by"], "exact")
            self.assertAlmostEqual(float(row["derivative"]) * float(row["parameter_value"]) / float(row["output_value"]),
                                   float(row["elasticity"]), 12)
            self.assertLess(float(row["difference"]), 1e-7)
        self.assertNotIn("more in sensitivity.csv", done.stdout)
        report = json.loads((self.out / "sensitivity.json").read_text())
        self.assertTrue(report["verdict"]["agrees"])
        self.assertTrue((self.out / "sensitivity.html").exists())

    def test_the_report_says_what_the_file_says(self):
        done = self.run_program("--output", "mean:Td,peak:Rb1", "--check-derivatives", "--vary",
                                "pump.tilt_deg,pressure.delivery_bar,block.mass_kg,friction.piston_coulomb_N")
        rows = {(r["output"], r["parameter"]): r for r in rows_of(self.out / "sensitivity.csv")}
        report = json.loads((self.out / "sensitivity.json").read_text())
        sections = {s["title"]: s for s in report["runs"]}
        tables = {name: [dict(zip(s["table"]["columns"], row)) for row in s["table"]["rows"]] for name, s in sections.items()}
        figures = {f["title"]: f for f in report["figures"]}
        for output in tables["Outputs"]:
            name, unit, value = output["output"], output["unit"], output["value"]
            effects = []
            said = done.stdout.split(f"\n{name} = ")[1].split("\n\n")[0].splitlines()
            self.assertAlmostEqual(float(said[0].split()[0]), value, delta=1e-6 * value)
            for place, row in enumerate(tables[f"Derivatives of {name}"]):
                stored = rows[name, row["parameter"]]
                self.assertEqual(row["derivative"], float(stored["derivative"]))
                self.assertEqual((row["value"], row["unit"], row["found by"]),
                                 (float(stored["parameter_value"]), stored["parameter_unit"], stored["found_by"]))
                effect = row["derivative"] * row["value"] / 100
                self.assertAlmostEqual(row[f"by +1 % ({unit})"], effect, delta=1e-12 * abs(effect))
                self.assertAlmostEqual(row["elasticity (%/%)"], 100 * effect / value, delta=1e-9)
                effects.append(abs(effect))
                bar = figures[f"What moves {name}"]["bars"][place]
                self.assertEqual(bar["label"], row["parameter"])
                self.assertAlmostEqual(bar["low"] + bar["high"], effect, delta=1e-12 * abs(effect))
                words = said[2 + place].split()
                self.assertEqual(words[0], row["parameter"])
                for word, number in zip(words[1:4], (row["value"], row["derivative"], row["elasticity (%/%)"])):
                    self.assertAlmostEqual(float(word), number, delta=1e-5 * abs(number))
            self.assertEqual(effects, sorted(effects, reverse=True))
            self.assertEqual(len(effects), 3)
            self.assertEqual(sections[f"Derivatives of {name}"]["text"], "No influence: block.mass_kg.")
        against = tables["Against Simbody"]
        self.assertEqual(len(against), 8)
        for row in against:
            stored = rows[row["output"], row["parameter"]]
            self.assertEqual((row["derivative"], row["by the other model"], row["difference"]),
                             tuple(float(stored[k]) for k in ("derivative", "derivative_of_other_model", "difference")))
        worst = max(against, key=lambda r: r["difference"])
        self.assertIn(f"({worst['output']} by {worst['parameter']})", done.stdout)

    def test_a_derivative_predicts_a_run(self):
        """What a small change does, by two runs of the program."""
        def mean_torque(change):
            out = self.folder / "run"
            subprocess.run([PROGRAM, "run", REPO / "cases/bap63_rated.toml", "--model", "analytic", "--out", out, "--set",
                            "operation.samples_per_revolution=40", "--set", f"pump.tilt_deg={40 + change}"],
                           check=True, capture_output=True, timeout=SECONDS)
            rows = rows_of(out / "analytic.csv")
            return sum(float(r["Td_z1_Nm"]) for r in rows) / len(rows)
        self.run_program("--output", "mean:Td", "--vary", "pump.tilt_deg")
        [row] = rows_of(self.out / "sensitivity.csv")
        difference = (mean_torque(1e-3) - mean_torque(-1e-3)) / 2e-3
        # Third derivative times 1e-6, and round-off of 1e-13 over 1e-3.
        self.assertAlmostEqual(float(row["derivative"]), difference, delta=1e-7 * abs(difference))

    def test_hydraulic_pressure_names_its_method(self):
        done = self.run_program("--output", "mean:Td,efficiency.volumetric,hydraulics.chamber_greatest_bar",
                                "--vary", "hydraulics.bulk_modulus_MPa", case="bap63_rated_hydraulic")
        reactions, efficiency, greatest = rows_of(self.out / "sensitivity.csv")
        for row in reactions, efficiency:
            self.assertEqual(row["found_by"], "forward sensitivities (CVODES)")
            self.assertGreater(float(row["error"]), 0)
        self.assertEqual(greatest["found_by"], "differences")
        self.assertIn("2 derivatives by forward sensitivities, 1 by differences", done.stdout)
        self.assertIn("forward sensitivities (CVODES)", (self.out / "sensitivity.json").read_text())

    def test_a_value_taken_from_another_parameter_is_said(self):
        """Arcs of [hydraulics] are those of [port_plate] unless given: two rows with one derivative."""
        names = "port_plate.delivery_arc_deg.1,hydraulics.delivery_arc_deg.1"
        done = self.run_program("--output", "mean:Td", "--vary", names, case="bap63_rated_hydraulic")
        self.assertIn("The case does not give hydraulics.delivery_arc_deg: the value is that of another parameter.", done.stdout)
        plate, oil = rows_of(self.out / "sensitivity.csv")
        self.assertEqual([r["parameter"] for r in (plate, oil)], names.split(","))
        self.assertEqual(plate["derivative"], oil["derivative"])
        done = self.run_program("--output", "mean:Td", "--vary", names, "--set", "hydraulics.delivery_arc_deg=[204, 336]",
                                case="bap63_rated_hydraulic")
        self.assertNotIn("The case does not give", done.stdout)
        plate, oil = rows_of(self.out / "sensitivity.csv")
        self.assertNotEqual(plate["derivative"], oil["derivative"])

    def test_an_interruption_keeps_what_is_finished(self):
        process = subprocess.Popen([PROGRAM, "sensitivity", REPO / "cases/bap63_rated.toml", "--model", "multibody", "--output",
                                    "mean:Td", "--set", "operation.samples_per_revolution=360", "--out", self.out],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(4)  # some of 45 parameters, each of some seconds
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=SECONDS)
        if "nothing was written" in err:
            self.skipTest("interrupted before the first parameter was finished: a very busy machine")
        self.assertEqual(process.returncode, 130, err)
        rows = rows_of(self.out / "sensitivity.csv")
        missing = [r["parameter"] for r in rows if not r["found_by"] and r["derivative"] == ""]
        self.assertGreater(len(missing), 0)
        self.assertLess(len(missing), len(rows))
        sentence = out.splitlines()[2]
        self.assertTrue(sentence.startswith("Interrupted: "), sentence)
        for name in missing:
            self.assertIn(name, sentence)
            self.assertIn(name, err)
        self.assertEqual(json.loads((self.out / "sensitivity.json").read_text())["verdict"]["answers"][0], sentence)

    def test_without_names_every_number_of_the_case(self):
        done = self.run_program()
        rows = rows_of(self.out / "sensitivity.csv")
        parameters = {r["parameter"] for r in rows}
        self.assertGreater(len(parameters), 40)
        # The console shows eight of an output, and says of how many it is silent.
        outputs = len({r["output"] for r in rows})
        self.assertEqual(done.stdout.count(f"and {len(parameters) - 8} more in sensitivity.csv\n"), outputs)
        self.assertLessEqual({"pump.tilt_deg", "port_plate.inner_land_mm.2", "operation.speed_rpm"}, parameters)

    def test_an_error_covers_what_shorter_steps_give(self):
        """Lives follow the largest of some samples: a scheme for smooth functions was 5000 times too sure of them."""
        case, name = REPO / "cases/bap63_bearing_life.toml", "port_plate.delivery_arc_deg.1"
        outputs = "life.system_h,life.tapered_h,life.tapered_P_N,life.cylindrical_h"
        run = [PROGRAM, "sensitivity", case, "--output", outputs, "--vary", name, "--out", self.out]
        subprocess.run(run, capture_output=True, check=True, timeout=SECONDS)
        found = {row["output"]: (float(row["derivative"]), float(row["error"])) for row in rows_of(self.out / "sensitivity.csv")}
        self.assertEqual(set(found), set(outputs.split(",")))
        run = [PROGRAM, "sweep", case, "--output", outputs, "--vary", f"{name}=203.99,204.01", "--out", self.out]
        subprocess.run(run, capture_output=True, check=True, timeout=SECONDS)
        low, high = rows_of(self.out / "sweep.csv")
        for output, (derivative, error) in found.items():
            column = next(key for key in low if key.startswith(output))
            short = (float(high[column]) - float(low[column])) / 0.02
            with self.subTest(output):
                self.assertLess(abs(derivative - short), error)
                self.assertLess(error, 0.1 * abs(derivative))

    def test_what_is_no_number_is_refused(self):
        for options, words in ((("--vary", "pump.pistons"), "pump.pistons: is not a continuous number"),
                               (("--vary", "pump.tilt"), "pump.tilt_deg"),
                               (("--output", "most:Td"), "most:Td: no statistic")):
            done = self.run_program(*options, status=BAD_INPUT)
            self.assertIn(words, done.stderr)
            self.assertFalse((self.out / "sensitivity.csv").exists())


if __name__ == "__main__":
    PROGRAM, REPO = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
