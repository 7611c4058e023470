"""What the flash is asked for in flight: bytes a line and a frame, by mode and speed, over the built-in scene.

    flash.py BUILD-DIR

Flies east past the town at 3,000 m, range 10 nautical miles. Two flights of each kind, of which the longer goes on where the
shorter ends: their difference is the steady state, without the tiles that every flight begins with. The counts are those
of landmass-sim, the same in each run. Nothing here passes or fails.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

RUN = Path("build/run")
SPEEDS_M_S = (250, 700)
BEGIN_S, END_S = 6, 26
MODES = {"GM": "", "GMT": "0.1 gmt", "SEA": "0.1 sea", "GM EXP": "0.1 gm exp", "GM DBS1": "0.1 gm dbs1",
         "GM DBS2": "0.1 gm dbs2"}
# Where the cursor stands, for the fields of view that look there: half of the range ahead and to the right.
CURSOR = "0.3 slew 1 0.5 0.48"


def fly(programs, work, speed, script, seconds):
    """The report of landmass-sim."""
    log, lines, report = (f"{work}/{name}" for name in ("flight.log", "script", "report.json"))
    subprocess.run([programs / "landmass-nav", "--straight", f"42.045,-29.18,90,3000,{speed}", "--seconds", str(END_S + 1),
                    "--out", log], check=True, capture_output=True)
    Path(lines).write_text(script + "\n")
    subprocess.run([programs / "landmass-sim", "--db", RUN / "scene.lmdb", "--bus", log, "--script", lines, "--seconds",
                    str(seconds), "--png", f"{work}/png", "--every", "0", "--json", report], check=True, capture_output=True)
    return json.loads(Path(report).read_text())["report"]


def steady(programs, work, speed, script):
    """(bytes, tiles, lines, frames, coarser look-ups) of the time from BEGIN_S to END_S."""
    def counts(seconds):
        r = fly(programs, work, speed, script, seconds)
        return (r["tiles"]["bytes_read"], r["tiles"]["read"], r["lines"], r["frames"], r["tiles"]["substituted"])
    return [after - before for after, before in zip(counts(END_S), counts(BEGIN_S))]


def patches():
    """A patch each four seconds, of the places of the scene."""
    text = (RUN / "scene/scene.txt").read_text().split("# place", 1)[1]
    places = [line.split() for line in text.splitlines()[1:] if line.strip()]
    names = ("town", "harbour", "airfield", "lake", "river-valley")
    found = [words for words in places if words[0] in names]
    return "\n".join(f"{BEGIN_S + 0.5 + 4 * i} sar {words[1]} {words[2]} 5" for i, words in enumerate(found))


def main():
    programs = Path(sys.argv[1]) / "bin"
    if not (RUN / "scene.lmdb").exists():
        print("No build/run/scene.lmdb (make run): no reads of flash counted")
        return
    print("Flash in steady flight over the built-in scene, from "
          f"{BEGIN_S} to {END_S} s (in the last row {len(patches().splitlines())} patches of 5 m)")
    print(f"  {'':10}{'m/s':>6}{'tiles':>8}{'kB a second':>13}{'bytes a line':>14}{'a frame':>10}{'coarser look-ups':>18}")
    with tempfile.TemporaryDirectory() as work:
        flights = {name: f"0 range 10\n{line}\n{CURSOR}" for name, line in MODES.items()}
        flights["SAR"] = f"0 range 10\n{patches()}"
        for name, script in flights.items():
            for speed in SPEEDS_M_S:
                size, tiles, lines, frames, coarser = steady(programs, work, speed, script)
                print(f"  {name:10}{speed:6}{tiles:8}{size / (END_S - BEGIN_S) / 1e3:13.1f}{size / max(lines, 1):14.0f}"
                      f"{size / max(frames, 1):10.0f}{coarser:18}")


if __name__ == "__main__":
    main()
