"""The page as its tests have it, and what both browsers measure of it."""
import os
import pathlib
import shutil
import subprocess

from browser import BUILD, ROOT, make_scene

SITE = pathlib.Path(os.environ.get("SITE", BUILD / "tmp/web/site"))  # another one only for what is measured

# 400 times the mean of 25 steps, in milliseconds: browsers' clocks are coarse.
STEPS = """(async () => {
    const took = [];
    for (let n = 0; n < 400; n++) {
        await landmass.unit.flash.settled();
        const begun = performance.now();
        for (let step = 0; step < 25; step++) {
            landmass.step();
        }
        took.push((performance.now() - begun) / 25);
    }
    landmass.begunMs = null;
    return took;
})()"""


def make_site():
    """The page as `make web` has it, with a golden country in place of the built-in scene."""
    if "SITE" in os.environ:
        return
    shutil.rmtree(SITE, ignore_errors=True)
    shutil.copytree(ROOT / "bsp/web/page", SITE)
    for name in ("goldens.html", "goldens_page.mjs", "goldens.mjs"):
        shutil.copy(ROOT / "tests/web" / name, SITE)
    for name in ("landmass.wasm", "golden.wasm"):
        shutil.copy(ROOT / "build/web" / name, SITE)
    make_scene(SITE)
    (SITE.parent / "bad.log").write_text("no frame\n")
    subprocess.run([BUILD / "bin/landmass-nav", "--straight", "45.95,11,0,3000,180", "--seconds", "20", "--out",
                    SITE.parent / "bus.log"], check=True, stdout=subprocess.DEVNULL)
    shutil.copy(SITE.parent / "bus.log", SITE / "flight.log")
