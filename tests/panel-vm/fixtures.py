"""What the cases need in the machine: programs, databases, traffic. Made by the project's own tools."""

import os
import shutil
import subprocess

HOST = os.path.join(os.environ.get("BUILD", "build/bench-linux"), "bin")
ARM64 = "build/panel-linux-arm64/bin"
WORK = "build/panel-vm/fixtures"
# Somebody who stands still in the air makes the same picture at whatever moment it is drawn.
FLIGHTS = {"flight": ("--straight", "45.97,11,0,2000,150", "--seconds", "5"),
           "still": ("--straight", "45.97,11,0,2000,0", "--seconds", "120")}


def log(name):
    """A flight as candump -L text; its path."""
    os.makedirs(WORK, exist_ok=True)
    path = os.path.join(WORK, name + ".log")
    subprocess.run([os.path.join(HOST, "landmass-nav"), *FLIGHTS[name], "--quiet", "--out", path], check=True)
    return path


def tree(*programs, logs=()):
    """A folder for a Machine: /t with test programs of this folder and flights."""
    top = os.path.join(WORK, "tree")
    shutil.rmtree(top, ignore_errors=True)
    os.makedirs(os.path.join(top, "t"))
    for program in programs:
        shutil.copy(os.path.join(ARM64, "tests/panel-vm", program), os.path.join(top, "t"))
    for name in logs:
        shutil.copy(log(name), os.path.join(top, "t"))
    return top


def frames(text):
    """The frames of candump -L text, without times and interfaces."""
    return [line.split()[2] for line in text.splitlines() if line.startswith("(")]
