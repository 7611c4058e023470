#!/usr/bin/env python3
"""How long a panel checks a signed database, and how much memory that takes: an image of so many megabytes (1000 unless said)
is made and signed here by openssl, and landmass-panel --check judges it.

    bench_trust.py [MEGABYTES [FOLDER]]
"""

import hashlib
import os
import resource
import struct
import subprocess
import sys
import tempfile
import time

BUILD = os.path.abspath(os.environ.get("BUILD", "build/bench-linux"))
TILES, SEAL, HEADER = 4, 11, 1024


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


def make(path, size):
    """By docs/FORMATS.md, 1.1 and 1.14; of one section."""
    sha = hashlib.sha256()
    with open(path, "wb") as file:
        file.seek(HEADER)
        for _ in range(size >> 20):
            block = os.urandom(1 << 20)
            sha.update(block)
            file.write(block)
    size = size >> 20 << 20
    subprocess.run(["openssl", "genpkey", "-algorithm", "ed25519", "-out", "key.pem"], check=True)
    key = subprocess.run(["openssl", "pkey", "-in", "key.pem", "-pubout", "-outform", "DER"], check=True, capture_output=True).stdout
    subprocess.run(["openssl", "pkey", "-in", "key.pem", "-pubout", "-out", "key.pub"], check=True)
    seal = struct.pack("<IIQ32s16xII", 1, 1, 1, key[-32:], TILES, 0) + sha.digest()

    def header(seal_crc):
        h = bytearray(HEADER)
        struct.pack_into("<8sIIQ", h, 0, b"LANDMASS", 3, HEADER, HEADER + size + len(seal) + 64)
        struct.pack_into("<I", h, 56, 2)
        struct.pack_into("<IIQQIIQQ", h, 64, TILES, 0, HEADER, size, SEAL, seal_crc, HEADER + size, len(seal) + 64)
        return h
    open("message", "wb").write(bytes(header(0)) + seal)
    subprocess.run(["openssl", "pkeyutl", "-sign", "-rawin", "-inkey", "key.pem", "-in", "message", "-out", "signature"], check=True)
    seal += open("signature", "rb").read()
    seal_crc = crc32c(seal)
    seal_bytes, seal = seal, seal[:-64]
    h = header(seal_crc)
    struct.pack_into("<I", h, 1020, crc32c(h[:1020]))
    with open(path, "r+b") as file:
        file.write(h)
        file.seek(HEADER + size)
        file.write(seal_bytes)
        os.fsync(file.fileno())


def measure(name):
    start = time.monotonic()
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(["/usr/bin/time", "-f", "%M KiB", BUILD + "/bin/landmass-panel", "--check", "--config", "panel.conf"],
                          capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert done.returncode == 0 and "signed by key" in done.stderr, done.stderr
    print("%s: %.2f s, of which the processor %.2f; most memory %s" % (
        name, time.monotonic() - start, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime,
        done.stderr.splitlines()[-1]))


def main():
    megabytes = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    with tempfile.TemporaryDirectory(dir=sys.argv[2] if len(sys.argv) > 2 else None) as folder:
        os.chdir(folder)
        make("image.lmdb", megabytes * 1000000)
        with open("panel.conf", "w") as file:
            file.write("database = %s/image.lmdb\ndatabase.key = %s/key.pub\ndatabase.serial = none\n" % (folder, folder))
        with open("image.lmdb", "rb") as file:
            os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)
        measure("%d MB from the medium" % megabytes)
        measure("%d MB from the kernel's memory" % megabytes)
        os.chdir("/")


main()
