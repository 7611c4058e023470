"""The golden pictures on the board: the same checksums as on a PC, from memory and from the display."""
import subprocess
import sys
from pathlib import Path

import machine
from tap import Tap

WORK = machine.BUILD / "tmp/golden"


def main():
    tap = Tap()
    why = machine.missing()
    if why:
        tap.skip("the board draws the golden pictures", why)
        return tap.end()
    golden = [line.split() for line in Path("tests/golden/pictures.golden").read_text().splitlines()]
    WORK.mkdir(parents=True, exist_ok=True)
    subprocess.run([machine.TOOLS / "golden_flash", WORK / "golden.img"], check=True)
    chips = machine.split_flash(WORK / "golden.img", WORK)
    with machine.Machine(machine.BUILD / "golden.elf", WORK, chips, icount=False) as m:
        lines = m.run()
        tap.ok("the image ends by itself", m.close() == 0, *lines[-5:])
    for name, *expected in golden:
        if name.startswith("image-"):
            tap.ok(f"{name} comes out of the flash as it went in", f"{name} {expected[0]}" in lines)
        else:
            radar, glass = expected
            drawn, seen = m.looks.get(name, ("nothing", "nothing"))
            tap.ok(f"{name} is drawn as on the PC", f"RADAR {name} {radar}" in lines and drawn == glass,
                   f"glass {drawn} instead of {glass}; the radar picture should be {radar}")
            tap.ok(f"{name} is on the display, pixel for pixel", seen == glass, f"{seen} instead of {glass}")
    for chip in chips:
        chip.unlink()
    return tap.end()


sys.exit(main())
