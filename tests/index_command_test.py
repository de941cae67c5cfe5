#!/usr/bin/env python3
"""Tests of `bentaxis index`: one page over a folder of reports.

usage: index_command_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import html.parser
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.parse

PROGRAM = REPO = None  # set in main
ODD = "odd % <b>#x & \"quotes\""


def run(*arguments, cwd=None):
    return subprocess.run([str(PROGRAM), *map(str, arguments)], capture_output=True, text=True, timeout=120, cwd=cwd)


class Page(html.parser.HTMLParser):
    """Links of the rows with the words of their verdict, and the pictures."""

    def __init__(self, text):
        super().__init__()
        self.rows, self.pictures, self.inside = [], 0, False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag == "a":
            self.rows.append([attributes["href"], ""])
        self.inside = tag == "span" and "chip" in attributes.get("class", "")
        self.pictures += tag == "img" and attributes["src"].startswith("data:image/svg+xml")

    def handle_data(self, data):
        if self.inside:
            self.rows[-1][1] += data

    def handle_endtag(self, tag):
        self.inside = False


class Index(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        case, few = REPO / "cases/bap63_rated.toml", ["--set", "operation.samples_per_revolution=36"]
        other = cls.folder / "other.toml"
        other.write_text(case.read_text().replace("tilt_deg = 40.0", "tilt_deg = 39.0"))
        cls.status = {}
        for name, more in {ODD: [], "deep/er/differs": ["--multibody-case", other]}.items():
            cls.status[name] = run("compare", case, *few, *more, "--out", cls.folder / name).returncode
        run("pressure", REPO / "cases/bap63_rated_hydraulic.toml", "--out", cls.folder / "deep")
        run("reference", "golden", case, "--angles", "36", "--out", cls.folder.with_name(cls.folder.name + "_golden"))
        done = run("regress", cls.folder.with_name(cls.folder.name + "_golden"), "--html", cls.folder / "deep/regress.html", "--json-file",
                   cls.folder / "deep/regress.json")
        assert done.returncode == 0, done.stderr
        (cls.folder / "no_report.json").write_text('{"schema": 1}')
        (cls.folder / "settings.json").write_text('{"other": 1} // of an editor')

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)
        shutil.rmtree(cls.folder.with_name(cls.folder.name + "_golden"))

    def test_worst_first_with_verdict_link_and_picture(self):
        self.assertEqual(self.status, {ODD: 0, "deep/er/differs": 1})
        done = run("index", self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        page = Page((self.folder / "index.html").read_text())
        self.assertEqual([(urllib.parse.unquote(link), word) for link, word in page.rows],
                         # The pressure's timing is warned of.
                         [("deep/er/differs/report.html", "Differs"), ("deep/pressure.html", "Pressure"), (f"{ODD}/report.html", "Agrees"),
                          ("deep/regress.html", "Agrees")])
        for link, _ in page.rows:
            self.assertTrue((self.folder / urllib.parse.unquote(link)).is_file(), link)
        self.assertEqual(page.pictures, 3)
        reports = json.loads((self.folder / "index.json").read_text())["reports"]
        for entry in reports:
            report = json.loads((self.folder / entry["json"]).read_text())
            self.assertEqual(entry["title"], report["title"])
            self.assertEqual(entry["date"], report["provenance"]["date"])
            worst = (report.get("verdict") or {}).get("worst") or {}
            self.assertEqual((entry["worst_channel"], entry["worst_over_peak"]),
                             (worst.get("channel", ""), worst.get("max_over_peak")))
        self.assertIn("2 JSON files are no report", done.stdout)
        # An index is no report: the next one says the same.
        before = (self.folder / "index.json").read_text()
        self.assertEqual(run("index", self.folder).returncode, 0)
        self.assertEqual((self.folder / "index.json").read_text(), before)

    def test_elsewhere_with_links_from_there(self):
        place = self.folder / "site/pages"
        self.addCleanup(shutil.rmtree, self.folder / "site")
        self.assertEqual(run("index", "deep", "--out", "site/pages", cwd=self.folder).returncode, 0)
        links = [urllib.parse.unquote(link) for link, _ in Page((place / "index.html").read_text()).rows]
        self.assertEqual(len(links), 3)
        for link in links:
            self.assertTrue((place / link).is_file(), link)

    def test_refusals(self):
        empty = self.folder / "empty"
        empty.mkdir()
        for where, words in ((self.folder / "missing", "no such folder"), (empty, "no report below it"),
                             (self.folder / "no_report.json", "no such folder")):
            done = run("index", where)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertRegex(done.stderr, f"^bentaxis: {where}: {words}[^\n]*\n$")
        self.assertEqual(list(empty.iterdir()), [])

    def report(self, verdict, **more):
        return json.dumps({"schema": 1, "program": [], "title": "a pump", "verdict": verdict, **more})

    def folder_of(self, **texts):
        """A folder of its own with these reports."""
        place = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, place)
        place.chmod(0o755)
        for name, text in texts.items():
            (place / name / "x.json").parent.mkdir()
            (place / name / "report.json").write_text(text)
        return place

    def assert_not_read(self, done, place, *names):
        """The console, the JSON, the page and the status say of what nothing can be said."""
        said = json.loads((place / "index.json").read_text())
        self.assertEqual([one["path"] for one in said["unread"]], list(names))
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertRegex(done.stderr, f"^bentaxis: [^\n]*{names[0]}[^\n]*\n$")
        headline = done.stdout.splitlines()[0]
        self.assertEqual(headline, said["headline"])
        self.assertIn(f"{len(names)} could not be read, so nothing can be said of", headline)
        self.assertIn("Of those that were read, none differs", headline)
        page = (place / "index.html").read_text()
        for name in names:
            self.assertIn(name, headline)
            self.assertRegex(done.stdout, f"(?m)^not read +{name}: ")
            self.assertIn(f"<li><code>{name}</code>", page)

    def test_a_damaged_report_is_not_passed_over(self):
        whole = (self.folder / "deep/er/differs/report.json").read_text()
        place = self.folder_of(good=self.report({"agrees": True, "headline": "fine"}), cut=whole[:5000], empty="", headless=json.dumps(
            {"schema": 1, "verdict": {"agrees": False}}), other='{"name": "no report"}')
        done = run("index", place)
        self.assert_not_read(done, place, "cut/report.json", "empty/report.json", "headless/report.json")
        self.assertIn("ends after 5000 bytes", done.stdout)
        self.assertIn("1 JSON files are no report", done.stdout)
        # None at all: one line, and nothing is written.
        place = self.folder_of(cut=whole[:5000])
        done = run("index", place)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertRegex(done.stderr, f"^bentaxis: {place}: no report below it can be read: cut/report.json: ends after 5000 bytes[^\n]*\n$")
        self.assertFalse((place / "index.html").exists())

    def test_what_must_not_be_read_is_not_passed_over(self):
        place = self.folder_of(good=self.report({"agrees": True, "headline": "fine"}), locked=self.report({"agrees": False}), shut=self.report(
            {"agrees": False}))
        out = self.folder_of()
        out.chmod(0o777)
        (place / "locked").chmod(0o700)
        (place / "shut/report.json").chmod(0o600)
        self.addCleanup((place / "locked").chmod, 0o755)
        as_others = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"] if os.geteuid() == 0 else []
        if not as_others:
            (place / "locked").chmod(0)
            (place / "shut/report.json").chmod(0)

        def run_as_others(folder):
            return subprocess.run([*as_others, str(PROGRAM), "index", str(folder), "--out", str(out)], capture_output=True, text=True, timeout=120)

        done = run_as_others(place)
        seen = "../" + place.name
        self.assert_not_read(done, out, f"{seen}/locked", f"{seen}/shut/report.json")
        self.assertRegex(done.stdout, r"not read +\S*locked: cannot be read: Permission denied\n")
        self.assertRegex(done.stdout, r"not read +\S*shut/report.json: cannot be read: [^\n]*no permission\n")
        done = run_as_others(place / "locked")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("Permission denied", done.stderr)

    def test_where_results_are_not_valid(self):
        """Also beside warnings, and counted in the headline."""
        place = self.folder_of(
            valid=self.report({"agrees": True, "headline": "fine"}, warnings=[{"name": "timing", "text": ""}]),
            invalid=self.report({"agrees": True, "headline": "fine", "not_valid": "over 100 % of the turn"}, warnings=[{"name": "film", "text": ""}]))
        done = run("index", place)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"^2 reports, 2 agree; 2 with warnings, 1 not valid throughout\. None differs; first that is not valid "
                         r"throughout: a pump \(invalid/report\.json\): not valid over 100 % of the turn\.\n")
        self.assertRegex(done.stdout, r"\nagrees +invalid/report\.json: fine; not valid over 100 % of the turn \(warnings: 1\)\n")
        self.assertEqual([word for _, word in Page((place / "index.html").read_text()).rows], ["Agrees; not valid over 100 % of the turn", "Agrees"])
        self.assertEqual([entry["not_valid"] for entry in json.loads((place / "index.json").read_text())["reports"]], ["over 100 % of the turn", ""])

    def test_counts_are_those_of_the_rows_and_most_of_the_turn_comes_first(self):
        fine = {"agrees": True, "headline": "fine", "worst": {"channel": "Td", "max_over_peak": 1e-13, "theta_deg": 0}}
        worse = {**fine, "worst": {"channel": "Td", "max_over_peak": 1e-12, "theta_deg": 0}}
        warned = {"warnings": [{"name": "timing", "text": ""}]}
        place = self.folder_of(
            some=self.report({**worse, "not_valid": "over 7.5 % of the turn"}), most=self.report({**fine, "not_valid": "over 40 % of the turn"}),
            warned=self.report(fine, **warned), differs=self.report({"agrees": False, "headline": "no"}, **warned), fine=self.report(fine),
            shown=self.report({"agrees": None, "headline": "alone"}))
        done = run("index", place)
        lines = done.stdout.splitlines()
        self.assertRegex(lines[0], r"^6 reports, 1 differ, 4 agree, 1 without a verdict; 2 with warnings, 2 not valid throughout\. Worst: ")
        rows = [line for line in lines if "/report.json: " in line]
        self.assertEqual([row.split()[1].split("/")[0] for row in rows], ["differs", "most", "some", "warned", "fine", "shown"])
        # Each number of the headline is that of the rows.
        for number, words in ((4, "agrees "), (2, "(warnings: 1)"), (2, "; not valid over")):
            self.assertEqual(sum(words in row for row in rows), number, words)

    def test_no_design_is_no_difference(self):
        place = self.folder_of(none=self.report({"agrees": False, "word": "No design", "headline": "none satisfies all constraints"}),
                               differs=self.report({"agrees": False, "headline": "The two models differ."}))
        done = run("index", place)
        self.assertRegex(done.stdout, r"^2 reports, 1 differ, 1 no design\. Worst: ")
        self.assertRegex(done.stdout, r"\nno design +none/report\.json: ")
        self.assertIn(("none/report.json", "No design"), [tuple(row) for row in Page((place / "index.html").read_text()).rows])


if __name__ == "__main__":
    PROGRAM, REPO = (pathlib.Path(p).resolve() for p in sys.argv[1:3])
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
