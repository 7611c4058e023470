"""Every page in Chromium as those have it who do not see it, see it badly, have a keyboard alone, or want no motion. TAP.

What is checked of each page is in tests/web/accessible.py; here are the states of the pages in which it is checked."""
import pathlib
import shutil
import subprocess
import sys
import time

from server import BUILD, Server

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "web"))
import browser  # noqa: E402  pylint: disable=wrong-import-position
import tap  # noqa: E402  pylint: disable=wrong-import-position
from accessible import check, check_parts  # noqa: E402  pylint: disable=wrong-import-position
from browser import ROOT, node  # noqa: E402  pylint: disable=wrong-import-position

TMP = (BUILD / "tmp/accessible").resolve()
SITE = TMP / "site"
SIZES = (1280, 720), (800, 1180), (1180, 820)
TABS = "targets", "weather", "malfunctions", "clock", "displays"
# Something in each list of the instructor's page, and a malfunction that is on.
EXERCISE = """
const {commands: c} = station, at = {latitude: 46.1, longitude: 11};
c.clock({timeMs: 0, rate: 1});
c.placeTarget({...at, kind: 13, speedMs: 9, courseDeg: 200, heightM: null, rcsDbsm: null, signature: 0, route: []});
c.circle('rain', null, {...at, radiusM: 5000, rateMmH: 40});
c.circle('jammer', null, {...at, ratioDb: 35});
c.sea(4);
c.malfunction(1, 20);
"""


def resize(b, width, height):
    b.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1,
                                                                   "mobile": False})


def at_all_sizes(b):
    """At 1280 x 720 all of it; on a tablet, upright and not, that it fits."""
    said = check(b)
    for size in SIZES[1:]:
        resize(b, *size)
        check_parts(b)
    resize(b, *SIZES[0])
    print("#", said)


def the_page_of_the_display(b):
    b.driver.get(b.page)
    b.until("globalThis.landmass?.tour && landmass.unit.value('pictures') > 10 && document.getElementById('figures').textContent !== ''")
    at_all_sizes(b)
    b.find("log").send_keys(str(TMP / "bad.log"))  # a word of warning has to be read, too
    b.until("document.getElementById('message').textContent !== ''")
    at_all_sizes(b)


def the_instructors_page_and_each_of_its_panels(b):
    b.get()
    b.until("globalThis.station?.isOpen && station.world.ownAircraft()")
    b.run(EXERCISE)
    b.until("((w) => w.targets.size + w.rain.size + w.jammer.size + w.malfunctions.size === 4)(station.world)")
    b.until("document.querySelector('#target-list button')")
    b.driver.find_element("css selector", "#target-list button").click()
    wrong = []
    for name in TABS:
        b.find(f"tab-{name}").click()
        time.sleep(0.3)
        print(f"# {name}")
        try:
            at_all_sizes(b)
        except AssertionError as error:
            wrong.append(f"{name}: {error}")
    assert not wrong, "; ".join(wrong)


def a_repeater(b):
    b.get("repeater.html?display=left")
    b.until("document.getElementById('over').textContent === 'THE DISPLAY HAS STOPPED'")
    at_all_sizes(b)


def the_debrief_of_a_flight(b):
    b.get("debrief.html")
    b.until("document.querySelectorAll('#recordings button').length === 1")
    b.driver.find_element("css selector", "#recordings button").click()
    b.until("debrief.lastState?.isScouted && document.querySelectorAll('#marks button').length > 2")
    at_all_sizes(b)


# Counts from the page's first script on: pictures may have come before a driver on a busy machine asks.
COUNT_DRAWN = """globalThis.drawn = 0;
const put = CanvasRenderingContext2D.prototype.putImageData;
CanvasRenderingContext2D.prototype.putImageData = function (...all) { drawn++; put.apply(this, all); };"""


def a_repeater_is_drawn_once_a_second_where_motion_is_not_wanted(b):
    tell = b.driver.execute_cdp_cmd
    counting = tell("Page.addScriptToEvaluateOnNewDocument", {"source": COUNT_DRAWN})
    tell("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-reduced-motion", "value": "reduce"}]})
    try:
        b.get("repeater.html?display=left")
        b.until("document.getElementById('over').textContent === 'THE DISPLAY HAS STOPPED'")
        drawn, came = b.ask("[drawn, repeater.pictures]")
        assert 0 < drawn <= 3 < came, f"{drawn} of {came} pictures drawn"
    finally:
        tell("Emulation.setEmulatedMedia", {"features": []})
        tell("Page.removeScriptToEvaluateOnNewDocument", counting)


TESTS = [the_page_of_the_display, the_instructors_page_and_each_of_its_panels, a_repeater, the_debrief_of_a_flight,
         a_repeater_is_drawn_once_a_second_where_motion_is_not_wanted]


def make():
    """The page's folder, and a display that recorded a flight of random events. Returns the words of landmass-ios."""
    shutil.rmtree(TMP, ignore_errors=True)
    shutil.copytree(ROOT / "bsp/web/page", SITE)
    shutil.copy(ROOT / "build/web/landmass.wasm", SITE)
    browser.make_scene(SITE)
    (TMP / "bad.log").write_text("no frame\n")
    flights = BUILD / "bin/tests/replay/flights"
    subprocess.run([flights, "image", TMP / "image.lmdb"], check=True)
    (TMP / "left").mkdir()
    subprocess.run([flights, "record", TMP / "image.lmdb", TMP, "2", "1", "6"], check=True, stdout=subprocess.DEVNULL)
    shutil.move(TMP / "2.log", TMP / "left/flight-00001-000.log")
    (TMP / "left/current.log").symlink_to("flight-00001-000.log")
    subprocess.run([BUILD / "bin/landmass-nav", "--straight", "45.95,11,0,3000,60", "--seconds", "600", "--out", TMP / "nav.log",
                    "--quiet"], check=True)
    return ["--image", TMP / "image.lmdb", "--site", BUILD / "ios", "--log", TMP / "nav.log", "--display", f"left:20={TMP}/left"]


def main():
    missing = browser.lacks()
    if missing:
        return tap.skip_all("pages for everybody", missing)
    with Server(*make()) as server:
        child, page = node(ROOT / "bsp/web/serve.mjs", SITE, 0)
        b = browser.Browser(server.url)
        b.page = page
        try:
            resize(b, *SIZES[0])
            return tap.run(TESTS, b)
        finally:
            b.driver.quit()
            child.kill()


if __name__ == "__main__":
    sys.exit(main())
