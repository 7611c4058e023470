"""The ground of the whole Earth as three rasters that `landmass-db build` takes, classes.tif, gamma.tif and terrain.tif, and
the class table for them, earth.classes.

Land and water are those of GSHHG's full shorelines (package gmt-gshhg-full). Relief is that of ETOPO at 20 minutes. What is
finer than that is made up: fractal noise, as strong as the relief is rough around there, and dry and green land by latitude and
height. It serves for size, seams, time and coasts, not for finding one's way inland.

    earth.py --relief FOLDER --out FOLDER [--step ARC-SECONDS] [--only WEST,SOUTH,EAST,NORTH] [--jobs N]
    earth.py --check POINTS.csv ... --out FOLDER        # columns lon_deg,lat_deg,land: how many of them the rasters have right

FOLDER of --relief holds etopo20data.gz: 540 rows from the south, 1,081 columns from 20 degrees 10 minutes east.
"""

import argparse
import csv
import gzip
import math
import multiprocessing
import os
import sys

import numpy as np
from osgeo import gdal

gdal.UseExceptions()
GAMMA_DB = {"soil": -20, "vegetation": -15, "water": -40}  # of the classes there are, as their table has it
SOIL, VEGETATION, WATER = range(len(GAMMA_DB))
HERE = os.path.dirname(os.path.realpath(__file__))
TABLES = (HERE + "/../programs/db/classes/heaton6.classes", HERE + "/../heaton6.classes")  # of the sources, of the package
EARTH_M = 6371000.0
DEGREE_M = EARTH_M * math.pi / 180
BLOCK = 512  # pixels along a block's side: whole tiles of the rasters
CACHED = 16384  # points at a time: what numpy makes on its way stays in the processor's cache
COARSEST_M = 24000.0  # wavelength of the first octave: below what the relief resolves
SAMPLES = 8  # of a wavelength at least; straight between them
PRIMES = np.array([[0x9E3779B1], [0x85EBCA77], [0xC2B2AE3D]], dtype=np.uint32)  # one for each axis of a lattice
GSHHG = "/usr/share/gmt-gshhg/binned_GSHHS_f.nc"
SQUARE = 65535  # units along a side of GSHHG's squares of a degree
WEST = 3  # GSHHG's number of that side
GROUNDING_LINE = 6  # the level of Antarctica's other shore, below the ice
LEVEL_OF_BITS = np.array([bits.bit_length() for bits in range(16)], dtype=np.uint8)


class Block:
    """A part of a raster of the Earth, north first. Rows and columns count from the raster's corner."""

    def __init__(self, corner, step_s, row, column, shape):
        (self.west, self.north), self.step_s = corner, step_s
        self.row, self.column, self.shape = row, column, shape

    def latitude(self, row):
        """Of the middle of a row that counts from the block's first."""
        return self.north - (self.row + row + 0.5) * self.step_s / 3600

    def longitude(self, column):
        return self.west + (self.column + column + 0.5) * self.step_s / 3600

    def row_at(self, latitude):
        """Where the middle of row 3 is 3.0, and its upper edge 2.5."""
        return (self.north - latitude) * 3600 / self.step_s - 0.5 - self.row

    def column_at(self, longitude):
        return (longitude - self.west) * 3600 / self.step_s - 0.5 - self.column


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
    fy, fx = (y - row)[:, None].astype(np.float32), (x - column).astype(np.float32)
    line = grid[row] * (1 - fy) + grid[row + 1] * fy
    return np.take(line, column, axis=1) * (1 - fx) + np.take(line, column + 1, axis=1) * fx


def hashed(x, y, z, seed):
    """A number in -1..1 for a point of a lattice, whose coordinates were multiplied by PRIMES."""
    h = x ^ y ^ z ^ np.uint32(seed)
    for right, times in ((15, 0x2C1B3C6D), (12, 0x297A2D39)):
        h ^= h >> np.uint32(right)
        h *= np.uint32(times)
    h ^= h >> np.uint32(15)
    return h.astype(np.float32) * np.float32(2.0**-31) - np.float32(1)


def noise(points, wavelength_m, seed):
    """Smooth noise of places on the sphere, so that neither the antimeridian nor a pole shows."""
    at = points * (EARTH_M / wavelength_m) + 2.0**20
    cell = np.floor(at)
    f = (at - cell).astype(np.float32)
    f = f * f * (3 - 2 * f)
    low = cell.astype(np.uint32) * PRIMES
    x, y, z = zip(low, low + PRIMES)
    values = [hashed(a, b, c, seed) for a in x for b in y for c in z]
    for along in f:  # of eight corners four are left, then two, then one
        half = len(values) // 2
        values = [low + along * (high - low) for low, high in zip(values[:half], values[half:])]
    return values[0]


def noise_at(latitude, longitude, wavelength_m, seed):
    """At rows of latitude and columns of longitude, degrees."""
    phi, turn = np.radians(latitude)[:, None], np.radians(longitude)[None, :]
    made = np.empty((latitude.size, longitude.size), dtype=np.float32)
    some = max(CACHED // longitude.size, 1)
    for row in range(0, latitude.size, some):
        part = phi[row : row + some]
        points = np.array([np.cos(part) * np.cos(turn), np.cos(part) * np.sin(turn), np.sin(part) + 0 * turn])
        made[row : row + some] = noise(points.reshape(3, -1), wavelength_m, seed).reshape(-1, longitude.size)
    return made


def doubled(values):
    """On a lattice twice as fine, straight between two points."""
    for _ in range(2):
        fine = np.empty((2 * values.shape[0] - 1, values.shape[1]), dtype=np.float32)
        fine[::2] = values
        fine[1::2] = (values[1:] + values[:-1]) / 2
        values = fine.T
    return values


def samples_apart(wavelength_m, step_s):
    """Pixels between the samples of an octave: a power of two."""
    return 2 ** max(int(math.log2(wavelength_m / SAMPLES / (step_s / 3600 * DEGREE_M))), 0)


def fractal(block, wavelength_m, shortest_m, seed):
    """Octaves down to the shortest wavelength, each half as strong as the one before. Long ones are sampled at each second, fourth
    ... pixel of the raster, not of the block, so that neighbouring blocks agree."""
    apart = samples_apart(wavelength_m, block.step_s)
    y, x = block.row % apart, block.column % apart  # from the first sample to the block
    total = np.zeros([-(-(over + side) // apart) + 1 for over, side in zip((y, x), block.shape)], dtype=np.float32)
    strength = np.float32(1)
    while wavelength_m >= shortest_m or apart > 1:
        if apart > samples_apart(wavelength_m, block.step_s):
            total, apart = doubled(total), apart // 2
        if wavelength_m >= shortest_m:
            rows, columns = (apart * np.arange(count) - over for count, over in zip(total.shape, (y, x)))
            total = total + strength * noise_at(block.latitude(rows), block.longitude(columns), wavelength_m, seed)
        wavelength_m, strength, seed = wavelength_m / 2, strength / 2, seed + 1
    return total[y : y + block.shape[0], x : x + block.shape[1]]


class Shores:
    """GSHHG's full shorelines as GMT keeps them: squares of a degree, the level of their corners, and the shores within."""

    def __init__(self, path=GSHHG):
        try:
            group = gdal.OpenEx(path, gdal.OF_MULTIDIM_RASTER).GetRootGroup()
        except RuntimeError as error:
            sys.exit("earth: %s: %s; install gmt-gshhg-full" % (path, error))

        def array(name):
            return group.OpenMDArray(name).ReadAsArray()

        self.corner = array("Embedded_node_levels_in_a_bin") >> 9 & 7  # of the south-west
        self.first, self.count = array("Id_of_first_segment_in_a_bin"), array("N_segments_in_a_bin")
        self.info, self.begin = array("Embedded_npts_levels_exit_entry_for_a_segment"), array("Id_of_first_point_in_a_segment")
        self.x = array("Relative_longitude_from_SW_corner_of_bin").view(np.uint16)
        self.y = array("Relative_latitude_from_SW_corner_of_bin").view(np.uint16)

    def pieces(self, square):
        """Straight pieces of the shores of a square: x, y, x, y in 0..1 from its south-west corner, and a bit for the level. Where a
        shore meets the west side, a piece follows that side to the north: a shore bounds what lies right of its pieces."""
        segments = slice(self.first[square], self.first[square] + self.count[square])
        info, begin = self.info[segments], self.begin[segments]
        count, level, entry, leave = info >> 9, info >> 6 & 7, info >> 3 & 7, info & 7
        points = slice(begin[0], begin[-1] + count[-1])
        x, y = self.x[points] / SQUARE, self.y[points] / SQUARE
        begin = begin - begin[0]
        end = begin + count - 1
        bits = np.repeat(np.where(level == GROUNDING_LINE, 0, 1 << (level - 1)), count)
        along = np.delete([x[:-1], y[:-1], x[1:], y[1:], bits[1:]], end[:-1], axis=1)
        at = np.concatenate([begin[entry == WEST], end[leave == WEST]])
        return np.hstack([along, [0 * y[at], y[at], 0 * y[at], 0 * y[at] + 1, bits[at]]])

    def fill(self, level, square, top, left, side):
        """Levels of a square whose north-west corner is there in pixels of `level`, and whose sides are so many pixels long."""
        bits = np.zeros(level.shape, dtype=np.uint8)
        bits[:, 0] = (1 << self.corner[square]) - 1
        if self.count[square]:
            xa, ya, xb, yb, bit = self.pieces(square)
            xa, ya, xb, yb = left + xa * side, top + (1 - ya) * side, left + xb * side, top + (1 - yb) * side
            first, end = (np.clip(np.ceil(pick(ya, yb)), 0, level.shape[0]).astype(int) for pick in (np.minimum, np.maximum))
            crossed = end - first  # rows of pixels that a piece crosses
            piece = np.repeat(np.arange(crossed.size), crossed)
            row = np.arange(piece.size) - np.repeat(np.cumsum(crossed) - crossed - first, crossed)
            x = xa[piece] + (row - ya[piece]) / (yb - ya)[piece] * (xb - xa)[piece]
            column = np.maximum(np.ceil(x), 0).astype(int)
            seen = column < level.shape[1]
            np.bitwise_xor.at(bits, (row[seen], column[seen]), bit[piece][seen].astype(np.uint8))
        level[:] = LEVEL_OF_BITS[np.bitwise_xor.accumulate(bits, axis=1)]

    def levels(self, block):
        """At the middles of pixels: 0 sea, 1 land, 2 lake, 3 island in it, 4 pond."""
        made, side = np.zeros(block.shape, dtype=np.uint8), 3600 / block.step_s
        rows, columns = block.shape
        for north in range(math.ceil(block.latitude(0)), math.ceil(block.latitude(rows - 1)) - 1, -1):
            for west in range(math.floor(block.longitude(0)), math.floor(block.longitude(columns - 1)) + 1):
                y, x = block.row_at(north), block.column_at(west)
                top, bottom = (min(max(math.ceil(at), 0), rows) for at in (y, block.row_at(north - 1)))
                left, right = (min(max(math.ceil(at), 0), columns) for at in (x, block.column_at(west + 1)))
                if top < bottom and left < right:
                    self.fill(made[top:bottom, left:right], (90 - north) * 360 + west % 360, y - top, x - left, side)
        return made


def ground_of(block, shores, relief, rough):
    """Classes and heights, north first."""
    level = shores.levels(block)
    classes, height = np.full(block.shape, WATER, dtype=np.uint8), np.zeros(block.shape, dtype=np.float32)
    if level.any():
        latitude, longitude = block.latitude(np.arange(block.shape[0])), block.longitude(np.arange(block.shape[1]))
        is_land, from_equator = (level == 1) | (level == 3), np.abs(latitude)[:, None].astype(np.float32)
        height = np.where(level == 0, 0, bilinear(relief, latitude, longitude))
        detail = fractal(block, COARSEST_M, 2 * block.step_s / 3600 * DEGREE_M, 1)
        strength = 0.4 * bilinear(rough, latitude, longitude) + 4
        height = np.where(is_land, np.maximum(height + strength * detail, 1), height)
        dry = 1.3 * np.exp(-(((from_equator - 24) / 9) ** 2)) + 0.6 * fractal(block, 900000.0, 100000.0, 99)
        bare = (dry > 0.8) | (height > 3500 - 40 * from_equator) | (from_equator > 74)
        classes[is_land] = np.where(bare, SOIL, VEGETATION)[is_land]
    return classes, np.rint(height).astype(np.int16)


def gamma_of(classes, row, column):
    """Reflectivity of a block, whole dB: the class's mean at X band, and a spread over pixels and over squares of eight. Without
    it `build` draws 16 values for each cell, which takes four times as long as all the rest."""
    mean, spread = np.array(list(GAMMA_DB.values()), dtype=np.float32), np.float32(3)
    high, wide = classes.shape

    def rank(far, seed):
        """A number for each square of 2^far pixels."""
        y = np.arange(row >> far, (row + high - 1 >> far) + 1, dtype=np.uint32)[:, None]
        x = np.arange(column >> far, (column + wide - 1 >> far) + 1, dtype=np.uint32)
        return hashed(x * PRIMES[0], y * PRIMES[1], np.uint32(far) * PRIMES[2], seed)

    total = rank(0, 7) + rank(0, 8) + np.repeat(np.repeat(rank(3, 9), 8, axis=0), 8, axis=1)[:high, :wide]
    return np.rint(mean[classes] + spread * total).astype(np.int16)


def new_raster(path, columns, rows, west, north, step, kind):
    options = ["TILED=YES", "COMPRESS=DEFLATE", "ZLEVEL=1", "PREDICTOR=%d" % (2 if kind == gdal.GDT_Int16 else 1), "BIGTIFF=IF_SAFER"]
    raster = gdal.GetDriverByName("GTiff").Create(path, columns, rows, 1, kind, options)
    raster.SetProjection('GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],'
                         'UNIT["degree",0.0174532925199433],AUTHORITY["EPSG","4326"]]')
    raster.SetGeoTransform((west, step, 0, north, 0, -step))
    return raster


GROUND = []  # shores, relief and roughness: what the processes that `make` starts have of it


def block_of(at):
    """A block and its parts of the three rasters."""
    block = Block(*at)
    classes, heights = ground_of(block, *GROUND)
    return block, (classes, heights, gamma_of(classes, block.row, block.column))


def table_of(path):
    """What a class table says of the classes there are. With structures in it `build` would look for the direction of walls."""
    wanted, kept = True, []
    try:
        with open(path) as file:
            for line in file:
                if line.startswith("["):
                    wanted = line.split("]")[0][1:] in GAMMA_DB
                kept += [line] * wanted
    except OSError as error:
        sys.exit("earth: %s; give the table that has %s with --table" % (error, ", ".join(GAMMA_DB)))
    missing = [name for name in GAMMA_DB if not any(line.startswith("[%s]" % name) for line in kept)]
    if missing:
        sys.exit("earth: %s: there is no class %s; give a table that has %s" % (path, missing[0], ", ".join(GAMMA_DB)))
    return "".join(kept)


def make(arguments):
    table = table_of(arguments.table)
    west, south, east, north = arguments.only
    step = arguments.step / 3600.0
    columns, rows = round((east - west) / step), round((north - south) / step)
    os.makedirs(arguments.out, exist_ok=True)
    relief = read_relief(arguments.relief)
    GROUND.extend((Shores(), relief, roughness(relief)))
    names = [arguments.out + "/" + name for name in ("classes.tif", "terrain.tif", "gamma.tif")]
    rasters = [new_raster(name + ".part", columns, rows, west, north, step, kind)
               for name, kind in zip(names, (gdal.GDT_Byte, gdal.GDT_Int16, gdal.GDT_Int16))]
    rasters[0].GetRasterBand(1).SetCategoryNames(list(GAMMA_DB))
    rasters[0].GetRasterBand(1).SetNoDataValue(255)
    with multiprocessing.Pool(arguments.jobs) as pool:
        for row in range(0, rows, BLOCK):  # row by row, so that blocks do not pile up before the files
            across = [((west, north), arguments.step, row, column, (min(BLOCK, rows - row), min(BLOCK, columns - column)))
                      for column in range(0, columns, BLOCK)]
            for block, made in pool.imap(block_of, across):
                for raster, values in zip(rasters, made):
                    raster.GetRasterBand(1).WriteArray(values, block.column, block.row)
            print("row %d of %d" % (min(row + BLOCK, rows), rows), flush=True)
    for raster in rasters:
        raster.FlushCache()
    del rasters, raster
    with open(arguments.out + "/earth.classes", "w") as file:
        file.write(table)
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
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="processes that make blocks; one more writes them")
    parser.add_argument("--table", metavar="FILE", default=next(filter(os.path.exists, TABLES), TABLES[0]),
                        help="class table of which earth.classes is made (heaton6.classes)")
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
