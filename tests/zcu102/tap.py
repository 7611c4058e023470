"""Results as tests/run.sh counts them."""
import sys


class Tap:
    def __init__(self):
        self.number = 0
        self.failed = 0

    def ok(self, statement, is_true, *notes):
        """One result; the notes say what was found when it is not true."""
        self.number += 1
        self.failed += not is_true
        print(f"{'ok' if is_true else 'not ok'} {self.number} - {statement}")
        if not is_true:
            for note in notes:
                print(f"#   {note}")
        sys.stdout.flush()

    def note(self, text):
        print(f"# {text}")

    def skip(self, statement, why):
        self.number += 1
        print(f"ok {self.number} - {statement} # SKIP")
        print(f"# skipped: {why}")

    def end(self):
        print(f"1..{self.number}")
        return 1 if self.failed else 0
