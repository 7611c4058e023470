"""coverage.py BUILD: which lines and branches of fixed/ and firmware/ the tests of a build with --coverage have run.

A line of a header counts as run when it was run in any of the objects that it was compiled into."""
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import figures

LAYERS = ("fixed", "firmware")


def read(data):
    """The files that gcov tells of an object."""
    answer = subprocess.run(["gcov", "--json-format", "--stdout", "--branch-probabilities", data], capture_output=True,
                            text=True)
    return [file for line in answer.stdout.splitlines() for file in json.loads(line)["files"]]


def add(file, lines, branches):
    """`lines` counts the runs of each line, `branches` those of each branch of a line."""
    for line in file["lines"]:
        place = (file["file"], line["line_number"])
        lines[place] = lines.get(place, 0) + line["count"]
        for number, branch in enumerate(line["branches"]):
            branches[place + (number,)] = branches.get(place + (number,), 0) + branch["count"]


def share(counts):
    return 100 * sum(count > 0 for count in counts) / max(1, len(counts))


def main():
    build = Path(sys.argv[1])
    data = [path for layer in LAYERS for path in sorted((build / layer).rglob("*.gcda"))]
    if not data:
        print(f"coverage: no test of {build} has run", file=sys.stderr)
        return 1
    lines, branches = {}, {}
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for files in pool.map(read, data):
            for file in files:
                add(file, lines, branches)
    sources = sorted({place[0] for place in lines if place[0].startswith(LAYERS)})
    never = {source: sum(place[0] == source and count == 0 for place, count in lines.items()) for source in sources}
    print("lines that no test has run, by source")
    for source in sorted(sources, key=lambda source: -never[source]):
        if never[source]:
            print(f"  {source:50}{never[source]:6}")
    rows = []
    for layer in LAYERS:
        of_layer = [count for place, count in lines.items() if place[0].startswith(layer)]
        rows.append((share(of_layer), "%", f"lines of {layer} run by tests"))
        of_layer = [count for place, count in branches.items() if place[0].startswith(layer)]
        rows.append((share(of_layer), "%", f"branches of {layer} run by tests"))
    figures.record("coverage", rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
