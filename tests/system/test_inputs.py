#!/usr/bin/env python3
"""What the tools do with inputs that are wrong, doubtful or clumsy: the table of docs/database.md, "What happens to an
input", is what this test sees when it runs every row.

    test_inputs.py            TAP on standard output
    test_inputs.py --write    run, and write the table into the document

BUILD names the build's folder. Files are made on the spot by GDAL, in the formats that users have.
"""

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import numpy
from osgeo import gdal, ogr, osr

gdal.UseExceptions()
BUILD = os.path.abspath(os.environ.get("BUILD", "build/bench-linux"))
DOCUMENT = "docs/database.md"
BEGIN, END = "<!-- table: tests/system/test_inputs.py -->\n", "<!-- end of the table -->\n"
TABLE = os.path.abspath("host-sim/programs/db/classes/heaton6.classes")
CLASSES = ["soil", "asphalt", "concrete", "structure", "vegetation", "water"]
SIDE, STEP = 64, 10.0  # pixels, metres
WEST, NORTH = 500000.0, 4800000.0
ROWS = []


def row(name, command, wanted):
    """A row of the table: what is given, the command, and how the command must end: 'refused', 'warned' or 'done'."""
    def keep(function):
        ROWS.append((name, command, wanted, function))
        return function
    return keep


class Run:
    def __init__(self, done):
        self.code, self.out, self.err = done.returncode, done.stdout, done.stderr

    def outcome(self):
        return "refused" if self.code else "warned" if "warning: " in self.err else "done"


def tool(program, *words, **more):
    line = [os.path.join(BUILD, "bin", "landmass-" + program)] + [str(word) for word in words]
    return Run(subprocess.run(line, capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL, **more))


def db(*words):
    return tool("db", *words)


def crs(name):
    reference = osr.SpatialReference()
    reference.SetFromUserInput(name)
    return reference


def raster(path, bands, kind=gdal.GDT_Float32, at=(WEST, NORTH), step=STEP, system="EPSG:32632", nodata=None, unit=None,
           names=None, driver="GTiff"):
    """Write planes of numbers as a raster; `bands` is a list of arrays."""
    high, wide = bands[0].shape
    out = gdal.GetDriverByName(driver).Create(path, wide, high, len(bands), kind)
    out.SetGeoTransform((at[0], step, 0, at[1], 0, -step))
    if system:
        out.SetProjection(crs(system).ExportToWkt())
    for i, plane in enumerate(bands):
        band = out.GetRasterBand(i + 1)
        band.WriteArray(plane)
        if nodata is not None:
            band.SetNoDataValue(nodata)
        if unit:
            band.SetUnitType(unit)
        if names:
            band.SetCategoryNames(names)
    out = None
    return path


def classes_plane():
    """Columns of soil, vegetation and water."""
    plane = numpy.zeros((SIDE, SIDE), numpy.uint8)
    plane[:, SIDE // 3:2 * SIDE // 3] = CLASSES.index("vegetation")
    plane[:, 2 * SIDE // 3:] = CLASSES.index("water")
    return plane


def image_planes(seed=1):
    colours = {0: (170, 140, 90), 4: (60, 120, 50), 5: (30, 50, 120)}
    noise = numpy.random.default_rng(seed)
    plane = classes_plane()
    return [numpy.clip(numpy.vectorize(lambda c: colours[c][b])(plane) + noise.normal(0, 6, plane.shape), 0, 255) for b in range(3)]


def exemplars(path, labels=("soil", "vegetation", "water"), field="class"):
    layer_file = ogr.GetDriverByName("GeoJSON").CreateDataSource(path)
    layer = layer_file.CreateLayer("exemplars", crs("EPSG:32632"), ogr.wkbPolygon)
    layer.CreateField(ogr.FieldDefn(field, ogr.OFTString))
    for i, label in enumerate(labels):
        for part in range(3):
            x = WEST + STEP * (i * SIDE / 3 + 3)
            y = NORTH - STEP * (part * SIDE / 3 + 3)
            ring = "%f %f,%f %f,%f %f,%f %f,%f %f" % (x, y, x + 140, y, x + 140, y - 140, x, y - 140, x, y)
            feature = ogr.Feature(layer.GetLayerDefn())
            feature.SetField(field, label)
            feature.SetGeometry(ogr.CreateGeometryFromWkt("POLYGON((%s))" % ring))
            layer.CreateFeature(feature)
    layer_file = None
    return path


def slope(base=100.0, side=120, step=30.0):
    """Heights that rise to the east by one metre a pixel."""
    return numpy.tile(base + numpy.arange(side, dtype=numpy.float32), (side, 1))


DEM_AT = (WEST - 1200, NORTH + 1200)


def terrain(path="dem.tif", plane=None, **more):
    more.setdefault("at", DEM_AT)
    more.setdefault("step", 30.0)
    return raster(path, [slope() if plane is None else plane], **more)


def prepare():
    raster("image.tif", image_planes(), gdal.GDT_Byte)
    exemplars("fields.geojson")
    shutil.copy(TABLE, "heaton6.classes")
    raster("classes.tif", [classes_plane()], gdal.GDT_Byte, nodata=255, names=CLASSES)
    terrain()
    for words in (["train", "--image", "image.tif", "--classes", "heaton6.classes", "--exemplars", "fields.geojson", "--net", "scene.net",
                   "--epochs", "20"],
                  ["reflect", "--class-raster", "classes.tif", "--classes", "heaton6.classes", "--out", "gamma.tif"],
                  BUILD_AREA + ["--out", "area.lmdb"]):
        done = db(*words)
        assert done.code == 0, done.err


BUILD_AREA = ["build", "--classes", "heaton6.classes", "--class-raster", "classes.tif", "--terrain", "dem.tif"]
TRAIN = ["train", "--image", "image.tif", "--classes", "heaton6.classes", "--exemplars", "fields.geojson", "--epochs", "20"]
SEGMENT = ["segment", "--image", "image.tif", "--classes", "heaton6.classes", "--net", "scene.net"]
REFLECT = ["reflect", "--class-raster", "classes.tif", "--classes", "heaton6.classes"]
THERMAL = ["infrared", "--class-raster", "classes.tif", "--classes", TABLE, "--out"]
CORRECT = ["correct", "--class-raster", "classes.tif", "--classes", "heaton6.classes", "--corrections", "fields.geojson"]


def contents(path):
    with open(path, "rb") as file:
        return file.read()


def kept(path, work):
    """What `work` does, with the file at `path` the same before and after, and nothing unfinished left."""
    before = contents(path)
    done = work()
    assert contents(path) == before, path + " was changed"
    assert not [name for name in os.listdir(".") if name.startswith(".unfinished")], "unfinished files are left"
    return done


# ---- Outputs that would take the place of an input.

def overwrite(name, command, path, words):
    row(name, command, "refused")(lambda: kept(path, lambda: db(*words)))


for each, lines, option in (("train", TRAIN, "--net"), ("segment", SEGMENT, "--out"), ("reflect", REFLECT, "--out"),
                            ("correct", CORRECT, "--out"), ("build", BUILD_AREA, "--out")):
    for given in lines[1:]:
        if not given.startswith("--") and os.path.splitext(given)[1]:
            overwrite("output named as the input `%s`" % given, each, given, lines + [option, given])


@row("output that is a symbolic link to an input", "build", "refused")
def output_is_a_link():
    os.symlink("dem.tif", "link.lmdb")
    return kept("dem.tif", lambda: db(*BUILD_AREA, "--out", "link.lmdb"))


@row("output that is a hard link of an input", "segment", "refused")
def output_is_a_hard_link():
    os.link("image.tif", "hard.tif")
    return kept("image.tif", lambda: db(*SEGMENT, "--out", "hard.tif"))


@row("output named as the source of a virtual raster", "segment", "refused")
def output_is_a_source():
    gdal.BuildVRT("image.vrt", ["image.tif"]).FlushCache()
    words = [word if word != "image.tif" else "image.vrt" for word in SEGMENT]
    return kept("image.tif", lambda: db(*words, "--out", "image.tif"))


@row("output named as a side file of an input", "reflect", "refused")
def output_is_a_side_file():
    return kept("classes.tif.aux.xml", lambda: db(*REFLECT, "--out", "classes.tif.aux.xml"))


@row("output named as an archive that is read", "build", "refused")
def output_is_an_archive():
    shutil.make_archive("N43", "zip", ".", "dem.tif")
    os.rename("N43.zip", "dem.tif.zip")
    return kept("dem.tif.zip", lambda: db("build", "--classes", "heaton6.classes", "--terrain", "dem.tif.zip", "--out", "dem.tif.zip"))


@row("output named as a signature that the targets name", "build", "refused")
def output_is_a_signature():
    done = tool("target", "bake", "--model", "tank", "--aspects", "24", "--depressions", "8", "--rays", "1", "--out", "tank.sig")
    assert done.code == 0, done.err
    with open("targets.txt", "w") as file:
        file.write("library tank tank.sig\n")
    return kept("tank.sig", lambda: db(*BUILD_AREA, "--targets", "targets.txt", "--out", "tank.sig"))


@row("picture named as the image", "picture", "refused")
def picture_is_the_image():
    return kept("area.lmdb", lambda: db("picture", "area.lmdb", "--plane", "class", "--out", "./area.lmdb"))


@row("new image that is a link to the old one", "convert", "refused")
def new_is_old():
    os.symlink("area.lmdb", "new.lmdb")
    return kept("area.lmdb", lambda: db("convert", "area.lmdb", "new.lmdb"))


@row("log named as the track", "landmass-nav", "refused")
def log_is_the_track():
    with open("track.csv", "w") as file:
        file.write("time,lat,lon,altitude\n" + "".join("%d,43.%02d,7,1000\n" % (1e9 + i, i) for i in range(20)))
    return kept("track.csv", lambda: tool("nav", "--out", "./track.csv", "track.csv"))


@row("log named as its text", "landmass-bus", "refused")
def decoded_is_the_log():
    done = tool("nav", "--out", "track.log", "track.csv")
    assert done.code == 0, done.err
    return kept("track.log", lambda: tool("bus", "decode", "--out", "./track.log", "track.log"))


@row("picture named as the model", "landmass-target", "refused")
def picture_is_the_model():
    done = tool("target", "model", "--model", "tank", "--obj", "tank.obj")
    assert done.code == 0, done.err
    return kept("tank.obj", lambda: tool("target", "model", "--model", "tank.obj", "--view", "./tank.obj"))


@row("picture named as the image", "landmass-reference", "refused")
def reference_is_the_image():
    return kept("area.lmdb", lambda: tool("reference", "gm", "area.lmdb", "--out", "./area.lmdb"))


@row("two outputs of one name", "segment", "refused")
def two_outputs():
    done = db(*SEGMENT, "--out", "both.tif", "--picture", "./both.tif")
    assert not os.path.exists("both.tif")
    return done


@row("output in a folder that is not there", "train", "refused")
def folder_is_missing():
    done = db(*TRAIN, "--net", "nosuch/scene.net")
    assert "epoch" not in done.out, "it trained before it noticed"
    return done


@row("report that is an ordinary file", "train", "refused")
def report_is_a_file():
    done = kept("image.tif", lambda: db(*TRAIN, "--net", "new.net", "--report", "image.tif"))
    assert "epoch" not in done.out, "it trained before it noticed"
    assert not os.path.exists("new.net")
    return done


def stopped(number):
    """Ends `train` while it works; what is left in the folder."""
    before = set(os.listdir("."))
    words = [os.path.join(BUILD, "bin", "landmass-db")] + TRAIN[:-2] + ["--epochs", "2000", "--patience", "2000", "--goal", "1.01",
                                                                       "--net", "never.net"]
    work = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 20
    while set(os.listdir(".")) == before and time.monotonic() < deadline:
        time.sleep(0.01)
    assert set(os.listdir(".")) != before, "no temporary file was seen"
    work.send_signal(number)
    assert work.wait(20) == -number, "it did not end by the signal"
    assert set(os.listdir(".")) == before, "left: %s" % (set(os.listdir(".")) - before)


@row("Ctrl-C, SIGTERM or SIGHUP during the work", "train", "refused")
def ctrl_c():
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        stopped(number)
    return None


# ---- Options that would be ignored.

IGNORED = [
    (REFLECT + ["--out", "no.tif"], ["image image.tif", "bands 1", "calibrate scene", "multilook 3", "trust-inputs"]),
    (["build", "--classes", TABLE, "--terrain", "dem.tif", "--out", "no.lmdb"],
     ["class-numbers", "map dem.tif", "steep-degrees 30", "geoid 45 --geoid-grid egm96"]),
    (["build", "--classes", TABLE, "--class-raster", "classes.tif", "--flat", "--out", "no.lmdb"],
     ["terrain-unit ft", "terrain-datum msl", "land-class soil", "voids-are-sea"]),
    (SEGMENT + ["--out", "no.tif"], ["picture-bands 1,2,3", "square 8", "field class", "sure 0.9"]),
    (TRAIN + ["--net", "no.net"], ["labels classes.tif"]),
    (THERMAL + ["no"], ["shadows", "heights dem.tif", "trust-inputs"]),
    (["picture", "area.lmdb", "--out", "no.png", "--plane", "class"], ["white 9", "black -30 --white 0"]),
]
for given, options in IGNORED:
    for option in options:
        @row("`--%s` which would be ignored" % option.replace(" --", "` and `--") , given[0], "refused")
        def is_ignored(words=given, option=option):
            done = db(*words, *("--" + option).split())
            assert done.code == 2 and not os.path.exists("no.tif") and not os.path.exists("no.lmdb"), done.err
            return done


@row("`--speed 100` beside `--circle`", "landmass-nav", "refused")
def speed_of_a_circle():
    return tool("nav", "--circle", "46,7,9000,3000,150", "--speed", "100", "--out", "no.log")


@row("GPX route without times, no `--speed`", "landmass-nav", "refused")
def route_without_speed():
    with open("route.gpx", "w") as file:
        file.write("<gpx><rte><rtept lat='46' lon='7'/><rtept lat='46.1' lon='7'/></rte></gpx>")
    done = tool("nav", "route.gpx", "--out", "no.log")
    assert "--speed flies them" in done.err, done.err
    return done


@row("`--profile` beside a `--table` of one's own", "landmass-bus", "refused")
def profile_and_table():
    return tool("bus", "table", "--profile", "canas17", "--table", "image.tif")


@row("`--start 5` without a log", "landmass-sim", "refused")
def start_of_nothing():
    return tool("sim", "--db", "area.lmdb", "--start", "5", "--seconds", "1")


# ---- Words and numbers that an option does not take.

for words, said in ((["picture", "area.lmdb", "--plane", "hight", "--out", "no.png"], "needs reflectivity, class, elevation, height or shade"),
                    (TRAIN + ["--net", "no.net", "--loss", "cubic"], "needs square or cross-entropy"),
                    (THERMAL + ["no", "--date", "02-30"], "names a day that its month has not"),
                    (THERMAL + ["no", "--hours", "25"], "`25` is no hour"),
                    (THERMAL + ["no", "--wind", "-3"], "needs a number from 0 to 40")):
    @row("`%s`" % " ".join(words[-2:] if "--out" not in words[-2:] else words[2:4]), words[0], "refused")
    def is_no_word(words=words, said=said):
        done = db(*words)
        assert done.code == 2 and said in done.err, done.err
        return done


@row("`--date 02-29`", "infrared", "done")
def leap_day():
    done = db(*THERMAL, "leap", "--date", "02-29", "--hours", "12")
    assert "day 60 of the year" in done.out, done.out
    return done


@row("a table as text to print", "landmass-radar", "refused")
def print_a_text():
    with open("own.radar", "w") as file:
        file.write(tool("radar", "print").out)
    done = tool("radar", "print", "own.radar")
    assert "is a text already" in done.err, done.err
    return done


# ---- Files that belong together: all of a run, or none.

TOGETHER = {"export": (["export", "area.lmdb", "--out"], "height.tif"), "infrared": (THERMAL, "infrared-1400.png")}


def all_files(folder):
    return {name: contents(os.path.join(folder, name)) if os.path.isfile(os.path.join(folder, name)) else None for name in os.listdir(folder)}


for each, (lines, last) in TOGETHER.items():
    @row("folder of an earlier run in which a file cannot be replaced", each, "refused")
    def last_is_a_folder(words=lines, last=last, out="together-" + each):
        done = db(*words, out)
        assert done.code == 0 and last in os.listdir(out), done.err
        shutil.rmtree(out)
        os.makedirs(os.path.join(out, last))
        with open(os.path.join(out, "class.tif"), "w") as file, open(os.path.join(out, "infrared-0400.tif"), "w") as other:
            print("of the earlier run", file=file)
            print("of the earlier run", file=other)
        before = all_files(out)
        done = db(*words, out)
        assert all_files(out) == before, set(all_files(out)) - set(before)
        return done


@row("Ctrl-C when some files are finished", "infrared", "refused")
def stopped_midway():
    os.mkdir("midway")
    hours = ",".join("%.2f" % (hour / 2) for hour in range(48))
    work = subprocess.Popen([os.path.join(BUILD, "bin", "landmass-db")] + THERMAL + ["midway", "--hours", hours], stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 60
    while len(os.listdir("midway")) < 8 and time.monotonic() < deadline:
        time.sleep(0.001)
    seen = os.listdir("midway")
    work.send_signal(signal.SIGINT)
    assert work.wait(20) == -signal.SIGINT, "it did not end by the signal"
    assert len(seen) >= 8 and not os.listdir("midway"), (seen, os.listdir("midway"))
    return None


# ---- Class numbers.

def reordered():
    """The class table with its sections in another order: water is the first, soil the last."""
    sections = re.split(r"(?m)^(?=\[)", contents(TABLE).decode())
    with open("reordered.classes", "w") as file:
        file.write(sections[0] + "".join(reversed(sections[1:])))
    return "reordered.classes"


def with_table(words, table):
    return [table if word == "heaton6.classes" else word for word in words]


def mean_gamma_of_water(path):
    plane = gdal.Open(path).ReadAsArray()
    return plane[:, -10:].mean()


@row("class table in another order, raster with names", "reflect", "done")
def table_is_reordered():
    done = db(*with_table(REFLECT, reordered()), "--out", "reordered-gamma.tif")
    assert abs(mean_gamma_of_water("reordered-gamma.tif") - mean_gamma_of_water("gamma.tif")) < 1, "water and soil are swapped"
    return done


@row("class table in another order, raster with names", "build", "done")
def table_is_reordered_in_build():
    done = db(*with_table(BUILD_AREA, reordered()), "--out", "reordered.lmdb")
    areas = dict(re.findall(r"class +\d+ +(\w+) .* ([0-9.]+) km2", done.out))
    first = dict(re.findall(r"class +\d+ +(\w+) .* ([0-9.]+) km2", db(*BUILD_AREA, "--out", "again.lmdb").out))
    assert areas == first, "areas differ: %s, %s" % (areas, first)
    return done


@row("class table in another order, raster with names", "correct", "done")
def table_is_reordered_in_correct():
    done = db(*with_table(CORRECT, reordered()), "--out", "corrected.tif")
    names = dict(re.findall(r"(?m)^ +(\d+): (\w+)$", gdal.Info("corrected.tif")))
    assert names[str(gdal.Open("corrected.tif").ReadAsArray()[0, -1])] == "water", names
    return done


@row("side file with the names lost, class table in another order", "reflect", "done")
def side_file_is_lost():
    assert db(*SEGMENT, "--out", "segmented.tif").code == 0
    os.remove("segmented.tif.aux.xml")
    words = ["segmented.tif" if word == "classes.tif" else word for word in with_table(REFLECT, reordered())]
    done = db(*words, "--out", "lost-gamma.tif")
    assert abs(mean_gamma_of_water("lost-gamma.tif") - mean_gamma_of_water("gamma.tif")) < 1, "water and soil are swapped"
    return done


@row("names in an attribute table, in another order", "reflect", "done")
def names_in_an_attribute_table():
    raster("rat.tif", [classes_plane()], gdal.GDT_Byte, nodata=255)
    file = gdal.Open("rat.tif", gdal.GA_Update)
    table = gdal.RasterAttributeTable()
    table.CreateColumn("Value", gdal.GFT_Integer, gdal.GFU_MinMax)
    table.CreateColumn("Class", gdal.GFT_String, gdal.GFU_Name)
    for i, name in enumerate(CLASSES):
        table.SetValueAsInt(i, 0, i)
        table.SetValueAsString(i, 1, name)
    file.GetRasterBand(1).SetDefaultRAT(table)
    file = None
    words = ["rat.tif" if word == "classes.tif" else word for word in with_table(REFLECT, reordered())]
    done = db(*words, "--out", "rat-gamma.tif")
    assert abs(mean_gamma_of_water("rat-gamma.tif") - mean_gamma_of_water("gamma.tif")) < 1, "water and soil are swapped"
    return done


def without_names():
    return raster("unnamed.tif", [classes_plane()], gdal.GDT_Byte, nodata=255)


for each, lines in (("reflect", REFLECT), ("build", BUILD_AREA), ("correct", CORRECT)):
    @row("class raster without names", each, "warned")
    def names_are_missing(lines=lines, out="unnamed-" + each + (".lmdb" if each == "build" else ".tif")):
        without_names()
        done = db(*["unnamed.tif" if word == "classes.tif" else word for word in lines], "--out", out)
        assert re.search(r"class number 5 is taken for water +1408 pixels +34.4 % +0.141 km2", done.out), done.out
        return done

    @row("class raster with a class that the table has not", each, "refused")
    def a_class_is_unknown(lines=lines, out="other-" + each + ".tif"):
        raster("other.tif", [classes_plane()], gdal.GDT_Byte, nodata=255, names=["soil", "asphalt", "concrete", "structure", "jungle", "water"])
        return db(*["other.tif" if word == "classes.tif" else word for word in lines], "--out", out)

    @row("the same with `--class-numbers`", each, "warned")
    def numbers_are_asked_for(lines=lines, out="other-" + each + ".tif"):
        return db(*["other.tif" if word == "classes.tif" else word for word in lines], "--class-numbers", "--out", out)

    @row("class raster with a number behind the table's end", each, "refused")
    def a_number_is_too_large(lines=lines, out="large-" + each + ".tif"):
        raster("large.tif", [numpy.where(classes_plane() == 5, 9, classes_plane())], gdal.GDT_Byte, nodata=255)
        return db(*["large.tif" if word == "classes.tif" else word for word in lines], "--out", out)

    @row("heights or reflectivity as class raster", each, "refused")
    def values_are_no_classes(lines=lines, out="values-" + each + ".tif"):
        raster("values.tif", [classes_plane() * 0.9], gdal.GDT_Float32)
        return db(*["values.tif" if word == "classes.tif" else word for word in lines], "--out", out)


# ---- Units and datums of terrain. The slope rises from 100 to 219 m; the land's mean elevation tells what became of it.

BUILD_TERRAIN = ["build", "--classes", "heaton6.classes", "--cell", "150", "--out", "terrain.lmdb"]
FEET, SURVEY_FEET = 0.3048, 1200 / 3937


def mean_elevation(done):
    assert done.code == 0, done.err
    return float(re.search(r"mean elevation of land ([0-9.-]+) m", done.out).group(1))


def land_like(path, wanted, *words, tolerance=0.5):
    """Builds over one model and compares its mean elevation with the slope's in metres, plus `wanted` metres."""
    done = db(*BUILD_TERRAIN, "--terrain", path, *words)
    plain = mean_elevation(db(*BUILD_TERRAIN, "--terrain", "dem.tif"))
    assert abs(mean_elevation(done) - plain - wanted) < tolerance, "mean elevation %s, wanted %s" % (mean_elevation(done), plain + wanted)
    return done


for each, said, system, metres in (
        ("US survey feet by its CRS (EPSG:6360)", None, "EPSG:32632+6360", SURVEY_FEET),
        ("international feet by its CRS (EPSG:8228)", None, "EPSG:32632+8228", FEET),
        ("`us-ft` in its band", "us-ft", "EPSG:32632", SURVEY_FEET),
        ("`US survey foot` in its band", "US survey foot", "EPSG:32632", SURVEY_FEET),
        ("`ft` in its band", "ft", "EPSG:32632", FEET),
        ("`cm` in its band", "cm", "EPSG:32632", 0.01),
        ("`fathom` in its band, which PROJ knows", "fathom", "EPSG:32632", 1.8288),
        ("`metre` in its band", "metre", "EPSG:32632", 1),
        ("no word of unit and datum", None, "EPSG:32632", 1)):
    @row("terrain, " + each, "build", "warned" if "8228" in system or "6360" in system else "done")
    def unit_is_read(said=said, system=system, metres=metres):
        terrain("unit.tif", slope() / metres, unit=said, system=system)
        done = land_like("unit.tif", 0)
        assert ("(assumed)" in done.out) == (said is None and "+" not in system) or said, done.out
        return done


@row("terrain, `smoots` in its band", "build", "refused")
def unit_is_unknown():
    terrain("smoots.tif", unit="smoots")
    return db(*BUILD_TERRAIN, "--terrain", "smoots.tif")


@row("the same with `--terrain-unit m`", "build", "done")
def unit_is_told():
    return land_like("smoots.tif", 0, "--terrain-unit", "m")


@row("`--terrain-unit` that is none", "build", "refused")
def told_unit_is_unknown():
    return db(*BUILD_TERRAIN, "--terrain", "dem.tif", "--terrain-unit", "smoots")


@row("terrain whose band and CRS differ in the unit", "build", "refused")
def units_differ():
    terrain("differ.tif", system="EPSG:32632+6360", unit="m")
    return db(*BUILD_TERRAIN, "--terrain", "differ.tif")


@row("terrain as depths (EPSG:5831)", "build", "warned")
def depths():
    terrain("depths.tif", -slope(), system="EPSG:32632+5831")
    return land_like("depths.tif", 0)


@row("terrain above EGM96 (EPSG:5773)", "build", "done")
def above_egm96():
    terrain("egm96.tif", system="EPSG:32632+5773")
    return land_like("egm96.tif", 0, tolerance=0.02)


def undulation():
    """EGM96 above the ellipsoid in the middle of the terrain, by PROJ's own grid."""
    away = osr.CoordinateTransformation(crs("EPSG:32632+5773"), crs("EPSG:4979"))
    return away.TransformPoint(DEM_AT[0] + 1800, DEM_AT[1] - 1800, 0)[2]


@row("terrain above the ellipsoid (EPSG:4979)", "build", "done")
def above_the_ellipsoid():
    assert 40 < undulation() < 60, undulation()
    terrain("ellipsoid.tif", slope(), at=(8.99, 43.37), step=0.0003, system="EPSG:4979")
    terrain("degrees.tif", slope(), at=(8.99, 43.37), step=0.0003, system="EPSG:4326")
    done = db(*BUILD_TERRAIN, "--terrain", "ellipsoid.tif")
    plain = db(*BUILD_TERRAIN, "--terrain", "degrees.tif")
    assert abs(mean_elevation(done) - mean_elevation(plain) + undulation()) < 0.5, (mean_elevation(done), undulation())
    return done


@row("terrain with `--terrain-datum ellipsoid`", "build", "done")
def told_the_ellipsoid():
    return land_like("dem.tif", -undulation(), "--terrain-datum", "ellipsoid")


@row("terrain above the ellipsoid, no geoid grid installed", "build", "refused")
def no_grid():
    folder = os.path.join(os.getcwd(), "proj")
    os.mkdir(folder)
    shutil.copy("/usr/share/proj/proj.db", folder)
    return tool("db", *BUILD_TERRAIN, "--terrain", "ellipsoid.tif", env={**os.environ, "PROJ_LIB": folder, "PROJ_DATA": folder, "PROJ_NETWORK": "OFF"})


@row("terrain above a datum whose grid is not installed (EPSG:5703)", "build", "warned")
def above_navd88():
    terrain("navd88.tif", system="EPSG:32632+5703")
    return land_like("navd88.tif", 0)


# ---- No terrain, visual databases, radar imagery.

FLAT = ["build", "--classes", "heaton6.classes", "--class-raster", "classes.tif", "--out", "flat.lmdb"]


@row("no terrain", "build", "refused")
def no_terrain():
    return db(*FLAT)


@row("no terrain, with `--flat`", "build", "done")
def flat():
    done = db(*FLAT, "--flat")
    assert "no terrain: all ground lies at 0 m" in done.out
    return done


def model(name="roof.obj", text="v 0 0 3\nv 9 0 3\nv 9 9 3\nf 1 2 3\n"):
    with open(name, "w") as file:
        file.write(text)
    return ["import", "--model", name, "--cell", "1", "--out-image", "roof.tif"]


@row("a model that says neither unit nor axes (OBJ)", "import", "refused")
def obj_alone():
    return db(*model(), "--at", "45,7")


@row("the same with `--unit m --up z`, no place", "import", "refused")
def obj_nowhere():
    return db(*model(), "--unit", "m", "--up", "z")


@row("the same with a place", "import", "done")
def obj_placed():
    return db(*model(), "--unit", "m", "--up", "z", "--at", "45,7")


@row("a model whose texture is missing", "import", "warned")
def obj_bare():
    with open("bare.mtl", "w") as file:
        file.write("newmtl roof\nmap_Kd nowhere.png\n")
    words = model("bare.obj", "mtllib bare.mtl\nv 0 0 3\nv 9 0 3\nv 9 9 3\nusemtl roof\nf 1 2 3\n")
    return db(*words, "--unit", "m", "--up", "z", "--at", "45,7")


@row("noise under the name of a model (.glb)", "import", "refused")
def glb_noise():
    return db(*model("noise.glb", "glTF no more"), "--at", "45,7")


@row("OpenFlight that is none", "import", "refused")
def flt_noise():
    return db(*model("noise.flt", "no record"), "--at", "45,7")


@row("a folder that is no CDB", "import", "refused")
def no_cdb():
    return db("import", "--cdb", ".", "--out-image", "cdb.tif")


def radar(path, plane):
    raster(path, [plane], nodata=-9999)
    return REFLECT + ["--out", "radar-gamma.tif", "--method", "radar", "--radar", path]


def radar_db():
    return numpy.random.default_rng(3).normal(-12, 3, (SIDE, SIDE)).astype(numpy.float32)


@row("radar imagery, its unit not said", "reflect", "refused")
def radar_of_no_unit():
    return db(*radar("radar.tif", radar_db()))


@row("radar imagery in dB with `--radar-unit linear`", "reflect", "refused")
def radar_not_linear():
    return db(*radar("radar.tif", radar_db()), "--radar-unit", "linear")


@row("radar imagery in linear power with `--radar-unit db`", "reflect", "refused")
def radar_not_db():
    return db(*radar("linear.tif", 10 ** (radar_db() / 10)), "--radar-unit", "db")


def wrong_radar(name, unit, make):
    """A row for a raster that is no radar imagery, and that its user may mean all the same."""
    @row(name + " as radar imagery, `--radar-unit %s`" % unit, "reflect", "refused")
    def is_doubted():
        words = REFLECT + ["--out", "no-radar.tif", "--method", "radar", "--radar", make(), "--radar-unit", unit]
        done = kept_away("no-radar.tif", lambda: db(*words))
        assert unit == "db" or trusted(words).code == 0
        return done


def kept_away(path, work):
    """What `work` does, which leaves no file at `path`."""
    if os.path.exists(path):
        os.remove(path)
    done = work()
    assert not os.path.exists(path), path + " was written"
    return done


def digital_numbers():
    return raster("optical.tif", image_planes()[:1], gdal.GDT_UInt16)


def powers(path, factor):
    return raster(path, [factor * 10 ** (radar_db() / 10)])


for the_unit in ("linear", "db"):
    wrong_radar("class raster", the_unit, lambda: "classes.tif")
    wrong_radar("elevations in metres by their band", the_unit, lambda: raster("metres.tif", [slope(5, SIDE) / 50], unit="metre"))
wrong_radar("elevations", "linear", lambda: terrain("heights.tif", slope() + 0.25))
wrong_radar("class raster without names", "linear", lambda: without_names())
wrong_radar("raw optical numbers", "linear", digital_numbers)
wrong_radar("powers 50 dB too weak", "linear", lambda: powers("weak.tif", 1e-5))


def dark_radar(unit, name, make):
    @row(name, "reflect", "refused")
    def is_doubted():
        words = REFLECT + ["--out", "no-radar.tif", "--method", "radar", "--radar", make(), "--radar-unit", unit]
        done = kept_away("no-radar.tif", lambda: db(*words))
        assert db(*words, "--trust-inputs").code == 0 or "is above 0" in db(*words, "--trust-inputs").err
        return done


dark_radar("db", "radar imagery in dB with a mean of -70 dB", lambda: raster("dark.tif", [radar_db() - 58], nodata=-9999))
dark_radar("db", "radar imagery in dB with a mean above 20 dB", lambda: raster("light.tif", [radar_db() * 4 + 60], nodata=-9999))
dark_radar("db", "linear power with empty borders as dB", lambda: raster("border.tif", [numpy.where(numpy.arange(SIDE) < SIDE / 4, 0, 10 ** (radar_db() / 10))]))


@row("radar imagery in linear power", "reflect", "done")
def radar_linear():
    powers("power.tif", 1)
    return db(*REFLECT, "--out", "radar-gamma.tif", "--method", "radar", "--radar", "power.tif", "--radar-unit", "linear")


@row("radar imagery with a hole", "reflect", "warned")
def radar_hole():
    plane = radar_db()
    plane[:9, :] = -9999
    return db(*radar("hole.tif", plane), "--radar-unit", "db")


# ---- The ground under vectors.

def vectors_on(at):
    ground = raster("ground.tif", [classes_plane()], gdal.GDT_Byte, nodata=255, names=CLASSES)
    with open("one.rules", "w") as file:
        file.write("[house]\nfrom = area\nwhere = building=*\nclass = structure\nheight = 9\n")
    source = ogr.GetDriverByName("GPKG").CreateDataSource("house.gpkg")
    layer = source.CreateLayer("houses", crs("EPSG:32632"), ogr.wkbPolygon)
    layer.CreateField(ogr.FieldDefn("building", ogr.OFTString))
    feature = ogr.Feature(layer.GetLayerDefn())
    feature.SetField("building", "yes")
    (x, y) = at
    ring = "%f %f,%f %f,%f %f,%f %f,%f %f" % (x, y, x + 200, y, x + 200, y - 200, x, y - 200, x, y)
    feature.SetGeometry(ogr.CreateGeometryFromWkt("POLYGON((%s))" % ring))
    layer.CreateFeature(feature)
    source = None
    return db("vectors", "--vectors", "house.gpkg", "--rules", "one.rules", "--classes", "heaton6.classes", "--cell", "10", "--ground", ground,
              "--out", "houses.tif")


@row("ground elsewhere than the vectors", "vectors", "refused")
def ground_elsewhere():
    return kept_away("houses.tif", lambda: vectors_on((520000.0, 4790000.0)))


@row("ground under a part of the vectors", "vectors", "warned")
def ground_in_part():
    return vectors_on((499900.0, 4799900.0))


@row("ground under all vectors", "vectors", "done")
def ground_under_all():
    return vectors_on((500100.0, 4799900.0))


# ---- Sensors.

@row("class table of X alone, `--sensor ku`", "reflect", "refused")
def table_of_x():
    with open(TABLE) as table, open("x.classes", "w") as out:
        out.writelines(line for line in table if not re.match("ku_db|ka_db|mmw_db|emissivity|albedo", line))
    return db("reflect", "--class-raster", "classes.tif", "--classes", "x.classes", "--out", "ku.tif", "--sensor", "ku")


@row("class table of X alone", "infrared", "refused")
def table_without_infrared():
    table_of_x()
    return db("infrared", "--class-raster", "classes.tif", "--classes", "x.classes", "--out", "thermal")


@row("class raster without a CRS", "infrared", "refused")
def infrared_nowhere():
    raster("nowhere.tif", [numpy.zeros((SIDE, SIDE))], gdal.GDT_Byte, system=None, names=CLASSES)
    return db("infrared", "--class-raster", "nowhere.tif", "--classes", TABLE, "--out", "thermal")


@row("reflectivity for another sensor than `--sensor`", "build", "refused")
def other_sensor():
    db(*REFLECT, "--out", "ka.tif", "--sensor", "ka")
    return db(*BUILD_AREA, "--reflectivity", "ka.tif", "--sensor", "x", "--out", "other.lmdb")


# ---- Inputs that are something else.

def trusted(words):
    """The same command with --trust-inputs goes on with a warning, or fails for another reason than the doubt."""
    done = db(*words, "--trust-inputs")
    assert "trust-inputs" not in done.err and "warning: " in done.err, done.err
    return done


def doubted(name, make):
    """A row for terrain that looks wrong, and that its user may mean all the same."""
    @row(name, "build", "refused")
    def is_doubted():
        words = BUILD_TERRAIN + make()
        trusted(words)
        return db(*words)


def terrain_of(path, plane, **more):
    return ["--terrain", terrain(path, plane, **more)]


def three_bands():
    raster("rgb.tif", [numpy.full((120, 120), v, numpy.uint8) for v in (90, 100, 110)], gdal.GDT_Byte, at=DEM_AT, step=30.0)
    return ["--terrain", "rgb.tif"]


def class_terrain():
    raster("class-terrain.tif", [numpy.full((120, 120), 2, numpy.uint8)], gdal.GDT_Byte, at=DEM_AT, step=30.0, names=CLASSES)
    return ["--terrain", "class-terrain.tif"]


def with_marks():
    plane = slope()
    plane[:40, :40] = -9999
    return terrain_of("marks.tif", plane)


doubted("picture (red, green, blue) as terrain", three_bands)
doubted("class raster as terrain", class_terrain)
doubted("terrain in centimetres without a word of it", lambda: terrain_of("centimetres.tif", slope() * 100))
doubted("terrain with posts of -9999 and no nodata value", with_marks)
doubted("terrains that overlap 40 m apart", lambda: terrain_of("low.tif", slope()) + terrain_of("high.tif", slope() + 70, at=(DEM_AT[0] + 900, DEM_AT[1])))
doubted("terrains on other grids that overlap 40 m apart",
        lambda: terrain_of("low.tif", slope()) + ["--terrain", gdal.Warp("warped.tif", gdal.Open(terrain("up.tif", slope() + 40)), dstSRS="EPSG:4326")
                                                  .GetDescription()])
doubted("feet beside metres, without a word of it", lambda: terrain_of("low.tif", slope()) + terrain_of("feet.tif", slope() / FEET))


@row("one post of terrain for the whole class raster", "build", "refused")
def one_post():
    terrain("coarse.tif", numpy.full((3, 3), 100, numpy.float32), at=(WEST - 3000, NORTH + 3000), step=3000)
    words = ["coarse.tif" if word == "dem.tif" else word for word in BUILD_AREA] + ["--out", "coarse.lmdb"]
    assert trusted(words).code == 0
    return db(*words)


def build_with(option, path):
    return BUILD_AREA + [option, path, "--out", "with.lmdb"]


def wrong_raster(name, option, make, goes_on=True):
    @row(name, "build", "refused")
    def is_doubted():
        words = build_with(option, make())
        done = trusted(words)
        assert not goes_on or done.code == 0, done.err
        return db(*words)


def plane_of(name, values, kind=gdal.GDT_Float32, **more):
    return lambda: raster(name, [numpy.asarray(values, numpy.float32) if kind == gdal.GDT_Float32 else values], kind, **more)


GAMMA = numpy.random.default_rng(3).normal(-15, 4, (SIDE, SIDE))
wrong_raster("class raster as reflectivity", "--reflectivity", lambda: "classes.tif")
wrong_raster("class raster without names as reflectivity", "--reflectivity", lambda: without_names())
wrong_raster("linear power as reflectivity", "--reflectivity", plane_of("linear.tif", 10 ** (GAMMA / 10)))
wrong_raster("reflectivity with an undeclared nodata value", "--reflectivity", plane_of("undeclared.tif", numpy.where(GAMMA > -10, -9999, GAMMA)))
wrong_raster("elevations as reflectivity", "--reflectivity", plane_of("elevations.tif", slope(side=SIDE) + 0.25), goes_on=False)
wrong_raster("class raster as heights", "--heights", lambda: "classes.tif")
wrong_raster("class raster without names as heights", "--heights", lambda: without_names())
wrong_raster("reflectivity as heights", "--heights", lambda: "gamma.tif")
wrong_raster("elevations above the sea as heights", "--heights", plane_of("above-sea.tif", slope(side=SIDE)))


@row("picture (red, green, blue) as class raster", "build", "refused")
def picture_as_classes():
    return db(*["image.tif" if word == "classes.tif" else word for word in BUILD_AREA], "--out", "picture.lmdb")


@row("heights in feet by their band", "build", "done")
def heights_in_feet():
    towns = numpy.where(classes_plane() == 0, 3, classes_plane()).astype(numpy.uint8)
    raster("towns.tif", [towns], gdal.GDT_Byte, nodata=255, names=CLASSES)
    raster("feet-high.tif", [numpy.where(towns == 3, 20 / FEET, 0).astype(numpy.float32)], unit="ft")
    done = db(*["towns.tif" if word == "classes.tif" else word for word in BUILD_AREA], "--heights", "feet-high.tif", "--out", "feet.lmdb")
    assert re.search(r"heights m.* 20(\.0)?[ ;]", done.out), done.out
    return done


@row("heights in `smoots`", "build", "refused")
def heights_in_smoots():
    raster("smoots-high.tif", [numpy.zeros((SIDE, SIDE), numpy.float32)], unit="smoots")
    return db(*build_with("--heights", "smoots-high.tif"))


wrong_raster("reflectivity without a value", "--reflectivity", plane_of("nothing.tif", numpy.full((SIDE, SIDE), numpy.nan)))
wrong_raster("heights without a value", "--heights", plane_of("nothing.tif", numpy.full((SIDE, SIDE), numpy.nan)))
doubted("complex numbers as terrain", lambda: terrain_of("complex.tif", slope(), kind=gdal.GDT_CFloat32))


@row("terrain that is cut short", "build", "refused")
def cut_short():
    with open("cut.tif", "wb") as file:
        file.write(contents("dem.tif")[:2000])
    return db(*BUILD_TERRAIN, "--terrain", "cut.tif")


@row("terrain without a CRS", "build", "refused")
def without_crs():
    terrain("nowhere.tif", system=None)
    return db(*BUILD_TERRAIN, "--terrain", "nowhere.tif")


@row("terrain without a value", "build", "refused")
def without_values():
    terrain("voids.tif", numpy.full((60, 60), -9999, numpy.float32), nodata=-9999)
    return db(*BUILD_TERRAIN, "--terrain", "voids.tif")


@row("output without a name", "build", "refused")
def without_a_name():
    return db(*BUILD_TERRAIN[:-1], "", "--terrain", "dem.tif")


for pole, system in (("north", "EPSG:3413"), ("south", "EPSG:3031")):
    @row("terrain over the %s pole" % pole, "build", "done")
    def over_a_pole(system=system):
        raster("pole.tif", [numpy.full((60, 60), 50, numpy.float32)], at=(-30000, 30000), step=1000, system=system)
        done = db("build", "--classes", "heaton6.classes", "--terrain", "pole.tif", "--cell", "600", "--geoid-grid", "egm96",
                  "--out", "pole.lmdb")
        assert done.code == 0 and db("verify", "pole.lmdb").code == 0, done.err
        return done


def script(name, text):
    @row("script line, " + name, "landmass-sim", "refused")
    def is_refused():
        with open("flight.script", "w") as file:
            file.write(text + "\n")
        return tool("sim", "--db", "area.lmdb", "--script", "flight.script", "--seconds", "1")


for text in ("range 10", "5", "5 rang 10", "5 range", "5 range ten", "5 gain 99", "5 sar 42 -29"):
    script("`%s`" % text, text)


# ---- Training.

@row("constant image", "train", "refused")
def constant_image():
    raster("constant.tif", [numpy.full((SIDE, SIDE), 90, numpy.uint8)] * 3, gdal.GDT_Byte)
    return db(*["constant.tif" if word == "image.tif" else word for word in TRAIN], "--net", "constant.net")


@row("misspelt label", "train", "refused")
def misspelt_label():
    exemplars("misspelt.geojson", ("soil", "vegetatoin", "water"))
    return db(*["misspelt.geojson" if word == "fields.geojson" else word for word in TRAIN], "--net", "misspelt.net")


@row("every polygon twice", "train", "warned")
def polygons_twice():
    with open("fields.geojson") as file:
        twice = re.sub(r'(?s)("features": \[)(.*)(\n\])', r"\1\2,\2\3", file.read())
    with open("twice.geojson", "w") as file:
        file.write(twice)
    counts = []
    for name in ("fields.geojson", "twice.geojson"):
        done = db(*[name if word == "fields.geojson" else word for word in TRAIN], "--net", "twice.net")
        counts.append(re.findall(r"(?m)^(\w+) +(\d+) pixels", done.out))
    assert twice.count("POLYGON".title()) == 18 and len(counts[0]) == 3 and counts[0] == counts[1], counts
    assert "decay of weights 0" in done.out, done.out
    return done


@row("image of one band; classes without exemplars", "train", "warned")
def one_band():
    raster("band.tif", image_planes()[:1], gdal.GDT_Byte)
    done = db(*["band.tif" if word == "image.tif" else word for word in TRAIN], "--net", "band.net")
    assert done.code == 0, done.err
    seen = db("segment", "--image", "band.tif", "--classes", "heaton6.classes", "--net", "band.net", "--out", "band-classes.tif")
    right = (gdal.Open("band-classes.tif").ReadAsArray() == classes_plane()).mean()
    assert seen.code == 0 and right > 0.9, right
    return done


@row("image brighter than what the network was trained on", "segment", "warned")
def out_of_range():
    raster("bright.tif", [plane + 400 for plane in image_planes()], gdal.GDT_Float32)
    return db(*["bright.tif" if word == "image.tif" else word for word in SEGMENT], "--out", "bright-classes.tif")


# ---- Areas of an image.

@row("`--area` outside the image", "picture", "refused")
def picture_elsewhere():
    return kept_away("elsewhere.png", lambda: db("picture", "area.lmdb", "--plane", "class", "--area", "10,10,10.1,10.1", "--out", "elsewhere.png"))


@row("`--area` outside the image", "export", "refused")
def export_elsewhere():
    done = db("export", "area.lmdb", "--area", "10,10,10.01,10.01", "--out", "elsewhere")
    assert not os.path.exists("elsewhere") or not os.listdir("elsewhere"), os.listdir("elsewhere")
    return done


# ---- The geoid of an image.

def geoid_of(path):
    done = db("inspect", path)
    return float(re.search(r"geoid +([0-9.-]+) m", done.out).group(1)), "geoid grid" in done.out


@row("no word of the geoid", "build", "done")
def no_geoid():
    done = db(*BUILD_TERRAIN, "--terrain", "dem.tif")
    assert "geoid: 0 m above WGS-84 everywhere (assumed" in done.out and geoid_of("terrain.lmdb") == (0, False), done.out
    return done


@row("`--geoid-grid egm96`", "build", "done")
def geoid_of_proj():
    done = db(*BUILD_TERRAIN, "--terrain", "dem.tif", "--geoid-grid", "egm96")
    height, has_grid = geoid_of("terrain.lmdb")
    assert has_grid and abs(height - undulation()) < 0.1, (height, undulation())
    assert db("verify", "terrain.lmdb").code == 0
    return done


def geoid_raster(path, plane, **more):
    return raster(path, [plane], at=(6, 46), step=0.25, system="EPSG:4326", **more)


@row("`--geoid-grid` with a raster", "build", "done")
def geoid_of_a_raster():
    geoid_raster("geoid.tif", numpy.full((20, 20), 45.5, numpy.float32))
    done = db(*BUILD_TERRAIN, "--terrain", "dem.tif", "--geoid-grid", "geoid.tif")
    assert done.code == 0 and geoid_of("terrain.lmdb") == (45.5, True), done.err
    return done


@row("`--geoid-grid` that does not cover the image", "build", "refused")
def geoid_elsewhere():
    raster("elsewhere.tif", [numpy.full((4, 4), 45.5, numpy.float32)], at=(20, 10), step=0.25, system="EPSG:4326")
    return db(*BUILD_TERRAIN, "--terrain", "dem.tif", "--geoid-grid", "elsewhere.tif")


@row("elevations as `--geoid-grid`", "build", "refused")
def geoid_of_elevations():
    geoid_raster("high-geoid.tif", numpy.full((20, 20), 500, numpy.float32))
    return db(*BUILD_TERRAIN, "--terrain", "dem.tif", "--geoid-grid", "high-geoid.tif")


@row("`--geoid` beside `--geoid-grid`", "build", "refused")
def two_geoids():
    return db(*BUILD_TERRAIN, "--terrain", "dem.tif", "--geoid-grid", "egm96", "--geoid", "45")


# ---- The table and the run.

def says(run):
    """The first line that tells the reason, without the program's name."""
    lines = [line for line in run.err.splitlines() if ("warning: " in line) == (run.code == 0)]
    return re.sub(r"^landmass-\w+: ", "", lines[0]) if lines else ""


def table_row(name, command, wanted, run):
    said = says(run).replace("|", "\\|") if run else ""
    return "| %s | `%s` | %s | %s |\n" % (name, command, wanted, said)


def document_with(rows):
    with open(DOCUMENT) as file:
        text = file.read()
    head, tail = text.split(BEGIN)[0], text.split(END)[1]
    return text, head + BEGIN + "\n| input | command | outcome | what is said |\n|---|---|---|---|\n" + "".join(rows) + "\n" + END + tail


def main():
    home, failed, lines = os.getcwd(), 0, []
    print("1..%d" % (len(ROWS) + 1))
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        prepare()
        for number, (name, command, wanted, function) in enumerate(ROWS, 1):
            statement = "%s, %s: %s" % (command, name, wanted)
            try:
                done = function()
                assert done is None or done.outcome() == wanted, "%s: %s%s" % (done.outcome(), done.out, done.err)
                assert done is None or wanted == "done" or says(done), "no reason is given"
                lines.append(table_row(name, command, wanted, done))
                print("ok %d - %s" % (number, statement))
            except Exception as error:
                failed += 1
                print("not ok %d - %s\n# %s" % (number, statement, str(error).replace("\n", "\n# ")))
        os.chdir(home)
    old, new = document_with(lines)
    if "--write" in sys.argv:
        with open(DOCUMENT, "w") as file:
            file.write(new)
    elif old != new:
        failed += 1
        print("not ", end="")
    print("ok %d - %s has the table that was seen" % (len(ROWS) + 1, DOCUMENT))
    sys.exit(failed > 0)


main()
