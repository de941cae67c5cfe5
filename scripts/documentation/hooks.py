"""Hooks of mkdocs: inline code that names a command or a key of the case file links to its place in the generated reference, and
a tutorial to its notebook."""
import pathlib
import posixpath
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from documentation import notebooks  # noqa: E402

COMMANDS = "docs/reference/commands/"
KEYS = "docs/reference/case_keys"
ANCHOR = re.compile(r'<a id="([\w.]+)">')
# Inline code outside of links, headings and blocks: <code>bentaxis compare CASE</code>, <code>pump.tilt_deg</code>
LINKED = re.compile(r"<a\b.*?</a>|<h[1-6]\b.*?</h[1-6]>|<pre\b.*?</pre>|"
                    r"<code>(?:bentaxis (?P<command>[a-z0-9]+)\b[^<]*|(?P<key>[a-z]\w*\.\w+)(?:\s*=[^<]*)?)</code>", re.DOTALL)

_commands, _keys = set(), set()


def on_files(files, config):
    _commands.clear()
    _keys.clear()
    for file in files:
        if file.src_uri.startswith(COMMANDS) and file.src_uri.endswith(".md"):
            _commands.add(pathlib.PurePosixPath(file.src_uri).stem)
        elif file.src_uri == KEYS + ".md":
            _keys.update(ANCHOR.findall(pathlib.Path(file.abs_src_path).read_text(encoding="utf-8")))
    return files


def on_page_content(html, page, config, files):
    here = page.file.dest_uri

    def linked(match):
        if match["command"] in _commands:
            target, anchor = f"{COMMANDS}{match['command']}.html", ""
        elif match["key"] in _keys:
            target, anchor = KEYS + ".html", "#" + match["key"]
        else:
            return match[0]
        if target == here:
            return match[0]
        return f'<a href="{posixpath.relpath(target, posixpath.dirname(here) or ".")}{anchor}">{match[0]}</a>'

    html = LINKED.sub(linked, html)
    if notebooks.is_notebook(page.file.src_uri):
        target = posixpath.relpath(str(notebooks.path_of(page.file.src_uri)), posixpath.dirname(here))
        html = html.replace("</h1>", f'</h1>\n<p>This page as a <a href="{target}" download>Jupyter notebook</a>.</p>', 1)
    return html
