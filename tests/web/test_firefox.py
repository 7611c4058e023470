"""The page in Firefox, where that is installed: golden pictures, a flight, keys, and nothing from elsewhere. TAP."""
import sys

import tap
from browser import ROOT, node
from firefox import Firefox, lacks
from site_of_tests import SITE, STEPS, make_site


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


TESTS = [golden_pictures_are_those_of_the_pc, the_page_flies_obeys_its_keys_and_asks_no_other_server,
         the_start_and_a_step_are_measured]


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
