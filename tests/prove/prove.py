"""Proves what tests/prove/*.c state, with the model checker CBMC, and shows that each proof can fail.

    python3 -B tests/prove/prove.py BUILD [--quick] [--plants] [--tap] [--list] [NAME...]

A file NAME.c has functions that begin with prove_; NAME.proof beside it says with which sources and options each is
checked, and which planted bugs must make it fail:

    source FILE...                compiled together with NAME.c; generated ones are found in BUILD/gen
    options OPTION...             of CBMC, for all proofs of the file
    proof FUNCTION [quick] [OPTION...]
    plant FUNCTION FILE           an edit of one line of FILE, which FUNCTION must not survive
    - the line as it is
    + the line that replaces it
    smaller FILE                  an edit as that of `plant`, for every proof of the file: a table of fewer rows

NAME on the command line is a file's, or FILE.FUNCTION without its prove_. One proof runs at a time, with 3 GB and
PROVE_TIMEOUT seconds of the processor (900). Exit status 0 iff all hold, or, with --plants, all fail.
"""
import argparse
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
CHECKS = ["--bounds-check", "--pointer-check", "--pointer-primitive-check", "--pointer-overflow-check",
          "--div-by-zero-check", "--signed-overflow-check", "--undefined-shift-check", "--unwinding-assertions"]
MEMORY_BYTES = 3 << 30
TIMEOUT_S = int(os.environ.get("PROVE_TIMEOUT", "900"))


class Proof:
    def __init__(self, file, function, options, is_quick):
        self.file, self.function, self.options, self.is_quick = file, function, options, is_quick
        self.plants = []
        self.name = f"{file.name}.{function.removeprefix('prove_')}"


class File:
    """NAME.proof, read. Every mistake in it is an error that names the line."""

    def __init__(self, path):
        self.name, self.path = path.stem, path
        self.sources, self.options, self.proofs, self.smaller = [], [], {}, []
        lines = path.read_text().splitlines()
        number = 0
        while number < len(lines):
            words = lines[number].split("#")[0].split()
            number += 1
            if not words:
                continue
            if words[0] == "source":
                self.sources += words[1:]
            elif words[0] == "options":
                self.options += words[1:]
            elif words[0] == "proof" and len(words) > 1:
                is_quick = words[2:3] == ["quick"]
                self.proofs[words[1]] = Proof(self, words[1], words[3 if is_quick else 2:], is_quick)
            elif words[0] == "plant" and len(words) == 3 and words[1] in self.proofs and self.is_edit(lines, number):
                self.proofs[words[1]].plants.append(self.edit(words[2], lines, number))
                number += 2
            elif words[0] == "smaller" and len(words) == 2 and self.is_edit(lines, number):
                self.smaller.append(self.edit(words[1], lines, number))
                number += 2
            else:
                sys.exit(f"prove: {path}:{number}: not understood: {lines[number - 1]}")
        self.check_functions()

    @staticmethod
    def is_edit(lines, number):
        return len(lines) > number + 1 and lines[number].startswith("- ") and lines[number + 1].startswith("+ ")

    @staticmethod
    def edit(file, lines, number):
        return file, lines[number][2:].strip(), lines[number + 1][2:].strip()

    def check_functions(self):
        there = set(re.findall(r"^void (prove_\w+)\(", (HERE / f"{self.name}.c").read_text(), re.M))
        if there != set(self.proofs):
            odd = ", ".join(sorted(there ^ set(self.proofs)))
            sys.exit(f"prove: {self.path}: {self.name}.c and this file differ about {odd}")


def command(proof, build):
    """CBMC's command, to be run in a tree that looks like the project's."""
    rooms = sorted(str(p.relative_to(ROOT)) for p in ROOT.glob("firmware/*/include"))
    includes = [f"-I{d}" for d in [".", "tests/prove", "fixed/include", "drivers/include", *rooms]]
    sources = []
    for source in proof.file.sources:
        sources.append(source if (ROOT / source).exists() else str((ROOT / build / "gen" / source).resolve()))
    return ["cbmc", f"tests/prove/{proof.file.name}.c", *sources, "--function", proof.function, *includes, *CHECKS,
            "--drop-unused-functions", "--slice-formula", "--verbosity", "4", *proof.options, *proof.file.options]


def limits():
    os.nice(10)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
    resource.setrlimit(resource.RLIMIT_CPU, (TIMEOUT_S, TIMEOUT_S + 1))


def processor_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Result:
    properties, all_s = 0, 0.0  # of all results so far

    def __init__(self, proof, build, tree):
        begin = processor_s()
        done = subprocess.run(command(proof, build), cwd=tree, capture_output=True, text=True, preexec_fn=limits)
        self.output = done.stdout + done.stderr
        if done.returncode < 0:
            self.output += f"no answer in {TIMEOUT_S} s of the processor"
        self.seconds = processor_s() - begin
        Result.all_s += self.seconds
        self.findings = re.findall(r"^\[.*: FAILURE$", self.output, re.M)
        self.failed = len(self.findings)
        self.checked = self.failed + len(re.findall(r"^\[.*: SUCCESS$", self.output, re.M))
        Result.properties += self.checked
        self.holds = self.checked > 0 and self.failed == 0 and "VERIFICATION SUCCESSFUL" in self.output
        self.is_refuted = self.failed > 0

    def cause(self):
        return "every property holds" if self.holds else "\n".join(self.findings[:20]) or self.output[-2000:]


def report(result, name, is_good, said, is_tap, number):
    if is_tap:
        print(f"{'ok' if is_good else 'not ok'} {number} - {name}: {said}")
    else:
        print(f"{name:<44} {said:<36} {result.seconds:7.1f} s", flush=True)
    if not is_good:
        print("\n".join("# " + line for line in result.cause().splitlines()), flush=True)


def change_line(edit, folder):
    file, old, new = edit
    lines = (folder / file).read_text().splitlines()
    where = [i for i, line in enumerate(lines) if line.strip() == old]
    if len(where) != 1:
        sys.exit(f"prove: {file} has this line {len(where)} times, and an edit needs it once: {old}")
    lines[where[0]] = new
    (folder / file).write_text("\n".join(lines) + "\n")


def result_with(proof, edits, build):
    """The result in a copy of the sources with some lines changed."""
    with tempfile.TemporaryDirectory(prefix="prove-") as name:
        folder = Path(name)
        for part in ("firmware", "fixed", "drivers", "tests/prove"):
            shutil.copytree(ROOT / part, folder / part)
        for edit in edits:
            change_line(edit, folder)
        return Result(proof, build, folder)


def prove(proof, build, is_tap, number):
    result = result_with(proof, proof.file.smaller, build) if proof.file.smaller else Result(proof, build, ROOT)
    said = f"{result.checked} properties hold" if result.holds else f"{result.failed} of {result.checked} FAILED"
    report(result, proof.name, result.holds, said, is_tap, number)
    return result.holds


def plant(proof, edit, build, is_tap, number):
    result = result_with(proof, [*proof.file.smaller, edit], build)
    said = f"{result.failed} fail with" if result.is_refuted else "SURVIVES or no answer:"
    report(result, f"{proof.name}", result.is_refuted, f"{said} {edit[2]}", is_tap, number)
    return result.is_refuted


def is_named(proof, names):
    return not names or any(name in (proof.file.name, proof.name) for name in names)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("build", help="build folder, for generated sources")
    options.add_argument("--quick", action="store_true", help="only what takes seconds")
    options.add_argument("--plants", action="store_true", help="the planted bugs instead of the proofs")
    options.add_argument("--tap", action="store_true", help="print as a test program does")
    options.add_argument("--list", action="store_true", help="print the proofs, and run none")
    options.add_argument("name", nargs="*")
    asked = options.parse_intermixed_args()
    proofs = [proof for path in sorted(HERE.glob("*.proof")) for proof in File(path).proofs.values()]
    proofs = [p for p in proofs if is_named(p, asked.name) and (p.is_quick or not asked.quick)]
    if not proofs:
        sys.exit("prove: there is no proof of this name; --list prints all")
    if asked.list:
        for p in proofs:
            print(f"{p.name:<44} {'quick' if p.is_quick else '':<6} {len(p.plants)} planted")
        return 0
    if shutil.which("cbmc") is None:
        print("# skipped: proofs need cbmc, which Debian has from 13 on" if asked.tap else
              "prove: skipped: there is no cbmc on PATH; Debian has it from 13 on")
        print("ok 1 # SKIP proofs" if asked.tap else "0 proved, 0 failed, 1 skipped")
        return 0
    jobs = [(plant, p, e) for p in proofs for e in p.plants] if asked.plants else [(prove, p) for p in proofs]
    failed = sum(not job(*what, asked.build, asked.tap, n) for n, (job, *what) in enumerate(jobs, 1))
    if not asked.tap:
        print(f"{len(jobs) - failed} {'bugs found' if asked.plants else 'proved'}, {failed} failed; "
              f"{Result.properties} properties, {Result.all_s:.0f} s of a processor")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
