#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a plant whose leaves are cards cut out by opacity: make_plant.py FOLDER [LEAVES]

plant.obj, plant.mtl   a stem, and LEAVES (200) cards of two triangles, bent once along the middle
leaf.png               256 x 256, RGBA: a lobed leaf with holes; alpha is the opacity (map_d)
bark.png               64 x 64, RGB
"""

import math
import random
import struct
import sys
import zlib


def write_png(file, width, height, channels, rows):
    """Writes rows, top first, of `channels` bytes per pixel."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    kind = {3: 2, 4: 6}[channels]
    with open(file, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)) +
                  chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows))) + chunk(b"IEND", b""))


def leaf_pixel(x, y):
    """Returns the colour and the opacity of the leaf at x, y of -1 to 1; the stalk is at y = -1."""
    along = (y + 1) / 2
    width = 0.75 * math.sin(math.pi * min(1, along ** 0.8)) * (0.8 + 0.2 * math.cos(9 * math.pi * along))
    edge = (max(width, 0.03 if along < 0.3 else 0) - abs(x)) * 24
    for hx, hy, radius in ((0.25, -0.1, 0.09), (-0.3, 0.2, 0.07), (-0.15, -0.45, 0.06), (0.2, 0.35, 0.05)):
        edge = min(edge, (math.hypot(x - hx, y - hy) - radius) * 24)
    vein = min(abs(x), abs((abs(x) * 1.2 - y) % 0.3 - 0.15) * 0.8)
    light = 0.75 + 0.25 * min(1, vein * 14)
    color = (int(70 * light + 30 * along), int(150 * light), int(40 * light))
    return (*color, int(255 * min(1, max(0, edge + 0.5))))


def main(folder, leaves):
    draw = random.Random(5)
    side = 256
    write_png(f"{folder}/leaf.png", side, side, 4,
              [bytes(v for i in range(side) for v in leaf_pixel(2 * (i + 0.5) / side - 1, 1 - 2 * (j + 0.5) / side))
               for j in range(side)])
    write_png(f"{folder}/bark.png", 64, 64, 3,
              [bytes(v for i in range(64) for v in
                     (lambda s: (int(110 * s), int(80 * s), int(50 * s)))(0.7 + 0.3 * math.sin(i * 0.8 + math.sin(j * 0.4))))
               for j in range(64)])
    with open(f"{folder}/plant.mtl", "w") as out:
        out.write("newmtl leaf\nmap_Kd -clamp on leaf.png\nmap_d -clamp on leaf.png\nPr 0.5\nPm 0\n\n"
                  "newmtl bark\nmap_Kd bark.png\nPr 0.9\nPm 0\n")
    lines, vertices = ["mtllib plant.mtl"], 0

    def vertex(p, uv):
        nonlocal vertices
        lines.append("v %.6f %.6f %.6f\nvt %.6f %.6f" % (*p, *uv))
        vertices += 1
        return vertices

    def stem(t):
        return (0.12 * math.sin(3 * t), 2.2 * t, 0.1 * math.sin(4 * t + 1) - 0.08)

    lines += ["o stem", "usemtl bark"]
    rings, around = 24, 12
    grid = [[vertex([c + 0.06 * (1 - 0.8 * k / rings) * d for c, d in
                     zip(stem(k / rings), (math.cos(2 * math.pi * i / around), 0, -math.sin(2 * math.pi * i / around)))],
                    (i / around, 4 * k / rings)) for i in range(around + 1)] for k in range(rings + 1)]
    for low, high in zip(grid, grid[1:]):
        for i in range(around):
            lines.append("f " + " ".join(f"{v}/{v}" for v in (low[i], low[i + 1], high[i + 1], high[i])))

    lines += ["o leaves", "usemtl leaf"]
    for k in range(leaves):
        t = 0.15 + 0.85 * (k + draw.random()) / leaves
        turn, rise = 2.399963 * k + draw.uniform(-0.2, 0.2), draw.uniform(-0.1, 0.7)
        out_, up = (math.cos(turn), 0, math.sin(turn)), draw.uniform(0.7, 1.3) * (1.15 - 0.7 * t)
        along = [math.cos(rise) * out_[0], math.sin(rise), math.cos(rise) * out_[2]]
        across = [-out_[2], draw.uniform(-0.3, 0.3), out_[0]]
        normal = [along[1] * across[2] - along[2] * across[1], along[2] * across[0] - along[0] * across[2],
                  along[0] * across[1] - along[1] * across[0]]
        sign = 1 if normal[1] > 0 else -1
        base = stem(t)

        def place(x, y):
            bend = -0.18 * (y + 1) ** 2 * up
            return [b + up * (0.55 * (y + 1) * a + 0.5 * x * c) + (bend if axis == 1 else 0)
                    for axis, (b, a, c) in enumerate(zip(base, along, across))]
        rows = [[vertex(place(x, y), ((x + 1) / 2, (y + 1) / 2)) for x in (-1, 1)] for y in (-1, 0, 1)]
        for (a, b), (d, c) in zip(rows, rows[1:]):
            corners = (a, b, c, d) if sign < 0 else (a, d, c, b)
            lines.append("f " + " ".join(f"{v}/{v}" for v in corners))
    with open(f"{folder}/plant.obj", "w") as out:
        out.write("\n".join(lines) + "\n")


main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 200)
