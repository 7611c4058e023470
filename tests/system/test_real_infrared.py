#!/usr/bin/env python3
"""landmass-db infrared beside what Landsat 5 measured: the thermal band of a scene in the Amazon forest, at polygons whose
class is known. TAP on standard output. The weather of that morning is not known: air, humidity and wind are those of the
season there, and the water is given, so that the order of the classes and the steps between them are compared.

BUILD names the build's folder, LANDMASS_DATA that of the data.
"""

import csv
import os
import subprocess
import sys
import tempfile

import numpy
from osgeo import gdal, ogr, osr

gdal.UseExceptions()
BUILD = os.environ.get("BUILD", "build/bench-linux")
DATA = os.path.join(os.environ.get("LANDMASS_DATA", "../shared/data"), "landsat5_amazon_tucurui_srtm_labels")
CLASSES = "host-sim/programs/db/classes/landcover.classes"
# Labels of the polygons, and the classes of landcover.classes that they are taken for, with their places in it.
KNOWN = {"forest": 6, "water": 5, "cleared": 4, "fallen_dry": 0}
# Of 13:00:47 UTC at 49.98 W, with the equation of time.
WEATHER = ["--date", "08-14", "--hours", "9.6", "--air", "27", "--air-range", "9", "--humidity", "80", "--wind", "3",
           "--water", "29"]


def brightness_kelvin(numbers):
    """Landsat 5 TM, band 6: radiance as the scene's MTL file has it, constants of the USGS handbook."""
    return 1260.56 / numpy.log(607.76 / (0.055375 * numbers + 1.18243) + 1)


def burn_polygons(like, path):
    """A class raster of the polygons, 255 elsewhere."""
    out = gdal.GetDriverByName("GTiff").Create(path, like.RasterXSize, like.RasterYSize, 1, gdal.GDT_Byte)
    out.SetGeoTransform(like.GetGeoTransform())
    out.SetProjection(like.GetProjection())
    out.GetRasterBand(1).Fill(255)
    out.GetRasterBand(1).SetNoDataValue(255)
    folder = ogr.GetDriverByName("Memory").CreateDataSource("")
    layer = folder.CreateLayer("", osr.SpatialReference(like.GetProjection()))
    layer.CreateField(ogr.FieldDefn("number", ogr.OFTInteger))
    with open(os.path.join(DATA, "derived", "trainingPolygons_lsat.tsv")) as rows:
        for row in csv.DictReader(rows, delimiter="\t"):
            feature = ogr.Feature(layer.GetLayerDefn())
            feature.SetField("number", KNOWN[row["class"]])
            feature.SetGeometry(ogr.CreateGeometryFromWkt(row["WKT"]))
            layer.CreateFeature(feature)
    gdal.RasterizeLayer(out, [1], layer, options=["ATTRIBUTE=number"])
    return out.ReadAsArray()


def main():
    if not os.path.isdir(DATA):
        print("1..0 # SKIP no data at " + DATA)
        return 0
    with tempfile.TemporaryDirectory() as folder:
        thermal = gdal.Open(os.path.join(DATA, "LT52240631988227CUB02_B6.TIF"))
        raster = os.path.join(folder, "classes.tif")
        classes = burn_polygons(thermal, raster)
        subprocess.run([os.path.join(BUILD, "bin", "landmass-db"), "infrared", "--class-raster", raster, "--classes", CLASSES,
                        "--terrain", os.path.join(DATA, "derived", "srtm.bsq"), "--out", folder] + WEATHER,
                       check=True, capture_output=True)
        ours = gdal.Open(os.path.join(folder, "infrared-0936.tif")).ReadAsArray()[0]
        theirs = brightness_kelvin(thermal.ReadAsArray().astype(float))
    mean = {label: (theirs[classes == number].mean() - 273.15, ours[classes == number].mean() - 273.15)
            for label, number in KNOWN.items()}
    for label, (seen, computed) in mean.items():
        print(f"# {label}: Landsat {seen:.1f} C through the air, computed {computed:.1f} C at the ground")
    order = [sorted(KNOWN, key=lambda label: mean[label][k]) for k in range(2)]
    print("1..2")
    is_order = order[0] == order[1]
    print("ok 1 - classes are in the order of their measured brightness" if is_order else f"not ok 1 - order {order[1]}")
    # Moist air lets half to nine tenths of a contrast through; the forest and the clearings are the largest classes.
    share = (mean["cleared"][0] - mean["forest"][0]) / (mean["cleared"][1] - mean["forest"][1])
    print(f"# of the step from forest to clearings {share:.2f} is seen")
    is_share = 0.4 < share < 1
    print(("ok" if is_share else "not ok") + " 2 - the step from forest to clearings is what the air lets through")
    return 0 if is_order and is_share else 1


sys.exit(main())
