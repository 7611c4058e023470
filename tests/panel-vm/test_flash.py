"""The panel's database in flash chips, on amd64, whose kernel has chips to play with (mtdram, nandsim)."""

import os

from cases import case, expect, main
from fixtures import database, log, public_key, tree, unsigned_database
from machine import Machine
from panel import Panel, fly, is_fine

BLOCK = 128 << 10
CHIP = "id_bytes=0x20,0xa2,0x00,0x15 parts=128"  # NAND of 64 MiB, its first 16 MiB as /dev/mtd0


def boot():
    return Machine("amd64", tree=tree(files=[log("still"), database("small"), unsigned_database(), public_key()], arch="amd64"),
                   devices=["-device", "virtio-gpu-pci,xres=640,yres=480"])


def prepare(m):
    m.do("modprobe -a can_raw vcan virtio-gpu && ip link add vcan0 type vcan && ip link set vcan0 up")
    fly(m)


def start(m, **settings):
    """The panel on /dev/mtd0."""
    return Panel(m, database="/dev/mtd0", bezel=False, **settings)


def shows_map(m):
    """The panel, when its glass shows the picture and the ground's elevation, which it has from the chip."""
    p = start(m)
    p.until(lambda text: is_fine(text) and any("ELV" in line for line in text))
    return p


def change_chip(m, module):
    """Take the chip that is there away, and put in another one."""
    m.sh("kill $(pidof landmass-panel); while pidof landmass-panel; do usleep 20000; done; rmmod mtdram; rmmod nandsim")
    m.do("modprobe " + module)


def write_nand(m, bad=(), path="/t/small.lmdb"):
    """Write a database as nandwrite does, block after block, the bad ones left out."""
    blocks = int(m.do("stat -c %%s %s" % path)) // BLOCK + 1
    good = [number for number in range(blocks + len(bad)) if number not in bad][:blocks]
    m.do("n=0; for to in %s; do dd if=%s of=/dev/mtd0 bs=%d skip=$n seek=$to count=1 conv=notrunc,sync "
         "2>/tmp/dd || cat /tmp/dd; n=$((n + 1)); done" % (" ".join(map(str, good)), path, BLOCK), 120)


@case("a database in NOR flash is shown")
def nor(m):
    change_chip(m, "mtdram total_size=16384 erase_size=128")
    m.do("dd if=/t/small.lmdb of=/dev/mtd0 bs=128k conv=notrunc 2>/dev/null")
    p = shows_map(m)
    expect("good erase blocks of 131072 bytes, 0 bad ones" in p.said(), p.said())


@case("a database in NAND flash with bad blocks is shown")
def nand(m):
    change_chip(m, "nandsim %s badblocks=3,9" % CHIP)
    write_nand(m, bad=(3, 9))
    p = shows_map(m)
    expect(", 2 bad ones" in p.said(), p.said())


@case("bits that the chip flips are put right on the way")
def flipped_bits(m):
    change_chip(m, "nandsim %s bitflips=1" % CHIP)
    write_nand(m)
    shows_map(m)


def lose_pages(m, path):
    """A chip with a database of which many pages can no longer be read."""
    pages = ",".join("%d:1" % page for page in range(1800, 3600, 16))  # as many as a parameter of a module has room for
    change_chip(m, "nandsim %s gravepages=%s" % (CHIP, pages))
    write_nand(m, path=path)
    m.do("dd if=/dev/mtd0 of=/dev/null bs=%d 2>/dev/null" % BLOCK)  # once each of them can be read


@case("pages that lose their data are told on the glass, and the picture goes on")
def lost_pages(m):
    lose_pages(m, "/t/small-plain.lmdb")
    p = start(m, database__trust="any")
    p.until(lambda text: "TILE" in text and "UNSIGNED" in text and "NAV FAIL" not in text)
    expect(p.is_alive(), "the display stands")


@case("a signed database of which pages are lost is not flown: nobody can say what it was")
def lost_signed_pages(m):
    lose_pages(m, "/t/small.lmdb")
    p = start(m)
    p.until(lambda text: "DB FAIL" in text and "NAV FAIL" not in text)
    expect("cannot be read" in p.said() and "check the medium" in p.said(), p.said())


if __name__ == "__main__":
    main(boot, prepare, "amd64")
