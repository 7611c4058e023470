"""Real radar data of the shared folder, as the measures take them. Each reader says what the data are.

Nothing here comes from the simulation.
"""
import functools

import numpy as np
import scipy.io
from osgeo import gdal
from scipy import ndimage

import scenes
from statistics_of import taylor

GOTCHA = "gotcha_xband/data_3dsar_pass1_az001_HH.mat"
MSTAR = "mstar_t72_15deg/170005.jpeg"
LIGHT_M_S = 299792458.0
# Centres of Gotcha's nine windows of bright, even grass (docs/realradar.md), metres east and north of the scene's centre.
GRASS = [(20.5, 43.5), (33.3, 43.5), (-17.9, 43.5), (39.7, 24.3), (-30.7, 24.3), (-43.5, 43.5), (-5.1, 30.7),
         (7.7, 37.1), (-43.5, 30.7)]
WINDOW_M = 12.8
# Its even windows that are dark: asphalt.
DARK = [(14.1, 17.9), (39.7, -7.7), (33.3, 11.5), (1.3, 5.1)]


class Gotcha:
    """X band, HH, grazing angle 45.7 degrees, one degree of aperture, focused by back-projection with Taylor weights.

    AFRL's Gotcha set, pass 1. `power` is [row][column], north up; `pixel_m` a side.
    """

    pixel_m = 0.2

    def __init__(self, path, side_m=100.0, weight_db=-35.0):
        data = scipy.io.loadmat(path, squeeze_me=True)["data"]
        echo = np.asarray(data["fp"].item())
        frequency = np.asarray(data["freq"].item(), float)
        x, y, z, r0 = (np.asarray(data[k].item(), float) for k in ("x", "y", "z", "r0"))
        pulses = echo.shape[1]
        step_hz = frequency[1] - frequency[0]
        weight = taylor(len(frequency), weight_db)
        bins = 8192
        profile = np.fft.ifft(np.fft.ifftshift(pad(echo * weight[:, None], bins), axes=0), axis=0)
        # pad() puts the middle frequency into the middle bin, which ifftshift brings to 0.
        bin_m = LIGHT_M_S / (2 * step_hz * bins)
        carrier = 4 * np.pi * frequency[len(frequency) // 2] / LIGHT_M_S
        side = round(side_m / self.pixel_m)
        axis = ((np.arange(side) - (side - 1) / 2) * self.pixel_m).astype(np.float32)
        east, north = np.meshgrid(axis, -axis)
        image = np.zeros((side, side), complex)
        for p, share in enumerate(taylor(pulses, weight_db)):
            away = np.sqrt((x[p] - east.astype(float)) ** 2 + (y[p] - north) ** 2 + z[p] ** 2) - r0[p]
            place = away / bin_m
            whole = np.floor(place)
            part = place - whole
            at = whole.astype(np.int64) % bins
            value = profile[at, p] * (1 - part) + profile[(at + 1) % bins, p] * part
            image += share * value * np.exp(1j * carrier * away)
        self.power = abs(image) ** 2
        grazing = np.arctan2(z[pulses // 2], np.hypot(x[pulses // 2], y[pulses // 2]))
        turn = abs(np.arctan2(y[-1], x[-1]) - np.arctan2(y[0], x[0])) * pulses / (pulses - 1)
        self.range_cell_m = LIGHT_M_S / (2 * step_hz * len(frequency) * np.cos(grazing))
        self.cross_cell_m = LIGHT_M_S / frequency.mean() / (2 * turn * np.cos(grazing))

    def window(self, place):
        """Power of the window of 12.8 m around a place."""
        side = round(WINDOW_M / self.pixel_m)
        middle = (self.power.shape[0] - 1) / 2
        row, column = round(middle - place[1] / self.pixel_m), round(middle + place[0] / self.pixel_m)
        return self.power[row - side // 2: row + side // 2, column - side // 2: column + side // 2]


def pad(echo, bins):
    """Spectra in the middle of `bins` rows, the middle frequency in the middle row."""
    wide = np.zeros((bins, echo.shape[1]), complex)
    first = bins // 2 - echo.shape[0] // 2
    wide[first: first + echo.shape[0]] = echo
    return wide


def read_band(path, band=1):
    file = gdal.Open(str(path))  # the band is of no use once the file is gone
    return file.GetRasterBand(band).ReadAsArray()


class Real:
    """The real data, read once and only when a measure asks. `has_*` says whether they are on this machine."""

    def __init__(self, folder):
        self.folder = folder

    def has(self, path):
        return self.folder is not None and (self.folder / path).is_file()

    @functools.cached_property
    def gotcha(self):
        return Gotcha(self.folder / GOTCHA)

    @functools.cached_property
    def mstar(self):
        """Power of 196 chips of a T-72 on grass, [chip][row][column]: X band, 0.2 m pixels of a 0.3 m cell, 8 bits, JPEG."""
        files = sorted((self.folder / MSTAR).parent.glob("*.jpeg"))
        return np.stack([read_band(f).astype(float) ** 2 for f in files])

    @functools.cached_property
    def sentinel1(self):
        """VV near Orihuela in dB, [row][column], 10 m, north up: C band, 4.4 looks, a resolution cell of 20 m."""
        return read_band(self.folder / scenes.S1)

    @functools.cached_property
    def montreal(self):
        """RCM-1, C band, one look, 50 x 50 cells near Montreal: power."""
        file = gdal.Open(str(self.folder / "sar_sicd_tiny/sicd_50x50.nitf"))
        return file.GetRasterBand(1).ReadAsArray().astype(float) ** 2 + file.GetRasterBand(2).ReadAsArray() ** 2


def mstar_clutter(chips):
    """The strips above and below the target, where its shadow does not reach: rows 0..19 and 108..127."""
    return np.concatenate([chips[:, :20], chips[:, 108:]], axis=0)


def mstar_shadow_db(chips):
    """Of each chip, how far the darkest 7 x 7 pixels lie under the clutter, dB."""
    clutter = np.concatenate([chips[:, :20].reshape(len(chips), -1), chips[:, 108:].reshape(len(chips), -1)], axis=1)
    dark = ndimage.uniform_filter(chips, (0, 7, 7))[:, 24:104, 24:104].reshape(len(chips), -1).min(axis=1)
    return 10 * np.log10(clutter.mean(axis=1) / np.maximum(dark, 0.01))
