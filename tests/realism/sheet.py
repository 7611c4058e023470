"""The sheet: real radar beside ours, the same place or the same kind of place, in one picture to look at.

Both of a pair are shown in decibels over the same span, each from its own median ground on. The sheet is left in
build/gallery and stays out of the project: the real pictures are not ours.
"""
import subprocess
from pathlib import Path

import numpy as np
from osgeo import gdal

import measures
import real_data
import scenes as place_of
from scenes import CELLS, moved
from statistics_of import db

SIDE, GAP, TEXT_SCALE = 512, 12, 2
LINE_PX = 9 * TEXT_SCALE
CAPTION_LINES = 4


class Font:
    """The firmware's font, of which the tap prints the rows of dots."""

    def __init__(self, tap):
        lines = subprocess.run([tap, "font"], capture_output=True, text=True, check=True).stdout.splitlines()
        rows = [np.array([int(v) for v in line.split()], np.uint8) for line in lines]
        self.glyphs = [(r[:, None] >> np.arange(4, -1, -1)) & 1 for r in rows]

    def write(self, picture, text, top, left, grey=220):
        for i, character in enumerate(text):
            code = ord(character) - ord(" ")
            glyph = np.kron(self.glyphs[code if 0 <= code < len(self.glyphs) else 0], np.ones((TEXT_SCALE, TEXT_SCALE)))
            x = left + i * 6 * TEXT_SCALE
            part = picture[top: top + glyph.shape[0], x: x + glyph.shape[1]]
            if part.shape == glyph.shape:
                part[glyph > 0] = grey


def wrapped(text, width):
    lines, line = [], ""
    for word in text.split():
        if len(line) + len(word) + 1 > width:
            lines.append(line)
            line = ""
        line = f"{line} {word}".strip()
    return lines + [line]


def grey_of(level_db, span=(-20, 25), about=None):
    """0..255 over the span about the median, or another level; what is not known is black."""
    level = level_db - (np.nanmedian(level_db) if about is None else about)
    grey = (level - span[0]) / (span[1] - span[0]) * 255
    return np.nan_to_num(np.clip(grey, 0, 255)).astype(np.uint8)


def fitted(grey):
    """A picture of 512 x 512 pixels, its pixels repeated as often as that needs."""
    rows, columns = grey.shape
    row, column = (np.arange(SIDE) * n // SIDE for n in (rows, columns))
    return grey[np.ix_(row, column)]


def upwards(picture, cells=None):
    """Levels of a patch as the glass shows them: range upwards, lines from left to right; the middle `cells`."""
    level = picture.level_db.T[::-1]
    if cells:
        first = (CELLS - cells) // 2
        level = level[first: first + cells, first: first + cells]
    return level


def orihuela_pairs(scenes, real):
    o = measures.orihuela(scenes, real)
    about = [np.median(picture[mask["vegetation"]]) for picture, mask in ((o.real_db, o.mask), (o.ours_db, o.our_mask))]
    grey = lambda box: [grey_of(picture[box], about=level) for picture, level in zip((o.real_db, o.ours_db), about)]
    whole, town = grey((slice(0, 512), slice(0, 512))), grey((slice(100, 356), slice(100, 356)))
    yield ("Sentinel-1, VV, C band, 4.4 looks, Orihuela. 10 m pixels of a 20 m cell, 2019-09-17. Copernicus.", whole[0],
           "Ours: the same place from Sentinel-2's bands of the day after, 20 m cells, looking 80 degrees, 45 degrees down.",
           whole[1])
    yield ("Sentinel-1: the middle of the same picture, twice as large: rows of houses, a town, fields.", town[0],
           "Ours: the same crop.", town[1])


def gotcha_pair(scenes, real):
    g = real.gotcha
    ours = scenes.patch("yard", place_of.utm_degrees(place_of.CAR_PARK), 0.5, 0, range_m=10000, height_m=8000)
    return ("Gotcha (AFRL), X band, HH, one look, 46 degrees down: 100 m of grass, a road, a car park, two reflectors.",
            grey_of(db(g.power)),
            "Ours: 100 m of the yard: a field, a road, a car park with lorries. 0.5 m cells, 4 looks, 39 degrees down.",
            grey_of(upwards(ours, 200)))


def mstar_pair(scenes, real):
    chips = real.mstar[::49][:4]
    real_picture = np.block([[chips[0], chips[1]], [chips[2], chips[3]]])
    ours = scenes.patch("yard", place_of.utm_degrees(place_of.TANKS), 0.5, range_m=12000, height_m=3200)
    return ("MSTAR, X band, four chips of a T-72 on grass, 25 m each, 0.2 m pixels, 15 degrees down: shadows up.",
            grey_of(db(np.maximum(real_picture, 1))),
            "Ours: four tanks on an even field, 52 m, 0.5 m cells, 4 looks, 15 degrees down.", grey_of(upwards(ours, 104)))


def grain_pair(scenes, real):
    ours = scenes.patch("plain", measures.PLAIN, 5)
    return ("RCM-1 (SICD), C band, HH, one look, 50 x 50 cells near Montreal, 52 degrees down. (c) Government of Canada.",
            grey_of(db(np.maximum(real.montreal, 1e-6))),
            "Ours: 50 x 50 cells of 5 m of an even plain, four looks: the grain alone.", grey_of(upwards(ours, 50)))


def alone(scenes):
    """Ours without a real neighbour: what to look at when no real data are here."""
    for text, name, cell, look in (("Ours: the built-in town, 2 m cells, looking north.", "town", 2, 0),
                                   ("Ours: the same, looking east.", "town", 2, 90),
                                   ("Ours: the built-in river valley, 5 m cells, looking north.", "river-valley", 5, 0),
                                   ("Ours: the built-in harbour, 2 m cells, looking east.", "harbour", 2, 90)):
        # About what the fields have: in a town the median may be shadow.
        yield text, grey_of(upwards(scenes.patch("builtin", scenes.place(name), cell, look)), about=place_of.FIELD_DB)


def pairs(scenes, real):
    if real.has(place_of.S1) and real.has(place_of.S2):
        yield from orihuela_pairs(scenes, real)
    for path, pair in ((real_data.GOTCHA, gotcha_pair), (real_data.MSTAR, mstar_pair),
                       ("sar_sicd_tiny/sicd_50x50.nitf", grain_pair)):
        if real.has(path):
            yield pair(scenes, real)
    ours = list(alone(scenes))
    for left, right in zip(ours[::2], ours[1::2]):
        yield *left, *right


def make(scenes, real, folder="build/gallery"):
    """Write the sheet; returns its path."""
    font = Font(scenes.bin / "tests/realism/realism_tap")
    rows = list(pairs(scenes, real))
    height = SIDE + CAPTION_LINES * LINE_PX + GAP
    sheet = np.full((GAP + len(rows) * height, 3 * GAP + 2 * SIDE), 24, np.uint8)
    for i, row in enumerate(rows):
        for k, (caption, picture) in enumerate((row[:2], row[2:])):
            top, left = GAP + i * height, GAP + k * (SIDE + GAP)
            sheet[top: top + SIDE, left: left + SIDE] = fitted(picture)
            for n, line in enumerate(wrapped(caption, SIDE // (6 * TEXT_SCALE))[:CAPTION_LINES]):
                font.write(sheet, line, top + SIDE + 6 + n * LINE_PX, left)
    path = Path(folder) / "realism.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    memory = gdal.GetDriverByName("MEM").Create("", sheet.shape[1], sheet.shape[0], 1)
    memory.GetRasterBand(1).WriteArray(sheet)
    gdal.GetDriverByName("PNG").CreateCopy(str(path), memory)
    Path(f"{path}.aux.xml").unlink(missing_ok=True)
    return path
