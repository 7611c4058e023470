"""The board in QEMU: runs an image, hands it flash contents and memory, listens to its console, and looks at its
display when the image asks for it."""
import json
import os
import re
import shutil
import socket
import subprocess
import tempfile
from pathlib import Path

QEMU = "qemu-system-aarch64"
CHIP_BYTES = 64 << 20  # of each of the two flash devices
CHIP_INDICES = (2, 5)  # QEMU's numbers of those on the lower and the upper bus
BUILD = Path("build/zcu102")
TOOLS = Path(os.environ.get("BUILD", "build/bench-linux")) / "bin/tests/zcu102"


def missing():
    """What this machine lacks to run the board, or None."""
    for name in (QEMU, "aarch64-linux-gnu-gcc"):
        if shutil.which(name) is None:
            return f"{name} is not installed (make deps)"
    return None


def split_flash(image, folder):
    """The two devices' contents as files, erased (FFh) behind the image."""
    folder.mkdir(parents=True, exist_ok=True)
    chips = []
    with open(image, "rb") as source:
        for number in range(len(CHIP_INDICES)):
            chip = folder / f"chip{number}.img"
            content = source.read(CHIP_BYTES)
            with open(chip, "wb") as target:
                target.write(content)
                target.write(b"\xff" * (CHIP_BYTES - len(content)))
            chips.append(chip)
        if source.read(1):
            raise ValueError(f"{image} is larger than the board's flash")
    return chips


def symbol(elf, name):
    """The address of a variable."""
    listing = subprocess.run(["aarch64-linux-gnu-nm", elf], capture_output=True, text=True, check=True).stdout
    return int(re.search(rf"^([0-9a-f]+) \w {name}$", listing, re.M).group(1), 16)


def checksum(picture):
    """("WIDTHxHEIGHT", checksum) of a screen dump."""
    words = subprocess.run([TOOLS / "picture_checksum", picture], capture_output=True, text=True, check=True).stdout.split()
    return words[0], words[1]


class Machine:
    """A run of QEMU, with `uart1` at the bezel's serial line, in QEMU's words. `looks` collects what the image showed: name -> (checksum it printed, checksum seen)."""

    def __init__(self, elf, folder, chips=(), memory=(), cores=1, icount=True, options=(), limit=120, uart1="null"):
        self.folder = Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.looks = {}
        self.lines = []
        self.scratch = tempfile.TemporaryDirectory()
        socket_path = Path(self.scratch.name) / "qmp"
        listener = socket.socket(socket.AF_UNIX)
        listener.bind(str(socket_path))
        listener.listen(1)
        listener.settimeout(20)
        command = ["timeout", "-k", "2", str(limit), QEMU, "-M", "xlnx-zcu102,canbus0=cb,canbus1=cb",
                   "-object", "can-bus,id=cb", "-smp", str(cores), "-m", "512M", "-display", "none",
                   "-monitor", "none", "-serial", "stdio", "-serial", uart1,
                   "-rtc", "base=2026-01-01,clock=vm", "-qmp", f"unix:{socket_path}", "-kernel", elf]
        for index, chip in zip(CHIP_INDICES, chips):
            command += ["-drive", f"if=mtd,format=raw,index={index},readonly=on,file={chip}"]
        for name, content in memory:
            command += ["-device", f"loader,file={content},addr={symbol(elf, name):#x},force-raw=on"]
        command += ["-icount", "shift=0,sleep=off"] if icount else []
        self.process = subprocess.Popen([str(word) for word in (*command, *options)], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=open(self.folder / "qemu.log", "w"),
                                        env=dict(os.environ, QEMU_AUDIO_DRV="none"))
        connection, _ = listener.accept()
        listener.close()
        self.monitor = connection.makefile("rw")
        self.monitor.readline()
        self.command("qmp_capabilities")

    def command(self, name, **arguments):
        self.monitor.write(json.dumps({"execute": name, "arguments": arguments}) + "\n")
        self.monitor.flush()
        while True:
            answer = json.loads(self.monitor.readline())
            if "error" in answer:
                raise RuntimeError(f"{name}: {answer['error']}")
            if "return" in answer:
                return answer["return"]

    def dump(self, name):
        """Write the display into NAME.ppm; its checksum."""
        picture = self.folder / f"{name}.ppm"
        self.command("screendump", filename=str(picture))
        return checksum(picture)[1]

    def say(self, text):
        """Type on the console."""
        self.process.stdin.write(text.encode())
        self.process.stdin.flush()

    def run(self, until=None):
        """Read the console to its end, or to a line that begins with `until` (or one of them), answering each LOOK. Returns the lines."""
        for raw in self.process.stdout:
            line = raw.decode("ascii", "replace").strip()
            self.lines.append(line)
            look = re.fullmatch(r"LOOK (\S+) ([0-9a-f]{8})", line)
            if look:
                self.looks[look.group(1)] = (look.group(2), self.dump(look.group(1)))
                self.say("\n")
            if until is not None and line.startswith(until):
                break
        return self.lines

    def value(self, name):
        """The number that the image printed behind `name`."""
        for line in self.lines:
            words = line.split()
            if len(words) == 2 and words[0] == name:
                return int(words[1])
        raise KeyError(f"the image did not print {name}")

    def close(self):
        """End the run; QEMU's exit status (124: it took longer than its limit)."""
        if self.process.poll() is None:
            try:
                self.command("quit")
            except (OSError, ValueError, RuntimeError):
                pass
        status = self.process.wait()
        self.process.stdin.close()
        self.process.stdout.close()
        self.scratch.cleanup()
        return status

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
