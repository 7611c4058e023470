#!/usr/bin/env python3
"""Which database a panel flies: what its configuration says about signatures and serial numbers, by what the program says,
how --check ends, and what a flight of a second remembers.

TAP on standard output. BUILD names the build's folder.
"""

import os
import signal
import subprocess
import tempfile
import time

from database import BUILD, build_small, check, end, good, make_keys


def make():
    build_small("none.lmdb")
    make_keys("a", "b")
    for serial in 5, 7:
        good("sign", "--key", "a.pem", "--serial", serial, "none.lmdb", "a%d.lmdb" % serial)
    damaged = bytearray(open("a7.lmdb", "rb").read())
    damaged[len(damaged) // 2] ^= 1
    open("damaged.lmdb", "wb").write(damaged)
    open("cut.lmdb", "wb").write(damaged[:len(damaged) // 2])


def write_config(image, **options):
    here = os.getcwd()
    with open("panel.conf", "w") as file:
        file.write("database = %s/%s\ncan = none\nglass = none\nstick = none\nrecord = none\nfaults = none\nrealtime.priority = 0\n"
                   "realtime.memory = free\n" % (here, image))
        for name, value in {"serial": here + "/serial", **options}.items():
            file.write("database.%s = %s\n" % (name, here + "/" + value if name == "key" else value))


PANEL = [BUILD + "/bin/landmass-panel", "--config", "panel.conf"]


def checked(name, code, words, image, **options):
    """--check ends with this code, and says these words."""
    write_config(image, **options)
    done = subprocess.run(PANEL + ["--check"], capture_output=True, text=True, timeout=60)
    missing = [w for w in words if w not in done.stderr]
    check(name, done.returncode == code and not missing, "exit %d, without %s: %s" % (done.returncode, missing, done.stderr))


def flown(image, **options):
    """What the panel says in a second of flight."""
    write_config(image, **options)
    panel = subprocess.Popen(PANEL, stderr=subprocess.PIPE, text=True)
    time.sleep(1.5)
    panel.send_signal(signal.SIGTERM)
    return panel.communicate(timeout=30)[1]


def remembered():
    return open("serial").read() if os.path.exists("serial") else None


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        make()
        checked("an unsigned database is refused unless the configuration says so", 1,
                ["none.lmdb: ", "`landmass-db sign` signs it", "database.trust = any"], "none.lmdb")
        checked("with a key, too", 1, ["none.lmdb: is not signed"], "none.lmdb", key="a.pub")
        checked("it is flown where the configuration says so, with a word", 0, ["the glass says UNSIGNED"], "none.lmdb", trust="any")
        checked("one that is signed by the key is flown", 0, ["signed by key ", "serial number 7"], "a7.lmdb", key="a.pub")
        checked("one of another key is refused", 1, ["which is not trusted here"], "a7.lmdb", key="b.pub")
        checked("unless the configuration says so", 0, ["the glass says UNSIGNED"], "a7.lmdb", key="b.pub", trust="any")
        checked("signed, but without a key that could tell", 1, ["no database.key vouches for it"], "a7.lmdb")
        checked("a key that is not there", 1, ["none.pub"], "a7.lmdb", key="none.pub")
        checked("a private key in the place of the public one", 1, ["a.pem: holds a private key"], "a7.lmdb", key="a.pem")
        for trust in "signed", "any":
            checked("a damaged one is not flown, trust " + trust, 1, ["is not what was signed", "fetch the image again"],
                    "damaged.lmdb", key="a.pub", trust=trust)
            checked("nor one that is cut short, trust " + trust, 1, ["ends after"], "cut.lmdb", key="a.pub", trust=trust)
        checked("a database that is not there yet is no mistake of the configuration", 0, ["no slot is whole, and"],
                "nowhere.lmdb", key="a.pub")
        check("--check remembers no serial number", remembered() is None)
        said = flown("a7.lmdb", key="a.pub")
        check("a flight does", "signed by key" in said and "DB FAIL" not in said and "UNSIGNED" not in said
              and remembered() == "serial 7\n", said)
        said = flown("a5.lmdb", key="a.pub")
        check("a lower one is refused", "its serial number is 5, and 7 was flown" in said and "DB FAIL" in said
              and remembered() == "serial 7\n", said)
        checked("--check says so, too", 1, ["sign it with a higher one, or set database.older = fly"], "a5.lmdb", key="a.pub")
        said = flown("a5.lmdb", key="a.pub", older="fly")
        check("unless it is forced", "flown, as database.older says" in said and "DB FAIL" not in said
              and remembered() == "serial 5\n", said)
        open("serial", "w").write("nonsense\n")
        checked("a number that cannot be read is told and does not ground the panel", 0, ["which serial number was flown is not known"],
                "a5.lmdb", key="a.pub")
        said = flown("none.lmdb", trust="any")
        check("the glass says UNSIGNED in flight", "the glass says: " in said and "UNSIGNED" in said.split("the glass says: ")[-1], said)
        said = flown("none.lmdb")
        check("and DB FAIL where it was refused", "DB FAIL" in said and "UNSIGNED" not in said, said)
        check("nothing else is left", sorted(f for f in os.listdir(".") if f.startswith("serial")) == ["serial"])
        os.chdir("/")
    end()


main()
