"""What the tests of the Python module share.

usage: X_test.py BENTAXIS REPO_ROOT [options of unittest], with the module in PYTHONPATH
"""

import csv
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy

import bentaxis

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
REPO = pathlib.Path(sys.argv[2]).resolve()
CASES = REPO / "cases"


def main():
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])


def columns_of(file):
    """A CSV file as arrays by name; empty fields are NaN."""
    with open(file, newline="", encoding="utf-8") as lines:
        header, *rows = csv.reader(lines)
    values = [[float(field) if field else numpy.nan for field in row] for row in rows]
    return dict(zip(header, numpy.array(values).T))


class ModuleTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def case(self, name="bap63_rated", **changes):
        """A shipped case; keywords are keys with "__" for the point."""
        return bentaxis.read_case(CASES / f"{name}.toml",
                                  {key.replace("__", "."): value for key, value in changes.items()})

    def run_program(self, *arguments, status=0):
        result = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(result.returncode, status, result.stderr)
        return result

    def refused(self, error, *arguments):
        """Calls the last argument: error expected; returns its text."""
        with self.assertRaises(error) as caught:
            arguments[-1]()
        return str(caught.exception)

    def assert_same(self, first, second):
        """Bit by bit, what was not computed too."""
        numpy.testing.assert_array_equal(numpy.asarray(first), numpy.asarray(second))

    def assert_close(self, first, second, tolerance, peak=None):
        """To rounding of the largest magnitude."""
        first, second = numpy.asarray(first), numpy.asarray(second)
        if peak is None:
            peak = numpy.nanmax(numpy.abs(second), initial=0)
        numpy.testing.assert_array_equal(numpy.isnan(first), numpy.isnan(second))
        worst = numpy.nanmax(numpy.abs(first - second), initial=0)
        self.assertLessEqual(worst, tolerance * max(peak, 1e-300))
