"""The board's memory, stack and instructions: what the compiler promises, and what a flight shows."""
import sys
from pathlib import Path

import bench
import machine
import memory
from tap import Tap

FLIGHT = machine.BUILD / "tmp/flight"  # test_flight.py made its image and scenario
WORK = machine.BUILD / "tmp/memory"
PIXEL_MOST, LINE_MOST = 84, 20000  # the goals are 80 and 20,000 (docs/zcu102.md)


def count():
    chips = machine.split_flash(FLIGHT / "whole/image.lmdb", WORK)
    modes, lines = bench.run(WORK, chips, FLIGHT / "whole/scenario.bin")
    for chip in chips:
        chip.unlink()
    return modes, lines


def main():
    tap = Tap()
    why = machine.missing()
    if why:
        tap.skip("the board's memory and instructions are within their budgets", why)
        return tap.end()
    if not (FLIGHT / "whole/scenario.bin").exists():
        tap.ok("test_flight has run before, whose flight this takes", False)
        return tap.end()
    chain, interrupt, cycles = memory.stacks()
    tap.ok("no function of the image calls itself, drivers and ports included", not cycles, *cycles)
    for what, size, most in memory.budgets(memory.sizes(), chain):
        tap.ok(f"{what} fits its budget", 0 < size <= most, f"{size} of {most}")
        tap.note(f"{what}: {size} of {most} bytes")
    tap.ok("the deepest interrupt fits the exceptions' stack", interrupt[0] <= memory.sizes()["exception stack"][1])
    painted = int(next(line for line in (FLIGHT / "whole/console").read_text().splitlines()
                       if line.startswith("stack-used")).split()[1])
    computed = memory.stacks("flight")[0]
    tap.ok("the stack painted in flight is as deep as computed, or less", painted <= computed[0], painted, computed)
    tap.ok("and not by much: the computed chain is the one that runs", painted * 2 > computed[0], painted, computed)
    modes, lines = count()
    tap.ok("the instructions of a flight can be counted", 0 in modes and bench.FINER in modes, *lines[-5:])
    tap.ok("they are the same to the digit in a second run", count()[1] == lines)
    for mode, what, most_us in ((0, "line", bench.LINE_BUDGET_US), (0, "lm_tile_cache_service", bench.LINE_BUDGET_US),
                                (bench.FINER, "line", bench.LINE_BUDGET_US),
                                (bench.FINER, "lm_tile_cache_service", bench.LINE_BUDGET_US)):
        worst = modes[mode][what][2]
        tap.ok(f"{bench.MODES[mode]}: the worst {what} fits {most_us} us at 100 MIPS", worst < most_us * bench.MIPS, worst)
        tap.note(f"{bench.MODES[mode]}: worst {what} {worst} instructions")
    for mode in (0, bench.FINER):
        worst = max(modes[mode][what][2] for what in ("step", "frame-step"))
        tap.ok(f"{bench.MODES[mode]}: no step takes longer than a line, with a frame or without",
               worst < bench.LINE_BUDGET_US * bench.MIPS, worst)
    pixel = bench.a_line(modes[bench.FINER], bench.PATCH_STAGES)[0] / bench.PATCH_CELLS
    tap.ok(f"a pixel of a patch finer than the map takes {PIXEL_MOST} instructions at most", pixel <= PIXEL_MOST, pixel)
    tap.note(f"a pixel of a patch finer than the map: {pixel:.1f} instructions")
    line = bench.a_line(modes[0], bench.SECTOR_STAGES)[0]
    tap.ok(f"a line of GM takes {LINE_MOST} instructions at most", line <= LINE_MOST, line)
    tap.note(f"a line of GM: {line:.0f} instructions")
    return tap.end()


sys.exit(main())
