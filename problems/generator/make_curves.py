#!/usr/bin/env python3
"""Curves, known mistakes and checks of the problem set, made from each problem.toml.

    make_curves.py [NAME ..]            make the files of these problems (default: all)
    make_curves.py --check [NAME ..]    compute a few angles anew and compare with the files
    make_curves.py --pages [NAME ..]    write the tables of problem.md from the files

Files of a problem:
  curves.csv    every column at every angle, 40 digits, from the closed form with 50 (closed_forms.py)
  mistakes.csv  the columns that each known mistake changes, at every fifth angle, 17 digits: KEY:COLUMN
  checks.csv    of each column: peak of its vector, digits to which the second derivation agrees, spread from inputs that
                are changed by 2 ulp of a double, tolerance, and the margin between spread and tolerance in decades

The second derivation (programs/multiplier_models.py, 60 digits) must agree to the digits that problem.toml states, at
every angle that is computed; otherwise nothing is written. Needs Python 3.11, numpy and mpmath.
"""
import argparse
import csv
import math
import multiprocessing
import sys
from fractions import Fraction
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "programs")]

from mpmath import mp, mpf  # noqa: E402

import closed_forms  # noqa: E402
import multiplier_models  # noqa: E402
from multipliers import Numbers  # noqa: E402
from problem_data import FOLDER, data_of, grid_of, settings_of  # noqa: E402

FIRST_DPS, SECOND_DPS, WRITTEN, MISTAKE_DIGITS, MISTAKE_STEP = 50, 60, 40, 17, 5
CHECK_STEP = 97  # rows between those of --check; twice that for whole pumps
ULPS = 2


class Disagreement(Exception):
    pass


def data(name, settings, changed=None):
    number = Numbers(mp)
    result = data_of(number, settings, changed)
    result.name = name
    if hasattr(result, "case"):
        result.case_path = FOLDER / name / result.case
        if changed and "." in changed[0]:
            result.case_object = lambda: changed_case(result.case_path, *changed)
    return result


def changed_case(path, key, factor):
    import make_reference
    case = make_reference.Case(path)
    setattr(case, key.split(".")[1], getattr(case, key.split(".")[1]) * factor)
    return case


def closed_form(name, settings, xs, wrong="", changed=None):
    solve = getattr(closed_forms, name)
    if name == "impacts":
        return solve(data(name, settings, changed), xs, wrong)
    d = data(name, settings, changed)
    return [solve(d, x, wrong) for x in xs]


def second_derivation(job):
    name, settings, xs = job
    mp.dps = SECOND_DPS
    try:
        rows = multiplier_models.rows_of(Numbers(mp), name, settings, xs)
    finally:
        mp.dps = FIRST_DPS
    return [{key: +value for key, value in row.items()} for row in rows]


def inputs_of(name, settings):
    """Names of the numbers that a spread comes from: those of [data], or of the case."""
    if "case" not in settings["data"]:
        return [key for key, value in settings["data"].items() if not isinstance(value, (str, int))]
    import make_reference
    case = make_reference.Case(FOLDER / name / settings["data"]["case"])
    return ["case." + key for key, value in vars(case).items()
            if isinstance(value, mpf) and value != 0 and key not in ("samples",)]


def vectors(settings):
    groups = {}
    for column in settings["column"]:
        groups.setdefault(column["vector"], []).append(column["name"])
    return groups


def peaks(settings, rows):
    return {name: max(mp.sqrt(sum(row[n] ** 2 for n in names)) for row in rows)
            for names in vectors(settings).values() for name in names}


def largest(settings, one, two, peak):
    """Largest difference of each column over the peak of its vector."""
    return {c["name"]: max(abs(a[c["name"]] - b[c["name"]]) for a, b in zip(one, two)) / peak[c["name"]] for c in settings["column"]}


def digits(difference):
    return WRITTEN if difference == 0 else min(WRITTEN, math.floor(float(-mp.log10(difference))))


def agree(name, settings, xs, rows, second):
    """Digits to which both derivations agree. @raises Disagreement below those of problem.toml"""
    names = [c["name"] for c in settings["column"]]
    for row in (rows[0], second[0]):
        if list(row) != names:
            raise Disagreement(f"{name}: columns {list(row)} are not those of problem.toml")
    known = {key: digits(d) for key, d in largest(settings, rows, second, peaks(settings, rows)).items()}
    for key, value in known.items():
        if value < settings["digits"]:
            raise Disagreement(f"{name}: {key}: the second derivation agrees to {value} digits, {settings['digits']} are stated")
    return known


def text(x, count=WRITTEN):
    return mp.nstr(x, count, min_fixed=0, max_fixed=0) if x else "0"


def write(path, header, rows):
    path.write_text("\n".join([",".join(header)] + [",".join(row) for row in rows]) + "\n")


def make(name, pool):
    settings = settings_of(name)
    xs, over = grid_of(settings), settings["grid"]["column"]
    rows = closed_form(name, settings, xs)
    if name == "impacts":
        second = second_derivation((name, settings, xs))
    else:
        parts = [xs[i::8] for i in range(8)]
        answers = pool.map(second_derivation, [(name, settings, part) for part in parts])
        by_x = {x: row for part, answer in zip(parts, answers) for x, row in zip(part, answer)}
        second = [by_x[x] for x in xs]
    known = agree(name, settings, xs, rows, second)
    peak = peaks(settings, rows)

    few = range(0, len(xs), 30)
    spread = {c["name"]: mpf(0) for c in settings["column"]}
    some_xs = xs if name == "impacts" else [xs[i] for i in few]
    some = rows if name == "impacts" else [rows[i] for i in few]
    for key in inputs_of(name, settings):
        moved = closed_form(name, settings, some_xs, changed=(key, 1 + ULPS * mpf(2) ** -52))
        for column, d in largest(settings, some, moved, peak).items():
            spread[column] += d

    every = range(0, len(xs), MISTAKE_STEP)
    header, columns = [over], [[repr(float(xs[i])) for i in every]]
    for mistake in settings["mistake"]:
        wrong = closed_form(name, settings, [xs[i] for i in every] if name != "impacts" else xs, mistake["key"])
        wrong = wrong if name != "impacts" else [wrong[i] for i in every]
        right = [rows[i] for i in every]
        found = False
        for column, d in largest(settings, right, wrong, peak).items():
            if d < mpf("1e-6"):
                continue
            found = True
            header.append(f"{mistake['key']}:{column}")
            columns.append([text(row[column], MISTAKE_DIGITS) for row in wrong])
        if not found:
            raise Disagreement(f"{name}: mistake {mistake['key']} changes no column")
    folder = FOLDER / name
    write(folder / "curves.csv", [over] + [c["name"] for c in settings["column"]],
          [[repr(float(x))] + [text(row[c["name"]]) for c in settings["column"]] for x, row in zip(xs, rows)])
    write(folder / "mistakes.csv", header, zip(*columns))
    tolerance = Fraction(settings["tolerance"])
    tolerance = mpf(tolerance.numerator) / tolerance.denominator
    checks = []
    for c in settings["column"]:
        s = spread[c["name"]]
        margin = mp.nstr(mp.log10(tolerance / s), 3) if s else ""
        checks.append([c["name"], text(peak[c["name"]], 17), str(known[c["name"]]), mp.nstr(s, 3), mp.nstr(tolerance, 3), margin])
    write(folder / "checks.csv", ["column", "peak", "digits", "spread_2ulp", "tolerance", "margin_decades"], checks)
    page(name)
    print(f"{name}: {len(settings['column'])} columns at {len(xs)} angles, agree to {min(known.values())} digits, "
          f"spread {mp.nstr(max(spread.values()), 2)}, {len(settings['mistake'])} mistakes", flush=True)


def short(x):
    return mp.nstr(mpf(x), 6)


def stored(name, file):
    with open(FOLDER / name / file, newline="") as stream:
        return list(csv.DictReader(stream))


def page(name):
    """Tables of problem.md between their marks, from the files."""
    settings, path = settings_of(name), FOLDER / name / "problem.md"
    over = settings["grid"]["column"]
    curves = {row[over]: row for row in stored(name, "curves.csv")}
    wrong_rows, checks = stored(name, "mistakes.csv"), stored(name, "checks.csv")
    peak = {row["column"]: mpf(row["peak"]) for row in checks}
    asked = ["| column | meaning | on | by | at | frame |", "|---|---|---|---|---|---|"]
    asked += [f"| `{c['name']}` | {c['meaning']} | {c.get('on', '')} | {c.get('by', '')} | {c.get('at', '')} | {c.get('frame', '')} |"
              for c in settings["column"]]
    known = ["| column | peak | digits | spread from 2 ulp | tolerance | margin, decades |", "|---|---|---|---|---|---|"]
    known += [f"| `{row['column']}` | {short(row['peak'])} | {row['digits']} | {row['spread_2ulp']} | {row['tolerance']} | {row['margin_decades']} |"
              for row in checks]
    wrong = [f"| mistake | column that shows it most | {over} | right | wrong |", "|---|---|---|---|---|"]
    for mistake in settings["mistake"]:
        def difference(place):
            row, column = place
            return abs(mpf(row[f"{mistake['key']}:{column}"]) - mpf(curves[row[over]][column])) / peak[column]

        changed = [c["name"] for c in settings["column"] if f"{mistake['key']}:{c['name']}" in wrong_rows[0]]
        row, column = max(((row, column) for row in wrong_rows for column in changed), key=difference)
        wrong.append(f"| {mistake['says']} | `{column}` | {float(row[over]):g} | {short(curves[row[over]][column])} "
                     f"| {short(row[mistake['key'] + ':' + column])} |")
    content = path.read_text()
    for mark, lines in (("asked", asked), ("known", known), ("mistakes", wrong)):
        begin, end = f"<!-- {mark}: written by generator/make_curves.py -->", f"<!-- end of {mark} -->"
        if begin not in content or end not in content:
            raise Disagreement(f"{path}: has no place for the table \"{mark}\"")
        before, rest = content.split(begin)
        content = before + begin + "\n" + "\n".join(lines) + "\n" + end + rest.split(end)[1]
    if content != path.read_text():
        path.write_text(content)
        return True
    return False


def check(name):
    """A few angles anew, both derivations, against the files."""
    settings = settings_of(name)
    xs = grid_of(settings)
    chosen = range(0, len(xs), CHECK_STEP if "case" not in settings["data"] else 2 * CHECK_STEP)
    curves = stored(name, "curves.csv")
    if len(curves) != len(xs):
        raise Disagreement(f"{name}: curves.csv has {len(curves)} rows, not {len(xs)}")
    chosen = range(len(xs)) if name == "impacts" else chosen
    rows = closed_form(name, settings, [xs[i] for i in chosen])
    agree(name, settings, xs, rows, second_derivation((name, settings, [xs[i] for i in chosen])))
    peak = {row["column"]: mpf(row["peak"]) for row in stored(name, "checks.csv")}
    held = [{c["name"]: mpf(curves[i][c["name"]]) for c in settings["column"]} for i in chosen]
    for key, d in largest(settings, rows, held, peak).items():
        if digits(d) < min(settings["digits"], WRITTEN - 1):
            raise Disagreement(f"{name}: {key}: curves.csv agrees with the closed form to {digits(d)} digits only")
    if page(name):
        raise Disagreement(f"{name}: the tables of problem.md were not those of the files; they are written anew")
    print(f"ok {name}: {len(rows)} angles", flush=True)


def main():
    parser = argparse.ArgumentParser(description="Curves of the problem set.")
    parser.add_argument("names", nargs="*", help="problems (default: all)")
    parser.add_argument("--check", action="store_true", help="compute a few angles anew and compare with the files")
    parser.add_argument("--pages", action="store_true", help="write the tables of problem.md from the files")
    parser.add_argument("--jobs", type=int, default=2, help="processes (default 2)")
    options = parser.parse_args()
    mp.dps = FIRST_DPS
    names = options.names or sorted(p.parent.name for p in FOLDER.glob("*/problem.toml"))
    try:
        if options.check or options.pages:
            for name in names:
                (check if options.check else page)(name)
        else:
            with multiprocessing.Pool(options.jobs) as pool:
                for name in names:
                    make(name, pool)
    except (Disagreement, ValueError, OSError, KeyError) as error:
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
