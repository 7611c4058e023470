"""A panel that flies, landmass-ios, and the pages of both in Chromium: a repeater and a debrief have the pictures that
the panel's glass got, at the same steps. TAP.

The panel (panel.py) hears what goes over the server's bus."""
import pathlib
import shutil
import subprocess
import sys

from canvas import CANVAS_SUM, follow
from panel import Panel
from server import BUILD, Server

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "web"))
import browser  # noqa: E402  pylint: disable=wrong-import-position
import tap  # noqa: E402  pylint: disable=wrong-import-position

TMP = (BUILD / "tmp/ios_panel").resolve()
FRAMES = 1000
# What an instructor does beside the flight, by the page's own commands.
WEATHER = """const c = station.commands;
c.placeTarget({kind: 16, latitude: 46.05, longitude: 11, speedMs: 60, courseDeg: 90, heightM: null, rcsDbsm: 60,
    signature: 0, route: []});
c.circle('rain', null, {latitude: 46.1, longitude: 11.05, radiusM: 6000, rateMmH: 60});
c.circle('jammer', null, {latitude: 46.2, longitude: 10.9, ratioDb: 20});"""
PATCH = """const {controlFrames: C} = await import('./frames.mjs');
station.commands.control(C.patch(46.05, 11.15, 5));"""
SECTOR = """const {controlFrames: C} = await import('./frames.mjs');
station.commands.control(C.switch(2));
station.commands.control(C.sector(0, 1));
station.commands.mendAll();
station.commands.malfunction(1, 10);"""


def act(b, station, words):
    """Do something on the instructor's page, which has a tab of its own, and come back."""
    here = b.driver.current_window_handle
    b.driver.switch_to.window(station)
    b.driver.execute_async_script(f"const done = arguments[0]; (async () => {{ {words} }})().then(done, (e) => done(String(e)))")
    b.driver.switch_to.window(here)


def the_repeater_has_every_picture_of_the_panel_at_its_step(b, panel):
    b.get()
    b.until("globalThis.station?.isOpen && station.world.ownAircraft()")
    station = b.driver.current_window_handle
    act(b, station, WEATHER)
    b.driver.switch_to.new_window("tab")
    follow(b, "left")
    b.until(f"sums.size >= {FRAMES // 4}")
    act(b, station, PATCH)
    b.until(f"sums.size >= {FRAMES // 2}")
    act(b, station, SECTOR)
    b.until(f"sums.size >= {FRAMES}")
    shown = dict(b.ask("[...sums]"))
    panel.check(shown)
    different = len({of["sum"] for of in shown.values()})
    assert different > FRAMES // 2, f"only {different} different pictures"
    print(f"# {len(shown)} pictures compared, {different} of them different;", b.find("figures").text)


def the_debrief_of_that_flight_has_its_pictures(b, panel):
    assert panel.stop() == 0
    wanted = panel.sums()
    b.get("debrief.html")
    b.until("document.querySelectorAll('#recordings button').length === 1")
    b.driver.find_element("css selector", "#recordings button").click()
    b.until("debrief.lastState?.isScouted")
    assert b.find("message").text == "", b.find("message").text
    b.driver.execute_script(CANVAS_SUM)
    seconds = b.ask("debrief.lengthUs") / 1e6
    seen = set()
    for part in (0.9, 0.1, 0.5, 0.3, 0.99, 0.02, 0.7):
        count = b.ask("debrief.jumps.count")
        b.ask(f"debrief.jump({1e6 * part * seconds})")
        b.until(f"debrief.jumps.count > {count}")
        picture, crc = b.ask("[debrief.picture, sumOf()]")
        assert picture == 0 or wanted[picture]["sum"] == crc, f"picture {picture} is {crc}, not {wanted[picture]}"
        seen.add(picture)
    assert len(seen) == 7, seen
    kinds = set(b.ask("debrief.marks.map(({kind}) => kind)"))
    assert {"patch", "command", "malfunction"} <= kinds, kinds
    assert b.find("message").text == "", b.find("message").text
    print(f"# {seconds:.0f} s;", b.find("figures").text)


TESTS = [the_repeater_has_every_picture_of_the_panel_at_its_step, the_debrief_of_that_flight_has_its_pictures]


def main():
    missing = browser.lacks()
    if missing:
        return tap.skip_all("a panel's pages in a browser", missing)
    shutil.rmtree(TMP, ignore_errors=True)
    (TMP / "recordings").mkdir(parents=True)
    browser.make_scene(TMP)
    subprocess.run([BUILD / "bin/landmass-nav", "--straight", "45.8,11,0,3000,180", "--seconds", "300", "--out",
                    TMP / "nav.log", "--quiet"], check=True)
    with Server("--image", TMP / "scene.lmdb", "--site", BUILD / "ios", "--log", TMP / "nav.log", "--display",
                f"left:20={TMP}/recordings") as server:
        panel, b = Panel(server.port, TMP, TMP / "scene.lmdb"), None
        try:
            b = browser.Browser(server.url)
            return tap.run(TESTS, b, panel)
        finally:
            panel.child.kill()
            if b:
                b.driver.quit()


if __name__ == "__main__":
    sys.exit(main())
