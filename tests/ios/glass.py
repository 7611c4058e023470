"""What frames do to the glass: a flight of landmass-sim hears them, and its picture and its words are read."""
import json
import pathlib
import re
import subprocess

import numpy as np
from osgeo import gdal

gdal.UseExceptions()

TELLS_S = 2.0    # flight time at which the page's frames come
LOOKS_S = 4.8    # and at which the picture is taken: nothing is stale yet
SECONDS = 5.0
DISPLAY_NODE = 20


class Glass:
    """Flies a golden country straight north, with the frames of the page at TELLS_S."""

    def __init__(self, binaries, scene, folder):
        self.bin, self.scene, self.folder = pathlib.Path(binaries), scene, pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        log = self.folder / "north.log"
        self.run("landmass-nav", "--straight", "45.95,11,0,3000,180", "--seconds", SECONDS, "--out", log, "--quiet")
        self.lines = log.read_text().splitlines()
        self.begin = float(self.lines[0].split()[0][1:-1])
        self.flown = {}

    def run(self, program, *words):
        return subprocess.run([str(self.bin / program), *map(str, words)], check=True, capture_output=True,
            text=True).stdout

    def log_of(self, told):
        """Navigation with the told frames between: lists of ID#DATA, 0.3 s from one list to the next."""
        lines = [(float(line.split()[0][1:-1]), line.split()[2]) for line in self.lines]
        for at, frames in enumerate(told):
            lines += [(self.begin + TELLS_S + 0.3 * at + 0.0002 * n, frame) for n, frame in enumerate(frames)]
        return "".join(f"({seconds:.6f}) can0 {frame}\n" for seconds, frame in sorted(lines, key=lambda line: line[0]))

    def fly(self, *told):
        """What the display shows and says at the end: {picture, report, said}."""
        key = repr(told)
        if key not in self.flown:
            log, script, words = (self.folder / name for name in ("flight.log", "keys.script", "told.log"))
            log.write_text(self.log_of(told))
            script.write_text(f"{LOOKS_S} picture glass\n")
            report = json.loads(self.run("landmass-sim", "--db", self.scene, "--bus", log, "--png", self.folder,
                "--every", 0, "--script", script,
                                         "--node", DISPLAY_NODE, "--reports", "--obey-controls", "--bus-out", words,
                                          "--json", "-"))
            picture = gdal.Open(str(self.folder / "glass.png")).ReadAsArray().astype(int)
            said = {}
            for line in self.run("landmass-bus", "decode", words).splitlines():
                found = re.match(r"\s*[\d.]+\s+([0-9A-F]{3}) .*?(BLONG|LONG|UCHAR\d?|CHAR|NODATA) ?([-\dA-F ]*)", line)
                if found:
                    said[int(found[1], 16)] = [int(number, 16 if found[2] == "BLONG" else 10)
                        for number in found[3].split()]
            self.flown[key] = {"picture": picture.max(axis=0) if picture.ndim == 3 else picture,
                "report": report["report"], "said": said}
        return self.flown[key]

    def changed(self, flight, than=(), least=24):
        """Where a picture differs from that of another flight; without one, from that without the page."""
        return np.abs(flight["picture"] - self.fly(*than)["picture"]) > least

    def middle(self, flight, than=()):
        """Middle of what became brighter: x, y. Of two flights the sign of life may differ, too, which medians pass over."""
        rows, columns = np.nonzero(flight["picture"] - self.fly(*than)["picture"] > 60)
        return (np.median(columns), np.median(rows)) if len(rows) else None
