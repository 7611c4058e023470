"""What can be checked of the documents without reading them.

    prose.py [FILE...]      (without files: every *.md of the repository, and the comments of every source)

A finding is one line, "place: what is wrong":
- a sentence of more than LONGEST_SENTENCE words,
- a line of more than LONGEST_LINE characters, tables and code excepted,
- a link, or a path in code type, that leads to no file of the repository,
- a name in code type with a prefix of ours (lm_, fx_, drv_, hs_) that no source has,
- a comment of a source that names a document, a header or a source of ours that is not there.
Ends with 1 if there is a finding.
"""
import re
import subprocess
import sys
from pathlib import Path

LONGEST_SENTENCE = 32  # words: "some 30"
LONGEST_LINE = 100
TOP = ("fixed", "firmware", "drivers", "bsp", "linker", "host-sim", "tests", "docs", "make")
SOURCES = (".c", ".h", ".S", ".ld", ".mk", ".py", ".sh")
# Made by the build.
MADE = {"tables.c", "noise_table.c", "response_table.c", "grown_table.c", "bus_generic.c"}
ABBREVIATIONS = re.compile(r"\b(e\.g|i\.e|cf|vs|no|Fig|Eq|eq|pp|p|ch|sec|approx)\.$")


def tracked():
    out = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], capture_output=True, text=True, check=True)
    return [Path(line) for line in out.stdout.splitlines() if Path(line).is_file()]


def blocks(text):
    """(line number, text) of each paragraph or list entry; tables, headings and code are left out."""
    is_code, start, words = False, 0, []
    for number, line in enumerate(text.splitlines() + [""], 1):
        fence = line.lstrip().startswith("```")
        is_prose = not (is_code or fence or line.startswith(("    ", "|", "#", "![", "[![")))
        begins = re.match(r"\s*([-*]|\d+\.)\s", line)
        if words and (not is_prose or not line.strip() or begins):
            yield start, " ".join(words)
            words = []
        if is_prose and line.strip():
            start = start if words else number
            words.append(re.sub(r"^\s*([-*]|\d+\.)\s+", "", line).strip())
        is_code ^= fence


def sentences(text):
    """A sentence ends at a full stop, question mark or colon before a space. Code in it is one word."""
    text = re.sub(r"`[^`]*`", "CODE", re.sub(r"\]\([^)]*\)", "]", text))
    begin = 0
    for end in re.finditer(r"[.?!:;]\)?(?=\s)", text):
        if not ABBREVIATIONS.search(text[begin:end.end()]):
            yield text[begin:end.end()]
            begin = end.end()
    yield text[begin:]


def prose(path, text):
    for number, line in enumerate(text.splitlines(), 1):
        if len(line) > LONGEST_LINE and not line.startswith(("|", "    ", "![", "[![")):
            yield f"{path}:{number}: a line of {len(line)} characters"
    for number, block in blocks(text):
        for sentence in sentences(block):
            words = [word for word in sentence.split() if re.search(r"\w", word)]
            if len(words) > LONGEST_SENTENCE:
                yield f"{path}:{number}: a sentence of {len(words)} words: {' '.join(words[:8])} ..."


def links(path, text, files, folders):
    for number, line in enumerate(text.splitlines(), 1):
        for target in re.findall(r"\]\(([^)#\s]+)", line):
            if not re.match(r"[a-z]+:", target) and not (path.parent / target).exists():
                yield f"{path}:{number}: a link to {target}, which is not there"
        for name in re.findall(r"`([\w.-]+/[\w./-]+?)/?`", line):
            is_ours = name.split("/")[0] in TOP and "..." not in name
            if is_ours and Path(name) not in files and Path(name) not in folders:
                yield f"{path}:{number}: names {name}, which is not there"


def names(path, text, known):
    for number, line in enumerate(text.splitlines(), 1):
        for code in re.findall(r"`([^`]+)`", line):
            for name in re.findall(r"\b(?:lm|fx|drv|hs|LM|FX|DRV)_\w+", code):
                if name not in known and not name.endswith("_"):
                    yield f"{path}:{number}: names {name}, which no source has"


def files_named(path, text, files):
    """Comments may send the reader to a document, a header or a source, which must be there."""
    present = {file.name for file in files} | MADE
    for number, line in enumerate(text.splitlines(), 1):
        found = re.findall(r"\b([\w-]+\.md)\b", line)
        if path.suffix in (".c", ".h"):
            found += re.findall(r"\b(?:lm|fx|drv|hs)/(\w+\.h)\b", line)
            found += re.findall(r"\b(?:see|of|in|and) (\w+\.[ch])\b", line)
        for name in found:
            if name not in present:
                yield f"{path}:{number}: names {name}, which is not there"


def findings(paths, files):
    folders = {folder for file in files for folder in file.parents}
    code = [file for file in files if file.suffix in SOURCES]
    known = {word for file in code for word in re.findall(r"\w+", file.read_text(errors="replace"))}
    for path in paths:
        if path.suffix == ".md":
            text = path.read_text()
            yield from prose(path, text)
            yield from links(path, text, files, folders)
            yield from names(path, text, known)
        elif path.suffix in SOURCES and path.name != "prose.py":
            yield from files_named(path, path.read_text(), files)


def main():
    files = tracked()
    paths = [Path(name) for name in sys.argv[1:]] or files
    found = list(findings(paths, set(files)))
    print("\n".join(found) if found else f"prose: {len(paths)} files, nothing found")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
