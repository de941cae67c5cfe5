#!/usr/bin/env python3
"""What is possible but hardly meant is warned of by name, and what is meant is not; the picture is to scale.

usage: plausibility_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import fnmatch
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest
import xml.etree.ElementTree as xml

PROGRAM = REPO = None  # set in main
SECONDS = 120          # no single command may take longer
WARNING = re.compile(r"^bentaxis: warning: ([a-z0-9A-Z-]+): (.+)$", re.MULTILINE)
ERROR = re.compile(r"^bentaxis: error: ([a-z0-9A-Z-]+): (.+)$", re.MULTILINE)
SVG = "{http://www.w3.org/2000/svg}"


def run(*arguments, cwd=None):
    return subprocess.run([PROGRAM, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, timeout=SECONDS)


def warned(case, *arguments):
    """Codes of the warnings of a case."""
    done = run("show", case, *arguments)
    assert done.returncode == 0, done.stderr
    return [code for code, _ in WARNING.findall(done.stderr)]


def implausible():
    return sorted((REPO / "tests" / "implausible").glob("*.toml"))


def expected(case):
    """Codes that the first line of an implausible case names."""
    return re.match(r"# expect: (.+)\n", case.read_text())[1].split()


class DoubtTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="bentaxis_plausibility_")))
        self.rated = REPO / "cases" / "bap63_rated.toml"

    def checks(self):
        return re.findall(r"^\| `([a-z0-9A-Z-]+)` \|", run("schema", "--markdown", "checks").stdout, re.MULTILINE)

    def test_every_implausible_case_is_warned_of_by_name(self):
        cases = [case for case in implausible() if case.name != "meant.toml"]
        self.assertGreaterEqual(len(cases), 40)
        for case in cases:
            with self.subTest(case=case.stem):
                self.assertLessEqual(set(expected(case)), set(warned(case)))

    def test_every_check_has_an_implausible_case(self):
        named = {code for case in implausible() if case.name != "meant.toml" for code in expected(case)}
        codes = self.checks()
        self.assertEqual(len(codes), len(set(codes)))
        self.assertEqual(named - set(codes), set(), "no such check")
        self.assertEqual(set(codes) - named, set(), "checks without a case")

    def test_a_warning_names_key_value_and_limit(self):
        for case in implausible():
            if case.name == "meant.toml":
                continue
            for code, text in WARNING.findall(run("show", case).stderr):
                with self.subTest(case=case.stem, code=code):
                    self.assertRegex(text, r"\d", "no number")
                    self.assertRegex(text, r"[a-z]+_[a-z]+|mass_kg|revolutions|points|pistons|stroke|block balance|tooth"
                                     r"|\[pressure\] file", "no key")

    def test_values_in_warnings_are_those_of_the_case(self):
        seen = set()
        for case in implausible():
            if case.name == "meant.toml":
                continue
            tables = tomllib.loads(case.read_text())
            for code, text in WARNING.findall(run("show", case).stderr):
                for table, key, value in re.findall(r"(?:\[(\w+)\] )?\b([a-z]\w+) = (-?[0-9][0-9.e+-]*)", text):
                    values = [t[key] for name, t in tables.items() if isinstance(t, dict) and table in ("", name)
                              and isinstance(t.get(key), (int, float))]
                    if not values:
                        continue  # not the case's: a limit, a default, what is derived
                    with self.subTest(case=case.stem, code=code, key=key):
                        self.assertTrue(any(abs(float(value) - v) <= 6e-6 * abs(v) for v in values), (text, values))
                        seen.add(key)
        self.assertGreater(len(seen), 40)

    def test_limits_in_warnings_follow_from_the_pump(self):
        """Of the rated pump: Ra 24.92, Rd 22, Dpi 22.5 mm, 5 pistons, 40 deg."""
        for change, words in (
                ("pump.bore_diameter_mm=27", f"is not below {2 * 22 * math.sin(math.pi / 5):.4g}, the distance of 5 neighbours on Rd"),
                ("pump.bore_diameter_mm=25.2", f"a wall of {2 * 22 * math.sin(math.pi / 5) - 25.2:.3g} mm to the next bore"),
                ("pump.axis_offset_mm=15", "is above 12.46 mm"),
                ("bearings.tapered_z_mm=26", "is above -6.23 mm"),
                ("bearings.tapered_z_mm=-26000", f"is below {-10 * 24.92:.4g} mm: 10 Ra"),
                ("bearings.tapered_z_mm=-67", "are 1 mm apart, less than a quarter of Ra = 24.92"),
                ("pump.piston_length_mm=400", f"is above {4 * 24.92:.4g} mm"),
                ("friction.block_viscous_Nm_per_rpm=0.0516", f"takes {0.0516 * 1500:.4g} Nm at 1500 rpm")):
            with self.subTest(change):
                self.assertIn(words, run("show", self.rated, "--set", change).stderr)

    def test_push_of_the_lands_is_the_integral_over_them(self):
        """Pressure falls evenly over each land; ports of 156 degrees, 1000 rings between r1 and r4."""
        r1, r2, r3, r4, n = 17.2, 19.0, 24.2, 26.0, 1000
        area = 0
        for i in range(n):
            r = r1 + (i + 0.5) * (r4 - r1) / n
            area += min((r - r1) / (r2 - r1), 1, (r4 - r) / (r4 - r3)) * r * (r4 - r1) / n * math.radians(156)
        for suction in (0, 15):
            push = area * (275 + suction) / 10
            text = run("show", self.rated, "--set", "block.bottom_area_mm2=2.5", "--set", f"pressure.suction_bar={suction}").stderr
            said = re.search(r"\(lands (\S+) N", text)
            self.assertIsNotNone(said, text)
            self.assertAlmostEqual(float(said[1]), push, delta=6e-4 * push)

    def test_shipped_stored_and_hard_cases_are_doubted_for_stated_reasons_only(self):
        entries = tomllib.loads((REPO / "tests" / "implausible" / "meant.toml").read_text())["meant"]
        data = REPO / "reference_data"
        cases = {f"shipped/{case.stem}": case for case in (REPO / "cases").glob("*.toml")}
        cases |= {str(case.parent.relative_to(data)): case for case in data.rglob("case.toml")}
        self.assertGreater(len(cases), 60)
        for entry in entries:
            self.assertGreater(len(entry["reason"]), 20)
        for name, case in sorted(cases.items()):
            with self.subTest(case=name):
                stated = [code for entry in entries if any(fnmatch.fnmatch(name, p) for p in entry["cases"])
                          for code in entry["codes"]]
                self.assertEqual(sorted(warned(case)), sorted(stated))

    def test_pumps_of_all_sizes_are_not_doubted(self):
        """The rated pump at the same stresses and speeds of points: as a pump of 8 and of 500 cm3."""
        text = self.rated.read_text()
        power = {"joint_circle_radius_mm": 1, "bore_circle_radius_mm": 1, "axis_offset_mm": 1, "piston_length_mm": 1,
                 "bore_diameter_mm": 1, "pitch_diameter_mm": 1, "tapered_z_mm": 1, "cylindrical_z_mm": 1,
                 "centre_of_mass_z_mm": 1, "centre_of_mass_mm": 1, "pin_z_mm": 1, "mass_kg": 3, "bottom_area_mm2": 2,
                 "transverse_inertia_kg_mm2": 5, "axial_inertia_kg_mm2": 5, "spring_force_N": 2, "piston_coulomb_N": 2,
                 "block_viscous_Nm_per_rpm": 4, "shaft_viscous_Nm_per_rpm": 4, "speed_rpm": -1, "inner_land_mm": 1,
                 "outer_land_mm": 1}
        for factor in (0.5, 2.0):
            def scaled(match):
                f = factor ** power.get(match[1], 0)
                return match[1] + " = " + re.sub(r"-?\d+(\.\d+)?", lambda n: repr(float(n[0]) * f), match[2])
            case = self.folder / "scaled.toml"
            case.write_text(re.sub(r"(?m)^(\w+) = ((?:\[[^\]]*\])|(?:-?\d+\.\d+))", scaled, text)
                            .replace('inertia = "lumped"', 'inertia = "real"'))
            with self.subTest(factor=factor):
                self.assertEqual(warned(case), [])
                self.assertIn("278.8" if factor == 1 else f"{278.83 * factor ** 3:.4g} Nm", run("show", case).stderr)

    def test_lands_are_off_the_bores_beyond_their_edges(self):
        """Rd = 22 mm between r1 and r4; the groove r2 .. r3 within Rd -+ Dpi/2 = 10.75 .. 33.25 mm."""
        for inner, outer, off in (([21.9, 23], [24, 26], 0), ([22, 23], [24, 26], 1), ([17, 19], [21, 22.1], 0),
                                  ([17, 19], [21, 22], 1), ([9, 10.8], [24, 26], 0), ([9, 10.7], [24, 26], 1),
                                  ([17, 19], [33.2, 35], 0), ([17, 19], [33.3, 35], 1)):
            with self.subTest(inner=inner, outer=outer):
                codes = warned(self.rated, "--set", f"port_plate.inner_land_mm={inner}",
                               "--set", f"port_plate.outer_land_mm={outer}")
                self.assertEqual("lands-off-bores" in codes, bool(off), codes)

    def test_a_speed_in_rad_per_s_is_that_of_a_usual_pump(self):
        for rpm, doubted in ((50, False), (1500, True), (6150, False)):
            codes = warned(self.rated, "--set", f"operation.speed_rpm={rpm * 0.104719755:.6g}")
            self.assertEqual("speed-in-rad-per-s" in codes, doubted, rpm)

    def test_what_is_a_limit_is_meant(self):
        for change in ("pump.tilt_deg=0", "operation.speed_rpm=0", "operation.speed_rpm=-1500", "operation.gravity_m_per_s2=0",
                       "pressure.delivery_bar=0", "pressure.transition_deg=0", "block.spring_force_N=0", "piston.mass_kg=0",
                       "shaft.mass_kg=0", "block.mass_kg=0", "gear.pressure_angle_deg=0", "friction.regularization_m_per_s=0"):
            with self.subTest(change=change):
                self.assertEqual(warned(self.rated, "--set", change), [])


class SaidTest(unittest.TestCase):
    setUp = DoubtTest.setUp

    def test_the_pump_is_said_first_in_one_line(self):
        for command in (["run", self.rated, "--model", "analytic"], ["compare", self.rated], ["show", self.rated],
                        ["reference", "golden", self.rated, "--out", "golden"]):
            with self.subTest(command=command[0]):
                done = run(*command, cwd=self.folder)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(done.stderr.splitlines()[0],
                                 "pump: 63.71 cm3/rev: 95.56 l/min at 1500 rpm, 278.8 Nm at 275 bar (ideal); "
                                 "mean piston speed 1.6 m/s")

    def test_ideal_torque_is_of_the_pressure_that_the_load_sets(self):
        load = ["--set", "load.kind=orifice", "--set", "load.area_mm2=20", "--set", "operation.samples_per_revolution=36"]
        said = {}
        for command in ("show", "compare"):
            done = run(command, REPO / "cases/bap63_rated_hydraulic.toml", *load, "--out", command, cwd=self.folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            report = json.loads((self.folder / command / "report.json").read_text())
            (said[command],) = [row["value"] for row in report["derived"] if row["name"] == "ideal torque"]
            if command == "show":
                printed = float(re.search(r"ideal torque +([\d.]+) Nm\n", done.stdout)[1])
        self.assertAlmostEqual(said["show"], said["compare"], delta=1e-9)
        self.assertAlmostEqual(printed, said["show"], delta=0.01)
        self.assertNotAlmostEqual(printed, 278.83, delta=10)  # that of the delivery pressure in the file

    def test_a_block_that_nothing_presses_has_no_balance(self):
        for delivery in (-10, -50, -200):
            warnings = dict(WARNING.findall(run("show", self.rated, "--set", f"pressure.delivery_bar={delivery}").stderr))
            for code in ("block-lifts-off", "film-force-outside"):
                self.assertIn("is not defined, as bottom areas and spring do not press (-", warnings[code])
                self.assertNotIn("inf", warnings[code])
        # Where they press it is defined.
        warnings = dict(WARNING.findall(run("show", self.rated, "--set", "block.bottom_area_mm2=200").stderr))
        self.assertRegex(warnings["film-force-outside"], r"block balance is 0\.\d+$")

    def test_zero_has_no_sign(self):
        done = run("show", self.rated, "--set", "pump.tilt_deg=0", "--set", "pressure.delivery_bar=-5")
        self.assertIn(", 0 Nm at -5 bar", done.stderr)
        self.assertRegex(done.stdout, r"ideal torque +0 Nm\n")

    def test_warnings_of_a_report_are_of_the_pressure_that_its_limits_are_of(self):
        done = run("compare", REPO / "cases/bap63_rated_hydraulic.toml", "--set", "operation.samples_per_revolution=72", "--set",
                   "block.bottom_area_mm2=120", "--out", "out", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        # Before the oil is solved there is an ideal trace, and the warning says so.
        self.assertRegex(dict(WARNING.findall(done.stderr))["block-lifts-off"], "^with an ideal pressure trace ")
        report = json.loads((self.folder / "out/report.json").read_text())
        (text,) = [w["text"] for w in report["plausibility"]["warnings"] if w["code"] == "block-lifts-off"]
        (limit,) = [row for row in report["validity"] if row["limit"].startswith("film force pushes the block off the port plate")]
        self.assertTrue(text.startswith(f"the block lifts off its plate in {limit['share_percent']:.3g} % of the turn, worst {limit['worst']:.4g} N "
                                        f"at {limit['theta_deg']:.4g} deg"), (text, limit))

    def test_strict_ends_with_status_2_and_writes_nothing(self):
        doubtful = ["--set", "gear.pressure_angle_deg=0.349", "--set", "piston.mass_kg=0.9", "--strict"]
        for command in (["run", self.rated, "--model", "analytic"], ["compare", self.rated], ["show", self.rated, "--out", "a.svg"],
                        ["inertia", self.rated], ["tradeoff", self.rated], ["reference", "golden", self.rated, "--out", "g"],
                        ["pressure", REPO / "cases" / "bap63_rated_hydraulic.toml"],
                        ["calibrate", self.rated, "--torque-with-friction", "290", "--torque-without-friction", "289"],
                        ["blocktorque", self.rated, REPO / "cases" / "bap63_rated_hydraulic.toml"]):
            with self.subTest(command=command[0]):
                done = run(*command, *doubtful, cwd=self.folder)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertEqual(done.stdout, "")
                self.assertEqual({code for code, _ in ERROR.findall(done.stderr)},
                                 {"pressure-angle", "piston-heavier-than-steel"})
                self.assertEqual(len(done.stderr.splitlines()), 4)  # pump, two errors, the end
                self.assertEqual(list(self.folder.iterdir()), [])

    def test_strict_ends_at_timing_beyond_its_limits(self):
        """Of the computed pressure: after it is there, before anything is written."""
        case = REPO / "cases" / "bap63_rated_hydraulic.toml"
        codes = {"below-saturation", "ports-connected", "short-circuit", "backflow"}
        for command in (["pressure", case], ["compare", case], ["run", case, "--model", "analytic"]):
            with self.subTest(command=command[0]):
                done = run(*command, cwd=self.folder)
                self.assertEqual(done.returncode, 0, done.stderr)
                said = set(re.findall(r"warning: ([a-z-]+):", done.stderr if command[0] == "run" else done.stdout))
                self.assertLessEqual(codes, said)
                done = run(*command, "--strict", "--out", "strict", cwd=self.folder)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertEqual(done.stdout, "")
                self.assertEqual({code for code, _ in ERROR.findall(done.stderr)}, codes)
                self.assertFalse((self.folder / "strict").exists())
                meant = "; ".join(f"{code}: so it is" for code in codes)
                done = run(*command, "--strict", "--set", "plausibility.meant=" + meant, cwd=self.folder)
                self.assertEqual(done.returncode, 0, done.stderr)
        rows = {row["code"]: row for row in json.loads((self.folder / "out" / "pressure.json").read_text())["timing"]}
        self.assertEqual({code for code, row in rows.items() if row["meant"]}, codes)
        answers = json.loads((self.folder / "out" / "pressure.json").read_text())["verdict"]["answers"]
        self.assertRegex(answers[-1], rf"^Port timing: {len(codes)} of \d+ quantities with a limit do not keep it, as intended\.$")
        # The plate that could be built gives its reasons itself.
        case = REPO / "cases" / "bap63_rated_timed_plate.toml"
        self.assertEqual(run("pressure", case, "--strict", cwd=self.folder).returncode, 0)

    def test_suction_speed_is_asked_for(self):
        case = REPO / "cases" / "bap63_rated_hydraulic.toml"
        done = run("pressure", case, "--suction-speed", "-0.5", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads((self.folder / "out" / "pressure.json").read_text())
        row = report["timing"][-1]
        self.assertEqual((row["code"], row["limit"], row["flagged"]), ("suction-speed", 1500, True))
        # The first answer, and what is said of all limits counts it.
        answers = report["verdict"]["answers"]
        self.assertEqual(done.stdout.splitlines()[1:1 + len(answers)], answers)
        self.assertEqual(answers[0], f"Suction speed {row['value']:.4g} rpm: {row['text']}. The case turns at 1500 rpm.")
        [timing] = [answer for answer in answers if answer.startswith("Port timing: ")]
        flagged = [r["quantity"] for r in report["timing"] if r["flagged"]]
        self.assertIn(row["quantity"], flagged)
        self.assertIn(f": {len(flagged)} of ", timing)
        self.assertIn(", ".join(flagged), timing)
        # As asked for: the least pressure at the speed found, and a little beyond it.
        for factor, above in ((0.998, True), (1.002, False)):
            run("pressure", case, "--set", f"operation.speed_rpm={row['value'] * factor}", "--out", "at", cwd=self.folder)
            table = json.loads((self.folder / "at" / "pressure.json").read_text())["runs"][0]["table"]["rows"]
            least = next(value for name, value, _ in table if name == "chamber pressure, minimum")
            self.assertEqual(least >= -0.5, above, least)
        for wrong in ("deep", "inf", "1bar"):
            done = run("pressure", case, "--suction-speed", wrong, cwd=self.folder)
            self.assertEqual(done.returncode, 2)
            self.assertIn("saturation, vapour or a gauge pressure in bar", done.stderr)

    def test_strict_lets_pass_what_is_not_doubtful(self):
        self.assertEqual(run("show", self.rated, "--strict").returncode, 0)

    def test_a_stated_reason_silences(self):
        heavy = ["--set", "piston.mass_kg=0.3"]
        reason = ["--set", "plausibility.meant=piston-heavier-than-steel: pistons of tungsten; gravity: unused"]
        self.assertEqual(run("show", self.rated, *heavy, "--strict").returncode, 2)
        self.assertEqual(run("show", self.rated, *heavy, *reason, "--strict").returncode, 0)
        done = run("compare", self.rated, *heavy, *reason, "--out", self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        said = json.loads((self.folder / "report.json").read_text())["plausibility"]
        self.assertEqual(said["warnings"], [])
        self.assertEqual([(row["code"], row["reason"]) for row in said["meant"]],
                         [("piston-heavier-than-steel", "pistons of tungsten")])
        for wrong, why in (("piston-heavy: so", "is not the code of a check"), ("gravity", "needs a reason"), ("gravity: ", "needs a reason")):
            with self.subTest(wrong=wrong):
                done = run("show", self.rated, "--set", "plausibility.meant=" + wrong)
                self.assertEqual(done.returncode, 2)
                self.assertEqual(len(done.stderr.splitlines()), 1)
                self.assertIn(why, done.stderr)

    def test_the_report_says_the_same(self):
        done = run("compare", REPO / "tests" / "implausible" / "radii_exchanged.toml", "--out", self.folder)
        said = json.loads((self.folder / "report.json").read_text())["plausibility"]
        self.assertEqual([(row["code"], row["text"]) for row in said["warnings"]], WARNING.findall(done.stderr))
        self.assertEqual("pump: " + said["summary"], done.stderr.splitlines()[0])
        self.assertIn('class="bentaxis-pump"', (self.folder / "report.html").read_text())


class PictureTest(unittest.TestCase):
    setUp = DoubtTest.setUp

    def picture(self, *changes):
        file = self.folder / "pump.svg"
        done = run("show", self.rated, *changes, "--out", file)
        self.assertEqual(done.returncode, 0, done.stderr)
        return xml.parse(file).getroot()

    def drawn(self, picture, view):
        """Scale of a view, px/mm, and its elements, which are in mm."""
        group = picture.find(f".//{SVG}g[@class='view-{view}']/{SVG}g[@class='mm']")
        scale = re.search(r"scale\((\S+) (\S+)\)", group.get("transform"))
        self.assertAlmostEqual(float(scale[1]), -float(scale[2]))
        return float(scale[1]), group

    def test_it_is_to_scale(self):
        picture = self.picture("--set", "pump.bore_diameter_mm=20.5")
        scales = {self.drawn(picture, view)[0] for view in ("side", "joints", "block")}
        self.assertEqual(len(scales), 1)
        _, joints = self.drawn(picture, "joints")
        flange = next(c for c in joints.iter(SVG + "circle") if c.get("class") == "pale")
        self.assertTrue(24.92 < float(flange.get("r")) < 1.5 * 24.92, flange.attrib)
        _, block = self.drawn(picture, "block")
        bores = [c for c in block.iter(SVG + "circle") if c.get("class") == "bore"]
        self.assertEqual([float(c.get("r")) for c in bores], [10.25] * 5)
        for bore in bores:
            self.assertAlmostEqual(float(bore.get("cx")) ** 2 + float(bore.get("cy")) ** 2, 22.0 ** 2, places=2)
        self.assertEqual((float(bores[0].get("cx")), float(bores[0].get("cy"))), (0, 22))
        self.assertGreater(float(bores[1].get("cx")), 0)  # piston 2 follows piston 1: theta_2 = -72 deg
        joints = block.find(f"{SVG}ellipse")
        self.assertEqual((joints.get("rx"), joints.get("ry")), ("24.92", "19.0898"))
        _, side = self.drawn(picture, "side")
        edge = next(p for p in side.iter(SVG + "path") if p.get("class") == "edge")
        self.assertEqual(edge.get("d"), "M0 -24.92L0 24.92")

    def test_ports_and_lands_are_between_their_radii_and_angles(self):
        _, block = self.drawn(self.picture(), "block")
        paths = {p.get("class"): p.get("d") for p in block.iter(SVG + "path")}
        for port, angles in (("delivery", (189, 345)), ("suction", (12, 168))):
            for look, inner, outer in ((port, 19.0, 24.2), (port + " land", 17.2, 26.0)):
                number = r"(-?[\d.]+)"
                pair = number + " " + number
                found = re.fullmatch(f"M{pair}A{pair} 0 0 1 {pair}L{pair}A{pair} 0 0 0 {pair}Z", paths[look])
                self.assertIsNotNone(found, paths[look])
                n = [float(v) for v in found.groups()]
                self.assertEqual(n[2:4] + n[8:10], [outer, outer, inner, inner])
                # From y towards -x.
                corners = [(n[0], n[1], outer, angles[0]), (n[4], n[5], outer, angles[1]),
                           (n[6], n[7], inner, angles[1]), (n[10], n[11], inner, angles[0])]
                for x, y, radius, angle in corners:
                    self.assertAlmostEqual(x, -radius * math.sin(math.radians(angle)), 3)
                    self.assertAlmostEqual(y, radius * math.cos(math.radians(angle)), 3)

    def test_pitch_cones_touch_where_teeth_do(self):
        for tilt in (40, 25):
            _, side = self.drawn(self.picture("--set", f"pump.tilt_deg={tilt}"), "side")
            dot = next(c for c in side.iter(SVG + "circle") if c.get("class") == "gear")
            at = float(dot.get("cx")), float(dot.get("cy"))
            ends = [tuple(map(float, e.get("d").split("L")[1].split())) for e in side.iter(SVG + "path")
                    if e.get("class") == "gear"]
            self.assertEqual(len(ends), 4)
            self.assertEqual(sum(math.dist(end, at) < 0.02 for end in ends), 2, (at, ends))

    def test_short_dimensions_have_no_arrow_heads(self):
        """Of Ra, Rd and b1: where a line is short they would cover it."""
        def heads(*changes):
            _, group = self.drawn(self.picture(*changes), "side")
            return sum(p.get("class") == "mass" and p.get("d").count("L") == 2 for p in group.iter(SVG + "path"))
        self.assertEqual(heads(), 6)
        self.assertEqual(heads("--set", "pump.joint_circle_radius_mm=2", "--set", "pump.bore_circle_radius_mm=2"), 2)

    def test_an_arrow_points_to_what_is_too_far_to_be_drawn(self):
        for bearing, words in (("tapered_z_mm=-5000", "C1 tapered at -5000 mm \u2190"),
                               ("cylindrical_z_mm=5000", "C2 cylindrical at 5000 mm \u2192")):
            texts = [text.text for text in self.picture("--set", "bearings." + bearing).iter(SVG + "text")]
            self.assertIn(words, texts)

    def test_exchanged_radii_are_seen(self):
        """The circle of the bores leaves the ellipse of the joints' circle altogether."""
        def touches(*changes):
            _, block = self.drawn(self.picture(*changes), "block")
            bore = next(c for c in block.iter(SVG + "circle") if c.get("class") == "bore")
            ellipse = block.find(f"{SVG}ellipse")
            return float(ellipse.get("ry")) <= float(bore.get("cy")) <= float(ellipse.get("rx"))
        self.assertTrue(touches())
        self.assertFalse(touches("--set", "pump.joint_circle_radius_mm=22", "--set", "pump.bore_circle_radius_mm=24.92"))

    def test_a_little_more_tilt_takes_little_more_room(self):
        scales = [self.drawn(self.picture("--set", f"pump.tilt_deg={tilt}"), "side")[0] for tilt in (40, 44.9)]
        self.assertTrue(0.8 < scales[1] / scales[0] < 1.1, scales)

    def test_any_case_is_drawn(self):
        """Within the sheet, however absurd the case, and with text that is no markup."""
        cases = [*implausible(), *(REPO / "reference_data").rglob("case.toml")]
        for case in cases:
            if case.name == "meant.toml":
                continue
            with self.subTest(case=str(case.relative_to(REPO))):
                file = self.folder / "pump.svg"
                self.assertEqual(run("show", case, "--out", file).returncode, 0)
                picture = xml.parse(file).getroot()
                self.assertNotRegex(file.read_text(), r"\b(nan|inf)\b")
                width, height = map(float, picture.get("viewBox").split()[2:])
                self.assertTrue(200 < height < width, (width, height))
                for text in picture.iter(SVG + "text"):
                    self.assertTrue(0 <= float(text.get("x")) <= width and 0 <= float(text.get("y")) <= height, text.text)
        picture = self.picture("--set", 'name=<b>&"x"</b>')
        self.assertIn('<b>&"x"</b>', picture.find(f"{SVG}title").text)


if __name__ == "__main__":
    PROGRAM, REPO = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
