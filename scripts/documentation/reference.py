"""The generated pages of the site's reference: commands, case keys, plausibility codes, JSON, Python, C++."""
import ast
import json
import pathlib
import re
import subprocess

NOTE = "<!-- made by scripts/build_site -->\n"


def output(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True, **options).stdout


def cell(text):
    """Text within a table."""
    return re.sub(r"([|<>*_`])", r"\\\1", text)


# ---------------------------------------------------------------- commands

def command_groups(help_text):
    """[(heading, [(name, line)])] of the commands that a help text lists, in one group or several."""
    groups, heading = [], None
    for line in re.sub(r"\n {10,}", " ", help_text).split("\n"):
        head = re.fullmatch(r"([A-Z]\S.*):", line)
        row = re.match(r"  ([a-z][a-z0-9]*)\s{2,}(\S.*)$", line)
        if head:
            heading = head[1]
        elif row and heading not in (None, "Options", "Positionals"):
            if not groups or groups[-1][0] != heading:
                groups.append((heading, []))
            groups[-1][1].append((row[1], row[2]))
        elif line and not line.startswith(" "):
            heading = None
    return groups


def subcommands(help_text):
    """(name, line) of all of them."""
    return [row for _, rows in command_groups(help_text) for row in rows]


def command_pages(program):
    """{path below docs/reference: text}: a page per command and the index."""
    top = output(program, "--help")
    pages, index = {}, f"{NOTE}# Commands\n"
    for heading, commands in command_groups(top):
        index += f"\n## {heading}\n\n| command | what it does |\n|---|---|\n"
        for name, what in commands:
            help_text = output(program, name, "--help")
            text = f"{NOTE}# bentaxis {name}\n\n```text\n{help_text.rstrip()}\n```\n"
            for below, _ in subcommands(help_text):
                text += f"\n## bentaxis {name} {below}\n\n```text\n{output(program, name, below, '--help').rstrip()}\n```\n"
            pages[f"commands/{name}.md"] = text
            index += f"| [`bentaxis {name}`](commands/{name}.md) | {cell(what)} |\n"
    if not pages:
        raise RuntimeError("`bentaxis --help` lists no commands: the form of the help has changed")
    pages["commands.md"] = index + f"\n## bentaxis --help\n\n```text\n{top.rstrip()}\n```\n"
    return pages


# ---------------------------------------------------------------- case keys

def case_keys_page(program):
    """Every key of a case file, each with an anchor: #pump.tilt_deg."""
    schema = json.loads(output(program, "schema"))["properties"]
    tables = ["top"] + [name for name, value in schema.items() if "properties" in value]
    text = (f"{NOTE}# Case keys\n\nEvery key of a [case file](../case_file.md), by table. The same from the program: `bentaxis schema --markdown TABLE`, "
            "and `bentaxis schema` as a JSON Schema for editors.\n")
    count = 0
    for table in tables:
        below = [f"{table}.{name}" for name, value in schema.get(table, {}).get("properties", {}).items() if "properties" in value]
        children = schema.get(table, {}).get("properties", {})
        own = [table] if table == "top" or len(below) < len(children) else []
        for name in own + below:
            done = subprocess.run([program, "schema", "--markdown", name], capture_output=True, text=True)
            if done.returncode != 0:  # a table whose keys are not listed, as [uncertainty], whose keys are those of others
                continue
            printed = done.stdout
            prefix = "" if name == "top" else name + "."
            rows, found = re.subn(r"^\| (`(\w+)`)", lambda match: f'| <a id="{prefix}{match[2]}"></a>{match[1]}', printed, flags=re.MULTILINE)
            count += found
            text += f"\n## {'Above all tables' if name == 'top' else f'[{name}]'}\n\n{rows}"
    if count < 100:
        raise RuntimeError(f"only {count} keys of case files were found: the form of `bentaxis schema` has changed")
    return text


# ---------------------------------------------------------------- plausibility codes

def plausibility_page(program):
    return (f"{NOTE}# Plausibility codes\n\nEvery command that reads a case warns of implausible input. Each warning starts with one of these names; "
            "the names are stable.\nSee [plausibility](../plausibility.md) for `--strict` and for giving a reason.\n\n"
            + output(program, "schema", "--markdown", "checks"))


# ---------------------------------------------------------------- JSON of a report

def described(part, schema):
    """What the schema says of a key, with the description of the part that it names."""
    while "description" not in part and "$ref" in part:
        part = schema["$defs"][part["$ref"].rsplit("/", 1)[-1]]
    return part.get("description", "")


def type_in_words(part):
    """(type, name of the part it consists of or "")."""
    if "$ref" in part:
        name = part["$ref"].rsplit("/", 1)[-1]
        return f"[{name}](#{name})", name
    if "const" in part:
        return f"`{json.dumps(part['const'])}`", ""
    if "enum" in part:
        return ", ".join(f"`{json.dumps(word)}`" for word in part["enum"]), ""
    for kinds in ("oneOf", "anyOf"):
        if kinds in part:
            return " or ".join(type_in_words(one)[0] for one in part[kinds]), ""
    kind = part.get("type", "any")
    if kind == "array" and isinstance(part.get("items"), dict):
        return "list of " + type_in_words(part["items"])[0], ""
    if kind == "object" and isinstance(part.get("additionalProperties"), dict):
        return "object; each value: " + type_in_words(part["additionalProperties"])[0], ""
    return " or ".join([kind] if isinstance(kind, str) else kind), ""


def keys_of(part, path=""):
    """(path, part, whether it is always there) of every key below a part of the schema. `[]` stands for the entries of a list, `.*` for any key."""
    for name, below in part.get("properties", {}).items():
        yield path + name, below, name in part.get("required", [])
        yield from keys_of(below, f"{path}{name}.")
    if isinstance(part.get("items"), dict):
        yield from keys_of(part["items"], path.removesuffix(".") + "[].")
    if isinstance(part.get("additionalProperties"), dict):
        yield from keys_of(part["additionalProperties"], path + "*.")
    for kinds in ("oneOf", "anyOf", "allOf"):
        for one in part.get(kinds, []):
            yield from keys_of(one, path)


def json_tables(schema):
    """{heading: rows (key, type, present, meaning)} of the report and of each part that keys name."""
    def rows(part):
        return [(f"`{path}`", type_in_words(below)[0], "always" if always else "", cell(described(below, schema)))
                for path, below, always in keys_of(part)]

    return {"The report": rows(schema), **{name: rows(part) for name, part in schema["$defs"].items()}}


def json_keys_page(root):
    schema = json.loads((root / "docs/report.schema.json").read_text(encoding="utf-8"))
    text = (f"{NOTE}# JSON keys\n\nEvery key of a report's JSON, made from [report.schema.json](../report.schema.json). "
            "Which report has which part: [JSON of a report](../report_json.md).\n\n"
            "`[]` stands for the entries of a list, `*` for any key. *Present*: always, where the object above it is there; otherwise where it applies. "
            "A type that is a link has a table below.\n")
    for heading, rows in json_tables(schema).items():
        text += f"\n## {heading}\n\n"
        part = schema["$defs"].get(heading, {})
        if part.get("description"):
            text += f"{cell(part['description'])[:1].upper()}{cell(part['description'])[1:].rstrip('.')}.\n\n"
        if rows:
            text += "| key | type | present | meaning |\n|---|---|---|---|\n" + "".join("| " + " | ".join(row) + " |\n" for row in rows)
        else:
            text += f"{type_in_words(part)[0][:1].upper()}{type_in_words(part)[0][1:]}.\n"
    return text


# ---------------------------------------------------------------- Python

def documented(node):
    return ast.get_docstring(node) or ""


def signature(node, source):
    text = ast.get_source_segment(source, node)
    head = re.sub(r"\s+", " ", text[:text.index(":\n")] if ":\n" in text else text.split("\n")[0].rstrip(":"))
    if len(head) <= 80:
        return head
    # An argument per line.
    arguments = ",\n    ".join(ast.unparse(argument) for argument in _arguments(node.args))
    result = f" -> {ast.unparse(node.returns)}" if node.returns else ""
    return f"def {node.name}(\n    {arguments},\n){result}"


def _arguments(arguments):
    """Each argument as a list of its own, defaults with it, as ast.unparse writes it."""
    def one(argument, default):
        return ast.arguments(posonlyargs=[], args=[argument], kwonlyargs=[], kw_defaults=[], defaults=[default] if default else [], vararg=None, kwarg=None)

    defaults = [None] * (len(arguments.args) - len(arguments.defaults)) + list(arguments.defaults)
    yield from (one(argument, default) for argument, default in zip(arguments.args, defaults))
    if arguments.kwonlyargs:
        yield ast.Name("*")
    yield from (one(argument, default) for argument, default in zip(arguments.kwonlyargs, arguments.kw_defaults))


def python_page(root):
    source = (root / "interfaces/python/bentaxis/__init__.pyi").read_text(encoding="utf-8")
    tree = ast.parse(source)
    text = f"{NOTE}# Python reference\n\nSignatures and docstrings of the module `bentaxis`. [From Python](../python.md) shows it at work.\n"
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    classes = [node for node in tree.body if isinstance(node, ast.ClassDef)]
    text += "\n## Functions\n"
    for node in functions:
        text += f"\n### `{node.name}` {{#{node.name}}}\n\n```python\n{signature(node, source)}\n```\n\n{documented(node)}\n"
    text += "\n## Classes\n"
    for node in classes:
        text += f"\n### `{node.name}` {{#{node.name}}}\n\n{documented(node)}\n"
        for member in node.body:
            if isinstance(member, ast.FunctionDef):
                kind = " (property)" if any(isinstance(d, ast.Name) and d.id == "property" for d in member.decorator_list) else ""
                text += (f"\n#### `{node.name}.{member.name}`{kind} {{#{node.name}.{member.name.strip('_')}}}\n\n"
                         f"```python\n{signature(member, source)}\n```\n\n{documented(member)}\n")
    if not functions or not classes:
        raise RuntimeError("the Python stub holds no functions or no classes")
    return text


# ---------------------------------------------------------------- C++

def cpp_page(headers):
    text = (f"{NOTE}# C++ reference\n\n[Classes, functions and files of the public headers](../../cpp/index.html), by Doxygen. "
            "[Structure](../structure.md) shows how to link the library.\n\n")
    for module, files in headers.items():
        text += f"\n## bentaxis/{module}\n\n| header | what it is |\n|---|---|\n"
        for file, brief in files:
            text += f"| `bentaxis/{module}/{file}` | {cell(brief)} |\n"
    return text


def public_headers(root):
    """{module: [(file, its first comment)]} of the installed headers."""
    modules = {}
    for file in sorted(root.glob("*/include/bentaxis/**/*.h")) + sorted(root.glob("*/*/include/bentaxis/**/*.h")) + sorted(
            root.glob("*/*/*/include/bentaxis/**/*.h")):
        if file.relative_to(root).parts[0].startswith("build"):
            continue
        module, name = file.relative_to(root).as_posix().split("include/bentaxis/")[1].split("/", 1)
        comment = []
        for line in file.read_text(encoding="utf-8").splitlines():
            if not line.startswith("//"):
                break
            comment.append(line.lstrip("/ "))
        brief = re.split(r"(?<=[.:]) ", " ".join(comment))[0]
        modules.setdefault(module, []).append((name, brief))
    return {module: sorted(modules[module]) for module in sorted(modules)}


def doxygen(root, destination, scratch):
    """HTML of the public headers; returns Doxygen's warnings."""
    folders = sorted({file.parents[1] for pattern in ("*/include/bentaxis/*/*.h", "*/*/include/bentaxis/*/*.h", "*/*/*/include/bentaxis/*/*.h")
                      for file in root.glob(pattern) if not file.relative_to(root).parts[0].startswith("build")})
    settings = f"""
PROJECT_NAME = "bentaxis, C++"
INPUT = {' '.join(f'"{folder}"' for folder in folders)}
FILE_PATTERNS = *.h
RECURSIVE = YES
STRIP_FROM_PATH = {' '.join(f'"{folder.parent}"' for folder in folders)}
STRIP_FROM_INC_PATH = {' '.join(f'"{folder.parent}"' for folder in folders)}
OUTPUT_DIRECTORY = "{destination.parent}"
HTML_OUTPUT = {destination.name}
GENERATE_LATEX = NO
EXTRACT_ALL = YES
JAVADOC_AUTOBRIEF = YES
MARKDOWN_SUPPORT = YES
QUIET = YES
WARN_IF_UNDOCUMENTED = NO
WARN_IF_INCOMPLETE_DOC = NO
HAVE_DOT = NO
CLASS_GRAPH = NO
VERBATIM_HEADERS = NO
SHOW_INCLUDE_FILES = NO
HTML_TIMESTAMP = NO
SEARCHENGINE = YES
SERVER_BASED_SEARCH = NO
DISABLE_INDEX = NO
GENERATE_TREEVIEW = NO
BUILTIN_STL_SUPPORT = YES
"""
    file = scratch / "Doxyfile"
    file.write_text(settings)
    done = subprocess.run(["doxygen", str(file)], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError("doxygen: " + done.stderr)
    return done.stderr.splitlines()


# ---------------------------------------------------------------- licences

# Debian packages of which parts are in the site.
PARTS = {"mkdocs-material": "theme, icons and search (with lunr and RxJS)", "libjs-katex": "typesetting of equations", "fonts-katex": "fonts of the equations",
         "doxygen": "styles and scripts of the C++ pages"}


def parts_page():
    text = f"{NOTE}# Parts of this site\n\nThe pages are bentaxis', under the Apache License 2.0. The site holds parts of these programs, each under its own licence.\n"
    for package, what in PARTS.items():
        file = pathlib.Path("/usr/share/doc") / package / "copyright"
        if not file.is_file():
            raise RuntimeError(f"{file}: no licence of {package}, of which the site has {what}")
        text += f"\n## {package}\n\n{what[0].upper() + what[1:]}.\n\n````text\n{file.read_text(encoding='utf-8').rstrip()}\n````\n"
    return text


def write(root, program, docs):
    """Writes all of them below docs/reference."""
    pages = command_pages(program)
    pages["case_keys.md"] = case_keys_page(program)
    pages["plausibility_codes.md"] = plausibility_page(program)
    pages["json_keys.md"] = json_keys_page(root)
    pages["python.md"] = python_page(root)
    pages["parts.md"] = parts_page()
    pages["cpp.md"] = cpp_page(public_headers(root))
    for path, text in pages.items():
        file = docs / "reference" / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
