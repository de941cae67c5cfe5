#!/usr/bin/env python3
"""[gear] contact = "teeth" from outside: run, compare, simulate.

usage: teeth_command_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import csv
import json
import math
import pathlib
import re
import sys
import unittest

import command_line_test as program
from command_line_test import BAD_INPUT, ProgramTest

FEW = ("--set", "operation.samples_per_revolution=36")

# The case's tilt is 40 deg: both pitch cones have 70 deg. From O2 to O4, across that towards the block's axis, and mm.
O4 = (0, math.sin(math.radians(70)), -math.cos(math.radians(70)))
UP = (0, math.cos(math.radians(70)), math.sin(math.radians(70)))
R = 106.466 / 2 / math.sin(math.radians(70))
FORCES = tuple(f"{which}_force_N" for which in ("at", "before", "after"))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return tuple(a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3))


def scaled(a, factor):
    return tuple(factor * x for x in a)


def contacts(rows):
    """Flank, row, force, point and normal of every loaded pair."""
    for row in rows:
        for flank in ("plus", "minus"):
            for which in ("at", "before", "after"):
                force, *numbers = (float(row[f"{flank}_{which}_{key}"] or 0) for key in (
                    "force_N", "x1_mm", "y1_mm", "z1_mm", "normal_x1", "normal_y1", "normal_z1"))
                if force > 0:
                    yield flank, row, force, tuple(numbers[:3]), tuple(numbers[3:])


def distance(line, x, y):
    """From a point to the nearest stretch of a line."""
    def of_stretch(x0, y0, x1, y1):
        length2 = (x1 - x0) ** 2 + (y1 - y0) ** 2
        part = min(1, max(0, ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / length2)) if length2 else 0
        return math.hypot(x0 + part * (x1 - x0) - x, y0 + part * (y1 - y0) - y)
    points = list(zip(line["x"], line["y"]))
    return min(of_stretch(*a, *b) for a, b in zip(points, points[1:]))


class TeethTest(ProgramTest):
    @classmethod
    def case_file(cls):
        return program.REPO / "cases" / "bap63_teeth.toml"

    def rows(self, name):
        with open(self.folder / "out" / name) as file:
            return list(csv.DictReader(file))

    def report(self):
        return json.loads((self.folder / "out/report.json").read_text())

    def test_warns_of_pairs_that_are_not_looked_at(self):
        soft = ("--set", "gear.youngs_modulus_GPa=0.5", "--set", "drive.duration_s=0.002", "--set", "drive.samples=40")
        self.run_program("simulate", self.case_file(), *soft, "--model", "analytic", "--out", "out")
        self.assertEqual([w["name"] for w in self.report()["warnings"]], ["further pairs of teeth touch"])
        self.run_program("simulate", self.case_file(), *soft[2:], "--model", "analytic", "--out", "out")
        self.assertEqual(self.report()["warnings"], [])

    def test_teeth_that_do_not_mesh_are_refused_with_their_file(self):
        for command in (("run", "--model", "multibody"), ("compare",), ("simulate",)):
            result = self.run_program(command[0], self.case_file(), *command[1:], "--set", "gear.addendum_mm=1",
                                      "--out", "out", status=BAD_INPUT)
            self.assertIn("bap63_teeth.toml: [gear] addendum_mm = 1: contact ratio", result.err)

    def test_given_states(self):
        (self.folder / "states.csv").write_text(
            "theta_deg,psi_deg,theta_rpm,psi_rpm,theta_rad_per_s2,psi_rad_per_s2\n"
            "0,0,1500,1500,0,0\n20,20,1500,1490,0,-5000\n400,400,-1500,-1500,0,0\n")
        for model in ("analytic", "multibody"):
            self.run_program("run", self.case_file(), "--model", model, "--states", "states.csv", "--out", "out")
            teeth, reactions = self.rows(f"teeth_{model}.csv"), self.rows(f"{model}.csv")
            self.assertEqual([row["theta_deg"] for row in teeth], ["0", "20", "400"])
            for row, reaction in zip(teeth, reactions):
                direction = math.copysign(1, float(reaction["theta_rpm"]))
                tooth = direction * float(reaction["Rcs_z4_N"])
                self.assertEqual(float(row["plus_force_N"]) > 0, tooth > 0)
                self.assertEqual(float(row["minus_force_N"]) > 0, tooth < 0)

    def test_compare(self):
        result = self.run_program("compare", self.case_file(), *FEW, "--out", "out")
        self.assertIn("The two models agree", result.out)
        self.assertEqual({p.name for p in (self.folder / "out").iterdir()},
                         {"report.html", "report.json", "analytic.csv", "multibody.csv", "teeth_analytic.csv",
                          "teeth_multibody.csv", "budget_analytic.csv", "budget_multibody.csv"})
        analytic, multibody = self.rows("teeth_analytic.csv"), self.rows("teeth_multibody.csv")
        self.assertEqual(analytic[0].keys(), multibody[0].keys())
        reactions = self.rows("analytic.csv")
        arm = 0.106466 / 2 * math.cos(math.radians(20))
        for teeth, row in zip(analytic, reactions):
            forces = [float(teeth[f"{flank}_{which}_force_N"]) for flank in ("plus", "minus")
                      for which in ("at", "before", "after")]
            self.assertAlmostEqual(sum(forces[:3]), float(teeth["plus_force_N"]), 9)
            self.assertAlmostEqual(float(teeth["transmission_error_um"]), arm * float(teeth["lag_urad"]), 9)
            # Flank + where the block is pushed, flank - where it is held back; never both with backlash.
            tooth = float(row["Rcs_z4_N"])
            self.assertEqual(float(teeth["plus_force_N"]) > 0, tooth > 0)
            self.assertEqual(float(teeth["minus_force_N"]) > 0, tooth < 0)
            # Beyond half the backlash of 50 um, and by no more than microns.
            self.assertTrue(25 < math.copysign(1, tooth) * float(teeth["transmission_error_um"]) < 27)
            for flank in ("plus", "minus"):
                for which in ("at", "before", "after"):
                    carries = float(teeth[f"{flank}_{which}_force_N"]) > 0
                    self.assertEqual(teeth[f"{flank}_{which}_x1_mm"] != "", carries)
        report = self.report()
        (drawing,) = [f for f in report["figures"] if f["id"] == "teeth"]
        self.assertEqual(len(drawing["frames"]), 36)
        for frame, teeth in zip(drawing["frames"], analytic):
            carrying = sum(float(v) > 0 for k, v in teeth.items() if k.endswith("_share"))
            self.assertEqual(len(frame["arrows"]), carrying)
            self.assertEqual(frame["theta_deg"], float(teeth["theta_deg"]))
        (section,) = [s for s in report["runs"] if s["title"] == "Teeth in contact"]
        facts = dict(section["facts"])
        self.assertIn("pitch 70, base 62.01, tip 73.98", facts["cones"])  # asin(sin 70 deg cos 20 deg); atan(m / R)
        self.assertIn("base pitch 11.77 deg", facts["path of contact"])   # 360 deg sin(62.01 deg) / 27
        self.assertIn("flexibility of a slice of teeth", [line["input"] for line in report["common"]])

    def test_octoids_are_told_apart(self):
        result = self.run_program("compare", self.case_file(), *FEW, "--multibody", "flank_shape=octoid", "--out", "out")
        self.assertIn("Explained", result.out)
        (row,) = self.report()["assumptions"]["rows"]
        self.assertEqual(row["name"], "flanks of the teeth")
        # Torque does not tell where the teeth touch; the pin does.
        split = {c["name"]: c for c in self.report()["channels"]}
        self.assertLess(split["Rcs_z4_N"]["max_over_peak"], 1e-10)
        self.assertGreater(split["Rcn_y2_N"]["max_over_peak"], 1e-4)

    def test_path_of_contact(self):
        self.run_program("compare", self.case_file(), *FEW, "--set", "assumptions.multibody.flank_shape=octoid", "--out", "out")
        (figure,) = [f for f in self.report()["figures"] if f["id"] == "contact_path"]
        # Involutes: the plane of action holds any regular contact and its force.
        plane = {}
        for flank, pair, force, point, normal in contacts(self.rows("teeth_analytic.csv")):
            if abs(point[0]) < 0.1:
                plane[flank] = cross(scaled(point, 1 / math.hypot(*point)), normal)
        self.assertEqual(plane.keys(), {"plus", "minus"})
        for series, model in zip(figure["series"], ("analytic", "multibody")):
            self.assertEqual(series["name"], model)
            expected = []
            for flank, row, force, point, normal in contacts(self.rows(f"teeth_{model}.csv")):
                unit = scaled(point, 1 / math.hypot(*point))
                side = 1 if flank == "plus" else -1
                beside = math.asin(side * dot(unit, plane[flank]))
                # Pythagoras on the sphere; x1 looks away from where flank + pushes.
                along = math.copysign(math.acos(dot(unit, O4) / math.cos(beside)), -side * point[0])
                expected.append((f"flank {'+' if side > 0 else '-'} at {float(row['theta_deg']):g} deg",
                                 R * along, 1e3 * R * beside))
            found = [(p["note"], p["x"], p["y"]) for p in series["points"]]
            self.assertEqual(len(found), len(expected))
            for a, b in zip(sorted(found), sorted(expected)):
                self.assertEqual(a[0], b[0])
                self.assertAlmostEqual(a[1], b[1], 6)
                self.assertAlmostEqual(a[2], b[2], 6)

    def test_picture(self):
        self.run_program("compare", self.case_file(), *FEW, "--out", "out")
        (drawing,) = [f for f in self.report()["figures"] if f["id"] == "teeth"]
        rows = self.rows("teeth_analytic.csv")
        carried = [sum(float(v) for k, v in row.items() if k.endswith(FORCES)) for row in rows]
        self.assertEqual(drawing["shown"], carried.index(max(carried)))
        largest = max(float(row[f"{flank}_force_N"]) for row in rows for flank in ("plus", "minus"))
        half_pitch = math.pi * 106.466 / 27 / 2
        sheet = drawing["panels"][1]
        for frame, row in zip(drawing["frames"], rows):
            outlines = [line for line in frame["lines"] if line["panel"] == 0]
            self.assertEqual([line["look"] for line in outlines], [0, 1])
            lines = [line for line in frame["lines"] if line["panel"] == 1]
            self.assertEqual(len(frame["arrows"]), len(lines))
            for arrow, line, (flank, _, force, point, normal) in zip(frame["arrows"], lines, contacts([row])):
                # Seen along O4 -> O2: -x1 to the right, the block above.
                away = dot(point, O4)
                self.assertAlmostEqual(arrow["x"], -R * point[0] / away, 6)
                self.assertAlmostEqual(arrow["y"], R * dot(point, UP) / away, 6)
                self.assertAlmostEqual(arrow["dx"], -half_pitch * force / largest * normal[0], 6)
                self.assertAlmostEqual(arrow["dy"], half_pitch * force / largest * dot(normal, UP), 6)
                self.assertEqual(line["look"], arrow["look"])
                self.assertEqual(drawing["looks"][line["look"]]["label"][-1], "+" if flank == "plus" else "-")
                # The outlines meet there: the lag to scale, 25 um on either side of the middle of the backlash; chords of
                # outlines leave some um.
                for outline in outlines:
                    self.assertLess(distance(outline, arrow["x"], arrow["y"]), 0.012)
                # A ray from O2 over the face width, as thick as the force.
                for x, y, edge in zip(line["x"], line["y"], (R - 8, R + 8)):
                    self.assertAlmostEqual(y, edge, 2)
                    self.assertAlmostEqual(x, arrow["x"] * edge / R, 2)
                    self.assertTrue(sheet["y_range"][0] < y < sheet["y_range"][1])
                self.assertAlmostEqual((line["width"] - 1.5) / 6, force / largest, 6)
                self.assertIn(f"{force:.4g} N", frame["text"])

    def test_section(self):
        self.run_program("compare", self.case_file(), *FEW, "--out", "out")
        (section,) = [s for s in self.report()["runs"] if s["title"] == "Teeth in contact"]
        facts, rows = dict(section["facts"]), self.rows("teeth_analytic.csv")
        error = [float(row["transmission_error_um"]) for row in rows]
        self.assertEqual(facts["transmission error"],
                         f"{min(error):.4g} to {max(error):.4g} um along the line of action, backlash 50 um")
        self.assertEqual(facts["teeth"], f"27 on either gear, module {106.466 / 27:.4g} mm, face width 16 mm")
        # Right triangles on the sphere about O2: the path of contact lies on a great circle that touches the base cones, whose
        # sine is sin 70 deg cos 20 deg.
        ap, cone = math.radians(20), math.radians(70)
        base = math.asin(math.sin(cone) * math.cos(ap))
        tip, root = (cone + math.atan(mm / R) for mm in (106.466 / 27, -1.25 * 106.466 / 27))
        self.assertEqual(facts["cones"], "pitch {:.4g}, base {:.4g}, tip {:.4g}, root {:.4g} deg".format(
            *map(math.degrees, (cone, base, tip, root))))
        leg = [math.acos(math.cos(polar) / math.cos(base)) for polar in (cone, tip)]
        half, pitch = math.degrees(leg[1] - leg[0]), 360 / 27 * math.sin(base)
        self.assertEqual(facts["path of contact"], f"{-half:.4g} to {half:.4g} deg from O4 as seen from O2, "
                         f"base pitch {pitch:.4g} deg, contact ratio {2 * half / pitch:.4g}")
        stiffness = re.fullmatch(r"(\S+) N/um, (\S+) N/\(mm um\)", facts["stiffness of a pair at O4"])
        self.assertAlmostEqual(float(stiffness[1]) / float(stiffness[2]), 16, 1)  # mm of face width
        # ISO 6336-1: 14 N/(mm um) is the maximum of a pair of standard spur teeth, 0.8 of it in practice.
        self.assertTrue(10 < float(stiffness[2]) < 18)
        for flank, sign in (("plus", "+"), ("minus", "-")):
            force = [float(row[f"{flank}_force_N"]) for row in rows]
            self.assertEqual(facts[f"force of flank {sign}"],
                             f"{min(force):.4g} to {max(force):.4g} N, largest at {10 * force.index(max(force))} deg")
        loaded = [sum(float(v) > 0 for k, v in row.items() if k.endswith("_share")) for row in rows]
        for pairs, word in ((0, "pairs"), (1, "pair"), (2, "pairs"), (3, "pairs")):
            share = 100 * loaded.count(pairs) / len(rows)
            self.assertEqual(facts.get(f"{pairs} {word} under load"), f"{share:.3g} % of the turn" if share else None)

    def test_run_of_one_model(self):
        for model in ("analytic", "multibody"):
            self.run_program("run", self.case_file(), *FEW, "--model", model, "--out", "out")
            self.assertEqual(len(self.rows(f"teeth_{model}.csv")), 36)

    def test_simulate(self):
        result = self.run_program("simulate", self.case_file(), "--set", "drive.duration_s=0.002", "--set", "drive.samples=40",
                                  "--out", "out")
        self.assertIn("The trajectories agree", result.out)
        rows = self.rows("teeth_analytic.csv")
        self.assertEqual(len(rows), 41)
        self.assertEqual(float(rows[0]["lag_urad"]), 0)
        self.assertGreater(max(float(r["plus_force_N"]) for r in rows), 0)
        (drawing,) = [f for f in self.report()["figures"] if f["id"] == "teeth"]
        self.assertEqual(len(drawing["frames"]), 41)

    def test_refusals(self):
        for options, text in (
                (("compare", "--set", "gear.tooth_number=5"), "[gear] addendum_mm"),
                (("compare", "--set", "gear.face_width_mm=200"), "[gear] face_width_mm = 200"),
                (("compare", "--set", "gear.dedendum_mm=1"), "no clearance"),
                (("compare", "--set", "gear.flanks=one"), "flanks"),
                (("compare", "--way", "integrated"), "contact = \"teeth\""),
                (("compare", "--analytic", "flank_shape=octoid"), "flank_shape: must be involute in the analytic model"),
                (("compare", "--multibody", "flank_shape=round"), "must be involute or octoid"),
                (("simulate", "--steady"), "--steady"),
                (("run", "--model", "analytic", "--set", "gear.pitch_error_file=none.csv"), "no such file")):
            result = self.run_program(options[0], self.case_file(), *options[1:], "--out", "refused", status=BAD_INPUT)
            self.assertIn(text, result.err)
            self.assertFalse((self.folder / "refused").exists())


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
