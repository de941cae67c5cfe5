#!/usr/bin/env python3
"""Tests of the report as a reader sees it: opened in headless Chromium, wide and narrow.

usage: report_page_test.py BENTAXIS REPO_ROOT [options of unittest]

Every page is opened at one or two widths, the default one at all; with BENTAXIS_EVERY_WIDTH=1 every page at all.
With BENTAXIS_SCREENSHOTS=DIR the pages are also saved there as pictures. Without Chromium: exit status 77.
"""

import html
import html.parser
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

WIDTHS = (1280, 800, 390)
LARGEST_PAGE = 3_500_000  # bytes per turn of 720 samples
SECONDS = 300             # no single command may take longer
NO_CHROMIUM = 77

PROGRAM = REPO = CHROMIUM = None  # set in main

# Text that would become markup if it were not escaped.
HOSTILE_NAME = "one <b>piston</b> & \\\"quotes\\\" </script><img src=x onerror=alert(1)> \u00e9\u4e2d"


class Report:
    """What is compared: a case of the repository with changed lines, and options of `compare`."""

    def __init__(self, options=(), changes=(), status=0, word="Agrees"):
        self.options, self.changes, self.status, self.word = options, changes, status, word

    def case(self):
        text = (REPO / "cases" / "bap63_rated.toml").read_text()
        for pattern, replacement in self.changes:
            text, count = re.subn(pattern, lambda _: replacement, text, flags=re.M)
            assert count == 1, f"{pattern}: {count} times in the case"
        return text


REPORTS = {
    "default": Report(),
    "unequal": Report(["--multibody", "gear=imposed", "piston_friction=off"], word="Explained"),
    "integrated": Report(["--way", "integrated"], [("^revolutions = .*", "revolutions = 3")]),
    "single": Report(changes=[("^pistons = 5", "pistons = 1"), ("^name = .*", f'name = "{HOSTILE_NAME}"')],
                     word="Agrees; not valid over 100 % of the turn"),
    "many": Report(changes=[("^pistons = 5", "pistons = 15"), ("_revolution = 720", "_revolution = 90"),
                            ("^bore_diameter_mm = .*", "bore_diameter_mm = 8.0")]),
    "one_angle": Report(changes=[("_revolution = 720", "_revolution = 1")]),
    "differing": Report(["--multibody-case", "other.toml"], status=1, word="Differs"),
}
OTHER_CASE = [("^tilt_deg = 40.0", "tilt_deg = 40.4")]  # for the multibody model of "differing"
# What is narrow is hardest, most of all with the most pistons.
WIDTHS_OF = {"default": WIDTHS, "many": (1280, 390), "unequal": (390,), "integrated": (800,), "single": (390,), "one_angle": (800,),
             "differing": (390,)}
WITHOUT_CURVES = {"one_angle"}                          # one angle makes no curve

# Runs in the page under test, which stands in a frame of the width to be tried (windows cannot be made as narrow as
# a telephone). Waits until the page says that it is ready, measures, and hands the measurements to the outer page.
PROBE = r"""
(async () => {
  const root = document.documentElement;
  const wait = time => new Promise(done => setTimeout(done, time));
  for (let i = 0; i < 200 && !root.dataset.ready; ++i) await wait(50);
  await wait(300);

  // Words by which a reader of the test finds an element.
  const name = e => {
    const at = e.closest("[id]");
    const classes = typeof e.className === "string" ? e.className : e.className.baseVal;
    return `${e.tagName.toLowerCase()}${classes ? "." + classes.trim().replace(/\s+/g, ".") : ""}`
      + ` in #${at ? at.id : ""} "${e.textContent.trim().slice(0, 40)}"`;
  };
  const shown = e => e.checkVisibility({ checkVisibilityCSS: true });
  const scrolls = e => /auto|scroll/.test(getComputedStyle(e).overflowX);
  const parents = function* (e) { for (let p = e.parentElement; p; p = p.parentElement) yield p; };
  const scroller = e => [...parents(e)].find(scrolls);
  // Taken out of sight on purpose, for readers who hear the page; or no text at all.
  const hidden = e => [e, ...parents(e)].some(p => p.getBoundingClientRect().right < -1000
    || getComputedStyle(p).clipPath.startsWith("inset(50%") || /script|style|title/i.test(p.tagName));

  const texts = () => {
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    const found = [];
    while (walker.nextNode()) {
      const node = walker.currentNode, parent = node.parentElement;
      if (!node.textContent.trim() || !shown(parent) || hidden(parent)) continue;
      const range = document.createRange();
      range.selectNodeContents(node);
      found.push({ parent, box: range.getBoundingClientRect() });
    }
    return found;
  };

  const measure = () => {
    const width = root.clientWidth, wide = [];
    for (const e of document.querySelectorAll("main *, header *, nav *")) {
      if (!shown(e) || hidden(e) || scroller(e) && scroller(e) !== e) continue;
      const box = e.getBoundingClientRect();
      if (box.right > width + 1 || box.left < -1) wide.push(name(e));
    }
    for (const e of document.querySelectorAll("table, .plot, .bars svg, canvas")) {
      if (!shown(e)) continue;
      const box = e.getBoundingClientRect();
      for (const p of parents(e)) {
        if (scrolls(p)) break;
        if (box.width > p.getBoundingClientRect().width + 1) { wide.push(name(e) + " in " + name(p)); break; }
      }
    }
    const all = texts();
    return {
      scrollWidth: root.scrollWidth, clientWidth: width, scrollHeight: root.scrollHeight, wide,
      empty: all.filter(t => t.box.width < 1 || t.box.height < 1).map(t => name(t.parent)),
      outside: all.filter(t => !scroller(t.parent) && (t.box.left < -1 || t.box.right > width + 1))
                  .map(t => name(t.parent)),
      cut: all.map(t => t.parent).filter(e => getComputedStyle(e).overflowX === "hidden"
                                         && e.scrollWidth > e.clientWidth + 1).map(name),
    };
  };

  // A line of text is some 8 px higher than its figures.
  const overlaps = boxes => {
    const found = [];
    boxes.forEach((a, i) => boxes.slice(i + 1).forEach(b => {
      const across = Math.min(a.box.right, b.box.right) - Math.max(a.box.left, b.box.left);
      const down = Math.min(a.box.bottom, b.box.bottom) - Math.max(a.box.top, b.box.top);
      if (across > 1 && down > 7) found.push(`${a.text} / ${b.text}`);
    }));
    return found;
  };
  const labels = (e, selector) => [...e.querySelectorAll(selector)].filter(shown).map(l => {
    const range = document.createRange();
    range.selectNodeContents(l);
    return { text: l.textContent.trim(), box: range.getBoundingClientRect() };
  }).filter(l => l.text);
  const drawn = canvas => {
    if (!canvas.width || !canvas.height) return false;
    const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    for (let i = 3; i < pixels.length; i += 4) if (pixels[i]) return true;
    return false;
  };
  const plots = () => [...document.querySelectorAll(".plot")].map(e => {
    const box = e.getBoundingClientRect(), canvases = [...e.querySelectorAll("canvas")];
    const low = e.classList.contains("low");
    return { name: name(e), width: box.width, height: box.height, drawn: canvases.some(drawn),
             canvas: Math.max(0, ...canvases.map(c => c.getBoundingClientRect().width)),
             figure: e.closest("figure").id, low,
             xTicks: labels(e, ".dygraph-axis-label-x").length, yTicks: labels(e, ".dygraph-axis-label-y").length,
             xLabel: labels(e, ".dygraph-xlabel").map(l => l.text).join(), overlaps:
             overlaps(labels(e, ".dygraph-axis-label, .dygraph-xlabel, .dygraph-ylabel")),
             yLabel: labels(e, ".dygraph-ylabel").map(l => l.text).join(),
             outside: labels(e, ".dygraph-axis-label, .dygraph-xlabel, .dygraph-ylabel").filter(l =>
               l.box.left < box.left - 1 || l.box.right > box.right + 1 || l.box.bottom > box.bottom + 1)
               .map(l => l.text) };
  });
  const charts = selector => [...document.querySelectorAll(selector)].map(e => {
    const box = e.getBoundingClientRect();
    return { name: name(e), width: box.width, height: box.height, bars: e.querySelectorAll("rect").length,
             axes: labels(e, "text.axis").map(l => l.text), ticks: labels(e, "text:not(.axis)").length,
             overlaps: overlaps(labels(e, "text")) };
  });
  const groups = () => [...document.querySelectorAll("table.comparison tbody.group > tr")].map(row => {
    const cell = head => row.querySelector(`[data-head="${head}"] > div`).textContent;
    return { name: row.querySelector("button").textContent, verdict: cell("Verdict"), of_peak: cell("of peak") };
  });
  const spot = selector => {
    const e = document.querySelector(selector);
    if (!e || !shown(e)) return null;
    const box = e.getBoundingClientRect();
    return { text: e.textContent, left: box.left, right: box.right, top: box.top + scrollY, height: box.height };
  };

  // The page's own message where it could not be drawn.
  const failure = [...document.querySelectorAll("[role=alert]")].map(e => e.textContent);
  const result = { errors: window.probeErrors.concat(failure), ready: root.dataset.ready };
  try {
    // Curves are drawn when they come near; the contents stay where they are.
    const canvases = () => [...document.querySelectorAll(".plot")].filter(e => e.querySelector("canvas")).length;
    const atFirst = canvases(), walked = [];
    const says = () => document.querySelector("#contents .where").textContent;
    for (const e of document.querySelectorAll("main > section, figure")) {
      e.scrollIntoView({ behavior: "instant" });
      await wait(120);
      // It is told by frames, of which a busy machine shows few.
      for (let i = 0; i < 30 && !says() && walked.length === 0; ++i) await wait(100);
      const box = document.getElementById("contents").getBoundingClientRect();
      const at = e.getBoundingClientRect();
      walked.push({ id: e.id, top: at.top, contents: [box.top, box.bottom],
                    says: says() });
    }
    // Chromium shows no frames while it only dumps the page, so that nothing comes near: as for print, all are drawn.
    dispatchEvent(new Event("beforeprint"));
    result.walk = { atFirst, atLast: canvases(), walked, sections: [...document.querySelectorAll("main > section")].map(e => e.id) };
    scrollTo({ top: 0, behavior: "instant" });
    await wait(100);
    Object.assign(result, { first: measure(), plots: plots(), bars: charts(".bars:not(.drawing) svg"),
      drawings: charts(".drawing svg"), groups: groups(), title: document.title,
      heading: document.querySelector("h1") && document.querySelector("h1").textContent,
      figures: document.querySelectorAll("figure").length, word: spot(".banner .word"),
      headline: spot(".banner .headline"), images: document.images.length,
      loaded: performance.getEntriesByType("resource").map(r => r.name) });
    // Everything that can be opened.
    document.querySelectorAll("details").forEach(d => { d.open = true; });
    document.querySelectorAll("main [aria-expanded=false]").forEach(b => b.click());
    await wait(300);
    result.opened = measure();
  } catch (error) {
    result.errors.push("probe: " + error.stack);
  }
  parent.postMessage(JSON.stringify(result), "*");
})();
"""
CATCH_ERRORS = """<script>
window.probeErrors = [];
addEventListener("error", e => probeErrors.push(e.message));
addEventListener("unhandledrejection", e => probeErrors.push(String(e.reason)));
</script>"""
FRAME = """<!DOCTYPE html><html><body style="margin:0">
<script>addEventListener("message", e => { document.getElementById("result").textContent = e.data; });</script>
<pre id="result" hidden></pre>
<iframe src="%s" style="border:0; display:block; width:%dpx; height:%dpx"></iframe>
</body></html>"""


def chromium(folder, page, size, *options):
    """Opens a page and returns what Chromium prints."""
    with tempfile.TemporaryDirectory(dir=folder, ignore_cleanup_errors=True) as profile:
        command = [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
                   "--disable-background-networking", "--disable-component-update", "--disable-sync",
                   "--disable-dev-shm-usage", "--hide-scrollbars", f"--user-data-dir={profile}",
                   f"--window-size={size[0]},{size[1]}", "--virtual-time-budget=20000", *options, page.as_uri()]
        # In a session of its own, to be ended with all its helpers.
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True, start_new_session=True)
        try:
            out, err = process.communicate(timeout=SECONDS)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            raise
    if process.returncode != 0:
        raise RuntimeError(f"Chromium ended with {process.returncode}: {err}")
    return out


class References(html.parser.HTMLParser):
    """Collects what a page would load or lead to."""

    def __init__(self, page):
        super().__init__()
        self.found, self.style, self.in_style = [], "", False
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        self.in_style = tag == "style"
        for name, value in attributes:
            if name in ("src", "href", "srcset", "data", "action", "poster", "background"):
                self.found.append(value or "")
            if name == "style":
                self.style += value

    def handle_endtag(self, tag):
        self.in_style = False

    def handle_data(self, data):
        if self.in_style:
            self.style += data


class PageTest(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="bentaxis_page_")))
        cls.pages = {}
        for name, report in REPORTS.items():
            folder = cls.folder / name
            folder.mkdir()
            (folder / "case.toml").write_text(report.case())
            (folder / "other.toml").write_text(Report(changes=OTHER_CASE).case())
            done = subprocess.run([PROGRAM, "compare", "case.toml", "--out", "out", *report.options], cwd=folder,
                                  capture_output=True, text=True, timeout=SECONDS)
            if done.returncode != report.status:
                raise RuntimeError(f"{name}: status {done.returncode}\n{done.stdout}{done.stderr}")
            cls.pages[name] = folder / "out" / "report.html"
        every = os.environ.get("BENTAXIS_EVERY_WIDTH") == "1"
        cls.measured = {(name, width): cls.measure(name, width) for name in REPORTS for width in (WIDTHS if every else WIDTHS_OF[name])}

    @classmethod
    def measure(cls, name, width):
        """Measurements of a page in a frame of the given width."""
        folder = cls.folder / name
        text = cls.pages[name].read_text()
        head, end = text.index("<head>") + len("<head>"), text.rindex("</body>")
        (folder / "probed.html").write_text(
            text[:head] + CATCH_ERRORS + text[head:end] + f"<script>{PROBE}</script>" + text[end:])
        frame = folder / f"frame_{width}.html"
        frame.write_text(FRAME % ("probed.html", width, 900))
        dump = chromium(folder, frame, (max(width, 500), 900), "--dump-dom")
        found = re.search(r'<pre id="result"[^>]*>(.*?)</pre>', dump, re.S)
        if not found or not found[1]:
            raise RuntimeError(f"{name} at {width} px: the page measured nothing\n{dump[:2000]}")
        result = json.loads(html.unescape(found[1]))
        pictures = os.environ.get("BENTAXIS_SCREENSHOTS")
        if pictures:
            height = min(result["first"]["scrollHeight"], 16000)
            frame.write_text(FRAME % (cls.pages[name].as_uri(), width, height))
            pathlib.Path(pictures).mkdir(parents=True, exist_ok=True)
            picture = pathlib.Path(pictures).resolve() / f"{name}_{width}.png"
            chromium(folder, frame, (width, height), f"--screenshot={picture}")
        return result

    def of(self, report):
        pages = [page for (name, _), page in self.measured.items() if name == report]
        self.assertGreater(len(pages), 0)
        return pages

    def test_size(self):
        for name, file in self.pages.items():
            with self.subTest(name):
                turns = 3 if name == "integrated" else 1
                self.assertLessEqual(file.stat().st_size, turns * LARGEST_PAGE)

    def test_loads_nothing(self):
        for name, file in self.pages.items():
            with self.subTest(name):
                references = References(file.read_text())
                self.assertEqual([r for r in references.found if not r.startswith("#") and r != "data:,"], [])
                self.assertNotIn("@import", references.style)
                self.assertEqual([u for u in re.findall(r"url\(([^)]*)\)", references.style)
                                  if not u.strip("'\" ").startswith(("data:", "#"))], [])
        for (name, width), page in self.measured.items():
            with self.subTest(name, width=width):
                self.assertEqual(page["loaded"], [])

    def test_ready_without_errors(self):
        for (name, width), page in self.measured.items():
            with self.subTest(name, width=width):
                self.assertEqual(page["errors"], [])
                self.assertEqual(page["ready"], "true")

    def test_what_is_asked_first_comes_first(self):
        order = ["verdict", "warnings", "pump", "space", "key", "comparison", "assumptions", "validity", "budget", "published",
                 "figures", "runs", "checks", "common", "case", "derived", "models", "versions"]
        for (name, width), page in self.measured.items():
            with self.subTest(name, width=width):
                sections = page["walk"]["sections"]
                self.assertEqual(sections, [s for s in order if s in sections])
                self.assertIn("key", sections)

    def test_curves_are_drawn_when_they_come_near(self):
        for (name, width), page in self.measured.items():
            with self.subTest(name, width=width):
                walk, plots = page["walk"], len(page["plots"])
                self.assertEqual(walk["atLast"], plots)
                if name not in WITHOUT_CURVES:
                    self.assertLess(walk["atFirst"], plots / 2)

    def test_contents_stay(self):
        for (name, width), page in self.measured.items():
            with self.subTest(name, width=width):
                for at in page["walk"]["walked"]:
                    top, bottom = at["contents"]
                    self.assertGreaterEqual(top, -1, at)
                    self.assertGreater(bottom, 20, at)
                    if width < 1100:  # a bar: it covers nothing that was asked for, and says where the reader is
                        self.assertLess(bottom, 60, at)
                        self.assertTrue(at["says"], at)
                        if at["top"] > -1:
                            self.assertGreaterEqual(at["top"], bottom - 1, at)

    def test_key_figures_are_those_of_the_report(self):
        for name, file in self.pages.items():
            with self.subTest(name):
                report = json.loads((file.parent / "report.json").read_text())
                key = report["key_figures"]
                self.assertEqual(key["models"], [m["name"] for m in report["models"]])
                rows = {(r["symbol"], r["unit"]): r for r in key["rows"]}
                channels = {c["name"]: c for c in report["channels"]}
                mean = channels["Td_z1_Nm"]["mean"]
                for value, of_channel in zip(rows["Td", "Nm"]["values"], mean):
                    self.assertAlmostEqual(value, of_channel, delta=1e-12 * abs(of_channel))
                for symbol, channel in (("Rs", "Rs_1_z2_N"), ("Rb1", "Rb1_x1_N"), ("Fh", "Fh_z2_N")):
                    row = rows[symbol, "N"]
                    self.assertAlmostEqual(row["values"][0], channels[channel]["peak"], delta=1e-8 * row["values"][0])
                    self.assertEqual(row["difference"], row["values"][1] - row["values"][0])

    def test_fits_its_width(self):
        for (name, width), page in self.measured.items():
            with self.subTest(name, width=width):
                self.assertEqual(page["first"]["clientWidth"], width)
                for state in ("first", "opened"):
                    self.assertLessEqual(page[state]["scrollWidth"], page[state]["clientWidth"], state)
                    self.assertEqual(page[state]["wide"], [], state)

    def test_text_can_be_read(self):
        for (name, width), page in self.measured.items():
            with self.subTest(name, width=width):
                for state in ("first", "opened"):
                    for fault in ("empty", "outside", "cut"):
                        self.assertEqual(page[state][fault], [], f"{state}: {fault}")

    def test_verdict_is_seen_first(self):
        for (name, width), page in self.measured.items():
            with self.subTest(name, width=width):
                for part in ("word", "headline"):
                    place = page[part]
                    self.assertIsNotNone(place, part)
                    self.assertGreater(place["height"], 10)
                    self.assertTrue(0 <= place["left"] < place["right"] <= width, place)
                    self.assertLess(place["top"], 600)
                self.assertEqual(page["word"]["text"], REPORTS[name].word)
                self.assertGreater(len(page["headline"]["text"]), 20)

    def test_a_group_shows_its_worst_verdict(self):
        """Unequal assumptions: what differs by a visible share of its peak is not said to agree."""
        for page in self.of("unequal"):
            groups = page["groups"]
            self.assertGreater(len(groups), 5)
            for group in groups:
                if "%" in group["of_peak"]:
                    self.assertEqual(group["verdict"], "explained", group)
            self.assertIn("explained", [g["verdict"] for g in groups])

    def test_plots(self):
        for (name, width), page in self.measured.items():
            with self.subTest(name, width=width):
                if name in WITHOUT_CURVES:
                    self.assertEqual(page["plots"], [])
                    continue
                self.assertGreater(len(page["plots"]), 10)
                for plot in page["plots"]:
                    self.assertGreater(plot["width"], 200, plot["name"])
                    self.assertGreater(plot["height"], 100, plot["name"])
                    self.assertGreater(plot["canvas"], 200, plot["name"])
                    self.assertTrue(plot["drawn"], plot["name"])
                    self.assertGreaterEqual(plot["xTicks"], 2, plot["name"])
                    self.assertGreaterEqual(plot["yTicks"], 2, plot["name"])
                    self.assertRegex(plot["yLabel"], r"\(.+\)", plot["name"])
                    self.assertEqual(plot["overlaps"], [], plot["name"])
                    self.assertEqual(plot["outside"], [], plot["name"])
                for figure in {plot["figure"] for plot in page["plots"]}:
                    self.assertTrue(any("deg" in p["xLabel"] for p in page["plots"] if p["figure"] == figure), figure)

    def test_bars(self):
        for (name, width), page in self.measured.items():
            with self.subTest(name, width=width):
                self.assertEqual(len(page["bars"]), 1)
                for chart in page["bars"]:
                    self.assertGreater(chart["width"], 200)
                    self.assertGreater(chart["height"], 100)
                    self.assertGreater(chart["bars"], 0)
                    self.assertEqual(len(chart["axes"]), 2)
                    self.assertGreaterEqual(chart["ticks"], 3)
                    self.assertEqual(chart["overlaps"], [])

    def test_drawings(self):
        """Three panels of the piston's polygon, two of the block's, the plate; an integrated run has no polygons, one angle nothing."""
        for (name, width), page in self.measured.items():
            with self.subTest(name, width=width):
                self.assertEqual(len(page["drawings"]), {"integrated": 1, "one_angle": 0}.get(name, 6))
                for drawing in page["drawings"]:
                    self.assertGreater(drawing["width"], 200)
                    self.assertEqual(len(drawing["axes"]), 2)
                    self.assertGreaterEqual(drawing["ticks"], 3)

    def test_text_of_the_case_stays_text(self):
        for page in self.of("single"):
            self.assertEqual(page["heading"], json.loads(f'"{HOSTILE_NAME}"'))
            self.assertEqual(page["title"], json.loads(f'"{HOSTILE_NAME}"'))
            self.assertEqual(page["images"], 0)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    PROGRAM, REPO = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if not CHROMIUM:
        print("report_page_test: SKIPPED: no Chromium found; scripts/setup test installs it", file=sys.stderr)
        sys.exit(NO_CHROMIUM)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
