"""Databases loaded into slots on a real kernel: block devices, NAND with bad blocks, USB storage, and machines that are
killed while they load (LANDMASS_VM_KILLS of them, drawn from LANDMASS_SEED).

A kill is SIGKILL to QEMU: what the machine's kernel had not written is lost, as with the power. What QEMU had written is
kept by the PC, so that the disk itself loses, tears and reorders nothing; that is what test_cuts draws."""

import json
import os
import random
import re
import signal
import subprocess
import time

from cases import case, expect, main
from fixtures import HOST, WORK, log, public_key, tree
from machine import Machine
from panel import Panel, fly, is_fine

KILLS = int(os.environ.get("LANDMASS_VM_KILLS", "3"))
SEED = int(os.environ.get("LANDMASS_SEED", "1"))
MIB = 1 << 20
DISKS = {name: os.path.abspath(os.path.join(WORK, name + ".img")) for name in ("disk-a", "disk-b", "files", "stick", "killed")}
CHIP = "id_bytes=0x20,0xa2,0x00,0x15 parts=128,128"  # NAND of 64 MiB, of which /dev/mtd0 and mtd1 have 16 MiB each
BIG, PLAIN = -1, 9  # numbers of databases: one of a megabyte, and one that nobody has signed
CLASSES = "host-sim/programs/db/classes/heaton6.classes"


def run(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


def image(number):
    """A signed database; each number another one, tile by tile."""
    path, scene = os.path.join(WORK, "load%d.lmdb" % number), os.path.join(WORK, "load-scene")
    public_key()
    if not os.path.exists(scene):
        run(os.path.join(HOST, "landmass-scene"), "--out", scene, "--size", 512)
    run(os.path.join(HOST, "landmass-db"), "build", "--classes", CLASSES, "--terrain", scene + "/terrain.tif", "--class-raster",
        scene + "/truth.tif", "--cell", 10 + 4 * number, "--title", "image %d" % number, "--out", path + ".plain")
    run(os.path.join(HOST, "landmass-db"), "sign", "--key", os.path.join(WORK, "signing.pem"), "--serial", 1, path + ".plain",
        path)
    return path


def blank(name, size):
    os.makedirs(WORK, exist_ok=True)
    with open(DISKS[name], "wb") as disk:
        disk.truncate(size)


def stick(path):
    """A stick with a database at its top."""
    folder = os.path.join(WORK, "stick")
    os.makedirs(folder, exist_ok=True)
    run("cp", path, os.path.join(folder, "landmass.lmdb"))
    blank("stick", 32 * MIB)
    run("/sbin/mke2fs", "-q", "-t", "ext4", "-d", folder, DISKS["stick"])


def drive(name):
    return ["-drive", "if=none,id=%s,format=raw,cache=writeback,file=%s" % (name, DISKS[name]),
            "-device", "virtio-blk-pci,drive=%s,serial=%s" % (name, name)]


def boot():
    """Both block devices, a disk for files, and a port for a stick."""
    for name in ("disk-a", "disk-b"):
        blank(name, 8 * MIB)
    blank("files", 64 * MIB)
    run("/sbin/mke2fs", "-q", "-t", "ext4", DISKS["files"])
    images = [image(number) for number in (0, 1, 2, BIG)]
    plain = os.path.join(WORK, "load%d.lmdb" % PLAIN)
    run("cp", images[0] + ".plain", plain)
    stick(images[1])
    top = tree(files=[*images, plain, public_key(), log("still")], arch="amd64")
    devices = ["-device", "virtio-gpu-pci,xres=640,yres=480", "-device", "qemu-xhci,id=xhci"]
    for name in ("disk-a", "disk-b", "files"):
        devices += drive(name)
    return Machine("amd64", tree=top, devices=devices)


def prepare(m):
    m.do("modprobe -a can_raw vcan virtio-gpu virtio_blk crc32c_generic ext4 xhci-pci usb-storage sd_mod; "
         "ip link add vcan0 type vcan && "
         "ip link set vcan0 up; until [ -b /dev/vdc ]; do usleep 20000; done; mkdir -p /slots")


def configure(m, first, second):
    m.do("printf '%%s\\n' 'slot.a = %s' 'slot.b = %s' 'database.key = /t/public.pem' 'database.serial = none' "
         "'slot.progress = /tmp/load' >/tmp/load.conf" % (first, second))


def put(m, number, limit_s=300):
    return json.loads(m.do("landmass-load put /t/load%d.lmdb --config /tmp/load.conf --json /tmp/put.json >/tmp/put 2>&1 || "
                           "{ cat /tmp/put; exit 1; }; cat /tmp/put.json" % number, limit_s))["report"]


def show(m, command="show"):
    """What each slot holds."""
    text = m.sh("landmass-load %s --config /tmp/load.conf --json /tmp/show.json >/tmp/show 2>&1; cat /tmp/show.json" % command,
                300)[1]
    return json.loads(text)["report"]["slots"]


def both_in_turn(m, first, second):
    """Both slots loaded, the second flown; then the first again."""
    configure(m, first, second)
    expect(put(m, 0)["slot"] == first)
    expect(put(m, 1)["slot"] == second)
    slots = show(m, "verify")
    expect([s["state"] for s in slots] == ["whole", "whole"] and slots[1]["is_flown_next"], slots)
    expect(put(m, 1)["is_there_already"])
    m.do("landmass-panel --check --config /tmp/load.conf")


@case("two block devices are slots, laid out as the page of slots says")
def block_devices(m):
    both_in_turn(m, "/dev/vda", "/dev/vdb")
    m.do("sync")
    told = json.loads(run(os.path.join(HOST, "landmass-load"), "verify", "--chip", 8, "--slot-a", DISKS["disk-a"], "--slot-b",
                          DISKS["disk-b"], "--json", "-"))["report"]["slots"]
    expect([s["state"] for s in told] == ["whole", "whole"] and told[1]["load"] == 2, told)


@case("the panel flies the slot on a block device, beside a load into the other one")
def flown(m):
    configure(m, "/dev/vda", "/dev/vdb")
    fly(m)
    p = Panel(m, bezel=False, slot__a="/dev/vda", slot__b="/dev/vdb", database="/nowhere")
    p.until(is_fine)
    expect("slot B: /dev/vdb: load 2, flown" in p.said(), p.said())
    code, said = m.sh("landmass-load put /t/load0.lmdb --config /tmp/load.conf 2>&1")
    expect(code == 0 and "slot A: load 3" in said, said)  # beside the panel that flies B
    p.stop()


@case("two MTD devices with bad blocks are slots, and a block that fails is taken out of use")
def nand(m):
    m.do("modprobe nandsim %s badblocks=3,9,130 weakblocks=0:1" % CHIP)
    both_in_turn(m, "/dev/mtd0", "/dev/mtd1")
    report = put(m, 2)  # the second erasure of block 0 fails
    expect(report["slot"] == "/dev/mtd0" and report["bad_blocks"] == 1, report)
    slots = show(m, "verify")
    expect([s["state"] for s in slots] == ["whole", "whole"] and slots[0]["is_flown_next"], slots)
    m.do("landmass-panel --check --config /tmp/load.conf; rmmod nandsim")


@case("a stick that is plugged in is mounted and loaded by the commands of its unit")
def usb(m):
    configure(m, "/slots/a", "/slots/b")
    m.do("mount -t ext4 /dev/vdc /slots")
    put(m, 0)
    m.qmp("blockdev-add", **{"driver": "raw", "node-name": "stick", "read-only": True,
                             "file": {"driver": "file", "filename": DISKS["stick"], "read-only": True}})
    m.qmp("device_add", driver="usb-storage", id="stick0", bus="xhci.0", drive="stick")
    m.until("[ -b /dev/sda ]")
    unit = m.do("cat /lib/systemd/system/landmass-load@.service")
    steps = [re.search("^%s=[-+]*(.*)$" % name, unit, re.M).group(1).replace("nsenter --target 1 --mount ", "")
             .replace(",X-mount.mkdir", "").replace("%I", "sda").replace("%i", "sda")
             for name in ("ExecStartPre", "ExecStart", "ExecStopPost")]
    m.do("mkdir -p /run/landmass-load/sda; %s" % steps[0].replace("-o ro", "-t ext4 -o ro"))
    m.do("%s --config /tmp/load.conf" % steps[1], 300)
    m.do(steps[2].replace("--lazy", "-l"))
    slots = show(m, "verify")
    expect(slots[1]["is_flown_next"] and slots[1]["title"] == "image 1", slots)
    m.qmp("device_del", id="stick0")
    m.until("[ ! -b /dev/sda ]")
    m.do("umount /slots")


GADGET = "/usr/lib/landmass-panel/usb-gadget"
PLUGGED = "grep -qsx 0001 /sys/bus/usb/devices/*/idProduct"


def send(m, number, code=0):
    """What the PC's program says of a database that it sends."""
    done, said = m.sh("landmass-load send /t/load%d.lmdb --json /tmp/send.json 2>&1" % number)
    expect(done == code, done, said)
    return said, json.loads(m.do("cat /tmp/send.json"))["report"]


def plug(m):
    m.do(GADGET + " connect")
    m.until(PLUGGED)


def pull_while_sending(m, number, how):
    """Begin to send, and let that happen when the first piece is in the slot."""
    m.do("rm -f /slots/b*; landmass-load send /t/load%d.lmdb >/tmp/sent 2>&1 & pid=$!; "
         "until head -c 4 /slots/b 2>/dev/null | grep -q LAND; do [ -d /proc/$pid ] || break; done; %s; wait $pid; true" %
         (number, how))
    return m.do("cat /tmp/sent")


@case("a PC sends databases over USB, by libusb and FunctionFS; a cable that is pulled and a program that is killed cost no byte")
def over_usb(m):
    m.do("modprobe -a dummy_hcd libcomposite usb_f_fs; mkdir -p /slots; rm -rf /slots/*; %s make" % GADGET)
    configure(m, "/slots/a", "/slots/b")
    m.do("landmass-load receive --config /tmp/load.conf >/tmp/received 2>&1 & echo $! >/tmp/receiver")
    plug(m)
    said, report = send(m, 0)
    expect("slot A: load 1;" in said and report["sent_bytes"] > report["image_bytes"], said)
    said, report = send(m, 0)
    expect(report["is_there_already"] and "slot A: whole, load 1, flown next; slot B: absent" in said, said)
    said, _ = send(m, PLAIN, code=1)
    expect("the panel: USB: is not signed;" in said and show(m)[1]["state"] == "absent", said)
    for how, again in (("echo '' >/sys/kernel/config/usb_gadget/landmass/UDC", lambda: plug(m)), ("kill -9 $pid", lambda: None)):
        said = pull_while_sending(m, BIG, how)
        slots = show(m)
        expect([s["state"] for s in slots] == ["whole", "cut off"] and slots[0]["is_flown_next"], slots, said)
        again()
        said, report = send(m, BIG)
        expect(0 < report["same_bytes"] < report["image_bytes"] and "slot B: load 2;" in said, said)
        slots = show(m, "verify")
        expect([s["state"] for s in slots] == ["whole", "whole"] and slots[1]["is_flown_next"], slots)
        m.do("cmp /slots/b /t/load%d.lmdb" % BIG)
    m.do("kill $(cat /tmp/receiver); while [ -d /proc/$(cat /tmp/receiver) ]; do usleep 10000; done; %s remove; "
         "rm -rf /slots/*; [ ! -e /sys/kernel/config/usb_gadget/landmass ]" % GADGET, 60)


def kill(m):
    """As when the power fails."""
    with open("/proc/%d/task/%d/children" % (m.process.pid, m.process.pid), encoding="ascii") as children:
        os.kill(int(children.read().split()[0]), signal.SIGKILL)
    m.process.wait()
    m.close()


class Loading:
    """Machines with files for slots, one after the other, each killed while it loads."""

    def __init__(self):
        self.draw = random.Random(SEED)
        self.top = tree(files=[image(0), image(1), public_key()], arch="amd64")
        blank("killed", 64 * MIB)
        run("/sbin/mke2fs", "-q", "-t", "ext4", DISKS["killed"])
        self.cut = self.ended = 0

    def start(self):
        m = Machine("amd64", tree=self.top, devices=drive("killed"))
        m.do("modprobe -a virtio_blk crc32c_generic ext4; until [ -b /dev/vda ]; do usleep 20000; done; mkdir -p /slots; "
             "mount -t ext4 /dev/vda /slots")
        configure(m, "/slots/a", "/slots/b")
        return m

    @staticmethod
    def look(m):
        """Which image is flown; it is whole, and byte by byte one of the two."""
        slots = show(m)
        flown = [s for s in slots if s["is_flown_next"]]
        expect(len(flown) == 1 and not [s for s in slots if s["state"] == "damaged"], slots)
        m.do("landmass-panel --check --config /tmp/load.conf 2>&1")
        return int(m.do("for n in 0 1; do cmp -s %s /t/load$n.lmdb && echo $n; done; true" % flown[0]["path"]))

    def one(self, seconds):
        """Look at what the last machine left, and kill this one."""
        m = self.start()
        try:
            now = self.look(m)
            m.do("landmass-load put /t/load%d.lmdb --config /tmp/load.conf >/tmp/put 2>&1 &" % (1 - now))
            time.sleep(self.draw.random() * seconds)
            kill(m)
        except BaseException:
            m.close()
            raise
        return now


@case("machines that are killed while they load start with one of two databases, whole")
def kills(_):
    loading = Loading()
    m = loading.start()
    put(m, 0)
    start = time.monotonic()
    put(m, 1)
    seconds = 1.2 * (time.monotonic() - start)
    kill(m)
    flown = [loading.one(seconds) for _ in range(KILLS + 1)]
    old = sum(a == b for a, b in zip(flown, flown[1:]))
    print("# %d kills of seed %d within %.1f s each: the old database is flown after %d, the new one after %d" %
          (KILLS, SEED, seconds, old, KILLS - old))


if __name__ == "__main__":
    main(boot, prepare, "amd64")
