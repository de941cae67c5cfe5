#!/usr/bin/env python3
"""One tooth on a ring by finite elements: what docs/external_benchmarks.md stores. Needs gmsh and ccx (CalculiX), nothing else does.

usage: finite_element_tooth.py [size of elements in the tooth, modules; 0.04]

Spur tooth as a rack with rounded corners cuts it (20 deg, h_a 1, h_f 1.25 modules), plane stress, unit width, ring held at
its bore. Prints the deflection of the tooth's middle, where the load's line meets it, along the load, per force and width.
"""

import math
import pathlib
import subprocess
import sys
import tempfile

E, NU = 206e3, 0.3  # N/mm2
MODULE, ALPHA, HEAD, FOOT, RIM = 4.0, math.radians(20), 1.0, 1.25, 3.0
CORNER = (FOOT - HEAD) / (1 - math.sin(ALPHA))  # modules


def flank(teeth, heights, count=60):
    """Points (x, y) of the right flank from the root circle to the tip, y along the tooth's middle, mm; and of the heights
    over the pitch circle (modules) the index in it, and the angle of the load to x."""
    r = teeth * MODULE / 2
    base, root = r * math.cos(ALPHA), r - FOOT * MODULE
    depth, rho = (FOOT - CORNER) * MODULE, CORNER * MODULE
    offset = MODULE * (math.pi / 4 + HEAD * math.tan(ALPHA) + CORNER * math.cos(ALPHA))
    points = []
    for i in range(count):  # the corner's envelope: the normal passes through the pitch point
        way = depth / math.tan(ALPHA) * i / count
        turned = (way + offset) / r
        reach = 1 + rho / math.hypot(way, depth)
        along, down = -way * reach, -depth * reach
        points.append((r * math.sin(turned) + along * math.cos(turned) + down * math.sin(turned),
                       r * math.cos(turned) - along * math.sin(turned) + down * math.cos(turned)))
    half = math.pi / (2 * teeth) + math.tan(ALPHA) - ALPHA
    start = math.tan(ALPHA) - HEAD * MODULE / math.sin(ALPHA) / base
    end = math.sqrt(((r + HEAD * MODULE) / base) ** 2 - 1)
    wanted = {math.sqrt(((r + h * MODULE) / base) ** 2 - 1): h for h in heights}
    loads = {}
    for roll in sorted([start + (end - start) * i / count for i in range(count + 1)] + list(wanted)):
        angle = roll - half
        if roll in wanted:
            loads[wanted[roll]] = (len(points), angle)
        points.append((base * (roll * math.cos(angle) - math.sin(angle)), base * (roll * math.sin(angle) + math.cos(angle))))
    return points, loads, root


def mesh(folder, points, root, middle, size):
    """Writes mesh.inp: quadratic triangles."""
    lines = []
    def point(x, y, s):
        lines.append(f"Point({len(lines) + 1}) = {{{x!r}, {y!r}, 0, {s}}};")
        return len(lines)
    coarse = root / 12
    right = [point(x, y, size) for x, y in points]
    left = [point(-x, y, size) for x, y in points]
    centre = point(0, 0, coarse)
    outer = [point(root * math.cos(a), root * math.sin(a), coarse) for a in (0, -math.pi / 2, math.pi)]
    bore = root / RIM
    inner = [point(bore * math.cos(a), bore * math.sin(a), coarse / 2) for a in (0, math.pi / 2, math.pi, -math.pi / 2)]
    inside = point(0, middle, size)
    number = 0
    def add(text):
        nonlocal number
        number += 1
        lines.append(text.format(number))
        return number
    loop = []
    for a, b in zip(right, right[1:]):
        loop.append(add(f"Line({{}}) = {{{{{a}, {b}}}}};"))
    loop.append(add(f"Line({{}}) = {{{{{right[-1]}, {left[-1]}}}}};"))
    for a, b in zip(left[::-1], left[::-1][1:]):
        loop.append(add(f"Line({{}}) = {{{{{a}, {b}}}}};"))
    for a, b in zip([left[0], *outer[::-1]], [*outer[::-1], right[0]]):
        loop.append(add(f"Circle({{}}) = {{{{{a}, {centre}, {b}}}}};"))
    hole = [add(f"Circle({{}}) = {{{{{a}, {centre}, {b}}}}};") for a, b in zip(inner, inner[1:] + inner[:1])]
    lines += [f"Curve Loop(1) = {{{', '.join(map(str, loop))}}};", f"Curve Loop(2) = {{{', '.join(map(str, hole))}}};",
              "Plane Surface(1) = {1, 2};", f"Point{{{inside}}} In Surface{{1}};", "Physical Surface(1) = {1};"]
    (folder / "mesh.geo").write_text("\n".join(lines) + "\n")
    subprocess.run(["gmsh", "-2", "-order", "2", "-format", "inp", "-o", "mesh.inp", "mesh.geo"], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)


def solve(folder, load, middle, angle, root):
    """Deflection of the middle along a unit load at a point of the flank, mm."""
    text = (folder / "mesh.inp").read_text().splitlines()
    nodes, part, elements = {}, "", 0
    for line in text:
        if line.startswith("*"):
            part = line.upper()
        elif part.startswith("*NODE"):
            n, x, y, _ = line.split(",")
            nodes[int(n)] = (float(x), float(y))
        elif part.startswith("*ELEMENT"):
            elements += 1
    def at(x, y):
        near = min(nodes, key=lambda n: math.dist(nodes[n], (x, y)))
        assert math.dist(nodes[near], (x, y)) < 1e-6
        return near
    held = [n for n, p in nodes.items() if math.hypot(*p) < root / RIM * 1.0001]
    name = next(line.split("ELSET=")[1].strip() for line in text if "ELSET=" in line.upper() and "CPS6" in line.upper())
    deck = [line for line in text if not line.upper().startswith("*HEADING") and line.strip() != "/tmp/mesh.inp"]
    pushed, seen = at(*load), at(0, middle)
    c, s = -math.cos(angle), -math.sin(angle)
    deck += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{E}, {NU}", f"*SOLID SECTION, ELSET={name}, MATERIAL=STEEL", "1.0",
             "*NSET, NSET=HELD", *(f"{n}," for n in held), "*NSET, NSET=SEEN", f"{seen},", "*BOUNDARY", "HELD, 1, 2",
             "*STEP", "*STATIC", "*CLOAD", f"{pushed}, 1, {c!r}", f"{pushed}, 2, {s!r}", "*NODE PRINT, NSET=SEEN", "U",
             "*END STEP"]
    (folder / "tooth.inp").write_text("\n".join(deck) + "\n")
    subprocess.run(["ccx", "tooth"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    _, ux, uy, _ = (folder / "tooth.dat").read_text().split("\n\n")[-1].split()[:4]
    return float(ux) * c + float(uy) * s, elements


def main():
    size = float(sys.argv[1]) if len(sys.argv) > 1 else 0.04
    for teeth in (27, 79):
        points, loads, root = flank(teeth, (-0.5, 0.0, 0.9))
        for height, (index, angle) in loads.items():
            x, y = points[index]
            middle = y - x * math.tan(angle)
            with tempfile.TemporaryDirectory() as folder:
                folder = pathlib.Path(folder)
                mesh(folder, points, root, middle, size * MODULE)
                deflection, elements = solve(folder, (x, y), middle, angle, root)
            print(f"{teeth} teeth, {height:+.1f} modules: {1e-6 * deflection:.6e} m/(N/m), {elements} elements", flush=True)


if __name__ == "__main__":
    main()
