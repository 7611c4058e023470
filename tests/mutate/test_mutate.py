"""Changes, draws and verdicts of mutate.py on sources of a few lines and programs that misbehave. Prints TAP."""
import os
import subprocess
import sys
import tempfile
import traceback
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import changes
import mutate
import programs
import reach

SOURCE = """/* a < b + 1 */
#define TWO 2
static const char *const words = "x + 1 && y";
int f(int a, struct two *p)
{
    int b = a < 3 ? p->x : -4;
    if (a && *p->y) {
        b += a << 1; // b - 1
    }
    for (int i = 0; i < a; i++)
        g(b);
    return a & b;
}
"""


def made(kind):
    """The lines that changes of a kind make of SOURCE."""
    lines = []
    for change in changes.changes(SOURCE):
        if change.kind == kind:
            _, old, new = changes.lines_of(SOURCE, change)
            assert old != new
            lines.append(new.strip())
    return lines


def each_kind_changes_what_it_says():
    assert made("relational") == ["int b = a <= 3 ? p->x : -4;", "int b = a >= 3 ? p->x : -4;",
                                  "for (int i = 0; i <= a; i++)", "for (int i = 0; i >= a; i++)"]
    assert made("plus-minus") == ["b -= a << 1; // b - 1", "for (int i = 0; i < a; i--)"]
    assert made("and-or") == ["if (a || *p->y) {"]
    assert made("shift") == ["b += a >> 1; // b - 1"]
    assert made("bits") == ["return a | b;"]
    assert made("ternary") == ["int b = a < 3 ? -4 : p->x;"]
    assert made("condition") == ["if (0 && (a && *p->y)) {", "if (1 || (a && *p->y)) {"]
    assert made("drop") == ["; // b - 1", ";"]
    assert sorted(made("constant")) == sorted([
        "int b = a < 2 ? p->x : -4;", "int b = a < 4 ? p->x : -4;", "int b = a < 3 ? p->x : -3;",
        "int b = a < 3 ? p->x : -5;", "b += a << 0; // b - 1", "b += a << 2; // b - 1", "for (int i = 1; i < a; i++)"])


def comments_strings_and_directives_stay():
    for change in changes.changes(SOURCE):
        assert SOURCE.splitlines()[:3] == change.apply(SOURCE).splitlines()[:3], change


def numbers_keep_their_form():
    assert {c.new for c in changes.changes("int a = 0xffu;")} == {"0x100u", "0xfeu"}


def a_chain_of_choices_is_swapped_link_by_link():
    text = "int f(void) { return a ? b : c ? d : e; }"
    assert {c.apply(text) for c in changes.changes(text) if c.kind == "ternary"} == {
        "int f(void) { return a ? c ? d : e : b; }", "int f(void) { return a ? b : c ? e : d; }"}


def in_folder(test):
    def run():
        with tempfile.TemporaryDirectory() as folder:
            test(Path(folder))
    run.__name__ = test.__name__
    return run


@in_folder
def a_seed_draws_the_same_and_each_change_once(folder):
    paths = []
    for name in ("one.c", "two.c"):
        (folder / name).write_text(SOURCE)
        paths.append(str(folder / name))
    draws = [[(m.source, m.text) for m in mutate.drawn(paths, [], seed)] for seed in ("1", "1", "2")]
    assert draws[0] == draws[1] and draws[0] != draws[2]
    assert len(set(draws[0])) == len(draws[0]) == 2 * len(changes.changes(SOURCE))
    assert {source for source, _ in draws[0][:2]} == set(paths)


@in_folder
def a_survivor_can_be_planted_again(folder):
    source = folder / "one.c"
    source.write_text(SOURCE)
    change = next(c for c in changes.changes(SOURCE) if c.kind == "shift")
    mutant = mutate.Mutant(str(source), change.apply(SOURCE), *changes.lines_of(SOURCE, change), "shift")
    mutate.write_survivors([mutate.Result(mutant, "survived", "", 3)], folder / "survivors.txt")
    again, = mutate.planted(folder / "survivors.txt")
    assert again.text.split() == mutant.text.split() and again.line == mutant.line


@in_folder
def what_is_planted_must_stand_in_its_file(folder):
    (folder / "one.c").write_text(SOURCE)
    (folder / "planted.txt").write_text(f"{folder}/one.c\n- int c;\n+ int d;\n")
    try:
        list(mutate.planted(folder / "planted.txt"))
    except SystemExit as stop:
        assert "stands there 0 times" in str(stop)
    else:
        raise AssertionError("planted where it does not stand")


def judged_survivors_have_a_verdict_a_reason_and_a_line_that_is_there():
    for (source, old, _), verdict in mutate.read_judged().items():
        assert verdict in mutate.VERDICTS and old in mutate.flat(Path(source).read_text()), (source, old)
    list(mutate.planted(Path("tests/mutate/known.txt")))


@in_folder
def a_program_that_fails_hangs_or_eats_is_caught(folder):
    def verdict(script, seconds=5):
        program = folder / "program"
        program.write_text(f"#!{sys.executable}\n{script}\n")
        program.chmod(0o755)
        return programs.run(program, folder, seconds)[0]

    assert verdict("print('ok 1 - fine')") == ""
    assert verdict("print('not ok 1 - skipped # SKIP')") == ""
    assert verdict("print('not ok 1 - wrong', flush=True)\nwhile True: pass") == "not ok 1 - wrong"
    assert verdict("import sys; sys.exit(3)") == "ended with status 3"
    assert verdict("while True: pass", 1) == "time"
    assert verdict("print('ok'); x = bytearray(3 << 30)") == "ended with status 1"


COUNTED = """int table[2] = {1, 2};
int half(int a)
{
    return a / 2;
}
int twice(int a)
{
    switch (a) {
    case 7:
        return 0;
    default:
        return a * 2;
    }
}
"""
MAIN = "#include <stdio.h>\nint half(int a); int main(void) { puts(\"ok 1 - runs\"); return half(0); }\n"


def built(folder):
    """A source of the firmware, in a tree of its own, with a program that runs a part of it."""
    for place in ("firmware/room", "build/bin/tests", "build/firmware/room"):
        (folder / place).mkdir(parents=True)
    (folder / "firmware/room/half.c").write_text(COUNTED)
    (folder / "test.c").write_text(MAIN)
    commands = ("gcc -c firmware/room/half.c -o build/firmware/room/half.o\n"
                "gcc -c test.c -o build/test.o\n"
                "ar rcs build/lib.a build/firmware/room/half.o\n"
                "gcc build/test.o -Wl,--start-group build/lib.a -Wl,--end-group -lm -lm -o build/bin/tests/test\n")
    for command in commands.splitlines():
        subprocess.run(command.split(), check=True)
    (folder / "build/mutate").mkdir(exist_ok=True)
    return programs.Build("build", "build/mutate", commands)


def in_tree(test):
    """In the folder of a tree, as the scripts are run in that of the project."""
    def run():
        before = Path.cwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                test(Path(folder))
            finally:
                os.chdir(before)
    run.__name__ = test.__name__
    return run


def asked(build, line):
    """Whether the program may run a line."""
    place = programs.make_place("build", Path("build/mutate/worker-0"))
    return reach.Reach(build, build.scratch).may_run("build/bin/tests/test", "firmware/room/half.c", [line], place)


@in_tree
def a_test_is_spared_the_lines_that_it_does_not_run(folder):
    build = built(folder)
    assert asked(build, 4), "a line that it runs"
    assert not asked(build, 12), "a line of a function that is not called"
    assert asked(build, 1), "a table has no code: nothing is known"


@in_tree
def a_test_is_counted_again_when_it_or_the_source_has_changed(folder):
    build = built(folder)
    assert not asked(build, 12)
    (folder / "test.c").write_text(MAIN.replace("half", "twice"))
    for command in (build.compiles["test.c"]["build/test.o"], build.links["build/bin/tests/test"]):
        subprocess.run(command, check=True)
    assert asked(build, 12) and not asked(build, 4)
    (folder / "firmware/room/half.c").write_text("\n" + COUNTED)
    assert asked(build, 13) and not asked(build, 5)


@in_tree
def without_clang_every_test_may_run_a_line(folder):
    build, clang = built(folder), reach.CLANG
    reach.CLANG = "no-such-compiler"
    try:
        assert asked(build, 12)
    finally:
        reach.CLANG = clang


@in_tree
def a_label_is_run_where_its_switch_is(folder):
    built(folder)

    def lines(number, old):
        return list(mutate.lines_run(mutate.Mutant("firmware/room/half.c", "", number, old, "", "constant")))
    assert lines(9, "    case 7:") == [8]
    assert lines(10, "        return 0;") == [10]
    assert lines(2, "int half(int a)\n{") == [2, 3]


def main():
    tests = [each_kind_changes_what_it_says, comments_strings_and_directives_stay, numbers_keep_their_form,
             a_chain_of_choices_is_swapped_link_by_link, a_seed_draws_the_same_and_each_change_once,
             a_survivor_can_be_planted_again, what_is_planted_must_stand_in_its_file,
             judged_survivors_have_a_verdict_a_reason_and_a_line_that_is_there,
             a_program_that_fails_hangs_or_eats_is_caught, a_test_is_spared_the_lines_that_it_does_not_run,
             a_test_is_counted_again_when_it_or_the_source_has_changed, without_clang_every_test_may_run_a_line,
             a_label_is_run_where_its_switch_is]
    print(f"1..{len(tests)}")
    failed = 0
    for number, test in enumerate(tests, 1):
        try:
            test()
            print(f"ok {number} - {test.__name__}")
        except (AssertionError, SystemExit):
            failed += 1
            print(f"not ok {number} - {test.__name__}")
            print("".join(f"# {line}\n" for line in traceback.format_exc().splitlines()), end="")
    return failed


if __name__ == "__main__":
    sys.exit(main())
