#!/usr/bin/env python3
"""The comparison with numbers of others can fail: planted wrong, missing, superfluous and unexpected numbers. Runs no program.

usage: external_benchmarks_test.py REPO_ROOT [options of unittest]
"""

import contextlib
import importlib.machinery
import importlib.util
import io
import json
import pathlib
import re
import sys
import tempfile
import unittest

REPO = benchmarks = None  # set in main


def loaded(file):
    loader = importlib.machinery.SourceFileLoader("run_external_benchmarks", str(file))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


def row(name, **more):
    return {"id": name, "what": name, "source": "s", "modules": ["m"], "why": "because", **more}


class ExternalBenchmarksTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="bentaxis_test_")))

    def compared(self, rows, numbers, modules=("m",)):
        text = json.dumps({"modules": modules, "sources": {}, "groups": [{"id": "g", "rows": rows}]})
        said = json.loads(text, parse_float=benchmarks.Printed, parse_int=benchmarks.Printed)
        groups, wrong = benchmarks.compared(said, numbers, self.folder)
        return [row.verdict() for row in groups["g"]], wrong

    def test_a_number_within_the_allowed_difference_passes(self):
        self.assertEqual(self.compared([row("a", value=2, relative=0.1)], {"a": 2.19}), (["pass"], []))
        self.assertEqual(self.compared([row("a", value=0, absolute=0.1)], {"a": -0.09}), (["pass"], []))
        self.assertEqual(self.compared([row("a", between=[1, 2])], {"a": 2.0}), (["pass"], []))

    def test_a_wrong_number_fails(self):
        for said, ours in ((dict(value=2, relative=0.1), 2.21), (dict(value=-2, relative=0.1), 2), (dict(value=0, absolute=0.1), 0.11),
                           (dict(between=[1, 2]), 2.01), (dict(value=1, absolute=9), float("nan")), (dict(value=17, absolute=0), 16)):
            verdicts, wrong = self.compared([row("a", **said)], {"a": ours})
            self.assertEqual(verdicts, ["fail"], said)
            self.assertRegex(wrong[0], "^a: FAILS")

    def test_an_explained_failure_is_no_error_and_its_end_is(self):
        said = row("a", value=1, absolute=0.1, fails="for a reason")
        self.assertEqual(self.compared([said], {"a": 2}), (["fail"], []))
        self.assertIn("passes, but a failure is explained", self.compared([said], {"a": 1})[1][0])

    def test_a_curve_fails_at_its_worst_point_and_where_one_is_missing(self):
        (self.folder / "c.csv").write_text("theta_deg,p\n0,1\n1,2\n2,3\n")
        said = row("c", curve=["c.csv", "p"], absolute=0.5)
        self.assertEqual(self.compared([said], {"c": {0: 1.4, 1: 2, 2: 3, 3: 99}}), (["pass"], []))
        self.assertEqual(self.compared([said], {"c": {0: 1, 1: 2.6, 2: 3}})[0], ["fail"])
        self.assertEqual(self.compared([said], {"c": {0: 1, 1: float("nan"), 2: 3}})[0], ["fail"])
        self.assertEqual(self.compared([said], {"c": {0: 1, 1: 2}})[0], ["missing"])

    def test_what_is_missing_unexpected_or_twice_is_an_error(self):
        said = row("a", value=1, absolute=1)
        self.assertIn("a: missing", self.compared([said], {})[1])
        self.assertIn("a: missing", self.compared([{**said, "fails": "x"}], {})[1])
        self.assertIn("b: computed, but nothing is expected", self.compared([said], {"a": 1, "b": 1})[1])
        self.assertIn("a: twice in the expected numbers", self.compared([said, said], {"a": 1})[1])
        self.assertIn("n: no number from outside", self.compared([said], {"a": 1}, ["m", "n"])[1])

    def test_a_module_needs_a_row_or_a_reason(self):
        modules = benchmarks.modules_of(REPO)
        self.assertTrue({"hydraulics", "core/pump", "studies/motion", "interfaces/fmu"} <= modules)
        said = json.loads(benchmarks.EXPECTED.read_text())
        self.assertEqual(benchmarks.without_row(said, modules), [])
        self.assertIn("new: has no row from outside and no reason why not", benchmarks.without_row(said, modules | {"new"}))
        said["without"]["compare"] = "none"
        self.assertIn("compare: has rows and a reason why it has none", benchmarks.without_row(said, modules))
        del said["without"]["report"], said["without"]["compare"]
        self.assertIn("report: has no row from outside and no reason why not", benchmarks.without_row(said, modules))

    def program(self, numbers, *options):
        benchmarks.measured = lambda build: numbers
        (self.folder / "bench").mkdir(exist_ok=True)
        (self.folder / "bench/external_numbers").touch()
        said, errors = io.StringIO(), io.StringIO()
        before, sys.argv = sys.argv, ["run_external_benchmarks", "--build", str(self.folder), *options]
        try:
            with contextlib.redirect_stdout(said), contextlib.redirect_stderr(errors):
                return benchmarks.main(), said.getvalue(), errors.getvalue()
        finally:
            sys.argv = before

    def test_the_command_fails_and_leaves_the_page(self):
        page = benchmarks.PAGE.read_text()
        expected = self.folder / "expected.json"
        expected.write_text(json.dumps({"modules": ["m"], "sources": {}, "groups": [{"id": "g", "rows": [row("a", value=1, absolute=0.1)]}]}))
        status, said, errors = self.program({"a": 3}, "--expected", str(expected))
        self.assertEqual(status, 1)
        self.assertIn("1 rows: 0 pass, 1 fail, of these 0 explained", said)
        self.assertIn("a: FAILS: difference 2, allowed 0.1", errors)
        self.assertEqual(self.program({"a": 1}, "--expected", str(expected))[0], 0)
        self.assertEqual(self.program({}, "--check")[0], 1)
        self.assertEqual(benchmarks.PAGE.read_text(), page)

    # The page as it is, one verdict, one expected number or one reason changed.
    def test_a_page_that_is_not_up_to_date_is_noticed(self):
        page = benchmarks.PAGE.read_text()
        line = next(line for line in page.splitlines() if line.count(" | ") == 8 and " pass " in line)
        cells = line.split(" | ")
        for place in (0, 1, 2, 4, 6, 7, 8):
            changed = page.replace(line, " | ".join(cells[:place] + ["x" + cells[place]] + cells[place + 1:]))
            self.assertNotEqual(benchmarks.same_everywhere(changed), benchmarks.same_everywhere(page), place)
        digits = page.replace(line, " | ".join(cells[:3] + ["1.23"] + cells[4:]))
        self.assertEqual(benchmarks.same_everywhere(digits), benchmarks.same_everywhere(page))

    def test_every_source_has_a_licence_and_every_row_a_reason(self):
        said = json.loads(benchmarks.EXPECTED.read_text())
        for group in said["groups"]:
            for one in group["rows"]:
                self.assertTrue(one["why"], one["id"])
                self.assertIn(one["source"], said["sources"])
        for source in said["sources"].values():
            self.assertTrue(source["is"] and source["licence"])

    # Otherwise a number could be met by repeating it.
    def test_no_program_that_computes_reads_what_is_expected(self):
        for file in (REPO / "bench/external").glob("*.[ch]*"):
            if file.suffix in (".cpp", ".h"):
                self.assertNotIn("expected", re.sub("//.*", "", file.read_text()), file)


if __name__ == "__main__":
    REPO = pathlib.Path(sys.argv.pop(1)).resolve()
    sys.dont_write_bytecode = True
    benchmarks = loaded(REPO / "scripts/run_external_benchmarks")
    unittest.main()
