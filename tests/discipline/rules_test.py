"""Runs the rules of rules.py on the tree, and each of them on a small tree in which it is broken. Prints TAP."""
import os
import re
import sys
import tempfile
from pathlib import Path

import rules

GOOD = {
    "fixed/include/fx/one.h": "#ifndef FX_ONE_H\n#define FX_ONE_H\n#include <stdint.h>\n"
                            "int32_t fx_one(int32_t x);\n#endif\n",
    "fixed/src/one.c": '#include "fx/one.h"\n\nint32_t fx_one(int32_t x)\n{\n    return x + 1;\n}\n',
    "firmware/base/include/lm/two.h": "#ifndef LM_TWO_H\n#define LM_TWO_H\nint lm_two(int x);\n#endif\n",
    "firmware/base/two.c": '#include "lm/two.h"\n#include "fx/one.h"\n\n'
                          "static const char *const names[] = {\"float\", \"double\"};\n\n"
                          "int lm_two(int x)\n{\n    return fx_one(x) + names[x & 1][0];\n}\n",
    "firmware/kernels/arm64/eight.c": "#include <arm_neon.h>\n",
    "firmware/unit/include/lm/six.h": "extern int six;\n",
    "firmware/clutter/seven.h": "extern int seven;\n",
    "drivers/include/drv/three.h": "extern int three;\n",
    "drivers/three.c": '#include "drv/three.h"\n#include "lm/two.h"\n#include <stdio.h>\nint three;\n',
    "bsp/here/four.c": '#include "drv/three.h"\n#include "four.h"\n',
    "bsp/here/four.h": "extern int four;\n",
    "bsp/other/five.h": "extern int five;\n",
    "host-sim/lib/include/hs/six.h": "extern int six;\n",
    "host-sim/lib/six.c": '#include "hs/six.h"\n#include "fx/one.h"\n',
    "host-sim/tracer/include/tracer/seven.h": "extern int seven;\n",
    "host-sim/tracer/seven.c": '#include "tracer/seven.h"\n#include "eight.h"\n#include "hs/six.h"\n',
    "host-sim/tracer/eight.h": "extern int eight;\n",
}

FUNCTION = "int lm_bad(int x);\nint lm_bad(int x)\n{\n%s\n}\n"

# What is planted: the sentence proved, the rule that must see it, what its violation must say, the file and its text
# (None: the flags are loosened instead).
PLANTED = [
    ("a product of doubles is seen", rules.floating_point, "SSE|general-regs|needs __",
     "firmware/map/bad.c", FUNCTION % "    return (int)(x * 0.5);"),
    ("a float hidden in a header is seen", rules.floating_point, "bad.h:1: names float",
     "fixed/include/fx/bad.h", "typedef float fx_bad;\n"),
    ("a call of malloc is seen", rules.foreign_symbols, "needs malloc", "firmware/map/bad.c",
     "void *malloc(unsigned long);\n" + FUNCTION % "    return malloc((unsigned long)x) == 0;"),
    ("a division of 64 bits in fixed is seen on the microcontroller", rules.cortex_m7, "needs __aeabi_uldivmod",
     "fixed/src/bad.c",
     "unsigned long long fx_bad(unsigned long long a, unsigned long long b);\n"
     "unsigned long long fx_bad(unsigned long long a, unsigned long long b)\n{\n    return a / b;\n}\n"),
    ("recursion through two functions is seen", rules.recursion_and_stack, "lm_[ab]: may call itself",
     "firmware/map/bad.c",
     "int lm_a(int x);\nint lm_b(int x);\nint lm_b(int x)\n{\n    return lm_a(x) * 3;\n}\n"
     "int lm_a(int x)\n{\n    return x < 2 ? x : lm_b(x - 1) + lm_b(x - 2);\n}\n"),
    ("a frame of variable size is seen", rules.recursion_and_stack, "variable size", "firmware/map/bad.c",
     FUNCTION % "    volatile char *p = __builtin_alloca((unsigned long)x);\n    p[0] = 1;\n    return p[x - 1];"),
    ("a stack deeper than the limit is seen", rules.recursion_and_stack, "bytes of stack", "firmware/map/bad.c",
     FUNCTION % "    volatile char big[9000];\n    big[x] = 1;\n    return big[x + 1];"),
    ("recursion through a table of functions is seen", rules.recursion_and_stack, "(lm_a|half): may call itself",
     "firmware/map/bad.c",
     "int lm_a(int x);\nstatic int half(int x)\n{\n    return lm_a(x / 2);\n}\nstatic int same(int x)\n{\n    return x;\n}\n"
     "static int (*const table[2])(int) = {half, same};\nint lm_a(int x)\n{\n    return table[x & 1](x);\n}\n"),
    ("a deep stack behind a table of tables is seen", rules.recursion_and_stack, "bytes of stack",
     "firmware/map/bad.c",
     "struct row {\n    int (*f)(int);\n};\nextern const struct row lm_row;\nint lm_a(int n, int x);\n"
     "static int big(int x)\n{\n    volatile char b[9000];\n    b[x] = 1;\n    return b[x + 1];\n}\n"
     "const struct row lm_row = {big};\nstatic const struct row *const rows[2] = {&lm_row, 0};\n"
     "int lm_a(int n, int x)\n{\n    return rows[n]->f(x);\n}\n"),
    ("fixed including firmware by a path is seen", rules.includes_upwards, "bad.c:1: includes firmware/",
     "fixed/src/bad.c", '#include "../../firmware/base/include/lm/two.h"\n'),
    ("firmware including a driver by a path is seen", rules.includes_upwards, "bad.c:1: includes drivers/",
     "firmware/map/bad.c", '#include "../../drivers/include/drv/three.h"\n'),
    ("firmware including the C library is seen", rules.includes_upwards, "includes <string.h>",
     "firmware/map/bad.c", "#include <string.h>\n"),
    ("a stage including the vectors of Arm is seen", rules.includes_upwards, "bad.c:1: includes <arm_neon.h>",
     "firmware/map/bad.c", "#include <arm_neon.h>\n"),
    ("a kernel in plain C including the vectors of Arm is seen", rules.includes_upwards, "bad.c:1: includes <arm_neon.h>",
     "firmware/kernels/c/bad.c", "#include <arm_neon.h>\n"),
    ("a driver including its board is seen", rules.includes_upwards, "includes bsp/here/four.h",
     "drivers/bad.c", '#include "../bsp/here/four.h"\n'),
    ("a board including another board is seen", rules.includes_upwards, "another board's bsp/other/five.h",
     "bsp/here/bad.c", '#include "../other/five.h"\n'),
    ("the recorder including a board is seen", rules.includes_upwards, "another board's bsp/other/five.h",
     "bsp/record/bad.c", '#include "../other/five.h"\n'),
    ("an include path too many in the Makefile is seen", rules.open_doors,
     'fixed: could include "lm/two.h"', None, None),
    ("a header that needs another one first is seen", rules.open_doors, '"lm/bad.h" does not compile by itself',
     "firmware/map/include/lm/bad.h", "uint32_t lm_bad(void);\n"),
    ("a library including one above it by a path is seen", rules.host_includes, "bad.c:1: includes host-sim/tracer/",
     "host-sim/lib/bad.c", '#include "../tracer/include/tracer/seven.h"\n'),
    ("a program including a library's private header is seen", rules.host_includes, "includes host-sim/tracer/eight.h",
     "host-sim/programs/target/bad.c", '#include "../../tracer/eight.h"\n'),
    ("a library's header that needs another one first is seen", rules.host_doors,
     '"hs/bad.h" does not compile by itself', "host-sim/lib/include/hs/bad.h", "uint32_t hs_bad(void);\n"),
    ("an #ifdef for the host is seen", rules.conditionals, "bad.c:1: #ifdef HOST",
     "firmware/map/bad.c", "#ifdef HOST\n#endif\n"),
    ("an #if in a kernel for Arm is seen", rules.conditionals, "bad_neon.h:2: #ifdef __aarch64__",
     "firmware/kernels/arm64/bad_neon.h", "#include <arm_neon.h>\n#ifdef __aarch64__\n#endif\n"),
    ("a function of 101 lines is seen", rules.long_functions, "a function of 101 lines", "firmware/map/bad.c",
     FUNCTION % "\n".join(["    x++;"] * 98 + ["    return x;"])),
    ("a static counter is seen", rules.mutable_data, r"calls\S* can be written to", "firmware/map/bad.c",
     FUNCTION % "    static int calls;\n    return calls += x;"),
    ("a global with a value is seen", rules.mutable_data, "fx_bad can be written to",
     "fixed/src/bad.c", "extern int fx_bad;\nint fx_bad = 3;\n"),
]

KEPT = [
    ("fixed and firmware compile without floating point and name none", rules.floating_point),
    ("fixed and firmware need nothing but memcpy, memmove, memset and memcmp", rules.foreign_symbols),
    ("fixed and firmware build for a Cortex-M7, and need of a compiler's library but division", rules.cortex_m7),
    ("no function calls itself and the deepest stack is known and fits", rules.recursion_and_stack),
    ("every layer includes only itself and the layers below", rules.includes_upwards),
    ("a room of the firmware sees only rooms below it", rules.rooms_in_order),
    ("the flags hide what a layer may not include, and its headers stand alone", rules.open_doors),
    ("libraries and programs include what host-sim.mk lets them see", rules.host_includes),
    ("the flags hide from libraries and programs all other headers, and theirs stand alone", rules.host_doors),
    ("there are no conditionals in fixed and firmware but in lm/config.h", rules.conditionals),
    ("no function in fixed and firmware is longer than 100 lines", rules.long_functions),
    ("fixed and firmware have no data that can be written to", rules.mutable_data),
]


class Report:
    def __init__(self, count):
        self.number = 0
        self.failed = 0
        print(f"1..{count}")

    def result(self, sentence, complaints, skipped=None):
        self.number += 1
        self.failed += bool(complaints)
        verdict = "not ok" if complaints else "ok"
        print(f"{verdict} {self.number} - {sentence}" + (f" # SKIP {skipped}" if skipped else ""))
        for complaint in complaints:
            print(f"# {complaint}")
        sys.stdout.flush()


def planted_tree(folder, flags, path, text):
    """The small tree with one file more, or with one folder more to be seen by the lowest layer."""
    root = Path(folder) / "tree"
    for name, content in {**GOOD, **({path: text} if path else {})}.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(content)
    flags = dict(flags)
    if path is None:
        flags["fixed"] = flags["fixed"] + ["-Ifirmware/base/include"]
    return rules.Tree(root, flags, Path(folder) / "scratch")


def judge(report, sentence, violations, wanted=None):
    """`wanted` is a pattern that one of the violations must match; without it there may be none."""
    if violations is None:
        report.result(sentence, [], skipped="the compiler that could tell is not in use here")
    elif wanted is None:
        report.result(sentence, violations)
    elif any(re.search(wanted, violation) for violation in violations):
        report.result(sentence, [])
    else:
        report.result(sentence, [f"none of these is {wanted}:"] + violations)


def plant_includes(report, flags):
    """In each room, one include of a header that it may not see: of the room above it, or a private one."""
    with tempfile.TemporaryDirectory() as folder:
        tree = rules.Tree(".", flags, folder)
        rooms = tree.rooms()
        for room, above in zip(rooms, rooms[1:] + rooms[:1]):
            stranger = (rules.public_headers(tree, f"firmware/{above}") if room != rooms[-1]
                        else rules.private_headers(tree, "firmware/display"))[0]
            answer = rules.probe(tree, f"firmware/{room}", f"#include {stranger}")
            is_refused = "No such file or directory" in answer or "file not found" in answer
            report.result(f"{stranger} planted in firmware/{room} is no such file or directory",
                          [] if is_refused else [answer or "it compiles"])


def plant_host_includes(report, flags):
    """In each library and program, one include of a public header that it may not see, or of a private one."""
    with tempfile.TemporaryDirectory() as folder:
        tree = rules.Tree(".", flags, folder)
        for part in tree.host_parts():
            strangers = [other for other in flags["LIBRARIES"] if other != part and other not in tree.host_sees(part)]
            stranger = rules.public_headers(tree, strangers[-1])[0]
            answer = rules.probe(tree, part, f"#include {stranger}")
            is_refused = "No such file or directory" in answer or "file not found" in answer
            report.result(f"{stranger} planted in {part} is no such file or directory",
                          [] if is_refused else [answer or "it compiles"])


def print_stack(graph):
    """The figures for the record; what is called through a pointer comes on top of them."""
    size, path = graph.deepest()
    print(f"# deepest stack: {size} bytes, {' > '.join(path)}")
    print(f"# call through a pointer that no table answers: {', '.join(sorted(graph.unanswered)) or 'none'}")


def main():
    build = os.environ.get("BUILD", "build/bench-linux")
    flags = rules.read_flags(f"{build}/tests/discipline/flags")
    report = Report(len(KEPT) + len(PLANTED) + len(flags["ROOMS"])
                    + len(flags["LIBRARIES"]) + len(flags["PROGRAMS"]) + 1)
    with tempfile.TemporaryDirectory() as folder:
        tree = rules.Tree(".", flags, folder)
        for sentence, rule in KEPT:
            judge(report, sentence, rule(tree))
        if rules.recursion_and_stack(tree) == []:
            print_stack(rules.call_graph(tree)[0])
    for sentence, rule, wanted, path, text in PLANTED:
        with tempfile.TemporaryDirectory() as folder:
            judge(report, sentence, rule(planted_tree(folder, flags, path, text)), wanted)
    plant_includes(report, flags)
    plant_host_includes(report, flags)
    with tempfile.TemporaryDirectory() as folder:
        harmless = "/* No float, no #ifdef. */\n#include <stdint.h>\n"
        tree = planted_tree(folder, flags, "firmware/map/harmless.c", harmless)
        found = [text for _, rule in KEPT for text in rule(tree) or []]
        report.result("a tree that keeps the rules is left in peace", found)
    return 1 if report.failed else 0


if __name__ == "__main__":
    sys.exit(main())
