#!/usr/bin/env python3
"""The JSON of every report against docs/report.schema.json, and the schema against what there is.

usage: report_schema_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import copy
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import jsonschema

PROGRAM = REPO = None  # set in main
SECONDS = 120          # no single command may take longer


def thinned(name, samples):
    """A shipped case with fewer samples a turn."""
    text = (REPO / "cases" / f"{name}.toml").read_text()
    text, count = re.subn(r"(?m)^samples_per_revolution = .*", f"samples_per_revolution = {samples}", text)
    assert count == 1
    return text


class SchemaTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.schema = json.loads((REPO / "docs" / "report.schema.json").read_text())
        jsonschema.Draft202012Validator.check_schema(cls.schema)
        cls.validator = jsonschema.Draft202012Validator(cls.schema)
        cls.temporary = tempfile.TemporaryDirectory(prefix="bentaxis_schema_")
        folder = cls.folder = pathlib.Path(cls.temporary.name)
        for case, samples in (("bap63_rated", 72), ("bap63_rated_hydraulic", 72), ("bap63_peak_hydraulic", 72)):
            (folder / f"{case}.toml").write_text(thinned(case, samples))
        rated, hydraulic, peak = "bap63_rated.toml", "bap63_rated_hydraulic.toml", "bap63_peak_hydraulic.toml"
        # One line per kind of report; together they use every part of the schema.
        cls.reports = {
            "compare": cls.report("report.json", "compare", hydraulic),
            "unequal": cls.report("report.json", "compare", rated, "--multibody", "piston_friction=off", "gear=imposed"),
            "integrated": cls.report("report.json", "compare", rated, "--way", "integrated", "--accuracy", "1e-3"),
            "differing": cls.report("report.json", "compare", rated, "--multibody-case", peak, status=1),
            "pressure": cls.report("pressure.json", "pressure", hydraulic, "--delivery-bar", "0:200:100", "--overlay", peak,
                                   "--transient", "1", "--published",
                                   REPO / "reference_data" / "published" / "bap63" / "numbers.toml", status=None),
            "inertia": cls.report("inertia.json", "inertia", rated, "--map-size", "4"),
            "tradeoff": cls.report("tradeoff.json", "tradeoff", rated, "--integrators", "rk-merson", "--accuracies", "1e-3"),
            "fig34": cls.report("fig34.json", "fig34", rated, "--exponents", "1", "--approaches-um", "5", "--backlashes-um", "0",
                                "--dissipations", "5", "--block-inertias-kg-mm2", "1500"),
            "paper": cls.report("paper.json", "paper"),
            "hardcases": cls.report("hardcases.json", "hardcases", "--filter", "speed", "--catalogue",
                                    REPO / "reference_data" / "hard"),
            "simulate": cls.report("report.json", "simulate", REPO / "cases" / "bap63_tooth_rattle.toml", "--set",
                                   "drive.duration_s=0.001", "--set", "drive.samples=10", "--error", "1e-4"),
            "show": cls.report("report.json", "show", hydraulic),
            "teeth": cls.report("report.json", "compare", REPO / "cases" / "bap63_teeth.toml", "--set",
                                "operation.samples_per_revolution=36"),
            "life": cls.report("life.json", "life", REPO / "cases" / "bap63_bearing_life.toml", "--set",
                               "operation.samples_per_revolution=36"),
            "uncertainty": cls.report("report.json", "uncertainty", rated, "--vary", "pump.tilt_deg=normal(0.1)", "--samples", "150",
                                      "--sobol", "32"),
            "rattle": cls.report("report.json", "rattle", REPO / "cases" / "bap63_tooth_rattle.toml", "--set",
                                 "friction.block_viscous_Nm_per_rpm=0.0054", "--speeds", "900:1200:#2", "--delivery-bar",
                                 "350", "--turns", "2", "--check-points", "1"),
            "sweep": cls.report("report.json", "sweep", rated, "--vary", "pump.piston_length_mm=6:46:10", "--vary",
                                "pump.joint_circle_radius_mm=20:35:5", "--maximise", "mean:Td", "--minimise", "max:Rb2", "--check", "10%"),
            "optimise": cls.report("report.json", "optimise", rated, "--vary", "pump.tilt_deg=20:42", "--maximise", "mean:Td", "--minimise",
                                   "peak:Rb1", "--subject-to", "peak:Rb1 <= 50000", "--population", "8", "--generations", "2"),
        }
        cls.reports["regress"] = cls.page_of_a_regression()
        (folder / "data.toml").write_text('schema = 1\n[[unknown]]\nparameter = "pump.bore_diameter_mm"\nbetween = [20, 25]\n' + "".join(
            f'[[number]]\noutput = "mean:Td"\nvalue = {value}\nuncertainty = 1\n' for value in (292, 300)))
        if cls.run_program("identify", rated, "--data", "data.toml", "--out", "out", status=None).returncode != 2:  # there is Ceres
            cls.reports["refuted"] = cls.report("report.json", "identify", rated, "--data", "data.toml", "--starts", "1", status=1)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def run_program(cls, *arguments, status=0):
        result = subprocess.run([PROGRAM, *map(str, arguments)], cwd=cls.folder, capture_output=True, text=True,
                                timeout=SECONDS)
        assert status is None or result.returncode == status, result.stderr
        return result

    @classmethod
    def report(cls, file, *arguments, status=0):
        cls.run_program(*arguments, "--out", "out", status=status)
        return json.loads((cls.folder / "out" / file).read_text(), parse_constant=lambda text: None)

    @classmethod
    def page_of_a_regression(cls):
        """A changed curve brings figures. What is in the page is what --json-file writes."""
        cls.run_program("reference", "golden", "bap63_rated.toml", "--out", "golden")
        stored = cls.folder / "golden" / "analytic.csv"
        lines = stored.read_text().splitlines()
        fields = lines[5].split(",")
        fields[1:4] = [str(float(value) + 1) for value in fields[1:4]]
        lines[5] = ",".join(fields)
        stored.write_text("\n".join(lines) + "\n")
        cls.run_program("regress", "golden", "--html", "regress.html", "--json-file", "regress.json", status=None)
        text = (cls.folder / "regress.html").read_text()
        page = json.loads(re.search(r'<script type="application/json" id="report">(.*?)</script>', text, re.S).group(1))
        written = json.loads((cls.folder / "regress.json").read_text())
        assert written == page, "regress --json-file is not what is in the page"
        return written

    def test_every_report_follows_the_schema(self):
        for name, report in self.reports.items():
            with self.subTest(name):
                errors = [f"{list(e.absolute_path)}: {e.message[:200]}" for e in self.validator.iter_errors(report)]
                self.assertEqual(errors, [])

    def test_every_part_of_the_schema_is_used(self):
        used = set().union(*self.reports.values())
        self.assertEqual(set(self.schema["properties"]) - used, {"long_run"})  # of the whole catalogue only
        kinds = {figure["kind"] for report in self.reports.values() for figure in report.get("figures", [])}
        self.assertEqual(kinds, {"curves", "piston_bars", "own_axis", "xy", "map", "scatter", "drawing", "parallel", "bars", "bands"})
        self.assertTrue(any("curves" in figure for figure in self.reports["regress"]["figures"]))
        maps = [figure for figure in self.reports["sweep"]["figures"] if figure["kind"] == "map"]
        self.assertTrue(any("reasons" in figure for figure in maps))  # of designs that do not assemble
        self.assertIsNotNone(self.reports["unequal"]["assumptions"])
        self.assertIsNotNone(self.reports["compare"]["published"])

    def test_every_object_is_closed(self):
        """A key that nobody described would pass a schema that leaves an object open."""
        def check(node, path):
            if isinstance(node, dict):
                if "properties" in node:
                    self.assertIs(node.get("additionalProperties"), False, path)
                for key, value in node.items():
                    check(value, path + "/" + key)
            elif isinstance(node, list):
                for value in node:
                    check(value, path)
        check(self.schema, "")

    def test_a_wrong_report_is_refused(self):
        def without(report, *path):
            for key in path[:-1]:
                report = report[key]
            del report[path[-1]]
        changes = {
            "no title": lambda r: without(r, "title"),
            "no published": lambda r: without(r, "published"),
            "unknown key": lambda r: r.update(colour="red"),
            "a channel without its unit": lambda r: without(r, "channels", 0, "unit"),
            "a verdict that does not exist": lambda r: r["channels"][0].update(verdict="fine"),
            "text for a number": lambda r: r["channels"][0].update(peak="12"),
            "a figure of no kind": lambda r: without(r, "figures", 0, "kind"),
            "facts as an object": lambda r: r["runs"][0].update(facts={"a": "b"}),
        }
        for name, change in changes.items():
            with self.subTest(name):
                report = copy.deepcopy(self.reports["compare"])
                change(report)
                self.assertFalse(self.validator.is_valid(report))


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    PROGRAM, REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
