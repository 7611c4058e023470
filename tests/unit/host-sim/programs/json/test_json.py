#!/usr/bin/env python3
"""Every command writes its report as JSON (docs/json.md): each is run with --json, what it writes is read by Python, and its
figures are compared with the text for people and with what is known otherwise.

TAP on standard output. BUILD names the build's folder.
"""

import glob
import json
import os
import re
import shutil
import subprocess
import sys
import time
import traceback

BUILD = os.environ.get("BUILD", "build/bench-linux")
WORK = os.path.join(BUILD, "tmp/json")
CLASSES = "host-sim/programs/db/classes/heaton6.classes"
# The panel's program has no reports.
PROGRAMS = sorted(set(path.split("landmass-")[-1] for path in glob.glob(os.path.join(BUILD, "bin/landmass-*"))) -
                  {"panel"})
HEAD = ["schema", "program", "command", "version", "report", "messages", "files", "seconds", "exit_code"]
KEY = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*$")


def unlike(pairs):
    """An object whose keys differ and are of our form."""
    keys = [key for key, _ in pairs]
    assert len(set(keys)) == len(keys), "a key is there twice: %s" % keys
    assert all(KEY.match(key) for key in keys), "keys %s" % keys
    assert all((type(value) is bool) == bool(re.search("(^|_)is_", key)) for key, value in pairs), pairs
    return dict(pairs)


def constant(word):
    raise AssertionError("%s is no JSON" % word)


def parse(text):
    document = json.loads(text, object_pairs_hook=unlike, parse_constant=constant)
    assert list(document) == HEAD, "the members are %s" % list(document)
    return document


def here(name):
    return os.path.join(WORK, name)


def start(program, *arguments, **options):
    return subprocess.run([os.path.join(BUILD, "bin/landmass-" + program), *arguments], capture_output=True, timeout=300,
                          stdin=subprocess.DEVNULL, **options)


def run(program, *arguments, code=0):
    """The document on standard output, and the text beside it."""
    done = start(program, *arguments, "--json", "-")
    text = done.stderr.decode("utf-8", "replace")
    assert done.returncode == code, "exit code %d: %s" % (done.returncode, text)
    document = parse(done.stdout)
    assert document["program"] == "landmass-" + program and document["exit_code"] == code
    assert document["command"] == (arguments[0] if commands_of(program) != [""] else "")
    for file in document["files"]:
        assert os.path.getsize(file["path"]) == file["bytes"], file
    return document, text


def find(pattern, text):
    """What the groups of the pattern match, as numbers where they are."""
    match = re.search(pattern, text, re.M)
    assert match, "%s is not in %s" % (pattern, text)
    return [float(word) if re.match(r"-?[\d.]+$", word) else word for word in match.groups()]


def near(a, b, step):
    """Is `b`, printed in steps of `step`, the number `a`?"""
    return abs(a - b) <= step * 0.501


def rows(pattern, text):
    return [tuple(float(word) if re.match(r"-?[\d.]+$", word) else word for word in row)
            for row in re.findall(pattern, text, re.M)]


def the_list(program, *command):
    return start(program, *command, "--help=list").stdout.decode().splitlines()


def commands_of(program):
    return [line.split("\t")[0] for line in the_list(program) if re.match("[a-z]", line)] or [""]


def every_command_lists_json():
    for program in PROGRAMS:
        for command in commands_of(program):
            assert "--json\tFILE\tfile" in the_list(program, *command.split()), "landmass-%s %s" % (program, command)


# ---- what every report has ----

def with_a_file_the_text_stays_and_the_document_is_the_same():
    plain = start("db", "inspect", here("image.lmdb"))
    both = start("db", "inspect", here("image.lmdb"), "--json", here("inspect.json"))
    assert plain.stdout == both.stdout and both.stderr == b""
    with open(here("inspect.json"), "rb") as file:
        kept = parse(file.read())
    document, text = run("db", "inspect", here("image.lmdb"))
    assert text.encode() == plain.stdout and kept["report"] == document["report"]


def an_error_is_a_message_and_the_document_is_there():
    document, text = run("db", "inspect", here("nosuch"), code=1)
    (message,) = document["messages"]
    assert message["severity"] == "error" and message["place"] == here("nosuch"), message
    assert message["cause"] in text and message["remedy"] is None or message["remedy"] in text


def an_error_in_the_middle_leaves_a_whole_document():
    document, _ = run("db", "build", "--classes", CLASSES, "--terrain", here("scene/terrain.tif"), "--class-raster",
                      here("scene/truth.tif"), "--out", here("bad.lmdb"), "--targets", CLASSES, code=1)
    assert document["messages"] and document["files"] == []
    assert not os.path.exists(here("bad.lmdb"))


def a_command_line_without_sense_writes_nothing():
    done = start("db", "inspect", here("image.lmdb"), "--nosuch", "--json", here("usage.json"))
    assert done.returncode == 2 and not os.path.exists(here("usage.json"))


def the_document_takes_no_file_of_the_run():
    with open(here("image.lmdb"), "rb") as file:
        before = file.read()
    done = start("db", "verify", here("image.lmdb"), "--json", here("image.lmdb"))
    assert done.returncode == 1 and b"is an input" in done.stderr
    done = start("db", "convert", here("image.lmdb"), here("two"), "--json", here("two"))
    assert done.returncode == 1 and b"two outputs" in done.stderr and not os.path.exists(here("two"))
    os.makedirs(here("same"))
    done = start("scene", "--out", here("same"), "--size", "64", "--json", here("same/scene.txt"))
    assert done.returncode == 1 and b"has been written by this run" in done.stderr, done.stderr
    with open(here("image.lmdb"), "rb") as file:
        assert file.read() == before
    assert not [name for name in os.listdir(WORK) if "unfinished" in name]


def a_document_that_cannot_be_written_is_an_error():
    done = start("db", "inspect", here("image.lmdb"), "--json", here("no/where.json"))
    assert done.returncode == 1 and done.stdout == b"" and b"no/where.json" in done.stderr
    with open("/dev/full", "wb") as full:
        done = subprocess.run([os.path.join(BUILD, "bin/landmass-db"), "inspect", here("image.lmdb"), "--json", "-"],
                              stdout=full, stderr=subprocess.PIPE)
    assert done.returncode == 1 and b"standard output cannot be written" in done.stderr


def names_that_are_no_utf_8_do_not_spoil_it():
    name = here("").encode() + b"a\xff\"\\\n\xe2\x82.lmdb"
    done = start("db", "inspect", name, "--json", "-")
    (message,) = parse(done.stdout)["messages"]
    assert message["place"] == here("") + "a\ufffd\"\\\n\ufffd\ufffd.lmdb", message


# ---- the commands ----

def db_plan():
    document, text = run("db", "plan", *SHARDED, "--shards", "4", "--out", here("four.plan"))
    r = document["report"]
    assert [(s["shard"], s["tiles_at_most"], s["memory_mib"]) for s in r["shards"]] == \
        rows(r"^shard (\d+) +at most (\d+) tiles, (\d+) MiB", text) and len(r["shards"]) >= 4
    assert [len(r["shards"]), r["sources"], r["tiles_at_most"]] == \
        find(r"^(\d+) shards of (\d+) sources, together at most (\d+) tiles", text)
    # One of them, as another document of `build`.
    document, text = run("db", "build", "--plan", here("four.plan"), "--shard", "1", "--out", here("1.part"))
    part = document["report"]
    assert [part["shard"], part["shards"], part["tiles"], part["bytes"]] == \
        find(r"^shard (\d+) of (\d+): (\d+) tiles, (\d+) bytes", text) and part["key"] == r["shards"][1]["key"]
    assert part["bytes"] == os.path.getsize(here("1.part"))


def db_join():
    assert start("db", "plan", *SHARDED, "--out", here("join.plan")).returncode == 0
    with open(here("join.plan")) as file:
        parts = [here("join%d.part" % i) for i in range(sum(line.startswith("shard ") for line in file))]
    for number, part in enumerate(parts):
        assert start("db", "build", "--plan", here("join.plan"), "--shard", str(number), "--out", part).returncode == 0
    document, text = run("db", "join", here("join.plan"), "--part", ",".join(parts), "--out", here("joined.lmdb"))
    r = document["report"]
    assert [r["tiles"], r["entries"], r["bytes"]] == find(r"^image (\d+) tiles of (\d+) entries, (\d+) bytes", text)
    assert r["bytes"] == os.path.getsize(here("joined.lmdb"))


def db_inspect():
    document, text = run("db", "inspect", here("image.lmdb"))
    r = document["report"]
    assert r["title"] == "a \"title\"" and r["bytes"] == os.path.getsize(here("image.lmdb"))
    latitude, longitude = find(r"^centre +(\S+), (\S+)$", text)
    assert near(r["centre"]["latitude_deg"], latitude, 1e-6) and near(r["centre"]["longitude_deg"], longitude, 1e-6)
    assert near(r["mean_elevation_m"], *find(r"^mean elevation +(\S+) m", text), 0.1)
    shown = rows(r"^ +(\d+) +([\d.]+) +(\d+) +(\d+)$", text)
    assert [(v["level"], v["tiles"], v["bytes"]) for v in r["levels"]] == [(a, c, d) for a, _, c, d in shown]
    assert all(near(v["cell_m"], row[1], 0.01) for v, row in zip(r["levels"], shown))
    assert [c["name"] for c in r["classes"]][:3] == ["soil", "vegetation", "water"] or len(r["classes"]) >= 6, r["classes"]
    assert sum(s["bytes"] for s in r["sections"]) < r["bytes"] and len(r["heights_m"]) == 16
    assert "title" in r["manifest"] or len(r["manifest"]) > 20
    assert all(b["south_deg"] <= r["centre"]["latitude_deg"] <= b["north_deg"] for b in r["bands"])
    (target,) = r["targets"]
    assert target["name"] == "ferry" and target["speed_m_s"] == 7 and near(target["latitude_deg"], 42.01, 1e-6)
    assert target["mean_rcs_dbsm"] == 42 and target["leg_m"] == 6000


def db_verify():
    document, text = run("db", "verify", here("image.lmdb"))
    r = document["report"]
    shown = find(r": (\d+) bytes, (\d+) entries, (\d+) tiles, (\d+) shared edges, (\d+) tiles against", text)
    assert [r[k] for k in ("bytes", "entries", "tiles", "shared_edges", "tiles_against_level_above")] == shown
    assert r["faults"] == [] and r["fault_count"] == 0 and r["is_complete"] is True
    with open(here("image.lmdb"), "rb") as file:
        damaged = bytearray(file.read())
    damaged[len(damaged) // 2] ^= 1
    with open(here("damaged.lmdb"), "wb") as file:
        file.write(damaged)
    document, text = run("db", "verify", here("damaged.lmdb"), code=1)
    r = document["report"]
    assert r["fault_count"] == len(r["faults"]) > 0 and document["messages"][-1]["severity"] == "error"
    assert [(f["offset_bytes"], f["cause"]) for f in r["faults"]] == \
        [(int(offset, 16), cause) for offset, cause in re.findall(r"^offset (\S+): (.*)$", text, re.M)]


def scene():
    document, _ = run("scene", "--out", here("scene2"), "--size", "64")
    files_of(document, here("scene2"))


def class_counts(r, text):
    shown = rows(r"^(\S[\w -]*?) +(\d+) pixels +([\d.]+) %$", text)
    assert shown[-1][:2] == ("no data", r["pixels_without_data"])
    assert [(c["name"], c["pixels"]) for c in r["classes"]] == [row[:2] for row in shown[:-1]]
    assert all(near(100 * c["share"], row[2], 0.1) for c, row in zip(r["classes"], shown))
    return sum(c["pixels"] for c in r["classes"]) + r["pixels_without_data"]


def confusion(r, text, pixels):
    overall, mean, kappa, shown = find(r"^overall ([\d.]+) %, mean of the classes ([\d.]+) %, kappa ([\d.]+), (\d+) pixels", text)
    assert near(100 * r["overall"], overall, 0.1) and near(100 * r["mean_recall"], mean, 0.1) and near(r["kappa"], kappa, 0.001)
    given = [c["given"] for c in r["classes"]]
    assert r["pixels"] == sum(map(sum, given)) == shown == pixels
    assert abs(sum(given[i][i] for i in range(len(given))) / pixels - r["overall"]) < 1e-9
    for i, c in enumerate(r["classes"]):
        assert abs(c["recall"] - given[i][i] / sum(given[i])) < 1e-9
        find(r"^%s +%s " % (c["name"][:14], " +".join(map(str, given[i]))), text)


SHARDED = ["--classes", CLASSES, "--terrain", here("scene/terrain.tif"), "--cell", "20"]
EXEMPLARS = ["--image", here("scene/image.tif"), "--exemplars", here("scene/exemplars.geojson"), "--classes", CLASSES]


def db_train():
    document, text = run("db", "train", *EXEMPLARS, "--net", here("net2"), "--hold-out", "polygons:0.3", "--epochs", "4",
                         "--committee", "2", "--report", here("train"))
    r = document["report"]
    assert [(e["name"], e["pixels"], e["to_train_on"], e["held_out"]) for e in r["exemplars"]] == \
        rows(r"^(\S+) +(\d+) pixels, +(\d+) to train on, +(\d+) held out", text)
    n = r["network"]
    assert [n["inputs"], *n["hidden"], n["outputs"], n["decay"]] == find(
        r"^network: (\d+) inputs, (\d+) hidden, (\d+) outputs; decay of weights ([0-9.e-]+)", text)
    shown = rows(r"^trained (\d+) epochs, (.*); kept epoch (\d+): RMS error ([\d.]+), recognition ([\d.]+) %", text)
    assert [(m["epochs"], m["stop"], m["kept_epoch"]) for m in r["members"]] == [row[:3] for row in shown] and len(shown) == 2
    assert all(near(m["rms_error"], row[3], 1e-4) and near(100 * m["recognition"], row[4], 0.1)
               for m, row in zip(r["members"], shown))
    _, first, second = text.split("\nExemplars ")
    confusion(r["trained_on"], first, sum(e["to_train_on"] for e in r["exemplars"]))
    confusion(r["held_out"], second, sum(e["held_out"] for e in r["exemplars"]))
    assert r["goal"] == 0.99 and r["goal_is_reached"] is ("goal of 99" not in text)
    assert {os.path.basename(f["path"]) for f in document["files"]} >= {"net2", "confusion_train.csv", "confusion_held_out.csv"}


def db_segment():
    document, text = run("db", "segment", *EXEMPLARS, "--net", here("net"), "--out", here("seg.tif"), "--report",
                         here("segment"), "--reject", "nodata", "--sure", "0.9")
    r = document["report"]
    assert class_counts(r, text) == r["width_px"] * r["height_px"] == 512 * 512
    rejected, of, outside, unsure = find(r"^rejected: (\d+) pixels of (\d+) became nodata; (\d+) outside the range, (\d+) uns", text)
    assert r["rejected"] == {"pixels": rejected, "outside": outside, "unsure": unsure, "became": "nodata"} and of == 512 * 512
    assert r["pixels_without_data"] == rejected > 0
    assert [r["mixtures"]] == find(r"^mixtures: (\d+) pixels took the class of the larger share$", text) and r["mixtures"] > 0
    pixels, fewer = find(r"^sieve: (\d+) pixels took the class around them, in regions of fewer than (\d+) pixels", text)
    assert r["sieve"] == {"pixels": pixels, "speck_pixels": fewer} and pixels > 0
    share, band = find(r"^outside the range of the training: ([\d.]+) % of the pixels; most in band (\d+)", text)
    assert near(100 * r["outside_share"], share, 0.1) and r["outside_worst_band"] == band
    name, share = find(r"^largest class: (\S+), ([\d.]+) %", text)
    assert r["largest_class"] == name and near(100 * r["largest_class_share"], share, 0.1)
    confusion(r["exemplars"], text.split("Exemplars in the segmented")[1], r["exemplars"]["pixels"])


def write_polygon(name, west, south, east, north, **properties):
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    with open(here(name), "w") as file:
        json.dump({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": properties, "geometry":
                   {"type": "Polygon", "coordinates": [ring]}}]}, file)


def db_correct():
    write_polygon("fix.geojson", -29.004, 41.998, -29.002, 41.999, **{"class": "water"})
    document, text = run("db", "correct", "--class-raster", here("scene/truth.tif"), "--classes", CLASSES, "--corrections",
                         here("fix.geojson"), "--out", here("fixed.tif"))
    (change,) = document["report"]["corrections"]
    number, changed, covered = find(r"^correction (\d+) \(water\): (\d+) of (\d+) pixels changed", text)
    assert change == {"id": number, "label": "water", "changed_pixels": changed, "covered_pixels": covered}
    # 0.002 by 0.001 degrees of 5 m pixels at latitude 42
    assert abs(covered - 165.5 * 111.07 / 25) < 45


def db_reflect():
    document, text = run("db", "reflect", "--class-raster", here("scene/truth.tif"), "--classes", CLASSES, "--method", "adjust",
                         "--image", here("scene/image.tif"), "--out", here("gamma.tif"))
    shown = rows(r"^(\S+) +(\d+) pixels  mean +(-?[\d.]+) dB \(table (\S+)\)  spread +([\d.]+) dB \((\S+)\) +(-?[\d.]+) \.\. (-?[\d.]+)", text)
    r = document["report"]["classes"]
    assert len(r) == len(shown) >= 5 and sum(c["pixels"] for c in r) == 512 * 512
    for c, row in zip(r, shown):
        assert (c["name"], c["pixels"], c["table_mean_db"], c["table_spread_db"]) == (row[0], row[1], row[3], row[5])
        assert all(near(c[key], row[i], 0.01)
                   for key, i in (("mean_db", 2), ("spread_db", 4), ("least_db", 6), ("greatest_db", 7)))


def db_mosaic():
    strip = here("strip.tif")
    run("db", "reflect", "--class-raster", here("scene/truth.tif"), "--classes", CLASSES, "--shards", "1", "--shard", "0", "--out", strip)
    document, text = run("db", "mosaic", "--strip", strip, "--out", here("mosaic.tif"))
    width, height, strips = find(r"mosaic.tif: (\d+) x (\d+) pixels of (\d+) strips$", text)
    r = document["report"]
    assert (r["width_px"], r["height_px"], r["strips"]) == (width, height, strips) == (512, 512, 1)
    took = find(r"^done in ([\d.]+) s, ([\d.]+) s of a processor, (\d+) MiB$", text)
    assert all(near(r[key], shown, step) for key, shown, step in zip(("seconds", "processor_s", "memory_mib"), took, (0.1, 0.1, 1)))


def db_infrared():
    document, text = run("db", "infrared", "--class-raster", here("scene/truth.tif"), "--classes", CLASSES, "--hours", "4,14",
                         "--out", here("infrared"))
    r = document["report"]
    day, latitude = find(r"^day (\d+) of the year at (\S+) degrees", text)
    assert r["day_of_year"] == day and near(r["latitude_deg"], latitude, 0.01)
    lines = re.findall(r"^([\d.]+) h, air (\S+) C:(.*)$", text, re.M)
    assert len(lines) == len(r["pictures"]) == 2
    for picture, (hour, air, classes) in zip(r["pictures"], lines):
        assert near(picture["hour"], float(hour), 0.01) and near(picture["air_c"], float(air), 0.1)
        words = classes.split()
        assert [c["name"] for c in picture["classes"]] == words[::2] and len(words) >= 8
        assert all(near(c["mean_c"], float(value), 0.1) for c, value in zip(picture["classes"], words[1::2]))
    files_of(document, here("infrared"))


def db_build():
    document, text = run("db", "build", "--classes", CLASSES, "--terrain", here("scene/terrain.tif"), "--class-raster",
                         here("scene/truth.tif"), "--targets", here("targets"), "--detail", here("scene/detail.txt"),
                         "--out", here("built.lmdb"))
    r = document["report"]
    shown = rows(r"^level (\d+) +cell +([\d.]+) m +(\d+) tiles", text)
    assert shown and [(v["level"], v["tiles"]) for v in r["levels"]] == [(a, c) for a, _, c in shown]
    assert [r["tiles"], r["entries"], r["bytes"]] == find(r"^image (\d+) tiles of (\d+) entries, (\d+) bytes", text)
    assert r["bytes"] == os.path.getsize(here("built.lmdb")) and r["tiles"] == sum(v["tiles"] for v in r["levels"])
    shown = rows(r"^class \d+ +(\S+) +(\d+) cells +([\d.]+) km2", text)
    assert [(c["name"], c["cells"]) for c in r["classes"]] == [row[:2] for row in shown]
    assert all(near(c["area_km2"], row[2], 0.001) for c, row in zip(r["classes"], shown))
    assert [r["cells"], r["cells_by_elevation"], r["cells_beyond_terrain"]] == \
        find(r"^cells (\d+), of them (\d+) classed from elevation, (\d+) beyond", text)
    assert [r["voids"][k] for k in ("interpolated_posts", "sea_posts", "left_void_posts")] == \
        find(r"^voids (\d+) posts interpolated, (\d+) taken as sea, (\d+) left", text)
    assert [r["detail"]["items"], r["detail"]["tiles"]] == find(r"^detail (\d+) items in (\d+) tiles", text)
    assert (r["targets"], r["signatures"]) == (1, 0) and len(r["heights_m"]) == 16
    assert near(r["mean_land_elevation_m"], *find(r"^mean elevation of land (\S+) m", text), 0.1)
    (terrain,) = r["terrain_heights"]
    assert [terrain["path"], terrain["heights"]] == find(r"^terrain from (.*?): (.*)$", text)
    inspected, _ = run("db", "inspect", here("built.lmdb"))
    assert [(v["level"], v["cell_m"], v["tiles"]) for v in inspected["report"]["levels"]] == \
        [(v["level"], v["cell_m"], v["tiles"]) for v in r["levels"]]


def db_convert():
    """Of an image of version 2 see test_convert."""
    document, text = run("db", "convert", here("image.lmdb"), here("converted.lmdb"), code=1)
    (message,) = document["messages"]
    assert message["cause"] in text and document["report"] == {} and document["files"] == []


def db_sign():
    subprocess.run(["openssl", "genpkey", "-algorithm", "ed25519", "-out", here("key.pem")], check=True, capture_output=True)
    document, text = run("db", "sign", "--key", here("key.pem"), "--serial", "5", here("image.lmdb"), here("signed.lmdb"))
    serial, key = find(r"serial (\d+), key (\w+)$", text)
    assert document["report"]["bytes"] == os.path.getsize(here("signed.lmdb"))
    assert document["report"]["signature"] == {"state": "fits", "serial": 5, "key_sha256": key} and serial == 5
    document, _ = run("db", "inspect", here("signed.lmdb"))
    assert document["report"]["signature"]["key_sha256"] == key


def db_export():
    document, text = run("db", "export", here("image.lmdb"), "--out", here("planes"))
    r = document["report"]
    assert [r["width_px"], r["height_px"], r["level"], r["classes"]] == \
        find(r"^(\d+) x (\d+) pixels of level (\d+) \(cell .* m\), (\d+) classes", text)
    assert near(r["cell_m"], *find(r"\(cell ([\d.]+) m\)", text), 0.01) and r["damaged_tiles"] == 0
    assert {os.path.basename(f["path"]) for f in document["files"]} == set(os.listdir(here("planes")))


def db_picture():
    document, text = run("db", "picture", here("image.lmdb"), "--plane", "elevation", "--out", here("plane.png"))
    r = document["report"]
    assert [r["plane"], r["width_px"], r["height_px"], r["level"]] == \
        find(r"^(\w+): (\d+) x (\d+) pixels of .* m, level (\d+) ", text)
    assert all(near(r["area"][key + "_deg"], value, 1e-6) for key, value in
               zip(("south", "west", "north", "east"), find(r"^area: (\S+),(\S+),(\S+),(\S+)$", text)))
    black, white = find(r"^scale: black (\S+) m, white (\S+) m", text)
    assert near(r["black"], black, 0.01) and near(r["white"], white, 0.01)


def db_qgis():
    document, text = run("db", "qgis", "--image", here("scene/image.tif"), "--classes", CLASSES, "--out", here("qgis"))
    paths = [f["path"] for f in document["files"]]
    assert {os.path.basename(path) for path in paths} == set(os.listdir(here("qgis"))) and paths[-1] in text


OSM = """<osm version="0.6"><node id="1" lat="42" lon="-29"/><node id="2" lat="42" lon="-28.9995"/>
<node id="3" lat="42.0005" lon="-28.9995"/><node id="4" lat="42.0005" lon="-29"/><node id="5" lat="42.001" lon="-29"/>
<way id="1"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="4"/><nd ref="1"/><tag k="building" v="yes"/><tag k="height" v="9"/></way>
<way id="2"><nd ref="4"/><nd ref="5"/><tag k="highway" v="primary"/></way><way id="3"><nd ref="4"/><nd ref="99"/><nd ref="98"/>
<tag k="building" v="yes"/></way></osm>"""


def db_vectors():
    folder = os.path.dirname(CLASSES)
    with open(here("town.osm"), "w") as file:
        file.write(OSM)
    document, text = run("db", "vectors", "--vectors", here("town.osm"), "--rules", folder + "/osm.rules", "--classes",
                         folder + "/landcover.classes", "--area", "41.999,-29.002,42.002,-28.998", "--out", here("town.tif"),
                         "--detail", here("town.detail"))
    r = document["report"]
    (source,) = r["sources"]
    assert source["nodes"]["read"] == 5 and source["ways"]["read"] == 3 and source["ways"]["made"] == 2
    assert source["ways"]["lost_dangling"] + source["ways"]["lost_open_ring"] == 1 and source["missing_nodes"] == 2
    for kind in ("nodes", "ways"):
        assert source[kind]["read"] == sum(v for key, v in source[kind].items() if key != "read")
    assert sum(rule["features"] for rule in r["rules"]) == 2
    building = [rule for rule in r["rules"] if rule["heights"] and sum(h["features"] for h in rule["heights"])]
    assert [h["features"] for h in building[0]["heights"] if h["tag"] == "height"] == [1], building
    detail = r["detail"]
    assert [detail["buildings"], detail["boxes"], detail["walls"], detail["lines"], detail["masts"]] == \
        find(r"^detail: (\d+) buildings in (\d+) boxes .*, (\d+) walls, (\d+) lines, (\d+) masts", text)
    # 0.0005 degrees each way at latitude 42: 55.5 m by 41.4 m
    assert detail["buildings"] == 1 and abs(detail["footprint_m2"] - 55.5 * 41.4) < 25
    assert class_counts(r, text) == r["width_px"] * r["height_px"]
    assert r["area"] == {"south_deg": 41.999, "west_deg": -29.002, "north_deg": 42.002, "east_deg": -28.998}


OBJ = """mtllib town.mtl
v 0 0 0\nv 40 0 0\nv 40 40 0\nv 0 40 0\nv 10 10 12\nv 20 10 12\nv 20 20 12\nv 10 20 12
usemtl grass\nf 1 2 3\nf 1 3 4\nusemtl roof\nf 5 6 7\nf 5 7 8
"""


def db_import():
    with open(here("town.obj"), "w") as file:
        file.write(OBJ)
    with open(here("town.mtl"), "w") as file:
        file.write("newmtl grass\nKd 0 1 0\nnewmtl roof\nKd 1 0 0\n")
    with open(here("town.map"), "w") as file:
        file.write("grass = soil\nroof = structure\n")
    document, text = run("db", "import", "--model", here("town.obj"), "--unit", "m", "--up", "z", "--at", "42,-29", "--cell", "1",
                         "--classes", CLASSES, "--map", here("town.map"), "--out-classes", here("model.tif"), "--out-heights",
                         here("model-h.tif"), "--out-terrain", here("model-t.tif"))
    r = document["report"]
    (model,) = r["models"]
    assert (model["triangles"], model["left_out"]) == (4, 0) and (r["width_px"], r["height_px"]) == (40, 40)
    assert r["seen_pixels"] == 1600 and r["pixels_above_ground"] == 100, r
    assert [r["pixels_above_ground"]] == find(r"^heights: (\d+) cells", text)
    assert class_counts(r, text) == 1600 and {c["name"]: c["pixels"] for c in r["classes"]}["structure"] == 100


def files_of(document, folder):
    """What the run says it wrote is what is there."""
    assert {os.path.basename(f["path"]) for f in document["files"]} == set(os.listdir(folder)), document["files"]


def writes_only(program, command, *arguments):
    """A command without a report: its files alone."""
    document, _ = run(program, *command.split(), *arguments)
    assert document["report"] == {} and document["files"], document
    return document


def kept(r, text):
    gaps, limit, jumps, holds, alone = find(r"^kept as they are: (\d+) gaps \(over (\S+) s\), (\d+) jumps .*, (\d+) repeated positions, (\d+) fixes", text)
    assert [r["gaps"], r["jumps"], r["repeated_positions"], r["isolated_fixes"]] == [gaps, jumps, holds, alone]
    assert near(r["gap_limit_s"], limit, 0.01)
    span, interval = find(r"^track: \d+ fixes over (\S+) s, median interval (\S+) s", text)
    assert near(r["span_s"], span, 0.1) and near(r["median_interval_s"], interval, 0.01)


def dis():
    import struct
    body = struct.pack(">HHHBB", 1, 2, 3, 1, 0) + 2 * struct.pack(">BBHBBBB", 1, 1, 225, 6, 0, 0, 0)
    body += struct.pack(">3f3d3fI", 0, 5, 0, 6378137, 0, 0, 1.5, 0, 0, 0) + b"\2" + bytes(39) + b"\1CAR" + bytes(12)
    with open(here("one.pdu"), "wb") as file:
        file.write(struct.pack(">BBBBIHH", 7, 1, 1, 1, 0, 12 + len(body), 0) + body + b"\7odd")
    document, text = run("dis", "--pdu", here("one.pdu"), "--out", here("dis.log"))
    r = document["report"]
    assert [r["datagrams"], r["pdus"], r["entity_states"], r["entity_state_updates"], r["commands"], r["other_pdus"]] == \
        find(r"^datagrams: (\d+) with (\d+) PDUs: (\d+) entity states, (\d+) updates, (\d+) commands, (\d+) others", text)
    assert [sum(r["refused"].values()), r["refused"]["header"]] == find(r"^refused: (\d+); (\d+) no whole header", text) == [1, 1]
    assert [r["entities"], r["entities_skipped"]] == find(r"^entities: (\d+); (\d+) skipped", text)
    assert [r["sets"], r["new_sets"], r["removals"], r["frames"]] == \
        find(r"^sent: (\d+) sets \((\d+) new.* and (\d+) removals, (\d+) frames", text)
    with open(here("dis.log")) as file:
        assert r["frames"] == len(file.readlines())
    (entity,) = r["entities_at_end"]
    assert entity["id"] == "1:2:3" and entity["marking"] == "CAR" and entity["target_kind"] == "car"


def ios():
    os.makedirs(here("site"), exist_ok=True)
    with open(here("site/index.html"), "w") as file:
        file.write("<title>station</title>")
    document, text = run("ios", "--image", here("image.lmdb"), "--site", here("site"), "--port", "0", "--seconds", "0.2")
    r = document["report"]
    assert [r["pages"], r["requests"], r["frames_heard"], r["frames_sent"], r["frames_not_sent"]] == \
        find(r"^(\d+) pages, (\d+) requests; (\d+) frames heard, (\d+) sent, (\d+) not sent", text) == [0, 0, 0, 0, 0]
    assert len(r["refused"]) == 13 and sum(r["refused"].values()) == 0


def nav():
    document, text = run("nav", "--straight", "42.045,-29.18,90,3000,180", "--seconds", "20", "--out", here("flight.log"))
    r = document["report"]
    frames, active = find(r"^sent: (\d+) frames in ([\d.]+) s", text)
    with open(here("flight.log")) as file:
        assert r["frames"] == frames == len(file.readlines())
    assert near(r["active_s"], active, 0.1) and [r["fixes"]] == find(r"^track: (\d+) fixes", text)
    shown = find(r"^left out: (\d+) malformed, (\d+) out of order, (\d+) without a position, (\d+) repeated in motion, (\d+) bar", text)
    assert list(r["left_out"].values()) == shown
    kept(r, text)
    with open(here("bad.csv"), "w") as file:
        file.write("timestamp,latitude,longitude,altitude_m\n0,42,-29,3000\n1,42.001,-29,3000\nx,1,1,1\n2,42.002,-29,3000\n")
    r = run("nav", here("bad.csv"), "--out", here("bad.log"))[0]["report"]
    assert r["fixes"] == 3 and r["left_out"]["malformed"] == 1 and r["height_datum"], r
    recorded = os.path.join(os.environ.get("LANDMASS_DATA", "../shared/data"), "nav_tracks/zero_gravity.csv.gz")
    if os.path.exists(recorded):
        document, text = run("nav", recorded, "--out", here("zero.log"), "--seconds", "30")
        kept(document["report"], text)
        assert document["report"]["jumps"] > 0 and document["report"]["left_out"]["repeated_in_motion"] > 0


def bus_decode():
    document, text = run("bus", "decode", here("flight.log"))
    r = document["report"]
    assert [r["frames"], r["malformed"]] == find(r"^# (\d+) frames, (\d+) lines not read", text)
    assert [r["values"]] == find(r"^# values: (\d+)", text) and r["frames"] > 1000
    assert r["frames"] == sum(v for key, v in r.items() if key not in ("items", "frames", "malformed", "torn_pairs", "sequence_breaks", "stuck", "fast_packets"))


def bus_fields():
    document, text = run("bus", "fields")
    assert [(f["name"], f["unit"]) for f in document["report"]["fields"]] == re.findall(r"^(\S+) +(.+)$", text, re.M)


def bus_table():
    document, text = run("bus", "table")
    assert document["report"]["items"] == len(re.findall(r"^\| \d", text, re.M)) > 10


def bus_dbc():
    document, _ = run("bus", "dbc", "--out", here("bus.dbc"))
    assert document["report"]["items"] > 10 and document["files"][0]["path"] == here("bus.dbc")


def bus_filters():
    document, text = run("bus", "filters")
    assert document["report"]["filters"] == len(text.splitlines()) > 0


def bus_reports():
    document, text = run("bus", "reports")
    assert document["report"]["reports"] == len(re.findall(r"^\| \d", text, re.M)) > 0


def bus_controls():
    document, text = run("bus", "controls")
    assert document["report"]["controls"] == len(re.findall(r"^\| \d", text, re.M)) > 0


def sim():
    with open(here("script"), "w") as file:
        file.write("0 range 10\n3 picture one\n")
    document, text = run("sim", "--db", here("image.lmdb"), "--bus", here("flight.log"), "--script", here("script"), "--png",
                         here("glass"), "--every", "0", "--seconds", "5")
    r = document["report"]
    assert [r["frames"], r["lines"], r["lines_dropped"], r["pictures_written"]] == \
        find(r"^frames (\d+), lines (\d+) \((\d+) dropped\), pictures written (\d+)", text)
    assert [r["bus"]["frames"], r["bus"]["malformed"], r["bus"]["errors"], r["position_jumps"], r["commands_refused"]] == \
        find(r"^bus: \S+: (\d+) frames, (\d+) malformed, (\d+) errors; position jumps (\d+); commands refused (\d+)", text)
    assert [r["bus"][k] for k in ("values", "not_used", "refused_length", "refused_node", "refused_type",
                                  "refused_not_a_number", "refused_range")] == \
        find(r"^ +(\d+) values, (\d+) frames of other use; refused: (\d+) length, (\d+) node, (\d+) type, (\d+) no number, (\d+) r", text)
    tiles = r["tiles"]
    read, evicted, hits, substituted, off = find(r"^tiles: (\d+) read .*, (\d+) evicted; ([\d.]+) % of look-ups hit, (\d+) answered by a coarser tile, (\d+) off", text)
    assert [tiles[k] for k in ("read", "evicted", "substituted", "off_map")] == [read, evicted, substituted, off] and read > 0
    assert near(100 * tiles["hits"] / (tiles["hits"] + tiles["misses"]), hits, 0.01)
    assert list(r["faults"].values()) == find(r"^faults: (\d+) flash reads failed, (\d+) records corrupt, (\d+) requests dropped, (\d+) d", text)
    assert r["map_is_usable"] is True and r["targets"]["held"] == 1 and r["pictures_written"] == 1
    first = r["images"][0]
    assert len(r["images"]) == 1 and [first["place"], first["path"], first["state"]] == [1, here("image.lmdb"), "flown"]
    assert first["title"] and 0 < first["cell_m"] < 100
    several, _ = run("sim", "--db", here("image.lmdb"), "--db2", here("flight.log"), "--db4", here("image.lmdb"), "--seconds", "0.1")
    assert [(i["place"], i["state"], i["title"], i["cell_m"]) for i in several["report"]["images"]] == \
        [(1, "flown", first["title"], first["cell_m"]), (2, "not usable", None, None), (4, "flown", first["title"], first["cell_m"])]
    files_of(document, here("glass"))


def reference(mode):
    return lambda: writes_only("reference", mode, here("image.lmdb"), "--cells", "16", "--out", here(mode + ".csv"))


def figures(name):
    return lambda: writes_only("figures", name, here(name + ".png"))


def tables(name):
    return lambda: writes_only("tables", name, here(name + ".c"))


def target_model():
    document, text = run("target", "model", "--model", "tank")
    r = document["report"]
    assert [r["triangles"], r["parts"], r["materials"]] == find(r"^(\d+) triangles in (\d+) parts, (\d+) materials", text)
    shown = find(r"^ahead (\S+) to (\S+) m, left (\S+) to (\S+) m, up (\S+) to (\S+) m", text)
    corners = [r[corner][axis] for axis in ("ahead_m", "left_m", "up_m") for corner in ("least", "greatest")]
    assert all(near(a, b, 0.001) for a, b in zip(corners, shown))
    assert [r[k] for k in ("open_edges", "turned_edges", "inside_out_parts", "triangles_without_area")] == \
        find(r"^(\d+) open edges, (\d+) edges whose sides disagree, (\d+) parts inside out, (\d+) tri", text)


def target_trace():
    document, text = run("target", "trace", "--model", "tank", "--rays", "1", "--out", here("tank.trace"))
    r = document["report"]
    columns, rows_, rays, bounces = re.search(r"^(\d+) x (\d+) primary rays, (\d+) rays in all; reflections by bounce:([ \d]+)", text, re.M).groups()
    assert [r["columns"], r["rows"], r["rays"]] == [int(columns), int(rows_), int(rays)]
    assert r["reflections"] == [int(word) for word in bounces.split()] and r["primary_rays"] == int(columns) * int(rows_)


def target_render():
    document, _ = run("target", "render", "--records", here("tank.trace"), "--csv", here("tank.csv"))
    with open(here("tank.csv")) as file:
        lines = file.read().splitlines()
    assert (document["report"]["height_px"], document["report"]["width_px"]) == (len(lines), len(lines[0].split(",")))
    document, text = run("target", "render", "--records", here("tank.trace"), "--coherent", "--complex", here("tank.tif"))
    assert near(document["report"]["peak_dbsm"], find(r"^brightest pixel: (\S+) dBsm", text)[0], 0.01)


def target_map():
    document, text = run("target", "map", "--model", "tank", "--rays", "1", "--csv", here("map.csv"))
    r = document["report"]
    shown = re.findall(r"^ *(\d+|ground) .* (\S+) % +(\d+) +(\S+)$", text, re.M)
    assert len(shown) == len(r["parts"]) > 20 and near(sum(p["power_share"] for p in r["parts"]), 1, 1e-6)
    for part, (name, power, cells, height) in zip(r["parts"], shown):
        assert part["part"] == (0 if name == "ground" else int(name)) and part["cells"] == int(cells)
        assert near(100 * part["power_share"], float(power), 0.01) and near(part["echo_height_m"], float(height), 0.01)
    heights = find(r"^heights of echoes: (\S+) to (\S+) m", text)
    assert near(r["least_height_m"], heights[0], 0.01) and near(r["greatest_height_m"], heights[1], 0.01)


def target_sheet():
    writes_only("target", "sheet", "--model", "tank", "--rays", "1", "--out", here("sheet.png"))


def target_bake():
    document, text = run("target", "bake", "--model", "tank", "--rays", "1", "--aspects", "2", "--depressions", "10,20", "--out",
                         here("tank.sig"))
    r = document["report"]
    assert [r["name"], r["chips"], r["aspects"], r["depressions"]] == find(r"^(\w+): (\d+) chips, (\d+) aspects by (\d+) depr", text)
    assert document["files"][0]["bytes"] == find(r", (\d+) bytes$", text)[0]
    shown = find(r"^cross section (\S+) dBsm in the mean, (\S+) to (\S+); gain (\S+) dB; (\S+) %", text)
    for key, value, step in zip(("mean_rcs_dbsm", "least_rcs_dbsm", "greatest_rcs_dbsm", "gain_db"), shown, (0.1, 0.1, 0.1, 0.01)):
        assert near(r[key], value, step), key
    assert near(100 * r["lost_share"], shown[4], 0.01)


def target_curves():
    writes_only("target", "curves", "--out", here("curves.png"))


def target_materials():
    document, text = run("target", "materials")
    shown = [line.split("#")[0].split() for line in text.splitlines() if not line.startswith("#")]
    assert [[v if isinstance(v, str) else "%.12g" % v for v in list(m.values())[:11]] for m in document["report"]["materials"]] == shown
    document, text = run("target", "materials", "--bands")
    for m in document["report"]["materials"]:
        shown = find("^" + m["name"] + r" +\S+ +(\S+) +\S+ +(\S+) +\S+ +(\S+) +\S+ +(\S+)$", text)
        assert all(near(band["reflection_db"], value, 0.01) for band, value in zip(m["bands"], shown))


def target_bench():
    document, text = run("target", "bench", "--model", "tank", "--rays", "1", "--seconds", "0.1")
    r = document["report"]
    shown = dict(line.split(" ", 1) for line in text.splitlines())
    assert [str(r[k]) for k in ("columns", "rows", "primary_rays", "rays")] == \
        [shown[k] for k in ("columns", "rows", "primary_rays", "rays")]
    assert near(1e3 * r["trace_cpu_s"], float(shown["trace_cpu_ms"]), 0.01) and near(1e3 * r["chip_s"], float(shown["chip_ms"]), 0.01)


NETEM = ["--model", "slicy", "--cells", "64", "--rays", "1"]


def score(r, text, what):
    assert (r["what"], r["chips"]) == tuple(find(r"^(\S+), (\d+) chips:", text)) and r["what"] == what
    for key, name in (("learned", "learned"), ("own_law", "own law")):
        shown = find(r"^  %s +mse (\S+) +ssim (\S+) +cw-ssim (\S+), at its best gain \((\S+)\) (\S+)$" % name, text)
        for member, value, step in zip(("mse", "ssim", "cw_ssim", "best_gain", "best_cw_ssim"), shown, (1e-6, 1e-4, 1e-4, 0.01, 1e-4)):
            assert near(r[key][member], value, step), (key, member)


def epochs(r, text):
    shown = rows(r"^epoch (\d+)\t(\S.*?)\ttraining (\S+)\tvalidation (\S+)\t", text)
    assert [(e["epoch"], e["phase"]) for e in r] == [row[:2] for row in shown] and len(shown) >= 4
    assert all(near(e["training_loss"], row[2], 1e-6) and near(e["validation_loss"], row[3], 1e-6) for e, row in zip(r, shown))


def netem_recover():
    document, text = run("netem", "recover", *NETEM, "--number", "6", "--looks", "2", "--epochs", "3", "--pix-epochs", "2", "--out",
                         here("learned"))
    r = document["report"]
    epochs(r["epochs"], text)
    score(r["score"], text, "validation")
    assert near(r["validation_loss"], *find(r"^validation loss (\S+) ", text), 1e-6)
    shown = rows(r"^mean error of the law, (\w+), (\S+): (\S+) over (\d+) reflections", text)
    assert [(e["direction"], e["material"], e["reflections"]) for e in r["law_errors"]] == [(a, b, d) for a, b, _, d in shown]
    assert {os.path.basename(f["path"]) for f in document["files"]} == set(os.listdir(here("learned")))


def netem_simulate():
    document, _ = run("netem", "simulate", *NETEM, "--training", here("learned/training.netem"), "--views", "4", "--out", here("made"))
    files_of(document, here("made"))
    with open(here("made/list"), "w") as file:
        for i, azimuth in enumerate(("000", "090", "180", "270")):
            file.write("%s.00.csv %s 15 0 0 1 %s\n" % (azimuth, azimuth, "training" if i < 2 else "validation"))


def netem_score():
    document, text = run("netem", "score", *NETEM, "--training", here("learned/training.netem"), "--chips", here("made/list"), "--out",
                         here("scored"))
    score(document["report"]["score"], text, "validation")
    assert document["report"]["score"]["chips"] == 2


def netem_train():
    document, text = run("netem", "train", *NETEM, "--chips", here("made/list"), "--epochs", "3", "--pix-epochs", "2", "--out",
                         here("trained"))
    epochs(document["report"]["epochs"], text)


def netem_register():
    document, text = run("netem", "register", *NETEM, "--chips", here("made/list"), "--views", "8", "--shift", "1", "--out", here("found"))
    r = document["report"]
    chips, views, correlation, opposite = find(r"^(\d+) chips against (\d+) views: correlation (\S+), that of the opposite views (\S+)$", text)
    assert (r["chips"], r["views"]) == (chips, views) == (4, 8)
    assert near(r["correlation"], correlation, 0.001) and near(r["opposite_correlation"], opposite, 0.001)
    assert [r["ambiguous"], r["better_elsewhere"]] == find(r"^ambiguous .*: (\d+); fits better: (\d+)$", text)


def netem_plot():
    document, _ = run("netem", "plot", "--training", here("learned/training.netem"), "--out", here("drawn"))
    files_of(document, here("drawn"))


def netem_bake():
    document, text = run("netem", "bake", "--model", "slicy", "--rays", "1", "--aspects", "2", "--depressions", "15", "--training",
                         here("learned/training.netem"), "--out", here("learned.sig"))
    assert document["report"]["chips"] == find(r": (\d+) chips,", text)[0] == 2


def netem_paper():
    """Its chips are nobody's to hand on: how it refuses, alone. What it prints are trainings as `recover` reports them."""
    document, _ = run("netem", "paper", "--slicy-15", here("none"), "--slicy-30", here("none"), "--out", here("paper"), code=1)
    assert document["messages"][-1]["severity"] == "error" and document["files"] == []


def radar_print():
    document, text = run("radar", "print")
    assert document["report"] == {} and document["files"] == []
    with open(here("my.radar"), "w") as file:
        file.write(text)


def radar_check():
    document, text = run("radar", "check", here("my.radar"))
    r = document["report"]
    assert [r["name"], r["band"], r["scales"]] == find(r": radar (\S+), band (\S+), (\d+) scales: no faults", text)
    with open(here("my.radar")) as file:
        wrong = re.sub(r"^name .*$", "name = " + 99 * "x", file.read(), flags=re.M)
    with open(here("wrong.radar"), "w") as file:
        file.write(wrong)
    document, _ = run("radar", "check", here("wrong.radar"), code=1)
    assert document["messages"][-1]["place"].startswith(here("wrong.radar")), document["messages"]


def radar_record():
    writes_only("radar", "record", here("my.radar"), here("my.record"))


SLOTS = ["--slot-a", os.path.join(WORK, "slot-a"), "--slot-b", os.path.join(WORK, "slot-b")]


def load_put():
    document, text = run("load", "put", here("image.lmdb"), "--unsigned", *SLOTS)
    r = document["report"]
    load, written, kept = find(r"^slot A: load (\d+), (\d+) bytes written, (\d+) were there;", text)
    assert (r["load"], r["written_bytes"], r["kept_bytes"]) == (load, written, kept)
    assert r["slot"] == here("slot-a") and r["is_there_already"] is False and r["bad_blocks"] == 0
    assert r["image_bytes"] == os.path.getsize(here("image.lmdb")) == written + kept
    document, text = run("load", "put", here("image.lmdb"), "--unsigned", *SLOTS)
    assert document["report"]["is_there_already"] is True and "already" in text
    document, _ = run("load", "put", here("damaged.lmdb"), "--unsigned", *SLOTS, code=1)
    assert "nothing was written" in document["messages"][-1]["remedy"] and document["files"] == []


def load_send():
    """Both ends, over a socket; receive's report is looked at, too."""
    path, conf = here("wire"), here("wire.conf")
    with open(conf, "w", encoding="utf-8") as file:
        file.write("slot.a = %s\nslot.b = %s\ndatabase.trust = any\ndatabase.serial = none\nslot.progress = none\n" %
                   (here("wire-a"), here("wire-b")))
    receiver = subprocess.Popen([os.path.join(BUILD, "bin/landmass-load"), "receive", "--once", "--socket", path, "--config",
                                 conf, "--json", here("wire.json")], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 60
    while not os.path.exists(path) and time.monotonic() < deadline:
        time.sleep(0.01)
    document, text = run("load", "send", here("image.lmdb"), "--socket", path)
    printed = receiver.communicate(timeout=60)[0].decode()
    r, size = document["report"], os.path.getsize(here("image.lmdb"))
    assert find(r"^(\d+) bytes sent; the panel had (\d+) already$", text) == [r["sent_bytes"], r["same_bytes"]]
    assert r["panel"] in text and (r["load"], r["image_bytes"], r["is_there_already"]) == (1, size, False)
    with open(here("wire.json"), encoding="utf-8") as file:
        (load,) = parse(file.read())["report"]["loads"]
    assert find(r"^slot A: load (\d+), (\d+) bytes written, (\d+) were there;", printed) == \
        [load["load"], load["written_bytes"], load["kept_bytes"]]
    assert load["is_done"] is True and (load["sent_bytes"], load["image_bytes"]) == (r["sent_bytes"], size)


def load_receive():
    """The other end is looked at by load_send; here nobody has made its FunctionFS."""
    document, _ = run("load", "receive", "--functionfs", here("nothing"), code=1)
    assert "is no FunctionFS" in document["messages"][-1]["cause"]


def slots_of(command):
    document, text = run("load", command, *SLOTS)
    a, b = document["report"]["slots"]
    load, size, title = find(r"^slot A: \S+: whole, load (\d+), (\d+) bytes, (.*); flown next$", text)
    assert (a["state"], a["load"], a["image_bytes"], '"%s"' % a["title"]) == ("whole", load, size, title), a
    assert a["is_flown_next"] is True and a["cause"] is None and a["path"] == here("slot-a")
    assert (b["state"], b["is_flown_next"], b["title"]) == ("absent", False, None) and "No such file" in b["cause"]


def load_show():
    slots_of("show")


def load_verify():
    slots_of("verify")
    with open(here("slot-a"), "r+b") as file:
        file.seek(os.path.getsize(here("image.lmdb")) // 2)
        byte = file.read(1)
        file.seek(-1, os.SEEK_CUR)
        file.write(bytes([byte[0] ^ 1]))
    document, text = run("load", "verify", *SLOTS, code=1)
    a = document["report"]["slots"][0]
    (offset,) = re.findall(r"^slot A: \S+: damaged, offset (\S+): ", text, re.M)
    assert a["state"] == "damaged" and a["cause_offset_bytes"] == int(offset, 16) and a["cause"] in text


class Skip(Exception):
    pass


def history():
    data = os.environ.get("LANDMASS_DATA", "../shared/data")
    path = os.path.join(data, "gotcha_xband/data_3dsar_pass1_az001_HH.mat")
    if not os.path.exists(path):
        raise Skip("the Gotcha set is not here")
    return path


def cut(r, words, steps):
    return all(near(r[key], value, step) for (key, step), value in zip(steps, words))


def netem_response():
    document, text = run("netem", "response", "--history", history())
    r = document["report"]
    shown = rows(r"^(-?[\d.]+), (-?[\d.]+) +(range|cross) +([\d.]+) +(-?[\d.]+) dB +(-?[\d.]+) dB", text)
    assert len(shown) == 2 * len(r["points"]) > 0
    for i, (x, y, direction, *words) in enumerate(shown):
        point = r["points"][i // 2]
        assert near(point["x_m"], x, 0.01) and near(point["y_m"], y, 0.01)
        assert cut(point[direction], words, (("main_lobe_difference", 1e-4), ("side_lobe_db", 0.1), ("real_side_lobe_db", 0.1)))
    for key, name in (("simulated", "simulated"), ("real", "real even ground")):
        words = find(r"^%s +(\d+) +(\S+) +(\S+) +(\S+) +(\S+)$" % name, text)
        assert cut(r[key], words, (("cells", 1), ("cv_power", 1e-3), ("cv_amplitude", 1e-3), ("std_db", 0.01), ("ks", 1e-4)))


def realradar_focus():
    document, text = run("realradar", "focus", history(), "--size", "50", "--out", here("focus"))
    r = document["report"]
    assert [r["frequencies"], r["pulses"]] == find(r"^(\d+) frequencies, .*; (\d+) pulses", text)
    for key, name in (("firmware", "simulated: the firmware, 1 look"), ("noise", "noise through the same processing"),
                      ("real", "real: bright even ground")):
        words = find(r"^\| %s +\| +(\d+) \| (\S+) \| (\S+) \| (\S+) \| (\S+) \| (\S+) \|" % name, text)
        assert cut(r[key], words, (("cells", 1), ("cv_power", 1e-3), ("cv_amplitude", 1e-3), ("std_db", 0.01), ("ks", 1e-4), ("enl", 1e-3)))
    shown = rows(r"^\| [a-z].*? +\| (range|cross) +\| (\S+) m \| (\S+) \| (\S+) \| (\S+) \|", text)
    points = [point[direction] for key in ("points_unweighted", "points_taylor") for point in r[key] for direction in ("range", "cross")]
    assert len(shown) == len(points) >= 4
    for point, (_, *words) in zip(points, shown):
        assert cut(point, words, (("irw_m", 1e-3), ("irw_cells", 1e-3), ("pslr_db", 0.01), ("islr_db", 0.01)))
    assert len(r["windows"]) == len(re.findall(r"\| (?:bright|dark) \|", text)) > 0


def realradar_classes():
    """A radar that is the database turned upside down: its ranks are the other way round."""
    subprocess.run(["gdal_translate", "-q", "-scale", "-100", "100", "100", "-100", here("gamma.tif"), here("radar.tif")], check=True)
    document, text = run("realradar", "classes", "--classes", CLASSES, "--class-raster", here("scene/truth.tif"), "--reflectivity",
                         here("gamma.tif"), "--radar", here("radar.tif"))
    r = document["report"]
    shown = rows(r"^\| (\S+) +\| +(\d+) \| +(\S+) \( *(\S+) \.\. *(\S+)\) \|", text)
    assert [(c["name"], c["pixels"]) for c in r["classes"]] == [row[:2] for row in shown] and len(shown) >= 5
    for c, row in zip(r["classes"], shown):
        assert cut(c["measured"], row[2:], (("median_db", 0.1), ("low_db", 0.1), ("high_db", 0.1)))
        assert abs(c["measured"]["median_db"] + c["database"]["median_db"]) < 0.01
    assert [r["pairs_in_order"], r["pairs"]] == find(r"^pairs of classes in the same order: (\d+) of (\d+)$", text)
    assert r["pairs_in_order"] == 0 and r["class_rank_correlation"] == -1 and r["pixel_rank_correlation"] < -0.8


def every_command_is_checked_here():
    """By the programs' own lists, so that a new command cannot be left out."""
    commands = {("%s %s" % (program, command)).strip() for program in PROGRAMS for command in commands_of(program)}
    assert commands == set(CHECKS), commands ^ set(CHECKS)


def the_document_lists_every_command():
    text = open("docs/json.md").read()
    for name in CHECKS:
        program, *command = name.split()
        section = text.split("## landmass-%s\n" % program)
        assert len(section) == 2 and (not command or "`%s`" % command[0] in section[1].split("## ")[0]), name


# In this order: some read what others wrote.
CHECKS = {"db import": db_import, "db train": db_train, "db segment": db_segment, "db correct": db_correct,
          "db vectors": db_vectors, "db reflect": db_reflect, "db mosaic": db_mosaic, "db infrared": db_infrared,
          "db build": db_build, "db plan": db_plan, "db join": db_join, "db inspect": db_inspect, "db convert": db_convert, "db sign": db_sign, "db verify": db_verify, "db qgis": db_qgis, "db export": db_export,
          "db picture": db_picture, "scene": scene, "nav": nav, "dis": dis, "ios": ios, "bus decode": bus_decode, "bus fields": bus_fields,
          "bus table": bus_table, "bus dbc": bus_dbc, "bus filters": bus_filters, "bus reports": bus_reports,
          "bus controls": bus_controls, "sim": sim,
          "load put": load_put, "load send": load_send, "load receive": load_receive, "load show": load_show, "load verify": load_verify,
          "radar print": radar_print, "radar check": radar_check, "radar record": radar_record,
          "reference sar": reference("sar"), "reference gm": reference("gm"), "reference sector": reference("sector"),
          "figures figure1": figures("figure1"), "figures table1": figures("table1"), "tables fixed": tables("fixed"),
          "tables grain": tables("grain"), "tables noise": tables("noise"), "tables response": tables("response"),
          "tables grown": tables("grown"), "target model": target_model, "target trace": target_trace,
          "target render": target_render, "target map": target_map, "target sheet": target_sheet, "target bake": target_bake,
          "target curves": target_curves, "target materials": target_materials, "target bench": target_bench,
          "netem recover": netem_recover, "netem simulate": netem_simulate, "netem score": netem_score,
          "netem train": netem_train, "netem register": netem_register, "netem plot": netem_plot, "netem bake": netem_bake,
          "netem response": netem_response, "netem paper": netem_paper, "realradar focus": realradar_focus,
          "realradar classes": realradar_classes}
CASES = [every_command_lists_json, every_command_is_checked_here, the_document_lists_every_command,
         with_a_file_the_text_stays_and_the_document_is_the_same,
         an_error_is_a_message_and_the_document_is_there, an_error_in_the_middle_leaves_a_whole_document,
         a_command_line_without_sense_writes_nothing, the_document_takes_no_file_of_the_run,
         a_document_that_cannot_be_written_is_an_error, names_that_are_no_utf_8_do_not_spoil_it]


def prepare():
    shutil.rmtree(WORK, ignore_errors=True)
    os.makedirs(WORK)
    done = start("scene", "--out", here("scene"), "--size", "512")
    assert done.returncode == 0, done.stderr
    done = start("db", "train", *EXEMPLARS, "--net", here("net"), "--epochs", "3")
    assert done.returncode == 0, done.stderr
    with open(here("targets"), "w") as file:
        file.write("target ferry 42.01 -29.01 ground+6 20 swerling 1 42 moving 7 6000\n")
    done = start("db", "build", "--classes", CLASSES, "--terrain", here("scene/terrain.tif"), "--class-raster",
                 here("scene/truth.tif"), "--targets", here("targets"), "--title", "a \"title\"", "--out", here("image.lmdb"))
    assert done.returncode == 0, done.stderr


def main():
    prepare()
    cases = [(case.__name__.replace("_", " "), case) for case in CASES] + \
        [("the figures of %s are those of its text" % name, check) for name, check in CHECKS.items()]
    print("1..%d" % len(cases))
    failed = 0
    for number, (name, case) in enumerate(cases, 1):
        try:
            case()
            print("ok %d - %s" % (number, name))
        except Skip as reason:
            print("ok %d - %s # SKIP\n# skipped: %s" % (number, name, reason))
        except Exception:
            failed += 1
            print("not ok %d - %s" % (number, name))
            print("# %s" % traceback.format_exc().strip().replace("\n", "\n# "))
    sys.exit(failed > 0)


main()
