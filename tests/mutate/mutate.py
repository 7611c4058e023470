"""Plants small errors in the firmware, one at a time, and asks whether any test notices.

    mutate.py BUILD --commands FILE [--mutants N] [--seed S] [--only PATH ...] [--kind KIND ...]
              [--planted FILE] [--jobs N] [--minutes M] [--least PERCENT]

Draws N changes of one token, evenly over the files of firmware and fixed (tables, the font and vector twins excepted);
those that the compiler refuses, or of which it makes the same object, are drawn anew. Each is compiled in a folder of
its own, linked into the tests that run its line (reach.py), and these are run, the cheapest first, until one fails; one
that takes too long or too much memory has failed. Prints a table by room and the survivors, which it leaves in
BUILD/mutate, too. The tree is never written to.

--planted reads changes from a file of blocks instead of drawing them: path, lines "- as it is", "+ as it would be".
tests/mutate/judged.txt has blocks of survivors that change nothing, or nothing that can be seen, with the reason.
Ends with 1 if less than --least percent of what could be seen is caught.
"""
import argparse
import difflib
import random
import re
import sys
import threading
import time
from pathlib import Path
from typing import NamedTuple

import changes
import programs
import reach

JUDGED = Path("tests/mutate/judged.txt")
WITHOUT = {"firmware/base/font.c", "firmware/table/radar.c"}
VERDICTS = ("equivalent", "unobservable")


class Mutant(NamedTuple):
    source: str
    text: str  # of the whole file, changed
    line: int
    old: str
    new: str
    kind: str


class Result(NamedTuple):
    mutant: Mutant
    verdict: str  # "caught", "survived", or one of VERDICTS
    by: str
    programs: int


def flat(text):
    return " ".join(text.split())


def lines_run(mutant):
    """The lines of which one must be run for a change to matter. What a label `case` picks, its `switch` runs."""
    lines = range(mutant.line, mutant.line + max(1, len(mutant.old.splitlines())))
    if not re.search(r"\bcase\b", mutant.old):
        return lines
    text = Path(mutant.source).read_text().splitlines()
    return [n for n in range(1, mutant.line + 1) if re.search(r"\bswitch \(", text[n - 1])][-1:] or lines


def read_blocks(path):
    """(source, old, new, what follows) of each block of a file."""
    for block in path.read_text().split("\n\n"):
        lines = [line for line in block.splitlines() if line.strip() and not line.startswith("#")]
        if lines:
            old = [line[2:] for line in lines[1:] if line.startswith("- ")]
            new = [line[2:] for line in lines[1:] if line.startswith("+ ")]
            rest = [line for line in lines[1:] if line[:2] not in ("- ", "+ ")]
            yield lines[0].strip(), "\n".join(old), "\n".join(new), " ".join(rest)


def read_judged():
    """(source, old, new) -> verdict, without regard to blanks."""
    judged = {}
    for source, old, new, reason in read_blocks(JUDGED) if JUDGED.exists() else ():
        verdict = reason.split(":")[0].strip()
        if verdict not in VERDICTS or ":" not in reason:
            sys.exit(f"mutants: {JUDGED}: {source}: \"{reason}\": wanted one of {', '.join(VERDICTS)}, a colon, a reason")
        judged[source, flat(old), flat(new)] = verdict
    return judged


def planted(path):
    """The mutants of a file of blocks; each old text must stand in its source, and once."""
    for source, old, new, _ in read_blocks(path):
        text = Path(source).read_text() if Path(source).exists() else ""
        lines, wanted = text.splitlines(), [flat(line) for line in old.splitlines()]
        starts = [i for i in range(len(lines)) if [flat(line) for line in lines[i: i + len(wanted)]] == wanted]
        if len(starts) != 1:
            sys.exit(f"mutants: {path}: {source}: \"{flat(old)}\" stands there {len(starts)} times, not once")
        lines[starts[0]: starts[0] + len(wanted)] = new.splitlines()
        yield Mutant(source, "\n".join(lines) + "\n", starts[0] + 1, old, new, "planted")


def sources(build, only):
    found = [source for source in sorted(build.compiles)
             if source.startswith(("firmware/", "fixed/src/")) and Path(source).exists() and source not in WITHOUT]
    return [s for s in found if not only or any(s.startswith(start) for start in only)]


def drawn(paths, kinds, seed):
    """Without an end: the files in turn, the kinds evenly within a file, each change once."""
    rng, seen, empty = random.Random(seed), set(), set()
    found = {path: [c for c in changes.changes(Path(path).read_text()) if not kinds or c.kind in kinds] for path in paths}
    while len(empty) < len(paths):
        for path in rng.sample(paths, len(paths)):
            left = [change for change in found[path] if (path, change) not in seen]
            if not left:
                empty.add(path)
                continue
            kind = rng.choice(sorted({change.kind for change in left}))
            change = rng.choice([change for change in left if change.kind == kind])
            seen.add((path, change))
            text = Path(path).read_text()
            yield Mutant(path, change.apply(text), *changes.lines_of(text, change), kind)


class Campaign:
    """Mutants from a source of them, judged by as many workers as asked for."""

    def __init__(self, build, mutants, count, minutes):
        self.build, self.mutants, self.wanted = build, mutants, count
        self.reach = reach.Reach(build, build.scratch)
        self.ends = time.monotonic() + 60 * minutes
        self.judged, self.results, self.same, self.failure = read_judged(), [], 0, None
        self.draw_lock, self.print_lock = threading.Lock(), threading.Lock()
        self.plain = {}

    def _plain_object(self, source, is_sanitized, place):
        key = source, is_sanitized
        if key not in self.plain:
            built = self.build.compile(source, Path(source).read_text(), is_sanitized, place / "plain")
            self.plain[key] = built.read_bytes() if built else None
        return self.plain[key]

    def _next(self, place):
        """A mutant whose object differs, and that object; None at the end."""
        while not self.failure and self.wanted > 0 and time.monotonic() < self.ends:
            mutant = next(self.mutants, None)
            if mutant is None:
                return None
            target = self.build.compile(mutant.source, mutant.text, False, place / "changed")
            if target and target.read_bytes() != self._plain_object(mutant.source, False, place):
                self.wanted -= 1
                return mutant, target
            self.same += 1
            if mutant.kind == "planted":
                print(f"no change  {mutant.source}:{mutant.line} {flat(mutant.new)}", flush=True)
        return None

    def _judge(self, mutant, target, place):
        """The result; None where the time is up before it is known."""
        verdict = self.judged.get((mutant.source, flat(mutant.old), flat(mutant.new)))
        if verdict:
            return Result(mutant, verdict, "", 0)
        lines, number = lines_run(mutant), 0
        for test in self.build.programs_of(mutant.source):
            if time.monotonic() >= self.ends:
                return None
            if not self.reach.may_run(test, mutant.source, lines, place):
                continue
            number += 1
            is_sanitized, with_object = self.build.is_sanitized(test), target
            if is_sanitized:
                with_object = self.build.compile(mutant.source, mutant.text, True, place / "changed")
            program = self.build.link(test, with_object, place)
            limit = self.build.limit_seconds(test)
            failure, _ = programs.run(program, place, limit, is_sanitized, programs.is_golden(test))
            if failure:
                self.build.check_plain(test, place)
                self.build.caught(mutant.source, test)
                return Result(mutant, "caught", f"{Path(test).name}: {failure}", number)
        return Result(mutant, "survived", "" if number else "no test runs it", number)

    def work(self, place):
        try:
            while True:
                with self.draw_lock:
                    found = self._next(place)
                if not found:
                    return
                result = self._judge(*found, place)
                with self.print_lock:
                    self.results.extend([result] if result else [])
                    tell(result or Result(found[0], "unfinished", "", 0))
        except BaseException as failure:  # also SystemExit: the other workers must end, too
            self.failure = failure


def tell(result):
    m = result.mutant
    print(f"{result.verdict:10}  {m.source}:{m.line} ({m.kind}, {result.programs} tests)  {result.by}"[:160], flush=True)
    if result.verdict == "survived":
        print(diff(m), flush=True)


def diff(mutant):
    return "\n".join(line for line in difflib.ndiff(mutant.old.splitlines(), mutant.new.splitlines())
                     if not line.startswith("?"))


def room(source):
    parts = source.split("/")
    return "fixed" if parts[0] == "fixed" else parts[1]


def percent(part, whole):
    return f"{100 * part / whole:.0f} %" if whole else "-"


def print_table(results):
    rooms = sorted({room(r.mutant.source) for r in results})
    heads = ("run", "caught", "survived", *VERDICTS, "score", "without judged")
    print(f"\n{'room':16}" + "".join(f"{head:>15}" for head in heads))
    for name in [*rooms, "all"]:
        of = [r.verdict for r in results if name in ("all", room(r.mutant.source))]
        caught, survived = of.count("caught"), of.count("survived")
        judged = [of.count(verdict) for verdict in VERDICTS]
        print(f"{name:16}" + "".join(f"{n:15}" for n in (len(of), caught, survived, *judged)) +
              f"{percent(caught, len(of)):>15}{percent(caught, caught + survived):>15}")


def write_survivors(results, path):
    """As blocks, so that --planted can take them again, or judged.txt with a reason."""
    survivors = [r.mutant for r in results if r.verdict == "survived"]
    path.write_text("".join(
        f"{m.source}\n" + "".join(f"- {line}\n" for line in m.old.splitlines()) +
        "".join(f"+ {line}\n" for line in m.new.splitlines()) + f"# line {m.line}, {m.kind}\n\n"
        for m in sorted(survivors)))


def arguments():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1].strip())
    parser.add_argument("build")
    parser.add_argument("--commands", type=Path, required=True)
    parser.add_argument("--mutants", type=int, default=100)
    parser.add_argument("--seed", default=None)
    parser.add_argument("--only", nargs="*", default=[])
    parser.add_argument("--kind", nargs="*", default=[])
    parser.add_argument("--planted", type=Path)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=1e6)
    parser.add_argument("--least", type=float, default=0)
    return parser.parse_args()


def main():
    asked = arguments()
    scratch = Path(asked.build, "mutate")
    scratch.mkdir(parents=True, exist_ok=True)
    build = programs.Build(asked.build, scratch, asked.commands.read_text())
    if not build.links:
        sys.exit(f"mutants: {asked.commands} links no test of {asked.build}")
    seed = asked.seed or str(random.SystemRandom().randrange(10**6))
    paths = sources(build, asked.only)
    mutants = planted(asked.planted) if asked.planted else drawn(paths, asked.kind, seed)
    print(f"seed {seed}, {len(paths)} files, {len(build.links)} tests", flush=True)
    campaign = Campaign(build, mutants, 10**9 if asked.planted else asked.mutants, asked.minutes)
    workers = [threading.Thread(target=campaign.work, args=(programs.make_place(asked.build, scratch / f"worker-{n}"),))
               for n in range(asked.jobs)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    if campaign.failure:
        raise campaign.failure
    print_table(campaign.results)
    print(f"{campaign.same} more were no C or made the same object")
    write_survivors(campaign.results, scratch / "survivors.txt")
    verdicts = [r.verdict for r in campaign.results]
    visible = verdicts.count("caught") + verdicts.count("survived")
    has_enough = visible > 0 and 100 * verdicts.count("caught") >= asked.least * visible
    print(f"{int(has_enough)} passed, {int(not has_enough)} failed, 0 skipped")
    return 0 if has_enough else 1


if __name__ == "__main__":
    sys.exit(main())
