#!/usr/bin/env python3
"""`bentaxis optimise` from outside: files, answers, refusals, interruption, processes.

usage: optimise_command_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import csv
import json
import math
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = REPO = None  # set in main
DONE, NONE_FOUND, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130
SECONDS = 300
FRONT = ["--vary", "pump.tilt_deg=25:42", "--vary", "pump.bore_diameter_mm=20:26", "--minimise", "peak:Rb1",
         "--maximise", "displacement_cm3", "--population", "16", "--generations", "8"]


def rows_of(path):
    with path.open() as file:
        return list(csv.DictReader(file))


class Optimise(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="bentaxis_test_")))
        self.out = self.folder / "out"
        self.case = REPO / "cases" / "bap63_rated.toml"

    def command(self, *options, case=None, out=None):
        return [PROGRAM, "optimise", str(case or self.case), "--out", str(out or self.out),
                "--set", "operation.samples_per_revolution=36", *map(str, options)]

    def run_program(self, *options, status=DONE, **places):
        done = subprocess.run(self.command(*options, **places), cwd=self.folder, capture_output=True, text=True, timeout=SECONDS)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done

    def refused(self, *options):
        done = self.run_program(*options, status=BAD_INPUT)
        said = [line for line in done.stderr.splitlines() if not line.startswith("pump: ")]
        self.assertEqual((done.stdout, len(said)), ("", 1), done.stderr)
        self.assertFalse(self.out.exists())
        return said[0]

    def test_chosen_cases_are_what_the_table_says(self):
        done = self.run_program(*FRONT, "--subject-to", "peak:Rb1 <= 60000", "--output", "mean:Td")
        report = json.loads((self.out / "report.json").read_text())
        self.assertEqual(report["verdict"]["word"], "Optimised")
        for answer in report["verdict"]["answers"]:
            self.assertIn(answer, done.stdout)
        front = rows_of(self.out / "front.csv")
        everything = rows_of(self.out / "evaluations.csv")
        allowed = [row for row in everything if row["reason"] == ""]
        # No design beats one of the front, and each of the front is there.
        self.assertEqual([row for row in everything if row["design"] in {r["design"] for r in front}], front)
        for one in front:
            self.assertFalse([o for o in allowed
                              if float(o["peak:Rb1"]) < float(one["peak:Rb1"]) and float(o["displacement_cm3"]) > float(one["displacement_cm3"])])
        for row in everything:
            self.assertEqual(float(row["peak:Rb1"]) > 60000, "peak:Rb1 <= 60000 N: exceeded by" in row["reason"])
        # Each chosen case, run by itself, has the numbers of its design; the same command and another one agree.
        table = next(s for s in report["runs"] if s["title"] == "Chosen designs")["table"]
        columns = table["columns"]
        self.assertEqual([row[1] for row in table["rows"]][1:], ["lowest peak:Rb1", "largest displacement_cm3", "balanced"])
        for row in table["rows"][1:]:
            sweep = self.folder / row[0]
            subprocess.run([PROGRAM, "sweep", self.out / row[0], "--set", "operation.samples_per_revolution=36",
                            "--vary", "piston.inertia=lumped", "--output", "peak:Rb1,displacement_cm3,mean:Td", "--out", sweep],
                           check=True, capture_output=True, timeout=SECONDS)
            found = rows_of(sweep / "sweep.csv")[0]
            for name in ("peak:Rb1", "displacement_cm3", "mean:Td"):
                shown = next(row[i] for i, column in enumerate(columns) if column.startswith(name))
                value = next(v for column, v in found.items() if column.startswith(name))
                self.assertTrue(math.isclose(float(value), shown, rel_tol=1e-12), (name, value, shown))
        self.assertFalse((self.out / "sweep.parts").exists())

    def test_chosen_designs_say_whether_they_are_valid(self):
        """As show says of the chosen case. A small bottom area lets the block lift off."""
        search = ["--vary", "block.bottom_area_mm2=50:250", "--maximise", "max:Fh_z2", "--population", "16", "--generations", "6"]
        for options, valid in (([], False), (["--subject-to", "validity.film.share <= 0", "--subject-to", "validity.point.share <= 0"], True)):
            done = self.run_program(*search, *options)
            verdict = json.loads((self.out / "report.json").read_text())["verdict"]
            table = next(s for s in json.loads((self.out / "report.json").read_text())["runs"] if s["title"] == "Chosen designs")["table"]
            subprocess.run([PROGRAM, "show", self.out / "chosen_1.toml", "--out", self.folder / "alone"], check=True, capture_output=True,
                           timeout=SECONDS)
            alone = json.loads((self.folder / "alone/report.json").read_text())["verdict"]
            self.assertEqual(alone.get("not_valid", "") == "", valid)
            self.assertTrue(done.stdout.splitlines()[0].endswith(
                "; the chosen design is " + ("" if valid else "not ") + "valid over the whole turn"), done.stdout)
            said = "valid over the whole turn" if valid else "not valid " + alone["not_valid"]
            self.assertEqual(table["rows"][1][table["columns"].index("validity")], said)
            self.assertEqual(verdict.get("not_valid", ""), "" if valid else "for 1 of 1 chosen designs")
            head = (self.out / "chosen_1.toml").read_text()
            self.assertEqual("# Not valid over" in head, not valid)
            self.assertEqual('To have valid designs only: --subject-to "validity.' in done.stdout, not valid)
            if not valid:
                self.assertIn(f"; {said}.\n", done.stdout)
                for limit in (a for a in alone["answers"] if a.startswith("Not valid")):
                    self.assertIn(limit, done.stdout)

    def test_a_limit_on_an_objective_is_named_where_it_stops_a_design(self):
        """And the case that is written states defaults, which are nobody's doubtful numbers."""
        nine = REPO / "cases" / "studies" / "nine_pistons.toml"
        done = self.run_program("--set", "pressure.kind=ideal", "--vary", "pump.tilt_deg=25:42", "--vary", "pump.bore_diameter_mm=15:19",
                                "--minimise", "peak:Rb1", "--maximise", "displacement_cm3", "--subject-to", "peak:Rb1 <= 45000",
                                "--population", "16", "--generations", "8", case=nine)
        largest = next(line for line in done.stdout.splitlines() if line.startswith("largest displacement_cm3"))
        self.assertIn("at its limit: peak:Rb1 <= 45000 N", largest)
        lowest = next(line for line in done.stdout.splitlines() if line.startswith("lowest peak:Rb1"))
        self.assertNotIn("<= 45000", lowest)
        for name in ("nine_pistons", self.out / "chosen_1.toml"):
            shown = subprocess.run([PROGRAM, "show", nine if name == "nine_pistons" else name, "--strict", "--set",
                                    "operation.samples_per_revolution=37"], cwd=self.folder, capture_output=True,
                                   text=True, timeout=SECONDS)
            self.assertEqual(shown.returncode, DONE, shown.stderr)

    def test_searches_that_disagree_say_so(self):
        """0 % of the front alone: nothing that a front could be trusted for. Of one objective the best values are compared."""
        many = [item for k in range(1, 8) for item in ("--vary", ["pump.tilt_deg=25:42", "pump.bore_diameter_mm=20:26",
                "bearings.tapered_z_mm=-60:-30", "bearings.cylindrical_z_mm=-160:-100", "block.bottom_area_mm2=150:350",
                "piston.mass_kg=0.05:0.2", "operation.speed_rpm=500:2500"][k - 1])]
        # One design of sixteen has so much displacement: one of the searches has none.
        done = self.run_program(*many, "--minimise", "peak:Rb1", "--maximise", "displacement_cm3", "--subject-to", "displacement_cm3 >= 81",
                                "--population", "8", "--generations", "0", "--no-refinement", "--comparison", "no")
        self.assertIn("How sure: the searches disagree: one of 2 finds nothing of the front alone, so the front is not settled: more ", done.stdout)
        done = self.run_program(*many, "--minimise", "peak:Rb1", "--population", "8", "--generations", "0", "--no-refinement", "--comparison", "no")
        self.assertRegex(done.stdout, r"How sure: the best values of the 2 searches differ by [\d.e-]+ %, so the best design is not settled: more ")
        rows = next(s for s in json.loads((self.out / "report.json").read_text())["runs"] if s["title"] == "How sure this is")["table"]["rows"]
        everything = [float(row["peak:Rb1"]) for row in rows_of(self.out / "evaluations.csv")]
        for search, part in ((0, everything[:8]), (1, everything[8:16])):
            self.assertEqual(rows[search][2], f"best: {min(part):.5g} N")

    def test_no_design_is_a_clear_no(self):
        done = self.run_program(*FRONT, "--subject-to", "displacement_cm3 >= 900", status=NONE_FOUND)
        self.assertTrue(done.stdout.startswith("none of "), done.stdout)
        self.assertIn("The design closest to feasible is design", done.stdout)
        verdict = json.loads((self.out / "report.json").read_text())["verdict"]
        self.assertEqual((verdict["agrees"], verdict["word"]), (False, "No design"))
        self.assertFalse(list(self.out.glob("chosen_*")))

    def test_refusals_name_option_and_value(self):
        vary = ["--vary", "pump.tilt_deg=25:42"]
        for options, words in (
                ([*vary], "--minimise"),
                (["--minimise", "peak:Rb1"], "--vary"),
                ([*vary, "--minimise", "peak:Rb1", "--subject-to", "peak:Rb1 < 3"], "peak:Rb1 < 3"),
                ([*vary, "--minimise", "peak:Rb1", "--population", "10"], "--population 10"),
                ([*vary, "--minimise", "timing.backflow"], "timing.backflow"),
                (["--vary", "pump.tilt_deg=40", "--minimise", "peak:Rb1"], "pump.tilt_deg"),
                (["--vary", "pump.tilt_deg", "--minimise", "peak:Rb1"], "--vary pump.tilt_deg"),
                ([*vary, "--minimise", "peak:Rb1@1"], "--conditions"),
                ([*vary, "--study", "missing.toml"], "missing.toml"),
                ([*vary, "--minimise", "peak:Rb1", "--conditions", "missing.csv"], "missing.csv")):
            with self.subTest(options=options):
                self.assertIn(words, self.refused(*options))
        study = self.folder / "study.toml"
        study.write_text("minimise = [\"peak:Rb1\"]\npopulatoin = 12\n")
        said = self.refused(*vary, "--study", study)
        self.assertIn("study.toml:2", said)
        self.assertIn("population", said)

    def test_a_study_file_is_the_same_as_options(self):
        study = self.folder / "study.toml"
        study.write_text("""minimise = ["peak:Rb1"]
maximise = ["displacement_cm3"]
population = 16
generations = 8
[[vary]]
parameter = "pump.tilt_deg"
values = "25:42"
[[vary]]
parameter = "pump.bore_diameter_mm"
values = "20:26"
""")
        self.run_program("--study", study)
        self.run_program(*FRONT, out=self.folder / "options")
        for name in ("evaluations.csv", "front.csv", "chosen_3.toml"):
            self.assertEqual((self.out / name).read_bytes(), (self.folder / "options" / name).read_bytes(), name)

    def test_timing_and_plausibility_are_constraints(self):
        # Of one plate: the same numbers as pressure states.
        case = REPO / "cases" / "bap63_rated_hydraulic.toml"
        self.run_program("--vary", "hydraulics.delivery_notch_deg=16:20", "--minimise", "timing.backflow", "--output",
                         "timing.warnings,plausibility.warnings", "--subject-to", "timing.overshoot.excess <= 100", "--population",
                         "8", "--generations", "0", "--restarts", "1", "--no-refinement", case=case)
        first = rows_of(self.out / "evaluations.csv")[0]
        self.assertEqual(float(first["hydraulics.delivery_notch_deg"]), 18)
        out = self.folder / "pressure"
        subprocess.run([PROGRAM, "pressure", case, "--set", "operation.samples_per_revolution=36", "--out", out],
                       check=True, capture_output=True, timeout=SECONDS)
        report = json.loads((out / "pressure.json").read_text())
        rows = {row["code"]: row for row in report["timing"]}
        self.assertTrue(math.isclose(float(first["timing.backflow"]), rows["backflow"]["value"], rel_tol=1e-9))
        self.assertTrue(math.isclose(float(first["timing.overshoot.excess"]), rows["overshoot"]["value"] - rows["overshoot"]["limit"],
                                     rel_tol=1e-9))
        self.assertEqual(float(first["timing.warnings"]), sum(row["flagged"] and not row.get("meant") for row in report["timing"]))
        self.assertEqual(float(first["plausibility.warnings"]), len(report["plausibility"]["warnings"]))

    def test_an_interrupted_run_goes_on(self):
        options = ["--vary", "hydraulics.delivery_notch_deg=10:20", "--minimise", "timing.backflow", "--population", "8",
                   "--generations", "3", "--restarts", "1", "--no-refinement"]
        case = REPO / "cases" / "bap63_rated_hydraulic.toml"
        running = subprocess.Popen(self.command(*options, case=case), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        parts = self.out / "sweep.parts"
        end = time.monotonic() + SECONDS
        while not list(parts.glob("block-*")) and running.poll() is None and time.monotonic() < end:
            time.sleep(0.01)
        running.send_signal(signal.SIGINT)
        _, said = running.communicate(timeout=SECONDS)
        if running.returncode != DONE:  # it may have ended before
            self.assertEqual(running.returncode, INTERRUPTED, said)
            self.assertIn("--resume goes on from them", said)
            refused = self.run_program(*options, "--seed", "2", "--resume", case=case, status=BAD_INPUT)
            self.assertIn("another case or plan", refused.stderr)
            done = self.run_program(*options, "--resume", case=case)
            self.assertIn("batches were there already", done.stderr)
        self.run_program(*options, case=case, out=self.folder / "whole")
        self.assertEqual((self.out / "evaluations.csv").read_bytes(), (self.folder / "whole" / "evaluations.csv").read_bytes())

    def test_an_interrupted_refinement_goes_on(self):
        options = ["--vary", "pump.tilt_deg=20:42", "--vary", "pump.bore_diameter_mm=18:26", "--minimise", "hydraulics.delivery_ripple_bar",
                   "--subject-to", "displacement_cm3 >= 50", "--population", "8", "--generations", "0", "--restarts", "1"]
        case = REPO / "cases" / "bap63_rated_hydraulic.toml"
        running = subprocess.Popen(self.command(*options, case=case), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        parts = self.out / "sweep.parts"
        end = time.monotonic() + SECONDS
        while len(list(parts.glob("block-*"))) < 4 and running.poll() is None and time.monotonic() < end:
            time.sleep(0.01)
        running.send_signal(signal.SIGINT)
        _, said = running.communicate(timeout=SECONDS)
        self.assertEqual(running.returncode, INTERRUPTED, said)
        self.assertRegex(said, r"1 of 1 batches and \d+ single designs are in .*: --resume goes on from them")
        done = self.run_program(*options, "--resume", case=case)
        self.assertRegex(done.stderr, r"1 batches and \d+ single designs were there already")
        self.assertFalse(parts.exists())
        self.run_program(*options, case=case, out=self.folder / "whole")
        self.assertEqual((self.out / "evaluations.csv").read_bytes(), (self.folder / "whole" / "evaluations.csv").read_bytes())

    def test_quantiles_are_those_of_uncertainty(self):
        case = self.folder / "case.toml"
        case.write_text(self.case.read_text() + '\n[uncertainty]\n"pump.bore_diameter_mm" = "normal(0.05)"\n"pressure.delivery_bar" = "relative(0.01)"\n')
        options = ["--vary", "pump.tilt_deg=25:42", "--minimise", "q95:peak:Rb1", "--subject-to", "q5:displacement_cm3 >= 50",
                   "--samples", "200", "--population", "8", "--generations", "4", "--restarts", "1"]
        done = self.run_program(*options, case=case)
        self.assertIn("lowest q95:peak:Rb1 (chosen_1.toml)", done.stdout)
        chosen = rows_of(self.out / "front.csv")[0]
        subprocess.run([PROGRAM, "uncertainty", self.out / "chosen_1.toml", "--set", "operation.samples_per_revolution=36", "--output",
                        "peak:Rb1,displacement_cm3", "--samples", "200", "--level", "0.9", "--out", self.folder / "u"],
                       check=True, capture_output=True, timeout=SECONDS)
        stated = {row["output"]: row for row in rows_of(self.folder / "u" / "outputs.csv")}
        self.assertTrue(math.isclose(float(chosen["q95:peak:Rb1"]), float(stated["peak:Rb1"]["high"]), rel_tol=1e-12))
        self.assertTrue(math.isclose(float(chosen["q5:displacement_cm3"]), float(stated["displacement_cm3"]["low"]), rel_tol=1e-12))
        report = json.loads((self.out / "report.json").read_text())
        facts = [fact for section in report["runs"] for fact in section["facts"]]
        self.assertTrue(any("200 samples of [uncertainty]" in str(fact) for fact in facts))
        self.assertIn("needs [uncertainty]", self.refused_again("--vary", "pump.tilt_deg=25:42", "--minimise", "q95:peak:Rb1"))

    def refused_again(self, *options):
        shutil.rmtree(self.out)
        return self.refused(*options)

    def test_random_and_grid_search_stand_beside_it(self):
        done = self.run_program(*FRONT)
        report = json.loads((self.out / "report.json").read_text())
        table = next(s for s in report["runs"] if s["title"] == "Against random and grid search")["table"]
        self.assertEqual([row[0] for row in table["rows"]], ["optimise", "random", "grid"])
        volume = table["columns"].index("volume, %")
        self.assertEqual(table["rows"][0][volume], 100)
        evaluated = len(rows_of(self.out / "evaluations.csv"))
        self.assertEqual([row[1] for row in table["rows"][:2]], [evaluated, evaluated])
        self.assertIn(f"For comparison: random search with {evaluated} designs dominates ", done.stdout)
        done = self.run_program(*FRONT, "--comparison", "no", out=self.folder / "without")
        self.assertNotIn("For comparison", done.stdout)
        self.assertEqual((self.out / "front.csv").read_bytes(), (self.folder / "without" / "front.csv").read_bytes())

    def test_a_search_that_does_not_fit_into_memory_is_refused(self):
        command = self.command("--vary", "pump.tilt_deg=25:42", "--minimise", "peak:Rb1", "--population", 100000, "--generations", 900,
                               "--restarts", 1)
        size = 4 << 30  # its address space; the designs would take some 9 GB
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=SECONDS,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (size, size)))
        self.assertEqual(done.returncode, BAD_INPUT, done.stderr)
        self.assertIn("90100000 designs", done.stderr)
        self.assertIn("lower --population, --generations or --restarts", done.stderr)
        self.assertFalse(self.out.exists())

    def test_two_processes_find_what_one_finds(self):
        mpirun = shutil.which("mpirun")
        if mpirun is None or "MPI none" in subprocess.run([PROGRAM, "--version"], capture_output=True, text=True).stdout:
            self.skipTest("no MPI")
        environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        # By the kernel of the closed form; by runs, whose designs of the gradients are kept one by one; with quantiles.
        uncertain = self.folder / "case.toml"
        uncertain.write_text(self.case.read_text() + '\n[uncertainty]\n"pump.bore_diameter_mm" = "normal(0.05)"\n')
        small = ["--population", "16", "--generations", "1", "--restarts", "1"]
        for name, options in (("front", [*FRONT[:-4], "--population", "160", "--generations", "3"]),
                              ("runs", [*FRONT[:4], "--minimise", "rms:budget.Td_inertia", "--subject-to", "displacement_cm3 >= 50", *small]),
                              ("quantiles", [*FRONT[:4], "--minimise", "q95:peak:Rb1", "--maximise", "q5:displacement_cm3", *small])):
            with self.subTest(name):
                one, two = (self.folder / f"{name}_{ranks}" for ranks in (1, 2))
                done = subprocess.run([mpirun, "--oversubscribe", "-n", "2", *self.command(*options, case=uncertain, out=two)],
                                      cwd=self.folder, env=environment, capture_output=True, text=True, timeout=SECONDS)
                self.assertEqual(done.returncode, DONE, done.stderr)
                self.run_program(*options, case=uncertain, out=one)
                self.assertEqual((two / "front.csv").read_bytes(), (one / "front.csv").read_bytes())


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
    REPO = pathlib.Path(sys.argv[2]).resolve()
    if "search none" in subprocess.run([PROGRAM, "--version"], capture_output=True, text=True).stdout:
        print("built without pagmo and NLopt: skipped")
        sys.exit(0)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
