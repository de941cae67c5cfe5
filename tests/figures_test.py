#!/usr/bin/env python3
"""Tests of the figures in docs/pictures that scripts/draw_figures makes: their points stand where the definitions have them.

usage: figures_test.py REPO_ROOT [BENTAXIS [PYTHON]] [options of unittest]

Positions are computed here from the case file alone by the equations of docs/theory.md. With BENTAXIS, and PYTHON that has
matplotlib, the figures are drawn anew as well: the stored ones must not be stale.
"""

import html
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest

NEAR = 2e-3  # mm, deg or bar: the picture has 6 decimals of a point
DRAWN = {
    "frames": {"O1", "O2", "A_1", "B_1", "O4", "C1", "C2"},
    "free_body_piston": {"A_1", "B_1"},
    "free_body_block": {f"B_{k}" for k in range(1, 6)} | {"O2", "O4"},
    "free_body_shaft": {f"A_{k}" for k in range(1, 6)} | {"O1", "O4", "C1", "C2"},
    "bearings": {"C1", "C2", "O1"},
    "gear": {"O2", "O4"},
    "port_plate": {"O2", "delivery_from", "delivery_to", "suction_from", "suction_to", "delivery_notch", "suction_notch"},
    "pressure_trace": {"middle_of_rise", "start_of_rise", "end_of_rise"},
    "lag_backlash": {"A_1", "B_1", "B_1 behind"},
    "teeth": {"O4", "path_begin +", "path_end +", "path_begin -", "path_end -"},
}
SCHEMES = {"drive_train", "circuit", "data_flow"}  # without geometry


def cos(degrees):
    return math.cos(math.radians(degrees))


def sin(degrees):
    return math.sin(math.radians(degrees))


class Picture:
    def __init__(self, path):
        text = path.read_text()
        self.facts = json.loads(html.unescape(re.search(r"<dc:description>(.*?)</dc:description>", text, re.DOTALL)[1]))
        self.size = len(text)
        self.texts = re.findall(r"<text[ >]", text)
        self.drawn = {}
        for name, x, y in re.findall(r'<g id="point ([^"]+)">.*?<use [^>]*?x="([-\d.]+)" y="([-\d.]+)"', text, re.DOTALL):
            x0, per_x, y0, per_y = self.facts["to_picture"]
            self.drawn[name] = ((float(x) - x0) / per_x, (float(y) - y0) / per_y)


class Definitions:
    """Points of a case by the equations of docs/theory.md, in mm."""

    def __init__(self, facts):
        self.case = tomllib.loads((REPO / facts["case"]).read_text())
        for change in facts["settings"]:
            key, value = change.split("=")
            table, name = key.split(".")
            self.case[table][name] = float(value)
        pump = self.case["pump"]
        self.alpha, self.b = pump["tilt_deg"], pump["axis_offset_mm"]
        self.Ra, self.Rd, self.b1 = (pump[f"{key}_mm"] for key in ("joint_circle_radius", "bore_circle_radius", "piston_length"))
        self.N, self.theta, self.facts = pump["pistons"], facts["theta_deg"], facts

    def angle(self, k):
        return self.theta - (k - 1) * 360 / self.N

    def to_s2(self, p):  # (2.2)
        y, z = p[1], p[2] - self.b
        return p[0], cos(self.alpha) * y - sin(self.alpha) * z, sin(self.alpha) * y + cos(self.alpha) * z

    def to_s1(self, p):
        return p[0], cos(self.alpha) * p[1] + sin(self.alpha) * p[2], -sin(self.alpha) * p[1] + cos(self.alpha) * p[2] + self.b

    def A(self, k):  # (3.2)
        return -self.Ra * sin(self.angle(k)), self.Ra * cos(self.angle(k)), 0.0

    def B(self, k, lag=0.0):  # (3.4), (3.6), (10.1), in S2
        a, psi = self.to_s2(self.A(k)), self.angle(k) - lag
        x, y = -self.Rd * sin(psi), self.Rd * cos(psi)
        return x, y, a[2] + math.sqrt(self.b1**2 - (x - a[0]) ** 2 - (y - a[1]) ** 2)

    def O4(self):  # (6.2)
        r = self.case["gear"]["pitch_diameter_mm"] / 2
        return 0.0, r, self.b - r * math.tan(math.radians(self.alpha / 2))

    def in_s1(self, name):
        if name[:2] in ("A_", "B_"):
            k = int(name[2:])
            return self.A(k) if name[0] == "A" else self.to_s1(self.B(k))
        bearings = self.case["bearings"]
        return {"O1": (0, 0, 0), "O2": (0, 0, self.b), "O4": self.O4(), "C1": (0, 0, bearings["tapered_z_mm"]),
                "C2": (0, 0, bearings["cylindrical_z_mm"])}[name]

    def plate(self, name):  # a point at (r, psi) is (-r sin(psi), r cos(psi)): section 7
        plate, oil = self.case["port_plate"], self.case["hydraulics"]
        if name == "O2":
            return 0.0, 0.0
        side, what = name.split("_")
        arc = plate[f"{side}_arc_deg"]
        outer = plate["outer_land_mm"][0]
        middle = (plate["inner_land_mm"][1] + outer) / 2
        r, psi = {"from": (outer, arc[0]), "to": (outer, arc[1]), "notch": (middle, arc[0] - oil.get(f"{side}_notch_deg", 0))}[what]
        return -r * sin(psi), r * cos(psi)

    def trace(self, name):  # (4.2)
        p = self.case["pressure"]
        start, width = p["delivery_start_deg"], p["transition_deg"]
        return {"middle_of_rise": (start, (p["suction_bar"] + p["delivery_bar"]) / 2),
                "start_of_rise": (start - width / 2, p["suction_bar"]), "end_of_rise": (start + width / 2, p["delivery_bar"])}[name]

    def path(self, name):  # (B.1)-(B.3): on the plane that touches the sphere at O4
        gear = self.case["gear"]
        delta, ap = 90 - self.alpha / 2, gear["pressure_angle_deg"]
        R = gear["pitch_diameter_mm"] / 2 / sin(delta)
        tip = delta + math.degrees(math.atan(gear["pitch_diameter_mm"] / gear["tooth_number"] / R))
        base = math.degrees(math.asin(sin(delta) * cos(ap)))
        half = math.acos(cos(tip) / cos(base)) - math.acos(cos(delta) / cos(base))
        if name == "O4":
            return 0.0, 0.0
        way = R * math.tan(half) * (1 if "end" in name else -1)
        return (1 if "+" in name else -1) * way * cos(ap), way * sin(ap)

    def expected(self, name):
        plane = self.facts["plane"]
        if plane == ["z1", "y1"]:
            p = self.in_s1(name)
            return p[2], p[1]
        if plane == ["z2", "y2"]:
            p = self.to_s2(self.in_s1(name))
            return p[2], p[1]
        if plane == ["theta_deg", "p_bar"]:
            return self.trace(name)
        if plane == ["across", "up"]:
            return self.path(name)
        if "lag_deg" in self.facts:
            lag = self.facts["lag_deg"] if "behind" in name else 0
            return (self.to_s2(self.A(1)) if name == "A_1" else self.B(1, lag))[:2]
        return self.plate(name)


def wrong(picture):
    """Names of the points that stand elsewhere than the definitions have them."""
    definitions = Definitions(picture.facts)
    return [name for name, xy in picture.drawn.items() if math.dist(xy, definitions.expected(name)) > NEAR]


class FiguresTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.pictures = {name: Picture(REPO / "docs" / "pictures" / f"{name}.svg") for name in [*DRAWN, *sorted(SCHEMES)]}

    def test_points_stand_where_the_definitions_have_them(self):
        for name, points in DRAWN.items():
            with self.subTest(name):
                found = {re.sub(r" by .*", "", point): xy for point, xy in self.pictures[name].drawn.items()}
                self.assertEqual(set(found), points)
                self.assertEqual(wrong(self.pictures[name]), [])

    def test_a_point_that_is_off_is_found(self):
        for name in DRAWN:
            with self.subTest(name):
                picture = Picture(REPO / "docs" / "pictures" / f"{name}.svg")
                point = sorted(picture.drawn)[-1]
                x, y = picture.drawn[point]
                picture.drawn[point] = (x, y + 0.05)
                self.assertEqual(wrong(picture), [point])
        tilted = Picture(REPO / "docs" / "pictures" / "frames.svg")
        tilted.facts["settings"].append("pump.tilt_deg=40.1")
        self.assertEqual(set(wrong(tilted)), {"B_1", "O4"})

    def test_gear_and_contact_ratio(self):
        facts = self.pictures["gear"].facts
        ap, half = 20, 20  # bap63_rated: pressure angle, half of the tilt
        k4 = (-cos(ap), sin(ap) * sin(half), sin(ap) * cos(half))  # (6.3)
        self.assertLess(math.dist(facts["k4"]["axis"], k4), 1e-12)
        teeth = self.pictures["teeth"]
        definitions = Definitions(teeth.facts)
        gear = definitions.case["gear"]
        end = definitions.path("path_end +")
        delta = 90 - definitions.alpha / 2
        R = gear["pitch_diameter_mm"] / 2 / sin(delta)
        pitch = 2 * math.pi / gear["tooth_number"] * sin(delta) * cos(gear["pressure_angle_deg"])
        self.assertAlmostEqual(teeth.facts["contact_ratio"], 2 * math.atan(math.hypot(*end) / R) / pitch, 9)

    def test_pressure_is_the_smooth_step(self):
        picture = self.pictures["pressure_trace"]
        p = Definitions(picture.facts).case["pressure"]
        w = p["transition_deg"]
        self.assertGreater(len(picture.facts["drawn"]), 4)
        for theta, bar in picture.facts["drawn"]:  # (4.2)
            past = (theta - p["delivery_start_deg"] + w / 2) % 360
            t = past / w if past < w else 1 if past < 180 else 1 - (past - 180) / w if past < 180 + w else 0
            self.assertAlmostEqual(bar, p["suction_bar"] + (p["delivery_bar"] - p["suction_bar"]) * t * t * (3 - 2 * t), 6)

    def test_small_with_text_and_described(self):
        pages = {path: path.read_text() for path in (REPO / "docs").glob("**/*.md")}
        for name, picture in self.pictures.items():
            with self.subTest(name):
                self.assertLess(picture.size, 60000)
                self.assertGreater(len(picture.texts), 5)
                shown = [text for page in pages.values() for text in re.findall(rf"!\[([^\]]*)\]\((?:\.\./)?pictures/{name}\.svg\)", page)]
                self.assertTrue(shown, "no page shows it")
                self.assertTrue(all(len(text) > 30 for text in shown), "the text for who does not see it is missing")

    def test_stored_figures_are_fresh(self):
        if not PROGRAM:
            self.skipTest("needs the program")
        with tempfile.TemporaryDirectory(prefix="bentaxis_figures_") as folder:
            done = subprocess.run([PYTHON, str(REPO / "scripts" / "draw_figures"), "--out", folder, "--program", PROGRAM],
                                  capture_output=True, text=True)
            if "No module named 'matplotlib'" in done.stderr:
                self.skipTest("needs matplotlib")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual({p.stem for p in pathlib.Path(folder).glob("*.svg")}, set(self.pictures))
            for name, stored in self.pictures.items():
                with self.subTest(name):
                    fresh = Picture(pathlib.Path(folder) / f"{name}.svg")
                    self.assertEqual(set(fresh.drawn), set(stored.drawn))
                    for point, xy in fresh.drawn.items():
                        self.assertLess(math.dist(xy, stored.drawn[point]), NEAR, point)
                    self.assertEqual(len(fresh.texts), len(stored.texts))


if __name__ == "__main__":
    places = [a for a in sys.argv[1:4] if not a.startswith("-")]
    REPO = pathlib.Path(places[0]).resolve()
    PROGRAM = places[1] if len(places) > 1 else None
    PYTHON = places[2] if len(places) > 2 else sys.executable
    unittest.main(argv=[sys.argv[0], *sys.argv[1 + len(places):]])
