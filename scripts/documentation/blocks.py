"""The blocks of commands of a page: found, run, and compared with what the page says they print.

CONTRIBUTING.md, "Documentation", says how a block is written.
"""
import dataclasses
import functools
import os
import pathlib
import re
import resource
import shlex
import shutil
import subprocess
import time

from . import links

OPEN = re.compile(r"^(?P<indent>[ >]*)(?P<fence>`{3,}|~{3,})[ \t]*(?P<language>[^\s`]*)(?P<more>[^`\n]*)$")
MARK = re.compile(r"^\s*<!--\s*(not run|slow|status)\s*(?::\s*(.*?))?\s*-->\s*$")
# Pages whose Python blocks are run by a script of their own.
RUN_ELSEWHERE = {"docs/python.md": "scripts/write_python_example --check"}
SECONDS = 1800  # no block may take longer
SHOWN = ("sh", "python")


class PageError(Exception):
    """Something in a page that is written wrongly: "page:line: what"."""


@dataclasses.dataclass
class Block:
    page: str
    line: int                       # of the opening fence
    language: str
    text: str
    marks: dict                     # "not run", "slow", "status" -> text behind the colon
    output: str | None = None       # of the text fence directly below
    output_line: int = 0
    end: int = 0                    # line of the last fence, its output's included

    @property
    def where(self):
        return f"{self.page}:{self.line}"


def of_page(page, text):
    """All fenced blocks of a page, those of output joined to the commands they belong to."""
    blocks, lines = [], text.split("\n")
    at, marks, before = 0, {}, None  # before: a block of commands with only blank lines since
    while at < len(lines):
        mark = MARK.match(lines[at])
        opening = OPEN.match(lines[at])
        if mark:
            marks[mark[1]] = mark[2] or ""
            if mark[1] == "not run" and not mark[2]:
                raise PageError(f"{page}:{at + 1}: `not run` needs a reason: <!-- not run: REASON -->")
            if mark[1] == "status" and not (mark[2] or "").isdigit():
                raise PageError(f"{page}:{at + 1}: `status` needs a number: <!-- status: 1 -->")
        elif opening:
            indent, fence = opening["indent"], opening["fence"]
            if opening["more"].strip():
                raise PageError(f'{page}:{at + 1}: "{opening["more"].strip()}": only the language stands at a fence; '
                                "marks are comments in the line above: <!-- slow -->, <!-- not run: REASON -->, <!-- status: 1 -->")
            end = at + 1
            close = re.compile(rf"^[ >]*{re.escape(fence[0])}{{{len(fence)},}}[ \t]*$")
            while end < len(lines) and not close.match(lines[end]):
                end += 1
            if end == len(lines):
                raise PageError(f"{page}:{at + 1}: this block does not end")
            body = "".join(line.removeprefix(indent) + "\n" for line in lines[at + 1:end])
            language = opening["language"]
            if language == "text" and before is not None and before.language in SHOWN and not marks:
                before.output, before.output_line, before.end = body, at + 1, end + 1
                before = None
            else:
                before = Block(page, at + 1, language, body, marks, end=end + 1)
                blocks.append(before)
            at, marks = end, {}
        elif lines[at].strip():
            if marks:
                raise PageError(f"{page}:{at + 1}: a mark such as <!-- slow --> stands directly above a block")
            before = None
        at += 1
    return blocks


# ---------------------------------------------------------------- names of commands and options

class Commands:
    """The commands and options that a program has, by its own help."""

    def __init__(self, program):
        self.program = program

    @functools.lru_cache(maxsize=None)
    def help(self, *words):
        done = subprocess.run([self.program, *words, "--help"], capture_output=True, text=True)
        return done.stdout if done.returncode == 0 else None

    @functools.lru_cache(maxsize=None)
    def names(self):
        from . import reference
        return {name for name, _ in reference.subcommands(self.help())}

    @functools.lru_cache(maxsize=None)
    def options(self, *words):
        return set(re.findall(r"--[a-z][\w-]*", self.help(*words) or "")) | {"--help", "--version"}

    def wrong(self, words):
        """What is wrong with a call, its words behind `bentaxis`; "" where nothing is."""
        words = [word for word in words if word]
        if not words or not re.fullmatch(r"[a-z][a-z0-9]*", words[0]):
            named = []  # options of the program, or a placeholder such as COMMAND
        elif words[0] not in self.names():
            return f"there is no command `bentaxis {words[0]}`"
        else:
            from . import reference
            below = {name for name, _ in reference.subcommands(self.help(words[0]))}
            named = words[:2] if len(words) > 1 and words[1] in below else words[:1]
        known = self.options(*named)
        for word in words:
            option = re.match(r"\[?(--[a-z][\w-]*)", word)
            if option and option[1] not in known:
                return f"`{' '.join(['bentaxis', *named])}` has no option {option[1]}"
        return ""


CALL = re.compile(r"(?:^|[\s;&|(])(?:\S*/)?bentaxis[ \t]+(?=[a-z-])([^|;&#\n)]*)")


def calls(text):
    """The words behind `bentaxis` of every call in a shell text."""
    for line in re.sub(r"\\\n", " ", text).split("\n"):
        if re.match(r"\s*(#|find_package|import |from )", line):
            continue
        for match in CALL.finditer(line):
            try:
                words = shlex.split(match[1], comments=True)
            except ValueError:  # a quotation that ends elsewhere
                words = match[1].split()
            if not words or re.match(r"[-a-z]", words[0]):
                yield words


INLINE = re.compile(r"(?<!`)`([^`]*\bbentaxis [a-z-][^`]*)`(?!`)")


def wrong_words(page, text, blocks, commands):
    """Commands and options in a page, in running text or in blocks that are not run, that the program does not have."""
    wrong = []
    for block in blocks:
        if block.language == "sh" and "not run" in block.marks:
            wrong += [f"{block.where}: {what}" for what in filter(None, map(commands.wrong, calls(block.text)))]
        elif block.language not in ("sh", "python") and re.search(r"^\s*(\$ )?bentaxis [a-z]", block.text, re.MULTILINE):
            wrong.append(f"{block.where}: this block holds commands: write ```sh and, below, ```text for what they print")
    plain = links.FENCE.sub(links.blanked, links.COMMENT.sub(links.blanked, text))
    for match in INLINE.finditer(plain):
        for what in filter(None, map(commands.wrong, calls(match[1]))):
            wrong.append(f"{page}:{plain.count(chr(10), 0, match.start()) + 1}: {what}")
    return wrong


# ---------------------------------------------------------------- pictures

PICTURE = re.compile(r"!\[[^\]]*\]\(([^()\s]+)\)[ \t]*<!-- made by (\S+) -->")


def pictures(file):
    """(line, picture, file in the scratch folder) of the pictures of a page that its own blocks make."""
    text = links.CODE.sub(links.blanked, links.FENCE.sub(links.blanked, file.read_text(encoding="utf-8")))
    return [(text.count("\n", 0, match.start()) + 1, file.parent / match[1], match[2]) for match in PICTURE.finditer(text)]


# ---------------------------------------------------------------- running

@dataclasses.dataclass
class Result:
    block: Block
    printed: str
    wrong: list
    seconds: float  # of processor time


def scratch_folder(root, folder):
    """What commands find: shipped cases and curves, and my.toml, which stands for the reader's own case."""
    for name in ("cases", "reference_data", "problems"):
        shutil.copytree(root / name, folder / name)
    (folder / "docs").symlink_to(root / "docs")
    shutil.copyfile(root / "cases/bap63_rated.toml", folder / "my.toml")


def environment(folder, program, python_path):
    return {"PATH": f"{program.parent}:/usr/local/bin:/usr/bin:/bin", "HOME": str(folder), "TMPDIR": str(folder), "LANG": "C.UTF-8", "TERM": "dumb",
            "PYTHONPATH": str(python_path), "PYTHONDONTWRITEBYTECODE": "1", "MPLBACKEND": "Agg", "XDG_CACHE_HOME": str(folder / ".cache")}


def processor_seconds():
    """Of all processes that this one started and that have ended."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def judged(block, printed, failure, seconds, ending=""):
    """The result of a block that printed this. `failure`: why it ended otherwise than the page says; `ending`: printed below its output."""
    wrong = []
    if failure:
        wrong.append(f"{block.where}: {failure}:\n" + indented(printed[-2000:]))
    elif block.output is not None or ending:
        difference = first_difference(("...\n" if block.output is None else block.output) + ending, printed)
        if difference:
            wrong.append(f"{block.page}:{block.output_line}: {difference}; it prints:\n" + indented(printed[:8000]))
    return Result(block, printed, wrong, seconds)


def run(block, folder, program, python_path):
    command = ["bash", "-euo", "pipefail", "-c", block.text] if block.language == "sh" else ["/usr/bin/python3", "-c", block.text]
    before = processor_seconds()
    expected = int(block.marks.get("status", 0))
    try:
        done = subprocess.run(command, cwd=folder, env=environment(folder, program, python_path), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=SECONDS)
        printed = done.stdout.decode("utf-8", "replace")
        failure = "" if done.returncode == expected else f"ends with status {done.returncode}, not {expected}"
    except subprocess.TimeoutExpired as late:
        printed, failure = (late.stdout or b"").decode("utf-8", "replace"), f"does not end within {SECONDS} s"
    return judged(block, printed, failure, processor_seconds() - before)


def indented(text):
    return "".join("    " + line + "\n" for line in text.rstrip("\n").split("\n"))


def chosen(block, slow):
    """Whether a block runs: slow ones in the slow run; there also the others of their page, which come before them."""
    return block.language in SHOWN and "not run" not in block.marks and (slow or "slow" not in block.marks) and not (
        block.language == "python" and block.page in RUN_ELSEWHERE)


def run_page(root, blocks, folder, program, python_path, slow=False):
    """Results of a page's blocks, in their order, in one scratch folder."""
    wanted = [block for block in blocks if chosen(block, slow)]
    if not wanted:
        return []
    scratch_folder(root, folder)
    return [run(block, folder, program, python_path) for block in wanted]


# ---------------------------------------------------------------- comparing

NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?![.]?\d|\w)")
ROUND_OFF = 1e-9  # smaller numbers with an exponent are round-off and differ between machines


def step_of(number):
    """One unit in the last printed digit."""
    mantissa, _, exponent = number.lower().partition("e")
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def same_number(expected, printed):
    if expected == printed:
        return True
    a, b = float(expected), float(printed)
    if "e-" in expected.lower() and abs(a) < ROUND_OFF:
        return abs(b) < ROUND_OFF
    return abs(a - b) <= 0.5 * step_of(expected) * (1 + 1e-6) and not (expected.lstrip("+-").isdigit() and printed.lstrip("+-").isdigit())


@functools.lru_cache(maxsize=None)
def pattern_of(line):
    """A line of a page as pattern, and the numbers that it prints."""
    numbers, parts_of = [], []
    for piece in re.split(r"(\.\.\.)", " ".join(line.split())):
        if piece == "...":
            parts_of.append(".*?")
            continue
        at = 0
        for match in NUMBER.finditer(piece):
            parts_of.append(re.escape(piece[at:match.start()]) + f"({NUMBER.pattern})")
            numbers.append(match[0])
            at = match.end()
        parts_of.append(re.escape(piece[at:]))
    return re.compile("".join(parts_of)), numbers


def same_line(expected, printed):
    pattern, numbers = pattern_of(expected)
    match = pattern.fullmatch(" ".join(printed.split()))
    return match is not None and all(map(same_number, numbers, match.groups()))


def first_difference(expected, printed):
    """What of the expected output is not printed; "" where the two agree. A line of `...` stands for any lines."""
    def lines_of(text):
        return [line.rstrip() for line in text.rstrip("\n").split("\n")]

    there, parts_of = lines_of(printed), [[]]
    for line in lines_of(expected):
        if line.strip() == "...":
            parts_of.append([])
        else:
            parts_of[-1].append(line)

    def fits(part, at):
        return at >= 0 and at + len(part) <= len(there) and all(map(same_line, part, there[at:at + len(part)]))

    def missing(part, at):
        for offset, line in enumerate(part):
            if at + offset >= len(there) or not same_line(line, there[at + offset]):
                now = there[at + offset] if at + offset < len(there) else "(nothing)"
                return f'the page says "{line.strip()}", the command prints "{now.strip()}"'
        return f'the command goes on printing "{there[at + len(part)]}"'

    if len(parts_of) == 1:
        return "" if fits(parts_of[0], 0) and len(there) == len(parts_of[0]) else missing(parts_of[0], 0)
    if not fits(parts_of[0], 0):
        return missing(parts_of[0], 0)
    at = len(parts_of[0])
    for part in parts_of[1:-1]:
        begin = next((i for i in range(at, len(there) - len(part) + 1) if fits(part, i)), None)
        if begin is None:
            return f'the page says "{part[0].strip()}" and what follows, which the command does not print'
        at = begin + len(part)
    last = parts_of[-1]
    if last and (len(there) - len(last) < at or not fits(last, len(there) - len(last))):
        return missing(last, max(len(there) - len(last), at))
    return ""
