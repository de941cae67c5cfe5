#!/usr/bin/env python3
"""Facts that pages of the documentation state and that have been wrong once, checked against their sources.

usage: documentation_facts_test.py REPO_ROOT [options of unittest]
"""
import pathlib
import re
import sys
import unittest

REPO = None  # set in main


def page(name):
    return (REPO / name).read_text()


class FactsTest(unittest.TestCase):
    def test_exit_statuses(self):
        """Pages list every exit status of the program, and no other."""
        enum = re.search(r"enum ExitStatus \{(.*?)\};", page("interfaces/cli/commands.h"), re.DOTALL)[1]
        of_program = {int(n) for n in re.findall(r"= (\d+)", enum)}
        self.assertGreaterEqual(len(of_program), 5)
        (row,) = re.findall(r"^\| exit statuses \| (.*) \|$", page("docs/compatibility.md"), re.MULTILINE)
        self.assertEqual({int(n) for n in re.findall(r"(?:^|· )(\d+) ", row)}, of_program)
        table = page("docs/command_line.md").rpartition("| exit status | |")[2]
        self.assertEqual({int(n) for n in re.findall(r"^\| (\d+) \|", table, re.MULTILINE)}, of_program)

    def test_arm_of_the_tooth_force(self):
        """The arm is half of the pitch diameter times the cosine (footnote 9; check C26 computes it)."""
        for file in sorted((REPO / "docs").rglob("*.md")):
            with self.subTest(file.name):
                self.assertNotRegex(file.read_text(), r"(?<![/\w(])d cos\((?:alpha_p|ap)\)")

    def test_open_and_closed_schema(self):
        """What the compatibility policy says of the schema: closed objects, so that new keys need the newer schema."""
        closed = page("docs/report.schema.json").count('"additionalProperties": false')
        policy = page("docs/compatibility.md")
        self.assertGreater(closed, 0)
        self.assertIn("additionalProperties: false", policy)
        self.assertIn("does not validate against an **older** schema", policy)

    def test_times_are_stated_by_the_generated_page_alone(self):
        """Times of the driven scenes are those of docs/performance.md, which a benchmark writes."""
        self.assertRegex(page("docs/performance.md"), r"full/residual/lumped \| [0-9.]+ us")
        self.assertNotRegex(page("docs/inertia.md"), r"^\| (full|pistons|piston) \| [0-9.]+ \|")

    def test_every_kind_of_contact_is_in_the_page_on_motion(self):
        words = re.search(r'choice\("contact", FIELD\(.*?\), \{(.*?)\}', page("core/pump/tables/gear.cpp"))[1]
        words = re.findall(r'"(\w+)"', words)
        self.assertEqual(len(words), 3)
        for word in words:
            with self.subTest(word):
                self.assertRegex(page("docs/motion.md"), rf'(?m)^\| `contact = "{word}"`')

    def test_measured_torque_of_the_paper(self):
        """Fig. 18 plots a measured curve; 295.5 Nm is the only value of it that is printed."""
        self.assertIn("Fig. 18 plots the mean torque over 0 to 350 bar, and one of its values is printed", page("docs/limits.md"))
        self.assertIn("Fig. 18 plots measured torque over 0 to 350 bar", page("reference_data/published/bap63/numbers.toml"))
        for file in sorted((REPO / "docs").rglob("*.md")):
            with self.subTest(file.name):
                self.assertNotRegex(file.read_text(), r"(?i)\bonly measure(d|ment)|one mean torque")

    def test_examples_from_memory_are_called_so(self):
        """Worked examples of catalogues that were not looked up are marked, row by row, and are no validation."""
        text = page("docs/bearing_life.md").rpartition("## Arithmetic checks")[2]
        self.assertIn("They are no validation", text)
        rows = re.findall(r"^\| (?!stated source|---)([^|]*)\|", text, re.MULTILINE)
        self.assertEqual([row for row in rows if "from memory" not in row and "Shigley" not in row], [])
        self.assertEqual(len(rows), 4)

    def test_tried_fmus_are_those_of_the_cases(self):
        """The table of scripts/try_fmpy has every shipped case, or the page says why not."""
        text = page("docs/fmu.md")
        table = re.search(r"<!-- table of scripts/try_fmpy -->\n(.*?)<!-- end of table -->", text, re.DOTALL)[1]
        for case in sorted((REPO / "cases").glob("*.toml")):
            for drive in ("speed", "case"):
                with self.subTest(case=case.stem, drive=drive):
                    if f"| `{case.stem}` | {drive} |" not in table:
                        self.assertRegex(text, rf"(?s)Not run:.*`{case.stem}`")

    def test_readme_is_short(self):
        text = page("README.md")
        self.assertLessEqual(text.count("\n"), 90)
        self.assertLessEqual(len(text.split()), 700)

    def test_releases_have_dates(self):
        heads = re.findall(r"^## \[(.*?)\](.*)$", page("CHANGELOG.md"), re.MULTILINE)
        self.assertGreaterEqual(len(heads), 4)
        for version, rest in heads[1:]:
            with self.subTest(version):
                self.assertRegex(rest, r"^ - \d{4}-\d\d-\d\d$")


if __name__ == "__main__":
    REPO = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
