"""Two panels in one machine: two programs with a screen, a configuration, settings and a journal each. And a tank."""

import os
import struct

from fixtures import WORK
from panel import HEIGHT, WIDTH, Panel

SCREEN = "virtio-gpu-pci,xres=%d,yres=%d" % (WIDTH, HEIGHT)
SCREENS = ["-device", SCREEN + ",id=left", "-device", SCREEN + ",id=right"]
ECEF = (4355342.0, 846592.7, 4566935.4)  # 46.02 N, 11.00 E, 200 m above the ellipsoid (WGS-84)


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
