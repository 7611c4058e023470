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
SlurmdTimeout=300
InactiveLimit=60
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
        self.folder, self.nodes = folder, nodes
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

    def process(self, name):
        """The id that a daemon wrote: head, n1, n2 ..., munge; None where it has none."""
        try:
            with open("%s/%s.pid" % (self.folder, name)) as file:
                return int(file.read())
        except (FileNotFoundError, ValueError):
            return None

    def kill(self, name, how=signal.SIGTERM):
        """End a daemon, and wait until it is gone."""
        process = self.process(name)
        try:
            os.kill(process, how)
            for _ in range(600):
                os.kill(process, 0)
                time.sleep(0.1)
        except (TypeError, ProcessLookupError):
            pass

    def restart_head(self):
        """The head ends as a machine does that is shut down, which keeps its state, and begins again. A head that is cut
        off instead forgets what it was told in the last seconds, and the srun of such a step waits for ever."""
        self.kill("head")
        self.head()
        for _ in range(600):
            try:
                self.run("squeue", "-h")
                return
            except OSError:
                time.sleep(0.1)
        raise OSError("the head does not answer")

    def kill_node(self, name):
        """A node dies with all that it runs: the daemon, and the processes of its steps. The head is told at once, as by
        a cluster's watchdog: how long Slurm takes to notice (SlurmdTimeout) is not what is tested."""
        self.kill(name, signal.SIGKILL)
        for path in os.listdir("/proc"):
            try:
                if path.isdigit() and ("SLURMD_NODENAME=" + name).encode() in self.environ_of(path):
                    os.kill(int(path), signal.SIGKILL)
            except OSError:
                pass
        self.run("scontrol", "update", "NodeName=" + name, "State=DOWN", "Reason=killed")

    def start_node(self, name):
        """A node that died comes back (ReturnToService)."""
        self.run("slurmd", "-N", name)
        self.wait_for("idle", self.nodes)

    def told(self):
        """What Slurm says: nodes, queue and the ends of its logs."""
        texts = []
        for words in (("sinfo", "-N", "-l"), ("squeue", "-l")):
            try:
                texts.append("%s:\n%s" % (words[0], self.run(*words)))
            except (OSError, subprocess.TimeoutExpired) as error:
                texts.append(str(error))
        for name in sorted(os.listdir(self.folder)):
            if name.endswith(".log"):
                with open(self.folder + "/" + name, errors="replace") as file:
                    texts.append("%s:\n%s" % (name, "".join(file.readlines()[-25:])))
        return "\n".join(texts)

    def environ_of(self, process):
        """Of a process of this cluster alone."""
        with open("/proc/%s/environ" % process, "rb") as file:
            variables = file.read().split(b"\0")
        return variables if ("SLURM_CONF=" + self.folder + "/slurm.conf").encode() in variables else []

    def end(self):
        for name in sorted(os.listdir(self.folder)):
            if name.endswith(".pid") and name != "munge.pid":
                self.kill(name[:-4], signal.SIGKILL if name == "head.pid" else signal.SIGTERM)
        self.kill("munge")
