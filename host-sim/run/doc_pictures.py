"""The pictures of docs/pictures that `make run` draws, from what it left in build/run/pictures.

Usage: doc_pictures.py build/run/pictures docs/pictures

run.png has six glasses of 500 pixels, places.png the five places from two sides without their frames; the others are the
glass as it is, at 480 pixels."""
import pathlib
import sys

import numpy as np
from osgeo import gdal

gdal.UseExceptions()
GAP = 4
STEP = 10  # of the tones that are kept: the files are half as large
FRAME = (93, 96, 548, 548)  # the picture on a glass of 768: left, top, width, height
RUN = (("ground-map-10nm", "ground-map-dbs1", "ground-map-dbs2"),
       ("sar-harbour-from-north", "sar-airfield-from-north", "sar-river-valley-from-north"))
PLACES = tuple(tuple(f"sar-{place}-from-{side}" for place in ("town", "harbour", "airfield", "lake", "river-valley"))
               for side in ("north", "east"))
ALONE = ("ground-map-exp", "ground-map-dbs1", "ground-map-dbs2", "gmt")


def read(folder, name, side, window=None):
    """Red, green and blue of a picture, or of a window of it, `side` pixels high and wide."""
    options = {"format": "MEM", "width": side, "height": side, "resampleAlg": "average", "rgbExpand": "rgb"}
    source = gdal.Open(str(folder / f"{name}.png"))
    if source.RasterCount >= 3:
        del options["rgbExpand"]
    return gdal.Translate("", source, srcWin=window, **options).ReadAsArray()[:3]


def sheet(folder, rows, side, window=None):
    high, wide = len(rows), len(rows[0])
    out = np.zeros((3, high * (side + GAP) - GAP, wide * (side + GAP) - GAP), np.uint8)
    for y, row in enumerate(rows):
        for x, name in enumerate(row):
            top, left = y * (side + GAP), x * (side + GAP)
            out[:, top:top + side, left:left + side] = read(folder, name, side, window)
    return out


def write(path, bands):
    memory = gdal.GetDriverByName("MEM").Create("", bands.shape[2], bands.shape[1], 3)
    memory.WriteArray(bands // STEP * STEP)
    gdal.SetConfigOption("GDAL_PAM_ENABLED", "NO")
    gdal.GetDriverByName("PNG").CreateCopy(str(path), memory, options=["ZLEVEL=9"])


def main():
    folder, docs = map(pathlib.Path, sys.argv[1:])
    write(docs / "run.png", sheet(folder, RUN, 500))
    write(docs / "places.png", sheet(folder, PLACES, 300, FRAME))
    for name in ALONE:
        write(docs / f"{name}.png", read(folder, name, 480))


main()
