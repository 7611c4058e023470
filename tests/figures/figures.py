"""Figures of this build beside those of the last release.

    figures.py COMMAND     keep and print what `make COMMAND` measured: lines "VALUE UNIT NAME" on standard input
    figures.py             print what every command measured last
    figures.py --release   make that the figures of the last release, for a commit that makes one

The last release is tests/figures/release.txt, one figure a line: COMMAND VALUE UNIT NAME. Nothing here passes or fails.
"""
import sys
from pathlib import Path

RELEASE = Path("tests/figures/release.txt")
KEPT = Path("build/figures")  # one file for each command


def read(path):
    """The remarks and the rows of a file of figures; a row is a list of words whose last one is the rest of the line."""
    lines = path.read_text().splitlines() if path.exists() else []
    remarks = [line for line in lines if line.startswith("#")]
    return remarks, [line.split(maxsplit=3) for line in lines if line.strip() and not line.startswith("#")]


def text(value):
    return f"{value:,.0f}" if value == round(value) or value >= 1000 else f"{value:,.2f}"


def show(command, figures):
    """`figures` are (value, unit, name)."""
    released = {name: float(value) for of, value, _, name in read(RELEASE)[1] if of == command}
    print(f"\n{'make ' + command + ', beside the last release':52}{'now':>14}{'release':>14}{'change':>10}")
    for value, unit, name in figures:
        before = released.pop(name, None)
        change = f"{(value - before) / before:+.1%}" if before else "" if before is None else f"{value - before:+g}"
        print(f"  {name:50}{text(value):>14}{text(before) if before is not None else 'new':>14}{change:>10}  {unit}")
    for name, before in released.items():
        print(f"  {name:50}{'gone':>14}{text(before):>14}")


def record(command, figures):
    """Keep the figures of a command, and print them."""
    KEPT.mkdir(parents=True, exist_ok=True)
    lines = [f"{command} {value:.10g} {unit} {name}\n" for value, unit, name in figures]
    (KEPT / command).write_text("".join(lines))
    show(command, figures)


def kept():
    """command -> its figures, as they were measured last."""
    return {path.name: [(float(value), unit, name) for _, value, unit, name in read(path)[1]]
            for path in sorted(KEPT.glob("*"))}


def release():
    remarks = "".join(line + "\n" for line in read(RELEASE)[0])
    RELEASE.write_text(remarks + "".join((KEPT / command).read_text() for command in kept()))


def main():
    words = sys.argv[1:]
    if words == ["--release"]:
        release()
    elif words:
        rows = [line.split(maxsplit=2) for line in sys.stdin.read().splitlines()]
        record(words[0], [(float(value), unit, name) for value, unit, name in rows])
    else:
        for command, figures in kept().items():
            show(command, figures)
    return 0


if __name__ == "__main__":
    sys.exit(main())
