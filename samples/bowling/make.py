#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""make.py FOLDER: writes the meshes and the pictures of samples/bowling.yaml (metres, +Y up), the same on every machine.

Needs Debian's python3-numpy.
"""
import math
import pathlib
import struct
import sys
import zlib

try:
    import numpy
except ImportError:
    sys.exit(f"{sys.argv[0]}: found no numpy in {sys.executable}; expected it; install Debian's python3-numpy, and use "
             "/usr/bin/python3")

INCH = 0.0254
# Heights and diameters of a pin, inches: equipment specifications of the United States Bowling Congress; a round head.
PIN = [(0, 0), (0.02, 2.03), (0.75, 2.828), (2.25, 3.906), (3.375, 4.510), (4.5, 4.766), (5.875, 4.563), (7.25, 3.703),
       (8.625, 2.472), (9.375, 1.965), (10, 1.797), (10.875, 1.870), (11.75, 2.094), (12.625, 2.406), (13.5, 2.547),
       (13.73, 2.547), (14.3, 2.27), (14.7, 1.65), (14.92, 0.85), (15, 0)]
BALL_RADIUS = 8.5 / 2 * INCH


def smoothed(points, count):
    """Points of a Catmull-Rom curve through `points`, by even parameters."""
    points = numpy.array(points, float)
    ends = numpy.vstack([2 * points[0] - points[1], points, 2 * points[-1] - points[-2]])
    curve = []
    for k in range(count + 1):
        at = min(k * (len(points) - 1) / count, len(points) - 1 - 1e-9)
        j, t = int(at), at - int(at)
        a, b, c, d = ends[j:j + 4]
        curve.append(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t**3))
    return numpy.array(curve)


def write_lathe(file, profile, sides):
    """Writes a solid of revolution with uvs and normals; `profile` is (height, radius) from bottom to top."""
    profile = numpy.maximum(profile, [[-9, 0]])
    tangent = numpy.gradient(profile, axis=0)
    normals = numpy.stack([-tangent[:, 1], tangent[:, 0]], 1)  # along the axis, and outwards
    normals /= numpy.maximum(numpy.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    normals[0], normals[-1] = (-1, 0), (1, 0)
    lines = [f"# made by {pathlib.Path(__file__).name}"]
    for (height, radius) in profile:
        for k in range(sides + 1):
            angle = 2 * math.pi * k / sides
            lines.append(f"v {radius * math.sin(angle):.6f} {height:.6f} {radius * math.cos(angle):.6f}")
    for row in range(len(profile)):
        lines += [f"vt {k / sides:.6f} {row / (len(profile) - 1):.6f}" for k in range(sides + 1)]
    for (along, out) in normals:
        for k in range(sides + 1):
            angle = 2 * math.pi * k / sides
            lines.append(f"vn {out * math.sin(angle):.5f} {along:.5f} {out * math.cos(angle):.5f}")
    for row in range(len(profile) - 1):
        for k in range(sides):
            a = row * (sides + 1) + k + 1
            b, c, d = a + 1, a + sides + 2, a + sides + 1
            if row > 0:
                lines.append("f " + " ".join(f"{v}/{v}/{v}" for v in (a, b, c)))
            if row < len(profile) - 2:
                lines.append("f " + " ".join(f"{v}/{v}/{v}" for v in (a, c, d)))
    file.write_text("\n".join(lines) + "\n")


def write_floor(file, half_width, begin, end):
    """Writes a rectangle in the plane y = 0."""
    corners = [(-half_width, begin, 0, 0), (half_width, begin, 1, 0), (half_width, end, 1, 1), (-half_width, end, 0, 1)]
    lines = [f"v {x} 0 {z}" for x, z, _, _ in corners] + [f"vt {u} {v}" for _, _, u, v in corners] + ["vn 0 1 0"]
    file.write_text("\n".join(lines + ["f 1/1/1 2/2/1 3/3/1", "f 1/1/1 3/3/1 4/4/1"]) + "\n")


def write_png(file, pixels):
    """Writes rows of RGB, the first row on top."""
    pixels = numpy.clip(numpy.round(255 * pixels), 0, 255).astype(numpy.uint8)
    if pixels.ndim == 2:
        pixels = numpy.repeat(pixels[:, :, None], 3, axis=2)
    height, width, _ = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def noise(random, height, width, rows, columns):
    """Smooth noise of 0 to 1 that repeats, with so many cells up and across."""
    cells = random.random((rows, columns))
    y, x = numpy.mgrid[0:height, 0:width]
    y, x = y * rows / height, x * columns / width
    j, i = y.astype(int), x.astype(int)
    t, s = y - j, x - i
    t, s = t * t * (3 - 2 * t), s * s * (3 - 2 * s)
    at = lambda a, b: cells[a % rows, b % columns]
    return (at(j, i) * (1 - s) + at(j, i + 1) * s) * (1 - t) + (at(j + 1, i) * (1 - s) + at(j + 1, i + 1) * s) * t


def wood(random, size=1024, boards=39):
    """Boards along the picture's height, each of a shade and with a grain of its own."""
    column = (numpy.arange(size) * boards // size)[None, :].repeat(size, 0)
    shift = random.integers(0, size, boards)
    rows = (numpy.arange(size)[:, None] + shift[column]) % size
    grain = sum(noise(random, size, size, n, boards * n) / n for n in (2, 4, 8)) / 0.875
    grain = numpy.take_along_axis(grain, rows, 0)
    shade = 0.8 + 0.2 * random.random(boards)[column]
    value = shade * (0.86 + 0.24 * (grain - 0.5))
    place = numpy.arange(size) * boards / size % 1
    value *= numpy.where(numpy.minimum(place, 1 - place) < 0.05, 0.72, 1)[None, :]
    return value[:, :, None] * numpy.array([0.88, 0.69, 0.44])


LETTERS = {"K": "10001 10010 10100 11000 10100 10010 10001", "I": "01110 00100 00100 00100 00100 00100 01110",
           "L": "10000 10000 10000 10000 10000 10000 11111", "N": "10001 11001 10101 10101 10011 10001 10001"}


def label(width=512, height=256):
    """Ink of KILN in an oval."""
    y, x = numpy.mgrid[0:height, 0:width]
    oval = ((x - width / 2) / (0.47 * width))**2 + ((y - height / 2) / (0.45 * height))**2
    ink = numpy.where((oval < 1) & (oval > 0.86), 1.0, 0.0)
    for k, letter in enumerate("KILN"):
        rows = LETTERS[letter].split()
        cell = 14
        left, top = width // 2 + (k - 2) * 6 * cell + cell // 2, height // 2 - 7 * cell // 2
        for j in range(7):
            for i in range(5):
                if rows[j][i] == "1":
                    ink[top + j * cell:top + (j + 1) * cell, left + i * cell:left + (i + 1) * cell] = 1
    return ink


def scuffs(random, size=512, count=160):
    """Depth of short, nearly straight scratches, which repeats."""
    depth = numpy.zeros((size, size))
    for _ in range(count):
        x, y = random.random(2) * size
        angle, bend, length = random.random() * math.pi, (random.random() - 0.5) * 0.02, 15 + 60 * random.random()
        strength = 0.3 + 0.7 * random.random()
        for step in range(int(2 * length)):
            x, y, angle = x + 0.5 * math.cos(angle), y + 0.5 * math.sin(angle), angle + bend
            fade = math.sin(math.pi * step / (2 * length))
            for j in (-1, 0, 1):
                for i in (-1, 0, 1):
                    weight = strength * fade * (1 - 0.35 * (abs(i) + abs(j)))
                    at = int(y + j) % size, int(x + i) % size
                    depth[at] = max(depth[at], weight)
    return depth


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    random = numpy.random.default_rng(7)
    pin = smoothed([(h * INCH, d * INCH / 2) for h, d in PIN], 38)
    write_lathe(folder / "pin.obj", pin, 24)
    angles = numpy.linspace(0, math.pi, 25)
    write_lathe(folder / "ball.obj", numpy.stack([-numpy.cos(angles), numpy.sin(angles)], 1) * BALL_RADIUS, 40)
    write_floor(folder / "alley.obj", 1.2, 3.2, -1.6)
    write_png(folder / "wood.png", wood(random))
    write_png(folder / "label.png", label())
    write_png(folder / "scuffs.png", scuffs(random))
    clouds = sum(noise(random, 512, 512, n, n) * w for n, w in ((4, 0.5), (12, 0.3), (40, 0.2)))
    write_png(folder / "dirt.png", numpy.clip(2.2 * (clouds - 0.45), 0, 1))


if __name__ == "__main__":
    main()
