#!/usr/bin/env python3
"""simulate --fmu from outside: a unit acts on the pump; files, report, refusals.

usage: simulate_fmu_test.py BENTAXIS REPO_ROOT UNITS [options of unittest]
"""

import csv
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import time
import unittest

import jsonschema

import command_line_test as program
from command_line_test import BAD_INPUT, ProgramTest

UNITS = None  # set in main
SHORT = ("--set", "drive.duration_s=0.004", "--set", "drive.samples=20")


def without_times(text):
    return re.sub(r"[0-9.e-]+ s\b", "", text)


class FmuTest(ProgramTest):
    def case(self, name="bap63_motor_start"):
        return str(program.REPO / "cases" / f"{name}.toml")

    def unit(self, name, version=2):
        return str(UNITS / f"{name}_fmi{version}.fmu")


class SimulateFmuTest(FmuTest):

    def simulate(self, *arguments, case="bap63_motor_start", status=0):
        return self.run_program("simulate", self.case(case), *SHORT, "--out", "out", *arguments, status=status)

    def rows(self, name):
        with open(self.folder / "out" / name, newline="") as file:
            return list(csv.DictReader(file))

    def report(self):
        return json.loads((self.folder / "out" / "report.json").read_text())

    def section(self):
        found = [s for s in self.report()["runs"] if s["title"] == "Coupling to an FMU"]
        self.assertEqual(len(found), 1)
        return found[0]

    def says(self, *arguments, contains, case="bap63_motor_start", status=BAD_INPUT):
        line = self.refused("simulate", self.case(case), *SHORT, "--out", "out", *arguments, status=status)
        for text in contains if isinstance(contains, (list, tuple)) else [contains]:
            self.assertIn(text, line)

    def test_a_rotor_turns_both_models(self):
        for version in 2, 3:
            result = self.simulate("--fmu", self.unit("rotor", version), "--communication-step", "1e-4",
                                   "--fmu-set", "torque=330")
            self.assertIn("The trajectories agree", result.out)
            self.assertIn("FMU: drive_speed (1/min) -> drive_speed (rad/s), by equal names", result.out)
            rows = self.rows("unit_analytic.csv")
            self.assertEqual(len(rows), 40)  # points before the end
            self.assertEqual(list(rows[0]), ["time_s", "drive_speed (1/min)", "drive_acceleration (rad/s2)", "Td_z1_Nm (N.m)"])
            for row in rows:  # the unit's own equation, with the parameter that was set
                values = [float(x) for x in row.values()]
                self.assertAlmostEqual(values[2], (330 - values[3]) / 0.2, places=6)
            pump = self.rows("simulation_analytic.csv")
            self.assertAlmostEqual(float(pump[5]["shaft_rpm"]), float(rows[10]["drive_speed (1/min)"]), places=7)
            self.assertEqual(len(self.rows("unit_multibody.csv")), 40)

            section = self.section()
            facts = dict(section["facts"])
            self.assertIn(f"FMI {version}.0", facts["FMU"])
            self.assertEqual(facts["parameter torque"], "330 N.m")
            self.assertEqual(section["table"]["columns"][:3], ["group", "unit", "peak"])
            self.assertIn("Td", [row[0] for row in section["table"]["rows"]])
            report = self.report()
            jsonschema.validate(report, json.loads((program.REPO / "docs" / "report.schema.json").read_text()))
            self.assertEqual([entry["file"] for entry in report["provenance"]["inputs"]][-1].split("/")[-1],
                             f"rotor_fmi{version}.fmu")
            self.assertIn("unit_analytic.csv", report["files"])

    def test_a_rotor_turns_a_pump_of_touching_pistons(self):
        result = self.simulate("--fmu", self.unit("rotor"), "--communication-step", "1e-4", "--fmu-set", "torque=330",
                               "--set", "block.axial_inertia_kg_mm2=2000", "--set", "drive.kind=speed",
                               case="bap63_tapered_pistons")
        self.assertIn("The trajectories agree", result.out)
        rows = self.rows("simulation_analytic.csv")
        # The pump brakes the rotor by less than the torque that drives it, and the block lags behind.
        self.assertGreater(float(rows[-1]["shaft_rpm"]), float(rows[0]["shaft_rpm"]))
        self.assertGreater(float(rows[-1]["theta_deg"]) - float(rows[-1]["psi_deg"]), 0.1)

    def test_connections_by_word(self):
        self.simulate("--model", "analytic", "--fmu", self.unit("motor"), "--connect", "shaft_angle=theta_deg",
                      "--connect", "shaft_speed=shaft_rpm", "--communication-step", "2e-5")
        self.assertEqual(dict(self.section()["facts"])["connection 1"], "theta_deg (deg) -> shaft_angle (rad)")
        # An input that nothing is connected to stays as it starts, and is named.
        self.simulate("--model", "analytic", "--fmu", self.unit("motor"), "--connect", "shaft_angle=theta_deg",
                      "--communication-step", "2e-5")
        self.assertEqual(dict(self.section()["facts"])["inputs of the FMU that keep their start values"], "shaft_speed")

    def test_a_coarse_step_is_warned_of(self):
        result = self.simulate("--model", "analytic", "--fmu", self.unit("rotor"), "--communication-step", "4e-3",
                               "--fmu-set", "torque=2000")
        self.assertIn("warning: coarse coupling", result.out)

    def test_a_valve_closes_the_load(self):
        self.simulate("--model", "analytic", "--fmu", self.unit("valve", 3), "--fmu-set", "begin=0.001", "--fmu-set", "end=0.003",
                      case="bap63_load_step")
        p = [float(row["p_delivery_bar"]) for row in self.rows("oil_analytic.csv")]
        self.assertGreater(p[-1], p[0] + 0.1)
        shares = [float(row["load_share (%)"]) for row in self.rows("unit_analytic.csv")]
        self.assertEqual((shares[0], round(shares[-1], 9)), (100, 80))

    def test_refusals(self):
        rotor = self.unit("rotor")
        for option, value in (("--connect", "a=b"), ("--communication-step", "1e-3"), ("--fmu-set", "a=1"), ("--fmu-timeout", "3")):
            self.says(option, value, contains=[option, "has no effect without --fmu"])
        self.says("--fmu", "none.fmu", contains="none.fmu: does not exist")
        self.says("--fmu", self.case(), contains="not a zip archive")
        self.says("--fmu", self.unit("old_valve"), "--connect", "drive_speed=load_share", contains="units do not fit")
        self.says("--fmu", self.unit("short_valve"), case="bap63_load_step", contains="no function fmi2Terminate")
        self.says("--fmu", self.unit("old_valve", 3), case="bap63_load_step", contains="its library is of FMI 2.9")
        self.says("--fmu", self.unit("valve"), contains="no load whose size could change")
        self.says("--fmu", rotor, "--connect", "drive_torque=moment", contains="no output \"moment\"")
        self.says("--fmu", rotor, "--connect", "drive_torque", contains="must be A=B")
        self.says("--fmu", rotor, "--communication-step", "1", contains=["--communication-step 1", "<= 0.004"])
        self.says("--fmu", rotor, "--communication-step", "0", contains="--communication-step")
        for limit in "-1", "nan", "1e9":
            self.says("--fmu", rotor, "--fmu-timeout", limit, contains=["--fmu-timeout", "[0, 1e+06]"])
        self.says("--fmu", rotor, "--fmu-set", "torque", contains="must be NAME=VALUE")
        self.says("--fmu", rotor, "--fmu-set", "drive_speed=3", contains=["no such parameter", "inertia, torque"])
        self.says("--fmu", rotor, "--steady", contains="--steady")
        self.says("--fmu", rotor, "--accuracy", "1e-6", contains="--accuracy")
        line = self.refused("simulate", self.case("bap63_rated"), "--fmu", rotor, "--out", "out")
        self.assertIn("[drive] is missing", line)

    def test_a_value_that_the_unit_refuses_is_bad_input(self):
        self.run_program("fmu", self.case("bap63_rated"), "--out", "pump.fmu")
        self.says("--fmu", "pump.fmu", "--connect", "pump:drive_speed=shaft_rpm", "--fmu-set", "pump.tilt_deg=95",
                  contains=["--fmu-set pump.tilt_deg=95: the FMU refuses it", "[0, 90)"])

    def test_a_unit_that_fails_ends_it_in_its_words(self):
        self.says("--fmu", self.unit("stubborn"), "--fmu-set", "fail_at=0.002", "--communication-step", "1e-3",
                     contains=["DoStep at 0.001 s", "no level of oil at 0.001 s"], status=program.COMPUTATION_FAILED)


class HostileFmuTest(FmuTest):
    """An FMU that does anything: the program ends with status 3 and its name, or goes on as if nothing had been."""

    def setUp(self):
        super().setUp()
        self.temporary = self.folder / "tmp"
        self.temporary.mkdir()

    def environment(self, hostile=""):
        return {**os.environ, "TMPDIR": str(self.temporary), "BENTAXIS_TEST_HOSTILE": hostile}

    def processes(self):
        """Those of FMUs, with what they have started."""
        found = []
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if f"TMPDIR={self.temporary}".encode() in (process / "environ").read_bytes():
                    found.append(int(process.name))
            except OSError:
                pass
        return found

    def nothing_is_left(self):
        return not any(self.temporary.iterdir()) and not self.processes()

    def command(self, *arguments, fmu="hostile_rotor", version=2, out="out"):
        return ("simulate", self.case(), *SHORT, "--model", "analytic", "--out", out, "--fmu", self.unit(fmu, version),
                "--communication-step", "1e-3", *arguments)

    def test_an_fmu_that_ends_or_hangs(self):
        for hostile, *words in (("step exit0", "fmi2DoStep at 0 s", "by exit status 0"),
                                ("step segv", "fmi2DoStep at 0 s", "SIGSEGV"),
                                ("get abort", "fmi2GetReal of \"drive_speed\"", "SIGABRT", "no licence for this pump"),
                                ("load exit0", "loading rotor.so", "by exit status 0"),
                                ("free exit0", "fmi2FreeInstance", "by exit status 0"),
                                ("terminate segv", "fmi2Terminate", "SIGSEGV"),
                                ("step close_all", "fmi2DoStep", "closed the descriptor"),
                                ("step hang", "fmi2DoStep", "has not returned after 2 s", "--fmu-timeout")):
            with self.subTest(hostile=hostile):
                line = self.refused(*self.command("--fmu-timeout", "2"), status=program.COMPUTATION_FAILED,
                                    env=self.environment(hostile))
                self.assert_mentions(line, "hostile_rotor_fmi2.fmu", *words)
                self.assertTrue(self.nothing_is_left())

    def test_an_fmu_that_is_only_impolite_changes_nothing(self):
        plain = self.run_program(*self.command(fmu="rotor", out="plain"), env=self.environment())
        for hostile in "step chdir", "step close_standard", "step print", "step handlers", "step fork", "enter daemon":
            with self.subTest(hostile=hostile):
                result = self.run_program(*self.command(), env=self.environment(hostile))
                self.assertEqual(without_times(result.out), without_times(plain.out.replace("plain/", "out/")))
                self.assertEqual(result.err, "")
                for name in "simulation_analytic.csv", "unit_analytic.csv":
                    self.assertEqual((self.folder / "out" / name).read_bytes(), (self.folder / "plain" / name).read_bytes())
                self.assertTrue(self.nothing_is_left())

    def hanging(self):
        """The program while its FMU hangs in a step."""
        process = self.start(*self.command(), env=self.environment("step say_and_hang"))
        self.addCleanup(process.kill)
        deadline = time.monotonic() + program.SECONDS
        while not (self.temporary / "hangs").exists():
            self.assertIsNone(process.poll())
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)
        return process

    def test_a_signal_ends_it_while_an_fmu_hangs(self):
        for number in signal.SIGTERM, signal.SIGINT, signal.SIGHUP:
            process = self.hanging()
            (self.temporary / "hangs").unlink()
            process.send_signal(number)
            self.finish(process, program.INTERRUPTED)
            self.assertIn("interrupted; nothing was written", process.err)
            self.assertEqual([p.name for p in self.folder.iterdir()], ["tmp"])
            self.assertTrue(self.nothing_is_left())

    def test_nothing_is_left_of_a_program_that_is_killed(self):
        process = self.hanging()
        (self.temporary / "hangs").unlink()
        process.kill()
        process.communicate()
        deadline = time.monotonic() + program.SECONDS
        while not self.nothing_is_left():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)

    @unittest.skipUnless(hasattr(os, "mkfifo"), "needs named pipes")
    def test_a_program_whose_output_nobody_reads(self):
        reader, writer = os.pipe()
        os.close(reader)
        result = subprocess.run([program.PROGRAM, *self.command(fmu="rotor")], cwd=self.folder, env=self.environment(),
                                stdout=writer, stderr=subprocess.DEVNULL, timeout=program.SECONDS, check=False)
        os.close(writer)
        self.assertNotEqual(result.returncode, 0)
        deadline = time.monotonic() + program.SECONDS
        while not self.nothing_is_left():
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    UNITS = pathlib.Path(sys.argv[3]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
