"""A Slurm cluster of one-core nodes on this machine, for tests: its own configuration, its own state, every daemon ended by
the process id that it wrote. Needs root, slurm-wlm and munge; no systemd, no control groups, no accounting."""

import os
import shutil
import signal
import socket
import subprocess
import time

CONFIGURATION = """ClusterName=landmass-test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/head.pid
SlurmdPidFile={folder}/%n.pid
SlurmctldLogFile={folder}/head.log
SlurmdLogFile={folder}/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
SlurmdTimeout=15
InactiveLimit=20
NodeName=n[1-{nodes}] NodeHostname={host} NodeAddr=127.0.0.1 Port=[{first}-{last}] CPUs=1 RealMemory=4000 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES State=UP
"""


def why_not():
    """What is missing for a cluster, or None."""
    missing = [name for name in ("slurmctld", "slurmd", "srun", "sinfo", "munged", "mungekey") if not shutil.which(name)]
    if missing:
        return "%s missing; make deps-world installs them" % ", ".join(missing)
    return None if os.geteuid() == 0 else "a cluster needs root"


def free_port(count):
    """The first of some ports in a row that nobody listens on."""
    for first in range(17100 + os.getpid() % 500 * 10, 60000, 10):
        sockets = []
        try:
            for port in range(first, first + count):
                sockets.append(socket.socket())
                sockets[-1].bind(("127.0.0.1", port))
            return first
        except OSError:
            continue
        finally:
            for opened in sockets:
                opened.close()
    raise OSError("no free ports")


class Cluster:
    def __init__(self, folder, nodes):
        self.folder = folder
        os.makedirs(folder + "/state")
        port = free_port(nodes + 1)
        host = socket.gethostname().split(".")[0]
        with open(folder + "/slurm.conf", "w") as file:
            file.write(CONFIGURATION.format(host=host, port=port, folder=folder, nodes=nodes, first=port + 1, last=port + nodes))
        self.environment = dict(os.environ, SLURM_CONF=folder + "/slurm.conf")
        self.run("mungekey", "--create", "--keyfile=" + folder + "/munge.key")
        self.run("munged", "--force", "--key-file=" + folder + "/munge.key", "--socket=" + folder + "/munge.socket", "--pid-file=" + folder
                 + "/munge.pid", "--log-file=" + folder + "/munge.log", "--seed-file=" + folder + "/munge.seed")
        self.head()
        for number in range(1, nodes + 1):
            os.makedirs("%s/spool-n%d" % (folder, number))
            self.run("slurmd", "-N", "n%d" % number)
        self.wait_for("idle", nodes)

    def run(self, *words):
        done = subprocess.run(words, env=self.environment, capture_output=True, text=True, timeout=60, stdin=subprocess.DEVNULL)
        if done.returncode != 0:
            raise OSError("%s: %s" % (" ".join(words), done.stderr))
        return done.stdout

    def head(self):
        self.run("slurmctld")

    def wait_for(self, state, nodes, seconds=60):
        for _ in range(2 * seconds):
            try:
                if sum(int(n) for n in self.run("sinfo", "-h", "-t", state, "-o", "%D").split()) == nodes:
                    return
            except OSError:
                pass
            time.sleep(0.5)
        raise OSError("the nodes are not " + state)

    def kill(self, name, how=signal.SIGKILL):
        """End a daemon by the id that it wrote: head, n1, n2 ..., munge."""
        try:
            with open("%s/%s.pid" % (self.folder, name)) as file:
                os.kill(int(file.read()), how)
        except (FileNotFoundError, ProcessLookupError, ValueError):
            pass

    def kill_node(self, name):
        """A node dies with all that it runs: the daemon, and the processes of its steps."""
        with open("%s/%s.pid" % (self.folder, name)) as file:
            os.kill(int(file.read()), signal.SIGKILL)
        for path in os.listdir("/proc"):
            try:
                if path.isdigit() and ("SLURMD_NODENAME=" + name).encode() in self.environ_of(path):
                    os.kill(int(path), signal.SIGKILL)
            except OSError:
                pass

    def environ_of(self, process):
        """Of a process of this cluster alone."""
        with open("/proc/%s/environ" % process, "rb") as file:
            variables = file.read().split(b"\0")
        return variables if ("SLURM_CONF=" + self.folder + "/slurm.conf").encode() in variables else []

    def end(self):
        for name in sorted(os.listdir(self.folder)):
            if name.endswith(".pid") and name not in ("munge.pid",):
                self.kill(name[:-4], signal.SIGTERM)
        time.sleep(1)
        self.kill("munge", signal.SIGTERM)
