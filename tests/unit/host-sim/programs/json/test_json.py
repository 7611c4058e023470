#!/usr/bin/env python3
"""Every command writes its report as JSON (docs/json.md): each is run with --json, what it writes is read by Python, and its
figures are compared with the text for people and with what is known otherwise.

TAP on standard output. BUILD names the build's folder.
"""

import json
import os
import re
import shutil
import subprocess
import sys

BUILD = os.environ.get("BUILD", "build/bench-linux")
WORK = os.path.join(BUILD, "tmp/json")
CLASSES = "host-sim/programs/db/classes/heaton6.classes"
PROGRAMS = ["bus", "db", "figures", "nav", "netem", "realradar", "reference", "scene", "sim", "tables", "target"]
HEAD = ["schema", "program", "command", "version", "report", "messages", "files", "seconds", "exit_code"]
KEY = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*$")


def unlike(pairs):
    """An object whose keys differ and are of our form."""
    keys = [key for key, _ in pairs]
    assert len(set(keys)) == len(keys), "a key is there twice: %s" % keys
    assert all(KEY.match(key) for key in keys), "keys %s" % keys
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
    assert {os.path.basename(f["path"]) for f in document["files"]} == set(os.listdir(here("scene2")))


CHECKS = {"db inspect": db_inspect, "db verify": db_verify, "scene": scene}
CASES = [every_command_lists_json, with_a_file_the_text_stays_and_the_document_is_the_same,
         an_error_is_a_message_and_the_document_is_there, an_error_in_the_middle_leaves_a_whole_document,
         a_command_line_without_sense_writes_nothing, the_document_takes_no_file_of_the_run,
         a_document_that_cannot_be_written_is_an_error, names_that_are_no_utf_8_do_not_spoil_it]


def prepare():
    shutil.rmtree(WORK, ignore_errors=True)
    os.makedirs(WORK)
    done = start("scene", "--out", here("scene"), "--size", "256")
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
        except Exception as error:
            failed += 1
            print("not ok %d - %s\n# %s: %s" % (number, name, type(error).__name__, str(error).replace("\n", "\n# ")))
    sys.exit(failed > 0)


main()
