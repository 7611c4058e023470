#!/usr/bin/env python3
"""Class and reflectivity rasters that are made in strips: the bytes of a run in one go, over windows, mixtures and the sieve at
the borders of strips. The sieve beside GDAL's over the whole raster. What mosaic refuses, and what a plan says of sources.

TAP on standard output. BUILD names the build's folder.
"""

import hashlib
import json
import os
import random
import re
import resource
import shutil
import subprocess
import tempfile

import numpy
from osgeo import gdal, osr

from database import BUILD, CLASSES, check, db, end, good, refused

WIDTH, HEIGHT = 300, 3500


def digest(path):
    return hashlib.sha256(open(path, "rb").read()).hexdigest()


def classes_of(path):
    return gdal.Open(path).ReadAsArray()


def write(path, bands, first, nodata=None):
    """Bands of numbers with fractions, from row `first` of the whole on."""
    reference = osr.SpatialReference()
    reference.ImportFromEPSG(32626)
    file = gdal.GetDriverByName("GTiff").Create(path, bands.shape[2], bands.shape[1], bands.shape[0], gdal.GDT_Float32, ["TILED=YES"])
    file.SetGeoTransform((500000.0, 5.0, 0.0, 4650000.0 - 5.0 * first, 0.0, -5.0))
    file.SetProjection(reference.ExportToWkt())
    for number, values in enumerate(bands, 1):
        file.GetRasterBand(number).WriteArray(values)
        file.GetRasterBand(number).SetNoDataValue(0)
    del file


def tall_image():
    """Copies of the scene's picture, each turned and with noise of its own: specks and mixtures everywhere. Bars of one class and
    of one pixel stand across the borders of strips, as do holes."""
    subprocess.run([BUILD + "/bin/landmass-scene", "--out", "scene", "--size", "320"], check=True, capture_output=True)
    scene = gdal.Open("scene/image.tif").ReadAsArray().astype(numpy.float32)
    numbers = numpy.random.default_rng(4)
    rows = numpy.concatenate([numpy.rot90(scene, k % 4, (1, 2)) for k in range(12)], 1)[:, :HEIGHT, :WIDTH]
    bands = rows * (1 + 0.05 * numbers.normal(size=rows.shape))
    for border in (1024, 2048):
        for k, column in enumerate(range(10, WIDTH, 13)):
            bands[:, border - k % 5 - 1:border + k % 3 + 1, column:column + 1 + k % 2] = bands[:, 40:41, 40 + k:41 + k]
        bands[:, border - 3:border + 3, 200:203] = 0
    write("image.tif", bands.astype(numpy.float32), 0)
    return bands.astype(numpy.float32)


def train(net, *options):
    good("train", "--image", "scene/image.tif", "--exemplars", "scene/exemplars.geojson", "--classes", CLASSES, "--net", net, "--epochs",
         "60", *options)
    return net


def strips(command, count, folder, options):
    """Made in any order. Returns their names, shuffled."""
    os.makedirs(folder, exist_ok=True)
    numbers = list(range(count))
    random.Random(3).shuffle(numbers)
    for number in numbers:
        good(command, *options, "--shards", count, "--shard", number, "--out", "%s/%d.tif" % (folder, number), "--json", "%s/%d.json"
             % (folder, number))
    return [word for number in reversed(numbers) for word in ("--strip", "%s/%d.tif" % (folder, number))]


def same_bytes(what, command, options):
    good(command, *options, "--out", "whole.tif", "--json", "whole.json")
    for count in (2, 4):
        names = strips(command, count, "%d" % count, options)
        good("mosaic", *names, "--out", "joined.tif")
        same_side = os.path.exists("whole.tif.aux.xml") == os.path.exists("joined.tif.aux.xml") and \
            (not os.path.exists("whole.tif.aux.xml") or digest("whole.tif.aux.xml") == digest("joined.tif.aux.xml"))
        check("%s, in %d strips: the bytes of a run in one go" % (what, count), digest("joined.tif") == digest("whole.tif") and same_side,
              "%d pixels differ" % (classes_of("joined.tif") != classes_of("whole.tif")).sum())
    good("mosaic", *names, "--out", "joined.vrt")
    check("and as a virtual raster the same pixels", (classes_of("joined.vrt") == classes_of("whole.tif")).all())
    reports = [json.load(open("4/%d.json" % k))["report"] for k in range(4)]
    told = [{c["name"]: c["pixels"] for c in r["classes"]} for r in [*reports, json.load(open("whole.json"))["report"]]]
    check("and what the strips count is what the whole counts", all(sum(t.get(name, 0) for t in told[:-1]) == n for name, n in
                                                                   told[-1].items()), str(told))


def sieve_beside_gdal(options):
    """GDAL's filter over all rows at once, which compares the sizes of whole regions. Ours counts them within a margin."""
    good("segment", *options, "--sieve", "0", "--out", "unsieved.tif")
    good("segment", *options, "--sieve", "300", "--out", "sieved.tif", "--json", "sieved.json")
    fewer = json.load(open("sieved.json"))["report"]["sieve"]["speck_pixels"]
    file = gdal.Open("unsieved.tif")
    source = file.GetRasterBand(1)
    wanted = gdal.GetDriverByName("MEM").Create("", WIDTH, HEIGHT, 1, gdal.GDT_Byte)
    gdal.SieveFilter(source, source.GetMaskBand(), wanted.GetRasterBand(1), fewer, 8)
    before, ours, theirs = source.ReadAsArray(), classes_of("sieved.tif"), wanted.ReadAsArray()
    changed = int((before != theirs).sum())
    differ = int(((before != ours) != (before != theirs)).sum())  # which class a speck takes is ours to say
    print("# sieve of %d pixels: GDAL over the whole takes %d pixels of %d for specks, ours others in %d; not sieved at all: %d"
          % (fewer, changed, before.size, differ, changed))
    check("the specks of a sieve in bands are those of GDAL over the whole but for one in a hundred",
          fewer == 12 and changed > 10000 and differ <= changed // 100)


def plans(options, bands):
    """What a strip is made of: rows of the two halves of an image, and their neighbours."""
    for name, first, last in (("north.tif", 0, 1500), ("south.tif", 1500, HEIGHT)):
        write(name, bands[:, first:last], first)
    gdal.BuildVRT("halves.vrt", ["north.tif", "south.tif"]).FlushCache()
    halves = ["--image", "halves.vrt", *options[2:]]
    good("segment", *halves, "--shards", "4", "--plan", "image.plan")
    text = open("image.plan").read()
    rows = re.findall(r"^strip (\d) (\d+) (\d+)$", text, re.M)
    check("a plan tells the rows of each strip", rows == [("0", "0", "1024"), ("1", "1024", "2048"), ("2", "2048", "3072"), ("3", "3072",
                                                                                                                 "3500")], text)
    reach = {k: {name for name in ("north.tif", "south.tif", "halves.vrt", options[5]) if re.search(r"^source %d \S*%s$"
                                                                                                  % (k, name), text, re.M)} for k in range(4)}
    always = {"halves.vrt", options[5]}
    check("and which files reach into it", reach == {0: always | {"north.tif"}, 1: always | {"north.tif", "south.tif"},
                                                     2: always | {"south.tif"}, 3: always | {"south.tif"}}, str(reach))
    good("segment", *halves, "--out", "whole.tif")
    old = strips("segment", 4, "old", halves)
    before = [digest("old/%d.tif" % k) for k in range(4)]
    changed = bands[:, 1500:HEIGHT].copy()
    changed[:, 900:1400] = changed[:, 100:600]
    write("south.tif", changed, 1500)
    good("segment", *halves, "--shards", "4", "--shard", "0", "--out", "again.tif")
    check("a strip that a changed source does not reach is the same bytes", digest("again.tif") == before[0])
    for k in (1, 2, 3):
        good("segment", *halves, "--shards", "4", "--shard", str(k), "--out", "old/%d.tif" % k)
    good("segment", *halves, "--out", "whole.tif")
    good("mosaic", *old, "--out", "joined.tif")
    check("with those that it reaches made again the raster is that of a run in one go", digest("joined.tif") == digest("whole.tif") and
          before[2] != digest("old/2.tif"))


def refusals(options):
    names = strips("segment", 3, "3", options)
    good("segment", *options, "--out", "whole.tif")
    refused("a strip that is missing is named", db("mosaic", *names[2:], "--out", "x.tif"), "strip %s of 3 is missing"
            % re.search(r"(\d)\.tif", names[1]).group(1))
    refused("one that is given twice, too", db("mosaic", *names, *names[:2], "--out", "x.tif"), names[1], "and so is")
    refused("a raster that is no strip, too", db("mosaic", *names[2:], "--strip", "whole.tif", "--out", "x.tif"), "whole.tif", "is no strip")
    strips("segment", 2, "2", options)
    refused("and a strip of another cut", db("mosaic", *names, "--strip", "2/0.tif", "--out", "x.tif"), "2/0.tif", "one of 2 strips")
    shutil.copy("3/1.tif", "moved.tif")
    file = gdal.Open("moved.tif", gdal.GA_Update)
    file.SetGeoTransform((500005.0, 5.0, 0.0, 4650000.0 - 5.0 * 1024, 0.0, -5.0))
    del file
    refused("and one that lies elsewhere", db("mosaic", "--strip", "3/0.tif,moved.tif,3/2.tif", "--out", "x.tif"), "moved.tif",
            "does not go on where strip 0")
    data = bytearray(open("3/2.tif", "rb").read())
    with open("torn.tif", "wb") as file:
        file.write(data[:len(data) // 2])
    refused("and one that is torn", db("mosaic", "--strip", "3/0.tif,3/1.tif,torn.tif", "--out", "x.tif"), "torn.tif")
    check("after all this there is no raster", not os.path.exists("x.tif"))
    refused("more strips than there are bands of 1,024 rows", db("segment", *options, "--shards", "5", "--shard", "0", "--out", "x.tif"),
            "5 strips of 1024 rows are more than 3500 rows")
    refused("a strip that there is not", db("segment", *options, "--shards", "3", "--shard", "3", "--out", "x.tif"), "3 is none of 0..2")
    refused("neither a strip nor a plan", db("segment", *options, "--shards", "3", "--out", "x.tif"), "needs --shard", code=2)
    refused("no output", db("segment", *options), "--out", "is missing", code=2)
    ground = ["--class-raster", "whole.tif", "--classes", CLASSES]
    refused("a method that looks at all pixels", db("reflect", *ground, "--method", "adjust", "--image", "image.tif", "--shards", "3",
                                                    "--shard", "0", "--out", "x.tif"), "--shards: needs --method assign", code=2)
    done = db("segment", *options, "--shards", "3", "--shard", "1", "--out", "x.tif", limit=(resource.RLIMIT_FSIZE, (9000, 9000)))
    refused("a full disk", done, "x.tif", "free some space")
    check("and nothing is left of it", not [name for name in os.listdir(".") if name.startswith("x.tif")], str(os.listdir(".")))


def main():
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        bands = tall_image()
        near = ["--image", "image.tif", "--classes", CLASSES, "--net", train("near.net")]
        wide = ["--image", "image.tif", "--classes", CLASSES, "--net", train("wide.net", "--context", "7")]
        same_bytes("classes by mixtures and sieve", "segment", [*near, "--sieve", "300"])
        same_bytes("classes by a network with windows", "segment", [*wide, "--spare", "structure"])
        same_bytes("without mixtures, and specks of up to 80 pixels", "segment", [*wide, "--mixtures", "0", "--sieve", "2000", "--reject",
                                                                                "nodata", "--sure", "0.6"])
        shutil.copy("whole.tif", "classes.tif")
        shutil.copy("whole.tif.aux.xml", "classes.tif.aux.xml")
        same_bytes("reflectivity", "reflect", ["--class-raster", "classes.tif", "--classes", CLASSES])
        sieve_beside_gdal(near)
        plans(near, bands)
        refusals(near)
        end()


main()
