#!/usr/bin/env python3
"""landmass-load send and receive as two programs, joined by a local socket in the place of USB: what is taken and what is
refused, what a full disk does, and a sender that is killed. test_loads.py of tests/panel-vm has the cable.

TAP on standard output. BUILD names the build's folder.
"""

import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import traceback

BUILD = os.environ.get("BUILD", "build/bench-linux")
LOAD = os.path.join(BUILD, "bin/landmass-load")
WORK = os.path.join(BUILD, "tmp/send")
LIMIT_S = 60


def here(name):
    return os.path.join(WORK, name)


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def prepare():
    shutil.rmtree(WORK, ignore_errors=True)
    os.makedirs(WORK)
    run(os.path.join(BUILD, "bin/tests/system/test_sim_tool"), "image", here("plain"))
    run("openssl", "genpkey", "-algorithm", "ed25519", "-out", here("key.pem"))
    run("openssl", "pkey", "-in", here("key.pem"), "-pubout", "-out", here("public.pem"))
    for serial in (1, 2, 3):
        run(os.path.join(BUILD, "bin/landmass-db"), "sign", "--key", here("key.pem"), "--serial", str(serial), here("plain"),
            here("image%d" % serial))
    with open(here("conf"), "w", encoding="utf-8") as file:
        file.write("slot.a = %s\nslot.b = %s\ndatabase.key = %s\ndatabase.serial = %s\nslot.progress = none\n" %
                   (here("a"), here("b"), here("public.pem"), here("serial")))


class Panel:
    """landmass-load receive, and the slots it writes."""

    def __init__(self, **options):
        self.process = subprocess.Popen([LOAD, "receive", "--socket", here("socket"), "--config", here("conf"), "--json",
                                         here("received.json")], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                        **options)

    def __enter__(self):
        deadline = time.monotonic() + LIMIT_S
        while not os.path.exists(here("socket")) and time.monotonic() < deadline:
            time.sleep(0.01)
        return self

    def __exit__(self, *_):
        self.process.terminate()
        assert self.process.wait(LIMIT_S) == 0
        os.unlink(here("socket"))

    def stop(self):
        """End it; its report."""
        self.__exit__()
        with open(here("received.json"), encoding="utf-8") as file:
            return json.load(file)["report"]


def start(name):
    return [LOAD, "send", here(name), "--socket", here("socket"), "--json", here("sent.json")]


def send(name, code=0):
    """What it prints, and its report."""
    done = subprocess.run(start(name), capture_output=True, text=True, timeout=LIMIT_S, check=False)
    assert done.returncode == code, (done.returncode, done.stdout, done.stderr)
    with open(here("sent.json"), encoding="utf-8") as file:
        return done.stdout + done.stderr, json.load(file)["report"]


def clear():
    for name in ("a", "a.state", "b", "b.state", "serial"):
        if os.path.exists(here(name)):
            os.unlink(here(name))


def slots(command="verify"):
    done = subprocess.run([LOAD, command, "--config", here("conf"), "--json", "-"], capture_output=True, check=False)
    return json.loads(done.stdout)["report"]["slots"]


def a_database_goes_into_one_slot_and_the_next_one_into_the_other():
    clear()
    size = os.path.getsize(here("image1"))
    panel = Panel().__enter__()
    said, report = send("image1")
    assert "panel: slot A: absent; slot B: absent" in said and "slot A: load 1; every record" in said, said
    assert (report["load"], report["image_bytes"], report["is_there_already"]) == (1, size, False), report
    assert report["sent_bytes"] > size and report["same_bytes"] == 0, report
    assert send("image1")[1]["is_there_already"]
    said, report = send("image2")
    assert "slot A: whole, load 1, flown next" in said and "slot B: load 2;" in said, said
    received = panel.stop()
    assert [load["is_done"] for load in received["loads"]] == [True] * 3 and received["damaged_messages"] == 0, received
    assert [s["state"] for s in slots()] == ["whole", "whole"] and slots()[1]["is_flown_next"]
    with open(here("b"), "rb") as a, open(here("image2"), "rb") as b:
        assert a.read() == b.read()


def the_panel_refuses_what_it_may_not_fly_and_writes_nothing():
    clear()
    with open(here("serial"), "w", encoding="ascii") as file:
        file.write("serial 2\n")  # as the panel that has flown it writes
    with open(here("image2"), "rb") as file:
        damaged = bytearray(file.read())
    with Panel():
        for name, words in (("plain", "is not signed"), ("image1", "its serial number is 1, and 2 was flown")):
            said, _ = send(name, code=1)
            assert "the panel: " in said and words in said, said
        assert [s["state"] for s in slots()] == ["absent", "absent"]
        assert "slot A: load 1;" in send("image3")[0]
        damaged[len(damaged) // 2] ^= 1
        with open(here("damaged"), "wb") as file:
            file.write(damaged)
        assert "nothing was written" in send("damaged", code=1)[0]  # the PC's own check
    assert [s["state"] for s in slots()] == ["whole", "absent"]


def a_full_disk_is_told_to_the_pc_and_the_other_slot_stays():
    clear()
    room = os.path.getsize(here("image1")) - 1
    with Panel():
        send("image1")
    with Panel(restore_signals=False, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (room, room))):
        said, _ = send("image2", code=1)
        assert "no room in the slot" in said and "the other slot is flown as before" in said, said
    assert [(s["state"], s["is_flown_next"]) for s in slots()] == [("whole", True), ("cut off", False)]
    with Panel():
        assert "slot B: load 2;" in send("image2")[0]


def a_sender_that_is_killed_costs_nothing():
    clear()
    with Panel():
        send("image1")
        for number in range(6):
            process = subprocess.Popen(start("image2"), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(0.03 * number)
            process.send_signal(signal.SIGKILL)
            process.wait()
            states = slots("show")
            assert states[0]["state"] == "whole" and states[1]["state"] != "damaged", states
        send("image2")
    assert [s["state"] for s in slots()] == ["whole", "whole"] and slots()[1]["is_flown_next"]


def nobody_who_listens_is_an_error():
    said, _ = send("image1", code=1)
    assert "nobody listens" in said, said
    for numbers in ("1209", "1209:", "1209:0001x", "x:1"):
        assert subprocess.run([LOAD, "send", here("image1"), "--usb", numbers], capture_output=True, check=False).returncode == 2


CASES = [a_database_goes_into_one_slot_and_the_next_one_into_the_other, the_panel_refuses_what_it_may_not_fly_and_writes_nothing,
         a_full_disk_is_told_to_the_pc_and_the_other_slot_stays, a_sender_that_is_killed_costs_nothing,
         nobody_who_listens_is_an_error]


def main():
    prepare()
    failed = 0
    print("1..%d" % len(CASES))
    for number, case in enumerate(CASES, 1):
        try:
            case()
            print("ok %d - %s" % (number, case.__name__))
        except (AssertionError, OSError, subprocess.SubprocessError, KeyError, ValueError):
            failed += 1
            print("not ok %d - %s" % (number, case.__name__))
            print("".join("# " + line + "\n" for line in traceback.format_exc().splitlines()), end="")
    return failed != 0


if __name__ == "__main__":
    sys.exit(main())
