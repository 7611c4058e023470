"""landmass-ios as browsers meet it, and as those meet it who mean no good. TAP."""
import os
import pathlib
import shutil
import subprocess
import sys
import time

import server
from server import BUILD
from wire import connect, Page, BINARY

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "web"))
import browser  # noqa: E402  pylint: disable=wrong-import-position
import tap  # noqa: E402  pylint: disable=wrong-import-position

TMP = BUILD / "tmp/ios_server"
TOKEN = "0123456789abcdef0123456789abcdef"
TARGET = "712#1E0300014A000000"  # 1810, LONG: a latitude of live target 0
RAIN = "708#1E02000142300000"    # 1800


class Server(server.Server):
    def __init__(self, *words):
        super().__init__("--image", TMP / "scene.lmdb", "--site", TMP / "site", *words)


def is_past_end(line):
    return " past 7FF#" in line


def makes_ready():
    shutil.rmtree(TMP, ignore_errors=True)
    (TMP / "site/web").mkdir(parents=True)
    (TMP / "recordings").mkdir()
    browser.make_scene(TMP)
    (TMP / "site/index.html").write_text("<title>station</title>")
    (TMP / "site/page.mjs").write_text("export const one = 1;\n")
    (TMP / "site/web/a.wasm").write_bytes(b"\0asm")
    (TMP / "outside.txt").write_text("secret")
    os.symlink(TMP.resolve() / "outside.txt", TMP / "site/link.txt")
    (TMP / "recordings/flight.log").write_text("(1700000000.000000) can0 40C#\n(1700000012.500000) can0 40C#\n")
    (TMP / "token").write_text(TOKEN + "\n")


def test_files_come_with_their_types_and_what_keeps_them_apart():
    with Server() as s:
        for path, kind in (("/", "text/html"), ("/page.mjs", "text/javascript"), ("/web/a.wasm", "application/wasm")):
            status, fields, body = s.get(path)
            assert status == 200 and fields["content-type"].startswith(kind) and body, path
            assert "default-src 'none'" in fields["content-security-policy"]
            assert fields["x-content-type-options"] == "nosniff" and fields["referrer-policy"] == "no-referrer"
            assert len(body) == int(fields["content-length"])
        assert s.get("/page.mjs", method="HEAD")[2] == b""
        assert s.get("/page.mjs", method="HEAD")[1]["content-length"] == "22"


def test_nothing_outside_the_site_is_served():
    with Server() as s:
        for path in ("/../outside.txt", "/%2e%2e/outside.txt", "/web/../../outside.txt", "/..%2foutside.txt", "/link.txt", "/.hidden",
                     "//etc/passwd", "/site", "/web", "/a b", "/\u00e4", "/recordings/../token", "/recordings/..%2ftoken", "/x" * 300):
            status, _, body = s.get(path)
            assert status in (0, 400, 403, 404, 414) and b"secret" not in body and TOKEN.encode() not in body, (path, status)
        assert s.get("/")[0] == 200


def test_the_image_comes_in_ranges():
    whole = (TMP / "scene.lmdb").read_bytes()
    with Server() as s:
        for text, status, part in (("bytes=0-9", 206, whole[:10]), ("bytes=100-", 206, whole[100:]), ("bytes=-7", 206, whole[-7:]),
                                   (f"bytes={len(whole) - 3}-{len(whole) + 99}", 206, whole[-3:]), (f"bytes={len(whole)}-", 416, b""),
                                   ("bytes=9-1", 200, whole), ("lines=1-2", 200, whole), ("bytes=x", 200, whole)):
            got, fields, body = s.get("/image", headers={"Range": text})
            assert (got, body) == (status, part), text
            if status == 206:
                first = whole.index(part) if len(part) > 100 else int(fields["content-range"].split(" ")[1].split("-")[0])
                assert fields["content-range"] == f"bytes {first}-{first + len(part) - 1}/{len(whole)}"


def test_other_hosts_origins_and_methods_are_refused_and_counted():
    with Server("--host", "station.example") as s:
        own = f"http://127.0.0.1:{s.port}"
        assert s.get("/", host="evil.example")[0] == 403
        assert s.get("/", host=f"127.0.0.1:{s.port}.evil.example")[0] == 403
        assert s.get("/", host="station.example")[0] == 200
        assert s.get("/", headers={"Origin": own})[0] == 200
        for origin in ("http://evil.example", "null", own + ".evil.example", "https://", f"http://127.0.0.1:{s.port + 1}"):
            assert s.get("/", headers={"Origin": origin})[0] == 403, origin
        assert Page(s.port, headers={"Origin": "http://evil.example"}).status != 101
        assert Page(s.port, host="evil.example").status != 101
        assert Page(s.port, headers={"Origin": own}).status == 101
        assert s.get("/", method="POST", headers={"Content-Length": "3"}, body=b"abc")[0] == 405
        refused = s.json("/counters.json")["refused"]
        assert refused["other_host"] == 3 and refused["other_origin"] == 6 and refused["method"] == 1, refused


def test_two_instructors_hear_the_same_and_a_third_hears_what_was():
    with Server("--out", TMP / "out.log") as s:
        one, two = Page(s.port), Page(s.port)
        one.lines(is_past_end)
        two.lines(is_past_end)
        one.send(f"(0.000000) page {TARGET}\n(0.000000) page {RAIN}\n")
        two.send(f"(0.000000) page {TARGET}\n")
        heard = [[line.split(" ", 1)[1] for line in page.lines(lambda line: False, 1)] for page in (one, two)]
        assert heard[0] == heard[1] == [f"loop {TARGET}", f"loop {RAIN}", f"loop {TARGET}"], heard
        three = Page(s.port).lines(is_past_end)
        assert [line.split(" ", 1)[1] for line in three] == [f"past {RAIN}", f"past {TARGET}", "past 7FF#"], three
        stamps = [float(line[1:].split(")")[0]) for line in three[:2]]
        assert abs(stamps[0] - time.time()) < 60, "frames carry the server's time, not the page's"
        one.close()  # without a word
        two.send(f"(0.000000) page {RAIN}\n")
        assert len(two.lines(lambda line: RAIN in line)) == 1
    assert s.status == 0
    assert [line.split()[2] for line in (TMP / "out.log").read_text().splitlines()] == [TARGET, RAIN, TARGET, RAIN]


def test_what_a_page_may_not_send_is_refused_with_a_word():
    with Server() as s:
        page = Page(s.port)
        page.lines(is_past_end)
        for text in ("(0.000000) p 40C#1E03000100000000", "(0.000000) p 00000712#1E03000100000000", "(0.000000) p 712#R", "(0.000000) p 712#1E",
                     "712#1E03000100000000", "(0.000000) p 712##11E03000100000000", "x" * 5000, "(0.000000) p 20000004#00"):
            page.send(text + "\n")
            assert page.lines(lambda line: True)[0].startswith("! "), text
        page.send(b"\xff" * 10, BINARY)
        assert page.lines(lambda line: True)[0].startswith("! ")
        page.send(("(0.000000) p " + TARGET + "\n") * 3000)  # longer than a message may be
        assert page.lines(lambda line: True)[0].startswith("! ")
        counters = s.json("/counters.json")
        assert counters["frames_sent"] == 0 and sum(counters["refused"].values()) == 10, counters
    with Server("--listen-only") as s:
        page = Page(s.port)
        page.lines(is_past_end)
        page.send(f"(0.000000) p {TARGET}\n")
        assert page.lines(lambda line: True)[0].startswith("! ")


def test_a_flood_is_cut_and_the_others_go_on():
    with Server() as s:
        flood, other = Page(s.port), Page(s.port)
        other.lines(is_past_end)
        for _ in range(10):
            flood.send(f"(0.000000) p {TARGET}\n" * 1000)
        heard = other.lines(lambda line: False, 2)
        sent = s.json("/counters.json")
        assert 2000 <= len(heard) <= 6000 and len(heard) == sent["frames_sent"], len(heard)
        assert sent["refused"]["too_fast"] == 10000 - len(heard)


def test_a_page_that_does_not_read_is_closed_and_holds_nobody_up():
    with Server() as s:
        deaf, other = Page(s.port), Page(s.port)
        other.lines(is_past_end)
        begun, heard = time.time(), 0
        writers = [Page(s.port) for _ in range(12)]
        while time.time() - begun < 40 and s.json("/counters.json")["refused"]["slow_pages"] == 0:
            for writer in writers:
                writer.send(f"(0.000000) p {TARGET}\n" * 1000)
            heard += len(other.lines(lambda line: False, 0.3))
            for writer in writers:
                writer.lines(lambda line: False, 0.01)
        counters = s.json("/counters.json")
        assert counters["refused"]["slow_pages"] == 1, counters
        other.send(f"(0.000000) p {RAIN}\n")
        assert other.lines(lambda line: RAIN in line, 10)[-1].endswith(RAIN)
        assert heard > 10000
        deaf.close()


def test_there_is_an_end_to_the_pages_it_takes():
    with Server() as s:
        pages = [Page(s.port) for _ in range(64)]
        assert all(page.status == 101 for page in pages)
        assert Page(s.port).status != 101
        pages[0].close()
        time.sleep(0.3)
        assert Page(s.port).status == 101


def test_half_requests_and_noise_leave_it_serving():
    with Server() as s:
        idle = [connect(s.port) for _ in range(100)]
        for number, one in enumerate(idle):
            one.sendall([b"GET / HT", b"\0\xff\r\n\r\n", b"GET /\r\n\r\n", b"GET / HTTP/1.1\r\nHost: " + b"a" * 20000][number % 4])
        assert s.get("/")[0] == 200
        for one in idle:
            one.close()
        assert s.get("/image", headers={"Range": "bytes=0-7"})[2] == b"LANDMASS"


def test_a_token_is_asked_for_where_there_is_one():
    with Server("--token-file", TMP / "token") as s:
        assert s.get("/")[0] == 401 and s.get("/image")[0] == 401
        assert Page(s.port).status != 101
        assert s.get("/?token=" + TOKEN[:-1] + "0")[0] == 401
        status, fields, _ = s.get("/?token=" + TOKEN)
        assert status == 200 and "httponly" in fields["set-cookie"] and "samesite=strict" in fields["set-cookie"]
        assert s.get("/", headers={"Cookie": f"a=b; landmass_token={TOKEN}"})[0] == 200
        assert s.get("/", headers={"Authorization": f"Bearer {TOKEN}"})[0] == 200
        assert Page(s.port, headers={"Cookie": f"landmass_token={TOKEN}"}).status == 101
    for words in (("--bind", "0.0.0.0"), ("--token-file", TMP / "site/page.mjs"), ("--site", TMP / "nowhere")):
        done = subprocess.run([*Server(*words).command, "--port", "0", "--seconds", "0.1"], stderr=subprocess.PIPE, text=True, check=False)
        assert done.returncode != 0 and done.stderr.startswith("landmass-ios: "), (words, done.stderr)


def test_recordings_are_listed_and_served():
    with Server("--recordings", TMP / "recordings", "--display", f"left:20={TMP}/recordings") as s:
        listed = s.json("/recordings.json")
        assert [one["name"] for one in listed] == ["flight.log", "left/flight.log"], listed
        assert listed[0]["start_utc"] == "2023-11-14T22:13:20Z" and listed[0]["seconds"] == 12.5 and listed[0]["bytes"] == 60
        assert s.get("/recordings/flight.log")[2] == (TMP / "recordings/flight.log").read_bytes()
        assert s.get("/recordings/left%2Fflight.log", headers={"Range": "bytes=1-4"})[2] == b"1700"
        assert s.get("/recordings/none.log")[0] == 404 and s.get("/recordings/right/flight.log")[0] == 404
        station = s.json("/station.json")
        assert station["displays"] == [{"name": "left", "node": 20, "recording": None}] and station["may_send"] is True


def test_a_recording_is_followed_part_by_part_as_it_grows():
    folder = TMP / "grows"
    folder.mkdir()

    def write(name, text):
        with (folder / name).open("a") as out:
            out.write(text)

    def link(name):
        os.symlink(name, folder / "next")
        os.replace(folder / "next", folder / "current.log")

    with Server("--display", f"left={folder}") as s:
        assert Page(s.port, "/display/left", "landmass-recording").lines(lambda line: True, 1) == ["closed"]
        write("flight-00007-000.log", "(1.0) unit 1\n(1.1) unit 2\n(1.2) un")
        link("flight-00007-000.log")
        page = Page(s.port, "/display/left", "landmass-recording")
        assert page.lines(lambda line: False, 0.5) == ["(1.0) unit 1", "(1.1) unit 2"]
        write("flight-00007-000.log", "it 3\n")
        assert page.lines(lambda line: True) == ["(1.2) unit 3"]
        write("flight-00007-001.log", "(2.0) unit 4\n")
        link("flight-00007-001.log")
        assert page.lines(lambda line: True) == ["(2.0) unit 4"]
        assert Page(s.port, "/display/left", "landmass-recording").lines(lambda line: "unit 4" in line)[0] == "(1.0) unit 1"
        write("flight-00008-000.log", "(9.0) unit 1\n")
        link("flight-00008-000.log")
        assert page.lines(lambda line: False, 2) == ["closed"]


def test_a_log_is_told_in_its_own_time():
    log = TMP / "two.log"
    log.write_text("(5.000000) can0 40C#0102000041380000\n(6.000000) can0 40D#0102000041380000\n")
    with Server("--log", log) as s:
        page = Page(s.port)
        heard = page.lines(lambda line: "40D#" in line, 4)
        stamps = [float(line[1:].split(")")[0]) for line in heard if " log " in line]
        assert len(stamps) in (1, 2) and (len(stamps) == 1 or abs(stamps[1] - stamps[0] - 1) < 0.3), heard


def test_the_map_is_drawn_where_the_database_lies():
    with Server() as s:
        bounds = s.json("/map.json")
        assert bounds["west"] < 11 < bounds["east"] and bounds["south"] < 46 < bounds["north"]
        status, fields, body = s.get("/map/12/2173/1453.png")
        assert status == 200 and fields["content-type"] == "image/png" and body[:8] == b"\x89PNG\r\n\x1a\n"
        assert s.get("/map/12/0/0.png")[0] == 204
        for path in ("/map/12/4096/0.png", "/map/23/0/0.png", "/map/-1/0/0.png", "/map/12/1/x.png", "/map/12/1.png"):
            assert s.get(path)[0] in (400, 404), path


def main():
    makes_ready()
    return tap.run([test for name, test in globals().items() if name.startswith("test_")])


if __name__ == "__main__":
    sys.exit(main())
