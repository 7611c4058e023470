"""A panel that flies beside landmass-ios: program, loop and clock of landmass-panel (virtual_panel.c)."""
import signal
import subprocess
import threading

from server import BUILD
from wire import Page

CONFIG = {"can": "none", "can.controls": "obey", "glass": "none", "database.trust": "any", "database.serial": "none",
          "glass.picture": "512x512", "stick": "none", "realtime.priority": "0", "realtime.memory": "free"}


class Panel:
    """Between two ends of a pipe: frames of the server's bus go in, sums of its glass's pictures come out. It records
    into the folder `recordings` of its own one, which must be there."""

    def __init__(self, port, folder, scene, **options):
        settings = {**CONFIG, "database": scene, "record": folder / "recordings",
                    **{name.replace("_", "."): value for name, value in options.items()}}
        (folder / "panel.conf").write_text("".join(f"{name} = {value}\n" for name, value in settings.items()))
        self.notes = folder / "panel.sums"
        self.child = subprocess.Popen([BUILD / "bin/tests/ios/virtual_panel", folder / "panel.conf", self.notes],
                                      stdin=subprocess.PIPE, stderr=(folder / "panel.said").open("w"))
        self.bus = Page(port)
        threading.Thread(target=self.carry, daemon=True).start()

    def carry(self):
        """Frames that are new; what is past the firmware would take for new."""
        try:
            while True:
                lines = [line for line in self.bus.message()[1].splitlines(keepends=True) if b" past " not in line]
                self.child.stdin.write(b"".join(lines))
                self.child.stdin.flush()
        except (OSError, ValueError):
            pass  # one of the two has ended

    def sums(self):
        """By number of the picture: the step that drew it, and its sum."""
        rows = [line.split() for line in self.notes.read_text().splitlines(keepends=True) if line.endswith("\n")]
        return {int(number): {"steps": int(step), "sum": crc} for number, step, crc in rows}

    def check(self, shown):
        """Pictures that a page showed, by number, are this panel's at their steps, and none was left out."""
        wanted, numbers = self.sums(), sorted(shown)
        wrong = [n for n in numbers if wanted.get(n) != shown[n]]
        assert not wrong, f"{len(wrong)} of {len(shown)} pictures differ, the first is {wrong[0]}: {shown[wrong[0]]}, {wanted.get(wrong[0])}"
        assert numbers == list(range(numbers[0], numbers[0] + len(numbers))), "a picture was left out"

    def stop(self):
        self.child.send_signal(signal.SIGTERM)
        return self.child.wait(timeout=20)
