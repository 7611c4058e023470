"""The pictures of docs/ios.md: the instructor's page on landmass-ios, beside a display that flies over the built-in scene.

Usage: station_pictures.py build/run/scene.lmdb docs/pictures, after `make all run ios-site`."""
import pathlib
import subprocess
import sys
import tempfile
import time

from server import BUILD, Server

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "web"))
import browser  # noqa: E402  pylint: disable=wrong-import-position

EXERCISE = """
const {commands: c, targets} = station, place = (latitude, longitude) => ({latitude, longitude});
c.clock({timeMs: 0, rate: 1});
c.placeTarget({...place(42.027, -29.09), kind: 13, speedMs: 9, courseDeg: 200, heightM: null, rcsDbsm: null, signature: 0, route: []});
const truck = c.placeTarget({...place(41.985, -29.02), kind: 3, speedMs: 20, courseDeg: 90, heightM: null, rcsDbsm: null, signature: 0,
    route: []});
c.addWaypoint(truck, place(42.01, -28.98));
c.addWaypoint(truck, place(41.96, -28.95));
c.circle('rain', null, {...place(41.93, -28.97), radiusM: 5000, rateMmH: 40});
c.circle('jammer', null, {...place(42.07, -29.15), ratioDb: 35});
c.malfunction(1, 20);
station.map.zoom = 11.4;
station.map.goTo(place(42.0, -29.08));
station.map.isFollowing = false;
"""


def bus(folder, image):
    """A flight, and what the display of node 20 says of itself."""
    nav, told, script = folder / "nav.log", folder / "told.log", folder / "script"
    script.write_text("0 range 10\n")
    for words in (("landmass-nav", "--straight", "42.0,-29.2,80,3000,180", "--seconds", 90, "--out", nav, "--quiet"),
                  ("landmass-sim", "--db", image, "--bus", nav, "--node", 20, "--reports", "--bus-out", told, "--script", script,
                   "--quiet")):
        subprocess.run([str(BUILD / "bin" / words[0]), *map(str, words[1:])], check=True, stdout=subprocess.DEVNULL)

    def of(path):
        """Lines by their time since the first: the display counts from its own start."""
        stamped = [(float(line[1:].split(")")[0]), line.split(") ")[1]) for line in path.read_text().splitlines()]
        return [(at - stamped[0][0], line) for at, line in stamped]
    lines = sorted(of(nav) + of(told), key=lambda line: line[0])
    (folder / "bus.log").write_text("".join(f"({at:.6f}) {line}\n" for at, line in lines))
    return folder / "bus.log"


def main():
    image, pictures = sys.argv[1], pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as name:
        log = bus(pathlib.Path(name), image)
        with Server("--image", image, "--site", BUILD / "ios", "--log", log, "--display", f"left:20={name}") as server:
            b = browser.Browser(server.url)
            try:
                b.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
                    "width": 1280, "height": 720, "deviceScaleFactor": 1, "mobile": False})
                b.get()
                b.until("globalThis.station?.isOpen && station.world.ownAircraft()")
                b.driver.execute_script(EXERCISE)
                b.until("station.world.targets.size === 2 && document.querySelectorAll('#target-list button').length === 2")
                b.driver.find_elements("css selector", "#target-list button")[1].click()
                time.sleep(6)
                b.driver.save_screenshot(str(pictures / "station.png"))
                b.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
                    "width": 800, "height": 1180, "deviceScaleFactor": 1, "mobile": True})
                b.find("tab-displays").click()
                b.driver.execute_script("document.querySelector('main').scrollTop = 0")
                time.sleep(3)
                b.driver.save_screenshot(str(pictures / "station-tablet.png"))
            finally:
                b.driver.quit()


if __name__ == "__main__":
    sys.exit(main())
