#!/usr/bin/env python3
"""The software bill of materials in the panel's package: what it names is there, and what is there it names."""

import importlib.util
import json
import os
import shutil
import subprocess
import sys

BUILD = os.environ.get("BUILD", "build/bench-linux")
WORK = os.path.join(BUILD, "tmp", "sbom")
BILL = "usr/share/doc/landmass-panel/landmass-panel.spdx.json"
PROGRAM = "usr/sbin/landmass-panel"
SPEC = importlib.util.spec_from_file_location("sbom", "host-sim/package/sbom.py")
sbom = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(sbom)


def unpacked(name):
    """A folder with the package's files, to be damaged."""
    root = os.path.join(WORK, name)
    shutil.rmtree(root, ignore_errors=True)
    subprocess.run(["dpkg-deb", "-R", os.path.join(WORK, "panel.deb"), root], check=True)
    return root


def faults(root):
    """What is said of the package that a folder becomes."""
    deb = root + ".deb"
    subprocess.run(["dpkg-deb", "--root-owner-group", "-Znone", "--build", root, deb], check=True, stdout=subprocess.DEVNULL)
    done = subprocess.run([sys.executable, "-B", "host-sim/package/sbom.py", "check", deb], capture_output=True, text=True,
                          check=False)
    assert done.returncode == (1 if done.stderr else 0), (done.returncode, done.stderr)
    return done.stderr


def change_bill(root, change):
    """Let `change` alter the bill of a folder."""
    path = os.path.join(root, BILL)
    with open(path, encoding="utf-8") as text:
        bill = json.load(text)
    change(bill)
    with open(path, "w", encoding="utf-8") as text:
        json.dump(bill, text)


def drop_library(bill, library):
    """The bill without a library: package and links."""
    gone = {r["relatedSpdxElement"] for r in bill["relationships"] if r.get("comment") == library}
    bill["relationships"] = [r for r in bill["relationships"] if r["relatedSpdxElement"] not in gone]
    bill["packages"] = [p for p in bill["packages"] if p["SPDXID"] not in gone]


def drop_file(bill, path):
    """The bill without a file."""
    me = sbom.identifier("File", path)
    bill["files"] = [f for f in bill["files"] if f["SPDXID"] != me]
    bill["relationships"] = [r for r in bill["relationships"] if me not in (r["relatedSpdxElement"], r["spdxElementId"])]


def bill_holds():
    """The package as it is built has a bill with which all agrees."""
    done = subprocess.run(["sh", "bsp/panel-linux/debian/build.sh", "amd64" if os.uname().machine == "x86_64" else "arm64",
                           BUILD + "/bin/landmass-panel", WORK], capture_output=True, text=True, check=True)
    os.replace(done.stdout.strip(), os.path.join(WORK, "panel.deb"))
    said = faults(unpacked("whole"))
    assert said == "", said


def bill_tells():
    """libraries with Debian's package and version as dpkg knows them, licences, the compiler"""
    with open(os.path.join(unpacked("told"), BILL), encoding="utf-8") as text:
        bill = json.load(text)
    told = {p["name"]: p for p in bill["packages"]}
    for name in ("libc6", "libusb-1.0-0", "libssl3"):
        version = subprocess.run(["dpkg-query", "-W", "-f", "${Version}\n", name], capture_output=True, text=True, check=True)
        assert told[name]["versionInfo"] in version.stdout.split(), told[name]
        assert told[name]["licenseDeclared"] not in ("", "NOASSERTION"), told[name]
    assert "gcc" in told or "clang" in told, sorted(told)
    sums = subprocess.run(["sha256sum", os.path.join(WORK, "told", PROGRAM)], capture_output=True, text=True, check=True)
    assert sums.stdout.split()[0] in json.dumps(bill), sums.stdout


def bill_is_repeatable():
    """Made twice, it has the same bytes; its time is that of the commit."""
    root = unpacked("again")
    path = os.path.join(root, BILL)
    texts = []
    for time in ("86400", "86400", "172800"):
        os.remove(path)
        subprocess.run([sys.executable, "-B", "host-sim/package/sbom.py", "make", root, "landmass-panel", "0", "amd64" if
                        os.uname().machine == "x86_64" else "arm64"], check=True, env=dict(os.environ, SOURCE_DATE_EPOCH=time))
        with open(path, encoding="utf-8") as text:
            texts.append(text.read())
    assert texts[0] == texts[1] and texts[0] != texts[2] and '"1970-01-02T00:00:00Z"' in texts[0]


def planted(name, plant, *wanted):
    """A folder with a planted fault is found out, in these words."""
    root = unpacked(name)
    plant(root)
    said = faults(root)
    assert all(word in said for word in wanted), said


def library_left_out():
    """a library that the bill leaves out"""
    planted("library", lambda root: change_bill(root, lambda b: drop_library(b, "libusb-1.0.so.0")),
            PROGRAM + ": libusb-1.0.so.0 is not in the bill")


def library_made_up():
    """a library that no program asks for"""
    def add(bill):
        link = next(r for r in bill["relationships"] if r.get("comment") == "libusb-1.0.so.0")
        bill["relationships"].append(dict(link, comment="libnone.so.1"))
    planted("made-up", lambda root: change_bill(root, add), "does not ask for libnone.so.1")


def file_left_out():
    """a file that the bill leaves out"""
    unit = "lib/systemd/system/landmass-panel.service"
    planted("file", lambda root: change_bill(root, lambda b: drop_file(b, unit)), unit + ": not in the bill", "verification code")


def file_gone():
    """a file that is not there"""
    planted("gone", lambda root: os.remove(os.path.join(root, "etc/landmass-panel.conf")) or
            os.remove(os.path.join(root, "DEBIAN/conffiles")), "etc/landmass-panel.conf: not in the package")


def file_changed():
    """one byte that changed"""
    def change(root):
        with open(os.path.join(root, PROGRAM), "ab") as program:
            program.write(b"\0")
    planted("changed", change, PROGRAM + ": another content")


def compiler_left_out():
    """a compiler that the bill does not name"""
    def drop(bill):
        bill["relationships"] = [r for r in bill["relationships"] if r["relationshipType"] != "BUILD_TOOL_OF"]
    planted("compiler", lambda root: change_bill(root, drop), "made by [], says the bill")


def bill_is_gone():
    """no bill, and one that is none"""
    planted("none", lambda root: os.remove(os.path.join(root, BILL)), "it has no bill of materials")
    planted("nonsense", lambda root: change_bill(root, lambda b: b.pop("packages")), "its bill is not SPDX")
    planted("licence", lambda root: change_bill(root, lambda b: b["packages"][1].pop("licenseDeclared")), "no licence")


CASES = ((bill_holds, "the package has a bill of materials that agrees with it"),
         (bill_tells, "it names libraries, their Debian packages, versions and licences, and the compiler"),
         (bill_is_repeatable, "the same package makes the same bill"),
         (library_left_out, "a library that is left out is found"), (library_made_up, "so is one that is not asked for"),
         (file_left_out, "a file that is left out is found"), (file_gone, "so is one that is not there"),
         (file_changed, "so is one that changed"), (compiler_left_out, "so is a compiler that is not named"),
         (bill_is_gone, "no bill, one that is none, or one without licences is told"))


def main():
    """Run the cases."""
    shutil.rmtree(WORK, ignore_errors=True)
    os.makedirs(WORK)
    failed = 0
    for number, (case, sentence) in enumerate(CASES, 1):
        try:
            case()
            print("ok %d - %s" % (number, sentence))
        except (AssertionError, OSError, subprocess.CalledProcessError, KeyError) as error:
            failed = 1
            print("not ok %d - %s" % (number, sentence))
            print("# %s: %s" % (type(error).__name__, str(error).replace("\n", "\n# ")))
    print("1..%d" % len(CASES))
    return failed


if __name__ == "__main__":
    if shutil.which("dpkg-deb") is None:
        print("1..1\nok 1 # SKIP the bill of materials\n# skipped: dpkg-deb is missing: this is no Debian system")
        sys.exit(0)
    sys.exit(main())
