#!/usr/bin/env python3
"""Tests of `bentaxis rattle` from outside: files, options, interruption and resumption.

usage: rattle_command_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import csv
import hashlib
import json
import pathlib
import re
import signal
import sys
import time
import unittest

import command_line_test as program
from command_line_test import INTERRUPTED, ProgramTest

FILES = {"report.html", "report.json", "rattle.csv"}


class RattleTest(ProgramTest):
    def command(self, *options, speeds="1000:2000:#2", delivery="100:300:#3", out="out"):
        return ("rattle", program.REPO / "cases" / "bap63_tooth_rattle.toml", "--turns", 2, "--discard", 2,
                "--speeds", speeds, "--delivery-bar", delivery, "--out", out, *options)

    def files(self, out="out"):
        return {path.name for path in (self.folder / out).iterdir()}

    def table(self, out="out"):
        with open(self.folder / out / "rattle.csv", newline="") as file:
            return list(csv.DictReader(file))

    def test_files_of_a_map(self):
        result = self.run_program(*self.command())
        self.assertEqual(self.files(), FILES)
        self.assertIn("of 6 points", result.out)
        rows = self.table()
        self.assertEqual(len(rows), 12)
        self.assertEqual({row["sweep"] for row in rows}, {"up", "down"})
        for row in rows:
            self.assertAlmostEqual(sum(float(row[f"share_{key}"]) for key in ("apart", "plus", "minus")), 1, 9)
            self.assertAlmostEqual(float(row["largest_over_mean"]), float(row["largest_N"]) / float(row["mean_N"]), 9)
            self.assertLess(float(row["rigid_least_N"]), float(row["rigid_greatest_N"]))
        report = json.loads((self.folder / "out" / "report.json").read_text())
        figure = {f["id"]: f for f in report["figures"]}["classes"]
        names = [figure["classes"][int(k)] for line in figure["values"] for k in line]
        self.assertEqual(names, [row["class"] for row in rows if row["sweep"] == "up"])
        sections = {s["title"]: s for s in report["runs"]}
        facts = dict(sections["How it was computed"]["facts"])
        # Thresholds as docs/rattle.md has them.
        for name, text in (("impact", "a touch at 0.001 m/s "), ("loses contact", " 1e-06 of the time"), ("discarded", "2 turns,"),
                           ("two steady states", " 10 % larger"), ("repeats itself", "1 to 4 turns ago, within 0.001 ")):
            self.assertIn(text, facts[name])
        for name, up, down, most, apart in sections["Classes"]["table"]["rows"]:
            of = [row for row in rows if row["class"] == name]
            rising = [row for row in of if row["sweep"] == "up"]
            self.assertEqual((up, down), (len(rising), len(of) - len(rising)))
            if rising:
                self.assertAlmostEqual(most, max(float(row["largest_over_mean"]) for row in rising), 9)
                self.assertAlmostEqual(apart, sum(float(row["share_apart"]) for row in rising) / up, 9)
            else:
                self.assertEqual((most, apart), (None, None))

    def test_a_map_with_drag_has_its_boundary(self):
        self.run_program(*self.command("--set", "friction.block_viscous_Nm_per_rpm=0.0054", speeds="300:1900:#3"))
        report = json.loads((self.folder / "out" / "report.json").read_text())
        table = {s["title"]: s["table"] for s in report["runs"]}["Boundary by the criterion"]
        self.assertEqual([row[0] for row in table["rows"]], [100, 200, 300])
        criterion = [row[1] for row in table["rows"]]
        self.assertEqual(criterion, sorted(criterion))
        (line,) = {f["id"]: f for f in report["figures"]}["classes"]["lines"]
        self.assertEqual(line["x"], criterion)

    def test_an_interrupted_map_goes_on(self):
        command = self.command(delivery="100:300:#12")
        self.run_program(*command, "--threads", 2)
        whole = (self.folder / "out" / "rattle.csv").read_bytes()

        process = self.start(*command, "--threads", 1)
        partial = self.folder / "out" / "rattle.partial.csv"
        end = time.monotonic() + program.SECONDS
        while not partial.exists() and process.poll() is None and time.monotonic() < end:
            time.sleep(0.002)
        process.send_signal(signal.SIGINT)
        self.finish(process, INTERRUPTED)
        self.assertRegex(process.err, "^bentaxis: out holds an earlier map until this one is finished\nbentaxis: interrupted; [0-9]+ of 12 rows are in out/rattle.partial.csv: --resume goes on")
        self.assertEqual(self.files(), FILES | {"rattle.partial.csv"})  # those of the earlier map
        self.assertEqual((self.folder / "out" / "rattle.csv").read_bytes(), whole)
        kept = partial.read_text().count("\nrow,")
        self.assertGreater(kept, 0)
        self.assertLess(kept, 12)

        # Another case, other options: refused, and nothing is touched.
        for more in (["--set", "gear.backlash_um=21"], ["--error", "1e-4"]):
            self.assert_mentions(self.refused(*command, "--resume", *more), "rattle.partial.csv", "another case")
        # Rows that are there are taken as they are.
        text = partial.read_text()
        (self.folder / "out" / "rattle.csv").unlink()
        self.run_program(*command, "--resume")
        self.assertEqual((self.folder / "out" / "rattle.csv").read_bytes(), whole)
        self.assertEqual(self.files(), FILES)
        first = text.split("\nup,")[1].split(",")[4]  # largest_N of a point
        changed = text.replace(f",{first},", ",4321,")
        partial.write_text(changed)
        self.assert_mentions(self.refused(*command, "--resume"), "rattle.partial.csv", "row 1 is damaged")
        head, *rows = re.split(r"(?m)^(?=row,)", changed)
        origin = head.splitlines()[1][2:]
        for i, row in enumerate(rows):
            numbers = row[:row.index("sum,")]
            rows[i] = f"{numbers}sum,{hashlib.sha256(f'{origin}{chr(10)}{numbers}'.encode()).hexdigest()}\n"
        partial.write_text(head + "".join(rows))
        self.run_program(*command, "--resume")
        self.assertIn(",4321,", (self.folder / "out" / "rattle.csv").read_text())

    def test_two_maps_in_one_folder(self):
        command = self.command(delivery="100:300:#12")
        first = self.start(*command, "--threads", 1)
        partial, end = self.folder / "out" / "rattle.partial.csv", time.monotonic() + program.SECONDS
        while not partial.exists() and first.poll() is None and time.monotonic() < end:
            time.sleep(0.002)
        first.send_signal(signal.SIGSTOP)
        for more in ((), ("--resume",), ("--error", "1e-4")):
            self.assert_mentions(self.refused(*command, *more), "out: another rattle map is running in this directory", f"process {first.pid} on ")
        first.kill()
        first.communicate()
        self.assertEqual(self.files(), {"rattle.partial.csv", "rattle.partial.lock"})
        (self.folder / "out" / "rattle.partial.csv.host-1-1.part").write_text("half")
        self.run_program(*command, "--resume")
        self.assertEqual(self.files(), FILES)

    def test_an_interruption_before_the_first_row_names_the_rows_of_an_earlier_run(self):
        (self.folder / "out").mkdir()
        partial = self.folder / "out" / "rattle.partial.csv"
        partial.write_text("rows of an earlier run")
        process = self.start(*self.command(delivery="20:21:#2", speeds="200:201:#2"), "--threads", 1)
        lock, end = self.folder / "out" / "rattle.partial.lock", time.monotonic() + program.SECONDS
        while not lock.exists() and process.poll() is None and time.monotonic() < end:
            time.sleep(0.001)
        process.send_signal(signal.SIGINT)
        self.finish(process, INTERRUPTED)
        self.assertEqual(process.err, "bentaxis: interrupted; out/rattle.partial.csv still holds the rows of an earlier run\n")
        self.assertEqual(partial.read_text(), "rows of an earlier run")

    def test_resume_without_rows_begins(self):
        self.run_program(*self.command("--resume", delivery="100:100:#1"))
        self.assertEqual(self.files(), FILES)

    def test_spacing(self):
        for speeds, expected in (("1000", [1000]), ("1000:1500:200", [1000, 1200, 1400]), ("1000:1500:#3", [1000, 1250, 1500])):
            self.run_program("rattle", program.REPO / "cases/bap63_rated.toml", "--speeds", speeds, "--delivery-bar", "100", "--out", "out")
            with open(self.folder / "out" / "rattle.csv") as file:
                rows = [row for row in csv.DictReader(file) if row["sweep"] == "up"]
            self.assertEqual([float(row["speed_rpm"]) for row in rows], expected)

    def test_bad_options(self):
        for options, word in (
            ({"speeds": "1000:2000"}, "FROM:TO:#N"),
            ({"speeds": "1000:2000:x"}, "FROM:TO:STEP"),
            ({"speeds": "0:2000:#3"}, "in rpm, >= 1"),
            ({"speeds": "2000:1000:#3"}, "FROM < TO"),
            ({"speeds": "1000:2000:#1"}, "#1"),
            ({"speeds": "1000:2000:#2.5"}, "an integer"),
            ({"speeds": "1000:2000:0"}, "STEP > 0"),
            ({"delivery": "-5:100:3"}, "in bar, >= 0"),
            ({"delivery": "100:200:#1001"}, "1000"),
            ({"delivery": "100:2000:1"}, "1000"),
            ({"delivery": "#3"}, "FROM:TO:#N"),
            ({"delivery": "x"}, "must be a list of numbers with commas (100,200), FROM:TO:STEP, FROM:TO:#N or one number, in bar, >= 0"),
            ({"speeds": "x"}, "must be a list of numbers with commas (100,200), FROM:TO:STEP, FROM:TO:#N or one number, in rpm, >= 1"),
            ({"delivery": "0,100:200:5"}, "\"100:200:5\" must be a number in bar, >= 0; a range is FROM:TO:STEP or FROM:TO:#N, without a list"),
            ({"delivery": "nan:200:#3"}, "FROM:TO:STEP"),
            ({"speeds": "1000,1500,1e3"}, "--speeds 1000,1500,1e3: 1000 is specified more than once"),
            ({"delivery": "100,100"}, "--delivery-bar 100,100: 100 is specified more than once"),
        ):
            with self.subTest(options):
                option = "--speeds" if "speeds" in options else "--delivery-bar"
                self.assert_mentions(self.refused(*self.command(**options)), option, word)
        for option, value in (("--error", "0"), ("--check-points", "-1"), ("--threads", "x")):
            self.assert_mentions(self.refused(*self.command(option, value)), option)
        self.assert_mentions(self.refused(*self.command("--turns", 0)[:2], "--speeds", "1:2:#2"), "--delivery-bar")
        self.assert_mentions(self.refused(*self.command("--speeds", "1000,1500")), "--speeds is given more than once")
        self.assert_mentions(self.refused(*self.command("--set", "friction.regularization_m_per_s=0")), "regularization_m_per_s")
        rigid = ("rattle", program.REPO / "cases/bap63_rated.toml", "--speeds", "1000:1500:#2", "--delivery-bar", "100:200:#2")
        self.assert_mentions(self.refused(*rigid, "--check-points", 3), "--check-points", "rigid")

    def test_check_counts_for_the_status(self):
        result = self.run_program(*self.command("--check-points", 1, speeds="1500:1500:#1", delivery="275:275:#1"))
        self.assertIn("Simbody agrees at 1 of 1 points", result.out)
        self.assertRegex(result.out, r"[a-z] at 1 of 1 points.*; Simbody")  # the class it has
        other = ("--set", "friction.block_viscous_Nm_per_rpm=0.0054", "--set", "friction.piston_coulomb_N=500",
                 "--set", "assumptions.multibody.piston_friction=false", "--check-points", 1)
        result = self.run_program(*self.command(*other, speeds="1500:1500:#1", delivery="100:100:#1"), status=1)
        self.assertIn("Simbody agrees at 0 of 1 points", result.out)

    def test_rigid_teeth_and_hydraulic_pressure(self):
        self.run_program("rattle", program.REPO / "cases" / "bap63_rated_hydraulic.toml", "--speeds", "500:1500:#2",
                         "--delivery-bar", "275:275:#1", "--out", "out")
        self.assertEqual([row["class"] for row in self.table()], ["reverses"] * 2 + ["carries"] * 2)

    def test_pressures_that_could_not_be_computed_count(self):
        teeth = [word for change in ("contact=compliant", "flanks=two", "stiffness_N_per_um=100", "backlash_um=20", "dissipation_s_per_m=0.5")
                 for word in ("--set", "gear." + change)]
        result = self.run_program("rattle", program.REPO / "cases" / "bap63_rated_hydraulic.toml", *teeth, "--speeds", "60,80", "--delivery-bar",
                                  "50,275", "--turns", 2, "--discard", 2, "--out", "out", status=3)
        self.assertIn("hits both flanks at 2 of 4 points, 2 could not be computed", result.out)
        self.assertIn("At 50 bar, of the pressures of the map that could be computed the nearest to the case's 275 bar: ", result.out)
        self.assertIn("Could not be computed: 275 bar.", result.out)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
