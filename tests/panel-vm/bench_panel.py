"""How fast the panel is: from a frame of the bus to the glass, the loop's regularity, share of the processor, memory.

Read from the kernel's own tracing of a panel in flight. Time in the machine is counted in instructions, a nanosecond each: the
figures are those of a processor that does 1,000 million instructions a second, whatever computer this is, and say nothing
of caches or of a display's refresh. QEMU's devices answer in real time, which a busy computer shows in the largest figures.
Nothing here passes or fails.
"""

import re

import machine
from panel import in_flight
from test_panel import boot, prepare

SECONDS = 10
TRACING = "/sys/kernel/tracing"
EVENTS = ("net/netif_rx", "syscalls/sys_enter_recvmmsg", "virtio_gpu/virtio_gpu_cmd_queue")
FLUSH = "type=0x104"  # VIRTIO_GPU_CMD_RESOURCE_FLUSH: what was drawn becomes visible


def trace(m):
    """Let the kernel record for SECONDS; [(time in us, "frame" | "look" | "glass")]."""
    m.do("mount -t tracefs t %s; cd %s; echo 16384 >buffer_size_kb; for e in %s; do echo 1 >events/$e/enable; done; "
         "echo >trace; echo 1 >tracing_on; sleep %d; echo 0 >tracing_on" % (TRACING, TRACING, " ".join(EVENTS), SECONDS))
    kinds = (("netif_rx", "frame"), ("sys_recvmmsg", "look"), (FLUSH, "glass"))
    events = []
    for line in m.do("cat %s/trace" % TRACING).splitlines():
        stamp = re.search(r" (\d+)\.(\d{6}): ", line)
        kind = next((kind for word, kind in kinds if word in line), None)
        if stamp and kind:
            events.append((int(stamp[1] + stamp[2]), kind))
    return events


def latencies(events):
    """For each frame of the bus the time until the first picture that was drawn after the panel had read it."""
    waiting, read, found = [], [], []
    for time_us, kind in events:
        if kind == "frame":
            waiting.append(time_us)
        elif kind == "look":
            read, waiting = read + waiting, []
        else:
            found += [time_us - arrival_us for arrival_us in read]
            read = []
    return found


def steps(events):
    """Times between the beginnings of neighbouring steps; the looks of one step lie close together."""
    looks = [time_us for time_us, kind in events if kind == "look"]
    begins = [now for before, now in zip([-1000] + looks, looks) if now - before > 300]
    return [now - before for before, now in zip(begins, begins[1:])]


def spread(numbers):
    """Least, median, 99th of a hundred, and largest."""
    numbers = sorted(numbers)
    at = [numbers[min(len(numbers) - 1, int(len(numbers) * share))] / 1000 for share in (0, 0.5, 0.99, 1)]
    return "least %.1f, median %.1f, 99 %% %.1f, largest %.1f ms (%d)" % (*at, len(numbers))


def ticks(m):
    """Hundredths of a second that the panel has had of the processor, and of the machine's time."""
    stat = m.do("cut -d' ' -f14,15 /proc/$(pidof landmass-panel)/stat; cut -d' ' -f1 /proc/uptime").split()
    return int(stat[0]) + int(stat[1]), float(stat[2]) * 100


def main():
    """Print the figures, or why there are none."""
    reason = machine.setup("arm64")
    if reason:
        print("panel: no figures: " + reason)
        return
    m = boot()
    try:
        prepare(m)
        in_flight(m, "flight")
        used, now = ticks(m)
        m.sleep(SECONDS)
        used_after, now_after = ticks(m)
        events = trace(m)
        memory = m.do("grep -E 'VmRSS|VmHWM|VmLck' /proc/$(pidof landmass-panel)/status").split()
        print("panel in flight, 672 frames of the bus and 30 pictures of 640 x 480 a second, in machine time:")
        print("  nav frame in to glass out: " + spread(latencies(events)))
        print("  between steps of the loop: " + spread(steps(events)))
        print("  processor: %.1f %% of 1,000 million instructions a second" % (100 * (used_after - used) / (now_after - now)))
        print("  memory: " + ", ".join("%s %s KiB" % pair for pair in zip(memory[::3], memory[1::3])))
    finally:
        m.close()


if __name__ == "__main__":
    main()
