#!/usr/bin/env python3
"""Images that are made in shards: the bytes of a build in one go, whatever the cut, the order and the machine's time, over a
border of zones, the antimeridian, voids, facings and detail. What join refuses, and which keys a changed source changes.

TAP on standard output. BUILD names the build's folder.
"""

import hashlib
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import tempfile
import time

import numpy
from osgeo import gdal

from database import BUILD, CLASSES, check, db, end, good, raster, refused


def hills(shape, seed, low=-20, high=900):
    numbers = numpy.random.default_rng(seed).normal(size=shape)
    for axis in (0, 1):
        for _ in range(3):
            numbers = sum(numpy.roll(numbers, k, axis) for k in range(-4, 5))
    numbers = (numbers - numbers.min()) / (numbers.max() - numbers.min())
    return (low + (high - low) * numbers).astype(numpy.float32)


def digest(path):
    return hashlib.sha256(open(path, "rb").read()).hexdigest()


def shards(plan):
    return [line.split() for line in open(plan) if line.startswith("shard ")]


def keys(plan):
    return [words[-1] for words in shards(plan)]


def make_parts(plan, folder):
    """In any order. Returns what each said."""
    os.makedirs(folder, exist_ok=True)
    numbers = list(range(len(shards(plan))))
    random.Random(7).shuffle(numbers)
    said = {}
    for number in numbers:
        out = "%s/%d.part" % (folder, number)
        good("build", "--plan", plan, "--shard", str(number), "--out", out, "--json", "shard.json")
        said[number] = json.load(open("shard.json"))["report"]
    return said


def parts_of(folder):
    names = sorted(os.listdir(folder))
    random.Random(len(names)).shuffle(names)
    return [word for name in names for word in ("--part", "%s/%s" % (folder, name))]


def same_bytes(what, options, counts):
    good("build", *options, "--jobs", "1", "--out", "whole.lmdb")
    for count in counts:
        plan, folder = "%d.plan" % count, "parts-%d" % count
        good("plan", *options, "--shards", str(count), "--out", plan)
        said = make_parts(plan, folder)
        good("join", plan, *parts_of(folder), "--out", "joined.lmdb")
        check("%s in %d shards, shuffled: the bytes of a build in one go" % (what, len(said)),
              len(said) >= count and digest("joined.lmdb") == digest("whole.lmdb"))
        told = {int(words[1]): int(words[9]) for words in shards(plan)}
        over = {n: (r["memory_mib"], told[n]) for n, r in said.items() if r["memory_mib"] > told[n]}
        check("and no shard takes more memory than the plan says, nor does the plan say more than 1 GiB",
              not over and max(told.values()) <= 1024, str(over))


def scene():
    subprocess.run([BUILD + "/bin/landmass-scene", "--out", "scene", "--size", "320"], check=True, capture_output=True)
    subprocess.run([BUILD + "/bin/landmass-scene", "--out", "far", "--size", "200", "--cell", "50"], check=True,
                   capture_output=True)
    return ["--classes", CLASSES, "--class-raster", "scene/truth.tif", "--terrain", "scene/terrain.tif", "--terrain",
            "far/terrain.tif", "--heights", "scene/heights.tif", "--detail", "scene/detail.txt", "--seed", "3", "--title", "a b#c"]


def refusals(options):
    good("build", *options, "--out", "whole.lmdb")
    plan, parts = "4.plan", "parts-4"
    done = db("join", plan, *parts_of(parts)[2:], "--out", "new.lmdb")
    lost = 4 - len(parts_of(parts)[2:]) // 2
    refused("a missing part is refused, and its shard is named", done, "shard ", "is missing")
    check("and no image is there", lost == 1 and not os.path.exists("new.lmdb"))
    refused("a part that is given twice is refused by its name",
            db("join", plan, *parts_of(parts), "--part", parts + "/2.part", "--out", "new.lmdb"), "2.part", "is shard 2, and so is")
    refused("a part of another cut is refused by its name",
            db("join", plan, "--part", "parts-9/0.part", "--out", "new.lmdb"), "0.part", "is shard 0 of")
    refused("a file that is no part is refused", db("join", plan, "--part", CLASSES, "--out", "new.lmdb"), "heaton6.classes")
    whole = open(parts + "/1.part", "rb").read()
    for name, at in (("header", 40), ("counts", 300), ("tiles", 5000), ("index", len(whole) - 8)):
        damaged = bytearray(whole)
        damaged[at] ^= 4
        os.makedirs("bad", exist_ok=True)
        open("bad/1.part", "wb").write(damaged)
        refused("a flipped bit of its %s is seen" % name, db("join", plan, "--part", "bad/1.part", "--out", "new.lmdb"), "bad/1.part")
    open("bad/1.part", "wb").write(whole[:-1000])
    refused("a part that was cut short is refused", db("join", plan, "--part", "bad/1.part", "--out", "new.lmdb"), "bad/1.part")
    text = open(plan).read()
    open("bad.plan", "w").write(text.replace("heights 0 ", "heights 0 1 ", 1))
    refused("a plan that somebody changed is refused", db("build", "--plan", "bad.plan", "--shard", "0", "--out", "x.part"), "bad.plan")
    refused("a shard that the plan does not have is refused",
            db("build", "--plan", plan, "--shard", "99", "--out", "x.part"), "--shard")
    here = set(os.listdir("."))
    done = db("build", "--plan", plan, "--shard", "2", "--out", "x.part", limit=(resource.RLIMIT_FSIZE, (200000, 200000)))
    refused("a full disk is refused, and the shard is named", done, "x.part: cannot be written", "shard 2 could not be made")
    check("and leaves nothing", set(os.listdir(".")) == here, str(set(os.listdir(".")) - here))


def changes():
    """Four files of terrain side by side: a change in one of them is a change of the shards around it."""
    whole = hills((240, 240), 5)
    whole[0, 0], whole[-1, -1] = -20, 900
    names = []
    for i in range(4):
        name = "dem%d.tif" % i
        row, column = i // 2 * 120, i % 2 * 120
        raster(name, 4326, 10 + column / 240, 45 - row / 240, 1 / 240, whole[row:row + 120, column:column + 120], gdal.GDT_Float32)
        names += ["--terrain", name]
    options = ["--classes", CLASSES, *names, "--cell", "150", "--seed", "1"]
    good("plan", *options, "--shards", "16", "--out", "before.plan")
    make_parts("before.plan", "kept")
    table = [line for line in open("before.plan") if line.startswith("heights ")]
    block = whole[:120, :120].copy()
    block[55:60, 55:60] += 0.5
    raster("dem0.tif", 4326, 10, 45, 1 / 240, block, gdal.GDT_Float32)
    place = [int(words[1]) for words in shards("before.plan")
             if db("build", "--plan", "before.plan", "--shard", words[1], "--out", "x.part").returncode == 1]
    good("plan", *options, "--shards", "16", "--out", "after.plan")
    assert table == [line for line in open("after.plan") if line.startswith("heights ")], "choose another change"
    before, after = keys("before.plan"), keys("after.plan")
    changed = [i for i, pair in enumerate(zip(before, after)) if pair[0] != pair[1]]
    check("shards of the old plan that the change reaches are refused, and no others", 0 < len(place) < 10, str(place))
    check("a changed source changes the keys of the shards that it reaches, and no others", changed == place, "%s, refused %s of %d" % (changed, place, len(before)))
    for number in changed:
        good("build", "--plan", "after.plan", "--shard", str(number), "--out", "kept/%d.part" % number)
    good("build", *options, "--out", "whole.lmdb")
    good("join", "after.plan", *parts_of("kept"), "--out", "joined.lmdb")
    check("and with these alone made again the image is that of a build in one go", digest("joined.lmdb") == digest("whole.lmdb"))
    os.utime("dem3.tif", (1, 1))
    done = db("build", "--plan", "after.plan", "--shard", "15", "--out", "x.part")
    check("a source that was only touched is still the same", done.returncode == 0, done.stderr)
    os.makedirs("named", exist_ok=True)
    for number, key in enumerate(after):
        shutil.copy("kept/%d.part" % number, "named/%s.part" % key)
    good("join", "after.plan", "--parts", "named", "--out", "named.lmdb")
    check("a folder of parts named by their keys joins, too", digest("named.lmdb") == digest("whole.lmdb"))


def of(parent):
    """Processes that one has begun."""
    with open("/proc/%d/task/%d/children" % (parent, parent)) as file:
        return [int(word) for word in file.read().split()]


def is_alive(process):
    try:
        with open("/proc/%d/stat" % process) as file:
            return file.read().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def start_workers(options):
    """A build with two workers, both at work. Returns it and them."""
    words = [BUILD + "/bin/landmass-db", "build", *options, "--jobs", "2", "--out", "made/new.lmdb"]
    build = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    children = []
    while build.poll() is None and sum(name.endswith(".part") for name in os.listdir("made")) < 2:
        children = of(build.pid)
    return build, children


def workers():
    """A build whose tiles are made by several processes."""
    raster("hills.tif", 4326, 10, 45, 1 / 1200, hills((480, 480), 9), gdal.GDT_Float32)
    options = ["--classes", CLASSES, "--terrain", "hills.tif", "--cell", "19", "--seed", "1"]
    os.makedirs("made", exist_ok=True)
    done = good("build", *options, "--jobs", "1", "--out", "whole.lmdb")
    shared = good("build", *options, "--jobs", "3", "--out", "made/joined.lmdb")
    check("made by three processes it is the same bytes", digest("made/joined.lmdb") == digest("whole.lmdb"))
    check("and the same report, but for the time", done.stdout.rpartition("done in")[0] == shared.stdout.rpartition("done in")[0]
          and done.stderr == shared.stderr, shared.stdout + shared.stderr)
    check("and nothing else is left", os.listdir("made") == ["joined.lmdb"], str(os.listdir("made")))
    done = db("build", *options, "--jobs", "2", "--out", "made/new.lmdb", limit=(resource.RLIMIT_FSIZE, (200000, 200000)))
    refused("a full disk is refused, with what the worker said", done, "cannot be written", "made/new.lmdb: shard ", "could not be made")
    check("and leaves nothing, nor a worker", os.listdir("made") == ["joined.lmdb"], str(os.listdir("made")))
    build, children = start_workers(options)
    os.kill(children[0], signal.SIGKILL)
    said = build.communicate(timeout=300)[1]
    check("a worker that is killed is told, with its shard", build.returncode == 1 and "was ended by signal 9" in said
          and "made/new.lmdb: shard " in said, said)
    check("the others end, and nothing is left", not any(map(is_alive, children)) and os.listdir("made") == ["joined.lmdb"],
          str(os.listdir("made")))
    build, children = start_workers(options)
    build.terminate()
    build.communicate(timeout=300)
    until = time.monotonic() + 60
    while time.monotonic() < until and any(map(is_alive, children)):
        time.sleep(0.05)
    check("workers end with a build that is stopped, and nothing is left", len(children) == 2 and not any(map(is_alive, children))
          and os.listdir("made") == ["joined.lmdb"], str(os.listdir("made")))


def reach():
    """Four files of classes side by side, and one of them lost: shards that lie elsewhere do without it."""
    names = []
    for i in range(4):
        names.append("classes%d.tif" % i)
        values = numpy.random.default_rng(i).integers(0, 6, (300, 300)).astype(numpy.uint8)
        raster(names[-1], 4326, 10 + i % 2 * 0.5, 45 - i // 2 * 0.5, 0.5 / 300, values, gdal.GDT_Byte)
    gdal.BuildVRT("classes.vrt", names)
    good("plan", "--classes", CLASSES, "--class-raster", "classes.vrt", "--flat", "--cell", "150", "--shards", "16", "--out", "reach.plan")
    os.remove("classes3.tif")
    made = [db("build", "--plan", "reach.plan", "--shard", words[1], "--out", "x.part").returncode == 0 for words in shards("reach.plan")]
    check("a shard reads the class raster where it lies, and not all of it", 0 < sum(made) < len(made), str(made))


def main():
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        options = scene()
        same_bytes("the built-in scene with detail, heights and facings", options, (1, 4, 9))
        refusals(options)
        changes()
        workers()
        reach()
        # 61.875 north is a border of zones; 179.6 to 180.4 east.
        ground = hills((320, 320), 3)
        ground[100:130, 140:180] = -9999
        ground[10:14, 10:14] = -9999
        raster("seam.tif", 4326, 179.6, 62.3, 1 / 400, ground, gdal.GDT_Float32, -9999)
        raster("cover.tif", 4326, 179.9, 62.0, 1 / 1600, numpy.random.default_rng(2).integers(0, 6, (32, 40)).repeat(10, 0).repeat(10, 1)
               .astype(numpy.uint8), gdal.GDT_Byte)
        same_bytes("a border of zones, the antimeridian and voids", ["--classes", CLASSES, "--terrain", "seam.tif", "--class-raster",
                                                                     "cover.tif", "--cell", "40", "--geoid-grid", "egm96"], (5,))
        end()


main()
