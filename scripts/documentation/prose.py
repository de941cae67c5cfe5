"""Rules for texts that users read: words, length of sentences, spelling of the glossary's terms. The rules are scripts/prose_rules.toml."""
import dataclasses
import re
import tomllib

from . import links

END = re.compile(r"(?<=[.!?])[\"')\]*_]*(?=\s+(?:[\"'(\[*_]*[A-Z0-9]|CODE\b)|\s*$)")
ABBREVIATION = re.compile(r"(?:\b(?:e\.g|i\.e|cf|vs|approx|resp|etc|no|nos|pp?|Fig|Figs|Eq|Eqs|Sec|Tab|Ref|Vol|ed|eds|al|[A-Z])|\.\.)\.$")
# The table of words of docs/style.md, which is made from the rules.
TABLE = re.compile(r"(<!-- words of scripts/prose_rules.toml -->\n)(.*?)(<!-- end of table -->)", re.DOTALL)
TERM = re.compile(r"^\| *([^|]+?) *\|", re.MULTILINE)


@dataclasses.dataclass(frozen=True)
class Word:
    pattern: re.Pattern
    write: str = ""
    instead_of: str = ""
    allowed: tuple = ()


def expression(text):
    return re.compile(text.replace(" ", r"\s+"), re.IGNORECASE)


class Rules:
    def __init__(self, file):
        data = tomllib.loads(file.read_text(encoding="utf-8"))
        self.words = [Word(expression(word["pattern"]), word.get("write", ""), word.get("instead_of", ""),
                           tuple(map(expression, word.get("allowed", [])))) for word in data["word"]]
        self.sentence_words = data["limits"]["sentence_words"]
        self.texts = data["texts"]
        self.spelling = data["spelling"]
        self.any_spelling = data["glossary"]["any_spelling"]
        self.exceptions = {}
        for exception in data.get("exception", []):
            if not exception["reason"]:
                raise ValueError(f"{file}: an exception needs a reason")
            self.exceptions.setdefault(exception["page"], []).append(expression(exception["pattern"]))

    def table(self):
        rows = "".join(f"| {word.write} | {word.instead_of} |\n" for word in self.words if word.write)
        return "| write | instead of |\n|---|---|\n" + rows


# ---------------------------------------------------------------- texts

def of_markdown(text):
    """(line, paragraph) of the prose of a page. Code, equations, comments and addresses are left out; code stands as CODE."""
    for pattern in (TABLE, links.COMMENT, links.FENCE, re.compile(r"\$\$.*?\$\$", re.DOTALL)):
        text = pattern.sub(links.blanked, text)
    text = links.CODE.sub(lambda match: "CODE" + "\n" * match[0].count("\n"), text)
    text = re.sub(r"(?<![\\$\w])\$[^$\n]+\$(?!\w)", "EQUATION", text)
    text = re.sub(r"\]\((?:[^()]|\([^()]*\))*\)", "]", text)
    text = text.replace("<br>", "LINE_BREAK")
    text = re.sub(r"<https?:[^>]*>|https?://\S+|</?[a-zA-Z][^>\n]*>", "", text)
    text = re.sub(r"\{[#.:][^}\n]*\}", "", text)
    paragraphs, current, begin = [], [], 0

    def close():
        nonlocal current
        if current:
            paragraphs.append((begin, " ".join(current)))
        current = []

    for number, line in enumerate(text.split("\n"), 1):
        line = re.sub(r"^[ >]*", "", line).rstrip()
        if line.startswith("|"):
            close()
            if not re.fullmatch(r"[|:\- ]+", line):
                cells = re.split(r"(?<!\\)\||LINE_BREAK", line)[1:]
                paragraphs += [(number, cell.strip()) for cell in cells if cell.strip()]
            continue
        head = re.match(r"(#+ |[*+-] |\d+[.)] |\[\^[^\]]*\]: |!!! \w+ ?|\?\?\? \w+ ?|: )", line)
        if not line or head:
            close()
            line = line[head.end():] if head else line
        if line:
            if not current:
                begin = number
            current.append(line)
            if head and head[0].startswith("#"):
                close()
    close()
    return paragraphs


def of_plain_text(text):
    """(line, paragraph) of a help text or a docstring: blank lines and lines of options part it. Code stands as CODE."""
    paragraphs, current, begin = [], [], 0
    for number, line in enumerate(text.split("\n"), 1):
        starts = re.match(r"\s{0,4}(?:(-\S.*?|[a-z][\w-]*)\s{2,}(?=\S)|-\S.*)", line)
        if not line.strip() or starts:
            if current:
                paragraphs.append((begin, " ".join(current)))
            current = []
            line = line[starts.end():] if starts else line
        if line.strip():
            begin = begin if current else number
            current.append(line.strip())
    paragraphs += [(begin, " ".join(current))] if current else []
    return [(number, links.CODE.sub("CODE", paragraph)) for number, paragraph in paragraphs]


def sentences(paragraph):
    start = 0
    for match in END.finditer(paragraph):
        piece = paragraph[start:match.end()]
        if ABBREVIATION.search(piece.rstrip("\"')]*_ ")) and match.end() < len(paragraph.rstrip()):
            continue
        if piece.strip():
            yield piece.strip()
        start = match.end()
    if paragraph[start:].strip():
        yield paragraph[start:].strip()


def words_of(sentence):
    return [word for word in sentence.split() if re.search(r"\w", word)]


# ---------------------------------------------------------------- rules

def wrong_words(name, paragraphs, rules):
    wrong = []
    here = rules.exceptions.get(name, [])
    for line, text in paragraphs:
        for word in rules.words:
            spans = [match.span() for allowed in (*word.allowed, *here) for match in allowed.finditer(text)]
            for match in word.pattern.finditer(text):
                if not any(low <= match.start() and match.end() <= high for low, high in spans):
                    wrong.append(f'{name}:{line}: "{match[0]}": write "{word.write}"' if word.write else f'{name}:{line}: "{match[0]}"')
    return wrong


def long_sentences(name, paragraphs, rules):
    """On a page of answers as the program prints them, the entries of a list that is parted by semicolons count one by one."""
    of_answers = name in rules.texts.get("answers", [])
    parts = [(line, part) for line, text in paragraphs for sentence in sentences(text) for part in (sentence.split("; ") if of_answers else [sentence])]
    return [f'{name}:{line}: a sentence of {len(words_of(part))} words, at most {rules.sentence_words}: "{part[:60]}.."'
            for line, part in parts if len(words_of(part)) > rules.sentence_words]


def glossary_terms(text, rules):
    """Terms of more than one part in the glossary's tables, each with the pattern of its other spellings."""
    terms = []
    for match in TERM.finditer(links.COMMENT.sub("", text)):
        for term in match[1].split(","):
            term = re.sub(r"\(.*?\)|[*`]", "", term).strip()
            parts = re.split(r"[ -]", term)
            if len(parts) < 2 or term in rules.any_spelling or not all(re.fullmatch(r"[A-Za-z]{2,}", part) for part in parts):
                continue
            terms.append((term, re.compile(r"\b" + "[ -]?".join(map(re.escape, parts)) + r"s?\b", re.IGNORECASE)))
    return terms


def other_spellings(name, paragraphs, terms):
    """Where a term is written in one word, or with a space where the glossary has a hyphen."""
    wrong = []
    for line, text in paragraphs:
        for term, pattern in terms:
            for match in pattern.finditer(text):
                found = match[0].lower()
                # A hyphen instead of a space is how two nouns stand before a third one.
                if found.removesuffix("s") != term.lower().removesuffix("s") and re.sub("-", " ", found.removesuffix("s")) != term.lower().removesuffix("s"):
                    wrong.append(f'{name}:{line}: "{match[0]}": the glossary has "{term}"')
    return wrong
