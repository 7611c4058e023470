"""Flies the board in QEMU over a database and leaves the pictures that the script asks for.

    fly.py --db FILE --bus FILE.log --script FILE --seconds S --out DIR

The second core replays the log on the second CAN controller; both controllers, the flash, the display and the
supervisor are the product's. What the board received, and when, is left as DIR/received.log: the bench flies to the
same pixels with it, which --compare checks."""
import argparse
import struct
import subprocess
import sys
from pathlib import Path

import machine

FRAME = struct.Struct("<I???B8sQ")  # struct lm_can_frame


def make_scenario(out, bus, script, seconds, hang=()):
    path = Path(out) / "scenario.bin"
    path.parent.mkdir(parents=True, exist_ok=True)
    subprocess.run([machine.TOOLS / "scenario", bus, script, str(seconds), path, *map(str, hang)], check=True)
    return path


def received_log(m, elf, count, path):
    """The frames that the unit took, as candump writes them, from the guest's memory."""
    raw = m.folder / "received.bin"
    m.command("pmemsave", val=machine.symbol(elf, "received"), size=count * FRAME.size, filename=str(raw))
    lines = ["(0000000000.000000) can0 7FF#"]  # the bench counts time from the first line
    for identifier, is_extended, is_remote, _, length, data, time_us in FRAME.iter_unpack(raw.read_bytes()):
        digits = f"{identifier:08X}" if is_extended else f"{identifier:03X}"
        content = "R" if is_remote else data[:length].hex().upper()
        lines.append(f"({time_us // 1000000:010}.{time_us % 1000000:06}) can0 {digits}#{content}")
    raw.unlink()
    Path(path).write_text("\n".join(lines) + "\n")


def fly(out, chips, scenario, cores=2, options=("-no-reboot",), limit=300, elf=machine.BUILD / "flight.elf"):
    """The finished machine, with its lines, values and looks, and received.log and recording.log in `out`."""
    with machine.Machine(elf, out, chips, [("scenario", scenario)], cores, options=options, limit=limit,
                         uart1=f"file:{Path(out) / 'recording.log'}") as m:
        m.run(until="stack-used")
        if m.lines and m.lines[-1].startswith("stack-used"):
            received_log(m, elf, m.value("received"), Path(out) / "received.log")
        m.run()
        m.status = m.close()
    (Path(out) / "console").write_text("\n".join(m.lines) + "\n")
    return m


def bench_checksums(out, database, script, seconds):
    """name -> checksum of the pictures of landmass-sim with what the board received."""
    pictures = Path(out) / "bench"
    sim = machine.TOOLS.parent.parent / "landmass-sim"
    subprocess.run([sim, "--db", database, "--bus", Path(out) / "received.log", "--script", script, "--png", pictures,
                    "--every", "0", "--seconds", str(seconds), "--quiet"], check=True, stderr=subprocess.DEVNULL)
    return {picture.stem: machine.checksum(picture)[1] for picture in pictures.glob("*.png")}


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("db", "bus", "script", "out"):
        options.add_argument(f"--{name}", required=True)
    options.add_argument("--seconds", type=float, required=True)
    options.add_argument("--compare", action="store_true", help="fly the bench too, and compare the pictures")
    o = options.parse_args()
    why = machine.missing()
    if why:
        print(f"fly: {why}", file=sys.stderr)
        return 1
    chips = machine.split_flash(o.db, Path(o.out))
    m = fly(o.out, chips, make_scenario(o.out, o.bus, o.script, o.seconds))
    for chip in chips:
        chip.unlink()
    print("\n".join(line for line in m.lines if line))
    if m.status != 0 or not m.looks:
        print("fly: the board did not come to the end of its flight", file=sys.stderr)
        return 1
    if o.compare:
        bench = bench_checksums(o.out, o.db, o.script, o.seconds)
        for name, (drawn, seen) in m.looks.items():
            same = drawn == seen == bench.get(name)
            print(f"{name}: {'the same on the bench' if same else 'DIFFERS from the bench'}")
        if any((seen, seen) != (drawn, bench.get(name)) for name, (drawn, seen) in m.looks.items()):
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
