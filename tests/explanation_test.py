#!/usr/bin/env python3
"""What explains a difference from a reference: the wrong parameter is named, and nothing is blamed without a cause.

usage: explanation_test.py BENTAXIS REPO_ROOT [options of unittest]

Written down before any result was seen: of 30 parameters, drawn with a fixed seed and each wrong by 0.5 to 5 %, at least
27 are named first, as what explains; of 10 differences that no parameter makes none is blamed on one. Parameters that
these data cannot tell from another (correlation of their derivatives at least 0.999) are left out before the draw.

Written after a first version had failed (2 of 10: its noise was measured over all columns together)
and before the second result: of 10 records with noise of a tenth of the difference in each column (root mean square) at least 9 name the true
parameter first; of 10 with noise as large as the difference none is blamed. Of 10 records that hold two columns alone (drive
torque and one bearing force) at least 9 name the true one first or among those that these data cannot tell from the first.

Written before a pair was drawn, from the derivatives alone: a pair is fit for the draw if its derivatives correlate by at most
0.5. The two are wrong by so much that both make a difference of the same size; the one that matters less is wrong by 1 to 5 %.
A draw counts if, by the derivatives, no single parameter explains more than 90 % of the difference (95 % would be blamed) and no
other pair 98 % (99 % would be). Of 10 such draws at least 9 name the pair first, with both changes right to a tenth.
Of 10 differences of such a pair and of a disturbance that is no parameter (one quarter of the size of the difference: 5.9 %
of its square) none is blamed on a pair or a single parameter.
"""

import csv
import itertools
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

PROGRAM = REPO = None  # set in main
SEED = 33
DRAWN, WRONG, NAMED_AT_LEAST = 40, 30, 27
FEW, FEW_NAMED = 10, 9
SEPARABLE = 0.999
NOISE = 1e-6  # N, Nm, mm, bar: a reaction with a smaller peak is round-off
LITTLE_CORRELATED, SINGLE_AT_MOST, OTHER_PAIR_AT_MOST = 0.5, 0.9, 0.98
DISTURBANCE = 0.25  # of the difference
DESCRIPTION = """schema = 1
kind = "external"
case = "{case}"
samples_per_revolution = 36
source = "the analytic model with one parameter or column changed"
how_made = "explanation_test.py"
who_may_change = "nobody"
digits = 16

[tolerance]
relative = 1e-9

[[curve]]
file = "curves.csv"
points = 36
models = ["analytic"]
"""


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


class ExplanationTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="bentaxis_test_")))
        self.case = REPO / "cases" / "bap63_rated.toml"

    def program(self, *arguments, status=0):
        result = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                                timeout=300)
        self.assertEqual(result.returncode, status, result.stderr)
        return result.stdout

    def curves(self, *changes):
        """Header and rows of the analytic model; None where the case is refused."""
        sets = [text for change in (*changes, "operation.samples_per_revolution=36") for text in ("--set", change)]
        result = subprocess.run([PROGRAM, "run", self.case, "--model", "analytic", *sets, "--out", "run"], cwd=self.folder,
                                capture_output=True, text=True, timeout=300)
        if result.returncode != 0:
            return None
        with open(self.folder / "run" / "analytic.csv", newline="") as file:
            header, *rows = csv.reader(file)
        return header, [[float(value) if value else math.nan for value in row] for row in rows]

    def write(self, name, curves):
        folder = self.folder / "references" / name
        folder.mkdir(parents=True)
        (folder / "description.toml").write_text(DESCRIPTION.format(case=self.case))
        header, rows = curves
        with open(folder / "curves.csv", "w", newline="") as file:
            csv.writer(file).writerows([header, *([("" if math.isnan(v) else repr(v)) for v in row] for row in rows)])

    def explanations(self):
        """By reference: the sentence, and the rows of the table."""
        text = self.program("regress", "references", "--json-file", "regress.json", status=1)
        report = json.loads((self.folder / "regress.json").read_text())
        (section,) = [run for run in report["runs"] if run["title"] == "What would explain the difference"]
        for name, sentence in dict(section["facts"]).items():
            self.assertIn(f"{name}: {sentence}", text)
            self.assertIn(f"{name}: {sentence}", report["verdict"]["answers"])
        rows = [dict(zip(section["table"]["columns"], row)) for row in section["table"]["rows"]]
        return {name: (sentence, [row for row in rows if row["case"] == name])
                for name, sentence in dict(section["facts"]).items()}

    def slopes(self):
        """By each parameter that the program can differentiate by: its value, and the change of all curves, over the peaks of
        their reactions, per relative change of it."""
        self.program("sensitivity", self.case, "--output", "peak:Rb1", "--set", "operation.samples_per_revolution=36", "--out",
                     "sensitivity")
        with open(self.folder / "sensitivity" / "sensitivity.csv", newline="") as file:
            values = {row["parameter"]: float(row["parameter_value"]) for row in csv.DictReader(file)
                      if row["found_by"] == "exact"}
        base, step, slopes = self.curves(), 1e-5, {}
        for name, value in values.items():
            there = self.curves(f"{name}={value * (1 + step)!r}") if value != 0 else None
            if there is not None:
                slopes[name] = [x / step for x in self.change(base, there)]
        return {name: (values[name], slope) for name, slope in slopes.items() if math.hypot(*slope) > 1e-4}

    def derivatives(self):
        """The values of the parameters whose effect differs from that of every other."""
        slopes = self.slopes()
        unit = {name: [x / math.hypot(*slope) for x in slope] for name, (_, slope) in slopes.items()}
        return {name: value for name, (value, _) in slopes.items()
                if all(abs(dot(unit[name], unit[other])) < SEPARABLE for other in unit if other != name)}

    def draw(self, count, seed, make):
        """References called draw_NN of wrong parameters, each changed once more by make(curves, draw); the true names."""
        values = self.derivatives()
        draw, truth = random.Random(seed), {}
        base = self.curves()
        while len(truth) < count:
            name = draw.choice(sorted(values))
            wrong = self.curves(f"{name}={values[name] * (1 + draw.choice([-1, 1]) * draw.uniform(0.01, 0.05))!r}")
            if wrong is None or self.size(base, wrong) < 1e-5:
                continue  # no such pump, or hardly a difference
            place = f"draw_{len(truth):02}"
            self.write(place, make(base, wrong, draw))
            truth[place] = name
        return truth

    @staticmethod
    def peaks(base):
        """Of every column that of its reaction, as differences are weighed: over all components and pistons."""
        header, rows = base
        own = [max((abs(row[c]) for row in rows if not math.isnan(row[c])), default=0) for c in range(len(header))]
        group = [name.split("_")[0].replace("yh", "xh") for name in header]
        return [max(peak for peak, other in zip(own, group) if other == mine) for mine in group]

    def change(self, base, other):
        """The difference of two runs, every column over the peak of its reaction."""
        return [0 if math.isnan(b[c] - a[c]) else (b[c] - a[c]) / peak for c, peak in enumerate(self.peaks(base))
                if c > 0 and peak > NOISE for a, b in zip(base[1], other[1])]

    def size(self, base, other):
        """Its root mean square."""
        change = self.change(base, other)
        return math.hypot(*change) / math.sqrt(len(change))

    @staticmethod
    def noisy(share):
        """Noise in every column in proportion to the difference in it (root mean square)."""
        def make(base, wrong, draw):
            header, rows = wrong
            gaps = [[b[c] - a[c] for a, b in zip(base[1], rows) if not math.isnan(b[c] - a[c])] for c in range(len(header))]
            sigma = [share * math.sqrt(sum(x * x for x in gap) / max(1, len(gap))) for gap in gaps]
            return header, [[row[0], *(v + sigma[c] * draw.gauss(0, 1) for c, v in enumerate(row[1:], 1))] for row in rows]
        return make

    def test_what_the_other_program_leaves_out_is_named(self):
        """Written before it was run: friction, weight or mass of the pistons left out as a whole are named as what explains."""
        friction = ("friction.piston_coulomb_N=0", "friction.piston_viscous_N_s_per_m=0", "friction.block_viscous_Nm_per_rpm=0",
                    "friction.shaft_viscous_Nm_per_rpm=0", "friction.shaft_torque_factor=1")
        wholes = {"friction": friction, "of_pistons": friction[:2], "weight": ("operation.gravity_m_per_s2=0",),
                  "mass": ("piston.mass_kg=0",)}
        for name, changes in wholes.items():
            self.write(name, self.curves(*changes))
        found = self.explanations()
        for name, changes in wholes.items():
            with self.subTest(name):
                sentence, rows = found[name]
                self.assertEqual({row["parameter"] for row in rows if row["explains"] == "yes"},
                                 {change.split("=")[0] for change in changes} - self.absent())
                self.assertIn("100 % of the difference", sentence)
                self.assertNotIn("other causes remain", sentence)

    def absent(self):
        """Of the names above those whose value is 0 in the case: they cannot be left out of it."""
        import tomllib
        friction = tomllib.loads(self.case.read_text())["friction"]
        return {f"friction.{name}" for name in ("piston_coulomb_N", "piston_viscous_N_s_per_m") if friction.get(name, 0) == 0}

    def test_little_noise_hides_nothing(self):
        truth = self.draw(FEW, SEED + 1, self.noisy(0.1))
        found = self.explanations()
        named = [place for place, name in truth.items()
                 if found[place][1] and found[place][1][0]["parameter"] == name and found[place][1][0]["explains"] == "yes"]
        self.assertGreaterEqual(len(named), FEW_NAMED, {p: (truth[p], found[p][0]) for p in truth if p not in named})

    def test_much_noise_blames_nothing(self):
        truth = self.draw(FEW, SEED + 2, self.noisy(1.0))
        for place, (sentence, rows) in self.explanations().items():
            with self.subTest(place, truth=truth[place]):
                self.assertTrue(sentence.startswith("No parameter of the case explains the difference"), sentence)
                self.assertNotIn("yes", [row["explains"] for row in rows])

    def draw_pairs(self, seed, make):
        """References called draw_NN of two wrong parameters, changed once more by make(base, wrong, draw); the true values."""
        slopes = self.slopes()
        names = sorted(slopes)
        gram = {(a, b): dot(slopes[a][1], slopes[b][1]) for a in names for b in names}
        size = {name: math.sqrt(gram[name, name]) for name in names}
        pairs = [pair for pair in itertools.combinations(names, 2)
                 if abs(gram[pair]) <= LITTLE_CORRELATED * size[pair[0]] * size[pair[1]]]
        self.assertGreater(len(pairs), 3 * FEW)

        def share(difference, *chosen):
            """Of the square of the difference, by the linear fit. The difference: of which parameter how much, relative."""
            along = [sum(change * gram[k, name] for name, change in difference.items()) / size[k] for k in chosen]
            whole = sum(x * y * gram[a, b] for a, x in difference.items() for b, y in difference.items())
            if len(chosen) == 1:
                return along[0] ** 2 / whole
            cosine = gram[chosen] / size[chosen[0]] / size[chosen[1]]
            if abs(cosine) >= SEPARABLE:
                return 0
            return (along[0] ** 2 + (along[1] - cosine * along[0]) ** 2 / (1 - cosine ** 2)) / whole

        base, draw, truth = self.curves(), random.Random(seed), {}
        for _ in range(100 * FEW):
            if len(truth) == FEW:
                break
            pair = draw.choice(pairs)
            amount = draw.uniform(0.01, 0.05) * min(size[name] for name in pair)
            change = {name: draw.choice([-1, 1]) * amount / size[name] for name in pair}
            if max(share(change, name) for name in names) > SINGLE_AT_MOST or max(
                    share(change, *other) for other in itertools.combinations(names, 2) if other != pair) > OTHER_PAIR_AT_MOST:
                continue
            wrong = self.curves(*(f"{name}={slopes[name][0] * (1 + by)!r}" for name, by in change.items()))
            if wrong is None or self.size(base, wrong) < 1e-5:
                continue  # no such pump, or hardly a difference
            place = f"draw_{len(truth):02}"
            self.write(place, make(base, wrong, draw))
            truth[place] = {name: (slopes[name][0], by) for name, by in change.items()}
        self.assertEqual(len(truth), FEW)
        return truth

    def test_pairs_are_named(self):
        truth = self.draw_pairs(SEED + 4, lambda base, wrong, draw: wrong)
        found, missed = self.explanations(), {}
        for place, changes in truth.items():
            sentence, rows = found[place]
            blamed = {row["parameter"]: row for row in rows if row["explains"] == "yes"}
            if set(blamed) != set(changes) or any(
                    abs(blamed[name]["nearest"] / value - 1 - by) > 0.1 * abs(by) for name, (value, by) in changes.items()):
                missed[place] = changes, sentence
                continue
            self.assertRegex(sentence, "^({0}) .* and ({0}) .* together explain (99|100)".format("|".join(changes)))
            alone = [row for row in rows if row["explains"] == "no"]
            self.assertTrue(all(row["share"] < 0.95 for row in alone[:1]), rows)
        print(f"{FEW - len(missed)} of {FEW} pairs named first; missed: {missed}", file=sys.stderr)
        self.assertLessEqual(len(missed), FEW - FEW_NAMED, missed)

    def test_no_pair_is_blamed_for_what_is_no_parameter(self):
        def disturbed(base, wrong, draw):
            header, rows = wrong
            share = DISTURBANCE * self.size(base, wrong)
            return header, [[row[0], *(v + share * peak * math.sqrt(2) * math.sin(math.radians(7 * row[0]) + c)
                                       for c, (v, peak) in enumerate(zip(row[1:], self.peaks(base)[1:])))] for row in rows]

        truth = self.draw_pairs(SEED + 5, disturbed)
        for place, (sentence, rows) in self.explanations().items():
            with self.subTest(place, truth=truth[place]):
                self.assertTrue(sentence.startswith("No parameter of the case explains the difference"), sentence)
                self.assertIn("; the best pair, ", sentence)
                self.assertNotIn("yes", [row["explains"] for row in rows])

    def test_a_pump_that_does_not_run_is_no_explanation(self):
        """The difference is that of a negative friction: every step towards it is refused, and nothing is blamed."""
        name = "friction.piston_viscous_N_s_per_m"  # 0 in the case
        (header, base), (_, there) = self.curves(), self.curves(f"{name}=20")
        self.write("negative", (header, [[a[0], *(2 * x - y for x, y in zip(a[1:], b[1:]))] for a, b in zip(base, there)]))
        (sentence, rows), = self.explanations().values()
        self.assertTrue(sentence.startswith("No parameter of the case explains the difference"), sentence)
        self.assertNotIn("yes", [row["explains"] for row in rows])
        tried = [row for row in rows if row["parameter"] == name]
        self.assertTrue(tried, rows)
        self.assertEqual({row["nearest"] for row in tried}, {0})

    def test_few_columns(self):
        columns = ["theta_deg", "Td_z1_Nm", "Rb1_x1_N"]

        def make(base, wrong, draw):
            header, rows = wrong
            places = [header.index(name) for name in columns]
            return columns, [[row[c] for c in places] for row in rows]

        truth = self.draw(FEW, SEED + 3, make)
        found = self.explanations()
        missed = {}
        for place, name in truth.items():
            if place not in found:
                continue  # it does not differ in these columns
            first = found[place][1][0] if found[place][1] else {}
            if first.get("explains") != "yes" or name not in (first["parameter"], *first["not to be told apart"].split(", ")):
                missed[place] = name, found[place][0]
        self.assertLessEqual(len(missed), FEW - FEW_NAMED, missed)

    def test_a_case_without_derivatives(self):
        """Teeth in contact have no exact derivatives: that is said, and the difference stays one."""
        self.case = REPO / "cases" / "bap63_teeth.toml"
        self.write("teeth", self.curves("piston.mass_kg=0.0927"))
        (sentence, rows), = self.explanations().values()
        self.assertRegex(sentence, "^No explanation was searched for: .+")
        self.assertEqual(rows, [])

    def test_wrong_parameters_are_named(self):
        values = self.derivatives()
        self.assertGreaterEqual(len(values), 10, values)
        draw = random.Random(SEED)
        truth = {}
        while len(truth) < DRAWN:
            name = draw.choice(sorted(values))
            share = draw.choice([-1, 1]) * draw.uniform(0.005, 0.05)
            curves = self.curves(f"{name}={values[name] * (1 + share)!r}")
            if curves is None:
                continue  # no such pump
            place = f"wrong_{len(truth):02}"
            self.write(place, curves)
            truth[place] = name, share
        named, missed = 0, []
        found = self.explanations()
        # Where the results agree to the tolerance there is nothing to explain: the first that differ.
        differing = [place for place in truth if place in found][:WRONG]
        self.assertEqual(len(differing), WRONG)
        for place in differing:
            name, share = truth[place]
            sentence, rows = found[place]
            first = rows[0] if rows else {}
            if first.get("parameter") == name and first["explains"] == "yes":
                named += 1
                self.assertAlmostEqual(first["nearest"], values[name] * (1 + share), delta=1e-3 * abs(values[name]))
            else:
                missed.append((name, share, sentence))
        print(f"{named} of {WRONG} named first; missed: {missed}", file=sys.stderr)
        self.assertGreaterEqual(named, NAMED_AT_LEAST, missed)

    def test_nothing_is_blamed_without_a_cause(self):
        header, base = self.curves()
        draw = random.Random(SEED)
        column = header.index
        peaks = [max(abs(row[c]) for row in base) for c in range(len(header))]

        def changed(change):
            return header, [[row[0], *(change(i, c, row[c]) for c in range(1, len(header)))] for i, row in enumerate(base)]

        def scaled(name, factor):
            return changed(lambda i, c, v: v * factor if c == column(name) else v)

        def shifted(rows):  # the angles of the record are late
            return changed(lambda i, c, v: base[(i - rows) % len(base)][c])

        def noise(sigma):
            return changed(lambda i, c, v: v + sigma * peaks[c] * draw.gauss(0, 1))

        def harmonic(order, share):
            return changed(lambda i, c, v: v + share * peaks[c] * math.sin(math.radians(order * base[i][0])))

        controls = {
            "scaled_Rs_z": scaled("Rs_1_z2_N", 1.02),
            "scaled_Th_x": scaled("Th_x2_Nm", 0.97),
            "scaled_Rs_x": scaled("Rs_3_x2_N", 1.05),
            "sign_Rs_y": scaled("Rs_2_y2_N", -1),
            "sign_Rc_x": scaled("Rc_1_x2_N", -1),
            "noise_1e-3": noise(1e-3),
            "noise_1e-2": noise(1e-2),
            "shifted_10_deg": shifted(1),
            "shifted_20_deg": shifted(-2),
            "harmonic_3": harmonic(3, 0.01),
        }
        self.assertEqual(len(controls), 10)
        for name, curves in controls.items():
            self.write(name, curves)
        found = self.explanations()
        self.assertEqual(set(found), set(controls))
        for name, (sentence, rows) in found.items():
            with self.subTest(name):
                self.assertTrue(sentence.startswith("No parameter of the case explains the difference"), sentence)
                self.assertNotIn("yes", [row["explains"] for row in rows])

    def test_compare_says_the_same(self):
        self.write("one", self.curves("piston.mass_kg=0.092"))
        (sentence, rows), = self.explanations().values()
        changed = ["--set", "operation.samples_per_revolution=36"]
        text = self.program("compare", self.case, *changed, "--with", "references/one", "--out", "out", status=1)
        verdict = json.loads((self.folder / "out" / "report.json").read_text())["verdict"]
        self.assertIn(f"one: {sentence}", text)
        self.assertIn(f"one: {sentence}", verdict["answers"])
        self.assertIn("piston.mass_kg", sentence)


if __name__ == "__main__":
    PROGRAM, REPO = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
