"""One-token changes of a C source: what a slip of the hand, or of the mind, would leave behind.

`changes(text)` lists them all, in the order of the text. Tokens are told apart as clang-format leaves them: a binary
operator stands between blanks. What is no C any more is left to the compiler to refuse.
"""
import re
from typing import NamedTuple

TOKEN = re.compile(r"""
    (?P<skip>\s+ | //[^\n]* | /\*.*?\*/ | "(?:\\.|[^"\\])*" | '(?:\\.|[^'\\])*')
  | (?P<word>[A-Za-z_]\w*)
  | (?P<number>0[xX][0-9a-fA-F]+[uUlL]* | \d+[uUlL]*)
  | (?P<sign><<= | >>= | \.\.\. | -> | \+\+ | -- | << | >> | <= | >= | == | != | && | \|\| | [-+*/%&|^]= | .)
""", re.VERBOSE | re.DOTALL)
DIRECTIVE = re.compile(r"^[ \t]*\#(?:[^\n]*\\\n)*[^\n]*", re.MULTILINE)

SWAPS = {
    "relational": {"<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",)},
    "plus-minus": {"+": ("-",), "-": ("+",), "+=": ("-=",), "-=": ("+=",)},
    "times-over": {"*": ("/",), "/": ("*",), "%": ("*",), "*=": ("/=",), "/=": ("*=",)},
    "and-or": {"&&": ("||",), "||": ("&&",)},
    "shift": {"<<": (">>",), ">>": ("<<",), "<<=": (">>=",), ">>=": ("<<=",)},
    "bits": {"&": ("|",), "|": ("&",), "^": ("&",), "&=": ("|=",), "|=": ("&=",), "^=": ("|=",)},
}
STEPS = {"++": "--", "--": "++"}
OPEN, CLOSE = {"(", "[", "{"}, {")", "]", "}"}
CONTROL = {"if", "for", "while", "switch"}
NO_STATEMENT = CONTROL | {"return", "goto", "do", "case", "default", "const", "static", "struct", "enum", "union",
                          "typedef", "else", "_Static_assert"}
ASSIGNS = {"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>=", "++", "--"}


class Change(NamedTuple):
    kind: str
    start: int  # characters start..end of the text become `new`
    end: int
    new: str

    def apply(self, text):
        return text[: self.start] + self.new + text[self.end:]


class Token(NamedTuple):
    kind: str
    text: str
    start: int
    end: int


def tokens(text):
    """Without comments, strings and directives."""
    text = DIRECTIVE.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), text)
    return [Token(m.lastgroup, m[0], m.start(), m.end()) for m in TOKEN.finditer(text) if m.lastgroup != "skip"]


def partners(line):
    """Index of each bracket -> index of its other half."""
    stack, found = [], {}
    for i, token in enumerate(line):
        if token.text in OPEN:
            stack.append(i)
        elif token.text in CLOSE and stack:
            found[i] = stack.pop()
            found[found[i]] = i
    return found


def _operators(text, line):
    for token in line:
        is_binary = text[token.start - 1: token.start] in (" ", "\n") and text[token.end: token.end + 1] in (" ", "\n")
        if token.text in STEPS:
            yield Change("plus-minus", token.start, token.end, STEPS[token.text])
        elif token.text == "!":
            yield Change("condition", token.start, token.end, "")
        elif is_binary:
            for kind, swaps in SWAPS.items():
                for new in swaps.get(token.text, ()):
                    yield Change(kind, token.start, token.end, new)


def _constants(line):
    for token in line:
        if token.kind != "number":
            continue
        digits = token.text.rstrip("uUlL")
        suffix = token.text[len(digits):]
        is_hex = digits[:2].lower() == "0x"
        value = int(digits, 16 if is_hex else 10)
        for new in (value + 1, value - 1):
            if new >= 0:
                yield Change("constant", token.start, token.end, (hex(new) if is_hex else str(new)) + suffix)


def _ternary_end(line, colon, pairs):
    """Index behind the last token of what follows the colon."""
    i, nested = colon + 1, 0
    while i < len(line):
        word = line[i].text
        if word in CLOSE or word in (",", ";") or (word == ":" and nested == 0):
            return i
        nested += {"?": 1, ":": -1}.get(word, 0)
        i = pairs.get(i, i) + 1
    return i


def _ternaries(text, line, pairs):
    for q, token in enumerate(line):
        if token.text != "?":
            continue
        i, nested = q + 1, 0
        while i < len(line) and not (line[i].text == ":" and nested == 0):
            nested += {"?": 1, ":": -1}.get(line[i].text, 0)
            i = pairs.get(i, i) + 1
        end = _ternary_end(line, i, pairs)
        if i < len(line) and q + 1 < i and i + 1 < end:
            first = text[line[q + 1].start: line[i - 1].end]
            second = text[line[i + 1].start: line[end - 1].end]
            yield Change("ternary", line[q + 1].start, line[end - 1].end, f"{second} : {first}")


def _conditions(text, line, pairs):
    for i, token in enumerate(line[:-1]):
        if token.text == "if" and line[i + 1].text == "(" and i + 1 in pairs:
            start, end = line[i + 1].start, line[pairs[i + 1]].end
            for before in ("0 && ", "1 || "):
                yield Change("condition", start, end, f"({before}{text[start:end]})")


def _begins_statement(line, i, pairs):
    before = line[i - 1].text
    if before == ")":
        opened = pairs.get(i - 1, 0)
        return opened > 0 and line[opened - 1].text in CONTROL
    return before in (";", "{", "}", "else")


def _is_declaration(line, i):
    return line[i].kind == "word" and (line[i + 1].kind == "word" or (
        line[i + 1].text == "*" and line[i + 1].end == line[i + 2].start))


def _statements(line, pairs):
    depth = 0
    for i, token in enumerate(line[:-2]):
        depth += {"(": 1, ")": -1}.get(token.text, 0)
        if depth or i == 0 or token.text in NO_STATEMENT or not _begins_statement(line, i, pairs):
            continue
        if token.text in CLOSE or token.text in (";", "{") or _is_declaration(line, i):
            continue
        end = i
        while end < len(line) and line[end].text not in (";", "{", "}"):
            end = (pairs.get(end, end) if line[end].text in OPEN else end) + 1
        words = {word.text for word in line[i:end]}
        is_call = end > i + 2 and line[end - 1].text == ")"
        if end < len(line) and line[end].text == ";" and (words & ASSIGNS or is_call or words <= {"break", "continue"}):
            yield Change("drop", token.start, line[end].end, ";")


def changes(text):
    line = tokens(text)
    pairs = partners(line)
    found = [*_operators(text, line), *_constants(line), *_ternaries(text, line, pairs),
             *_conditions(text, line, pairs), *_statements(line, pairs)]
    return sorted(set(found), key=lambda change: (change.start, change.kind, change.new))


def lines_of(text, change):
    """(number of the first line, the lines as they are, the lines as they would be)."""
    first = text.rfind("\n", 0, change.start) + 1
    last = text.find("\n", change.end)
    last = len(text) if last < 0 else last
    old = text[first:last]
    new = text[first: change.start] + change.new + text[change.end: last]
    return text.count("\n", 0, first) + 1, old, new
