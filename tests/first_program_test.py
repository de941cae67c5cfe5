#!/usr/bin/env python3
"""The first program, which scripts/compare_default_pump builds: it compares as the whole one does, and says how to build the rest.

usage: first_program_test.py FIRST_BENTAXIS BENTAXIS REPO_ROOT [options of unittest]
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

FIRST = WHOLE = REPO = None  # set in main
DONE, BAD_INPUT = 0, 2
BUILT = {"compare", "show", "index", "run", "cases", "schema", "docs", "licenses", "completion", "manual"}


class FirstProgramTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="bentaxis_test_")))

    def run_program(self, program, *arguments, status=DONE):
        result = subprocess.run([program, *map(str, arguments)], cwd=self.folder, stdin=subprocess.DEVNULL,
                                capture_output=True, text=True, timeout=120)
        self.assertEqual(result.returncode, status, f"{arguments}: {result.stdout[:500]}{result.stderr}")
        return result

    def commands(self, program):
        lines = self.run_program(program, "--help").stdout.split("Options:")[1].splitlines()
        return {line.split()[0]: line for line in lines if re.match(r"  [a-z]", line)}

    def test_compares_as_the_whole_program_does(self):
        case = REPO / "cases" / "bap63_rated_hydraulic.toml"
        for name, program in (("first", FIRST), ("whole", WHOLE)):
            self.run_program(program, "compare", case, "--out", name)
        files = sorted(file.name for file in (self.folder / "first").iterdir())
        self.assertIn("report.html", files)
        self.assertEqual(files, sorted(file.name for file in (self.folder / "whole").iterdir()))
        for name in files:
            first, whole = ((self.folder / place / name).read_bytes() for place in ("first", "whole"))
            if name.endswith(".csv"):
                self.assertEqual(first, whole, name)
        first, whole = (json.loads((self.folder / place / "report.json").read_text()) for place in ("first", "whole"))
        for report in (first, whole):  # times, date, command
            report["models"] = [{**model, "seconds": 0} for model in report["models"]]
            del report["provenance"]
        libraries = [entry for entry in whole["program"] if entry not in first["program"]]
        self.assertLessEqual({name for name, _ in libraries}, {"HDF5", "MPI", "OpenTURNS", "Ceres", "search"})
        whole["program"] = [entry for entry in whole["program"] if entry not in libraries]
        self.assertEqual(first, whole)

    def test_lists_all_commands_and_says_how_to_build_the_others(self):
        first, whole = self.commands(FIRST), self.commands(WHOLE)
        self.assertEqual(first.keys(), whole.keys())
        for name, line in first.items():
            if name in BUILT:
                self.assertEqual(line, whole[name])
                continue
            self.assertIn("(not built yet: scripts/build)", line)
            for arguments in ([], ["bap63_rated", "--out", "there", "--vary", "pump.tilt_deg=20:40:5", "-x"]):
                result = self.run_program(FIRST, name, *arguments, status=BAD_INPUT)
                self.assertEqual(result.stderr, f"bentaxis: {name} is not built yet: run scripts/build (it takes some minutes)\n")
        self.assertEqual(list(self.folder.iterdir()), [])
        for name in BUILT:
            self.assertIn(name, first)

    def test_refuses_what_the_others_would_add_to_a_comparison(self):
        for option, value in (("--with", REPO / "reference_data" / "high_precision" / "bap63_rated"),
                              ("--engine", "mujoco"), ("--uncertainty", 100)):
            result = self.run_program(FIRST, "compare", "bap63_rated", option, value, status=BAD_INPUT)
            self.assertEqual(result.stderr, f"bentaxis: {option} is not built yet: run scripts/build (it takes some minutes)\n")
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    FIRST, WHOLE, REPO = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
    del sys.argv[1:4]
    unittest.main()
