"""The estimate of cycles: its pipeline and its plugin on what is known, and what it says where something is missing."""
import re
import shutil
import subprocess
import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parent.parent)]
import cycles  # noqa: E402
import machine  # noqa: E402
from tap import Tap  # noqa: E402

WORK = machine.BUILD / "tmp/cycles"
ELF = machine.BUILD / "bench.elf"


def says(call, *words):
    """True if the call ends in Trouble whose words have all of `words`."""
    try:
        call()
    except cycles.Trouble as trouble:
        return all(word in str(trouble) for word in words)
    return False


def pipeline(tap):
    chain, busy = cycles.ask_mca(["mul x0, x0, x1"] * 100)
    apart, _ = cycles.ask_mca([f"add x{i % 8}, x9, x10" for i in range(100)])
    tap.ok("a chain of products waits for each of them", chain >= 300, chain)
    tap.ok("sums that are independent go two at a time", apart <= 60, apart)
    tap.ok("and are bound by being issued", cycles.pipeline_bound(100, apart, {"ALU": 50}) == "issue")
    tap.ok("the chain is bound by its results", cycles.pipeline_bound(100, chain, busy) == "waiting for results", busy)
    tap.ok("100 loads are bound by their unit", cycles.pipeline_bound(100, 100, {"LdSt": 100}) == "load and store")
    calls, _ = cycles.ask_mca(["bl ."] * 100)
    tap.ok("a call takes what a jump takes: what is called is counted itself", calls < 250, calls)
    tap.ok("an instruction that is none is refused",
           says(lambda: cycles.ask_mca(["frobnicate x0"]), cycles.MCA, "frobnicate"))


def cachegrind(program, rounds):
    """Misses of data reads of a run: (of the first cache, of both)."""
    out = subprocess.run(["valgrind", "--tool=cachegrind", "--cache-sim=yes", "--cachegrind-out-file=/dev/null",
                          "--I1=32768,2,64", "--D1=32768,4,64", "--LL=1048576,16,64", program, "touch", str(rounds)],
                         capture_output=True, text=True, check=True).stderr
    return [int(re.search(rf"{name} +misses: +[\d,]+ +\( *([\d,]+) rd", out).group(1).replace(",", ""))
            for name in ("D1", "LLd")]


def caches(tap):
    """The difference of two runs is what the rounds between them miss, without the program's beginning and end."""
    program = machine.TOOLS / "strides"
    model = [list(map(int, cycles.run([program, "model", rounds]).split())) for rounds in (1, 6)]
    judge = [cachegrind(program, rounds) for rounds in (1, 6)]
    for level, name in enumerate(("first cache", "both caches")):
        ours, theirs = (runs[1][level] - runs[0][level] for runs in (model, judge))
        tap.ok(f"{name} miss as cachegrind says, within a thousandth", abs(ours - theirs) <= theirs / 1000, ours, theirs)
        tap.note(f"{name}: {ours} misses of 100,000 reads, by cachegrind {theirs}")


def image(tap):
    plan, names = cycles.make_plan(ELF)
    tap.ok("the plan has the hot stages", {"scan_line_run", "illuminate", "layover_run"} <= set(names), names)
    tap.ok("an image that is not there is named", says(lambda: cycles.make_plan(WORK / "none.elf"), "none.elf", "make"))
    product = machine.BUILD / "landmass.elf"
    tap.ok("an image without the instrument is refused by the symbol that it lacks",
           says(lambda: cycles.make_plan(product), "landmass.elf", "instrument_leave"))
    code = cycles.Code(ELF)
    tap.ok("an address outside of the image is named", says(lambda: cycles.pipeline(code, [4]), "0x4"))
    loops = {code.function[head] for head in code.loop.values() if head in code.function}
    tap.ok("the kernels' loops are found", {"lm_k_light", "lm_k_tile_read", "lm_k_layover"} <= loops)
    kernels = [address for address in code.text if code.function[address].startswith("lm_k_")]
    taken = cycles.pipeline(code, kernels)
    tap.ok("the pipeline takes all instructions of the kernels", taken[0] > len(kernels) / 2 > 2000, taken[0])
    return plan


def start(tap):
    """The bench without a scenario: it starts, says that there is none, and ends."""
    stages, names, console = cycles.fly(ELF, None, None, WORK)
    tap.ok("it says so", any("no scenario" in line for line in console), *console)
    tap.ok("a flight without lines is refused",
           says(lambda: cycles.lines_of(stages, names, 0), "no line was drawn", "GM NORM"))
    counted = (WORK / "counted").read_text().splitlines() if (WORK / "counted").exists() else []
    sums = [list(map(int, line.split()[1:])) for line in counted if line.startswith("sum")]
    tap.ok("the plugin has counted what ran outside of all stages", any(row[1] == 0 and row[3] > 10000 for row in sums), sums)
    tap.ok("with fewer misses than accesses, fewer of them far, and fewer beside another than misses",
           bool(sums) and all(row[a] >= row[a + 1] >= max(row[a + 2], row[a + 3]) for row in sums for a in (4, 9)), sums)


def plugin_says(plan, *words):
    (WORK / "wrong").write_text(plan)
    out = subprocess.run(["timeout", "20", machine.QEMU, "-M", "xlnx-zcu102", "-display", "none", "-monitor", "none",
                          "-serial", "null", "-plugin", f"{cycles.PLUGIN},plan={WORK}/wrong,out={WORK}/none",
                          "-kernel", str(ELF)], capture_output=True, text=True, stdin=subprocess.DEVNULL, check=False)
    return out.returncode not in (0, 124) and all(word in out.stderr for word in words)


def main():
    tap = Tap()
    lacking = [tool for tool in (cycles.MCA, cycles.OBJDUMP, "valgrind") if shutil.which(tool) is None]
    why = machine.missing() or (f"{lacking[0]} is not installed (make deps)" if lacking else None)
    if why:
        tap.skip("the cycles of a flight can be estimated", why)
        return tap.end()
    WORK.mkdir(parents=True, exist_ok=True)
    pipeline(tap)
    caches(tap)
    plan = image(tap)
    start(tap)
    tap.ok("the plugin refuses a plan with a line that is none", plugin_says("nonsense 1 2\n", "wrong", "nonsense"))
    tap.ok("and one with more stages than it has room for", plugin_says("stage 4 0\n" * 100, "stage 4"))
    tap.ok("the plan of the image fits", len(plan) < 110, len(plan))
    return tap.end()


sys.exit(main())
