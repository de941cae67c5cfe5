"""Hooks of mkdocs: `bentaxis COMMAND` in a page links to the reference page of that command."""
import pathlib
import posixpath
import re

COMMAND_PAGES = "docs/reference/commands/"
# Inline code outside of links and headings: <code>bentaxis compare CASE</code>
LINKED = re.compile(r"<a\b.*?</a>|<h[1-6]\b.*?</h[1-6]>|<pre\b.*?</pre>|<code>bentaxis ([a-z0-9]+)\b([^<]*)</code>", re.DOTALL)

_commands = set()


def on_files(files, config):
    _commands.clear()
    _commands.update(pathlib.PurePosixPath(file.src_uri).stem for file in files
                     if file.src_uri.startswith(COMMAND_PAGES) and file.src_uri.endswith(".md"))
    return files


def on_page_content(html, page, config, files):
    def linked(match):
        command = match[1]
        target = f"{COMMAND_PAGES}{command}.html"
        if command not in _commands or page.file.dest_uri == target:
            return match[0]
        path = posixpath.relpath(target, posixpath.dirname(page.file.dest_uri) or ".")
        return f'<a href="{path}">{match[0]}</a>'

    return LINKED.sub(linked, html)
