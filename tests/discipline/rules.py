"""The rules that keep the firmware portable, each as a function from a source tree to its violations.

A violation is one line of text, "place: what is wrong". The functions look at nothing outside the tree
they are given, so that rules_test.py can show each of them a planted one.
"""
import concurrent.futures
import os
import re
import subprocess
from pathlib import Path

LOW_LAYERS = ("fixed", "firmware")  # freestanding: no library, no float, no state of their own
LAYERS = ("fixed", "firmware", "drivers", "bsp")
SYSTEM_HEADERS = {"stdint.h", "stddef.h", "stdbool.h", "limits.h"}
VECTOR_HEADERS = {"arm64": "arm_neon.h"}  # of the folders of firmware/kernels that have one
MEMORY_FUNCTIONS = {"memcpy", "memmove", "memset", "memcmp"}
LONGEST_FUNCTION_LINES = 100
DEEPEST_STACK_BYTES = 8192


class Tree:
    """A source tree and the flags that each of its parts is compiled with.

    A part is a layer ("fixed", "drivers", "bsp"), a room of the firmware ("firmware/map"), or a library or program of
    host-sim/ ("host-sim/gis", "host-sim/programs/nav").
    """

    def __init__(self, root, flags, scratch):
        self.root = Path(root)
        self.flags = flags  # "CC", "GENERATED", "ROOMS", "LIBRARIES", "PROGRAMS", and each part's name -> list of words
        self.scratch = Path(scratch)
        self.built = {}  # kind -> what objects() found

    def files(self, layer, *suffixes):
        return sorted(p.relative_to(self.root) for p in (self.root / layer).rglob("*") if p.suffix in suffixes)

    def rooms(self):
        return self.flags["ROOMS"]

    def parts(self, *layers):
        """The parts of the layers, in the order in which one may see another."""
        rooms = [f"firmware/{room}" for room in self.rooms()]
        return [part for layer in layers for part in (rooms if layer == "firmware" else [layer])]

    def sees(self, part):
        """The parts whose public headers a part may include, by firmware/rooms.mk and the order of the layers."""
        layer, _, room = part.partition("/")
        below = self.parts(*LAYERS[: LAYERS.index(layer)])
        if layer in ("firmware", "drivers"):
            rooms = [f"firmware/{name}" for name in self.flags[f"SEES_{room or layer}"]]
            return [other for other in below if not other.startswith("firmware/")] + rooms
        return below

    def host_parts(self):
        """Libraries and programs of host-sim/, the highest first: a library sees none that stands before it."""
        return self.flags["PROGRAMS"] + self.flags["LIBRARIES"]

    def host_sees(self, part):
        """The parts whose public headers a library or program may include, by host-sim/host-sim.mk."""
        inside = {"fixed": ["fixed"], "drivers": ["drivers"], "bench": ["bsp"]}
        inside["firmware"] = inside["firmware.h"] = self.parts("firmware")
        return [other for name in self.flags[f"SEES_{part}"] for other in inside.get(name, [f"host-sim/{name}"])]

    def part_of(self, path):
        parts = Path(path).parts
        depth = {"firmware": 2, "host-sim": 3 if parts[1:2] == ("programs",) else 2}.get(parts[0], 1)
        return "/".join(parts[:depth])

    def sources(self, *layers):
        return [p for layer in layers for p in self.files(layer, ".c", ".h")]

    def text(self, path):
        return (self.root / path).read_text()

    def compile(self, part, source, output, *more, compiler=None):
        """Compile one file as the Makefile would, with `more` flags. Returns the compiler's complaints, or ""."""
        flags = self.flags[part]
        if compiler:  # for another machine: the build machine's own instruction set is not its
            flags = [flag for flag in flags if not flag.startswith(("-march=", "-mtune="))]
        command = (compiler or self.flags["CC"]) + flags + list(more)
        command += ["-c", str(source), "-o", str(output)]
        # A compiler cache would keep the object alone, and lose the graph of calls beside it.
        environment = {**os.environ, "CCACHE_DISABLE": "1"} if "-fcallgraph-info=su" in more else None
        result = subprocess.run(command, cwd=self.root, capture_output=True, text=True, env=environment)
        return "" if result.returncode == 0 else result.stderr or f"exit status {result.returncode}"

    def objects(self, kind, *more, compiler=None):
        """Compile the low layers, once for each `kind` of flags. Returns the objects and the complaints."""
        if kind not in self.built:
            self.built[kind] = self.build(self.scratch / kind, more, compiler)
        objects, complaints = self.built[kind]
        return objects, list(complaints)

    def build(self, folder, more, compiler):
        generated = Path(self.flags["GENERATED"][0])  # has made sources under the paths that they would have here
        jobs = []
        for layer in LOW_LAYERS:
            made = {path.relative_to(generated): path for path in self.files(generated / layer, ".c")}
            for path, source in [(path, path) for path in self.files(layer, ".c")] + sorted(made.items()):
                if architecture(path) not in (None, "c"):
                    continue  # compiled by the boards that have it
                target = folder / path.with_suffix(".o")
                target.parent.mkdir(parents=True, exist_ok=True)
                jobs.append((self.part_of(path), source, target))
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            complaints = list(pool.map(lambda job: self.compile(*job, *more, compiler=compiler), jobs))
        bad = [first_error(text) for text in complaints if text]
        return [job[2] for job in jobs], bad


def architecture(path):
    """Whose kernels a file belongs to, by its folder: c, arm64; None for what is no kernel."""
    parts = Path(path).parts
    return parts[2] if parts[:2] == ("firmware", "kernels") and len(parts) == 4 else None


def first_error(complaint):
    lines = complaint.strip().splitlines()
    return next((line for line in lines if "error:" in line), lines[0])


def read_flags(path):
    """The file that discipline.mk writes: a name and its words on each line."""
    lines = (line.split() for line in Path(path).read_text().splitlines())
    return {words[0]: words[1:] for words in lines}


def without_comments(text):
    """The text with comments, strings and characters blanked; lines keep their numbers."""
    pattern = r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\''
    return re.sub(pattern, lambda m: re.sub(r"[^\n]", " ", m.group()), text, flags=re.S)


def numbered_lines(text):
    return enumerate(text.splitlines(), 1)


def floating_point(tree):
    """No float: the compiler may use none, and the source may not name one. Told to keep to the general registers, gcc
    refuses a float and clang calls a library for it."""
    objects, bad = tree.objects("general-regs", "-mgeneral-regs-only")
    if not bad:
        bad = strangers(tree, objects, MEMORY_FUNCTIONS)
    for path in tree.sources(*LOW_LAYERS):
        for number, line in numbered_lines(without_comments(tree.text(path))):
            found = re.search(r"\b(float|double|_Float\w+|__fp16|_Complex)\b", line)
            if found:
                bad.append(f"{path}:{number}: names {found.group()}")
    return bad


def symbols(objects, *options):
    """(object, type, name) of each symbol that nm lists."""
    if not objects:
        return []
    out = subprocess.run(["nm", "-A", *options, *map(str, objects)], capture_output=True, text=True, check=True).stdout
    rows = (re.match(r"(.*?):\S*\s+(\S)\s+(\S+)$", line) for line in out.splitlines())
    return [row.groups() for row in rows if row]


def strangers(tree, objects, allowed):
    """Names that the objects need, that none of them has and that are not allowed."""
    have = {name for _, _, name in symbols(objects, "--defined-only")}
    needed = [(place, name) for place, _, name in symbols(objects, "-u") if name not in have and name not in allowed]
    return [f"{Path(place).relative_to(tree.scratch)}: needs {name}" for place, name in needed]


def is_clang(tree):
    return "clang" in tree.flags["CC"][0]


def plain_objects(tree):
    """The objects as they are, and beside them what gcc tells of calls. Without -fno-pie a constant table of pointers
    would look like data."""
    graph = [] if is_clang(tree) else ["-fcallgraph-info=su", "-ffunction-sections", "-fdata-sections"]
    return tree.objects("plain", "-fno-pie", *graph)


def foreign_symbols(tree):
    """Nothing from outside but the four functions that a compiler may call by itself."""
    objects, bad = plain_objects(tree)
    return bad or strangers(tree, objects, MEMORY_FUNCTIONS)


def cortex_m7(tree):
    """Both low layers build for a 32-bit microcontroller. A compiler's library is where a floating multiplication would
    show; firmware may have it divide 64 bits, which fixed does without. None when there is no clang to ask."""
    try:
        where = subprocess.run(["clang", "-print-file-name=include"], capture_output=True, text=True, check=True)
    except FileNotFoundError:
        return None
    compiler = ["clang", "--target=thumbv7em-none-eabi", "-mcpu=cortex-m7"]
    own_headers = ["-isystem", where.stdout.strip()]
    objects, bad = tree.objects("cortex-m7", *own_headers, "-mfloat-abi=soft", compiler=compiler)
    aeabi = {"__aeabi_" + name for name in ("memcpy", "memcpy4", "memcpy8", "memmove", "memmove4", "memmove8",
                                            "memset", "memset4", "memset8", "memclr", "memclr4", "memclr8")}
    divisions = {"__aeabi_ldivmod", "__aeabi_uldivmod"}
    fixed = [path for path in objects if path.relative_to(tree.scratch / "cortex-m7").parts[0] == "fixed"]
    return (bad or strangers(tree, fixed, MEMORY_FUNCTIONS | aeabi)
            or strangers(tree, objects, MEMORY_FUNCTIONS | aeabi | divisions))


class CallGraph:
    """What gcc's -fcallgraph-info=su tells about the objects of a tree, and what their tables of functions add.

    A call through a pointer reaches every function that the constant tables of its own file name, and the tables that
    these name in turn. In a file without such a table it is the board's or an argument's.
    """

    def __init__(self):
        self.stack_bytes = {}  # function -> its own frame
        self.calls = {}  # function -> set of functions
        self.dynamic = []  # functions whose frame is not constant
        self.indirect = {}  # object -> functions of it that call through a pointer
        self.unanswered = []  # those of them whose calls go to no table: to the board, or to an argument
        self.tables = {}  # (object, constant data) -> functions and data that it names

    def read(self, path):
        text = path.with_suffix(".ci").read_text()
        for name, label in re.findall(r'node: \{ title: "([^"]+)" label: "([^"]*)"', text):
            size = re.search(r"(\d+) bytes \(([a-z,]+)\)", label)
            if size:
                self.stack_bytes[name] = int(size.group(1))
                if size.group(2) == "dynamic":
                    self.dynamic.append(name)
        for source, target in re.findall(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"', text):
            if target == "__indirect_call":
                self.indirect.setdefault(path, set()).add(source)
            else:
                self.calls.setdefault(source, set()).add(target)
        unit = re.search(r'graph: \{ title: "([^"]+)"', text)
        self.read_tables(path, unit.group(1) if unit else "")

    def read_tables(self, path, source):
        """Each table has a section of its own, and so has each function, by which a static one is known."""
        out = subprocess.run(["readelf", "-rW", path], capture_output=True, text=True, check=True).stdout
        table = None
        for line in out.splitlines():
            section = re.match(r"Relocation section '\.rela(\S+)'", line)
            target = re.match(r"[0-9a-f]+ +[0-9a-f]+ +R_\S+ +[0-9a-f]+ +(\S+)", line)
            if section:
                name = data_name(section.group(1))
                table = self.tables.setdefault((path, name), set()) if name else None
            elif target and table is not None:
                static = re.match(r"\.text\.(?:unlikely\.)?(\S+)", target.group(1))
                table.add(f"{source}:{static.group(1)}" if static else data_name(target.group(1)) or target.group(1))

    def reached_by_tables(self, path):
        """All that the tables of an object name, and the tables that they name, of this object or of another."""
        seen, waiting = set(), [key for key in self.tables if key[0] == path]
        while waiting:
            owner, name = waiting.pop()
            for target in self.tables[owner, name] - seen:
                seen.add(target)
                own = (owner, target)
                waiting += [own] if own in self.tables else [key for key in self.tables if key[1] == target]
        return seen

    def resolve(self):
        """Add the calls through pointers that tables answer, and keep the callers whose calls none does."""
        for path, callers in self.indirect.items():
            functions = self.reached_by_tables(path) & self.stack_bytes.keys()
            self.unanswered += [] if functions else callers
            for caller in callers if functions else ():
                self.calls.setdefault(caller, set()).update(functions)

    def cycles(self):
        """Each function from which a call may come back to itself."""
        return sorted(name for name in self.calls if name in self.reachable(name))

    def reachable(self, start):
        seen, waiting = set(), list(self.calls.get(start, ()))
        while waiting:
            name = waiting.pop()
            if name not in seen:
                seen.add(name)
                waiting.extend(self.calls.get(name, ()))
        return seen

    def deepest(self):
        """(bytes, path) of the deepest chain of calls; only for a graph without cycles."""
        known = {}

        def below(name):
            if name not in known:
                deepest = max((below(callee) for callee in self.calls.get(name, ())), default=(0, []))
                known[name] = (deepest[0] + self.stack_bytes.get(name, 0), [name] + deepest[1])
            return known[name]

        return max((below(name) for name in self.stack_bytes), default=(0, []))


def data_name(section):
    """The constant that has this section to itself, or None."""
    found = re.match(r"\.(?:data\.rel\.ro(?:\.local)?|rodata)\.(?!str|cst)(\S+)$", section)
    return found and found.group(1)


def call_graph(tree):
    """The graph, and what the compiler complained of."""
    objects, bad = plain_objects(tree)
    graph = CallGraph()
    if not bad and not all(path.with_suffix(".ci").exists() for path in objects):
        bad = [f"{tree.flags['CC'][0]} left no .ci file beside its object: is it a compiler cache? Run without it"]
    if not bad:
        for path in objects:
            graph.read(path)
        graph.resolve()
    return graph, bad


def recursion_and_stack(tree):
    """No function calls itself in the end, each frame has a constant size, and the deepest chain fits. None when the
    compiler is clang, which does not tell."""
    if is_clang(tree):
        return None
    graph, bad = call_graph(tree)
    bad += [f"{name}: may call itself" for name in graph.cycles()]
    bad += [f"{name}: has a stack frame of variable size" for name in graph.dynamic]
    if not bad and graph.deepest()[0] > DEEPEST_STACK_BYTES:
        bad.append(f"{' > '.join(graph.deepest()[1])}: takes {graph.deepest()[0]} bytes of stack")
    return bad


def includes(tree, path):
    for number, line in numbered_lines(tree.text(path)):
        found = re.match(r'\s*#\s*include\s*([<"])([^>"]+)', line)
        if found:
            yield number, found.group(1), found.group(2)


def resolve(tree, path, name):
    """Where an #include "name" leads, from the root of the tree, or None."""
    flags = tree.flags[tree.part_of(path)]
    folders = [path.parent] + [Path(word[2:]) for word in flags if word.startswith("-I")]
    for folder in folders:
        target = os.path.normpath(tree.root / folder / name)
        if os.path.isfile(target):
            return Path(os.path.relpath(target, tree.root))
    return None


RECORDER = "record"  # the one folder of bsp that is no board: it stands between any board's ports and the unit


def includes_upwards(tree):
    """A layer includes itself and the layers below, a board's folder no other board's but the recorder's, and the two
    lowest layers four headers of the compiler; a kernel's folder that of its architecture. A driver may bring libraries
    of its own board."""
    bad = []
    for level, layer in enumerate(LAYERS):
        for path in tree.sources(layer):
            for number, bracket, name in includes(tree, path):
                place = f"{path}:{number}"
                if bracket == "<":
                    is_vectors = VECTOR_HEADERS.get(architecture(path)) == name
                    if layer in LOW_LAYERS and name not in SYSTEM_HEADERS and not is_vectors:
                        bad.append(f"{place}: includes <{name}>")
                    continue
                target = resolve(tree, path, name)
                if target is None and layer in LOW_LAYERS:
                    bad.append(f'{place}: includes "{name}", which is in no layer below')
                elif target is not None and target.parts[0] not in LAYERS[: level + 1]:
                    bad.append(f"{place}: includes {target}")
                elif target is not None and target.parts[0] == "bsp" and target.parts[1] != RECORDER and \
                        target.parts[:2] != path.parts[:2]:
                    bad.append(f"{place}: includes another board's {target}")
    return bad


def probe(tree, part, text):
    """What the compiler says of a file of this part."""
    source = tree.scratch / "probe" / (part.replace("/", "_") + ".c")
    source.parent.mkdir(parents=True, exist_ok=True)
    source.write_text(f"{text}\nextern int probe;\n")
    return tree.compile(part, source, source.with_suffix(".o"))


def public_headers(tree, part):
    """As they are written in an #include."""
    folder = Path(part) / "include"
    return [f'"{path.relative_to(folder)}"' for path in tree.files(part, ".h") if folder in path.parents]


def private_headers(tree, part):
    folder = Path(part) / "include"
    return [f'"{path.name}"' for path in tree.files(part, ".h") if folder not in path.parents]


def rooms_in_order(tree):
    """The arrows between the rooms have no circle: each room sees only rooms that come before it in the list."""
    bad = []
    for number, room in enumerate(tree.rooms()):
        above = [f"firmware/{other}" for other in tree.rooms()[number + 1:]]
        bad += [f"firmware/{room}: sees {other}, which is above it"
                for other in tree.sees(f"firmware/{room}") if other in above]
    folders = {path.parts[1] for path in tree.sources("firmware")}
    return bad + [f"firmware/{name}: is no room of firmware/rooms.mk" for name in sorted(folders - set(tree.rooms()))]


def found_headers(tree, part, headers):
    """Those of the headers that a file of this part could include, as "could include HEADER"."""
    conditions = "\n".join(f"#if __has_include({header})\n#error could include {header}\n#endif" for header in headers)
    return re.findall(r"error: (?:#error )?(could include .*)", probe(tree, part, conditions))


def open_doors(tree):
    """The flags of the Makefile hide from each part what it may not include, and its own headers stand alone."""
    bad = []
    for part in tree.parts(*LAYERS):
        seen = [part, *tree.sees(part)]
        hidden = ['"hs/error.h"', '"support.h"']
        if part.split("/")[0] in LOW_LAYERS:
            hidden += ["<stdio.h>", "<stdlib.h>", "<string.h>", "<math.h>", "<unistd.h>"]
        for other in tree.parts(*LAYERS[:-1]):
            hidden += public_headers(tree, other) if other not in seen else []
            hidden += private_headers(tree, other) if other not in (part, "drivers") else []
        bad += [f"{part}: {found}" for found in found_headers(tree, part, hidden)]
        bad += [f"{part}: {header} does not compile by itself" for header in public_headers(tree, part)
                if probe(tree, part, f"#include {header}")]
    return bad


def host_includes(tree):
    """A library or program of host-sim/ includes its own headers and public ones of the parts that it sees."""
    bad = []
    for part in tree.host_parts():
        folders = [Path(part)] + [Path(other) if other == "bsp" else Path(other) / "include"
                                  for other in tree.host_sees(part)]
        for path in tree.files(part, ".c", ".h"):
            for number, bracket, name in includes(tree, path):
                target = resolve(tree, path, name) if bracket == '"' else None
                if target and not any(folder in target.parents for folder in folders):
                    bad.append(f"{path}:{number}: includes {target}")
    folders = {tree.part_of(path) for path in tree.sources("host-sim")}
    return bad + [f"{folder}: is not in host-sim/host-sim.mk" for folder in sorted(folders - set(tree.host_parts()))]


def host_doors(tree):
    """The flags of host-sim.mk hide from each library and program what it may not include; public headers stand alone."""
    bad = []
    for part in tree.host_parts():
        seen = [part, *tree.host_sees(part)]
        hidden = ['"support.h"']
        for other in tree.host_parts() + tree.parts(*LAYERS[:-1]):
            hidden += public_headers(tree, other) if other not in seen else []
            hidden += private_headers(tree, other) if other not in (part, "drivers") else []
        bad += [f"{part}: {found}" for found in found_headers(tree, part, hidden)]
        bad += [f"{part}: {header} does not compile by itself" for header in public_headers(tree, part)
                if probe(tree, part, f"#include {header}")]
    return bad


def conditionals(tree):
    """One firmware for all boards: #if only in lm/config.h, for include guards, and to refuse a machine (#error)."""
    bad = []
    for path in tree.sources(*LOW_LAYERS):
        if path == Path("firmware/base/include/lm/config.h"):
            continue
        lines = tree.text(path).splitlines()
        for number, line in enumerate(lines, 1):
            found = re.match(r"\s*#\s*(?:if|ifdef|elif|ifndef)\b\s*(.*)", line)
            following = lines[number] if number < len(lines) else ""
            is_harmless = found and (following == f"#define {found.group(1)}" or following.startswith("#error "))
            if found and not is_harmless:
                bad.append(f"{path}:{number}: {line.strip()}")
    return bad


def long_functions(tree):
    """A body runs from a brace in the first column to the next; clang-format sees to that."""
    bad = []
    for path in tree.sources(*LOW_LAYERS):
        start = None
        for number, line in numbered_lines(tree.text(path)):
            if line == "{":
                start = number
            elif line == "}" and start is not None:
                if number - start + 1 > LONGEST_FUNCTION_LINES:
                    bad.append(f"{path}:{start}: a function of {number - start + 1} lines")
                start = None
    return bad


def mutable_data(tree):
    """Nothing that a second radar in the same program would share."""
    objects, bad = plain_objects(tree)
    return bad or [f"{Path(place).relative_to(tree.scratch)}: {name} can be written to"
                   for place, kind, name in symbols(objects, "--defined-only") if kind in "bBdDcCsSgG"]
