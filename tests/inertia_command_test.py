#!/usr/bin/env python3
"""`bentaxis inertia` and the scenes of `bentaxis run` from outside.

usage: inertia_command_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import csv
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from command_line_test import PUMP

PROGRAM = REPO = None  # set in main
DONE, BAD_INPUT, COMPUTATION_FAILED = 0, 2, 3
SECONDS = 120
REAL = "centre_of_mass_mm = 19.0\ntransverse_inertia_kg_mm2 = 24.0\naxial_inertia_kg_mm2 = 5.0\nspin_rpm = 0.0\n"


def piston_case(folder, piston, samples=60):
    """The high-precision default pump with another [piston] table."""
    text = (REPO / "reference_data/high_precision/bap63_rated/case.toml").read_text()
    head, rest = text.split("[piston]", 1)
    tail = rest[rest.index("["):]
    text = head + "[piston]\n" + piston + "\n" + tail
    lines = [f"samples_per_revolution = {samples}" if line.startswith("samples_per_revolution") else line
             for line in text.splitlines()]
    path = folder / "case.toml"
    path.write_text("\n".join(lines) + "\n")
    return path


class WithFolder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="bentaxis_test_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_program(self, *arguments, status=DONE):
        result = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                                timeout=SECONDS)
        self.assertEqual(result.returncode, status, result.stderr)
        result.stderr = PUMP.sub("", result.stderr)  # said first, plausibility_test.py
        return result

    def table(self, path):
        with open(self.folder / path) as file:
            return list(csv.DictReader(file))


class InertiaTest(WithFolder):
    def study(self, *options, piston='inertia = "lumped"\nmass_kg = 0.09\n' + REAL):
        self.run_program("inertia", piston_case(self.folder, piston), "--map-size", 8, "--out", "out", *options)
        return json.loads((self.folder / "out/inertia.json").read_text())

    def test_files_and_numbers(self):
        report = self.study("--speeds", "1500,2350")
        self.assertEqual({p.name for p in (self.folder / "out").iterdir()},
                         {"inertia.html", "inertia.json", "inertia.csv", "inertia_errors.csv", "inertia_map.csv"})
        self.assertIs(report["verdict"]["agrees"], True)
        missed = report["verdict"]["headline"].startswith("Two point masses are not accurate enough")
        self.assertEqual(report["verdict"]["word"], "Two masses are not enough" if missed else "Two masses are enough")
        # Two speeds, two reactions: a window for each kind of piston, and the order of the two.
        rows = report["published"]["rows"]
        self.assertEqual([row["verdict"] for row in rows], ["inside"] * 12)
        self.assertEqual({(row["at"], row["paper"]) for row in rows if "Fig. 36" in row["where"]}, {
            (f"no load, {speed} rpm; {of}", paper) for speed in (1500, 2350) for of, paper in (
                ("two masses", "window 0 to 70 N"), ("real pistons", "window 0 to 70 N"),
                ("two masses minus real pistons", "above 0 N"))})
        curves = self.table("out/inertia.csv")
        self.assertEqual(len(curves), 60)
        self.assertEqual(len(curves[0]), 1 + 2 * 2 * 4 * 7)  # speeds, loads, variants, components and magnitudes
        self.assertTrue(all(value != "" for row in curves for value in row.values()))
        errors = self.table("out/inertia_errors.csv")
        self.assertEqual({row["load"] for row in errors}, {"no_load", "loaded"})
        self.assertEqual(len(self.table("out/inertia_map.csv")), 64)
        kinds = [figure.get("kind", "curves") for figure in report["figures"]]
        self.assertEqual((kinds.count("map"), kinds.count("xy")), (2, 2))
        titles = [run["title"] for run in report["runs"]]
        self.assertIn("Where the error comes from", titles)
        scenes = next(run for run in report["runs"] if run["title"] == "What each scene costs")["table"]["rows"]
        self.assertEqual({(row[0], row[2], row[4]) for row in scenes},
                         {("full", 7, 14), ("pistons", 7, 10), ("piston", 3, 2)})

    def test_length_map_one_speed_backwards_and_spinning(self):
        spinning = 'inertia = "real"\nmass_kg = 0.09\n' + REAL.replace("spin_rpm = 0.0", "spin_rpm = 900.0")
        report = self.study("--speeds=-2000", "--map", "length", "--map-factors", "0.05,2", piston=spinning)
        causes = next(run for run in report["runs"] if run["title"] == "Where the error comes from")["table"]["rows"]
        self.assertGreater(dict((row[0], row[1]) for row in causes)["spin"], 0)
        # Too short a piston cannot be assembled: empty, never 0.
        self.assertIn("", [row["Rs_error_over_loaded"] for row in self.table("out/inertia_map.csv")])

    def test_massless_piston(self):
        massless = 'inertia = "real"\nmass_kg = 0.0\ncentre_of_mass_mm = 19.0\ntransverse_inertia_kg_mm2 = 0.0\n' \
                   "axial_inertia_kg_mm2 = 0.0\n"
        self.study("--speeds", "1500", piston=massless)

    def test_what_is_left_of_loads_that_cancel_is_no_effect_of_inertia(self):
        """At one pressure on all pistons and without drag the teeth carry 4e-6 N, of which inertia makes 7e-7 N."""
        case = piston_case(self.folder, 'inertia = "lumped"\nmass_kg = 0.09\n' + REAL)
        alike = [word for change in ("pressure.suction_bar=275", "pressure.delivery_bar=275", "friction.block_viscous_Nm_per_rpm=0",
                                     "friction.piston_coulomb_N=0") for word in ("--set", change)]
        done = self.run_program("inertia", case, "--speeds", 1500, "--map-size", 2, "--out", "out", *alike)
        headline = json.loads((self.folder / "out/inertia.json").read_text())["verdict"]["headline"]
        self.assertNotIn("Rcs", headline)
        self.assertRegex(done.stdout, r"\nRcs +1500  loaded +\S+e-07   none: loads that cancel\n")
        self.assertRegex(done.stdout, r"\nRs +1500  loaded +\S+   [0-9.]+\n")
        [row] = [row for row in self.table("out/inertia_errors.csv") if row["reaction"] == "Rcs" and row["load"] == "loaded"]
        self.assertEqual(float(row["error_over_peak_loaded"]), 0)
        # With drag they carry a load, of which it is a share.
        done = self.run_program("inertia", case, "--speeds", 1500, "--map-size", 2, "--out", "out")
        self.assertRegex(done.stdout, r"\nRcs +1500  loaded +\S+e-07   \S+e-\d+\n")

    def test_a_massless_piston_with_inertia_is_refused(self):
        case = piston_case(self.folder, 'inertia = "lumped"\nmass_kg = 0.0\n' + REAL)
        line = self.run_program("inertia", case, "--out", "new", status=BAD_INPUT).stderr.splitlines()[-1]
        self.assertIn("case.toml: [piston] transverse_inertia_kg_mm2 = 24: must be 0 where mass_kg = 0", line)
        self.assertFalse((self.folder / "new").exists())

    def test_refusals(self):
        case = piston_case(self.folder, 'inertia = "lumped"\nmass_kg = 0.09\n')
        for arguments, words in [
                ([], ["centre_of_mass_mm", "transverse_inertia_kg_mm2"]),
                (["--speeds", "0"], ["--speeds"]),
                (["--map-factors", "2,1"], ["--map-factors"]),
                (["--map-speeds", "0,100"], ["--map-speeds"]),
                (["--map", "colour"], ["--map"])]:
            if arguments:
                case = piston_case(self.folder, 'inertia = "lumped"\nmass_kg = 0.09\n' + REAL)
            with self.subTest(arguments):
                line = self.run_program("inertia", case, "--out", "new", *arguments, status=BAD_INPUT).stderr
                self.assertEqual(line.count("\n"), 1)
                for word in words:
                    self.assertIn(word, line)
                self.assertFalse((self.folder / "new").exists())

    def test_resolved_teeth_are_held_to_what_their_stiffness_leaves(self):
        """Without load their forces are their stiffness times the round-off of a gap."""
        self.run_program("inertia", "bap63_teeth", "--speeds", "1500", "--map-size", "2", "--out", "out")
        verdict = json.loads((self.folder / "out" / "inertia.json").read_text())["verdict"]
        self.assertEqual((verdict["agrees"], verdict["word"]), (True, "Two masses are enough"))

    def test_without_load_the_difference_of_resolved_teeth_goes_with_their_stiffness(self):
        """What docs/inertia.md says of it: so it is round-off of the gap, and no other cause."""
        unloaded = [word for change in (
            "pressure.delivery_bar=0", "operation.gravity_m_per_s2=0", "block.spring_force_N=0", "friction.piston_coulomb_N=0",
            "friction.shaft_viscous_Nm_per_rpm=0", "friction.shaft_torque_factor=1") for word in ("--set", change)]
        apart = []
        for modulus in (20, 2000):
            subprocess.run([PROGRAM, "compare", "bap63_teeth", *unloaded, "--set", f"gear.youngs_modulus_GPa={modulus}", "--out", "out"],
                           cwd=self.folder, capture_output=True, timeout=SECONDS)
            channels = json.loads((self.folder / "out/report.json").read_text())["channels"]
            apart.append(max(c["max_abs"] for c in channels if c["group"] == "Rb1"))
        self.assertGreater(apart[1] / apart[0], 20)
        self.assertLess(apart[1] / apart[0], 500)

    def test_a_block_that_does_not_turn_as_the_shaft_is_refused(self):
        for case, kind in (("bap63_cardan", "cardan"), ("bap63_tapered_pistons", "pistons")):
            line = self.run_program("inertia", case, "--out", "new", status=BAD_INPUT).stderr.splitlines()[-1]
            self.assertIn(f'[transfer] kind = "{kind}": must be one of "gear", "constant_velocity", "double_cardan" in an inertia study', line)
            self.assertFalse((self.folder / "new").exists())

    def test_page_draws(self):
        browser = shutil.which("chromium")
        if browser is None:
            self.skipTest("no browser")
        self.study("--speeds", "2350")
        page = subprocess.run([browser, "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000",
                               "--dump-dom", f"file://{self.folder}/out/inertia.html"], capture_output=True, text=True,
                              timeout=SECONDS).stdout
        self.assertIn('data-ready="true"', page)
        for figure in ["figure-map_Rc", "figure-fraction", "figure-rs"]:
            self.assertIn(f'id="{figure}"', page)
        self.assertIn('class="contour"', page)
        self.assertNotIn("NaN", page.split("</script>")[-1])


class SceneTest(WithFolder):
    def run_scene(self, case, *options, status=DONE):
        result = self.run_program("run", case, "--model", "multibody", "--out", "out", *options, status=status)
        return self.table("out/multibody.csv") if status == DONE else result.stderr

    def test_what_a_scene_does_not_compute_is_empty(self):
        case = piston_case(self.folder, 'inertia = "lumped"\nmass_kg = 0.09\n')
        full = self.run_scene(case)
        for scene in ["pistons", "piston"]:
            for method in ["multipliers", "residual"]:
                with self.subTest(scene=scene, method=method):
                    table = self.run_scene(case, "--scene", scene, "--reactions", method)
                    self.assertEqual(table[7]["Td_z1_Nm"], "")
                    self.assertEqual(table[7]["Rcs_z4_N"], "")
                    for name in ["Rs_1_z2_N", "Rc_5_x2_N"]:
                        self.assertAlmostEqual(float(table[7][name]), float(full[7][name]), delta=1e-8)

    def test_massless_pistons_are_refused_or_right(self):
        for piston in ['inertia = "lumped"\nmass_kg = 0.0\n', 'inertia = "lumped"\nmass_kg = 0.1\njoint_mass_fraction = 1.0\n']:
            case = piston_case(self.folder, piston)
            self.assertIn("--reactions residual", self.run_scene(case, status=COMPUTATION_FAILED))
            self.run_program("run", case, "--model", "analytic", "--out", "out")
            analytic = self.table("out/analytic.csv")
            table = self.run_scene(case, "--reactions", "residual")
            for name in ["Rs_1_z2_N", "Rcs_z4_N", "Td_z1_Nm", "Rb1_y1_N"]:
                self.assertAlmostEqual(float(table[11][name]), float(analytic[11][name]), delta=1e-7)

    def test_integrated_runs_are_of_the_full_pump(self):
        case = piston_case(self.folder, 'inertia = "lumped"\nmass_kg = 0.09\n')
        self.assertIn("--scene", self.run_scene(case, "--way", "integrated", "--scene", "piston", status=BAD_INPUT))

    def test_dynamically_equivalent_piston(self):
        data = "mass_kg = 0.09\n" + REAL
        tables = [self.run_scene(piston_case(self.folder, f'inertia = "{kind}"\n' + data))
                  for kind in ["real", "dynamically_equivalent"]]
        self.assertAlmostEqual(float(tables[0][5]["Rc_1_x2_N"]), float(tables[1][5]["Rc_1_x2_N"]), delta=1e-9)
        case = piston_case(self.folder, 'inertia = "dynamically_equivalent"\n' + data.replace("= 19.0", "= 0.0"))
        self.assertIn("centre_of_mass_mm", self.run_scene(case, status=BAD_INPUT))


if __name__ == "__main__":
    PROGRAM, REPO = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    del sys.argv[1:3]
    unittest.main()
