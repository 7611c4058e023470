#!/usr/bin/env python3
"""The workflow of a world, on the cores of this machine and on two nodes of Slurm: the bytes of a build in one go after a
killed engine, a killed node, a killed head and a full disk, or a plain refusal that names the shard.

TAP on standard output. BUILD names the build's folder.
"""

import hashlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import numpy as np
from osgeo import gdal, osr

import cluster

sys.path.insert(0, os.path.abspath("host-sim/world"))
import earth  # noqa: E402

gdal.UseExceptions()
BUILD = os.path.abspath(os.environ.get("BUILD", "build/bench-linux"))
TOP = os.path.abspath(".")
WORLD = TOP + "/host-sim/world"
CLASSES = TOP + "/host-sim/programs/db/classes/heaton6.classes"
OPTIONS = "--classes %s --class-raster scene/truth.tif --terrain scene/terrain.tif --heights scene/heights.tif --detail " \
          "scene/detail.txt --seed 3" % CLASSES
CHECKS = []


def check(name, is_true, why=""):
    CHECKS.append(is_true)
    print(("ok " if is_true else "not ok ") + "%d - %s" % (len(CHECKS), name), flush=True)
    if not is_true and why:
        print("# " + why.strip()[-9000:].replace("\n", "\n# "), flush=True)


def skip(name, why):
    CHECKS.append(True)
    print("ok %d - %s # SKIP\n# skipped: %s" % (len(CHECKS), name, why), flush=True)


def start(*words, db=None, environment=None, shards=6, retries=2, options=OPTIONS, config=()):
    """The workflow; its messages go to engine.log. CI=true: Snakemake looks at a cluster's steps each second, not each ten."""
    command = ["snakemake", "-s", WORLD + "/Snakefile", "--nolock", "--rerun-triggers", "mtime", "--rerun-incomplete", *words,
               "--config", "db=" + (db or BUILD + "/bin/landmass-db"), "options=" + options, "out=world.lmdb", "work=work", "shards=%d" % shards,
               "retries=%d" % retries, *config]
    return subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=open("engine.log", "w"), stderr=subprocess.STDOUT,
                            env=dict(environment or os.environ, CI="true"), start_new_session=True)


def log():
    return open("engine.log", errors="replace").read()


def digest(path):
    return hashlib.sha256(open(path, "rb").read()).hexdigest() if os.path.exists(path) else None


def clean():
    for name in ("work", ".snakemake"):
        shutil.rmtree(name, ignore_errors=True)
    if os.path.exists("world.lmdb"):
        os.unlink("world.lmdb")


def parts():
    return {name: os.stat("work/parts/" + name).st_mtime_ns for name in os.listdir("work/parts") if name.endswith(".part")} \
        if os.path.isdir("work/parts") else {}


def wait_for(process, is_true, seconds=200):
    """Until something is so, while the engine runs."""
    end = time.time() + seconds
    while not is_true() and process.poll() is None and time.time() < end:
        time.sleep(0.05)
    return is_true() and process.poll() is None


def other_db(path, before_a_shard):
    """A landmass-db that does something before it makes a shard: waits, so that it can be killed, or goes without memory."""
    with open(path, "w") as file:
        file.write('#!/bin/sh\n[ "$1" != build ] || { %s; }\nexec %s/bin/landmass-db "$@"\n' % (before_a_shard, BUILD))
    os.chmod(path, 0o755)
    return os.path.abspath(path)


def tries():
    """The nodes that each shard was tried on."""
    return [open("work/tries/" + name).read().split() for name in os.listdir("work/tries")] if os.path.isdir("work/tries") else []


def ended(engine, seconds=400):
    """The engine's exit status; None, and the engine is stopped, after some thirty times what it needs."""
    try:
        return engine.wait(seconds)
    except subprocess.TimeoutExpired:
        os.killpg(engine.pid, signal.SIGKILL)
        engine.wait()
        return None


def on_this_machine(whole):
    engine = start("-j2")
    was_killed = wait_for(engine, lambda: len(parts()) >= 2)
    os.killpg(engine.pid, signal.SIGKILL)
    engine.wait()
    before = parts()
    done = ended(start("-j2"))
    kept = [name for name, when in before.items() if parts().get(name) == when]
    check("an engine that is killed in the middle goes on where it was", was_killed and done == 0 and len(kept) == len(before) > 0,
          log())
    check("the image is the bytes of a build in one go", digest("world.lmdb") == whole)
    report = open("work/report.txt").read() if os.path.exists("work/report.txt") else ""
    check("a report tells each shard", "6 shards" in report and len(report.splitlines()) == 9, report)
    check("and pictures are there", len(os.listdir("work/pictures")) == 4)
    costs = [subprocess.run([sys.executable, "-B", WORLD + "/cost.py", "work", *words], capture_output=True, text=True).stdout.splitlines()
             for words in ((), ("--night", "8", "2"), ("--times", "1", "2"))]
    check("and what the Earth would cost, a night's cells and two cores are told of it", len(costs[0]) == 13 and costs[1][-1].endswith(
        ": too long |") and len(costs[1]) > 4 and costs[2][-1].startswith("6 shards: "), str(costs))
    done = ended(start("-j2"))
    check("run again, it has nothing to do", done == 0 and "Nothing to be done" in log(), log())
    damaged = sorted(parts())[3]
    with open("work/parts/" + damaged, "r+b") as file:
        file.seek(9000)
        byte = file.read(1)
        file.seek(9000)
        file.write(bytes((byte[0] ^ 1,)))
    os.unlink("world.lmdb")
    done = ended(start("-j1", "world.lmdb"))
    check("a damaged part is refused by its name, and no image is there",
          done != 0 and damaged in log() and "is damaged" in log() and not os.path.exists("world.lmdb"), log())
    os.unlink("work/parts/" + damaged)
    done = ended(start("-j1", "world.lmdb"))
    check("without it the shard is made again, and the image is right", done == 0 and digest("world.lmdb") == whole, log())
    clean()
    done = ended(start("-j1", db=other_db("full", "trap '' XFSZ; ulimit -f 300"), retries=0))
    full = len(parts())
    check("a full disk is a plain refusal that names the shard", done != 0 and "shard" in log() and "could not be made" in log()
          and not os.path.exists("world.lmdb"), log())
    done = ended(start("-j2", "world.lmdb", "--log-handler-script", WORLD + "/progress.py"))
    told = log()
    check("progress is a line for each step, with what is left",
          told.count(" is made") == 6 - full + 1 and "more, some " in told and "image is made" in told and "Building DAG" not in told, told)
    check("with room again it goes on, and the image is right", done == 0 and digest("world.lmdb") == whole, log())
    clean()
    done = ended(start("-j1", db=other_db("hungry", hunger()), retries=0))
    check("a shard that runs out of memory is refused by its number", done != 0 and "out of memory" in log()
          and "could not be made" in log() and not parts(), log())


def hunger():
    """Shell words for the most address space in which each shard runs out of memory: libraries take most of it, and differ."""
    landmass("plan", *OPTIONS.split(), "--shards", "6", "--out", "hungry.plan")
    for limit_kb in range(320000, 200000, -1000):
        words = "export OPENBLAS_NUM_THREADS=1; ulimit -v %d" % limit_kb
        said = (subprocess.run(["sh", "-c", words + "; exec %s/bin/landmass-db build --plan hungry.plan --shard %d --out hungry.part"
                                % (BUILD, shard)], capture_output=True, text=True).stderr for shard in range(6))
        if all("out of memory" in text and "could not be made" in text for text in said):
            return words
    return "exit 3"


def landmass(*words):
    subprocess.run([BUILD + "/bin/landmass-db", *words], check=True, capture_output=True)


def tall_image():
    """A virtual raster of three files, each three pictures of the scene, one above the other; and a network for it."""
    picture = gdal.Open("scene/image.tif")
    bands, rows = picture.ReadAsArray(), picture.RasterYSize
    for number, name in enumerate(("north.tif", "middle.tif", "south.tif")):
        file = gdal.GetDriverByName("GTiff").Create(name, picture.RasterXSize, 3 * rows, picture.RasterCount, gdal.GDT_UInt16)
        west, step, _, north, _, _ = picture.GetGeoTransform()
        file.SetGeoTransform((west, step, 0, north - 3 * rows * step * number, 0, -step))
        file.SetProjection(picture.GetProjection())
        for band in range(picture.RasterCount):
            for k in range(3):
                file.GetRasterBand(band + 1).WriteArray(bands[band][::-1] if (number + k) % 2 else bands[band], 0, k * rows)
        del file
    gdal.BuildVRT("image.vrt", ["north.tif", "middle.tif", "south.tif"]).FlushCache()
    landmass("train", "--image", "scene/image.tif", "--exemplars", "scene/exemplars.geojson", "--classes", CLASSES, "--net", "scene.net",
             "--epochs", "40", "--context", "3")


def raster_states():
    return {"%s/%d" % (kind, k): os.stat("work/%s/%d.tif" % (kind, k)).st_mtime_ns for kind in ("classes", "gamma") for k in range(3)}


def rasters():
    """Classes and reflectivity as steps of the workflow."""
    clean()
    tall_image()
    options = "--classes %s --flat --seed 3" % CLASSES
    segment = ["--image", "image.vrt", "--classes", CLASSES, "--net", "scene.net"]
    run = {"options": options, "shards": 8, "config": ["strips=3", "segment=" + " ".join(segment), "reflect=--classes " + CLASSES]}

    def is_right():
        landmass("segment", *segment, "--out", "classes.tif")
        landmass("reflect", "--class-raster", "classes.tif", "--classes", CLASSES, "--out", "gamma.tif")
        for kind in ("classes", "gamma"):
            strips = [word for k in (2, 0, 1) for word in ("--strip", "work/%s/%d.tif" % (kind, k))]
            landmass("mosaic", *strips, "--out", kind + "-joined.tif")
        landmass("build", *options.split(), "--class-raster", "work/classes.vrt", "--reflectivity", "work/gamma.vrt", "--out", "whole2.lmdb")
        return [digest(kind + "-joined.tif") == digest(kind + ".tif") for kind in ("classes", "gamma")] \
            + [digest("world.lmdb") == digest("whole2.lmdb")]

    done = ended(start("-j2", "estimate_classes", **run))
    check("an estimate of strips stands before them", done == 0 and "3 strips of 256 x 2304 pixels" in log() and "estimate, " in log()
          and not os.path.exists("work/classes"), log())
    done = ended(start("-j2", "world.lmdb", **run))
    right = is_right() if done == 0 else []
    check("classes and reflectivity in strips: the rasters and the image are the bytes of runs in one go", right == [True] * 3,
          "%s, %s\n%s" % (done, right, log()))
    if done != 0:
        return
    states, made = raster_states(), parts()
    done = ended(start("-j2", "world.lmdb", **run))
    check("run again, they have nothing to do", done == 0 and "Nothing to be done" in log() and states == raster_states(), log())
    file = gdal.Open("south.tif", gdal.GA_Update)
    for band in range(1, file.RasterCount + 1):
        values = file.GetRasterBand(band).ReadAsArray()
        file.GetRasterBand(band).WriteArray(values[:300, ::-1].copy(), 0, 460)
    del file, values
    os.utime("south.tif")
    done = ended(start("-j2", "world.lmdb", **run))
    again = sorted(name for name, when in raster_states().items() if states[name] != when)
    keys = [line.split()[-1] + ".part" for line in open("work/image.plan") if line.startswith("shard ")]
    kept = [name for name in keys if name in made and parts()[name] == made[name]]
    right = is_right() if done == 0 else []
    check("a changed source: its strips are made again, and the shards that they reach into",
          done == 0 and "classes/2" in again and "classes/0" not in again and 0 < len(kept) < len(keys),
          "%s; %d of %d parts kept\n%s" % (again, len(kept), len(keys), log()))
    print("# made again: %s; parts kept: %d of %d" % (" ".join(again), len(kept), len(keys)))
    check("and all is again the bytes of runs in one go", right == [True] * 3, str(right))
    with open("south.tif", "r+b") as file:
        file.truncate(os.path.getsize("south.tif") // 2)
    done = ended(start("-j1", "world.lmdb", **{**run, "retries": 0}))
    check("a torn source is a plain refusal that names file and strip", done != 0 and "of the classes" in log() and "south.tif" in log(), log())


def on_slurm(whole):
    nodes = cluster.Cluster(os.path.abspath("cluster"), 2)
    engine = None
    try:
        clean()
        # Steps begin, and end when they are let: neither node nor head dies at a moment that the machine's speed chooses.
        held = other_db("held", "until [ -e %s/go ]; do sleep 0.1; done" % os.getcwd())
        engine = start("--profile", WORLD + "/slurm", "work/report.txt", db=held, environment=nodes.environment, shards=4)
        is_busy = wait_for(engine, lambda: {"n1", "n2"} <= {node for names in tries() for node in names})
        nodes.kill_node("n2")
        nodes.restart_head()
        open("go", "w").close()
        done = ended(engine)
        check("a node that dies and a head that is restarted cost nothing but time: the image is right",
              is_busy and done == 0 and digest("world.lmdb") == whole, "busy: %s, status: %s\n" % (is_busy, done) + log()[-2000:] + nodes.told())
        check("both nodes had shards, and that of the dead one was done again on the other",
              any(names == ["n2", "n1"] for names in tries()), str(tries()))
        report = open("work/report.txt").read() if os.path.exists("work/report.txt") else "there is no report"
        check("the report says so", "4 shards, 1 of them tried again" in report, report)
        print("# " + report.strip().replace("\n", "\n# "))
        nodes.start_node("n2")
        faults_on_slurm(nodes, whole)
    except (OSError, subprocess.TimeoutExpired) as error:
        check("a cluster of two nodes", False, "%s\n%s" % (error, nodes.told()))
    finally:
        if engine is not None and engine.poll() is None:
            os.killpg(engine.pid, signal.SIGKILL)
            engine.wait()
        nodes.end()


def faults_on_slurm(nodes, whole):
    """What fails on a node is told by its cause and its shard, and leaves no image; without it the world is made."""
    cluster_run = {"environment": nodes.environment, "shards": 4}

    def run(db=None, retries=0):
        return ended(start("--profile", WORLD + "/slurm", "world.lmdb", db=db, retries=retries, **cluster_run))

    for what, limits, words in (("a full disk", "trap '' XFSZ; ulimit -f 300", ("could not be made",)),
                                ("a shard that runs out of memory", hunger(),
                                 ("out of memory", "could not be made"))):
        clean()
        done = run(other_db("poor", limits))
        check("on the cluster: %s is a plain refusal that names the shard" % what, done not in (0, None) and "shard" in log() and all(
            word in log() for word in words) and not os.path.exists("world.lmdb"), log()[-3000:] + nodes.told())
    os.unlink("go")
    clean()
    shutil.copy("scene/terrain.tif", "terrain.kept")
    engine = start("--profile", WORLD + "/slurm", "world.lmdb", db=other_db("held", "until [ -e %s/go ]; do sleep 0.1; done" % os.getcwd()),
                   retries=0, **cluster_run)
    is_busy = wait_for(engine, lambda: len(tries()) >= 2)
    with open("scene/terrain.tif", "r+b") as file:
        file.truncate(os.path.getsize("scene/terrain.tif") // 2)
    open("go", "w").close()
    done = ended(engine)
    check("on the cluster: an input that is torn in the middle is named, with the shard", is_busy and done not in (0, None) and
          "terrain.tif" in log() and "could not be made" in log() and not os.path.exists("world.lmdb"), log()[-3000:] + nodes.told())
    done = run()
    check("and one that is torn at the start, too", done not in (0, None) and "terrain.tif" in log() and not os.path.exists("world.lmdb"),
          log()[-3000:])
    shutil.copy2("terrain.kept", "scene/terrain.tif")
    os.utime("scene/terrain.tif")
    done = run(retries=2)
    check("on the cluster: with a sound input it goes on, and the image is right", done == 0 and digest("world.lmdb") == whole,
          log()[-3000:] + nodes.told())


def levels_by_gmt(block):
    """What GMT makes of the same shorelines."""
    south, north = block.latitude(block.shape[0] - 0.5), block.latitude(-0.5)
    west, east = block.longitude(-0.5), block.longitude(block.shape[1] - 0.5)
    subprocess.run(["gmt", "grdlandmask", "-Df", "-R%.9f/%.9f/%.9f/%.9f" % (west, east, south, north), "-I%gs" % block.step_s, "-r",
                    "-N0/1/2/3/4", "-Ggmt.nc=nb"], check=True, capture_output=True)
    return gdal.Open("gmt.nc").ReadAsArray()


def shores():
    """Every pixel of places with much to get wrong, against GMT."""
    if not shutil.which("gmt") or not os.path.exists(earth.GSHHG):
        skip("shores against GMT's", "gmt or gmt-gshhg-full missing; make deps-world installs them")
        return
    all_shores = earth.Shores()
    for name, corner, step_s, shape in (("islands in lakes, Finland", (20, 64), 20, (700, 700)),
                                        ("the antimeridian, Fiji", (177, -15), 20, (720, 720)),
                                        ("the ice front of Antarctica", (-70, -60), 60, (800, 1800)),
                                        ("the south pole", (-180, -88), 60, (120, 21600)),
                                        ("pixels that no degree is a multiple of, Sulawesi", (118.7, 2.3), 7, (900, 900))):
        block = earth.Block(corner, step_s, 0, 0, shape)
        wrong = np.count_nonzero(all_shores.levels(block) != levels_by_gmt(block))
        # A shore may run through the very middle of a pixel, as one does in Antarctica.
        check("shores against GMT's: " + name, wrong <= 2, "%d pixels of %d differ" % (wrong, shape[0] * shape[1]))


def seams():
    """Of made-up ground: blocks beside each other, the two sides of the antimeridian, and the pixels around a pole."""
    def fractal(row, column, shape, octaves=(earth.COARSEST_M, 1200.0, 1)):
        return earth.fractal(earth.Block((-180, 90), 20, row, column, shape), *octaves)

    whole = fractal(7000, 9000, (200, 300))
    parts = np.vstack([np.hstack([fractal(y, x, (high, wide)) for x, wide in ((9000, 131), (9131, 169))])
                       for y, high in ((7000, 77), (7077, 123))])
    check("a block has the numbers of the four that it falls into", (whole == parts).all(), str(np.abs(whole - parts).max()))
    around = 360 * 180
    for octaves in ((earth.COARSEST_M, 1200.0, 1), (900000.0, 100000.0, 99)):
        beyond, begin = fractal(5000, around - 40, (100, 80), octaves)[:, 40:], fractal(5000, 0, (100, 40), octaves)
        check("east of the antimeridian the numbers are those of the west, octaves from %g m" % octaves[0],
              np.abs(beyond - begin).max() < 1e-3, str(np.abs(beyond - begin).max()))
    for name, row in (("north", 0), ("south", around // 2 - 1)):
        ring = fractal(row, 0, (1, around))[0]
        check("around the %s pole no pixel stands out" % name, np.abs(ring - np.roll(ring, 1)).max() < 0.01,
              str(np.abs(ring - np.roll(ring, 1)).max()))
    block = earth.Block((-180, 90), 20, 7000, 9000, whole.shape)
    rows, columns = (np.arange(side) for side in whole.shape)
    exact = sum(0.5**k * earth.noise_at(block.latitude(rows), block.longitude(columns), earth.COARSEST_M / 2**k, 1 + k) for k in range(5))
    check("straight between samples, octaves are what they are at each pixel", np.abs(whole - exact).max() < 0.02,
          str(np.abs(whole - exact).max()))


def coasts():
    """Land and water of a real coast, against points that GMT answered from the same shorelines at full resolution."""
    data = os.environ.get("LANDMASS_DATA")
    name = "the shores of a world against 1,200 points of GSHHG"
    if not os.path.exists(earth.GSHHG):
        skip(name, "gmt-gshhg-full missing; make deps-world installs it")
        return
    if not data:
        skip(name, "LANDMASS_DATA is not set")
        return
    make = [sys.executable, "-B", WORLD + "/earth.py"]
    told = ""
    for box, place in (("7,43,8,44", "nice_N43E007"), ("-125,48,-124,49", "washington_N48W125")):
        made = subprocess.run([*make, "--relief", data + "/etopo20_global", "--out", "ground", "--step", "20", "--only=" + box],
                              capture_output=True, text=True)
        told += made.stderr + subprocess.run(
            [*make, "--check", "%s/gshhg_coasts/derived_points_land_%s.csv" % (data, place), "--out", "ground"],
            capture_output=True, text=True).stdout
    right = [int(line.split()[1]) for line in told.splitlines()]
    check(name, len(right) == 2 and min(right) >= 590 and told.count(" 0 wrong elsewhere") == 2, told)


def class_table():
    """The class table that earth.py writes beside its rasters."""
    kept = earth.table_of(CLASSES)
    sections = [line.strip() for line in kept.splitlines() if line.startswith("[")]
    check("the Earth's class table has the classes of its rasters, in their order",
          sections == ["[%s]" % name for name in earth.GAMMA_DB] and all("gamma_db = %d " % db in kept for db in earth.GAMMA_DB.values()))
    try:
        earth.table_of(__file__)
        told = "nothing"
    except SystemExit as error:
        told = str(error)
    check("a table without them is refused", "there is no class soil" in told, told)


def plain(path, side_px, pixel_m, heights):
    """Terrain around 46 N 9 E, in UTM."""
    raster = gdal.GetDriverByName("GTiff").Create(path, side_px, side_px, 1, gdal.GDT_Float32)
    spatial = osr.SpatialReference()
    spatial.ImportFromEPSG(32632)
    raster.SetProjection(spatial.ExportToWkt())
    half = side_px * pixel_m / 2
    raster.SetGeoTransform((500000 - half, pixel_m, 0, 5093000 + half, 0, -pixel_m))
    raster.GetRasterBand(1).SetNoDataValue(-9999)
    raster.GetRasterBand(1).WriteArray(heights)


def eased():
    """A plateau at 700 m with a lake at 0 m and a hole without data, within a world at 500 m."""
    over_m, pixel_m, side = 1500, 50, 160
    heights = np.full((side, side), 700.0)
    heights[8:20, 100:120] = 0
    heights[100:110, 60:70] = -9999
    plain("plateau.tif", side, pixel_m, heights)
    plain("around.tif", 60, 500, np.full((60, 60), 500.0))
    subprocess.run([BUILD + "/bin/landmass-db", "build", "--classes", CLASSES, "--terrain", "around.tif", "--cell", "150",
                    "--out", "around.lmdb"], check=True, capture_output=True)
    done = subprocess.run([sys.executable, "-B", WORLD + "/ease.py", "--terrain", "plateau.tif", "--onto", "around.lmdb",
                           "--out", "eased.tif", "--over", str(over_m), "--db", BUILD + "/bin/landmass-db"],
                          capture_output=True, text=True)
    check("terrain is eased into a world", done.returncode == 0 and "200.0 m apart" in done.stdout, done.stdout + done.stderr)
    made = gdal.Open("eased.tif").ReadAsArray()
    has, middle = made > -9999, side // 2
    check("at its border the terrain is the world's", np.abs(made[middle, [0, -1]] - 500).max() < 1, str(made[middle, :4]))
    check("from so many metres on it is as it was", (made[middle, 31:38] == 700).all(), str(made[middle, 20:40]))
    check("between, it rises evenly", (np.diff(made[middle, :32]) >= 0).all() and np.diff(made[middle, :32]).max() < 12)
    check("a lake stays level", (made[8:20, 100:120] == 0).all())
    check("a hole stays one, and the terrain around it is the world's",
          (has == (heights > -9999)).all() and np.abs(made[99, 60:70] - 500).max() < 1, str(made[95:100, 65]))
    subprocess.run(["gdal_translate", "-q", "-a_ullr", "600000", "5193000", "608000", "5185000", "plateau.tif", "far.tif"], check=True)
    far = subprocess.run([sys.executable, "-B", WORLD + "/ease.py", "--terrain", "far.tif", "--onto", "around.lmdb",
                          "--out", "far-eased.tif", "--db", BUILD + "/bin/landmass-db"], capture_output=True, text=True)
    check("elsewhere it is refused", far.returncode != 0 and "ease: " in far.stderr and not os.path.exists("far-eased.tif"), far.stderr)


def main():
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as work:
        os.chdir(work)
        if not shutil.which("snakemake"):
            skip("the workflow of a world", "snakemake missing; make deps-world installs it")
        else:
            subprocess.run([BUILD + "/bin/landmass-scene", "--out", "scene", "--size", "256"], check=True, capture_output=True)
            subprocess.run([BUILD + "/bin/landmass-db", "build", *OPTIONS.split(), "--out", "whole.lmdb"], check=True, capture_output=True)
            whole = digest("whole.lmdb")
            on_this_machine(whole)
            rasters()
            missing = cluster.why_not()
            if missing:
                skip("two nodes of Slurm", missing)
            else:
                on_slurm(whole)
        shores()
        seams()
        coasts()
        class_table()
        eased()
        os.chdir("/")
    print("1..%d" % len(CHECKS))
    sys.exit(0 if all(CHECKS) else 1)


main()
