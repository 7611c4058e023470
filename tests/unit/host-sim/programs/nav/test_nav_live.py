#!/usr/bin/env python3
"""landmass-nav with a flight simulator, from datagram to log: a recorded FlightGear, a made X-Plane that is asked, and hostile
neighbours, over ports of this machine.

TAP on standard output. BUILD names the build's folder.
"""

import json
import os
import re
import select
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import traceback

BUILD = os.environ.get("BUILD", "build/bench-linux")
PROGRAM = os.path.join(BUILD, "bin/landmass-nav")
RECORDED = "tests/unit/host-sim/nav/flightgear.txt"
LINE = re.compile(r"\((\d+\.\d{6})\) can0 ([0-9A-F]{3})#([0-9A-F]*)$")
HERE = "127.0.0.1"


class Skip(Exception):
    pass


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.bind((HERE, 0))
        return s.getsockname()[1]


class Nav:
    """landmass-nav at work, heard at `port`."""

    def __init__(self, simulator, *options):
        self.port = free_port()
        self.folder = tempfile.TemporaryDirectory()
        self.log = os.path.join(self.folder.name, "flight.log")
        self.json = os.path.join(self.folder.name, "report.json")
        self.process = subprocess.Popen([PROGRAM, simulator, str(self.port), "--out", self.log, "--json", self.json, *options],
                                        stdin=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.wait_for("waiting for the simulator")

    def wait_for(self, words):
        said = b""
        until = time.monotonic() + 20
        while words.encode() not in said:
            ready, _, _ = select.select([self.process.stderr], [], [], max(0, until - time.monotonic()))
            byte = os.read(self.process.stderr.fileno(), 1) if ready else b""
            assert byte, "did not say %r but %r" % (words, said)
            said += byte

    def end(self, code=0):
        self.process.send_signal(signal.SIGINT)
        said = self.process.communicate(timeout=20)[1].decode()
        assert self.process.returncode == code, "exit code %d: %s" % (self.process.returncode, said)
        with open(self.json) as file:
            report = json.load(file)["report"]
        frames = []
        if os.path.exists(self.log):
            with open(self.log) as file:
                for line in file:
                    match = LINE.match(line.rstrip("\n"))
                    assert match, "no line of a log: %r" % line
                    frames.append((float(match[1]), int(match[2], 16), bytes.fromhex(match[3])))
        self.folder.cleanup()
        return report, frames, said


def sender(address=HERE):
    s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    s.bind((address, 0))
    return s


def recorded():
    with open(RECORDED, encoding="ascii") as file:
        for line in file:
            if not line.startswith("#"):
                seconds, text = line.split(" ", 1)
                yield float(seconds), text.encode()


def value(data):
    return struct.unpack(">f", data[4:])[0]


def a_recorded_flight_of_flightgear_reaches_the_log():
    nav = Nav("--flightgear", "--position", "float")
    begin, last = time.monotonic(), 0
    with sender() as s:
        for seconds, text in recorded():
            time.sleep(max(0, begin + seconds - time.monotonic()))
            s.sendto(text, (HERE, nav.port))
            last += 1
    nav.wait_for("paused")
    nav.wait_for("flying")
    nav.wait_for("silent")
    report, frames, _ = nav.end()
    assert report["datagrams"] == report["used"] == last and report["pauses"] == 1, report
    assert report["silences"] >= 1 and report["frames"] == len(frames) > 1000 and report["frames_lost"] == 0, report
    latitudes = [value(data) for _, name, data in frames if name == 1036]
    assert all(abs(degrees - 46) < 0.05 for degrees in latitudes) and len(latitudes) > 20, latitudes
    assert all(0 <= b[0] - a[0] for a, b in zip(frames, frames[1:]))


def hostile_neighbours_are_counted_and_do_no_harm():
    nav = Nav("--flightgear", "--from", HERE)
    text = next(recorded())[1]
    with sender() as s, sender("127.0.0.2") as other:
        for i in range(40):
            s.sendto(text.replace(text.split(b" ")[1].split(b",")[0], b"%d" % (i + 1), 1), (HERE, nav.port))
            other.sendto(text, (HERE, nav.port))
            s.sendto(os.urandom(200), (HERE, nav.port))
            s.sendto(b"landmass1 " + b"9" * 5000, (HERE, nav.port))
            s.sendto(b"", (HERE, nav.port))
            time.sleep(0.02)
    report, frames, _ = nav.end()
    assert report["used"] == 40 and report["left_out"]["other_sender"] == 40, report
    assert report["left_out"]["foreign"] == 80 and report["left_out"]["malformed"] == 40, report
    assert len(frames) > 200


def targets_on_routes_are_told_beside_a_simulator():
    with tempfile.TemporaryDirectory() as folder:
        routes = os.path.join(folder, "drill.routes")
        with open(routes, "w") as file:
            file.write("target 5 3\n at 0 46.1 11\n speed 20 46.2 11\n")
        nav = Nav("--flightgear", "--live-routes", routes)
        begin = time.monotonic()
        with sender() as s:
            for seconds, text in recorded():
                if seconds > 2.5:
                    break
                time.sleep(max(0, begin + seconds - time.monotonic()))
                s.sendto(text, (HERE, nav.port))
        _, frames, _ = nav.end()
        told = [struct.unpack(">i", data[4:])[0] * 1e-7 for _, name, data in frames if name == 1810 and data[2] == 5]
        assert len(told) >= 2 and all(46.1 <= degrees < 46.11 for degrees in told), told


def xplane_is_asked_and_answers():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        try:
            s.bind(("127.0.0.9", 49000))
        except OSError as why:
            raise Skip("port 49000 of 127.0.0.9: %s" % why)
        s.settimeout(10)
        nav = Nav("--xplane", "--ask", "127.0.0.9", "--position", "float")
        asked = [s.recvfrom(2000) for _ in range(3)]
        assert [packet[:5] for packet, _ in asked] == [b"RPOS\0", b"RREF\0", b"RREF\0"], asked
        to = (HERE, nav.port)
        numbers = [struct.unpack_from("<i", packet, 9)[0] for packet, _ in asked[1:]]
        for i in range(50):
            s.sendto(b"RPOS4" + struct.pack("<3d10f", 11 + i * 1e-5, 46, 3000, 500, 1, 90, 0, 77, 0, 0, 0, 0, 0), to)
            s.sendto(b"RREF," + struct.pack("<ifif", numbers[0], 0, numbers[1], 86), to)
            time.sleep(0.02)
        report, frames, _ = nav.end()
        stopped = [s.recvfrom(2000)[0] for _ in range(3)]
    assert stopped[0] == b"RPOS\0000\0" and all(packet[5:9] == b"\0\0\0\0" for packet in stopped[1:]), stopped
    assert report["used"] == 50 and report["left_out"]["foreign"] == 0, report
    names = {name: value(data) for _, name, data in frames if name not in (1200, 1206)}
    assert abs(names[1069] - 86) < 1e-3 and abs(names[1121] - 4) < 1e-3 and abs(names[1133] - 90) < 1e-3, names


def a_run_without_a_usable_datagram_fails_and_says_what_to_do():
    nav = Nav("--flightgear")
    _, frames, said = nav.end(1)
    assert "no datagram came" in said and not frames, said
    nav = Nav("--xplane")
    with sender() as s:
        s.sendto(b"DATA*" + bytes(36), (HERE, nav.port))
        time.sleep(0.2)
    _, _, said = nav.end(1)
    assert "rows 17, 20 and 21" in said, said


def a_port_that_is_taken_is_refused():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.bind((HERE, 0))
        done = subprocess.run([PROGRAM, "--flightgear", str(s.getsockname()[1]), "--seconds", "1"], capture_output=True, timeout=20)
    assert done.returncode == 1 and b"choose another port" in done.stderr, done


TESTS = [
    a_recorded_flight_of_flightgear_reaches_the_log,
    hostile_neighbours_are_counted_and_do_no_harm,
    targets_on_routes_are_told_beside_a_simulator,
    xplane_is_asked_and_answers,
    a_run_without_a_usable_datagram_fails_and_says_what_to_do,
    a_port_that_is_taken_is_refused,
]


def main():
    print("1..%d" % len(TESTS))
    failures = 0
    for number, test in enumerate(TESTS, 1):
        try:
            test()
            print("ok %d - %s" % (number, test.__name__))
        except Skip as why:
            print("ok %d - %s # SKIP %s" % (number, test.__name__, why))
        except Exception:
            failures += 1
            for line in traceback.format_exc().splitlines():
                print("# " + line)
            print("not ok %d - %s" % (number, test.__name__))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
