"""How make compiles each source and links each test, and how a test is run with one object of another make.

Make is asked what it would do (`make -n -B V=1`), and its commands are run with the source and the output named anew:
neither the tree nor its build folder is written to.
"""
import json
import os
import re
import resource
import shlex
import signal
import subprocess
import threading
from pathlib import Path

MEMORY_BYTES = 2 << 30
LINK_SECONDS = 0.1
PICTURES = Path("tests/golden/pictures.golden")
QUIET = {**os.environ, "CCACHE_DISABLE": "1"}


class Build:
    def __init__(self, folder, scratch, commands):
        self.folder, self.scratch = Path(folder), Path(scratch)
        self.compiles, self.links = {}, {}
        for line in commands.splitlines():
            words = shlex.split(line) if re.search(r" -o \S+$", line) else []
            if "-c" in words:
                self.compiles.setdefault(words[words.index("-c") + 1], {})[words[-1]] = words
            elif words and words[-1].startswith(f"{folder}/bin/tests/"):
                self.links[words[-1]] = words
        self.symbols = {program: self._globals(program) for program in self.links}
        self.counted_seconds, self.catches = {}, {}  # of a run that counted; (source, program) -> errors it caught
        known = self.scratch / "times.json"
        self.times = json.loads(known.read_text()) if known.exists() else {}
        self.lock = threading.Lock()

    def _globals(self, path):
        listed = subprocess.run(["nm", "--defined-only", "--extern-only", "--format=posix", path], check=True,
                                capture_output=True, text=True).stdout
        return {line.split()[0] for line in listed.splitlines() if line[-1] != ":"}

    # ---- objects ----

    def _object(self, source, is_sanitized):
        place = "sanitized/" if is_sanitized else ""
        return f"{self.folder}/{place}{source[:-2]}.o"

    def compile(self, source, text, is_sanitized, folder):
        """The object of `text` in the place of `source`, without debug information; None where it is no C."""
        words = self.compiles.get(source, {}).get(self._object(source, is_sanitized))
        if not words:
            return None
        folder.mkdir(parents=True, exist_ok=True)
        changed, target = folder / Path(source).name, folder / (Path(source).stem + (".sane.o" if is_sanitized else ".o"))
        changed.write_text(text)
        keep = [word for word in words[: words.index("-c")] if word not in ("-MMD", "-MP", "-g", "-Werror")]
        command = [*keep, "-w", "-g0", "-iquote", str(Path(source).parent), "-c", str(changed), "-o", str(target)]
        done = subprocess.run(command, capture_output=True, env=QUIET)
        return target if done.returncode == 0 else None

    # ---- programs ----

    def programs_of(self, source):
        """Tests that link a source, the cheapest first; those of its own folder, and those that caught errors, sooner."""
        own = self._globals(self._object(source, False))
        linking = [p for p, symbols in self.symbols.items() if own & symbols]
        room = f"/{Path(source).parent}/".replace("/fixed/src/", "/fixed/")

        def cost(program):
            share = (0.1 if room in program else 1) / (1 + self.catches.get((source, program), 0))
            return (LINK_SECONDS + self.seconds(program)) * share, program
        return sorted(linking, key=cost)

    def caught(self, source, program):
        with self.lock:
            self.catches[source, program] = self.catches.get((source, program), 0) + 1

    def _key(self, program):
        return f"{program} {Path(program).stat().st_mtime_ns}"

    def seconds(self, program):
        """What a test took here, or else while it counted, or else with tests/run.sh, or else a guess."""
        log = self.folder / "test-logs" / program.removeprefix(f"{self.folder}/bin/").replace("/", "-")
        if self._key(program) in self.times:
            return self.times[self._key(program)]
        if program in self.counted_seconds:
            return self.counted_seconds[program]
        return float(log.with_suffix(".seconds").read_text()) if log.with_suffix(".seconds").exists() else 5.0

    def limit_seconds(self, program):
        is_known = self._key(program) in self.times or (program in self.counted_seconds and not self.is_sanitized(program))
        return max(4.0, 5 * self.seconds(program)) + (0 if is_known else 60)

    def check_plain(self, program, place):
        """A test that fails catches nothing by failing: run it once as it is."""
        key = self._key(program)
        if key in self.times:
            return
        verdict, seconds = run(program, place, 900, self.is_sanitized(program), is_golden(program))
        if verdict:
            raise SystemExit(f"mutants: {program} fails without any change ({verdict}): build and mend it first")
        with self.lock:
            self.times[key] = round(seconds, 2)
            (self.scratch / "times.json").write_text(json.dumps(self.times, indent=0))

    def link(self, program, target, place):
        """The program with this object before the archives, so that no archive's member is taken in its place."""
        words = list(self.links[program])
        output = place / "program"
        words[-1] = str(output)
        words.insert(words.index("-Wl,--start-group"), str(target))
        words.insert(1, "-Wl,--strip-debug")
        done = subprocess.run(words, capture_output=True, text=True, env=QUIET)
        if done.returncode:
            raise SystemExit(f"mutants: {program} does not link: {done.stderr[-400:]}")
        return output

    def is_sanitized(self, program):
        return any("/sanitized/lib" in word for word in self.links[program])


def make_place(folder, path):
    """A folder where a test may write, which looks like the build's to it."""
    path.mkdir(parents=True, exist_ok=True)
    (path / "tmp").mkdir(exist_ok=True)
    for name in ("bin", "gen"):
        if not (path / name).is_symlink():
            (path / name).symlink_to(Path(folder, name).resolve())
    return path


def is_golden(program):
    return Path(program).name == "golden"


def run(program, place, limit_seconds, is_sanitized=False, has_pictures=False, more={}):
    """("" if the program passed or else what ended it, its seconds of processor). Ends at the first failure."""
    def bound():
        os.setsid()
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_CPU, (int(limit_seconds) + 1, int(limit_seconds) + 5))
        resource.setrlimit(resource.RLIMIT_FSIZE, (MEMORY_BYTES, MEMORY_BYTES))
        if not is_sanitized:  # the sanitizers' shadow is larger than any limit, and little of it is used
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))

    # The seed of make mutants draws errors; tests that know a SEED draw what they do by default.
    environment = {**os.environ, "CMOCKA_MESSAGE_OUTPUT": "TAP", "BUILD": str(place), **more,
                   "ASAN_OPTIONS": f"hard_rss_limit_mb={MEMORY_BYTES >> 20}"}
    environment.pop("SEED", None)
    process = subprocess.Popen([str(program)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, errors="replace",
                               stderr=subprocess.DEVNULL, env=environment, preexec_fn=bound)
    late = threading.Timer(20 * limit_seconds, os.killpg, (process.pid, signal.SIGKILL))  # waits for what never comes
    late.start()
    verdict, said = "", []
    for line in process.stdout:
        said.append(line)
        if line.startswith("not ok") and "# SKIP" not in line:
            verdict = line.strip()
            os.killpg(process.pid, signal.SIGKILL)
            break
    process.stdout.close()
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = status
    late.cancel()
    if not verdict and status:
        is_late = os.WIFSIGNALED(status) and os.WTERMSIG(status) in (signal.SIGXCPU, signal.SIGKILL)
        verdict = "time" if is_late else f"ended with status {os.waitstatus_to_exitcode(status)}"
    if not verdict and has_pictures and "".join(said) != PICTURES.read_text():
        verdict = "the pictures differ"
    return verdict, used.ru_utime + used.ru_stime
