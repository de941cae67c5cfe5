"""Links of Markdown and HTML files: do they lead to a file, and to an anchor in it? Needs nothing but Python."""
import html.parser
import os
import pathlib
import re
import urllib.parse

FENCE = re.compile(r"^([ >]*)(`{3,}|~{3,}).*?^\1\2[`~]*[ \t]*$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"(?<!`)(`+)(?!`).+?(?<!`)\1(?!`)", re.DOTALL)
COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\[\]]*\](?:\([^()]*\))?)*\]\(\s*<?([^()\s>]*(?:\([^()\s]*\)[^()\s>]*)*)>?(?:\s+\"[^\"]*\")?\s*\)")
INNER = re.compile(r"\[!\[[^\]]*\]\(([^()\s]+)\)\]")  # a picture that is a link
DEFINITION = re.compile(r"^ {0,3}\[[^\]^]+\]:\s*<?(\S+?)>?(?:\s|$)", re.MULTILINE)
SOURCE = re.compile(r"<(?:img|source|a)\b[^>]*\b(?:src|href)=\"([^\"]+)\"")


def blanked(match):
    return re.sub(r"[^\n]", " ", match[0])


def without_code(text):
    """The text with blocks of code, inline code and comments blanked; lines stay where they are."""
    for pattern in (COMMENT, FENCE, CODE):
        text = pattern.sub(blanked, text)
    return text


def of_markdown(text):
    """(line, target) of every link and picture of a page."""
    text = without_code(text)
    return sorted((text.count("\n", 0, match.start()) + 1, match[1])
                  for pattern in (LINK, INNER, DEFINITION, SOURCE) for match in pattern.finditer(text) if match[1])


def is_external(target):
    return re.match(r"[a-z][a-z0-9+.-]*:|//", target, re.IGNORECASE) is not None


def parts(target):
    """Path and anchor of a target."""
    path, _, anchor = target.partition("#")
    return urllib.parse.unquote(path.split("?")[0]), urllib.parse.unquote(anchor)


def local_path(page, target):
    """The file that a link of `page` names, relative to what `page` is relative to; None for links elsewhere or within the page."""
    path, _ = parts(target)
    if is_external(target) or not path:
        return None
    return pathlib.PurePosixPath(os.path.normpath(page.parent / path))


def wrong_in_markdown(folder):
    """Links of the Markdown files of a folder that lead to no file."""
    wrong = []
    for page in sorted(folder.rglob("*.md")):
        for line, target in of_markdown(page.read_text(encoding="utf-8")):
            path = None if is_external(target) else parts(target)[0]
            if path and not (page.parent / path).exists():
                wrong.append(f"{page.relative_to(folder)}:{line}: link to {target}: no such file")
    return wrong


class _Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.anchors, self.links = set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if value is None:
                continue
            if name == "id" or (name == "name" and tag == "a"):
                self.anchors.add(value)
            elif name in ("href", "src"):
                self.links.append((tag, value))

    handle_startendtag = handle_starttag


def wrong_in_site(site, leave_out=()):
    """Links and anchors of the site's pages that lead nowhere, and what would be loaded from elsewhere. Pages below the folders
    `leave_out` are looked at as targets only. Returns (links followed, wrong)."""
    pages = {}

    def page(path):
        if path not in pages:
            pages[path] = _Page(path.read_text(encoding="utf-8", errors="replace"))
        return pages[path]

    followed, wrong = 0, []
    for file in sorted(site.rglob("*.html")):
        name = file.relative_to(site)
        if name.parts[0] in leave_out or name.name == "404.html":  # that page is served from anywhere
            continue
        for tag, target in page(file).links:
            if is_external(target):
                if tag not in ("a",) and not target.startswith("data:"):
                    wrong.append(f"{name}: <{tag}> loads {target}")
                continue
            path, anchor = parts(target)
            followed += 1
            goal = pathlib.Path(os.path.normpath(file.parent / path)) if path else file
            if goal.is_dir():
                goal /= "index.html"
            if not goal.is_file():
                wrong.append(f"{name}: link to {target}: no such file")
            elif anchor and goal.suffix == ".html" and anchor not in page(goal).anchors:
                wrong.append(f"{name}: link to {target}: no such anchor")
    return followed, wrong
