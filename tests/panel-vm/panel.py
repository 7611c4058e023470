"""The panel in a Machine: configured, started, operated and looked at."""

import os
import re
import shutil
import subprocess
import time

from fixtures import HOST, WORK, database, log

WIDTH, HEIGHT = 640, 480
SECTOR = ["96", "100", "444", "280"]  # X Y WIDTH HEIGHT of the radar picture, without marks that a freeze removes
with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "gpio-lines.txt"), encoding="utf-8") as lines:
    GPIO = [line.strip() for line in lines if not line.startswith("#")]
RELEASED, PRESSED = 1, 0  # as the configuration has it by default: keys draw their lines to ground
SETTINGS = {"database": "/t/small.lmdb", "database.key": "/t/public.pem", "database.serial": "/tmp/serial",
            "can": "vcan0", "glass.picture": "%dx%d" % (WIDTH, HEIGHT)}
BEZEL = {"key.7": "OSB7", "key.12": "OSB12", "key.13": "OSB13", "key.14": "OSB14", "key.19": "OSB19",
         "key.designate": "DESIGNATE", "led.fault": "LED-FAULT", "led.alive": "LED-ALIVE"}


def land(m):
    """No more traffic."""
    m.sh("kill $(pidof canplayer); while pidof canplayer; do usleep 10000; done")


def fly(m, name="still"):
    """Traffic of a flight on the bus, from its beginning, for ever. What 10 ms bring is sent together: the machine awakes a
    hundred times a second for it and not a thousand times, which would be half of its work."""
    land(m)
    m.do("canplayer -g 10 -l i -I /t/%s.log vcan0=can0 &" % name)


# What the lines of text on the glass tell.
def is_flagged(text):
    return "NAV" in text


def is_removed(text):
    return "NAV FAIL" in text


def is_fine(text):
    return not any(word in text for word in ("NAV", "NAV FAIL", "BUS", "DB FAIL", "TILE"))


def _glass(*words):
    tool = os.path.join(HOST, "tests/panel-vm/glass")
    return subprocess.run([tool, *words], capture_output=True, text=True, check=True).stdout


def differences(screen, picture, turn=0):
    """How many pixels of the screen are not as when it shows the picture turned, in its middle."""
    return int(_glass("differ", screen, picture, str(turn)))


def strangers(screen, film):
    """How many pixels of the radar picture on the screen come from no moment of a film."""
    return int(_glass("among", screen, *SECTOR, *film))


def bench(name, flight, script="", seconds=10, size=(WIDTH, HEIGHT), every=0):
    """What the bench shows of a flight and the small database, operated by a script: the pictures, in their order."""
    folder = os.path.join(WORK, "bench-" + name)
    shutil.rmtree(folder, ignore_errors=True)
    with open(os.path.join(WORK, name + ".script"), "w", encoding="utf-8") as out:
        out.write(script)
    subprocess.run([os.path.join(HOST, "landmass-sim"), "--db", database("small"), "--bus", log(flight), "--script",
                    out.name, "--png", folder, "--every", str(every), "--size", "%dx%d" % size, "--seconds", str(seconds),
                    "--quiet"], check=True)
    return [os.path.join(folder, picture) for picture in sorted(os.listdir(folder))]


class Panel:
    """The program, running from here on; settings given here stand in for those above. `delivered`: with the
    configuration of its package instead. `environment`: variables, as a shell takes them."""

    def __init__(self, machine, environment="", bezel=True, delivered=False, **settings):
        self.machine = machine
        self.stop()
        chosen = {**SETTINGS, **(BEZEL if bezel else {})}
        chosen.update((name.replace("__", "."), value) for name, value in settings.items())
        text = "".join("%s = %s\n" % item for item in chosen.items())
        machine.do("cat >/tmp/panel.conf <<'END'\n%sEND\n" % text)
        machine.do("%s landmass-panel %s 2>/tmp/panel.log &" % (
            environment, "" if delivered else "--config /tmp/panel.conf"))
        machine.until("grep -q 'the glass says' /tmp/panel.log")

    def stop(self):
        """End it as its user does."""
        self.machine.sh("kill $(pidof landmass-panel); while pidof landmass-panel; do usleep 20000; done")

    def said(self):
        """What it wrote to its journal."""
        return self.machine.do("cat /tmp/panel.log")

    def report(self, part):
        """Its counters of a part ("bus", "flash", "glass"), by their first word."""
        self.machine.do("n=$(grep -c watchdog: /tmp/panel.log); kill -USR1 $(pidof landmass-panel); "
                        "until [ $(grep -c watchdog: /tmp/panel.log) -gt $n ]; do usleep 10000; done")
        line = [line for line in self.said().splitlines() if line.startswith("landmass-panel: %s: " % part)][-1]
        return {name: int(number) for number, name in re.findall(r"(\d+) (\w+)", line)}

    # ---- the glass ----

    def look(self, name="glass"):
        """A picture of the glass."""
        return self.machine.screendump(os.path.join(WORK, name + ".png"))

    def read(self):
        """The lines of text on the glass."""
        return _glass("text", self.look()).splitlines()

    def until(self, condition, limit_s=90):
        """Look at the glass until the condition holds of its lines of text; these."""
        deadline = time.monotonic() + limit_s
        while True:
            text = self.read()
            if condition(text):
                return text
            if time.monotonic() > deadline:
                raise AssertionError("not within %g s; the glass says %s; %s" % (limit_s, text, self.said()[-1000:]))
            time.sleep(0.05)

    def is_alive(self):
        """Whether the hand turns."""
        first = self.look("hand")
        for _ in range(40):
            self.machine.sleep(0.05)
            with open(first, "rb") as before, open(self.look("hand-later"), "rb") as after:
                is_same = before.read() == after.read()
            if not is_same:
                return True
        return False

    def counter(self, name):
        """A number of the BIT page, which must be on the glass."""
        for line in self.read():
            words = line.split("  ")
            words = [word.strip() for word in words if word.strip()]
            if name in words:
                return int(words[words.index(name) + 1])
        raise AssertionError("no %s on the glass: %s" % (name, self.read()))

    # ---- the keys ----

    def set_key(self, name, level):
        """Set the line of a key, which may bounce or stay."""
        self.machine.gpio_in(GPIO.index(name), level)

    def press(self, name):
        """Press a key and let it go."""
        self.set_key(name, PRESSED)
        self.machine.sleep(0.1)
        self.set_key(name, RELEASED)
        self.machine.sleep(0.1)


def in_flight(m, flight="still", **settings):
    """A panel whose glass shows the picture of a flight."""
    fly(m, flight)
    p = Panel(m, **settings)
    p.until(is_fine)
    return p
