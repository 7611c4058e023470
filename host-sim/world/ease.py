"""Terrain of an area, eased into that of the image that lies around it: two models of one mountain differ by metres, and coarse
ones by hundreds. Where an area's image ends within a wider one (`landmass-sim --db2`), that is a cliff, which shines and throws a
shadow. Build the area of what this writes, and it goes over into the other along its border, whatever the level.

    ease.py --terrain FILE [FILE...] --onto WORLD.lmdb --out eased.tif [--over METRES] [--db PATH]

FILEs are on one grid and touch (whatever GDAL reads). What lies farther than METRES (2000) from where they end stays as it is, as
do sea and lakes at 0 m and below; at the end the terrain is the world's. --db names the program landmass-db.
"""

import argparse
import os
import subprocess
import sys
import tempfile

import numpy as np
from osgeo import gdal, osr

gdal.UseExceptions()
NO_DATA = -32767
METRES_PER_DEGREE = 111195.0


def grid_of(raster):
    """Bounds, and metres of a pixel each way."""
    west, wide, _, north, _, high = raster.GetGeoTransform()
    bounds = (west, north + high * raster.RasterYSize, west + wide * raster.RasterXSize, north)
    spatial = osr.SpatialReference(raster.GetProjection())
    if spatial.IsGeographic():
        middle = np.radians((bounds[1] + bounds[3]) / 2)
        return bounds, (abs(wide) * METRES_PER_DEGREE * np.cos(middle), abs(high) * METRES_PER_DEGREE)
    return bounds, (abs(wide) * spatial.GetLinearUnits(), abs(high) * spatial.GetLinearUnits())


def degrees_around(raster, bounds):
    """South, west, north and east of it, a little more than it covers."""
    here, there = osr.SpatialReference(raster.GetProjection()), osr.SpatialReference()
    there.ImportFromEPSG(4326)
    for spatial in (here, there):
        spatial.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    west, south, east, north = osr.CoordinateTransformation(here, there).TransformBounds(*bounds, 21)
    more = 0.05 * max(north - south, east - west)
    return south - more, west - more, north + more, east + more


def world_below(arguments, raster, bounds):
    """The world's terrain on the raster's grid; NaN where it has none."""
    area = "%.6f,%.6f,%.6f,%.6f" % degrees_around(raster, bounds)
    with tempfile.TemporaryDirectory() as folder:
        words = [arguments.db, "export", arguments.onto, "--out", folder + "/planes", "--area=" + area]
        done = subprocess.run(words, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit("ease: %s" % done.stderr.strip())
        warped = gdal.Warp("", folder + "/planes/elevation.tif", format="MEM", outputBounds=bounds, width=raster.RasterXSize,
                           height=raster.RasterYSize, dstSRS=raster.GetProjection(), resampleAlg="bilinear",
                           outputType=gdal.GDT_Float32, dstNodata=NO_DATA)
        world = warped.ReadAsArray()
    return np.where(world == NO_DATA, np.nan, world)


def to_the_end(has, pixel_m):
    """Metres from each pixel to the nearest without data. Pixels beyond the raster have none; those that are not square count by
    their mean side."""
    rows, columns = has.shape
    padded = gdal.GetDriverByName("MEM").Create("", columns + 2, rows + 2, 1, gdal.GDT_Byte)
    padded.GetRasterBand(1).WriteArray(np.pad(has, 1).astype(np.uint8))
    far = gdal.GetDriverByName("MEM").Create("", columns + 2, rows + 2, 1, gdal.GDT_Float32)
    gdal.ComputeProximity(padded.GetRasterBand(1), far.GetRasterBand(1), ["VALUES=0", "DISTUNITS=PIXEL"])
    return far.ReadAsArray()[1:-1, 1:-1] * np.sqrt(pixel_m[0] * pixel_m[1])


def eased(heights, world, far_m, over_m):
    """The world's terrain at the end, the own one from `over_m` on, and no bend at either."""
    near = np.clip(1 - (far_m - far_m.min()) / over_m, 0, 1)
    weight = near * near * (3 - 2 * near)
    own = (heights <= 0) | np.isnan(world)
    return np.where(own, heights, heights + (world - heights) * weight)


def ease(arguments):
    raster = gdal.BuildVRT("", arguments.terrain)
    band = raster.GetRasterBand(1)
    heights, no_data = raster.ReadAsArray().astype(np.float32), band.GetNoDataValue()
    has = np.isfinite(heights) if no_data is None else np.isfinite(heights) & (heights != no_data)
    bounds, pixel_m = grid_of(raster)
    world = world_below(arguments, raster, bounds)
    apart = np.abs(world - heights)[has & (heights > 0) & np.isfinite(world)]
    if apart.size == 0:
        sys.exit("ease: %s: has no terrain there; name the image that lies around" % arguments.onto)
    made = np.where(has, eased(heights, world, to_the_end(has, pixel_m), arguments.over), NO_DATA)
    out = gdal.GetDriverByName("GTiff").Create(arguments.out + ".part", raster.RasterXSize, raster.RasterYSize, 1,
                                               gdal.GDT_Float32, ["TILED=YES", "COMPRESS=DEFLATE", "PREDICTOR=3"])
    out.SetProjection(raster.GetProjection())
    out.SetGeoTransform(raster.GetGeoTransform())
    out.GetRasterBand(1).SetNoDataValue(NO_DATA)
    out.GetRasterBand(1).SetUnitType(band.GetUnitType())
    out.GetRasterBand(1).WriteArray(made)
    del out
    os.replace(arguments.out + ".part", arguments.out)
    print("terrain and world are %.1f m apart (median), %.1f m (nine tenths)" % tuple(np.percentile(apart, (50, 90))))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--terrain", nargs="+", required=True, metavar="FILE")
    parser.add_argument("--onto", required=True, metavar="WORLD.lmdb")
    parser.add_argument("--out", required=True, metavar="FILE.tif")
    parser.add_argument("--over", type=float, default=2000, metavar="METRES")
    parser.add_argument("--db", default="landmass-db", metavar="PATH")
    ease(parser.parse_args())


if __name__ == "__main__":
    main()
