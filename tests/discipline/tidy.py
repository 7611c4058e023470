"""Asks clang-tidy about every source that make would compile, tests excepted.

    make -Bn CC=clang-19 O=BUILD lint-build | python3 tidy.py BUILD

The commands of make tell which flags a source has. One that clang-tidy passed is asked again when its object, and so
the source or a header that it includes, has become newer, or .clang-tidy has. Ends with 1 if there is a finding.
"""
import concurrent.futures
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path


# Up to how many states of a function the analyzer follows: its default is 225,000, and it then takes five times as long. Of
# 29 errors planted in the middle of as many sources (a null pointer, a division by zero, a leak) both find the same 18, and
# so does 40,000.
STATES = ["-Xclang", "-analyzer-config", "-Xclang", "max-nodes=50000"]


def compilations(lines):
    """(source, object, flags) of each compiling command."""
    for line in lines.replace("\\\n", " ").splitlines():
        words = shlex.split(line) if " -c " in line else []
        if "-c" in words and "-o" in words:
            source, target = words[words.index("-c") + 1], words[words.index("-o") + 1]
            yield source, target, [word for word in words[1:] if word.startswith(("-I", "-D", "-f", "-std", "-O"))]


def is_known(stamp, target):
    paths = [stamp, Path(target), Path(".clang-tidy")]
    return all(path.exists() for path in paths) and stamp.stat().st_mtime >= max(p.stat().st_mtime for p in paths)


def plain_object(build, source):
    """A source may be compiled for tests, or for a program that makes sources, once more and in other ways."""
    return f"{build}/{source[:-len('.c')]}.o"


def ask(build, source, target, flags):
    """The findings, or "" when there are none."""
    stamp = Path(build) / "tidy" / (source + ".ok")
    if is_known(stamp, target):
        return ""
    if source.startswith("host-sim/") and not source.startswith("host-sim/lib/"):
        flags = [*flags, "-include", "tests/discipline/analyzer.h"]
    answer = subprocess.run(["clang-tidy", "--quiet", source, "--", *flags, *STATES], capture_output=True, text=True)
    if answer.returncode == 0:
        stamp.parent.mkdir(parents=True, exist_ok=True)
        stamp.touch()
        return ""
    return answer.stdout or answer.stderr


def main():
    build = sys.argv[1]
    jobs = {}
    for job in compilations(sys.stdin.read()):
        source, target, _ = job
        if not source.startswith(("tests/", "build/")) and (source not in jobs or target == plain_object(build, source)):
            jobs[source] = job
    if not jobs:
        print("make names no source to compile")
        return 1
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        answers = list(pool.map(lambda job: ask(build, *job), jobs.values()))
    print("".join(answers), end="")
    return 1 if any(answers) else 0


if __name__ == "__main__":
    sys.exit(main())
