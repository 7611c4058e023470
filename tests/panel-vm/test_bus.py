"""The SocketCAN driver on real interfaces of the kernel, beside can-utils' candump."""

from cases import case, expect, main
from fixtures import frames, tree
from machine import Machine

PROBE, CANDUMP = "/tmp/probe", "/tmp/candump"
WANTED, UNWANTED = "40C#091E000040459E04", "40C#R"


def boot():
    return Machine(tree=tree("can_probe", logs=("flight",)),
                   devices=["-object", "can-bus,id=bus", "-device", "kvaser_pci,canbus=bus", "-device", "kvaser_pci,canbus=bus"])


def prepare(m):
    """A virtual bus, vcan0, and a real one, between can0 and can1."""
    m.do("modprobe -a can_raw vcan kvaser_pci")
    m.do("ip link add vcan0 type vcan && ip link set vcan0 up")
    for card in ("can0", "can1"): # busybox's ip knows neither bit rates nor this spelling of a queue's length
        m.do("/sbin/ip link set %s up txqueuelen 1000 type can bitrate 1000000" % card)


def listen(m, interface, pause_s=""):
    """Start the driver and candump on an interface."""
    m.sh("kill $(pidof candump can_probe)") # of a case that failed
    m.do("candump -L %s >%s & /t/can_probe %s %s >%s &" % (interface, CANDUMP, interface, pause_s, PROBE))
    m.until("grep -q '! open' %s && pidof candump" % PROBE)


def heard(m):
    """End both; (frames of the driver, frames of candump, the driver's words)."""
    m.do("sleep 0.2; kill $(pidof candump can_probe); while pidof can_probe; do usleep 20000; done")
    said = m.do("cat " + PROBE)
    return frames(said), frames(m.do("cat " + CANDUMP)), [line for line in said.splitlines() if line.startswith("!")]


def hears_a_flight(m, sender, receiver):
    """Play a flight on `sender`; the driver on `receiver` must hand over what candump sees there."""
    listen(m, receiver)
    m.do("canplayer -I /t/flight.log %s=can0" % sender)
    mine, others, words = heard(m)
    asked_for = {frame.split("#")[0] for frame in mine}
    expect(len(others) > 3000 and len(asked_for) > 12, len(others), "frames of", asked_for)
    expect(mine == [frame for frame in others if frame.split("#")[0] in asked_for], "other frames, or another order")
    expect(words[-1].endswith("malformed 0 down 0 overflowed 0"), words)


@case("on vcan the driver hands over what candump sees, every frame in its place")
def virtual_bus(m):
    hears_a_flight(m, "vcan0", "vcan0")


@case("so it does on a CAN card, of what another card sent over the bus")
def real_bus(m):
    hears_a_flight(m, "can0", "can1")


@case("remote frames, unknown identifiers and identifiers that only look alike stay in the kernel")
def filters(m):
    listen(m, "vcan0")
    for frame in (UNWANTED, "7FF#01", "0001F40C#091E000040459E04", WANTED, "0001040C#091E000040459E04"):
        m.do("cansend vcan0 " + frame)
    mine, others, _ = heard(m)
    expect(len(others) == 5 and mine == [WANTED, "0001040C#091E000040459E04"], mine, others)


@case("the controller's report of bus-off is handed over as a report")
def bus_off(m):
    listen(m, "vcan0")
    m.do("cansend vcan0 20000040#0000000000000000; cansend vcan0 " + WANTED)
    mine, _, words = heard(m)
    expect(mine == ["20000040#0000000000000000", WANTED], mine, words)


@case("an interface that goes down is told once, and heard again when it is up")
def down_and_up(m):
    listen(m, "vcan0")
    m.do("cansend vcan0 %s; ip link set vcan0 down; sleep 0.3; ip link set vcan0 up" % WANTED)
    m.until("cansend vcan0 %s && sleep 0.2 && [ $(grep -c '#' %s) -gt 1 ]" % (WANTED, PROBE))
    _, _, words = heard(m)
    expect(len(words) == 3 and "Network is down" in words[1], words)


@case("an interface that is removed and comes back under its name is heard again")
def removed_and_back(m):
    listen(m, "vcan0")
    m.do("cansend vcan0 %s; ip link del vcan0; sleep 0.3; ip link add vcan0 type vcan; ip link set vcan0 up" % WANTED)
    m.until("cansend vcan0 %s && sleep 0.2 && [ $(grep -c '#' %s) -gt 1 ]" % (WANTED, PROBE))


@case("what arrives while nobody looks is kept: 5,000 frames")
def burst(m):
    listen(m, "vcan0", 3)
    m.do("cangen vcan0 -g 0 -n 5000 -I 40C -L 8 -D i")
    m.until("[ $(grep -c '#' %s) -ge 5000 ]" % PROBE)
    mine, _, words = heard(m)
    counted = [int.from_bytes(bytes.fromhex(frame[4:]), "little") for frame in mine]
    expect(counted == list(range(counted[0], counted[0] + 5000)) and words[-1].endswith("overflowed 0"), mine[:3], words)


@case("what the kernel could not keep is counted, frame by frame")
def overflow(m):
    listen(m, "vcan0", 4)
    m.do("kill $(pidof candump); cangen vcan0 -g 0 -n 30000 -I 40C -L 8 -D i", 120)
    m.until("sleep 1; grep -q '#' %s && cansend vcan0 %s" % (PROBE, WANTED))
    mine, _, words = heard(m)
    lost = int(words[-1].split()[-1])
    expect(lost > 0 and len(mine) + lost >= 30001, len(mine), words)


main(boot, prepare)
