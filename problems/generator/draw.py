#!/usr/bin/env python3
"""Draws drawing.svg of every problem: draw.py [--check]. Proportions follow the problem; nothing is to scale."""
import math
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parent.parent
W, H = 420, 260


class Drawing:
    def __init__(self):
        self.parts = []

    def add(self, element):
        self.parts.append(element)

    def line(self, *points, width=1.5, colour="#222", dash=""):
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        style = f' stroke-dasharray="{dash}"' if dash else ""
        self.add(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round"{style}/>')

    def body(self, *points, colour="#cfdce8"):
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.add(f'<polygon points="{path}" fill="{colour}" stroke="#222" stroke-width="1.5" stroke-linejoin="round"/>')

    def circle(self, x, y, r=4, fill="#fff"):
        self.add(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{r}" fill="{fill}" stroke="#222" stroke-width="1.5"/>')

    def text(self, x, y, words, colour="#222", size=13):
        self.add(f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" fill="{colour}">{words}</text>')

    def arrow(self, x, y, to_x, to_y, label="", colour="#222", width=1.5):
        a = math.atan2(to_y - y, to_x - x)
        back = [(to_x - 8 * math.cos(a + s), to_y - 8 * math.sin(a + s)) for s in (-0.35, 0.35)]
        self.line((x, y), (to_x, to_y), width=width, colour=colour)
        self.line(back[0], (to_x, to_y), back[1], width=width, colour=colour)
        if label:
            self.text(to_x + 7 * math.cos(a) - (0 if math.cos(a) > -0.3 else 22), to_y + 7 * math.sin(a) + 5, label, colour)

    def axes(self, x, y, first, second, angle=0, size=42):
        """Two axes, the second counter-clockwise of the first as seen."""
        a = math.radians(angle)
        self.arrow(x, y, x + size * math.cos(a), y - size * math.sin(a), first, "#0a5c9e")
        self.arrow(x, y, x - size * math.sin(a), y - size * math.cos(a), second, "#0a5c9e")

    def ground(self, x, y, wide=36, up=False):
        self.line((x - wide / 2, y), (x + wide / 2, y), width=2)
        for i in range(6):
            at, step = x - wide / 2 + 3 + i * (wide - 4) / 6, -7 if up else 7
            self.line((at, y), (at - 5, y + step), width=1)

    def force(self, x, y, to_x, to_y, label):
        self.arrow(x, y, to_x, to_y, label, "#b03a00", 2.2)

    def svg(self):
        return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {W} {H}" width="{W}" height="{H}" '
                'font-family="DejaVu Sans,Verdana,sans-serif">\n<rect width="100%" height="100%" fill="#fff"/>\n'
                + "\n".join(self.parts) + "\n</svg>\n")


def pendulum(d):
    d.ground(130, 60, up=True)
    d.body((122, 62), (138, 58), (188, 170), (150, 190))
    d.circle(130, 62)
    d.circle(160, 146, 3, "#222")
    d.text(168, 150, "G")
    d.text(104, 70, "O")
    d.axes(130, 62, "x0", "y0", size=44)
    d.line((130, 62), (130, 215), dash="5 4", width=1)
    d.arrow(130, 62, 218, 232, "x1", "#0a5c9e")
    d.text(138, 205, "theta")
    d.force(130, 62, 84, 30, "F")
    d.text(40, 245, "seen along -z0", size=11)
    d.line((300, 62), (300, 120), width=5)
    d.ground(270, 75)
    d.body((300, 118), (380, 150), (372, 178), (292, 140))
    d.circle(345, 150, 3, "#222")
    d.text(352, 148, "G")
    d.line((240, 62), (400, 62), dash="9 3 2 3", width=1)
    d.text(392, 54, "z0")
    d.circle(300, 62)
    d.text(304, 54, "O")
    d.text(262, 245, "seen from the side", size=11)


def sphere(d, arcs, names):
    cx, cy, r = 210, 225, 170
    for angle, name, colour in arcs:
        a = math.radians(angle)
        d.arrow(cx, cy, cx + r * math.cos(a), cy - r * math.sin(a), name, colour)
    for (one, _, _), (two, _, _), name in zip(arcs, arcs[1:], names):
        points = [(cx + 130 * math.cos(math.radians(one + (two - one) * i / 20)), cy - 130 * math.sin(math.radians(one + (two - one) * i / 20)))
                  for i in range(21)]
        d.line(*points, width=6, colour="#9db8d2")
        d.text(points[10][0] - 25, points[10][1] - 10, name, size=12)
    d.circle(cx, cy)
    d.text(cx + 8, cy + 12, "O")


def spherical_four_bar(d):
    sphere(d, [(170, "z0", "#0a5c9e"), (145, "a", "#222"), (75, "b", "#222"), (15, "z2", "#0a5c9e")], ["input", "coupler", "output"])
    d.text(10, 20, "axes through O; links as arcs between them, laid out flat", size=11)


def universal_joint(d):
    d.line((20, 150), (150, 150), width=8, colour="#9db8d2")
    d.line((150, 150), (185, 110), (150, 150), (185, 190), width=5, colour="#9db8d2")
    d.line((270, 130), (390, 70), width=8, colour="#9db8d2")
    d.line((270, 130), (222, 100), (270, 130), (238, 182), width=5, colour="#9db8d2")
    d.line((185, 110), (210, 148), (185, 190), width=2)
    d.arrow(205, 148, 180, 80, "a")
    d.arrow(205, 148, 250, 210, "b")
    d.circle(205, 148)
    d.text(212, 140, "O")
    d.arrow(20, 150, 130, 150, "z0", "#0a5c9e")
    d.arrow(300, 115, 400, 65, "z2", "#0a5c9e")
    d.line((205, 148), (390, 148), dash="5 4", width=1)
    d.text(310, 138, "tilt")


def piston_side(d, both=False):
    """Plane y1-z1: z1 to the right, y1 up, the block bent upwards."""
    ox, oy, tilt = 130, 190, math.radians(32)
    z2 = (math.cos(tilt), -math.sin(tilt))
    y2 = (-math.sin(tilt), -math.cos(tilt))
    for side in ((1, -1) if both else (1,)):
        ax, ay = ox, oy - side * 62
        bx, by = ox + y2[0] * side * 56 + z2[0] * 150, oy + y2[1] * side * 56 + z2[1] * 150
        for edge in (-13, 13):
            d.line((bx - z2[0] * 45 + y2[0] * edge, by - z2[1] * 45 + y2[1] * edge), (bx + z2[0] * 55 + y2[0] * edge, by + z2[1] * 55 + y2[1] * edge), width=3)
        d.line((ax, ay), (bx, by), width=7, colour="#9db8d2")
        d.circle(ax, ay, 6)
        d.circle(bx, by, 8, "#cfdce8")
        if side > 0:
            d.text(ax - 20, ay - 6, "A")
            d.text(bx - 4, by - 22, "B")
            d.force(bx + z2[0] * 50, by + z2[1] * 50, bx + z2[0] * 14, by + z2[1] * 14, "")
            d.text(bx + z2[0] * 60, by + z2[1] * 60, "p", "#b03a00")
    d.line((ox, oy - 62), (ox, oy + (62 if both else 0)), width=5, colour="#9db8d2")
    d.line((ox, oy), (20, oy), width=7, colour="#9db8d2")
    d.arrow(ox, oy, ox + 80, oy, "z1", "#0a5c9e")
    d.arrow(ox, oy, ox, oy - 120, "y1", "#0a5c9e")
    d.arrow(ox, oy, ox + z2[0] * 250, oy + z2[1] * 250, "z2", "#0a5c9e")
    d.text(ox + 92, oy - 18, "tilt")
    d.circle(ox, oy, 3, "#222")
    d.text(ox + 4, oy + 18, "O1, O2")


def piston(d):
    piston_side(d)
    d.force(130, 128, 178, 98, "Rs")


def piston_pair(d):
    piston_side(d, True)
    for x, name in ((95, "C1"), (40, "C2")):
        d.ground(x, 198)
        d.text(x - 8, 224, name)


def gear_pair(d):
    ox, oy, tilt, cone = 180, 190, math.radians(55), math.radians(24)
    z2 = (math.cos(tilt), -math.sin(tilt))
    p = (math.cos(cone), -math.sin(cone))
    d.line((ox, oy), (ox + 190 * p[0], oy + 190 * p[1]), dash="5 4", width=1)
    P = (ox + 150 * p[0], oy + 150 * p[1])
    d.body((P[0], P[1]), (P[0], 2 * oy - P[1]), (ox + 95, oy + 20), (ox + 95, oy - 20))
    second = 150 * math.cos(tilt - cone)
    foot = (ox + second * z2[0], oy + second * z2[1])
    mirror = (2 * foot[0] - P[0], 2 * foot[1] - P[1])
    d.body(P, mirror, (mirror[0] - 30 * z2[0] + 20, mirror[1] - 30 * z2[1] + 30), (P[0] - 50 * p[0], P[1] - 50 * p[1]), colour="#e6dcc8")
    d.arrow(ox, oy, ox + 205, oy, "z1", "#0a5c9e")
    d.arrow(ox, oy, ox + 205 * z2[0], oy + 205 * z2[1], "z2", "#0a5c9e")
    d.circle(*P, 4, "#222")
    d.text(P[0] + 6, P[1] + 16, "P")
    d.force(P[0], P[1], P[0] - 25, P[1] - 50, "F k")
    d.circle(ox, oy, 3, "#222")
    d.text(ox - 16, oy - 6, "O")
    for x, name in ((120, "C1"), (50, "C2")):
        d.ground(x, oy + 8, 30)
        d.text(x - 8, oy - 10, name)
    d.line((ox, oy), (20, oy), width=5, colour="#9db8d2")


def crank(d, pads):
    ox, oy = 80, 150
    A, B = (120, 105), (280, 150)
    d.line((ox, oy), A, width=7, colour="#9db8d2")
    d.line(A, B, width=7, colour="#9db8d2")
    d.body((235, 125), (345, 125), (345, 175), (235, 175))
    for x, y in ((ox, oy), A, B):
        d.circle(x, y, 5)
    d.ground(ox, oy + 10)
    d.axes(ox, oy, "x", "y", size=60)
    d.text(96, 136, "theta")
    if pads:
        for x, name in ((330, "1"), (250, "2")):
            for y, up, letter in ((175, 1, "L"), (125, -1, "U")):
                d.body((x - 7, y), (x + 7, y), (x + 7, y + up * 9), (x - 7, y + up * 9), colour="#e6dcc8")
                d.ground(x, y + up * 9, 30, up < 0)
                d.force(x, y + up * 44, x, y + up * 14, "")
                d.text(x + 8, y + up * 36 + 5, letter + name, "#b03a00")
        d.force(400, 136, 348, 136, "")
        d.text(374, 130, "gas", "#b03a00")
    else:
        d.line((215, 175), (385, 175), width=2)
        d.ground(300, 176, 150)
        d.force(290, 230, 290, 180, "")
        d.text(298, 225, "N", "#b03a00")
        d.force(250, 182, 205, 182, "Ff")
        d.force(400, 150, 348, 150, "")
        d.text(374, 144, "gas", "#b03a00")


def impacts(d):
    for x in (90, 320):
        d.line((x, 70), (x, 170), width=6)
    d.line((90, 170), (320, 170), width=3)
    d.circle(185, 120, 12, "#cfdce8")
    d.force(197, 120, 250, 120, "v")
    d.arrow(205, 215, 300, 215, "y", "#0a5c9e")
    d.line((205, 205), (205, 225))
    d.arrow(140, 195, 185, 195)
    d.arrow(185, 195, 140, 195)
    d.text(60, 200, "shaken")
    d.text(40, 190 - 60, "wall 1")
    d.text(332, 130, "wall 2")
    d.text(192, 62, "gap")
    d.arrow(225, 57, 312, 57)
    d.arrow(188, 57, 97, 57)


def pump(d, count):
    piston_side(d, True)
    for x, name in ((95, "C1"), (40, "C2")):
        d.ground(x, 198)
        d.text(x - 8, 224, name)
    d.text(300, 235, f"{count} pistons", size=12)
    d.text(190, 252, "full drawing: docs/theory.md, figure 1", size=11)


DRAWINGS = {"pendulum": pendulum, "spherical_four_bar": spherical_four_bar, "universal_joint": universal_joint, "piston": piston,
            "piston_pair": piston_pair, "gear_pair": gear_pair, "one_sided_wall": lambda d: crank(d, True),
            "step_friction": lambda d: crank(d, False), "impacts": impacts, "pump_lumped": lambda d: pump(d, 5),
            "pump_real": lambda d: pump(d, 7)}


def main():
    differs = []
    for name, draw in DRAWINGS.items():
        drawing, path = Drawing(), FOLDER / name / "drawing.svg"
        draw(drawing)
        if "--check" not in sys.argv:
            path.write_text(drawing.svg())
        elif path.read_text() != drawing.svg():
            differs.append(str(path))
    if differs:
        sys.exit("not as draw.py draws them: " + ", ".join(differs))


if __name__ == "__main__":
    main()
