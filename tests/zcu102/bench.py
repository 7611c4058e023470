"""Counts the instructions of a flight on the board and prints them by stage.

    bench.py --db FILE --bus FILE.log --script FILE --seconds S --out DIR

QEMU counts every instruction as one nanosecond; one core runs, without interrupts and without waiting, so that the
figures are the same to the digit in each run. It counts instructions and not cycles: caches, memory and flash cost
nothing. Nothing here passes or fails."""
import argparse
import sys
from pathlib import Path

import fly
import machine

sys.path.insert(0, str(Path(__file__).parent.parent / "figures"))
import figures  # noqa: E402

LINE_BUDGET_US = 3900  # a line of the fastest sweep, 256 of them in a second
MIPS = 100
# As bench.c numbers them: enum lm_sector_mode times enum lm_fov, and behind them the patches.
SECTORS = [f"{mode} {field}" for mode in ("GM", "GMT", "SEA", "BCN") for field in ("NORM", "EXP", "DBS1", "DBS2")]
MODES = dict(enumerate(SECTORS + ["SAR patch", "SAR patch finer than the map", "a track held"]))
PATCH = len(SECTORS)
FINER = PATCH + 1
PATCH_CELLS = 256
PATCH_PX = 549  # of a patch's side on the glass of 768 x 768: lm_frame_of_display
TILE_BYTES = 17472


def value(lines, name):
    """The number that the board printed behind `name`."""
    return next(int(words[1]) for words in map(str.split, lines) if len(words) == 2 and words[0] == name)


def run(out, chips, scenario):
    """mode -> name -> (calls, instructions, most, own), and the lines of the console."""
    m = machine.Machine(machine.BUILD / "bench.elf", out, chips, [("scenario", scenario)], options=("-no-reboot",),
                        limit=600)
    with m:
        m.run()
    modes = {}
    for line in m.lines:
        words = line.split()
        if len(words) == 7 and words[0] == "stage":
            modes.setdefault(int(words[1]), {})[words[2]] = tuple(map(int, words[3:]))
    return modes, m.lines


def print_mode(name, stages):
    lines = stages.get("line", (0, 0, 0))[0]
    print(f"\n{name}: {lines} lines")
    print(f"  {'':34}{'a line':>10}{'a call':>10}{'worst call':>12}{'calls':>9}")
    for stage, (calls, instructions, most, _) in sorted(stages.items(), key=lambda item: -item[1][1]):
        per_line = f"{instructions / lines:10,.0f}" if lines else f"{'':10}"
        print(f"  {stage.removeprefix('lm_'):34}{per_line}{instructions / calls:10,.0f}{most:12,}{calls:9,}")


LEAST_SHARE = 0.005


def own_costs(stages):
    """[(instructions a line, stage)] of what a line takes from the map to its grey, without the stages that a stage
    calls; the most first, and the rest in one."""
    lines = stages["line"][0]
    costs = sorted(((own / lines, stage.removeprefix("lm_")) for stage, (_, _, _, own) in stages.items()
                    if stage.startswith("lm_")), reverse=True)
    whole = sum(own for own, _ in costs)
    shown = [(own, stage) for own, stage in costs if own >= LEAST_SHARE * whole]
    return shown + [(whole - sum(own for own, _ in shown), "all others")], whole


def print_own(modes):
    """A table for each of the goals: a line's cells are 256."""
    for mode in (0, PATCH, FINER):
        costs, whole = own_costs(modes[mode])
        print(f"\n{MODES[mode]}, each stage without those that it calls")
        print(f"  {'':34}{'a line':>10}{'a pixel':>10}")
        for own, stage in costs + [(whole, "all")]:
            print(f"  {stage:34}{own:10,.0f}{own / PATCH_CELLS:10.1f}")


def print_line_budget(modes):
    print(f"\na line's budget at {MIPS} MIPS: {LINE_BUDGET_US} us, {LINE_BUDGET_US * MIPS:,} instructions")
    for mode, stages in sorted(modes.items()):
        for what in ("line", "lm_tile_cache_service", "step", "frame-step"):
            if what in stages:
                worst = stages[what][2]
                print(f"  worst {what.removeprefix('lm_'):20} {MODES.get(mode, f'mode {mode}'):12}"
                      f"{worst:12,} = {worst / MIPS:8,.0f} us, {worst / (LINE_BUDGET_US * MIPS):6.0%}")


# What makes a line, from the map to its grey, and what paints it.
SECTOR_STAGES = ("lm_sector_sample_ahead", "lm_sector_draw_line", "lm_scan_conv_sector")
PATCH_STAGES = ("lm_sar_sample_ahead", "lm_sar_draw_line", "lm_scan_conv_patch")


def a_line(stages, names):
    """Instructions of a line: (to its grey, painting). Painting is apart, for it goes by the pixels of the glass."""
    ahead, draw, paint = (stages[name][1] / stages["line"][0] for name in names)
    return ahead + draw, paint


def print_goals(modes, first_picture_us):
    """The goals of docs/zcu102.md."""
    line, paint = a_line(modes[0], SECTOR_STAGES)
    print("\nagainst the goals")
    for patch, what, goal in ((PATCH, "SAR patch:               ", 45), (FINER, "SAR patch, finer than map:", 80)):
        if patch in modes:
            pixel, paint_pixel = (each / PATCH_CELLS for each in a_line(modes[patch], PATCH_STAGES))
            print(f"  {what}{pixel:6.1f} instructions a pixel (goal {goal}), and "
                  f"{paint_pixel:.1f} for painting it on this glass")
    print(f"  GM line of 256 cells:    {line:6,.0f} instructions (goal 20,000), and {paint:,.0f} for painting it")
    frames, spent, most, _ = modes[0]["steady-frame"]
    print(f"  GM frame, steady sweep:  {spent / frames:6,.0f} instructions (goal 150,000), worst {most:,} of {frames}")
    print(f"  reset to first picture:  {first_picture_us / 1000:6.1f} ms of the guest's time (goal 1,000)")


def sum_of(modes, stage):
    """(calls, instructions, most) of a stage in all modes."""
    found = [stages[stage] for stages in modes.values() if stage in stages] or [(0, 0, 0, 0)]
    calls, instructions, most, _ = zip(*found)
    return sum(calls), sum(instructions), max(most)


def tile_costs(modes):
    """What a tile costs after it was read: (instructions, what). Nothing is unpacked of an image of raw records."""
    tiles, checking, _ = sum_of(modes, "lm_tile_check")
    parts, unpacking, most = sum_of(modes, "lm_tile_unpack_run")
    if not tiles or not parts:
        return []
    return [(unpacking / tiles, "unpacking a tile"), (unpacking / tiles / TILE_BYTES, "unpacking a byte of a tile"),
            (most, "unpacking, worst part"), (checking / tiles, "checking a tile")]


def print_tiles(modes):
    tiles, _, _ = sum_of(modes, "lm_tile_check")
    print(f"\n{tiles:,} tiles, instructions")
    for cost, what in tile_costs(modes):
        print(f"  {what:27}{cost:12,.1f}")


def record(modes, first_picture_us):
    rows = [(cost, "instructions", what) for cost, what in tile_costs(modes)]
    rows.append((max(stages[step][2] for stages in modes.values() for step in ("step", "frame-step")), "instructions",
                 "worst step of all"))
    for mode, stages in sorted(modes.items()):
        if "line" in stages:
            drawn, paint = a_line(stages, PATCH_STAGES if mode >= PATCH else SECTOR_STAGES)
            rows += [(drawn, "instructions", f"{MODES[mode]}, a line"),
                     (paint, "instructions", f"{MODES[mode]}, painting a line")]
            if mode >= PATCH:
                rows += [(drawn / PATCH_CELLS, "instructions", f"{MODES[mode]}, a pixel"),
                         (paint * PATCH_CELLS / PATCH_PX**2, "instructions", f"{MODES[mode]}, painting a pixel of the glass")]
        rows += [(stages["step"][2], "instructions", f"{MODES[mode]}, worst step"),
                 (stages["frame-step"][2], "instructions", f"{MODES[mode]}, worst step with a frame")]
        if "steady-frame" in stages:
            rows.append((stages["steady-frame"][1] / stages["steady-frame"][0], "instructions",
                         f"{MODES[mode]}, a frame in steady sweep"))
    figures.record("bench-zcu102", rows + [(first_picture_us, "us", "reset to first picture, the guest's time")])


def read_options(description):
    """The command line of a flight to count."""
    options = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("db", "bus", "script", "out"):
        options.add_argument(f"--{name}", required=True)
    options.add_argument("--seconds", type=float, required=True)
    return options.parse_args()


def main():
    o = read_options(__doc__)
    why = machine.missing()
    if why:
        print(f"bench: {why}", file=sys.stderr)
        return 1
    chips = machine.split_flash(o.db, Path(o.out))
    modes, lines = run(o.out, chips, fly.make_scenario(o.out, o.bus, o.script, o.seconds))
    for chip in chips:
        chip.unlink()
    if not modes:
        print("bench: the board did not come to the end of its flight", *lines[-5:], sep="\n", file=sys.stderr)
        return 1
    for mode, stages in sorted(modes.items()):
        print_mode(MODES.get(mode, f"mode {mode}"), stages)
    print_own(modes)
    print_line_budget(modes)
    first_picture_us = value(lines, "first-picture-us")
    print_goals(modes, first_picture_us)
    print_tiles(modes)
    record(modes, first_picture_us)
    return 0


if __name__ == "__main__":
    sys.exit(main())
