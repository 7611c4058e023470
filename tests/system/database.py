"""What the tests of database images share: landmass-db, what it refuses, rasters to build from, and results in TAP."""
import os
import resource
import signal
import subprocess
import sys

import numpy
from osgeo import gdal, osr

gdal.UseExceptions()
BUILD = os.path.abspath(os.environ.get("BUILD", "build/bench-linux"))
CLASSES = os.path.abspath("host-sim/programs/db/classes/heaton6.classes")
CHECKS = []


def check(name, is_true, why=""):
    CHECKS.append(is_true)
    print(("ok " if is_true else "not ok ") + "%d - %s" % (len(CHECKS), name), flush=True)
    if not is_true and why:
        print("# " + why.strip().replace("\n", "\n# "))


def end():
    print("1..%d" % len(CHECKS))
    sys.exit(0 if all(CHECKS) else 1)


def db(*words, limit=None):
    """Run landmass-db; `limit` is what resource.setrlimit takes."""
    def confine():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(*limit)
    return subprocess.run([BUILD + "/bin/landmass-db"] + [str(w) for w in words], capture_output=True, text=True, timeout=300,
                          stdin=subprocess.DEVNULL, preexec_fn=confine if limit else None)


def good(*words):
    done = db(*words)
    assert done.returncode == 0, "%s: %s" % (" ".join(str(w) for w in words), done.stderr)
    return done


def refused(name, done, *words, code=1):
    missing = [w for w in words if w not in done.stderr]
    check(name, done.returncode == code and not missing, "exit %d, without %s: %s" % (done.returncode, missing, done.stderr))


def raster(path, epsg, west, north, step, values, kind, nodata=None):
    reference = osr.SpatialReference()
    reference.ImportFromEPSG(epsg)
    file = gdal.GetDriverByName("GTiff").Create(path, values.shape[1], values.shape[0], 1, kind)
    file.SetGeoTransform((west, step, 0.0, north, 0.0, -step))
    file.SetProjection(reference.ExportToWkt())
    if nodata is not None:
        file.GetRasterBand(1).SetNoDataValue(nodata)
    file.GetRasterBand(1).WriteArray(values)
    del file


def build_small(out, *words):
    """An image of 640 m of six classes, of classes.tif, which stays."""
    values = (numpy.arange(64 * 64).reshape(64, 64) // 7 % 6).astype(numpy.uint8)
    raster("classes.tif", 32632, 500000.0, 4800000.0, 10.0, values, gdal.GDT_Byte)
    good("build", "--classes", CLASSES, "--class-raster", "classes.tif", "--flat", *words, "--out", out)


def make_keys(*names):
    """Of each name a NAME.pem and its NAME.pub."""
    for name in names:
        for words in (["genpkey", "-algorithm", "ed25519", "-out", name + ".pem"],
                      ["pkey", "-in", name + ".pem", "-pubout", "-out", name + ".pub"]):
            subprocess.run(["openssl"] + words, check=True, capture_output=True, timeout=60)
