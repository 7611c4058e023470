#!/usr/bin/env python3
"""What `landmass-bus` says of a profile agrees with the firmware and with itself: the .dbc is read by a reader of our own
(and by cantools where that is installed), and numbers that it describes are decoded to the same values.

TAP on standard output. BUILD names the build's folder, LANDMASS_DATA the folder of the real data.
"""

import glob
import gzip
import math
import os
import random
import re
import struct
import subprocess
import sys
import tempfile

BUILD = os.environ.get("BUILD", "build/bench-linux")
BUS = os.path.join(BUILD, "bin/landmass-bus")
GENERATOR = os.path.join(BUILD, "gen/bin/bus_table")
DATA = os.environ.get("LANDMASS_DATA", "../shared/data")
PEER = os.path.join(DATA, "can_peer")
TABLES = ["host-sim/bus/arinc825.bus", "host-sim/bus/nmea2000.bus"]
PROFILES = [["--profile", "canas17"], ["--profile", "xcsoar"]] + [["--table", path] for path in TABLES]
EXTENDED = 1 << 31


def bus(*arguments, text=None):
    done = subprocess.run([BUS, *arguments], input=text, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


class Signal:
    """A signal of a .dbc: where it lies and what it means."""

    LINE = re.compile(r' SG_ (\w+)\s*(M|m\d+)? ?: (\d+)\|(\d+)@([01])([+-]) \(([^,]+),([^)]+)\) \[([^|]+)\|([^]]+)\] "([^"]*)" (\S+)$')

    def __init__(self, line):
        name, mux, start, bits, order, sign, scale, offset, low, high, unit, _ = self.LINE.match(line).groups()
        self.name, self.mux, self.bits, self.unit = name, mux, int(bits), unit
        self.is_little, self.is_signed, self.is_float = order == "1", sign == "-", False
        self.scale, self.offset, self.low, self.high = float(scale), float(offset), float(low), float(high)
        start = int(start)
        # bits above the run, when the eight bytes are one number in the signal's order
        self.below = start if self.is_little else 64 - (start // 8 * 8 + 7 - start % 8) - self.bits
        assert 0 <= self.below <= 64 - self.bits, line

    def mask(self):
        return ((1 << self.bits) - 1) << self.below

    def raw(self, data):
        word = int.from_bytes(data.ljust(8, b"\0"), "little" if self.is_little else "big")
        return word >> self.below & ((1 << self.bits) - 1)

    def value(self, data):
        raw = self.raw(data)
        if self.is_float:
            raw = struct.unpack("!f" if self.bits == 32 else "!d", raw.to_bytes(self.bits // 8, "big"))[0]
        elif self.is_signed and raw >> (self.bits - 1):
            raw -= 1 << self.bits
        return raw * self.scale + self.offset

    def encode(self, raw):
        """The eight bytes in which this signal is the integer or float `raw` and all else is 0."""
        if self.is_float:
            raw = int.from_bytes(struct.pack("!f" if self.bits == 32 else "!d", raw), "big")
        word = (raw & ((1 << self.bits) - 1)) << self.below
        return word.to_bytes(8, "little" if self.is_little else "big")


class Message:
    def __init__(self, identifier, name, length, sender):
        self.identifier, self.name, self.length, self.signals = int(identifier), name, int(length), []
        self.is_sent = sender == "landmass"

    def signal(self, name):
        return next(s for s in self.signals if s.name == name)


def read_dbc(text):
    """{identifier: Message}. Every line must be of a kind that is known."""
    messages, message = {}, None
    for line in text.splitlines():
        if re.match(r"BO_ ", line):
            message = Message(*re.match(r"BO_ (\d+) (\w{1,32}): (\d) (Vector__XXX|landmass)$", line).groups())
            assert message.identifier not in messages, line
            messages[message.identifier] = message
        elif line.startswith(" SG_ "):
            message.signals.append(Signal(line))
        elif line.startswith("SIG_VALTYPE_ "):
            identifier, name, kind = re.match(r"SIG_VALTYPE_ (\d+) (\w+) : ([12]);$", line).groups()
            signal = messages[int(identifier)].signal(name)
            assert signal.bits == 32 * int(kind), line
            signal.is_float = True
        else:
            assert re.match(r'(VERSION ".*"|NS_ :|BS_:|BU_: landmass|CM_ .*;|BA_.*;|VAL_ .* ;|)$', line), line
    return messages


def overlapping(message):
    """Pairs of signals that share bits without being alternatives."""
    for i, a in enumerate(message.signals):
        for b in message.signals[:i]:
            alternatives = a.mux and b.mux and a.mux != "M" and b.mux != "M" and a.mux != b.mux
            if a.is_little == b.is_little and a.mask() & b.mask() and not alternatives:
                yield a.name, b.name


def log_line(seconds, identifier, data):
    width = "%08X" if identifier & EXTENDED else "%03X"
    return "(%.6f) can0 %s#%s\n" % (seconds, width % (identifier & ~EXTENDED), data.hex().upper())


# ---- the cases ----

def names_are_unlike_and_signals_do_not_overlap():
    for profile in PROFILES:
        messages = read_dbc(bus("dbc", *profile))
        assert len({m.name for m in messages.values()}) == len(messages)
        for message in messages.values():
            assert len({s.name for s in message.signals}) == len(message.signals) > 0, message.name
            assert not list(overlapping(message)), (message.name, list(overlapping(message)))


def peer_values():
    """(time, identifier, value, tolerance) of each value that the other library sent on channel 0."""
    with gzip.open(os.path.join(PEER, "peer_expected_3s.csv.gz"), "rt") as lines:
        next(lines)
        for line in lines:
            time, _, value, _, kind, identifier, *_, redundancy, tolerance = line.rstrip("\n").split(",")
            if redundancy == "0" and value and kind not in ("CHAR4", "NODATA"):
                yield time, int(identifier), float(value), float(tolerance)


def peer_frames():
    """{time: (identifier, data)}, and the DOUBLEH before a frame of the same identifier."""
    frames, half, halves = {}, {}, {}
    with gzip.open(os.path.join(PEER, "peer_frames_3s.log.gz"), "rt") as lines:
        for line in lines:
            time, _, frame = line.split()
            identifier, data = frame.split("#")
            data = bytes.fromhex(data)
            if len(data) == 8 and data[1] == 31:
                halves[time[1:-1]] = half[identifier]
            half[identifier] = data
            frames[time[1:-1]] = (int(identifier, 16), data)
    return frames, halves


def compare_with_peer(decode):
    """decode(identifier, data) -> {signal: value}; every value of an identifier that the .dbc has must come out."""
    frames, halves = peer_frames()
    compared = 0
    for time, identifier, value, tolerance in peer_values():
        frame_id, data = frames[time]
        signals = decode(frame_id, data)
        if frame_id != identifier or signals is None:
            continue
        if "as_DOUBLEL" in signals:
            high = decode(frame_id, halves[time])["as_DOUBLEH"]
            got = struct.unpack("!d", struct.pack("!II", int(high), int(signals["as_DOUBLEL"])))[0]
        elif "value_SHORT2" in signals:
            got = signals["value_SHORT2"] * signals["full_scale_SHORT2"] / 32767
        else:
            got = signals["as_FLOAT"]
        assert abs(got - value) <= tolerance + 5e-11 * max(1, abs(value)), (time, identifier, got, value)
        compared += 1
    assert compared > 1500, compared


def need_peer():
    if not os.path.isdir(PEER):
        raise Skip("no " + PEER)


def the_dbc_reads_what_another_library_sent():
    need_peer()
    messages = read_dbc(bus("dbc"))

    def decode(identifier, data):
        if identifier not in messages:
            return None
        signals = messages[identifier].signals
        kind = next(s for s in signals if s.mux == "M").value(data) if any(s.mux == "M" for s in signals) else -1
        return {s.name: s.value(data) for s in signals if s.mux in (None, "M", "m%d" % kind)}

    compare_with_peer(decode)


def cantools_reads_the_dbc_and_what_another_library_sent():
    try:
        import cantools
    except ImportError:
        raise Skip("cantools is not installed (it is not in Debian 12); the reader above stands for it") from None
    need_peer()
    for profile in PROFILES:
        cantools.database.load_string(bus("dbc", *profile), "dbc", strict=True)
    database = cantools.database.load_string(bus("dbc"), "dbc", strict=True)
    known = {m.frame_id for m in database.messages}

    def decode(identifier, data):
        return database.decode_message(identifier, data, decode_choices=False) if identifier in known else None

    compare_with_peer(decode)


def the_filters_are_those_of_the_messages():
    for profile in PROFILES:
        messages = {i for i, m in read_dbc(bus("dbc", *profile)).items() if not m.is_sent}
        filters = [line.split(":") for line in bus("filters", *profile).split()]
        heard = {int(i, 16) | (EXTENDED if len(i) == 8 else 0) for i, _ in filters}
        assert messages <= heard, messages - heard
        redundant = {i | EXTENDED for i in messages if not i & EXTENDED}
        assert heard <= messages | redundant, heard - messages - redundant
        for _, mask in filters:
            assert int(mask, 16) >> 30 == 3, "a mask without the bits for 29 bits and remote frames"


def table_rows(profile):
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in bus("table", *profile).splitlines()]
    return [dict(zip(rows[0], row)) for row in rows[2:]]


def is_fast(row):
    """Whether it comes in fast packets, of which a .dbc has frames alone; test_nmea2000 judges the messages."""
    return "fast" in row.get("bits", "")


FAST_TABLE = """profile fast
framing packed
channel-mask 0x000000FF
item "in frame 0" field=true-track id=0x01F80500 mask=0x03FFFF00 endian=little packet=fast \\
     bits=16+16 scale=0.005 unit=deg range=0..360 period=100 stale=300 dead=2000
item "in frame 1" field=pitch id=0x01F80500 mask=0x03FFFF00 endian=little packet=fast \\
     bits=64+16 type=signed scale=0.002 unit=deg range=-90..90 period=100 stale=300 dead=2000
item "in frame 3, from its first byte on" field=roll id=0x01F80500 mask=0x03FFFF00 endian=big packet=fast \\
     bits=160+32 type=signed scale=1e-7 unit=deg range=-180..180 period=100 stale=300 dead=2000
item "in frames 1 and 2" field=latitude id=0x01F80500 mask=0x03FFFF00 endian=little packet=fast \\
     bits=88+32 type=signed scale=1e-7 unit=deg range=-90..90 period=100 stale=300 dead=2000
"""


def frames_of_fast_packets_are_read_as_their_messages():
    """Of each number that lies in one frame, the .dbc says of that frame what the decoder says of the message."""
    dice, seen = random.Random(2000), 0
    with tempfile.TemporaryDirectory() as folder:
        table = os.path.join(folder, "fast.bus")
        with open(table, "w") as file:
            file.write(FAST_TABLE)
        (message,) = read_dbc(bus("dbc", "--table", table)).values()
        names = {s.name: s.mux for s in message.signals}
        assert {"sequence": None, "frame": "M", "message_bytes": "m0"}.items() <= names.items() and len(names) == 6, names
        assert sorted(m for m in names.values() if m) == ["M", "m0", "m0", "m1", "m3"], names
        assert "in frames 1 and 2: bits 88 to 119 of the message, in its frames 1 to 2" in bus("dbc", "--table", table)
        for turn in range(40):
            data = bytes(dice.randrange(256) for _ in range(43))
            parts = [data[:6]] + [data[i:i + 7] for i in range(6, 43, 7)]
            frames = [bytes([turn % 8 << 5 | i]) + (bytes([43]) if i == 0 else b"") + part for i, part in enumerate(parts)]
            text = bus("decode", "--table", table, "-", text="".join(
                log_line(1 + 0.001 * i, 0x01F80517 | EXTENDED, frame) for i, frame in enumerate(frames)))
            for field, name in (("true-track", "in_frame_0"), ("pitch", "in_frame_1"), ("roll", "in_frame_3")):
                signal = next(s for s in message.signals if s.name.startswith(name))
                value = signal.value(frames[int(signal.mux[1:])])
                if signal.low <= value <= signal.high:
                    (found,) = field_values(text, field)
                    assert abs((found - value + 180) % 360 - 180) < 1e-4 * max(1, abs(value)), (name, value, found)
                    seen += 1
    assert seen > 60, seen


def field_values(text, field):
    return [float(v) for v in re.findall(r"= %s (\S+) " % re.escape(field), text)]


def packed_cases(table, dice):
    """(row of the table, data, value in the bus's unit) for numbers within and at the ends of each range."""
    messages = read_dbc(bus("dbc", "--table", table))
    for row in table_rows(["--table", table]):
        if is_fast(row):
            continue
        message = messages[int(row["id"]) | EXTENDED]
        matching = [s for s in message.signals if s.unit == row["unit"] and s.mux != "M" and
                    re.sub(r"\W+", "_", row["item"])[:20].startswith(re.sub(r"_\d+$", "", s.name)[:20].rstrip("_"))]
        if len(matching) > 1:  # long names are told apart by the number of the row
            matching = [s for s in matching if "latit" in s.name or "longi" in s.name][row["field"] == "longitude":][:1]
        signal, = matching
        low, high = map(float, row["range"].split(".."))
        for _ in range(200):
            wanted = (dice.uniform(low, high) - signal.offset) / signal.scale
            raw = struct.unpack("!f", struct.pack("!f", wanted))[0] if signal.is_float and signal.bits == 32 else wanted
            raw = raw if signal.is_float else math.trunc(wanted)
            data = signal.encode(raw)
            if signal.mux:
                other = next(s for s in message.signals if s.mux == "M").encode(int(signal.mux[1:]))
                data = bytes(a | b for a, b in zip(data, other))
            if low <= signal.value(data) <= high:
                yield row, data, signal.value(data)


def numbers_of_a_text_table_are_decoded_as_the_dbc_describes_them():
    dice = random.Random(825)
    step = {"deg": 3 * 360 / 2**32, "m": 1.6 / 64, "m/s": 0.0016, "s": 0.501}
    for table in TABLES:
        cases = list(packed_cases(table, dice))
        for field in {row["field"] for row, _, _ in cases}:
            mine = [(int(row["id"]), data, value) for row, data, value in cases if row["field"] == field]
            unit = next(row["unit"] for row, _, _ in cases if row["field"] == field)
            text = bus("decode", "--table", table, text="".join(log_line(i, EXTENDED | c[0], c[1]) for i, c in enumerate(mine)))
            got = field_values(text, field)
            assert len(got) == len(mine) > 150, (field, len(got), len(mine))
            for value, (_, data, wanted) in zip(got, mine):
                error = abs(value - wanted)
                error = min(error, abs(error - 360)) if unit == "deg" else error
                assert error <= step[unit] + 1e-7, (table, field, data.hex(), value, wanted)


def whole_seconds_are_cut_off_and_not_rounded():
    for ticks, seconds in ((0, 0), (9999, 0), (10000, 1), (863999999, 86399)):
        data = b"\0\0" + struct.pack("<I", ticks) + b"\0\0"
        text = bus("decode", "--table", TABLES[1], text=log_line(0, EXTENDED | 0x09F80907, data))
        assert field_values(text, "utc") == [seconds], text


def a_position_of_nmea_2000_is_read_and_all_ones_are_none():
    # 0x17C9A116 is 399,089,942 ten-millionths of a degree; the longitude is "not available".
    text = bus("decode", "--table", TABLES[1], text="(1.000000) can0 09F80116#16A1C917FFFFFF7F\n")
    assert field_values(text, "latitude") == [39.9089942] and not field_values(text, "longitude"), text


def the_firmware_has_the_table_of_its_board():
    assert bus("table", "--profile", "generic") == bus("table", "--table", TABLES[0])


CANAEROSPACE_TABLE = """profile my-canaerospace
framing canaerospace
item "body pitch" field=pitch id=311 types=FLOAT,SHORT range=-90..90 per-unit=100 period=20 stale=100 dead=1000
item "clock" field=utc id=1200 types=CHAR4 range=0..86400 period=1000 stale=2000 dead=5000
"""


def linked_with(source, folder):
    """landmass-bus with another lm_bus_generic than the board's."""
    obj, program = os.path.join(folder, "generic.o"), os.path.join(folder, "landmass-bus")
    headers = ["-Ifixed/include", *("-I" + path for path in glob.glob("firmware/*/include"))]
    subprocess.run(["gcc", "-std=c11", "-Wall", "-Wextra", "-Wconversion", "-Werror", *headers, "-c", source, "-o", obj], check=True)
    parts = [BUILD + "/host-sim/programs/bus/main.o", obj]
    archives = ["host-sim/bus/libbus", "host-sim/lib/liblib", "libdrivers", "libfirmware", "libfixed"]
    libraries = ["%s/%s.a" % (BUILD, name) for name in archives]
    counts = ["--coverage"] if BUILD.endswith("coverage") else []  # what `make coverage` compiles asks for its library
    subprocess.run(["gcc", *counts, *parts, *libraries, "-lpng", "-lm", "-o", program], check=True)
    return program


def a_table_that_is_compiled_is_the_table_that_is_read():
    with tempfile.TemporaryDirectory() as folder:
        mine, source = os.path.join(folder, "mine.bus"), os.path.join(folder, "generic.c")
        with open(mine, "w") as out:
            out.write(CANAEROSPACE_TABLE)
        for table in [*TABLES, mine]:
            subprocess.run([GENERATOR, table, source], check=True)
            program = linked_with(source, folder)
            for form in ("table", "dbc", "filters"):
                done = subprocess.run([program, form, "--profile", "generic"], capture_output=True, text=True, check=True)
                assert done.stdout == bus(form, "--table", table), (table, form)


def a_table_that_is_wrong_stops_the_build_and_leaves_the_source_alone():
    with tempfile.TemporaryDirectory() as folder:
        wrong, source = os.path.join(folder, "wrong.bus"), os.path.join(folder, "generic.c")
        for text in ("", "nonsense\n", CANAEROSPACE_TABLE.replace("id=311", "id=5000"), "profile x\nframing packed\n"):
            with open(wrong, "w") as out:
                out.write(text)
            with open(source, "w") as out:
                out.write("as before")
            done = subprocess.run([GENERATOR, wrong, source], capture_output=True, text=True)
            assert done.returncode == 1 and wrong in done.stderr, done
            with open(source) as kept:
                assert kept.read() == "as before"
        assert subprocess.run([GENERATOR, wrong], capture_output=True).returncode == 2


def the_document_has_the_tables_that_the_firmware_has():
    document = open("docs/bus.md").read()
    for profile in PROFILES[:2]:
        assert bus("table", *profile) in document, "docs/bus.md: put the output of landmass-bus table %s there" % " ".join(profile)
    assert bus("reports") in document, "docs/bus.md: put the output of landmass-bus reports there"
    assert bus("controls") in document, "docs/bus.md: put the output of landmass-bus controls there"


def reports_are_decoded_to_what_the_dbc_says():
    messages = read_dbc(bus("dbc"))
    rows = []
    for table in bus("reports"), bus("controls"):
        cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()]
        rows += [dict(zip(cells[0], row)) for row in cells[2:]]
    types = {"LONG": (3, ">i"), "ULONG": (4, ">I"), "CHAR": (9, ">b"), "UCHAR": (10, ">B"), "UCHAR2": (19, ">2B"), "UCHAR3": (27, ">3B"), "UCHAR4": (16, ">4B")}
    dice = random.Random(1510)
    for row in rows:
        kind, form = types[row["type"]]
        for _ in range(50):
            numbers = struct.unpack(form, dice.randbytes(struct.calcsize(form)))
            data = bytes([20, kind, 0, 7]) + struct.pack(form, *numbers)
            text = bus("decode", text=log_line(1, int(row["id"]), data)).split(" = ", 1)[1].splitlines()[0]
            values = {s.name: s.value(data) for s in messages[int(row["id"])].signals if s.mux == "m%d" % kind}
            if len(numbers) > 1:
                assert text == ", ".join("%s %d" % pair for pair in values.items()) == ", ".join(
                    "%s %d" % pair for pair in zip(row["unit or bytes"].split(), numbers)), (row, text)
            else:
                value, unit = text.split(" ")
                wanted = numbers[0] / int(row["counts in a unit"])
                assert unit == row["unit or bytes"] and abs(float(value) - wanted) < 0.0006, (row, text)
                assert abs(values["value"] - wanted) < 1e-6 * max(1, abs(wanted)), (row, values)
        empty = bytes([20, 0, 0, 7])
        assert " = " not in bus("decode", text=log_line(1, int(row["id"]), empty)), row


class Skip(Exception):
    pass


CASES = [names_are_unlike_and_signals_do_not_overlap, the_dbc_reads_what_another_library_sent,
         cantools_reads_the_dbc_and_what_another_library_sent, the_filters_are_those_of_the_messages,
         reports_are_decoded_to_what_the_dbc_says, frames_of_fast_packets_are_read_as_their_messages,
         numbers_of_a_text_table_are_decoded_as_the_dbc_describes_them, whole_seconds_are_cut_off_and_not_rounded,
         a_position_of_nmea_2000_is_read_and_all_ones_are_none, the_firmware_has_the_table_of_its_board,
         a_table_that_is_compiled_is_the_table_that_is_read,
         a_table_that_is_wrong_stops_the_build_and_leaves_the_source_alone,
         the_document_has_the_tables_that_the_firmware_has]


def main():
    print("1..%d" % len(CASES))
    failed = 0
    for number, case in enumerate(CASES, 1):
        name = case.__name__.replace("_", " ")
        try:
            case()
            print("ok %d - %s" % (number, name))
        except Skip as reason:
            print("ok %d - %s # SKIP\n# skipped: %s" % (number, name, reason))
        except Exception as error:
            failed += 1
            print("not ok %d - %s\n# %s: %s" % (number, name, type(error).__name__, error))
    sys.exit(failed > 0)


main()
