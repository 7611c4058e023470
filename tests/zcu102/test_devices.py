"""The drivers on their devices, and what the board does with a program that goes astray."""
import socket
import subprocess
import sys
import tempfile
import time

import machine
from tap import Tap

WORK = machine.BUILD / "tmp/devices"
SHIFTS = [bytes((i + shift) & 0xFF for i in range(256)) for shift in range(256)]

# What faults.c does in turn, and what the report must say.
FAULTS = (
    ("reading through a null pointer", "*** exception: data abort, not mapped"),
    ("writing to code", "*** exception: data abort, not permitted, on writing"),
    ("running a variable", "*** exception: instruction abort, not permitted"),
    ("a stack that outgrows its pages", "*** exception: data abort, not mapped, on writing"),
    ("an address where nothing is", "*** exception: data abort, not mapped"),
    ("an instruction that there is not", "*** exception: unknown instruction"),
    ("a fault in an interrupt", "*** exception in exception: data abort, not mapped"),
)


def pattern_chips():
    """The byte at offset n is 11 n + 37 (n / 4096), as devices.c expects it."""
    WORK.mkdir(parents=True, exist_ok=True)
    page = bytes(11 * i & 0xFF for i in range(4096))
    chips = []
    for number in range(2):
        chips.append(WORK / f"chip{number}.img")
        with open(chips[-1], "wb") as chip:
            for row in range(number * machine.CHIP_BYTES // 4096, (number + 1) * machine.CHIP_BYTES // 4096):
                chip.write(page.translate(SHIFTS[37 * row & 0xFF]))
    return chips


def devices(tap):
    chips = pattern_chips()
    with machine.Machine(machine.BUILD / "devices.elf", WORK, chips, options=("-no-reboot",)) as m:
        m.run(until="TYPE")
        m.say("abc")
        m.run()
        status = m.close()
    for chip in chips:
        chip.unlink()
    for line in m.lines:
        if line.startswith(("ok ", "not ok ")):
            tap.ok(line.split("ok ", 1)[1], line.startswith("ok "))
    tap.ok("the image came to its end", status == 0 and "all done" in m.lines, *m.lines[-5:])


def faults(tap):
    with machine.Machine(machine.BUILD / "faults.elf", WORK) as m:
        m.run()
        m.close()
    runs = "\n".join(m.lines).split("restarts ")[1:]
    for number, (what, words) in enumerate(FAULTS):
        lines = runs[number].splitlines() if number < len(runs) else ["nothing"]
        tap.ok(f"{what} is reported and ends in a restart", words in lines and lines[0] == str(number), *lines)
    tap.ok("the program counts its restarts", runs[-1].startswith(f"{len(FAULTS)}\nall done"), *m.lines[-5:])


def sentence(text):
    """As drv/bezel_serial.h frames it."""
    checksum = 0
    for character in text.encode():
        checksum ^= character
    return f"${text}*{checksum:02X}\r\n".encode()


def bench_test_pages():
    """Checksums of the bench's test page, in as many pictures as its sign of life has positions."""
    (WORK / "flash").write_bytes(b"\xff" * 4096)
    (WORK / "script").write_text("0.5 osb 14\n" + "".join(f"{1 + 0.034 * n:.3f} picture page-{n}\n" for n in range(16)))
    subprocess.run([machine.TOOLS.parent.parent / "landmass-sim", "--db", WORK / "flash", "--script", WORK / "script",
                    "--png", WORK / "bench", "--every", "0", "--seconds", "2", "--quiet"], check=True,
                   stderr=subprocess.DEVNULL)
    return {machine.checksum(page)[1] for page in (WORK / "bench").glob("page-*.png")}


def bezel(tap):
    """The product itself, as it is flashed: a press on its bezel."""
    pages = bench_test_pages()
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/uart1"
        with machine.Machine(machine.BUILD / "landmass.elf", WORK, options=("-no-reboot",),
                             uart1=f"unix:{path},server=on,wait=off") as m:
            m.run(until="no usable database")
            before = m.dump("before")
            with socket.socket(socket.AF_UNIX) as line:
                line.connect(path)
                line.sendall(sentence("D14") + sentence("U14"))
                deadline = time.monotonic() + 20
                while m.dump("after") not in pages and time.monotonic() < deadline:
                    time.sleep(0.02)
            tap.ok("a press on the serial bezel brings the test page, as on the bench",
                   before not in pages and m.dump("after") in pages)


def level_2(tap):
    with machine.Machine(machine.BUILD / "faults.elf", WORK, options=("-machine", "virtualization=on")) as m:
        m.run()
        m.close()
    tap.ok("started at exception level 2, the board goes on at level 1", "all done" in m.lines, *m.lines[-5:])


def main():
    tap = Tap()
    why = machine.missing()
    if why:
        tap.skip("the drivers work on the board's devices", why)
        return tap.end()
    devices(tap)
    bezel(tap)
    faults(tap)
    level_2(tap)
    return tap.end()


sys.exit(main())
