"""Firefox that is driven by WebDriver BiDi (W3C) over its own socket: Debian has no geckodriver."""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "ios"))
from wire import Page  # noqa: E402  pylint: disable=wrong-import-position

WAIT_S = 60
# It looks for nothing outside.
PREFERENCES = {"services.settings.server": "data:,", "app.normandy.enabled": False, "app.update.enabled": False,
               "network.captive-portal-service.enabled": False, "network.connectivity-service.enabled": False,
               "datareporting.policy.dataSubmissionEnabled": False, "browser.safebrowsing.downloads.remote.enabled": False}


def lacks():
    """What is missing on this machine; '' if nothing."""
    name = next((name for name in ("firefox-esr", "node") if shutil.which(name) is None), None)
    return f"{name} is missing, which make deps does not install: apt install {name}" if name else ""


class Firefox:
    """A browser with a page, within `with`."""

    def __init__(self, url):
        self.url, self.number, self.profile = url, 0, pathlib.Path(tempfile.mkdtemp(prefix="landmass-firefox-"))
        (self.profile / "user.js").write_text(
            "".join(f"user_pref({json.dumps(name)}, {json.dumps(value)});\n" for name, value in PREFERENCES.items()))
        with (self.profile / "said").open("w") as said:
            self.child = subprocess.Popen(["firefox-esr", "--headless", "--no-remote", "--profile", self.profile,
                                           "--remote-debugging-port", "0"], stdout=said, stderr=said)

    def _port(self):
        """Where it listens, which it says."""
        end = time.monotonic() + WAIT_S
        while time.monotonic() < end and self.child.poll() is None:
            found = re.search(r"WebDriver BiDi listening on ws://127\.0\.0\.1:(\d+)", (self.profile / "said").read_text())
            if found:
                return int(found[1])
            time.sleep(0.1)
        raise AssertionError("firefox does not listen: " + (self.profile / "said").read_text()[-500:])

    def __enter__(self):
        self.socket = Page(self._port(), "/session", protocol=None)
        self.socket.socket.settimeout(WAIT_S)
        self.do("session.new", capabilities={})
        self.context = self.do("browsingContext.getTree")["contexts"][0]["context"]
        return self

    def __exit__(self, *_):
        self.child.kill()
        self.child.wait()
        shutil.rmtree(self.profile, ignore_errors=True)

    def do(self, method, **params):
        """A command and its result; what happens meanwhile is passed over."""
        self.number += 1
        self.socket.send(json.dumps({"id": self.number, "method": method, "params": params}))
        while True:
            answer = json.loads(self.socket.message()[1])
            if answer.get("id") == self.number:
                assert answer["type"] == "success", answer
                return answer["result"]

    def get(self, page=""):
        self.do("browsingContext.navigate", context=self.context, url=self.url + page, wait="complete")

    def run(self, words):
        """Do what statements say."""
        self.ask(f"(() => {{ {words} }})()")

    def ask(self, expression):
        """The value of an expression, or of the promise that it is."""
        answer = self.do("script.evaluate", expression=f"(async () => JSON.stringify(await ({expression}) ?? null))()",
                         target={"context": self.context}, awaitPromise=True)
        assert answer["type"] == "success", answer["exceptionDetails"]["text"]
        return json.loads(answer["result"]["value"])

    def until(self, expression):
        end = time.monotonic() + WAIT_S
        while not self.ask(f"!!({expression})"):
            assert time.monotonic() < end, f"{expression} is not true after {WAIT_S} s"
            time.sleep(0.05)

    def _act(self, source, *actions):
        self.do("input.performActions", context=self.context, actions=[{**source, "actions": list(actions)}])

    def press(self, key):
        self._act({"type": "key", "id": "keys"}, {"type": "keyDown", "value": key}, {"type": "keyUp", "value": key})

    def click(self, selector):
        """By the mouse, in the middle of an element."""
        x, y = self.ask(f"(() => {{ const e = document.querySelector(\"{selector}\"); e.scrollIntoView({{block: 'center'}}); "
                        "const r = e.getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()")
        self._act({"type": "pointer", "id": "mouse"}, {"type": "pointerMove", "x": round(x), "y": round(y)},
                  {"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0})
