"""`make rooms`: which room of the firmware may see which, and which of these arrows the sources use.

    rooms.py FLAGS      (the file that discipline.mk writes)
"""
import sys

import rules


def actual(tree, part):
    """The parts that the files of a part include headers of, with the number of such includes."""
    count = {}
    for path in tree.files(part, ".c", ".h"):
        for _, bracket, name in rules.includes(tree, path):
            target = rules.resolve(tree, path, name) if bracket == '"' else None
            other = tree.part_of(target) if target else part
            if other != part:
                count[other] = count.get(other, 0) + 1
    return count


def short(part):
    return part.removeprefix("firmware/")


def main():
    tree = rules.Tree(".", rules.read_flags(sys.argv[1]), "")
    parts = tree.parts("fixed", "firmware", "drivers")
    arrows = strange = 0
    print(f"{'room':10} {'files':>5} {'lines':>6}  may see, and how many includes use it")
    for part in reversed(parts):
        used = actual(tree, part)
        files = tree.files(part, ".c", ".h")
        lines = sum(tree.text(path).count("\n") for path in files)
        allowed = [f"{short(other)} {used.pop(other, 0)}" for other in reversed(parts) if other in tree.sees(part)]
        arrows += sum(not word.endswith(" 0") for word in allowed)
        print(f"{short(part):10} {len(files):5} {lines:6}  {', '.join(allowed)}")
        strange += len(used)
        for other in used:
            print(f"{'':24} NOT ALLOWED: {short(other)} {used[other]}")
    print(f"{len(parts)} rooms, {arrows} arrows in use, {strange} not allowed")
    return 1 if strange else 0


if __name__ == "__main__":
    sys.exit(main())
