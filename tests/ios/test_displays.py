"""Two panels in flight, landmass-ios, two instructors and a repeater in Chromium: the page changes from one display to the
other and has each time the pictures of that panel; instructors who wish different things at one moment end up at one. TAP.

The left panel obeys controls, the right one does not and has another glass. What they report of themselves comes by the
log, as landmass-sim says it on the same flight."""
import json
import pathlib
import random
import shutil
import subprocess
import sys
import threading
import time

from canvas import CANVAS_SUM
from panel import Panel
from server import BUILD, Server

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "web"))
import browser  # noqa: E402  pylint: disable=wrong-import-position
import tap  # noqa: E402  pylint: disable=wrong-import-position

TMP = (BUILD / "tmp/ios_displays").resolve()
PANELS = {"left": (20, {}), "right": (21, {"can_controls": "off", "glass_picture": "640x480"})}
REPORTED = {20: "0 range 10\n", 21: "0 range 40\n0.5 gmt\n"}  # what the two nodes show of themselves
FRAMES, ROUNDS, SECONDS = 250, 6, 600
NOTE = CANVAS_SUM + """
repeater.onPicture = ({picture, steps}) => sums.set(picture, {steps, sum: sumOf()});"""
# Two wishes for each thing, which stand side by side.
WISHES = {
    "sea": ("c.sea({})", (2, 7), "w.sea?.value"),
    "wind": ("c.wind({})", (45, 200), "w.wind?.value"),
    "rain 1": ("c.circle('rain', 1, {{latitude: 46.1, longitude: 11, radiusM: {}, rateMmH: 40}})", (3000, 8000),
               "Math.round(w.rain.get(1)?.radiusM)"),
    "malfunction 1": ("c.malfunction(1, {})", (6, 18), "w.malfunctions.get(1)?.amount"),
    "target 200": ("c.keepTarget(new T.Target({{number: 200, latitude: 46.1, longitude: 11, kind: {}, speedMs: 0, courseDeg: 0, "
                   "heightM: null, rcsDbsm: 50, signature: 0, route: []}}))", (3, 13), "w.targets.get(200)?.kind"),
}


class Instructor(browser.Browser):
    """The instructor's page in a browser of its own."""

    def start(self):
        self.get()
        self.until("globalThis.station?.isOpen && station.world.ownAircraft()")
        return self

    def act(self, words, at_ms=None):
        """Do something, at once or at `at_ms` of the machine's clock. A page that is hidden may wait a minute for a timer."""
        wait = f"await new Promise((go) => setTimeout(go, {at_ms} - Date.now())); " if at_ms else ""
        said = self.driver.execute_async_script(
            "const done = arguments[0], c = station.commands; (async () => {"
            f"const T = await import('./targets.mjs'); {wait}{words}"
            "})().then(() => done(''), (error) => done(String(error)))")
        assert said == "", said

    def shown(self):
        """What this page shows of each thing that is wished for."""
        looks = ", ".join(f"'{name}': {look}" for name, (_, _, look) in WISHES.items())
        return self.ask(f"((w) => ({{{looks}}}))(station.world)")

    def kept(self):
        return set(self.ask("station.keeper.keys"))


def reports():
    """A flight, and what displays of two nodes say of themselves on it, as one log."""
    nav, lines = TMP / "nav.log", []

    def run(program, *words):
        subprocess.run([BUILD / "bin" / program, *map(str, words), "--quiet"], check=True, stdout=subprocess.DEVNULL)

    def take(path):
        """Lines by their time since the first."""
        stamped = [(float(line[1:].split(")")[0]), line.split(") ")[1]) for line in path.read_text().splitlines()]
        lines.extend((at - stamped[0][0], line) for at, line in stamped)
    run("landmass-nav", "--straight", "45.8,11,0,3000,60", "--seconds", SECONDS, "--out", nav)
    take(nav)
    for node, keys in REPORTED.items():
        (TMP / "script").write_text(keys)
        run("landmass-sim", "--db", TMP / "scene.lmdb", "--bus", nav, "--seconds", 120, "--node", node, "--reports", "--bus-out",
            TMP / "told.log", "--script", TMP / "script")
        take(TMP / "told.log")
    (TMP / "bus.log").write_text("".join(f"({at:.6f}) {line}\n" for at, line in sorted(lines)))
    return TMP / "bus.log"


# ---- tests ----

def both_displays_are_listed_with_their_words(left, _right, _panels):
    left.find("tab-displays").click()
    words = "document.getElementById('display-list').textContent"
    left.until(f"/left .*10 NM.*right .*GMT.*40 NM/.test({words})")
    links = left.ask("[...document.querySelectorAll('#display-list a')].map((a) => a.href.split('/').pop())")
    assert links == ["repeater.html?display=left", "repeater.html?display=right"], links


def watch(b, name):
    """Choose a display by the keyboard, in the page's own list. Returns the pictures of the canvas from when it is live."""
    b.find("display").send_keys(name)
    b.until(f"repeater.display.name === '{name}' && document.getElementById('over').textContent === ''")
    b.run("repeater.player.ask('every', {isEvery: true})")
    time.sleep(0.5)
    b.run("sums.clear()")
    b.until(f"sums.size >= {FRAMES}")
    shown = dict(b.ask("[...sums]"))
    b.run("repeater.player.ask('every', {isEvery: false})")  # a busy machine cannot keep up with each picture for long
    return shown


def the_page_changes_between_displays_and_has_the_pictures_of_each(left, right, panels):
    here = left.driver.current_window_handle
    left.find("tab-displays").click()
    left.until("document.querySelectorAll('#display-list a').length === 2")
    left.driver.find_element("css selector", "#display-list li:nth-child(2) a").click()
    repeater = next(w for w in left.driver.window_handles if w != here)
    left.driver.switch_to.window(repeater)
    left.until("globalThis.repeater?.player")
    assert left.ask("repeater.display.name") == "right"
    left.run(NOTE)
    sizes, compared = {}, []
    for name in ("left", "right", "left"):
        shown = watch(left, name)
        panels[name].check(shown)
        compared.append(len(shown))
        sizes[name] = left.ask("['width', 'height'].map((side) => document.getElementById('glass')[side])")
        if name == "right":  # a command that only the left one obeys
            assert len({of["sum"] for of in shown.values()}) > FRAMES // 3
            right.act("const {controlFrames: C} = await import('./frames.mjs'); c.control(C.patch(46.05, 11.15, 5))")
    left.until("document.getElementById('words').textContent.startsWith('SAR')")
    assert sizes == {"left": [512, 512], "right": [640, 480]}, sizes
    print(f"# {compared} pictures compared")
    left.driver.close()
    left.driver.switch_to.window(here)


def wish(instructors, round_number):
    """Each instructor's wish for everything, at one moment, in an order of his own."""
    at_ms = 1000 * time.time() + 700

    def ask(n):
        acts = [act.format(values[n ^ round_number & 1]) for act, values, _ in WISHES.values()]
        random.Random(2 * round_number + n).shuffle(acts)
        instructors[n].act("; ".join(acts), at_ms)
    threads = [threading.Thread(target=ask, args=(n,)) for n in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def settled(left, right):
    """What both pages show, where it is the same, somebody's wish, and kept by one page alone; None otherwise."""
    shown, also, kept, also_kept = left.shown(), right.shown(), left.kept(), right.kept()
    is_wish = all(shown[name] in values for name, (_, values, _) in WISHES.items())
    is_kept = all((name in kept) != (name in also_kept) for name in WISHES)
    return shown if shown == also and is_wish and is_kept else None


def two_instructors_at_one_moment_agree(left, right, _panels):
    """They end up at one wish, which stays while it is repeated twice. A busy page may hear a wish late and leave its own."""
    won = [0, 0]
    for n in range(ROUNDS):
        wish((left, right), n)
        end, held, since = time.monotonic() + 30, None, time.monotonic()
        while held is None or time.monotonic() < since + 2.2:
            assert time.monotonic() < end, (left.shown(), right.shown(), left.kept(), right.kept())
            time.sleep(0.1)
            now = settled(left, right)
            if now is None or now != held:
                held, since = now, time.monotonic()
        shown = held
        for name, (_, values, _) in WISHES.items():
            won[values.index(shown[name]) ^ n & 1] += 1
    print(f"# {sum(won)} wishes: {won[0]} of the one instructor, {won[1]} of the other stayed")


def both_panels_had_one_sender_and_fly_again(_left, _right, panels):
    for name, panel in panels.items():
        assert panel.stop() == 0
        log = next((TMP / name / "recordings").glob("*-000.log"))
        said = json.loads(subprocess.run([BUILD / "bin/landmass-sim", "--db", TMP / "scene.lmdb", "--replay", log, "--json", "-"],
                                         check=True, capture_output=True, text=True).stdout)["report"]
        replay, weather = said["replay"], said["weather"]
        assert replay["departures"] == replay["checks_failed"] == replay["reads_differ"] == 0 < replay["checks"], replay
        assert weather["sets"] > 2 * ROUNDS and weather["torn"] == weather["frames_of_a_second_sender"] == 0, weather
        print(f"# {name}: {weather['sets']} sets of weather, one sender")


TESTS = [both_displays_are_listed_with_their_words, the_page_changes_between_displays_and_has_the_pictures_of_each,
         two_instructors_at_one_moment_agree, both_panels_had_one_sender_and_fly_again]


def main():
    missing = browser.lacks()
    if missing:
        return tap.skip_all("two displays and two instructors in a browser", missing)
    shutil.rmtree(TMP, ignore_errors=True)
    for name in PANELS:
        (TMP / name / "recordings").mkdir(parents=True)
    browser.make_scene(TMP)
    displays = [word for name, (node, _) in PANELS.items() for word in ("--display", f"{name}:{node}={TMP}/{name}/recordings")]
    with Server("--image", TMP / "scene.lmdb", "--site", BUILD / "ios", "--log", reports(), *displays) as server:
        panels, instructors = {}, []
        try:
            for name, (_, options) in PANELS.items():
                panels[name] = Panel(server.port, TMP / name, TMP / "scene.lmdb", **options)
            for _ in range(2):
                instructors.append(Instructor(server.url))
                instructors[-1].start()
            return tap.run(TESTS, *instructors, panels)
        finally:
            for panel in panels.values():
                panel.child.kill()
            for b in instructors:
                b.driver.quit()


if __name__ == "__main__":
    sys.exit(main())
