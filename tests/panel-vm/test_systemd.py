"""The panel's package on a small Debian with systemd as its first program: installed by dpkg, started, watched, restarted."""

import glob
import os
import re
import shutil
import subprocess

import machine
from cases import case, expect, main
from fixtures import HOST, WORK, database, log, public_key
from machine import FOLDER, Machine
from panel import BEZEL, GPIO, RELEASED, Panel, fly, is_fine

HERE = os.path.dirname(os.path.abspath(__file__))
DISK = os.path.join(FOLDER, "systemd")
SETTINGS = {"can": "vcan0", "can.node": "20", "database.key": "/etc/landmass-panel.pem", "glass.picture": "640x480",
            "stick": "0627:0001", **BEZEL}


class Service(Panel):
    """The panel as a service."""

    def __init__(self, m):  # pylint: disable=super-init-not-called
        self.machine = m

    def said(self):
        return self.machine.do("journalctl --no-pager -o cat -u landmass-panel")

    def stop(self):
        self.machine.do("systemctl stop landmass-panel")

    def show(self, name):
        """A property of the service."""
        return self.machine.do("systemctl show -P %s landmass-panel" % name)

    def until_active(self, limit_s=240):
        """Wait until systemd says that it runs."""
        self.machine.until("[ $(systemctl is-active landmass-panel) = active ]", limit_s)


def newer():
    """The sound database, signed with the next serial number; its path."""
    path = os.path.join(WORK, "newer.lmdb")
    subprocess.run([os.path.join(HOST, "landmass-db"), "sign", "--key", os.path.join(WORK, "signing.pem"), "--serial", "2",
                    os.path.join(WORK, "small-plain.lmdb"), path], check=True, stdout=subprocess.DEVNULL)
    return path


def boot():
    top = os.path.join(WORK, "tree-systemd")
    shutil.rmtree(top, ignore_errors=True)
    shutil.copytree(os.path.join(DISK, "boot"), top)
    os.makedirs(os.path.join(top, "t"))
    deb = max(glob.glob("build/packages/landmass-panel_*_arm64.deb"), key=os.path.getmtime)
    shutil.copy(deb, os.path.join(top, "t", "landmass-panel.deb"))
    for path in (log("still"), database("small"), newer(), public_key()):
        shutil.copy(path, os.path.join(top, "t"))
    disk = "file=%s,if=none,id=disk,format=raw,snapshot=on" % os.path.abspath(os.path.join(DISK, "disk.img"))
    return Machine(tree=top, memory_mb=512, limit_s=880, devices=[
        "-drive", disk, "-device", "virtio-blk-pci,drive=disk", "-device", "virtio-gpu-pci,xres=640,yres=480",
        "-device", "qemu-xhci", "-device", "usb-tablet,id=stick"])


def prepare(m):
    """Devices as a board has them."""
    m.do("ip link add vcan0 type vcan && ip link set vcan0 up")
    for name in GPIO[:6]:
        m.gpio_in(GPIO.index(name), RELEASED)


@case("dpkg installs the package on a machine that runs systemd, which starts the service")
def installed(m):
    m.do("udevadm settle; dpkg -i /t/landmass-panel.deb", limit_s=400)
    expect(m.do("systemctl is-enabled landmass-panel") == "enabled")
    p = Service(m)
    p.until_active()
    expect(p.show("Type") == "notify" and p.show("User") == "landmass-panel", p.show("User"))
    p.until(lambda text: "DB FAIL" in text)
    expect(p.show("StatusText").find("DB FAIL") >= 0, p.show("StatusText"))


@case("with a database in its slot and a bus it shows the picture, as its user, with keys, stick and recording")
def flies(m):
    m.do("cp /t/public.pem /etc/landmass-panel.pem")
    m.do("cat >>/etc/landmass-panel.conf <<'END'\n%sEND\n" % "".join("%s = %s\n" % item for item in SETTINGS.items()))
    m.do("landmass-load put /t/small.lmdb; chown landmass-panel: /var/lib/landmass-panel/*")
    fly(m)
    m.do("systemctl restart landmass-panel")
    p = Service(m)
    p.until(is_fine)
    who = m.do("ps -o user:20=,cls= -p %s" % p.show("MainPID")).split()
    expect(who == ["landmass-panel", "FF"], who)
    expect("RESTART" not in p.read(), "a restart that was asked for is told as one that was not")
    m.until("journalctl -o cat -u landmass-panel | grep -q 'hand controller: .*0627:0001'")
    m.until("ls /var/lib/landmass-panel/recordings/flight-*-000.log")
    p.press("OSB12")
    p.until(lambda text: any("DB TINY IMAGE" in line for line in text))
    p.press("OSB13")
    said = p.said().split("signal 15")[-1]
    wrong = [line for line in said.splitlines() if re.search("denied|not permitted|not locked|not real-time|busy", line)]
    expect(not wrong, wrong)


@case("a panel that hangs is ended by systemd's watchdog and started again, and the glass says so")
def watchdog(m):
    p = Service(m)
    before = p.show("MainPID")
    m.do("kill -STOP " + before)
    m.until("[ $(systemctl show -P NRestarts landmass-panel) -ge 1 ]")
    p.until_active()
    text = p.until(lambda text: "RESTART" in text)
    expect(p.show("MainPID") not in (before, "0"), before)
    expect("watchdog" in p.said().lower() and "systemd has ended the panel before: watchdog" in p.said(), p.said()[-800:])
    p.press("OSB12")
    p.until(lambda text: any("RESTART  WATCHDOG" in line for line in text))
    p.press("OSB13")
    p.until(lambda text: is_fine(text) and "RESTART" not in text)
    expect("RESTART" in text)


@case("so is one that a signal ends")
def crash(m):
    p = Service(m)
    m.do("kill -SEGV " + p.show("MainPID"))
    p.until(lambda text: "RESTART" in text)
    p.press("OSB12")
    p.until(lambda text: any("RESTART  CRASH" in line for line in text))
    p.press("OSB13")


CHECK = "setpriv --reuid=landmass-panel --regid=landmass-panel --groups=landmass-panel,video landmass-panel --check --devices"


@case("a check of the devices beside it finds nothing wrong, says what it cannot try, and disturbs nothing")
def checked(m):
    p = Service(m)
    p.until(is_fine)
    before = p.show("MainPID"), p.show("NRestarts")
    code, said = m.sh(CHECK + " 2>&1")
    expect(code == 0, code, said)
    expect("glass: /dev/dri/card0: screen at Virtual-1; another program holds it" in said, said)
    expect("key: OSB7" in said and "was not tried" in said and "can: vcan0: up" in said, said)
    p.until(is_fine)
    expect((p.show("MainPID"), p.show("NRestarts")) == before and p.is_alive(), p.said()[-500:])


@case("without the panel it tries them, and names each that is not as it should be")
def checked_alone(m):
    Service(m).stop()
    code, said = m.sh(CHECK + " 2>&1")
    expect(code == 0 and "holds it" not in said and "was not tried" not in said, code, said)
    m.do("ip link set vcan0 down; chown root /var/lib/landmass-panel/recordings; chmod 600 /dev/gpiochip0; "
         "echo off >/sys/class/drm/card0-Virtual-1/status")
    code, said = m.sh(CHECK + " 2>&1")
    m.do("ip link set vcan0 up; chown landmass-panel /var/lib/landmass-panel/recordings; chmod 660 /dev/gpiochip0; "
         "echo detect >/sys/class/drm/card0-Virtual-1/status")
    fly(m)  # a sender ends where its interface goes down
    m.do("systemctl start landmass-panel")
    expect(code == 3, code, said)
    for words in ("can: vcan0: is down; ip link set", "record: /var/lib/landmass-panel/recordings: Permission denied",
                  "no screen is connected", "key: OSB7"):
        expect(words in said, words, said)


@case("the service for a PC over USB takes a database as the panel's user, beside the panel; stopped, it leaves no device behind")
def over_usb(m):
    m.do("modprobe -d /usr -a dummy_hcd libcomposite usb_f_fs; systemctl start landmass-load-usb")
    m.until("grep -qsx 'Cockpit panel' /sys/bus/usb/devices/*/product")
    pid = m.do("systemctl show -P MainPID landmass-load-usb")
    expect(m.do("ps -o user:20= -p " + pid).strip() == "landmass-panel", pid)
    code, said = m.sh("landmass-load send /t/newer.lmdb 2>&1", limit_s=400)
    journal = m.do("journalctl --no-pager -o cat -u landmass-load-usb")
    expect(code == 0 and "slot A: whole, load 1, flown next; slot B: " in said and "slot B: load 2;" in said, said, journal)
    expect("slot B: load 2" in journal, journal)
    m.do("systemctl stop landmass-load-usb")
    expect(m.do("systemctl show -P Result landmass-load-usb") == "success")
    expect(m.sh("ls /sys/kernel/config/usb_gadget/landmass /run/landmass-usb 2>/dev/null")[1] == "", "the gadget is still there")
    Service(m).until(is_fine)


@case("systemctl stop ends it, the lamps dark; started by hand it tells no restart")
def stopped(m):
    p = Service(m)
    p.stop()
    expect(p.show("Result") == "success" and p.show("ActiveState") == "inactive", p.show("Result"))
    expect(m.gpio_out(GPIO.index("LED-ALIVE")) in (0, None), "its lamp burns")
    expect(m.sh("ls /run/landmass-panel/ended")[0] != 0, "what ended it is still there")
    m.do("systemctl start landmass-panel")
    p.until_active()
    p.until(is_fine)
    expect("RESTART" not in p.read(), p.read())


@case("the service may do what a panel does and no more")
def sandbox(m):
    p = Service(m)
    pid = p.show("MainPID")
    status = dict(line.split(":\t", 1) for line in m.do("cat /proc/%s/status" % pid).splitlines() if ":\t" in line)
    expect(int(status["CapEff"], 16) == 0 and int(status["CapBnd"], 16) == 0 and status["NoNewPrivs"] == "1", status)
    expect(status["Seccomp"] == "2", status["Seccomp"])
    code, _ = m.sh("nsenter --mount --target %s touch /usr/landmass" % pid)
    expect(code != 0, "its file system may be written")


@case("after a purge nothing of it is left but what others made")
def purged(m):
    m.do("dpkg --purge landmass-panel", limit_s=400)
    expect(m.sh("systemctl is-active landmass-panel")[1] != "active")
    expect(m.sh("ls /etc/landmass-panel.conf /var/lib/landmass-panel /usr/sbin/landmass-panel 2>/dev/null")[1] == "")


def setup(arch):
    """The machine of the other tests, and the disk over it. None, or why that is impossible here."""
    reason = HOST_SETUP(arch)
    if reason:
        return reason
    done = subprocess.run(["sh", os.path.join(HERE, "setup_systemd.sh"), DISK, os.path.join(FOLDER, arch)],
                          capture_output=True, text=True, check=False)
    return None if done.returncode == 0 else (done.stderr.strip().splitlines() or ["setup_systemd.sh failed"])[-1]


HOST_SETUP = machine.setup

if __name__ == "__main__":
    machine.setup = setup
    main(boot, prepare)
