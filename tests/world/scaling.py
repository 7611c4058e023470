#!/usr/bin/env python3
"""How fast shards are made on one node of Slurm and on two, each with one core: scaling.py [REPEATS] [SHARDS]

The nodes are daemons of this machine (cluster.py), which needs two cores that nobody else uses, or the figures say little. The
ground is some 75 km of the built-in generator. A round is one world on one node, then one on two. Prints the seconds from the
first step to the last of each, and how much faster two nodes are, the smallest and the median of the rounds; beside it what
cost.py's schedule makes of the shards' own processor times, and the machine's load before each.
"""

import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

import cluster

TOP = os.path.abspath(".")
BUILD = os.path.abspath(os.environ.get("BUILD", "build/bench-linux"))
WORLD = TOP + "/host-sim/world"
CLASSES = TOP + "/host-sim/programs/db/classes/heaton6.classes"


def snakemake(targets, nodes, shards, environment):
    words = ["snakemake", *targets, "-s", WORLD + "/Snakefile", "--profile", WORLD + "/slurm", "--nolock", "--jobs", str(nodes), "--config",
             "db=" + BUILD + "/bin/landmass-db", "options=--classes %s --terrain ground/terrain.tif" % CLASSES, "work=work", "out=world.lmdb",
             "shards=%d" % shards]
    done = subprocess.run(words, env=dict(environment, CI="true"), capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        sys.exit("scaling: " + done.stderr[-2000:])


def shards_on(nodes, shards, environment):
    """Seconds for all shards of a plan that is there."""
    shutil.rmtree("work/parts", ignore_errors=True)
    parts = ["work/parts/%s.part" % line.split()[-1] for line in open("work/image.plan") if line.startswith("shard ")]
    begin = time.time()
    snakemake(parts, nodes, shards, environment)
    return time.time() - begin


def schedule():
    """Of the last reports; cost.py wants those of an image that is joined, too."""
    subprocess.run([BUILD + "/bin/landmass-db", "join", "work/image.plan", "--parts", "work/parts", "--out", "world.lmdb", "--json",
                    "work/reports/join.json"], check=True, capture_output=True)
    return subprocess.run([sys.executable, "-B", WORLD + "/cost.py", "work", "--times", "1", "2"], check=True, capture_output=True,
                          text=True).stdout.strip()


def main():
    repeats = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    shards = int(sys.argv[2]) if len(sys.argv) > 2 else 8
    missing = cluster.why_not()
    if missing or not shutil.which("snakemake"):
        sys.exit("scaling: %s" % (missing or "snakemake missing; make deps-world installs it"))
    taken = {1: [], 2: []}
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as work:
        os.chdir(work)
        subprocess.run([BUILD + "/bin/landmass-scene", "--out", "ground", "--size", "1500", "--cell", "50"], check=True, capture_output=True)
        nodes = cluster.Cluster(work + "/cluster", 2)
        try:
            snakemake(["work/image.plan"], 1, shards, nodes.environment)
            for number in range(repeats):
                for count in (1, 2):
                    load = os.getloadavg()[0]
                    taken[count].append(shards_on(count, shards, nodes.environment))
                    print("round %d, %d node%s: %.1f s; load before: %.1f" % (number + 1, count, "s" * (count > 1), taken[count][-1], load),
                          flush=True)
            print("%d shards: " % shards + "; ".join("%d node%s: least %.1f s, median %.1f s" % (n, "s" * (n > 1), min(t), statistics.median(t))
                                                   for n, t in taken.items()))
            print("two nodes are %.2f times as fast by the least, %.2f by the median"
                  % (min(taken[1]) / min(taken[2]), statistics.median(taken[1]) / statistics.median(taken[2])))
            print("schedule: " + schedule())
        finally:
            nodes.end()
            os.chdir("/")


main()
