#!/usr/bin/env python3
"""Signed images, judged by others: openssl checks the signature and writes the keys, hashlib makes the digests, and where
they stand is read here by docs/FORMATS.md, 1.14, alone. Then what sign and verify refuse, in words and exit codes.

TAP on standard output. BUILD names the build's folder.
"""

import hashlib
import json
import os
import struct
import subprocess
import tempfile

from database import build_small, check, db, end, make_keys, refused

SEAL = 11


def openssl(*words):
    return subprocess.run(("openssl",) + words, capture_output=True, check=True, timeout=60).stdout


def build():
    build_small("area.lmdb", "--title", "Signed")
    make_keys("a", "b")


def sections(image):
    count, = struct.unpack_from("<I", image, 56)
    return [struct.unpack_from("<IIQQ", image, 64 + 24 * i) for i in range(count)]


def outside_judge(path):
    """What the format says is signed, from the bytes of the file alone."""
    image = open(path, "rb").read()
    table = sections(image)
    index, = [i for i, s in enumerate(table) if s[0] == SEAL]
    offset, size = table[index][2:]
    seal = image[offset:offset + size]
    header = bytearray(image[:1024])
    struct.pack_into("<I", header, 64 + 24 * index + 4, 0)
    struct.pack_into("<I", header, 1020, 0)
    open("message", "wb").write(bytes(header) + seal[:-64])
    open("signature", "wb").write(seal[-64:])
    judged = subprocess.run(["openssl", "pkeyutl", "-verify", "-rawin", "-pubin", "-inkey", "a.pub", "-in", "message", "-sigfile",
                             "signature"], capture_output=True, text=True)
    check("openssl finds the signature to be that of the key", judged.returncode == 0, judged.stdout + judged.stderr)
    version, count, serial = struct.unpack_from("<IIQ", seal)
    check("version, count and serial number stand where the format says", (version, count, serial) == (1, len(table) - 1, 42))
    others = [s for i, s in enumerate(table) if i != index]
    mine = [(s[0], hashlib.sha256(image[s[2]:s[2] + s[3]]).digest()) for s in others]
    theirs = [(struct.unpack_from("<I", seal, 64 + 40 * i)[0], seal[64 + 40 * i + 8:64 + 40 * i + 40]) for i in range(count)]
    check("each digest is the SHA-256 of its section", mine == theirs)
    der = openssl("pkey", "-pubin", "-in", "a.pub", "-outform", "DER")
    check("the key in the seal is the public one", der[-32:] == seal[16:48])
    return hashlib.sha256(der).hexdigest()


def is_absent(path):
    return not os.path.exists(path) and not [f for f in os.listdir(".") if f.startswith(path + ".") or f.startswith("." + path)]


def signs():
    done = db("sign", "--key", "a.pem", "--serial", 42, "area.lmdb", "signed.lmdb")
    check("sign writes a signed image", done.returncode == 0, done.stderr)
    fingerprint = outside_judge("signed.lmdb")
    old, new = open("area.lmdb", "rb").read(), open("signed.lmdb", "rb").read()
    table, after = sections(old), sections(new)
    check("the sections are as they were", all(a[:4] == b[:4] and old[a[2]:a[2] + a[3]] == new[b[2]:b[2] + b[3]]
                                               for a, b in zip(table, after)) and len(after) == len(table) + 1)
    done = db("verify", "signed.lmdb", "--key", "a.pub", "--json", "verify.json")
    said = json.load(open("verify.json"))["report"]["signature"]
    check("verify --key trusts it", done.returncode == 0 and "trusted" in done.stdout, done.stderr)
    check("and reports state, serial number and the fingerprint as openssl and sha256sum make it",
          said == {"state": "trusted", "serial": 42, "key_sha256": fingerprint}, str(said))
    done = db("inspect", "signed.lmdb")
    check("inspect shows them too", "serial 42, key " + fingerprint in done.stdout)
    done = db("verify", "area.lmdb")
    check("an unsigned image has no faults for that", done.returncode == 0 and "signature       none" in done.stdout)
    db("sign", "--key", "a.pem", "--serial", 42, "signed.lmdb", "again.lmdb")
    check("signed again it is the same, byte for byte", open("again.lmdb", "rb").read() == new)
    os.remove("again.lmdb")
    done = db("convert", "--compress", "none", "signed.lmdb", "raw.lmdb")
    check("convert leaves the seal out and says so", done.returncode == 0 and "its seal is left out" in done.stderr)


def refuses():
    refused("an unsigned image does not pass verify --key", db("verify", "area.lmdb", "--key", "a.pub"), "is not signed",
            "`landmass-db sign` signs it")
    refused("nor does one signed by another", db("verify", "signed.lmdb", "--key", "b.pub"), "which is not trusted here")
    damaged = bytearray(open("signed.lmdb", "rb").read())
    damaged[sections(damaged)[4][2] + 5] ^= 1
    open("damaged.lmdb", "wb").write(damaged)
    refused("one whose manifest was changed is refused", db("verify", "damaged.lmdb", "--key", "a.pub"), "section MANIFEST is not what was signed")
    open("cut.lmdb", "wb").write(damaged[:-1])
    refused("and one that is cut short", db("verify", "cut.lmdb", "--key", "a.pub"), "faults")
    refused("a damaged image is not signed", db("sign", "--key", "a.pem", "--serial", 1, "damaged.lmdb", "no.lmdb"), "faults")
    refused("nor over itself", db("sign", "--key", "a.pem", "--serial", 1, "area.lmdb", "area.lmdb"), "area.lmdb")
    refused("nor without a serial number", db("sign", "--key", "a.pem", "area.lmdb", "no.lmdb"), "serial", code=2)
    refused("nor into a folder that is not there", db("sign", "--key", "a.pem", "--serial", 1, "area.lmdb", "none/no.lmdb"), "none")
    check("nothing is left of what was refused", is_absent("no.lmdb"))


def refuses_keys():
    openssl("genpkey", "-algorithm", "ed25519", "-aes256", "-pass", "pass:secret", "-out", "locked.pem")
    openssl("genpkey", "-algorithm", "x25519", "-out", "x.pem")
    openssl("genpkey", "-algorithm", "RSA", "-pkeyopt", "rsa_keygen_bits:2048", "-out", "rsa.pem")
    openssl("pkey", "-in", "rsa.pem", "-pubout", "-out", "rsa.pub")
    for name, text in ("right", "secret\n"), ("wrong", "secretly\n"), ("empty", ""), ("text", "a key\n"):
        open(name, "w").write(text)
    open("cut.pem", "w").write(open("a.pem").read()[:60])
    open("cut.pub", "w").write(open("a.pub").read()[:60])
    sign = ["sign", "--serial", 1, "area.lmdb", "no.lmdb", "--key"]
    refused("a key with a password needs it", db(*sign, "locked.pem"), "locked.pem", "has a password", "--password")
    refused("another password is refused", db(*sign, "locked.pem", "--password", "wrong"), "its password is another one")
    refused("and none at all", db(*sign, "locked.pem", "--password", "empty"), "empty: is empty")
    check("the right one signs", db(*sign[:4], "locked.lmdb", "--key", "locked.pem", "--password", "right").returncode == 0)
    refused("a key of another kind does not sign", db(*sign, "x.pem"), "a key of X25519, not of Ed25519", "openssl genpkey")
    refused("nor one of RSA", db(*sign, "rsa.pem"), "a key of RSA, not of Ed25519")
    for name in "a.pub", "cut.pem", "text", "empty":
        refused("%s is no private key" % name, db(*sign, name), name, "holds no private key")
    refused("a key that is not there", db(*sign, "none.pem"), "none.pem")
    verify = ["verify", "signed.lmdb", "--key"]
    refused("a private key is not taken for a public one", db(*verify, "a.pem"), "a.pem: holds a private key", "-pubout")
    refused("a public key of RSA is refused", db(*verify, "rsa.pub"), "a key of RSA, not of Ed25519")
    refused("a public key that is cut short is refused", db(*verify, "cut.pub"), "cut.pub: a damaged PEM file")
    refused("a text is no key", db(*verify, "text"), "text: no PEM file")
    both = open("b.pub").read() + open("a.pub").read()
    open("both.pub", "w").write("# keys of ours\n" + both)
    check("any of several keys will do", db(*verify, "both.pub").returncode == 0)
    open("many.pub", "w").write(both * 5)
    refused("nine keys are too many", db(*verify, "many.pub"), "more than 8 keys")
    check("nothing is left of what was refused", is_absent("no.lmdb"))


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        build()
        signs()
        refuses()
        refuses_keys()
        os.chdir("/")
    end()


main()
