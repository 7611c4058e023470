"""Estimates the cycles of a flight on the board: what the Cortex-A53 takes for a stage, and what bounds it.

    cycles.py --db FILE --bus FILE.log --script FILE --seconds S --out DIR

QEMU flies bench.elf with the plugin of this folder, which counts instructions, misses of the caches' model, and records
samples of what is executed, by mode and stage. llvm-mca runs those samples through its model of the pipeline. The
figures are the same in each run. docs/zcu102.md says what they do not hold."""
import os
import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent))
import bench  # noqa: E402
import fly as pilot  # noqa: E402
import machine  # noqa: E402

MCA = os.environ.get("LLVM_MCA", "llvm-mca-19")
OBJDUMP = os.environ.get("LLVM_OBJDUMP", "llvm-objdump-19")
CORE, OTHER_CORE = "cortex-a53", "cortex-a55"
PLUGIN = Path(os.environ.get("BUILD", "build/bench-linux")) / "bin/tests/zcu102/cycles_plugin.so"
MHZ = 1200
# What a miss costs. Hennessy and Patterson, Computer Architecture, 6th edition, 2.6: 13 cycles from the second level.
# Memory: 58 ns, as measured on Cortex-A53 at 1.25 GHz with LPDDR4-1600 (TI, AM62x Linux Performance Guide 10.0,
# lat_mem_rd-stride128-sz1000k, twice the second level).
NEAR_CYCLES, FAR_CYCLES = 13, 70
LINE = 64
MODES = {0: "GM NORM", bench.PATCH: bench.MODES[bench.PATCH], bench.FINER: bench.MODES[bench.FINER]}
DRAWN = {0: "lm_sector_draw_line", bench.PATCH: "lm_sar_draw_line", bench.FINER: "lm_sar_draw_line"}
CALLS = "-call-latency=1"  # what is called is in the trace; llvm-mca would take 100 cycles for it
LEAST_SHARE = 0.01
LOOPS_SHOWN = 8
PIECES = 8
TRACE_MOST = 16000  # instructions of a stage that are run through the pipeline
BUSY = 0.85  # of the cycles: what is busy for as much bounds the rest
ISSUED = 2   # instructions a cycle
REMARK = re.compile(r"\s*(//|<).*")
PLACE = re.compile(r"(?<=\s)0x[0-9a-f]+$")  # of code or data: a number has a # before it
JUMPS = re.compile(r"(b|b\.\w+|cbn?z|tbn?z)\s")


class Trouble(Exception):
    """Something that the estimate needs is not there: file, cause and remedy in words."""


def run(command, **options):
    try:
        return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=True, **options).stdout
    except FileNotFoundError as error:
        raise Trouble(f"{command[0]} is not installed (make deps)") from error
    except subprocess.CalledProcessError as error:
        raise Trouble(f"{command[0]} failed: {error.stderr.strip()[:400]}") from error


def symbols(elf):
    if not Path(elf).exists():
        raise Trouble(f"{elf} is not there (make BOARD=zcu102 all)")
    return {name: int(value, 16) for value, name in
            re.findall(r"^([0-9a-f]+) \w (\S+)$", run(["aarch64-linux-gnu-nm", elf]), re.M)}


def make_plan(elf):
    """(the plugin's lines, the stages' names behind "outside"). A symbol that is missing is Trouble."""
    at = symbols(elf)
    stages = sorted((address, name) for name, address in at.items() if name.startswith("__wrap_"))
    needed = ("instrument_leave", "instrument_modes_set", "__shared_start", "__shared_end")
    for name in needed:
        if name not in at:
            raise Trouble(f"{elf} has no symbol {name}, which tells where counting begins and ends "
                          "(tests/zcu102/images/instrument.c)")
    if not stages:
        raise Trouble(f"{elf} has no stages (__wrap_*): it was not linked as bench.elf is (tests/zcu102/images)")
    plan = [f"stage {address:x} 0" for address, _ in stages]
    plan += [f"leave {at['instrument_leave']:x} 0", f"modes {at['instrument_modes_set']:x} {bench.FINER + 3:x}",
             f"shared {at['__shared_start']:x} {at['__shared_end'] - at['__shared_start']:x}"]
    listing = Path(f"{elf}.map").read_text()
    own = re.findall(r"^ \.text\S*\s+0x([0-9a-f]+)\s+0x([0-9a-f]+) \S*(?:images/instrument|/stages)\.o$", listing, re.M)
    plan += [f"skip {int(start, 16):x} {int(size, 16):x}" for start, size in own if int(size, 16)]
    return plan, ["outside"] + [name.removeprefix("__wrap_lm_") for _, name in stages]


class Code:
    """The instructions of an image by address, as llvm-mca reads them, and its innermost loops."""

    def __init__(self, elf):
        self.text, self.jump, self.function = {}, {}, {}
        name = "?"
        for line in run([OBJDUMP, "-d", "--no-show-raw-insn", "--mcpu=" + CORE, elf]).splitlines():
            head = re.match(r"[0-9a-f]+ <(\S+)>:$", line)
            if head:
                name = head.group(1)
                continue
            found = re.match(r"\s*([0-9a-f]+):\s+(\S.*)$", line)
            if found and not found.group(2).startswith((".", "udf")):  # constants among the code
                self.add(int(found.group(1), 16), found.group(2), name)
        self.loop = self.find_loops()

    def add(self, address, text, function):
        text = REMARK.sub("", text).strip()
        place = PLACE.search(text)
        if place and JUMPS.match(text):
            self.jump[address] = int(place.group(0), 16)
        self.text[address] = PLACE.sub(".", text)
        self.function[address] = function

    def find_loops(self):
        """address -> head of the innermost loop, which is what lies between a jump back and its target."""
        loops = sorted(((end - head, head, end) for end, head in self.jump.items()
                        if head <= end and self.function.get(head) == self.function[end]), reverse=True)
        loop = {}
        for _, head, end in loops:  # the longest first, so that what lies inside remains
            loop.update((address, head) for address in range(head, end + 4, 4))
        return loop


def pipeline(code, addresses, core=CORE):
    """(cycles, {unit: busy cycles}) of instructions in this order, each with its operands in the first cache."""
    missing = next((address for address in addresses if address not in code.text), None)
    if missing is not None:
        raise Trouble(f"an instruction at {missing:#x} was executed that the image does not have")
    return ask_mca([code.text[address] for address in addresses], core)


def ask_mca(instructions, core=CORE):
    """The same of instructions as text."""
    answer = run([MCA, "-mtriple=aarch64", f"-mcpu={core}", "-iterations=1", "-instruction-info=0", CALLS, "-"],
                 input="\n".join(instructions) + "\n")
    numbers = dict(re.findall(r"^(Instructions|Total Cycles): +(\d+)$", answer, re.M))
    if int(numbers["Instructions"]) != len(instructions):
        raise Trouble(f"{MCA} took {numbers['Instructions']} of {len(instructions)} instructions")
    units = [(number, re.sub(r"^CortexA\d+Unit|^A53Unit", "", unit))
             for number, unit in re.findall(r"^\[([\d.]+)\] +- (\w+)", answer, re.M)]
    pressure = re.search(r"^Resource pressure per iteration:\n.*\n(.*)$", answer, re.M).group(1).split()
    busy = defaultdict(float)
    for (_, unit), cycles in zip(units, pressure):
        busy[unit] = max(busy[unit], 0.0 if cycles == "-" else float(cycles))
    return int(numbers["Total Cycles"]), busy


UNITS = {"LdSt": "load and store", "FPALU": "vector unit", "FPMDS": "vector unit", "MAC": "multiplier", "ALU": "integer units",
         "Div": "divider", "B": "branches"}


def pipeline_bound(instructions, cycles, busy):
    """What keeps the pipeline from being faster: issuing, a unit, or waiting for results."""
    most, unit = max((used, name) for name, used in busy.items()) if busy else (0, "")
    if instructions / ISSUED >= BUSY * cycles and instructions / ISSUED >= most:
        return "issue"
    return UNITS.get(unit, unit) if most >= BUSY * cycles else "waiting for results"


class Stage:
    """What a stage took itself in a mode."""

    def __init__(self, words):
        self.calls, self.instructions = words[0], words[1]
        (_, self.fetch_misses, self.fetch_next, self.fetch_far, _) = words[2:7]
        (self.accesses, self.misses, self.next, self.far, self.far_next) = words[7:12]
        self.shared = words[12]
        self.trace = []
        self.cycles = self.other_cycles = None

    def fetch_cycles(self):
        return self.fetch_misses * NEAR_CYCLES + self.fetch_far * FAR_CYCLES

    def memory_cycles(self):
        return self.misses * NEAR_CYCLES + self.far * FAR_CYCLES

    def least_memory_cycles(self):
        """If every miss beside one before it was fetched ahead in time."""
        return (self.misses - self.next) * NEAR_CYCLES + (self.far - self.far_next) * FAR_CYCLES

    def all_cycles(self):
        return self.cycles + self.fetch_cycles() + self.memory_cycles()

    def bound(self):
        return max((self.cycles, "compute"), (self.fetch_cycles(), "fetch"), (self.memory_cycles(), "memory"))[1]


def in_pieces(trace):
    """TRACE_MOST instructions of it at most, in pieces from its beginning to its end."""
    if len(trace) <= TRACE_MOST:
        return trace
    piece, apart = TRACE_MOST // PIECES, len(trace) // PIECES
    return [address for i in range(PIECES) for address in trace[i * apart:i * apart + piece]]


def read_output(path):
    """(mode, stage number) -> Stage; of those of MODES, with the trace as addresses."""
    blocks, stages = {}, {}
    for line in Path(path).read_text().splitlines():
        words = line.split()
        if words[0] == "block":
            blocks[int(words[1])] = (int(words[2], 16), int(words[3]))
        elif words[0] == "sum":
            stages[int(words[1]), int(words[2])] = Stage(list(map(int, words[3:])))
        elif words[0] == "trace" and int(words[1]) in MODES:
            trace = stages[int(words[1]), int(words[2])].trace
            for index in words[3:]:
                start, count = blocks[int(index)]
                trace.extend(range(start, start + 4 * count, 4))
            stages[int(words[1]), int(words[2])].trace = in_pieces(trace)
    if not any(mode in MODES for mode, _ in stages):
        raise Trouble(f"{path} has no counts of a mode: the flight was too short")
    return stages


def fly(elf, db, scenario, out):
    """Fly with the plugin: (stages, their names, the console). The folder keeps the plan and what the plugin wrote."""
    plan, names = make_plan(elf)
    out.mkdir(parents=True, exist_ok=True)
    (out / "plan").write_text("\n".join(plan) + "\n")
    counted = out / "counted"
    counted.unlink(missing_ok=True)
    if not PLUGIN.exists():
        raise Trouble(f"{PLUGIN} is not there (make cycles builds it)")
    chips = machine.split_flash(db, out) if db else []
    memory = [("scenario", scenario)] if scenario else []
    try:
        m = machine.Machine(elf, out, chips, memory, limit=1200,
                            options=("-no-reboot", "-plugin", f"{PLUGIN},plan={out}/plan,out={counted}"))
        with m:
            m.run()
    except (OSError, ValueError) as error:
        raise Trouble(f"QEMU ended early: {(out / 'qemu.log').read_text().strip()[-400:]}") from error
    finally:
        for chip in chips:
            chip.unlink()
    if not counted.exists():
        raise Trouble(f"QEMU's plugin wrote nothing: {(out / 'qemu.log').read_text().strip()[-400:]}")
    return read_output(counted), names, m.lines


def in_lines(console):
    """{(mode, name): instructions in lines} as bench.elf counted them; what paints belongs to them."""
    rows = (line.split() for line in console if line.startswith("stage "))
    return {(int(row[1]), row[2].removeprefix("lm_")): int(row[4] if row[2].startswith("lm_scan_conv") else row[6])
            for row in rows if len(row) == 7}


def estimate(code, stages, names, of_lines):
    """mode -> [(name, Stage)], the most cycles first; what has no trace, or little to do, is left out."""
    modes = {}
    for mode in MODES:
        rows = []
        own = {names[number]: stage for (m, number), stage in stages.items()
               if m == mode and 2 * of_lines.get((m, names[number]), 0) > stage.instructions}
        whole = sum(stage.instructions for stage in own.values())
        for name, stage in own.items():
            if stage.instructions < LEAST_SHARE * whole or not stage.trace:
                continue
            scale = stage.instructions / len(stage.trace)
            cycles, stage.busy = pipeline(code, stage.trace)
            stage.cycles = cycles * scale
            stage.other_cycles = pipeline(code, stage.trace, OTHER_CORE)[0] * scale
            stage.pipeline = pipeline_bound(len(stage.trace), cycles, stage.busy)
            rows.append((name, stage))
        modes[mode] = sorted(rows, key=lambda row: -row[1].all_cycles())
    return modes


def lines_of(stages, names, mode):
    number = names.index(DRAWN[mode].removeprefix("lm_"))
    if (mode, number) not in stages:
        raise Trouble(f"no line was drawn in {MODES[mode]}: the flight has another script")
    return stages[mode, number].calls


WIDTHS = (9, 9, 9, 9, 9, 7, 7, 9, 9)


def figures_of(s):
    """What a row of the table shows of a stage."""
    return [s.instructions, s.cycles, s.other_cycles, s.misses, s.next, s.far, s.fetch_misses, s.all_cycles(),
            s.all_cycles() * 1000 / MHZ]


def print_row(name, figures, each, remark):
    shown = "".join(f"{figure / each:{width},.{1 if each > 5000 else 0}f}" for figure, width in zip(figures, WIDTHS))
    print(f"  {name:24}{shown}  {remark}")


def print_stages(name, rows, each, unit):
    print(f"\n{name}, {unit}: cycles of the pipeline by two models, misses of the caches, both together at {MHZ / 1000:.1f} GHz")
    print(f"  {'':24}" + "".join(f"{title:>{width}}" for title, width in zip(
        ("instr.", "A53", "A55", "misses", "in row", "far", "fetch", "cycles", "ns"), WIDTHS)) + "  bound by")
    for stage_name, s in rows:
        bound = s.bound()
        print_row(stage_name, figures_of(s), each, f"{bound}{': ' + s.pipeline if bound == 'compute' else ''}")
    whole = [sum(column) for column in zip(*(figures_of(s) for _, s in rows))]
    least = sum(s.cycles + s.fetch_cycles() + s.least_memory_cycles() for _, s in rows)
    print_row("all", whole, each, f"{least / each:,.1f} cycles if all misses in a row are fetched ahead")


def hot_loops(code, rows):
    """[(instructions of the trace, head, iterations, addresses, stage)] of the innermost loops."""
    loops = defaultdict(list)
    for name, stage in rows:
        weight = stage.instructions / len(stage.trace)
        for address in stage.trace:
            head = code.loop.get(address)
            if head is not None:
                loops[name, head, weight].append(address)
    found = [(len(a) * weight, head, a.count(head), a, name) for (name, head, weight), a in loops.items() if a.count(head)]
    return sorted(found, reverse=True)[:LOOPS_SHOWN]


def print_loops(code, rows, elf):
    print(f"\n  {'loop':44}{'instr.':>8}{'A53':>8}{'A55':>8}  an iteration, bound by")
    for _, head, turns, addresses, _ in hot_loops(code, rows):
        place = run(["aarch64-linux-gnu-addr2line", "-s", "-e", elf, f"{head:#x}"]).split()[0]
        cycles, busy = pipeline(code, addresses)
        other, _ = pipeline(code, addresses, OTHER_CORE)
        print(f"  {code.function[head] + ' ' + place:44}{len(addresses) / turns:8.1f}{cycles / turns:8.1f}{other / turns:8.1f}"
              f"  {pipeline_bound(len(addresses), cycles, busy)}")


def main():
    o = bench.read_options(__doc__)
    why = machine.missing()
    elf = machine.BUILD / "bench.elf"
    try:
        if why:
            raise Trouble(why)
        code = Code(elf)
        stages, names, console = fly(elf, o.db, pilot.make_scenario(o.out, o.bus, o.script, o.seconds), Path(o.out))
        for mode, rows in estimate(code, stages, names, in_lines(console)).items():
            lines = lines_of(stages, names, mode)
            a_pixel = mode >= bench.PATCH
            print_stages(MODES[mode], rows, lines * bench.PATCH_CELLS if a_pixel else lines,
                         "a pixel" if a_pixel else "a line")
            print_loops(code, rows, elf)
    except Trouble as trouble:
        print(f"cycles: {trouble}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
