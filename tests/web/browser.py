"""A browser that is driven, and what pages of it need: a golden country, a server in node."""
import os
import pathlib
import shutil
import subprocess
import time

try:
    from selenium import webdriver
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    webdriver = ActionChains = By = Keys = None

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("BUILD", "build/bench-linux"))
WAIT_S = 60
SCRIPT_S = 180


def lacks():
    """What is missing on this machine to drive Chromium; '' if nothing."""
    name = "python3-selenium" if webdriver is None else next(
        (name for name in ("chromium", "chromedriver", "node") if shutil.which(name) is None), None)
    return f"{name} is missing: run make deps" if name else ""


def make_scene(folder):
    """A golden country as an image file: 46 N 11 E is in its middle."""
    flash = folder / "golden.flash"
    subprocess.run([BUILD / "bin/tests/zcu102/golden_flash", flash], check=True)
    data = flash.read_bytes()
    offset, size = (int.from_bytes(data[at:at + 8], "little") for at in (32, 40))
    (folder / "scene.lmdb").write_bytes(data[offset:offset + size])


def node(*words):
    """A program of node that prints where it listens, first of all."""
    child = subprocess.Popen(["node", *map(str, words)], stdout=subprocess.PIPE, text=True)
    return child, child.stdout.readline().split()[0]


class Browser:
    def __init__(self, url, *more):
        options = webdriver.ChromeOptions()
        for word in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                     "--window-size=1280,860", *more):
            options.add_argument(word)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(options=options)
        # The driver's own 30 s are short where panels, a server, two browsers and another test share two cores.
        self.driver.set_script_timeout(SCRIPT_S)
        self.url = url

    def get(self, page=""):
        self.driver.get(self.url + page)

    def find(self, name):
        return self.driver.find_element(By.ID, name)

    def run(self, words):
        """Do what statements say."""
        self.driver.execute_script(words)

    def ask(self, expression):
        return self.driver.execute_script(f"return {expression}")

    def comes(self, expression, seconds):
        """Wait until an expression is true; False if it did not become so."""
        end = time.monotonic() + seconds
        while not self.ask(f"!!({expression})"):
            if time.monotonic() > end:
                return False
            time.sleep(0.05)
        return True

    def until(self, expression):
        assert self.comes(expression, WAIT_S), f"{expression} is not true after {WAIT_S} s"

    def press(self, *keys):
        chain = ActionChains(self.driver)
        for key in keys:
            chain = chain.key_down(key)
        for key in reversed(keys):
            chain = chain.key_up(key)
        chain.perform()
