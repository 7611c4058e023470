"""coverage.py BUILD PROGRAM: which lines, branches and conditions of fixed/ and firmware/ the tests have run.

BUILD was compiled by clang with -fprofile-instr-generate -fcoverage-mapping -fcoverage-mcdc, and its tests have left
their counts in BUILD/profiles. PROGRAM holds every object of both layers, linked or not by any test.

A condition counts when some pair of runs shows that it alone turned the decision (modified condition/decision
coverage, as DO-178C asks it at level A). What is missing goes to BUILD/missing.txt, one place a line.
Ends with 1 where a share is below its floor in tests/figures/coverage-floors.txt.
"""
import json
import subprocess
import sys
from pathlib import Path

import figures

KINDS = {"lines": "lines", "branches": "branches", "mcdc": "conditions (MC/DC)"}
LAYERS = ("fixed", "firmware")
FLOORS = Path("tests/figures/coverage-floors.txt")


def export(build, program):
    """The files of LAYERS as llvm-cov tells of them: path from here -> its answer."""
    data = build / "all.profdata"
    profiles = sorted((build / "profiles").glob("*.profraw"))
    if not profiles:
        sys.exit(f"coverage: no test of {build} has run")
    listed = build / "profiles.list"
    listed.write_text("".join(f"{path}\n" for path in profiles))
    subprocess.run(["llvm-profdata-19", "merge", "-sparse", f"--input-files={listed}", "-o", data], check=True)
    answer = subprocess.run(["llvm-cov-19", "export", "-instr-profile", data, program], check=True,
                            capture_output=True, text=True).stdout
    here = f"{Path.cwd()}/"
    files = {file["filename"].removeprefix(here).removeprefix(f"{build}/gen/"): file
             for file in json.loads(answer)["data"][0]["files"]}
    return {path: file for path, file in files.items() if path.startswith(LAYERS)}


def room(path):
    """fixed/src/trig.c is of fixed, firmware/map/db.c of firmware/map."""
    parts = path.split("/")
    return parts[0] if parts[0] == "fixed" else "/".join(parts[:2])


def missing(path, file):
    """Places of a file that no test reached: (line, what)."""
    for line, column, count, has_count, is_entry, is_gap in file["segments"]:
        if has_count and is_entry and not is_gap and count == 0:
            yield line, f"column {column}: never run"
    for line, column, _, _, taken, not_taken, *_ in file["branches"]:
        if (taken == 0) != (not_taken == 0):
            yield line, f"column {column}: never {'true' if taken == 0 else 'false'}"
    for line, column, *_, shown in file["mcdc_records"]:
        for number, is_shown in enumerate(shown, 1):
            if not is_shown:
                yield line, f"column {column}: condition {number} of {len(shown)} has never turned the decision alone"


def share(files, kind):
    counts = [file["summary"][kind] for file in files]
    return 100 * sum(c["covered"] for c in counts) / max(1, sum(c["count"] for c in counts))


def print_rooms(files):
    print(f"{'room':24}" + "".join(f"{name:>22}" for name in KINDS.values()))
    for name in sorted({room(path) for path in files}):
        of_room = [file for path, file in files.items() if room(path) == name]
        print(f"  {name:22}" + "".join(f"{share(of_room, kind):20.1f} %" for kind in KINDS))


def floors():
    """(layer, kind) -> percent that must be reached."""
    rows = [line.split() for line in FLOORS.read_text().splitlines() if line.strip() and not line.startswith("#")]
    return {(layer, kind): float(percent) for layer, kind, percent in rows}


def main():
    build, program = Path(sys.argv[1]), sys.argv[2]
    files = export(build, program)
    places = [f"{path}:{line}: {what}\n" for path, file in sorted(files.items())
              for line, what in sorted(set(missing(path, file)))]
    (build / "missing.txt").write_text("".join(places))
    print_rooms(files)
    print(f"\n{len(places)} places are missing, listed in {build}/missing.txt")
    rows, failures = [], []
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
