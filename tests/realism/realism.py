"""How real the pictures are: one table of measures, each with its yardstick, the real value and ours.

    realism.py            print the table
    realism.py --tap      the same as a test, in TAP form: a measure on the list OPEN may miss its yardstick
    realism.py --only NAME...
                          print the rows of these functions of measures.py
    realism.py --sheet    print the table and leave the sheet of real radar beside ours in build/gallery

BUILD is the folder of the build, LANDMASS_DATA that of the shared data. A measure whose data are absent is skipped.
"""
import concurrent.futures
import os
import sys
import textwrap
import time
import traceback

import measures
import real_data
import scenes

# Measures whose yardstick is not reached. One that is not on the list must reach its yardstick, and one that does is to
# be taken off. Beside one that went back stands why.
OPEN = set()


def take(measure, world, real):
    """One measure: its row, or the reason why it is skipped."""
    try:
        return measure[2](world, real)
    except measures.Skip as reason:
        return reason
    except Exception as fault:  # the others are still worth having; the run fails
        traceback.print_exc()
        return fault


def verdict(row):
    if isinstance(row, Exception):
        return "skipped" if isinstance(row, measures.Skip) else "broken"
    return "-" if row.reached is None else "reached" if row.reached else "not reached"


def print_table(rows):
    """The table as Markdown, as docs/realism.md has it."""
    print("| report, issue | measure | yardstick | real | ours | null model | |")
    print("|---|---|---|---|---|---|---|")
    for (ref, name, _), row in rows:
        if isinstance(row, Exception):
            print(f"| {ref} | {name} | | | | | {verdict(row)}: {row} |")
        else:
            print(f"| {ref} | {name} | {row.yardstick} | {row.real} | {row.ours} | {row.null} | {verdict(row)} |")
    said = [verdict(row) for _, row in rows]
    print(f"\n{said.count('reached')} reached, {said.count('not reached')} not reached, {said.count('-')} without a "
          f"yardstick, {said.count('skipped')} skipped")


def print_tap(rows):
    """A test a measure. Returns the number of failures."""
    failures = 0
    for number, ((_, name, function), row) in enumerate(rows, 1):
        said, is_open = verdict(row), function.__name__ in OPEN
        if said == "skipped":
            print(f"ok {number} - {name} # SKIP\n# skipped: {row}")
            continue
        if said == "broken":
            print(f"not ok {number} - {name}: {row!r}")
            failures += 1
            continue
        is_good = said != "not reached" or is_open
        failures += not is_good
        remark = ", which is open" if said == "not reached" and is_open else ""
        print(f"{'ok' if is_good else 'not ok'} {number} - {name}: {said}{remark}")
        print(textwrap.indent(f"yardstick {row.yardstick}; real {row.real}; ours {row.ours}; null {row.null}", "# "))
        if said == "reached" and is_open:
            print(f"# {function.__name__} is reached: take it off the list OPEN of tests/realism/realism.py")
    print(f"1..{len(rows)}")
    return failures


def main():
    started = time.monotonic()
    data = scenes.find_data()
    world = scenes.Scenes(os.environ.get("BUILD", "build/bench-linux"), data)
    real = real_data.Real(data)
    unknown = set(OPEN) - {function.__name__ for _, _, function in measures.MEASURES}
    if unknown:
        sys.exit(f"realism: OPEN names what is no measure: {', '.join(sorted(unknown))}")
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        names = ["builtin", "yard", "plain", "sea"]
        names += [name for name, file in (("orihuela", scenes.S2), ("hawaii", scenes.DTED[0])) if world.has(file)]
        list(pool.map(world.image, names))
    only = sys.argv[sys.argv.index("--only") + 1:] if "--only" in sys.argv else []
    wanted = [m for m in measures.MEASURES if not only or m[2].__name__ in only]
    rows = []
    for measure in wanted:
        begun = time.monotonic()
        rows.append((measure, take(measure, world, real)))
        if os.environ.get("REALISM_TIMES"):
            print(f"# {measure[2].__name__}: {time.monotonic() - begun:.1f} s", file=sys.stderr)
    if "--tap" in sys.argv:
        failures = print_tap(rows)
        print(f"# took {time.monotonic() - started:.0f} s")
        return 1 if failures else 0
    print_table(rows)
    if "--sheet" in sys.argv:
        import sheet
        print("\nsheet: " + str(sheet.make(world, real)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
