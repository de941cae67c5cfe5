#!/usr/bin/env python3
"""Tests of the pump in three dimensions as the page draws it, read back from the drawn objects in headless Chromium.

usage: scene_page_test.py BENTAXIS REPO_ROOT [options of unittest]

With BENTAXIS_SCENE_PICTURES=1 the stored small pictures are written anew (then look at them). Without Chromium: exit status 77.
"""

import csv
import html
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

import report_page_test as pages

ROWS = (0, 5, 17, 23, 34)
WEBGL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")
DRAWN = 2e-6     # of a length or of a body's largest load: what is left of 32-bit floats
WIDE, HIGH = 48, 32  # px of a stored picture
# Greys from 0 to 255: largest mean difference, and largest of blocks of 4 x 4 px. The same program draws the same picture;
# another rasteriser puts edges elsewhere by parts of a pixel, as drawing it 1.37 times larger does. test_pictures holds
# that this stays within half of these, and that a turn by 40 deg does not.
MEAN, BLOCK = 3.0, 12.0
CASES = {name: f"cases/{name}.toml" for name in ("bap63_rated", "bap63_teeth", "bap63_as_compared_in_the_paper")} | {
    name: f"reference_data/hard/{name}/case.toml" for name in ("pistons_4", "tilt_45", "offset_plus")}

PROBE = r"""
(async () => {
  const wait = time => new Promise(done => setTimeout(done, time));
  const root = document.documentElement, S = window.bentaxisScene, result = { errors: window.probeErrors };
  for (let i = 0; i < 200 && !root.dataset.ready; ++i) await wait(50);
  try {
    result.webgl = S.webgl();
    result.text = document.querySelector("#space").textContent;
    result.still = document.querySelectorAll("#space .space svg").length;
    if (result.webgl) {
      result.rows = @ROWS@.map(i => {
        S.setRow(i);
        S.select(null);
        S.show(true);
        const states = [0, 1].map(m => { S.model(String(m)); return S.state(); });
        const free = {};
        for (const name of ["shaft", "block", "piston 1", "piston 4"]) {
          S.select(name);
          free[name] = [0, 1].map(m => { S.model(String(m)); return S.state(); });
          free[name].sums = S.sumOf(name);
        }
        S.select(null);
        return { i, states, free, sums: Object.fromEntries(Object.keys(free).map(n => [n, S.sumOf(n)])) };
      });
      S.model("0");
      result.tags = {};
      for (const view of ["free", "side"]) for (const i of [0, 7]) {
        S.setRow(i);
        S.select(null);
        S.show(true);
        S.view(view);
        S.drawNow();
        const frame = document.querySelector("#space canvas").getBoundingClientRect();
        const box = e => (b => [b.left - frame.left, b.top - frame.top, b.right - frame.left, b.bottom - frame.top])(e.getBoundingClientRect());
        result.tags[view + i] = { size: [frame.width, frame.height],
          shown: [...document.querySelectorAll("#space .tags span")].map(e => [e.textContent, ...box(e)]),
          arrows: [...new Set(S.state().arrows.filter(a => !a.none).map(a => a.label))] };
      }
      S.view("free");
      S.show(["Rs", "Rc"]);
      const grey = (i, larger = 10) => {
        S.setRow(i);
        const picture = S.still("free", Math.round(larger * @WIDE@), Math.round(larger * @HIGH@)), small = document.createElement("canvas");
        small.width = @WIDE@; small.height = @HIGH@;
        const pen = small.getContext("2d");
        pen.fillStyle = "#fff";
        pen.fillRect(0, 0, @WIDE@, @HIGH@);
        pen.imageSmoothingQuality = "high";
        pen.drawImage(picture, 0, 0, @WIDE@, @HIGH@);
        const d = pen.getImageData(0, 0, @WIDE@, @HIGH@).data;
        return Array.from({ length: @WIDE@ * @HIGH@ }, (_, p) => Math.round((d[4 * p] + d[4 * p + 1] + d[4 * p + 2]) / 3));
      };
      result.picture = grey(5);
      result.larger = grey(5, 13.7);
      result.turned = grey(9);
    }
    // Keyboard, and the cursor both ways.
    const canvas = document.querySelector("#space canvas"), plot = [...document.querySelectorAll(".plot")][0];
    S.setRow(3);
    if (canvas) canvas.dispatchEvent(new KeyboardEvent("keydown", { key: ".", bubbles: true }));
    result.stepped = S.row();
    if (plot) {
      dispatchEvent(new Event("beforeprint"));  // draws it: without frames nothing is seen to come near
      plot.scrollIntoView({ behavior: "instant" });
      await wait(3000);
      const figure = plot.closest("figure"), reading = () => figure.querySelector(".readout .angle").textContent;
      S.setRow(12);
      await wait(3000);
      result.told = reading();
      const box = plot.getBoundingClientRect();
      const at = { bubbles: true, clientX: box.left + 0.75 * box.width, clientY: box.top + box.height / 2 };
      const inner = plot.querySelector("canvas:last-of-type");
      inner.dispatchEvent(new MouseEvent("mouseover", at));
      inner.dispatchEvent(new MouseEvent("mousemove", at));
      result.pointed = reading();
      document.querySelector("#space").scrollIntoView({ behavior: "instant" });
      await wait(3000);
      result.followed = S.row();
    }
  } catch (error) {
    result.errors.push("probe: " + error.stack);
  }
  const out = document.createElement("pre");
  out.id = "probe-result";
  out.textContent = JSON.stringify(result);
  document.body.append(out);
})();
"""


def probe(folder, page, *options, size=(1280, 900)):
    """What PROBE finds in a page."""
    text = page.read_text()
    script = PROBE.replace("@ROWS@", str(list(ROWS))).replace("@WIDE@", str(WIDE)).replace("@HIGH@", str(HIGH))
    head, end = text.index("<head>") + 6, text.rindex("</body>")
    probed = page.with_name("probed.html")
    probed.write_text(text[:head] + pages.CATCH_ERRORS + text[head:end] + f"<script>{script}</script>" + text[end:])
    dump = pages.chromium(folder, probed, size, "--dump-dom", *options)
    found = re.search(r'<pre id="probe-result">(.*?)</pre>', dump, re.S)
    if not found:
        raise RuntimeError(f"{page}: nothing found")
    return json.loads(html.unescape(found[1]))


def length(v):
    return math.sqrt(sum(x * x for x in v))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


class SceneTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="bentaxis_scene_")))
        cls.found = {}
        for name, case in CASES.items():
            done = subprocess.run([PROGRAM, "compare", str(REPO / case), "--set",
                                   "operation.samples_per_revolution=36", "--out", name], cwd=cls.folder,
                                  capture_output=True, text=True, timeout=pages.SECONDS)
            if done.returncode not in (0, 1):
                raise RuntimeError(f"{name}: {done.stdout}{done.stderr}")
            cls.found[name] = probe(cls.folder, cls.folder / name / "report.html", *WEBGL)

    def table(self, name, model):
        with open(self.folder / name / f"{model}.csv", newline="") as file:
            return [{k: float(v) if v else math.nan for k, v in row.items()} for row in csv.DictReader(file)]

    def near(self, found, expected, size, what):
        self.assertLessEqual(length([a - b for a, b in zip(found, expected)]), DRAWN * size, f"{what}: {found} {expected}")

    def test_no_errors(self):
        for name, found in self.found.items():
            self.assertEqual(found["errors"], [], name)
            self.assertTrue(found["webgl"], name)

    def test_places_and_arrows_are_those_of_the_tables(self):
        """docs/theory.md, frames and (9), (11), written out anew; forces from the CSV files."""
        for name, case in CASES.items():
            pump = tomllib.loads((REPO / case).read_text())["pump"]
            tilt, count = math.radians(pump["tilt_deg"]), pump["pistons"]
            ra, rd, b, b1 = (1e-3 * pump[k] for k in ("joint_circle_radius_mm", "bore_circle_radius_mm", "axis_offset_mm",
                                                      "piston_length_mm"))
            c, s = math.cos(tilt), math.sin(tilt)
            turned = lambda x, y, z: [x, c * y + s * z, -s * y + c * z]
            tables = [self.table(name, m) for m in ("analytic", "multibody")]
            compared = 0
            for row in self.found[name]["rows"]:
                for model, state in enumerate(row["states"]):
                    values, first = tables[model][row["i"]], tables[0][row["i"]]
                    theta = math.radians(values["theta_deg"])
                    bodies = {body["name"]: body for body in state["bodies"]}
                    arrows = {(a["id"], a["kind"]): a for a in state["arrows"]}
                    self.near(bodies["block"]["origin"], [0, 0, b], 1, "O2")
                    for k, axis in enumerate([turned(math.cos(theta), math.sin(theta), 0), turned(-math.sin(theta), math.cos(theta), 0),
                                              turned(0, 0, 1)]):
                        self.near(bodies["block"]["axes"][k], axis, 1, "block")
                    for k in range(1, count + 1):
                        angle = theta - 2 * math.pi * (k - 1) / count
                        joint = [-ra * math.sin(angle), ra * math.cos(angle), 0]
                        ring = turned(-rd * math.sin(angle), rd * math.cos(angle), 1e-3 * first[f"zB_{k}_z2_mm"])
                        ring[2] += b
                        along = [(q - p) / b1 for p, q in zip(joint, ring)]
                        body = bodies[f"piston {k}"]
                        self.near(body["origin"], joint, 1, f"A{k}")
                        self.near(body["axes"][2], along, 1, f"axis of piston {k}")
                        peak = max(length([r[f"Rs_{k}_{x}2_N"] for x in "xyz"]) for r in tables[model])
                        arrow = arrows[f"Rs_{k}", "force"]
                        self.near(arrow["tail"], joint, 1, f"tail of Rs_{k}")
                        self.near(arrow["vector"], turned(*(values[f"Rs_{k}_{x}2_N"] for x in "xyz")), peak, f"Rs_{k}")
                        arrow = arrows[f"Rc_{k}", "force"]
                        self.near(arrow["tail"], ring, 1, f"tail of Rc_{k}")
                        self.near(arrow["vector"], turned(values[f"Rc_{k}_x2_N"], values[f"Rc_{k}_y2_N"], 0), peak, f"Rc_{k}")
                        compared += 2
                    vector = [values[f"Rb1_{x}1_N"] for x in "xyz"]
                    self.near(arrows["Rb1", "force"]["vector"], vector, length(vector), "Rb1")
            self.assertEqual(compared, 2 * 2 * count * len(ROWS))

    def test_arrows_of_a_free_body_sum_to_zero(self):
        for name, found in self.found.items():
            for row in found["rows"]:
                for body, states in row["free"].items():
                    for model, state in enumerate(states):
                        arrows = state["arrows"]
                        self.assertGreater(len(arrows), 3, body)
                        forces = [a for a in arrows if a["kind"] == "force"]
                        moments = [a["vector"] for a in arrows if a["kind"] == "moment"]
                        moments += [cross(a["tail"], a["vector"]) for a in forces]
                        for vectors in ([a["vector"] for a in forces], moments):
                            rest = length([sum(v[k] for v in vectors) for k in range(3)])
                            self.assertLessEqual(rest, DRAWN * sum(map(length, vectors)), (name, row["i"], body, model))
                        # One left out is noticed.
                        largest = max(forces, key=lambda a: length(a["vector"]))
                        rest = length([sum(a["vector"][k] for a in forces if a is not largest) for k in range(3)])
                        self.assertGreater(rest, 100 * DRAWN * sum(length(a["vector"]) for a in forces))
                        self.assertLessEqual(row["sums"][body][model]["force_over_sum"], DRAWN)
                        self.assertLessEqual(row["sums"][body][model]["moment_over_sum"], DRAWN)

    def tags_are_apart(self, found):
        for view, tags in found["tags"].items():
            with self.subTest(view):
                names = [name for name, *_ in tags["shown"]]
                self.assertEqual(sorted(names), sorted(tags["arrows"]), "each arrow that is shown has its name, once")
                self.assertGreater(len(names), 10)
                wide, high = tags["size"]
                for i, (name, left, top, right, bottom) in enumerate(tags["shown"]):
                    self.assertTrue(left >= -1 and top >= -1 and right <= wide + 1 and bottom <= high + 1, (name, left, top))
                    for other, l, t, r, b in tags["shown"][i + 1:]:
                        self.assertFalse(left < r - 1 and l < right - 1 and top < b - 1 and t < bottom - 1, f"{name} over {other}")

    def test_names_of_arrows_do_not_overlap(self):
        for name, found in self.found.items():
            with self.subTest(name):
                self.tags_are_apart(found)

    def test_names_of_arrows_on_a_narrow_screen(self):
        found = probe(self.folder, self.folder / "bap63_rated" / "report.html", *WEBGL, size=(500, 900))
        self.assertEqual(found["errors"], [])
        self.tags_are_apart(found)

    def test_only_the_body_is_left(self):
        for row in self.found["bap63_rated"]["rows"]:
            for body, states in row["free"].items():
                self.assertEqual([b["name"] for b in states[0]["bodies"] if b["visible"]], [body])

    def test_keyboard_and_cursor(self):
        for name, found in self.found.items():
            self.assertEqual(found["stepped"], 4, name)
            self.assertIn("120", found["told"], name)
            pointed = float(re.match(r"[\d.]+", found["pointed"])[0])
            self.assertGreater(pointed, 180)
            self.assertEqual(found["followed"], round(pointed / 10), name)

    def test_pictures(self):
        store = REPO / "tests" / "scene_pictures"
        for name, found in self.found.items():
            with self.subTest(name):
                file = store / f"{name}.pgm"
                if os.environ.get("BENTAXIS_SCENE_PICTURES"):
                    store.mkdir(exist_ok=True)
                    rows = [" ".join(map(str, found["picture"][i:i + WIDE])) for i in range(0, WIDE * HIGH, WIDE)]
                    file.write_text(f"P2\n{WIDE} {HIGH}\n255\n" + "\n".join(rows) + "\n")
                mean, block = self.apart(found["larger"], found["picture"])
                self.assertLessEqual(mean, MEAN / 2)
                self.assertLessEqual(block, BLOCK / 2)
                stored = [int(v) for v in file.read_text().split()[4:]]
                mean, block = self.apart(stored, found["picture"])
                self.assertLessEqual(mean, MEAN)
                self.assertLessEqual(block, BLOCK)
                self.assertGreater(self.apart(stored, found["turned"])[1], BLOCK, "a turn is not noticed")

    @staticmethod
    def apart(a, b):
        """Mean difference, and the largest of blocks of 4 x 4 px."""
        gap = [x - y for x, y in zip(a, b)]
        blocks = [abs(sum(gap[(j + v) * WIDE + i + u] for u in range(4) for v in range(4))) / 16
                  for j in range(0, HIGH, 4) for i in range(0, WIDE, 4)]
        return sum(map(abs, gap)) / len(gap), max(blocks)

    def test_without_webgl(self):
        found = probe(self.folder, self.folder / "bap63_rated" / "report.html", "--disable-3d-apis")
        self.assertEqual(found["errors"], [])
        self.assertFalse(found["webgl"])
        self.assertIn("no WebGL", found["text"])
        self.assertEqual(found["still"], 1)

    def test_scene_with_curves_of_its_own(self):
        """Beside curves of another kind (here of the oil) the view is there without being asked for."""
        subprocess.run([PROGRAM, "pressure", str(REPO / "cases/bap63_rated_hydraulic.toml"), "--out", str(self.folder / "oil")],
                       check=True, capture_output=True)
        page = html.unescape(pages.chromium(self.folder, self.folder / "oil" / "pressure.html", (1280, 900), "--dump-dom", *WEBGL))
        self.assertIn('data-ready="true"', page)
        self.assertRegex(page, r">At 0\sdeg: Rs on piston \d [1-9][\d.]+\skN;")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    PROGRAM, REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    pages.CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if not pages.CHROMIUM:
        print("scene_page_test: SKIPPED: no Chromium found; scripts/setup test installs it", file=sys.stderr)
        sys.exit(pages.NO_CHROMIUM)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
