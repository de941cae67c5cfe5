"""All problems with numpy alone: rigid bodies, constraints, Lagrange multipliers, doubles.

    python3 numpy_multipliers.py NAME -o FILE.csv     then: bentaxis score FILE.csv --problem NAME
    python3 numpy_multipliers.py --list

A template: replace rows_of() by what your engine computes, one dictionary of columns for each value of the grid.
Needs Python 3.11 and numpy.
"""
import argparse

import numpy

from multiplier_models import MODELS, rows_of
from multipliers import Numbers
from problem_data import grid_of, settings_of, write_table


def main():
    parser = argparse.ArgumentParser(description="Solve a problem of the problem set with numpy.")
    parser.add_argument("name", nargs="?", choices=sorted(MODELS), metavar="NAME")
    parser.add_argument("-o", "--out", metavar="FILE")
    parser.add_argument("--list", action="store_true", help="print the problems that it solves")
    parser.add_argument("--version", action="version", version=f"numpy {numpy.__version__}")
    options = parser.parse_args()
    if options.list:
        print("\n".join(sorted(MODELS)))
        return
    if not options.name or not options.out:
        parser.error("NAME and -o FILE are needed")
    settings = settings_of(options.name)
    xs = grid_of(settings)
    rows = rows_of(Numbers(), options.name, settings, xs)
    write_table(options.out, settings["grid"]["column"], xs, rows, text=lambda x: repr(float(x)))


if __name__ == "__main__":
    main()
