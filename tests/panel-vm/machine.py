"""A machine in QEMU: Debian's kernel with real CAN, GPIO, USB, display, flash and watchdog interfaces.

The machine's shell is reached through a port of its own, so that nothing the kernel says gets in between. Sockets and logs
of a run lie in a folder of its own. QEMU never outlives its time limit.

Time in the machine is counted in instructions, a nanosecond each, and goes no faster than the real one. A busy computer
makes the machine slow, but nothing in it late; so what the tests wait for are states, or time in the machine.
"""

import json
import os
import shlex
import shutil
import socket
import subprocess
import tempfile
import time

FOLDER = "build/panel-vm"
GPIO_DATA, GPIO_DIRECTION = 0x90303FC, 0x9030400  # of the PL061: data through the mask of all lines, and direction
# What makes QEMU slow is left out. With tables of its own for programs (kpti) the kernel changes tables twice a system call,
# and QEMU forgets its translations each time. To calibrate the local timer it reads a clock for 0.1 s, which takes QEMU 4 s.
BOARDS = {"arm64": ("qemu-system-aarch64", "console=ttyAMA0 kpti=off",
                    ["-M", "virt", "-cpu", "cortex-a53", "-dtb", "board.dtb"]),
          "amd64": ("qemu-system-x86_64", "console=ttyS0 nolapic_timer", ["-M", "q35"])}


class MachineError(Exception):
    """The machine is gone, or did not answer in time."""


def setup(arch):
    """Make kernel and first file system unless they are there. None, or why that is impossible here."""
    here = os.path.dirname(os.path.abspath(__file__))
    done = subprocess.run(["sh", os.path.join(here, "setup.sh"), arch, os.path.join(FOLDER, arch)],
                          capture_output=True, text=True)
    return None if done.returncode == 0 else (done.stderr.strip().splitlines() or ["setup.sh failed"])[-1]


def archive(tree, path):
    """The tree below the folder `tree` as a cpio archive, which the kernel unpacks over the first one."""
    names = subprocess.run(["find", "."], cwd=tree, capture_output=True, check=True).stdout
    with open(path, "ab") as out:
        subprocess.run(["cpio", "-o", "-H", "newc", "-R", "+0:+0", "--quiet"], cwd=tree, input=names, stdout=out, check=True)


class Machine:
    """Boots at once; close() it. `tree` is a folder whose files appear in the machine, from / on."""

    def __init__(self, arch="arm64", tree=None, devices=(), limit_s=800, memory_mb=256):
        self.run = tempfile.mkdtemp(prefix="panel-vm.")
        initrd = os.path.join(self.run, "initrd")
        folder = os.path.abspath(os.path.join(FOLDER, arch))
        shutil.copy(os.path.join(folder, "base.cpio"), initrd)
        if tree:
            archive(tree, initrd)
        program, words, board = BOARDS[arch]
        command = ["timeout", "-k", "2", str(limit_s), program, *board, "-smp", "1", "-accel", "tcg",
                   "-icount", "shift=0,sleep=on", "-m", str(memory_mb), "-nodefaults", "-no-reboot", "-display", "none",
                   "-kernel", "Image", "-initrd", initrd, "-append", words + " quiet panic=-1",
                   "-serial", "file:" + os.path.join(self.run, "console"),
                   "-qmp", self._listen("qmp"), "-qtest", self._listen("qtest"), "-qtest-log", "/dev/null",
                   "-device", "virtio-serial-pci", "-device", "virtserialport,chardev=shell",
                   "-chardev", "socket,id=shell,server=on,wait=off,path=" + os.path.join(self.run, "shell"), *devices]
        with open(os.path.join(self.run, "qemu"), "w", encoding="utf-8") as log:
            self.process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=log,
                                            stderr=log)
        self.events = []  # what QEMU told by itself, by name
        try:
            self._qmp = self._connect("qmp")
            self._read_json()
            self.qmp("qmp_capabilities")
            self._qtest = self._connect("qtest")
            self._shell = self._connect("shell")
            self._read_until("@@ready", 180)
        except BaseException:
            self.close()
            raise

    def _listen(self, name):
        return "unix:%s,server=on,wait=off" % os.path.join(self.run, name)

    def _connect(self, name):
        deadline = time.monotonic() + 20
        while time.monotonic() < deadline and self.process.poll() is None:
            connection = socket.socket(socket.AF_UNIX)
            try:
                connection.connect(os.path.join(self.run, name))
                connection.settimeout(180)
                return connection.makefile("rwb", buffering=0) if name != "shell" else connection
            except OSError:
                connection.close()
                time.sleep(0.01)
        raise MachineError("QEMU did not start: " + self.said("qemu"))

    def said(self, name="console"):
        """What the kernel (console) or QEMU (qemu) printed, its end."""
        with open(os.path.join(self.run, name), encoding="utf-8", errors="replace") as log:
            return log.read()[-2000:]

    # ---- the machine's shell ----

    def _read_until(self, mark, limit_s):
        """All that the shell says before a line that begins with `mark`, and the rest of that line."""
        heard, deadline, looked = b"\n", time.monotonic() + limit_s, 0
        mark = b"\n" + mark.encode()
        while True:
            found = heard.find(mark, looked)
            end = heard.find(b"\n", found + 1)
            if found >= 0 and end >= 0:
                return heard[1:found + 1].decode(errors="replace"), heard[found + len(mark):end].decode().strip()
            looked = found if found >= 0 else max(0, len(heard) - len(mark))
            self._shell.settimeout(max(0.01, deadline - time.monotonic()))
            try:
                more = self._shell.recv(1 << 20)
            except socket.timeout:
                raise MachineError("no answer in %g s: %s\n%s" % (limit_s, heard[-500:], self.said())) from None
            if not more:
                raise MachineError("the machine is gone: " + self.said())
            heard += more

    def sh(self, script, limit_s=180):
        """Run a script; (exit code, what it printed)."""
        line = "sh -c %s </dev/null 2>&1; printf '\\n@@rc %%d\\n' $?\n" % shlex.quote(script)
        self._shell.sendall(line.encode())
        output, code = self._read_until("@@rc", limit_s)
        return int(code), output.rstrip("\n")

    def do(self, script, limit_s=180):
        """Run a script that must succeed; what it printed."""
        code, output = self.sh(script, limit_s)
        if code != 0:
            raise AssertionError("%s: ended with %d: %s" % (script, code, output))
        return output

    def sleep(self, seconds):
        """Let time pass in the machine."""
        self.do("sleep %g" % seconds)

    def until(self, script, limit_s=120):
        """Repeat a script until it succeeds; what it printed then."""
        deadline = time.monotonic() + limit_s
        while True:
            code, output = self.sh(script)
            if code == 0:
                return output
            if time.monotonic() > deadline:
                raise AssertionError("not within %g s: %s: %s" % (limit_s, script, output))
            time.sleep(0.05)

    # ---- QEMU's own doors ----

    def _read_json(self):
        answer = json.loads(self._qmp.readline())
        if "event" in answer:
            self.events.append(answer["event"])
        return answer

    def qmp(self, command, **arguments):
        """A command to QEMU; its answer."""
        self._qmp.write(json.dumps({"execute": command, "arguments": arguments}).encode() + b"\n")
        while True:
            answer = self._read_json()
            if "error" in answer:
                raise AssertionError("%s: %s" % (command, answer["error"]["desc"]))
            if "return" in answer:
                return answer["return"]

    def qtest(self, command):
        """A command at the level of wires and registers; the words behind OK."""
        self._qtest.write(command.encode() + b"\n")
        answer = self._qtest.readline().decode().split()
        if answer[:1] != ["OK"]:
            raise AssertionError("%s: %s" % (command, answer))
        return answer[1:]

    def gpio_in(self, line, level):
        """Set a line of the GPIO chip from outside."""
        chip = next(child["name"] for child in self.qmp("qom-list", path="/machine/unattached")
                    if child["type"] == "child<pl061>")
        self.qtest("set_irq_in /machine/unattached/%s unnamed-gpio-in %d %d" % (chip, line, level))

    def gpio_out(self, line):
        """The level that the machine drives on a line, or None when the line is an input."""
        if not int(self.qtest("readl 0x%x" % GPIO_DIRECTION)[0], 16) >> line & 1:
            return None
        return int(self.qtest("readl 0x%x" % GPIO_DATA)[0], 16) >> line & 1

    def screendump(self, path):
        """What is on the glass, as a PNG file."""
        self.qmp("screendump", filename=os.path.abspath(path), format="png")
        return path

    # ---- the end ----

    def close(self):
        """Switch it off and forget it."""
        self.process.terminate()
        try:
            self.process.wait(5)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        shutil.rmtree(self.run, ignore_errors=True)
