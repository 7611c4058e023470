"""Two slots in the board's flash, one in each device: which one the product flies, and what its console and its BIT
page say of it. The slots are laid out by landmass-load, and then torn as a power cut or a bad chip would.

QEMU's flash is read only here: who writes it in the field is not part of the board's program."""
import socket
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import machine
from tap import Tap

WORK = machine.BUILD / "tmp/slots"
LOAD = machine.TOOLS.parent.parent / "landmass-load"
GLASS = machine.TOOLS.parent / "panel-vm/glass"
MIB = 1 << 20
RECORD_BYTES, RECORD_COPIES = 64, (-128 * 1024, -64 * 1024)  # from the end of a slot: docs/slots.md
LOADING, WHOLE = 1, 2
RECORD_COUNT_AT = 32  # of the header: docs/FORMATS.md, 1.1


def crc32c(data):
    """Castagnoli's, bit by bit."""
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


def record(state, generation, sequence, image):
    size, crc = struct.unpack_from("<Q", image, 16)[0], struct.unpack_from("<I", image, 1020)[0]
    body = struct.pack("<8sIIQQQI16x", b"LMDBSLOT", 1, state, generation, sequence, size, crc)
    return body + struct.pack("<I", crc32c(body))


def countries():
    """Images of the golden countries, the largest first."""
    whole = WORK / "golden.img"
    subprocess.run([machine.TOOLS / "golden_flash", whole], check=True)
    content = whole.read_bytes()
    whole.unlink()
    places = [struct.unpack_from("<QQ", content, 8 + 40 * i + 24) for i in range(4)]
    return [content[offset:offset + size] for offset, size in places]


def lay_out(images, mib, folder):
    """The contents of both chips after these loads, one after the other."""
    folder.mkdir(parents=True, exist_ok=True)
    chips = [folder / "lower", folder / "upper"]
    for chip in chips:
        chip.unlink(missing_ok=True)
    for image in images:
        (folder / "image").write_bytes(image)
        subprocess.run([LOAD, "put", folder / "image", "--unsigned", "--chip", str(mib), "--slot-a", chips[0], "--slot-b",
                        chips[1]], check=True, capture_output=True)
    return [bytearray(chip.read_bytes()) if chip.exists() else bytearray(b"\xff" * mib * MIB) for chip in chips]


def sentence(words):
    """The bezel's: drv/bezel_serial.h."""
    checksum = 0
    for letter in words:
        checksum ^= ord(letter)
    return f"${words}*{checksum:02X}\r\n".encode()


def text_of(m, folder):
    picture = (folder / "glass.png").resolve()
    m.command("screendump", filename=str(picture), format="png")
    return subprocess.run([GLASS, "text", picture], capture_output=True, text=True, check=True).stdout


def start(chips, folder):
    """What the console says at the start, and the words of the BIT page."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"chip{i}" for i in range(len(chips))]
    for path, content in zip(paths, chips):
        path.write_bytes(content)
    with tempfile.TemporaryDirectory() as scratch, socket.socket(socket.AF_UNIX) as line, \
            machine.Machine(machine.BUILD / "landmass.elf", folder, paths, options=("-no-reboot",),
                            uart1=f"unix:{scratch}/uart1,server=on,wait=off") as m:
        m.run(until=("flying", "no usable"))
        line.connect(f"{scratch}/uart1")
        line.sendall(sentence("D12") + sentence("U12"))
        deadline, words = time.monotonic() + 40, ""
        while "RECORDS" not in words and time.monotonic() < deadline:
            words = text_of(m, folder)
        console = m.lines
    for path in paths:
        path.unlink()
    return console, words


class Slots:
    def __init__(self, tap):
        self.tap = tap
        WORK.mkdir(parents=True, exist_ok=True)
        self.images = countries()
        self.whole = lay_out(self.images[:2], 64, WORK / "laid")  # load 1 in A, load 2 in B

    def case(self, name, chips, image, console, glass=()):
        """`image`: the number of the one that is flown, or None."""
        said, words = start(chips, WORK / "run")
        records = struct.unpack_from("<I", self.images[image], RECORD_COUNT_AT)[0] if image is not None else 0
        end = "flying" if image is not None else "no usable database"
        told = [line for line in said if line.startswith(("slot ", "flying", "no usable"))]
        self.tap.ok(f"{name}: the console says so", told == [*console, end], *told)
        squeezed = [" ".join(line.split()) for line in words.splitlines()]
        shown = all(any(part in line for line in squeezed) for part in (*glass, f"RECORDS {records}"))
        silent = bool(glass) or not any("SLOT" in line for line in squeezed)
        self.tap.ok(f"{name}: so does the BIT page", shown and silent, *squeezed)

    def torn(self, slot, change):
        chips = [bytearray(chip) for chip in self.whole]
        change(chips[slot])
        return chips


def half_erased(chip):
    size = struct.unpack_from("<Q", chip, 16)[0]
    chip[size // 2:size] = b"\xff" * (size - size // 2)


def flipped(chip):
    chip[200] ^= 4


def put_record(chip, copy, content):
    at = len(chip) + RECORD_COPIES[copy]
    chip[at:at + len(content)] = content


def main():
    tap = Tap()
    why = machine.missing()
    if why:
        tap.skip("the board flies the newest slot that verifies", why)
        return tap.end()
    s = Slots(tap)
    s.case("both whole", s.whole, 1, ["slot A: load 1 stands by", "slot B: load 2, flown"], ["SLOT B"])
    s.case("the newest torn", s.torn(1, half_erased), 0, ["slot A: load 1, flown", "slot B: load 2, not flown: damaged"],
           ["SLOT A", "SLOT B BAD"])
    both = s.torn(1, flipped)
    flipped(both[0])
    s.case("both bad", both, None, ["slot A: load 1, not flown: damaged", "slot B: load 2, not flown: damaged"],
           ["SLOT A BAD SLOT B BAD", "DB FAIL"])

    # The third load goes into slot A; power fails while its first record is written, and after that.
    chips = [bytearray(s.images[2]), s.whole[1]]
    chips[0] += b"\xff" * (64 * MIB - len(chips[0]))
    loading, switched = record(LOADING, 3, 0, s.images[2]), record(WHOLE, 4, 3, s.images[2])
    put_record(chips[0], 0, switched[:20] + b"\xff" * 44)
    put_record(chips[0], 1, loading)
    s.case("cut while it switches", chips, 1,
           ["slot A: not flown, a load has not come to its end", "slot B: load 2, flown"], ["SLOT B", "SLOT A CUT OFF"])
    put_record(chips[0], 0, switched)
    s.case("cut between the two records", chips, 2, ["slot A: load 3, flown", "slot B: load 2 stands by"], ["SLOT A"])

    s.case("no slots", [s.images[0] + b"\xff" * (64 * MIB - len(s.images[0])), b"\xff" * 64 * MIB], 0, [])
    shown = subprocess.run([LOAD, "show", "--chip", "32", "--slot-a", WORK / "laid/lower", "--slot-b", WORK / "laid/upper"],
                           capture_output=True, text=True, check=False)
    tap.ok("chips of another length than --chip are refused", shown.returncode == 1 and "whole," not in shown.stdout)
    return tap.end()


sys.exit(main())
