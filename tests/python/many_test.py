"""Sweeps, simulations and identifications in Python."""

import csv
import json
import math

import numpy

import bentaxis
from support import CASES, ModuleTest, columns_of, main

DATA = """schema = 1
[[unknown]]
parameter = "pump.bore_diameter_mm"
between = [20, 25]
[[number]]
output = "mean:Td"
value = 292.5
uncertainty = 1
"""


class OptimiseTest(ModuleTest):
    VARY = {"pump.tilt_deg": "25:42", "pump.bore_diameter_mm": "20:26"}

    def search(self, the_case=None, **options):
        return bentaxis.optimise(the_case or self.case(operation__samples_per_revolution=36), self.VARY, "peak:Rb1", "displacement_cm3",
                                 "peak:Rs <= 13000", population=16, generations=4, restarts=1, **options)

    def test_results_are_those_of_the_program(self):
        try:
            found = self.search(outputs="mean:Td")
        except bentaxis.InputError as error:
            if "without pagmo" in str(error):
                self.skipTest(str(error))
            raise
        self.run_program("optimise", CASES / "bap63_rated.toml", "--set", "operation.samples_per_revolution=36", "--vary",
                         "pump.tilt_deg=25:42", "--vary", "pump.bore_diameter_mm=20:26", "--minimise", "peak:Rb1", "--maximise",
                         "displacement_cm3", "--subject-to", "peak:Rs <= 13000", "--output", "mean:Td", "--population", "16",
                         "--generations", "4", "--restarts", "1", "--out", "out")
        found.write_csv(self.folder / "mine.csv")
        self.assertEqual((self.folder / "mine.csv").read_text(), (self.folder / "out/evaluations.csv").read_text())
        self.assertEqual(found.names[:3], ["pump.tilt_deg", "pump.bore_diameter_mm", "peak:Rb1"])
        with open(self.folder / "out/front.csv", newline="") as file:
            self.assertEqual([int(row["design"]) for row in csv.DictReader(file)], list(found.front))
        self.assertEqual([one.why for one in found.chosen], ["lowest peak:Rb1", "largest displacement_cm3", "balanced"])
        best = found.chosen[0].design
        self.assertEqual(found["peak:Rb1"][best], min(found["peak:Rb1"][row] for row in found.front))
        table = bentaxis.run(found.case(best))
        self.assertAlmostEqual(max(table["Rb1_x1"]**2 + table["Rb1_y1"]**2 + table["Rb1_z1"]**2)**0.5, found["peak:Rb1"][best], 6)
        for row, reason in found.infeasible.items():
            self.assertIn("peak:Rs_1 <= 13000", reason)
            self.assertNotIn(row, found.front)
        self.assertEqual(found.answers, json.loads((self.folder / "out/report.json").read_text())["verdict"]["answers"])
        with self.assertRaises(IndexError):
            found.case(len(found))
        found.report(self.folder / "report")
        self.assertTrue((self.folder / "report/chosen_3.toml").exists())
        for options, text in (({"population": 10}, "multiple of 4"), ({"comparison": "some"}, "fast, yes or no"),
                              ({"samples": 0}, "samples = 0"), ({"threads": -1}, "threads"), ({"model": "none"}, "model")):
            with self.subTest(text):
                options = {"population": 16, "generations": 4, "restarts": 1, **options}
                self.assertIn(text, self.refused(bentaxis.InputError, lambda o=options: bentaxis.optimise(
                    self.case(), self.VARY, "peak:Rb1", **o)))


class SweepTest(ModuleTest):
    VARY = {"pump.tilt_deg": "20:40:5", "pressure.delivery_bar": numpy.array([100.0, 200.0, 300.0])}

    def test_results_are_those_of_the_program(self):
        self.run_program("sweep", CASES / "bap63_rated.toml", "--vary", "pump.tilt_deg=20:40:5", "--vary",
                         "pressure.delivery_bar=100,200,300", "--output", "max:Rb1_z1,mean:Td", "--format", "csv", "--out", "out")
        sweep = bentaxis.sweep(self.case(), self.VARY, ["max:Rb1_z1", "mean:Td"])
        sweep.write_csv(self.folder / "mine.csv")
        self.assertEqual((self.folder / "mine.csv").read_text(), (self.folder / "out/sweep.csv").read_text())
        self.assertEqual(sweep.names, ["pump.tilt_deg", "pressure.delivery_bar", "max:Rb1_z1_N", "mean:Td"])
        self.assertEqual((len(sweep), sweep.values.shape), (15, (15, 2)))
        self.assertEqual([sweep.unit(name) for name in sweep.names], ["deg", "bar", "N", "Nm"])
        self.assertIs(sweep["mean:Td_Nm"].base, sweep)
        self.assert_same(sweep["pump.tilt_deg"][::3], [20, 25, 30, 35, 40])
        self.assertIn("designs", sweep.headline)
        self.assertIsInstance(sweep, bentaxis.Table)
        self.assertEqual(list(sweep.to_pandas().columns), sweep.names)

    def test_values_that_are_none_are_refused_by_name(self):
        for vary, options, text in (
                ({"pump.tilt_deg": numpy.zeros((2, 2))}, {}, "pump.tilt_deg: must be a number, a text or a list of them, "
                                                             "not an array of 2 dimensions"),
                ({"pump.tilt_dge": [40]}, {}, 'did you mean "pump.tilt_deg"?'),
                ({"pump.tilt_deg": [40]}, {"check": float("nan")}, "check = nan: must be a share")):
            with self.subTest(text):
                self.assertIn(text, self.refused(bentaxis.InputError, lambda v=vary, o=options: bentaxis.sweep(
                    self.case(), v, "mean:Td", **o)))
        self.assertEqual(len(bentaxis.sweep(self.case(), {"pump.tilt_deg": numpy.array(40)}, "mean:Td")), 1)
        self.assertEqual(len(bentaxis.sweep(self.case(), {"pump.tilt_deg": "38:40:1"}, "mean:Td", check=1).checks), 3)

    def test_a_design_is_a_run(self):
        sweep = bentaxis.sweep(self.case(), {"pump.tilt_deg": [33]}, "mean:Td")
        torque = bentaxis.run(self.case(pump__tilt_deg=33))["Td_Nm"]
        self.assertAlmostEqual(sweep["mean:Td_Nm"][0], numpy.mean(torque), delta=1e-11 * numpy.mean(torque))

    def test_efficiencies_are_those_of_the_program(self):
        self.run_program("compare", CASES / "bap63_rated_hydraulic.toml", "--out", "out")
        budget = json.loads((self.folder / "out/report.json").read_text())["budget"]
        stated = {line["name"]: line["values"][0] for line in budget["efficiency"]}
        outputs = {"overall": "total", "overall_iso": "ISO 4409 total", "volumetric_iso": "ISO 4409 volumetric",
                   "mechanical_mass": "mass-based hydraulic-mechanical"}
        sweep = bentaxis.sweep(self.case("bap63_rated_hydraulic"), {"operation.speed_rpm": [1500]},
                               ["efficiency." + name for name in outputs])
        for i, name in enumerate(outputs.values()):
            self.assertAlmostEqual(sweep.values[0][i], stated[name], 9, name)

    def test_samples_checks_and_designs_that_are_none(self):
        sweep = bentaxis.sweep(self.case(operation__samples_per_revolution=36), {"pump.tilt_deg": "30:42"}, "peak:Rb1",
                               sampling="sobol", samples=64, check=0.1)
        self.assertTrue(sweep.agrees)
        self.assertGreater(len(sweep.checks), 0)
        self.assertTrue(all(check.agrees for check in sweep.checks))
        none = bentaxis.sweep(self.case(), {"pump.tilt_deg": [40, 95]}, "mean:Td")
        self.assertEqual(list(none.infeasible), [1])
        self.assertIn("tilt", none.infeasible[1])
        self.assertTrue(numpy.isnan(none["mean:Td_Nm"][1]))
        one = bentaxis.sweep(self.case(), self.VARY, "mean:Td", threads=1)
        self.assert_same(one.values, bentaxis.sweep(self.case(), self.VARY, "mean:Td", threads=2).values)

    def test_words_and_what_is_refused(self):
        words = bentaxis.sweep(self.case(), {"assumptions.analytic.gear": ["mesh", "imposed"]}, "mean:Td")
        self.assert_same(words["assumptions.analytic.gear"], [0, 1])
        for vary, outputs, text in (({}, "mean:Td", "vary: name at least one"), (self.VARY, None, "outputs: name at least one"),
                                    ({"pump.tilt": [1]}, "mean:Td", "pump.tilt"), (self.VARY, "mean:Tx", "Tx")):
            with self.subTest(text):
                found = self.refused(bentaxis.InputError, lambda v=vary, o=outputs: bentaxis.sweep(self.case(), v, o))
                self.assertIn(text, found)
                self.assertNotIn("--", found)
        self.assertIn("samples", self.refused(
            bentaxis.InputError, lambda: bentaxis.sweep(self.case(), {"pump.tilt_deg": "30:40"}, "mean:Td", sampling="lhs")))

    def test_report(self):
        files = bentaxis.sweep(self.case(), self.VARY, "mean:Td").report(self.folder / "out")
        self.assertEqual(sorted(file.name for file in (self.folder / "out").iterdir()),
                         ["report.html", "report.json", "sweep.csv"])
        self.assertEqual(len(files), 3)


class SimulationTest(ModuleTest):
    CHANGES = {"drive__duration_s": 0.01, "drive__samples": 20}

    def test_one_model_gives_the_numbers_of_the_program(self):
        self.run_program("simulate", CASES / "bap63_motor_start.toml", "--model", "analytic", "--set", "drive.duration_s=0.01",
                         "--set", "drive.samples=20", "--out", "out")
        simulation = bentaxis.simulate(self.case("bap63_motor_start", **self.CHANGES), model="analytic")
        table = simulation.analytic
        for column, values in columns_of(self.folder / "out/simulation_analytic.csv").items():
            self.assert_same(table[column], values)
        self.assertEqual(table.unit("shaft_rpm"), "rpm")
        self.assertIsNone(simulation.multibody)
        self.assertTrue(simulation.agrees)
        files = simulation.report(self.folder / "mine")
        self.assertEqual(sorted(file.name for file in (self.folder / "out").iterdir()),
                         sorted(file.name for file in map(type(self.folder), files)))

    def test_both_models_agree(self):
        simulation = bentaxis.simulate(self.case("bap63_motor_start", **self.CHANGES), error=1e-5)
        self.assertTrue(simulation.agrees)
        self.assertLess(max(one.of_allowed for one in simulation.groups if one.of_allowed == one.of_allowed), 1)
        self.assert_close(simulation.multibody["shaft_rpm"], simulation.analytic["shaft_rpm"], 1e-5)
        self.assertIn("agree", simulation.headline)

    def test_oil_and_what_is_refused(self):
        case = self.case("bap63_load_step", drive__duration_s=0.002, drive__samples=10)
        simulation = bentaxis.simulate(case, model="analytic")
        oil = simulation.oil_analytic
        self.assertEqual(len(oil), 11)
        self.assertEqual(oil.names[0], "time_s")
        self.assertTrue(all(oil.meaning(name) for name in oil.names))
        for arguments, text in (({"oil": "none"}, "coupled or periodic"), ({"error": 1}, "[1e-10, 0.1]"),
                                ({"model": "adams"}, "analytic or multibody")):
            self.assertIn(text, self.refused(bentaxis.InputError, lambda a=arguments: bentaxis.simulate(case, **a)))
        self.assertIn("[drive]", self.refused(bentaxis.InputError, lambda: bentaxis.simulate(self.case())))


class IdentificationTest(ModuleTest):
    def identify(self, **options):
        (self.folder / "data.toml").write_text(DATA)
        return bentaxis.identify(self.case(operation__samples_per_revolution=60), self.folder / "data.toml", starts=1, **options)

    def test_one_number(self):
        try:
            found = self.identify(fit_only=True)
        except bentaxis.InputError as error:
            self.assertIn("Ceres", str(error))
            self.skipTest("built without Ceres")
        [name] = found.unknowns
        self.assertEqual(name, "pump.bore_diameter_mm")
        self.assertLess(found.sum_of_squares, 1e-6)
        self.assertEqual(found.case[name], found.values[name])
        self.assertIn("identified", found.case.name)
        self.assertAlmostEqual(numpy.mean(bentaxis.run(found.case)["Td_Nm"]), 292.5, delta=1e-3)
        self.assertGreater(found.deviations[name], 0)
        self.assertEqual((found.degrees_of_freedom, found.p_value, found.refuted), (0, None, False))
        self.assertIsNone(found.bands)
        self.run_program("identify", CASES / "bap63_rated.toml", "--set", "operation.samples_per_revolution=60", "--data",
                         "data.toml", "--starts", 1, "--fit-only", "--out", "out")
        with open(self.folder / "out/unknowns.csv", newline="", encoding="utf-8") as file:
            [row] = csv.DictReader(file)
        self.assertEqual(float(row["identified"]), found.values[name])

    def test_a_refuted_fit(self):
        other = '[[number]]\noutput = "mean:Td"\nvalue = 300\nuncertainty = 1\n'
        (self.folder / "two.toml").write_text(DATA + other)
        case = self.case(operation__samples_per_revolution=60)
        try:
            found = bentaxis.identify(case, self.folder / "two.toml", starts=1, steps=20, draws=10)
        except bentaxis.InputError as error:
            self.assertIn("Ceres", str(error))
            self.skipTest("built without Ceres")
        # 292.5 and 300 Nm of one pump, each known to 1 Nm.
        self.assertAlmostEqual(found.sum_of_squares, 2 * 3.75**2, delta=0.02)
        self.assertTrue(found.refuted)
        self.assertEqual(found.degrees_of_freedom, 1)
        self.assertAlmostEqual(found.p_value, math.erfc(math.sqrt(found.sum_of_squares / 2)), delta=1e-12)
        self.assertAlmostEqual(found.birge_ratio, math.sqrt(found.sum_of_squares), 12)
        (name, residual), _ = found.worst_residuals
        self.assertEqual(name, "mean:Td")
        self.assertAlmostEqual(abs(residual), 3.75, delta=0.01)
        self.assertEqual(found.intervals, {})
        self.assertIsNone(found.bands)
        self.assertIn("fit refuted", found.case.name)

    def test_bands_and_report(self):
        try:
            found = self.identify(steps=20, draws=10, unknowns={"pump.tilt_deg": (35, 42)})
        except bentaxis.InputError as error:
            self.assertIn("Ceres", str(error))
            self.skipTest("built without Ceres")
        self.assertIn("must be a pair", self.refused(
            bentaxis.InputError, lambda: self.identify(unknowns={"pump.tilt_deg": 3})))
        self.assertEqual(found.unknowns, ["pump.bore_diameter_mm", "pump.tilt_deg"])
        low, high = found.intervals["pump.tilt_deg"]
        self.assertLess(low, high)
        found.report(self.folder / "out")
        inputs = json.loads((self.folder / "out/report.json").read_text())["provenance"]["inputs"]
        self.assertEqual([entry["file"].split("/")[-1] for entry in inputs], ["bap63_rated.toml", "data.toml"])
        known = columns_of(self.folder / "out/bands.csv")
        for column, values in known.items():
            self.assert_same(found.bands[column], values)
        self.assertEqual(list(known), found.bands.names)


if __name__ == "__main__":
    main()
