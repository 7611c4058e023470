"""A simulator's packets on the network reach two panels: landmass-dis in the machine, from UDP to a CAN interface."""

import os
import platform
import socket
import subprocess

from cases import Skip, case, expect, main
from fixtures import HOST, database, log, public_key, tree
from machine import Machine
from panel import fly, is_fine
from seats import SCREENS, Seat, entity_state

DIS = os.path.join(HOST, "landmass-dis")
OF_THE_MACHINE = ("libc.so", "libm.so", "ld-linux", "linux-vdso")


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


PORT = free_port()


def with_libraries(program):
    """The program, and the libraries that the machine has not."""
    told = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
    paths = [line.split("=> ")[1].split()[0] for line in told.splitlines() if "=> /" in line]
    return [program] + [path for path in paths if not os.path.basename(path).startswith(OF_THE_MACHINE)]


def boot():
    network = ["-netdev", "user,id=net,hostfwd=udp:127.0.0.1:%d-10.0.2.15:3000" % PORT,
               "-device", "virtio-net-pci,netdev=net"]
    return Machine("amd64", devices=SCREENS + network,
                   tree=tree(files=[log("still"), database("small"), public_key(), *with_libraries(DIS)], arch="amd64"))


def prepare(m):
    m.do("modprobe -a can_raw vcan virtio-gpu virtio_net && ip link add vcan0 type vcan && ip link set vcan0 up")
    m.do("ip address add 10.0.2.15/24 dev eth0 && ip link set eth0 up")
    fly(m)


def there(seat):
    """Live targets that a panel has, and what it says of them."""
    told = seat.report("live targets")
    return int(told.split(" there")[0].split()[-1]), told


@case("an entity of DIS comes to two panels on one bus, and goes when its packets end")
def comes_and_goes(m):
    if platform.machine() != "x86_64":
        raise Skip("the machine runs this computer's landmass-dis, which is not of amd64")
    seats = [Seat(m, name, **{"can.node": 20 + number, "glass.card": "/dev/dri/card%d" % number})
             for number, name in enumerate(("left", "right"))]
    m.do("LD_LIBRARY_PATH=/t /t/landmass-dis --listen 3000 --bind 10.0.2.15 --can vcan0 2>/tmp/dis.log & sleep 1")
    for seat in seats:
        seat.until(is_fine)
        expect(there(seat)[0] == 0, there(seat))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as simulator:
        for number in range(60):
            simulator.sendto(entity_state(number), ("127.0.0.1", PORT))
            m.sleep(0.5)
            if all(there(seat)[0] == 1 for seat in seats):
                break
    for seat in seats:
        count, told = there(seat)
        expect(count == 1 and " 0 torn, 0 refused" in told, told, m.do("cat /tmp/dis.log"))
    m.sleep(30)  # landmass-dis ends an entity after 12 s, a panel a target after 10 s more
    for seat in seats:
        expect(there(seat)[0] == 0, there(seat))
        seat.until(is_fine)
    expect(m.sh("kill -INT $(pidof landmass-dis); sleep 1; pidof landmass-dis")[0] != 0, "landmass-dis goes on")


if __name__ == "__main__":
    main(boot, prepare, arch="amd64")
