#!/usr/bin/env python3
"""Tests of input files that are none: pipes, devices, directories, sizes without end, texts without depth, control characters.

usage: input_files_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import unittest

import command_line_test as base
from command_line_test import BAD_INPUT, CURVE, DONE, OUT_OF_TOLERANCE, Case, ProgramTest

DEEP = 50_000
LARGE = 2 << 30  # bytes, of a file without content


class InputTest(ProgramTest):
    def refused_with(self, words, *arguments):
        result = self.run_program(*arguments, status=BAD_INPUT)
        lines = [line for line in result.err.splitlines() if not line.startswith("pump: ")]
        self.assertEqual(len(lines), 1, result.err)
        self.assertLess(len(lines[0]), 1000)
        self.assert_mentions(lines[0], *words)
        return lines[0]

    def readers(self, file):
        """Every way in for a file: a name and a command that reads it."""
        rated = base.REPO / "cases" / "bap63_rated.toml"
        Case(**{"pressure.kind": '"curve"', "pressure.file": f'"{file}"'}).write(self.folder / "curve_case.toml")

        def with_key(name, shipped, table, line):
            text = (base.REPO / "cases" / shipped).read_text()
            text = re.sub(rf"^{line.split()[0]} = .*\n", "", text, flags=re.M)
            self.assertIn(f"[{table}]\n", text)
            (self.folder / name).write_text(text.replace(f"[{table}]\n", f"[{table}]\n{line}\n", 1))
        with_key("opening_case.toml", "bap63_rated_hydraulic.toml", "hydraulics", f'delivery_opening_file = "{file}"')
        with_key("stroke_case.toml", "bap63_rated_hydraulic.toml", "hydraulics", f'stroke_file = "{file}"')
        with_key("drive_case.toml", "bap63_start_up.toml", "drive", f'file = "{file}"')
        share = (base.REPO / "cases" / "bap63_load_step.toml").read_text().replace("curves/load_step_share.csv", str(file))
        (self.folder / "share_case.toml").write_text(share.replace("curves/", str(base.REPO / "cases" / "curves") + "/"))
        with_key("pitch_case.toml", "bap63_teeth.toml", "gear", f'pitch_error_file = "{file}"')
        return {
            "case": ("show", file),
            "case of a reference": ("reference", "new", file, "--from", file),
            "pressure curve": ("run", "curve_case.toml", "--model", "analytic", "--out", "out"),
            "opening": ("show", "opening_case.toml"),
            "stroke": ("show", "stroke_case.toml"),
            "drive": ("show", "drive_case.toml"),
            "share": ("show", "share_case.toml"),
            "pitch errors": ("show", "pitch_case.toml"),
            "states": ("run", rated, "--model", "analytic", "--states", file, "--out", "out"),
            "duty cycle": ("life", rated, "--duty", file, "--out", "out"),
            "record": ("reference", "new", rated, "--from", file, "--out", "ref"),
            "mapping": ("reference", "new", rated, "--from", base.REPO / "tests/imports/good/bench.csv", "--mapping", file, "--out", "ref"),
            "study": ("sweep", rated, "--study", file, "--out", "out"),
            "data": ("identify", rated, "--data", file, "--out", "out"),
            "published": ("pressure", base.REPO / "cases/bap63_rated_hydraulic.toml", "--published", file, "--out", "out"),
            "FMU": ("simulate", base.REPO / "cases/bap63_load_step.toml", "--fmu", file, "--out", "out"),
        }

    def try_all(self, file, *words):
        for name, command in self.readers(file).items():
            with self.subTest(name):
                self.refused_with([pathlib.Path(file).name, *words], *command)
                self.assertFalse((self.folder / "out").exists())
                self.assertFalse((self.folder / "ref").exists())


class KindTest(InputTest):
    def test_pipe(self):
        os.mkfifo(self.folder / "input.csv")  # nobody writes: whoever reads it waits for ever
        self.try_all(self.folder / "input.csv", "pipe")

    def test_device(self):
        self.try_all("/dev/zero", "device")

    def test_directory(self):
        (self.folder / "input.csv").mkdir()
        self.try_all(self.folder / "input.csv", "directory")

    def test_too_large(self):
        with (self.folder / "input.csv").open("wb") as file:
            file.truncate(LARGE)
        self.try_all(self.folder / "input.csv", "MiB")

    def test_standard_input_from_a_file(self):
        with (base.REPO / "cases" / "bap63_rated.toml").open() as file:
            result = subprocess.run([base.PROGRAM, "show", "/dev/stdin"], stdin=file, capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, DONE, result.stderr)
        result = subprocess.run([base.PROGRAM, "show", "/dev/stdin"], input="", capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, BAD_INPUT)
        self.assertIn("pipe", result.stderr)

    def test_index_passes_over_what_is_no_report(self):
        folder = self.folder / "reports"
        folder.mkdir()
        os.mkfifo(folder / "pipe.json")
        (folder / "deep.json").write_text("[" * 1_000_000)
        (folder / "closed.json").write_text("[" * 1_000_000 + "]" * 1_000_000)
        self.refused_with(["no report"], "index", folder)


class DepthTest(InputTest):
    TEXTS = {"dotted key": "a" + ".a" * DEEP + " = 1\n", "dotted table": "[a" + ".a" * DEEP + "]\n",
             "list": "a = " + "[" * DEEP + "]" * DEEP + "\n", "list without end": "a = " + "[" * DEEP,
             "inline table": "a = " + "{a=" * DEEP + "1" + "}" * DEEP + "\n",
             "both": "[a" + ".a" * 20 + "]\n" + "b" + ".b" * 20 + " = {" + "c" + ".c" * DEEP + " = 1}\n"}

    def test_deep(self):
        file = self.folder / "deep.toml"
        for name, text in self.TEXTS.items():
            file.write_text(text)
            with self.subTest(name):
                self.refused_with(["deep.toml:", "deep"], "show", file)
        for name in ("study", "data", "published"):
            with self.subTest(name):
                file.write_text(self.TEXTS["dotted key"])
                self.refused_with(["deep.toml:1:", "deep"], *self.readers(file)[name])
        for command in (("regress", "set"), ("reference", "update", "set")):
            folder = self.folder / "set" / "one"
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "description.toml").write_text(self.TEXTS["dotted key"])
            with self.subTest(command):
                result = self.run_program(*command, status=BAD_INPUT)
                self.assert_mentions(result.out + result.err, "description.toml:1", "deep")

    def test_deep_change(self):
        rated = base.REPO / "cases" / "bap63_rated.toml"
        for value in ("[" * 20_000 + "]" * 20_000, "{a" + ".a" * 20_000 + "=1}"):
            self.refused_with(["--set pump.tilt_deg", "deep"], "show", rated, "--set", "pump.tilt_deg=" + value)

    def test_what_people_write_is_not_deep(self):
        text = (base.REPO / "cases" / "bap63_rated.toml").read_text()
        text += "\n# " + "a." * 1000 + "\n" + "# " + "[" * 1000 + "\n"
        (self.folder / "case.toml").write_text(text)
        self.run_program("show", "case.toml")

    def test_long_list(self):
        long = "[" + ", ".join(["1.5"] * 200_000) + "]"
        Case(**{"port_plate.delivery_arc_deg": long}).write(self.folder / "case.toml")
        self.refused_with(["case.toml:", "200000 entries", "10000"], "show", "case.toml")
        Case(**{"port_plate.delivery_arc_deg": "[" + ", ".join(["1.5"] * 10_000) + "]"}).write(self.folder / "case.toml")
        self.refused_with(["delivery_arc_deg", "pair of numbers"], "show", "case.toml")


class CharacterTest(InputTest):
    ESCAPE = "\x1b[31m"

    def test_arguments(self):
        rated = base.REPO / "cases" / "bap63_rated.toml"
        for arguments in (("show", self.ESCAPE + ".toml"), ("run", rated, "--model", "analytic", "--out", "out" + self.ESCAPE),
                          ("show", rated, "--set", "pump.tilt_deg=" + self.ESCAPE), ("show", rated, "--set", "\u009b31m=1")):
            self.refused_with(["control character", "\\u00"], *arguments)

    def test_texts_of_a_case(self):
        for text in ('"a\\u0000b"', '"a\\u001b[31mb"', '"a\\u009b31mb"', '"a\\u007f"'):
            with self.subTest(text):
                Case(**{"pressure.kind": '"curve"', "pressure.file": text}).write(self.folder / "case.toml")
                self.refused_with(["case.toml:", "control character"], "show", "case.toml")
        (self.folder / "case.toml").write_text('"a\\u001b[31mb" = 1\n')
        self.refused_with(["case.toml:1", "control character"], "show", "case.toml")

    def test_names_of_columns(self):
        rated = base.REPO / "cases" / "bap63_rated.toml"
        bench = (base.REPO / "tests/imports/good/bench.csv").read_bytes()
        self.assertIn(b"Antriebsmoment", bench)
        file = self.folder / "record.csv"
        for name in (b"\x1b[31mMoment", b"\xc2\x9b31mMoment", b"Moment\x7f"):
            with self.subTest(name):
                file.write_bytes(bench.replace(b"Antriebsmoment", name))
                self.refused_with(["record.csv", "control character", "Moment"], "reference", "new", rated, "--from", file, "--out", "ref")
        (self.folder / "states.csv").write_bytes(b"theta_deg,\x1b[31mpsi_deg\n0,0\n")
        self.refused_with(["states.csv:1", "control character"], "run", rated, "--model", "analytic", "--states", "states.csv", "--out", "out")
        (self.folder / "states.csv").write_bytes(b"theta_deg,psi_deg\n0,\x1b[31m0\n")
        self.refused_with(["states.csv:2", "\\u001B"], "run", rated, "--model", "analytic", "--states", "states.csv", "--out", "out")
        (self.folder / "states.csv").write_bytes(b"theta_deg,psi_deg\n0,0\x00garbage\n")
        self.refused_with(["states.csv:2", "byte 0"], "run", rated, "--model", "analytic", "--states", "states.csv", "--out", "out")

    def test_windows_1252_becomes_utf8(self):
        """What regress reads is what reference new wrote."""
        bench = (base.REPO / "tests/imports/good/bench.csv").read_bytes()
        (self.folder / "record.csv").write_bytes(bench.replace(b"Antriebsmoment", "Drehmoment über".encode("cp1252")))
        self.run_program("reference", "new", base.REPO / "cases" / "bap63_rated.toml", "--from", "record.csv", "--accept", "--out", "ref")
        self.assertIn("Drehmoment über", (self.folder / "ref" / "description.toml").read_text())
        self.run_program("regress", "ref")

    def test_names_of_folders_and_reports(self):
        folder = self.folder / "set" / f"a{self.ESCAPE}"
        folder.mkdir(parents=True)
        (folder / "description.toml").write_text("schema = 1\n")
        self.refused_with(["control character", "\\u001B"], "regress", "set")
        self.run_program("compare", base.REPO / "cases" / "bap63_rated.toml", "--set", "operation.samples_per_revolution=36", "--out", "reports")
        report = json.loads((self.folder / "reports" / "report.json").read_text())
        report["verdict"]["headline"] = "headline" + self.ESCAPE
        (self.folder / "reports" / f"b{self.ESCAPE}.json").write_text(json.dumps(report))
        self.assertIn("headline\\u001B[31m", self.run_program("index", "reports").out)  # run_program holds that no escape is printed


class ReferenceTest(InputTest):
    """What regress refuses is not written."""

    BENCH = "tests/imports/good/bench.csv"

    def new(self, mapping, *words, record=None):
        (self.folder / "m.toml").write_text(mapping)
        rated = base.REPO / "cases" / "bap63_rated.toml"
        self.refused_with(["m.toml", *words], "reference", "new", rated, "--from", record or base.REPO / self.BENCH, "--mapping", "m.toml", "--out", "ref")
        self.assertEqual([file.name for file in self.folder.iterdir()], ["m.toml"])

    def test_mappings_that_regress_refuses(self):
        self.run_program("reference", "new", base.REPO / "cases" / "bap63_rated.toml", "--from", base.REPO / self.BENCH, "--out", "ref")
        good = (self.folder / "ref_mapping.toml").read_text()
        (self.folder / "ref_mapping.toml").unlink()
        self.new("foo = 1\n", "schema", "missing")
        self.new("", "schema")
        self.new(good.split("[[curve]]")[0], "[[curve]]")
        self.new(good.replace('file = "bench.csv"', 'file = "other.csv"'), "other.csv")
        self.new(good.replace("points = ", "points = 1"), "points")
        self.new(good.replace('theirs = "Antriebsmoment"', 'theirs = "Moment"'), "Moment")
        self.new(good.replace('case = "case.toml"', 'case = "none.toml"'), "none.toml")
        self.new(good.replace('kind = "external"', 'kind = "golden"'))
        # Maps nothing.
        header = good.split("[[curve.vector]]")[0].split("[[curve.column]]")[0].split("[curve.frame]")[0]
        names = [name for line in good.splitlines() if line.startswith("theirs") for name in json.loads(
            "[" + line.split("=", 1)[1].strip().strip("[]") + "]") if name]
        self.new(header.replace("ignore = [", "ignore = " + json.dumps(names, ensure_ascii=False)[:-1] + ", "), "nothing")

    def test_files_of_a_case_come_along(self):
        """A file of pitch errors is a file of the case too."""
        text = (base.REPO / "cases" / "bap63_teeth.toml").read_text()
        self.assertNotIn("pitch_error_file", text)
        teeth = int(re.search(r"^tooth_number = (\d+)", text, re.M)[1])
        (self.folder / "case.toml").write_text(text.replace("[gear]", '[gear]\npitch_error_file = "pitch.csv"', 1))
        (self.folder / "pitch.csv").write_text("tooth,shaft_um,block_um\n" + "".join(f"{i + 1},0,0\n" for i in range(teeth)))
        self.run_program("reference", "new", "case.toml", "--from", base.REPO / self.BENCH, "--accept", "--out", "ref")
        self.assertEqual((self.folder / "ref" / "pitch.csv").read_bytes(), (self.folder / "pitch.csv").read_bytes())


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    base.PROGRAM, base.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
