"""What the cases need in the machine: programs, databases, traffic. Made by the project's own tools."""

import glob
import gzip
import os
import shutil
import subprocess

HOST = os.path.join(os.environ.get("BUILD", "build/bench-linux"), "bin")
CROSS = "build/panel-linux-%s/bin"
WORK = "build/panel-vm/fixtures"
# Somebody who stands still in the air makes the same picture at whatever moment it is drawn.
FLIGHTS = {"flight": ("--straight", "45.97,11,0,2000,150", "--seconds", "5"),
           "still": ("--straight", "45.97,11,0,2000,0", "--seconds", "10")}
BUSY_FRAMES_A_SECOND = 6400  # 80 % of a bus of 1 Mbit/s, where a frame of 11 bits and 8 bytes takes 125 us
DATABASES = {"small": "image", "broken": "break-fine"}


def log(name):
    """A flight as candump -L text; its path."""
    path = os.path.join(WORK, name + ".log")
    os.makedirs(WORK, exist_ok=True)
    subprocess.run([os.path.join(HOST, "landmass-nav"), *FLIGHTS[name], "--quiet", "--out", path], check=True)
    return path


def peer_data(name):
    """A file of the frames that another CANaerospace library wrote, decompressed; None where they are not at hand."""
    path = os.path.join(os.environ.get("LANDMASS_DATA", "../shared/data"), "can_peer", name + ".gz")
    if not os.path.exists(path):
        return None
    with gzip.open(path, "rt", encoding="ascii") as lines:
        return lines.read().splitlines()


def busy_log(lines):
    """The frames of candump -L text at their times, and between them, up to 80 % of a bus, frames that the panel's filters
    let pass and its decoder refuses: true headings of a redundant sender, of a type that no heading has. The log's path."""
    stamped = [(float(line.split()[0][1:-1]), line.split()[2]) for line in lines]
    start, seconds = stamped[0][0], stamped[-1][0] - stamped[0][0]
    fillers = round(BUSY_FRAMES_A_SECOND * seconds) - len(stamped)
    stamped += [(start + (number + 0.5) * seconds / fillers, "0001046D#0914000000000000") for number in range(fillers)]
    os.makedirs(WORK, exist_ok=True)
    path = os.path.join(WORK, "busy.log")
    with open(path, "w", encoding="ascii") as out:
        out.writelines("(%.6f) can0 %s\n" % frame for frame in sorted(stamped))
    return path


def lines_of(path):
    """The lines of a file."""
    with open(path, encoding="ascii") as text:
        return text.read().splitlines()


def public_key():
    """The key that databases are signed by; the path of its public half."""
    secret, public = os.path.join(WORK, "signing.pem"), os.path.join(WORK, "public.pem")
    os.makedirs(WORK, exist_ok=True)
    if not os.path.exists(public):
        subprocess.run(["openssl", "genpkey", "-algorithm", "ed25519", "-out", secret], check=True)
        subprocess.run(["openssl", "pkey", "-in", secret, "-pubout", "-out", public], check=True)
    return public


def database(name):
    """A database; its path. The sound one is signed."""
    path = os.path.join(WORK, name + ".lmdb")
    plain = os.path.join(WORK, name + "-plain.lmdb")
    public_key()
    subprocess.run([os.path.join(HOST, "tests/system/test_sim_tool"), DATABASES[name], plain], check=True)
    if name == "broken":
        os.replace(plain, path)
    else:
        subprocess.run([os.path.join(HOST, "landmass-db"), "sign", "--key", os.path.join(WORK, "signing.pem"), "--serial", "1",
                        plain, path], check=True, stdout=subprocess.DEVNULL)
    return path


def unsigned_database():
    """The sound database before it was signed; its path."""
    database("small")
    return os.path.join(WORK, "small-plain.lmdb")


def tree(*programs, files=(), package=True, arch="arm64"):
    """A folder for a Machine: the panel's package, and in /t test programs of this folder and `files`."""
    top = os.path.join(WORK, "tree-" + arch)
    shutil.rmtree(top, ignore_errors=True)
    os.makedirs(os.path.join(top, "t"))
    for program in programs:
        shutil.copy(os.path.join(CROSS % arch, "tests/panel-vm", program), os.path.join(top, "t"))
    for path in files:
        shutil.copy(path, os.path.join(top, "t"))
    shutil.copy("tests/panel-vm/gadget.sh", os.path.join(top, "t", "gadget"))
    if package:
        deb = max(glob.glob("build/packages/landmass-panel_*_%s.deb" % arch), key=os.path.getmtime)
        subprocess.run(["dpkg-deb", "-x", deb, top], check=True)
    return top


def frames(text):
    """The frames of candump -L text, without times and interfaces."""
    return [line.split()[2] for line in text.splitlines() if line.startswith("(")]


def counters(words):
    """The counters in a line of "name number name number": a dictionary."""
    words = words.lstrip("! ").split()
    return {name: int(number) for name, number in zip(words[::2], words[1::2])}
