"""Flights on the board over a golden country: the bus from controller to controller, the flash by DMA, damage to both,
and the supervisor. The bench flies with what the board received, and must draw the same.

When a frame arrives is not the same in every run: QEMU's two cores share one thread, and how long the one that sends
waits for the one that draws depends, by a millisecond or so, on the host. That is why the bench is given the arrivals
of the very run."""
import os
import pty
import re
import shutil
import struct
import subprocess
import sys
import time
from pathlib import Path

import fly
import machine
from tap import Tap

WORK = machine.BUILD / "tmp/flight"
FLAG_DB, FLAG_TILE = 1 << 2, 1 << 3  # of lm/overlay.h
SECONDS = 5
SCRIPT = """\
0   range 10
0.4 picture first-lines
1.9 picture ground-map
2   sar 46.0 11.0 5
2.7 picture patch-begun
4.9 picture sar
"""
PICTURES = SCRIPT.count("picture")
SECTION_TILES, SECTIONS_MAX = 4, 32
RECORD_BYTES = 17472


def country():
    """The image of the golden country in the middle, out of what golden_flash makes."""
    whole = WORK / "golden.img"
    subprocess.run([machine.TOOLS / "golden_flash", whole], check=True)
    content = whole.read_bytes()
    offset, size = struct.unpack_from("<QQ", content, 8 + 16 + 8)
    whole.unlink()
    return content[offset:offset + size]


# What the model does not have, and says when it is used: the watchdog, eFuses (QEMU asks itself), a display that
# nobody looks at, and the panel's power switch.
NOT_MODELLED = re.compile(r"addr 0xFD4D000[048],|eFuse|DPDMA client not attached|dpcd: Bad offset 0x600")


def complaints(log):
    """Registers that the program should not have touched, or not so."""
    return [line for line in log.read_text().splitlines() if not NOT_MODELLED.search(line)]


def damage_tiles(image):
    """One bit of every third record (docs/FORMATS.md, 1.1 and 1.5)."""
    damaged = bytearray(image)
    for section in range(SECTIONS_MAX):
        kind, _, offset, size = struct.unpack_from("<IIQQ", image, 64 + 24 * section)
        if kind == SECTION_TILES:
            for record in range(0, size // RECORD_BYTES, 3):
                damaged[offset + record * RECORD_BYTES + 1000] ^= 1 << record % 8
    return bytes(damaged)


class Flights:
    def __init__(self, tap):
        self.tap = tap
        WORK.mkdir(parents=True, exist_ok=True)
        self.image = country()
        self.script = WORK / "flight.script"
        self.script.write_text(SCRIPT)
        self.bus = WORK / "flight.log"
        subprocess.run([machine.TOOLS.parent.parent / "landmass-nav", "--straight", "45.95,10.95,10,2500,150",
                        "--seconds", str(SECONDS - 0.1), "--quiet", "--out", self.bus], check=True)

    def fly(self, name, image, chips=None):
        """The flight with this image; its machine, and whether the pictures are the bench's."""
        out = WORK / name
        out.mkdir(parents=True, exist_ok=True)
        database = out / "image.lmdb"
        database.write_bytes(image)
        chips = machine.split_flash(database, out) if chips is None else chips
        m = fly.fly(out, chips, fly.make_scenario(out, self.bus, self.script, SECONDS),
                    options=("-no-reboot", "-d", "guest_errors,unimp", "-D", out / "complaints"))
        for chip in chips:
            chip.unlink()
        self.tap.ok(f"{name}: the board comes to the end of its flight", m.status == 0 and len(m.looks) == PICTURES,
                    *m.lines[-8:])
        bench = fly.bench_checksums(out, database, self.script, SECONDS)
        for picture, checksum in bench.items():
            self.tap.ok(f"{name}: {picture} is on the display as on the bench",
                        m.looks.get(picture) == (checksum, checksum), m.looks.get(picture), checksum)
        self.replayed(name, database, m)
        return m

    def replayed(self, name, database, m):
        """What the board recorded on its second serial line is shown again by the bench, bit for bit."""
        out, again = WORK / name, WORK / name / "again"
        shutil.rmtree(again, ignore_errors=True)
        sim = subprocess.run([machine.TOOLS.parent.parent / "landmass-sim", "--db", database, "--replay",
                              out / "recording.log", "--png", again, "--every", "1"], capture_output=True, text=True)
        said = re.search(r"checks of the glass (\d+), failed 0; departures 0; the recording has no end", sim.stdout)
        self.tap.ok(f"{name}: the recording is shown again, and every check of it holds",
                    sim.returncode == 0 and said and int(said.group(1)) > 100, sim.stdout, sim.stderr)
        for picture, (checksum, _) in m.looks.items():
            shown = again / f"frame-{m.value(picture) - 1:05}.png"  # numbered from 0
            self.tap.ok(f"{name}: {picture} is in the replay as on the display",
                        shown.exists() and machine.checksum(shown)[1] == checksum, shown)
        shutil.rmtree(again, ignore_errors=True)

    def whole(self):
        m = self.fly("whole", self.image)
        sent = m.value("sent")
        self.tap.ok("every frame of the bus arrives, in the order and at the time it was sent",
                    sent > 3000 and m.value("received") == sent and m.value("refused") == 0 and self.is_in_order())
        self.tap.ok("no step sees a frame that came after its time", m.value("early") == 0)
        self.tap.ok("nothing is lost or late", all(m.value(name) == 0 for name in (
            "ring-overflowed", "fifo-overflowed", "recorded-lines-lost", "lines-dropped", "steps-left-out", "read-errors", "tiles-corrupt")))
        bad = complaints(WORK / "whole/complaints")
        self.tap.ok("QEMU has no complaint about how the devices are used", not bad, *bad[:5])
        self.tap.ok("the page has no warning", m.value("flags") == 0)
        self.tap.ok("tiles came while the sweep ran", m.value("tiles-read") > 50)
        self.tap.ok("the first picture comes within a second of the reset", 0 < m.value("first-picture-us") < 1000000)
        self.tap.note(f"first picture {m.value('first-picture-us')} us after reset; {m.value('interrupts')} interrupts")

    def is_in_order(self):
        """What arrived is what the log holds: the same identifiers and bytes, each at its time, or late by
        what the core that sends has to wait for the one that draws."""
        def frames(path):
            for line in Path(path).read_text().splitlines():
                time, _, frame = line.split()
                yield float(time.strip("()")), frame
        sent = list(frames(self.bus))
        received = list(frames(WORK / "whole/received.log"))[1:]
        start = sent[0][0]
        return all(one[1] == other[1] and -1e-5 < other[0] - (one[0] - start) < 0.02
                   for one, other in zip(sent, received))

    def kept(self):
        """record.sh keeps a file for each start of the board, and no noise."""
        whole = (WORK / "whole/recording.log").read_bytes()
        folder = WORK / "kept"
        shutil.rmtree(folder, ignore_errors=True)
        board, line = pty.openpty()
        with subprocess.Popen(["sh", "bsp/zcu102/record.sh", os.ttyname(line), folder], stdout=subprocess.PIPE) as pc:
            listens = pc.stdout.readline()
            content = b"\xff\x00\x80 no head\n" + whole + whole[:5000] + b"\n" + whole[:20000]
            while content:
                content = content[os.write(board, content[:1000]):]
            self.wait_for(folder / "flight-00003-000.log", 20000)
            os.close(line)
            os.close(board)  # the cable is pulled
        files = sorted(file.name for file in folder.iterdir())
        self.tap.ok("what comes over the line is kept in a file for each start of the board",
                    files == [f"flight-0000{n}-000.log" for n in (1, 2, 3)], listens, files)
        self.tap.ok("without a bit of difference", (folder / files[0]).read_bytes() == whole
                    and (folder / files[2]).read_bytes().startswith(whole[:19000]))

    @staticmethod
    def wait_for(file, most):
        """The file stands still near its full length."""
        for _ in range(100):
            if file.exists() and file.stat().st_size > most - 100:
                return
            time.sleep(0.1)

    def damaged(self):
        m = self.fly("damaged tiles", damage_tiles(self.image))
        self.tap.ok("flipped bits are found, and the page says TILE",
                    m.value("tiles-corrupt") > 0 and m.value("flags") == FLAG_TILE, m.lines)
        header = bytearray(self.image)
        header[30] ^= 4
        m = self.fly("damaged header", bytes(header))
        self.tap.ok("a damaged header is no database, and the page says DB FAIL", m.value("flags") == FLAG_DB)
        m = self.fly("no flash", b"\xff" * 4096, chips=[])
        self.tap.ok("without flash the page says DB FAIL", m.value("flags") == FLAG_DB)

    def hung(self, what, words):
        out = WORK / f"hung-{what}"
        chips = machine.split_flash(WORK / "whole/image.lmdb", out)
        scenario = fly.make_scenario(out, self.bus, self.script, SECONDS, (what, 1.0))
        m = fly.fly(out, chips, scenario, options=())
        for chip in chips:
            chip.unlink()
        starts = [line for line in m.lines if "started after" in line]
        self.tap.ok(f"{what} hangs: the supervisor restarts the board, once", len(starts) == 2 and m.status == 0, *starts)
        self.tap.ok(f"{what} hangs: the console says {words}", starts[-1].endswith(words), *starts)
        return m.looks.get("bit")


def main():
    tap = Tap()
    why = machine.missing()
    if why:
        tap.skip("the board flies as the bench does", why)
        return tap.end()
    flights = Flights(tap)
    flights.whole()
    flights.kept()
    flights.damaged()
    pages = [flights.hung(what, words) for what, words in
             (("step", "HUNG STEP"), ("display", "NO FRAME"), ("bus", "NO BUS"))]
    tap.ok("and each time the BIT page says so", len(set(pages)) == 3 and None not in pages
           and all(drawn == seen for drawn, seen in pages), pages)
    return tap.end()


sys.exit(main())
