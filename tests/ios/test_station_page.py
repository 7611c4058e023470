"""The instructor's page in Chromium: every control is worked, its frames are taken from the bus, and a display that
hears them is read. TAP."""
import csv
import json
import pathlib
import re
import shutil
import signal
import sys
import time

from server import BUILD, Server

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "web"))
import browser as web  # noqa: E402  pylint: disable=wrong-import-position
import tap  # noqa: E402  pylint: disable=wrong-import-position

try:
    from glass import Glass
except ImportError:
    Glass = None

TMP = BUILD / "tmp/ios"
NORTH = (46.12, 11.0)       # ahead of the aircraft, a third of the way up the glass
FARTHER = (46.3, 11.0)
SIDE = (46.05, 11.15)        # where a patch can be taken
BOUNDS = {"title": "golden", "west": 10.5, "south": 45.6, "east": 11.5, "north": 46.4, "zoom_max": 12}
FLAG_MALFUNCTION, SWITCH_FROZEN = 1 << 14, 1
LOST_SECTOR = (5, 6)


class Page:
    """A page in a browser of its own, and what it puts on the bus."""

    def __init__(self, url, width=1280, height=720):
        self.b = web.Browser(url)
        self.resize(width, height)

    def resize(self, width, height, is_mobile=False):
        self.b.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": is_mobile})

    def start(self):
        self.b.get()
        self.b.until("globalThis.station?.isOpen && station.world.ownAircraft()")
        self.js(f"Object.assign(station.map.bounds, {json.dumps(BOUNDS)}, {{zoom_max: station.map.bounds.zoom_max}})")
        self.js("station.map.wholeMap(); station.map.isFollowing = false; station.ownLines = [];"
                "const {link} = station, take = link.take.bind(link), isOwn = (line) => line.includes('#1F');"
                "link.take = (text) => { station.ownLines.push(...text.split('\\n').filter(isOwn)); take(text); }")
        return self

    def mark(self):
        return self.js("return station.ownLines.length")

    def since(self, mark):
        """What came back from the bus since a mark: ID#DATA of the pages' node."""
        return [line.split()[2] for line in self.js(f"return station.ownLines.slice({mark})") if " past " not in line]

    def js(self, words):
        return self.b.driver.execute_script(words)

    def click(self, name):
        """The page is drawn five times a second, and its buttons with it."""
        self.b.until(f"!document.getElementById('{name}').matches(':disabled')")
        self.b.find(name).click()

    def tab(self, name):
        self.click(f"tab-{name}")

    def tool(self, name):
        self.b.driver.find_element("css selector", f"input[name=tool][value={name}]").click()

    def fill(self, name, value):
        field = self.b.find(name)
        if field.tag_name == "select":
            field.find_element("css selector", f"option[value='{value}']").click() if field.find_elements(
                "css selector", f"option[value='{value}']") else field.send_keys(str(value))
        else:
            field.clear()
            field.send_keys(str(value))

    def pixel(self, place):
        return self.js(f"return station.map.toPixel({{latitude: {place[0]}, longitude: {place[1]}}})")

    def point(self, *places, is_drag=False):
        """Click at places of the map, or drag from the first to the second."""
        canvas = self.b.find("map")
        box, chain = canvas.size, web.ActionChains(self.b.driver)
        for n, place in enumerate(places):
            x, y = self.pixel(place)
            chain.move_to_element_with_offset(canvas, round(x - box["width"] / 2), round(y - box["height"] / 2))
            if not is_drag:
                chain.click()
            elif n == 0:
                chain.click_and_hold()
        if is_drag:
            chain.release()
        chain.perform()

    def center(self, place):
        self.js(f"station.map.goTo({{latitude: {place[0]}, longitude: {place[1]}}})")

    def told(self, act, *ids):
        """Frames of these identifiers that an act puts on the bus; for four seconds no repeat comes between."""
        self.js("station.keeper.kept.forEach((item) => { item.sentMs = performance.now() + 3000; })")
        mark = self.mark()
        act()
        end, wanted = time.monotonic() + 10, set(ids)
        while time.monotonic() < end:
            own = [f for f in self.since(mark) if int(f[:3], 16) in wanted]
            if {int(f[:3], 16) for f in own} == wanted:
                return own[:len(ids)]
            time.sleep(0.03)
        raise AssertionError(f"{wanted} did not come: {own}")

    def reset(self):
        """Nothing is told; the whole map is seen."""
        self.js("const c = station.commands; c.removeAllTargets(); c.fairWeather(); c.mendAll();"
                "station.map.wholeMap()")
        self.b.until("((w) => w.targets.size + w.rain.size + w.jammer.size + w.malfunctions.size === 0)(station.world)")
        self.tool("look")

    def world(self, words):
        return self.js(f"return station.world.{words}")

    def wait(self, words):
        self.b.until(f"station.world.{words}")


TARGET = (1815, 1810, 1811, 1814)
MOVING = (1815, 1810, 1811, 1813, 1814)


def bright(p, kind=16, speed=0):
    """The form: a target that every glass shows."""
    p.tab("targets")
    for name, value in (("target-kind", kind), ("target-speed", speed), ("target-course", 0), ("target-height", ""),
        ("target-rcs", 60)):
        p.fill(name, value)


def place(p, at=NORTH, speed=0):
    bright(p, speed=speed)
    p.tool("target")
    return p.told(lambda: p.point(at), *(MOVING if speed else TARGET), 1816)


def clear_targets(p):
    p.tab("targets")
    p.told(lambda: p.click("target-remove-all"), 1818)
    p.wait("targets.size === 0")


def a_target_is_placed_and_stands_on_the_glass(p, g):
    flight = g.fly(place(p))
    spot, all_of_it = g.middle(flight), g.changed(flight).mean()
    assert spot and abs(spot[0] - 384) < 30, spot
    assert 0 < all_of_it < 0.05, f"{100 * all_of_it:.2f} % of the glass"
    assert flight["report"]["bus"]["refused_range"] == 0
    p.wait("targets.size === 1")
    assert "corner reflector" in p.b.find("target-list").text
    clear_targets(p)


def a_target_that_is_dragged_moves_on_the_glass(p, g):
    near = g.middle(g.fly(place(p)))
    p.tool("look")
    p.wait("targets.size === 1")
    far = g.middle(g.fly(p.told(lambda: p.point(NORTH, FARTHER, is_drag=True), *TARGET, 1816)))
    assert far[1] < near[1] - 100 and abs(far[0] - 384) < 30, (near, far)
    clear_targets(p)


def a_way_is_gone_with_its_speed(p, g):
    stands = g.middle(g.fly(place(p)))
    clear_targets(p)
    place(p, speed=900)
    p.wait("targets.size === 1")
    p.tool("route")
    frames = p.told(lambda: p.point(FARTHER), *MOVING, 1816)
    assert p.js("return station.targets.routeOf(0).length") == 1
    moved = g.middle(g.fly(frames))
    assert moved[1] < stands[1] - 12, (stands, moved)
    p.b.until("station.world.targets.get(0).northMs > 890")
    p.click("target-route-clear")
    p.b.until("station.targets.routeOf(0).length === 0")
    clear_targets(p)


def a_target_is_changed_moved_and_removed(p, g):
    first = place(p)
    p.wait("targets.size === 1")
    p.center(FARTHER)
    far = p.told(lambda: p.click("target-move"), *TARGET, 1816)
    p.wait("targets.get(0).latitude > 46.2")
    assert g.middle(g.fly(first, far))[1] < g.middle(g.fly(first))[1] - 100
    p.fill("target-rcs", -40)
    p.fill("target-kind", 1)
    faint = p.told(lambda: p.click("target-apply"), *TARGET, 1816)
    assert not g.middle(g.fly(faint)), "a person of -40 dBsm is seen"
    p.click("target-loop")
    p.told(lambda: p.click("target-waypoint"), *TARGET, 1816)
    p.b.until("station.keeper.kept.get('target 0').target.isLoop && station.targets.routeOf(0).length === 1")
    gone = p.told(lambda: p.click("target-remove"), 1817)
    assert not g.changed(g.fly(first, gone)).any(), "a removed target is still seen"
    p.wait("targets.size === 0")
    p.js("station.map.wholeMap()")


def a_target_in_the_middle_of_the_map_has_the_form_and_its_signature(p, g):
    bright(p)
    p.center(NORTH)
    frames = p.told(lambda: p.click("target-place"), *TARGET, 1816)
    spot = g.middle(g.fly(frames))
    assert spot and abs(spot[0] - 384) < 30, spot
    clear_targets(p)
    p.tab("displays")
    p.fill("control-mode", 3)  # beacons
    mode = p.told(lambda: p.click("control-sector"), 1536)
    bright(p, kind=17)
    replies = []
    for code in (1, 13):
        p.tab("targets")
        p.fill("target-signature", code)
        replies.append(p.told(lambda: p.click("target-place"), *TARGET, 1816))
        clear_targets(p)
    assert g.changed(g.fly(mode, replies[0]), than=(mode,)).any()
    assert g.changed(g.fly(mode, replies[0]), than=(mode, replies[1])).any(), "beacons of two codes look the same"
    p.fill("target-signature", 0)
    p.tab("displays")
    p.fill("control-mode", 0)


def the_buttons_of_the_map_zoom_and_follow(p, _):
    zoom = p.js("return station.map.zoom")
    p.click("map-in")
    assert p.js("return station.map.zoom") > zoom
    p.click("map-out")
    p.click("map-out")
    assert p.js("return station.map.zoom") < zoom
    p.click("map-whole")
    assert abs(p.js("return station.map.zoom") - zoom) < 0.01
    p.center(FARTHER)
    p.js("station.map.isFollowing = false; document.getElementById('map-follow').checked = false")
    p.click("map-follow")
    p.b.until("Math.abs(station.map.centerPlace.latitude - station.world.ownAircraft().latitude) < 0.001")
    p.click("map-follow")
    assert p.js("return station.map.isFollowing") is False


def all_targets_go_at_once(p, g):
    frames = place(p) + place(p, FARTHER)
    p.wait("targets.size === 2")
    gone = p.told(lambda: p.click("target-remove-all"), 1818)
    assert g.changed(g.fly(frames)).any() and not g.changed(g.fly(frames, gone)).any()
    p.wait("targets.size === 0")


RAIN, JAMMER = (1800, 1801, 1802, 1803), (1804, 1805, 1806)


def rain_is_placed_changed_dragged_and_removed(p, g):
    p.tab("weather")
    p.fill("rain-radius", 8)
    p.fill("rain-rate", 100)
    p.tool("rain")
    frames = p.told(lambda: p.point(NORTH), *RAIN)
    assert g.changed(g.fly(frames)).mean() > 0.01
    p.wait("rain.size === 1")
    p.tool("look")
    dragged = p.told(lambda: p.point(NORTH, FARTHER, is_drag=True), *RAIN)
    assert g.changed(g.fly(frames, dragged), than=(frames,)).mean() > 0.005
    p.fill("rain-rate", 5)
    buttons = p.b.driver.find_elements("css selector", "#rain-list button")
    weak = p.told(buttons[0].click, *RAIN)
    assert g.changed(g.fly(weak)).mean() < g.changed(g.fly(dragged)).mean()
    p.center(NORTH)
    assert p.told(buttons[1].click, *RAIN)[0][12:] != weak[0][12:]
    p.js("station.map.wholeMap()")
    gone = p.told(buttons[2].click, 1807)
    assert not g.changed(g.fly(frames, gone)).any()
    p.wait("rain.size === 0")
    p.told(lambda: p.click("rain-place"), *RAIN)
    p.told(lambda: p.click("weather-clear"), 1807)


def a_jammer_is_placed_and_fair_weather_ends_it(p, g):
    p.tab("weather")
    p.fill("jammer-ratio", 60)
    p.tool("jammer")
    frames = p.told(lambda: p.point(NORTH), *JAMMER)
    flight = g.fly(frames)
    assert flight["picture"].mean() > g.fly()["picture"].mean() + 1
    p.wait("jammer.size === 1")
    p.told(lambda: p.click("jammer-place"), *JAMMER)
    p.wait("jammer.size === 2")
    fair = p.told(lambda: p.click("weather-clear"), 1807)
    assert not g.changed(g.fly(frames, fair)).any()
    p.wait("jammer.size === 0")


def sea_and_wind_are_told(p, g):
    p.tab("weather")
    p.fill("sea-state", 8)
    rough = p.told(lambda: p.click("sea-tell"), 1808)
    p.fill("wind-from", 45)
    wind = p.told(lambda: p.click("wind-tell"), 1809)
    assert g.changed(g.fly(rough)).any(), "the sea is as it was"
    assert g.changed(g.fly(rough, wind), than=(rough,), least=8).any(), "the wind does nothing"
    p.wait("sea?.value === 8 && station.world.wind?.value === 45")
    time.sleep(0.4)
    assert "state 8" in p.b.find("sea-told").text and "45" in p.b.find("wind-told").text
    fair = p.told(lambda: p.click("weather-clear"), 1807)
    assert not g.changed(g.fly(rough, wind, fair)).any()


def each_malfunction_breaks_the_picture_and_is_mended(p, g):
    p.tab("malfunctions")
    mean = g.fly()["picture"].mean()
    rows = p.b.driver.find_elements("css selector", "#malfunction-list tr")
    assert len(rows) == 10
    frames = []
    p.fill("malfunction-8", 20)
    for kind, row in enumerate(rows):
        frames.append(p.told(row.find_element("class name", "break").click, 1825))
        p.wait(f"malfunctions.has({kind})")
    for kind in (0, 1, 2, 3, 4, 7, 8):
        flight = g.fly(frames[kind])
        assert g.changed(flight).mean() > 0.002, f"malfunction {kind}: {g.changed(flight).mean():.4f} of the glass"
        assert flight["said"][1500][0] & FLAG_MALFUNCTION, kind
    means = [g.fly(frames[kind])["picture"].mean() for kind in (0, 1)]
    assert max(means) < mean, (means, mean)
    wedge = g.fly(frames[5] + frames[6])
    left, right = g.changed(wedge)[:, :384].sum(), g.changed(wedge)[:, 400:].sum()
    assert wedge["picture"].mean() < mean and left > 5 * right, (left, right)
    for kind, row in enumerate(rows[:2]):
        mended = p.told(row.find_element("class name", "mend").click, 1826)
        flight = g.fly(frames[kind], mended)
        assert not g.changed(flight).any() and not flight["said"][1500][0] & FLAG_MALFUNCTION, kind
    mended = p.told(lambda: p.click("mend-all"), 1826)
    assert not g.changed(g.fly(frames[2] + frames[4], mended)).any()
    p.wait("malfunctions.size === 0")


def buttons_stay_where_they_are_whatever_is_told(p, _):
    p.tab("malfunctions")
    places = ("const top = document.getElementById('malfunction-list').getBoundingClientRect().y; "
              "return [...document.querySelectorAll('#malfunction-list button')].map((one) => { "
              "const at = one.getBoundingClientRect(); return [at.x, at.y - top, at.height].map(Math.round); })")
    before = p.js(places)
    assert len(before) == 20
    for kind, row in enumerate(p.b.driver.find_elements("css selector", "#malfunction-list tr")):
        row.find_element("class name", "break").click()
        p.wait(f"malfunctions.has({kind})")
    time.sleep(0.4)
    assert p.js(places) == before
    p.js("station.keeper.kept.clear()")  # as if another page told it, until this one takes over
    p.b.until("[...document.querySelectorAll('#malfunction-list .told')].some((one) => one.textContent.includes('another'))")
    assert p.js(places) == before
    wide = p.js("const right = document.getElementById('right'); return right.scrollWidth - right.clientWidth")
    assert wide <= 0, wide


def a_dead_key_does_nothing(p, g):
    p.tab("malfunctions")
    p.fill("malfunction-9", 12)
    dead = p.told(lambda: p.b.driver.find_elements("class name", "break")[9].click(), 1825)
    p.told(lambda: p.click("mend-all"), 1826)
    p.tab("displays")
    key = p.told(lambda: p.b.driver.find_element("css selector", "[data-button='12']").click(), 1531)
    assert g.fly(key)["said"][1519][3] == 3, "key 12 opens the BIT page"
    assert g.fly(dead, key)["said"][1519][3] == 0, "a dead key does nothing"


def every_key_of_the_bezel_is_obeyed(p, g):
    p.tab("displays")
    for number in range(1, 29):
        key = p.b.driver.find_element("css selector", f"[data-button='{number}']")
        down_and_up = both_of(p, key)
        controls = g.fly(*[[frame] for frame in down_and_up])["report"]["controls"]
        assert controls["obeyed"] == 2 and controls["bad"] == controls["torn"] == 0, (number, controls)


def both_of(p, key):
    mark = p.mark()
    key.click()
    for _ in range(200):
        own = [f for f in p.since(mark) if f.startswith("5FB")]
        if len(own) == 2:
            return own
        time.sleep(0.02)
    raise AssertionError(f"a key went down and up: {own}")


def the_picture_is_held_and_released(p, g):
    p.tab("displays")
    held = p.told(lambda: p.click("control-freeze"), 1532)
    released = p.told(lambda: p.click("control-release"), 1532)
    assert g.fly(held)["said"][1521][1] & SWITCH_FROZEN
    assert not g.fly(held, released)["said"][1521][1] & SWITCH_FROZEN


def mode_range_width_and_gain_are_obeyed(p, g):
    p.tab("displays")
    p.fill("control-mode", 2)
    p.fill("control-field", 1)
    assert g.fly(p.told(lambda: p.click("control-sector"), 1536))["said"][1519][1:3] == [2, 1]
    p.fill("control-nm", 20)
    assert g.fly(p.told(lambda: p.click("control-range"), 1537))["said"][1520] == [20]
    p.fill("control-width-number", 1)
    assert g.fly(p.told(lambda: p.click("control-width"), 1538))["said"][1521][0] == 30
    p.fill("control-db", -6)
    assert g.fly(p.told(lambda: p.click("control-gain"), 1539))["said"][1522] == [-6]


def cursor_steerpoint_and_patch_go_where_the_map_says(p, g):
    p.tab("displays")
    p.tool("cursor")
    latitude, longitude = (round(x * 1e7) for x in SIDE)
    said = g.fly(p.told(lambda: p.point(SIDE), 1540, 1541))["said"]
    assert abs(said[1510][0] - latitude) < 30000 and abs(said[1511][0] - longitude) < 30000, (said[1510], said[1511])
    p.tool("steer")
    steer = p.told(lambda: p.point((46.15, 11.0)), 1542, 1543)
    assert g.changed(g.fly(steer)).any()
    assert not g.changed(g.fly(steer, p.told(lambda: p.click("control-steer-off"), 1542, 1543))).any()
    p.tool("patch")
    said = g.fly(p.told(lambda: p.point(SIDE), 1544, 1545, 1546))["said"]
    assert said[1519][0] == 1 and abs(said[1516][0] - latitude) < 30000, said
    p.center(SIDE)
    for name, ids in (("cursor", (1540, 1541)), ("steer", (1542, 1543)), ("patch", (1544, 1545, 1546))):
        here = p.told(lambda: p.click(f"control-{name}-here"), *ids)
        assert len(here) == len(ids)
    p.fill("control-cell", 20)
    coarse = p.told(lambda: p.click("control-patch-here"), 1544, 1545, 1546)
    assert g.changed(g.fly(coarse), than=(here,)).any(), "cells of 20 m look like those of 5 m"
    p.fill("control-cell", 5)
    p.js("station.map.wholeMap()")


def designate_drop_slew_and_knob_are_obeyed(p, g):
    p.tab("displays")
    designate, drop = (p.told(lambda: p.click(f"control-{name}"), 1532) for name in ("designate", "drop"))
    p.center(SIDE)
    cursor = p.told(lambda: p.click("control-cursor-here"), 1540, 1541)
    assert g.fly(cursor, designate)["said"][1519][0] == 1 and g.fly(cursor, designate, drop)["said"][1519][0] == 0
    for way, item, sign in (("1,0", 1511, 1), ("-1,0", 1511, -1), ("0,1", 1510, 1), ("0,-1", 1510, -1)):
        button = p.b.driver.find_element("css selector", f"[data-slew='{way}']")
        mark = p.mark()
        web.ActionChains(p.b.driver).click_and_hold(button).pause(0.2).release().perform()
        time.sleep(0.3)
        own = [f for f in p.since(mark) if f.startswith(("5FE", "5FF"))]
        assert len(own) == 4, own
        flight, still = g.fly(own[:2], own[2:])["said"], g.fly()["said"]
        assert sign * (flight[item][0] - still[item][0]) > 10000, (way, flight[item], still[item])
    mark = p.mark()
    p.js("const k = document.getElementById('control-knob'); k.value = 1000; k.dispatchEvent(new Event('change'))")
    time.sleep(0.3)
    knob = [f for f in p.since(mark) if f.startswith("5FD")]
    assert g.fly(knob)["picture"].mean() > g.fly()["picture"].mean()


def the_clock_freezes_runs_jumps_and_has_a_seed(p, g):
    p.tab("clock")
    runs = p.told(lambda: p.click("run"), 1821, 1820)
    p.wait("clock?.rate === 1")
    ship = place(p, speed=900)
    p.wait("targets.size === 1")
    p.tab("clock")
    frozen = p.told(lambda: p.click("freeze"), 1821, 1820)
    p.wait("clock?.rate === 0")
    time.sleep(0.5)
    assert "FROZEN" in p.b.find("exercise-state").text and p.b.find("freeze").get_attribute("aria-pressed") == "true"
    at = p.world("exerciseMs()")
    time.sleep(0.5)
    assert p.world("exerciseMs()") == at
    p.fill("clock-time", "1:00:00")
    p.told(lambda: p.click("clock-jump"), 1821, 1820)
    p.wait("exerciseMs() === 3600000")
    p.told(lambda: p.b.driver.find_element("css selector", "[data-by='60']").click(), 1821, 1820)
    p.wait("exerciseMs() === 3660000")
    p.told(lambda: p.b.driver.find_element("css selector", "[data-by='-10']").click(), 1821, 1820)
    p.wait("exerciseMs() === 3650000")
    p.told(lambda: p.b.driver.find_element("css selector", "[data-by='10']").click(), 1821, 1820)
    p.told(lambda: p.b.driver.find_element("css selector", "[data-by='-60']").click(), 1821, 1820)
    p.wait("exerciseMs() === 3600000")
    p.fill("clock-rate", 4)
    fast = p.told(lambda: p.click("clock-rate-tell"), 1821, 1820)
    p.wait("clock?.rate === 4")
    p.fill("clock-seed", 77)
    seed = p.told(lambda: p.click("clock-seed-tell"), 1822, 1821, 1820)
    assert g.changed(g.fly(seed), than=(seed[1:],)).any(), "another seed draws the same noise"
    # The time is the same for all, for the rates are compared: a ship told in the clock's first step goes on from 0.
    clocks = [[frame[:12] + "00000000" if frame.startswith("71C") else frame for frame in told] for told in (frozen, runs, fast)]
    stands, moves, moves_fast = (g.middle(g.fly(clock + ship), than=(clock,))[1] for clock in clocks)
    assert stands - moves > 3 and stands - moves_fast > 2 * (stands - moves), (stands, moves, moves_fast)
    clear_targets(p)


def what_cannot_be_is_said_and_not_sent(p, _):
    p.tab("weather")
    p.fill("rain-rate", 500)
    mark = p.mark()
    p.click("rain-place")
    assert "1 to 150" in p.b.find("message").text
    time.sleep(0.3)
    assert not [f for f in p.since(mark) if f.startswith("708")]
    p.fill("rain-rate", 30)
    p.tab("clock")
    p.fill("clock-time", "noon")
    p.click("clock-jump")
    assert "hours:minutes:seconds" in p.b.find("message").text


def the_events_are_saved_as_a_file(p, _):
    p.tab("weather")
    folder = TMP.resolve() / "saved"
    shutil.rmtree(folder, ignore_errors=True)
    p.b.driver.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(folder)})
    p.told(lambda: p.click("sea-tell"), 1808)
    p.wait("sea !== null")
    p.click("events-save")
    saved = p.js("return station.saved")
    end = time.monotonic() + 30
    while not (folder / saved["name"]).exists() and time.monotonic() < end:
        time.sleep(0.1)
    rows = list(csv.reader((folder / saved["name"]).open(newline="")))
    assert rows[0] == ["utc", "exercise", "event", "by"] and len(rows) == p.world("events.length") + 1, rows[:2]
    assert all(len(row) == 4 for row in rows), rows
    assert "sea" in rows[-1][2].lower() and re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z", rows[-1][0]), rows[-1]
    p.told(lambda: p.click("weather-clear"), 1807)


def two_instructors_agree(p, _):
    other = Page(p.b.url).start()
    try:
        place(p)
        other.wait("targets.size === 1 && station.world.targets.get(0).kind === 16")
        other.tab("targets")
        other.b.until("document.querySelector('#target-list button')")
        other.b.driver.find_element("css selector", "#target-list button").click()
        other.b.until("!document.getElementById('target-remove').disabled")
        other.fill("target-kind", 13)
        other.click("target-apply")
        p.wait("targets.get(0).kind === 13")
        p.b.until("!station.keeper.kept.has('target 0')")
        assert other.js("return station.keeper.kept.has('target 0')")
        p.b.until("document.getElementById('target-list').textContent.includes('another page')")
        other.b.driver.quit()  # what it kept is kept on
        p.b.until("station.keeper.kept.has('target 0')")
        assert p.world("targets.size") == 1
        fresh = Page(p.b.url).start()
        try:
            fresh.wait("targets.size === 1 && station.world.targets.get(0).kind === 13")
        finally:
            fresh.b.driver.quit()
    finally:
        other.b.driver.quit()
    clear_targets(p)


def stale_navigation_and_a_lost_connection_are_plain(p, _):
    server = p.server
    server.child.send_signal(signal.SIGSTOP)  # the connection stays, and nothing comes
    p.b.until("document.getElementById('own').textContent.includes('STALE')")
    p.b.until("document.getElementById('own').textContent.includes('LOST')")
    server.child.send_signal(signal.SIGCONT)
    p.b.until("document.getElementById('own').textContent.startsWith('Own aircraft,')")
    server.stop(signal.SIGKILL)
    p.b.until("document.getElementById('lost').textContent.includes('Connection lost')")
    assert p.b.find("freeze").is_enabled() is False and p.b.find("connection").text == "NO CONNECTION"
    server.start()
    p.b.until("station.isOpen && document.getElementById('lost').textContent === ''")
    assert p.b.find("freeze").is_enabled()
    p.b.until("document.getElementById('events').textContent.includes('connection lost')")


def a_page_that_may_only_listen_tells_nothing(p, _):
    place(p)
    listener = Page(p.b.url)
    try:
        listener.b.get()
        listener.b.until("globalThis.station?.isOpen && station.world.targets.size === 1")
        listener.js("station.site.may_send = false; station.setOpen(true)")
        assert not listener.b.find("freeze").is_enabled() and "listening only" in listener.b.find("connection").text
        p.js("station.keeper.kept.clear(); station.keeper.orphans = () => []")
        listener.wait("targets.size === 0")  # after ten seconds: it did not keep it
        p.js("delete station.keeper.orphans")
    finally:
        listener.b.driver.quit()


def the_keyboard_alone_is_enough(p, g):
    p.start()
    for panel in ("targets", "weather", "malfunctions", "clock", "displays"):
        p.tab(panel)
        wanted = p.js("return [...document.querySelectorAll('button, input, select, canvas, a, [tabindex=\"0\"]')]"
                      ".filter((e) => e.checkVisibility() && !e.matches(':disabled, [type=radio]:not(:checked)') && "
                      "e.tabIndex >= 0).length")
        reached = set()
        for _ in range(wanted + 6):
            p.b.press(web.Keys.TAB)
            reached.add(p.js("return [...document.querySelectorAll('*')].indexOf(document.activeElement)"))
        assert len(reached) >= wanted, f"{panel}: {len(reached)} of {wanted}"
    bright(p)
    p.center(NORTH)
    p.b.driver.find_element("css selector", "input[name=tool][value=look]").send_keys(web.Keys.ARROW_RIGHT)
    p.js("document.getElementById('map').focus()")
    frames = p.told(lambda: p.b.press(web.Keys.ENTER), *TARGET, 1816)
    assert abs(g.middle(g.fly(frames))[0] - 384) < 30
    p.wait("targets.size === 1")
    before = p.js("return station.map.center[0]")
    p.b.press(web.Keys.ARROW_RIGHT)
    p.b.press("+")
    assert p.js("return station.map.center[0]") > before
    moved = p.told(lambda: p.b.press("m"), *TARGET, 1816)
    assert moved[2] != frames[2]
    p.told(lambda: p.b.press(web.Keys.DELETE), 1817)
    p.b.press(web.Keys.ESCAPE)
    assert p.js("return station.tool()") == "look"
    p.b.find("tab-targets").send_keys(web.Keys.ARROW_RIGHT)
    assert p.js("return document.activeElement.id") == "tab-weather" and p.b.find("panel-weather").is_displayed()


def fingers_pan_zoom_and_place_on_a_tablet(p, g):
    p.resize(800, 1180, is_mobile=True)
    try:
        p.js("station.map.wholeMap(); document.querySelector('main').scrollTop = 0")
        time.sleep(0.3)
        box = p.js("const r = document.getElementById('map').getBoundingClientRect(); "
                   "return [r.left, r.top, r.width, r.height]")
        middle = (box[0] + box[2] / 2, box[1] + box[3] / 2)

        def touch(kind, *points):
            p.b.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {
                "type": kind, "touchPoints": [{"x": x, "y": y, "id": n} for n, (x, y) in enumerate(points)]})
        zoom = p.js("return station.map.zoom")
        touch("touchStart", (middle[0] - 30, middle[1]), (middle[0] + 30, middle[1]))
        for d in (60, 90, 120):
            touch("touchMove", (middle[0] - d, middle[1]), (middle[0] + d, middle[1]))
        touch("touchEnd")
        assert abs(p.js("return station.map.zoom") - zoom - 2) < 0.2, p.js("return station.map.zoom") - zoom
        before = p.js("return station.map.center[0]")
        touch("touchStart", middle)
        touch("touchMove", (middle[0] - 20, middle[1]))
        touch("touchMove", (middle[0] - 60, middle[1]))
        touch("touchEnd")
        assert p.js("return station.map.center[0]") > before
        bright(p)
        p.center(NORTH)
        p.tool("target")
        p.js("document.querySelector('main').scrollTop = 0")

        def tap():
            touch("touchStart", middle)
            touch("touchEnd")
        frames = p.told(tap, *TARGET, 1816)
        assert abs(g.middle(g.fly(frames))[0] - 384) < 40
        clear_targets(p)
    finally:
        p.resize(1280, 720)


def the_page_fits_and_is_calm_where_motion_is_not_wanted(p, _):
    for width, height in ((1280, 720), (800, 1180), (1180, 820)):
        p.resize(width, height)
        for panel in ("targets", "weather", "malfunctions", "clock", "displays"):
            p.tab(panel)
            wide = p.js("const right = document.getElementById('right'); "
                        "return [document.documentElement.scrollWidth, right.scrollWidth - right.clientWidth]")
            assert wide[0] <= width and wide[1] <= 0, (width, panel, wide)
    p.resize(1280, 720)
    p.js("document.activeElement.blur(); const {map} = station, draw = map.draw.bind(map); "
         "map.draw = (layers) => { station.drawn++; draw(layers); }")
    p.b.driver.execute_cdp_cmd("Emulation.setEmulatedMedia",
        {"features": [{"name": "prefers-reduced-motion", "value": "reduce"}]})
    time.sleep(2)
    p.js("station.drawn = 0")
    time.sleep(2)
    drawn = p.js("return station.drawn")
    p.b.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})
    assert 1 <= drawn <= 3, drawn


def the_page_asks_no_other_server_and_has_no_error(p, _):
    names = p.js("return performance.getEntriesByType('resource').map((entry) => entry.name)")
    assert names and all(name.startswith((p.b.url, "data:")) for name in names), names
    errors = [e for e in p.b.driver.get_log("browser") if e["level"] == "SEVERE" and "/map/" not in e["message"]
        and "WebSocket" not in e["message"]]
    assert not errors, errors


TESTS = [a_target_is_placed_and_stands_on_the_glass, a_target_that_is_dragged_moves_on_the_glass,
         a_way_is_gone_with_its_speed, a_target_is_changed_moved_and_removed, all_targets_go_at_once,
         a_target_in_the_middle_of_the_map_has_the_form_and_its_signature, the_buttons_of_the_map_zoom_and_follow,
         rain_is_placed_changed_dragged_and_removed, a_jammer_is_placed_and_fair_weather_ends_it,
         sea_and_wind_are_told, each_malfunction_breaks_the_picture_and_is_mended,
         buttons_stay_where_they_are_whatever_is_told, a_dead_key_does_nothing,
         every_key_of_the_bezel_is_obeyed, the_picture_is_held_and_released, mode_range_width_and_gain_are_obeyed,
         cursor_steerpoint_and_patch_go_where_the_map_says, designate_drop_slew_and_knob_are_obeyed,
         the_clock_freezes_runs_jumps_and_has_a_seed, what_cannot_be_is_said_and_not_sent, the_events_are_saved_as_a_file,
         two_instructors_agree,
         stale_navigation_and_a_lost_connection_are_plain, a_page_that_may_only_listen_tells_nothing,
         the_keyboard_alone_is_enough,
         fingers_pan_zoom_and_place_on_a_tablet, the_page_fits_and_is_calm_where_motion_is_not_wanted,
         the_page_asks_no_other_server_and_has_no_error]


def main():
    missing = web.lacks() or ("" if Glass else "python3-gdal is missing: run make deps")
    if missing:
        return tap.skip_all("the instructor's page in a browser", missing)
    TMP.mkdir(parents=True, exist_ok=True)
    web.make_scene(TMP)
    glass = Glass(BUILD / "bin", TMP / "scene.lmdb", TMP / "glass")
    glass.run("landmass-nav", "--straight", "45.7,11,0,3000,60", "--seconds", 600, "--out", TMP / "nav.log", "--quiet")
    with Server("--image", TMP / "scene.lmdb", "--site", BUILD / "ios", "--log", TMP / "nav.log", "--display",
                f"left:20={TMP}") as server:
        page = Page(server.url)
        page.server = server
        try:
            page.start()
            return tap.run(TESTS, page, glass, before=lambda p, _: p.reset())
        finally:
            page.b.driver.quit()


if __name__ == "__main__":
    sys.exit(main())
