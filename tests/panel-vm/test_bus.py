"""The SocketCAN driver on real interfaces of the kernel, beside can-utils' candump."""

import csv

from cases import Skip, case, expect, main
from fixtures import busy_log, counters, frames, lines_of, log, peer_data, tree
from machine import Machine

CARDS = ["-object", "can-bus,id=bus", "-device", "kvaser_pci,canbus=bus", "-device", "kvaser_pci,canbus=bus"]
PROBE, CANDUMP = "/tmp/probe", "/tmp/candump"


def boot():
    busy = busy_log(peer_data("peer_frames_3s.log") or lines_of(log("flight")))
    return Machine(tree=tree("can_probe", "can_driver", files=[log("flight"), busy], package=False), devices=CARDS)


def prepare(m):
    """A virtual bus, vcan0, and a real one, between can0 and can1."""
    m.do("modprobe -a can_raw vcan kvaser_pci")
    m.do("ip link add vcan0 type vcan && ip link set vcan0 up")
    for card in ("can0", "can1"): # busybox's ip knows neither bit rates nor this spelling of a queue's length
        m.do("/sbin/ip link set %s up txqueuelen 1000 type can bitrate 1000000" % card)


def hears_a_flight(m, sender, receiver):
    """Play a flight on `sender`; the driver on `receiver` must hand over what candump sees there."""
    m.do("candump -L %s >%s & /t/can_probe %s frames >%s &" % (receiver, CANDUMP, receiver, PROBE))
    m.until("grep -q '! open' %s && pidof candump" % PROBE)
    m.do("canplayer -I /t/flight.log %s=can0; sleep 0.2; kill $(pidof candump can_probe)" % sender)
    m.until("! pidof can_probe")
    said = m.do("cat " + PROBE)
    mine, others, count = frames(said), frames(m.do("cat " + CANDUMP)), counters(said.splitlines()[-1])
    asked_for = {frame.split("#")[0] for frame in mine}
    expect(len(others) > 3000 and len(asked_for) > 12, len(others), "frames of", asked_for)
    expect(mine == [frame for frame in others if frame.split("#")[0] in asked_for], "other frames, or another order")
    expect(count == {"frames": len(mine), "malformed": 0, "overflowed": 0}, count)


@case("on vcan the driver hands over what candump sees, every frame in its place")
def virtual_bus(m):
    hears_a_flight(m, "vcan0", "vcan0")


@case("so it does on a CAN card, of what another card sent over the bus")
def real_bus(m):
    hears_a_flight(m, "can0", "can1")


@case("the driver's own statements hold: filters, stamps, losses, answers, down, removed, full queue")
def from_inside(m):
    code, said = m.sh("/t/can_driver /t/flight.log", 120)
    print("".join("# %s\n" % line for line in said.splitlines()), end="")
    passed = sum(line.startswith("ok ") and "SKIP" not in line for line in said.splitlines())
    expect(code == 0 and passed >= 11, "ended with", code, "after", passed, "statements")


def wrong_values(decoded, expected, loops):
    """What of the decoded lines of can_probe is not what the sender's list expects, `loops` times over."""
    values = {}
    for line in decoded:
        identifier, channel, value, step = line.split()
        values.setdefault((identifier, channel), []).append((float(value), float(step)))
    wrong = ["%d sources" % len(values)] if len(values) < 20 else []
    for source, heard in values.items():
        wanted = [(float(row["value"]), float(row["tolerance"])) for row in expected
                  if (str(int(row["can_id"]) % 65536), row["redundancy"]) == source and row["type"] not in ("NODATA", "ERROR")]
        if len(heard) != loops * len(wanted):
            wrong.append("%s: %d values, not %d" % (source, len(heard), loops * len(wanted)))
        for (value, step), (want, tolerance) in zip(heard, wanted * loops):
            error = abs((value - want + 180) % 360 - 180) if abs(want) <= 360 else abs(value - want)
            if error > tolerance + 5e-11 + 0.503 * step:
                wrong.append("%s: %g, not %g" % (source, value, want))
    return wrong


@case("a minute of another library's frames at 80 % of a bus: every value as expected, and none lost")
def busy_bus(m):
    expected = peer_data("peer_expected_3s.csv")
    if not expected:
        raise Skip("no frames of another library here (can_peer)")
    m.do("/t/can_probe vcan0 values >/tmp/values &")
    m.until("grep -q '! open' /tmp/values")
    loops = 60 // 4  # the log has 3 s of flight, and a second of services before it
    took_s = int(m.do("t=$(date +%%s); canplayer -l %d -I /t/busy.log vcan0=can0; echo $(($(date +%%s) - t))" % loops, 600))
    m.do("sleep 0.5; kill $(pidof can_probe); while pidof can_probe; do usleep 20000; done")
    lines = m.do("cat /tmp/values").splitlines()
    wrong = wrong_values([line for line in lines if line[0].isdigit()], list(csv.DictReader(expected)), loops)
    expect(not wrong and counters(lines[-1])["overflowed"] == 0, len(wrong), wrong[:5], lines[-1])
    expect(59 <= took_s <= 62, "a minute took", took_s, "s of the machine's time")


if __name__ == "__main__":
    main(boot, prepare)
