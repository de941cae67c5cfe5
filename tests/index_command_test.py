#!/usr/bin/env python3
"""Tests of `bentaxis index`: one page over a folder of reports.

usage: index_command_test.py BENTAXIS REPO_ROOT [options of unittest]
"""

import html.parser
import json
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
        (cls.folder / "broken.json").write_text('{"schema"')

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
                             (self.folder / "broken.json", "no such folder")):
            done = run("index", where)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertRegex(done.stderr, f"^bentaxis: {where}: {words}[^\n]*\n$")
        self.assertEqual(list(empty.iterdir()), [])


if __name__ == "__main__":
    PROGRAM, REPO = (pathlib.Path(p).resolve() for p in sys.argv[1:3])
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
