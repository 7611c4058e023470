#!/usr/bin/env python3
"""landmass-load, killed at drawn moments on real files (SIGKILL): after each kill one slot is whole, and it holds one of the
two databases byte for byte; a load that is left alone comes to its end. What power does besides, test_cuts draws.

TAP on standard output. BUILD names the build's folder; LANDMASS_KILLS how many, LANDMASS_SEED from which seed.
"""

import json
import os
import random
import shutil
import subprocess
import sys
import time

BUILD = os.environ.get("BUILD", "build/bench-linux")
LOAD = os.path.join(BUILD, "bin/landmass-load")
WORK = os.path.join(BUILD, "tmp/kills")
KILLS = int(os.environ.get("LANDMASS_KILLS", "200"))
SEED = int(os.environ.get("LANDMASS_SEED", "1"))
CLASSES = "host-sim/programs/db/classes/heaton6.classes"


def here(name):
    return os.path.join(WORK, name)


SLOTS = ["--slot-a", here("slot-a"), "--slot-b", here("slot-b")]


def prepare():
    shutil.rmtree(WORK, ignore_errors=True)
    os.makedirs(WORK)
    subprocess.run([os.path.join(BUILD, "bin/landmass-scene"), "--out", here("scene"), "--size", "512"], check=True,
                   capture_output=True)
    for number, cell in enumerate((10, 14)):
        subprocess.run([os.path.join(BUILD, "bin/landmass-db"), "build", "--classes", CLASSES, "--terrain",
                        here("scene/terrain.tif"), "--class-raster", here("scene/truth.tif"), "--cell", str(cell), "--title",
                        "image %d" % number, "--out", here("image%d" % number)], check=True, capture_output=True)
    images = []
    for number in range(2):
        with open(here("image%d" % number), "rb") as file:
            images.append(file.read())
    assert images[0] != images[1]
    return images


def put(number, **options):
    return subprocess.Popen([LOAD, "put", here("image%d" % number), "--unsigned", *SLOTS], stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL, **options)


def flown(images):
    """Which image the next start flies."""
    done = subprocess.run([LOAD, "show", *SLOTS, "--json", "-"], capture_output=True)
    slots = json.loads(done.stdout)["report"]["slots"]
    chosen = [slot for slot in slots if slot["is_flown_next"]]
    assert len(chosen) == 1, slots
    assert not [slot for slot in slots if slot["state"] == "damaged"], slots
    with open(chosen[0]["path"], "rb") as file:
        return images.index(file.read())


def time_of_a_load():
    start = time.monotonic()
    assert put(0).wait() == 0
    first = time.monotonic() - start
    start = time.monotonic()
    assert put(1).wait() == 0
    return max(first, time.monotonic() - start)


def kill_and_look(images):
    draw = random.Random(SEED)
    longest = time_of_a_load()
    now, done, old, new = flown(images), 0, 0, 0
    while done < KILLS:
        wanted = 1 - now
        load = put(wanted)
        time.sleep(draw.random() * longest)
        load.kill()
        ended = load.wait() == 0
        done += not ended
        after = flown(images)
        assert after == wanted or not ended, "a load that had come to its end is not flown"
        old, new = old + (after == now), new + (after == wanted)
        if after == now and draw.random() < 0.2:
            assert put(wanted).wait() == 0 and flown(images) == wanted, "a load that is left alone does not come to its end"
            after = wanted
        now = after
    print("# %d kills of seed %d within %.0f ms each: the old database is flown after %d, the new one after %d" %
          (done, SEED, 1000 * longest, old, new))
    assert old > KILLS // 10, "nothing was cut off"


def two_loads_at_once(images):
    """One waits for nobody: it says that the slot is in use, or the other one had come to its end."""
    for _ in range(20):
        both = [put(number) for number in (0, 1)]
        codes = [load.wait() for load in both]
        assert 0 in codes, codes
        flown(images)


def main():
    images = prepare()
    cases = [kill_and_look, two_loads_at_once]
    print("1..%d" % len(cases))
    failed = 0
    for number, case in enumerate(cases, 1):
        try:
            case(images)
            print("ok %d - %s" % (number, case.__name__.replace("_", " ")))
        except AssertionError as wrong:
            failed += 1
            print("not ok %d - %s\n# %s" % (number, case.__name__.replace("_", " "), wrong))
    sys.exit(failed > 0)


main()
