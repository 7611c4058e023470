"""`make rooms`: which room, library or program may see which, and which of these arrows the sources use.

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


def print_parts(tree, title, parts, sees, name):
    """One line a part. Returns the number of parts, of arrows in use, and of arrows that are not allowed."""
    arrows = strange = 0
    print(f"{title:20} {'files':>5} {'lines':>6}  may see, and how many includes use it")
    for part in parts:
        used = {}
        for other, count in actual(tree, part).items():
            used[name(other)] = used.get(name(other), 0) + count
        files = tree.files(part, ".c", ".h")
        lines = sum(tree.text(path).count("\n") for path in files)
        allowed = [f"{other} {used.pop(other, 0)}" for other in dict.fromkeys(map(name, sees(part)))]
        arrows += sum(not word.endswith(" 0") for word in allowed)
        print(f"{name(part):20} {len(files):5} {lines:6}  {', '.join(allowed)}")
        strange += len(used)
        for other in used:
            print(f"{'':34} NOT ALLOWED: {other} {used[other]}")
    print(f"total {len(parts):14}: {arrows} arrows in use, {strange} not allowed\n")
    return strange


def main():
    tree = rules.Tree(".", rules.read_flags(sys.argv[1]), "")
    parts = tree.parts("fixed", "firmware", "drivers")[::-1]
    strange = print_parts(tree, "room", parts, lambda part: [p for p in parts if p in tree.sees(part)],
                          lambda part: part.removeprefix("firmware/"))
    for title, parts in (("program", tree.flags["PROGRAMS"]), ("library", tree.flags["LIBRARIES"])):
        strange += print_parts(tree, title, parts, tree.host_sees,
                               lambda part: part.split("/")[0] if part.startswith("firmware")
                               else part.removeprefix("host-sim/"))
    return 1 if strange else 0


if __name__ == "__main__":
    sys.exit(main())
