#!/usr/bin/env python3
"""Records of foreign programs for tests/import_test.py, written by LibreOffice, Octave and scipy.

The curves are those of reference_data/generator/make_reference.py, which shares nothing with the program; the files
are written by the programs whose formats they have. Needs the packages of the slow group (scripts/setup slow).

    /usr/bin/python3 tests/imports/make_exports.py DIR     writes good/ and bad/ below DIR
"""
import csv
import pathlib
import subprocess
import sys
import tempfile

import numpy
import scipy.io

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SAMPLES = 200
SPEED = 9000.0  # deg/s
# A numeric cell of a CSV import by LibreOffice: comma, quote, UTF-8, from line 1, standard cells, English.
CSV_IN = "CSV:44,34,76,1,,1033"
# Semicolon, quote, UTF-8, German (decimal comma), all text quoted, as shown: no.
CSV_OUT = "csv:Text - txt - csv (StarCalc):59,34,76,1,,1031,true,false"


def curves(changes, cache={}):
    """Result columns of a case by name, over theta_deg."""
    key = tuple(changes)
    if key not in cache:
        text = (ROOT / "cases" / "bap63_rated.toml").read_text()
        for old, new in (("samples_per_revolution = 720", f"samples_per_revolution = {SAMPLES}"), *changes):
            assert text.count(old) == 1, old
            text = text.replace(old, new)
        with tempfile.TemporaryDirectory() as folder:
            case, out = pathlib.Path(folder, "case.toml"), pathlib.Path(folder, "curve.csv")
            case.write_text(text)
            subprocess.run([sys.executable, ROOT / "reference_data" / "generator" / "make_reference.py", case, "-o", out],
                           check=True, stdout=subprocess.DEVNULL)
            header, *rows = csv.reader(out.open())
            # The generator leaves what does not exist empty.
            cache[key] = {name: numpy.array([float(row[i]) if row[i] else numpy.nan for row in rows])
                          for i, name in enumerate(header)}
    return {name: values.copy() for name, values in cache[key].items()}


def own(c, name):
    """Components of a reaction in its own frame; 0 where it has none."""
    found = {}
    for column, values in c.items():
        parts = column.split("_")
        if column.startswith(name + "_") and len(parts) == len(name.split("_")) + 2 and parts[-2][1] in "12":
            found[parts[-2][0]] = values
    return numpy.array([found.get(axis, 0 * c["theta_deg"]) for axis in "xyz"])


def in_s1(c, name, tilt):
    """The same in S1: S2 is turned about x by the tilt."""
    vector = own(c, name)
    if name.startswith("Rb"):
        return vector
    s, k = numpy.sin(numpy.radians(tilt)), numpy.cos(numpy.radians(tilt))
    return numpy.array([[1, 0, 0], [0, k, s], [0, -s, k]]) @ vector


def turned_by(sequence, degrees):
    """Rows: axes that were turned by Euler angles about axes that turn along."""
    axes = numpy.eye(3)
    for letter, angle in zip(sequence, numpy.radians(degrees)):
        i = "XYZ".index(letter)
        a, b = (i + 1) % 3, (i + 2) % 3
        first, second = axes[a].copy(), axes[b].copy()
        axes[a] = numpy.cos(angle) * first + numpy.sin(angle) * second
        axes[b] = numpy.cos(angle) * second - numpy.sin(angle) * first
    return axes


def sorted_by(angle, columns):
    order = numpy.argsort(angle)
    return [angle[order], *(values[order] for values in columns)]


def plain_csv(file, lines):
    with file.open("w", newline="") as out:
        csv.writer(out).writerows(lines)


def libreoffice(file, kind, infilter=None):
    subprocess.run(["soffice", "--headless", f"-env:UserInstallation=file://{file.parent}/profile",
                    *([f"--infilter={infilter}"] if infilter else []), "--convert-to", kind, "--outdir",
                    file.parent / "out", file], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return next((file.parent / "out").iterdir())


def octave(script, **variables):
    """Runs Octave with variables; returns nothing, the script writes."""
    with tempfile.TemporaryDirectory() as folder:
        scipy.io.savemat(f"{folder}/in.mat", variables)
        subprocess.run(["octave-cli", "--no-gui", "--eval", f"load('{folder}/in.mat');{script}"], check=True,
                       stderr=subprocess.DEVNULL)


def excel_csv(out, c, spoil=None):
    """Semicolons, decimal commas, titles and units; forces on the other body, in kN; their zero 37 deg before ours."""
    columns = {"Drehwinkel": (c["theta_deg"] + 37) % 360, "Zeit": (c["theta_deg"] + 37) % 360 / SPEED * 1e3}
    for title, name in (("Kolben 1", "Rs_1"), ("Lager A", "Rb1"), ("Lager B", "Rb2")):
        for axis, values in zip("XYZ", own(c, name)):
            if numpy.any(values != 0):
                columns[f"{title} F{axis}"] = -values / 1e3
    columns["Kolben 1 Querkraft X"], columns["Kolben 1 Querkraft Y"] = -own(c, "Rc_1")[:2] / 1e3
    columns["Antriebsmoment"] = c["Td_z1_Nm"]
    if spoil:
        spoil(columns)
    order = numpy.argsort(columns["Drehwinkel"])
    units = ["°", "ms", *("kN" for _ in range(len(columns) - 3)), "Nm"]
    rows = [[f"{values[i]:.9g}" for values in columns.values()] for i in order]
    rows.append([f"{float(rows[0][0]) + 360:.9g}", f"{360 / SPEED * 1e3:.9g}", *rows[0][2:]])
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "table.csv")
        plain_csv(file, [["Prüfstand 3, Messung 17"], [], list(columns), units, *rows])
        out.write_bytes(libreoffice(file, CSV_OUT, CSV_IN).read_bytes())


def adams_tab(out, c, tilt=40.0, spoil=None):
    """An exported table: seconds, two turns after a start at 0.1 s; global axes X = z1, Y = x1, Z = y1; N mm."""
    theta = c["theta_deg"]
    names, columns = [], []
    for title, name in (("JOINT_A1", "Rs_1"), ("JOINT_A2", "Rs_2"), ("BRG_TAPERED", "Rb1"), ("PIN", "Rcn")):
        x, y, z = in_s1(c, name, tilt)
        for axis, values in zip("XYZ", (z, x, y)):
            names.append(f"{title}.F{axis} (newton)")
            columns.append(values)
    names.append("MOTION_1.TZ (newton-mm)")
    columns.append(-1e3 * c["Td_z1_Nm"])
    if spoil:
        spoil(names, columns)
    shifted = sorted_by((theta - 108) % 360, columns)  # their zero is 108 deg behind ours
    time = numpy.concatenate([shifted[0], shifted[0] + 360, [720]]) / SPEED + 0.1
    data = numpy.array([time, *(numpy.concatenate([v, v, v[:1]]) for v in shifted[1:])]).T
    header = "\t".join(f'"{name}"' for name in ["Time (sec)", *names])
    octave(f"f = fopen('{out}', 'w'); fprintf(f, 'Plot: reactions\\n\\n%s\\n', header);"
           "fprintf(f, [repmat('%.9E\\t', 1, columns(data) - 1) '%.9E\\n'], data'); fclose(f);",
           header=header, data=data)


def tab_text(out, c, spoil=None):
    """Tabs, milliseconds; axes of each reaction exchanged: their x, y, z are ours y, z, x."""
    names, columns = [], []
    for title, name in (("piston1", "Rs_1"), ("piston3", "Rs_3"), ("bearing_front", "Rb1"), ("pin", "Rcn")):
        x, y, z = own(c, name)
        for axis, values in zip("xyz", (y, z, x)):
            names.append(f"F{axis}_{title}")
            columns.append(values / 1e3)
    names += ["drive_torque", "tooth_force"]
    columns += [c["Td_z1_Nm"], c["Rcs_z4_N"] / 1e3]
    if spoil:
        spoil(names, columns)
    data = numpy.array(sorted_by((c["theta_deg"] + 252) % 360 / SPEED * 1e3, columns)).T
    octave(f"f = fopen('{out}', 'w'); fprintf(f, '%s\\n%s\\n', header, units); fclose(f);"
           f"dlmwrite('{out}', data, 'delimiter', '\\t', 'precision', '%.10g', '-append');",
           header="\t".join(["t", *names]),
           units="\t".join(["ms", *("[kN]" for _ in names[:-2]), "[Nm]", "[kN]"]), data=data)


def workbook(out, c, spoil=None):
    """Two sheets; a falling angle in radians, pressures in MPa, forces in N, pistons numbered from the third on."""
    columns = {"phi": numpy.radians(90 - c["theta_deg"])}
    for number, piston in ((1, 3), (2, 4), (4, 1)):
        for axis, values in zip("xyz", own(c, f"Rs_{piston}")):
            columns[f"Cylinder {number} F{axis}"] = values
        columns[f"Cylinder {number} wall Fx"], columns[f"Cylinder {number} wall Fy"] = own(c, f"Rc_{piston}")[:2]
    columns["Torque"] = c["Td_z1_Nm"]
    columns["Gear force"] = -c["Rcs_z4_N"]
    if spoil:
        spoil(columns)
    data = numpy.array(list(columns.values())).T
    def cell(value):
        kind = "string" if isinstance(value, str) else "float"
        more = "" if kind == "string" else f' office:value="{value:.12g}"'
        return (f'<table:table-cell office:value-type="{kind}"{more}><text:p>{value}</text:p></table:table-cell>')
    def sheet(name, rows):
        body = "".join("<table:table-row>" + "".join(cell(v) for v in row) + "</table:table-row>" for row in rows)
        return f'<table:table table:name="{name}">{body}</table:table>'
    text = ('<?xml version="1.0" encoding="UTF-8"?><office:document '
            'xmlns:office="urn:oasis:names:tc:opendocument:xmlns:office:1.0" '
            'xmlns:table="urn:oasis:names:tc:opendocument:xmlns:table:1.0" '
            'xmlns:text="urn:oasis:names:tc:opendocument:xmlns:text:1.0" office:version="1.2" '
            'office:mimetype="application/vnd.oasis.opendocument.spreadsheet"><office:body><office:spreadsheet>'
            + sheet("Info", [["Pump", "BAP 63"], ["Speed", 1500.0], ["Pressure", "275 bar"]])
            + sheet("Results", [["Simulation of the rated point"], [*columns], *data.tolist()])
            + "</office:spreadsheet></office:body></office:document>")
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "book.fods")
        file.write_text(text)
        out.write_bytes(libreoffice(file, "xlsx").read_bytes())


def matlab(out, c, tilt=40.0, spoil=None, by_octave=False):
    """A structure; turns from a trigger; vectors in S1 turned by Euler angles ZXZ 30, 50, -20 deg; lbf."""
    axes = turned_by("ZXZ", (30, 50, -20))
    record = {"rev": (c["theta_deg"] + 72.5) % 360 / 360}
    for title, name in (("joint1", "Rs_1"), ("joint5", "Rs_5"), ("bearing1", "Rb1"), ("bearing2", "Rb2")):
        record[title] = (axes @ in_s1(c, name, tilt)).T / 4.4482216152605
    record["drive"] = c["Td_z1_Nm"]
    if spoil:
        spoil(record)
    order = numpy.argsort(record["rev"])
    record = {name: values[order] for name, values in record.items()}
    if by_octave:
        octave(f"save('-v7', '{out}', 'run');", run=record)
    else:
        scipy.io.savemat(out, {"run": record, "comment": "run 12, trigger at -72.5 deg"}, do_compression=True)


def request_file(out, c):
    """A request file: the time, then a line per request with eight values."""
    blocks = []
    for i, theta in enumerate(c["theta_deg"]):
        lines = [f" {theta / SPEED:.10E}"]
        for number, name in ((1, "Rb1"), (2, "Rb2")):
            x, y, z = own(c, name)[:, i]
            values = [numpy.hypot(numpy.hypot(x, y), z), x, y, z, 0, 0, 0, 0]
            lines.append(f" {number} " + " ".join(f"{v: .10E}" for v in values))
        blocks.append("\n".join(lines))
    octave(f"f = fopen('{out}', 'w'); fprintf(f, 'Request output of pump_rated\\n\\n%s\\n', text); fclose(f);",
           text="\n".join(blocks))


def negate(*names):
    def spoil(columns, values=None):
        for name in names:
            if values is None:
                columns[name] = -columns[name]
            else:
                values[columns.index(name)] *= -1
    return spoil


def negate_part(name, part):
    def spoil(record):
        record[name][:, part] *= -1
    return spoil


def swap(a, b):
    def spoil(columns):
        for name in [n for n in columns if n.startswith(a)]:
            other = name.replace(a, b)
            columns[name], columns[other] = columns[other], columns[name]
    return spoil


def main(folder):
    good, bad = folder / "good", folder / "bad"
    for place in (good, bad):
        place.mkdir(parents=True, exist_ok=True)
    right = curves(())
    excel_csv(good / "bench.csv", right)
    adams_tab(good / "adams.tab", right)
    tab_text(good / "signals.txt", right)
    workbook(good / "results.xlsx", right)
    matlab(good / "run.mat", right)
    matlab(good / "run_octave.mat", right, by_octave=True)
    request_file(good / "pump.req", right)

    piston = curves((("mass_kg = 0.09\n", "mass_kg = 0.0918\n"),))
    block = curves((("mass_kg = 1.6\n", "mass_kg = 1.632\n"),))
    tilt = curves((("tilt_deg = 40.0", "tilt_deg = 40.4"),))
    timing = curves((("delivery_start_deg = 180.0", "delivery_start_deg = 181.0"),))
    gear = curves((("pressure_angle_deg = 20.0", "pressure_angle_deg = 20.4"),))
    excel_csv(bad / "one_sign.csv", right, negate("Lager A FY"))
    excel_csv(bad / "piston_mass.csv", piston)
    excel_csv(bad / "port_timing.csv", timing)
    adams_tab(bad / "tilt.tab", tilt, tilt=40.4)
    adams_tab(bad / "one_sign.tab", right, spoil=negate("JOINT_A2.FY (newton)"))
    tab_text(bad / "block_mass.txt", block)
    tab_text(bad / "gear_angle.txt", gear)
    workbook(bad / "swapped_pistons.xlsx", right, swap("Cylinder 1", "Cylinder 2"))
    workbook(bad / "port_timing.xlsx", timing)
    matlab(bad / "one_sign.mat", right, spoil=negate_part("bearing1", 1))
    matlab(bad / "tilt.mat", tilt, tilt=40.4)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]).resolve())
