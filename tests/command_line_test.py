#!/usr/bin/env python3
"""Tests of the program from outside: arguments, files, exit statuses, messages.

usage: command_line_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import csv
import datetime
import hashlib
import json
import os
import pathlib
import pty
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
import unittest

import jsonschema

DONE, OUT_OF_TOLERANCE, BAD_INPUT, COMPUTATION_FAILED, INTERRUPTED = 0, 1, 2, 3, 130
REPORT_FILES = {"report.html", "report.json", "analytic.csv", "multibody.csv", "budget_analytic.csv",
                "budget_multibody.csv"}
SECONDS = 120  # no single command may take longer

PROGRAM = REPO = None  # set in main


# ---- Cases -----------------------------------------------------------------------------------------


class Case:
    """The text of a case file, edited key by key. "pump.tilt_deg" is a key of a table, "name" one of none."""

    def __init__(self, **changes):
        self.lines = (REPO / "reference_data" / "high_precision" / "bap63_rated" / "case.toml").read_text().splitlines()
        self.set({"operation.samples_per_revolution": 36})
        self.set(changes)

    def set(self, changes):
        """Sets keys to values or, given None, takes them out. A str value is written as it is."""
        for name, value in changes.items():
            table, _, key = name.rpartition(".")
            line = self.line_of(name)
            text = [] if value is None else [f"{key} = {self._toml(value)}"]
            if line:
                self.lines[line - 1:line] = text
            elif text:
                self.lines[self.line_of_table(table):self.line_of_table(table)] = text
        return self

    def get(self, name):
        return self.lines[self.line_of(name) - 1].split("=", 1)[1].strip()

    def without_table(self, table):
        first = self.line_of_table(table) - 1
        last = next((i for i in range(first + 1, len(self.lines)) if self.lines[i].startswith("[")), len(self.lines))
        del self.lines[first:last]
        return self

    def line_of_table(self, table):
        """Number of the line of the heading, 0 for the keys above all tables; adds the table where it is missing."""
        if not table:
            return 0
        if f"[{table}]" not in self.lines:
            self.lines += ["", f"[{table}]"]
        return self.lines.index(f"[{table}]") + 1

    def line_of(self, name):
        """Number of the line of a key; 0 if there is none."""
        table, _, key = name.rpartition(".")
        current = ""
        for number, line in enumerate(self.lines, 1):
            if line.startswith("["):
                current = line.strip("[]")
            elif current == table and re.match(rf"{key}\s*=", line):
                return number
        return 0

    def write(self, file):
        file.write_text("\n".join(self.lines) + "\n")
        return file

    @staticmethod
    def _toml(value):
        return value if isinstance(value, str) else json.dumps(value)


CURVE = "theta_deg,pressure_bar\n0,5\n90,6\n180,100\n270,90\n"


# ---- Running ---------------------------------------------------------------------------------------


PUMP = re.compile(r"^(pump|bentaxis: warning: [a-z0-9-]+): [^\n]+\n", re.MULTILINE)

# Tables whose numbers tests/hydraulics_test.cpp, tests/circuit_test.cpp and, of [drive], tests/simulation_test.cpp, of [transfer],
# tests/multibody_transfer_test.cpp hold to count;
# [uncertainty] holds no numbers of the pump.
HELD_ELSEWHERE = {"uncertainty", "hydraulics", "oil", "leakage", "suction_line", "delivery_line", "load", "accumulator", "loop", "drive", "transfer"}


class ProgramTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="bentaxis_test_")))

    def start(self, *arguments, **options):
        return subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.folder, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)

    def schema(self):
        return json.loads(self.run_program("schema").out)

    def controls(self):
        """Cases with the numbers that must count there. A number is what the program's schema says is one."""
        numbers = {f"{table}.{key}" for table, schema in self.schema()["properties"].items() if table not in HELD_ELSEWHERE
                   for key, parameter in schema.get("properties", {}).items()
                   if parameter.get("type") in ("number", "integer", "array")} - STRUCTURE
        self.assertGreater(len(numbers), 40)
        without_effect = {name for base, name, _ in WITHOUT_EFFECT if base in (RATED, RATED_BEARINGS, BALL_BEARINGS)}
        rated = {name for name in numbers if Case(**RATED).line_of(name)} - HIDDEN_BY_PRESSURE - without_effect
        tried = rated.union(*(names for _, names in CONTROLS))
        self.assertEqual(numbers - tried - without_effect, set(), "forgotten")
        return ((RATED, rated), *CONTROLS)

    def finish(self, process, status):
        try:
            process.out, process.err = process.communicate(timeout=SECONDS)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            self.fail(f"not done after {SECONDS} s: {process.args}")
        shown = f"{' '.join(process.args[1:])}\nstatus {process.returncode}\n{process.out}{process.err}"
        self.assertEqual(process.returncode, status, shown)
        self.assertNotRegex(process.out + process.err, "[\x1b\r]", f"colour or progress without a terminal: {shown}")
        if status in (DONE, OUT_OF_TOLERANCE):
            self.assertNotRegex(process.out, r"(?<![\w./-])-?(nan|inf)(?![\w./-])", f"no number: {shown}")
        # What pump a case describes, and what of it is doubtful, is said first (plausibility_test.py); the tests here are about the rest.
        process.err = PUMP.sub("", process.err)
        return process

    def run_program(self, *arguments, status=DONE, **options):
        return self.finish(self.start(*arguments, **options), status)

    def refused(self, *arguments, status=BAD_INPUT, **options):
        """Runs what must fail: one line on standard error, nothing on standard output, no file made or changed.
        Returns the line."""
        before = self.contents()
        result = self.run_program(*arguments, status=status, **options)
        self.assertEqual(result.out, "")
        self.assertEqual(result.err.count("\n"), 1, result.err)
        self.assertTrue(result.err.endswith("\n") and result.err.strip(), result.err)
        self.assertEqual(self.contents(), before)
        return result.err.strip()

    def contents(self):
        """All paths below the folder of the test; of files with their bytes."""
        return {str(p.relative_to(self.folder)): p.read_bytes() if p.is_file() else None
                for p in self.folder.rglob("*")}

    def case(self, name="case.toml", **changes):
        return Case(**changes).write(self.folder / name)

    def assert_mentions(self, line, *words):
        for word in words:
            self.assertIn(str(word), line)

    def read_csv(self, name):
        """Heading and rows of text."""
        with (self.folder / name).open(newline="") as file:
            heading, *rows = csv.reader(file)
        for row in rows:
            self.assertEqual(len(row), len(heading), name)
        return heading, rows

    def column(self, name, channel):
        heading, rows = self.read_csv(name)
        return [row[heading.index(channel)] for row in rows]


# ---- Usage -----------------------------------------------------------------------------------------


class UsageTest(ProgramTest):
    def test_help_and_version_go_to_standard_output(self):
        for arguments, word in (
            (["--help"], "compare"), (["-h"], "compare"), (["run", "--help"], "--model"),
            (["compare", "--help"], "--tolerance"), (["--version"], "bentaxis "),
        ):
            with self.subTest(arguments):
                result = self.run_program(*arguments)
                self.assertIn(word, result.out)
                self.assertEqual(result.err, "")

    def test_version_is_the_one_of_the_project(self):
        version = re.search(r"project\(bentaxis VERSION (\S+)", (REPO / "CMakeLists.txt").read_text())[1]
        first, second = self.run_program("--version").out.splitlines()
        self.assertEqual(first, f"bentaxis {version}")
        self.assertTrue(second.startswith("optional parts: Ceres "), second)

    def test_starts_without_the_libraries_that_few_commands_need(self):
        """Each brings others, up to forty, that every start would load: they are linked with modules."""
        shown = subprocess.run(["ldd", PROGRAM], capture_output=True, text=True, check=True).stdout
        self.assertIn("libSimTKsimbody", shown)
        for library in ("libmatio", "libhdf5", "libcurl", "libmpi", "libcholmod", "libglog", "libOT", "libpagmo", "libmujoco", "libdart"):
            self.assertNotIn(library, shown)

    def test_help_names_every_option_of_the_interface(self):
        for command, options in (("run", "--model --out --way --scene --gear --integrator --accuracy"),
                                 ("compare", "--out --tolerance")):
            self.assert_mentions(self.run_program(command, "--help").out, *options.split())

    def test_bounds_of_numbers(self):
        case = self.case()
        for arguments, words in (
            (["hardcases", "--turns", "100001"], ["--turns", "100000"]),
            (["hardcases", "--filter", "absent"], ["hard/catalogue.toml", "absent"]),
            (["tradeoff", case, "--angles", "100001"], ["--angles", "100000"]),
            (["run", case, "--model", "multibody", "--way", "integrated", "--error", "0.1004"], ["--error", "0.1"]),
            (["run", case, "--model", "multibody", "--way", "integrated", "--error", "9.96e-12"], ["--error", "1e-11"]),
        ):
            with self.subTest(arguments):
                line = self.refused(*arguments)
                self.assert_mentions(line, *words)
                self.assertRegex(line, rf"\b{words[1]}\b")

    def test_accuracies_that_are_tried_unless_others_are_named(self):
        self.run_program("tradeoff", self.case(), "--integrators", "verlet", "--angles", 10, "--max-seconds-per-run", 1e-6, "--out", ".")
        rows = json.loads((self.folder / "tradeoff.json").read_text())["rows"]
        tried = [row["accuracy"] for row in rows if row["method"] == "integrated"]
        self.assertEqual(tried, 2 * [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10])

    def test_report_names_the_processor(self):
        names = [line.partition(":")[2].strip() for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines()
                 if line.startswith("model name")]
        self.run_program("compare", self.case(), "--out", ".")
        program = dict(json.loads((self.folder / "report.json").read_text())["program"])
        self.assertEqual(program["processor"], names[0] if names else os.uname().machine)

    def test_progress_is_taken_off_a_terminal(self):
        case = self.case(**{"operation.samples_per_revolution": 20000})
        mine, theirs = pty.openpty()
        process = subprocess.Popen([PROGRAM, "run", case, "--model", "multibody", "--out", "out"], cwd=self.folder,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=theirs)
        os.close(theirs)
        shown = b""
        with open(mine, "rb", buffering=0) as terminal:
            while True:
                try:
                    piece = terminal.read(4096)
                except OSError:  # its end, on Linux
                    break
                if not piece:
                    break
                shown += piece
        self.assertEqual(process.wait(SECONDS), DONE, shown)
        self.assertRegex(shown, rb"\r[^\r]* [ 0-9]{2}[0-9] %")
        self.assertEqual(shown.rpartition(b"%")[2].count(b"\r\x1b[K"), 1, shown[-200:])

    def test_bad_usage(self):
        case = self.case()
        run = ["run", case, "--out", "out"]
        compare = ["compare", case, "--out", "out"]
        for arguments, words in (
            ([], []),
            (["--nonsense"], ["--nonsense"]),
            (["frobnicate"], ["frobnicate"]),
            (["run"], []),
            (["compare"], []),
            (run, ["--model"]),
            ([*run, "--model", "magic"], ["magic", "analytic", "multibody"]),
            ([*run, "--model", "analytic", "--nonsense"], ["--nonsense"]),
            ([*run, "--model", "analytic", "other.toml"], ["other.toml"]),
            ([*run, "--model", "analytic", "--out"], ["--out"]),
            ([*run, "--model", "multibody", "--way", "sideways"], ["sideways", "driven", "integrated"]),
            ([*run, "--model", "multibody", "--scene", "none"], ["none", "full"]),
            ([*run, "--model", "multibody", "--gear", "belt"], ["belt", "mesh", "imposed"]),
            ([*run, "--model", "multibody", "--integrator", "magic"], ["magic", "rk-merson"]),
            ([*run, "--model", "multibody", "--way", "integrated", "--accuracy", "1"], ["1e-12", "0.1"]),
            ([*run, "--model", "multibody", "--way", "integrated", "--accuracy", "nan"], ["nan"]),
            ([*compare, "--tolerance", "0"], ["--tolerance"]),
            ([*compare, "--tolerance", "-1"], ["--tolerance"]),
            ([*compare, "--tolerance", "nan"], ["--tolerance", "nan"]),
            ([*compare, "--tolerance", "small"], ["--tolerance", "small"]),
            ([*compare, "--multibody", "gear=belt"], ["gear=belt", "mesh", "imposed"]),
            ([*compare, "--multibody", "colour=red"], ["colour=red", "piston_friction", "inertia", "gear"]),
            ([*compare, "--multibody", "gear"], ["gear", "mesh", "imposed"]),
            ([*compare, "--multibody-case", "absent.toml"], ["absent.toml"]),
        ):
            with self.subTest(arguments[:1] + arguments[4:]):  # without the path of the case
                self.assert_mentions(self.refused(*arguments), *words)

    def test_set_is_as_if_the_file_said_so(self):
        changes = {"pump.tilt_deg": 30.0, "friction.piston_coulomb_N": 50.0}
        self.run_program("run", self.case("changed.toml", **changes), "--model", "analytic", "--out", "file")
        settings = [word for key, value in changes.items() for word in ("--set", f"{key}={value}")]
        self.run_program("run", self.case(), "--model", "analytic", "--out", "set", *settings)
        self.assertEqual(*[(self.folder / out / "analytic.csv").read_bytes() for out in ("file", "set")])
        self.run_program("compare", self.case(), *settings, "--out", "set")
        report = json.loads((self.folder / "set" / "report.json").read_text())
        entries = {(e["table"], e["key"]): e["value"] for e in report["case"]["entries"]}
        self.assertEqual(float(entries["pump", "tilt_deg"]), 30.0)
        # Golden curves of a changed case belong to the case as changed.
        self.run_program("reference", "golden", self.case(), *settings, "--out", "golden")
        self.run_program("regress", "golden")

    def states(self, lines, name="states.csv"):
        file = self.folder / name
        file.write_text("\n".join(lines) + "\n")
        return file

    MOTION = "theta_deg,psi_deg,theta_rpm,psi_rpm,theta_rad_per_s2,psi_rad_per_s2"

    def test_states_of_constant_speed_are_a_turn(self):
        case = self.case()
        for model in ("analytic", "multibody"):
            self.run_program("run", case, "--model", model, "--out", "turn")
            angles = self.column(f"turn/{model}.csv", "theta_deg")
            states = self.states([self.MOTION, *(f"{a},{a},1500,1500,0,0" for a in angles)])
            self.run_program("run", case, "--model", model, "--states", states, "--out", "states")
            header = (self.folder / f"states/{model}.csv").read_text().splitlines()[0]
            self.assertTrue(header.startswith(self.MOTION + ",Rs_1_x2_N"), header)
            self.assertTrue(header.endswith("Rcs_law_N,ring_power_W,power_balance_W"), header)
            for column in (self.folder / f"turn/{model}.csv").read_text().splitlines()[0].split(","):
                with self.subTest(model=model, column=column):
                    self.assertEqual(*[self.column(f"{out}/{model}.csv", column) for out in ("turn", "states")])

    def test_states_give_reactions_with_their_own_pressures_and_columns(self):
        case = self.case()
        pressures = ",".join(f"p_{k}_bar" for k in range(1, 6))
        own = self.states([f"time_s,{self.MOTION},{pressures},suction_bar,delivery_bar",
                           "0,10,9.5,1500,1490,100,-200,275,275,0,0,0,1,270", "0.001,19,18.7,1510,1492,90,-150,275,275,0,0,0,1,270"])
        case_s = self.states([self.MOTION, "10,9.5,1500,1490,100,-200"], "plain.csv")
        torque = {}
        for model in ("analytic", "multibody"):
            self.run_program("run", case, "--model", model, "--states", own, "--channels", "p,Td,Rcs_law", "--out", "own")
            with open(self.folder / f"own/{model}.csv") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual([row["time_s"] for row in rows], ["0", "0.001"])
            self.assertEqual([row["p_1_bar"] for row in rows], ["275", "275"])
            self.assertEqual({row["Rcs_law_N"] for row in rows}, {""})
            self.assertNotIn("Rs_1_x2_N", rows[0])
            self.run_program("run", case, "--model", model, "--states", case_s, "--out", "plain")
            torque[model] = float(rows[0]["Td_z1_Nm"])
            # Other pressures, another torque.
            self.assertNotAlmostEqual(torque[model], float(self.column(f"plain/{model}.csv", "Td_z1_Nm")[0]), 3)
        self.assertAlmostEqual(torque["analytic"], torque["multibody"], delta=1e-9 * abs(torque["analytic"]))

    def test_bad_states(self):
        case = self.case()
        good = "10,9.5,1500,1490,100,-200"
        for lines, words in (
            ([self.MOTION], ["no states"]),
            ([], ["states.csv"]),
            ([self.MOTION.replace("psi_rpm", "psi_rmp"), good], ["states.csv:1", "psi_rmp", 'did you mean "psi_rpm"']),
            ([self.MOTION[:-len(",psi_rad_per_s2")], good[:-5]], ["states.csv:1", "psi_rad_per_s2", "missing"]),
            ([self.MOTION + ",psi_deg", good + ",1"], ["states.csv:1", "psi_deg", "duplicate"]),
            ([self.MOTION + ",p_2_bar", good + ",1"], ["states.csv:1", "p_1_bar", "missing"]),
            ([self.MOTION, good, good.replace("9.5", "9,5")], ["states.csv:3"]),
            ([self.MOTION, good, good.replace("9.5", "east")], ["states.csv:3", "psi_deg", "east"]),
            ([self.MOTION, good.replace("9.5", "nan")], ["states.csv:2", "psi_deg", "nan"]),
            (["time_s," + self.MOTION, "1," + good, "0.5," + good], ["states.csv:3", "time_s = 0.5", ">= 1"]),
            ([self.MOTION, good, "10,190,1500,1490,0,0"],
             ["states.csv:3", "psi_deg = 190", "closer to theta_deg = 10", "piston 5", "longer than"]),
        ):
            with self.subTest(words):
                self.assert_mentions(self.refused("run", case, "--model", "analytic", "--states", self.states(lines),
                                                  "--out", "out"), *words)
        self.assert_mentions(self.refused("run", case, "--model", "analytic", "--states", "absent.csv"), "absent.csv")
        states = self.states([self.MOTION, good])
        for option, word in ((["--way", "integrated"], "--way"), (["--scene", "piston"], "--scene"),
                             (["--channels", "Rcs_lew"], "Rcs_law"), (["--accuracy", "1e-4"], "--accuracy")):
            with self.subTest(option):
                self.assert_mentions(self.refused("run", case, "--model", "multibody", "--states", states, *option), word)

    def test_every_command_that_reads_a_case_takes_changes(self):
        case = self.case()
        hydraulic = REPO / "cases" / "bap63_rated_hydraulic.toml"
        (self.folder / "curve.csv").write_text("theta_deg,Td_z1_Nm\n0,1\n120,2\n240,3\n")
        for command in (
            ["run", case, "--model", "analytic"], ["run", case, "--model", "multibody"], ["compare", case],
            ["compare", case, "--multibody-case", case], ["inertia", case], ["tradeoff", case],
            ["pressure", hydraulic], ["rattle", case, "--speeds", "1:2:#2", "--delivery-bar", "1:2:#2"], ["reference", "new", case, "--from", "curve.csv"],
            ["reference", "golden", case, "--out", "golden"], ["calibrate", hydraulic, "--torque-with-friction", "294.7", "--torque-without-friction", "293.4"],
            ["blocktorque", case, hydraulic],
            ["uncertainty", case],
        ):
            with self.subTest(command):
                self.assert_mentions(self.refused(*command, "--set", "pump.tilt_deg=95"), "tilt_deg", "95")

    def test_table_of_openings(self):
        folder = self.folder / "pump"
        folder.mkdir()
        (folder / "case.toml").write_bytes((REPO / "cases" / "bap63_rated_hydraulic.toml").read_bytes())
        table = "theta_deg,area_mm2\n0,0\n2,0\n20,100\n150,100\n178,0\n"
        (folder / "suction.csv").write_text(table)
        command = ["pressure", folder / "case.toml", "--set", "hydraulics.suction_opening_file=suction.csv"]
        self.run_program(*command, "--out", "out")
        areas = dict(zip(self.column("out/pressure.csv", "theta_deg"), self.column("out/pressure.csv", "as_1_mm2")))
        self.assertEqual([round(float(areas[angle]), 9) for angle in ("1", "20", "100", "180")], [0, 100, 100, 0])
        (folder / "suction.csv").write_text(table.replace("150,100", "150,-1"))
        self.assert_mentions(self.refused(*command, "--out", "bad"), "suction.csv:5", "area_mm2 = -1", ">= 0")

    def test_options_that_would_change_nothing(self):
        case = self.case()
        analytic = ["run", case, "--model", "analytic", "--out", "out"]
        multibody = ["run", case, "--model", "multibody", "--out", "out"]
        compare = ["compare", case, "--out", "out"]
        integrated = ["--way", "integrated"]
        for arguments, option in (
            ([*analytic, *integrated], "--way integrated"),
            ([*analytic, "--scene", "piston"], "--scene"),
            ([*analytic, "--scene", "full"], "--scene"),
            ([*analytic, "--reactions", "residual"], "--reactions"),
            ([*analytic, "--integrator", "rk3"], "--integrator"),
            ([*analytic, "--accuracy", "1e-6"], "--accuracy"),
            ([*analytic, "--error", "1e-6"], "--error"),
            ([*multibody, "--integrator", "rk3"], "--integrator"),
            ([*multibody, "--accuracy", "1e-6"], "--accuracy"),
            ([*multibody, "--way", "driven", "--accuracy", "1e-6"], "--accuracy"),
            ([*multibody, "--error", "1e-6"], "--error"),
            ([*multibody, *integrated, "--scene", "piston"], "--scene"),
            ([*multibody, *integrated, "--scene", "full"], "--scene"),
            ([*multibody, *integrated, "--reactions", "residual"], "--reactions"),
            ([*compare, "--accuracy", "1e-6"], "--accuracy"),
            ([*compare, "--integrator", "rk3"], "--integrator"),
            ([*compare, "--error", "1e-6"], "--error"),
            ([*compare, *integrated, "--scene", "pistons"], "--scene"),
            ([*compare, *integrated, "--reactions", "residual"], "--reactions"),
        ):
            with self.subTest(arguments[:1] + arguments[2:]):
                self.assert_mentions(self.refused(*arguments), option)
        # --way driven says what is done anyway.
        self.run_program(*analytic, "--way", "driven")

    def test_second_case_must_be_the_same_run(self):
        case = self.case()
        for key, value in (("pump.pistons", 7), ("operation.samples_per_revolution", 72),
                           ("operation.revolutions", 2)):
            with self.subTest(key):
                other = self.case("other.toml", **{key: value})
                line = self.refused("compare", case, "--multibody-case", other, "--out", "out")
                self.assert_mentions(line, "other.toml")


# ---- Results ---------------------------------------------------------------------------------------


def heading_of(pistons):
    """The columns that never change."""
    axes = ("Rs_{}_x2_N", "Rs_{}_y2_N", "Rs_{}_z2_N", "Rc_{}_x2_N", "Rc_{}_y2_N")
    return (["theta_deg"] + [name.format(k) for k in range(1, pistons + 1) for name in axes] + """
            Fh_z2_N Th_x2_Nm Th_y2_Nm Rcn_x2_N Rcn_y2_N Rcs_z4_N Rb1_x1_N Rb1_y1_N Rb1_z1_N Rb2_x1_N Rb2_y1_N
            Td_z1_Nm xh_x2_mm yh_y2_mm""".split())


def digits(text):
    """Significant digits of a number's text, without sign, point, exponent and zeros at either end."""
    return re.split("[eE]", text)[0].replace("-", "").replace(".", "").strip("0")


class RunTest(ProgramTest):
    MODELS = ("analytic", "multibody")

    def test_curves_of_both_models(self):
        case = self.case()
        for model in self.MODELS:
            with self.subTest(model):
                result = self.run_program("run", case, "--model", model, "--out", "new/folder")
                self.assertEqual(result.out.splitlines()[-1], f"new/folder/{model}.csv")
                self.assertEqual(result.err, "")
                heading, rows = self.read_csv(f"new/folder/{model}.csv")
                wanted = heading_of(5)
                self.assertEqual(heading[:len(wanted)], wanted)
                self.assertEqual(len(set(heading)), len(heading))
                self.assertEqual([float(row[0]) for row in rows], [10 * i for i in range(36)])
        self.assertEqual({p.name for p in self.folder.glob("new/folder/*")}, {"analytic.csv", "multibody.csv"})

    def test_other_numbers_of_pistons(self):
        for pistons in (1, 9):
            for model in self.MODELS:
                with self.subTest(pistons=pistons, model=model):
                    case = self.case(**{"pump.pistons": pistons, "operation.samples_per_revolution": 7})
                    self.run_program("run", case, "--model", model, "--out", "out")
                    heading, rows = self.read_csv(f"out/{model}.csv")
                    wanted = heading_of(pistons)
                    self.assertEqual(heading[:len(wanted)], wanted)
                    self.assertEqual([float(row[0]) for row in rows], [360 * i / 7 for i in range(7)])

    def test_only_the_channels_asked_for(self):
        case = self.case()
        self.run_program("run", case, "--model", "analytic", "--out", "all")
        self.run_program("run", case, "--model", "multibody", "--scene", "piston", "--out", "all")
        for model in self.MODELS:
            with self.subTest(model):
                result = self.run_program("run", case, "--model", model, "--channels", "Rc,Rs_2_z2_N,zB",
                                          "--out", "some")
                heading, rows = self.read_csv(f"some/{model}.csv")
                wanted = [h for h in self.read_csv(f"all/{model}.csv")[0]
                          if h in ("theta_deg", "Rs_2_z2_N") or h.startswith(("Rc_", "zB_"))]
                self.assertEqual(heading, wanted)
                self.assertEqual(len(heading), 1 + 10 + 1 + 5)
                for name in heading[1:]:
                    self.assertEqual(self.column(f"some/{model}.csv", name), self.column(f"all/{model}.csv", name))
                # The multibody model built only one piston, and said so.
                self.assertEqual(model == "multibody", 'scene "piston"' in result.err)
        self.assertEqual(self.run_program("run", case, "--model", "multibody", "--channels", "Td,Rs", "--out",
                                          "pump").err, "")
        self.assertEqual(self.run_program("run", case, "--model", "multibody", "--channels", "Rs", "--scene", "full",
                                          "--out", "pump").err, "")

    def test_channels_that_are_none(self):
        case = self.case()
        for model in self.MODELS:
            self.assert_mentions(self.refused("run", case, "--model", model, "--channels", "Rx"), "Rx", "Rs, Rc, Fh")
        self.assert_mentions(self.refused("compare", case, "--channels", "Rs_6_z2_N"), "Rs_6_z2_N")
        self.assert_mentions(self.refused("run", case, "--model", "multibody", "--channels", "Rs,Td", "--scene",
                                          "pistons"), "--scene pistons", "Td_z1_Nm")

    def test_numbers_are_the_shortest_that_read_back(self):
        case = self.case()
        for model in self.MODELS:
            self.run_program("run", case, "--model", model, "--out", "out")
            heading, rows = self.read_csv(f"out/{model}.csv")
            for row in rows:
                for name, text in zip(heading, row):
                    if text == "":
                        continue
                    self.assertRegex(text, r"^-?\d+(\.\d+)?(e[+-]\d+)?$", name)
                    self.assertEqual(digits(text), digits(repr(float(text))), name)
                    self.assertNotEqual(text, "-0", name)

    def test_integrated_run(self):
        for speed, sign in ((1500.0, 1), (-1500.0, -1)):
            with self.subTest(speed=speed):
                case = self.case(**{"operation.speed_rpm": speed, "operation.revolutions": 3})
                self.run_program("run", case, "--model", "multibody", "--way", "integrated", "--out", "out")
                theta = [float(text) for text in self.column("out/multibody.csv", "theta_deg")]
                self.assertEqual(len(theta), 36 * 3)
                for i, angle in enumerate(theta):
                    self.assertAlmostEqual(angle, sign * 10 * i, delta=1e-9)

    def test_driven_angles_rise_whatever_the_sign_of_the_speed(self):
        case = self.case(**{"operation.speed_rpm": -1500.0, "operation.revolutions": 3})
        for model in self.MODELS:
            self.run_program("run", case, "--model", model, "--out", "out")
            self.assertEqual([float(t) for t in self.column(f"out/{model}.csv", "theta_deg")],
                             [10 * i for i in range(36)])

    def test_imposed_gear_has_no_tooth_force(self):
        case = self.case()
        for model in self.MODELS:
            with self.subTest(model):
                self.run_program("run", case, "--model", model, "--out", "out")
                self.assertTrue(all(self.column(f"out/{model}.csv", "Rcs_z4_N")))
                self.run_program("run", case, "--model", model, "--gear", "imposed", "--out", "out")
                self.assertEqual(set(self.column(f"out/{model}.csv", "Rcs_z4_N")), {""})

    def test_point_of_a_film_force_of_zero_is_empty(self):
        # Nothing presses the block along its axis.
        case = self.case(**{"pump.tilt_deg": 0.0, "pump.axis_offset_mm": 0.0, "pressure.delivery_bar": 0.0,
                            "block.spring_force_N": 0.0, "friction.piston_coulomb_N": 0.0,
                            "friction.block_viscous_Nm_per_rpm": 0.0})
        self.run_program("run", case, "--model", "analytic", "--gear", "imposed", "--out", "out")
        self.assertEqual(set(self.column("out/analytic.csv", "Fh_z2_N")), {"0"})
        for name in ("xh_x2_mm", "yh_y2_mm"):
            self.assertEqual(set(self.column("out/analytic.csv", name)), {""})

    def test_out_is_the_default_folder(self):
        self.run_program("run", self.case(), "--model", "analytic")
        self.assertTrue((self.folder / "out" / "analytic.csv").is_file())

    def test_curve_is_found_beside_the_case(self):
        elsewhere = self.folder / "some where" / "Fälle"
        elsewhere.mkdir(parents=True)
        case = Case(**{"pressure.kind": '"curve"', "pressure.file": '"curve.csv"'}).write(elsewhere / "a b.toml")
        for text in (CURVE, CURVE.replace("\n", "\r\n"), CURVE.rstrip("\n"), CURVE + "\n\n"):
            (elsewhere / "curve.csv").write_bytes(text.encode())
            self.run_program("run", case, "--model", "analytic", "--out", elsewhere / "out")
            self.assertEqual(self.column(elsewhere / "out" / "analytic.csv", "p_1_bar")[9], "6")

    def test_line_ends_of_other_systems(self):
        case = self.case()
        case.write_bytes(b"\xef\xbb\xbf" + case.read_bytes().replace(b"\n", b"\r\n"))
        self.run_program("run", case, "--model", "analytic", "--out", "out")

    def test_a_float_may_be_written_as_an_integer(self):
        case = self.case(**{"operation.speed_rpm": "1500", "pump.tilt_deg": "40"})
        self.run_program("run", case, "--model", "analytic", "--out", "out")

    def test_same_input_gives_same_bytes(self):
        case = self.case()
        for out in ("one", "two"):
            for model in self.MODELS:
                self.run_program("run", case, "--model", model, "--out", out)
        for model in self.MODELS:
            self.assertEqual(*[(self.folder / out / f"{model}.csv").read_bytes() for out in ("one", "two")])


class ProvenanceTest(ProgramTest):
    def report(self, *arguments, file="report.json", environment=None, status=0):
        process = self.start(*arguments, "--out", "out", env={**os.environ, **(environment or {})})
        self.finish(process, status)
        return json.loads((self.folder / "out" / file).read_text()), (self.folder / "out").iterdir()

    def test_report_says_where_it_comes_from(self):
        case = self.case()
        before = datetime.datetime.now(datetime.timezone.utc).replace(microsecond=0)
        report, _ = self.report("compare", case.name, "--set", "name=it's a pump")
        origin = report["provenance"]
        self.assertEqual(origin["command"], r"bentaxis compare case.toml --set 'name=it'\''s a pump' --out out")
        date = datetime.datetime.strptime(origin["date"], "%Y-%m-%dT%H:%M:%SZ").replace(tzinfo=datetime.timezone.utc)
        self.assertLessEqual(before, date)
        self.assertLess(date, before + datetime.timedelta(minutes=5))
        self.assertEqual(origin["version"], self.run_program("--version").out.split()[1])
        self.assertEqual(origin["inputs"][0],
                         {"file": "case.toml", "sha256": hashlib.sha256(case.read_bytes()).hexdigest()})
        self.assertEqual([name for name, _ in origin["machine"]], ["compiler", "processor", "system"])
        self.assertTrue(all(value for _, value in origin["machine"]))
        self.assertNotIn(str(self.folder), json.dumps(report))  # no path that was not typed

    def test_curve_is_an_input(self):
        (self.folder / "curve.csv").write_text(CURVE)
        case = self.case(**{"pressure.kind": '"curve"', "pressure.file": '"curve.csv"'})
        report, _ = self.report("compare", case)
        self.assertIn({"file": f"{self.folder.name}/curve.csv", "sha256": hashlib.sha256(CURVE.encode()).hexdigest()},
                      report["provenance"]["inputs"])

    def test_the_same_date_gives_the_same_bytes(self):
        case = self.case()
        written = []
        for _ in range(2):
            report, files = self.report("compare", case, environment={"SOURCE_DATE_EPOCH": "1700000000"})
            written.append({file.name: file.read_bytes() for file in files})
        self.assertEqual(report["provenance"]["date"], "2023-11-14T22:13:20Z")
        self.assertEqual(set(written[0]), REPORT_FILES)
        self.assertEqual(*written)
        self.assertIsNone(report["models"][0]["seconds"])
        usual, _ = self.report("compare", case)
        for model in usual["models"]:
            self.assertGreater(model["seconds"], 0)

    def test_a_date_that_is_none_is_refused(self):
        for text in ("", "yesterday", "-1", "1.5", "99999999999999"):
            process = self.start("compare", self.case(), "--out", "out", env={**os.environ, "SOURCE_DATE_EPOCH": text})
            result = self.finish(process, BAD_INPUT)
            self.assert_mentions(result.err, f"SOURCE_DATE_EPOCH={text}:", "seconds since 1970")
            self.assertEqual(list(self.folder.glob("out/*")), [])


class BudgetTest(ProgramTest):
    def test_csv_adds_up(self):
        self.run_program("compare", self.case(), "--out", "out")
        torque = [float(v) for v in self.column("out/analytic.csv", "Td_z1_Nm")]
        peak = max(map(abs, torque))
        for model in RunTest.MODELS:
            heading, rows = self.read_csv(f"out/budget_{model}.csv")
            self.assertEqual(heading[:9], ["theta_deg", "Td_pressure_Nm", "Td_piston_friction_Nm", "Td_weight_Nm",
                                           "Td_inertia_Nm", "Td_block_friction_Nm", "Td_shaft_friction_Nm",
                                           "Td_torque_factor_Nm", "Td_z1_Nm"])
            self.assertEqual(len(rows), len(torque))
            for row, whole in zip(rows, torque):
                parts = [float(v) for v in row[1:9]]
                self.assertAlmostEqual(sum(parts[:7]), parts[7], delta=1e-12 * peak)
                self.assertAlmostEqual(parts[7], whole, delta=1e-12 * peak)

    def test_report_has_means_and_a_figure(self):
        result = self.run_program("compare", self.case(), "--out", "out")
        report = json.loads((self.folder / "out" / "report.json").read_text())
        lines = {line["cause"]: line for line in report["budget"]["torque"]}
        for model in (0, 1):
            whole = lines.pop("drive torque Td") if model == 0 else whole
            self.assertAlmostEqual(sum(line["mean"][model] for line in lines.values()), whole["mean"][model], 9)
        self.assertTrue(all(line["verdict"] == "agrees" for line in lines.values()))
        self.assertIn("torque_budget", [figure["id"] for figure in report["figures"]])
        self.assertRegex(result.out, r"mean drive torque \d+\.\d+ Nm: pressure \d")

    def test_no_budget_of_what_has_none(self):
        for arguments in (("--way", "integrated", "--accuracy", "1e-3"), ("--channels", "Rs")):
            self.run_program("compare", self.case(), *arguments, "--out", "out")
            report = json.loads((self.folder / "out" / "report.json").read_text())
            self.assertNotIn("budget", report)
            self.assertEqual(list(self.folder.glob("out/budget*")), [])


class CompareTest(ProgramTest):
    def test_writes_its_files(self):
        result = self.run_program("compare", self.case(), "--out", "out")
        self.assertEqual({p.name for p in (self.folder / "out").iterdir()}, REPORT_FILES)
        self.assertEqual(result.err, "")
        for name in REPORT_FILES:
            self.assertIn(f"out/{name}\n", result.out)
        report = json.loads((self.folder / "out" / "report.json").read_text(), parse_constant=self.fail)
        self.assertIs(report["verdict"]["agrees"], True)
        self.assertEqual(report["verdict"]["tolerance"], 1e-9)

    def test_curves_are_those_of_run(self):
        case = self.case()
        self.run_program("compare", case, "--out", "both")
        for model in RunTest.MODELS:
            self.run_program("run", case, "--model", model, "--out", "each")
            self.assertEqual(*[(self.folder / out / f"{model}.csv").read_bytes() for out in ("both", "each")])

    def test_only_the_channels_asked_for(self):
        result = self.run_program("compare", self.case(), "--channels", "Rs,Tc", "--out", "out")
        self.assertIn('scene "piston"', result.err)
        report = json.loads((self.folder / "out" / "report.json").read_text())
        self.assertEqual({c["name"].split("_")[0] for c in report["channels"]}, {"Rs", "Tc"})
        self.assertEqual({f["id"] for f in report["figures"]}, {"rs", "rs_xy", "rs3", "shares"})
        # What the scene does not compute has not been checked.
        self.assertEqual([c["name"] for c in report["checks"] if c["model"] == "multibody"],
                         ["moment about the piston's own axis"])
        self.assertNotIn("not computed", result.out)

    def test_tolerance_decides_the_status(self):
        self.run_program("compare", self.case(), "--tolerance", "1e-25", "--out", "out", status=OUT_OF_TOLERANCE)
        self.assertEqual({p.name for p in (self.folder / "out").iterdir()}, REPORT_FILES)
        report = json.loads((self.folder / "out" / "report.json").read_text())
        self.assertIs(report["verdict"]["agrees"], False)

    def test_unequal_assumptions_are_explained(self):
        self.run_program("compare", self.case(), "--multibody", "gear=imposed", "piston_friction=off", "--out", "out")
        self.assertEqual(set(self.column("out/multibody.csv", "Rcs_z4_N")), {""})

    def test_tolerance_counts_under_unequal_assumptions(self):
        case = self.case()
        other = self.case("other.toml", **{"pump.tilt_deg": 40.0 * (1 + 1e-6)})  # no assumption explains that
        command = ["compare", case, "--multibody-case", other, "--multibody", "piston_friction=off", "--out", "out"]
        result = self.run_program(*command, status=OUT_OF_TOLERANCE)
        self.assertIn("Not explained.", result.out)
        self.assertIn("(tolerance 1e-10)", result.out)
        result = self.run_program(*command, "--tolerance", "1e-3")
        self.assertIn("Explained.", result.out)
        self.assertIn("(tolerance 0.001)", result.out)
        report = json.loads((self.folder / "out" / "report.json").read_text())
        self.assertEqual(report["verdict"]["rest_tolerance"], 1e-3)

    def test_integrated(self):
        case = self.case(**{"operation.revolutions": 2})
        self.run_program("compare", case, "--way", "integrated", "--out", "out")
        for model in RunTest.MODELS:
            self.assertEqual(len(self.column(f"out/{model}.csv", "theta_deg")), 72)


# ---- Refused input ---------------------------------------------------------------------------------

# What is wrong: changed keys, the key that is to be named with its line, and words of the message beside these
# (the value and what is allowed).
BAD_VALUES = (
    ("text for a number", {"pump.tilt_deg": '"forty"'}, ['"forty"', "number", "in [0, 90)"]),
    ("number for a text", {"name": 5}, ["5", "text"]),
    ("table for a number", {"pump.tilt_deg": "{ value = 40.0 }"}, ["number", "in [0, 90)"]),
    ("float for an integer", {"pump.pistons": 5.0}, ["5.0", "integer", "in [1, 99]"]),
    ("truth value for a number", {"shaft.mass_kg": True}, ["true", "number", ">= 0"]),
    ("number for a word", {"piston.inertia": 1}, ["1", '"lumped" or "real"']),
    ("unknown word", {"piston.inertia": '"spread"'}, ['"spread"', '"lumped" or "real"']),
    ("pistons cannot reach", {"pump.piston_length_mm": 2.0}, ["2.0", "must be >"]),
    ("no pistons", {"pump.pistons": 0}, ["0", "in [1, 99]"]),
    ("too many pistons", {"pump.pistons": 100}, ["100", "in [1, 99]"]),
    ("not a number", {"pump.joint_circle_radius_mm": "nan"}, ["nan", "> 0"]),
    ("infinite", {"operation.speed_rpm": "inf"}, ["inf", "finite"]),
    ("infinite mass", {"piston.mass_kg": "-inf"}, ["-inf", ">= 0"]),
    ("negative radius", {"pump.joint_circle_radius_mm": -24.92}, ["-24.92", "> 0"]),
    ("radius of zero", {"pump.bore_circle_radius_mm": 0}, ["0", "> 0"]),
    ("tilt of 90 degrees", {"pump.tilt_deg": 90.0}, ["90.0", "in [0, 90)"]),
    ("negative tilt", {"pump.tilt_deg": -1.0}, ["-1.0", "in [0, 90)"]),
    ("pressure angle", {"gear.pressure_angle_deg": 61.0}, ["61.0", "in [0, 60]"]),
    ("equal bearings", {"bearings.cylindrical_z_mm": -26.0}, ["-26.0", "tapered_z_mm"]),
    ("mass fraction", {"piston.joint_mass_fraction": 1.5}, ["1.5", "in [0, 1]"]),
    ("torque factor", {"friction.shaft_torque_factor": 0.0}, ["0.0", "in (0, 1]"]),
    ("negative friction", {"friction.piston_coulomb_N": -1.0}, ["-1.0", ">= 0"]),
    ("no samples", {"operation.samples_per_revolution": 0}, ["0", ">= 1"]),
    ("negative revolutions", {"operation.revolutions": -1}, ["-1", ">= 1"]),
    ("transition", {"pressure.transition_deg": 181.0}, ["181.0", "in [0, 180]"]),
    ("kind of pressure", {"pressure.kind": '"measured"'}, ['"measured"', '"ideal"', '"curve"', '"hydraulic"']),
    ("kind of pump", {"pump.type": '"axial"'}, ['"axial"', '"bent_axis_bevel"']),
    ("schema", {"schema": 2}, ["2", "[1, 1]"]),
    ("land", {"port_plate.inner_land_mm": [19.0, 17.2]}, ["19.0", "r1 < r2"]),
    ("lands overlap", {"port_plate.outer_land_mm": [18.0, 26.0]}, ["18.0", "r2 < r3 < r4"]),
    ("land of three numbers", {"port_plate.inner_land_mm": [1.0, 2.0, 3.0]}, ["3.0", "pair"]),
    ("negative land", {"port_plate.inner_land_mm": [-1.0, 19.0]}, ["-1.0", ">= 0"]),
    ("arc too long", {"port_plate.delivery_arc_deg": [0.0, 361.0]}, ["361.0", "from + 360"]),
    ("arc backwards", {"port_plate.suction_arc_deg": [168.0, 12.0]}, ["168.0", "from < to"]),
    ("no such curve", {"pressure.file": '"absent.csv"', "pressure.kind": '"curve"'}, ["absent.csv"]),
    ("folder for a curve", {"pressure.file": '"."', "pressure.kind": '"curve"'}, ["directory"]),
    ("axial inertia above twice the transverse",
     {"piston.axial_inertia_kg_mm2": 50.0, "piston.centre_of_mass_mm": 19.0, "piston.transverse_inertia_kg_mm2": 24.0},
     ["50.0", "in [0, 48]"]),
    ("inertia of pistons without their data", {"assumptions.multibody.inertia": '"real"'},
     ['"real"', "centre_of_mass_mm", "transverse_inertia_kg_mm2"]),
    ("assumption", {"assumptions.analytic.piston_friction": '"off"'}, ['"off"', "true or false"]),
    ("unknown key", {"pump.bore_diameter_in": 1.0}, ["pump"]),
    ("misspelt key beside the right one", {"pump.tilt_degs": 1.0}, ["pump", '"tilt_deg"']),
    ("unknown key above all tables", {"author": '"me"'}, []),
)

# Contents of a curve; number of the line to be named (0: none), words of the message.
BAD_CURVES = (
    ("empty", "", 0, ["empty"]),
    ("only a heading", "theta_deg,pressure_bar\n", 0, ["3"]),
    ("two points", "theta_deg,pressure_bar\n0,5\n90,6\n", 0, ["2", "at least 3"]),
    ("text in a number", CURVE.replace("90,6", "90,6x"), 3, ["6x", "pressure_bar"]),
    ("empty field", CURVE.replace("90,6", "90,"), 3, ["pressure_bar"]),
    ("not a number", CURVE.replace("90,6", "90,nan"), 3, ["nan", "pressure_bar", "finite"]),
    ("infinite", CURVE.replace("90,6", "90,inf"), 3, ["inf", "pressure_bar", "finite"]),
    ("too few fields", CURVE.replace("90,6", "90"), 3, []),
    ("too many fields", CURVE.replace("90,6", "90,6,7"), 3, []),
    ("another heading", CURVE.replace("pressure_bar", "pressure"), 0, ["pressure", "unit"]),
    ("falling angles", CURVE.replace("180,", "80,"), 4, ["theta_deg", "80"]),
    ("equal angles", CURVE.replace("180,", "90,"), 4, ["theta_deg", "90"]),
    ("end point repeated, another value", CURVE + "360,6\n", 6, ["pressure_bar", "6", "periodic"]),
)


class BadInputTest(ProgramTest):
    def refused_by_every_command(self, case):
        lines = {self.refused(*command, "--out", "out/of/it").replace(f"(see bentaxis {command[0]} --help)", "(see its help)")
                 for command in (["run", case, "--model", "analytic"], ["run", case, "--model", "multibody"], ["compare", case])}
        self.assertEqual(len(lines), 1, lines)
        return lines.pop()

    def test_values(self):
        for label, changes, words in BAD_VALUES:
            with self.subTest(label):
                case = Case(**changes)
                name = next(iter(changes))
                file = case.write(self.folder / "case.toml")
                line = self.refused_by_every_command(file)
                self.assert_mentions(line, f"case.toml:{case.line_of(name)}:", name.rpartition(".")[2], *words)

    def test_every_key_that_is_required(self):
        optional = {"operation.gravity_m_per_s2", "operation.samples_per_revolution", "piston.joint_mass_fraction",
                    "block.bottom_area_mm2", "block.spring_force_N", "pressure.delivery_start_deg"}
        table, count = "", 0
        for text in Case().lines:
            if text.startswith("["):
                table = text.strip("[]")
            key = text.partition("=")[0].strip()
            name = f"{table}.{key}" if table else key
            if "=" not in text or table == "friction" or name in optional:
                continue
            count += 1
            with self.subTest(name):
                case = Case(**{name: None})
                line = self.refused_by_every_command(case.write(self.folder / "case.toml"))
                place = f"case.toml:{case.line_of_table(table)}:" if table else "case.toml:"
                self.assert_mentions(line, place, key, "missing", "must be")
        self.assertGreater(count, 25)

    def test_every_table_that_is_required(self):
        for table in ("pump", "gear", "bearings", "piston", "shaft", "block", "operation", "pressure"):
            with self.subTest(table):
                file = Case().without_table(table).write(self.folder / "case.toml")
                self.assert_mentions(self.refused_by_every_command(file), "case.toml", f"[{table}]", "missing")

    def test_unknown_table(self):
        case = Case(**{"hydraulic.bulk_modulus_bar": 1.0})
        line = self.refused_by_every_command(case.write(self.folder / "case.toml"))
        self.assert_mentions(line, f"case.toml:{case.line_of_table('hydraulic')}:", "[hydraulic]")

    def test_misspelt_key(self):
        case = Case(**{"pump.tilt_deg": None, "pump.tlit_deg": 40.0})
        line = self.refused_by_every_command(case.write(self.folder / "case.toml"))
        self.assert_mentions(line, "case.toml:", "tilt_deg", "tlit_deg")

    def test_syntax(self):
        for label, text in (("no value", "tilt_deg ="), ("no equals sign", "tilt_deg 40"), ("open text", 'type = "bent'),
                            ("twice", "pistons = 5"), ("too large for a double", "tilt_deg = 1e999"),
                            ("not UTF-8", "# \udcff")):
            with self.subTest(label):
                case = Case()
                case.lines.insert(case.line_of("pump.pistons"), text)
                (self.folder / "case.toml").write_bytes("\n".join(case.lines).encode(errors="surrogateescape"))
                line = self.refused_by_every_command("case.toml")
                self.assert_mentions(line, f"case.toml:{case.line_of('pump.pistons') + 1}:")

    def test_curves(self):
        case = self.case(**{"pressure.kind": '"curve"', "pressure.file": '"curve.csv"'})
        for label, text, number, words in BAD_CURVES:
            with self.subTest(label):
                (self.folder / "curve.csv").write_text(text)
                line = self.refused_by_every_command(case)
                self.assert_mentions(line, f"curve.csv:{number}:" if number else "curve.csv:", *words)

    def test_a_column_of_a_curve_that_comes_twice(self):
        case = self.case(**{"pressure.kind": '"curve"', "pressure.file": '"curve.csv"'})
        for heading in ("theta_deg,pressure_bar,pressure_bar", "theta_deg,theta_deg,pressure_bar"):
            with self.subTest(heading):
                (self.folder / "curve.csv").write_text(heading + "\n0,5,1\n90,6,200\n180,7,300\n")
                self.assert_mentions(self.refused_by_every_command(case), "curve.csv", "must have one column")

    def test_an_empty_argument_is_not_one_that_is_not_given(self):
        """What a script passes whose variable is not set: a check would be left out."""
        case = self.case()
        for command, name in ((["compare", case, "--with", ""], "--with"), (["regress", "--filter", "standstill", ""], "dir"),
                              (["compare", case, "--multibody-case", ""], "--multibody-case"), (["run", case, "--states", ""], "--states"),
                              (["simulate", case, "--fmu", ""], "--fmu"), (["life", case, "--duty", ""], "--duty"),
                              (["regress", "--junit", ""], "--junit"), (["show", case, "--out", ""], "--out"),
                              (["sweep", case, "--study", ""], "--study"), (["merge", ""], "OUT"), (["run", ""], "case"),
                              (["compare", case, "--set", ""], "--set")):
            with self.subTest(command[0], name=name):
                self.assert_mentions(self.refused(*command), name + ": must not be empty")

    def test_what_the_system_refuses(self):
        (self.folder / "loop").symlink_to("loop")
        for name in ("loop", "loop/x", "a" * 300):
            for command in (["regress", name], ["compare", self.case(), "--with", name], ["merge", name], ["index", name],
                            ["reference", "update", name], ["reference", "golden", self.case(), "--out", name]):
                with self.subTest(command[0], name=name[:9]):
                    line = self.refused(*command)
                    self.assert_mentions(line, name[:9])
                    self.assertNotIn("filesystem", line)

    def test_files_that_are_none(self):
        (self.folder / "empty.toml").write_text("")
        (self.folder / "binary.toml").write_bytes(bytes(range(256)))
        for name in ("absent.toml", ".", "empty.toml", "binary.toml", "/dev/null", ""):
            with self.subTest(name):
                self.assert_mentions(self.refused_by_every_command(name), name)

    def test_inertia_asked_for_without_data(self):
        case = self.case()
        for model in ("--analytic", "--multibody"):
            line = self.refused("compare", case, model, "inertia=real", "--out", "out")
            self.assert_mentions(line, "inertia=real", "centre_of_mass_mm", "transverse_inertia_kg_mm2",
                                 "axial_inertia_kg_mm2")

    def test_integrated_run_at_standstill(self):
        case = self.case(**{"operation.speed_rpm": 0.0})
        for command in (["run", case, "--model", "multibody"], ["compare", case]):
            line = self.refused(*command, "--way", "integrated", "--out", "out")
            self.assert_mentions(line, "case.toml", "speed_rpm")
        self.run_program("compare", case, "--out", "out")  # driven, standstill is a case as any other

    def test_massless_piston(self):
        case = self.case(**{"piston.mass_kg": 0.0})
        for command in (["run", case, "--model", "multibody"], ["compare", case],
                        ["run", case, "--model", "multibody", "--way", "integrated"]):
            line = self.refused(*command, "--out", "out", status=COMPUTATION_FAILED)
            self.assert_mentions(line, "multibody", "mass")
        self.run_program("run", case, "--model", "analytic", "--out", "out")


# ---- Output that cannot be written, interruption, company ---------------------------------------------


def limit_file_size(size):
    """For a child process: writing beyond `size` bytes is an error, as on a full disk."""
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    return limit


class OutputTest(ProgramTest):
    COMMANDS = (["compare"], ["run", "--model", "analytic"], ["run", "--model", "multibody"])

    def test_folder_cannot_be_made(self):
        (self.folder / "file").write_text("mine")
        case = self.case()
        for out in ("file", "file/below", "/proc/bentaxis", "/dev/null"):
            for command in self.COMMANDS:
                with self.subTest(out=out, command=command):
                    self.assert_mentions(self.refused(*command, case, "--out", out), out, "cannot be written")

    def test_folder_where_a_file_should_be(self):
        self.run_program("compare", self.case(), "--out", "out")
        faster = self.case(**{"operation.speed_rpm": 3000.0})
        for name in sorted(REPORT_FILES):
            with self.subTest(name):
                file = self.folder / "out" / name
                kept = file.read_bytes()
                file.unlink()
                file.mkdir()
                self.assert_mentions(self.refused("compare", faster, "--out", "out"), f"out/{name}", "directory")
                file.rmdir()
                file.write_bytes(kept)

    def test_full_disk(self):
        case = self.case()
        for command in self.COMMANDS:
            for size in (0, 10_000):
                with self.subTest(command=command, size=size):
                    line = self.refused(*command, case, "--out", "new/one", preexec_fn=limit_file_size(size))
                    self.assert_mentions(line, "new/one/", "cannot be written")

    def test_full_disk_leaves_earlier_results(self):
        self.run_program("compare", self.case(), "--out", "out")
        faster = self.case(**{"operation.speed_rpm": 3000.0})
        for command in self.COMMANDS:
            with self.subTest(command=command):
                self.refused(*command, faster, "--out", "out", preexec_fn=limit_file_size(10_000))

    def test_new_results_replace_old_ones_and_nothing_else(self):
        self.run_program("compare", self.case(), "--out", "out")
        (self.folder / "out" / "notes.txt").write_text("mine")
        before = self.contents()
        self.run_program("compare", self.case(**{"operation.speed_rpm": 3000.0}), "--out", "out")
        after = self.contents()
        self.assertEqual(after.keys(), before.keys())
        self.assertEqual(after["out/notes.txt"], b"mine")
        for name in REPORT_FILES:
            self.assertNotEqual(after[f"out/{name}"], before[f"out/{name}"], name)

    def test_output_that_does_not_arrive_is_no_success(self):
        # A long text fails before its end: why is then forgotten, and nothing else is said instead.
        for arguments in (["--help"], ["--version"], ["schema"], ["run", self.case(), "--model", "analytic", "--out", "out"],
                          ["compare", self.case(), "--out", "out"]):
            with self.subTest(arguments), open("/dev/full", "w") as full:
                done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, stdin=subprocess.DEVNULL,
                                      stdout=full, stderr=subprocess.PIPE, text=True)
                self.assertEqual(done.returncode, BAD_INPUT)
                self.assertRegex(PUMP.sub("", done.stderr), r"^bentaxis: standard output cannot be written(: No space left on device)?\n$")
        # Of a job that fails anyway, one line says why.
        shutil.copytree(REPO / "reference_data" / "hard" / "tilt_45", self.folder / "hard" / "tilt_45")
        shutil.copy(REPO / "reference_data" / "hard" / "catalogue.toml", self.folder / "hard")
        (self.folder / "hard" / "tilt_45" / "reference.csv").unlink()
        with open("/dev/full", "w") as full:
            done = subprocess.run([PROGRAM, "hardcases", "--catalogue", "hard", "--filter", "tilt_45", "--out", "out"],
                                  cwd=self.folder, stdin=subprocess.DEVNULL, stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertEqual(done.returncode, BAD_INPUT)
        self.assertRegex(done.stderr, r"^bentaxis: [^\n]*reference\.csv[^\n]*\n$")


class LargeRunTest(ProgramTest):
    """Many rows: files have them all, the page some of them, and memory grows by what the tables need."""

    ROWS = 12_000  # more than there are beside which nothing runs (studies/verification/comparison.cpp)
    BYTES_OF_A_ROW = 10_000  # two tables of 78 numbers, curves, budgets: 4 200 were measured

    def memory_of(self, *arguments):
        """Largest resident memory of a run that succeeds, bytes."""
        process = self.start(*arguments)
        self.addCleanup(process.kill)
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        process.communicate()
        self.assertEqual(process.returncode, DONE)
        return used.ru_maxrss * 1024

    def test_a_comparison_holds_less_than_both_tables(self):
        """Of very many rows one model's values at a time: the other's lie in a file that has no name."""
        rows = (self.ROWS, 3 * self.ROWS)
        used = [self.memory_of("compare", self.case(f"{n}.toml", **{"operation.samples_per_revolution": n}), "--out", str(n)) for n in rows]
        two_tables = 2 * 78 * 8
        self.assertLess(used[1] - used[0], (rows[1] - rows[0]) * two_tables)
        self.assertEqual([file.name for file in (self.folder / str(rows[1])).iterdir() if file.name.startswith(".")], [])

    def page_of(self, folder):
        page = (self.folder / folder / "report.html").read_text()
        found = {name: json.loads(text) for name, text in
                 re.findall(r'<script type="application/json" id="(report|scene)">(.*?)</script>', page, re.DOTALL)}
        self.assertIn("scene", found)
        self.assertIn("polygon_piston", [figure["id"] for figure in found["report"]["figures"]])
        return page, found["scene"]

    def test_comparison(self):
        few, many = (self.case(f"{rows}.toml", **{"operation.samples_per_revolution": rows}) for rows in (720, self.ROWS))
        small = self.memory_of("compare", few, "--out", "few")
        large = self.memory_of("compare", many, "--out", "many")
        self.assertLess(large - small, self.ROWS * self.BYTES_OF_A_ROW)
        self.run_program("run", many, "--model", "analytic", "--out", "run")
        self.assertEqual((self.folder / "many/analytic.csv").read_bytes(), (self.folder / "run/analytic.csv").read_bytes())
        self.assertEqual((self.folder / "many/multibody.csv").read_text().count("\n"), self.ROWS + 1)
        page, scene = self.page_of("many")
        self.assertLess(len(page), 20_000_000)
        self.assertEqual(scene["rows"], -(-self.ROWS // -(-self.ROWS // 1440)))
        self.assertIn("one of 9 rows", scene["note"])

    def test_simulation(self):
        case = str(REPO / "cases/bap63_rated.toml")
        drive = ["--set", "drive.kind=speed", "--set", "drive.duration_s=0.04"]
        rows = self.ROWS
        small = self.memory_of("simulate", case, *drive, "--set", "drive.samples=720", "--out", "few")
        large = self.memory_of("simulate", case, *drive, "--set", f"drive.samples={rows}", "--out", "many")
        self.assertLess(large - small, rows * self.BYTES_OF_A_ROW)
        self.assertEqual((self.folder / "many/simulation_multibody.csv").read_text().count("\n"), rows + 2)
        page, _ = self.page_of("many")
        self.assertLess(len(page), 20_000_000)


class InterruptionTest(ProgramTest):
    def long_case(self):
        return self.case("long.toml", **{"operation.samples_per_revolution": 200000})

    def start_and_wait(self, *arguments):
        """Starts what takes long and waits until it computes."""
        process = self.start(*arguments)
        self.addCleanup(process.kill)
        out = self.folder / arguments[arguments.index("--out") + 1]
        until = time.monotonic() + 20

        def computed():  # seconds of its own, however busy the machine
            fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
            return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

        while (not out.exists() or computed() < 0.4) and time.monotonic() < until and process.poll() is None:
            time.sleep(0.02)
        self.assertIsNone(process.poll(), "ended before it could be interrupted")
        return process

    def test_interrupted_run_leaves_nothing(self):
        case = self.long_case()
        for command in (["run", case, "--model", "multibody"], ["compare", case],
                        ["run", case, "--model", "multibody", "--way", "integrated"]):
            for out in ("new/folder", "there"):
                with self.subTest(command=command, out=out):
                    (self.folder / "there").mkdir(exist_ok=True)
                    (self.folder / "there" / "multibody.csv").write_text("earlier result")
                    before = self.contents()
                    process = self.start_and_wait(*command, "--out", out)
                    process.send_signal(signal.SIGINT)
                    sent = time.monotonic()
                    self.finish(process, INTERRUPTED)
                    self.assertLess(time.monotonic() - sent, 5)
                    self.assertEqual((process.out, process.err.count("\n")), ("", 1), process.err)
                    self.assertEqual(self.contents(), before)

    def test_other_signals_that_end_a_run(self):
        for number in (signal.SIGTERM, signal.SIGHUP):
            with self.subTest(number):
                process = self.start_and_wait("run", self.long_case(), "--model", "multibody", "--out", "new/folder")
                process.send_signal(number)
                self.finish(process, INTERRUPTED)
                self.assertEqual(self.contents().keys(), {"long.toml"})

    def test_interrupted_run_keeps_what_others_put_into_its_folder(self):
        process = self.start_and_wait("run", self.long_case(), "--model", "multibody", "--out", "out")
        self.run_program("run", self.case(), "--model", "analytic", "--out", "out")
        (self.folder / "out" / "notes.txt").write_text("mine")
        process.send_signal(signal.SIGINT)
        self.finish(process, INTERRUPTED)
        self.assertEqual({p.name for p in self.folder.glob("out/*")}, {"analytic.csv", "notes.txt"})


    def test_what_a_killed_run_has_left_is_removed_by_the_next(self):
        process = self.start("run", self.long_case(), "--model", "analytic", "--out", "out")
        self.addCleanup(process.kill)
        until = time.monotonic() + SECONDS
        while not list(self.folder.glob("out/.bentaxis.part-*/*")) and time.monotonic() < until and process.poll() is None:
            time.sleep(0.002)
        process.kill()
        process.communicate()
        self.assertEqual(process.returncode, -signal.SIGKILL)
        self.assertEqual(len(os.listdir(self.folder / "out")), 1)
        self.run_program("run", self.case(), "--model", "multibody", "--out", "out")
        self.assertEqual(os.listdir(self.folder / "out"), ["multibody.csv"])

    def test_an_interrupted_update_says_what_was_rewritten(self):
        for name, samples in (("a", 3), ("b", 4000)):
            self.run_program("reference", "golden", self.case(), "--angles", samples, "--out", f"data/{name}")
        (self.folder / "data" / "a" / "multibody.csv").write_text("theta_deg\n0\n")
        process = self.start("reference", "update", "data")
        self.addCleanup(process.kill)
        until = time.monotonic() + SECONDS
        before = (self.folder / "data" / "a" / "multibody.csv").read_bytes()
        while (self.folder / "data" / "a" / "multibody.csv").read_bytes() == before and time.monotonic() < until and process.poll() is None:
            time.sleep(0.002)
        process.send_signal(signal.SIGINT)
        self.finish(process, INTERRUPTED)
        self.assertEqual(process.err, "bentaxis: interrupted after 1 of 2 golden folders, of which 1 were rewritten; do the same again for the rest\n")
        self.assertEqual({p.name for p in self.folder.glob("data/a/*")}, {"description.toml", "analytic.csv", "multibody.csv"})


def limit_files(size):
    """For preexec_fn: files of the program may have this many bytes, as on a disk that is full then."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


class FullDiskTest(ProgramTest):
    """A file that cannot be completed: one line that names it, status 2, and what was there is there."""

    def test_every_command_that_writes(self):
        rated, start = REPO / "cases" / "bap63_rated.toml", REPO / "cases" / "bap63_motor_start.toml"
        few = ("--set", "operation.samples_per_revolution=36")
        (self.folder / "record.csv").write_text(
            "theta_deg,Rs_1_z2_N\n" + "".join(f"{angle},{1000 + angle}\n" for angle in range(0, 360, 10)))
        for command in (["run", rated, *few, "--model", "analytic", "--out", "out"],
                        ["run", rated, *few, "--model", "multibody", "--out", "out"],
                        ["compare", rated, *few, "--out", "out"],
                        ["compare", rated, *few, "--out", "there", "--figures", "out"],
                        ["show", rated, "--out", "pump.svg"],
                        ["show", rated, *few, "--out", "out"],
                        ["simulate", start, *few, "--model", "analytic", "--out", "out"],
                        ["sensitivity", rated, *few, "--output", "peak:Rb1", "--out", "out"],
                        ["life", REPO / "cases" / "bap63_bearing_life.toml", *few, "--out", "out"],
                        ["inertia", rated, *few, "--speeds", "1500", "--out", "out"],
                        ["fmu", rated, "--out", "pump.fmu"],
                        ["init", "project", "--case", rated],
                        ["reference", "golden", rated, "--out", "out"],
                        ["index", ".", "--out", "index.html"]):
            with self.subTest(command=command[0]):
                if command[0] == "index":
                    self.run_program("show", rated, *few, "--out", "report")
                before = self.contents()
                result = self.run_program(*command, status=BAD_INPUT, preexec_fn=lambda: limit_files(700))
                self.assertRegex(result.err, r"^bentaxis: \S+: cannot be written: File too large\n$")
                self.assertEqual(self.contents(), before)


class MemoryTest(ProgramTest):
    """What would not fit is refused before it is computed: what it needs, what there is, what to lower."""

    def test_samples_and_rows(self):
        start, rated = REPO / "cases" / "bap63_motor_start.toml", self.case(**{"operation.samples_per_revolution": 200000})
        little, more = 6e8, 1.2e9
        for command, key in ((("compare", rated), "samples_per_revolution"),
                             (("run", rated, "--model", "multibody", "--set", "operation.revolutions=20", "--way", "integrated"), "samples_per_revolution"),
                             (("inertia", rated, "--speeds", "1500"), "samples_per_revolution"),
                             (("simulate", start, "--model", "analytic", "--set", "drive.samples=200000"), "[drive] samples"),
                             (("simulate", start, "--set", "drive.samples=200000"), "[drive] samples")):
            with self.subTest(command=command):
                line = self.refused(*command, preexec_fn=lambda: limit_memory(little if command[0] in ("simulate", "compare") else more))
                self.assertRegex(line, rf"{re.escape(key)} = 200000(, revolutions = 20)?: .*about [0-9.]+ GB of memory are needed, and [0-9.]+ GB are "
                                       rf"available; lower {re.escape(key)}")
        result = self.run_program("show", rated, "--out", "out", status=BAD_INPUT, preexec_fn=lambda: limit_memory(little))
        self.assert_mentions(result.err, "samples_per_revolution = 200000: ", "GB of memory are needed")
        # A series is as many runs.
        fits = self.case("fits.toml", **{"operation.samples_per_revolution": 20000})
        result = self.run_program("inertia", fits, "--speeds", "500,1000,1500,2000,2500,3000", "--out", "out", status=BAD_INPUT,
                                  preexec_fn=lambda: limit_memory(more))
        self.assert_mentions(result.err, "samples_per_revolution = 20000: ", "GB of memory are needed")
        # Row by row, and few of them, it fits.
        self.run_program("run", rated, "--model", "analytic", "--out", "out", preexec_fn=lambda: limit_memory(1.2e9))
        self.run_program("compare", self.case("few.toml"), "--out", "out", preexec_fn=lambda: limit_memory(1.2e9))

    def test_many_designs(self):
        case = self.case(**{"operation.samples_per_revolution": 36})
        with open(case, "a") as file:
            file.write('\n[uncertainty]\n"pump.tilt_deg" = "normal(0.1)"\n')
        line = self.refused("uncertainty", case, "--samples", 10000000, "--output", "mean:Td", preexec_fn=lambda: limit_memory(1.2e9))
        self.assertRegex(line, "--samples: .*GB of memory are needed, and .*; lower --samples")


def limit_memory(size):
    """For preexec_fn: the address space of the program may have this many bytes."""
    resource.setrlimit(resource.RLIMIT_AS, (int(size), int(size)))


class TogetherTest(ProgramTest):
    def test_runs_into_one_folder(self):
        case = self.case(**{"operation.samples_per_revolution": 720})
        commands = [["run", case, "--model", model, "--out", "out"] for model in RunTest.MODELS]
        for process in [self.start(*command) for command in commands]:
            self.finish(process, DONE)
        self.assertEqual({p.name for p in self.folder.glob("out/*")}, {"analytic.csv", "multibody.csv"})
        for model in RunTest.MODELS:
            self.assertEqual(len(self.column(f"out/{model}.csv", "theta_deg")), 720)

    def test_same_command_several_times(self):
        case = self.case()
        for process in [self.start("compare", case, "--out", "out") for _ in range(4)]:
            self.finish(process, DONE)
        self.assertEqual({p.name for p in (self.folder / "out").iterdir()}, REPORT_FILES)
        json.loads((self.folder / "out" / "report.json").read_text())
        self.assertTrue((self.folder / "out" / "report.html").read_text().rstrip().endswith("</html>"))
        for model in RunTest.MODELS:
            self.assertEqual(len(self.column(f"out/{model}.csv", "theta_deg")), 36)


class PressureTest(ProgramTest):
    """bentaxis pressure, and what run and compare make of a hydraulic case."""

    CASES = ("bap63_rated", "bap63_peak")
    # No calibrated one: those the cases were set to.
    OUTSIDE = {"bap63_peak": set(), "bap63_rated": {
        ("predicted", "oscillations of the torque in a turn (order of its largest harmonic)"),
        ("predicted", "Rcs at 0 deg, the paper's model"),
        ("predicted", "torque from shaft to block at 0 deg, the paper's model"),
        ("predicted", "Rcs along x2"),
        ("used to infer the geometry", "torque from shaft to block at 38 deg")}}

    @property
    def NUMBERS(self):
        return REPO / "reference_data" / "published" / "bap63" / "numbers.toml"

    def hydraulic(self, name="case.toml", of="bap63_rated", **changes):
        case = Case()
        case.lines = (REPO / "cases" / f"{of}_hydraulic.toml").read_text().splitlines()
        return case.set({"operation.samples_per_revolution": 72, **changes}).write(self.folder / name)

    def test_files_and_numbers(self):
        result = self.run_program("pressure", self.hydraulic(), "--out", "out", "--transient", 2)
        self.assertEqual({p.name for p in self.folder.glob("out/*")},
                         {"pressure.html", "pressure.json", "pressure.csv", "power.csv", "orders.csv", "transient.csv"})
        self.assertEqual(len(self.column("out/pressure.csv", "p_1_bar")), 720)
        delivery = [float(v) for v in self.column("out/pressure.csv", "p_delivery_bar")]
        self.assertAlmostEqual(sum(delivery) / len(delivery), 275, delta=0.01)
        report = json.loads((self.folder / "out/pressure.json").read_text())
        self.assertLessEqual({"Fig. 10, 17", "Fig. 25", "Fig. 17"}, {f["paper"] for f in report["figures"]})
        facts = {row[0]: row[1] for row in report["runs"][0]["table"]["rows"]}
        self.assertAlmostEqual(facts["mean delivery pressure"], 275, delta=1e-4)
        self.assertIn("volumetric efficiency", result.out)
        power = dict(zip(self.column("out/power.csv", "place"), map(float, self.column("out/power.csv", "power_W"))))
        what = dict(zip(self.column("out/power.csv", "place"), self.column("out/power.csv", "what")))
        left = sum(watts if what[place] == "source" else -watts for place, watts in power.items())
        self.assertLess(abs(left), 1e-9 * power["pistons"])
        rows = {row[0]: row[2] for row in report["runs"][1]["table"]["rows"]}
        self.assertEqual(rows["into the load"], power["load"])
        self.assertEqual(rows["all losses"], sum(watts for place, watts in power.items() if what[place] == "loss"))
        orders = [int(order) for order in self.column("out/orders.csv", "order")]
        self.assertEqual(orders, list(range(1, 101)))
        flow = [float(v) for v in self.column("out/orders.csv", "Qload_l_per_min")]
        self.assertEqual({order % 5 for order, v in zip(orders, flow) if v != 0}, {0})
        ids = {figure["id"] for figure in report["figures"]}
        self.assertLessEqual({"pv", "dp_dtheta", "bulk_modulus", "bulk_modulus_law", "opening_parts", "backflow", "power",
                              "losses", "orders_flow", "orders_pressure", "orders_rate"}, ids)
        # 72 samples a turn are few, but the means of both models are those of the same samples
        self.assertRegex(result.out, r"mean drive torque, multibody +29\d")

    def test_shipped_cases_against_the_published_numbers(self):
        for name in self.CASES:
            result = self.run_program("pressure", REPO / "cases" / f"{name}_hydraulic.toml", "--out", name,
                                      "--published", self.NUMBERS)
            rows = json.loads((self.folder / name / "pressure.json").read_text())["published"]["rows"]
            outside = {(row["status"], row["quantity"]) for row in rows if row["verdict"] == "outside"}
            self.assertEqual(outside, self.OUTSIDE[name])
            self.assertGreater(len([row for row in rows if row["verdict"] == "inside"]), 10)
            self.assertEqual(result.out.count("OUTSIDE"), len(outside))
        needs = [float(x) for x in re.findall(r"needs a mean delivery pressure of ([0-9.]+) bar", result.out)]
        self.assertEqual(len(needs), 3)
        for pressure in needs:
            self.assertTrue(370 < pressure < 385.9, needs)

    def test_the_timed_plate_against_the_published_numbers(self):
        """They are tests of it, and docs/hydraulics.md says which it misses: these, and what neither plate meets."""
        self.run_program("pressure", REPO / "cases" / "bap63_rated_timed_plate.toml", "--out", "timed",
                         "--published", self.NUMBERS, status=1)  # friction was calibrated with the other plate
        rows = json.loads((self.folder / "timed" / "pressure.json").read_text())["published"]["rows"]
        outside = {(row["status"], row["quantity"]) for row in rows if row["verdict"] == "outside"}
        self.assertEqual(outside - self.OUTSIDE["bap63_rated"], {
            ("used to infer the geometry", "Rb2 y1"),
            ("calibrated", "mean torque, the paper's model"), ("calibrated", "mean torque, measured"),
            ("calibrated", "mean torque, ADAMS"),
            ("used to infer the geometry", "torque from shaft to block at 0 deg, ADAMS"),
            ("used to infer the geometry", "torque from shaft to block, ADAMS"),
            ("used to infer the geometry", "Rcs z4")})

    def test_number_outside_its_window(self):
        case = self.hydraulic(**{"friction.shaft_torque_factor": 0.95})
        result = self.run_program("pressure", case, "--out", "out", "--published", self.NUMBERS, status=OUT_OF_TOLERANCE)
        self.assertRegex(result.out, r"mean torque, the paper's model.* OUTSIDE +calibrated")

    def test_nothing_of_an_earlier_result_stays_beside_a_report(self):
        self.run_program("compare", self.hydraulic(), "--out", "out")
        (self.folder / "out" / "notes.txt").write_text("mine")
        self.assertTrue((self.folder / "out" / "pressure.csv").exists())
        self.run_program("compare", self.case("plain.toml"), "--out", "out")
        self.assertEqual({p.name for p in (self.folder / "out").iterdir()}, REPORT_FILES | {"notes.txt"})
        report = json.loads((self.folder / "out" / "report.json").read_text())
        self.assertEqual(set(report["files"]), REPORT_FILES)

    def test_numbers_of_another_pump(self):
        case = self.hydraulic(**{"gear.pitch_diameter_mm": 90.0})
        result = self.run_program("pressure", case, "--out", "out", "--published", self.NUMBERS, status=BAD_INPUT)
        self.assertRegex(result.err, r"case.toml: the printed numbers are of another pump \(.*\): gear_arm_mm is ")
        self.assertFalse((self.folder / "out").exists())

    def test_torque_curve(self):
        result = self.run_program("pressure", self.hydraulic(), "--out", "out", "--delivery-bar", "0:350:25")
        shown = result.out[result.out.index("mean Td, analytic"):result.out.index("out/pressure.html")]
        self.assertIn("294.7", shown)
        for number in re.findall(r"[0-9.]+", shown):  # in the file all digits, on the console six
            self.assertLessEqual(len(number.replace(".", "").lstrip("0")), 6, number)
        at_delivery = [float(v) for v in self.column("out/torque_curve.csv", "flow_at_delivery_l_per_min")]
        pressures = [float(v) for v in self.column("out/torque_curve.csv", "delivery_bar")]
        self.assertEqual(pressures, [25.0 * i for i in range(15)])
        torque = [float(v) for v in self.column("out/torque_curve.csv", "mean_Td_analytic_Nm")]
        other = [float(v) for v in self.column("out/torque_curve.csv", "mean_Td_multibody_Nm")]
        flow = [float(v) for v in self.column("out/torque_curve.csv", "flow_l_per_min")]
        self.assertEqual((torque, flow), (sorted(torque), sorted(flow, reverse=True)))
        for a, b in zip(torque, other):
            self.assertAlmostEqual(a, b, delta=1e-9 * torque[-1])
        # Compressed oil takes less room: by p/K and the air in it.
        for i in range(1, len(flow)):
            self.assertAlmostEqual(at_delivery[i] / flow[i], 1 - 25e5 * i / 1.4e9 - 0.005, delta=3e-3)
        figures = {f["id"]: f for f in json.loads((self.folder / "out/pressure.json").read_text())["figures"]}
        drawn = {s["label"]: s["values"] for s in figures["flow_curve"]["series"]}
        for label, values in (("in the suction port", flow), ("of the mean delivery pressure", at_delivery)):
            for shown, value in zip(drawn.pop("volume flow to the load, at the density " + label), values, strict=True):
                self.assertAlmostEqual(shown / value, 1, 8)  # the page has nine digits
        self.assertEqual(drawn, {})

    def test_calibrate_and_blocktorque(self):
        result = self.run_program("calibrate", REPO / "cases" / "bap63_rated_hydraulic.toml", "--torque-with-friction", "294.7",
                                  "--torque-without-friction", "293.4")
        self.assertEqual(result.out, 4 * ("piston_coulomb_N = 25.1777, shaft_torque_factor = 0.987746: 294.7000 Nm with, "
                                          "293.4000 Nm without piston friction\n"))
        cases = [REPO / "cases" / f"{name}.toml" for name in ("bap63_rated", "bap63_rated_hydraulic")]
        result = self.run_program("blocktorque", *cases)
        self.assertIn(result.out, (REPO / "docs" / "shaft_to_block_torque.md").read_text())
        self.assert_mentions(self.refused("blocktorque", cases[0]), "HYDRAULIC_CASE is missing")
        self.assert_mentions(self.refused("calibrate", self.case(**{"friction.piston_coulomb_N": 0.0}), "--torque-with-friction", 2, "--torque-without-friction", 1),
                             "piston_coulomb_N")

    def test_calibrate_finds_the_torques_or_says_that_it_does_not(self):
        def viscous(value):
            return self.case(**{"operation.samples_per_revolution": 36, "friction.piston_viscous_N_s_per_m": value})

        # Viscous friction does not grow with piston_coulomb_N: it adds about 2 of the wanted 3 Nm.
        result = self.run_program("calibrate", viscous(20.0), "--torque-with-friction", 295, "--torque-without-friction", 292)
        self.assertIn(": 295.0000 Nm with, 292.0000 Nm without", result.out.splitlines()[-1])
        # And here more than is wanted: no Coulomb friction gives that.
        self.assert_mentions(self.refused("calibrate", viscous(500.0), "--torque-with-friction", 295, "--torque-without-friction", 292),
                             "piston_coulomb_N", "must be > 0", "add 3 Nm", "piston_viscous_N_s_per_m")
        self.assert_mentions(self.refused("calibrate", viscous(0.0), "--torque-with-friction", 290, "--torque-without-friction", 295), "piston_coulomb_N", "add -5 Nm")

    def test_overlay(self):
        self.run_program("pressure", self.hydraulic(), "--overlay", self.hydraulic("peak.toml", "bap63_peak"),
                         "--out", "out")
        figures = {f["paper"]: f for f in json.loads((self.folder / "out/pressure.json").read_text())["figures"]}
        for number in range(19, 25):
            figure = figures[f"Fig. {number}"]
            self.assertEqual(len(figure["x"]["values"]), 3 * 72)
            self.assertTrue(all(len(s["values"]) == 3 * 72 for s in figure["series"]))

    def test_both_models_get_the_same_curve(self):
        case = self.hydraulic()
        self.run_program("compare", case, "--out", "out")
        self.assertEqual({p.name for p in self.folder.glob("out/*")}, REPORT_FILES | {"pressure.csv"})
        for k in range(1, 6):
            self.assertEqual(self.column("out/analytic.csv", f"p_{k}_bar"), self.column("out/multibody.csv", f"p_{k}_bar"))
        report = json.loads((self.folder / "out/report.json").read_text())
        self.assertIn("Hydraulic model", [run["title"] for run in report["runs"]])
        self.run_program("run", case, "--model", "multibody", "--out", "run")
        self.assertEqual((self.folder / "run/multibody.csv").read_text(), (self.folder / "out/multibody.csv").read_text())

    def test_refused(self):
        for changes, words in (
                ({"operation.speed_rpm": 0.0}, ("speed_rpm", "at rest")),
                ({"operation.speed_rpm": -1500.0}, ("speed_rpm", "motoring")),
                ({"pump.tilt_deg": 0.0}, ("tilt_deg", "stroke")),
                ({"pressure.delivery_bar": -1.0}, ("delivery_bar", "[0,")),
                ({"pressure.suction_bar": -2.0}, ("suction_bar", "absolute")),
                ({"pressure.points": 4}, ("points", "[16,")),
                ({"hydraulics.air_percent": 0.0}, ("air_percent", "(0,")),
                ({"hydraulics.bulk_modulus_GPa": 1.4}, ("bulk_modulus_GPa", "bulk_modulus_MPa")),
                ({"hydraulics.kidney_width_deg": None}, ("kidney_width_deg", "missing")),
                ({"hydraulics.notch_law": '"cubic"'}, ("notch_law", "quadratic"))):
            with self.subTest(changes):
                line = self.refused("pressure", self.hydraulic(**changes), "--out", "out")
                self.assert_mentions(line, "case.toml", *words)
        self.assert_mentions(self.refused("pressure", self.case("ideal.toml")), "ideal.toml", "hydraulic")
        case = self.hydraulic()
        for text, word in ("1:2", "FROM:TO:STEP"), ("a:2:1", "FROM:TO:STEP"), ("5:1:1", "FROM <= TO"), ("0:1:0", "STEP > 0"):
            self.assert_mentions(self.refused("pressure", case, "--delivery-bar", text), text, word)
        slow = self.hydraulic("slow.toml", **{"operation.speed_rpm": 5.0})
        self.assert_mentions(self.refused("pressure", slow, status=COMPUTATION_FAILED), "slow.toml", "delivery_bar", "cannot be reached",
                             "11.7 bar")


# ---- The format of case files ----------------------------------------------------------------------------


class SchemaTest(ProgramTest):
    def errors(self, file):
        return [error.message for error in jsonschema.Draft7Validator(self.schema()).iter_errors(
            tomllib.loads(pathlib.Path(file).read_text()))]

    def test_every_case_of_the_repository_conforms(self):
        files = [*REPO.glob("cases/*.toml"), *REPO.glob("reference_data/*/*/case.toml")]
        self.assertGreater(len(files), 70)
        for file in files:
            self.assertEqual(self.errors(file), [], file)

    def test_what_a_single_key_can_be_refused_for_is_in_the_schema(self):
        together = {  # what keys must be to each other, or what files must be there
            "pistons cannot reach", "equal bearings", "land", "lands overlap", "arc too long", "arc backwards",
            "no such curve", "folder for a curve", "axial inertia above twice the transverse",
            "inertia of pistons without their data", "not a number", "infinite",
            "float for an integer"}  # 5.0 is an integer in JSON
        checked = 0
        for label, changes, _ in BAD_VALUES:
            if label in together:
                continue
            with self.subTest(label):
                checked += 1
                self.assertNotEqual(self.errors(Case(**changes).write(self.folder / "case.toml")), [])
        self.assertGreater(checked, 20)

    def test_what_a_choice_makes_necessary(self):
        for changes in ({"pressure.transition_deg": None}, {"pressure.kind": '"curve"'},
                        {"pressure.kind": '"hydraulic"'}, {"piston.inertia": '"real"'}):
            with self.subTest(changes):
                self.assertNotEqual(self.errors(Case(**changes).write(self.folder / "case.toml")), [])

    def test_tables_for_docs(self):
        text = self.run_program("schema", "--markdown", "gear", "bearings").out
        self.assertIn("| `pressure_angle_deg` | alpha_p |", text)
        self.assertIn("| `tapered_z_mm` | z_C1 |", text)
        self.assert_mentions(self.refused("schema", "--markdown", "gears"), "gears", '"gear"')


# ---- Negative controls: a wrong input to one model is noticed -------------------------------------------

# Cases in which every parameter has something to do. Pressure hides weights and inertia: light cases show them.
RATED = {"pressure.suction_bar": 5.0, "friction.piston_viscous_N_s_per_m": 20.0, "friction.regularization_m_per_s": 0.5}
LIGHT = {"pressure.delivery_bar": 0.0, "operation.speed_rpm": 3000.0}
REAL = {**LIGHT, "piston.inertia": '"real"', "piston.centre_of_mass_mm": 19.0, "piston.transverse_inertia_kg_mm2": 24.0,
        "piston.axial_inertia_kg_mm2": 5.0, "piston.spin_rpm": 900.0}
BESIDE_B = {**RATED, "piston.contact_mm": 41.5, "gear.flanks": '"two"', "friction.block_viscous_Nm_per_rpm": 0.0}
COMPLIANT = {**RATED, "gear.contact": '"compliant"', "gear.stiffness_N_per_um": 200.0}
CURVED = {"pressure.kind": '"curve"', "pressure.file": '"curve.csv"'}

# At rest: with runout, relief and crowning, and a torque that brings tips in early.
TEETH = {**RATED, "gear.contact": '"teeth"', "gear.tooth_number": 27, "gear.face_width_mm": 16.0, "gear.addendum_mm": 3.9,
         "gear.dedendum_mm": 4.9, "gear.tip_relief_um": 5.0, "gear.tip_relief_height_mm": 2.0, "gear.lead_crowning_um": 6.0,
         "gear.youngs_modulus_GPa": 206.0, "gear.poisson_ratio": 0.3, "gear.rim_ratio": 3.0, "gear.shaft_runout_um": 4.0,
         "gear.shaft_runout_deg": 40.0, "gear.block_runout_um": 3.0, "gear.block_runout_deg": 100.0, "gear.backlash_um": 20.0,
         "gear.dissipation_s_per_m": 0.5, "friction.block_viscous_Nm_per_rpm": 0.05}

# What does not make itself felt in the rated case; every other number of that case does.
HIDDEN_BY_PRESSURE = {"shaft.mass_kg", "shaft.centre_of_mass_z_mm", "block.mass_kg", "block.centre_of_mass_z_mm",
                      "operation.gravity_m_per_s2"}
# Beside it: cases and what counts there.
CONTROLS = (
    (LIGHT, {*HIDDEN_BY_PRESSURE, "piston.mass_kg", "piston.joint_mass_fraction", "operation.speed_rpm"}),
    (REAL, {"piston.mass_kg", "piston.centre_of_mass_mm", "piston.transverse_inertia_kg_mm2", "piston.axial_inertia_kg_mm2",
            "piston.spin_rpm"}),
    (BESIDE_B, {"piston.contact_mm", "gear.pitch_diameter_mm", "gear.pressure_angle_deg"}),
    (TEETH, {name for name, value in TEETH.items() if name.startswith("gear.") and isinstance(value, float)}
     - {"gear.dissipation_s_per_m"}),
)
# Numbers that say how much is computed, not what of.
STRUCTURE = {"pump.pistons", "gear.tooth_number", "operation.samples_per_revolution", "operation.revolutions", "pressure.points"}
# Ratings of bearings: only their life depends on them (tests/bearing_life_test.cpp).
RATINGS = {"bearings.tapered_dynamic_rating_kN": 105.0, "bearings.tapered_static_rating_kN": 125.0, "bearings.tapered_Y": 0.73,
           "bearings.tapered_e": 0.83, "bearings.tapered_X": 0.4, "bearings.tapered_Y0": 0.4,
           "bearings.cylindrical_dynamic_rating_kN": 106.0, "bearings.cylindrical_static_rating_kN": 98.0}
RATED_BEARINGS = {**RATED, **RATINGS}
BALLS = {f"bearings.{bearing}_{key}": value for bearing in ("tapered", "cylindrical")
         for key, value in (("balls", 9), ("ball_diameter_mm", 12.0), ("ball_pitch_diameter_mm", 60.0), ("inner_groove_ratio", 0.52),
                            ("outer_groove_ratio", 0.53), ("radial_clearance_um", 5.0))}
BALL_BEARINGS = {**RATED_BEARINGS, "bearings.tapered_rolling_element": '"ball"', "bearings.cylindrical_rolling_element": '"ball"', **BALLS}
# Without effect at constant speed, whatever their size.
WITHOUT_EFFECT = (
    (RATED, "shaft.axial_inertia_kg_mm2", 20000.0), (RATED, "block.axial_inertia_kg_mm2", 15000.0),
    (LIGHT, "shaft.axial_inertia_kg_mm2", 0.0), (LIGHT, "block.axial_inertia_kg_mm2", 0.0),
    (REAL, "piston.joint_mass_fraction", 0.7), (LIGHT, "piston.spin_rpm", 900.0),
    (TEETH, "gear.dissipation_s_per_m", 0.1),
    *((RATED_BEARINGS, name, 2 * value) for name, value in RATINGS.items()),
    *((BALL_BEARINGS, name, value + 1 if "balls" in name else 1.01 * value) for name, value in BALLS.items()),
    # Compliant teeth act where the motion is not given; rigid ones have nothing of this.
    *((base, f"gear.{key}", value) for base in (COMPLIANT, RATED)
      for key, value in (("stiffness_N_per_um", 300.0), ("stiffness_exponent", 1.5), ("dissipation_s_per_m", 0.1), ("backlash_um", 20.0))),
)


class FigureFilesTest(ProgramTest):
    def test_pictures_of_an_earlier_result_go_and_other_files_stay(self):
        command = ("compare", self.case(**{"operation.samples_per_revolution": 36}), "--out", "out", "--figures", "pictures")
        self.run_program(*command)
        pictures = self.folder / "pictures"
        before = {path.name for path in pictures.iterdir()}
        self.assertGreater(len([name for name in before if name.endswith(".svg")]), 5)
        (pictures / "mine.txt").write_text("mine")
        self.run_program(*command, "--channels", "Td")
        after = {path.name for path in pictures.iterdir()}
        named = [line.split(",")[0] for line in (pictures / "figures.csv").read_text().splitlines()[1:]]
        self.assertEqual(after, {"figures.csv", "mine.txt"} | {f"{name}.{kind}" for name in named for kind in ("svg", "png", "csv")})
        self.assertLess(len(after), len(before) / 2)


class TwoFlanksTest(ProgramTest):
    """Two flanks and bore forces beside B at constant speed."""

    def test_models_agree_and_say_what_it_means(self):
        case = self.case(**BESIDE_B)
        out = self.run_program("compare", case, "--out", "out").out
        self.assertIn("The two models agree", out)
        # Both flanks are modelled: that the other one carries is no warning, and what one flank would change is said.
        self.assertNotIn("Rcs < 0", out)
        [flank] = [limit for limit in json.loads((self.folder / "out" / "report.json").read_text())["validity"] if "flank" in limit["limit"]]
        self.assertFalse(flank["violated"])
        self.assertRegex(flank["consequence"], r"^Rcs is negative over [\d.]+ % of the turn: there the other flank is loaded; each flank pushes the "
                         r"gears apart\. With one line of action .* Rcn changes by up to")
        share = float(re.search(r"negative over ([\d.]+) %", flank["consequence"])[1])
        values = [float(value) for value in self.column("out/analytic.csv", "Rcs_z4_N")]
        self.assertAlmostEqual(share, 100 * sum(value < 0 for value in values) / len(values), delta=0.06)
        self.assertRegex(out, r"Rc works on the play: over .* mean power of Rc on the play -?[0-9.]+ W")
        power = [float(re.search(r"mean power of Rc on the play (-?[0-9.]+) W", out)[1])]
        for model in ("analytic", "multibody"):
            torque = [float(value) for value in self.column(f"out/budget_{model}.csv", "Td_ring_Nm")]
            power.append(-sum(torque) / len(torque) * 1500 * 3.14159265358979 / 30)
        for value in power[1:]:
            self.assertAlmostEqual(value, power[0], delta=1e-3 * abs(power[0]))
        # Every difference between unlike assumptions is still explained.
        out = self.run_program("compare", case, "--multibody", "gear=imposed", "piston_friction=off", "--out", "out").out
        self.assertIn("Explained.", out)

    def test_compliant_teeth_at_constant_speed_are_two_rigid_flanks(self):
        for name, base in (("two", {"gear.flanks": '"two"'}), ("compliant", COMPLIANT)):
            self.run_program("run", self.case(**{**RATED, **base}), "--model", "analytic", "--out", name)
        self.assertEqual(*[(self.folder / out / "analytic.csv").read_bytes() for out in ("two", "compliant")])

    def test_inertia_study(self):
        case = self.case(**{**REAL, "piston.contact_mm": 41.5, "gear.flanks": '"two"'})
        self.assertIn("The models agree", self.run_program("inertia", case, "--out", "out").out)


class NegativeControlTest(ProgramTest):
    def compare(self, first, second, status):
        first.write(self.folder / "first.toml")
        second.write(self.folder / "second.toml")
        self.run_program("compare", "first.toml", "--multibody-case", "second.toml", "--out", "out", status=status)

    def test_equal_cases_agree(self):
        (self.folder / "curve.csv").write_text(CURVE)
        for base in (RATED, LIGHT, REAL, CURVED):
            self.compare(Case(**base), Case(**base), DONE)

    def test_every_parameter_counts(self):
        for base, names in self.controls():
            for name in sorted(names):
                value = json.loads(Case(**base).get(name))
                pair = isinstance(value, list)
                for i in range(2 if pair else 1):
                    changed = ([v * (1 + 1e-6 * (i == j)) for j, v in enumerate(value)] if pair
                               else value * (1 + 1e-6))
                    with self.subTest(name, changed=changed):
                        self.assertNotEqual(changed, value)
                        self.compare(Case(**base), Case(**base).set({name: changed}), OUT_OF_TOLERANCE)

    def test_pressure_curve_counts(self):
        (self.folder / "curve.csv").write_text(CURVE)
        (self.folder / "other.csv").write_text(CURVE.replace("180,100", "180,100.0001"))
        other = Case(**{**CURVED, "pressure.file": '"other.csv"'})
        self.compare(Case(**CURVED), other, OUT_OF_TOLERANCE)

    def test_what_has_no_effect_at_constant_speed(self):
        for base, name, value in WITHOUT_EFFECT:
            with self.subTest(name, value=value):
                self.compare(Case(**base), Case(**base).set({name: value}), DONE)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    PROGRAM, REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
