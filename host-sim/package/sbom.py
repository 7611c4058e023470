#!/usr/bin/env python3
"""The software bill of materials of a Debian package of ours: SPDX 2.3 as JSON.

It is read off what goes into the package: each file with its checksums, each library that a program asks for with the
Debian package of this machine that it comes from, the compiler that left its name in the program. The same package on the
same machine gives the same bytes. SPDX: https://spdx.github.io/spdx-spec/v2.3/
"""

import argparse
import glob
import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile
import time

ARCHES = {"amd64": "x86_64-linux-gnu", "arm64": "aarch64-linux-gnu"}
LICENCES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "licences.txt")
COMPILERS = (("gcc", re.compile(r"GCC: \(Debian ([^)]+)\)"), "GPL-3.0-or-later WITH GCC-exception-3.1"),
             ("clang", re.compile(r"clang version ([0-9.]+[^\s)]*)"), "Apache-2.0 WITH LLVM-exception"))
DOCUMENT, PACKAGE = "SPDXRef-DOCUMENT", "SPDXRef-Package"


class SbomError(Exception):
    """What stands in the way, and what to do about it."""


def run(*command, **options):
    """What a program prints."""
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        raise SbomError("%s: %s" % (" ".join(command), done.stderr.strip() or "failed"))
    return done.stdout


# ---- what is in the package ----

def bill_path(name):
    """Where the bill lies in the package."""
    return "usr/share/doc/%s/%s.spdx.json" % (name, name)


def files_of(root, name):
    """Paths of the regular files below a folder, but for control files and the bill; sorted."""
    found = []
    for folder, _, names in os.walk(root):
        found += [os.path.relpath(os.path.join(folder, n), root) for n in names]
    found = [f for f in found if not f.startswith("DEBIAN/") and f != bill_path(name)]
    return sorted(f for f in found if not os.path.islink(os.path.join(root, f)))


def digests(path):
    """SHA-1, which SPDX wants, and SHA-256."""
    with open(path, "rb") as data:
        content = data.read()
    return hashlib.sha1(content).hexdigest(), hashlib.sha256(content).hexdigest()


def is_elf(path):
    """Whether it is a program or a library."""
    with open(path, "rb") as data:
        return data.read(4) == b"\x7fELF"


def needed(path):
    """The libraries that a program asks for, as its dynamic section names them."""
    return sorted(re.findall(r"\(NEEDED\).*\[(\S+)\]", run("readelf", "--wide", "-d", path)))


def compilers(path):
    """(name, version, licence) of each compiler that the program names; the linker keeps their words."""
    words = run("readelf", "-p", ".comment", path)
    return sorted({(name, version, licence) for name, pattern, licence in COMPILERS for version in pattern.findall(words)})


def owner(library, arch):
    """(package, its version, its source, the source's version): who brought a library to this machine."""
    folders = ["%s/%s" % (top, ARCHES[arch]) for top in ("/usr/lib", "/lib")]
    paths = [os.path.realpath(os.path.join(folder, library)) for folder in folders]
    paths += [path[len("/usr"):] for path in paths if path.startswith("/usr/lib/")]
    for path in paths:
        found = subprocess.run(["dpkg-query", "-S", path], capture_output=True, text=True, check=False)
        names = [line.split(": ")[0] for line in found.stdout.splitlines()]
        names = [name for name in names if name.endswith(":" + arch) or ":" not in name]
        if names:
            form = "${Package}\t${Version}\t${source:Package}\t${source:Version}"
            return run("dpkg-query", "-W", "-f", form, names[0]).split("\t")
    raise SbomError("%s: no Debian package of this machine has it for %s: make deps" % (library, arch))


def licence_of(source):
    """The licence of a source package."""
    with open(LICENCES, encoding="utf-8") as lines:
        table = dict(line.split(None, 1) for line in lines if line.strip() and not line.startswith("#"))
    if source not in table:
        raise SbomError("the licence of the Debian source %s is not known: read its copyright file, add a line to %s" % (
            source, LICENCES))
    return table[source].strip()


def own_licence(root, name):
    """The licence and the holders that the package's copyright file names."""
    with open(os.path.join(root, "usr/share/doc", name, "copyright"), encoding="utf-8") as text:
        fields = dict(line.rstrip("\n").split(": ", 1) for line in text if re.match(r"[A-Z][A-Za-z-]*: ", line))
    return fields["License"], fields["Copyright"]


# ---- the bill ----

def verification_code(sums):
    """SPDX 2.3, section 7.9: a digest of the files' digests."""
    return hashlib.sha1("".join(sorted(sums)).encode()).hexdigest()


def identifier(kind, name):
    """An SPDX identifier: letters, digits, points and hyphens alone."""
    return "SPDXRef-%s-%s" % (kind, re.sub(r"[^A-Za-z0-9.-]", lambda c: "-%02x" % ord(c.group()), name))


def relation(subject, kind, other, comment=None):
    """One relationship."""
    known = {"spdxElementId": subject, "relationshipType": kind, "relatedSpdxElement": other}
    return dict(known, comment=comment) if comment else known


def library_package(facts, arch):
    """A Debian package that a program needs."""
    name, version, source, source_version = facts
    url = "pkg:deb/debian/%s@%s?arch=%s" % (name, version.replace(":", "%3A").replace("+", "%2B"), arch)
    return {"SPDXID": identifier("Library", name), "name": name, "versionInfo": version, "supplier": "Organization: Debian",
            "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "primaryPackagePurpose": "LIBRARY",
            "licenseConcluded": "NOASSERTION", "licenseDeclared": licence_of(source), "copyrightText": "NOASSERTION",
            "sourceInfo": "built from the Debian source %s %s" % (source, source_version),
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": url}]}


def compiler_package(name, version, licence):
    """A compiler, by the words that it leaves in a program."""
    return {"SPDXID": identifier("Tool", name + "-" + version), "name": name, "versionInfo": version,
            "supplier": "Organization: Debian", "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
            "primaryPackagePurpose": "APPLICATION", "licenseConcluded": "NOASSERTION", "licenseDeclared": licence,
            "copyrightText": "NOASSERTION", "comment": "parts of its runtime (libgcc, start files) are in the programs"}


def own_package(root, name, version, arch, sums):
    """Our package, whose files these are."""
    licence, holders = own_licence(root, name)
    return {"SPDXID": PACKAGE, "name": name, "versionInfo": version, "supplier": "Organization: landmass maintainers",
            "downloadLocation": "NOASSERTION", "filesAnalyzed": True,
            "packageFileName": "%s_%s_%s.deb" % (name, version, arch),
            "packageVerificationCode": {"packageVerificationCodeValue": verification_code(sums),
                                        "packageVerificationCodeExcludedFiles": ["./" + bill_path(name)]},
            "licenseConcluded": licence, "licenseDeclared": licence, "licenseInfoFromFiles": [licence],
            "copyrightText": holders}


def describe_file(root, path, licence):
    """A file of the package."""
    sha1, sha256 = digests(os.path.join(root, path))
    return {"SPDXID": identifier("File", path), "fileName": "./" + path,
            "checksums": [{"algorithm": "SHA1", "checksumValue": sha1}, {"algorithm": "SHA256", "checksumValue": sha256}],
            "fileTypes": ["BINARY" if is_elf(os.path.join(root, path)) else "OTHER"],
            "licenseConcluded": licence, "licenseInfoInFiles": [licence], "copyrightText": "NOASSERTION"}


def link(root, files, arch):
    """What the programs are made of: packages, and who stands how to whom."""
    packages, relations = {}, []
    for path in files:
        if not is_elf(os.path.join(root, path)):
            continue
        for library in needed(os.path.join(root, path)):
            found = library_package(owner(library, arch), arch)
            packages[found["SPDXID"]] = found
            relations.append(relation(identifier("File", path), "DYNAMIC_LINK", found["SPDXID"], library))
        for facts in compilers(os.path.join(root, path)):
            found = compiler_package(*facts)
            packages[found["SPDXID"]] = found
            relations.append(relation(found["SPDXID"], "BUILD_TOOL_OF", identifier("File", path)))
    return [packages[key] for key in sorted(packages)], relations


def make(root, name, version, arch):
    """The bill of what lies in a folder."""
    files = files_of(root, name)
    licence = own_licence(root, name)[0]
    described = [describe_file(root, path, licence) for path in files]
    sums = [file["checksums"][0]["checksumValue"] for file in described]
    packages, relations = link(root, files, arch)
    own = own_package(root, name, version, arch, sums)
    made = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(int(os.environ.get("SOURCE_DATE_EPOCH", "0"))))
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": DOCUMENT, "name": "%s-%s-%s" % (name, version, arch),
            "documentNamespace": "https://landmass.example/spdx/%s-%s-%s-%s" % (name, version, arch, verification_code(sums)),
            "creationInfo": {"created": made, "creators": ["Organization: landmass maintainers", "Tool: landmass-sbom-1"]},
            "packages": [own] + packages, "files": described,
            "relationships": [relation(DOCUMENT, "DESCRIBES", PACKAGE)] +
                             [relation(PACKAGE, "CONTAINS", file["SPDXID"]) for file in described] + relations}


# ---- a package against its bill ----

def faults_of_form(bill):
    """What the standard asks for and the bill lacks."""
    faults = []
    elements = bill["packages"] + bill["files"]
    known = [element["SPDXID"] for element in elements] + [bill["SPDXID"]]
    if (bill["spdxVersion"], bill["dataLicense"], bill["SPDXID"]) != ("SPDX-2.3", "CC0-1.0", DOCUMENT):
        faults.append("the head is not that of SPDX 2.3")
    faults += ["%s: not an identifier" % i for i in known if not re.fullmatch(r"SPDXRef-[A-Za-z0-9.-]+", i)]
    faults += ["%s: stands twice" % i for i in sorted(set(known)) if known.count(i) > 1]
    faults += ["%s: no such element" % i for r in bill["relationships"]
               for i in (r["spdxElementId"], r["relatedSpdxElement"]) if i not in known]
    faults += ["%s: no licence" % p["name"] for p in bill["packages"] if not p.get("licenseDeclared")]
    faults += ["%s: no version" % p["name"] for p in bill["packages"] if not p.get("versionInfo")]
    return faults


def faults_of_files(bill, root, name):
    """Files that are in one and not in the other, or others."""
    there, told = set(files_of(root, name)), {file["fileName"][2:]: file for file in bill["files"]}
    faults = ["%s: not in the bill" % path for path in sorted(there - set(told))]
    faults += ["%s: not in the package" % path for path in sorted(set(told) - there)]
    for path in sorted(there & set(told)):
        sums = tuple(c["checksumValue"] for c in told[path]["checksums"])
        if sums != digests(os.path.join(root, path)):
            faults.append("%s: another content than the bill's" % path)
    sums = [file["checksums"][0]["checksumValue"] for file in bill["files"]]
    own = next(p for p in bill["packages"] if p["SPDXID"] == PACKAGE)
    if own["packageVerificationCode"]["packageVerificationCodeValue"] != verification_code(sums):
        faults.append("the verification code is another")
    return faults


def faults_of_links(bill, root, name):
    """Libraries and compilers that a program names and the bill does not, and the other way round."""
    packages = {p["SPDXID"]: p for p in bill["packages"]}
    faults = []
    for path in files_of(root, name):
        whole, me = os.path.join(root, path), identifier("File", path)
        is_program = is_elf(whole)
        there = set(needed(whole)) if is_program else set()
        told = {r["comment"] for r in bill["relationships"] if r["relationshipType"] == "DYNAMIC_LINK" and r["spdxElementId"] == me}
        tools = {c[:2] for c in compilers(whole)} if is_program else set()
        named = {(packages[r["spdxElementId"]]["name"], packages[r["spdxElementId"]]["versionInfo"]) for r in
                 bill["relationships"] if r["relationshipType"] == "BUILD_TOOL_OF" and r["relatedSpdxElement"] == me}
        faults += ["%s: %s is not in the bill" % (path, library) for library in sorted(there - told)]
        faults += ["%s: does not ask for %s" % (path, library) for library in sorted(told - there)]
        if is_program and (not tools or tools != named):
            faults.append("%s: made by %s, says the bill, and by %s" % (path, sorted(named), sorted(tools)))
    return faults


def check(deb):
    """What is wrong with a package's bill: sentences."""
    with tempfile.TemporaryDirectory() as root:
        run("dpkg-deb", "-x", deb, root)
        found = glob.glob(os.path.join(root, "usr/share/doc/*/*.spdx.json"))
        if len(found) != 1:
            return ["it has no bill of materials"]
        try:
            with open(found[0], encoding="utf-8") as text:
                bill = json.load(text)
            name = next(p for p in bill["packages"] if p["SPDXID"] == PACKAGE)["name"]
            return faults_of_form(bill) or faults_of_files(bill, root, name) + faults_of_links(bill, root, name)
        except (KeyError, IndexError, TypeError, ValueError, StopIteration) as cause:
            return ["its bill is not SPDX: %s: %s" % (type(cause).__name__, cause)]


def main():
    """The command line."""
    parser = argparse.ArgumentParser(prog="sbom.py", description="The software bill of materials of a Debian package: SPDX 2.3.")
    commands = parser.add_subparsers(dest="command", required=True)
    maker = commands.add_parser("make", help="write the bill of what lies in a folder into its doc folder")
    maker.add_argument("root", help="folder that becomes the package")
    for word, meaning in (("name", "of the package"), ("version", "of the package"), ("arch", "amd64 or arm64")):
        maker.add_argument(word, help=meaning)
    checker = commands.add_parser("check", help="compare packages with their bills; 1: something is wrong")
    checker.add_argument("deb", nargs="+", help="package")
    chosen = parser.parse_args()
    if chosen.command == "make":
        bill = make(chosen.root, chosen.name, chosen.version, chosen.arch)
        with open(os.path.join(chosen.root, bill_path(chosen.name)), "w", encoding="utf-8") as out:
            json.dump(bill, out, indent=1, ensure_ascii=True)
            out.write("\n")
        return 0
    faults = [(deb, fault) for deb in chosen.deb for fault in check(deb)]
    for fault in faults:
        print("sbom: %s: %s" % fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (SbomError, OSError) as error:
        sys.exit("sbom: %s" % error)
