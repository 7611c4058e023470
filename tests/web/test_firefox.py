"""The pages in Firefox, where that is installed: golden pictures, a flight, keys, nothing from elsewhere; and of
landmass-ios the instructor's page and a repeater. TAP."""
import shutil
import subprocess
import sys

import tap
from browser import BUILD, ROOT, node
from firefox import Firefox, lacks  # which finds tests/ios
from site_of_tests import SITE, STEPS, make_site

from canvas import follow
from server import Server

TMP = BUILD / "tmp/firefox"


def golden_pictures_are_those_of_the_pc(b):
    b.get("goldens.html")
    b.until("document.getElementById('lines').textContent !== ''")
    drawn = b.ask("document.getElementById('lines').textContent")
    assert drawn == (ROOT / "tests/golden/pictures.golden").read_text(), drawn[:300]


def the_page_flies_obeys_its_keys_and_asks_no_other_server(b):
    b.get()
    b.until("globalThis.landmass?.firstPictureMs && landmass.tour")
    b.ask("Object.assign(landmass.bus, {latitude: 45.95, longitude: 11}) && 0")
    b.until("landmass.unit.value('pictures') > 30")
    b.until("landmass.context.getImageData(0, 0, 768, 768).data.filter((x, i) => i % 4 == 1 && x > 40).length > 5000")
    assert b.ask("document.getElementById('message').textContent") == ""
    b.press("l")
    b.until("landmass.bus.bankDeg === 5")
    b.click("[data-button='12']")
    b.until("landmass.unit.value('isRadarPage') === 0")
    names = b.ask("performance.getEntriesByType('resource').map((entry) => entry.name)")
    assert names and all(name.startswith((b.url, "data:")) for name in names), names


def the_start_and_a_step_are_measured(b):
    b.get()
    b.until("globalThis.landmass?.firstPictureMs")
    first, steps = b.ask("landmass.firstPictureMs"), sorted(b.ask(STEPS))
    print(f"# first picture after {first:.0f} ms; a step {steps[0]:.3f} ms at least, {steps[200]:.3f} in the middle, "
          f"{steps[-1]:.3f} at most")
    assert steps[200] < 2, "a step takes more than half of its time"


def station(b):
    """A display that recorded a flight of random events, on landmass-ios; the address of its pages is the browser's."""
    shutil.rmtree(TMP, ignore_errors=True)
    (TMP / "left").mkdir(parents=True)
    flights = BUILD / "bin/tests/replay/flights"
    subprocess.run([flights, "image", TMP / "image.lmdb"], check=True)
    subprocess.run([flights, "record", TMP / "image.lmdb", TMP, "2", "1", "6"], check=True, stdout=subprocess.DEVNULL)
    shutil.move(TMP / "2.log", TMP / "left/flight-00001-000.log")
    (TMP / "left/current.log").symlink_to("flight-00001-000.log")
    server = Server("--image", TMP / "image.lmdb", "--site", BUILD / "ios", "--display", f"left:20={TMP}/left").start()
    b.url = server.url
    return server


def the_instructors_page_and_a_repeater_work(b):
    here, server = b.url, station(b)
    try:
        b.get()
        b.until("globalThis.station?.isOpen")
        b.click("#tab-weather")
        b.click("#sea-tell")
        b.until("station.world.sea !== null")
        follow(b, "left")
        wanted = (TMP / "2.sums").read_text().split()
        b.until("document.getElementById('over').textContent === 'THE DISPLAY HAS STOPPED'")
        shown = dict(b.ask("[...sums]"))
        wrong = [n for n, of in shown.items() if wanted[n - 1] != of["sum"]]
        assert not wrong and len(shown) > 100, (len(shown), wrong[:3])
        print(f"# {len(shown)} pictures of a repeater compared")
    finally:
        b.url = here
        server.stop()


TESTS = [golden_pictures_are_those_of_the_pc, the_page_flies_obeys_its_keys_and_asks_no_other_server,
         the_start_and_a_step_are_measured, the_instructors_page_and_a_repeater_work]


def main():
    missing = lacks()
    if missing:
        return tap.skip_all("the page in Firefox", missing)
    make_site()
    server, url = node(ROOT / "bsp/web/serve.mjs", SITE, 0)
    try:
        with Firefox(url) as b:
            return tap.run(TESTS, b)
    finally:
        server.kill()


if __name__ == "__main__":
    sys.exit(main())
