"""Tests that are functions, one after the other, with results as tests/run.sh counts them."""
import sys
import time
import traceback


class Skip(Exception):
    """What a test needs is not at hand; the words say what."""


def _where(error):
    """Line of the test's own file at which it failed."""
    frames = traceback.extract_tb(error.__traceback__)
    return next((f"{frame.filename.rsplit('/', 1)[-1]}:{frame.lineno}" for frame in frames[1:]), "")


def _passes(test, number, name, before, given):
    begun = time.monotonic()
    try:
        before(*given)
        test(*given)
    except Skip as why:
        print(f"ok {number} # SKIP {name}\n# skipped: {why}", flush=True)
        return True
    except Exception as error:  # pylint: disable=broad-except
        print(f"not ok {number} - {name}\n# {type(error).__name__}: {error!s:.500} at {_where(error)}", flush=True)
        return False
    print(f"ok {number} - {name}\n# {time.monotonic() - begun:.1f} s", flush=True)
    return True


def run(tests, *given, before=lambda *_: None):
    """Run functions, or those that the command line names, with what is given; `before` comes before each of them.
    Returns the program's exit code."""
    names = [test.__name__.removeprefix("test_") for test in tests]
    chosen = [(name, test) for name, test in zip(names, tests) if len(sys.argv) < 2 or name in sys.argv[1:]]
    print(f"1..{len(chosen)}", flush=True)
    passed = [_passes(test, number, name, before, given) for number, (name, test) in enumerate(chosen, 1)]
    return 0 if all(passed) else 1


def skip_all(what, lacks):
    """What `what` proves cannot be tried here. Returns the program's exit code."""
    print(f"ok 1 # SKIP {what}\n# skipped: {lacks}\n1..1")
    return 0
