"""PyTorch on the very training that `netem_peer FILE EPOCHS` timed: the same inputs, chips, first weights and batches.

netem_peer.py FILE EPOCHS WAY     WAY: double or float

Networks are torch.nn.Linear with ReLU and a sigmoid; a ray's coefficients are multiplied and its echoes added to cells by
index_add; the kernel of 107 x 107 is applied by torch.fft, which on a processor is much faster than conv2d; the loss is
mse_loss on every second cell after tanh, the optimiser torch.optim.Adam. One thread. Prints
    loss-before LOSS
    torch SECONDS-OF-PROCESSOR-AN-EPOCH LOSS-AFTER
"""
import random
import struct
import sys
import time

import torch

KERNEL = 107
WIDTHS = (4, 16, 32, 64, 32, 32, 1)


class Reader:
    def __init__(self, path):
        with open(path, "rb") as stream:
            self.data = stream.read()
        self.at = 0

    def take(self, code, count):
        values = struct.unpack_from("<%d%s" % (count, code), self.data, self.at)
        self.at += struct.calcsize("<%d%s" % (count, code))
        return values

    def number(self, code):
        return self.take(code, 1)[0]

    def tensor(self, code, count, kind):
        return torch.tensor(self.take(code, count), dtype=kind)


def network(weights, at, kind):
    layers = []
    for before, after in zip(WIDTHS, WIDTHS[1:]):
        layer = torch.nn.Linear(before, after).to(kind)
        with torch.no_grad():
            layer.weight.copy_(weights[at:at + before * after].reshape(after, before))
            at += before * after
            layer.bias.copy_(weights[at:at + after])
            at += after
        layers += [layer, torch.nn.ReLU() if after > 1 else torch.nn.Sigmoid()]
    return torch.nn.Sequential(*layers), at


class Chip:
    """Steps are kept by the number of the reflection: those of one reflection at a time are one vector operation."""

    def __init__(self, reader, side, kind):
        pixels = (side // 2) ** 2
        self.real = reader.tensor("d", pixels, kind).reshape(side // 2, side // 2)
        rows = [reader.number("i"), reader.number("i")]
        rays, steps = reader.number("i"), reader.number("i")
        self.weight = reader.number("d")
        self.inputs = [reader.tensor("d", 4 * count, kind).reshape(count, 4) for count in rows]
        first = reader.take("i", rays + 1)
        way = reader.take("i", 3 * steps)
        self.bounces, before = [], {}
        depth = max(first[i + 1] - first[i] for i in range(rays))
        for number in range(depth):
            here = [i for i in range(rays) if first[i] + number < first[i + 1]]
            at = [first[i] + number for i in here]
            echo = [(k, way[3 * s], way[3 * s + 2]) for k, s in enumerate(at) if way[3 * s + 2] >= 0]
            self.bounces.append({
                "from": torch.tensor([before[i] for i in here]) if number else None,
                "on": torch.tensor([way[3 * (s - 1) + 1] for s in at]) if number else None,
                "count": len(here),
                "ray": torch.tensor([e[0] for e in echo], dtype=torch.long),
                "row": torch.tensor([e[1] for e in echo], dtype=torch.long),
                "cell": torch.tensor([e[2] for e in echo], dtype=torch.long),
            })
            before = {i: k for k, i in enumerate(here)}


class Simulator:
    def __init__(self, nets, kernel, side, kind):
        self.nets, self.side = nets, side
        self.period = side + KERNEL - 1
        self.spectrum = torch.fft.rfft2(kernel.reshape(KERNEL, KERNEL), s=(self.period, self.period))
        self.kind = kind

    def __call__(self, chip):
        back, on = (net(inputs).squeeze(1) for net, inputs in zip(self.nets, chip.inputs))
        picture = torch.zeros(self.side * self.side, dtype=self.kind)
        power = None
        for b in chip.bounces:
            power = torch.full((b["count"],), chip.weight, dtype=self.kind) if b["from"] is None else \
                power[b["from"]] * on[b["on"]]
            picture = picture.index_add(0, b["cell"], power[b["ray"]] * back[b["row"]])
        spread = torch.fft.irfft2(torch.fft.rfft2(picture.reshape(self.side, self.side), s=(self.period, self.period)) *
                                  self.spectrum, s=(self.period, self.period))
        half = KERNEL // 2
        return torch.tanh(spread[half:half + self.side:2, half:half + self.side:2])


def mean_loss(simulator, chips):
    with torch.no_grad():
        return sum(torch.nn.functional.mse_loss(simulator(chip), chip.real).item() for chip in chips) / len(chips)


def main(path, epochs, kind):
    torch.set_num_threads(1)
    torch.set_flush_denormal(True)
    reader = Reader(path)
    count, side, batch, rate = reader.number("i"), reader.number("i"), reader.number("i"), reader.number("d")
    kernel = reader.tensor("d", KERNEL * KERNEL, kind)
    weights = reader.tensor("d", reader.number("i"), kind)
    back, at = network(weights, 0, kind)
    on, _ = network(weights, at, kind)
    chips = [Chip(reader, side, kind) for _ in range(count)]
    simulator = Simulator((back, on), kernel, side, kind)
    optimiser = torch.optim.Adam([*back.parameters(), *on.parameters()], lr=rate)
    print("loss-before %.9f" % mean_loss(simulator, chips), flush=True)
    random.seed(1)
    before = time.process_time()
    for _ in range(epochs):
        order = random.sample(chips, len(chips))
        for i in range(0, count, batch):
            some = order[i:i + batch]
            optimiser.zero_grad()
            for chip in some:
                (torch.nn.functional.mse_loss(simulator(chip), chip.real) / len(some)).backward()
            optimiser.step()
    spent = (time.process_time() - before) / epochs
    print("torch %.4f %.9f" % (spent, mean_loss(simulator, chips)))


if len(sys.argv) == 4 and sys.argv[3] in ("double", "float"):
    main(sys.argv[1], int(sys.argv[2]), torch.float64 if sys.argv[3] == "double" else torch.float32)
else:
    sys.exit(__doc__)
