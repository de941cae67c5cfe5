#!/usr/bin/env python3
"""Tests of regress, of the reference commands and of the published table, from outside.

usage: regress_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import csv
import io
import json
import pathlib
import re
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree

import command_line_test as base
from command_line_test import BAD_INPUT, COMPUTATION_FAILED, DONE, OUT_OF_TOLERANCE, Case, ProgramTest

KINDS = ("high_precision", "published", "golden")


def change_csv(file, change):
    """Rewrites a CSV file: change(header, rows of text), both in place."""
    header, *rows = csv.reader(io.StringIO(file.read_text()))
    change(header, rows)
    file.write_text("".join(",".join(line) + "\n" for line in [header, *rows]))


def negated(text):
    return text[1:] if text.startswith("-") else "-" + text


class RegressTest(ProgramTest):
    def copy_of(self, name, folder="ref"):
        """A shipped reference under another name, to be spoilt."""
        return pathlib.Path(shutil.copytree(base.REPO / "reference_data" / name, self.folder / folder))

    def regress(self, *arguments, status=DONE):
        result = self.run_program("regress", *arguments, status=status)
        return result.out + result.err

    def junit(self, file):
        """Validates and reads a JUnit file; returns its outcomes by (suite, class name, name)."""
        subprocess.run(["xmllint", "--noout", "--schema", str(base.REPO / "tests" / "junit.xsd"), str(file)],
                       check=True, stderr=subprocess.PIPE)
        root = xml.etree.ElementTree.parse(file).getroot()
        outcomes = {}
        for suite in root.findall("testsuite"):
            cases = suite.findall("testcase")
            self.assertEqual(len(cases), int(suite.get("tests")))
            for tag, count in (("failure", "failures"), ("error", "errors"), ("skipped", "skipped")):
                self.assertEqual(sum(c.find(tag) is not None for c in cases), int(suite.get(count)))
            for c in cases:
                outcomes[suite.get("name"), c.get("classname"), c.get("name")] = next(
                    (tag for tag in ("failure", "error", "skipped") if c.find(tag) is not None), "passed")
        for count in ("tests", "failures", "errors", "skipped"):
            self.assertEqual(int(root.get(count)), sum(int(s.get(count)) for s in root.findall("testsuite")))
        return outcomes


class ShippedDataTest(RegressTest):
    def test_all_agree(self):
        before = {p: p.read_bytes() for p in (base.REPO / "reference_data").rglob("*") if p.is_file()}
        out = self.regress("--junit", "j.xml", "--html", "r.html")
        self.assertNotIn("differs", out)
        outcomes = self.junit(self.folder / "j.xml")
        self.assertEqual({"passed", "skipped"}, set(outcomes.values()))
        for kind in KINDS:
            for folder in (base.REPO / "reference_data" / kind).iterdir():
                name = f"{kind}/{folder.name}"
                passed = [key for key, outcome in outcomes.items() if key[0] == name and outcome == "passed"]
                self.assertGreaterEqual(len(passed), 1 if kind == "published" else 18, name)
        self.assertEqual(before, {p: p.read_bytes() for p in before})

    def test_published_numbers_are_mentioned_where_there_are_any(self):
        self.assertIn("published numbers were read", self.regress())
        self.assertNotIn("published", self.regress(base.REPO / "reference_data" / "golden"))

    def test_worst_first(self):
        lines = [line for line in self.regress().splitlines() if line.startswith("agrees")]
        worst = []
        for line in lines:
            numbers = re.findall(r"\d\.\de[+-]\d\d", line)  # both models' differences, the tolerance
            worst.append(max(float(n) for n in numbers[:-1]) / float(numbers[-1]))
        self.assertGreater(len(worst), 100)
        # Two digits are printed.
        self.assertTrue(all(a >= 0.9 * b for a, b in zip(worst, worst[1:])), worst[:5])

    def test_every_shipped_case_has_golden_curves(self):
        held = {str((f.parent / re.search(r'^case = "(.*)"', f.read_text(), re.M)[1]).resolve())
                for f in (base.REPO / "reference_data" / "golden").glob("*/description.toml")}
        for case in (base.REPO / "cases").glob("*.toml"):
            text = case.read_text()
            # With oil they have no turn at constant speed: transfer_command_test holds the motion.
            if "[pump]" in text and not ('kind = "pistons"' in text and 'kind = "hydraulic"' in text):
                self.assertIn(str(case.resolve()), held, "bentaxis reference golden CASE --out reference_data/golden/..")

    def test_filter(self):
        out = self.regress("--filter", "offset_nine")
        self.assertIn("offset_nine", out)
        self.assertNotIn("bap63", out)
        self.assert_mentions(self.refused("regress", "--filter", "nothing like it"), "nothing like it")

    def test_page_without_failures(self):
        self.regress("--filter", "reversed", "--html", "pages/r.html")
        self.assertIn("high_precision/reversed", (self.folder / "pages" / "r.html").read_text())


class NegativeControlTest(RegressTest):
    """What is wrong is caught, named, and exits as documented."""

    def spoilt(self, change, status, *words, name="high_precision/bap63_rated"):
        folder = self.copy_of(name)
        change(folder)
        out = self.regress("ref", "--junit", "j.xml", "--html", "r.html", status=status)
        outcomes = self.junit(self.folder / "j.xml")
        self.assertIn("failure" if status == OUT_OF_TOLERANCE else "error", outcomes.values())
        self.assert_mentions(out, *words)
        page = (self.folder / "r.html").read_text()
        if status == OUT_OF_TOLERANCE:
            self.assertIn('"id":"fail-1"', page)
        shutil.rmtree(folder)
        return out

    def spoilt_curve(self, change, status, *words, **options):
        return self.spoilt(lambda folder: change_csv(folder / "reference.csv", change), status, *words, **options)

    def test_unspoilt(self):
        self.copy_of("high_precision/bap63_rated")
        self.regress("ref")

    def test_parameter_off_by_a_millionth_in_the_case_of_one_model(self):
        for base_case, names in self.controls():
            Case(**base_case).write(self.folder / "case.toml")
            if not (self.folder / "golden").exists():
                (self.folder / "golden").mkdir()
            shutil.rmtree(self.folder / "golden")
            self.run_program("reference", "golden", "case.toml", "--out", "golden")
            description = self.folder / "golden" / "description.toml"
            text = description.read_text()
            description.write_text(text.replace("samples_per", 'multibody_case = "other.toml"\nsamples_per'))
            other = self.folder / "golden" / "other.toml"
            Case(**base_case).write(other)
            self.regress("golden")
            for name in sorted(names):
                value = json.loads(Case(**base_case).get(name))
                pair = isinstance(value, list)
                for i in range(2 if pair else 1):
                    changed = ([v * (1 + 1e-6 * (i == j)) for j, v in enumerate(value)] if pair
                               else value * (1 + 1e-6))
                    with self.subTest(name, changed=changed):
                        Case(**base_case).set({name: changed}).write(other)
                        self.regress("golden", status=OUT_OF_TOLERANCE)

    def test_parameter_off_by_a_millionth_in_one_case_file(self):
        def change(folder):
            text = (folder / "case.toml").read_text()
            (folder / "other.toml").write_text(text.replace("mass_kg = 0.09\n", "mass_kg = 0.09000009\n"))
            d = folder / "description.toml"
            d.write_text(d.read_text().replace('case = "case.toml"',
                                               'case = "case.toml"\nmultibody_case = "other.toml"'))
        out = self.spoilt(change, OUT_OF_TOLERANCE, "differs", "Rs")
        outcomes = self.junit(self.folder / "j.xml")
        failed = {key[1] for key, outcome in outcomes.items() if outcome == "failure"}
        self.assertEqual(failed, {"ref.multibody"}, out)

    def test_sign_flipped(self):
        def change(header, rows):
            column = header.index("Rcs_z4_N")
            for row in rows:
                row[column] = negated(row[column])
        self.spoilt_curve(change, OUT_OF_TOLERANCE, "Rcs_z4_N", "opposite sign")

    def test_columns_swapped(self):
        def change(header, rows):
            a, b = header.index("Rb1_x1_N"), header.index("Rb1_y1_N")
            header[a], header[b] = header[b], header[a]
        out = self.spoilt_curve(change, OUT_OF_TOLERANCE, "Rb1_y1_N", "has this curve as")
        self.assertIn("differs", out)

    def test_shifted_by_half_a_degree(self):
        def change(header, rows):
            for row in rows:
                row[0] = str(float(row[0]) + 0.5)
        self.spoilt_curve(change, OUT_OF_TOLERANCE, "differs", "shifted by about -0.50 deg")

    def test_rows_missing(self):
        self.spoilt_curve(lambda header, rows: rows.pop(), BAD_INPUT, "reference.csv", "71 rows", "truncated")

    def test_cut_within_a_row(self):
        def change(folder):
            file = folder / "reference.csv"
            file.write_bytes(file.read_bytes()[:-300])
        self.spoilt(change, BAD_INPUT, "reference.csv:73:", "fields")

    def test_cut_within_the_last_number(self):
        def change(folder):
            file = folder / "reference.csv"
            file.write_bytes(file.read_bytes()[:-6])  # what is left is a number
        self.spoilt(change, BAD_INPUT, "reference.csv", "truncated")

    def test_not_a_number(self):
        def change(header, rows):
            rows[10][header.index("Td_z1_Nm")] = "nan"
        self.spoilt_curve(change, BAD_INPUT, "reference.csv:12:", "Td_z1_Nm", "nan")

    def test_empty_field(self):
        def change(header, rows):
            rows[10][header.index("Td_z1_Nm")] = ""
        folder = self.copy_of("high_precision/bap63_rated")
        change_csv(folder / "reference.csv", change)
        self.assert_mentions(self.regress("ref", status=OUT_OF_TOLERANCE), "incomplete", "Td_z1_Nm", "gaps")

    def test_unused_file(self):
        self.spoilt(lambda folder: (folder / "old.csv").write_text("x\n"), BAD_INPUT, "old.csv", "is not used")

    def test_unused_file_above_the_cases(self):
        self.copy_of("high_precision", "all")
        (self.folder / "all" / "stray.csv").write_text("x\n")
        self.assert_mentions(self.refused("regress", "all"), "stray.csv", "is not used")

    def test_a_proposal_of_reference_new_may_stand_beside_the_reference(self):
        self.copy_of("high_precision/bap63_rated", "all/high_precision/bap63_rated")
        (self.folder / "all" / "rig_mapping.toml").write_text("x\n")
        self.regress("all", status=DONE)

    def test_unused_column(self):
        def change(header, rows):
            header[header.index("Td_z1_Nm")] = "Td"
        self.spoilt_curve(change, BAD_INPUT, '"Td"', "is not used")

    def test_reaction_taken_out_of_a_complete_reference(self):
        def change(header, rows):
            column = header.index("Td_z1_Nm")
            for line in [header, *rows]:
                line.pop(column)
        folder = self.copy_of("high_precision/bap63_rated")
        change_csv(folder / "reference.csv", change)
        self.assert_mentions(self.regress("ref", status=OUT_OF_TOLERANCE), "incomplete", "Td_z1_Nm", "does not have it")

    def test_curve_that_is_not_there(self):
        self.spoilt(lambda folder: (folder / "reference.csv").unlink(), BAD_INPUT, "reference.csv", "no such file")

    def test_description(self):
        def edit(old, new):
            def change(folder):
                d = folder / "description.toml"
                text = d.read_text()
                self.assertIn(old, text)
                d.write_text(text.replace(old, new))
            return change
        for old, new, *words in (
                ("[tolerance]", "[tolerances]", "description.toml", "tolerance", "missing"),
                ("relative", "relatve", "description.toml", "[tolerance] relative", "missing"),
                ("relative = 1e-11", "relative = -1", "[tolerance] relative = -1"),
                ("digits = 20", 'digits = "20"', "digits", "integer"),
                ('kind = "high-precision"', 'kind = "high"', "kind", "golden"),
                ("points = 72", "points = 72\nmodel = 1", 'unknown key "model"', "models")):
            with self.subTest(new):
                self.spoilt(edit(old, new), BAD_INPUT, *words)

    def test_kind_must_fit_the_folder(self):
        """What is called golden could be rewritten: high-precision data cannot be made so by one word."""
        folder = self.copy_of("high_precision/bap63_rated", "high_precision/x")
        d = folder / "description.toml"
        d.write_text(d.read_text().replace('kind = "high-precision"', 'kind = "golden"'))
        self.assert_mentions(self.regress("high_precision", status=BAD_INPUT), "kind", "high-precision")
        self.refused("reference", "update", "high_precision")

    def test_bad_case(self):
        def change(folder):
            c = folder / "case.toml"
            c.write_text(c.read_text().replace("pistons = 5", "pistons = 0"))
        self.spoilt(change, BAD_INPUT, "case.toml", "pistons")

    def test_computation_that_fails(self):
        self.case()
        self.run_program("reference", "golden", "case.toml", "--out", "golden/a")
        self.case(**{"piston.mass_kg": 0.0})  # refused by the multibody model
        out = self.regress("golden", "--junit", "j.xml", status=COMPUTATION_FAILED)
        self.assert_mentions(out, "multibody", "mass", "1 could not be computed")
        self.assertIn("error", self.junit(self.folder / "j.xml").values())

    def test_other_cases_go_on_after_a_bad_one(self):
        self.copy_of("high_precision", "all")
        (self.folder / "all" / "bap63_rated" / "old.csv").write_text("x\n")
        out = self.regress("all", status=BAD_INPUT)
        self.assert_mentions(out, "old.csv", "11 agree", "1 cannot be used")


ADAMS_COLUMNS = {  # their name: (ours, factor)
    "JOINT_A1.FX": ("Rs_1_x2_N", -1e-3), "JOINT_A1.FY": ("Rs_1_y2_N", -1e-3), "JOINT_A1.FZ": ("Rs_1_z2_N", -1e-3),
    "BEARING_1.FX": ("Rb1_x1_N", -1e-3), "BEARING_1.FY": ("Rb1_y1_N", -1e-3), "BEARING_1.FZ": ("Rb1_z1_N", -1e-3),
    "MOTION.TZ": ("Td_z1_Nm", -1e3)}


class ForeignCurveTest(RegressTest):
    """A curve of another program, computed by the high-precision generator and written as that program would."""

    @classmethod
    def setUpClass(cls):
        cls.text = subprocess.run(
            [sys.executable, "-c",
             "import sys, pathlib, tempfile, subprocess\n"
             "d = pathlib.Path(tempfile.mkdtemp())\n"
             "t = pathlib.Path(sys.argv[1]).read_text().replace('samples_per_revolution = 720',"
             " 'samples_per_revolution = 400')\n"
             "(d / 'c.toml').write_text(t)\n"
             "subprocess.run([sys.executable, sys.argv[2], d / 'c.toml', '-o', d / 'c.csv'], check=True,"
             " stdout=subprocess.DEVNULL)\n"
             "print((d / 'c.csv').read_text(), end='')\n",
             str(base.REPO / "cases" / "bap63_rated.toml"),
             str(base.REPO / "reference_data" / "generator" / "make_reference.py")],
            check=True, stdout=subprocess.PIPE, text=True).stdout

    def adams_file(self):
        rows = list(csv.DictReader(io.StringIO(self.text)))
        self.assertEqual(len(rows), 400)
        # Their angle is zero a quarter turn before ours, and their record starts at their own zero.
        lines = []
        for row in rows:
            angle = (float(row["theta_deg"]) + 90) % 360
            lines.append((angle, [f"{angle:.4f}"] + [f"{factor * float(row[ours]):.6e}"
                                                     for ours, factor in ADAMS_COLUMNS.values()]
                          + [f"{angle / 9000:.7f}"]))
        header = ["ANGLE", *ADAMS_COLUMNS, "TIME"]
        text = "\n".join([",".join(header), *(",".join(fields) for _, fields in sorted(lines))])
        (self.folder / "adams.csv").write_text(text)  # without a final line end, as such tools do

    def described(self, **changes):
        """A folder made by the program, its description then written by hand."""
        settings = {"offset": -90.0, "sign": -1, "unit": "kN", "torque": "Nmm", "relative": 1e-3, **changes}
        shutil.rmtree(self.folder / "ref", ignore_errors=True)
        (self.folder / "ref").mkdir()
        shutil.copy(base.REPO / "cases" / "bap63_rated.toml", self.folder / "ref" / "case.toml")
        shutil.copy(self.folder / "adams.csv", self.folder / "ref")
        columns = "".join(
            f'[[curve.column]]\ntheirs = "{theirs}"\nours = "{ours}"\nsign = {settings["sign"]}\n'
            f'unit = "{settings["torque"] if ours.endswith("Nm") else settings["unit"]}"\n'
            for theirs, (ours, _) in ADAMS_COLUMNS.items())
        (self.folder / "ref" / "description.toml").write_text(
            'schema = 1\nkind = "external"\ncase = "case.toml"\nsource = "s"\nhow_made = "h"\n'
            'who_may_change = "w"\ndigits = 3\n'
            f'[tolerance]\nrelative = {settings["relative"]}\n'
            '[[curve]]\nfile = "adams.csv"\npoints = 400\nignore = ["TIME"]\n'
            f'[curve.angle]\ncolumn = "ANGLE"\noffset_deg = {settings["offset"]}\n{columns}')

    def test_mapping_alone(self):
        self.adams_file()
        self.described()
        out = self.regress("ref", "--junit", "j.xml")
        outcomes = self.junit(self.folder / "j.xml")
        by_group = {(key[1], key[2]): outcome for key, outcome in outcomes.items()}
        for model in ("ref.analytic", "ref.multibody"):
            for group in ("Rs", "Rb1", "Td"):
                self.assertEqual(by_group[model, group], "passed")
            for group in ("Rc", "Rb2", "Rcs", "Fh", "Th", "Rcn"):
                self.assertEqual(by_group[model, group], "skipped")
        self.assert_mentions(out, "the models are computed at the reference's own 400 angles", "missing     ref: no curve of Fh, Rb2, Rc, Rcn, Rcs", "27 of 30")
        # No more digits than the curve has.
        self.assertEqual(max(float(d) for d in re.findall(r"e-\d\d +(\d+\.\d) ", out)), 3.0)

    def test_wrong_mappings_are_noticed(self):
        self.adams_file()
        for changes, *words in (({"offset": 0.0}, "shifted by about"), ({"sign": 1}, "opposite sign"),
                                ({"unit": "N", "torque": "Nm"}, "times the reference"),
                                ({"offset": -90.5}, "differs"), ({"relative": 1e-7}, "differs")):
            with self.subTest(changes):
                self.described(**changes)
                self.assert_mentions(self.regress("ref", status=OUT_OF_TOLERANCE), *words)

    def test_unit_of_another_kind(self):
        self.adams_file()
        self.described(unit="bar")
        self.assert_mentions(self.regress("ref", status=BAD_INPUT), "unit", "cannot become N")

    def test_time_column_and_repeated_end(self):
        self.adams_file()
        self.described()
        d = self.folder / "ref" / "description.toml"
        d.write_text(d.read_text().replace('column = "ANGLE"', 'column = "TIME"\nunit = "s"')
                     .replace('ignore = ["TIME"]', 'ignore = ["ANGLE"]').replace("points = 400", "points = 401"))
        curve = self.folder / "ref" / "adams.csv"
        first = curve.read_text().splitlines()[1].split(",")
        curve.write_text(curve.read_text() + "\n" + ",".join(first[:-1] + ["0.0400000"]) + "\n")
        self.regress("ref")
        spoilt = [*first[:-1], "0.0400000"]
        spoilt[1] = "5.0"
        curve.write_text("\n".join([*curve.read_text().splitlines()[:-1], ",".join(spoilt)]) + "\n")
        self.assert_mentions(self.regress("ref", status=BAD_INPUT), "JOINT_A1.FX", "not periodic")

    def test_half_a_turn_is_refused(self):
        self.adams_file()
        self.described()
        curve = self.folder / "ref" / "adams.csv"
        curve.write_text("\n".join(curve.read_text().splitlines()[:201]) + "\n")
        d = self.folder / "ref" / "description.toml"
        d.write_text(d.read_text().replace("points = 400", "points = 200"))
        self.assert_mentions(self.regress("ref", status=BAD_INPUT), "adams.csv", "no points between")

    def test_new_guesses_and_its_folder_runs(self):
        header, *rows = csv.reader(io.StringIO(self.text))
        keep = [header.index(name) for name in ("theta_deg", "Rb1_x1_N", "Rb1_y1_N", "Td_z1_Nm", "Fh_z2_N")]
        names = ["Theta [deg]", "Rb1.x1 [kN]", "Rb1.y1 [kN]", "Torque [Nm]", "film"]
        factors = [1, 1e-3, 1e-3, 1, 1]
        lines = [",".join(names)] + [",".join(f"{f * float(row[i]):.6g}" for f, i in zip(factors, keep))
                                     for row in rows]
        (self.folder / "rig.csv").write_text("\n".join(lines) + "\n")
        # What the case reads goes with it, used in a turn at constant speed or not.
        (self.folder / "pump.toml").write_text((base.REPO / "cases" / "bap63_rated.toml").read_text() +
                                               '\n[drive]\nfile = "speed.csv"\nduration_s = 0.1\nsamples = 2\n')
        (self.folder / "speed.csv").write_text("time_s,speed_rpm\n0,1500\n1,1500\n2,1500\n3,1500\n")
        out = self.run_program("reference", "new", "pump.toml", "--from", "rig.csv", "--out", "mine", "--accept").out
        self.assertIn("4 of 4 columns", out)
        self.assertEqual({p.name for p in (self.folder / "mine").iterdir()},
                         {"case.toml", "rig.csv", "description.toml", "speed.csv"})
        self.assertIn('theirs = "film"', (self.folder / "mine" / "description.toml").read_text())
        out = self.regress("mine")
        self.assert_mentions(out, "Rb1", "Td", "Fh", "missing     mine: no curve of Rb2", "assumed")
        self.assert_mentions(self.refused("reference", "new", "pump.toml", "--from", "rig.csv", "--out", "mine",
                                          "--accept"), "mine", "not empty")

    def test_steep_edge_within_a_tube(self):
        """A pressure edge half a degree off fails at its flank, and passes in a tube of one degree: but for what the curve goes on by
        until the later edge, 2.5 % of the peak of yh."""
        case = Case(**{"operation.samples_per_revolution": 360, "pressure.transition_deg": 4.0})
        case.write(self.folder / "case.toml")
        self.run_program("reference", "golden", "case.toml", "--angles", "720", "--out", "ref")
        d = self.folder / "ref" / "description.toml"
        text = d.read_text().replace('kind = "golden"', 'kind = "external"').replace("1e-11", "3e-2")
        text = text.replace("samples_per_revolution = 720", "samples_per_revolution = 360")
        case.set({"pressure.delivery_start_deg": 180.5}).write(self.folder / "case.toml")
        d.write_text(text)
        self.regress("ref", status=OUT_OF_TOLERANCE)
        d.write_text(text.replace("relative = 3e-2", "relative = 3e-2\ntube_deg = 1.0"))
        self.regress("ref")
        case.set({"pressure.delivery_start_deg": 182.0}).write(self.folder / "case.toml")
        self.regress("ref", status=OUT_OF_TOLERANCE)


class GoldenTest(RegressTest):
    def test_update_says_what_changed(self):
        self.case()
        self.run_program("reference", "golden", "case.toml", "--out", "golden/a")
        self.regress("golden")
        before = self.contents()
        self.assertIn("unchanged", self.run_program("reference", "update", "golden").out)
        self.assertEqual(self.contents(), before)
        self.case(**{"piston.mass_kg": 0.1})
        self.regress("golden", status=OUT_OF_TOLERANCE)
        out = self.run_program("reference", "update", "golden").out
        self.assert_mentions(out, "a: rewritten", "analytic.csv", "multibody.csv", "of peak", "Rs_", "1 of 1")
        self.regress("golden")

    def test_other_kinds_are_never_written(self):
        self.copy_of("high_precision", "set/high_precision")
        self.copy_of("published", "set/published")
        self.case()
        self.run_program("reference", "golden", "case.toml", "--out", "set/golden/a")
        case = self.folder / "set" / "high_precision" / "bap63_rated" / "case.toml"
        case.write_text(case.read_text().replace("mass_kg = 0.09", "mass_kg = 0.08"))
        before = self.contents()
        self.assertIn("13 others", self.run_program("reference", "update", "set").out)
        for kind in ("high_precision", "published"):
            line = self.refused("reference", "update", f"set/{kind}")
            self.assert_mentions(line, f"no golden curves; {kind.replace('_', '-')} data are never written")
        self.assertEqual(self.contents(), before)

    def test_a_golden_curve_has_our_columns(self):
        self.case()
        self.run_program("reference", "golden", "case.toml", "--out", "golden")
        description = self.folder / "golden" / "description.toml"
        description.write_text(description.read_text() + '\n[[curve.column]]\ntheirs = "Td_z1_Nm"\nours = "Td_z1_Nm"\nunit = "Nm"\n')
        self.assert_mentions(self.refused("reference", "update", "golden"), "multibody.csv", "has our columns")

    def test_golden_needs_a_new_folder(self):
        self.case()
        self.copy_of("high_precision/reversed", "old")
        self.assert_mentions(self.refused("reference", "golden", "case.toml", "--out", "old"), "not empty")


class PublishedTest(RegressTest):
    def section(self, case):
        case.write(self.folder / "case.toml")
        self.run_program("compare", "case.toml", "--out", "out")
        return json.loads((self.folder / "out" / "report.json").read_text())["published"]

    def rows(self, section, **fields):
        return [r for r in section["rows"] if all(str(v) in str(r[k]) for k, v in fields.items())]

    def test_rated_case(self):
        section = self.section(Case(**{"operation.samples_per_revolution": 720, "name": '"mine"'}))
        verdict = lambda **fields: [r["verdict"] for r in self.rows(section, **fields)]
        self.assertEqual(verdict(quantity="mean torque, measured"), ["inside"])
        self.assertEqual(verdict(where="Fig. 32, top", variant="Cc = 0"), ["outside"])  # -101.0 N
        self.assertEqual(verdict(where="Fig. 32, bottom", variant="ADAMS, Cc = 0"), ["outside"])
        self.assertEqual(verdict(where="Fig. 34", variant="Cc = 0"), ["inside"])
        self.assertEqual(verdict(where="Fig. 36"), ["not comparable"] * 2)
        self.assertEqual(set(verdict(quantity="peak of Rb1")), {"not comparable"})
        self.assertTrue(all(r["status"] in ("predicted", "calibrated", "used to infer the geometry")
                            for r in section["rows"]))
        counted = [r for r in section["rows"] if r["counted"] and r["verdict"] == "inside"]
        self.assertEqual(section["predicted_inside"], len(counted))
        self.assertRegex(section["text"], r"Only predicted rows are validation: \d+ of \d+")

    def test_conditions_decide(self):
        light = {"pressure.delivery_bar": 0.0, "friction.piston_coulomb_N": 0.0, "operation.gravity_m_per_s2": 0.0}
        section = self.section(Case(**light))
        self.assertEqual([r["verdict"] for r in self.rows(section, where="Fig. 36")], ["inside", "not comparable"])
        self.assertEqual({r["verdict"] for r in self.rows(section, quantity="mean torque")}, {"not comparable"})
        section = self.section(Case(**{"pressure.delivery_bar": 386.0}))
        self.assertEqual({r["verdict"] for r in self.rows(section, quantity="peak of Rb1")}, {"inside"})

    def test_another_pump_has_no_table(self):
        for change in ({"pump.pistons": 7}, {"pump.bore_diameter_mm": 24.0}, {"gear.pitch_diameter_mm": 90.0}):
            self.assertIsNone(self.section(Case(**change)))


class OwnAnglesTest(RegressTest):
    """Records at angles that are none of the case's: nothing is resampled, so nothing is forgiven."""
    CHANNELS = "Rs_1_x2_N,Rs_1_y2_N,Rs_1_z2_N,Rb1_x1_N,Rb1_y1_N,Rb1_z1_N,Td_z1_Nm"
    CASE = "bap63_rated"

    def record(self, keep, *changes):
        """Rows of the multibody model, every tenth of a degree, that `keep` takes: of their number."""
        self.run_program("run", self.CASE, "--model", "multibody", "--channels", self.CHANNELS, "--set",
                         "operation.samples_per_revolution=3600", *(w for c in changes for w in ("--set", c)), "--out", "fine")
        header, *rows = csv.reader(io.StringIO((self.folder / "fine" / "multibody.csv").read_text()))
        return [header, *([*row] for i, row in enumerate(rows) if keep(i))]

    def held(self, rows, status, *more):
        """What regress says of a reference that is made of a record."""
        (self.folder / "record.csv").write_text("".join(",".join(row) + "\n" for row in rows))
        shutil.rmtree(self.folder / "ref", ignore_errors=True)
        self.run_program("reference", "new", self.CASE, "--from", "record.csv", "--accept", "--out", "ref", *more)
        out = self.regress("ref", status=status)
        self.assertNotIn("resampled", out)
        # The other command that states it says the same.
        compared = self.run_program("compare", self.CASE, "--with", "ref", "--out", "out", *more, status=status)
        if status == OUT_OF_TOLERANCE:
            for line in re.findall(r"^differs .*$", out, re.MULTILINE):
                self.assertIn(line, compared.out)
        return out

    def test_every_right_record_agrees(self):
        for name, keep in (("rough", lambda i: i % 80 == 3), ("a gap of 25 deg", lambda i: i % 10 == 3 and not 600 <= i < 850),
                           ("a few rows missing", lambda i: i % 10 == 0 and not 990 <= i < 1030)):
            with self.subTest(name):
                out = self.held(self.record(keep), DONE)
                worst = max(float(d) for d in re.findall(r"(\d\.\de[-+]\d\d) +\d+\.\d ", out))
                self.assertLess(worst, 1e-11)  # of the multibody model's own
                self.assert_mentions(out, "nothing is compared between 98 and 103 deg" if "rows" in name else
                                     "the models are computed at the reference's own")
        out = self.held(self.record(lambda i: i % 10 == 3 and not 600 <= i < 850), DONE)
        self.assert_mentions(out, "nothing is compared between 59.3 and 85.3 deg")

    def test_whole_degrees(self):
        """Integer angles are exact where their steps are multiples of one; rounded ones are not."""
        rows = self.record(lambda i: i % 10 == 0 and not 990 <= i < 1030)
        for write in ("{:.0f}", "{:.4f}"):
            same = [rows[0], *([write.format(float(row[0])), *row[1:]] for row in rows[1:])]
            self.held(same, DONE)
            self.assertNotIn("rounding_deg", (self.folder / "ref" / "description.toml").read_text())
        rounded = self.record(lambda i: i % 36 == 3)
        self.held([rounded[0], *([f"{float(row[0]):.0f}", *row[1:]] for row in rounded[1:])], DONE)
        self.assertIn("rounding_deg = 0.5", (self.folder / "ref" / "description.toml").read_text())

    def test_spike(self):
        rows = self.record(lambda i: i % 36 == 3)
        rows[42][4] = str(float(rows[42][4]) + 9000)
        out = self.held(rows, OUT_OF_TOLERANCE)
        self.assert_mentions(out, "differs", "Rb1_x1_N at 147.9 deg")
        self.assertRegex(out, r"agrees +ref +Rs ")
        self.assertRegex(out, r"differs +ref +Rb1 .* 2\.0e-01")

    def test_wrong_timing(self):
        out = self.held(self.record(lambda i: i % 80 == 3, "pressure.delivery_start_deg=184"), OUT_OF_TOLERANCE)
        size = float(re.search(r"differs +ref +Rs +\S+ N +(\S+)", out)[1])
        self.assertGreater(size, 0.25)

    DESCRIPTION = """schema = 1
kind = "external"
case = "{case}"
source = "the analytic model"
how_made = "regress_test.py"
who_may_change = "nobody"
digits = 16
[tolerance]
relative = 1e-6
[[curve]]
file = "curve.csv"
points = {points}
models = ["analytic"]
"""

    def said_of(self, rows):
        """What regress says of all curves of the analytic model's, as a reference of the case."""
        folder = self.folder / "ref"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        (folder / "curve.csv").write_text("".join(",".join(row) + "\n" for row in rows))
        case = base.REPO / "cases" / f"{self.CASE}.toml"
        (folder / "description.toml").write_text(self.DESCRIPTION.format(case=case, points=len(rows) - 1))
        return self.regress("ref", status=OUT_OF_TOLERANCE)

    def all_curves(self, *changes):
        self.run_program("run", self.CASE, "--model", "analytic", *(w for c in changes for w in ("--set", c)), "--out", "all")
        return list(csv.reader(io.StringIO((self.folder / "all" / "analytic.csv").read_text())))

    def test_a_shift_is_the_smallest_that_the_pistons_allow(self):
        """Of all curves: those of the whole pump come again after 72 deg, and a spline through 36 points leaves the more of 3 deg."""
        header, *fine = self.all_curves("operation.samples_per_revolution=720")
        for points in (36, 72):
            for shift in (3, -7.5, 17):
                step, by = 720 // points, round(2 * shift)
                rows = [[fine[i][0], *fine[(i + by) % 720][1:]] for i in range(0, 720, step)]
                hints = re.findall(r"(\S+) at \S+ deg(?: and \d+ more)?: the result is the reference shifted by about (\S+) deg",
                                   self.said_of([header, *rows]))
                self.assertGreaterEqual(len(hints), 11, hints)
                for channel, said in hints:
                    # What half a pitch of 36 deg moves is told from it by more points alone.
                    self.assertAlmostEqual(float(said), shift, delta=0.15, msg=f"{channel}, {points} points, {shift} deg")

    def test_another_operating_condition_is_named_before_a_dimension(self):
        for changes, words in (
                (["operation.speed_rpm=3000"], "operation.speed_rpm 1500 -> 3000 rpm (+100 %) explains"),
                (["pressure.delivery_bar=100"], "pressure.delivery_bar 275 -> 100 bar (-63.6 %) explains"),
                (["operation.speed_rpm=2000", "pressure.delivery_bar=200"],
                 "operation.speed_rpm 1500 -> 2000 rpm (+33.3 %) and pressure.delivery_bar 275 -> 200 bar (-27.3 %) together")):
            rows = self.all_curves("operation.samples_per_revolution=36", *changes)
            for columns in (range(len(rows[0])), [0, *(rows[0].index(c) for c in ("Rs_1_z3_N", "Rb1_y1_N", "Td_z1_Nm", "Rcs_z4_N"))]):
                out = self.said_of([[row[c] for c in columns] for row in rows])
                self.assert_mentions(out, words, "another operating condition than the case")
        # Of the torque alone a bore explains as much: the pressure is named, the bore behind it.
        rows = self.all_curves("operation.samples_per_revolution=36", "pressure.delivery_bar=280")
        column = rows[0].index("Td_z1_Nm")
        out = self.said_of([[row[0], row[column]] for row in rows])
        self.assertRegex(out, r"pressure\.delivery_bar 275 -> 280 bar \(\+1\.82 %\) explains 100 % .*distinguish it from: .*pump\.bore_diameter_mm")
        # A dimension that is wrong is named all the same.
        out = self.said_of(self.all_curves("operation.samples_per_revolution=36", "pump.bore_diameter_mm=22.8"))
        self.assert_mentions(out, "pump.bore_diameter_mm 22.5 -> 22.8 mm")
        self.assertNotIn("operating condition", out)

    def test_no_pump_has_what_would_explain_an_offset(self):
        """The suction pressure that comes nearest, -12 bar, is below absolute vacuum: it is neither named nor listed."""
        rows = self.record(lambda i: i % 20 == 3)
        column = rows[0].index("Rs_1_z2_N")
        for row in rows[1:]:
            row[column] = repr(float(row[column]) - 2000)
        (self.folder / "record.csv").write_text("".join(",".join(row) + "\n" for row in rows))
        self.run_program("reference", "new", self.CASE, "--from", "record.csv", "--accept", "--out", "ref")
        out = self.regress("ref", "--json-file", "regress.json", status=OUT_OF_TOLERANCE)
        self.assertIn("No parameter of the case explains the difference", out)
        [section] = [run for run in json.loads((self.folder / "regress.json").read_text())["runs"]
                     if run["title"] == "What would explain the difference"]
        self.assertGreater(len(section["table"]["rows"]), 0)
        for row in section["table"]["rows"]:
            named = dict(zip(section["table"]["columns"], row))
            if named["parameter"] == "pressure.suction_bar":
                self.assertGreater(named["nearest"], -1.014)
        self.assertNotIn("pressure.suction_bar 0 -> -", out)

    def test_the_wrong_parameter_explains_it(self):
        """And what explains it in the case makes it agree: both commands say one thing."""
        for change, step in (("piston.mass_kg=0.0936", 20), ("pump.tilt_deg=39", 56)):
            name, value = change.split("=")
            rows = self.record(lambda i, step=step: i % step == 3, change)
            out = self.held(rows, OUT_OF_TOLERANCE)
            line = next(line for line in out.splitlines() if " explains " in line)
            self.assertRegex(line, rf"{name} [\d.]+ -> {value}\d* .* explains 100 % of the difference")
            self.assertNotIn("other causes", line)
            self.held(rows, DONE, "--set", change)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    base.PROGRAM, base.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
