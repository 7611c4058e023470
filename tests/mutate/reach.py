"""Which test runs which line of firmware/ and fixed/: a test that never runs a line cannot notice a change of it.

Each program is linked once more, with the sources of both layers compiled by clang to count what they run, and is run
once. What it ran is kept in BUILD/mutate/reach until the program or the source changes. A program is counted when an
error first asks for it. Of a line without code, such as a row of a table, nothing is known, and where clang is missing
nothing is known of any: then every program that links the file may notice.
"""
import hashlib
import json
import shutil
import subprocess
import threading
from pathlib import Path

import programs

CLANG, PROFDATA, COV = "clang-19", "llvm-profdata-19", "llvm-cov-19"
LAYERS = ("fixed/", "firmware/")
KEPT = ("-I", "-D", "-std", "-m", "-iquote")


def digest(data):
    return hashlib.sha256(data).hexdigest()


def lines_of_segments(segments, count):
    """({lines that were run}, {lines that have code}) of 1..count, by the segments of llvm-cov export.

    A segment holds from its place to the next. A line was run if any segment on it was, or the one it begins in.
    """
    run, known = set(), set()
    places = [*segments, [count + 1, 1, 0, False, False, False]]
    for (line, _, times, has_count, *_), (next_line, next_column, *_) in zip(places, places[1:]):
        if has_count:
            last = min(count, next_line if next_column > 1 else next_line - 1)
            known.update(range(line, last + 1))
            if times > 0:
                run.update(range(line, last + 1))
    return run, known


class Reach:
    def __init__(self, build, scratch):
        self.build, self.folder = build, Path(scratch, "reach")
        self.is_able = all(shutil.which(tool) for tool in (CLANG, PROFDATA, COV))
        self.lock, self.locks, self.archive = threading.Lock(), {}, None
        self.maps, self.code = {}, {}  # program -> what it ran; source -> its lines that have code

    # ---- objects that count ----

    def _compile(self, source):
        """The object of a source that counts; None where clang refuses it."""
        words = self.build.compiles[source].get(f"{self.build.folder}/{source[:-2]}.o")
        if not words:
            return None
        target = self.folder / "counted" / (source[:-2].replace("/", "-") + ".o")
        keep = [word for word in words if word.startswith(KEPT)]
        done = subprocess.run([CLANG, *keep, "-O2", "-w", "-fprofile-instr-generate", "-fcoverage-mapping", "-c", source,
                               "-o", str(target)], capture_output=True)
        return str(target) if done.returncode == 0 else None

    def _counted(self):
        """An archive of them all, made once."""
        with self.lock:
            if not self.archive:
                place = self.folder / "counted"
                shutil.rmtree(place, ignore_errors=True)
                place.mkdir(parents=True)
                objects = [self._compile(source) for source in sorted(self.build.compiles) if source.startswith(LAYERS)]
                self.archive = place / "libcounted.a"
                subprocess.run(["ar", "rcs", str(self.archive), *filter(None, objects)], check=True)
        return self.archive

    # ---- what a program ran ----

    def _link(self, program, output):
        words = list(self.build.links[program])
        words[-1] = str(output)
        words.insert(words.index("-Wl,--start-group") + 1, str(self._counted()))
        runtime = subprocess.run([CLANG, "-print-file-name=libclang_rt.profile-x86_64.a"], check=True,
                                 capture_output=True, text=True).stdout.strip()
        words[-2:-2] = ["-Wl,-u,__llvm_profile_runtime", runtime]
        subprocess.run(words, check=True, capture_output=True)

    def _count(self, program, place):
        """{source: what of it the program ran}; None where it does not pass when it counts."""
        counting = place / "counting"
        shutil.rmtree(counting, ignore_errors=True)
        counting.mkdir()
        output = counting / "program"
        try:
            self._link(program, output)
            verdict, seconds = programs.run(
                output, place, 900, self.build.is_sanitized(program), programs.is_golden(program),
                {"LLVM_PROFILE_FILE": str(counting / "%p.profraw")})
            if verdict:
                return None
            merged = counting / "profdata"
            subprocess.run([PROFDATA, "merge", "-sparse", *counting.glob("*.profraw"), "-o", merged], check=True,
                           capture_output=True)
            told = subprocess.run([COV, "export", "-skip-functions", "-skip-branches", "-instr-profile", merged, output],
                                  check=True, capture_output=True).stdout
        except subprocess.CalledProcessError:
            return None
        found = {}
        for file in json.loads(told)["data"][0]["files"]:
            source = file["filename"].removeprefix(f"{Path.cwd()}/")
            if source.startswith(LAYERS) and source.endswith(".c"):
                text = Path(source).read_bytes()
                run, known = lines_of_segments(file["segments"], text.count(b"\n"))
                found[source] = {"digest": digest(text), "run": sorted(run), "known": sorted(known)}
        shutil.rmtree(counting)
        return {"seconds": seconds, "files": found}

    def _map(self, program, place):
        """What is known of a program: as it was kept, or counted now."""
        with self.lock:
            mine = self.locks.setdefault(program, threading.Lock())
        with mine:
            if program not in self.maps:
                kept = self.folder / (program.removeprefix(f"{self.build.folder}/bin/").replace("/", "-") + ".json")
                now = digest(Path(program).read_bytes())
                told = json.loads(kept.read_text()) if kept.exists() else {}
                if told.get("program") != now or any(digest(Path(source).read_bytes()) != file["digest"] for source, file
                                                     in (told["map"] or {"files": {}})["files"].items()):
                    told = {"program": now, "map": self._count(program, place)}
                    kept.parent.mkdir(parents=True, exist_ok=True)
                    kept.write_text(json.dumps(told))
                self.maps[program] = told["map"]
                if told["map"]:
                    self.build.counted_seconds[program] = told["map"]["seconds"]
            return self.maps[program]

    def may_run(self, program, source, lines, place):
        """Whether a program may run any of these lines of a source: yes where nothing is known of them all."""
        if not self.is_able or not self._has_code(source, lines):
            return True
        told = self._map(program, place)
        file = told["files"].get(source) if told else None
        if not file:
            return True
        self.code[source] = set(file["known"])
        return not self._has_code(source, lines) or any(line in file["run"] for line in lines)

    def _has_code(self, source, lines):
        """Whether any of the lines has code, as far as a program that was counted has told."""
        return source not in self.code or any(line in self.code[source] for line in lines)
