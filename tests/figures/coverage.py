"""coverage.py BUILD PROGRAM OBJECT...: which lines, branches and conditions of fixed/ and firmware/ the tests have run.

BUILD was compiled by clang with -fprofile-instr-generate -fcoverage-mapping -fcoverage-mcdc, and its tests have left
their counts in BUILD/profiles. PROGRAM holds every object of both layers, linked or not by any test; each OBJECT is one
of a test, which has inline functions of their headers.

A condition counts when some pair of runs shows that it alone turned the decision (modified condition/decision
coverage, as DO-178C asks it at level A). An inline function of a header is in many objects and counts once:
what any of them shows is shown.

What is missing goes to BUILD/missing.txt, one place a line. Places of which tests/figures/coverage-argued.txt tells
why nothing can reach them go to BUILD/argued.txt, each with its reason; shares count them as not reached.
Ends with 1 where a place is missing; where a share is below its floor in tests/figures/coverage-floors.txt; or where an
argument does not fit: its code is not in the file, or is there more than once, or tests have reached all of it.
"""
import bisect
import json
import re
import subprocess
import sys
from pathlib import Path

import figures

KINDS = {"lines": "lines", "branches": "branches", "mcdc": "conditions (MC/DC)"}
LAYERS = ("fixed", "firmware")
NEGATIVE = 1 << 62  # llvm-cov subtracts counts; those of tests with threads may be short of a few, and the rest below 0
FLOORS = Path("tests/figures/coverage-floors.txt")
ARGUED = Path("tests/figures/coverage-argued.txt")


def export(build, program, objects):
    """The files of LAYERS as llvm-cov tells of them: path from here -> its answer."""
    data = build / "all.profdata"
    profiles = sorted((build / "profiles").glob("*.profraw"))
    if not profiles:
        sys.exit(f"coverage: no test of {build} has run")
    listed = build / "profiles.list"
    listed.write_text("".join(f"{path}\n" for path in profiles))
    subprocess.run(["llvm-profdata-19", "merge", "-sparse", f"--input-files={listed}", "-o", data], check=True)
    answer = subprocess.run(["llvm-cov-19", "export", "-instr-profile", data, program,
                             *(word for path in objects for word in ("-object", path))], check=True,
                            capture_output=True, text=True).stdout
    here = f"{Path.cwd()}/"
    files = {file["filename"].removeprefix(here).removeprefix(f"{build}/gen/"): file
             for file in json.loads(answer)["data"][0]["files"]}
    return {path: file for path, file in files.items() if path.startswith(LAYERS)}


def room(path):
    """fixed/src/trig.c is of fixed, firmware/map/db.c of firmware/map."""
    parts = path.split("/")
    return parts[0] if parts[0] == "fixed" else "/".join(parts[:2])


class Source:
    """The text of a file, by llvm-cov's lines and columns, which count from 1."""

    def __init__(self, build, path):
        made = build / "gen" / path
        self.text = (made if made.exists() else Path(path)).read_text()
        self.starts = [0] + [match.end() for match in re.finditer("\n", self.text)]

    def offset(self, line, column):
        return self.starts[line - 1] + column - 1

    def line(self, offset):
        return bisect.bisect_right(self.starts, offset)

    def between(self, start, end):
        return " ".join(self.text[start:end].split())


def run_lines(segments):
    """(lines that were run, lines with code), all objects together, as llvm-cov shows them."""
    run, mapped, inside = 0, 0, None  # inside: the segment that a line begins in
    by_line = {}
    for segment in segments:
        by_line.setdefault(segment[0], []).append(segment)
    for line in range(min(by_line, default=0), max(by_line, default=-1) + 1):
        of_line = by_line.get(line, [])
        starts = [s for s in of_line if s[3] and s[4] and not s[5]]
        is_skipped = bool(of_line) and not of_line[0][3] and of_line[0][4]
        if not is_skipped and (starts or (inside and inside[3])):
            mapped += 1
            run += max([s[2] for s in starts] + [inside[2] if inside else 0]) > 0
        inside = of_line[-1] if of_line else inside
    return run, mapped


class Counted:
    """What llvm-cov counted in a file, all objects together. A span is (offset of its start, of its end)."""

    def __init__(self, file, source):
        def span(record):
            return source.offset(*record[0:2]), source.offset(*record[2:4])
        self.lines = run_lines(file["segments"])
        self.never_run = [source.offset(line, column) for line, column, count, has_count, is_entry, is_gap
                          in file["segments"] if has_count and is_entry and not is_gap and count == 0]
        self.branches = {}  # span of a condition -> how often [true, false]
        for record in file["branches"]:
            taken = self.branches.setdefault(span(record), [0, 0])
            for way in range(2):
                taken[way] += record[4 + way] if record[4 + way] < NEGATIVE else 0
        self.decisions = {}  # span -> of each of its conditions, whether it has turned the decision alone
        for record in file["mcdc_records"]:
            before = self.decisions.get(span(record), [False] * len(record[-1]))
            self.decisions[span(record)] = [a or b for a, b in zip(before, record[-1], strict=True)]
        for decision, shown in self.decisions.items():  # what has turned a decision alone was true and false
            for condition, is_shown in zip(self.conditions_of(decision), shown, strict=True):
                if is_shown:
                    self.branches[condition] = [max(1, count) for count in self.branches[condition]]

    def conditions_of(self, decision):
        """Spans of a decision's conditions in their order; what stands within a condition is none of them."""
        inside = [s for s in self.branches if decision[0] <= s[0] and s[1] <= decision[1]]
        return sorted(s for s in inside if not any(o != s and o[0] <= s[0] and s[1] <= o[1] for o in inside))

    def share_of(self, kind):
        """(reached, all) of a kind of KINDS."""
        if kind == "lines":
            return self.lines
        ways = [count > 0 for taken in self.branches.values() for count in taken] if kind == "branches" else \
               [shown for conditions in self.decisions.values() for shown in conditions]
        return sum(ways), len(ways)


def missing(counted, source):
    """Places of a file that no test reached, in their order: (offset, what)."""
    places = {}  # (offset, text) -> what is missing there
    for start in counted.never_run:
        places[start, source.text[start:].split("\n", 1)[0].strip()] = ["never run"]
    for (start, end), (taken, not_taken) in counted.branches.items():
        if (taken == 0) != (not_taken == 0):
            what = "never true" if taken == 0 else "never false"
            places.setdefault((start, source.between(start, end)), []).append(what)
    for decision, shown in counted.decisions.items():
        for (start, end), is_shown in zip(counted.conditions_of(decision), shown, strict=True):
            if not is_shown:
                what = "has never turned the decision alone"
                places.setdefault((start, source.between(start, end)), []).append(what)
    return [(start, f"{', '.join(what)}: {text}") for (start, text), what in sorted(places.items())]


def arguments():
    """(path, code, reason) of each entry of ARGUED. Code is a piece of the file, what is argued of it in backquotes."""
    entries = []
    for line in ARGUED.read_text().splitlines():
        if line.startswith((" ", "\t")):
            entries[-1][2].append(line.strip())
        elif line.strip() and not line.startswith("#"):
            path, code = line.split(": ", 1)
            entries.append((path, code, []))
    return [(path, code, " ".join(reason)) for path, code, reason in entries]


def argued_span(code, source):
    """The span of the argued part of a piece of code, or None where the piece does not stand there just once."""
    parts = [r"\s+".join(re.escape(word) for word in part.split(" ")) for part in code.split("`")]
    found = list(re.finditer("({})({})({})".format(*parts), source.text)) if len(parts) == 3 else []
    return found[0].span(2) if len(found) == 1 else None


def settle(missed, sources):
    """Missing places by the arguments for them. `missed` is path -> places.

    Returns lines of missing places, [(path, line)], and of argued ones, and what is wrong with the arguments."""
    spans, wrong = {}, []
    for path, code, reason in arguments():
        span = argued_span(code, sources[path]) if path in sources else None
        if span is None or not reason:
            wrong.append(f"coverage: {ARGUED}: {path}: not there just once, or without a reason: {code}")
        elif not any(span[0] <= start < span[1] for start, _ in missed[path]):
            wrong.append(f"coverage: {ARGUED}: {path}: tests have reached this: {code}")
        else:
            spans.setdefault(path, []).append((span, reason))
    left, argued = [], []
    for path, places in sorted(missed.items()):
        for start, what in places:
            reason = next((why for span, why in spans.get(path, []) if span[0] <= start < span[1]), None)
            line = sources[path].line(start)
            place = f"{path}:{line}:{start - sources[path].starts[line - 1] + 1}: {what}"
            if reason is None:
                left.append((path, place))
            else:
                argued.append((path, f"{place}\n    {reason}"))
    return left, argued, wrong


def share(files, kind):
    counts = [file.share_of(kind) for file in files]
    return 100 * sum(reached for reached, _ in counts) / max(1, sum(count for _, count in counts))


def print_rooms(files, left, argued):
    print(f"{'room':24}" + "".join(f"{name:>22}" for name in KINDS.values()) + f"{'missing':>9}{'argued':>9}")
    for name in sorted({room(path) for path in files}):
        of_room = [file for path, file in files.items() if room(path) == name]
        counts = [sum(room(path) == name for path, _ in places) for places in (left, argued)]
        print(f"  {name:22}" + "".join(f"{share(of_room, kind):20.1f} %" for kind in KINDS)
              + "".join(f"{count:9}" for count in counts))


def floors():
    """(layer, kind) -> percent that must be reached."""
    rows = [line.split() for line in FLOORS.read_text().splitlines() if line.strip() and not line.startswith("#")]
    return {(layer, kind): float(percent) for layer, kind, percent in rows}


def main():
    build, program = Path(sys.argv[1]), sys.argv[2]
    exported = export(build, program, sys.argv[3:])
    sources = {path: Source(build, path) for path in exported}
    files = {path: Counted(file, sources[path]) for path, file in exported.items()}
    left, argued, failures = settle({path: missing(file, sources[path]) for path, file in files.items()}, sources)
    for name, places in (("missing.txt", left), ("argued.txt", argued)):
        (build / name).write_text("".join(f"{place}\n" for _, place in places))
    print_rooms(files, left, argued)
    print(f"\n{len(left)} places are missing, listed in {build}/missing.txt; "
          f"{len(argued)} are argued in {ARGUED}, listed in {build}/argued.txt")
    failures += [f"coverage: {place}" for _, place in left]
    rows = []
    least = floors()
    for layer in LAYERS:
        of_layer = [file for path, file in files.items() if path.startswith(layer)]
        for kind, name in KINDS.items():
            percent = share(of_layer, kind)
            rows.append((percent, "%", f"{name} of {layer} run by tests"))
            if percent < least[layer, kind]:
                failures.append(f"coverage: {name} of {layer}: {percent:.2f} %, below its floor of {least[layer, kind]} %")
    figures.record("coverage", rows)
    print("\n".join(failures), file=sys.stderr, end="\n" if failures else "")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
