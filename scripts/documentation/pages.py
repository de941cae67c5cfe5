"""The pages of the site: what mkdocs.yml names, README.md, docs/, and every file of the repository that one of them links to.

They are collected in the repository's own layout, so that their links need no change.
"""
import pathlib
import shutil

import yaml

from . import links

GENERATED = pathlib.PurePosixPath("docs/reference")  # made by scripts/build_site; not in the repository


class _Loader(yaml.SafeLoader):
    """mkdocs.yml has tags of mkdocs and Python; what they stand for is not needed here."""


_Loader.add_constructor("!ENV", lambda loader, node: None)
_Loader.add_multi_constructor("tag:yaml.org,2002:python/", lambda loader, suffix, node: None)


def navigation(root):
    """The paths that mkdocs.yml names in `nav`, in their order."""
    def paths(node):
        if isinstance(node, str):
            yield pathlib.PurePosixPath(node)
        elif isinstance(node, list):
            for item in node:
                yield from paths(item)
        elif isinstance(node, dict):
            for item in node.values():
                yield from paths(item)

    return list(paths(yaml.load((root / "mkdocs.yml").read_text(encoding="utf-8"), _Loader)["nav"]))


def sources(root):
    """Every file of the repository that the site holds, and what is wrong with it: ([paths], ["page:line: what"])."""
    named = [page for page in navigation(root) if GENERATED not in page.parents]
    todo = named + [pathlib.PurePosixPath(file.relative_to(root).as_posix()) for file in sorted((root / "docs").rglob("*.md"))]
    done, wrong, seen = [], [], set()
    for page in todo:  # grows
        if page in seen:
            continue
        seen.add(page)
        if not (root / page).is_file():
            wrong.append(f"mkdocs.yml: no file {page}")
            continue
        done.append(page)
        if page.suffix != ".md":
            continue
        if page.parts[0] == "docs" and page not in named:
            wrong.append(f"{page}: is not in the navigation of mkdocs.yml")
        for line, target in links.of_markdown((root / page).read_text(encoding="utf-8")):
            path = links.local_path(page, target)
            if path is None:
                continue
            if GENERATED in path.parents:
                wrong.append(f"{page}:{line}: link to {path}, which only the site has: write `bentaxis COMMAND`, which the site links")
            elif path.parts[:1] == ("..",) or not (root / path).exists():
                wrong.append(f"{page}:{line}: link to {target}: no such file")
            elif (root / path).is_dir():
                wrong.append(f"{page}:{line}: link to {target}: a folder is no page; link to a file in it")
            else:
                todo.append(path)
    return done, wrong


def collect(root, destination):
    """Copies the sources of the site; returns what is wrong with them."""
    files, wrong = sources(root)
    for file in files:
        target = destination / file
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(root / file, target)
    return wrong
