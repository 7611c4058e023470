"""The PC's share of the work beside GDAL's nearest like work, on the same rasters, in the same run.

    host.py BUILD-DIR FIGURES      (FIGURES: a file that gets lines "VALUE UNIT NAME", as tests/figures keeps them)

Ratios are of processor time, of all threads, the least of some runs; the two of a pair take turns, so that a busy machine is
as hard on the one as on the other. Rasters lie in build/run (`make run`) and, enlarged, in a folder that is removed.
Nothing here passes or fails.
"""
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

RUN = Path("build/run")
CLASSES = "host-sim/programs/db/classes/heaton6.classes"
SIDE = 2048      # of the rasters
SHADED = 4096    # side of the terrain that is shaded: as many pixels as PATCHES patches have
PATCHES = 256    # of 256 x 256 cells
RUNS = int(os.environ.get("RUNS", "3"))
CREATE = ["-co", "TILED=YES", "-co", "COMPRESS=DEFLATE"]  # as our programs write rasters


def cost(*command):
    """(s of processor, s by the clock, MB) of a program, with the threads that it starts."""
    start = time.monotonic()
    child = subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    said = child.stderr.read()
    _, status, used = os.wait4(child.pid, 0)
    if status != 0:
        sys.exit(f"bench: {' '.join(map(str, command))}\n{said.decode()}")
    return used.ru_utime + used.ru_stime, time.monotonic() - start, used.ru_maxrss / 1024


def least(*sequences):
    """For each sequence of commands its least cost, the sequences taking turns: (processor, clock, memory)."""
    best = [(float("inf"), float("inf"), 0.0)] * len(sequences)
    for _ in range(RUNS):
        for i, sequence in enumerate(sequences):
            parts = [cost(*command) for command in sequence]
            all_of_it = (sum(p[0] for p in parts), sum(p[1] for p in parts), max(p[2] for p in parts))
            best[i] = tuple(map(min, best[i][:2], all_of_it[:2])) + (max(best[i][2], all_of_it[2]),)
    return best


class Table:
    def __init__(self, figures):
        self.figures = figures
        print(f"  {'':44}{'s of processor':>16}{'by the clock':>14}{'MB':>8}")

    def row(self, what, used):
        print(f"  {what:44}{used[0]:16.2f}{used[1]:14.2f}{used[2]:8.0f}")

    def pair(self, figure, ours, peer):
        """A figure's name is "OURS, processor time beside PEER"."""
        our_name, peer_name = figure.split(", processor time beside ")
        self.row(our_name, ours)
        self.row(f"  {peer_name}", peer)
        self.ratio(figure, ours[0] / peer[0])

    def ratio(self, name, value):
        print(f"  {name:60}{value:8.2f}")
        self.figures.write(f"{value:.2f} times {name}\n")


def hillshade(table, build, work):
    """A patch against one shading of as many pixels; reading and writing, which both do not count, are subtracted."""
    terrain = f"{work}/terrain.tif"
    subprocess.run(["gdal_translate", "-q", "-ot", "Float32", "-outsize", str(SHADED), str(SHADED), "-r", "bilinear",
                    RUN / "scene/terrain.tif", terrain], check=True)
    out, bench = f"{work}/out.tif", build / "bin/tests/bench/stage_bench"
    shaded, copied, drawn, set_up = least(
        [["gdaldem", "hillshade", "-q", terrain, out]], [["gdal_translate", "-q", "-ot", "Byte", terrain, out]],
        [[bench, "sar", str(PATCHES + 1)]], [[bench, "sar", "1"]])
    ours, peer = drawn[0] - set_up[0], shaded[0] - copied[0]
    pixels = SHADED * SHADED
    print(f"  {PATCHES} patches of 256 x 256: {ours / pixels * 1e9:.1f} ns a pixel; gdaldem hillshade, {SHADED} x {SHADED}: "
          f"{peer / pixels * 1e9:.1f} ns a pixel")
    table.ratio("patch, processor time beside gdaldem hillshade", ours / peer)


def warp(source, out, method="near"):
    """gdalwarp to the same grid."""
    return ["gdalwarp", "-q", "-overwrite", "-r", method, "-ts", str(SIDE), str(SIDE), *CREATE, source, out]


def enlarge(source, out, method):
    subprocess.run(["gdal_translate", "-q", "-outsize", str(SIDE), str(SIDE), "-r", method, *CREATE, source, out], check=True)
    return out


def rasters(table, build, work):
    """segment against gdalwarp of the image, reflect of a reflectivity raster; build against gdalwarp of all it reads, and gdaladdo."""
    db = build / "bin/landmass-db"
    image = enlarge(RUN / "scene/image.tif", f"{work}/image.tif", "bilinear")
    classes = enlarge(RUN / "classes.tif", f"{work}/classes.tif", "near")
    out = f"{work}/out.tif"
    ours, peer = least([[db, "segment", "--image", image, "--net", RUN / "scene.net", "--classes", CLASSES, "--out", out]],
                       [warp(image, f"{work}/warped.tif", "bilinear")])
    table.pair("segment, processor time beside gdalwarp", ours, peer)
    # A raster of the same type, which holds as little that can be packed.
    like, reflectivity = enlarge(RUN / "reflectivity.tif", f"{work}/like.tif", "near"), f"{work}/reflectivity.tif"
    ours, peer = least([[db, "reflect", "--class-raster", classes, "--classes", CLASSES, "--method", "assign",
                         "--out", reflectivity]], [warp(like, f"{work}/warped.tif", "bilinear")])
    table.pair("reflect, processor time beside gdalwarp", ours, peer)
    build_against_gdal(table, db, work, classes, reflectivity)


def build_against_gdal(table, db, work, classes, reflectivity):
    terrain, lmdb = RUN / "scene/terrain.tif", f"{work}/scene.lmdb"
    warped = [f"{work}/warped-{i}.tif" for i in range(3)]
    gdal = [warp(source, to, how) for source, to, how in
            zip((classes, reflectivity, terrain), warped, ("near", "bilinear", "bilinear"))]
    gdal += [["gdaladdo", "-q", "-r", "average", to] for to in warped]
    ours, peer = least([[db, "build", "--classes", CLASSES, "--class-raster", classes, "--reflectivity", reflectivity,
                         "--terrain", terrain, "--out", lmdb]], gdal)
    table.pair("build, processor time beside gdalwarp and gdaladdo", ours, peer)
    verify(table, db, lmdb)


def verify(table, db, lmdb):
    """By the clock, with all processors, against a read of the same file past the page cache, which is the disk's rate."""
    read = ["dd", f"if={lmdb}", "of=/dev/null", "bs=4M", "iflag=direct"]
    try:
        ours, disk = least([[db, "verify", lmdb]], [read])
    except SystemExit:
        print("  verify: no direct reads from this folder, so that the disk's rate is not known")
        return
    size = Path(lmdb).stat().st_size / 1e6
    table.row("verify", ours)
    print(f"    {size:.0f} MB: {size / ours[1]:.0f} MB a second by the clock; the disk {size / disk[1]:.0f}")
    table.ratio("verify, its rate beside the disk's", disk[1] / ours[1])


def main():
    build, figures = Path(sys.argv[1]), Path(sys.argv[2])
    if not (RUN / "scene.lmdb").exists():
        print("No build/run/scene.lmdb (make run): nothing measured beside GDAL")
        return 0
    print(f"The PC's work beside GDAL's, rasters of {SIDE} x {SIDE}: least of {RUNS} runs that take turns")
    with tempfile.TemporaryDirectory() as work, figures.open("a") as kept:
        table = Table(kept)
        hillshade(table, build, work)
        rasters(table, build, work)
    return 0


if __name__ == "__main__":
    sys.exit(main())
