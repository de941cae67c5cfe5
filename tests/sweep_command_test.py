#!/usr/bin/env python3
"""Tests of `bentaxis sweep` and `bentaxis merge` from outside: files, ranks, parts, interruption and resumption.

usage: sweep_command_test.py BENTAXIS REPO_ROOT [options of unittest]      (Debian's python3, with h5py)
"""

import csv
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time
import unittest

import command_line_test as program
from command_line_test import INTERRUPTED, OUT_OF_TOLERANCE, ProgramTest

try:
    import h5py
except ImportError:
    h5py = None

MPIRUN = shutil.which("mpirun")
RESULTS = ("sweep.csv", "sweep.h5", "sweep_checks.csv")
RANKS = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


class SweepTest(ProgramTest):
    def command(self, *options, case="bap63_rated.toml", out="out", samples=36, **vary):
        vary = vary or {"pump.tilt_deg": "20:100:#21", "pressure.delivery_bar": "50:400:#10"}
        return ["sweep", program.REPO / "cases" / case, "--set", f"operation.samples_per_revolution={samples}",
                "--out", out, *(word for item in vary.items() for word in ("--vary", "=".join(item))),
                *(options if "--output" in options else ("--output", "max:Rb1_z1,peak:Rb1,mean:Td", *options))]

    def rows(self, out="out", name="sweep.csv"):
        with open(self.folder / out / name, newline="") as file:
            return list(csv.DictReader(file))

    def results(self, out):
        return {name: (self.folder / out / name).read_bytes() for name in RESULTS if (self.folder / out / name).exists()}

    def ranks(self, count, *arguments):
        command = [MPIRUN, "--oversubscribe", "-n", str(count), program.PROGRAM, *map(str, arguments)]
        return subprocess.Popen(command, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True, env=os.environ | RANKS, start_new_session=True)

    @staticmethod
    def has(library):
        """Whether the program is built with an optional library."""
        said = subprocess.run([program.PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout
        return f"{library} none" not in said

    def with_mpi(self):
        """Whether program and machine can run in ranks; what cannot is said, not passed over."""
        if MPIRUN is None:
            self.skipTest("no mpirun")
        if not self.has("MPI"):
            self.skipTest("built without MPI")

    # ---- What is in the files ------------------------------------------------------------------------

    def test_numbers_are_those_of_run(self):
        self.run_program(*self.command("--check", "20%"))
        rows = self.rows()
        self.assertEqual(len(rows), 210)
        self.assertEqual([row["design"] for row in rows], [str(i) for i in range(210)])
        for i, row in enumerate(rows[:20]):  # the last variable fastest
            self.assertAlmostEqual(float(row["pressure.delivery_bar"]), 50 + 350 * (i % 10) / 9, 9)
            self.assertEqual(float(row["pump.tilt_deg"]), 20 + 4 * (i // 10))
        row = rows[37]
        self.run_program("run", program.REPO / "cases/bap63_rated.toml", "--model", "analytic", "--out", "run",
                         "--set", "operation.samples_per_revolution=36", "--set", f"pump.tilt_deg={row['pump.tilt_deg']}",
                         "--set", f"pressure.delivery_bar={row['pressure.delivery_bar']}")
        table = self.rows("run", "analytic.csv")
        axial = [float(line["Rb1_z1_N"]) for line in table]
        peak = max(math.hypot(*(float(line[f"Rb1_{axis}1_N"]) for axis in "xyz")) for line in table)
        torque = sum(float(line["Td_z1_Nm"]) for line in table) / 36
        for found, expected in ((row["max:Rb1_z1_N"], max(axial)), (row["peak:Rb1 [N]"], peak), (row["mean:Td [Nm]"], torque)):
            self.assertLess(abs(float(found) - expected), 1e-12 * abs(expected))
        # Infeasible designs are data with their reason.
        for row in rows:
            infeasible = float(row["pump.tilt_deg"]) >= 90
            self.assertEqual(row["reason"] != "", infeasible)
            self.assertEqual(row["mean:Td [Nm]"] == "", infeasible)
            if infeasible:
                self.assert_mentions(row["reason"], "tilt_deg", row["pump.tilt_deg"], "[0, 90)")
        # What was checked: about a fifth (standard deviation 5.8 designs), all of it agreeing.
        checks = self.rows(name="sweep_checks.csv")
        self.assertLess(abs(len(checks) / 3 - 42), 4 * 5.8)
        for row in checks:
            self.assertEqual(row["agrees"], "" if row["own_reason"] and row["other_reason"] else "1")
        self.assertIn("30 infeasible", json.loads((self.folder / "out" / "report.json").read_text())["verdict"]["headline"])

    def test_a_program_without_its_modules_writes_csv(self):
        if not self.has("HDF5"):
            self.skipTest("built without HDF5")
        (self.folder / "bin").mkdir()
        alone = shutil.copy(program.PROGRAM, self.folder / "bin/bentaxis")

        def run(*arguments):
            return subprocess.run([alone, *map(str, self.command(*arguments))], cwd=self.folder, capture_output=True, text=True)
        refused = run("--format", "hdf5")
        self.assertEqual(refused.returncode, 2)
        self.assert_mentions(refused.stderr, "--format hdf5", "bentaxis_hdf5.so", str(self.folder / "lib/bentaxis"))
        self.assertFalse((self.folder / "out").exists())
        self.assertEqual(run().returncode, 0)
        self.assertTrue((self.folder / "out/sweep.csv").exists())
        self.assertFalse((self.folder / "out/sweep.h5").exists())

    @unittest.skipIf(h5py is None, "no h5py")
    def test_hdf5_holds_the_same_and_says_what_it_is(self):
        if not self.has("HDF5"):
            self.assert_mentions(self.refused(*self.command("--format", "hdf5")), "--format hdf5", "libhdf5-dev")
            self.skipTest("built without HDF5")
        vary = {"pump.tilt_deg": "20:100:#21", "piston.inertia": "lumped,real"}
        self.run_program(*self.command("--check", "10%", **vary))
        rows = self.rows()
        with h5py.File(self.folder / "out" / "sweep.h5") as file:
            self.assertEqual(set(file["designs"]), set(vary))
            self.assertEqual(dict(file["designs/pump.tilt_deg"].attrs) | {"meaning": ""},
                             {"unit": "deg", "symbol": "alpha", "meaning": ""})
            self.assertEqual(file["designs/piston.inertia"].attrs["words"], "lumped,real,dynamically_equivalent")
            self.assertEqual([("lumped", "real")[int(i)] for i in file["designs/piston.inertia"]],
                             [row["piston.inertia"] for row in rows])
            for column, name in (("max:Rb1_z1_N", "max:Rb1_z1_N"), ("peak:Rb1 [N]", "peak:Rb1"), ("mean:Td [Nm]", "mean:Td")):
                set_ = file["outputs"][name]
                self.assertEqual(set_.attrs["unit"], "Nm" if "Td" in name else "N")
                self.assertIn(name.split(":")[0] + " of ", set_.attrs["meaning"])
                self.assertIsNotNone(set_.chunks)
                for number, row in zip(set_, rows):
                    self.assertTrue(math.isnan(number) if row[column] == "" else number == float(row[column]))
            self.assertEqual([text.decode() for text in file["reason"]], [row["reason"] for row in rows])
            self.assertIn("tilt_deg = 40", file.attrs["case"])
            self.assertIn('parameter = "pump.tilt_deg"', file.attrs["plan"])
            checks = self.rows(name="sweep_checks.csv")
            self.assertEqual(len(file["checks/design"]) * 3, len(checks))
            self.assertEqual(int(file["checks/design"][0]), int(checks[0]["design"]))
            # Plan and case of the file are enough to compute it again.
            (self.folder / "case.toml").write_text(file.attrs["case"])
            (self.folder / "plan.toml").write_text(file.attrs["plan"])
        self.run_program("sweep", "case.toml", "--study", "plan.toml", "--out", "again")
        self.assertEqual(self.results("again")["sweep.csv"], self.results("out")["sweep.csv"])

    def test_samples(self):
        vary = {"pump.tilt_deg": "normal(30, 1)", "pump.axis_offset_mm": "-1:1", "piston.inertia": "lumped",
                "pump.pistons": "5:9"}
        for sampling in ("lhs", "sobol", "random"):
            self.run_program(*self.command("--sampling", sampling, "--samples", 256, "--seed", 3, out=sampling, **vary))
            rows = self.rows(sampling)
            tilts = [float(row["pump.tilt_deg"]) for row in rows]
            self.assertLess(abs(sum(tilts) / 256 - 30), 4 / 16)
            self.assertTrue(all(-1 < float(row["pump.axis_offset_mm"]) < 1 for row in rows))
            counts = [sum(row["pump.pistons"] == str(n) for row in rows) for n in range(5, 10)]
            self.assertEqual(sum(counts), 256)
            for count in counts:  # a fifth each, within four standard deviations of random ones
                self.assertLess(abs(count - 51.2), 4 * 6.4)
        self.run_program(*self.command("--sampling", "lhs", "--samples", 256, "--seed", 4, out="other", **vary))
        self.assertNotEqual(self.results("lhs")["sweep.csv"], self.results("other")["sweep.csv"])

    def test_what_no_printed_digit_tells_apart_is_the_same(self):
        out = self.run_program(*self.command("--output", "mean:Td", **{"pump.tilt_deg": "40:40.000001:#2"})).out
        self.assertRegex(out, r"\nmean:Td is [\d.]+ Nm in every design, to the digits that are printed\.\n")
        self.assertNotIn("lowest", out)

    def test_best_designs_say_whether_they_are_valid(self):
        """As show says of the design by itself. In bap63_rated a bottom area of 50 mm2 lets the block lift off."""
        vary = {"block.bottom_area_mm2": "50,250"}
        for options, design, valid in ((("--minimise", "max:Fh_z2"), 1, True), (("--maximise", "max:Fh_z2"), 0, False)):
            result = self.run_program(*self.command("--output", "max:Fh_z2", *options, **vary))
            report = json.loads((self.folder / "out" / "report.json").read_text())
            headline, answers = report["verdict"]["headline"], report["verdict"]["answers"]
            area = vary["block.bottom_area_mm2"].split(",")[design]
            self.run_program("show", program.REPO / "cases" / "bap63_rated.toml", "--set", "operation.samples_per_revolution=36", "--set",
                             f"block.bottom_area_mm2={area}", "--out", "alone")
            alone = json.loads((self.folder / "alone" / "report.json").read_text())["verdict"]
            self.assertEqual(alone.get("not_valid", "") == "", valid)
            self.assertTrue(headline.endswith("the best design is valid over the whole turn" if valid
                                              else "the best design is not valid over the whole turn"), headline)
            self.assertIn(headline, result.out)
            table = next(run for run in report["runs"] if run["title"] == "Best designs")
            said = "valid over the whole turn" if valid else f"not valid {alone['not_valid']}"
            self.assertIn({"name": f"design {design}", "value": said}, [dict(zip(("name", "value"), fact)) if isinstance(fact, list) else fact
                                                                       for fact in table["facts"]])
            self.assertEqual(report["verdict"].get("not_valid", ""), "" if valid else "for 1 of 1 best designs")
            if not valid:
                self.assertTrue(answers[0].endswith(f"; not valid {alone['not_valid']}."), answers)
                for limit in (a for a in alone["answers"] if a.startswith("Not valid")):
                    self.assertIn(f"Design {design}: {limit}", answers)
                self.assertIn("--output validity.film.share", answers[-1])

    def test_a_study_file_and_options_on_top(self):
        (self.folder / "study.toml").write_text(
            'sampling = "grid"\noutput = ["mean:Td"]\nminimise = ["peak:Rb1"]\n\n'
            '[[vary]]\nparameter = "pump.tilt_deg"\nvalues = "20:40:10"\n\n'
            '[[vary]]\nparameter = "operation.speed_rpm"\nvalues = "log(100:10000:#3)"\n')
        case = program.REPO / "cases/bap63_rated.toml"
        self.run_program("sweep", case, "--study", "study.toml", "--vary", "pump.tilt_deg=30,35", "--out", "out")
        self.assertEqual([(row["operation.speed_rpm"], row["pump.tilt_deg"]) for row in self.rows()],
                         [(n, a) for n in ("100", "1000", "10000") for a in ("30", "35")])
        (self.folder / "study.toml").write_text('samplings = "grid"\n')
        self.assert_mentions(self.refused("sweep", case, "--study", "study.toml"), "study.toml", "samplings")

    def test_steps_are_the_numbers_that_are_meant(self):
        """0.1 + 0.2 is 0.3 and not 0.30000000000000004."""
        self.run_program("sweep", program.REPO / "cases/bap63_rated.toml", "--vary", "pressure.suction_bar=0.1:0.7:0.2",
                         "--vary", "pump.tilt_deg=20:30:#4", "--output", "mean:Td", "--out", "out")
        self.assertEqual({row["pressure.suction_bar"] for row in self.rows()}, {"0.1", "0.3", "0.5", "0.7"})
        self.assertEqual({row["pump.tilt_deg"] for row in self.rows()}, {"20", "23.3333333333333", "26.6666666666667", "30"})

    def test_a_study_file_without_a_seed_has_seed_1(self):
        (self.folder / "study.toml").write_text('sampling = "random"\nsamples = 8\noutput = ["mean:Td"]\n\n'
                                                '[[vary]]\nparameter = "pump.tilt_deg"\nvalues = "20:40"\n')
        tables = []
        for seed in ((), ("--seed", "1"), ("--seed", "2")):
            out = "seed" + "".join(seed[1:])
            self.run_program("sweep", program.REPO / "cases/bap63_rated.toml", "--study", "study.toml", *seed, "--out", out)
            tables.append(self.results(out)["sweep.csv"])
        self.assertEqual(tables[0], tables[1])
        self.assertNotEqual(tables[0], tables[2])

    def test_hydraulic_pressure(self):
        self.run_program(*self.command("--output", "hydraulics.flow_l_per_min,efficiency.overall,mean:Td,efficiency.overall_iso,"
                                       "efficiency.volumetric_iso,efficiency.mechanical_mass", "--check", "1%",
                                       case="bap63_rated_hydraulic.toml", samples=60, **{"operation.speed_rpm": "1000:2000:#3"}))
        flows = [float(row["hydraulics.flow_l_per_min [l/min]"]) for row in self.rows()]
        self.assertEqual(flows, sorted(flows))
        # At least one design, six outputs.
        self.assertEqual(len(self.rows(name="sweep_checks.csv")), 6)
        for row in self.rows():
            self.assertLess(float(row["efficiency.overall_iso [%]"]), float(row["efficiency.overall [%]"]))

    def test_a_disagreement_is_reported_and_counts(self):
        result = self.run_program(*self.command("--check", "100%", "--set", "assumptions.multibody.inertia=lumped",
                                                "--set", "assumptions.analytic.inertia=real", **{"pump.tilt_deg": "20:40:#3"}),
                                  status=OUT_OF_TOLERANCE)
        self.assertIn("design 0, peak:Rb1: ", result.out)
        self.assertIn("0", {row["agrees"] for row in self.rows(name="sweep_checks.csv")})

    # ---- Blocks --------------------------------------------------------------------------------------

    def test_threads_and_ranks_give_the_same(self):
        whole = self.command("--check", "5%")
        self.run_program(*whole, "--threads", 1)
        expected = self.results("out")
        self.assertEqual(set(expected), set(RESULTS) - (set() if self.has("HDF5") else {"sweep.h5"}))
        self.run_program(*self.command("--check", "5%", out="two"), "--threads", 2)
        self.assertEqual(self.results("two"), expected)
        self.with_mpi()
        for count in (1, 2, 3):
            self.finish(self.ranks(count, *self.command("--check", "5%", out=f"ranks{count}")), 0)
            self.assertEqual(self.results(f"ranks{count}"), expected)
            self.assertFalse((self.folder / f"ranks{count}" / "sweep.parts").exists())

    def test_ranks_refuse_together(self):
        self.with_mpi()
        process = self.ranks(3, *self.command(**{"pump.tilt": "1,2"}))
        out, err = process.communicate(timeout=program.SECONDS)
        self.assertEqual(process.returncode, 2, err)
        self.assertEqual(err.count("no such parameter"), 1, err)
        self.assertFalse((self.folder / "out").exists())

    def test_parts_and_merge(self):
        self.run_program(*self.command("--check", "5%", out="whole"))
        for part in (1, 2):
            self.run_program(*self.command("--check", "5%", "--part", f"{part}/3"))
        self.assertFalse((self.folder / "out" / "sweep.csv").exists())
        # The third part is missing: blocks 2, 5, 8, ..
        line = self.refused("merge", "out")
        self.assert_mentions(line, "sweep.parts", "missing or damaged: 2, 5, 8")
        self.run_program(*self.command("--check", "5%", "--part", "3/3", out="elsewhere"))
        self.run_program("merge", "out", "elsewhere")
        self.assertEqual(self.results("out"), self.results("whole"))
        # Blocks of two sweeps do not mix, in one folder or in several.
        other = self.command("--check", "6%", "--part", "3/3", out="elsewhere")
        self.assert_mentions(self.refused(*other), "elsewhere/sweep.parts", "another case or plan")
        shutil.rmtree(self.folder / "elsewhere")
        self.run_program(*other)
        self.assert_mentions(self.refused("merge", "out", "elsewhere"), "elsewhere/sweep.parts", "another case")
        self.assert_mentions(self.refused("merge", "nowhere"), "nowhere")

    def test_a_block_under_the_name_of_another_is_not_taken(self):
        self.run_program(*self.command("--check", "5%", out="whole"))
        self.run_program(*self.command("--check", "5%", "--part", "1/1"))  # one part leaves no blocks behind ..
        self.assertFalse((self.folder / "out" / "sweep.parts").exists())
        for part in (1, 2):
            self.run_program(*self.command("--check", "5%", "--part", f"{part}/2"))
        parts = self.folder / "out" / "sweep.parts"
        shutil.copy(parts / "block-000005.bin", parts / "block-000011.bin")
        self.assert_mentions(self.refused("merge", "out"), "sweep.parts", "1 hold the designs of another block: 11")
        result = self.run_program(*self.command("--check", "5%", "--resume"))
        self.assertRegex(result.err, "held the designs of another block, and the blocks were computed again: 11\nbentaxis: 209 blocks were")
        self.assertEqual(self.results("out"), self.results("whole"))

    def interrupted(self, process, how, parts=pathlib.Path("out/sweep.parts")):
        """Ends a run in the middle; returns the finished blocks."""
        end = time.monotonic() + program.SECONDS
        while len(list((self.folder / parts).glob("*.bin"))) < 3 and process.poll() is None and time.monotonic() < end:
            time.sleep(0.002)
        how(process)
        return process

    def slow(self, *options, out="out"):
        return self.command("--model", "multibody", *options, out=out, samples=120,
                            **{"pump.tilt_deg": "20:40:#12", "pressure.delivery_bar": "50:400:#12"})

    def test_an_interrupted_sweep_goes_on(self):
        self.run_program(*self.slow(out="whole"))
        process = self.interrupted(self.start(*self.slow("--threads", 1)), lambda p: p.send_signal(signal.SIGINT))
        self.finish(process, INTERRUPTED)
        self.assertRegex(process.err, "^bentaxis: interrupted; [0-9]+ of 144 blocks are in out/sweep.parts: --resume goes on from them\n$")
        self.assertFalse((self.folder / "out" / "sweep.csv").exists())
        parts = self.folder / "out" / "sweep.parts"
        blocks = {file.name: file.stat().st_mtime_ns for file in parts.glob("*.bin")}
        self.assertTrue(3 <= len(blocks) < 144)
        # Another plan is refused, and nothing is touched.
        self.assert_mentions(self.refused(*self.slow("--resume", "--set", "operation.speed_rpm=1600")), "sweep.parts", "another case")
        # A block that was damaged is computed again; the others are taken as they are.
        damaged = parts / sorted(blocks)[0]
        content = damaged.read_bytes()
        damaged.write_bytes(content[:200] + bytes([content[200] ^ 1]) + content[201:])
        result = self.run_program(*self.slow("--resume"))
        self.assertIn(f"{len(blocks) - 1} blocks were there already", result.err)
        self.assertEqual(self.results("out"), self.results("whole"))
        self.assertEqual(sorted(os.listdir(self.folder / "out")), sorted(os.listdir(self.folder / "whole")))

    def test_an_interruption_while_results_are_written_says_what_is_there(self):
        vary = {"pump.tilt_deg": "20:40:#400", "pressure.delivery_bar": "50:400:#400"}
        process = self.start(*self.command(samples=3, **vary))
        parts, end = self.folder / "out" / "sweep.parts", time.monotonic() + program.SECONDS
        while len(list(parts.glob("*.bin"))) < 313 and process.poll() is None and time.monotonic() < end:
            time.sleep(0.001)
        process.send_signal(signal.SIGINT)
        self.finish(process, INTERRUPTED)
        self.assertEqual(process.err, "bentaxis: interrupted; 313 of 313 blocks are in out/sweep.parts: --resume goes on from them\n")
        self.assertEqual(os.listdir(self.folder / "out"), ["sweep.parts"])
        # The same of a merge: the blocks stay.
        process = self.start("merge", "out")
        while not list((self.folder / "out").glob(".bentaxis.part-*")) and process.poll() is None and time.monotonic() < end:
            time.sleep(0.001)
        process.send_signal(signal.SIGINT)
        self.finish(process, INTERRUPTED)
        self.assert_mentions(process.err, "no results were written", "the blocks stay where they are")
        self.assertEqual(os.listdir(self.folder / "out"), ["sweep.parts"])
        result = self.run_program(*self.command("--resume", samples=3, **vary))
        self.assertIn("313 blocks were there already", result.err)
        self.assertFalse(parts.exists())

    def test_two_sweeps_in_one_folder(self):
        self.run_program(*self.slow(out="whole"))
        first = self.interrupted(self.start(*self.slow("--threads", 1)), lambda p: p.send_signal(signal.SIGSTOP))
        for command in (self.slow(), self.slow("--resume"), self.slow("--part", "1/2"), ["merge", "out"],
                        self.slow("--set", "operation.speed_rpm=1600")):
            self.assert_mentions(self.refused(*command), "out/sweep.parts: another sweep is running in this directory", f"process {first.pid} on ")
        first.send_signal(signal.SIGCONT)
        self.finish(first, 0)
        self.assertEqual(self.results("out"), self.results("whole"))
        self.assertEqual(sorted(os.listdir(self.folder / "out")), sorted(os.listdir(self.folder / "whole")))
        # Parts of one sweep are computed side by side; a whole one is not computed beside them.
        one = self.interrupted(self.start(*self.slow("--part", "1/2", "--threads", 1)), lambda p: p.send_signal(signal.SIGSTOP))
        self.run_program(*self.slow("--part", "2/2"))
        self.assert_mentions(self.refused(*self.slow()), "another sweep is running in this directory")
        one.send_signal(signal.SIGCONT)
        self.finish(one, 0)
        self.run_program("merge", "out")
        self.assertEqual(self.results("out"), self.results("whole"))
        self.run_program(*self.slow("--resume"))
        self.assertFalse((self.folder / "out" / "sweep.parts").exists())

    def test_a_killed_sweep_leaves_nothing_behind_the_next(self):
        self.run_program(*self.slow(out="whole"))
        process = self.interrupted(self.start(*self.slow("--threads", 1)), lambda p: p.kill())
        process.communicate()
        parts = self.folder / "out" / "sweep.parts"
        self.assertTrue((parts / "lock").exists())
        (parts / "block-000003.bin.host-1-1.part").write_bytes(b"half of a block")
        self.run_program(*self.slow())
        self.assertEqual(sorted(os.listdir(self.folder / "out")), sorted(os.listdir(self.folder / "whole")))

    def test_a_full_disk(self):
        for limit, named in ((700, "sweep.parts/"), (10000, "out/sweep.csv"), (20000, "sweep.h5" if self.has("HDF5") else "report.html")):
            with self.subTest(limit):
                result = self.run_program(*self.command(), status=2, preexec_fn=lambda limit=limit: program.limit_files(limit))
                self.assert_mentions(result.err, named, "File too large")
                self.assertLessEqual({path.name for path in self.folder.glob("out/*")}, {"sweep.parts"})
                self.assertEqual(list(self.folder.glob("out/.*")) + list(self.folder.glob("out/sweep.parts/*.part")), [])
                if limit > 700:  # where the first block could be written
                    self.assertIn("210 of 210 blocks are in out/sweep.parts: --resume goes on from them", result.err)
        self.run_program(*self.command("--resume"))
        self.assertFalse((self.folder / "out" / "sweep.parts").exists())

    def test_a_killed_sweep_resumes_to_the_same_file(self):
        self.run_program(*self.slow(out="whole"))
        process = self.interrupted(self.start(*self.slow()), lambda p: p.kill())
        process.communicate()
        self.assertEqual(process.returncode, -signal.SIGKILL)
        result = self.run_program(*self.slow("--resume"))
        self.assertRegex(result.err, "[1-9][0-9]* blocks were there already")
        self.assertEqual(self.results("out"), self.results("whole"))

    def test_a_lost_rank_ends_the_run(self):
        self.with_mpi()
        self.run_program(*self.slow(out="whole"))

        def kill_one(process):
            ranks = [pid for pid in pathlib.Path("/proc").iterdir() if pid.name.isdigit() and self.is_rank_of(pid, process.pid)]
            self.assertEqual(len(ranks), 2)
            os.kill(int(ranks[1].name), signal.SIGKILL)

        process = self.interrupted(self.ranks(2, *self.slow()), kill_one)
        process.communicate(timeout=program.SECONDS)
        self.assertNotEqual(process.returncode, 0)
        self.assertFalse((self.folder / "out" / "sweep.csv").exists())
        self.finish(self.ranks(2, *self.slow("--resume")), 0)
        self.assertEqual(self.results("out"), self.results("whole"))

    @staticmethod
    def is_rank_of(pid, mpirun):
        try:
            status = (pid / "stat").read_text()
        except OSError:
            return False
        return int(status.rpartition(")")[2].split()[1]) == mpirun

    # ---- Refusals ------------------------------------------------------------------------------------

    def test_bad_options(self):
        case = program.REPO / "cases/bap63_rated.toml"
        output, vary = ("--output", "mean:Td"), ("--vary", "pump.tilt_deg=20:40:5")
        for options, words in (
            (output, ("--vary",)),
            (vary, ("--output",)),
            ((*output, "--vary", "pump.tilt_deg"), ("--vary pump.tilt_deg", "NAME=VALUES")),
            ((*output, "--vary", "pump.tilt_deg=20:40"), ("pump.tilt_deg = 20:40", "FROM:TO:STEP", "--sampling")),
            ((*output, "--vary", "pump.tilt_deg=a"), ("pump.tilt_deg = a", "number")),
            ((*output, "--vary", "pump.tilt_deg="), ("pump.tilt_deg", "values")),
            ((*output, *vary, "--vary", "pump.tilt_deg=30:40:5"), ("pump.tilt_deg", "more than once")),
            ((*output, "--vary", "pump.tilt_deg=log(0:40:#3)"), ("pump.tilt_deg", "0 < FROM")),
            ((*output, "--vary", "pump.tilt_deg=log(1:40:3)"), ("pump.tilt_deg", "#N")),
            ((*output, "--vary", "pump.tilt_deg=normal(40, 1)"), ("pump.tilt_deg", "--sampling")),
            ((*output, "--vary", "pump.pistons=5:9:0.5"), ("pump.pistons = 5.5", "whole")),
            ((*output, "--vary", "assumptions.analytic.inertia=heavy"), ("assumptions.analytic.inertia = heavy", "lumped")),
            ((*output, *vary, "--samples", 10), ("--samples", "grid")),
            ((*output, *vary, "--sampling", "sobol"), ("--samples", "sobol")),
            ((*output, *vary, *vary[:1], "pump.axis_offset_mm=1:2:#1000000", "--vary", "operation.speed_rpm=1:2:#1000"), ("designs", "at most")),
            (("--output", "mean:Tdd", *vary), ("mean:Tdd",)),
            ((*vary, "--minimise", "mean:Td", "--maximise", "mean:Td"), ("mean:Td", "both")),
            ((*output, *vary, "--check", "101%"), ("--check 101%",)),
            ((*output, *vary, "--check", "x"), ("--check x",)),
            (("--output", "stroke_mm", *vary, "--check", "1%"), ("--check",)),
            ((*output, *vary, "--part", "4/3"), ("--part 4/3", "I/N")),
            ((*output, *vary, "--part", "0/3"), ("--part 0/3", "I/N")),
            ((*output, *vary, "--format", "xlsx"), ("--format", "csv")),
        ):
            with self.subTest(options):
                self.assert_mentions(self.refused("sweep", case, *options), *words)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
