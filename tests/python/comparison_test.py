"""Comparisons in Python, and both models held to stored curves."""

import hashlib
import json
import locale
import os
import pickle
import struct
import xml.etree.ElementTree

import numpy

import bentaxis
from support import CASES, REPO, ModuleTest, main


class ComparisonTest(ModuleTest):
    def inputs_of(self, case, name):
        bentaxis.compare(case).report(self.folder / name)
        report = json.loads((self.folder / name / "report.json").read_text())
        return {entry["file"].split("/")[-1]: entry["sha256"] for entry in report["provenance"]["inputs"]}

    def test_a_report_names_the_bytes_that_were_read(self):
        file, curve = self.folder / "case.toml", self.folder / "curve.csv"
        file.write_text((CASES / "bap63_rated.toml").read_text())
        curve.write_text("theta_deg,pressure_bar\n0,5\n90,5\n180,200\n270,200\n")
        read = {one.name: hashlib.sha256(one.read_bytes()).hexdigest() for one in (file, curve)}
        case = bentaxis.read_case(file, {"operation.samples_per_revolution": 36, "pressure.kind": "curve",
                                         "pressure.file": "curve.csv"})
        self.assertEqual(self.inputs_of(pickle.loads(pickle.dumps(case)), "pickled"), read)
        file.write_text("schema = 1")
        curve.write_text("theta_deg,pressure_bar\n0,5\n90,5\n180,300\n270,300\n")
        self.assertEqual(self.inputs_of(case, "edited"), read)
        file.unlink()
        curve.unlink()
        self.assertEqual(self.inputs_of(case, "gone"), read)

    def test_a_decimal_comma_changes_nothing(self):
        # LC_NUMERIC of the C library, with a comma; desktop programs set such a locale for the whole process.
        entries = b",\0\0\0" + b",\0\0\0" + b"\0" * 4 + b"UTF-8\0"
        (self.folder / "comma").mkdir()
        (self.folder / "comma/LC_NUMERIC").write_bytes(
            struct.pack("=8I", 0x20031114, 6, 32, 34, 35, 36, 40, 44) + entries)
        os.environ["LOCPATH"] = str(self.folder)
        self.addCleanup(os.environ.pop, "LOCPATH")
        self.addCleanup(locale.setlocale, locale.LC_NUMERIC, "C")

        def written(name):
            bentaxis.compare(self.case(operation__samples_per_revolution=36)).report(self.folder / name)
            report = json.loads((self.folder / name / "report.json").read_text())
            report.pop("provenance")
            for model in report["models"]:
                model.pop("seconds", None)
            return report, *((self.folder / name / file).read_text() for file in ("analytic.csv", "multibody.csv"))

        usual = written("usual")
        locale.setlocale(locale.LC_NUMERIC, "comma")
        self.assertEqual(locale.localeconv()["decimal_point"], ",")
        self.assertEqual(written("with_a_comma"), usual)

    def test_the_first_comparison(self):
        comparison = bentaxis.compare(self.case())
        self.assertTrue(comparison.agrees)
        self.assertIn("agree", comparison.headline)
        self.assertLess(comparison.worst.largest_over_peak, 1e-9)
        self.assertEqual(comparison.worst.verdict, "agrees")
        self.assertLessEqual({"Rs", "Rc", "Rb1", "Rb2", "Rcs", "Td"}, set(comparison.groups))
        self.assertEqual(max(one.largest_over_peak for one in comparison.groups.values()),
                         comparison.worst.largest_over_peak)
        self.assertTrue(all(check.holds for check in comparison.checks))
        torque = comparison.analytic["Td_Nm"]
        self.assert_same(torque, bentaxis.run(self.case())["Td_Nm"])
        self.assert_close(comparison.multibody["Td_Nm"], torque, 1e-12)
        name = comparison.worst.name
        difference = comparison.multibody[name] - comparison.analytic[name]
        self.assertEqual(numpy.max(numpy.abs(difference)), comparison.worst.largest)

    def test_the_report_is_the_program_s(self):
        files = bentaxis.compare(self.case()).report(self.folder / "mine")
        self.run_program("compare", CASES / "bap63_rated.toml", "--out", "theirs")
        self.assertEqual(sorted(file.name for file in map(type(self.folder), files)),
                         sorted(file.name for file in (self.folder / "theirs").iterdir()))
        mine, theirs = (json.loads((self.folder / folder / "report.json").read_text()) for folder in ("mine", "theirs"))
        self.assertEqual(list(mine), list(theirs))
        self.assertEqual(mine["provenance"]["inputs"][0], theirs["provenance"]["inputs"][0])
        self.assertIn("Python", mine["provenance"]["command"])
        self.assertEqual((self.folder / "mine/analytic.csv").read_text(), (self.folder / "theirs/analytic.csv").read_text())
        self.assertIn("published", mine)

    def test_assumptions_are_taken_apart(self):
        comparison = bentaxis.compare(self.case(), multibody={"piston_friction": False})
        self.assertTrue(comparison.agrees)
        self.assertIn("explained", [one.verdict for one in comparison.channels])
        words = self.refused(bentaxis.InputError, lambda: bentaxis.compare(self.case(), multibody={"gear": "none"}))
        self.assertIn("gear", words)
        self.assertNotIn("--", words)
        self.refused(bentaxis.InputError, lambda: bentaxis.compare(self.case(), multibody=["gear=none"]))

    def test_a_wrong_input_is_noticed(self):
        comparison = bentaxis.compare(self.case(), multibody_case=self.case(pump__tilt_deg=39.9))
        self.assertFalse(comparison.agrees)
        self.assertEqual(comparison.worst.verdict, "differs")
        self.assertFalse(bentaxis.compare(self.case(), tolerance=1e-17).agrees)
        self.refused(bentaxis.InputError, lambda: bentaxis.compare(self.case(), tolerance=0))

    def test_channels_by_the_smallest_scene(self):
        comparison = bentaxis.compare(self.case(), channels="Rc")
        self.assertTrue(comparison.agrees)
        self.assertEqual({one.channel.quantity for one in comparison.channels if one.verdict == "agrees"}, {"Rc"})

    def test_hydraulic_cases_have_their_pressure(self):
        comparison = bentaxis.compare(self.case("bap63_rated_hydraulic", operation__samples_per_revolution=90))
        self.assertTrue(comparison.agrees)
        self.assertGreater(len(comparison.pressure), 10)
        self.assertIsNone(bentaxis.compare(self.case(operation__samples_per_revolution=36)).pressure)


class RegressionTest(ModuleTest):
    def test_shipped_curves(self):
        regression = bentaxis.regress(filter="bap63_rated")
        self.assertTrue(regression.agrees)
        self.assertIn("agree", regression.summary)
        outcome = regression.outcomes[0]
        self.assertEqual(outcome.state, "agrees")
        self.assertEqual({one.model for one in outcome.groups}, {"analytic", "multibody"})
        self.assert_close(outcome.result("analytic")["Td_Nm"], outcome.reference("analytic")["Td_Nm"], 1e-12)
        regression.write_junit(self.folder / "junit.xml")
        self.assertEqual(xml.etree.ElementTree.parse(self.folder / "junit.xml").getroot().get("failures"), "0")

    def test_folders_and_what_is_none(self):
        place = next((REPO / "reference_data").glob("**/bap63_rated/**/reference.toml"), None) or next(
            (REPO / "reference_data/high_precision").iterdir())
        folder = place.parent if place.is_file() else place
        self.assertEqual(len(bentaxis.regress(folder).outcomes), 1)
        self.assertIn("leaves none", self.refused(bentaxis.InputError, lambda: bentaxis.regress(folder, filter="zzz")))
        self.refused(bentaxis.InputError, lambda: bentaxis.regress(self.folder))


if __name__ == "__main__":
    main()
