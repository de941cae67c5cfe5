#!/usr/bin/env python3
"""Words: what a misspelt or impossible command line is told, completion, the manual page.

usage: words_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

from workbooks import write_workbook

PROGRAM = REPO = None  # set in main
DONE, BAD_INPUT = 0, 2
SECONDS = 120
GROUPS = ("Compare and report", "Simulate", "Study many designs", "Data in and out", "The paper")
# What every command says about the pump before anything else: another test's business.
PUMP = re.compile(r"^(pump|bentaxis: warning: [a-z0-9-]+): [^\n]+\n", re.MULTILINE)


class WordsTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="bentaxis_test_")))
        self.case = REPO / "cases" / "bap63_rated.toml"

    def run_program(self, *arguments, status=DONE, program=None, **options):
        result = subprocess.run([program or PROGRAM, *map(str, arguments)], cwd=self.folder, stdin=subprocess.DEVNULL,
                                capture_output=True, text=True, timeout=SECONDS, **options)
        self.assertEqual(result.returncode, status, f"{arguments}: {result.stdout[:500]}{result.stderr}")
        return result

    def refused(self, *arguments, **options):
        """One line on standard error, no file made."""
        before = sorted(self.folder.rglob("*"))
        result = self.run_program(*arguments, status=BAD_INPUT, **options)
        said = PUMP.sub("", result.stderr)
        self.assertEqual((result.stdout, said.count("\n")), ("", 1), result.stderr)
        self.assertEqual(sorted(self.folder.rglob("*")), before)
        return re.sub(r" \(see bentaxis[a-z ]* --help\)$", "", said.removeprefix("bentaxis: ").removesuffix("\n"))

    def changed_case(self, old, new):
        text = self.case.read_text()
        self.assertIn(old, text)
        file = self.folder / "case.toml"
        file.write_text(text.replace(old, new))
        return file


class MessagesTest(WordsTest):
    def test_says_whose_help_helps(self):
        for arguments, command in ((["comparr"], ""), (["run", self.case, "--modell", "analytic"], " run"),
                                   (["reference", "golden", "--out"], " reference golden")):
            said = self.run_program(*arguments, status=BAD_INPUT).stderr
            self.assertTrue(said.endswith(f" (see bentaxis{command} --help)\n"), said)
            self.run_program(*command.split(), "--help")

    def test_what_was_meant(self):
        run = ["run", self.case, "--model", "analytic"]
        for arguments, line in (
            (["comparr", self.case], 'there is no command comparr; did you mean "compare"?'),
            (["reference", "golde", self.case], 'reference has no command golde; did you mean "golden"?'),
            (["compare", self.case, "--tolernace", "1e-9"], 'compare has no option --tolernace; did you mean "--tolerance"?'),
            (["compare", self.case, "--tolernace=1e-9"], 'compare has no option --tolernace; did you mean "--tolerance"?'),
            # The misspelt option and not the one that is missing for it.
            (["run", self.case, "--modle", "analytic"], 'run has no option --modle; did you mean "--model"?'),
            ([*run, "--gear", "mehs"], '--gear: mehs: must be mesh or imposed; did you mean "mesh"?'),
            ([*run, "--channels", "Rss"], '--channels: no channel is called Rss; did you mean "Rs"?'),
            ([*run, "--channels", "Rs_1_x2"], '--channels: no channel is called Rs_1_x2; did you mean "Rs_1_x2_N"?'),
            ([*run, "--set", "pump.joint_radius_mm=25"], '--set pump.joint_radius_mm=25: unknown key "joint_radius_mm" in '
             '[pump]; did you mean "joint_circle_radius_mm"?'),
        ):
            with self.subTest(arguments[-1]):
                self.assertEqual(self.refused(*arguments), line)
        file = self.changed_case("joint_circle_radius_mm", "joint_radius_mm")
        line = next(i for i, text in enumerate(file.read_text().splitlines(), 1) if text.startswith("joint_radius_mm"))
        self.assertTrue(self.refused("run", file, "--model", "analytic").endswith(
            f'joint_circle_radius_mm is missing: must be > 0; is "joint_radius_mm" in line {line} meant?'))
        # Nothing is like it: what there is.
        self.assertIn("; there are: compare, show, regress,", self.refused("frobnicate"))

    def test_words_and_places_of_others(self):
        """What a key of another table or another program's word for it is called here."""
        for key, meant in (("pump.speed_rpm", '[operation] "speed_rpm"'), ("operation.tilt_deg", '[pump] "tilt_deg"'),
                           ("pump.swash_angle_deg", '"tilt_deg"'), ("pump.Piston_Diameter_mm", '"bore_diameter_mm"'),
                           ("pump.alpha", '"tilt_deg"'), ("pressure.outlet_bar", '"delivery_bar"'),
                           ("pump.kind", '[transfer] "kind"')):
            with self.subTest(key):
                self.assertTrue(self.refused("show", self.case, "--set", f"{key}=1").endswith(f"; did you mean {meant}?"))
        sweep = ["sweep", self.case, "--output", "max:Rb1_z1", "--vary"]
        self.assertEqual(self.refused(*sweep, "operation.shaft_speed=1:2:1"),
                         'operation.shaft_speed: no such parameter; did you mean "operation.speed_rpm"?')
        self.assertEqual(self.refused(*sweep, "speed=1:2:1"), 'speed: no such parameter; did you mean "operation.speed_rpm"?')
        line = self.refused("show", self.changed_case("tilt_deg =", "swash_angle ="))
        self.assertRegex(line, r'tilt_deg is missing: must be in \[0, 90\); is "swash_angle" in line \d+ meant\?$')
        line = self.refused("show", self.changed_case("tilt_deg = 40.0", "tilt_deg = 40.0\nspeed_rpm = 1500"))
        self.assertRegex(line, r'case.toml:\d+: unknown key "speed_rpm" in \[pump\]; did you mean \[operation\] "speed_rpm"\?$')

    def test_only_near_names_are_suggested(self):
        sweep = ["sweep", self.case, "--vary", "pump.tilt_deg=30:40:5", "--output"]
        self.assertTrue(self.refused(*sweep, "efficiency.total").endswith("unknown name; allowed: efficiency.mechanical"))
        self.assertTrue(self.refused(*sweep, "validity.flak").endswith('; did you mean "validity.flank"?'))
        self.assertTrue(self.refused(*sweep, "frobnicate").endswith(" more, listed by bentaxis outputs"))

    def test_slips(self):
        self.assertRegex(self.refused("show", self.changed_case('kind = "ideal"', "kind = ideal")),
                         r'case.toml:\d+: kind = ideal; words need quotes: "ideal"$')
        for values in ("30-40", "30..40", "-40..-30"):
            self.assertTrue(self.refused("sweep", self.case, "--vary", f"pump.tilt_deg={values}", "--output", "max:Rb1_z1")
                            .endswith("must be a number; a range is FROM:TO:STEP or FROM:TO:#NUMBER"))
        (self.folder / "curve.csv").write_text("theta_deg,Td_z1_Nm\n0,1\n")
        self.assertIn("bentaxis reference new", self.refused("compare", self.case, "--with", "curve.csv"))

    def test_a_case_that_lacks_something_is_told_one_that_has_it(self):
        for command in (["simulate"], ["pressure"], ["life"]):
            with self.subTest(command):
                example = re.search(r"as in (cases/\S+\.toml)$", self.refused(*command, self.case))
                self.assertIsNotNone(example)
                self.run_program(*command, REPO / example[1], "--help")
                self.assertTrue((REPO / example[1]).exists())

    def test_enumerations_are_their_names(self):
        for arguments, line in (
            (["run", self.case, "--model", "magic"], "--model: magic: must be analytic or multibody"),
            (["run", self.case, "--model", "0"], "--model: 0: must be analytic or multibody"),
            (["tradeoff", self.case, "--integrators", "verlet,rk33"], "--integrators: rk33: must be rk-merson, rk-feldberg, "
             'rk3, verlet, semi-explicit-euler or cpodes; did you mean "rk3"?'),
        ):
            with self.subTest(arguments[-1]):
                self.assertEqual(self.refused(*arguments), line)

    def test_numbers(self):
        run = ["run", self.case, "--model", "analytic", "--set"]
        for arguments, line in (
            (["inertia", self.case, "--speeds", "1500,abc"], '--speeds 1500,abc: "abc" must be a number in rpm'),
            (["compare", self.case, "--tolerance", "40,0"],
             "--tolerance: 40,0: must be a finite number > 0; decimals follow a point: 40.0"),
            (["hardcases", "--turns", "1.5"], "--turns: 1.5: must be an integer in [0, 100000]"),
            (["hardcases", "--turns", "1e3"], "--turns: 1e3: must be an integer in [0, 100000], written without an exponent"),
            (["reference", "new", self.case, "--from", self.case, "--tolerance", "2"], "--tolerance: 2: must be a number > 0, at most 1"),
            ([*run, "pump.tilt_deg=40,0"],
             "--set pump.tilt_deg=40,0: must be a number, in [0, 90); decimals follow a point: 40.0"),
            ([*run, "pump.axis_offset_mm=nan"], "--set pump.axis_offset_mm=nan: must be a finite number"),
            ([*run, "pump.axis_offset_mm=wide"], "--set pump.axis_offset_mm=wide: must be a finite number"),
        ):
            with self.subTest(arguments[-1]):
                self.assertEqual(self.refused(*arguments), line)
        for value in ("40,0", "-4,05e1", "40,0 # as in the drawing"):
            with self.subTest(value):
                self.assertRegex(self.refused("run", self.changed_case("tilt_deg = 40.0", f"tilt_deg = {value}"),
                                              "--model", "analytic"),
                                 r"case.toml:\d+: tilt_deg = -?40?,\S+; decimals follow a point: -?40?\.05?\S*$")

    def test_what_is_missing_or_too_much(self):
        for arguments, line in (
            (["run", "--model", "analytic"], "run: CASE is missing"),
            (["reference"], "reference needs a command: new, golden or update"),
            (["compare", self.case, "--out"], "--out needs a value: DIR [out]"),
            (["compare", self.case, "--out", "a", "--out", "b"], "--out is given more than once"),
            (["run", self.case, "more", "--model", "analytic"], "run: more was not expected"),
        ):
            with self.subTest(arguments[-1]):
                self.assertEqual(self.refused(*arguments), line)

    def test_a_dash_is_no_folder(self):
        for command in (["run", self.case, "--model", "analytic"], ["compare", self.case]):
            self.assertIn("-: cannot be written: is not a directory", self.refused(*command, "--out", "-"))

    def test_more_samples_than_a_machine_holds(self):
        many = ["--set", "operation.samples_per_revolution=2000000000"]
        for command in (["compare", self.case], ["run", self.case, "--model", "multibody"]):
            line = self.refused(*command, *many)
            self.assertRegex(line, r"\[operation\] samples_per_revolution = 2000000000: 2e\+09 samples of [0-9]+ columns: about \S+ GB "
                             r"of memory are needed, and [0-9.]+ GB are available; lower samples_per_revolution")
        line = self.refused("run", self.case, "--model", "multibody", "--way", "integrated", *many[:1],
                            "operation.revolutions=100000000")
        self.assertIn("revolutions = 100000000", line)
        self.assertIn("GB of disk", self.refused("run", self.case, "--model", "analytic", *many))


class OutputsTest(WordsTest):
    def test_every_name_that_is_listed_can_be_asked_for(self):
        for name in ("bap63_rated", "bap63_rated_hydraulic", "bap63_bearing_life"):
            case = REPO / "cases" / f"{name}.toml"
            lines = self.run_program("outputs", case).stdout.split("\n\n", 1)[1].splitlines()
            names = [line.split()[0] for line in lines]
            self.assertEqual(len(names), len(set(names)))
            self.assertEqual("hydraulics.flow_l_per_min" in names, "rated" != name[6:])
            self.assertEqual("life.system_h" in names, "life" in name)
            self.assertIn("max:Rb1_z1_N", names)
            for line in lines:  # a meaning, and a unit where there is one
                self.assertRegex(line, r"^\S+  +(\S+  +)?\S.*\w")
                self.assertNotIn("at about", line)
        few = ["--set", "operation.samples_per_revolution=12"]
        self.run_program("sweep", self.case, *few, "--vary", "pump.tilt_deg=39:40:1", "--out", "out", "--output", ",".join(
            line.split()[0] for line in self.run_program("outputs", self.case).stdout.split("\n\n", 1)[1].splitlines()))
        heading = next((self.folder / "out").glob("*.csv")).read_text().splitlines()[0]
        self.assertIn("efficiency.mechanical", heading)


class DialectTest(WordsTest):
    """Every table that is read may be separated by semicolons or tabs, with decimal commas, in UTF-16, or a workbook."""

    def dialects(self, text):
        comma = text.replace(",", ";").replace(".", ",")
        yield "semicolons.csv", comma.encode()
        yield "tabs.txt", text.replace(",", "\t").encode()
        yield "blanks.txt", text.replace(",", "  ").encode()
        yield "utf16.csv", comma.encode("utf-16")

    def same(self, table, arguments, result):
        """The result of the table in each dialect is that of the one with commas."""
        (self.folder / "commas.csv").write_text(table)
        self.run_program(*arguments("commas.csv"), "--out", "commas")
        expected = (self.folder / "commas" / result).read_bytes()
        for name, content in self.dialects(table):
            with self.subTest(name):
                (self.folder / name).write_bytes(content)
                self.run_program(*arguments(name), "--out", f"out_{name}")
                self.assertEqual((self.folder / f"out_{name}" / result).read_bytes(), expected)
        with self.subTest("workbook"):
            header, *rows = (line.split(",") for line in table.split())
            write_workbook(self.folder / "book.xlsx", [header, *([float(field) for field in row] for row in rows)])
            self.run_program(*arguments("book.xlsx"), "--out", "out_book")
            self.assertEqual((self.folder / "out_book" / result).read_bytes(), expected)

    def test_duty_cycle(self):
        case = REPO / "cases" / "bap63_bearing_life.toml"
        self.same((REPO / "cases" / "curves" / "duty_cycle.csv").read_text(),
                  lambda file: ["life", case, "--duty", file], "life.csv")

    def test_drive_curve(self):
        case = REPO / "cases" / "bap63_tooth_rattle.toml"
        text = case.read_text()
        self.assertNotIn("flow = ", text)
        drive = ["simulate", case, "--model", "analytic", "--set", "drive.duration_s=0.002", "--set", "drive.samples=10",
                 "--set", 'drive.kind="speed"']
        self.same("time_s,speed_rpm\n0,1500.5\n0.001,1501\n0.002,1502\n0.01,1500\n",
                  lambda file: [*drive, "--set", f'drive.file="{self.folder / file}"'], "simulation_analytic.csv")

    def test_states(self):
        table = ("theta_deg,psi_deg,theta_rpm,psi_rpm,theta_rad_per_s2,psi_rad_per_s2\n"
                 "10,9.5,1500,1490.25,100,-200\n11,10.5,1500,1490,100,-200\n")
        self.same(table, lambda file: ["run", self.case, "--model", "analytic", "--states", file], "analytic.csv")

    def test_share_of_a_load(self):
        load = ["simulate", REPO / "cases" / "bap63_load_step.toml", "--model", "analytic", "--set", "drive.duration_s=0.002",
                "--set", "drive.samples=10"]
        self.same("time_s,share\n0,1\n0.0005,0.75\n0.001,0.7\n0.5,0.6\n",
                  lambda file: [*load, "--set", f'load.file="{self.folder / file}"'], "simulation_analytic.csv")

    def test_opening_of_a_port(self):
        table = "theta_deg,area_mm2\n" + "".join(f"{angle},{1.5 * min(angle, 170 - angle)}\n" for angle in range(0, 171, 10))
        self.same(table + "180,0\n350,0\n", lambda file: [
            "pressure", REPO / "cases" / "bap63_rated_hydraulic.toml", "--set",
            f'hydraulics.suction_opening_file="{self.folder / file}"'], "pressure.csv")

    def test_errors_of_teeth(self):
        teeth = REPO / "cases" / "bap63_teeth.toml"
        count = tomllib.loads(teeth.read_text())["gear"]["tooth_number"]
        table = "tooth,shaft_um,block_um\n" + "".join(f"{i},{i % 5 - 1.5},{i % 3}\n" for i in range(1, count + 1))
        self.same(table, lambda file: ["run", teeth, "--model", "analytic", "--set", "operation.samples_per_revolution=12", "--set",
                                       f'gear.pitch_error_file="{self.folder / file}"'], "analytic.csv")

    def test_pressure_curve(self):
        table = "theta_deg,pressure_bar\n" + "".join(f"{20 * i},{275.5 if i < 9 else 0}\n" for i in range(18))
        self.same(table, lambda file: ["run", self.case, "--model", "analytic", "--set", "pressure.kind=curve", "--set",
                                       f'pressure.file="{self.folder / file}"'], "analytic.csv")

    def test_record_to_identify_from(self):
        few = ["--set", "operation.samples_per_revolution=36"]
        self.run_program("run", self.case, "--model", "analytic", *few, "--set", "pump.tilt_deg=40.5", "--out", "rig")
        heading, *rows = ((fields := line.split(","))[:2] for line in (self.folder / "rig" / "analytic.csv").read_text().splitlines())
        table = "\n".join(map(",".join, [heading, *rows])) + "\n"

        def identify(file):
            data = self.folder / "data.toml"
            data.write_text('schema = 1\n[[unknown]]\nparameter = "pump.tilt_deg"\nbetween = [35, 45]\n'
                            f'[[curve]]\nfile = "{file}"\nrelative_uncertainty = 0.01\nwhere = "rig"\n')
            return ["identify", self.case, *few, "--data", data, "--steps", 40]

        self.same(table, identify, "unknowns.csv")

    def test_operating_points_to_optimise_for(self):
        self.same("share,speed_rpm\n0.5,1500\n1.5,1800\n", lambda file: [
            "optimise", self.case, "--vary", "pump.tilt_deg=30:40", "--minimise", "peak:Rb1", "--maximise", "displacement_cm3",
            "--conditions", file, "--population", 8, "--generations", 1, "--restarts", 1, "--comparison", "no"], "front.csv")

    def test_a_single_row(self):
        self.same("share,speed_rpm,delivery_bar\n1,1500,200.5\n",
                  lambda file: ["life", REPO / "cases" / "bap63_bearing_life.toml", "--duty", file], "life.csv")

    def test_what_is_wrong_is_named_with_its_place(self):
        (self.folder / "duty.csv").write_text("share;speed_rpm;delivery_bar\n0,5;1500;200\n0,5;fast;200\n")
        line = self.refused("life", REPO / "cases" / "bap63_bearing_life.toml", "--duty", "duty.csv")
        self.assertIn("duty.csv:3", line)
        self.assertIn("fast", line)


class InertiaWordsTest(WordsTest):
    def headline(self, *changes):
        result = self.run_program("inertia", self.case, "--map-size", 2, "--out", "out", *changes)
        report = json.loads((self.folder / "out" / "inertia.json").read_text())
        self.assertEqual(result.stdout.splitlines()[1], report["verdict"]["headline"])
        return report["verdict"]["headline"], report

    def test_headline_says_whether_two_masses_do(self):
        headline, report = self.headline("--speeds", "1500,2350")
        self.assertRegex(headline, r"^Two point masses are not accurate enough for Rc: off by 1\.7 % of its loaded peak \(12\.8 N at 2350 rpm\)"
                         r"\. They are for the others: \w+ is off by 0\.\d+ % .*, the rest by less\. The limit is 1 %\.")
        self.assertTrue(report["published"]["rows"])
        headline, _ = self.headline("--speeds", "1500")
        self.assertRegex(headline, r"^Two point masses are accurate enough: Rc is off by 0\.72 % of its loaded peak \(5\.26 N at 1500 rpm\)")

    def test_another_pump_is_not_held_to_the_papers_numbers(self):
        for change in ("pump.pistons=7", "pump.bore_diameter_mm=20", "gear.pitch_diameter_mm=90"):
            with self.subTest(change):
                _, report = self.headline("--speeds", "1500", "--set", change)
                self.assertNotIn("published", {key for key, value in report.items() if value})


class PageTest(WordsTest):
    def test_each_value_has_a_heading(self):
        browser = shutil.which("chromium")
        if browser is None:
            self.skipTest("no browser")
        self.run_program("compare", REPO / "cases" / "bap63_rated_hydraulic.toml", "--out", "out")
        page = self.run_program("--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000", "--dump-dom",
                                f"file://{self.folder}/out/report.html", program=browser).stdout
        tables = re.findall(r'<table class="readout">(.*?)</table>', page, re.S)
        self.assertGreater(len(tables), 10)
        def columns(row):
            return sum(int((re.search(r'colspan="(\d+)"', cell) or [0, 1])[1]) for cell in re.findall("<t[hd][^>]*>", row))
        for table in tables:
            head, *rows = re.findall(r"<tr.*?</tr>", table, re.S)
            self.assertEqual({columns(row) for row in rows}, {columns(head)}, head)


class ShippedCasesTest(WordsTest):
    def test_are_listed_as_their_files_say(self):
        cases = json.loads(self.run_program("cases", "--json").stdout)
        files = sorted((REPO / "cases").glob("*.toml"))
        self.assertEqual(sorted(case["name"] for case in cases), [file.stem for file in files])
        text = self.run_program("cases").stdout
        for case in cases:
            content = tomllib.loads(pathlib.Path(case["file"]).read_text())
            self.assertEqual(case["title"], content["name"])
            self.assertEqual(case["group"].startswith("Motion"), "drive" in content)
            self.assertEqual("hydraulic" in case["group"], content["pressure"]["kind"] == "hydraulic")
            self.assertRegex(text, rf"(?m)^  {case['name']} +{re.escape(case['title'])}$")
            self.assertIn(f"\n{case['group']}\n", "\n" + text)

    def test_a_name_is_a_case_from_any_folder(self):
        run = ["--model", "analytic", "--out"]
        self.run_program("run", "bap63_rated", *run, "name")
        self.run_program("run", self.case, *run, "file")
        name, file = ((self.folder / folder / "analytic.csv").read_bytes() for folder in ("name", "file"))
        self.assertEqual(name, file)
        # A file of this name wins.
        (self.folder / "bap63_rated").write_text(self.case.read_text().replace("pistons = 5 ", "pistons = 7 "))
        self.run_program("run", "bap63_rated", *run, "own")
        self.assertIn(b"Rs_7_", (self.folder / "own" / "analytic.csv").read_bytes().split(b"\n")[0])

    def test_unknown_names_get_near_suggestions(self):
        self.assertEqual(self.refused("run", "bap63_ratd", "--model", "analytic"),
                         'bap63_ratd: neither a file nor a shipped case; did you mean "bap63_rated"?')
        for elsewhere in ("bap63_rated.toml", "./bap63_rated", "cases/bap63_rated"):  # a file is meant
            self.assertNotIn("shipped", self.refused("run", elsewhere, "--model", "analytic"))
        # As the documents write it, without their folder.
        self.assertIn("cases/bap63_rated.toml: cannot be read: no such file; the shipped case is bap63_rated",
                      self.refused("run", "cases/bap63_rated.toml", "--model", "analytic"))

    def test_a_case_of_a_study_has_a_name(self):
        name, file = (self.run_program("show", case).stdout for case in ("four_transfers", self.case.parent / "studies/four_transfers.toml"))
        self.assertEqual(name, file)


class CompletionTest(WordsTest):
    def words(self, *typed):
        kind, *lines = self.run_program("completion", "words", "--", *typed).stdout.splitlines()
        return kind, [line.split("\t")[0] for line in lines]

    def test_follows_the_parser(self):
        # Whatever --help names is completed: no list is kept beside the parser.
        def names(text, heading):
            lines = text.split(f"\n{heading}:\n")[1].split("\n\n")[0].splitlines() if f"\n{heading}:\n" in text else []
            words = [line.split()[0] for line in lines if line.startswith("  ") and line[2:3].strip()]
            return [word.split(",")[-1] for word in words]
        help_text = self.run_program("--help").stdout
        commands = [[name] for group in GROUPS for name in names(help_text, group)]
        self.assertGreater(len(commands), 12)
        self.assertEqual(self.words(""), ("words", [name for [name] in commands]))
        commands += [["reference", name] for name in self.words("reference", "")[1]]
        for command in commands:
            with self.subTest(command):
                options = names(self.run_program(*command, "--help").stdout, "Options")
                self.assertEqual(self.words(*command, "-"), ("words", options))
                self.assertIn("--help", options)

    def test_values(self):
        for typed, kind, words in (
            (["comp"], "words", ["compare", "completion"]),
            (["run", "zz"], "files", []),
            (["run", "bap63_rated_h"], "files", ["bap63_rated_hydraulic"]),  # names beside files
            (["run", "case.toml", ""], "nothing", []),
            (["run", "case.toml", "--mod"], "words", ["--model"]),
            (["run", "a=b"], "files", []),
            (["run", "case.toml", "--model", ""], "words", ["analytic", "multibody"]),
            (["run", "case.toml", "--model", "m"], "words", ["multibody"]),
            (["run", "case.toml", "--model=m"], "words", ["--model=multibody"]),
            (["run", "--model", "multibody", "--out", ""], "folders", []),
            (["compare", "case.toml", "--multibody-case", "z"], "files", []),
            (["compare", "case.toml", "--tolerance", ""], "nothing", []),
            (["tradeoff", "case.toml", "--integrators", "verlet,rk"], "words",
             ["verlet,rk-merson", "verlet,rk-feldberg", "verlet,rk3"]),
            (["run", "--set", "pump.tilt"], "words", ["pump.tilt_deg="]),
            (["compare", "--channels", "Rb"], "words", ["Rb1", "Rb2"]),
            (["reference", "g"], "words", ["golden"]),
            (["regress", "--junit", ""], "files", []),
            (["nonsense", "--out=x"], "nothing", []),
        ):
            with self.subTest(typed):
                self.assertEqual(self.words(*typed), (kind, words))

    def script(self, shell):
        file = self.folder / f"completion.{shell}"
        file.write_text(self.run_program("completion", shell).stdout)
        return file

    def shell(self, *command):
        if shutil.which(command[0]) is None:
            self.skipTest(f"no {command[0]}")
        path = f"{PROGRAM.parent}:{os.environ['PATH']}"
        return self.run_program(*command[1:], program=command[0],
                                env={**os.environ, "PATH": path, "HOME": str(self.folder)}).stdout

    def test_bash(self):
        script = self.script("bash")
        (self.folder / "pump.toml").touch()
        (self.folder / "place").mkdir()
        def completed(line):
            return self.shell("bash", "-c", f"""source {script}
                compopt() {{ options+=" $*"; }}  # is for a completion at a prompt
                COMP_LINE={line!r}; COMP_POINT=${{#COMP_LINE}}; _bentaxis
                printf '%s\\n' "${{COMPREPLY[@]}}" $options """).split()
        self.assertEqual(completed("bentaxis tra"), ["tradeoff"])
        self.assertEqual(completed("bentaxis run pump.toml --model "), ["analytic", "multibody"])
        self.assertEqual(completed("bentaxis run pump.toml --model=an"), ["analytic"])  # bash replaces what follows =
        self.assertEqual(completed("bentaxis run pu"), ["pump.toml", "-o", "filenames"])
        self.assertEqual(completed("bentaxis run bap63_te"), ["bap63_teeth", "-o", "filenames"])
        self.assertEqual(completed("bentaxis run pump.toml --out p"), ["place", "-o", "filenames"])
        self.assertEqual(completed("bentaxis run --set pump.tilt"), ["pump.tilt_deg=", "-o", "nospace"])

    def test_fish(self):
        script = self.script("fish")
        def completed(line):
            lines = self.shell("fish", "--no-config", "-c", f"source {script}; complete -C {line!r}").splitlines()
            return [text.split("\t")[0] for text in lines]
        (self.folder / "pump.toml").touch()
        self.assertEqual(completed("bentaxis tra"), ["tradeoff"])
        self.assertEqual(completed("bentaxis run pump.toml --model "), ["analytic", "multibody"])
        self.assertEqual(completed("bentaxis run pu"), ["pump.toml"])
        self.assertEqual(completed("bentaxis run bap63_te"), ["bap63_teeth"])

    def test_zsh(self):
        script = self.script("zsh")
        def completed(*words):
            quoted = " ".join(f'"{word}"' for word in words)
            return self.shell("zsh", "-f", "-c", f"""compdef() {{ :; }}; compadd() {{ print -l -- $found; }}
                _files() {{ print files $@; }}; source {script}
                words=({quoted}); CURRENT=$#words; _bentaxis""").split()
        self.assertEqual(completed("bentaxis", "tra"), ["tradeoff"])
        self.assertEqual(completed("bentaxis", "run", "pump.toml", "--model", ""), ["analytic", "multibody"])
        self.assertEqual(completed("bentaxis", "run", "zz"), ["files"])
        self.assertEqual(completed("bentaxis", "run", "bap63_te"), ["bap63_teeth", "files"])
        self.assertEqual(completed("bentaxis", "run", "c", "--out", ""), ["files", "-/"])


class OptionNamesTest(WordsTest):
    """One meaning per option name: what --help of every command says of it."""

    def commands(self):
        names = [[name] for name in CompletionTest.words(self, "")[1]]
        return names + [["reference", name] for name in CompletionTest.words(self, "reference", "")[1]]

    def options(self):
        """(command, option, its value, what is said of it) from the manual page, which is made of the parser."""
        page = self.run_program("manual").stdout.split(".SH COMMANDS")[1].split(".SH EXIT STATUS")[0]
        page = page.replace("\\:", "").replace("\\-", "-").replace("\\fB", "").replace("\\fR", "").replace("\\fI", "")
        for section in page.split(".SS ")[1:]:
            head, *items = section.split(".TP\n")
            command = re.match(r"bentaxis ((?:[a-z0-9]+ ?)+)", head)[1].strip()
            for item in items:
                line, said = item.splitlines()[:2]
                if line.startswith("-"):
                    name, _, value = line.partition(" ")
                    yield command, name, value, said

    @staticmethod
    def kind(value):
        """The same for a value and a list of such values; defaults in brackets do not count."""
        value = value.split(" [")[0]
        if value.startswith(("DIR", "FILE")):
            return "path"
        if "|" not in value:
            value = re.split(r"[,=]| \.\.", value)[0]  # NAME=VALUES and NAME[,NAME..] begin with a name
        return re.sub(r"\[$", "", value)

    def test_have_one_kind_of_value_and_one_meaning(self):
        seen, count = {}, 0
        for command, name, value, said in self.options():
            count += 1
            # What stands behind a semicolon is of the command alone.
            meaning = (self.kind(value), said.split(";")[0].strip())
            first = seen.setdefault(name, (command, meaning))
            self.assertEqual(meaning, first[1], f"{name} of {command} against {name} of {first[0]}")
        self.assertGreater(count, 150)
        self.assertGreater(len(seen), 60)

    def test_kinds_tell_values_apart(self):
        self.assertEqual(self.kind("NUMBER[,NUMBER..] [1e-4,1e-6]"), self.kind("NUMBER [1e-6]"))
        self.assertEqual(self.kind("NAME=VALUES"), self.kind("NAME[,NAME..]"))
        self.assertEqual(self.kind("FILE.fmu"), self.kind("DIR [out]"))
        kinds = {self.kind(value) for value in ("", "NUMBER", "SHARE [0%]", "FILE", "NAME", "analytic|multibody [analytic]")}
        self.assertEqual(len(kinds), 6)

    def test_former_names_work_and_say_the_new_one(self):
        hydraulic = REPO / "cases" / "bap63_rated_hydraulic.toml"
        few = ["--set", "operation.samples_per_revolution=36"]
        for arguments, former, name in (
            (["sensitivity", self.case, *few, "--output", "mean:Td", "--parameter", "pump.tilt_deg", "--parameter", "piston.mass_kg"], "--parameter", "--vary"),
            (["sensitivity", self.case, *few, "--output=mean:Td", "--parameter=pump.tilt_deg"], "--parameter", "--vary"),
            (["reference", "golden", self.case, "--samples", "36", "--out", "golden"], "--samples", "--angles"),
            (["fmu", self.case, "--tolerance", "1e-8", "--out", "pump.fmu"], "--tolerance", "--accuracy"),
            (["regress", "golden", "--json", "regress.json"], "--json", "--json-file"),
        ):
            with self.subTest(arguments):
                said = PUMP.sub("", self.run_program(*arguments).stderr)
                self.assertEqual(said.count("\n"), 1, said)
                self.assertRegex(said, rf"{former} is now called {name}; the former name goes on working\n")
        for arguments, name in (
            (["calibrate", hydraulic, "--with", "0", "--without", "0"], "--torque-with-friction"),
            (["identify", self.case, "--data", "no.toml", "--unknown", "x"], "--vary"),
            (["rattle", self.case, "--speeds", "1:2:1", "--delivery-bar", "1", "--check", "-1"], "--check-points"),
            (["sensitivity", "no.toml", "--check"], "--check-derivatives"),
            (["tradeoff", self.case, "--samples", "0"], "--angles"),
        ):
            with self.subTest(arguments):
                self.assertIn(f"is now called {name};", self.run_program(*arguments, status=BAD_INPUT).stderr)

    def test_former_names_are_no_longer_shown(self):
        shown = {(command, name) for command, name, _, _ in self.options()}
        for former in (("rattle", "--check"), ("sensitivity", "--check"), ("identify", "--unknown"), ("regress", "--json")):
            self.assertNotIn(former, shown)
        self.assertIn(("sweep", "--check"), shown)

    def test_speeds_are_a_list_or_a_range(self):
        for text in ("1:2", "1,x", "1,,2"):
            for command in (["inertia", self.case], ["rattle", self.case, "--delivery-bar", "1"]):
                self.assertIn("--speeds", self.refused(*command, "--speeds", text))


class HelpTest(WordsTest):
    def test_lists_commands_in_groups(self):
        text = self.run_program("--help").stdout
        places = [text.index(f"\n{group}:\n") for group in GROUPS]
        self.assertEqual(places, sorted(places))
        self.assertNotIn("Subcommands:", text)

    def test_every_command_has_an_example_of_its_own(self):
        seen = {}
        for command in OptionNamesTest.commands(self):
            text = self.run_program(*command, "--help").stdout
            example = text.split("\nExample:\n")[1].strip()
            self.assertIn("bentaxis " + " ".join(command), example)
            self.assertNotIn(example, seen.values() if command[0] != "reference" else ())
            seen[" ".join(command)] = example

    def test_examples_run(self):
        # Of every command, one after the other in one empty directory, as a shell runs them.
        seen = set()
        for command in OptionNamesTest.commands(self):
            text = self.run_program(*command, "--help").stdout
            example = text.split("\nExample:\n")[1].strip()
            if "(not in this build: " in " ".join(text.split()) or (command == ["manual"] and shutil.which("man") is None):
                continue
            if example in seen:  # of reference and of reference golden
                continue
            seen.add(example)
            with self.subTest(example):
                done = subprocess.run(["bash", "-o", "pipefail", "-c", example], cwd=self.folder, stdin=subprocess.DEVNULL,
                                      capture_output=True, text=True, timeout=SECONDS,
                                      env={**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}"})
                if "the documentation site is not there" not in done.stderr:
                    self.assertEqual(done.returncode, DONE, done.stderr)

    def test_says_what_this_build_cannot_run(self):
        text, parts = self.run_program("--help").stdout, self.run_program("--version").stdout
        for part, lacking in (("Ceres none", "it has no Ceres"), ("search none", "it has no pagmo")):
            self.assertEqual(part in parts, lacking in " ".join(text.split()))


class ManualTest(WordsTest):
    def test_has_every_command_and_option(self):
        manual = self.run_program("manual").stdout.replace("\\-", "-").replace("\\fR", "").replace("\\fB", "")
        for command in CompletionTest.words(self, "")[1]:
            self.assertIn(f".SS bentaxis {command}", manual)
            for option in CompletionTest.words(self, command, "-")[1]:
                if option != "--help":
                    self.assertIn(f"\n{option}", manual, command)
        self.assertIn(".SS bentaxis reference golden", manual)
        self.assertIn("analytic|\\:multibody", manual)  # a line may break there

    def test_is_good_roff(self):
        if shutil.which("groff") is None:
            self.skipTest("no groff")
        (self.folder / "bentaxis.1").write_text(self.run_program("manual").stdout)
        page = self.run_program("-man", "-ww", "-Tutf8", "-P-c", "bentaxis.1", program="groff")
        self.assertEqual(page.stderr, "")
        text = re.sub(".\b", "", page.stdout)  # bold is printed twice
        for word in ("NAME", "SYNOPSIS", "COMMANDS", "EXIT STATUS", "bentaxis compare CASE [OPTIONS]"):
            self.assertIn(word, text)


if __name__ == "__main__":
    PROGRAM, REPO = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    del sys.argv[1:3]
    unittest.main()
