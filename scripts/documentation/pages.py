"""The pages of the site: what mkdocs.yml names, README.md, and every file of the repository that one of them links to.

They are collected in the repository's own layout, so that their links need no change.
"""
import os
import pathlib
import re
import shutil
import urllib.parse

import yaml

GENERATED = pathlib.PurePosixPath("docs/reference")  # made by scripts/build_site; not in the repository
FENCE = re.compile(r"^( *)(`{3,}|~{3,}).*?^\1\2`*~*[ \t]*$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"(?<!`)(`+)(?!`).+?(?<!`)\1(?!`)", re.DOTALL)
COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\[\]]*\])*\]\(\s*<?([^()\s>]*(?:\([^()\s]*\)[^()\s>]*)*)>?(?:\s+\"[^\"]*\")?\s*\)")
IMAGE = re.compile(r"<(?:img|source)\b[^>]*\bsrc=\"([^\"]+)\"")
ANCHOR = re.compile(r"<a\b[^>]*\bhref=\"([^\"]+)\"")


class _Loader(yaml.SafeLoader):
    """mkdocs.yml has tags of mkdocs; what they stand for is not needed here."""


_Loader.add_constructor("!ENV", lambda loader, node: None)


def navigation(root):
    """The paths that mkdocs.yml names in `nav`, in their order."""
    def paths(node):
        if isinstance(node, str):
            yield node
        elif isinstance(node, list):
            for item in node:
                yield from paths(item)
        elif isinstance(node, dict):
            for item in node.values():
                yield from paths(item)

    return list(paths(yaml.load((root / "mkdocs.yml").read_text(encoding="utf-8"), _Loader)["nav"]))


def without_code(text):
    """The text with blocks of code, inline code and comments blanked; lines stay where they are."""
    def blank(match):
        return re.sub(r"[^\n]", " ", match[0])

    for pattern in (FENCE, COMMENT, CODE):
        text = pattern.sub(blank, text)
    return text


def links(text):
    """(line, target) of every link and picture of a page."""
    text = without_code(text)
    found = []
    for pattern in (LINK, IMAGE, ANCHOR):
        for match in pattern.finditer(text):
            found.append((text.count("\n", 0, match.start()) + 1, match[1]))
    return sorted(found)


def is_external(target):
    return re.match(r"[a-z][a-z0-9+.-]*:|//", target, re.IGNORECASE) is not None


def local_path(page, target):
    """The file that a link of `page` names, relative to the root; None for links out of the repository or within the page."""
    path = urllib.parse.unquote(target.split("#")[0].split("?")[0])
    if is_external(target) or not path:
        return None
    return pathlib.PurePosixPath(os.path.normpath(page.parent / path))


def sources(root):
    """Every file of the repository that the site holds, and what is wrong with it: ([paths], ["page:line: what"])."""
    todo = [pathlib.PurePosixPath(path) for path in navigation(root)]
    todo += [pathlib.PurePosixPath(file.relative_to(root).as_posix()) for file in sorted((root / "docs").rglob("*.md"))]
    done, wrong = [], []
    seen = set()
    for page in todo:  # grows
        if page in seen or GENERATED in page.parents:
            continue
        seen.add(page)
        if not (root / page).is_file():
            wrong.append(f"mkdocs.yml: no file {page}")
            continue
        done.append(page)
        if page.suffix != ".md":
            continue
        for line, target in links((root / page).read_text(encoding="utf-8")):
            path = local_path(page, target)
            if path is None:
                continue
            if GENERATED in path.parents:
                wrong.append(f"{page}:{line}: link to {path}, which only the site has: write `bentaxis COMMAND`, which the site links")
            elif path.parts[:1] == ("..",) or not (root / path).exists():
                wrong.append(f"{page}:{line}: link to {target}: no such file")
            elif (root / path).is_file():
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
