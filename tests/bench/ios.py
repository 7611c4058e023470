"""landmass-ios with a full bus and ten pages: frames that a page did not get, and processor time.

Usage: ios.py LANDMASS_IOS IMAGE [SECONDS]. The bus is a log of 8,000 frames a second, some 1 Mbit/s; pages read it over
the loopback interface."""
import os
import pathlib
import resource
import sys
import tempfile
import threading

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "ios"))
from server import Server  # noqa: E402  pylint: disable=wrong-import-position
from wire import Page  # noqa: E402  pylint: disable=wrong-import-position

FRAMES_A_S, PAGES = 8000, 10


def hear(page, counts):
    counts.append(sum(" log " in line for line in page.lines(lambda line: line.endswith("#00000000FFFFFFFF"), 30)))
    page.close()


def main():
    program, image = sys.argv[1:3]
    seconds = int(sys.argv[3]) if len(sys.argv) > 3 else 10
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder) / "bus.log"
        frames = FRAMES_A_S * seconds
        # The pages are there before the second frame is.
        lines = ["(0.000000) can0 100#0000000000000000\n"]
        lines += [f"({3 + i / FRAMES_A_S:.6f}) can0 {0x100 + i % 512:03X}#{i:016X}\n" for i in range(frames)]
        lines.append(f"({3 + seconds:.6f}) can0 100#00000000FFFFFFFF\n")
        log.write_text("".join(lines))
        (pathlib.Path(folder) / "index.html").write_text("<title>bench</title>")
        counts = []
        with Server("--image", image, "--site", folder, "--log", log, program=program) as server:
            threads = [threading.Thread(target=hear, args=(Page(server.port), counts)) for _ in range(PAGES)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
    lost = sum(frames + 1 - count for count in counts if count < frames + 1)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    percent = 100 * (used.ru_utime + used.ru_stime) / (seconds + 3)
    print(f"landmass-ios, {PAGES} pages, {FRAMES_A_S} frames a second for {seconds} s: {lost} frames lost of {frames * PAGES}, "
          f"{percent:.1f} % of one core")
    return os.EX_OK if lost == 0 and len(counts) == PAGES else 1


if __name__ == "__main__":
    sys.exit(main())
