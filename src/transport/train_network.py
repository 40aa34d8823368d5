#!/usr/bin/python3
"""Trains the network by which a style's ink is moved (fluidy-style network calls this).

Standard input has the style's densities, WIDTH * HEIGHT floats of mean 1; the file of
transport/network.h goes to OUT. The loss is that of transport/sliced.c, on patches of 128 px with
random shapes; the network is a U-Net whose batch norms are folded into its weights at the end,
which then become integers. Nothing here runs when a film is painted.
"""
import argparse
import math
import struct
import sys
import zlib

try:
    import numpy as np
    import torch
    import torch.nn.functional as F
except ImportError as problem:
    sys.exit(f"{problem}: training needs PyTorch; install python3-torch")

CHANNELS = 12          # C of the layers below
PATCH = 128            # px of a training picture
LEVELS = 4             # of the loss
SQUARINGS = 3          # of the flow: transport/flow_map.h
NOISES = (4, 12)       # px between the nodes of the noise inputs
AMPLITUDES = (3.0, 12.0, 40.0)  # px², of the grids of 2, 4 and 8 px
ACTIVATION_MOST = 8191
MAGIC = b"FLNET001"
# name, stride, kernel, inputs, outputs: in the order of the file
LAYERS = [("stem", 2, 5, 4, 1), ("e1a", 1, 3, 1, 1), ("e1b", 1, 3, 1, 1),
          ("e2a", 1, 3, 1, 2), ("e2b", 1, 3, 2, 2), ("e3a", 1, 3, 2, 3), ("e3b", 1, 3, 3, 3),
          ("e4a", 1, 3, 3, 4), ("e4b", 1, 3, 4, 4), ("d3a", 1, 3, 7, 3), ("d3b", 1, 3, 3, 3),
          ("d2a", 1, 3, 5, 2), ("d2b", 1, 3, 2, 2), ("d1a", 1, 3, 3, 1), ("d1b", 1, 3, 1, 1),
          ("o1", 1, 3, 1, 0), ("o2", 1, 3, 2, 0), ("o3", 1, 3, 3, 0)]


def is_head(name):
    return name.startswith("o")


class FloatMath:
    """What the layers do in training: convolution, batch norm, leaky rectifier."""

    def __init__(self, net):
        self.net = net

    def layer(self, name, x):
        conv = self.net.conv[name]
        x = conv(F.pad(x, (conv.kernel_size[0] // 2,) * 4, mode="replicate"))
        return x if is_head(name) else F.leaky_relu(self.net.norm[name](x), 0.125)

    @staticmethod
    def halve(x):
        return F.avg_pool2d(x, 2)

    @staticmethod
    def double(x):
        return F.interpolate(x, scale_factor=2, mode="bilinear", align_corners=False)


class IntegerMath:
    """The same in the integers of transport/network.c."""

    def __init__(self, layers):
        self.layers = layers

    def layer(self, name, x):
        weight, bias, shift, stride = self.layers[name]
        pad = weight.shape[-1] // 2
        x = F.pad(x, (pad,) * 4, mode="replicate")
        total = F.conv2d(x, weight.double(), bias.double(), stride=stride).long()
        value = (total + (1 << shift >> 1)) >> shift
        if not is_head(name):
            value = torch.where(value < 0, (value + 4) >> 3, value)
        return value.clamp(-ACTIVATION_MOST, ACTIVATION_MOST).double()

    @staticmethod
    def halve(x):
        x = x.long()
        total = x[..., ::2, ::2] + x[..., 1::2, ::2] + x[..., ::2, 1::2] + x[..., 1::2, 1::2]
        return ((total + 2) >> 2).double()

    @staticmethod
    def double(x):
        total = 16 * F.interpolate(x, scale_factor=2, mode="bilinear", align_corners=False)
        return ((total.round().long() + 8) >> 4).double()


def forward(math_, x):
    """The three heads, finest first; x is 4 planes with sides that are multiples of 16."""
    e1 = math_.layer("e1b", math_.layer("e1a", math_.layer("stem", x)))
    e2 = math_.layer("e2b", math_.layer("e2a", math_.halve(e1)))
    e3 = math_.layer("e3b", math_.layer("e3a", math_.halve(e2)))
    e4 = math_.layer("e4b", math_.layer("e4a", math_.halve(e3)))
    d3 = math_.layer("d3b", math_.layer("d3a", torch.cat((math_.double(e4), e3), 1)))
    d2 = math_.layer("d2b", math_.layer("d2a", torch.cat((math_.double(d3), e2), 1)))
    d1 = math_.layer("d1b", math_.layer("d1a", torch.cat((math_.double(d2), e1), 1)))
    return math_.layer("o1", d1), math_.layer("o2", d2), math_.layer("o3", d3)


class Net(torch.nn.Module):
    def __init__(self):
        super().__init__()
        self.conv, self.norm = torch.nn.ModuleDict(), torch.nn.ModuleDict()
        for name, stride, kernel, inputs, outputs in LAYERS:
            inputs = 4 if name == "stem" else inputs * CHANNELS
            outputs = outputs * CHANNELS or 1
            self.conv[name] = torch.nn.Conv2d(inputs, outputs, kernel, stride, bias=is_head(name))
            if is_head(name):
                torch.nn.init.normal_(self.conv[name].weight, 0, 0.01)
                torch.nn.init.zeros_(self.conv[name].bias)
            else:
                self.norm[name] = torch.nn.BatchNorm2d(outputs, momentum=0.05)


def potential(heads):
    """As fl_potential_sum() adds grids: from the coarsest, always doubled."""
    total = 0
    for amplitude, head in reversed(list(zip(AMPLITUDES, heads))):
        total = F.interpolate(total + amplitude * torch.tanh(head), scale_factor=2,
                              mode="bicubic", align_corners=False)
    return total


# ---- transport -------------------------------------------------------------------------------

def gradients(f):
    f = F.pad(f, (1, 1, 1, 1), mode="replicate")
    return ((f[..., 1:-1, 2:] - f[..., 1:-1, :-2]) / 2, (f[..., 2:, 1:-1] - f[..., :-2, 1:-1]) / 2)


def sample(f, u):
    """f, N x C x H x W, at each pixel's place plus u."""
    h, w = f.shape[-2:]
    x = torch.arange(w).float().view(1, 1, w) + u[:, 0]
    y = torch.arange(h).float().view(1, h, 1) + u[:, 1]
    grid = torch.stack((x * (2 / (w - 1)) - 1, y * (2 / (h - 1)) - 1), -1)
    return F.grid_sample(f, grid, mode="bilinear", padding_mode="border", align_corners=True)


def transport(p, density, taper):
    v = torch.cat(gradients(p), 1) * taper
    u = -v / 2**SQUARINGS
    for _ in range(SQUARINGS):
        u = u + sample(u, u)
    xx, xy = gradients(u[:, :1])
    yx, yy = gradients(u[:, 1:])
    jacobian = (1 + xx) * (1 + yy) - xy * yx
    return sample(density, u) * jacobian, v, jacobian


# ---- the loss --------------------------------------------------------------------------------

def coarser(f):
    k = torch.tensor([1.0, 4, 6, 4, 1]) / 16
    f = F.pad(f, (2, 2, 2, 2), mode="reflect")
    return F.conv2d(F.conv2d(f, k.view(1, 1, 1, 5))[..., ::2], k.view(1, 1, 5, 1))[..., ::2, :]


def patches(f, x, y):
    i = torch.arange(7)
    return f[(y[:, None] + i)[:, :, None], (x[:, None] + i)[:, None, :]].reshape(len(x), 49)


class Loss:
    def __init__(self, style, generator):
        bank = torch.randn(96, 49, generator=generator)
        self.bank = bank / bank.norm(dim=1, keepdim=True)
        self.tables = []
        for _ in range(LEVELS):
            h, w = style.shape[-2:]
            x = torch.randint(0, w - 6, (16384,), generator=generator)
            y = torch.randint(0, h - 6, (16384,), generator=generator)
            self.tables.append((self.bank @ patches(style[0, 0], x, y).T).sort(1).values)
            style = coarser(style)

    def __call__(self, density, coverage, levels, corners, directions):
        total, each = density.new_zeros(()), [None] * LEVELS
        for level in range(LEVELS):
            inside = (-F.max_pool2d(-coverage, 7, 1) > 0.98)[:, 0]
            for i in range(len(density)) if level in levels else ():
                places = inside[i].nonzero()
                if len(places) < 64:
                    continue
                places = places[torch.randint(0, len(places), (corners,))]
                chosen = torch.randperm(96)[:directions]
                found = (self.bank[chosen] @ patches(density[i, 0], places[:, 1], places[:, 0]).T)
                rank = ((torch.arange(corners) + 0.5) / corners * 16384).long()
                part = (found.sort(1).values - self.tables[level][chosen][:, rank]).square().mean()
                total = total + part / len(density)
                each[level] = (each[level] or 0) + part.item() / len(density)
            density, coverage = coarser(density), coarser(coverage)
        return total, each


# ---- what is learned from --------------------------------------------------------------------

def material_noise(n, px, count):
    """Cubic B-splines of normals, of variance 1, as transport/network_input.c has them."""
    t = (torch.arange(n + px) + 0.5) / px
    i, f = t.floor().long(), t - t.floor()
    w = torch.stack(((1 - f)**3, 4 - 6 * f**2 + 3 * f**3, 4 - 6 * (1 - f)**2 + 3 * (1 - f)**3,
                     f**3), 1) / 6
    matrix = torch.zeros(n + px, int(i.max()) + 4)
    for k in range(4):
        matrix[torch.arange(n + px), i + k] = w[:, k]
    field = matrix @ torch.randn(count, 1, matrix.shape[1], matrix.shape[1]) @ matrix.T
    x, y = torch.randint(0, px, (2,))
    return field[..., y:y + n, x:x + n] / 0.4795  # the deviation: sum of squares, both ways


def shapes(count, taper_px):
    """Coverage, density and taper of random shapes; a quarter have no contour."""
    f = material_noise(PATCH, 40, count) + 0.3 * material_noise(PATCH, 16, count)
    f = f + 0.5 + 0.3 * torch.randn(count, 1, 1, 1)
    gx, gy = gradients(f)
    coverage = (0.5 + f / (gx.square() + gy.square()).sqrt().clamp(min=1e-3)).clamp(0, 1)
    coverage[::4] = 1
    depth, inside = torch.zeros_like(coverage), coverage
    for step in range(math.ceil(taper_px)):  # an octagon's distance
        depth = depth + inside.clamp(0, 1) * min(1.0, taper_px - step)
        pad = F.pad(inside, (1, 1, 1, 1), value=1.0)
        cross = torch.min(torch.min(pad[..., 1:-1, :-2], pad[..., 1:-1, 2:]),
                          torch.min(pad[..., :-2, 1:-1], pad[..., 2:, 1:-1]))
        inside = torch.min(inside, cross if step % 2 else -F.max_pool2d(-pad, 3, 1))
    t = (depth / taper_px).clamp(0, 1)
    density = coverage.clone()
    some = torch.arange(count) % 3 == 1
    density[some] *= 1 + 0.25 * material_noise(PATCH, 24, int(some.sum()))
    return coverage, density.clamp(min=0), t * t * (3 - 2 * t)


def inputs_of(coverage, density):
    """The noises lie on the shapes; around them there is none."""
    noise = [material_noise(coverage.shape[-1], px, len(coverage)) * coverage for px in NOISES]
    return torch.cat([density - 1, coverage - 0.5] + noise, 1)


# ---- training --------------------------------------------------------------------------------

def step_size(step, steps):
    at = step / steps
    for until, size in ((0.345, 4e-3), (0.425, 3e-3), (0.543, 2e-3), (0.75, 1e-3), (1, 5e-4)):
        if at < until:
            return size
    return 5e-4


def train(style, taper_px, steps):
    generator = torch.Generator().manual_seed(7)
    net, loss = Net(), Loss(style, generator)
    adam = torch.optim.Adam(net.parameters(), lr=4e-3, betas=(0.9, 0.98))
    coverage, density, taper = shapes(256, taper_px)
    for step in range(steps):
        pick = torch.randint(0, len(coverage), (2,))
        c, d, t = coverage[pick], density[pick], taper[pick]
        p = potential(forward(FloatMath(net), inputs_of(c, d)))
        moved, v, jacobian = transport(p, d, t)
        levels = (2, 3) if step < 60 else range(LEVELS)
        value, each = loss(moved, c, levels, 512, 16)
        bent = sum(g.square().mean() for g in gradients(v[:, :1]) + gradients(v[:, 1:]))
        value = (value + 2e-3 * bent + 2e-5 * 2 * v.square().mean()
                 + F.relu(0.05 - jacobian).square().mean())
        for group in adam.param_groups:
            group["lr"] = step_size(step, steps)
        adam.zero_grad()
        value.backward()
        torch.nn.utils.clip_grad_norm_(net.parameters(), 1)
        adam.step()
        if step % 50 == 0 or step == steps - 1:
            print(f"step {step} of {steps}: loss {value.item():.4f}",
                  *(f"{e:.4f}" if e is not None else "-" for e in each), flush=True)
    settle_norms(net, coverage, density)
    return net, (coverage, density, taper), loss


def settle_norms(net, coverage, density):
    """The norms' figures as means over many patches rather than of the last ones."""
    for norm in net.norm.values():
        norm.reset_running_stats()
        norm.momentum = None
    with torch.no_grad():
        for i in range(0, 128, 2):
            forward(FloatMath(net), inputs_of(coverage[i:i + 2], density[i:i + 2]))
    net.eval()


# ---- integers --------------------------------------------------------------------------------

def largest_activation(net, data):
    most = 4.0  # noises are of this size

    class Watch(FloatMath):
        def layer(self, name, x):
            nonlocal most
            y = super().layer(name, x)
            most = max(most, y.abs().max().item())
            return y
    with torch.no_grad():
        for i in range(0, 64, 4):
            forward(Watch(net), inputs_of(data[0][i:i + 4], data[1][i:i + 4]))
    return most


def quantise(net, data):
    """Layers as integers, and the bits behind the point of every activation."""
    bits = int(math.floor(math.log2(ACTIVATION_MOST / (1.25 * largest_activation(net, data)))))
    layers = {}
    for name, stride, *_ in LAYERS:
        weight, bias = net.conv[name].weight.detach(), net.conv[name].bias
        if is_head(name):
            bias = bias.detach()
        else:
            norm = net.norm[name]
            gain = norm.weight.detach() / (norm.running_var + norm.eps).sqrt()
            weight = weight * gain.view(-1, 1, 1, 1)
            bias = norm.bias.detach() - norm.running_mean * gain
        shift = 14
        while True:  # the largest that no sum exceeds
            w, b = (weight * 2**shift).round().long(), (bias * 2**(shift + bits)).round().long()
            most = (w.abs().sum((1, 2, 3)) * ACTIVATION_MOST + b.abs() + (1 << shift)).max()
            if most < 2**31 and w.abs().max() < 32768:
                break
            shift -= 1
        layers[name] = (w, b, shift, stride)
    return layers, bits


def write(path, layers, bits):
    body = struct.pack("<4H", CHANNELS, bits, len(LAYERS), 0)
    for name, *_ in LAYERS:
        weight, bias, shift, _ = layers[name]
        body += struct.pack("<I", shift)
        body += bias.numpy().astype("<i4").tobytes() + weight.numpy().astype("<i2").tobytes()
    with open(path, "wb") as out:
        out.write(MAGIC + body + struct.pack("<I", zlib.crc32(body)))


def reference_case(path, layers, bits):
    """Quantised inputs of 64 x 48 px and what the integers make of them, for the test of the C."""
    coverage, density, _ = shapes(4, 5)
    x = (inputs_of(coverage, density)[1:2, :, :48, :64] * 2**bits).round().double()
    heads = forward(IntegerMath(layers), x)
    with open(path, "wb") as out:
        for plane in (x, *heads):
            out.write(plane.numpy().astype("<i2").tobytes())


def report(net, layers, bits, data, loss):
    c, d, t = (plane[:16] for plane in data)
    x = inputs_of(c, d)
    with torch.no_grad():
        exact = potential(forward(FloatMath(net), x))
        whole = potential([h.float() / 2**bits for h in
                           forward(IntegerMath(layers), (x * 2**bits).round().double())])
        for name, p in (("flat", exact * 0), ("real", exact), ("integer", whole)):
            _, each = loss(transport(p, d, t)[0], c, range(LEVELS), 1024, 96)
            print(name, "network:", *(f"{e:.4f}" for e in each))
        print(f"integers differ by {(exact - whole).abs().mean():.4f} px² of "
              f"{exact.abs().mean():.2f}; {bits} bits behind the point")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("width", type=int)
    parser.add_argument("height", type=int)
    parser.add_argument("taper", type=float)
    parser.add_argument("out")
    parser.add_argument("--steps", type=int, default=2049)
    parser.add_argument("--case", help="a stored case for the tests goes there")
    wanted = parser.parse_args()
    torch.set_num_threads(1)
    torch.manual_seed(7)
    picture = np.frombuffer(sys.stdin.buffer.read(), "<f4").copy()
    style = torch.from_numpy(picture).view(1, 1, wanted.height, wanted.width)
    net, data, loss = train(style, wanted.taper, wanted.steps)
    layers, bits = quantise(net, data)
    write(wanted.out, layers, bits)
    report(net, layers, bits, data, loss)
    if wanted.case:
        reference_case(wanted.case, layers, bits)


main()
