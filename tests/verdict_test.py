#!/usr/bin/env python3
"""What a command finds is said alike everywhere: exit status, headline, JSON, page and the index over all reports.

usage: verdict_test.py BENTAXIS REPO_ROOT [options of unittest]

Every command that can end with exit status 1 is run where its verdict is "no", and where it is "yes".
"""

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
            tone = "bad" if entry["agrees"] is False else "warn" if entry["warnings"] else "good" if entry["agrees"] else "neutral"
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
