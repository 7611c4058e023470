"""Figures of this build beside their goals and those of the last release.

    figures.py COMMAND     keep and print what `make COMMAND` measured: lines "VALUE UNIT NAME" on standard input
    figures.py --keep COMMAND   keep it and print nothing
    figures.py             print what every command measured last
    figures.py --goals     print those that have a goal
    figures.py --now       make what was measured last the figures of this version, and write the table of README.md anew
    figures.py --readme    write that table anew
    figures.py --release   make what was measured last the figures of the last release, for a commit that makes one

The last release is tests/figures/release.txt and this version tests/figures/now.txt, one figure a line: COMMAND VALUE UNIT
NAME. tests/figures/goals.txt has the goals. Nothing here passes or fails.
"""
import sys
from pathlib import Path
from typing import NamedTuple

HERE = Path("tests/figures")
RELEASE, NOW, GOALS = HERE / "release.txt", HERE / "now.txt", HERE / "goals.txt"
KEPT = Path("build/figures")  # one file for each command
README = Path("README.md")
BEGIN, END = "<!-- tests/figures/figures.py --readme -->", "<!-- end -->"


class Goal(NamedTuple):
    command: str
    sense: str
    limit: float
    unit: str
    name: str
    what: str

    def is_met(self, value):
        return value <= self.limit if self.sense == "<=" else value >= self.limit


def read(path, words=4):
    """The remarks and the rows of a file of figures; a row is a list of words whose last one is the rest of the line."""
    lines = path.read_text().splitlines() if path.exists() else []
    remarks = [line for line in lines if line.startswith("#")]
    return remarks, [line.split(maxsplit=words - 1) for line in lines if line.strip() and not line.startswith("#")]


def read_goals():
    """In the order of their file."""
    goals = []
    for command, sense, limit, unit, rest in read(GOALS, 5)[1]:
        name, what = (part.strip() for part in rest.split("|"))
        goals.append(Goal(command, sense, float(limit), unit, name, what))
    return goals


def figures_of(path):
    """(command, name) -> value."""
    return {(command, name): float(value) for command, value, _, name in read(path)[1]}


def text(value):
    if value is None:
        return ""
    return f"{value:,.0f}" if value == round(value) or value >= 1000 else f"{value:,.2f}"


def goal_text(goal, value):
    """Such as "<= 28 missed"."""
    if goal is None:
        return ""
    return f"{goal.sense} {text(goal.limit)}" + ("" if value is None or goal.is_met(value) else " missed")


def show(command, figures):
    """`figures` are (value, unit, name)."""
    released = {name: value for (of, name), value in figures_of(RELEASE).items() if of == command}
    goals = {goal.name: goal for goal in read_goals() if goal.command == command}
    print(f"\n{'make ' + command:50}{'goal':>20}{'release':>14}{'now':>14}{'change':>10}")
    for value, unit, name in figures:
        before = released.pop(name, None)
        change = f"{(value - before) / before:+.1%}" if before else "" if before is None else f"{value - before:+g}"
        print(f"  {name:48}{goal_text(goals.pop(name, None), value):>20}{text(before) or 'new':>14}{text(value):>14}"
              f"{change:>10}  {unit}")
    for name in list(goals) + [name for name in released if name not in goals]:
        print(f"  {name:48}{goal_text(goals.get(name), None):>20}{text(released.get(name)):>14}{'not now':>14}")


def keep(command, figures):
    KEPT.mkdir(parents=True, exist_ok=True)
    lines = [f"{command} {value:.10g} {unit} {name}\n" for value, unit, name in figures]
    (KEPT / command).write_text("".join(lines))


def record(command, figures):
    """Keep the figures of a command, and print them."""
    keep(command, figures)
    show(command, figures)


def kept():
    """command -> its figures, as they were measured last."""
    return {path.name: [(float(value), unit, name) for _, value, unit, name in read(path)[1]]
            for path in sorted(KEPT.glob("*"))}


def measured():
    """(command, name) -> value, as they were measured last."""
    return {(command, name): value for command, rows in kept().items() for value, _, name in rows}


def show_goals():
    released, now = figures_of(RELEASE), measured()
    print(f"\n{'what has a goal (tests/figures/goals.txt)':62}{'goal':>20}{'release':>14}{'now':>14}")
    for goal in read_goals():
        key = (goal.command, goal.name)
        print(f"  {goal.what:60}{goal_text(goal, now.get(key)):>20}{text(released.get(key)) or '-':>14}"
              f"{text(now.get(key)) or 'make ' + goal.command:>14}  {goal.unit}")


def keep_now():
    """Of the commands that did not run, this version's figures stay as they are."""
    now = {**figures_of(NOW), **measured()}
    rows = [f"{goal.command} {now[key]:.10g} {goal.unit} {goal.name}\n" for goal in read_goals()
            if (key := (goal.command, goal.name)) in now]
    NOW.write_text("".join(line + "\n" for line in read(NOW)[0]) + "".join(rows))


def readme_table():
    """The lines of the table. A goal that is missed has its figure in bold type."""
    released, now = figures_of(RELEASE), figures_of(NOW)
    lines = ["| what | unit | goal | release | now | `make` |", "|---|---|---|---|---|---|"]
    for goal in read_goals():
        key = (goal.command, goal.name)
        value = text(now.get(key)) or "-"
        value = value if key not in now or goal.is_met(now[key]) else f"**{value}**"
        sense = "at most" if goal.sense == "<=" else "at least"
        lines.append(f"| {goal.what} | {goal.unit} | {sense} {text(goal.limit)} | {text(released.get(key)) or '-'} | "
                     f"{value} | `{goal.command}` |")
    return lines


def with_table(page):
    """A page with the table between its two marks made anew."""
    before, _, rest = page.partition(BEGIN + "\n")
    _, _, after = rest.partition(END)
    return before + BEGIN + "\n" + "\n".join(readme_table()) + "\n" + END + after


def write_readme():
    README.write_text(with_table(README.read_text()))


def release():
    remarks = "".join(line + "\n" for line in read(RELEASE)[0])
    RELEASE.write_text(remarks + "".join((KEPT / command).read_text() for command in kept()))


def main():
    words = sys.argv[1:]
    if words == ["--release"]:
        release()
    elif words == ["--goals"]:
        show_goals()
    elif words in (["--now"], ["--readme"]):
        if words == ["--now"]:
            keep_now()
        write_readme()
    elif words:
        rows = [line.split(maxsplit=2) for line in sys.stdin.read().splitlines()]
        (keep if words[0] == "--keep" else record)(words[-1], [(float(value), unit, name) for value, unit, name in rows])
    else:
        for command, figures in kept().items():
            show(command, figures)
    return 0


if __name__ == "__main__":
    sys.exit(main())
