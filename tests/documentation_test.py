#!/usr/bin/python3
"""The checks of the documentation can fail: for every rule a text that breaks it, and one that keeps it.

usage: documentation_test.py [options of unittest]
"""
import json
import pathlib
import re
import stat
import sys
import tempfile
import unittest

import yaml

REPO = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPO / "scripts"))
sys.dont_write_bytecode = True
from documentation import blocks, links, notebooks, pages, prose, reference  # noqa: E402

PROGRAM = r"""#!/bin/bash
case "$*" in
  --help) printf 'Subcommands:\n  run      compute\n  reference  curves\n' ;;
  "run --help") printf 'Options:\n  --out DIR  where\n  --model WORD\n' ;;
  "reference --help") printf 'Subcommands:\n  new   make\n' ;;
  "reference new --help") printf 'Options:\n  --from FILE\n' ;;
  "cases --json") echo '[{"name": "bap63_rated", "file": "REPO/cases/bap63_rated.toml"}]' ;;
  *) echo "peak 12.34 N at 90 deg"; exit "${STATUS:-0}" ;;
esac
""".replace("REPO", str(REPO))


class BlocksTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.program = self.folder / "bin/bentaxis"
        self.program.parent.mkdir()
        self.program.write_text(PROGRAM)
        self.program.chmod(self.program.stat().st_mode | stat.S_IXUSR)
        self.commands = blocks.Commands(str(self.program))

    def run_page(self, text, slow=False):
        scratch = self.folder / "scratch"
        scratch.mkdir()
        results = blocks.run_page(REPO, blocks.of_page("page.md", text), scratch, self.program, self.folder, slow)
        return results, [line for result in results for line in result.wrong]

    def assert_run(self, text, *wrong):
        self.assertEqual(len(self.run_page(text)[1]), len(wrong))

    def test_what_is_printed_is_what_the_page_says(self):
        results, wrong = self.run_page("Text\n\n```sh\nbentaxis run x\n```\n\n```text\npeak 12.3 N at 90 deg\n```\n")
        self.assertEqual((len(results), wrong), (1, []))

    def test_another_output_is_found(self):
        _, wrong = self.run_page("```sh\nbentaxis run x\n```\n```text\npeak 12.4 N at 90 deg\n```\n")
        self.assertEqual(len(wrong), 1)
        self.assertTrue(wrong[0].startswith("page.md:4: the page says \"peak 12.4 N at 90 deg\""), wrong)

    def test_a_command_that_fails_is_found(self):
        _, wrong = self.run_page("```sh\nbentaxis run x\nfalse\ntrue\n```\n")
        self.assertEqual(len(wrong), 1)
        self.assertIn("page.md:1: ends with status 1, not 0", wrong[0])

    def test_another_status_is_found(self):
        _, wrong = self.run_page("<!-- status: 1 -->\n```sh\nSTATUS=1 bentaxis run x\n```\n\n<!-- status: 2 -->\n```sh\nSTATUS=1 bentaxis run x\n```\n")
        self.assertEqual(len(wrong), 1)
        self.assertIn("page.md:7: ends with status 1, not 2", wrong[0])

    def test_blocks_of_a_page_share_a_folder_with_the_cases(self):
        _, wrong = self.run_page("```sh\ntest -f my.toml -a -f cases/bap63_rated.toml; echo 1 > made\n```\n\n```sh\ncat made\n```\n```text\n1\n```\n")
        self.assertEqual(wrong, [])

    def test_what_a_block_writes_does_not_reach_the_repository(self):
        self.run_page("```sh\necho x > cases/of_a_test.toml\n```\n")
        self.assertFalse((REPO / "cases/of_a_test.toml").exists())

    def test_python_blocks_run(self):
        _, wrong = self.run_page("```python\nprint(2 / 3)\n```\n```text\n0.67\n```\n\n```python\nraise ValueError\n```\n")
        self.assertEqual(len(wrong), 1)
        self.assertIn("page.md:8", wrong[0])

    def test_blocks_that_do_not_run(self):
        page = "<!-- slow -->\n```sh\nfalse\n```\n\n<!-- not run: needs root -->\n```sh\nfalse\n```\n\n```text\nno output\n```\n"
        self.assertEqual(self.run_page(page), ([], []))
        (self.folder / "scratch").rmdir()
        self.assertEqual(len(self.run_page(page, slow=True)[1]), 1)

    def test_marks_are_written_rightly(self):
        for page in ("<!-- not run -->\n```sh\nx\n```\n", "<!-- status: bad -->\n```sh\nx\n```\n", "<!-- slow -->\nText\n", "```sh\nno end\n",
                     "```sh run\nx\n```\n"):
            with self.subTest(page=page), self.assertRaises(blocks.PageError):
                blocks.of_page("page.md", page)

    def test_text_between_makes_no_output(self):
        found = blocks.of_page("page.md", "```sh\nx\n```\nAnother:\n```text\ny\n```\n")
        self.assertIsNone(found[0].output)

    def wrong_words(self, page):
        return blocks.wrong_words("page.md", page, blocks.of_page("page.md", page), self.commands)

    def test_commands_and_options_that_do_not_exist_are_found(self):
        for call, what in {"bentaxis run x --out d": "", "bentaxis rum x": "page.md:3: there is no command `bentaxis rum`",
                           "bentaxis run x --otu d": "page.md:3: `bentaxis run` has no option --otu",
                           "bentaxis reference new c --from f": "", "build/cli/bentaxis run --model=x": "",
                           "mpirun -n 2 bentaxis run --modell x": "page.md:3: `bentaxis run` has no option --modell",
                           "bentaxis run x \\\n  --otu d": "page.md:3: `bentaxis run` has no option --otu",
                           "bentaxis reference new c --form f": "page.md:3: `bentaxis reference new` has no option --form"}.items():
            with self.subTest(call=call):
                self.assertEqual(self.wrong_words(f"Do `{call}`."), [what.replace(":3:", ":1:")] if what else [])
                self.assertEqual(self.wrong_words(f"\n<!-- not run: a test -->\n```sh\n{call}\n```\n"), [what] if what else [])

    def test_pictures_that_blocks_make(self):
        page = self.folder / "page.md"
        page.write_text("`![no](x.svg) <!-- made by x.svg -->`\n```text\n![no](x.svg) <!-- made by x.svg -->\n```\n![a](pictures/a.svg) <!-- made by figures/b.svg -->\n![c](c.svg)\n")
        self.assertEqual(blocks.pictures(page), [(5, self.folder / "pictures/a.svg", "figures/b.svg")])

    def test_commands_in_other_blocks_are_found(self):
        self.assertEqual(len(self.wrong_words("```text\nbentaxis run x\n```\n")), 1)
        self.assertEqual(len(self.wrong_words("```\nbentaxis run x\n```\n")), 1)
        self.assertEqual(self.wrong_words("```\na = b\n```\n"), [])
        self.assertEqual(self.wrong_words("```toml\n[pump]\n```\n"), [])


class NotebooksTest(unittest.TestCase):
    PAGE = pathlib.PurePosixPath("docs/tutorials/9_a_test.md")

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.program = self.folder / "bin/bentaxis"
        self.program.parent.mkdir()
        self.program.write_text(PROGRAM)
        self.program.chmod(self.program.stat().st_mode | stat.S_IXUSR)

    def wrong(self, text):
        results = notebooks.run(self.PAGE, text, self.folder, blocks.environment(self.folder, self.program, self.folder))
        return [line for result in results for line in result.wrong]

    def test_cells_share_a_folder_with_the_cases_and_print_what_the_page_says(self):
        self.assertEqual(self.wrong("# Title\n\n```sh\nbentaxis run x > made; test -f my.toml -a -f cases/bap63_teeth.toml\n```\n\n```sh\ncat made\n```\n\n"
                                    "```text\npeak 12.3 N at 90 deg\n```\n\n<!-- status: 1 -->\n```sh\nSTATUS=1 bentaxis run x\n```\n\n"
                                    "```text\npeak 12.3 N at ...\n```\n\n```python\nprint(2 / 3)\n```\n\n```text\n0.667\n```\n"), [])

    def test_what_differs_from_the_page_is_found(self):
        for text, line in (("```sh\nbentaxis run x\n```\n```text\npeak 12.4 N at 90 deg\n```\n", "9_a_test.md:4: the page says \"peak 12.4"),
                           ("```sh\nbentaxis run x\nfalse\ntrue\n```\n", "9_a_test.md:1: CalledProcessError"),
                           ("<!-- status: 1 -->\n```sh\nSTATUS=2 bentaxis run x\n```\n", "the page says \"exit status 1\""),
                           ("<!-- status: 1 -->\n```sh\nbentaxis run x\n```\n", "the page says \"exit status 1\""),
                           ("```python\nraise ValueError('no')\n```\n", "9_a_test.md:1: ValueError: no")):
            with self.subTest(text=text):
                wrong = self.wrong(text)
                self.assertEqual(len(wrong), 1, wrong)
                self.assertIn(line, wrong[0])

    def test_text_and_links(self):
        notebook, block_of = notebooks.of_page(self.PAGE, "# Title\n\nSee [keys](../case_file.md#pump), ![a](../pictures/a.svg), [here](#x), <https://a.b>.\n\n"
                                               "```sh\nls\n```\n\n```text\nnone\n```\n\n<!-- not run: a reason -->\n```sh\nmake\n```\n\nEnd\n")
        cells = ["".join(cell["source"]) for cell in notebook["cells"]]
        self.assertEqual([cell["cell_type"] for cell in notebook["cells"]], ["markdown", "code", "markdown", "code", "markdown"])
        self.assertEqual(cells[2], "# Title\n\nSee [keys](../docs/case_file.html#pump), ![a](../docs/pictures/a.svg), [here](#x), <https://a.b>.")
        self.assertEqual(cells[3], "%%bash -euo pipefail\nls")
        self.assertEqual(cells[4], "```sh\nmake\n```\n\nEnd")
        self.assertEqual({index: block.line for index, block in block_of.items()}, {3: 5})

    def test_links_of_the_tutorials_lead_to_files(self):
        count = 0
        for page in notebooks.of_tutorials(REPO):
            for cell in notebooks.of_page(page, (REPO / page).read_text(encoding="utf-8"))[0]["cells"]:
                for _, target in links.of_markdown("".join(cell["source"])) if cell["cell_type"] == "markdown" else []:
                    path = links.local_path(notebooks.FOLDER / "x", target)
                    if path is not None:
                        count += 1
                        there = REPO / path.with_suffix(".md" if path.suffix == ".html" else path.suffix)
                        self.assertTrue(there.is_file() or "reference" in path.parts, target)
        self.assertGreater(count, 10)


class OutputTest(unittest.TestCase):
    def same(self, expected, printed):
        self.assertEqual(blocks.first_difference(expected, printed), "", (expected, printed))

    def differ(self, expected, printed):
        self.assertNotEqual(blocks.first_difference(expected, printed), "", (expected, printed))

    def test_numbers(self):
        self.same("a 1.25", "a 1.25")
        self.same("a 1.25", "a 1.2512")
        self.same("a 1.3e4", "a 12951")
        self.same("a -0.5", "a -0.46")
        self.same("difference 7.1e-14 of", "difference 3e-13 of")
        self.differ("a 1.25", "a 1.26")
        self.differ("a 1.25", "a 1.2551")
        self.differ("a 72", "a 73")
        self.differ("a 1.25", "a -1.25")
        self.differ("a 1.25", "a x")
        self.differ("difference 7.1e-14 of", "difference 3e-5 of")
        self.differ("Rs_1 is 5", "Rs_2 is 5")
        self.differ("version 1.0.1", "version 1.0.2")

    def test_left_out_text(self):
        self.same("a ... z", "a b c z")
        self.same("a\n...\nz", "a\nb\nc\nz")
        self.same("a\n...\n", "a\nb")
        self.same("...\nb\n...", "a\nb\nc")
        self.same("a\n...\nz", "a\nz")
        self.differ("a ... z", "a b c")
        self.differ("a\n...\nz", "a\nb")
        self.differ("a\n...\nm\n...\nz", "a\nz")
        self.differ("a\nb", "a")
        self.differ("a", "a\nb")
        self.differ("...\nb", "b\na")

    def test_spaces_do_not_count_and_words_do(self):
        self.same("a   b", "a b")
        self.differ("ab", "a b")
        self.differ("a.b", "axb")


class LinksTest(unittest.TestCase):
    def test_links_of_markdown(self):
        text = ('[a](x.md) ![p](p.png "title") [![i](i.svg)](j.md#k)\n`[no](code.md)`\n```sh\n[no](fence.md)\n```\n<!-- [no](comment.md) -->\n'
                '[r]: def.md\n<img src="q.png">\n[k [l]](m_(n).md)')
        self.assertEqual([target for _, target in links.of_markdown(text)],
                         sorted(["x.md", "p.png", "i.svg", "j.md#k"]) and [t for _, t in sorted(
                             [(1, "i.svg"), (1, "j.md#k"), (1, "p.png"), (1, "x.md"), (7, "def.md"), (8, "q.png"), (9, "m_(n).md")])])

    def test_dead_links_of_a_folder(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "docs").mkdir()
            (folder / "README.md").write_text("[a](docs/a.md#x) [b](docs/b.md) [c](https://example.org) [d](#d)")
            (folder / "docs/a.md").write_text("[up](../README.md)\n[gone](../cases/x.toml)")
            self.assertEqual(links.wrong_in_markdown(folder), ["README.md:1: link to docs/b.md: no such file",
                                                               "docs/a.md:2: link to ../cases/x.toml: no such file"])

    def test_dead_links_and_anchors_of_a_site(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "a.html").write_text('<h1 id="t">A</h1><a href="b.html#u">ok</a><a href="#t">ok</a><a href="https://example.org">ok</a>'
                                           '<a href="c.html">no file</a><a href="b.html#v">no anchor</a><a href="#w">no anchor</a>'
                                           '<script src="https://example.org/x.js"></script><img src="p.png">')
            (folder / "b.html").write_text('<h2 id="u">B</h2>')
            followed, wrong = links.wrong_in_site(folder)
            self.assertEqual(followed, 6)
            self.assertEqual(wrong, ["a.html: link to c.html: no such file", "a.html: link to b.html#v: no such anchor",
                                     "a.html: link to #w: no such anchor", "a.html: <script> loads https://example.org/x.js",
                                     "a.html: link to p.png: no such file"])

    def repository(self, files):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        root = pathlib.Path(folder.name)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        return pages.sources(root)

    def test_pages_of_the_site(self):
        files, wrong = self.repository({"mkdocs.yml": "docs_dir: !ENV [X, docs]\nnav:\n  - A: README.md\n  - B:\n      - C: docs/a.md\n      - R: docs/reference/r.md\n",
                                        "README.md": "[a](docs/a.md)", "docs/a.md": "[t](../cases/c.toml)", "cases/c.toml": ""})
        self.assertEqual((sorted(map(str, files)), wrong), (["README.md", "cases/c.toml", "docs/a.md"], []))

    def test_pages_that_are_wrong(self):
        _, wrong = self.repository({"mkdocs.yml": "nav:\n  - A: README.md\n  - B: docs/gone.md\n",
                                    "README.md": "[a](docs/reference/x.md) [b](docs/none.md) [c](docs)", "docs/lost.md": ""})
        self.assertEqual([line.split(": ")[0] for line in wrong], ["README.md:1", "README.md:1", "README.md:1", "mkdocs.yml", "docs/lost.md"])


class ProseTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.rules = prose.Rules(REPO / "scripts/prose_rules.toml")

    def wrong(self, text):
        paragraphs = prose.of_markdown(text)
        return prose.wrong_words("p", paragraphs, self.rules) + prose.long_sentences("p", paragraphs, self.rules)

    def test_every_word_of_the_table_is_found(self):
        """What the table says not to write is what the rules find, and what it says to write passes."""
        for word in self.rules.words:
            with self.subTest(word=word.instead_of):
                self.assertTrue(word.write and word.instead_of)
                self.assertNotEqual(prose.wrong_words("p", [(1, word.instead_of)], self.rules), [])
                self.assertEqual(prose.wrong_words("p", [(1, word.write)], self.rules), [])

    def test_words(self):
        self.assertEqual(self.wrong("A plausible pump, as at least one test says. Of course."), [])
        self.assertEqual(self.wrong("One\n\nThe least\nwear"), ['p:3: "least": write "minimum, maximum"'])
        self.assertEqual(len(self.wrong("This changes\nnothing.")), 1)
        self.assertEqual(len(self.wrong("| a | hardly |\n|---|---|\n")), 1)
        self.assertEqual(len(self.wrong("* [is beyond](x.md)")), 1)

    def test_code_is_no_prose(self):
        self.assertEqual(self.wrong("`beyond` and $knots$\n```sh\nbeyond\n```\n<!-- beyond -->\n[a](beyond.md)\n\n$$\nbeyond\n$$\n"), [])

    def test_exceptions_are_of_their_page(self):
        paragraphs = [(1, 'Write "of the tolerance", not "of what is allowed".')]
        self.assertEqual(prose.wrong_words("docs/style.md", paragraphs, self.rules), [])
        self.assertEqual(len(prose.wrong_words("docs/other.md", paragraphs, self.rules)), 1)

    def test_long_sentences(self):
        limit = self.rules.sentence_words
        self.assertEqual(self.wrong("word " * (limit - 1) + "end. " + "Word " * (limit - 1) + "end."), [])
        self.assertEqual(len(self.wrong("word " * limit + "end.")), 1)
        self.assertEqual(len(self.wrong("word " * (limit - 4) + "see e.g. Fig. 3 in `code`, and so on.")), 1)
        self.assertEqual(self.wrong("* " + "word " * 20 + "\n* " + "word " * 20), [])

    def test_the_glossary_decides_on_spelling(self):
        terms = prose.glossary_terms("| term | x |\n|---|---|\n| co-simulation | |\n| port plate, plate | |\n", self.rules)
        self.assertEqual([term for term, _ in terms], ["co-simulation", "port plate"])

        def wrong(text):
            return prose.other_spellings("p", [(1, text)], terms)

        self.assertEqual(wrong("Co-simulation of port plates; the port-plate timing"), [])
        self.assertEqual(wrong("a cosimulation"), ['p:1: "cosimulation": the glossary has "co-simulation"'])
        self.assertEqual(len(wrong("a co simulation and a portplate")), 2)

    def test_help_texts_are_parted(self):
        text = "Usage: x\n\nOptions:\n  --out DIR   where results go\n  --model M   which model,\n              in words\n"
        self.assertIn((5, "which model, in words"), prose.of_plain_text(text))

    def test_an_option_on_a_line_of_its_own_parts(self):
        text = "  --out DIR   where results go\n  --way driven|integrated [driven]\n              how it runs"
        self.assertEqual(prose.of_plain_text(text), [(1, "where results go"), (3, "how it runs")])

    def test_code_ends_no_sentence(self):
        self.assertEqual([list(prose.sentences(t)) for _, t in prose.of_plain_text("Runs it. `error`: wanted error.")], [["Runs it.", "CODE: wanted error."]])

    def test_lines_of_a_cell_are_paragraphs(self):
        self.assertEqual([t for _, t in prose.of_markdown("| a<br>b | c |")], ["a", "b", "c"])

    def test_entries_of_printed_lists_are_counted_one_by_one(self):
        answer = [(1, "Largest forces: " + "; ".join(["word " * 20] * 3))]
        self.assertEqual(prose.long_sentences(self.rules.texts["answers"][0], answer, self.rules), [])
        self.assertEqual(len(prose.long_sentences("docs/other.md", answer, self.rules)), 1)
        self.assertEqual(len(prose.long_sentences(self.rules.texts["answers"][0], [(1, "word " * 40)], self.rules)), 1)

    def test_exceptions_need_a_reason(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "rules.toml"
            file.write_text((REPO / "scripts/prose_rules.toml").read_text() + '\n[[exception]]\npage = "x"\npattern = "y"\nreason = ""\n')
            with self.assertRaises(ValueError):
                prose.Rules(file)


def menu_paths():
    """{page: the entries of the menu that lead to it}"""
    def paths(node, above):
        if isinstance(node, str):
            yield node, above
        for name, below in node.items() if isinstance(node, dict) else ():
            yield from paths(below, [*above, name])
        for below in node if isinstance(node, list) else ():
            yield from paths(below, above)

    nav = yaml.load((REPO / "mkdocs.yml").read_text(encoding="utf-8"), pages._Loader)["nav"]
    return dict(paths(nav, []))


class FindingAnswersTest(unittest.TestCase):
    def test_click_paths(self):
        """A path is that of the menu, and then the heading that its link leads to."""
        menu = menu_paths()
        rows = re.findall(r"^\| (\d+) \|[^|]*\|([^|]*)\|", (REPO / "docs/finding_answers.md").read_text(encoding="utf-8"), re.MULTILINE)
        self.assertEqual([int(number) for number, _ in rows], list(range(1, 26)))
        for number, cell in rows:
            found = re.findall(r"\[((?:`[^`]*`|[^\]`])+)\]\(([^)#]*)(?:#([^)]*))?\)", cell)
            self.assertTrue(found, number)
            for words, page, anchor in found:
                with self.subTest(question=number, path=words):
                    path = words.split(" › ")
                    above = menu[f"docs/{page}"]
                    self.assertEqual(path[:len(above)], above)
                    self.assertLessEqual(len(path), len(above) + 1)
                    if len(path) > len(above):
                        self.assertTrue(anchor)
                    if anchor:
                        headings = re.findall(r"^#+ (.*)$", (REPO / "docs" / page).read_text(encoding="utf-8"), re.MULTILINE)
                        of_anchor = [head for head in headings if re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") == anchor]
                        self.assertEqual(len(of_anchor), 1, headings)
                        if len(path) > len(above):
                            self.assertIn(path[-1], of_anchor[0])


class ReferenceTest(unittest.TestCase):
    def test_every_json_key_is_explained(self):
        """A key with a value has a meaning; a list of objects, an object and a fixed word are explained by their keys."""
        schema = json.loads((REPO / "docs/report.schema.json").read_text())
        page = reference.json_keys_page(REPO)
        for heading, rows in reference.json_tables(schema).items():
            for key, kind, _, meaning in rows:
                with self.subTest(part=heading, key=key):
                    self.assertTrue(meaning or kind == "object" or "list of" in kind or "each value" in kind or re.fullmatch('`"\\w+"`', kind))
                    self.assertIn(f"| {key} | {kind} |", page)

    def test_keys_of_a_schema(self):
        """Every place where a schema can name a key is looked into."""
        schema = {"$defs": {"part": {"description": "of the part"}}, "required": ["a"], "properties": {
            "a": {"type": "array", "items": {"properties": {"b": {"type": "number"}}, "required": ["b"]}},
            "c": {"type": "object", "additionalProperties": {"properties": {"d": {"enum": ["x", "y"]}}}},
            "e": {"oneOf": [{"properties": {"f": {"$ref": "#/$defs/part"}}}, {"type": "null"}]}, "g": {"type": ["number", "null"], "description": "1|2"}}}
        self.assertEqual(reference.json_tables(schema), {"The report": [
            ("`a`", "list of any", "always", ""), ("`a[].b`", "number", "always", ""), ("`c`", "object; each value: any", "", ""),
            ("`c.*.d`", '`"x"`, `"y"`', "", ""), ("`e`", "any or null", "", ""), ("`e.f`", "[part](#part)", "", "of the part"),
            ("`g`", "number or null", "", "1\\|2")], "part": []})

    def test_every_python_name_has_its_place(self):
        page = reference.python_page(REPO)
        for anchor in ("{#compare}", "{#Case}", "{#Case.update}"):
            self.assertIn(anchor, page)

    def test_every_public_header_is_listed(self):
        listed = sum(map(len, reference.public_headers(REPO).values()))
        there = [file for file in REPO.glob("**/include/bentaxis/**/*.h") if not file.relative_to(REPO).parts[0].startswith("build")]
        self.assertEqual(listed, len(there))


if __name__ == "__main__":
    unittest.main()
