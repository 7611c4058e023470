"""Two panels of one cockpit in one machine: two programs, two screens, one bus, and on it targets from landmass-dis."""

import os
import struct
import subprocess

from cases import case, expect, main
from fixtures import HOST, WORK, database, log, public_key, tree
from machine import Machine
from panel import GPIO, HEIGHT, PRESSED, RELEASED, WIDTH, Panel, fly, is_fine

SCREEN = "virtio-gpu-pci,xres=%d,yres=%d" % (WIDTH, HEIGHT)
DEVICES = ["-device", SCREEN + ",id=left", "-device", SCREEN + ",id=right"]
KEYS = {"key.1": "OSB12", "key.15": "OSB19"}  # mode and SWAP, on lines that have names
ECEF = (4355342.0, 846592.7, 4566935.4)       # 46.02 N, 11.00 E, 200 m above the ellipsoid (WGS-84)


def entity_state(number):
    """An Entity State PDU of DIS 7 (IEEE 1278.1-2012, 7.2.2): a tank that stands still."""
    pdu = struct.pack("!BBBBIHH", 7, 1, 1, 1, number << 16 | 1, 144, 0)
    pdu += struct.pack("!HHHBB", 1, 2, 3, 1, 0)
    pdu += struct.pack("!BBHBBBB", 1, 1, 225, 1, 1, 3, 0) * 2
    pdu += struct.pack("!3f3d3fI", 0, 0, 0, *ECEF, 0, 0, 0, 0)
    pdu += struct.pack("!B15x6f", 1, 0, 0, 0, 0, 0, 0)
    pdu += struct.pack("!B11sI", 1, b"TANK", 0)
    assert len(pdu) == 144
    return pdu


def dis_log():
    """Frames that landmass-dis makes of ten seconds of that tank; the log's path."""
    os.makedirs(WORK, exist_ok=True)
    paths = []
    for number in range(10):
        paths.append(os.path.join(WORK, "tank-%d.pdu" % number))
        with open(paths[-1], "wb") as out:
            out.write(entity_state(number))
    path = os.path.join(WORK, "dis.log")
    subprocess.run([os.path.join(HOST, "landmass-dis"), "--pdu", ",".join(paths), "--out", path, "--quiet"], check=True)
    return path


class Seat(Panel):
    """One of the two panels, with a screen, a configuration, settings and a journal of its own."""

    def __init__(self, machine, name, **settings):  # pylint: disable=super-init-not-called
        self.machine, self.name = machine, name
        chosen = {"database": "/t/small.lmdb", "database.key": "/t/public.pem", "database.serial": "none",
                  "can": "vcan0", "glass.picture": "%dx%d" % (WIDTH, HEIGHT),
                  "settings": "/tmp/%s.settings" % name, "record": "none"}
        chosen.update(settings)
        text = "".join("%s = %s\n" % item for item in chosen.items())
        machine.do("cat >/tmp/%s.conf <<'END'\n%sEND\n" % (name, text))
        self.start()

    def start(self):
        self.machine.do("landmass-panel --config /tmp/%s.conf 2>/tmp/%s.log & echo $! >/tmp/%s.pid" % ((self.name,) * 3))
        self.machine.until("grep -q 'the glass says' /tmp/%s.log" % self.name)

    def stop(self):
        self.machine.sh("p=$(cat /tmp/%s.pid); kill $p; while [ -d /proc/$p ]; do usleep 20000; done" % self.name)

    def said(self):
        return self.machine.do("cat /tmp/%s.log" % self.name)

    def report(self, part):
        self.machine.do("n=$(grep -c watchdog: /tmp/{0}.log); kill -USR1 $(cat /tmp/{0}.pid); "
                        "until [ $(grep -c watchdog: /tmp/{0}.log) -gt $n ]; do usleep 10000; done".format(self.name))
        return [line for line in self.said().splitlines() if line.startswith("landmass-panel: %s: " % part)][-1]

    def look(self, name="glass"):
        path = os.path.abspath(os.path.join(WORK, "%s-%s.png" % (name, self.name)))
        self.machine.qmp("screendump", filename=path, device=self.name, format="png")
        return path


def is_in(mode):
    """A condition of the glass's lines of text: this mode's label, and nothing wrong."""
    return lambda text: is_fine(text) and any(mode in line.split() for line in text)


def boot():
    return Machine(tree=tree(files=[log("still"), dis_log(), database("small"), public_key()]), devices=DEVICES)


def prepare(m):
    m.do("modprobe -a can_raw vcan virtio-gpu")
    m.do("ip link add vcan0 type vcan && ip link set vcan0 up")
    for name in GPIO[:6]:
        m.gpio_in(GPIO.index(name), RELEASED)
    fly(m)
    m.do("canplayer -l i -I /t/dis.log vcan0=can0 &")


def press(seat, line):
    seat.set_key(line, PRESSED)
    seat.machine.sleep(0.1)
    seat.set_key(line, RELEASED)
    seat.machine.sleep(0.1)


@case("two panels hear one bus, SWAP exchanges their pages, and one that restarts says so and has its page")
def two(m):
    left = Seat(m, "left", **{"can.node": 20, "can.partner": 21, "glass.card": "/dev/dri/card0", **KEYS})
    right = Seat(m, "right", **{"can.node": 21, "can.partner": 20, "glass.card": "/dev/dri/card1"})
    left.until(is_in("GM"))
    right.until(is_in("GM"))
    press(left, "OSB12")
    left.until(is_in("GMT"))
    press(left, "OSB19")
    right.until(is_in("GMT"))
    left.until(is_in("GM"))
    for seat in left, right:
        told = seat.report("live targets")
        expect(": 1 there" in told and " 0 torn, 0 refused" in told, told)
    m.sleep(2)  # the settings are in their file
    right.stop()
    press(left, "OSB19")
    left.until(lambda text: "NO SWAP" in text)
    right.start()
    right.until(lambda text: "RESTART" in text and any("GMT" in line.split() for line in text))
    left.until(is_in("GM"))
    press(left, "OSB19")
    left.until(is_in("GMT"))
    right.until(is_in("GM"))


if __name__ == "__main__":
    main(boot, prepare)
