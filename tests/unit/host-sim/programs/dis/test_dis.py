#!/usr/bin/env python3
"""landmass-dis from datagram to frame: PDUs that others made (npm's open-dis) and recorded, judged by others (tshark's
dissector), over a port of this machine, from a capture and from files.

TAP on standard output. BUILD names the build's folder. A peer that is not there is a skip.
"""

import json
import math
import os
import re
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import traceback

BUILD = os.environ.get("BUILD", "build/bench-linux")
PROGRAM = os.path.join(BUILD, "bin/landmass-dis")
DATA = os.environ.get("LANDMASS_DATA", "../shared/data")
LINE = re.compile(r"\((\d+\.\d{6})\) can0 ([0-9A-F]{3})#([0-9A-F]*)$")
A_M, E2 = 6378137.0, 0.0066943799901413165


class Skip(Exception):
    pass


def run(*arguments, code=0):
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, timeout=120, stdin=subprocess.DEVNULL)
    assert done.returncode == code, "exit code %d: %s" % (done.returncode, done.stderr.decode())
    return done.stdout.decode(), done.stderr.decode()


def report(*arguments):
    with tempfile.NamedTemporaryFile(suffix=".json") as file:
        log, _ = run(*arguments, "--json", file.name)
        return json.load(open(file.name))["report"], frames_of(log)


def frames_of(log):
    """Time, identifier and bytes of each line."""
    frames = []
    for line in log.splitlines():
        match = LINE.match(line)
        assert match, "no line of a log: %r" % line
        frames.append((float(match[1]), int(match[2], 16), bytes.fromhex(match[3])))
    return frames


def sets_of(frames):
    """What the sets carry, by the table of docs/bus.md: a dictionary each, with its time and number."""
    forms = {1810: ("latitude", ">i", 1e-7), 1811: ("longitude", ">i", 1e-7), 1812: ("height", ">f", 1), 1816: ("rcs", ">f", 1)}
    sets = []
    for at, name, data in frames:
        if name in (1817, 1818):
            continue
        if name == 1815:
            kind, algorithm, signature, parts = data[4:8]
            sets.append({"time": at, "number": data[2], "code": data[3], "kind": kind, "algorithm": algorithm, "parts": parts,
                         "signature": signature})
        last = sets[-1]
        assert (last["number"], last["code"]) == (data[2], data[3])
        if name in forms:
            key, form, unit = forms[name]
            last[key] = struct.unpack(form, data[4:8])[0] * unit
        elif name != 1815:
            last[name] = struct.unpack(">hh", data[4:8])
    for one in sets:
        assert ((one["parts"] & 1) != 0) == ("height" in one) and ((one["parts"] & 2) != 0) == (1813 in one), one
        assert ((one["parts"] & 4) != 0) == (1814 in one) and ((one["parts"] & 8) != 0) == ("rcs" in one), one
        assert ((one["parts"] & 16) != 0) == (1819 in one), one
    return sets


# ---- PDUs of our own, from the fields of IEEE Std 1278.1-2012, 7.2.2 ----

def geocentric(latitude, longitude, height):
    s, c = math.sin(math.radians(latitude)), math.cos(math.radians(latitude))
    n = A_M / math.sqrt(1 - E2 * s * s)
    return ((n + height) * c * math.cos(math.radians(longitude)), (n + height) * c * math.sin(math.radians(longitude)),
            (n * (1 - E2) + height) * s)


def state(entity, place, velocity=(0, 0, 0), exercise=1, marking=b"TEST", algorithm=2, kind=(1, 1, 225, 6, 0, 0, 0), version=7,
          site=11):
    body = struct.pack(">HHHBB", site, 22, entity, 1, 0) + 2 * struct.pack(">BBHBBBB", *kind)
    body += struct.pack(">3f3d3fI", *velocity, *place, 1.5, 0, 0, 0)
    body += struct.pack(">B15x3f3f", algorithm, 0, 0, 0, 0, 0, 0) + b"\1" + marking.ljust(11, b"\0") + bytes(4)
    return struct.pack(">BBBBIHH", version, exercise, 1, 1, 0, 12 + len(body), 0) + body


def write_capture(path, datagrams):
    """Times and payloads as UDP over IPv4 over Ethernet."""
    with open(path, "wb") as file:
        file.write(struct.pack("<IHHiIII", 0xa1b2c3d4, 2, 4, 0, 0, 65535, 1))
        for at, payload in datagrams:
            udp = struct.pack(">HHHH", 3000, 3000, 8 + len(payload), 0) + payload
            ip = struct.pack(">BBHHHBBH4s4s", 0x45, 0, 20 + len(udp), 1, 0, 64, 17, 0, bytes([127, 0, 0, 1]), bytes([127, 0, 0, 1]))
            packet = bytes(12) + b"\x08\0" + ip + udp
            file.write(struct.pack("<IIII", int(at), round(at % 1 * 1e6), len(packet), len(packet)) + packet)


# ---- the tests ----

def a_capture_becomes_targets_where_its_entities_are(work):
    path = os.path.join(work, "two.pcap")
    write_capture(path, [(1000, state(1, geocentric(47, 8, 500), marking=b"CAR")),
                         (1000.25, state(2, geocentric(47.01, 8.01, 3048), (100, 0, 0), kind=(1, 2, 225, 1, 3, 0, 0)) + bytes(4)),
                         (1003, b"\7\1\1"), (1003.1, state(3, geocentric(47, 8, 0))[:100])])
    figures, frames = report("--capture", path, "--geoid", "48")
    sets = sets_of(frames)
    car, jet = [next(s for s in sets if s["kind"] == kind) for kind in (2, 7)]
    assert abs(car["latitude"] - 47) < 1e-7 and abs(car["longitude"] - 8) < 1e-7 and "height" not in car
    assert abs(jet["height"] - 3000) < 0.01 and abs(math.hypot(*jet[1813]) * 0.05 - 100 * math.hypot(
        math.sin(math.radians(8.01)), math.cos(math.radians(8.01)) * math.sin(math.radians(47.01)))) < 0.1
    assert car["time"] == 1000 and jet["time"] == 1000.25
    assert figures["refused"]["header"] == 1 and figures["refused"]["truncated"] == 1 and figures["targets_most"] == 2
    assert sum(name == 1817 for _, name, _ in frames) == 2 == figures["removals"]


def tshark_reads_the_same_entities(work):
    if not shutil.which("tshark"):
        raise Skip("no tshark here")
    path = os.path.join(work, "many.pcap")
    entities = [state(i, geocentric(-60 + i, 3 * i, 100 * i), (i, -i, 0.5 * i), marking=b"N%d" % i, version=6 + i % 2)
                for i in range(1, 60)]
    write_capture(path, [(0.01 * i, e) for i, e in enumerate(entities)])
    peer = subprocess.run(["tshark", "-r", path, "-d", "udp.port==3000,dis", "-T", "fields", "-E", "separator=|"] + [
        word for field in ("entity_id_site", "entity_id_application", "entity_id_entity", "entity_marking", "entity_location.x",
                           "entity_location.y", "entity_location.z") for word in ("-e", "dis." + field)],
        capture_output=True, timeout=60)
    rows = [row.split("|") for row in peer.stdout.decode().splitlines() if row.count("|") == 6]
    assert len(rows) == 59, peer.stderr.decode()
    figures, _ = report("--capture", path)
    ours = {e["id"]: e for e in figures["entities_at_end"]}
    for site, application, entity, marking, x, y, z in rows:
        # The last of them were 0.6 s on the way at some metres a second.
        e = ours["%s:%s:%s" % (int(site), int(application), int(entity))]
        at = geocentric(e["latitude_deg"], e["longitude_deg"], e["ellipsoid_height_m"])
        assert math.dist(at, (float(x), float(y), float(z))) < 0.6 * 1.5 * int(entity) + 0.01 and e["marking"] == marking.strip(), e
    assert len(ours) == 59


def a_recorded_drive_is_never_further_off_than_the_threshold(work):
    path = os.path.join(DATA, "dis_hawaii_vehicle/derived_GAZ69MultipleBlocksBase64.pcap")
    if not os.path.exists(path):
        raise Skip("no %s here" % path)
    with open(path.replace(".pcap", "_entity_state.csv")) as file:
        names, *rows = [line.strip().split(",") for line in file]
    fixes = [(float(r[1]), float(r[names.index("lat_deg")]), float(r[names.index("lon_deg")])) for r in rows]
    figures, frames = report("--capture", path)
    sets = sets_of(frames)
    assert figures["entity_states"] == 716 == len(fixes) and len({s["number"] for s in sets}) == 1
    worst, last = 0, 0
    for at, latitude, longitude in fixes: # where the display had it just after each state came
        while last + 1 < len(sets) and sets[last + 1]["time"] <= at + 1e-6:
            last += 1
        s = sets[last]
        east, north = [0.05 * v * (at - s["time"]) for v in s.get(1813, (0, 0))]
        a_east, a_north = [0.005 * v * (at - s["time"]) ** 2 for v in s.get(1819, (0, 0))]
        off = math.hypot((s["latitude"] - latitude) * 110700 + north + a_north,
                         (s["longitude"] - longitude) * 103800 + east + a_east)
        worst = max(worst, off)
    print("# worst %.2f m with %d sets of %d states" % (worst, len(sets), len(fixes)))
    assert worst < 2.1, worst


def single_pdus_of_simulators_are_read_or_passed_over(work):
    folder = os.path.join(DATA, "dis_single_pdus")
    if not os.path.isdir(folder):
        raise Skip("no %s here" % folder)
    names = sorted(name for name in os.listdir(folder) if name.endswith(".raw"))
    figures, frames = report("--pdu", ",".join(os.path.join(folder, name) for name in names))
    assert figures["datagrams"] == len(names) == 12 and figures["entity_states"] == 2 and not any(figures["refused"].values())
    assert figures["other_pdus"] == 10
    assert {round(s["latitude"], 6) for s in sets_of(frames)} == {42.882481, 51.22871}


class Listener:
    """The program at a port of this machine, until it is interrupted."""

    def __init__(self, work, *arguments):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.json = os.path.join(work, "listener.json")
        self.run = subprocess.Popen([PROGRAM, "--listen", str(self.port), "--json", self.json, *arguments], stdout=subprocess.PIPE,
                                    stderr=subprocess.PIPE, stdin=subprocess.DEVNULL)
        hexadecimal = ":%04X " % self.port
        for _ in range(1000):
            with open("/proc/net/udp") as file:
                if hexadecimal in file.read():
                    return
            time.sleep(0.01)
        raise AssertionError("does not listen")

    def end(self):
        self.run.send_signal(signal.SIGINT)
        log, text = self.run.communicate(timeout=30)
        assert self.run.returncode == 0, text.decode()
        return json.load(open(self.json))["report"], frames_of(log.decode())


def what_comes_to_the_port_is_told_and_an_interrupt_removes_it(work):
    listener = Listener(work)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for i in range(30):
            sender.sendto(state(i % 10 + 1, geocentric(47, 8 + i % 10, 500)), ("127.0.0.1", listener.port))
        time.sleep(1.5)
    figures, frames = listener.end()
    assert figures["datagrams"] == 30 and figures["targets_most"] == 10 == figures["removals"], figures
    assert len({s["number"] for s in sets_of(frames)}) == 10 and figures["heartbeats"] >= 10
    assert abs(frames[0][0] - time.time()) < 60


OPEN_DIS = """
const dis = require('open-dis'), socket = require('dgram').createSocket('udp4');
const convert = new dis.CoordinateConversion(), wanted = Number(process.argv[2]);
let sent = 0;
for (let i = 1; i <= 5; i++) {
    const pdu = new dis.EntityStatePdu(), place = convert.getXYZfromLatLonAltDegrees({lat: 40 + i, lon: -100 - i, alt: 100});
    pdu.exerciseID = 5;
    Object.assign(pdu.entityID, {site: 17, application: 23, entity: i});
    Object.assign(pdu.entityType, {entityKind: 1, domain: 3, country: 225, category: 6});
    Object.assign(pdu.entityLocation, place);
    Object.assign(pdu.entityLinearVelocity, {x: 3, y: 0, z: 0});
    pdu.deadReckoningParameters.deadReckoningAlgorithm = 2;
    pdu.marking.characters = Array.from('SHIP ' + i + '     ').map(c => c.charCodeAt(0)).slice(0, 11);
    pdu.pduLength = 144;
    const out = new dis.OutputStream(new ArrayBuffer(500));
    pdu.encodeToBinary(out);
    const bytes = Buffer.from(out.toByteArray());
    socket.send(bytes, wanted, '127.0.0.1', () => { if (++sent == 5) socket.close(); });
}
"""


def open_dis_sends_and_its_ships_are_where_it_says(work):
    if not shutil.which("npm") or not shutil.which("node"):
        raise Skip("no npm here")
    try:
        done = subprocess.run(["npm", "install", "--silent", "--no-audit", "--no-fund", "--prefix", work, "open-dis@1.3.6"],
                              capture_output=True, timeout=120, stdin=subprocess.DEVNULL)
        is_there = done.returncode == 0
    except subprocess.TimeoutExpired:
        is_there = False
    if not is_there:
        raise Skip("npm cannot be reached")
    with open(os.path.join(work, "send.js"), "w") as file:
        file.write(OPEN_DIS)
    listener = Listener(work, "--exercise", "5")
    done = subprocess.run(["node", os.path.join(work, "send.js"), str(listener.port)], capture_output=True, timeout=60)
    time.sleep(0.5)
    figures, frames = listener.end()
    assert done.returncode == 0, done.stderr.decode()[-500:]
    sets = sets_of(frames)
    assert figures["entity_states"] == 5 and not any(figures["refused"].values()), figures
    assert {e["id"]: e["marking"].strip() for e in figures["entities_at_end"]} == {"17:23:%d" % i: "SHIP %d" % i for i in range(1, 6)}
    assert {(round(s["latitude"], 4), round(s["longitude"], 4)) for s in sets} == {(40 + i, -100 - i) for i in range(1, 6)}, sets
    assert {s["kind"] for s in sets} == {13} and all(0 < math.hypot(*s[1813]) * 0.05 < 3.01 for s in sets)


# ---- CIGI, from the fields of packet-cigi.c ----

def ig_control(order, ticks=None, minor=3):
    flags = minor << 4 | (0 if ticks is None else 4) | 1
    return struct.pack(order + "BBBbBBHIIII", 1, 24, 3, 0, flags, 0, 0x8000, 7, ticks or 0, 3, 0)


def entity_control(order, entity, place, kind=1, state=1, clamp=0, attach=0, yaw=0.0, parent=0):
    return struct.pack(order + "BBHBBBBHHfffddd", 2, 48, entity, clamp << 5 | attach << 2 | state, 0, 255, 0, kind, parent, 1.5, -2.5,
                       yaw, *place)


def rate_control(order, entity, rates, local=0):
    return struct.pack(order + "BBHBBHffffff", 8, 32, entity, 0, local << 1, 0, *rates, 0, 0, 0)


def write_cigi_kinds(work):
    path = os.path.join(work, "cigi.kinds")
    with open(path, "w") as file:
        file.write("0.1.7 kind truck\n0.2.9 kind fighter\n0.1.13 kind ship\n")
    return path


def a_cigi_host_tells_of_entities_where_tshark_sees_them(work):
    if not shutil.which("tshark"):
        raise Skip("no tshark here")
    for order in "<>":
        path = os.path.join(work, "cigi.pcap")
        told, messages = {}, []
        for i in range(1, 41):
            told[i] = (-60 + 3 * i + 0.123456789, 4.5 * i - 90.5, 100.0 * i)
            control = entity_control(order, i, told[i], kind=9, yaw=4.0 * i)
            messages.append((0.02 * i, ig_control(order, 2000 * i) + control + bytes([200, 4, 0, 0])))
        write_capture(path, messages)
        peer = subprocess.run(["tshark", "-r", path, "-d", "udp.port==3000,cigi", "-T", "fields", "-E", "separator=|"] + [
            word for field in ("entity_id", "lat_xoff", "lon_yoff", "alt_zoff", "yaw") for word in ("-e", "cigi.entity_control." + field)],
            capture_output=True, timeout=60)
        rows = [row.split("|") for row in peer.stdout.decode().splitlines() if row.count("|") == 4 and row[0] != "|"]
        assert len(rows) == 40, (peer.stdout[:300], peer.stderr[:300])
        figures, frames = report("--cigi", "--kinds", write_cigi_kinds(work), "--capture", path, "--geoid", "33")
        ours = {e["id"]: e for e in figures["entities_at_end"]}
        assert figures["entity_states"] == 40 and figures["other_pdus"] == 40 and not any(figures["refused"].values()), figures
        headings = {round(s["latitude"], 5): s[1814][0] * 180 / 32768 % 360 for s in sets_of(frames)}
        for entity, latitude, longitude, height, yaw in rows:
            e = ours["0:0:%d" % int(entity)]
            assert abs(e["latitude_deg"] - float(latitude)) < 1e-6 and abs(e["longitude_deg"] - float(longitude)) < 1e-6, (e, rows)
            assert abs(e["ellipsoid_height_m"] - 33 - float(height)) < 0.01, e
            assert abs((headings[round(float(latitude), 5)] - float(yaw) + 180) % 360 - 180) < 0.02, (entity, yaw)


def a_cigi_entity_moves_stops_and_goes(work):
    """A fighter whose velocity follows from its places, a lorry that has a rate, one that is attached, one that goes."""
    path, kinds, order = os.path.join(work, "cigi.pcap"), write_cigi_kinds(work), "<"
    messages = []
    for n in range(181):  # three seconds at 60 Hz
        t = n / 60
        packets = [entity_control(order, 0, (46, 11, 3000)),
                   entity_control(order, 5, (46.2 + 200 * min(t, 2) / 111170, 11, 4000), kind=9),
                   entity_control(order, 8, (46, 11, 0), kind=9, attach=1, parent=5)]
        if n == 0:
            packets += [entity_control(order, 6, (46.1, 11.1, 1), kind=7, clamp=1, yaw=90.0), rate_control(order, 6, (15, 0, 0), 1),
                        entity_control(order, 7, (46.1, 11.2, 0), kind=13, clamp=1),
                        entity_control(order, 9, (46.1, 11.3, 0), kind=77)]
        if n <= 60:  # and then it is not told any more
            packets += [entity_control(order, 10, (46.3, 11 + 50 * t / 77000, 0), kind=7, clamp=1)]
        if n == 120:
            packets += [entity_control(order, 7, (0, 0, 0), kind=13, state=2)]
        messages.append((100 + t, ig_control(order, int(t * 1e5)) + b"".join(packets)))
    write_capture(path, messages)
    figures, frames = report("--cigi", "--kinds", kinds, "--capture", path, "--timeout", "1")
    sets = sets_of(frames)
    fighter = [s for s in sets if s["kind"] == 7]
    speeds = [(s["time"], 0.05 * math.hypot(*s.get(1813, (0, 0)))) for s in fighter]
    assert all(abs(v - 200) < 1 for t, v in speeds if 100.5 < t < 102), speeds
    assert speeds[-1][1] < 1 and abs(fighter[-1]["latitude"] - 46.2 - 400 / 111170) < 1e-5, (speeds, fighter[-1])
    silent = [s for s in sets if s["kind"] == 3 and s["latitude"] > 46.25]
    assert any(abs(0.05 * s[1813][0] - 50) < 1 for s in silent if 1813 in s and 100.5 < s["time"] < 101.3), silent
    assert silent[-1]["time"] > 101.6 and not any(silent[-1].get(1813, (0, 0))), silent
    assert abs(silent[-1]["longitude"] - 11 - 50 / 77000) < 1e-6, silent[-1]
    (lorry, *more) = [s for s in sets if s["kind"] == 3 and s["latitude"] < 46.25]
    assert any(abs(0.05 * s[1813][0] - 15) < 0.06 and abs(s[1813][1]) <= 2 for s in (lorry, *more)) and "height" not in lorry, lorry
    assert more[-1]["time"] > 102 and figures["entities_deactivated"] == 1 and figures["entities_timed_out"] == 0
    assert figures["types_without_rule"] == ["0.2.77.0.0.0.0"] and figures["left_out"]["attached"] == 181
    assert figures["left_out"]["ownship"] == 181 and figures["targets_most"] == 4


def cigi_that_is_none_is_refused_and_counted(work):
    path, order = os.path.join(work, "cigi.pcap"), ">"
    good = entity_control(order, 5, (46, 11, 100), kind=9)
    control = ig_control(order)
    write_capture(path, [
        (0, b"\1"), (0, good), (0, control[:2] + b"\4" + control[3:] + good), (0, control[:6] + b"\0\0" + control[8:]),
        (0, control + b"\2"), (0, control + good[:-1]), (0, control + good[:1] + b"\1" + good[2:]),
        (0, control + struct.pack(">BBH", 2, 4, 5)), (0, control + entity_control(order, 5, (math.nan, 0, 0))),
        (0, control + entity_control(order, 5, (91, 0, 0))), (0, control + rate_control(order, 5, (math.inf, 0, 0))),
        (0, control + rate_control(order, 5, (1e6, 0, 0))), (0, state(1, geocentric(47, 8, 500)))])
    figures, frames = report("--cigi", "--kinds", write_cigi_kinds(work), "--capture", path)
    refused = figures["refused"]
    assert frames == [] and refused == {"header": 4, "protocol": 3, "truncated": 1, "short": 1, "number": 2, "place": 1, "speed": 1,
                                        "id": 0}, refused


def an_interface_of_socketcan_gets_what_a_log_gets(work):
    """vcan0, or one that this run may make."""
    name = "vcan0"
    made = False
    if not os.path.exists("/sys/class/net/" + name) and shutil.which("ip"):
        made = subprocess.run(["ip", "link", "add", "dev", name, "type", "vcan"], capture_output=True).returncode == 0
    try:
        if not os.path.exists("/sys/class/net/" + name) or (
                made and subprocess.run(["ip", "link", "set", "up", name], capture_output=True).returncode != 0):
            raise Skip("no vcan0 here, and none can be made")
        path = os.path.join(work, "two.pcap")
        write_capture(path, [(1000, state(1, geocentric(47, 8, 500))), (1000.4, state(2, geocentric(47, 9, 500)))])
        with socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW) as ear:
            ear.bind((name,))
            ear.settimeout(0.5)
            figures, _ = report("--capture", path, "--can", name)
            heard = []
            while len(heard) < figures["frames"]:
                word, length, data = struct.unpack("=IB3x8s", ear.recv(16))
                heard.append((word & 0x1fffffff, data[:length]))
        assert figures["frames_lost"] == 0, figures
        _, told = report("--capture", path)
        assert sorted(name for name, _ in heard) == sorted(name for _, name, _ in told)
        assert {data[4:] for _, name, data in told if name == 1811} == {data[4:] for name, data in heard if name == 1811}
    finally:
        if made:
            subprocess.run(["ip", "link", "del", "dev", name], capture_output=True)


def mistakes_are_told_with_their_place(work):
    for words, code, said in (
            (["--capture", os.path.join(work, "nosuch")], 1, "nosuch: cannot be opened"),
            (["--capture", PROGRAM], 1, "is no capture"),
            (["--pdu", PROGRAM, "--listen", "3000"], 2, "only one of them"),
            (["--pdu", PROGRAM, "--out", PROGRAM], 1, "is an input"),
            (["--pdu", PROGRAM, "--group", "239.1.2.3"], 2, "goes with --listen alone"),
            (["--listen", "3000", "--group", "10.0.0.1"], 2, "multicast"),
            (["--listen", "3000", "--bind", "192.0.2.77"], 1, "cannot be listened to"),
            (["--listen", "3000", "--exercise", "1,x"], 2, "whole numbers"),
            (["--listen", "3000", "--cigi"], 2, "--kinds"),
            (["--pdu", PROGRAM, "--targets", "9-3"], 2, "FIRST-LAST"),
            (["--pdu", PROGRAM, "--can", "nosuchcan0"], 1, "nosuchcan0")):
        _, text = run(*words, code=code)
        assert said in text, text
    with open(os.path.join(work, "bad.kinds"), "w") as file:
        file.write("1.1 kind car\n1.2 kind zeppelin\n")
    _, text = run("--pdu", PROGRAM, "--kinds", os.path.join(work, "bad.kinds"), code=1)
    assert "bad.kinds:2:" in text and "zeppelin" in text, text
    figures, frames = report("--pdu", PROGRAM) # a program is no datagram
    assert frames == [] and sum(figures["refused"].values()) == 1


def a_table_of_the_users_decides(work):
    kinds, path = os.path.join(work, "my.kinds"), os.path.join(work, "one.pcap")
    write_capture(path, [(0, state(1, geocentric(1, 2, 900))), (0, state(2, geocentric(1, 2, 0), kind=(1, 3, 0, 0, 0, 0, 0)))])
    with open(kinds, "w") as file:
        file.write("1.1.225 kind corner-reflector rcs 31.5 signature 9 height\n")
    figures, frames = report("--capture", path, "--kinds", kinds)
    (one,) = sets_of(frames)
    assert (one["kind"], one["rcs"], one["signature"], round(one["height"], 2)) == (16, 31.5, 9, 900)
    assert figures["types_without_rule"] == ["1.3.0.0.0.0.0"] and figures["entities_without_rule"] == 1
    with open(kinds, "w") as file:
        file.write(run("--print-kinds")[0])
    assert run("--capture", path, "--kinds", kinds)[0] == run("--capture", path)[0]


CASES = [a_capture_becomes_targets_where_its_entities_are, tshark_reads_the_same_entities,
         a_recorded_drive_is_never_further_off_than_the_threshold, single_pdus_of_simulators_are_read_or_passed_over,
         what_comes_to_the_port_is_told_and_an_interrupt_removes_it, open_dis_sends_and_its_ships_are_where_it_says,
         a_cigi_host_tells_of_entities_where_tshark_sees_them, a_cigi_entity_moves_stops_and_goes,
         cigi_that_is_none_is_refused_and_counted, an_interface_of_socketcan_gets_what_a_log_gets, mistakes_are_told_with_their_place, a_table_of_the_users_decides]


def main():
    print("1..%d" % len(CASES))
    failed = 0
    for number, case in enumerate(CASES, 1):
        name = case.__name__.replace("_", " ")
        with tempfile.TemporaryDirectory() as work:
            try:
                case(work)
                print("ok %d - %s" % (number, name))
            except Skip as reason:
                print("ok %d - %s # SKIP\n# skipped: %s" % (number, name, reason))
            except Exception:
                failed += 1
                print("not ok %d - %s" % (number, name))
                print("# %s" % traceback.format_exc().strip().replace("\n", "\n# "))
    sys.exit(failed > 0)


main()
