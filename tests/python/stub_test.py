"""The stub says what the module has, and the module what the stub says."""

import ast
import inspect
import subprocess
import sys

import bentaxis
from support import REPO, ModuleTest, main

STUB = REPO / "interfaces/python/bentaxis/__init__.pyi"


def of(cls):
    """Public members of a class, and the special methods that it defines with a text."""
    hidden = ("__init__", "__new__", "__getstate__", "__reduce__", "__setstate__", "__module__", "__doc__", "__hash__", "__weakref__",
              "__qualname__", "__entries")
    return {name: member for name, member in vars(cls).items()
            if name not in hidden and not name.startswith("_pybind11") and not name.startswith("__dict")}


def words(text):
    return " ".join((text or "").split())


class StubTest(ModuleTest):
    def setUp(self):
        super().setUp()
        self.stub = {node.name: node for node in ast.parse(STUB.read_text(encoding="utf-8")).body
                     if isinstance(node, (ast.ClassDef, ast.FunctionDef))}

    def test_names(self):
        self.assertEqual(sorted(self.stub), sorted(bentaxis.__all__))
        for name, node in self.stub.items():
            if isinstance(node, ast.ClassDef):
                there = [one.name for one in node.body if isinstance(one, ast.FunctionDef)]
                self.assertEqual(sorted(there), sorted(of(getattr(bentaxis, name))), name)

    def test_every_name_has_a_text_which_is_that_of_the_stub(self):
        def check(node, member):
            text = words(member.__doc__)
            if not isinstance(member, property) and not inspect.isclass(member):
                text = words((member.__doc__ or "").partition("\n")[2])
            self.assertEqual(words(ast.get_docstring(node)), text, node.name)
            self.assertTrue(text, node.name)
            self.assertTrue(text.endswith("."), f"{node.name}: {text}")

        for name, node in self.stub.items():
            check(node, getattr(bentaxis, name))
            for one in node.body if isinstance(node, ast.ClassDef) else []:
                if isinstance(one, ast.FunctionDef):
                    check(one, vars(getattr(bentaxis, name))[one.name])

    def test_the_stub_is_what_the_script_writes(self):
        subprocess.run([sys.executable, REPO / "scripts/write_python_stub", "--check",
                        str(__import__("pathlib").Path(bentaxis.__file__).parent.parent)], check=True)

    def test_nothing_of_the_build_is_in_it(self):
        text = STUB.read_text(encoding="utf-8")
        for word in ("bentaxis::", "0x", "_bentaxis", "pybind11"):
            self.assertNotIn(word, text)
        self.assertTrue((STUB.parent / "py.typed").exists())


if __name__ == "__main__":
    main()
