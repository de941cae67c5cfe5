#!/usr/bin/env python3
"""Tests of what a report hands on: paper, files of its figures, a dark screen, curves from elsewhere in its figures.

usage: paper_test.py BENTAXIS REPO_ROOT [options of unittest]

With BENTAXIS_SCREENSHOTS=DIR the pages are also saved there as pictures, light and dark. Without Chromium: exit status 77.
"""

import csv
import io
import json
import math
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import report_page_test as page_test
from packed_curves import unpacked

PROGRAM = REPO = None   # set in main
SECONDS = 120           # no single command may take longer
DOTS = 72               # per inch: a pixel of the paper is a point
COLOURED = 50           # difference of the largest and the smallest of red, green, blue
PNG = b"\x89PNG\r\n\x1a\n"

# What is measured on the page. Everything asynchronous is awaited before the answer is given.
PROBE = r"""
(async () => {
  const wait = time => new Promise(done => setTimeout(done, time));
  for (let i = 0; i < 200 && !document.documentElement.dataset.ready; ++i) await wait(50);
  const result = { errors: window.probeErrors, files: {}, faint: [] };
  try {
    // Files: what a click on each button would save.
    const pending = [];
    HTMLAnchorElement.prototype.click = function () {
      const name = this.download;
      pending.push(fetch(this.href).then(r => r.arrayBuffer()).then(b => {
        result.files[name] = btoa(Array.from(new Uint8Array(b), c => String.fromCharCode(c)).join(""));
      }));
    };
    const buttons = [...document.querySelectorAll(".hand-out button")];
    for (const button of buttons) { button.click(); await wait(5); }
    for (let i = 0; i < 400 && pending.length < buttons.length; ++i) await wait(20);
    await Promise.all(pending);
    result.buttons = buttons.length;

    // Every text against the ground it stands on.
    const rgb = text => { const c = text.match(/[\d.]+/g).map(Number); return c.length === 4 && c[3] === 0 ? null : c; };
    const light = c => c.slice(0, 3).map(v => v / 255).map(v => (v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4))
      .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
    const ground = e => { for (let p = e; p; p = p.parentElement) { const c = rgb(getComputedStyle(p).backgroundColor); if (c) return c; }
                          return [255, 255, 255]; };
    document.querySelectorAll("details").forEach(d => { d.open = true; });
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
      const e = walker.currentNode.parentElement;
      if (!walker.currentNode.textContent.trim() || !e.checkVisibility({ checkVisibilityCSS: true }) || /script|style/i.test(e.tagName)
          || e.closest(".label")) continue;
      const colour = rgb(e.closest("svg") ? getComputedStyle(e).fill : getComputedStyle(e).color);
      const [a, b] = [light(colour), light(ground(e))].sort((x, y) => y - x);
      if ((a + 0.05) / (b + 0.05) < 4.5) result.faint.push(`${e.textContent.trim().slice(0, 40)}: ${colour} on ${ground(e)}`);
    }
    result.ground = light(rgb(getComputedStyle(document.body).backgroundColor));
    result.scroll = [document.documentElement.scrollWidth, document.documentElement.clientWidth];
    const published = document.querySelector("#published details");
    result.published = published ? published.querySelector("summary").textContent : null;
    result.words = [...document.querySelectorAll(".banner .word")].map(e => e.textContent);
  } catch (error) { result.errors.push("probe: " + error.stack); }
  parent.postMessage(JSON.stringify(result), "*");
})();
"""
DARK = "--blink-settings=preferredColorScheme=0"


def run(folder, *arguments, status=0):
    done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=folder, capture_output=True, text=True, timeout=SECONDS)
    if status is not None and done.returncode != status:
        raise RuntimeError(f"{arguments}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return done


def make_rig(folder, name, factor, columns=("Td_z1_Nm", "Rb1_x1_N", "Rb1_y1_N"), tube_deg=0.0):
    """A reference folder like that of a rig: each value too large by a wave of `factor`."""
    place = folder / name
    place.mkdir()
    with open(folder / "base" / "analytic.csv") as file:
        rows = list(csv.DictReader(file))
    with open(place / "rig.csv", "w") as file:
        file.write(",".join(("theta_deg", *columns)) + "\n")
        for row in rows:
            wave = 1 + factor * math.sin(math.radians(3 * float(row["theta_deg"])))
            file.write(",".join([row["theta_deg"], *(repr(float(row[c]) * wave) for c in columns)]) + "\n")
    shutil.copy(folder / "case.toml", place / "case.toml")
    (place / "description.toml").write_text(f"""schema = 1
kind = "external"
case = "case.toml"
source = "Rig 7, 2009"
how_made = "torque meter, 4 kHz"
who_may_change = "the test"
digits = 6
[tolerance]
relative = 0.01
tube_deg = {tube_deg}
[[curve]]
file = "rig.csv"
points = {len(rows)}
""")
    return place


class HandOnTest(unittest.TestCase):
    maxDiff = 2000

    @classmethod
    def setUpClass(cls):
        cls.folder = folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="bentaxis_paper_")))
        text = (REPO / "cases" / "bap63_rated.toml").read_text()
        (folder / "case.toml").write_text(re.sub("(?m)^samples_per_revolution = .*", "samples_per_revolution = 180", text))
        hydraulic = (REPO / "cases" / "bap63_rated_hydraulic.toml").read_text()
        (folder / "hydraulic.toml").write_text(re.sub("(?m)^samples_per_revolution = .*", "samples_per_revolution = 180", hydraulic))
        run(folder, "compare", "case.toml", "--out", "base")
        make_rig(folder, "rig", 0.005)
        make_rig(folder, "bad_rig", 0.02)
        make_rig(folder, "tube_rig", 0.005, tube_deg=2.0)
        run(folder, "compare", "case.toml", "--with", "rig", "--out", "compare", "--figures", "compare/figures")
        run(folder, "regress", "rig", "--html", "regress/report.html", "--figures", "regress/figures")
        run(folder, "inertia", "case.toml", "--map-size", 6, "--out", "inertia", "--figures", "inertia/figures")
        run(folder, "tradeoff", "case.toml", "--accuracies", "1e-3,1e-4", "--integrators", "rk-merson,rk3", "--out", "tradeoff",
            "--figures", "tradeoff/figures")
        run(folder, "pressure", "hydraulic.toml", "--delivery-bar", "0:200:100", "--out", "pressure", "--figures", "pressure/figures")
        run(folder, "hardcases", "--filter", "speed", "--catalogue", REPO / "reference_data" / "hard", "--out", "hardcases")
        run(folder, "sweep", "case.toml", "--vary", "pump.piston_length_mm=6:46:10", "--vary", "pump.joint_circle_radius_mm=20:35:5",
            "--maximise", "mean:Td", "--minimise", "max:Rb2", "--out", "sweep", "--figures", "sweep/figures")
        cls.pages = {name: folder / name / file for name, file in
                     {"compare": "report.html", "regress": "report.html", "inertia": "inertia.html", "tradeoff": "tradeoff.html",
                      "pressure": "pressure.html", "hardcases": "hardcases.html", "sweep": "report.html"}.items()}
        cls.reports = {name: cls.embedded(page, "report") for name, page in cls.pages.items()}
        cls.measured = {(name, width, dark): cls.measure(name, width, dark) for name in cls.pages
                        for width, dark in ((1400, False), (420, True))}

    @staticmethod
    def embedded(page, block):
        text = page.read_text()
        found = json.loads(re.search(rf'<script type="application/json" id="{block}">(.*?)</script>', text, re.S).group(1))
        return unpacked(found) if block == "curves" else found

    @classmethod
    def measure(cls, name, width, dark):
        page = cls.pages[name]
        text = page.read_text()
        head, end = text.index("<head>") + len("<head>"), text.rindex("</body>")
        (page.parent / "probed.html").write_text(
            text[:head] + page_test.CATCH_ERRORS + text[head:end] + f"<script>{PROBE}</script>" + text[end:])
        frame = page.parent / "frame.html"
        frame.write_text(page_test.FRAME % ("probed.html", width, 900))
        options = [DARK] if dark else []
        dump = page_test.chromium(page.parent, frame, (max(width, 500), 900), "--dump-dom", *options)
        found = re.search(r'<pre id="result"[^>]*>(.*?)</pre>', dump, re.S)
        if not found or not found[1]:
            raise RuntimeError(f"{name} at {width} px: the page measured nothing\n{dump[:2000]}")
        pictures = os.environ.get("BENTAXIS_SCREENSHOTS")
        if pictures:
            frame.write_text(page_test.FRAME % (page.as_uri(), width, 9000))
            pathlib.Path(pictures).mkdir(parents=True, exist_ok=True)
            picture = pathlib.Path(pictures).resolve() / f"{name}_{width}{'_dark' if dark else ''}.png"
            page_test.chromium(page.parent, frame, (width, 9000), f"--screenshot={picture}", *options)
        return json.loads(page_test.html.unescape(found[1]))

    # ---- Paper

    @classmethod
    def paper(cls, name):
        """Pages of the printed report: width, height, RGB pixels; and their lines of text with their places."""
        page = cls.pages[name]
        file = page.with_suffix(".pdf")
        # A dark screen too: paper is light.
        page_test.chromium(page.parent, page, (1400, 900), "--no-pdf-header-footer", f"--print-to-pdf={file}", DARK)
        subprocess.run(["pdftoppm", "-r", str(DOTS), file, page.parent / "paper"], check=True, timeout=SECONDS)
        pages = []
        for ppm in sorted(page.parent.glob("paper-*.ppm")):
            _, size, _, pixels = ppm.read_bytes().split(b"\n", 3)
            width, height = map(int, size.split())
            pages.append((width, height, pixels))
        text = subprocess.run(["pdftotext", "-bbox-layout", file, "-"], check=True, capture_output=True, text=True).stdout
        places = []
        for number, part in enumerate(text.split("<page ")[1:]):
            for line in re.finditer(r'<line xMin="[^"]*" yMin="([^"]*)"[^>]*>(.*?)</line>', part, re.S):
                words = " ".join(page_test.html.unescape(w) for w in re.findall(r"<word [^>]*>(.*?)</word>", line[2]))
                places.append((number, float(line[1]), words))
        return pages, places

    @staticmethod
    def coloured_columns(page, top, bottom):
        """How many columns of pixels have a coloured one between two heights."""
        width, _, pixels = page
        found = set()
        for y in range(top, bottom):
            row = pixels[3 * y * width:3 * (y + 1) * width]
            for x in range(width):
                colour = row[3 * x:3 * x + 3]
                if max(colour) - min(colour) > COLOURED:
                    found.add(x)
        return len(found)

    def test_a_printed_report_has_its_curves(self):
        for name, report in self.reports.items():
            pages, places = self.paper(name)
            for figure in report.get("figures", []):
                with self.subTest(name, figure=figure["id"]):
                    words = figure["title"].split()
                    start = " ".join(words[:6])
                    at = [p for p in places if " ".join(p[2].split()[:6]) == start]
                    self.assertTrue(at, "the title is not on paper")
                    # The legend's lines are short. Where several titles start alike, each must have its curves.
                    for number, top, _ in at:
                        width = self.coloured_columns(pages[number], int(top) + (60 if figure["kind"] == "scatter" else 20), min(int(top) + 300, pages[number][1]))
                        # A scatter is of measured times: points of about the same time are drawn over each other. Without points it is 0.
                        enough = {"piston_bars": 150, "xy": 150, "scatter": 20}.get(figure["kind"], 290)
                        # Equal scales leave room beside what is drawn: two thin loops, a round plate; polygons are
                        # taller than wide, and no figure is taller than 108 mm.
                        enough = {"bearing_loci": 5, "plate_pressure": 120, "polygon_piston": 150,
                                  "polygon_block": 150}.get(figure["id"], enough)
                        self.assertGreater(width, enough, f"page {number + 1}: columns with colour, of some 380")

    def test_paper_is_not_wasted(self):
        for name in self.pages:
            pages, _ = self.paper(name)
            for number, (width, height, pixels) in enumerate(pages[:-1]):
                with self.subTest(name, page=number + 1):
                    rows = [y for y in range(height) if min(pixels[3 * y * width:3 * (y + 1) * width]) < 200]
                    self.assertGreater(max(rows) / height, 0.5)

    def test_paper_is_light(self):
        pages, _ = self.paper("tradeoff")
        for width, height, pixels in pages:
            self.assertGreater(sum(pixels) / len(pixels), 200)

    # ---- Files

    def test_a_click_hands_out_what_figures_writes(self):
        import base64
        for (name, width, dark), page in self.measured.items():
            with self.subTest(name, width=width):
                self.assertEqual(page["errors"], [])
                ids = [f["file"] for f in self.reports[name].get("figures", [])]
                self.assertEqual(page["buttons"], 3 * len(ids))
                self.assertEqual(set(page["files"]), {f"{i}.{t}" for i in ids for t in ("svg", "png", "csv")})
                for figure in ids:
                    files = {t: base64.b64decode(page["files"][f"{figure}.{t}"]) for t in ("svg", "png", "csv")}
                    stored = self.pages[name].parent / "figures"
                    self.assertEqual(ElementTree.canonicalize(files["svg"].decode()),
                                     ElementTree.canonicalize((stored / f"{figure}.svg").read_text().rstrip("\n")), figure)
                    theirs = (stored / f"{figure}.png").read_bytes()
                    for png in (files["png"], theirs):
                        self.assertTrue(png.startswith(PNG))
                    # A size in half pixels may be rounded either way.
                    for a, b in zip(struct.unpack(">II", files["png"][16:24]), struct.unpack(">II", theirs[16:24])):
                        self.assertLessEqual(abs(a - b), 2, figure)
                    self.same_numbers(files["csv"].decode(), (stored / f"{figure}.csv").read_text(), figure)

    def same_numbers(self, page, file, figure):
        """The page's curves have 9 digits, its differences 4."""
        mine, theirs = (list(csv.reader(io.StringIO(text))) for text in (page, file))
        self.assertEqual(mine[0], theirs[0], figure)
        self.assertEqual(len(mine), len(theirs), figure)
        for row, other in zip(mine[1:], theirs[1:]):
            for head, a, b in zip(mine[0], row, other):
                try:
                    self.assertLessEqual(abs(float(a) - float(b)), (1e-3 if " minus " in head else 1e-8) * abs(float(b)), figure)
                except ValueError:
                    self.assertEqual(a, b, figure)

    def test_files_hold_the_curves(self):
        with open(self.folder / "compare" / "analytic.csv") as file:
            model = [float(row["Td_z1_Nm"]) for row in csv.DictReader(file)]
        with open(self.folder / "compare" / "figures" / "fig17_30_td.csv") as file:
            figure = [float(row["Td_z1_Nm analytic"]) for row in csv.DictReader(file)]
        self.assertEqual(model, figure)
        svg = ElementTree.parse(self.folder / "compare" / "figures" / "fig17_30_td.svg").getroot()
        self.assertIn("Drive torque Td", "".join(svg.itertext()))

    def test_figures_of_an_earlier_run_go(self):
        run(self.folder, "compare", "case.toml", "--out", "again", "--figures", "again/figures")
        before = {f.name for f in (self.folder / "again" / "figures").iterdir()}
        (self.folder / "again" / "figures" / "mine.txt").write_text("keep")
        run(self.folder, "compare", "case.toml", "--channels", "Td", "--out", "again", "--figures", "again/figures")
        after = {f.name for f in (self.folder / "again" / "figures").iterdir()}
        self.assertIn("fig12_rs.png", before)
        self.assertEqual(after, {"figures.csv", "mine.txt"} | {f"{figure}.{kind}" for figure in ("fig17_30_td", "torque_budget")
                                                           for kind in ("svg", "png", "csv")})

    # ---- Screen

    def test_every_text_can_be_read_light_and_dark(self):
        for (name, width, dark), page in self.measured.items():
            with self.subTest(name, dark=dark):
                self.assertEqual(page["faint"], [])
                self.assertEqual(page["ground"] < 0.1, dark, "the ground is dark on a dark screen only")

    def test_only_tables_scroll(self):
        for (name, width, dark), page in self.measured.items():
            with self.subTest(name, width=width):
                self.assertLessEqual(*page["scroll"])

    def test_published_numbers_are_a_line(self):
        line = self.measured["compare", 1400, False]["published"]
        self.assertRegex(line, r"All \d+ rows: \d+ \w+")

    def test_packed_curves_are_those_of_the_files(self):
        curves = self.embedded(self.pages["compare"], "curves")
        for table in curves["tables"]:
            with open(self.pages["compare"].parent / f"{table['name']}.csv", encoding="utf-8") as text:
                rows = list(csv.DictReader(text))
            names = [name for name in rows[0] if name in table["columns"]]
            self.assertGreater(len(names), 40)
            for name in names:
                theirs = [float(row[name]) if row[name] else None for row in rows]
                for mine, value in zip(table["columns"][name], theirs):
                    self.assertEqual(mine is None, value is None, name)
                    if value is not None:
                        self.assertAlmostEqual(mine, value, delta=5e-9 * abs(value), msg=name)  # 9 digits

    # ---- Curves from elsewhere

    def test_a_reference_is_a_third_curve(self):
        curves = self.embedded(self.pages["compare"], "curves")
        self.assertEqual(curves["reference"]["name"], "rig")
        self.assertEqual(set(curves["reference"]["held"]), {"Td_z1_Nm", "Rb1_x1_N", "Rb1_y1_N"})
        held = curves["reference"]["held"]["Td_z1_Nm"]
        for t, model in enumerate(("analytic", "multibody")):
            for value, theirs, difference in zip(curves["tables"][t]["columns"]["Td_z1_Nm"], held["values"], held["difference"][model]):
                self.assertAlmostEqual(value - theirs, difference, delta=1e-3 * abs(difference) + 1e-6)
        self.assertAlmostEqual(held["allowed"], 0.01 * max(map(abs, held["values"])), delta=1e-3)
        self.assertEqual(self.measured["compare", 1400, False]["words"], ["Agrees", "rig: agrees"])
        note = next(f["note"] for f in self.reports["compare"]["figures"] if f["id"] == "td")
        self.assertRegex(note, r"rig: Td agrees: 0\.\d+ % of peak .* 1 % allowed; Td_z1_Nm at [\d.]+ deg")
        svg = (self.folder / "compare" / "figures" / "fig17_30_td.svg").read_text()
        self.assertIn("each model minus rig", svg)
        self.assertIn('class="band"', svg)
        self.assertNotIn('class="band"', (self.folder / "compare" / "figures" / "fig12_rs.svg").read_text())

    def test_a_reference_that_differs_decides(self):
        done = run(self.folder, "compare", "case.toml", "--with", "bad_rig", "--out", "bad", status=1)
        self.assertIn("The two models agree.", done.stdout)
        self.assertIn("They differ from bad_rig: 2 of 2 reactions compared differ. Worst: ", done.stdout)
        self.assertEqual(done.stdout.count("reactions compared differ"), 1)
        report = json.loads((self.folder / "bad" / "report.json").read_text())
        self.assertFalse(report["verdict"]["agrees"])
        self.assertTrue(report["verdict"]["models_agree"])
        self.assertFalse(report["verdict"]["reference"]["agrees"])

    def test_a_tube_is_drawn(self):
        run(self.folder, "compare", "case.toml", "--with", "tube_rig", "--out", "tube")
        held = self.embedded(self.folder / "tube" / "report.html", "curves")["reference"]["held"]["Td_z1_Nm"]
        self.assertTrue(all(low <= v <= high for low, v, high in zip(held["low"], held["values"], held["high"])))
        self.assertGreater(max(high - low for low, high in zip(held["low"], held["high"])), 0.1)

    def test_a_golden_run_and_another_case(self):
        run(self.folder, "reference", "golden", "case.toml", "--angles", 36, "--out", "golden")
        # A fifth of the angles: judged at these, not between them.
        done = run(self.folder, "compare", "case.toml", "--with", "golden", "--out", "third")
        held = self.embedded(self.folder / "third" / "report.html", "curves")["reference"]["held"]["Td_z1_Nm"]
        self.assertEqual([v is not None for v in held["values"]], [i % 5 == 0 for i in range(180)])
        self.assertLess(max(abs(v) for v in held["difference"]["multibody"] if v is not None), 1e-8)
        self.assertRegex(done.stdout, r"golden agrees: (\d+) of \1 reactions compared agree")
        done = run(self.folder, "compare", "case.toml", "--set", "pump.tilt_deg=39.9", "--with", "golden", "--out", "third", status=1)
        self.assertRegex(done.stdout, r"warning: the curves belong to another case: golden: pump\.tilt_deg = 40\.?0* \(here 39\.(9|89+)\)")

    def test_what_is_no_reference_is_refused_first(self):
        for name in ("one", "other"):
            (self.folder / "several").mkdir(exist_ok=True)
            shutil.copytree(self.folder / "rig", self.folder / "several" / name)
        for folder, words in (("several", "contains 2 references"), ("nowhere", "is not a directory"), (REPO / "reference_data" / "published" / "bap63", "printed numbers")):
            with self.subTest(folder):
                done = run(self.folder, "compare", "case.toml", "--with", folder, "--out", "refused", status=2)
                self.assertIn(words, done.stderr)
                self.assertEqual([line.split(":")[0] for line in done.stderr.strip().splitlines()], ["pump", "bentaxis"])
                self.assertFalse((self.folder / "refused" / "report.html").exists())

    def test_a_passing_regression_is_a_picture(self):
        figures = self.reports["regress"]["figures"]
        self.assertEqual({f["title"] for f in figures}, {"rig: Rb1", "rig: Td"})
        for figure in figures:
            self.assertEqual([t["name"] for t in figure["curves"]["tables"]], ["analytic", "multibody"])
            self.assertEqual(set(figure["curves"]["reference"]["held"]), set(figure["channels"]))
            for words in ("agrees", "Rig 7, 2009", "torque meter, 4 kHz", "1 % allowed"):
                self.assertIn(words, figure["note"])


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    PROGRAM, REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    page_test.CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if not page_test.CHROMIUM or not shutil.which("pdftoppm"):
        print("paper_test: SKIPPED: no Chromium or pdftoppm found; scripts/setup test installs them", file=sys.stderr)
        sys.exit(page_test.NO_CHROMIUM)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
