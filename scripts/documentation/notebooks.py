"""Tutorials as Jupyter notebooks: text becomes text, a block of commands becomes a cell. What the page says that a block prints
is not stored; running the notebook prints it, and `run` compares the two.
"""
import json
import os
import pathlib
import re

from . import blocks, links

FOLDER = pathlib.PurePosixPath("notebooks")  # of the site
TUTORIALS = pathlib.PurePosixPath("docs/tutorials")

PREPARATION_TEXT = """*Made from {page}. It needs the program `bentaxis` in PATH, and Jupyter with a Python kernel. Run the cells in their order.*
"""
PREPARATION = """# A folder of its own, with copies of the shipped cases.
import json, os, pathlib, shutil, subprocess, tempfile
shipped = json.loads(subprocess.run(["bentaxis", "cases", "--json"], check=True, capture_output=True, text=True).stdout)
os.chdir(tempfile.mkdtemp(prefix="bentaxis_"))
shutil.copytree(next(pathlib.Path(case["file"]).parent for case in shipped if case["name"] == "bap63_rated"), "cases")
shutil.copy("cases/bap63_rated.toml", "my.toml")
print("Files are in", os.getcwd())"""


def is_notebook(page):
    return pathlib.PurePosixPath(page).parent == TUTORIALS


def of_tutorials(root):
    """The pages that become notebooks, in their order."""
    return sorted(TUTORIALS / file.name for file in (root / TUTORIALS).glob("*.md"))


def path_of(page):
    """Of a page's notebook in the site."""
    return FOLDER / (pathlib.PurePosixPath(page).stem + ".ipynb")


def _lines(text):
    return text.strip("\n").splitlines(keepends=True)


def _target(page, target):
    """A link of a page as one of its notebook, which stands in FOLDER of the site: a page is an HTML file there."""
    path = links.local_path(page, target)
    if path is None:
        return target
    anchor = links.parts(target)[1]
    if path.suffix == ".md":
        path = path.with_name("index.html") if path.name == "README.md" else path.with_suffix(".html")
    return os.path.relpath(path, FOLDER) + ("#" + anchor if anchor else "")


def _text(page, text):
    text = links.COMMENT.sub("", text)
    for pattern in (links.LINK, links.INNER):
        text = pattern.sub(lambda match: match[0].replace(f"({match[1]}", f"({_target(page, match[1])}", 1), text)
    return re.sub(r"\n{3,}", "\n\n", text)


def _source(block):
    if block.language == "python":
        return block.text
    if "status" in block.marks:
        return "%%bash --no-raise-error -euo pipefail\ntrap 'echo \"exit status $?\"' EXIT\n" + block.text
    return "%%bash -euo pipefail\n" + block.text


def of_page(page, text):
    """(notebook as a mapping in nbformat 4.5, {index of a cell: its block}). Blocks that are not run stay text."""
    page = pathlib.PurePosixPath(page)
    lines = text.split("\n")
    notebook, block_of, at = [], {}, 0

    def add(kind, source):
        if source.strip():
            cell = {"cell_type": kind, "id": f"cell-{len(notebook)}", "metadata": {}, "source": _lines(source)}
            if kind == "code":
                cell |= {"execution_count": None, "outputs": []}
            notebook.append(cell)

    add("markdown", PREPARATION_TEXT.format(page=page))
    add("code", PREPARATION)
    for block in blocks.of_page(str(page), text):
        if not blocks.chosen(block, False):
            continue
        add("markdown", _text(page, "\n".join(lines[at:block.line - 1])))
        add("code", _source(block))
        block_of[len(notebook) - 1] = block
        at = block.end
    add("markdown", _text(page, "\n".join(lines[at:])))
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return {"cells": notebook, "metadata": {"kernelspec": kernel, "language_info": {"name": "python"}}, "nbformat": 4, "nbformat_minor": 5}, block_of


def write(root, site):
    """Writes the notebooks of all tutorials, without outputs, into a site."""
    for page in of_tutorials(root):
        notebook, _ = of_page(page, (root / page).read_text(encoding="utf-8"))
        target = site / path_of(page)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def _printed(cell):
    return "".join(output.get("text", "") for output in cell.outputs if output.output_type == "stream")


def run(page, text, folder, environment):
    """The results of a page's blocks as its notebook, run by nbclient in `folder`. The first result is that of the preparation, and has
    the processor time of all."""
    os.environ.setdefault("PYDEVD_DISABLE_FILE_VALIDATION", "1")  # this process and the kernel load a debugger, which warns
    import nbclient
    import nbformat

    mapping, block_of = of_page(page, text)
    notebook = nbformat.reads(json.dumps(mapping), as_version=4)
    nbformat.validate(notebook)
    client = nbclient.NotebookClient(notebook, timeout=blocks.SECONDS, kernel_name="python3", allow_errors=True,
                                     resources={"metadata": {"path": str(folder)}})
    results, before = [], blocks.processor_seconds()
    with client.setup_kernel(env=environment | {"PYDEVD_DISABLE_FILE_VALIDATION": "1"}):
        for index, cell in enumerate(notebook.cells):
            if cell.cell_type != "code":
                continue
            client.execute_cell(cell, index)
            block = block_of.get(index, blocks.Block(str(page), 1, "python", PREPARATION, {}))
            failure = "; ".join(f"{output.ename}: {output.evalue}" for output in cell.outputs if output.output_type == "error")
            ending = f"exit status {block.marks['status']}\n" if "status" in block.marks else ""
            results.append(blocks.judged(block, _printed(cell), failure, 0, ending))
            if failure:
                break
    results[0].seconds = blocks.processor_seconds() - before
    return results
