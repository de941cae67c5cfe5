#!/usr/bin/env python3
"""What a command finds is said alike everywhere: exit status, headline, JSON, page and the index over all reports.

usage: verdict_test.py BENTAXIS REPO_ROOT [options of unittest]

Every command that can end with exit status 1 is run where its verdict is "no", and where it is "yes".
"""

import csv
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = REPO = None  # set in main
FEW = ["--set", "operation.samples_per_revolution=36"]


def run(*arguments):
    return subprocess.run([str(PROGRAM), *map(str, arguments)], capture_output=True, text=True, timeout=300)


def of_page(page):
    """The report that a page draws."""
    text = re.search(r'<script type="application/json" id="report">(.*?)</script>', page.read_text(), re.DOTALL).group(1)
    return json.loads(text.replace("<\\/", "</"))


class Verdicts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        cls.reports = cls.folder / "reports"
        cls.case = REPO / "cases/bap63_rated.toml"
        # A reference of the case itself, and the same with one value off by a millionth of its peak.
        cls.golden, cls.wrong = cls.folder / "golden", cls.folder / "wrong"
        done = run("reference", "golden", cls.case, "--angles", "36", "--out", cls.golden)
        assert done.returncode == 0, done.stderr
        shutil.copytree(cls.golden, cls.wrong)
        for file in cls.wrong.rglob("*.csv"):
            lines = file.read_text().splitlines()
            at = next((i for i, line in enumerate(lines) if line.startswith("theta_deg")), None)
            if at is None:
                continue
            column = lines[at].split(",").index("Rb1_x1_N")
            row = lines[at + 5].split(",")
            row[column] = repr(float(row[column]) + 0.05)
            lines[at + 5] = ",".join(row)
            file.write_text("\n".join(lines) + "\n")
        cls.accept_new_checksums(cls.wrong)
        cls.tilted = cls.folder / "tilted.toml"
        cls.tilted.write_text(cls.case.read_text().replace("tilt_deg = 40.0", "tilt_deg = 40.0001"))

    @classmethod
    def accept_new_checksums(cls, folder):
        """A description may list checksums of its files."""
        import hashlib
        for description in folder.rglob("*.toml"):
            text = description.read_text()
            for file in folder.rglob("*.csv"):
                text = re.sub(rf'("?{re.escape(file.name)}"?\s*=\s*")[0-9a-f]{{64}}"',
                              lambda m: m.group(1) + hashlib.sha256(file.read_bytes()).hexdigest() + '"', text)
            description.write_text(text)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def check(self, name, status, arguments, word=None):
        """Runs a command and holds all that it says to its exit status. Returns the report."""
        out = self.reports / name
        if arguments[0] == "regress":
            out.mkdir(parents=True)
            arguments = [*arguments, "--html", out / "report.html", "--json-file", out / "report.json", "--junit", out / "junit.xml"]
        else:
            arguments = [*arguments, "--out", out]
        done = run(*arguments)
        self.assertEqual(done.returncode, status, f"{arguments}\n{done.stdout}\n{done.stderr}")
        report_file = next(file for file in sorted(out.glob("*.json")) if file.name != "simulation.json")
        report = json.loads(report_file.read_text())
        agrees = report["verdict"]["agrees"]
        self.assertIn(agrees, [False] if status == 1 else [True, None], name)
        page = of_page(report_file.with_suffix(".html"))
        self.assertEqual(page["verdict"], report["verdict"], name)
        self.assertTrue(report["verdict"]["headline"], name)
        if word:
            self.assertRegex(report["verdict"]["headline"], word)
        for part in ("models_agree", "checks_hold"):
            if report["verdict"].get(part) is False:
                self.assertEqual(status, 1, name)
        if arguments[0] == "regress":
            junit = (out / "junit.xml").read_text()
            failures = sum(int(count) for count in re.findall(r'<testsuites[^>]* failures="(\d+)"', junit))
            self.assertEqual(failures > 0, status == 1, junit)
        return report

    def test_compare(self):
        self.check("compare/yes", 0, ["compare", self.case, *FEW], "^The two models agree")
        report = self.check("compare/no", 1, ["compare", self.case, *FEW, "--multibody-case", self.tilted], "^The two models differ")
        # The channel of the headline is one that differs.
        worst = report["verdict"]["worst"]["channel"]
        self.assertIn(worst, report["verdict"]["headline"])
        self.assertEqual({c["name"]: c["verdict"] for c in report["channels"]}[worst], "differs")

    def test_compare_with_a_reference_that_differs(self):
        report = self.check("compare/with_yes", 0, ["compare", self.case, *FEW, "--with", self.golden])
        self.assertIs(report["verdict"]["models_agree"], True)
        report = self.check("compare/with_no", 1, ["compare", self.case, *FEW, "--with", self.wrong], "differ from")
        self.assertEqual((report["verdict"]["models_agree"], report["verdict"]["reference"]["agrees"], report["verdict"]["word"]),
                         (True, False, "Reference differs"))

    def test_compare_of_unequal_assumptions(self):
        self.check("compare/explained", 0, ["compare", self.case, *FEW, "--multibody", "piston_friction=off"], "^Explained")
        self.check("compare/not_explained", 1, ["compare", self.case, *FEW, "--multibody", "piston_friction=off",
                                                "--multibody-case", self.tilted], "^Not explained")

    def test_regress(self):
        self.check("regress/yes", 0, ["regress", self.golden])
        self.check("regress/no", 1, ["regress", self.wrong])

    def test_simulate(self):
        short = ["simulate", REPO / "cases/bap63_motor_start.toml", "--set", "drive.duration_s=0.01", "--set", "drive.samples=20"]
        self.check("simulate/yes", 0, short, "^The trajectories agree")
        report = self.check("simulate/no", 1, [*short, "--accuracy", "0.01"])
        violated = [check for check in report["checks"] if check["verdict"] == "violated"]
        self.assertRegex(report["verdict"]["headline"], "models differ" if not violated else "models differ|A check fails")

    def test_inertia(self):
        self.check("inertia/yes", 0, ["inertia", self.case, *FEW, "--speeds", "1500"], "The models agree to")
        # Bearings 0.01 mm apart cost Simbody six digits.
        self.check("inertia/no", 1, ["inertia", self.case, *FEW, "--speeds", "1500", "--set", "bearings.cylindrical_z_mm=-26.01"],
                   "^The models differ by")

    def test_sweep(self):
        sweep = ["sweep", self.case, *FEW, "--vary", "pump.tilt_deg=20:40:10", "--output", "peak:Rb1"]
        self.check("sweep/unchecked", 0, sweep)
        self.check("sweep/yes", 0, [*sweep, "--check", "100%"])
        self.check("sweep/no", 1, [*sweep, "--check", "100%", "--set", "bearings.cylindrical_z_mm=-26.001"])

    def test_life(self):
        life = ["life", REPO / "cases/bap63_bearing_life.toml", *FEW]
        self.check("life/yes", 0, life, "h at 1500 rpm")
        self.check("life/no", 1, [*life, "--set", "assumptions.multibody.piston_friction=false"])

    def test_sensitivity(self):
        sensitivity = ["sensitivity", self.case, *FEW]
        self.check("sensitivity/unchecked", 0, sensitivity)
        self.check("sensitivity/yes", 0, [*sensitivity, "--check-derivatives"])
        self.check("sensitivity/no", 1, [*sensitivity, "--check-derivatives", "--set", "bearings.cylindrical_z_mm=-26.01"])
        # A computation that fails is no wrong input.
        done = run(*sensitivity, "--check-derivatives", "--set", "bearings.cylindrical_z_mm=-26.001", "--out", self.folder / "fails")
        self.assertEqual(done.returncode, 3, done.stderr)

    def test_rattle(self):
        rattle = ["rattle", REPO / "cases/bap63_tooth_rattle.toml", "--speeds", "500:1500:#2", "--delivery-bar", "100:200:#2", "--check-points", "2",
                  "--turns", "2", "--discard", "2"]
        self.check("rattle/yes", 0, rattle)
        self.check("rattle/no", 1, [*rattle, "--set", "assumptions.multibody.piston_friction=false"])

    def test_pressure(self):
        numbers = REPO / "reference_data/published/bap63/numbers.toml"
        case = REPO / "cases/bap63_rated_hydraulic.toml"
        report = self.check("pressure/unjudged", 0, ["pressure", case])
        self.assertIsNone(report["verdict"]["agrees"])
        self.check("pressure/no", 1, ["pressure", case, "--published", numbers, "--set", "friction.shaft_viscous_Nm_per_rpm=0.01"])

    def test_hardcases(self):
        self.check("hardcases/yes", 0, ["hardcases", "--filter", "tilt_0"])
        catalogue = self.folder / "catalogue"
        shutil.copytree(REPO / "reference_data/hard", catalogue)
        for file in catalogue.glob("tilt_0/case.toml"):
            file.write_text(file.read_text().replace("spring_force_N = 250.0", "spring_force_N = 251.0"))
        self.check("hardcases/no", 1, ["hardcases", "--filter", "tilt_0", "--catalogue", catalogue])

    def test_zz_index_says_what_the_reports_say(self):
        """Runs last, over the reports of all others."""
        done = run("index", self.reports)
        self.assertEqual(done.returncode, 0, done.stderr)
        entries = json.loads((self.reports / "index.json").read_text())["reports"]
        page = (self.reports / "index.html").read_text()
        rows = {re.search(r'<a href="([^"]*)"', row).group(1): re.search(r'class="chip (\w+)"', row).group(1)
                for row in page.split("<tr>") if 'class="chip' in row}
        lines = done.stdout.splitlines()
        self.assertGreaterEqual(len(entries), 10)
        for entry in entries:
            verdict = json.loads((self.reports / entry["json"]).read_text())["verdict"]
            name = entry["json"]
            self.assertEqual(entry["agrees"], verdict["agrees"], name)
            self.assertEqual(entry["headline"], verdict["headline"], name)
            self.assertTrue(entry["headline"], name)
            self.assertEqual("no" in pathlib.PurePath(name).parts[1].split("_") or "not_explained" in name, entry["agrees"] is False, name)
            tone = "bad" if entry["agrees"] is False else "warn" if entry["warnings"] or entry["not_valid"] else "good" if entry["agrees"] else "neutral"
            self.assertEqual(rows[entry["page"]], tone, name)
            line = next(line for line in lines if f" {name}: " in line)
            # The word of its page, where it does not agree.
            fault = "differs" if entry["word"].endswith("iffers") else entry["word"].lower()
            self.assertTrue(line.startswith({True: "agrees", False: fault, None: "-"}[entry["agrees"]] + " "), line)
        # What differs comes first.
        order = [entry["agrees"] is False for entry in entries]
        self.assertEqual(order, sorted(order, reverse=True))

    def test_index_of_a_report_before_1_0_1(self):
        """That said so part by part: the worst decides."""
        place = self.folder / "old"
        place.mkdir()
        report = {"schema": 1, "program": [], "title": "old", "verdict": {
            "agrees": True, "headline": "The two models agree.", "reference": {"name": "rig", "agrees": False, "headline": "differs"}},
            "warnings": [{"name": "timing", "text": "late"}], "plausibility": {"summary": "", "warnings": [{"code": "tilt", "text": ""}], "meant": []}}
        (place / "report.json").write_text(json.dumps(report))
        self.assertEqual(run("index", place).returncode, 0)
        entry = json.loads((place / "index.json").read_text())["reports"][0]
        self.assertEqual((entry["agrees"], entry["word"], entry["warnings"]), (False, "Reference differs", ["timing", "tilt"]))


class NotCompared(unittest.TestCase):
    """What was not compared is named with the reason, and is neither agreement nor a difference."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.out = self.folder / "out"
        self.case = REPO / "cases/bap63_rated.toml"

    def run_case(self, *arguments, status=0, report="report.json"):
        done = run(*arguments, "--out", self.out)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done, json.loads((self.out / report).read_text()) if status != 2 else None

    def test_compare_where_nothing_is_left(self):
        imposed = ["--analytic", "gear=imposed", "--multibody", "gear=imposed"]
        for more in ([], ["--multibody", "piston_friction=off"]):
            done, _ = self.run_case("compare", self.case, *FEW, *imposed, *more, "--channels", "Rcs", status=2)
            self.assertRegex(done.stderr, r"--channels Rcs: nothing was compared: Rcs is computed by neither model: the speed of the block is imposed\n$")
            self.assertEqual(done.stdout, "")
            self.assertFalse(self.out.exists())
        done, _ = self.run_case("compare", self.case, *FEW, "--analytic", "gear=imposed", "--channels", "Rcs", status=2)
        self.assertIn("Rcs is not computed by the analytic model", done.stderr)
        done, _ = self.run_case("compare", self.case, *FEW, *imposed, "--channels", "Rcs,Td")
        self.assertRegex(done.stdout, "The two models agree. Largest difference Td_z1_Nm")

    def test_a_difference_that_is_not_the_largest_is_not_called_so(self):
        """Where Fh passes 0 the point of action is as uncertain as it is far away."""
        done, report = self.run_case("compare", self.case, "--set", "block.bottom_area_mm2=200")
        channels = {channel["name"]: channel for channel in report["channels"]}
        with open(self.out / "analytic.csv") as one, open(self.out / "multibody.csv") as other:
            rows = list(zip(csv.DictReader(one), csv.DictReader(other)))
        largest = max(abs(float(a["yh_y2_mm"]) - float(b["yh_y2_mm"])) for a, b in rows)
        worst = channels[report["verdict"]["worst"]["channel"]]
        self.assertEqual((worst["name"], worst["nearest_to_limit"]), ("yh_y2_mm", True))
        self.assertLess(worst["max_abs"], 0.9 * largest)
        self.assertRegex(done.stdout, r"\nThe two models agree. Difference nearest to its limit: yh_y2_mm at ")
        self.assertRegex(done.stdout, r"\nyh_y2_mm .* agrees, difference nearest to its limit\n")
        # What is held to its peak alone has its largest difference.
        for name in ("Rb1_x1_N", "Td_z1_Nm", "Fh_z2_N"):
            self.assertNotIn("nearest_to_limit", channels[name])
            self.assertAlmostEqual(max(abs(float(a[name]) - float(b[name])) for a, b in rows), channels[name]["max_abs"], delta=0)

    def test_outputs_of_a_sweep_that_both_models_share(self):
        sweep = ["sweep", self.case, *FEW, "--vary", "pump.tilt_deg=20:40:10", "--check", "100%", "--output"]
        shared = ["validity.friction", "stroke_mm", "plausibility.warnings", "max:p_1", "validity.film.share"]
        done, report = self.run_case(*sweep, ",".join(["peak:Rb1", *shared]))
        for name in shared:
            self.assertRegex(done.stdout, rf"Not checked by the other model: [^\n]*{name}[^ ]* \(")
        checks = {row["title"]: row for row in report["runs"]}["Recomputed by Simbody"]["table"]["rows"]
        self.assertEqual([row[1] for row in checks], [3, 0, 0, 0, 0, 0])
        rows = [line.split(",") for line in (self.out / "sweep_checks.csv").read_text().splitlines()]
        self.assertEqual({row[1]: row[6] for row in rows[1:]}["peak:Rb1"], "1")
        self.assertEqual({row[6] for row in rows[1:] if row[1] != "peak:Rb1"}, {""})
        shutil.rmtree(self.out)
        done, _ = self.run_case(*sweep, ",".join(shared), status=2)
        self.assertIn("--check: none of the outputs is computed independently by both models", done.stderr)

    def test_designs_that_both_models_refuse(self):
        sweep = ["sweep", self.case, *FEW, "--check", "100%", "--output", "peak:Rb1", "--vary"]
        done, report = self.run_case(*sweep, "pump.tilt_deg=40:100:30")
        self.assertIn("Simbody agrees at 2 of 2 designs; 1 of 3 checked designs not compared: both models refuse them", done.stdout)
        self.assertIs(report["verdict"]["agrees"], True)
        done, report = self.run_case(*sweep, "pump.tilt_deg=90,100", status=1)
        self.assertNotIn("agrees", done.stdout)
        self.assertEqual((report["verdict"]["agrees"], report["verdict"]["word"]), (False, "Nothing compared"))

    def test_derivatives_that_both_models_share(self):
        sensitivity = ["sensitivity", self.case, *FEW, "--vary", "pump.tilt_deg", "--check-derivatives", "--output"]
        done, report = self.run_case(*sensitivity, "mean:Td,stroke_mm,validity.friction", report="sensitivity.json")
        self.assertRegex(done.stdout, "1 of 3 derivatives agree with differences of Simbody")
        self.assertRegex(done.stdout, r"Not checked by the other model: stroke_mm \(follows from the case alone\), validity.friction \(")
        table = {row["title"]: row for row in report["runs"]}["Against Simbody"]["table"]["rows"]
        self.assertEqual([row[0] for row in table if row[5] is not None], ["mean:Td"])
        shutil.rmtree(self.out)
        done, _ = self.run_case(*sensitivity, "stroke_mm,displacement_cm3", status=2)
        self.assertIn("--check-derivatives: none of the outputs is computed independently by both models: stroke_mm", done.stderr)

    def test_a_curve_that_a_golden_reference_lacks(self):
        golden = self.folder / "golden"
        self.assertEqual(run("reference", "golden", self.case, *FEW, "--angles", "36", "--out", golden).returncode, 0)
        for curve in golden.glob("*.csv"):
            lines = [line.split(",") for line in curve.read_text().splitlines()]
            if "Td_z1_Nm" in lines[0]:
                place = lines[0].index("Td_z1_Nm")
                curve.write_text("".join(",".join(line[:place] + line[place + 1:]) + "\n" for line in lines))
        missing = r"Not compared: Td_z1_Nm \(the reference does not have it\)"
        done, report = self.run_case("compare", self.case, *FEW, "--with", golden, status=1)
        self.assertRegex(done.stdout, rf"The reference golden is incomplete: (\d+) of \1 reactions compared agree\.[^\n]*{missing}")
        self.assertNotIn("differ from golden", done.stdout)
        self.assertEqual(report["verdict"]["word"], "Reference incomplete")
        done = run("regress", golden)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stdout, "^0 agree, 0 differ, 1 incomplete; ")
        self.assertRegex(done.stdout, rf"\ngolden is incomplete: (\d+) of \1 reactions compared agree\.[^\n]*{missing}")

    def test_both_pumps_are_described(self):
        """A second pump that tips and is timed badly, beside one that does not."""
        second = self.folder / "second.toml"
        text = (REPO / "cases/bap63_rated_hydraulic.toml").read_text()
        text = re.sub(r'(?m)^name = .*$', 'name = "second"', text, count=1)
        second.write_text(re.sub(r"(?m)^bottom_area_mm2 = .*$", "bottom_area_mm2 = 0", text))
        done, report = self.run_case("compare", REPO / "cases/bap63_rated_hydraulic.toml", *FEW, "--multibody-case", second, status=1)
        names = [self.name_of(REPO / "cases/bap63_rated_hydraulic.toml") + " (analytic model)", "second (multibody model)"]
        for rows, key in ((report["validity"], "limit"), (report["timing"], "quantity")):
            for name in names:
                self.assertTrue(any(row[key].startswith(name + ": ") for row in rows), (name, key))
            self.assertTrue(all(row[key].startswith(tuple(name + ": " for name in names)) for row in rows), key)
        violated = [row for row in report["validity"] if row["violated"] and row["limit"].startswith(names[1])]
        self.assertTrue(violated)
        self.assertIn("of second (multibody model)", report["verdict"]["not_valid"])
        lift = [row for row in report["plausibility"]["warnings"] if row["code"] == "block-lifts-off"]
        self.assertEqual([row["text"].startswith(names[1] + ": ") for row in lift], [True])
        for name in names:
            self.assertIn(name + ": Drive torque: mean ", done.stdout)
            self.assertIn(name + ": Port timing: ", done.stdout)
        self.assertIn(names[1] + ": Not valid over ", done.stdout)
        self.assertRegex(done.stderr, r"(?s)^pump: analytic model, \S*bap63_rated_hydraulic.toml: .*\n"
                         r"pump: multibody model, \S*second.toml: .*warning: block-lifts-off: ")
        self.assertTrue(any(w["text"].startswith(names[1] + ": over ") for w in report["warnings"]))

    @staticmethod
    def name_of(case):
        return re.search(r'(?m)^name = "(.*)"', case.read_text()).group(1)


class RoundOff(unittest.TestCase):
    """Small results of large loads carry their round-off: no verdict is made of it. What is wrong is noticed all the same."""

    # Little or nothing turns the shaft, the teeth or the pistons.
    TEETH = ["--set", "friction.block_viscous_Nm_per_rpm=0", "--set", "gear.contact=teeth", "--set", "gear.tooth_number=25",
             "--set", "gear.face_width_mm=6.7", "--set", "pump.pistons=2", *FEW]
    PISTONS = ["--set", "pump.tilt_deg=0", "--set", "pump.bore_diameter_mm=1", "--set", "friction.piston_coulomb_N=0",
               "--set", "piston.mass_kg=1e-7", *FEW]

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.case = REPO / "cases/bap63_rated.toml"

    def run_case(self, *arguments):
        done = run(*arguments, "--out", self.folder)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        return done, json.loads((self.folder / "report.json").read_text())

    def test_a_free_run_without_torque(self):
        for torque in ("0", "1e-9", "0.001"):
            done, report = self.run_case("simulate", self.case, "--set", "drive.kind=torque", "--set", f"drive.torque_Nm={torque}",
                                         "--set", "drive.start_rpm=1500", "--set", "drive.duration_s=0.005", "--set", "drive.samples=20")
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertTrue(report["verdict"]["headline"].startswith("The trajectories agree"), done.stdout)
            self.assertNotIn("are not compared", done.stdout)

    def test_teeth_and_pistons_without_load(self):
        for name, changes in (("teeth", self.TEETH), ("pistons", self.PISTONS)):
            done, report = self.run_case("compare", self.case, *changes)
            self.assertEqual(done.returncode, 0, f"{name}: {done.stdout}")
            self.assertNotIn("differ:", done.stdout)

    def test_an_input_off_by_a_millionth_is_noticed(self):
        for changes, key in ((self.TEETH, "bottom_area_mm2 = 250.0"), (self.TEETH, "piston_coulomb_N = 25.0"), (self.TEETH, "mass_kg = 0.09"),
                             (self.PISTONS, "spring_force_N = 250.0"), (self.PISTONS, "block_viscous_Nm_per_rpm = 0.0054")):
            wrong = self.folder / "wrong.toml"
            name, value = key.split(" = ")
            text = self.case.read_text()
            self.assertIn(key, text)
            wrong.write_text(text.replace(key, f"{name} = {float(value) * (1 + 1e-6)!r}"))
            done, report = self.run_case("compare", self.case, *changes, "--multibody-case", wrong)
            self.assertEqual(done.returncode, 1, key)
            headline = report["verdict"]["headline"]
            verdicts = {c["name"]: c["verdict"] for c in report["channels"]}
            named = [channel for channel in verdicts if channel in headline]
            self.assertTrue(named, headline)
            self.assertEqual({verdicts[channel] for channel in named}, {"differs"}, headline)
            self.assertNotIn("cause", report["verdict"], headline)

    def test_a_difference_by_round_off_names_its_cause(self):
        """Pistons of 1e-9 kg have next to no equation of motion in Simbody."""
        done, report = self.run_case("compare", self.case, "--set", "pump.tilt_deg=0", "--set", "pump.bore_diameter_mm=1", "--set",
                                     "piston.mass_kg=1e-9", "--set", "friction.piston_coulomb_N=0", "--set", "operation.gravity_m_per_s2=0", *FEW)
        self.assertEqual(done.returncode, 1, done.stdout)
        cause = report["verdict"]["cause"]
        self.assertIn(cause["text"], report["verdict"]["headline"])
        self.assertIn("round-off", cause["text"])
        self.assertGreater(10 * cause["round_off_over_peak"], cause["max_over_peak"])

    def test_round_off_of_the_multipliers_is_named(self):
        """Pistons of a hundred tonnes: the constraint multipliers lose digits, the other method does not."""
        heavy = [self.case, "--set", "piston.mass_kg=1e5", *FEW]
        done, report = self.run_case("compare", *heavy)
        self.assertEqual(done.returncode, 1, done.stdout)
        cause = report["verdict"]["cause"]
        self.assertIn("Simbody's constraint multipliers", cause["text"])
        self.assertIn(cause["text"], report["verdict"]["headline"])
        self.assertGreater(10 * cause["round_off_over_peak"], cause["max_over_peak"])
        done, report = self.run_case("compare", *heavy, "--reactions", "residual")
        self.assertEqual(done.returncode, 0, done.stdout)
        # A wrong input is no round-off: the other method finds it too.
        wrong = self.folder / "wrong.toml"
        text = self.case.read_text()
        self.assertIn("piston_length_mm = ", text)
        wrong.write_text(re.sub(r"piston_length_mm = ([\d.]+)", lambda found: f"piston_length_mm = {float(found[1]) * 1.00001!r}", text))
        done, report = self.run_case("compare", *heavy, "--multibody-case", wrong)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertNotIn("cause", report["verdict"])

    def test_small_components_are_named(self):
        """With the channel's own peak beside that of its vector."""
        done, report = self.run_case("compare", self.case, *FEW, "--set", "piston.mass_kg=0.01")
        for channel in report["channels"]:
            if channel["own_peak"] is not None and not channel["peak_is_floor"]:
                self.assertLessEqual(channel["own_peak"], channel["peak"] * (1 + 1e-12), channel["name"])
        small = {f"{c['quantity']}_{c['axis']}" for c in report["channels"]
                 if c["compared"] and c["own_peak"] and 1e-12 * c["peak"] < c["own_peak"] < 1e-3 * c["peak"]}
        texts = [w["text"] for w in report["warnings"] if w["name"] == "small channels"]
        self.assertEqual(len(texts), 1 if small else 0)
        for name in small:  # with the share of the smallest that would pass
            least = min((c for c in report["channels"] if f"{c['quantity']}_{c['axis']}" == name and c["compared"] and c["own_peak"]),
                        key=lambda c: c["own_peak"] / c["peak"])
            self.assertIn(f"{name} ({least['allowed'] / least['own_peak']:.1e} of itself)", texts[0])
        self.assertIn("Rs_y3", small)


if __name__ == "__main__":
    PROGRAM, REPO = (pathlib.Path(p).resolve() for p in sys.argv[1:3])
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
