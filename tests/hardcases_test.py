"""The catalogue of hard cases, and the robust edges of long and parallel runs.

usage: hardcases_test.py PROGRAM REPOSITORY
"""
import csv
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from command_line_test import PUMP

PROGRAM = REPO = None  # set in main
SECONDS = 120  # no single command may take longer


def run(*arguments, **options):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=SECONDS, **options)


class Temporary(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="bentaxis_hard_")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)


class CatalogueTest(Temporary):
    def test_nothing_is_silently_wrong(self):
        result = run("hardcases", "--out", self.folder)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        report = json.loads((self.folder / "hardcases.json").read_text())
        self.assertGreaterEqual(len(report["cases"]), 60)
        self.assertEqual({m["model"] for c in report["cases"] for m in c["models"]}, {"analytic", "multibody", "residual"})
        for case in report["cases"]:
            for model in case["models"]:
                where = f"{case['name']}, {model['model']}"
                self.assertIn(model["verdict"], ("accurate", "refused"), where)
                if model["verdict"] == "refused":
                    self.assertTrue(model["message"], where)
                for group in model["groups"]:
                    if group["loss_over_peak"] > 1e-10:
                        ratio = group["loss_over_peak"] / group["predicted"]
                        self.assertTrue(0.01 < ratio < 100, f"{where}: {group}")
        with open(self.folder / "hardcases.csv", newline="") as stream:
            self.assertEqual(len(list(csv.DictReader(stream))), 3 * len(report["cases"]))
        self.assertIn("Hard cases", (self.folder / "hardcases.html").read_text())
        (long_run,) = [run for run in report["runs"] if run["title"] == "20 turns integrated"]
        self.assertIn("accuracy 1e-06;", long_run["text"])
        self.assertRegex(result.stdout, r"20 turns integrated, accuracy 1e-06, ")

    def test_a_wrong_number_is_noticed(self):
        """The control: one entry of one stored curve off by 1e-9 of itself."""
        catalogue = self.folder / "catalogue"
        shutil.copytree(REPO / "reference_data" / "hard", catalogue)
        file = catalogue / "tilt_45" / "reference.csv"
        rows = [line.split(",") for line in file.read_text().splitlines()]
        column = rows[0].index("Rs_1_z2_N")
        worst = max(rows[1:], key=lambda row: abs(float(row[column])))
        worst[column] = repr(float(worst[column]) * (1 + 1e-9))
        file.write_text("\n".join(map(",".join, rows)) + "\n")
        result = run("hardcases", "--catalogue", catalogue, "--filter", "tilt_45", "--out", self.folder / "out")
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("WRONG", result.stdout)

    def test_a_refusal_that_is_not_expected_is_noticed(self):
        catalogue = self.folder / "catalogue"
        shutil.copytree(REPO / "reference_data" / "hard", catalogue)
        file = catalogue / "catalogue.toml"
        file.write_text(file.read_text().replace('multibody = "refused"', 'multibody = "accurate"'))
        result = run("hardcases", "--catalogue", catalogue, "--filter", "mass_1e-9", "--out", self.folder / "out")
        self.assertEqual(result.returncode, 1, result.stdout)

    def test_catalogues_that_are_none(self):
        top = 'base = "x"\nsamples_per_revolution = 8\n'
        for text, said in (("case = [1]", "base"), (top + "case = [1]", "case"), (top + "[[case]]\nname = 3\n", "name"),
                           ("[[case]", ":1:"), (top + '[[case]]\nname = "a"\ngroup = "g"\nhard = "h"\nanalytic = "?"\n',
                                                'analytic = "?"')):
            with self.subTest(text):
                (self.folder / "catalogue.toml").write_text(text)
                result = run("hardcases", "--catalogue", self.folder, "--out", self.folder / "out")
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertEqual(len(result.stderr.splitlines()), 1)
                self.assertIn("catalogue.toml", result.stderr)
                self.assertIn(said, result.stderr)
                self.assertFalse((self.folder / "out").exists())

    def test_number_of_turns(self):
        for turns in ("-1", "1.5", "many", "1000000"):
            result = run("hardcases", "--turns", turns, "--out", self.folder / "out")
            self.assertEqual(result.returncode, 2)
            self.assertEqual(len(result.stderr.splitlines()), 1)
            self.assertLess(len(result.stderr), 120)
            self.assertIn("--turns", result.stderr)
            self.assertFalse((self.folder / "out").exists())

    def test_unknown_name(self):
        result = run("hardcases", "--filter", "no such case", "--out", self.folder / "out")
        self.assertEqual(result.returncode, 2)
        self.assertIn("no such case", result.stderr)


class WarningTest(Temporary):
    def test_lost_digits_are_said(self):
        case = REPO / "reference_data" / "hard" / "assembly_1e-8" / "case.toml"
        result = run("run", case, "--model", "analytic", "--out", self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("of its peak only", result.stderr)
        case = REPO / "reference_data" / "hard" / "tilt_45" / "case.toml"
        self.assertEqual(PUMP.sub("", run("run", case, "--model", "analytic", "--out", self.folder).stderr), "")

    def test_no_loss_is_silent(self):
        """Whatever the catalogue has lost more of than 3e-9 of a peak, `run` warns of; of sound cases it says nothing."""
        self.assertEqual(run("hardcases", "--turns", "0", "--out", self.folder).returncode, 0)
        options = {"analytic": ["--model", "analytic"], "multibody": ["--model", "multibody"],
                   "residual": ["--model", "multibody", "--reactions", "residual"]}
        lossy = 0
        for case in json.loads((self.folder / "hardcases.json").read_text())["cases"]:
            file = REPO / "reference_data" / "hard" / case["name"] / "case.toml"
            for model in case["models"]:
                lost = {g["group"] for g in model["groups"] if g["loss_over_peak"] > 3e-9}
                sound = model["verdict"] == "accurate" and all(
                    max(g["loss_over_peak"], g["predicted"]) < 1e-11 for g in model["groups"])
                if not lost and not sound:
                    continue
                lossy += bool(lost)
                with self.subTest(case=case["name"], model=model["model"]):
                    said = PUMP.sub("", run("run", file, *options[model["model"]], "--out", self.folder).stderr)
                    warned = set(re.findall(r"(\w+) is accurate to", said)) | set(re.findall(r"(\w+) \d\.\de-\d+", said))
                    self.assertLessEqual(lost, warned, said)
                    if sound:
                        self.assertEqual(said, "")
        self.assertGreater(lossy, 15)

    def test_the_report_warns_too(self):
        case = REPO / "reference_data" / "hard" / "mass_1e6" / "case.toml"
        self.assertIn(run("compare", case, "--out", self.folder).returncode, (0, 1))
        warnings = json.loads((self.folder / "report.json").read_text())["warnings"]
        self.assertIn("digits lost in Simbody", {w["name"] for w in warnings})

    def test_a_body_that_cannot_be_is_refused(self):
        text = (REPO / "reference_data" / "high_precision" / "noload_2350_real" / "case.toml").read_text()
        case = self.folder / "case.toml"
        case.write_text(re.sub(r"(?m)^mass_kg = .*", "mass_kg = 0", text, count=1))
        result = run("run", case, "--model", "multibody", "--reactions", "residual", "--out", self.folder)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("without mass", result.stderr)


class LongRunTest(Temporary):
    def case(self, samples):
        text = (REPO / "cases" / "bap63_rated.toml").read_text()
        text = text.replace("pistons = 5 ", "pistons = 9 ")
        text = text.replace("samples_per_revolution = 720", f"samples_per_revolution = {samples}")
        file = self.folder / "long.toml"
        file.write_text(text)
        return file

    def test_memory_does_not_grow_with_the_samples(self):
        """As a table 60000 samples of 9 pistons need 60 MB more than a thousand do."""
        peak = {}
        for samples in (1000, 60000):
            file = self.case(samples)
            script = ("import resource, subprocess, sys; r = subprocess.run(sys.argv[1:], capture_output=True); "
                      "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss); sys.exit(r.returncode)")
            result = subprocess.run([sys.executable, "-c", script, PROGRAM, "run", str(file), "--model", "analytic",
                                     "--out", str(self.folder / "out")], capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stderr)
            peak[samples] = int(result.stdout)
        self.assertLess(peak[60000] - peak[1000], 10000)  # kB
        with open(self.folder / "out" / "analytic.csv") as stream:
            self.assertEqual(sum(1 for _ in stream), 60001)

    def test_streamed_and_tabulated_files_are_the_same(self):
        file = self.case(36)
        self.assertEqual(run("run", file, "--model", "analytic", "--out", self.folder / "a").returncode, 0)
        self.assertIn(run("compare", file, "--out", self.folder / "b").returncode, (0, 1))
        self.assertEqual((self.folder / "a" / "analytic.csv").read_bytes(),
                         (self.folder / "b" / "analytic.csv").read_bytes())

    def test_file_size_limit(self):
        """A file that may not grow ends like a full disk: a message, nothing left."""
        def limit():
            import signal
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 20, 1 << 20))
        result = run("run", self.case(60000), "--model", "analytic", "--out", self.folder / "new", preexec_fn=limit)
        self.assertEqual(result.returncode, 2)
        self.assertIn("analytic.csv", result.stderr)
        self.assertFalse((self.folder / "new").exists())


class TwoRunsTest(Temporary):
    def test_a_failing_run_leaves_the_results_of_another(self):
        """The first makes the folder and is interrupted; the second puts its results there meanwhile."""
        text = (REPO / "cases" / "bap63_rated.toml").read_text()
        quick = self.folder / "quick.toml"
        quick.write_text(text.replace("samples_per_revolution = 720", "samples_per_revolution = 4"))
        slow = self.folder / "slow.toml"
        slow.write_text(text.replace("samples_per_revolution = 720", "samples_per_revolution = 2000000"))
        out = self.folder / "both"
        first = subprocess.Popen([PROGRAM, "run", str(slow), "--model", "analytic", "--out", str(out)],
                                 stderr=subprocess.PIPE)
        try:
            while not out.exists():
                self.assertIsNone(first.poll())
            result = run("run", quick, "--model", "multibody", "--out", out)
            self.assertEqual(result.returncode, 0, result.stderr)
            first.terminate()
            first.communicate(timeout=SECONDS)
        finally:
            first.kill()
            first.wait()
        self.assertEqual(first.returncode, 130)
        self.assertEqual(os.listdir(out), ["multibody.csv"])


if __name__ == "__main__":
    PROGRAM, REPO = sys.argv[1], Path(sys.argv[2])
    unittest.main(argv=sys.argv[:1], verbosity=1)
