"""The pictures of docs/pictures, from what `make run`, `make gallery` and doc_scenes.sh left in build.

Usage: doc_pictures.py build/run/pictures docs/pictures [build/gallery build/docs]

The first folder alone makes run.png, six glasses of 500 pixels, places.png, the five places from two sides without their
frames, and single glasses of 480 pixels. Pictures whose source is not there are named and left as they are. Pictures of web
pages are taken by tests/ios/station_pictures.py and by hand."""
import pathlib
import shutil
import sys

import numpy as np
from osgeo import gdal

gdal.UseExceptions()
GAP = 4
STEP = 10  # of the tones that are kept: the files are half as large
FRAME = (93, 96, 548, 548)  # the picture on a glass of 768: left, top, width, height
FRAME_OF_1024 = (125, 128, 732, 732)
RUN = (("ground-map-10nm", "ground-map-dbs1", "ground-map-dbs2"),
       ("sar-harbour-from-north", "sar-airfield-from-north", "sar-river-valley-from-north"))
PLACES = tuple(tuple(f"sar-{place}-from-{side}" for place in ("town", "harbour", "airfield", "lake", "river-valley"))
               for side in ("north", "east"))
ALONE = ("ground-map-exp", "ground-map-dbs1", "ground-map-dbs2", "gmt")
APRON = (("patch-look-000", "patch-look-090"), ("patch-look-180", "patch-look-270"))
AS_THEY_ARE = ("figure1", "table1", "slicy", "slicy-reflections", "tank-parts", "signature-tank")
GLASSES = {"effect-rain": "modes/effect-rain", "effect-jammer": "modes/effect-jammer", "airfield-dbs2": "airfield/ground-map-dbs2"}


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


def others(gallery, made):
    """(picture, its sources, what makes it of them) of all others."""
    apron = [gallery / "airfield" / f"{n}.png" for row in APRON for n in row]
    yield "airfield", apron, lambda: sheet(gallery / "airfield", APRON, 310, FRAME_OF_1024)
    rain = [gallery / "modes" / f"{n}.png" for n in ("effect-patch", "effect-patch-rain")]
    yield "effect-patch-rain", rain, lambda: np.concatenate([read(p.parent, p.stem, 480) for p in rain], 2)
    for name, source in GLASSES.items():
        yield name, [gallery / f"{source}.png"], lambda s=source: read((gallery / s).parent, (gallery / s).name, 480)
    for name, side in (("ku-map", 512), ("ku-harbour", 512), ("page", 640)):
        yield name, [made / f"{name}.png"], lambda n=name, side=side: read(made, n, side)


def draw_others(gallery, made, docs):
    for name, sources, draw in others(gallery, made):
        missing = [str(p) for p in sources if not p.exists()]
        if missing:
            print(f"{name}: left as it is, there is no {missing[0]}")
        else:
            write(docs / f"{name}.png", draw())
    for name in AS_THEY_ARE:
        if (made / f"{name}.png").exists():
            shutil.copyfile(made / f"{name}.png", docs / f"{name}.png")
        else:
            print(f"{name}: left as it is, there is no {made / name}.png")


def main():
    folder, docs, *more = map(pathlib.Path, sys.argv[1:])
    write(docs / "run.png", sheet(folder, RUN, 500))
    write(docs / "places.png", sheet(folder, PLACES, 300, FRAME))
    for name in ALONE:
        write(docs / f"{name}.png", read(folder, name, 480))
    if more:
        draw_others(*more, docs)


main()
