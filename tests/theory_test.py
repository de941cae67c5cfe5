#!/usr/bin/env python3
"""Tests of the equations in docs/: numbers, references, checks of corrections, and the nomenclature.

usage: theory_test.py REPO_ROOT [BENTAXIS] [options of unittest]
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PAGES = ("theory", "motion", "teeth")
NUMBER = r"(?:\d+|M|B)\.\d+"


def display(text):
    return re.findall(r"^ *\$\$\n(.*?)\n *\$\$$", text, re.MULTILINE | re.DOTALL)


class TheoryTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.text = {page: (REPO / "docs" / f"{page}.md").read_text() for page in PAGES}
        cls.tags = {}
        for page, text in cls.text.items():
            for equation in display(text):
                for tag in re.findall(r"\\tag\{([^}]*)\}", equation):
                    number, _, paper = tag.partition("; paper ")
                    assert number not in cls.tags, number
                    cls.tags[number] = (page, paper)

    def test_every_equation_has_one_number_and_numbers_are_consecutive(self):
        for page, text in self.text.items():
            for equation in display(text):
                self.assertEqual(len(re.findall(r"\\tag\{", equation)), 1, f"{page}: {equation}")
            self.assertEqual(text.count("$$") % 2, 0, page)
        by_section = {}
        for number in self.tags:
            self.assertRegex(number, rf"^{NUMBER}$")
            section, place = number.split(".")
            by_section.setdefault(section, []).append(int(place))
        for section, places in by_section.items():
            self.assertEqual(places, list(range(1, len(places) + 1)), section)
        self.assertGreater(len(self.tags), 70)

    def test_numbers_stand_in_their_sections(self):
        for part in re.split(r"^## ", self.text["theory"], flags=re.MULTILINE)[1:]:
            section = part.split(".")[0]
            for number in re.findall(r"\\tag\{([\d.]+)", part):
                self.assertEqual(number.split(".")[0], section, number)

    def test_references_lead_to_equations(self):
        pages = [*PAGES, "notation"]
        found = 0
        for page in pages:
            text = (REPO / "docs" / f"{page}.md").read_text()
            for number in re.findall(rf"\(({NUMBER})\)(?!\s*mm)", re.sub(r"\\tag\{.*?\}", "", text)):
                self.assertIn(number, self.tags, page)
                found += 1
        self.assertGreater(found, 60)

    def test_every_equation_of_the_paper_is_dealt_with(self):
        """1 to 57: in a number, beside a load, in the table of corrections or among those found right."""
        text = self.text["theory"]
        named = set()
        for _, paper in self.tags.values():
            named |= self.numbers(paper)
        section = text[text.index("## 14."):text.index("## 15.")]
        for cell in re.findall(r"\(([\d)(, -]+)\)", section):
            named |= self.numbers(cell.replace("(", "").replace(")", ""))
        for cell in re.findall(r"\| \((\d[^|]*)\) \|$", text, re.MULTILINE):
            named |= self.numbers(cell.replace("(", "").replace(")", ""))
        self.assertEqual(sorted(set(range(1, 58)) - named), [])

    @staticmethod
    def numbers(text):
        found = set()
        for low, high in re.findall(r"(\d+)(?:-(\d+))?", text):
            found |= set(range(int(low), int(high or low) + 1))
        return found

    def test_checks_that_the_page_names_are_those_of_the_script(self):
        script = (REPO / "docs" / "check_corrections.py").read_text()
        there = re.findall(r'^@check\("([CI]\d\d)"', script, re.MULTILINE)
        self.assertEqual(len(there), len(set(there)))
        text = "".join(self.text.values())
        named = set(re.findall(r"\b([CI]\d\d)\b", text))
        self.assertEqual(named - set(there), set())
        # C24 is of friction as printed, which nothing corrects; (C16), (C17) and so on stand in the table.
        self.assertEqual(set(there) - named - {"C24"}, set())
        first, last = re.search(r"C01\.\.(C\d\d) and I01\.\.(I\d\d)", text).groups()
        self.assertEqual((first, last), (max(t for t in there if t[0] == "C"), max(t for t in there if t[0] == "I")))
        table = self.text["theory"][self.text["theory"].index("| equation | printed"):]
        corrected = re.findall(r"C\d\d", table)
        self.assertGreater(len(set(corrected)), 24)

    def test_every_correction_names_its_check(self):
        table = self.text["theory"][self.text["theory"].index("| equation | printed"):].split("\n\n")[0]
        rows = [row for row in table.splitlines()[2:]]
        self.assertGreater(len(rows), 30)
        without = [row.split("|")[1].strip() for row in rows if not re.search(r"C\d\d \|$|C\d\d, C\d\d \|$", row)]
        # Said to be missing, or named wrongly, in the paper: nothing to evaluate.
        self.assertEqual(without, ["section 3.1.1", "nomenclature"])

    def test_dois_are_complete(self):
        dois = re.findall(r"\[doi:(\S+)\]\(https://doi\.org/(\S+)\)", self.text["theory"])
        self.assertGreater(len(dois), 3)
        for shown, linked in dois:
            self.assertEqual(shown, linked)
            self.assertRegex(shown, r"^10\.\d{4,}/\S+$")

    def test_pdf_has_every_equation_number_and_figure(self):
        with tempfile.TemporaryDirectory(prefix="bentaxis_theory_") as folder:
            pdf = pathlib.Path(folder) / "theory.pdf"
            done = subprocess.run([str(REPO / "scripts" / "build_theory_pdf"), str(pdf)], capture_output=True, text=True)
            if "ModuleNotFoundError" in done.stderr or "chromium" in done.stderr:
                self.skipTest("needs the packages of scripts/setup docs, and Chromium")
            self.assertEqual(done.returncode, 0, done.stderr)
            text = subprocess.run(["pdftotext", "-layout", str(pdf), "-"], capture_output=True, text=True, check=True).stdout
            info = subprocess.run(["pdfinfo", str(pdf)], capture_output=True, text=True, check=True).stdout
        version = re.search(r"project\(bentaxis VERSION ([\d.]+)", (REPO / "CMakeLists.txt").read_text())[1]
        self.assertIn(f"bentaxis {version}: theory", info)
        self.assertIn(f"Version {version}", text)
        missing = [number for number in self.tags if not re.search(rf"\({re.escape(number)}[;)]", text)]
        self.assertEqual(missing, [])
        self.assertGreater(int(re.search(r"Pages: +(\d+)", info)[1]), 15)
        # Text of figures is text: a label of each.
        for label in ("z3 of piston 1", "delivery_start_deg", "pitch cone", "leading edge", "motor rotor"):
            self.assertIn(label, text)

    def test_one_symbol_one_meaning_and_tables_are_fresh(self):
        if not PROGRAM:
            self.skipTest("needs the program")
        done = subprocess.run([sys.executable, str(REPO / "scripts" / "write_notation"), "--check", PROGRAM], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_two_meanings_of_a_symbol_are_found(self):
        import importlib.machinery
        import importlib.util
        loader = importlib.machinery.SourceFileLoader("write_notation", str(REPO / "scripts" / "write_notation"))
        module = importlib.util.module_from_spec(importlib.util.spec_from_loader("write_notation", loader))
        sys.dont_write_bytecode = True
        loader.exec_module(module)
        page = (REPO / "docs" / "notation.md").read_text()
        self.assertEqual(module.collisions(page), {})
        twice = page.replace("| $\\kappa$ |", "| $\\lambda$ |")
        self.assertNotEqual(twice, page)
        self.assertEqual(list(module.collisions(twice)), ["\\lambda"])
        self.assertEqual(list(module.collisions(page.replace("| $\\kappa$ |", "| $R_\\mathrm{a}$ |"))), ["R_a"])

    def test_inputs_of_the_mechanical_model_stand_in_the_equations(self):
        """Every symbol of these tables is in an equation or a sentence of the theory, motion or teeth."""
        text = re.sub(r"[{}\s]|\\mathrm|\\,", "", "".join(self.text.values()))
        page = (REPO / "docs" / "notation.md").read_text()
        rows = re.findall(r"^\| \$(.*?)\$ \| `(pump|gear|piston|shaft|block|friction|drive|pressure|port_plate)\.(\w+)`", page, re.MULTILINE)
        self.assertGreater(len(rows), 50)
        missing = [f"{table}.{key}" for symbol, table, key in rows
                   if re.sub(r"[{}\s]|\\mathrm|\\,", "", symbol) not in text]
        self.assertEqual(missing, [])


if __name__ == "__main__":
    places = [a for a in sys.argv[1:3] if not a.startswith("-")]
    REPO = pathlib.Path(places[0]).resolve()
    PROGRAM = places[1] if len(places) > 1 else None
    unittest.main(argv=[sys.argv[0], *sys.argv[1 + len(places):]])
