"""The memory map of the board's image, and its deepest stack from the compiler's call graph.

The graph has one hole, calls through a pointer. Here is what stands behind each kind: the firmware calls the ports of
the recorder, which calls those of the drivers and puts lines; the drivers ask the clock, and the interrupt controller's
driver calls the handlers, on a stack of its own."""
import re
import subprocess
import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent.parent / folder) for folder in ("discipline", "figures")]
import figures  # noqa: E402
from rules import CallGraph  # noqa: E402

BUILD = Path("build/zcu102")
IMAGE = BUILD / "landmass.elf"
LAYERS = ("fixed", "firmware", "drivers", "bsp/zcu102", "bsp/record")
KIB = 1024
STACK_BUDGET = 8 * KIB
INTERRUPT_FRAME = 272  # bsp/zcu102/vectors.S
PORTS = {"receive", "receive_2", "send", "send_frame", "read_start", "read_poll", "acquire", "present", "next",
         "next_control", "tell_refusal"}
HANDLERS = {"tick", "drv_uart_interrupt", "drv_can_interrupt"}


def plain(name):
    """A static function's title is "file:name"."""
    return name.rsplit(":", 1)[-1]


def behind_pointer(graph, caller):
    """The functions that `caller` may reach by a call through a pointer."""
    if caller == "drv_irq_dispatch":
        return {name for name in graph.stack_bytes if plain(name) in HANDLERS}
    if caller.startswith("drivers/bezel/"):
        return {name for name in graph.stack_bytes if plain(name) == "get_byte"}
    if caller.startswith(("drivers/", "drv_")):
        return {"zcu102_now_us"}
    # A slot of the flash stands before the flash itself, and what is known of the slots before the bezel.
    if caller.startswith(("firmware/map/slot_flash", "bsp/zcu102/slots")):
        return {name for name in graph.stack_bytes if plain(name) in PORTS and name.startswith("drivers/")}
    ports = {name for name in graph.stack_bytes if plain(name) in PORTS}
    if caller.startswith(("bsp/record/", "record_")):
        before = ("drivers/", "firmware/map/slot_flash", "bsp/zcu102/slots")
        return {name for name in ports if name.startswith(before)} | {"bsp/zcu102/recording.c:put_line"}
    return {name for name in ports if name.startswith("drivers/")} if caller.startswith("tests/") else ports


def call_graph(image):
    """Of an image, by the name of its main program: "main", or that of a test's."""
    graph = CallGraph()
    paths = [path for layer in LAYERS for path in sorted((BUILD / layer).rglob("*.ci"))]
    if image != "main":
        paths = [path for path in paths if path.stem != "main"]
        paths += [BUILD / f"tests/zcu102/images/{name}.ci" for name in (image, "handed", "look", "peer")]
    for path in paths:
        graph.read(path.with_suffix(".o"))
    graph.resolve()
    # A file with a table may call a port, too: more than it reaches does no harm.
    for caller in set().union(*graph.indirect.values()):
        graph.calls.setdefault(caller, set()).update(behind_pointer(graph, caller))
    return graph


def deepest(graph, root):
    """(bytes, path) of the deepest chain from a function."""
    known = {}

    def below(name):
        if name not in known:
            under = max((below(callee) for callee in graph.calls.get(name, ())), default=(0, []))
            known[name] = (under[0] + graph.stack_bytes.get(name, 0), [plain(name)] + under[1])
        return known[name]

    return below(root)


def stacks(image="main"):
    """The deepest chains on the main stack and on the exceptions', and the functions that may call themselves."""
    graph = call_graph(image)
    cycles = graph.cycles()
    if cycles:
        return None, None, cycles
    interrupt = deepest(graph, "zcu102_interrupt")
    return deepest(graph, "main"), (interrupt[0] + INTERRUPT_FRAME, interrupt[1]), []


def symbols(image=IMAGE):
    out = subprocess.run(["aarch64-linux-gnu-nm", image], capture_output=True, text=True, check=True).stdout
    return {name: int(value, 16) for value, name in re.findall(r"^([0-9a-f]+) \w (\S+)$", out, re.M)}


def sizes(image=IMAGE):
    """name -> (start, bytes) of what the image occupies."""
    at = symbols(image)
    rows = {}
    for name, start, end in (("text", "__text_start", "__text_end"), ("rodata", "__rodata_start", "__rodata_end"),
                             ("data", "__data_start", "__bss_start"), ("bss", "__bss_start", "__bss_end"),
                             ("stack", "__stack_bottom", "__stack_top"),
                             ("exception stack", "__exception_stack_bottom", "__exception_stack_top"),
                             ("kept across a reset", "__kept_start", "__kept_end")):
        rows[name] = (at[start], at[end] - at[start])
    listing = subprocess.run(["aarch64-linux-gnu-nm", "-S", image], capture_output=True, text=True, check=True).stdout
    for value, size, name in re.findall(r"^([0-9a-f]+) ([0-9a-f]+) \w (\S+)$", listing, re.M):
        where = int(value, 16)
        if at["__bulk_start"] <= where < at["__shared_end"] and int(size, 16) >= 1024:
            rows[{"tile_pool": "tile cache", "plane": "radar picture",
                  "scanned": "framebuffers, scanned out", "flash_piece": "flash DMA"}.get(name, name)] = (
                      where, int(size, 16))
    return rows


def unpadded(image=IMAGE):
    """Bytes of text and rodata without what fills their last pages."""
    at = symbols(image)
    return sum(at[f"__{name}_last"] - at[f"__{name}_start"] for name in ("text", "rodata"))


def budgets(rows, main):
    """(what, bytes, most) of docs/EQUATIONS.md's memory budgets."""
    apart = ("tile cache", "framebuffers, scanned out", "text", "rodata")
    return [("text + rodata", rows["text"][1] + rows["rodata"][1], 320 * KIB),
            ("static RAM beside tile cache and framebuffers",
             sum(size for name, (_, size) in rows.items() if name not in apart), 2048 * KIB),
            ("deepest stack, computed", main[0], STACK_BUDGET)]


def main():
    rows = sizes()
    print(f"{'':32}{'at':>10}{'bytes':>12}")
    for name, (start, size) in sorted(rows.items(), key=lambda row: row[1][0]):
        print(f"{name:32}{start:#10x}{size:12,}")
    chain, interrupt, cycles = stacks()
    if cycles:
        print("these functions may call themselves:", ", ".join(cycles))
        return 1
    print(f"\ndeepest chain of calls: {chain[0]:,} bytes\n    {' > '.join(chain[1])}")
    print(f"deepest interrupt, on its own stack: {interrupt[0]:,} bytes\n    {' > '.join(interrupt[1])}\n")
    failed = False
    fits = budgets(rows, chain)
    for what, size, most in fits:
        failed |= size > most
        print(f"{what:48}{size:12,} of {most:12,}  {'OVER BUDGET' if size > most else 'fits'}")
    figures.record("size", [(size, "bytes", what) for what, size, _ in fits] +
                   [(unpadded(), "bytes", "text + rodata, last pages without padding")])
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
