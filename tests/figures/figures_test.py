"""The list of goals, what the commands measure, and the table of README.md belong together; so do the code and what is
argued of its coverage. Prints TAP."""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "zcu102"))
import coverage  # noqa: E402
import figures  # noqa: E402
from tap import Tap  # noqa: E402

# Who measures what has a goal: the figure's name, or the end of it, stands there in quotes.
MEASURED_BY = {"bench": ["tests/bench/bench.sh", "tests/bench/host.py"], "bench-zcu102": ["tests/zcu102/bench.py"],
               "bench-m7": ["tests/cortex-m7/bench.sh"],
               "run": ["Makefile"], "check": ["Makefile"]}


def is_measured(goal):
    sources = "".join(Path(name).read_text() for name in MEASURED_BY[goal.command])
    last = goal.name.split(", ", 1)[-1]
    return goal.name in sources or f", {last}" in sources


def check_goals(tap, goals):
    targets = set(re.findall(r"^([a-z0-9-]+):", Path("Makefile").read_text(), re.M))
    strangers = [goal.command for goal in goals if goal.command not in targets or goal.command not in MEASURED_BY]
    tap.ok("each goal's command is a target of make", not strangers, *strangers)
    tap.ok("a goal is a most or a least", all(goal.sense in ("<=", ">=") for goal in goals))
    lost = [goal.name for goal in goals if goal.command in MEASURED_BY and not is_measured(goal)]
    tap.ok("each goal's figure is one that its command keeps", not lost, *lost)
    tap.ok("no goal stands twice", len({goal[:1] + goal[4:5] for goal in goals}) == len(goals))


def check_now(tap, goals):
    units = {(goal.command, goal.name): goal.unit for goal in goals}
    for path in (figures.RELEASE, figures.NOW):
        rows = figures.read(path)[1]
        other = [name for command, _, unit, name in rows if units.get((command, name), unit) != unit]
        tap.ok(f"{path.name}: what has a goal has the goal's unit", not other, *other)
    aimless = [name for command, _, _, name in figures.read(figures.NOW)[1] if (command, name) not in units]
    tap.ok("this version's figures all have goals", not aimless, *aimless)


def check_readme(tap):
    page = figures.README.read_text()
    tap.ok("README.md has the table once", page.count(figures.BEGIN) == 1 and page.count(figures.END) == 1)
    tap.ok("and it is that of the list: figures.py --readme changes nothing", figures.with_table(page) == page)
    changed = page.replace("at most", "at moist", 1)
    tap.ok("a table that differs is seen", changed != page and figures.with_table(changed) == page)


def check_columns(tap, goals):
    """Three columns of one figure, as a command prints them."""
    goal = goals[0]
    for value, verdict in ((goal.limit, ""), (goal.limit + 1, " missed")):
        wanted = f"{goal.sense} {figures.text(goal.limit)}{verdict}"
        tap.ok(f"{value:g} of {goal.limit:g} is told as '{wanted}'", figures.goal_text(goal, value) == wanted)
    code = f"import figures; figures.show({goal.command!r}, [({goal.limit + 1!r}, {goal.unit!r}, {goal.name!r})])"
    out = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True, check=True,
                         env={"PYTHONPATH": str(Path(__file__).parent)}).stdout
    row = next((line for line in out.splitlines() if goal.name in line), "")
    released = figures.figures_of(figures.RELEASE)[goal.command, goal.name]
    tap.ok("its row has goal, last release and now, in this order",
           re.search(rf"{goal.limit:g} missed +{re.escape(figures.text(released))} +{goal.limit + 1:g}", row), row or out)


def check_arguments(tap):
    entries = coverage.arguments()
    there = {path: coverage.Source(Path("build"), path) for path, _, _ in entries if Path(path).exists()}
    lost = [f"{path}: {code}" for path, code, reason in entries
            if not reason or path not in there or coverage.argued_span(code, there[path]) is None]
    tap.ok("each argument is about code that stands once in its file, and says why", not lost, *lost)


CODE = """int f(int a, int b)
{
    return a > 0 &&
           b > 0;
}
int g(int b) { return b > 0; }
"""


def settled(folder, entries, offsets):
    """What is left, argued and wrong of places of CODE, by these entries."""
    path = folder / "f.c"
    path.write_text(CODE)
    coverage.ARGUED = folder / "argued.txt"
    coverage.ARGUED.write_text(entries.replace("FILE", str(path)))
    return coverage.settle({str(path): [(offset, "never true") for offset in offsets]},
                           {str(path): coverage.Source(folder, path)})


def check_settling(tap):
    at = CODE.index("b > 0;")
    entry = "FILE: a > 0 && `b > 0`;\n    b is 7\n"
    before = coverage.ARGUED
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        left, argued, wrong = settled(folder, entry, [at])
        tap.ok("a place is argued by its code, however its lines are broken",
               not left and not wrong and len(argued) == 1 and "f.c:4:12: never true" in argued[0][1], left, argued, wrong)
        left, argued, wrong = settled(folder, entry, [at, CODE.index("a > 0")])
        tap.ok("the code around it is not", len(left) == 1 and len(argued) == 1 and not wrong, left, argued, wrong)
        for what, entries in (("is reached", entry), ("has no reason", entry.split("\n", 1)[0]),
                              ("is there twice", "FILE: `b > 0`;\n    why\n"),
                              ("is not there", "FILE: `c > 0`;\n    why\n")):
            places = [] if what == "is reached" else [at]
            left, argued, wrong = settled(folder, entries, places)
            tap.ok(f"an argument about code that {what} is told", len(wrong) == 1 and len(left) == len(places), wrong)
    coverage.ARGUED = before


def main():
    tap = Tap()
    goals = figures.read_goals()
    check_goals(tap, goals)
    check_now(tap, goals)
    check_readme(tap)
    check_columns(tap, goals)
    check_arguments(tap)
    check_settling(tap)
    return tap.end()


if __name__ == "__main__":
    sys.exit(main())
