#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""make_meshes.py FOLDER: writes the meshes of samples/strike-assets.yaml (metres, +Y up), the same on every machine.

pin.obj and ball.obj are lathes; alley.obj is the lane with its gutters, the pit behind the pins and the boards beside
them, and alley_low.obj the same surface with a vertex wherever light is to be computed. Colours are those of vertices.
"""
import math
import pathlib
import sys

INCH = 0.0254
# Heights and diameters of a pin, inches: equipment specifications of the United States Bowling Congress.
PIN = [(0, 2.031), (0.75, 2.828), (2.25, 3.906), (3.375, 4.510), (4.5, 4.766), (5.875, 4.563), (7.25, 3.703),
       (8.625, 2.472), (9.375, 1.965), (10, 1.797), (10.875, 1.870), (11.75, 2.094), (12.625, 2.406), (13.5, 2.547)]
PIN_HEIGHT, HEAD_RADIUS = 15 * INCH, 1.273 * INCH
BALL_RADIUS = 8.5 / 2 * INCH
# The alley: half width of the lane, radius of a gutter, where the boards beside the pins stand, and along z the
# beginning of the lane, its end, the wall behind the pit, and the front of the boards.
LANE, GUTTER, SIDE = 20.75 * INCH, 4.625 * INCH, 0.86
BEGIN, END, WALL, BOARDS = 2.6, -1.1, -1.9, 0.35
PIT_DEPTH, WALL_HEIGHT, BOARD_HEIGHT, BOARD_WIDTH = 0.25, 0.55, 0.42, 0.04


def pin_radius(height):
    """Radius of a pin at a height, metres: a monotone cubic through the specification, and a round head."""
    y = height / INCH
    top = 15 - 1.273
    if y >= top:
        return INCH * math.sqrt(max(0, 1.273**2 - (y - top)**2))
    points = [(h, d / 2) for h, d in PIN] + [(top, 1.273)]
    slopes = []
    for k in range(len(points)):
        if k in (0, len(points) - 1):
            j = min(k, len(points) - 2)
            slopes.append(0.0 if k else (points[1][1] - points[0][1]) / (points[1][0] - points[0][0]))
            continue
        a = (points[k][1] - points[k - 1][1]) / (points[k][0] - points[k - 1][0])
        b = (points[k + 1][1] - points[k][1]) / (points[k + 1][0] - points[k][0])
        slopes.append(0.0 if a * b <= 0 else 2 * a * b / (a + b))
    for k in range(len(points) - 1):
        (x0, y0), (x1, y1) = points[k], points[k + 1]
        if y <= x1:
            t, width = (y - x0) / (x1 - x0), x1 - x0
            return INCH * (y0 * (1 + 2 * t) * (1 - t)**2 + slopes[k] * width * t * (1 - t)**2 + y1 * t * t * (3 - 2 * t) +
                           slopes[k + 1] * width * t * t * (t - 1))
    raise ValueError(height)


class Mesh:
    def __init__(self):
        self.vertices, self.faces = [], []

    def vertex(self, x, y, z, color):
        self.vertices.append((x, y, z, *color))
        return len(self.vertices)

    def quad(self, a, b, c, d):
        self.faces += [(a, b, c), (a, c, d)]

    def write(self, file, with_colors):
        lines = [f"# made by {pathlib.Path(__file__).name}"]
        form = "v %.6f %.6f %.6f" + (" %.3f %.3f %.3f" if with_colors else "")
        lines += [form % (vertex if with_colors else vertex[:3]) for vertex in self.vertices]
        lines += ["f %d %d %d" % face for face in self.faces]
        file.write_text("\n".join(lines) + "\n")


def lathe(profile, sides, color):
    """A closed solid: `profile` is (radius, height) from bottom to top, whose first and last radius are 0."""
    mesh = Mesh()
    bottom = mesh.vertex(0, profile[0][1], 0, color(0, 0, profile[0][1]))
    rings = []
    for radius, height in profile[1:-1]:
        ring = []
        for k in range(sides):
            angle = 2 * math.pi * k / sides
            ring.append(mesh.vertex(radius * math.sin(angle), height, radius * math.cos(angle), color(k, radius, height)))
        rings.append(ring)
    top = mesh.vertex(0, profile[-1][1], 0, color(0, 0, profile[-1][1]))
    for k in range(sides):
        n = (k + 1) % sides
        mesh.faces += [(bottom, rings[0][n], rings[0][k]), (top, rings[-1][k], rings[-1][n])]
        for low, high in zip(rings, rings[1:]):
            mesh.quad(low[k], low[n], high[n], high[k])
    return mesh


def pin():
    heights = [PIN_HEIGHT * k / 96 for k in range(97)]
    profile = [(0, 0)] + [(pin_radius(h), h) for h in heights[:-1]] + [(0, PIN_HEIGHT)]

    def color(_side, _radius, height):
        stripe = any(low < height / INCH < high for low, high in [(9.3, 9.9), (10.5, 11.1)])
        return (0.62, 0.03, 0.04) if stripe else (0.93, 0.92, 0.88)

    return lathe(profile, 64, color)


def ball():
    rings, sides = 64, 96
    angles = [math.pi * k / rings for k in range(rings + 1)]
    profile = [(BALL_RADIUS * math.sin(a), -BALL_RADIUS * math.cos(a)) for a in angles]
    profile[0], profile[-1] = (0, -BALL_RADIUS), (0, BALL_RADIUS)

    def color(side, radius, height):
        # Two bands that cross, so that one sees it roll.
        x = radius * math.sin(2 * math.pi * side / sides) / BALL_RADIUS
        return (0.9, 0.75, 0.2) if abs(x) < 0.13 or abs(height / BALL_RADIUS) < 0.13 else (0.05, 0.12, 0.42)

    return lathe(profile, sides, color)


def board_color(k):
    shade = 0.86 + 0.14 * math.sin(12.9898 * k) * math.cos(4.1 * k)
    return (0.80 * shade, 0.58 * shade, 0.33 * shade)


def cross_section(lane_parts, gutter_parts):
    """From left to right: (x, y, board), board counted across the lane, -1 elsewhere; boards meet in two points."""
    points = [(-SIDE, 0, -1)]
    middle = LANE + GUTTER
    for side in (-1, 1):
        arc = []
        for k in range(gutter_parts + 1):
            angle = math.pi * k / gutter_parts
            arc.append((round(side * middle - GUTTER * math.cos(angle), 6), round(-GUTTER * math.sin(angle), 6) + 0.0, -1))
        if side < 0:
            points += arc
            for k in range(lane_parts):
                points += [(round(-LANE + 2 * LANE * j / lane_parts, 6), 0, k) for j in (k, k + 1)]
        else:
            points += arc
    return points + [(SIDE, 0, -1)]


def strip(mesh, section, stations, place, color):
    """Joins the points of a section, from one station to the next; facing up or forwards where both rise."""
    rows = [[mesh.vertex(*place(point, s), color(point)) for point in section] for s in stations]
    for low, high in zip(rows, rows[1:]):
        for k in range(len(section) - 1):
            if section[k][:2] != section[k + 1][:2]:
                mesh.quad(low[k], low[k + 1], high[k + 1], high[k])


def spaced(first, last, parts):
    return [first + (last - first) * k / parts for k in range(parts + 1)]


def alley(is_low):
    mesh = Mesh()
    grey, dark, side = (0.25, 0.25, 0.27), (0.12, 0.12, 0.13), (0.45, 0.32, 0.2)
    section = cross_section(22 if is_low else 39, 6 if is_low else 16)
    if is_low:  # boards share their vertices
        section = [point for k, point in enumerate(section) if k == 0 or point[:2] != section[k - 1][:2]]
    # Fine where the pins stand, coarser towards the player.
    stations = spaced(BEGIN, 0.6, 24 if is_low else 20)[:-1] + spaced(0.6, END, 36 if is_low else 20)
    strip(mesh, section, stations, lambda p, z: (p[0], p[1], z), lambda p: board_color(p[2]) if p[2] >= 0 else grey)
    # The pit: down, back, and up the wall.
    down = [(END, -GUTTER - 0.02, 0), (END, -PIT_DEPTH, 0)] + [(z, -PIT_DEPTH, 0) for z in spaced(END, WALL, 5)[1:]]
    down += [(WALL, y, 0) for y in spaced(-PIT_DEPTH, WALL_HEIGHT, 6)[1:]]
    strip(mesh, down, spaced(SIDE, -SIDE, 12), lambda p, x: (x, p[1], p[0]), lambda p: dark)
    for sign in (-1, 1):
        outer = SIDE + BOARD_WIDTH
        board = [(SIDE, y, 0) for y in spaced(-PIT_DEPTH, BOARD_HEIGHT, 4)] + [(outer, BOARD_HEIGHT, 0), (outer, -PIT_DEPTH, 0)]
        stations = spaced(BOARDS, WALL, 14)
        strip(mesh, board, stations if sign > 0 else stations[::-1],
              lambda p, z, sign=sign: (sign * p[0], p[1], z), lambda p: side)
        corners = [mesh.vertex(sign * x, y, BOARDS, side) for x, y in
                   [(SIDE, -PIT_DEPTH), (outer, -PIT_DEPTH), (outer, BOARD_HEIGHT), (SIDE, BOARD_HEIGHT)]]
        mesh.quad(*(corners if sign > 0 else corners[::-1]))
    return mesh


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, mesh in [("pin", pin()), ("ball", ball()), ("alley", alley(False)), ("alley_low", alley(True))]:
        mesh.write(folder / f"{name}.obj", with_colors=name != "alley_low")
        print(f"{name}.obj: {len(mesh.vertices)} vertices, {len(mesh.faces)} triangles")


if __name__ == "__main__":
    main()
