#!/usr/bin/env python3
"""Makes the folders of reference_data/hard from its catalogue: case, high-precision curve.

    make_hard_cases.py [NAME ...]   write the cases of these names (default: those that are missing or out of date)
    make_hard_cases.py --check      recompute everything and compare; exit status 1 where a folder is out of date

A case is the text of the base case with the catalogue's keys set to other values; its curve is made_reference's.
"""
import argparse
import multiprocessing
import os
import re
import sys
import tomllib
from pathlib import Path

import make_reference

FOLDER = Path(__file__).resolve().parent.parent / "hard"


def toml(value):
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list):
        return "[" + ", ".join(toml(v) for v in value) + "]"
    return repr(value)


def case_text(catalogue, entry):
    """The base case with a header of its own and the entry's keys changed; comments go."""
    base = (FOLDER / catalogue["base"]).read_text().splitlines()
    change = dict(entry["change"])
    change.setdefault("operation.samples_per_revolution", catalogue["samples_per_revolution"])
    lines, table, left = [], "", dict(change)

    def rest_of(table):
        for name in [n for n in left if n.rpartition(".")[0] == table]:
            lines.append(f"{name.rpartition('.')[2]} = {toml(left.pop(name))}")

    for line in base:
        line = re.sub(r"\s*#.*$", "", line)
        if not line.strip():
            continue
        heading = re.fullmatch(r"\[(.+)\]", line)
        if heading:
            rest_of(table)
            table = heading[1]
            lines += ["", line]
            continue
        key = line.split("=")[0].strip()
        name = f"{table}.{key}" if table else key
        if name == "name":
            line = f'name = "{entry["name"]}"'
        elif name in left:
            line = f"{key} = {toml(left.pop(name))}"
        lines.append(line)
    rest_of(table)
    if left:
        raise SystemExit(f"{entry['name']}: no table for {', '.join(left)}")
    return "# Made by generator/make_hard_cases.py from catalogue.toml.\n" + "\n".join(lines) + "\n"


def files_of(catalogue, entry):
    """The case as it should be."""
    return {"case.toml": case_text(catalogue, entry)}


def current(catalogue, entry):
    folder = FOLDER / entry["name"]
    return (folder / "reference.csv").exists() and all(
        (folder / name).exists() and (folder / name).read_text() == text
        for name, text in files_of(catalogue, entry).items())


def make(job):
    catalogue, entry = job
    folder = FOLDER / entry["name"]
    folder.mkdir(exist_ok=True)
    for name, text in files_of(catalogue, entry).items():
        (folder / name).write_text(text)
    case = make_reference.Case(folder / "case.toml")
    make_reference.write_curve(case, make_reference.solve_curve(case), folder / "reference.csv")
    return entry["name"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    with open(FOLDER / "catalogue.toml", "rb") as stream:
        catalogue = tomllib.load(stream)
    entries = catalogue["case"]
    unknown = set(arguments.names) - {e["name"] for e in entries}
    if unknown:
        raise SystemExit(f"not in the catalogue: {', '.join(sorted(unknown))}")
    stray = {p.name for p in FOLDER.iterdir() if p.is_dir()} - {e["name"] for e in entries}
    status = 0
    for name in sorted(stray):
        print(f"{name}: not in the catalogue", file=sys.stderr)
        status = 1
    with multiprocessing.Pool(min(2, os.cpu_count() or 1)) as pool:
        if arguments.check:
            old = [e["name"] for e in entries if not current(catalogue, e)]
            for name in old:
                print(f"{name}: case or curve is missing or out of date", file=sys.stderr)
            jobs = [(e["name"], FOLDER / e["name"] / "case.toml", FOLDER / e["name"] / "reference.csv")
                    for e in entries if e["name"] not in old]
            status = max(status, 1 if old else 0,
                         make_reference.report(pool.imap(make_reference.check, jobs), 1e-15))
        else:
            wanted = [e for e in entries if e["name"] in arguments.names
                      or (not arguments.names and not current(catalogue, e))]
            for name in pool.imap_unordered(make, [(catalogue, e) for e in wanted]):
                print("made", name, flush=True)
    return status


if __name__ == "__main__":
    sys.exit(main())
