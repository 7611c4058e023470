"""Debrief of a long flight in Chromium, on landmass-ios: how fast it is looked ahead, memory, and what jumps take.

Usage: debrief.py IMAGE [SECONDS]. The flight circles the image's middle for an hour unless said, through all modes."""
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / folder) for folder in ("ios", "web")]
import browser  # noqa: E402  pylint: disable=wrong-import-position
from server import BUILD, Server  # noqa: E402  pylint: disable=wrong-import-position

JUMPS = 40
MINUTE = ("0.5 gm", "8 gm exp", "16 gm dbs1", "24 gmt", "30 sea", "36 gm", "38 sarfrom {place} 2 90 15000 3000", "50 drop")


def run(program, *words):
    subprocess.run([str(BUILD / "bin" / program), *map(str, words)], check=True, stdout=subprocess.DEVNULL)


def record(folder, image, seconds, bounds):
    latitude, longitude = ((bounds[low] + bounds[high]) / 2 for low, high in (("south", "north"), ("west", "east")))
    acts = [line.format(place=f"{latitude:.5f} {longitude:.5f}").split(" ", 1) for line in MINUTE]
    lines = [f"{60 * minute + float(at):.1f} {act}\n" for minute in range(seconds // 60) for at, act in acts]
    (folder / "script").write_text("".join(lines))
    run("landmass-nav", "--circle", f"{latitude},{longitude},12000,3000,180", "--seconds", seconds, "--out", folder / "nav.log",
        "--quiet")
    run("landmass-sim", "--db", image, "--bus", folder / "nav.log", "--script", folder / "script", "--seconds", seconds, "--quiet",
        "--record", folder / "flights/hour.log")


def memory_mib(parent):
    """Resident memory of the largest process below a parent."""
    of, size = {}, {}
    for status in pathlib.Path("/proc").glob("[0-9]*/status"):
        try:
            fields = dict(line.split(":", 1) for line in status.read_text().splitlines())
        except OSError:
            continue
        of[int(fields["Pid"])], size[int(fields["Pid"])] = int(fields["PPid"]), int(fields.get("VmRSS", "0 kB").split()[0])

    def is_below(pid):
        while pid not in (0, parent):
            pid = of.get(pid, 0)
        return pid == parent
    return max(size[pid] for pid in of if is_below(pid)) / 1024


def measure(b, seconds):
    b.get("debrief.html")
    b.until("document.querySelectorAll('#recordings button').length === 1")
    begun = time.monotonic()
    b.driver.find_element("css selector", "#recordings button").click()
    while not b.ask("!!debrief.lastState?.isScouted"):
        time.sleep(0.5)
    ahead_s, took = time.monotonic() - begun, []
    for place in random.Random(1).sample(range(seconds), JUMPS):
        count = b.ask("debrief.jumps.count")
        b.ask(f"debrief.jump({place}e6)")
        b.until(f"debrief.jumps.count > {count}")
        took.append(b.ask("debrief.jumps.lastMs"))
    took.sort()
    state = b.ask("(({moments, apartUs, momentsBytes}) => [moments, apartUs / 1e6, momentsBytes / 2 ** 20])(debrief.lastState)")
    print(f"{seconds} s: looked ahead in {ahead_s:.0f} s, {seconds / ahead_s:.0f} times real time; {state[0]} key pictures, one every "
          f"{state[1]:.0f} s, {state[2]:.0f} MiB; {JUMPS} jumps: {took[JUMPS // 2] / 1000:.2f} s in the middle, "
          f"{took[-1] / 1000:.2f} s at most; the page's process {memory_mib(b.driver.service.process.pid):.0f} MiB")
    message = b.ask("document.getElementById('message').textContent")
    assert message == "", message


def main():
    image, seconds = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 3600
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "flights").mkdir()
        with Server("--image", image, "--site", BUILD / "ios", "--recordings", folder / "flights") as server:
            record(folder, image, seconds, server.json("/map.json"))
            size = os.stat(folder / "flights/hour.log").st_size
            print(f"recording of {size / 1e6:.1f} MB")
            b = browser.Browser(server.url)
            try:
                measure(b, seconds)
            finally:
                b.driver.quit()


if __name__ == "__main__":
    sys.exit(main())
