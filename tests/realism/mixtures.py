"""What segment's rule for mixtures and its sieve do, beside no rule, GDAL's sieve and a majority of 3 x 3.

Usage: mixtures.py BUILD-DIR [OPTION-OF-TRAIN..]. A line a rule:

right   pixels given a class of which no other has more, of all and of the mixed ones
alien   mixed pixels given a class of which they hold nothing
blobs   8-connected groups of such pixels that touch a bank, a kilometre of it
notches pixels within 1.2 km of the airfield that are paved at three quarters or more and are given a class of
        open ground, in hectares
roofs   pixels that are nothing but structure and are given structure; area given structure over the true one

Scenes: the built-in one with its shares, and Jasper Ridge where LANDMASS_DATA is: trained on pixels nine tenths of one
class in every other square of 16 pixels, judged in the other squares by its published abundances."""
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from osgeo import gdal, osr
from scipy import ndimage

gdal.UseExceptions()
BIN = pathlib.Path(sys.argv[1]) / "bin"
CLASSES = "host-sim/programs/db/classes/heaton6.classes"
SPECK = 3  # pixels: regions of fewer are specks, as --sieve 60 has them in pixels of 5 m
RULES = (("the network alone", ("--mixtures", 0, "--sieve", 0)), ("sieve", ("--mixtures", 0)), ("mixtures", ("--sieve", 0)),
         ("mixtures and sieve", ()))
SOIL, ASPHALT, CONCRETE, STRUCTURE, VEGETATION, WATER = range(6)


def run(program, *words):
    return subprocess.run([str(BIN / program), *map(str, words)], check=True, capture_output=True, text=True).stdout


def around(plane):
    """The nine planes of a pixel and its neighbours; outside there is what lies at the edge."""
    wide = np.pad(plane, 1, mode="edge")
    height, width = plane.shape
    return [wide[y:y + height, x:x + width] for y in range(3) for x in range(3)]


def majority(given, classes):
    votes = np.stack([sum((p == c).astype(np.uint8) for p in around(given)) for c in range(classes)])
    own = np.take_along_axis(votes, given[None].astype(int), 0)[0]
    return np.where(own == votes.max(0), given, votes.argmax(0))


def gdal_sieved(given):
    """Specks take the class of their largest neighbour."""
    band = [gdal.GetDriverByName("MEM").Create("", *given.shape[::-1]) for _ in range(2)]
    band[0].WriteArray(given)
    gdal.SieveFilter(band[0].GetRasterBand(1), None, band[1].GetRasterBand(1), SPECK, 8)
    return band[1].ReadAsArray()


def general(given, shares, where):
    """`shares` are height x width x classes."""
    got = np.take_along_axis(shares, given[..., None].astype(int), 2)[..., 0]
    best, whole = shares.max(2), shares.sum(2)
    mixed = where & (best < 0.9 * whole)
    return 100 * (got >= best)[where].mean(), 100 * (got >= best)[mixed].mean(), 100 * (got[mixed] <= 0.02 * whole[mixed]).mean()


def of_the_built_in(given, shares, cell_m, airfield):
    got = np.take_along_axis(shares, given[..., None].astype(int), 2)[..., 0]
    wet = shares[..., WATER] >= 2
    edges = (wet[:, 1:] != wet[:, :-1]).sum() + (wet[1:] != wet[:-1]).sum()
    bank_km = edges * cell_m * np.pi / 4000  # a line at any angle crosses 4 / pi edges for each of its cells
    bank = np.any([p != wet for p in around(wet)], axis=0)
    groups, _ = ndimage.label(got == 0, np.ones((3, 3)))
    blobs = np.unique(groups[bank & (got == 0)]).size
    paved = shares[..., ASPHALT] + shares[..., CONCRETE] >= 3
    notches = paved & airfield & np.isin(given, (SOIL, VEGETATION))
    roofs = shares[..., STRUCTURE] == 4
    return (blobs / bank_km, notches.sum() * cell_m ** 2 / 1e4, 100 * (given[roofs] == STRUCTURE).mean(),
            (given == STRUCTURE).sum() / (shares[..., STRUCTURE].sum() / 4))


def say(name, figures, rest=()):
    line = f"{name:31s} right {figures[0]:6.2f} %, of the mixed {figures[1]:5.2f} %, alien {figures[2]:5.2f} %"
    if rest:
        line += "; blobs %.2f /km, notches %.3f ha, roofs %.1f %%, area %.2f" % rest
    print(line, flush=True)


def segmented(folder, image, classes, *options):
    run("landmass-db", "segment", "--image", image, "--net", folder / "net", "--classes", classes, "--out", folder / "classes.tif",
        *options)
    return gdal.Open(str(folder / "classes.tif")).ReadAsArray()


def built_in(folder):
    run("landmass-scene", "--out", folder, "--shares")
    said = run("landmass-db", "train", "--image", folder / "image.tif", "--exemplars", folder / "exemplars.geojson", "--classes",
               CLASSES, "--net", folder / "net", *sys.argv[2:])
    shares = gdal.Open(str(folder / "shares.tif")).ReadAsArray().transpose(1, 2, 0).astype(np.uint8)
    image = gdal.Open(str(folder / "image.tif"))
    west, cell_m, _, north, _, _ = image.GetGeoTransform()
    places = (folder / "scene.txt").read_text().split("# place")[1]
    place = next(line.split() for line in places.splitlines() if line.startswith("airfield "))
    utm, degrees = osr.SpatialReference(image.GetProjection()), osr.SpatialReference()
    degrees.ImportFromEPSG(4326)
    east_m, north_m, _ = osr.CoordinateTransformation(degrees, utm).TransformPoint(float(place[1]), float(place[2]))
    rows, columns = np.mgrid[0:shares.shape[0], 0:shares.shape[1]]
    airfield = np.hypot(west + cell_m * columns - east_m, north - cell_m * rows - north_m) < 1200
    print("built-in scene;", next(line for line in said.splitlines() if line.startswith("overall")))
    everywhere = np.ones(airfield.shape, bool)
    for name, options in RULES:
        given = segmented(folder, folder / "image.tif", CLASSES, *options)
        say(name, general(given, shares, everywhere), of_the_built_in(given, shares, cell_m, airfield))
        if name == RULES[0][0]:
            voted = majority(given, 6)
            say("majority of 3 x 3", general(voted, shares, everywhere), of_the_built_in(voted, shares, cell_m, airfield))
        if options[-2:] == ("--sieve", 0):
            left = gdal_sieved(given)
            say(f"{name}, GDAL's sieve", general(left, shares, everywhere), of_the_built_in(left, shares, cell_m, airfield))


def jasper(folder, data):
    names = "tree", "water", "dirt", "road"
    # Somewhere, in pixels of 20 m: a speck's ground is counted in square metres.
    image = folder / "jasper.tif"
    gdal.Translate(str(image), str(data / "tm_like_6band.bsq"), outputSRS="EPSG:32610", outputBounds=(0, 2000, 2000, 0))
    shares = gdal.Open(str(data / "abundance_tree_water_dirt_road.bsq")).ReadAsArray().transpose(1, 2, 0)
    rows, columns = np.mgrid[0:shares.shape[0], 0:shares.shape[1]]
    (folder / "t").write_text("".join(f"[{n}]\ncolour = 0 0 0\nkind = ground\ngamma_db = -20\nspread_db = 3\nlimits_db = -30 -10\n"
                                      for n in names))
    (folder / "m").write_text("".join(f"{i + 1} = {n}\n" for i, n in enumerate(names)))
    figures = {}
    for fold in range(2):
        judged = (rows // 16 + columns // 16) % 2 == fold
        labels = np.where((shares.max(2) > 0.9) & ~judged, shares.argmax(2) + 1, 0)
        out = gdal.GetDriverByName("GTiff").Create(str(folder / "labels.tif"), *labels.shape[::-1])
        out.WriteArray(labels.astype(np.uint8))
        out = None
        for seed in (1, 2, 3):
            run("landmass-db", "train", "--image", image, "--classes", folder / "t", "--labels", folder / "labels.tif", "--map",
                folder / "m", "--net", folder / "net", "--seed", seed, "--priors", "equal", *sys.argv[2:])
            for name, options in (RULES[0], RULES[2], ("mixtures and sieve", ("--sieve", 400 * SPECK))):
                given = segmented(folder, image, folder / "t", *options)
                figures.setdefault(name, []).append(general(given, shares, judged))
                if name == RULES[0][0]:
                    figures.setdefault("majority of 3 x 3", []).append(general(majority(given, 4), shares, judged))
                if name == RULES[2][0]:
                    figures.setdefault("mixtures, GDAL's sieve", []).append(general(gdal_sieved(given), shares, judged))
    print("Jasper Ridge, 6 bands, means of two halves and three seeds")
    for name, rows in figures.items():
        say(name, np.mean(rows, 0))


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        built_in(folder)
        data = pathlib.Path(os.environ.get("LANDMASS_DATA", "../shared/data")) / "jasper_ridge_aviris/derived"
        if data.exists():
            jasper(folder, data)


main()
