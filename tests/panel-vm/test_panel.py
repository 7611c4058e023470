"""The panel, with its package's files, on a machine with a bus, keys, a hand controller, a glass and a watchdog."""

import os
import re
import subprocess

from cases import case, expect, main
from fixtures import HOST, WORK, busy_log, counters, database, lines_of, log, public_key, tree
from machine import Machine
from panel import (GPIO, HEIGHT, PRESSED, RELEASED, Panel, bench, differences, fly, in_flight, is_fine, is_flagged,
                   is_removed, land, strangers)

DEVICES = ["-device", "virtio-gpu-pci,xres=640,yres=480", "-device", "qemu-xhci", "-device", "usb-tablet,id=stick",
           "-device", "i6300esb", "-action", "watchdog=none"]
# Report descriptors (USB's HID 1.11): eight buttons and two axes of a byte each; and some that lie.
JOYSTICK = "05010904a10105091901290815002501750195088102050109300931158125" "7f750895028102c0"
HOSTILE = ["06",                                          # an item that ends in the middle
           "05010904a1010930" + "750895ff8102" * 40,      # a report of 10,200 bytes
           "05010904" + "a101" * 60,                      # collections in collections, none ever closed
           "05010904a101" + "a4" * 80 + "c0",             # a state kept and never taken back
           "05010904a10109300931157f258175089502810200",  # a range whose end lies before its beginning
           "05010904a101c0"]                              # nothing at all
MODULES = "can_raw vcan virtio-gpu xhci-pci i6300esb dummy_hcd libcomposite usb_f_hid"


def boot():
    files = [log("still"), log("flight"), busy_log(lines_of(log("flight"))[:1400]), database("small"), database("broken"),
             public_key()]
    return Machine(tree=tree("can_probe", "count_malloc.so", files=files), devices=DEVICES)


def prepare(m):
    """All keys up, and the bus there."""
    m.do("modprobe -a " + MODULES)
    m.do("ip link add vcan0 type vcan && ip link set vcan0 up")
    for name in GPIO[:6]:
        m.gpio_in(GPIO.index(name), RELEASED)


@case("as it is installed, with the configuration of its package, the panel shows what the bench shows")
def delivered(m):
    m.do("ip link add can0 type vcan && ip link set can0 up")
    m.do("mkdir -p /var/lib/landmass-panel && ln -s /t/small.lmdb /var/lib/landmass-panel/database.lmdb")
    m.do("echo database.key = /t/public.pem >>/etc/landmass-panel.conf")
    p = Panel(m, delivered=True)
    p.until(lambda text: is_removed(text) and "BUS" in text)
    (wanted,) = bench("delivered", "still", "14 picture dead\n", seconds=15, size=(HEIGHT, HEIGHT))
    wrong = differences(p.look(), wanted)
    m.do("canplayer -I /t/flight.log can0=can0 &")
    p.until(is_fine)
    land(m)
    m.do("ip link del can0")
    expect(wrong == 0, wrong, "pixels differ from the bench's")


@case("in flight every pixel of the radar picture is the bench's at some moment")
def radar_picture(m):
    film = bench("film", "still", seconds=12, every=1)
    p = in_flight(m)
    p.until(lambda text: "ELV +984FT" in text)
    m.sleep(3)  # the tiles are there, and the second sweep is under way
    p.press("OSB7")
    p.until(lambda text: "FZ" in text[:6])
    wrong = strangers(p.look(), film)
    expect(wrong == 0, wrong, "pixels are the bench's at no moment")


def shows(p, picture, turn):
    """Look at the glass until it shows a picture, or for two seconds; the pixels that are wrong in the end."""
    for _ in range(20):
        wrong = differences(p.look(), picture, turn)
        if wrong == 0:
            break
        p.machine.sleep(0.1)
    return wrong


@case("the test pattern is the bench's, pixel for pixel, whichever way the screen is mounted")
def test_pattern(m):
    (whole,) = bench("pattern", "still", "1 osb 14\n2 picture pattern\n", seconds=3)
    (small,) = bench("small-pattern", "still", "1 osb 14\n2 picture pattern\n", seconds=3, size=(400, 300))
    fly(m)
    for turn, size, picture in ((0, "640x480", whole), (180, "640x480", whole), (90, "400x300", small), (270, "400x300", small)):
        p = Panel(m, glass__turn=turn, glass__picture=size)
        p.press("OSB14")
        wrong = shows(p, picture, turn)
        expect(wrong == 0, wrong, "pixels differ, turned by", turn, p.said())


@case("when the traffic stops the picture is flagged first and then removed, as on the bench")
def nav_stops(m):
    p = in_flight(m)
    land(m)
    flagged = p.until(lambda text: not is_fine(text))
    expect(is_flagged(flagged) and not is_removed(flagged), flagged)
    expect(m.gpio_out(GPIO.index("LED-FAULT")) == 1, "the lamp of faults is dark")
    p.until(lambda text: is_removed(text) and "BUS" in text)
    (wanted,) = bench("dead", "still", "14 picture dead\n", seconds=15)
    wrong = differences(p.look(), wanted)
    expect(wrong == 0, wrong, "pixels differ from the bench's")
    fly(m)
    p.until(is_fine)


@case("an interface that goes down is told on the glass, and heard again when it is up")
def down_and_up(m):
    p = in_flight(m)
    m.do("ip link set vcan0 down")
    p.until(lambda text: "BUS" in text and is_removed(text))
    expect(p.is_alive(), "the display stands")
    m.do("ip link set vcan0 up")
    fly(m)
    p.until(is_fine)


@case("what it recorded is shown again by the bench, every check and every frame that it sent")
def recorded(m):
    p = in_flight(m, can__node=20, can__reports="on", record="/tmp/recordings")
    p.press("OSB7")
    p.press("OSB12")
    m.sleep(3)
    counted = p.report("recording")
    p.stop()
    land(m)
    path = os.path.join(WORK, "recorded.log")
    with open(path, "w", encoding="ascii") as out:
        out.write(m.do("cat /tmp/recordings/flight-00001-000.log") + "\n")
    again = subprocess.run([os.path.join(HOST, "landmass-sim"), "--db", database("small"), "--replay", path],
                           capture_output=True, text=True, check=False)
    expect(again.returncode == 0 and " failed 0; departures 0\n" in again.stdout, again.stdout, again.stderr)
    checks = int(re.search(r"checks of the glass (\d+)", again.stdout).group(1))
    expect(checks >= 3 and counted["lines"] == 0, again.stdout, counted)


@case("as a node that tells reports, it puts the cursor on the bus ten times a second, and a place when there is one")
def tells(m):
    fly(m)
    p = Panel(m, can__node=20, can__reports="on")
    p.until(is_fine)
    frames = m.do("timeout 5 candump -L vcan0,5E6:7FF,5DC:7FF,5EC:7FF || true").splitlines()
    cursor = [f.split()[-1] for f in frames if "5E6#" in f]
    codes = [int(f[10:12], 16) for f in cursor]
    expect(35 <= len(cursor) <= 60, len(cursor), "frames of the cursor in some five seconds", p.said()[-500:])
    expect(all(f.startswith("5E6#140300") and len(f) == 20 for f in cursor), cursor[:3])
    expect(all((b - a) % 256 == 1 for a, b in zip(codes, codes[1:])), codes)
    expect(all(f.endswith("#140000" + f[-2:]) for f in frames if "5EC#" in f), "a designated place without a patch")
    expect(any("5DC#1405" in f for f in frames), "no state word")


@case("so it is with an interface that is removed and comes back")
def removed_and_back(m):
    p = in_flight(m)
    land(m)
    m.do("ip link del vcan0")
    p.until(lambda text: "BUS" in text and is_removed(text))
    m.do("ip link add vcan0 type vcan && ip link set vcan0 up")
    fly(m)
    p.until(is_fine)


@case("a panel whose interface comes after it finds it")
def late_interface(m):
    land(m)
    m.do("ip link del vcan0")
    p = Panel(m)
    p.until(lambda text: "BUS" in text and is_removed(text))
    m.do("ip link add vcan0 type vcan && ip link set vcan0 up")
    fly(m)
    p.until(is_fine)


@case("of traffic that fills a bus to 80 % the panel loses nothing, and goes on drawing")
def busy_bus(m):
    land(m)
    p = Panel(m)
    before = p.report("bus")
    m.do("/t/can_probe vcan0 values >/tmp/values &")
    m.until("grep -q '! open' /tmp/values")
    m.do("canplayer -I /t/busy.log vcan0=can0")
    m.do("sleep 1; kill $(pidof can_probe); while pidof can_probe; do usleep 20000; done")
    asked_for = counters(m.do("tail -n 1 /tmp/values"))["frames"]
    after = p.report("bus")
    expect(after["frames"] - before["frames"] == asked_for > 9000 and after["overflowed"] == 0, after, asked_for)
    expect(p.is_alive(), "the display stands")


@case("a controller that has left the bus is counted, on the page that says so")
def bus_off(m):
    p = in_flight(m)
    p.press("OSB12")
    p.until(lambda text: any("BUS ERR" in line for line in text))
    before = p.counter("BUS ERR")
    m.do("cansend vcan0 20000040#0000000000000000")
    p.until(lambda text: p.counter("BUS ERR") == before + 1)
    m.do("cansend vcan0 20000100#0000000000000000")
    p.press("OSB13")
    p.until(is_fine)


@case("a database that is cut off, empty, missing or a folder ends in DB FAIL, not in a panel that ends")
def bad_database(m):
    fly(m)
    m.do("head -c 3000000 /t/small.lmdb >/tmp/cut.lmdb; : >/tmp/empty.lmdb")
    for path in ("/tmp/cut.lmdb", "/tmp/empty.lmdb", "/tmp/nosuch.lmdb", "/t"):
        p = Panel(m, database=path)
        p.until(lambda text: "DB FAIL" in text)
        expect(p.is_alive() and path in p.said(), path, p.said())


@case("damaged records are told on the glass while the picture goes on")
def damaged_records(m):
    fly(m)
    p = Panel(m, database="/t/broken.lmdb", database__trust="any")
    p.until(lambda text: "TILE" in text and "UNSIGNED" in text and not is_removed(text))
    expect(p.is_alive(), "the display stands")


@case("a screen that is unplugged and comes back shows the picture again")
def unplugged_screen(m):
    p = in_flight(m)
    m.do("echo off >/sys/class/drm/card0-Virtual-1/status")
    code, _ = m.sh("sleep 3; grep 'glass: .* it is looked for' /tmp/panel.log")
    m.do("echo detect >/sys/class/drm/card0-Virtual-1/status")
    expect(code == 0, "it was not noticed:", p.said())
    m.until("[ $(grep -c 'DRM connector' /tmp/panel.log) -eq 2 ]")
    p.until(is_fine)
    expect(p.is_alive(), "the display stands")


@case("through the older frame buffer device it shows the same")
def frame_buffer(m):
    p = in_flight(m, glass="fbdev")
    expect(p.is_alive() and "frame buffer" in p.said(), p.said())


@case("a key that bounces when it is pressed and when it is let go acts once")
def bounce(m):
    p = in_flight(m, keys__debounce=50)
    p.until(lambda text: "40" in text)
    for last in (PRESSED, RELEASED):
        for _ in range(9):
            p.set_key("OSB19", 1 - last)
            p.set_key("OSB19", last)
        m.sleep(0.3)
    p.until(lambda text: "20" in text)
    m.sleep(0.3)
    expect("20" in p.read(), p.read())


@case("a glitch between two looks of the processor is no key")
def glitch(m):
    p = in_flight(m)
    p.until(lambda text: "40" in text)
    m.qmp("stop")
    p.set_key("OSB19", PRESSED)
    p.set_key("OSB19", RELEASED)
    m.qmp("cont")
    m.sleep(0.5)
    expect("40" in p.read(), p.read())


@case("when the kernel's queue of edges overflows the panel still knows how the key stands")
def edge_overflow(m):
    p = in_flight(m)
    m.do("kill -STOP $(pidof landmass-panel)")
    for _ in range(40):
        p.set_key("OSB12", PRESSED)
        p.set_key("OSB12", RELEASED)
    p.set_key("OSB12", PRESSED)
    m.do("kill -CONT $(pidof landmass-panel)")
    p.until(lambda text: any("DB TINY IMAGE" in line for line in text))
    m.do("kill -STOP $(pidof landmass-panel)")
    for _ in range(40):
        p.set_key("OSB12", RELEASED)
        p.set_key("OSB12", PRESSED)
    p.set_key("OSB12", RELEASED)
    m.do("kill -CONT $(pidof landmass-panel)")
    p.press("OSB13")
    p.until(is_fine)
    p.press("OSB12")
    p.until(lambda text: any("DB TINY IMAGE" in line for line in text))


@case("a key that is held down for ever is told, and lights the lamp of faults until it is let go")
def stuck_key(m):
    p = in_flight(m)
    p.set_key("OSB19", PRESSED)
    m.sleep(16)
    expect("key: OSB19 has been down for 15 s: stuck" in p.said(), p.said())
    expect(m.gpio_out(GPIO.index("LED-FAULT")) == 1, "the lamp of faults is dark")
    p.set_key("OSB19", RELEASED)
    m.until("grep -q 'is let go again' /tmp/panel.log")


@case("the lamps blink while pictures go to the glass, and tell a fault")
def lamps(m):
    p = in_flight(m)
    levels = set()
    for _ in range(40):
        levels.add(m.gpio_out(GPIO.index("LED-ALIVE")))
        m.sleep(0.1)
    expect(levels == {0, 1} and m.gpio_out(GPIO.index("LED-FAULT")) == 0, levels, m.gpio_out(GPIO.index("LED-FAULT")))


def tilt(m, x):
    """Tilt QEMU's hand controller to the right, 0..32767."""
    m.qmp("input-send-event", events=[{"type": "abs", "data": {"axis": "x", "value": x}}])


def cursor(text):
    """Where the cursor is, as the glass says it."""
    return [line for line in text if line.startswith("E0")]


def cursor_rests(p):
    """Look until the cursor stays where it is; where that is."""
    before = None
    for _ in range(50):
        now = cursor(p.read())
        if now == before:
            return now
        before = now
        p.machine.sleep(0.5)
    raise AssertionError("the cursor keeps moving")


@case("a hand controller slews the cursor; pulled out while it does it lets go, and works again when it is back")
def hand_controller(m):
    p = in_flight(m, stick="0627:0001")
    p.until(lambda text: "E011*00.00" in text)
    tilt(m, 20000)
    p.until(lambda text: "E011*00.00" not in text)
    m.qmp("device_del", id="stick")
    place = cursor_rests(p)
    expect(p.is_alive(), "the display stands")
    m.qmp("device_add", driver="usb-tablet", id="stick")
    m.until("[ $(grep -c 'hand controller: .*0627:0001' /tmp/panel.log) -ge 2 ]")
    tilt(m, 12000)
    p.until(lambda text: cursor(text) != place)
    tilt(m, 16384)
    cursor_rests(p)


@case("a device in this very machine, of the kind that game ports have, does the same with its buttons")
def joystick(m):
    fly(m)
    m.do("/t/gadget plug " + JOYSTICK)
    p = Panel(m, stick="auto", **{"stick.button.1": "12", "stick.button.2": "13"})
    m.until("grep -q 'hand controller: .*1209:0c0d' /tmp/panel.log")
    p.until(is_fine)
    m.do("/t/gadget report 010000; sleep 0.2; /t/gadget report 000000")
    p.until(lambda text: any("DB TINY IMAGE" in line for line in text))
    m.do("/t/gadget report 020000; sleep 0.2; /t/gadget report 000000")
    p.until(lambda text: is_fine(text) and "E011*00.00" in text)
    m.do("/t/gadget report 007f00")
    p.until(lambda text: "E011*00.00" not in text)
    m.do("/t/gadget unplug")
    cursor_rests(p)


@case("devices whose descriptors lie are refused, and the panel goes on")
def hostile_devices(m):
    fly(m)
    p = Panel(m, stick="1209:0c0d")
    for number, descriptor in enumerate(HOSTILE, 1):
        m.do("/t/gadget plug " + descriptor)
        m.until("[ $(grep -c 'hand controller: .*1209:0c0d' /tmp/panel.log) -eq %d ]" % number)
        m.do("/t/gadget unplug")
    expect(p.is_alive() and "attached" not in p.said(), p.said())
    p.until(is_fine)


@case("with everything at work the loop allocates nothing")
def no_allocation(m):
    p = in_flight(m, "flight", environment="COUNT_MALLOC=/tmp/mallocs LD_PRELOAD=/t/count_malloc.so", stick="0627:0001")
    counts = "od -A n -t u8 /tmp/mallocs"
    before, others_before = map(int, m.do(counts).split())
    land(m)
    p.until(is_removed)
    fly(m, "flight")
    p.until(is_fine)
    for _ in range(2):
        p.press("OSB12")
        p.press("OSB13")
    after, others_after = map(int, m.do(counts).split())
    print("# allocations: %d at the start, %d in the loop, %d in other threads (libusb)" % (
        before, after - before, others_after - others_before))
    expect(0 < before == after, after - before, "allocations in the loop")


@case("the watchdog is fed by a loop that goes round, and bites when it hangs")
def watchdog(m):
    p = in_flight(m, watchdog="/dev/watchdog", watchdog__timeout="3")
    m.sleep(7)
    m.qmp("query-status")
    expect("WATCHDOG" not in m.events, "it bit while the panel worked;", p.said())
    m.do("kill -STOP $(pidof landmass-panel); sleep 6")
    m.qmp("query-status")
    m.do("kill -CONT $(pidof landmass-panel)")
    expect("WATCHDOG" in m.events, "it did not bite;", p.said())


@case("a watchdog that a stopped panel was commanded to leave does not bite")
def watchdog_stopped(m):
    m.events.clear()
    Panel(m, watchdog="/dev/watchdog", watchdog__timeout="2").stop()
    m.sleep(5)
    m.qmp("query-status")
    expect("WATCHDOG" not in m.events, m.events)


if __name__ == "__main__":
    main(boot, prepare)
