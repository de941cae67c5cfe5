"""Runs in Python: the program's numbers without copies, without Python's lock, ended by Ctrl-C."""

import gc
import os
import pickle
import signal
import sys
import threading
import time
import warnings

import numpy

import bentaxis
from support import CASES, ModuleTest, columns_of, main


def motion(count=40):
    turn = numpy.linspace(0, 360, count)
    return {"theta_deg": turn, "psi_deg": turn, "theta_rpm": numpy.full(count, 1500), "psi_rpm": numpy.full(count, 1500),
            "theta_rad_per_s2": numpy.zeros(count), "psi_rad_per_s2": [0] * count}


class TableTest(ModuleTest):
    def test_columns_are_looks_at_one_memory(self):
        table = bentaxis.run(self.case())
        torque = table["Td_z1_Nm"]
        self.assertIs(torque.base, table)
        self.assertTrue(numpy.shares_memory(torque, table["Td_z1_Nm"]))
        self.assertTrue(numpy.shares_memory(torque, table.values))
        self.assertFalse(torque.flags.owndata)
        self.assertFalse(torque.flags.writeable)
        with self.assertRaises(ValueError):
            torque[0] = 1
        with self.assertRaises(ValueError):
            table.values[0, 0] = 1
        place = table.channels.index("Td_z1_Nm")
        self.assertEqual(torque.__array_interface__["data"][0],
                         table.values.__array_interface__["data"][0] + 8 * place)

    def test_an_array_keeps_what_it_looks_at(self):
        torque = bentaxis.run(self.case())["Td_z1_Nm"]
        before = torque.copy()
        gc.collect()
        others = [bentaxis.run(self.case(pump__tilt_deg=30)) for _ in range(5)]  # would use memory that was freed
        self.assert_same(torque, before)
        del others
        table = torque.base
        count = sys.getrefcount(table)
        del torque
        self.assertEqual(sys.getrefcount(table), count - 1)

    def test_columns_say_what_they_are(self):
        table = bentaxis.run(self.case())
        self.assertEqual(table.names[0], "theta_deg")
        self.assertEqual(table.names[1:], table.channels)
        self.assertEqual(list(table), table.keys())
        self.assertEqual(table.unit("theta_deg"), "deg")
        self.assertEqual(table.unit("Td_z1_Nm"), "Nm")
        self.assertEqual(table.meaning("Rs_2_x2_N"), "joint force on piston 2 by shaft, at A2, along x2 in S2")
        self.assertEqual(table.meaning("Td_z1_Nm"), "drive torque on shaft by prime mover, about z1, along z1 in S1")
        channel = table.channel("Rs_2_x2_N")
        self.assertEqual((channel.quantity, channel.piston, channel.frame, channel.on_body, channel.by_body, channel.point),
                         ("Rs", 2, "S2", "piston 2", "shaft", "A2"))
        self.assertIsNone(table.channel("theta_deg"))
        for name in table.names:
            self.assertIn(name, table)
            self.assertTrue(table.unit(name), name)
            self.assertTrue(table.meaning(name), name)
        self.assertEqual(len(table), self.case()["operation.samples_per_revolution"])
        for short in ("Td", "Td_Nm", "Td_z1"):
            self.assert_same(table[short], table["Td_z1_Nm"])
        self.assertIn("did you mean", self.refused(KeyError, lambda: table["Td_z1_nm"]))
        self.refused(KeyError, lambda: table["Rb1"])  # of three components

    def test_pickles_are_copies(self):
        turn = bentaxis.run(self.case())
        states = bentaxis.run_states(self.case(), {**motion(), "time_s": numpy.linspace(0, 0.04, 40)}, channels="Rs")
        for table in (turn, states):
            other = pickle.loads(pickle.dumps(table))
            self.assertEqual((other.name, other.names, other.channels), (table.name, table.names, table.channels))
            for name in table.names:
                self.assert_same(other[name], table[name])
                self.assertFalse(numpy.shares_memory(other[name], table[name]))
                self.assertEqual((other.unit(name), other.meaning(name)), (table.unit(name), table.meaning(name)))
            self.assert_same(other.values, table.values)
            self.assertEqual(other.channel(table.channels[3]).on_body, table.channel(table.channels[3]).on_body)
            table.write_csv(self.folder / "first.csv")
            other.write_csv(self.folder / "second.csv")
            self.assertEqual((self.folder / "second.csv").read_text(), (self.folder / "first.csv").read_text())
        sweep = bentaxis.sweep(self.case(), {"pump.tilt_deg": [30, 40]}, "mean:Td")
        self.assert_same(pickle.loads(pickle.dumps(sweep))["mean:Td"], sweep["mean:Td"])

    def test_pandas(self):
        table = bentaxis.run(self.case())
        frame = table.to_pandas()
        self.assertEqual(list(frame.columns), table.channels)
        self.assert_same(frame.index, table["theta_deg"])
        self.assert_same(frame["Td_z1_Nm"], table["Td_z1_Nm"])
        self.assertEqual(frame.attrs["units"]["Td_z1_Nm"], "Nm")


class RunTest(ModuleTest):
    def test_the_analytic_model_gives_the_bytes_of_the_program(self):
        for name in ("bap63_rated", "bap63_rated_hydraulic"):
            self.run_program("run", CASES / f"{name}.toml", "--model", "analytic", "--out", "out")
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                table = bentaxis.run(self.case(name))
            table.write_csv(self.folder / "mine.csv")
            self.assertEqual((self.folder / "mine.csv").read_text(), (self.folder / "out/analytic.csv").read_text())
            for column, values in columns_of(self.folder / "out/analytic.csv").items():
                self.assert_same(table[column], values)

    def test_the_multibody_model_gives_those_of_the_program_to_rounding(self):
        self.run_program("run", CASES / "bap63_rated.toml", "--model", "multibody", "--out", "out")
        table = bentaxis.run(self.case(), model="multibody")
        known = columns_of(self.folder / "out/multibody.csv")
        self.assertEqual(list(known), table.names)
        peaks = {}
        for name in table.channels:
            group = table.channel(name).group
            peaks[group] = max(peaks.get(group, 0), numpy.nanmax(numpy.abs(known[name]), initial=0))
        for name in table.channels:
            if "residual" not in name and "moment" not in name:
                self.assert_close(table[name], known[name], 1e-10, peaks[table.channel(name).group])

    def test_channels(self):
        table = bentaxis.run(self.case(), channels="Rs")
        self.assertEqual({table.channel(name).quantity for name in table.channels}, {"Rs"})
        self.assert_same(table["Rs_1_z2_N"], bentaxis.run(self.case())["Rs_1_z2_N"])
        self.assertEqual(bentaxis.run(self.case(), channels=["Td", "Rcs_z4_N"]).channels, ["Rcs_z4_N", "Td_z1_Nm"])
        words = self.refused(bentaxis.InputError, lambda: bentaxis.run(self.case(), channels="Rx"))
        self.assertTrue(words.startswith("channels: no channel is called Rx"), words)
        self.assertIn("analytic or multibody", self.refused(bentaxis.InputError, lambda: bentaxis.run(self.case(), "adams")))
        self.refused(bentaxis.InputError, lambda: bentaxis.run(self.case(), channels=3))

    def test_doubtful_results_are_warned_of(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            bentaxis.run(self.case(pump__tilt_deg=1e-7), channels="Td")
        program = self.run_program("run", CASES / "bap63_rated.toml", "--model", "analytic", "--set", "pump.tilt_deg=1e-7",
                                   "--channels", "Td").stderr
        self.assertEqual([str(one.message) in program for one in caught], [True] * len(caught))
        self.assertTrue(all(issubclass(one.category, bentaxis.DoubtWarning) for one in caught))

    def test_implausible_cases_are_warned_of(self):
        case = self.case(pump__tilt_deg=1e-7)
        codes = [doubt.code for doubt in case.doubts()]
        self.assertTrue(codes)
        case.update({"drive.kind": "speed", "drive.duration_s": 1e-3, "drive.samples": 4})

        def warned(call):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                result = call()
            implausible = [str(one.message) for one in caught if one.category is bentaxis.PlausibilityWarning]
            self.assertEqual([text.partition(":")[0] for text in implausible], codes)
            self.assertEqual([one.filename for one in caught], [__file__] * len(caught))
            self.assertEqual([str(one.message) for one in caught], result.warnings)
            return result

        table = warned(lambda: bentaxis.run(case, channels="Td"))
        self.assertEqual(pickle.loads(pickle.dumps(table)).warnings, table.warnings)
        warned(lambda: bentaxis.run_states(case, motion()))
        warned(lambda: bentaxis.compare(case, channels="Td"))
        warned(lambda: bentaxis.simulate(case, "analytic"))
        warned(lambda: bentaxis.sweep(case, {"pump.bore_diameter_mm": [22.5]}, "mean:Td"))
        # A case that is as pumps are warns of nothing.
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertEqual(bentaxis.run(self.case(), channels="Td").warnings, [])
            self.assertEqual(bentaxis.compare(self.case(), channels="Td").warnings, [])
        # As errors, they end the call.
        with warnings.catch_warnings():
            warnings.simplefilter("error", bentaxis.PlausibilityWarning)
            for call in (bentaxis.run, bentaxis.compare, bentaxis.simulate):
                self.assertRaises(bentaxis.PlausibilityWarning, call, case)

    def test_names_membership_and_arrays_agree(self):
        tables = [bentaxis.run(self.case()), bentaxis.run_states(self.case(), motion()),
                  bentaxis.sweep(self.case(), {"pump.tilt_deg": [38, 39, 40]}, ["mean:Td", "max:Rb1_z1"])]
        for table in tables:
            array = numpy.asarray(table)
            self.assertEqual(array.shape, (len(table), len(table.names)))
            self.assertEqual(list(table), table.names)
            for i, name in enumerate(table.names):
                self.assertIn(name, table)
                numpy.testing.assert_array_equal(array[:, i], table[name])
            numpy.testing.assert_array_equal(array[:, -len(table.channels):], table.values)
            self.assertEqual(numpy.asarray(table, dtype="float32").dtype, numpy.float32)
            for name in ("Td", "Td_z1", "Rs", "Rs_1", "theta", "nothing", "", 3, None):
                try:
                    table[name]
                    there = True
                except (KeyError, TypeError):
                    there = False
                self.assertEqual(name in table, there, name)
        self.assertIn("Td", tables[0])
        self.assertNotIn("Rs", tables[0])

    def test_states_from_arrays_and_from_a_file_are_the_program_s(self):
        states = motion()
        with open(self.folder / "states.csv", "w", encoding="utf-8") as file:
            file.write(",".join(states) + "\n")
            for row in zip(*states.values()):
                file.write(",".join(repr(float(value)) for value in row) + "\n")
        self.run_program("run", CASES / "bap63_rated.toml", "--model", "analytic", "--states", "states.csv", "--out", "out")
        for given in (states, self.folder / "states.csv", str(self.folder / "states.csv")):
            table = bentaxis.run_states(self.case(), given)
            for column, values in columns_of(self.folder / "out/analytic.csv").items():
                self.assert_same(table[column], values)
        self.assertEqual(table.unit("theta_rad_per_s2"), "rad/s2")
        other = bentaxis.run_states(self.case(), states, model="multibody", channels=["Rb1"])
        for name in other.channels:
            self.assert_close(other[name], table[name], 1e-9, 1e4)

    def test_states_that_are_none(self):
        for change, words in (({"psi_deg": [1, 2]}, "psi_deg has 2 numbers, theta_deg has 40"), ({"psi": 1}, "one dimension"),
                              ({"psi": [0] * 40}, "states: unknown column \"psi\""),
                              ({"psi_deg": motion()["psi_deg"] + 170}, "states:0: psi_deg = 170"),
                              ({"theta_rpm": [numpy.inf] * 40}, "states:0: theta_rpm")):
            with self.subTest(words):
                found = self.refused(bentaxis.InputError,
                                     lambda c=change: bentaxis.run_states(self.case(), {**motion(), **c}))
                self.assertIn(words, found)
        self.refused(bentaxis.InputError, lambda: bentaxis.run_states(self.case(), self.folder / "none.csv"))
        for none in (None, [], ["a.csv", "b.csv"]):
            self.assertEqual(self.refused(bentaxis.InputError, lambda n=none: bentaxis.run_states(self.case(), n)),
                             "states: must be a mapping from columns to arrays, or one path")


class LockTest(ModuleTest):
    LONG = {"operation__samples_per_revolution": 10000}

    def test_other_threads_go_on_during_a_run(self):
        ticks = []
        done = threading.Event()

        def count():
            while not done.is_set():
                ticks.append(time.perf_counter())
                time.sleep(0.001)

        case = self.case(**self.LONG)
        thread = threading.Thread(target=count)
        thread.start()
        start = time.perf_counter()
        bentaxis.run(case, model="multibody")
        end = time.perf_counter()
        done.set()
        thread.join()
        during = [tick for tick in ticks if start < tick < end]
        self.assertGreater(end - start, 0.2)
        # With the lock held there would be none but at its looks at signals.
        self.assertGreater(len(during), 40 * (end - start))

    def test_two_threads_run_at_once(self):
        alone = bentaxis.run(self.case(), model="multibody")["Td_z1_Nm"]
        found = []
        threads = [threading.Thread(target=lambda: found.append(bentaxis.run(self.case(), model="multibody")["Td_z1_Nm"]))
                   for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(found), 4)
        for torque in found:
            self.assert_close(torque, alone, 1e-12)

    def interrupted(self, job):
        """Seconds from Ctrl-C until KeyboardInterrupt."""
        sent = []

        def send():
            time.sleep(0.3)
            sent.append(time.perf_counter())
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=send)
        thread.start()
        with self.assertRaises(KeyboardInterrupt):
            job()
            time.sleep(1)
            self.fail("it ended before it was interrupted")
        thread.join()
        return time.perf_counter() - sent[0]

    def test_ctrl_c_ends_a_computation(self):
        case = self.case(operation__samples_per_revolution=500000)
        self.assertLess(self.interrupted(lambda: bentaxis.run(case, model="multibody")), 5)
        vary = {"pump.tilt_deg": "20:40:#1000", "pressure.delivery_bar": "50:400:#1000"}
        self.assertLess(self.interrupted(lambda: bentaxis.sweep(self.case(), vary, "max:Rb1_z1")), 5)
        self.assertEqual(len(bentaxis.run(self.case())), 720)  # and all is well after it

    def test_what_a_handler_raises_comes_through(self):
        def handler(*_):
            raise TimeoutError("enough")

        before = signal.signal(signal.SIGALRM, handler)
        self.addCleanup(signal.signal, signal.SIGALRM, before)
        case = self.case(operation__samples_per_revolution=500000)
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        with self.assertRaises(TimeoutError):
            bentaxis.run(case, model="multibody")


if __name__ == "__main__":
    main()
