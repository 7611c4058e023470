"""How long a state of an entity is on its way through landmass-dis: from the sending of its datagram to the port until the
last frame of its set can be read. Usage: dis_delay.py PROGRAM [STATES]

Each state is a surprise (the entity is 50 m from where it was), so that a set is due at once. Once alone, and once while 200
other entities tell their states 5 times a second each. The log goes through a pipe; a CAN bus adds 135 us a frame at
1 Mbit/s.
"""

import random
import socket
import struct
import subprocess
import sys
import threading
import time

A_M = 6378137.0


def state(entity, north_m):
    body = struct.pack(">HHHBB", 1, 2, entity, 1, 0) + 2 * struct.pack(">BBHBBBB", 1, 1, 225, 6, 0, 0, 0)
    body += struct.pack(">3f3d3fI", 0, 0, 0, A_M, 10.0 * entity, north_m, 1.5, 0, 0, 0)
    body += struct.pack(">B15x3f3f", 2, 0, 0, 0, 0, 0, 0) + b"\1" + bytes(11) + bytes(4)
    return struct.pack(">BBBBIHH", 7, 1, 1, 1, 0, 12 + len(body), 0) + body


def measure(program, states, others):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    run = subprocess.Popen([program, "--listen", str(port), "--quiet"], stdout=subprocess.PIPE, stdin=subprocess.DEVNULL)
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sender.connect(("127.0.0.1", port))
    read = {}  # when the last frame of a set of number 0 with this latitude was read

    def reader():
        for line in run.stdout:
            now = time.perf_counter()
            name, data = line.split()[2].split(b"#")
            if data[4:6] != b"00":
                continue
            if name == b"712":
                reader.latitude = data[8:16]
            if name == b"716":  # the last of its sets
                read.setdefault(reader.latitude, now)

    thread = threading.Thread(target=reader)
    thread.start()
    time.sleep(0.5)
    random.seed(1)
    sent, delays, other = [], [], 0
    for i in range(states):
        until = time.perf_counter() + random.uniform(0.012, 0.03)
        while time.perf_counter() < until:
            if others and i > 0:
                try:
                    sender.send(state(2 + other % others, 0))
                except ConnectionRefusedError:
                    pass
                other += 1
                time.sleep(1 / (5 * others))
            else:
                time.sleep(0.001)
        try:
            now = time.perf_counter()
            sender.send(state(1, 50.0 * i))
            sent.append((now, 50.0 * i))
        except ConnectionRefusedError:  # not listening yet
            continue
    time.sleep(1.2)
    run.send_signal(2)
    thread.join()
    run.wait()
    # The latitude that 50 m north of the equator is, in 1e-7 degrees: the sender's formula is exact enough to tell them apart.
    known = sorted((int(latitude, 16), at) for latitude, at in read.items())
    for now, north in sent:
        wanted = north / (A_M * (1 - 0.00669438)) * 57.29577951 * 1e7
        near = min(known, key=lambda one: abs(one[0] - wanted))
        if abs(near[0] - wanted) < 100 and near[1] > now:
            delays.append((near[1] - now) * 1e3)
    delays.sort()
    return delays, len(sent)


def main():
    program = sys.argv[1]
    states = int(sys.argv[2]) if len(sys.argv) > 2 else 300
    print("A state of DIS, from its datagram to the last frame of its set (landmass-dis, loopback, a pipe): ms")
    for others in (0, 200):
        delays, sent = measure(program, states, others)
        print("  %-34s median %6.2f   99 %% %6.2f   (%d of %d states)" % (
            "alone" if not others else "beside %d entities at 5 Hz" % others, delays[len(delays) // 2],
            delays[int(0.99 * (len(delays) - 1))], len(delays), sent))


main()
