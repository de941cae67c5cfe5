#!/usr/bin/env python3
"""Tests of the problem set and of `bentaxis score`: planted mistakes are named, random curves are not, gaps are said.

usage: problems_test.py BENTAXIS REPO_ROOT [options of unittest]
With Debian's numpy and mpmath.
"""
import csv
import json
import math
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

PROGRAM = REPO = FOLDER = None  # set in main
NAMES = ("gear_pair", "impacts", "one_sided_wall", "pendulum", "piston", "piston_pair", "pump_lumped", "pump_real", "spherical_four_bar",
         "step_friction", "universal_joint")


def run(*arguments):
    return subprocess.run([str(PROGRAM), *map(str, arguments)], capture_output=True, text=True, timeout=120)


def score(header, rows, problem, *options):
    """The run that scores a table, and its JSON where there is one."""
    file = FOLDER / "table.csv"
    file.write_text("\n".join([",".join(header)] + [",".join(map(repr, row)) for row in rows]) + "\n")
    done = run("score", file, "--problem", problem, *options, "--json")
    return done, json.loads(done.stdout) if done.stdout else None


def curves(problem):
    with open(REPO / "problems" / problem / "curves.csv", newline="") as stream:
        header, *rows = list(csv.reader(stream))
    return header, [[float(x) for x in row] for row in rows]


def named(result):
    return [mistake["says"] for mistake in result["mistakes"]]


class Planted(unittest.TestCase):
    """Programs that are wrong in one way, by other code than the one that made the stored mistakes: the multiplier models,
    or bentaxis itself."""

    @classmethod
    def setUpClass(cls):
        global models, multipliers, problem_data, np
        sys.path.insert(0, str(REPO / "problems/programs"))
        sys.dont_write_bytecode = True
        import multiplier_models as models
        import multipliers
        import numpy as np
        import problem_data

    def solve(self, problem, change=None, model=None):
        """Rows at every fifth value of the grid. @param change  of the data in SI"""
        settings, number = problem_data.settings_of(problem), multipliers.Numbers()
        data = problem_data.data_of(number, settings)
        data.name = problem
        if change:
            change(data)
        xs = problem_data.grid_of(settings)
        if problem == "impacts":
            rows = (model or models.MODELS[problem])(number, data, xs)
        else:
            xs = xs[::5]
            rows = [(model or models.MODELS[problem])(number, data, x) for x in xs]
        return ["theta_deg", *rows[0]], [[float(x), *map(float, row.values())] for x, row in zip(xs, rows)]

    def must_name(self, table, problem, words, columns=None):
        done, result = score(*table, problem)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertEqual(result["verdict"], "wrong")
        self.assertEqual(result["unexplained"], [], done.stdout)
        self.assertEqual(len(result["mistakes"]), 1, done.stdout)
        self.assertIn(words, named(result)[0], done.stdout)
        self.assertEqual(result["mistakes"][0]["or"], [])
        text = run("score", FOLDER / "table.csv", "--problem", problem).stdout
        self.assertIn(f"mistake: {', '.join(result['mistakes'][0]['columns'])}: {named(result)[0]} (within", text)
        if columns:
            self.assertEqual(result["mistakes"][0]["columns"], columns)

    def test_right(self):
        for problem in ("pendulum", "gear_pair", "impacts"):
            done, result = score(*self.solve(problem), problem)
            self.assertNotEqual(result["verdict"], "wrong", done.stdout)
            self.assertGreater(result["digits"], 12.5)

    def test_reaction_on_the_bearing(self):
        header, rows = self.solve("pendulum")
        rows = [[x, omega, *(-value for value in rest)] for x, omega, *rest in rows]
        self.must_name((header, rows), "pendulum", "opposite sign", ["F_x0_N", "F_y0_N", "M_x0_Nm", "M_y0_Nm"])

    def test_couple_about_the_centre(self):
        def about_the_centre(constraint, about):
            return original(constraint, constraint.one.r)

        original = multipliers.Constraint.wrench
        multipliers.Constraint.wrench = about_the_centre
        try:
            table = self.solve("pendulum")
        finally:
            multipliers.Constraint.wrench = original
        self.must_name(table, "pendulum", "about the centre of mass, not about O", ["M_x0_Nm", "M_y0_Nm"])

    def test_no_gyroscopic_moment(self):
        class System(multipliers.System):
            def solve(self, loads=(), couples=()):
                gyroscopic = [(b, multipliers.cross(b.w, b.R.dot(b.inertia).dot(b.R.T).dot(b.w))) for b in self.bodies]
                return super().solve(loads, [*couples, *gyroscopic])

        for problem, words in (("pendulum", "gyroscopic moment about the centre of mass"), ("universal_joint", "omega x H, is missing")):
            models.System = System
            try:
                table = self.solve(problem)
            finally:
                models.System = multipliers.System
            self.must_name(table, problem, words)

    def test_no_spin(self):
        self.must_name(self.solve("piston", lambda d: setattr(d, "spin", 0.0)), "piston", "gyroscopic moment of the spin")

    def test_frame(self):
        header, rows = self.solve("piston")
        c, s = math.cos(math.radians(40)), math.sin(math.radians(40))
        rows = [[t, a, c * b + s * e, c * e - s * b, f, c * g] for t, a, b, e, f, g in rows]
        self.must_name((header, rows), "piston", "components in S1", ["Rs_y2_N", "Rs_z2_N", "Rc_y2_N"])

    def test_friction_with_the_motion(self):
        self.must_name(self.solve("piston", lambda d: setattr(d, "viscous_friction", -d.viscous_friction)), "piston", "with the motion")

    def test_bearings_exchanged(self):
        def change(d):
            d.tapered_z, d.cylindrical_z = d.cylindrical_z, d.tapered_z

        self.must_name(self.solve("piston_pair", change), "piston_pair", "places of the two bearings")

    def test_other_flank(self):
        self.must_name(self.solve("gear_pair", lambda d: setattr(d, "pressure_angle", -d.pressure_angle)), "gear_pair", "pulls the gears")

    def test_no_inertia_of_the_output(self):
        self.must_name(self.solve("gear_pair", lambda d: setattr(d, "output_inertia", 0.0)), "gear_pair", "inertia of the output")

    def test_axes_exchanged(self):
        def change(d):
            d.coupler_inertia = [d.coupler_inertia[i] for i in (1, 0, 2)]

        self.must_name(self.solve("spherical_four_bar", change), "spherical_four_bar", "moments of inertia of the coupler are exchanged")

    def test_two_sided_pads(self):
        def model(number, d, x):
            crank = models.SliderCrank(number, d, models.angle_of(number, x), [d.front_pads_x, d.rear_pads_x])
            crank.solve()
            one, two = (guide.multipliers[0] for guide in crank.guides)
            return {"L1_N": one, "U1_N": 0.0, "L2_N": two, "U2_N": 0.0, "Td_z_Nm": crank.drive.multipliers[0]}

        self.must_name(self.solve("one_sided_wall", model=model), "one_sided_wall", "pull where the upper ones should push")

    def test_friction_reversed(self):
        self.must_name(self.solve("step_friction", lambda d: setattr(d, "friction_coefficient", -d.friction_coefficient)), "step_friction",
                       "with the motion")

    def test_elastic(self):
        self.must_name(self.solve("impacts", lambda d: setattr(d, "restitution", 1.0)), "impacts", "elastic")

    def pump(self, problem, *changes, text=None, samples=72, all_columns=False):
        case = REPO / "problems" / problem / "case.toml"
        if text:
            changed = FOLDER / "case.toml"
            changed.write_text(text(case.read_text()))
            case = changed
        options = [word for change in changes for word in ("--set", change)]
        done = run("run", case, "--model", "analytic", "--out", FOLDER, "--set", f"operation.samples_per_revolution={samples}", *options)
        if done.returncode != 0:
            raise AssertionError(done.stderr)
        with open(FOLDER / "analytic.csv", newline="") as stream:
            header, *rows = list(csv.reader(stream))
        keep = [i for i, name in enumerate(header) if all_columns or re.match("theta|Rs_1_|Rc_1_|Fh_|Th_|Rcn|Rcs|Rb|Td", name)]
        return [header[i] for i in keep], [[float(row[i]) for i in keep] for row in rows]

    def test_bearing_about_O1_in_S2(self):
        header, rows = self.pump("pump_lumped", "bearings.tapered_z_mm=0.0")
        x, y, z = (header.index(f"Rb1_{axis}1_N") for axis in "xyz")
        c, s = math.cos(math.radians(40)), math.sin(math.radians(40))
        for row in rows:
            row[y], row[z] = c * row[y] - s * row[z], s * row[y] + c * row[z]
        self.must_name((header, rows), "pump_lumped", "Rb1 about O1 in S2")

    def test_no_lands(self):
        table = self.pump("pump_real", text=lambda case: case[:case.index("[port_plate]")])
        self.must_name(table, "pump_real", "lands of the port plate")

    def test_unit(self):
        header, rows = curves("gear_pair")
        torque = header.index("Td_z1_Nm")
        rows = [[1000 * x if i == torque else x for i, x in enumerate(row)] for row in rows]
        self.must_name((header, rows), "gear_pair", "1000 times too large", ["Td_z1_Nm"])


class NotNamed(unittest.TestCase):
    def test_random_curves(self):
        draw = random.Random(36)
        for problem in NAMES:
            header, rows = curves(problem)
            for _ in range(3):
                wrong = [[row[0]] for row in rows]
                for column in range(1, len(header)):
                    peak = max(abs(row[column]) for row in rows)
                    parts = [(draw.gauss(0, 1), draw.uniform(0, 360)) for _ in range(6)]
                    for row in wrong:
                        row.append(peak * sum(a * math.cos(math.radians(k * row[0] + p)) for k, (a, p) in enumerate(parts)) / 3)
                done, result = score(header, wrong, problem)
                self.assertEqual(done.returncode, 1)
                self.assertEqual(result["mistakes"], [], problem)
                self.assertEqual(result["unexplained"], header[1:])

    def test_wrong_in_no_known_way(self):
        draw = random.Random(7)
        header, rows = curves("gear_pair")
        for change in (lambda x: 1.1 * x, lambda x: x + draw.gauss(0, 1), lambda x: x + 0.05 * abs(x)):
            _, result = score(header, [[row[0], *map(change, row[1:])] for row in rows], "gear_pair")
            self.assertEqual(result["mistakes"], [])
            self.assertNotEqual(result["unexplained"], [])


class Gaps(unittest.TestCase):
    def test_exact(self):
        for problem in NAMES:
            done, result = score(*curves(problem), problem)
            self.assertEqual((done.returncode, result["verdict"], result["digits"], result["gaps"]), (0, "solved", 16.0, []), problem)
            for column in result["columns"]:
                self.assertGreaterEqual(column["digits_of_curve"], 40)
                self.assertGreater(column["margin_decades"], 4, f"{problem} {column['name']}")

    def test_half_a_turn(self):
        header, rows = curves("pendulum")
        done, result = score(header, rows[:180], "pendulum")
        self.assertEqual((done.returncode, result["verdict"], result["angles_covered"]), (1, "incomplete", 180))
        self.assertEqual(result["gaps"], ["rows at 180 of 360 angles; none between 179 and 360 (theta_deg)"])
        _, result = score(header, rows[180:], "pendulum")
        self.assertEqual(result["gaps"], ["rows at 180 of 360 angles; none between -1 and 180 (theta_deg)"])

    def test_the_description_stands_for_its_folder(self):
        header, rows = curves("pendulum")
        score(header, rows, "pendulum")
        texts = [run("score", FOLDER / "table.csv", "--problem", REPO / "problems/pendulum" / name).stdout for name in ("", "problem.toml")]
        self.assertIn("solved: ", texts[0])
        self.assertEqual(*texts)

    def test_the_verdict_is_said_first(self):
        header, rows = curves("pendulum")
        score(header, rows[:180], "pendulum")
        text = run("score", FOLDER / "table.csv", "--problem", "pendulum").stdout
        self.assertTrue(text.splitlines()[1].startswith("incomplete: 5 of 5 columns"), text)

    def test_angles_that_come_twice_are_told(self):
        header, rows = curves("pendulum")
        _, result = score(header, rows + [[rows[3][0], *(1.1 * x for x in rows[3][1:])]], "pendulum")
        self.assertEqual(result["verdict"], "wrong")
        self.assertEqual(result["gaps"], ["1 rows are at angles of rows before them; all of them are compared"])

    def test_a_heading_without_underscores_is_recognised_as_one(self):
        header, rows = curves("gear_pair")
        mean = [name for name in header if name.startswith("input_bearing")][:1] or header[-1:]
        plain = mean[0].rsplit("_", 1)[0].replace("_", "")
        _, result = score([plain if name == mean[0] else name for name in header], rows, "gear_pair")
        self.assertIn(f"column {plain} is not asked for; is it {mean[0]}?", result["gaps"])

    def test_missing_and_further_columns(self):
        header, rows = curves("pendulum")
        done, result = score([*header[:-1], "M_y_Nm"], rows, "pendulum")
        self.assertEqual((done.returncode, result["verdict"]), (1, "incomplete"))
        self.assertEqual(result["gaps"], ["no column M_y0_Nm", "column M_y_Nm is not asked for; is it M_y0_Nm?"])
        self.assertEqual([c["result"] for c in result["columns"]], ["agrees"] * 4 + ["missing"])

    def test_units(self):
        header, rows = curves("pendulum")
        other = ["theta_rad", "omega_rpm", "F_x0_kN", "f_y0_kN", "M_x0_Nmm", "M_y0"]
        factors = [math.pi / 180, 30 / math.pi, 1e-3, 1e-3, 1e3, 1]
        done, result = score(other, [[x * f for x, f in zip(row, factors)] for row in rows], "pendulum")
        self.assertEqual((done.returncode, result["verdict"]), (0, "solved"), done.stdout + done.stderr)
        self.assertIn("F_x0_kN is converted to N", result["gaps"])
        self.assertIn("M_y0 has no unit: taken as Nm", result["gaps"])

    def test_other_angles(self):
        J, arm, start = 4300e-6 + 1.5 * 0.12**2, 1.5 * 9.80665 * 0.12, 190 * math.pi / 30
        xs = [0.25 + 2.5 * i for i in range(144)]
        omega = [math.sqrt(start**2 - 2 * arm * (1 - math.cos(math.radians(x))) / J) for x in xs]
        done, result = score(["theta_deg", "omega_rad_per_s"], list(map(list, zip(xs, omega))), "pendulum")
        column = result["columns"][0]
        self.assertEqual(column["result"], "agrees")
        self.assertGreater(column["digits"], 12)
        self.assertLess(column["interpolation"], 1e-12)
        self.assertIn("144 rows are at other angles: compared with interpolated curves", result["gaps"])
        # Mistakes are named there too, and those of the program's own angles.
        _, result = score(["theta_deg", "omega_rad_per_s"], [[x, -value] for x, value in zip(xs, omega)], "pendulum")
        self.assertEqual(named(result), ["opposite sign: the reaction on the other body"])
        weight = [1.5 * 9.80665 - 1.5 * 0.12 * (arm * math.sin(a)**2 / J - w**2 * math.cos(a)) for a, w in zip(map(math.radians, xs), omega)]
        done, result = score(["theta_deg", "F_y0_N"], [[x, value - 1.5 * 9.80665] for x, value in zip(xs, weight)], "pendulum")
        self.assertEqual([says[:24] for says in named(result)], ["the weight is missing in"], done.stdout)
        # With corners nothing is interpolated.
        header, rows = curves("step_friction")
        done, result = score(header, [[row[0] + (0.2 if i % 2 else 0), *row[1:]] for i, row in enumerate(rows)], "step_friction")
        self.assertIn("180 rows are left out: they lie between the problem's angles, and its curves have corners", result["gaps"])
        self.assertEqual(result["verdict"], "incomplete")

    def test_finer_table_with_more_columns(self):
        """A pump's own run has twice the angles and 59 further columns: what is asked for is solved."""
        header, rows = Planted.pump(None, "pump_lumped", samples=720, all_columns=True)
        done, result = score(header, rows, "pump_lumped")
        self.assertEqual((done.returncode, result["verdict"], len(result["gaps"])), (0, "solved", 2), done.stdout)
        self.assertIn("360 rows are left out", result["gaps"][0])
        self.assertRegex(result["gaps"][1], r"^not asked for: .* \(\d+ columns\)$")

    def test_other_directions(self):
        header, rows = curves("piston")
        _, result = score(header, [[(360 - row[0]) % 360, *row[1:]] for row in rows], "piston")
        self.assertTrue(any("other direction" in says for says in named(result)), result["mistakes"])
        _, result = score(header, [[(row[0] + 90) % 360, *row[1:]] for row in rows], "piston")
        self.assertEqual(named(result), ["the angle is off by -90 deg"])

    def test_refused(self):
        header, rows = curves("pendulum")
        for table, problem, words in (
                ((["phi", *header[1:]], rows), "pendulum", "has no column theta_deg"),
                ((["theta_deg", "a_N"], [[row[0], 1.0] for row in rows]), "pendulum", "has none of the columns that pendulum asks for"),
                ((header, rows), "pendulums", 'did you mean "pendulum"'),
                ((header, rows), "./nowhere", "problem.toml")):
            done, result = score(*table, problem)
            self.assertEqual((done.returncode, result), (2, None))
            self.assertEqual(len(done.stderr.strip().split("\n")), 1, done.stderr)
            self.assertIn(words, done.stderr)
        self.assertEqual(run("score").returncode, 2)

    def test_badge_and_list(self):
        badge = FOLDER / "badge.svg"
        score(*curves("pendulum"), "pendulum", "--badge", badge)
        text = "".join(xml.etree.ElementTree.parse(badge).getroot().itertext())
        self.assertIn("bentaxis pendulum", text)
        self.assertIn("16.0 digits", text)
        listed = run("problems").stdout
        for name in NAMES:
            self.assertIn(name, listed)
        self.assertEqual([problem["name"] for problem in json.loads(run("problems", "--json").stdout)], list(NAMES))

    def test_tolerance(self):
        header, rows = curves("pendulum")
        rows = [[row[0], *(x * (1 + 1e-6) for x in row[1:])] for row in rows]
        self.assertEqual(score(header, rows, "pendulum")[0].returncode, 1)
        self.assertEqual(score(header, rows, "pendulum", "--tolerance", "1e-5")[0].returncode, 0)


class Derivations(unittest.TestCase):
    def make(self, *arguments, program="generator/make_curves.py"):
        return subprocess.run([sys.executable, "-B", str(REPO / "problems" / program), *arguments], capture_output=True, text=True, timeout=300)

    def test_files_are_those_of_both_derivations(self):
        done = self.make("--check")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.count("ok "), len(NAMES))

    def test_drawings_and_models(self):
        for program in ("generator/draw.py", "generator/models.py"):
            done = self.make("--check", program=program)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_wrong_closed_form_is_refused(self):
        sys.path.insert(0, str(REPO / "problems/generator"))
        import make_curves
        make_curves.mp.dps = make_curves.FIRST_DPS
        settings = make_curves.settings_of("piston")
        xs = make_curves.grid_of(settings)[:40:20]
        second = make_curves.second_derivation(("piston", settings, xs))
        make_curves.agree("piston", settings, xs, make_curves.closed_form("piston", settings, xs), second)
        for wrong in ("no_gyroscopic", "no_weight"):
            with self.assertRaises(make_curves.Disagreement):
                make_curves.agree("piston", settings, xs, make_curves.closed_form("piston", settings, xs, wrong), second)

    def test_pumps_are_the_reference_data(self):
        """At 72 angles the curves are those of another program, to the 20 digits that it wrote."""
        from mpmath import mpf
        for problem, reference in (("pump_lumped", "bap63_rated"), ("pump_real", "seven_real_spinning")):
            def rows(path):
                with open(path, newline="") as stream:
                    return {float(row["theta_deg"]): row for row in csv.DictReader(stream)}

            ours, theirs = rows(REPO / "problems" / problem / "curves.csv"), rows(REPO / f"reference_data/high_precision/{reference}/reference.csv")
            with open(REPO / "problems" / problem / "checks.csv", newline="") as stream:
                peaks = {row["column"]: mpf(row["peak"]) for row in csv.DictReader(stream)}
            for theta, row in theirs.items():
                for column, peak in peaks.items():
                    self.assertLess(abs(mpf(ours[theta][column]) - mpf(row[column])), mpf("1e-18") * peak, f"{problem} {column} {theta}")


if __name__ == "__main__":
    PROGRAM, REPO = pathlib.Path(sys.argv.pop(1)).resolve(), pathlib.Path(sys.argv.pop(1)).resolve()
    with tempfile.TemporaryDirectory() as folder:
        FOLDER = pathlib.Path(folder)
        unittest.main()
