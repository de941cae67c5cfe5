"""Cases in Python: reading, changing, refusing, writing, copies, pickles."""

import copy
import os
import pickle
import threading

import numpy

import bentaxis
from support import CASES, ModuleTest, main


class CaseTest(ModuleTest):
    def test_values_are_those_of_the_file_in_its_units(self):
        case = self.case()
        self.assertEqual(case["pump.tilt_deg"], 40)
        self.assertEqual(case["pump.pistons"], 5)
        self.assertIsInstance(case["pump.pistons"], int)
        self.assertEqual(case["pressure.kind"], "ideal")
        self.assertIsInstance(case["port_plate.delivery_arc_deg"] if "port_plate.delivery_arc_deg" in case
                              else (0.0, 0.0), tuple)
        self.assertEqual(case.name, case["name"])

    def test_shipped_cases_are_read_by_name(self):
        titles = bentaxis.cases()
        self.assertEqual(sorted(titles), sorted(file.stem for file in CASES.glob("*.toml")))
        case = bentaxis.read_case("bap63_rated")
        self.assertEqual(case, bentaxis.read_case(CASES / "bap63_rated.toml"))
        self.assertEqual(case.name, titles["bap63_rated"])
        self.assertIn('did you mean "bap63_rated"?',
                      self.refused(bentaxis.InputError, lambda: bentaxis.read_case("bap63_ratd")))

    def test_every_key_has_a_value_and_is_documented(self):
        case = self.case("bap63_rated_hydraulic")
        self.assertGreater(len(case), 60)
        for key in case:
            self.assertIsNotNone(case[key], key)
            self.assertIn(key, case)
            self.assertTrue(bentaxis.parameter(key).meaning or bentaxis.parameter(key).words, key)
        self.assertEqual(dict(case.items()), {key: case[key] for key in case.keys()})
        self.assertEqual(bentaxis.parameter("pump.tilt_deg").unit, "deg")

    def test_every_value_can_be_put_back(self):
        for name in ("bap63_rated_hydraulic", "bap63_motor_start", "bap63_teeth"):
            case = self.case(name)
            before = case.text()
            for key, value in case.items():
                if value != "" and key != "schema":
                    case[key] = value
            self.assertEqual(case.text(), before)

    def test_values_are_changed_and_defaults_follow(self):
        case = self.case()
        case["pump.tilt_deg"] = 35
        self.assertEqual(case["pump.tilt_deg"], 35)
        case["pump.tilt_deg"] = numpy.float64(34.5)
        self.assertEqual(case["pump.tilt_deg"], 34.5)
        case["pump.tilt_deg"] = numpy.array(34.25)
        self.assertEqual(case["pump.tilt_deg"], 34.25)
        case["operation.samples_per_revolution"] = numpy.int32(36)
        self.assertEqual(case["operation.samples_per_revolution"], 36)
        case.update({"pump.tilt_deg": 30, "operation.speed_rpm": -1200})
        self.assertEqual((case["pump.tilt_deg"], case["operation.speed_rpm"]), (30, -1200))

    def test_what_is_refused_has_the_words_of_the_program_and_changes_nothing(self):
        case = self.case()
        for text in ("a\0b", "\ud800"):
            self.assertIn("name: must be a text that UTF-8 can encode, without a null character",
                          self.refused(bentaxis.InputError, lambda t=text: case.__setitem__("name", t)))
        words = self.refused(bentaxis.InputError, lambda: case.__setitem__("pump.tilt_deg", 95))
        program = self.run_program("run", CASES / "bap63_rated.toml", "--model", "analytic", "--set", "pump.tilt_deg=95",
                                   status=2).stderr
        self.assertEqual(words, 'case["pump.tilt_deg"] = 95: ' + program.strip().partition(": ")[2].partition(": ")[2])
        self.assertIn("[0, 90)", words)
        for key, value in (("pump.tilt_degrees", 3), ("pump.tilt_deg", float("nan")), ("pump.tilt_deg", "35"),
                           ("pump.pistons", 5.5), ("pump.tilt_deg", None), ("pressure.kind", "steady")):
            with self.assertRaises(bentaxis.InputError, msg=f"{key} = {value}"):
                case[key] = value
        with self.assertRaises(bentaxis.InputError):
            case.update({"pump.tilt_deg": 20, "pump.pistons": -1})
        self.assertEqual(case, self.case())
        self.assertIn("pump.tilt_deg", self.refused(KeyError, lambda: case["pump.tilt_degr"]))

    def test_errors_are_pythons_too(self):
        self.assertTrue(issubclass(bentaxis.InputError, ValueError))
        self.assertTrue(issubclass(bentaxis.ComputationError, RuntimeError))
        words = self.refused(ValueError, lambda: bentaxis.read_case(self.folder / "none.toml"))
        self.assertIn("none.toml: cannot be read", words)
        self.assertNotIn("--set", words)

    def test_written_files_read_back(self):
        for name in ("bap63_rated_hydraulic", "bap63_load_step", "bap63_teeth"):
            case = self.case(name)
            case.write(self.folder / "case.toml")
            again = bentaxis.read_case(self.folder / "case.toml")
            self.assertEqual(again.text(), case.text())
            self.assertEqual(bentaxis.parse_case(case.text(), CASES / "x.toml").text(), case.text())

    def test_relative_paths_stand_where_they_were_read(self):
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(CASES)
        case = bentaxis.read_case("bap63_load_step.toml")
        os.chdir(self.folder)
        case["pump.tilt_deg"] = 33
        self.assertTrue(os.path.isabs(case.file))
        case.write("moved.toml")
        self.assertEqual(bentaxis.read_case("moved.toml")["pump.tilt_deg"], 33)

    def test_copies_and_pickles_are_equal_and_apart(self):
        case = self.case("bap63_rated_hydraulic", pump__tilt_deg=38)
        for other in (case.copy(), copy.copy(case), copy.deepcopy(case), pickle.loads(pickle.dumps(case))):
            self.assertEqual(other, case)
            other["pump.tilt_deg"] = 20
            self.assertEqual(case["pump.tilt_deg"], 38)
            self.assertNotEqual(other, case)
        with self.assertRaises(TypeError):
            hash(case)

    def test_doubts_are_those_of_the_program(self):
        self.assertEqual(self.case().doubts(), [])
        doubts = self.case(pump__tilt_deg=0.7).doubts()
        self.assertIn("tilt-in-radians", [doubt.code for doubt in doubts])
        self.assertIn("63.7", self.case().summary())
        self.case().validate()

    def test_a_case_changed_by_another_thread_is_no_part_of_a_run(self):
        case = self.case()
        stop = threading.Event()

        def change():
            while not stop.is_set():
                case["pump.tilt_deg"] = 20
                case["pump.tilt_deg"] = 40

        allowed = [bentaxis.run(self.case(pump__tilt_deg=tilt), channels="Td")["Td_Nm"] for tilt in (20, 40)]
        thread = threading.Thread(target=change)
        thread.start()
        try:
            for _ in range(50):
                torque = bentaxis.run(case, channels="Td")["Td_Nm"]
                self.assertTrue(any(numpy.array_equal(torque, one) for one in allowed))
        finally:
            stop.set()
            thread.join()


if __name__ == "__main__":
    main()
