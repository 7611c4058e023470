"""The ground of the whole Earth as three rasters that `landmass-db build` takes: classes.tif, gamma.tif and terrain.tif.

Land and water are those of GSHHG's full shorelines, which GMT reads (packages gmt and gmt-gshhg-full). Relief is that of
ETOPO at 20 minutes. What is finer than that is made up: fractal noise, as strong as the relief is rough around there, and
dry and green land by latitude and height. It serves for size, seams, time and coasts, not for finding one's way inland.

    earth.py --relief FOLDER --out FOLDER [--step ARC-SECONDS] [--only WEST,SOUTH,EAST,NORTH]
    earth.py --check POINTS.csv ... --out FOLDER        # columns lon_deg,lat_deg,land: how many of them the rasters have right

FOLDER of --relief holds etopo20data.gz: 540 rows from the south, 1,081 columns from 20 degrees 10 minutes east.
"""

import argparse
import csv
import gzip
import os
import subprocess
import sys
import tempfile

import numpy as np
from osgeo import gdal

gdal.UseExceptions()
CLASSES = ("soil", "asphalt", "concrete", "structure", "vegetation", "water")
SOIL, VEGETATION, WATER = (CLASSES.index(name) for name in ("soil", "vegetation", "water"))
EARTH_M = 6371000.0
BLOCK = 2700  # pixels along a block's side: 250 MiB at most
GAMMA_DB = (-15, -40)  # of vegetation and of water, as in the class table
COARSEST_M = 24000.0  # wavelength of the first octave: below what the relief resolves


def read_relief(folder):
    """Metres; rows from south to north with a pole on either end, columns from west to east with one more on either side."""
    path = os.path.join(folder, "etopo20data.gz")
    try:
        with gzip.open(path, "rt") as file:
            heights = np.array(file.read().split(), dtype=np.float32)
    except (OSError, ValueError) as error:
        sys.exit("earth: %s: %s; give the folder of ETOPO at 20 minutes" % (path, error))
    if heights.size != 540 * 1081:
        sys.exit("earth: %s: has %d values instead of 583740; give ETOPO at 20 minutes" % (path, heights.size))
    heights = np.maximum(heights.reshape(540, 1081)[:, :1080], 0)
    heights = np.vstack([np.full(1080, heights[0].mean()), heights, np.full(1080, heights[-1].mean())])
    return np.hstack([heights[:, -1:], heights, heights[:, :1]]).astype(np.float32)


def roughness(relief):
    """Spread of the relief among a place and its eight neighbours, metres."""
    around = np.pad(relief, 1, mode="edge")
    near = [around[y : y + relief.shape[0], x : x + relief.shape[1]] for y in range(3) for x in range(3)]
    return np.std(near, axis=0).astype(np.float32)


def bilinear(grid, latitude, longitude):
    """At rows of latitude and columns of longitude, degrees."""
    y = np.clip((latitude + 90) * 3 + 0.5, 0, 540.999)
    y = np.where(y < 1, np.maximum((latitude + 90) * 6, 0), y)  # the half cell beside a pole
    y = np.where(y > 540, 540 + np.clip((latitude - 89.5) * 3 - 1, 0, 0.5) * 2, y)
    x = ((longitude - 20) % 360) * 3 + 0.5
    row, column = np.minimum(y.astype(int), 540), x.astype(int)
    fy, fx = (y - row)[:, None].astype(np.float32), (x - column)[None, :].astype(np.float32)
    low, high = grid[row], grid[row + 1]
    south = low[:, column] * (1 - fx) + low[:, column + 1] * fx
    north = high[:, column] * (1 - fx) + high[:, column + 1] * fx
    return south * (1 - fy) + north * fy


def hashed(x, y, z, seed):
    """A number in -1..1 for a point of a lattice."""
    z = np.atleast_1d(z)  # numpy warns where a number alone overflows
    h = x * np.uint32(0x9E3779B1) ^ y * np.uint32(0x85EBCA77) ^ z * np.uint32(0xC2B2AE3D) ^ np.uint32(seed)
    h = (h ^ (h >> np.uint32(15))) * np.uint32(0x2C1B3C6D)
    h = (h ^ (h >> np.uint32(12))) * np.uint32(0x297A2D39)
    return (h ^ (h >> np.uint32(15))).astype(np.float32) * np.float32(2.0**-31) - np.float32(1)


def noise(points, wavelength_m, seed):
    """Smooth noise of places on the sphere, so that neither the antimeridian nor a pole shows."""
    at = points * (EARTH_M / wavelength_m) + 2.0**20
    cell = np.floor(at)
    f = (at - cell).astype(np.float32)
    f = f * f * (3 - 2 * f)
    cell = cell.astype(np.uint32)
    total = np.zeros(points.shape[1], dtype=np.float32)
    for corner in range(8):
        step = [(corner >> axis) & 1 for axis in range(3)]
        weight = np.ones(points.shape[1], dtype=np.float32)
        for axis in range(3):
            weight *= f[axis] if step[axis] else 1 - f[axis]
        total += weight * hashed(*(cell[axis] + np.uint32(step[axis]) for axis in range(3)), seed)
    return total


def fractal(points, wavelength_m, shortest_m, seed):
    """Octaves down to the shortest wavelength, each half as strong as the one before."""
    total, strength = np.zeros(points.shape[1], dtype=np.float32), np.float32(1)
    while wavelength_m >= shortest_m:
        total += strength * noise(points, wavelength_m, seed)
        wavelength_m, strength, seed = wavelength_m / 2, strength / 2, seed + 1
    return total


def shores(west, south, east, north, step_s):
    """GSHHG's levels at the middles of pixels, north first: 0 sea, 1 land, 2 lake, 3 island in it, 4 pond."""
    with tempfile.TemporaryDirectory() as folder:
        # -A1: what is smaller than a square kilometre is left out where pixels are larger, which halves the time.
        words = ["gmt", "grdlandmask", "-Df", "-A%d" % (step_s >= 30), "-R%.9f/%.9f/%.9f/%.9f" % (west, east, south, north),
                 "-I%gs" % step_s, "-r", "-N0/1/2/3/4", "-G%s/mask.nc=nb" % folder]
        done = subprocess.run(words, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit("earth: %s: %s; install gmt and gmt-gshhg-full" % (" ".join(words[:2]), done.stderr.strip()))
        return gdal.Open(folder + "/mask.nc").ReadAsArray()


def block_of(ground, west, north, columns, rows, step_s):
    """Classes and heights of a block, north first."""
    step = step_s / 3600.0
    relief, rough = ground
    level = shores(west, north - rows * step, west + columns * step, north, step_s)
    latitude, longitude = north - (np.arange(rows) + 0.5) * step, west + (np.arange(columns) + 0.5) * step
    height = np.where(level == 0, np.float32(0), bilinear(relief, latitude, longitude))
    land = np.nonzero((level == 1) | (level == 3))
    classes = np.full(level.shape, WATER, dtype=np.uint8)
    if land[0].size:
        phi, turn = np.radians(latitude[land[0]]), np.radians(longitude[land[1]])
        points = np.array([np.cos(phi) * np.cos(turn), np.cos(phi) * np.sin(turn), np.sin(phi)])
        detail = fractal(points, COARSEST_M, 2 * step * 111195, 1)
        strength = 0.4 * bilinear(rough, latitude, longitude)[land] + 4
        height[land] = np.maximum(height[land] + strength * detail, 1)
        dry = 1.3 * np.exp(-(((np.abs(latitude[land[0]]) - 24) / 9) ** 2)) + 0.6 * fractal(points, 900000.0, 100000.0, 99)
        bare = (dry > 0.8) | (height[land] > 3500 - 40 * np.abs(latitude[land[0]])) | (np.abs(latitude[land[0]]) > 74)
        classes[land] = np.where(bare, SOIL, VEGETATION)
    return classes, np.rint(height).astype(np.int16)


def gamma_of(classes, row, column):
    """Reflectivity of a block, whole dB: the class's mean at X band, and a spread over pixels and over squares of eight. Without
    it `build` draws 16 values for each cell, which takes four times as long as all the rest."""
    mean, spread = np.full(6, -20, np.float32), np.full(6, 3, np.float32)
    mean[VEGETATION], mean[WATER] = GAMMA_DB
    y, x = (np.arange(row, row + classes.shape[0], dtype=np.uint32)[:, None],
            np.arange(column, column + classes.shape[1], dtype=np.uint32)[None, :])
    rank = sum(hashed(x >> np.uint32(far), y >> np.uint32(far), np.uint32(far), seed) for far, seed in ((0, 7), (0, 8), (3, 9)))
    return np.rint(mean[classes] + spread[classes] * rank).astype(np.int16)


def new_raster(path, columns, rows, west, north, step, kind):
    options = ["TILED=YES", "COMPRESS=DEFLATE", "PREDICTOR=%d" % (2 if kind == gdal.GDT_Int16 else 1), "BIGTIFF=IF_SAFER"]
    raster = gdal.GetDriverByName("GTiff").Create(path, columns, rows, 1, kind, options)
    raster.SetProjection('GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],'
                         'UNIT["degree",0.0174532925199433],AUTHORITY["EPSG","4326"]]')
    raster.SetGeoTransform((west, step, 0, north, 0, -step))
    return raster


def make(arguments):
    west, south, east, north = arguments.only
    step = arguments.step / 3600.0
    columns, rows = round((east - west) / step), round((north - south) / step)
    os.makedirs(arguments.out, exist_ok=True)
    relief = read_relief(arguments.relief)
    names = [arguments.out + "/" + name for name in ("classes.tif", "terrain.tif", "gamma.tif")]
    rasters = [new_raster(name + ".part", columns, rows, west, north, step, kind)
               for name, kind in zip(names, (gdal.GDT_Byte, gdal.GDT_Int16, gdal.GDT_Int16))]
    rasters[0].GetRasterBand(1).SetCategoryNames(list(CLASSES))
    rasters[0].GetRasterBand(1).SetNoDataValue(255)
    ground = relief, roughness(relief)
    for row in range(0, rows, BLOCK):
        for column in range(0, columns, BLOCK):
            wide, high = min(BLOCK, columns - column), min(BLOCK, rows - row)
            classes, heights = block_of(ground, west + column * step, north - row * step, wide, high, arguments.step)
            for raster, values in zip(rasters, (classes, heights, gamma_of(classes, row, column))):
                raster.GetRasterBand(1).WriteArray(values, column, row)
            print("row %d of %d, column %d of %d" % (row, rows, column, columns), flush=True)
    for raster in rasters:
        raster.FlushCache()
    del rasters, raster
    for name in names:
        for end in ("", ".aux.xml"):
            if os.path.exists(name + ".part" + end):
                os.replace(name + ".part" + end, name + end)


def check(arguments):
    """Points that somebody else knows to be land or water."""
    raster = gdal.Open(arguments.out + "/classes.tif")
    west, step, _, north, _, _ = raster.GetGeoTransform()
    band = raster.GetRasterBand(1)
    for path in arguments.check:
        right = shore = count = 0
        with open(path, newline="") as file:
            for row in csv.DictReader(line for line in file if not line.startswith("#")):
                x, y = int((float(row["lon_deg"]) - west) / step), int((north - float(row["lat_deg"])) / step)
                is_land = band.ReadAsArray(x, y, 1, 1)[0, 0] != WATER
                x, y = min(max(x - 1, 0), raster.RasterXSize - 3), min(max(y - 1, 0), raster.RasterYSize - 3)
                around = band.ReadAsArray(x, y, 3, 3) != WATER
                count += 1
                right += is_land == (int(row["land"]) != 0)
                shore += is_land != (int(row["land"]) != 0) and around.any() and not around.all()
        print("%s: %d of %d right, %d wrong beside a shore, %d wrong elsewhere" % (path, right, count, shore, count - right - shore))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--relief", metavar="FOLDER")
    parser.add_argument("--out", metavar="FOLDER", required=True)
    parser.add_argument("--step", type=float, default=60, help="arc seconds between pixels (60)")
    parser.add_argument("--only", type=lambda text: tuple(float(word) for word in text.split(",")), default=(-180, -90, 180, 90))
    parser.add_argument("--check", nargs="+", metavar="POINTS.csv")
    arguments = parser.parse_args()
    if arguments.check:
        check(arguments)
    elif not arguments.relief:
        parser.error("--relief is required")
    else:
        make(arguments)


if __name__ == "__main__":
    main()
