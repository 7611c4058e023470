"""landmass-ios behind a proxy with TLS, which is configured as docs/ios.md says. TAP."""
import json
import os
import pathlib
import re
import shutil
import socket
import ssl
import subprocess
import sys
import textwrap
import time

from server import BUILD, Server
from wire import ask, connect, Page

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "web"))
import browser  # noqa: E402  pylint: disable=wrong-import-position
import tap  # noqa: E402  pylint: disable=wrong-import-position

TMP = (BUILD / "tmp/ios_proxy").resolve()
NAME, TOKEN = "station.example", "0123456789abcdef0123456789abcdef"
TARGET = "712#1E0300014A000000"  # 1810: a latitude of live target 0


def documented(first):
    """The block of docs/ios.md that begins so."""
    text = (browser.ROOT / "docs/ios.md").read_text()
    blocks = map(textwrap.dedent, re.findall(r"(?:^    .*\n)+", text, re.M))
    return next(block for block in blocks if block.startswith(first))


def make_certificate():
    command = documented("openssl req").replace("\\\n", " ")
    subprocess.run(command, shell=True, cwd=TMP, check=True, stderr=subprocess.DEVNULL)
    context = ssl.create_default_context(cafile=TMP / "station.crt")
    return context, NAME


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as s:
        return s.getsockname()[1]


class Proxy:
    """A proxy before a server that asks for a token; both run within `with`."""

    def __init__(self, program, first, around):
        self.program, self.first, self.around = program, first, around

    def __enter__(self):
        self.port, self.tls = free_port(), make_certificate()
        self.host = f"{NAME}:{self.port}"
        (TMP / "token").write_text(TOKEN + "\n")
        self.server = Server("--image", TMP / "scene.lmdb", "--site", BUILD / "ios", "--host", self.host, "--token-file",
                             TMP / "token").start()
        block = documented(self.first).replace("/etc/ssl/station", str(TMP / "station"))
        block = block.replace("127.0.0.1:8470", f"127.0.0.1:{self.server.port}").replace("443", f"127.0.0.1:{self.port}")
        (TMP / "proxy.conf").write_text(self.around(block))
        words = [str(TMP / "proxy.conf")] if self.program == "stunnel" else ["-p", str(TMP), "-c", str(TMP / "proxy.conf")]
        with (TMP / "proxy.said").open("w") as said:
            self.child = subprocess.Popen([self.program, *words], stderr=said, stdout=said)
        for _ in range(100):
            try:
                connect(self.port).close()
                return self
            except OSError:
                time.sleep(0.1)
        raise AssertionError((TMP / "proxy.said").read_text()[-500:])

    def __exit__(self, *_):
        self.child.terminate()
        self.child.wait(timeout=20)
        self.server.stop()

    def ask(self, path, **headers):
        return ask(self.port, path, headers={name: text for name, text in headers.items() if text}, host=self.host, tls=self.tls)

    def page(self, **headers):
        return Page(self.port, headers=headers, host=self.host, tls=self.tls)


def nginx(block):
    user = "user root;" if os.getuid() == 0 else ""
    folders = " ".join(f"{kind}_temp_path {TMP}/temp;" for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
    return f"{user} daemon off; pid {TMP}/pid; error_log stderr; events {{}} http {{ access_log off; {folders}\n{block}}}\n"


PROXIES = [Proxy("stunnel", "[station]", lambda block: f"foreground = yes\npid = {TMP}/pid\n{block}"),
           Proxy("nginx", "map $http_upgrade", nginx)]


def the_token_opens_pages_and_ranges(p):
    assert p.ask("/")[0] == 401 and p.ask("/?token=" + TOKEN[:-1] + "1")[0] == 401
    status, fields, _ = p.ask("/?token=" + TOKEN)
    assert status == 200 and "httponly" in fields["set-cookie"] and "default-src 'none'" in fields["content-security-policy"]
    cookie = f"landmass_token={TOKEN}"
    assert p.ask("/station.json", Cookie=cookie)[0] == 200
    status, fields, body = p.ask("/image", Cookie=cookie, Range="bytes=0-7")
    assert (status, body) == (206, b"LANDMASS") and fields["content-range"].startswith("bytes 0-7/"), (status, fields)


def the_bus_goes_both_ways(p):
    page = p.page(Cookie=f"landmass_token={TOKEN}", Origin=f"https://{p.host}")
    assert page.status == 101, page.status
    assert page.lines(lambda line: " past 7FF#" in line)[-1].endswith("past 7FF#")
    page.send(f"(0.000000) page {TARGET}\n")
    assert page.lines(lambda line: TARGET in line)[-1].endswith(f"loop {TARGET}")
    page.close()


def other_origins_hosts_and_no_token_are_refused(p):
    cookie = f"landmass_token={TOKEN}"
    for origin in ("https://evil.example", f"https://{NAME}", f"https://{p.host}.evil.example", "null"):
        assert p.page(Cookie=cookie, Origin=origin).status == 403, origin
        assert p.ask("/station.json", Cookie=cookie, Origin=origin)[0] == 403, origin
    assert p.page(Origin=f"https://{p.host}").status == 401
    assert ask(p.port, "/", headers={"Cookie": cookie}, host="evil.example", tls=p.tls)[0] == 403
    refused = json.loads(p.server.get("/counters.json", headers={"Cookie": cookie})[2])["refused"]
    assert (refused["other_origin"], refused["no_token"], refused["other_host"]) == (8, 1, 1), refused


def the_instructors_page_works_in_a_browser(p):
    missing = browser.lacks()
    if missing:
        raise tap.Skip(missing)
    b = browser.Browser(f"https://{p.host}/", f"--host-resolver-rules=MAP {NAME} 127.0.0.1", "--ignore-certificate-errors")
    try:
        b.get("?token=" + TOKEN)
        b.until("globalThis.station?.isOpen")
        b.ask("station.commands.sea(5) && 0")
        b.until("station.world.sea?.value === 5")
        b.get("debrief.html")
        b.until("globalThis.debrief?.module")
        assert b.ask("isSecureContext && document.cookie") == "", "a script can read the token"
    finally:
        b.driver.quit()


def main():
    shutil.rmtree(TMP, ignore_errors=True)
    (TMP / "temp").mkdir(parents=True)
    browser.make_scene(TMP)

    def of(proxy, test):
        def run():
            if shutil.which(proxy.program) is None:
                raise tap.Skip(f"{proxy.program} is missing: docs/ios.md")
            with proxy:
                test(proxy)
        run.__name__ = f"{proxy.program}_{test.__name__}"
        return run
    tests = [the_token_opens_pages_and_ranges, the_bus_goes_both_ways, other_origins_hosts_and_no_token_are_refused,
             the_instructors_page_works_in_a_browser]
    return tap.run([of(proxy, test) for proxy in PROXIES for test in tests])


if __name__ == "__main__":
    sys.exit(main())
