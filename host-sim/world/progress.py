"""What Snakemake says of a world, in few lines: `snakemake --log-handler-script progress.py`.

A line when a step ends: how many are done, what it was, when, and while shards are made how long the others will take at the
pace so far. What fails says why by itself; here is which step it was, and where its log is.
"""

import sys
import time

from snakemake.logging import logger

logger.log_handler.clear()  # what Snakemake itself would say; --quiet would also keep from us what ends
BEGAN = time.time()
STEPS = {}  # by the number of the job: its name
DONE = {"shard": 0, "classes_strip": 0, "gamma_strip": 0}
LEFT = {}
TITLES = {"shard": "shard", "classes_strip": "strip of the classes", "gamma_strip": "strip of the reflectivity", "mosaic": "raster of strips",
          "plan": "plan", "classes_plan": "plan of the classes", "gamma_plan": "plan of the reflectivity", "join": "image", "verify": "check",
          "picture": "picture", "report": "report", "all": "all", "estimate": "estimate", "estimate_classes": "estimate of the classes"}


def clock(seconds):
    return "%d s" % seconds if seconds < 100 else "%d min" % (seconds / 60 + 0.5) if seconds < 6000 else "%.1f h" % (seconds / 3600)


def say(text):
    print(text, file=sys.stderr, flush=True)


def begin(message):
    details = list(dict(message.get("wildcards") or {}).values())
    word = " " + str(details[0])[:12] if details else ""
    STEPS[message["jobid"]] = (message["name"], TITLES.get(message["name"], message["name"]) + word)


def count(table):
    """How many of each kind are to be made, from Snakemake's table of steps."""
    for row in (line.split() for line in table.splitlines()):
        if len(row) >= 2 and row[0] in DONE and row[1].isdigit():
            LEFT[row[0]] = int(row[1])


def end(job):
    kind, title = STEPS.get(job, ("", "a step"))
    passed = time.time() - BEGAN
    pace = ""
    if kind in DONE:
        DONE[kind] += 1
        left = LEFT.get(kind, 0) - DONE[kind]
        if left > 0:
            pace = "; %d more, some %s at this pace" % (left, clock(left * passed / DONE[kind]))
    say("%s: %s is made%s" % (clock(passed), title, pace))


def log_handler(message):
    level = message.get("level")
    if level == "job_info":
        begin(message)
    elif level == "run_info":
        count(message["msg"])
    elif level == "job_finished":
        end(message["jobid"])
    elif level == "job_error":
        say("step failed: %s; its log: %s" % (STEPS.get(message["jobid"], ("", message.get("name")))[1], ", ".join(message.get("log") or ["none"])))
    elif level == "error":
        say(str(message["msg"]))
