#!/usr/bin/env python3
"""`bentaxis paper` from outside: the list of the paper's figures against what is drawn, the curves against other commands.

usage: paper_figures_test.py BENTAXIS REPO_ROOT [options of unittest]

The page needs Chromium; without it that part is skipped.
"""

import csv
import json
import math
import pathlib
import re
import shutil
import sys
import tempfile
import tomllib
import unittest

import command_line_test as program
import report_page_test as page_test
from command_line_test import BAD_INPUT, ProgramTest

# The list that was asked for: curves, and two drawings.
WANTED = {10, 12, 13, 14, 15, *range(17, 31), 32, 34, 36, 37} | {31, 33}

PROBE = r"""
(async () => {
  const root = document.documentElement, wait = time => new Promise(done => setTimeout(done, time));
  for (let i = 0; i < 200 && !root.dataset.ready; ++i) await wait(50);
  const report = JSON.parse(document.getElementById("report").textContent), missing = [];
  for (const figure of report.figures) {
    const place = document.getElementById("figure-" + figure.id);
    if (place) place.scrollIntoView();
    // What is drawn when it comes near the screen is drawn by then.
    const drawn = () => place && [...place.querySelectorAll("svg, img, canvas")].some(e => e.getBoundingClientRect().height > 50);
    for (let i = 0; i < 40 && place && !drawn(); ++i) await wait(20);
    if (!drawn() || !place.textContent.includes(figure.title)) missing.push(figure.id);
  }
  const result = { errors: window.probeErrors, missing, count: report.figures.length,
                   rows: document.querySelectorAll("#runs table tbody tr, #runs table tr").length,
                   scroll: [root.scrollWidth, root.clientWidth] };
  parent.postMessage(JSON.stringify(result), "*");
})();
"""


def ident(figure, panel=None):
    name = (panel or {}).get("name", "")
    return f"fig{figure['number']}{figure.get('part', '')}" + (f"_{name}" if name else "")


def known_range(axis):
    if "axis" in axis:
        return axis["axis"]
    return [axis["labels"][0], axis["labels"][2]] if "labels" in axis else None


def read(file):
    with open(file) as lines:
        return list(csv.DictReader(lines))


class PaperFiguresTest(ProgramTest):
    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory(prefix="bentaxis_paper_")
        cls.addClassCleanup(cls.shared.cleanup)
        cls.place = pathlib.Path(cls.shared.name)
        cls.data = program.REPO / "reference_data/published/bap63"
        cls.list = tomllib.loads((cls.data / "figures.toml").read_text())
        cls.numbers = tomllib.loads((cls.data / "numbers.toml").read_text())
        cls.panels = {ident(f, p): (f, p) for f in cls.list["figure"] for p in f.get("panel", [])}
        cls.said, cls.report = cls.draw(cls.place, "--figures", "pictures")
        cls.figures = {f["id"]: f for f in cls.report["figures"]}

    @classmethod
    def draw(cls, folder, *options):
        test = cls()
        test.folder = folder
        result = test.run_program("paper", "--out", "out", *options)
        return result.out, json.loads((folder / "out/paper.json").read_text())

    def runTest(self):
        """For draw()."""

    def rows(self):
        table = self.report["runs"][0]["table"]
        return {row[0]: dict(zip(table["columns"], row)) for row in table["rows"]}

    def series(self, figure, label):
        (found,) = [s for s in self.figures[figure]["series"] if s["label"] == label]
        return found

    def run_case(self, model, *changes, case="bap63_rated_hydraulic"):
        self.run_program("run", program.REPO / f"cases/{case}.toml", "--model", model, "--out", "run",
                         *(word for change in changes for word in ("--set", change)))
        return read(self.folder / f"run/{model}.csv")

    def assert_same(self, found, wanted, tolerance=1e-12):
        self.assertEqual(len(found), len(wanted))
        peak = max(abs(v) for v in wanted)
        worst = max(abs(a - b) for a, b in zip(found, wanted))
        self.assertLessEqual(worst, tolerance * peak)

    # ---- The list and the page

    def test_every_figure_of_the_list_is_drawn(self):
        self.assertEqual({f["number"] for f in self.list["figure"]}, WANTED)
        drawings = {ident(f) for f in self.list["figure"] if not f.get("panel")}
        self.assertEqual(drawings, {"fig13", "fig14b", "fig31", "fig33"})
        self.assertLessEqual(drawings | set(self.panels), set(self.figures))
        names = {p.name for p in (self.place / "pictures").iterdir()}
        for figure in self.figures:
            self.assertLessEqual({f"{figure}.svg", f"{figure}.png", f"{figure}.csv"}, names)
        self.assertEqual(len(self.rows()), len(self.panels) + len(drawings))
        for figure in drawings:
            self.assertEqual(self.figures[figure]["kind"], "drawing")

    def test_curves_are_dashed_as_the_list_says(self):
        for name, (_, panel) in self.panels.items():
            dashed = {c["label"] for c in panel["curve"] if c.get("dashed")}
            self.assertEqual({s["label"] for s in self.figures[name]["series"] if s.get("dashed")}, dashed, name)
            svg = (self.place / f"pictures/{name}.svg").read_text()
            dashes = set(re.findall(r'stroke-dasharray="([^"]*)"', svg)) - {"none"}
            self.assertEqual(bool(dashes), bool(dashed), name)

    def test_axes_are_those_of_the_list(self):
        """Ends stand where they are known and our curves are inside; where a curve leaves, its end is drawn."""
        table = {row["figure"]: row for row in read(self.place / "out/paper.csv")}
        self.assertEqual(set(table), set(self.panels))
        for name, (figure, panel) in self.panels.items():
            with self.subTest(name):
                drawn, row = self.figures[name], table[name]
                for key in "xy":
                    ends, axis = known_range(panel[key]), drawn[key]
                    if ends is None:
                        self.assertNotIn("from", axis)
                        self.assertNotIn("to", axis)
                        self.assertIn("unknown: " + panel[key]["why"], drawn["note"])
                    elif key == "x":
                        self.assertEqual([axis["from"], axis["to"]], ends)
                judged = [c["label"] for c in panel["curve"] if not c.get("leaves")]
                values = [v for s in drawn["series"] if s["label"] in judged for v in s["y"]]
                self.assertEqual((float(row["least"]), float(row["greatest"])), (min(values), max(values)))
                ends = known_range(panel["y"])
                if ends is None:
                    self.assertEqual(row["verdict"], "axis unknown")
                    continue
                inside = ends[0] <= min(values) and max(values) <= ends[1]
                self.assertEqual(row["verdict"], "inside" if inside else "outside")
                # A reason stands where it is needed and nowhere else.
                self.assertEqual("outside" in panel, not inside)
                lines = [s["y"] for s in drawn["series"] if s["label"].startswith("printed axis ends")]
                if inside:
                    self.assertEqual([drawn["y"]["from"], drawn["y"]["to"]], ends)
                    self.assertEqual(lines, [])
                else:
                    self.assertIn(panel["outside"], drawn["note"])
                    self.assertLessEqual(drawn["y"]["from"], min(*values, ends[0]))
                    self.assertGreaterEqual(drawn["y"]["to"], max(*values, ends[1]))
                    self.assertEqual({v for line in lines for v in line},
                                     {e for e, out in ((ends[0], min(values) < ends[0]), (ends[1], max(values) > ends[1])) if out})

    def test_the_windows_of_the_printed_numbers_are_these_axes(self):
        """One reading of a figure's axis in one folder, or the reason for two."""
        held = 0
        for number in self.numbers["number"]:
            if number["measure"] != "range" or "Fig. " not in number["where"]:
                continue
            for figure in map(int, re.findall(r"\d+", number["where"].split("Fig. ")[1].split("(")[0])):
                for name, (of, panel) in self.panels.items():
                    if of["number"] == figure and any(c["channels"] == number["channels"] for c in panel["curve"]):
                        same = number["window"] == known_range(panel["y"])
                        self.assertEqual(same, "differs" not in panel, name)
                        held += 1
        self.assertGreater(held, 15)

    def test_numbers_of_the_figures(self):
        """Each number printed with a figure of the list stands beside it, with what both models give."""
        table = self.report["runs"][1]["table"]
        rows = [dict(zip(table["columns"], row)) for row in table["rows"]]
        (row,) = [r for r in rows if r["quantity"] == "torque from shaft to block at 0 deg" and r["figure"] == "31"]
        self.assertEqual((row["printed"], row["status"]), ("6.1 ± 0.05 Nm", "used to infer the geometry"))
        for model in ("analytic", "multibody"):
            first = self.run_case(model, "friction.block_viscous_Nm_per_rpm=0.0")[0]
            self.assertAlmostEqual(float(row[model]), float(first["Tcs_z2_Nm"]), 4)
        cited = {int(n) for r in rows for n in r["figure"].split(", ")}
        self.assertEqual(cited, {12, 13, 14, 17, 23, 30, 31, 32, 33, 36, 37})

    def test_windows_are_the_printed_axes(self):
        """A window of numbers.toml for one curve of a figure is that figure's axis, where figures.toml has it."""
        compared = 0
        for number in self.numbers["number"]:
            where = re.fullmatch(r"Fig\. (\d+)", number["where"])
            if not where or number["measure"] != "range" or "window" not in number:
                continue
            for figure, panel in self.panels.values():
                axis = known_range(panel["y"])
                drawn = [c["channels"] for c in panel.get("curve", []) if "channels" in c]
                factor = {c.get("factor", 1) for c in panel.get("curve", [])}
                if figure["number"] != int(where[1]) or axis is None or number["channels"] not in drawn or factor != {1}:
                    continue
                with self.subTest(number["where"], channels=number["channels"]):
                    self.assertEqual(number["window"], axis)
                compared += 1
        self.assertGreaterEqual(compared, 8)

    # ---- The curves against the commands that make them elsewhere

    def test_curves_of_a_turn(self):
        table = self.run_case("analytic")
        theta = [float(row["theta_deg"]) for row in table]
        rs = self.series("fig12", "Rs(z2)")
        self.assertEqual(rs["x"], [*theta, 360])
        self.assert_same(rs["y"], [float(r["Rs_1_z2_N"]) for r in [*table, table[0]]])
        pressure = self.series("fig10", "piston 1 pressure")
        self.assert_same(pressure["y"], [float(r["p_1_bar"]) / 275 for r in [*table, table[0]]])
        both = self.series("fig19", "Rc(x2), 1500 rpm, p*r")
        self.assertEqual(both["x"], [t + 360 * i for i in range(3) for t in theta] + [1080])
        self.assert_same(both["y"], [float(r["Rc_1_x2_N"]) for r in [*table * 3, table[0]]])
        peak = self.run_case("analytic", case="bap63_peak_hydraulic")
        self.assert_same(self.series("fig23", "Rb1 (y1), p*i")["y"], [float(r["Rb1_y1_N"]) for r in [*peak * 3, peak[0]]])

    def test_curves_of_the_papers_variants(self):
        free = self.run_case("analytic", "friction.block_viscous_Nm_per_rpm=0.0")
        self.assert_same(self.series("fig32_force", "Cc = 0")["y"], [float(r["Rcs_z4_N"]) for r in [*free, free[0]]])
        self.assert_same(self.series("fig34", "present model, Cc = 0")["y"],
                         [-math.cos(math.radians(20)) * float(r["Rcs_z4_N"]) for r in [*free, free[0]]])
        adams = self.run_case("multibody", "assumptions.multibody.piston_friction=false")
        self.assert_same(self.series("fig30", "ADAMS results")["y"], [float(r["Td_z1_Nm"]) for r in [*adams, adams[0]]])
        self.assertNotEqual(self.series("fig30", "ADAMS results")["y"], self.series("fig30", "present model")["y"])

    def test_curves_of_other_studies(self):
        self.run_program("inertia", program.REPO / "cases/bap63_rated.toml", "--map-size", "2", "--out", "inertia")
        table = read(self.folder / "inertia/inertia.csv")
        for figure, force in (("fig36", "Rc"), ("fig37", "Rs")):
            for label, kind in (("2 masses", "lumped"), ("real piston", "real")):
                for speed in (1500, 2350):
                    wanted = [float(r[f"multibody_{kind}_noload_{speed}rpm_{force}_1_magnitude_N"]) for r in [*table, table[0]]]
                    # That command has a scene of one piston.
                    self.assert_same(self.series(figure, f"{label}, {speed} rpm")["y"], wanted, 1e-9)
        self.run_program("pressure", program.REPO / "cases/bap63_rated_hydraulic.toml", "--delivery-bar", "0:350:175", "--out", "p")
        drawn = self.series("fig18", "simulation")
        self.assertEqual((drawn["x"][0], drawn["x"][-1], len(drawn["x"])), (0, 350, 15))
        for row in read(self.folder / "p/torque_curve.csv"):
            at = drawn["x"].index(float(row["delivery_bar"]))
            self.assertAlmostEqual(drawn["y"][at], float(row["mean_Td_analytic_Nm"]), 9)

    def test_drawings(self):
        """Coordinates of drawings have 9 digits in the JSON, as those of curves in the page."""
        geometry = tomllib.loads((program.REPO / "cases/bap63_rated_hydraulic.toml").read_text())["pump"]
        free = self.run_case("analytic", "friction.block_viscous_Nm_per_rpm=0.0")
        for figure, angle in (("fig31", 0), ("fig33", 38)):
            row = next(r for r in free if float(r["theta_deg"]) == angle)
            (frame,) = self.figures[figure]["frames"]
            self.assertEqual(frame["theta_deg"], angle)
            torque, scales = 0, []
            for k, arrow in enumerate(frame["arrows"]):
                at = math.radians(angle - 72 * k)
                radius = geometry["bore_circle_radius_mm"]
                self.assertAlmostEqual(arrow["x"], -radius * math.sin(at), 7)
                self.assertAlmostEqual(arrow["y"], radius * math.cos(at), 7)
                force = [-float(row[f"Rc_{k + 1}_{axis}2_N"]) for axis in "xy"]
                scales.append(math.hypot(arrow["dx"], arrow["dy"]) / math.hypot(*force))
                self.assertAlmostEqual(arrow["dx"] * force[1] / math.hypot(*force), arrow["dy"] * force[0] / math.hypot(*force), 7)
                torque += 1e-3 * (arrow["x"] * arrow["dy"] - arrow["y"] * arrow["dx"]) / scales[-1]
            self.assertEqual(len(scales), 5)
            self.assertAlmostEqual(min(scales) / max(scales), 1, 7)
            # What balances them is the torque that carries the block round.
            self.assertAlmostEqual(torque, -float(row["Tcs_z2_Nm"]), 6)
            self.assertIn(f"{torque:+.2f} Nm", frame["text"])
            self.assertIn("counter-clockwise" if angle else "2, clockwise", frame["text"])
            shares = self.figures[f"{figure}_shares_at_{angle}_deg"]["bars"]
            self.assertAlmostEqual(sum(bar["low"] + bar["high"] for bar in shares), -float(row["Tcs_z2_Nm"]), 9)
        (frame,) = self.figures["fig14b"]["frames"]
        self.assertEqual(frame["theta_deg"], 280)
        x = y = 0
        for arrow in frame["arrows"]:  # tip to tail, closed
            self.assertAlmostEqual(arrow["x"], x, 4)
            self.assertAlmostEqual(arrow["y"], y, 4)
            x, y = x + arrow["dx"], y + arrow["dy"]
        self.assertLess(math.hypot(x, y), 1e-8 * abs(frame["arrows"][0]["dx"]))
        # What is said of their sum is not rounded before.
        self.assertLess(float(re.search(r"sum (\S+) N", frame["text"])[1]), 1e-11 * abs(frame["arrows"][0]["dx"]))
        # Fig. 13: x2 negative in delivery, y2 negative up to 270 deg and positive from there.
        r1, r2 = self.figures["fig13"]["frames"]
        signs = [[math.copysign(1, arrow["dy"]) for arrow in frame["arrows"]] for frame in (r1, r2)]
        self.assertEqual(signs, [[-1, -1], [-1, 1]])

    def test_models_agree(self):
        differences = [row["other model, of peak"] for row in self.rows().values() if row["other model, of peak"] is not None]
        self.assertEqual(len(differences), len(self.panels))
        self.assertLess(max(differences), 1e-11)
        self.assertIsNone(self.report["verdict"]["agrees"])

    # ---- Lists that are changed

    def changed(self, *changes):
        shutil.copy(self.data / "numbers.toml", self.folder / "numbers.toml")
        text = (self.data / "figures.toml").read_text()
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new, 1)
        (self.folder / "figures.toml").write_text(text)
        return "paper", "--list", "figures.toml", "--out", "changed"

    def test_a_curve_outside_its_axis_is_said(self):
        result = self.run_program(*self.changed(("labels = [-2000, 2000, 12000]", "labels = [-400, 200, 11000]")))
        self.assertRegex(result.out, r"Fig. 12 +outside")
        report = json.loads((self.folder / "changed/paper.json").read_text())
        self.assertIn("outside: Fig. 10; Fig. 12; Fig. 25", report["verdict"]["headline"])
        (figure,) = [f for f in report["figures"] if f["id"] == "fig12"]
        least = min(self.series("fig12", "Rs(x2)")["y"])
        greatest = max(self.series("fig12", "Rs(z2)")["y"])
        self.assertIn(f"Rs(z2) is above the axis by {greatest - 11000:.3g} N", figure["note"])
        self.assertIn(f"Rs(x2) is below the axis by {-400 - least:.3g} N", figure["note"])
        self.assertLess(figure["y"]["from"], least)
        self.assertGreater(figure["y"]["to"], greatest)
        self.assertEqual([s["y"] for s in figure["series"][-2:]], [[-400, -400], [11000, 11000]])

    def test_bad_lists_are_refused(self):
        for old, new, words in (
                ("labels = [-2000, 2000, 12000]", "labels = [-2000, 3000, 12000]", ("labels", "whole steps")),
                ("labels = [-2000, 2000, 12000]", "labels = [-2000, 2000, 12000], axis = [0, 12000]", ("axis", "hold its labels")),
                ("labels = [-2000, 2000, 12000]", "axis = [0, 12000]", ("why",)),
                ('condition = "rated"\nangles', 'condition = "raced"\nangles', ("condition", "raced")),
                ('channels = ["Rs_1_x2_N"]', 'channels = ["Rs_1_x9_N"]', ("Rs_1_x9_N",)),
                ('over = "delivery_bar"', 'over = "delivery"', ("delivery",)),
                ("number = 12\n", "number = 10\n", ("fig10", "duplicate")),
                ('file = "bap63_peak_hydraulic.toml"', 'file = "bap63_rated_hydraulic.toml"', ("peak load", "delivery_bar is 275")),
                ("kind = \"curves\"", "kind = \"curve\"", ("kind",)),
                ("angles = [280]", "angles = [360]", ("angles",))):
            with self.subTest(new):
                arguments = self.changed((old, new))
                result = self.run_program(*arguments, status=BAD_INPUT)
                self.assertEqual(result.err.count("\n"), 1, result.err)
                for word in words:
                    self.assertIn(word, result.err)
                self.assertFalse((self.folder / "changed/paper.html").exists())

    def test_page(self):
        page_test.CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
        if not page_test.CHROMIUM:
            self.skipTest("no Chromium")
        text = (self.place / "out/paper.html").read_text()
        head, end = text.index("<head>") + len("<head>"), text.rindex("</body>")
        (self.folder / "probed.html").write_text(
            text[:head] + page_test.CATCH_ERRORS + text[head:end] + f"<script>{PROBE}</script>" + text[end:])
        for width in (1280, 390):
            frame = self.folder / "frame.html"
            frame.write_text(page_test.FRAME % ("probed.html", width, 900))
            dump = page_test.chromium(self.folder, frame, (max(width, 500), 900), "--dump-dom")
            answer = re.search(r'<pre id="result"[^>]*>(.*?)</pre>', dump, re.S)
            found = json.loads(page_test.html.unescape(answer[1]))
            self.assertEqual((found["errors"], found["missing"]), ([], []), width)
            self.assertEqual(found["count"], len(self.figures))
            self.assertGreaterEqual(found["rows"], len(self.rows()))
            self.assertEqual(found["scroll"][0], found["scroll"][1], width)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program.PROGRAM, program.REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
