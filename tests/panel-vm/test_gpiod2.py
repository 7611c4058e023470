"""The GPIO driver over Debian 13's libgpiod 2, the real library on a real kernel. The panel of Debian 12 has 1.6 (test_panel)."""

import os
import re
import shutil
import subprocess

import machine
from cases import case, expect, main
from fixtures import WORK
from machine import FOLDER, Machine
from panel import GPIO, PRESSED, RELEASED

HERE = os.path.dirname(os.path.abspath(__file__))
MADE = os.path.join(FOLDER, "gpiod2")
RUN = "/t/ld-linux-aarch64.so.1 --library-path /t /t/gpio_probe"
HOST_SETUP = machine.setup


def setup(arch):
    """The machine of the other tests, and the probe. None, or why that is impossible here."""
    reason = HOST_SETUP(arch)
    if reason:
        return reason
    done = subprocess.run(["sh", os.path.join(HERE, "setup_gpiod2.sh"), MADE], capture_output=True, text=True, check=False)
    return None if done.returncode == 0 else (done.stderr.strip().splitlines() or ["setup_gpiod2.sh failed"])[-1]


def boot():
    top = os.path.join(WORK, "tree-gpiod2")
    shutil.rmtree(top, ignore_errors=True)
    shutil.copytree(os.path.join(MADE, "t"), os.path.join(top, "t"))
    return Machine(tree=top, limit_s=400)


def prepare(m):
    for name in GPIO[:6]:
        m.gpio_in(GPIO.index(name), RELEASED)


def start(m, *inputs):
    """The probe in the background, until it has its lines."""
    m.do("%s 600 LED-ALIVE %s >/tmp/probe 2>&1 & echo $! >/tmp/pid" % (RUN, " ".join(inputs)))
    return m.until("grep '^open' /tmp/probe", 60)


def stop(m):
    m.do("p=$(cat /tmp/pid); kill $p; while [ -d /proc/$p ]; do usleep 20000; done")


def last(m):
    """The levels that it saw last, bit by bit, and whether its lamp is lit."""
    words = m.do("grep '^edges' /tmp/probe | tail -n 1")
    found = re.match(r"edges [0-9a-f]+ levels ([0-9a-f]+) lit (\d)", words)
    return (int(found.group(1), 16), int(found.group(2))) if found else (0, 0)


@case("lines are found by their names and by chip and number; keys are seen by their edges, lamps are lit")
def lines(m):
    said = start(m, "OSB7", "OSB12", "9030000.pl061:2")
    expect("3 inputs, levels 0" in said, said)
    for bit, name in enumerate(("OSB7", "OSB12", "OSB13")):
        for level, wanted in ((PRESSED, 1 << bit), (RELEASED, 0)):
            count = int(m.do("grep -c '^edges' /tmp/probe || true"))
            m.gpio_in(GPIO.index(name), level)
            m.until("[ $(grep -c '^edges' /tmp/probe) -gt %d ]" % count, 60)
            levels, lit = last(m)
            expect(levels == wanted, name, level, levels)
            m.sleep(0.05)
            expect(m.gpio_out(GPIO.index("LED-ALIVE")) == lit, "the lamp is not as it was told")
    expect("silent" not in m.do("cat /tmp/probe"), "a change came without an edge")
    stop(m)


@case("when the kernel's queue of edges overflows the level is right all the same")
def overflow(m):
    start(m, "OSB7")
    m.do("kill -STOP $(cat /tmp/pid)")
    for _ in range(40):
        m.gpio_in(GPIO.index("OSB7"), PRESSED)
        m.gpio_in(GPIO.index("OSB7"), RELEASED)
    m.gpio_in(GPIO.index("OSB7"), PRESSED)
    m.do("kill -CONT $(cat /tmp/pid)")
    m.until("grep -q '^edges' /tmp/probe", 60)
    expect(last(m)[0] == 1, last(m))
    m.gpio_in(GPIO.index("OSB7"), RELEASED)
    stop(m)


@case("a line that is not there, or that somebody has, is told by name")
def refused(m):
    start(m, "OSB7", "NOWHERE", "9030000.pl061:99")
    said = m.do("cat /tmp/probe")
    expect("fault NOWHERE: " in said and "fault 9030000.pl061:99: " in said and "open 1 inputs" in said, said)
    again = m.sh(RUN + " 1 LED-FAULT OSB7 OSB12")[1]
    expect("fault OSB7: " in again and "busy" in again.lower() and "open 1 inputs" in again, again)
    stop(m)
    expect("open 1 inputs" in m.do(RUN + " 1 LED-FAULT OSB7"), "the line is not given back")


if __name__ == "__main__":
    machine.setup = setup
    main(boot, prepare)
