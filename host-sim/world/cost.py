"""What the land of the Earth would cost, from the measured figures of a world that was made.

    cost.py WORLD-FOLDER [--disk MB/S] [--network MB/S] [--fails SHARE]     # the folder has reports/, as the workflow leaves it

Each shard of the land takes as long a tile as one of the measured shards, in turn, and a fixed time to begin; shards go to
whatever core is free, longest first. Some fail half-way and are made again. The shared disk has one speed for all nodes.
The parts of 4,096 shards make an image, one join each. What is not measured is an option, and the table's head names it.
"""

import argparse
import glob
import heapq
import json
import math
import sys

LAND_M2 = 1.5e14
UNIT_M = 40030174.0 / 2**32  # a binary angle of the Earth's mean circle
TILE_CELLS = 64
SHARDS_A_PLAN, TILES_A_SHARD = 4096, 32768  # BUILD_SHARDS_MAX, and what `plan` allows a shard
CORES_A_NODE = 32
RECORD_BYTES = 17.6e3  # of a tile in the image, until all are joined and it is compressed


def read(folder):
    """Seconds of a processor and bytes a tile of each shard; the join's seconds and bytes a tile; MiB."""
    shards, join = [], None
    for path in sorted(glob.glob(folder + "/reports/*.json")):
        with open(path) as file:
            report = json.load(file)["report"]
        if path.endswith("join.json"):
            join = report
        elif "shard" in report and report.get("tiles", 0) > 0:
            shards.append(report)
    if not shards or not join:
        sys.exit("cost: %s: has no reports of shards and a join; name the folder of a world that was made" % folder)
    return shards, join


def makespan(seconds, cores, fails):
    """Longest first, to the core that is free first. One shard in 1 / fails ends in its middle and is done again."""
    free = [0.0] * min(cores, len(seconds))
    every = round(1 / fails) if fails > 0 else 0
    for i, took in enumerate(sorted(seconds, reverse=True)):
        heapq.heapreplace(free, free[0] + took * (1.5 if every and i % every == 0 else 1))
    return max(free)


def clock(seconds):
    return "%.1f min" % (seconds / 60) if seconds < 5400 else "%.1f h" % (seconds / 3600) if seconds < 172800 else "%.1f d" % (seconds / 86400)


def line(shards):
    """The seconds until a shard begins, and those a tile of each: the straight line that fits best, no shard below a tenth of it."""
    n = len(shards)
    x, y = [s["tiles"] for s in shards], [s["processor_s"] for s in shards]
    mx, my = sum(x) / n, sum(y) / n
    spread = sum((a - mx) ** 2 for a in x)
    slope = sum((a - mx) * (b - my) for a, b in zip(x, y)) / spread if spread > 0 else my / mx
    begin = max(my - slope * mx, 0)
    return begin, [max((b - begin) / a, slope / 10) for a, b in zip(x, y) if a >= mx / 2]


def row(cell, cores, measured, options):
    shards, join = measured
    begin, rates = line(shards)
    begin += options.start
    exponent = math.floor(math.log2(cell / UNIT_M))
    side = TILE_CELLS * UNIT_M * 2**exponent
    tiles = options.area / side**2 * 4 / 3
    count = math.ceil(tiles / TILES_A_SHARD)
    images = math.ceil(count / SHARDS_A_PLAN)
    each = tiles / count
    times = [begin + each * rate for rate in rates]
    seconds = [times[i % len(times)] for i in range(count)]
    core_s = sum(seconds) * (1 + options.fails / 2)
    made = sum(s["bytes"] for s in shards) / sum(s["tiles"] for s in shards) * tiles
    raw, image = RECORD_BYTES * tiles, join["bytes"] / join["tiles"] * tiles
    read_in = options.source * tiles
    schedule = makespan(seconds, cores, options.fails)
    traffic = read_in + made
    disk = traffic / (options.disk * 1e6)
    nodes = math.ceil(cores / CORES_A_NODE)
    wire = traffic / nodes / (options.network * 1e6)
    shard_s = max(schedule, disk, wire)
    join_cpu = join["processor_s"] / join["tiles"] * tiles
    waves = math.ceil(images / cores)
    join_s = max(join_cpu / images * waves, (made + 2 * raw + image) / (options.disk * 1e6))
    bound = "cores" if shard_s == schedule else "disk" if shard_s == disk else "network"
    return (UNIT_M * 2**exponent, tiles, count, images, core_s / 3600, join_cpu / 3600, cores,
            min(cores, count) * max(s["memory_mib"] for s in shards) / 1024, (made + raw) / 1e12, traffic / 1e12,
            clock(shard_s), bound, clock(join_s), "cores" if join_cpu / images * waves >= join_s else "disk", shard_s + join_s)


def night(measured, options):
    """Cells from coarse to fine, until the shards and the join of one plan take too long."""
    hours, cores = options.night[0], int(options.night[1])
    print("| cells | tiles | shards | disk | shards in | join in | both |\n|" + "---|" * 7)
    cell = UNIT_M * 2**18
    while cell > 1:
        (metres, tiles, count, images, _, _, _, _, disk, _, shard_time, _, join_time, _, seconds) = row(cell, cores, measured, options)
        print("| %.1f m | %.3g | %d | %.2g TB | %s | %s | %s%s |"
              % (metres, tiles, count, disk, shard_time, join_time, clock(seconds), "" if seconds <= 3600 * hours else ": too long"))
        if seconds > 3600 * hours or images > 1:
            return
        cell /= 2


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--disk", type=float, default=2000, help="MB/s of the disk that all nodes share (2000)")
    parser.add_argument("--network", type=float, default=1000, help="MB/s of a node of 32 cores (1000)")
    parser.add_argument("--source", type=float, default=12000, help="bytes of sources read a tile (12000)")
    parser.add_argument("--area", type=float, default=LAND_M2, help="square metres (1.5e14, the land)")
    parser.add_argument("--data", type=float, nargs="+", default=[30, 10, 5], help="metres of the sources' pixels (30 10 5)")
    parser.add_argument("--cores", type=int, nargs="+", default=[32, 256, 2000])
    parser.add_argument("--fails", type=float, default=0.01, help="share of shards that fail and are made again (0.01)")
    parser.add_argument("--start", type=float, default=2, help="seconds of a core between two shards, for the engine and the cluster (2)")
    parser.add_argument("--night", nargs=2, type=float, metavar=("HOURS", "CORES"), help="instead: the finest cells that so long is enough for")
    parser.add_argument("--times", nargs=2, type=int, metavar="CORES", help="instead: the measured shards on so many cores")
    options = parser.parse_args()
    measured = read(options.folder)
    if options.times:
        seconds = [s["processor_s"] for s in measured[0]]
        spans = [makespan(seconds, cores, 0) for cores in options.times]
        print("%d shards: " % len(seconds) + ", ".join("%.1f s on %d" % (span, n) for span, n in zip(spans, options.times))
              + ": %.2f times as fast" % (spans[0] / spans[1]))
        return
    if options.night:
        night(measured, options)
        return
    (shards, join), (begin, rates) = measured, line(measured[0])
    print("Measured: %d shards, %.1f s and %.2f to %.2f ms a tile, %.0f MiB; join %.2f ms a tile, %.0f MiB. Assumed: a disk of %.0f MB/s, "
          "%.0f MB/s of a node, %.0f bytes of sources a tile, "
          "%.0f s between two shards of a core.\n"
          % (len(shards), begin, 1e3 * min(rates), 1e3 * max(rates), max(s["memory_mib"] for s in shards),
             1e3 * join["processor_s"] / join["tiles"], join["memory_mib"], options.disk, options.network, options.source, options.start))
    print("| data, cells | tiles | shards, images | core-hours, of joins | cores | memory | disk | moved | shards in | joins in |\n|"
          + "---|" * 10)
    for cell in options.data:
        for cores in options.cores:
            (metres, tiles, count, images, core_h, join_h, _, memory, disk, moved, shard_time, shard_bound, join_time, join_bound,
             _) = row(cell, cores, measured, options)
            print("| %g m, %.1f m | %.2g | %d, %d | %.0f, %.0f | %d | %.0f GiB | %.1f TB | %.1f TB | %s, %s | %s, %s |"
                  % (cell, metres, tiles, count, images, core_h + join_h, join_h, cores, memory, disk, moved, shard_time, shard_bound,
                     join_time, join_bound))


main()
