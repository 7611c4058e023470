#!/usr/bin/env python3
"""Work that takes long shows how far it is: on a terminal each command draws its bars and takes them away again, and where
standard error is no terminal nothing of them is seen.

TAP on standard output. BUILD names the build's folder. What is run is small; that the bars move is seen by their last state.
"""

import os
import pty
import re
import shutil
import subprocess
import sys
import traceback

BUILD = os.environ.get("BUILD", "build/bench-linux")
WORK = os.path.join(BUILD, "tmp/progress")
CLASSES = "host-sim/programs/db/classes/heaton6.classes"
TAKEN_AWAY = "\r\033[K"
BAR = re.compile(r"\r(\S[\w .,-]*?) +\[([#.]{40})\] +([\d.]+) %")


def here(name):
    return os.path.join(WORK, name)


# Each with the labels of its bars. In this order: some read what others wrote.
COMMANDS = [
    (["scene", "--out", here("scene"), "--size", "256"], ["eroding", "laying the land", "painting the scene", "imaging the scene"]),
    (["db", "train", "--image", here("scene/image.tif"), "--exemplars", here("scene/exemplars.geojson"), "--classes", CLASSES,
      "--net", here("net"), "--epochs", "3"], ["exemplars", "training"]),
    (["db", "segment", "--image", here("scene/image.tif"), "--classes", CLASSES, "--net", here("net"), "--out", here("seg.tif")],
     ["segment"]),
    (["db", "reflect", "--class-raster", here("scene/truth.tif"), "--classes", CLASSES, "--method", "assign", "--out",
      here("gamma.tif")], ["reflect"]),
    (["db", "build", "--classes", CLASSES, "--terrain", here("scene/terrain.tif"), "--class-raster", here("scene/truth.tif"),
      "--detail", here("scene/detail.txt"), "--out", here("image.lmdb")], ["facings", "building", "storing tiles"]),
    (["db", "verify", here("image.lmdb")], ["verifying"]),
    (["load", "put", here("image.lmdb"), "--unsigned", "--slot-a", here("slot-a"), "--slot-b", here("slot-b")],
     ["checking the file", "writing", "checking the slot"]),
    (["load", "verify", "--slot-a", here("slot-a"), "--slot-b", here("slot-b")], ["checking slot A"]),
    (["db", "export", here("image.lmdb"), "--out", here("planes")], ["elevation"]),
    (["db", "picture", here("image.lmdb"), "--plane", "shade", "--out", here("shade.png")], ["shade"]),
    (["nav", "--straight", "42.0,-29.0,90,3000,180", "--seconds", "20", "--out", here("flight.log")], ["sending"]),
    (["bus", "decode", here("flight.log"), "--out", here("flight.txt")], ["decoding"]),
    (["sim", "--db", here("image.lmdb"), "--bus", here("flight.log"), "--seconds", "1"], ["flying"]),
    (["reference", "sar", here("image.lmdb"), "--cells", "32", "--out", here("sar.csv")], ["lines"]),
    (["reference", "gm", here("image.lmdb"), "--cells", "32", "--out", here("gm.csv")], ["lines"]),
    (["reference", "sector", here("image.lmdb"), "--cells", "32", "--out", here("sector.csv")], ["lines"]),
    (["target", "bake", "--model", "tank", "--rays", "1", "--aspects", "4", "--depressions", "10", "--out", here("tank.sig")], ["looks"]),
]


def program(words):
    return [os.path.join(BUILD, "bin/landmass-" + words[0]), *words[1:]]


def on_a_terminal(words, output=subprocess.DEVNULL):
    """What the run writes to standard error when that is a terminal; standard output is none, unless told."""
    master, slave = pty.openpty()
    run = subprocess.Popen(program(words), stdin=subprocess.DEVNULL, stdout=slave if output is None else output, stderr=slave)
    os.close(slave)
    text = b""
    while True:
        try:
            part = os.read(master, 65536)
        except OSError:
            break
        if not part:
            break
        text += part
    os.close(master)
    assert run.wait(timeout=300) == 0, text
    return text.decode()


def draws_its_bars(words, labels):
    text = on_a_terminal(words)
    bars = {}
    for label, hashes, percent in BAR.findall(text):
        bars.setdefault(label, []).append((hashes.count("#"), float(percent)))
    for label in labels:
        assert label in bars, "no bar %s, but %s" % (label, sorted(bars))
        states = bars[label]
        assert states[0][1] == 0 and max(percent for _, percent in states) > 60, (label, states[-3:])
        assert all(count == int(percent * 40 // 100) for count, percent in states), (label, states)
    assert TAKEN_AWAY in text and "[" not in text.rsplit(TAKEN_AWAY, 1)[1], text[-200:]


def is_silent_elsewhere(words, _):
    done = subprocess.run(program(words), capture_output=True, stdin=subprocess.DEVNULL, timeout=300)
    assert done.returncode == 0 and b"[####" not in done.stderr and b"\033" not in done.stderr, done.stderr[-300:]
    assert b"[####" not in done.stdout


def lines_on_the_terminal_stand_for_a_bar():
    """What is printed shows how far the work is; a bar between the lines would spoil them."""
    text = on_a_terminal(["bus", "decode", here("flight.log")], output=None)
    assert "latitude" in text and not BAR.search(text) and TAKEN_AWAY not in text


def main():
    shutil.rmtree(WORK, ignore_errors=True)
    os.makedirs(WORK)
    cases = [("%s %s shows its progress on a terminal" % (w[0], w[1]), draws_its_bars, (w, labels)) for w, labels in COMMANDS]
    cases += [("%s %s shows none where there is no terminal" % (w[0], w[1]), is_silent_elsewhere, (w, labels))
              for w, labels in COMMANDS if w[0] in ("db", "bus", "nav")]
    cases += [("lines on the terminal stand for a bar", lines_on_the_terminal_stand_for_a_bar, ())]
    print("1..%d" % len(cases))
    failed = 0
    for number, (name, case, arguments) in enumerate(cases, 1):
        try:
            case(*arguments)
            print("ok %d - %s" % (number, name))
        except Exception:
            failed += 1
            print("not ok %d - %s" % (number, name))
            print("# %s" % traceback.format_exc().strip().replace("\n", "\n# "))
    sys.exit(failed > 0)


main()
