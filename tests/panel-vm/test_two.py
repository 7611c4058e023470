"""Two panels of one cockpit in one machine: two programs, two screens, one bus, and on it targets from landmass-dis."""

import os
import subprocess

from cases import case, expect, main
from fixtures import HOST, WORK, database, log, public_key, tree
from machine import Machine
from panel import GPIO, PRESSED, RELEASED, fly, is_fine
from seats import SCREENS, Seat, entity_state

KEYS = {"key.1": "OSB12", "key.15": "OSB19"}  # mode and SWAP, on lines that have names


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


def is_in(mode):
    """A condition of the glass's lines of text: this mode's label, and nothing wrong."""
    return lambda text: is_fine(text) and any(mode in line.split() for line in text)


def boot():
    return Machine(tree=tree(files=[log("still"), dis_log(), database("small"), public_key()]), devices=SCREENS)


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


def has_target(seat):
    """The tank comes, which is told once a second."""
    for _ in range(30):
        told = seat.report("live targets")
        if ": 1 there" in told and " 0 torn, 0 refused" in told:
            return True
        seat.machine.sleep(0.5)
    return False


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
        expect(has_target(seat), seat.report("live targets"))
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
