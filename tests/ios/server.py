"""landmass-ios as a child of a test."""
import json
import os
import pathlib
import signal
import subprocess

from wire import ask

BUILD = pathlib.Path(os.environ.get("BUILD", "build/bench-linux"))


class Server:
    """A server that runs within `with`, or between start() and stop(); it comes back at the same port."""

    def __init__(self, *words, program=BUILD / "bin/landmass-ios"):
        self.command, self.port = [str(word) for word in (program, *words)], 0

    def start(self):
        self.child = subprocess.Popen([*self.command, "--port", str(self.port)], stderr=subprocess.PIPE, text=True)
        self.port = int(self.child.stderr.readline().rstrip("/\n").rsplit(":", 1)[1])
        self.url = f"http://127.0.0.1:{self.port}/"
        return self

    def stop(self, how=signal.SIGTERM):
        if self.child.stderr.closed:
            return  # it was stopped before
        self.child.send_signal(how)
        self.said = self.child.stderr.read()
        self.status = self.child.wait(timeout=20)
        self.child.stderr.close()

    def __enter__(self):
        return self.start()

    def __exit__(self, *_):
        self.stop()

    def get(self, path, **more):
        return ask(self.port, path, **more)

    def json(self, path):
        return json.loads(self.get(path)[2])
