#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes meshes of kinds that scans seldom are, for benchmarks: make_meshes.py FOLDER

cards.obj   5,000 leaves in a ball, two triangles each, one-sided and open
fence.obj   400 thin closed slats, 1 x 0.05 x 0.002, side by side and crossing
strip.obj   a terrain 1,000 times as long as it is wide, 160,000 triangles, open
parts.obj   60 closed balls that intersect one another, 76,800 triangles
"""

import math
import random
import sys


class Mesh:
    def __init__(self):
        self.vertices, self.faces = [], []

    def grid(self, columns, rows, place, wrap=False):
        """Adds place(i, j) for columns x rows vertices, and their squares as two triangles each."""
        first = len(self.vertices) + 1
        self.vertices += [place(i, j) for j in range(rows) for i in range(columns)]
        for j in range(rows - 1):
            for i in range(columns if wrap else columns - 1):
                a, b = first + j * columns + i, first + j * columns + (i + 1) % columns
                self.faces += [(a, b, b + columns), (a, b + columns, a + columns)]

    def box(self, centre, half, turn):
        first, c, s = len(self.vertices) + 1, math.cos(turn), math.sin(turn)
        for k in range(8):
            x, y, z = (half[a] * (1 if k >> a & 1 else -1) for a in range(3))
            self.vertices.append((centre[0] + c * x - s * y, centre[1] + s * x + c * y, centre[2] + z))
        for a, b, c, d in ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)):
            self.faces += [(first + a, first + b, first + c), (first + a, first + c, first + d)]

    def ball(self, centre, radius, columns=32, rows=20):
        first = len(self.vertices) + 1
        at = lambda theta, phi: tuple(centre[k] + radius * v for k, v in enumerate(
            (math.sin(theta) * math.cos(phi), math.cos(theta), -math.sin(theta) * math.sin(phi))))
        self.grid(columns, rows, lambda i, j: at(math.pi * (rows - j) / (rows + 1), 2 * math.pi * i / columns), wrap=True)
        for row, pole in ((0, math.pi), (rows - 1, 0)):
            self.vertices.append(at(pole, 0))
            for i in range(columns):
                a, b = first + row * columns + i, first + row * columns + (i + 1) % columns
                self.faces.append((len(self.vertices), b, a) if row == 0 else (len(self.vertices), a, b))

    def write(self, file):
        with open(file, "w") as out:
            out.writelines("v %.7g %.7g %.7g\n" % v for v in self.vertices)
            out.writelines("f %d %d %d\n" % f for f in self.faces)


def main(folder):
    draw = random.Random(1)
    direction = lambda: (lambda v: [x / math.hypot(*v) for x in v])([draw.gauss(0, 1) for _ in range(3)])

    cards = Mesh()
    for _ in range(5000):
        centre, across, other = [draw.random() ** (1 / 3) * x for x in direction()], direction(), direction()
        dot = sum(a * b for a, b in zip(across, other))
        up = [b - dot * a for a, b in zip(across, other)]
        cards.grid(2, 2, lambda i, j: tuple(c + 0.04 * (i - 0.5) * a + 0.06 * (j - 0.5) * u
                                            for c, a, u in zip(centre, across, up)))
    cards.write(folder + "/cards.obj")

    fence = Mesh()
    for k in range(400):
        fence.box((0.06 * (k % 200), 0, 0.2 * (k // 200)), (0.02, 0.5, 0.001), 0.4 if k // 200 else -0.4)
    fence.write(folder + "/fence.obj")

    strip = Mesh()
    strip.grid(4001, 21, lambda i, j: (0.25 * i, 0.1 * math.sin(0.7 * i) * math.sin(2.1 * j), -0.05 * j))
    strip.write(folder + "/strip.obj")

    parts = Mesh()
    for _ in range(60):
        parts.ball([draw.uniform(-1, 1) for _ in range(3)], draw.uniform(0.15, 0.4))
    parts.write(folder + "/parts.obj")


main(sys.argv[1])
