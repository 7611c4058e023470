"""Cases of a machine, with results in TAP.

    @case("the panel answers a request for its identity")
    def identity(m):
        ...
        expect(answer == "081#...", answer)

    main(boot, prepare)  # boot() gives a Machine, prepare(m) makes it ready for the cases, which share it
                         # arch="amd64": it is not of the panel's usual architecture

A case that raises anything has failed. When the machine is gone the next case gets a new one. Where no machine can be
had, all are skipped, and the reason is said.
"""

import signal
import sys
import time
import traceback

import machine

CASES = []


def case(sentence):
    """Register a function of a Machine as the test of a sentence."""
    def register(function):
        CASES.append((sentence, function))
        return function
    return register


class Skip(Exception):
    """What a case needs is not at hand; the words say what."""


def expect(condition, *evidence):
    """Fail the case, with what was seen instead, unless the condition holds."""
    if not condition:
        raise AssertionError(" ".join(str(word) for word in evidence) or "not so")


def _explain(error, m):
    lines = traceback.format_exception_only(type(error), error)
    where = traceback.extract_tb(error.__traceback__)
    lines += ["%s:%d: %s" % (f.filename, f.lineno, f.line) for f in where if "panel-vm" in f.filename]
    if m and m.process.poll() is not None:
        lines += ["the machine ended; it last said:", m.said()]
    for line in "\n".join(lines).splitlines():
        print("# " + line)


def _skip_all(reason):
    for number, (sentence, _) in enumerate(CASES, 1):
        print("ok %d - %s # SKIP" % (number, sentence))
    print("# skipped: " + reason)
    return 0


def main(boot, prepare, arch="arm64"):
    """Run the cases, or those whose sentence holds a word of the command line; ends the program."""
    sys.stdout.reconfigure(line_buffering=True)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that the machine ends with its test
    words = sys.argv[1:]
    CASES[:] = [c for c in CASES if not words or any(word in c[0] for word in words)]
    print("1..%d" % len(CASES))
    reason = machine.setup(arch)
    sys.exit(_skip_all(reason) if reason else _run(boot, prepare))


def _start(boot, prepare):
    m = boot()
    try:
        prepare(m)
    except BaseException:
        m.close()
        raise
    return m


def _run(boot, prepare):
    failures, m = 0, None
    try:
        for number, (sentence, function) in enumerate(CASES, 1):
            start = time.monotonic()
            try:
                m = m or _start(boot, prepare)
                function(m)
                print("ok %d - %s" % (number, sentence))
            except Skip as reason:
                print("ok %d - %s # SKIP\n# skipped: %s" % (number, sentence, reason))
            except Exception as error:  # pylint: disable=broad-except
                failures += 1
                print("not ok %d - %s" % (number, sentence))
                _explain(error, m)
                if m and isinstance(error, (machine.MachineError, OSError)):
                    m.close()
                    m = None
            print("# %.1f s" % (time.monotonic() - start))
        if m:
            print("# %s s of the machine's time" % m.do("cut -d' ' -f1 /proc/uptime"))
    finally:
        if m:
            m.close()
    return 1 if failures else 0
