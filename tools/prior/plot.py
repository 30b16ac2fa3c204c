#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws docs/light-prior.csv: plot.py TABLE PICTURE"""
import csv
import math
import sys

from PIL import Image, ImageDraw, ImageFont

SCALE = 3  # drawn larger, then reduced
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 900, 560, 70, 190, 20, 55
LOWEST, LAST = 1e-4, 63  # of the plot: moment, band
COLOURS = {"photographed": (31, 119, 180), "sun and sky": (214, 110, 20), "studio": (44, 150, 60)}


def font(size):
    return ImageFont.truetype("DejaVuSans.ttf", size * SCALE)


def place(band, moment):
    """Returns the pixel of a point of the plot, both axes logarithmic."""
    x = LEFT + (WIDTH - LEFT - RIGHT) * math.log(band) / math.log(LAST)
    y = TOP + (HEIGHT - TOP - BOTTOM) * math.log(moment) / math.log(LOWEST)
    return (x * SCALE, y * SCALE)


def polyline(draw, values, colour, width, dashed=False):
    """Draws moments of bands 1 and up as far as they are in the plot."""
    points = [place(band, max(moment, 1e-12)) for band, moment in enumerate(values) if band > 0]
    floor = place(1, LOWEST)[1]
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if y0 >= floor:
            break
        if y1 > floor:
            x1, y1 = x0 + (x1 - x0) * (floor - y0) / (y1 - y0), floor
        pieces = max(1, round((x1 - x0) / (12 * SCALE))) if dashed else 1
        for k in range(pieces):
            draw.line([(x0 + (x1 - x0) * t / pieces, y0 + (y1 - y0) * t / pieces)
                       for t in (k, k + (0.6 if dashed else 1))], fill=colour, width=width * SCALE)


def main(table, picture):
    with open(table, encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    names, families, moments = rows[0][1:], rows[1][1:], [[float(v) for v in row[1:]] for row in rows[4:]]
    columns = list(zip(*moments))
    image = Image.new("RGB", (WIDTH * SCALE, HEIGHT * SCALE), "white")
    draw = ImageDraw.Draw(image)
    for exponent in range(0, -5, -1):
        draw.line([place(1, 10.0**exponent), place(LAST, 10.0**exponent)], fill=(220, 220, 220), width=SCALE)
        x, y = place(1, 10.0**exponent)
        draw.text((x - 8 * SCALE, y), f"{10.0 ** exponent:g}", fill="black", font=font(13), anchor="rm")
    for band in (1, 2, 4, 8, 16, 32, LAST):
        draw.line([place(band, 1), place(band, LOWEST)], fill=(220, 220, 220), width=SCALE)
        x, y = place(band, LOWEST)
        draw.text((x, y + 6 * SCALE), str(band), fill="black", font=font(13), anchor="ra" if band == LAST else "ma")
    draw.text((place(8, LOWEST)[0], (HEIGHT - 22) * SCALE), "band l", fill="black", font=font(13), anchor="ma")
    draw.text((place(1, 1)[0] + 6 * SCALE, place(1, 1)[1] + 4 * SCALE), "S_l / S_0", fill="black", font=font(13))

    for name, family, values in zip(names, families, columns):
        if family:
            polyline(draw, values, COLOURS[family], 1)
    former = [1 / (band + 1) ** 2 for band in range(len(moments))]
    polyline(draw, former, (130, 130, 130), 2, dashed=True)
    polyline(draw, columns[names.index("prior")], (0, 0, 0), 4)
    polyline(draw, columns[names.index("mean")], (255, 60, 60), 1)

    # Labels at the right end, moved apart where lines end beside one another.
    labels = [(values[LAST], name, COLOURS[family]) for name, family, values in zip(names, families, columns) if family]
    labels += [(columns[names.index("prior")][LAST], "prior (red: mean)", (0, 0, 0)),
               (former[LAST], "(l + 1)^-2, until now", (110, 110, 110))]
    lowest = 0
    for value, name, colour in sorted(labels, reverse=True):
        x, y = place(LAST, max(value, 2.6 * LOWEST))
        y = max(y, lowest)
        draw.text((x + 8 * SCALE, y), name, fill=colour, font=font(12), anchor="lm")
        lowest = y + 14 * SCALE
    image.resize((WIDTH, HEIGHT), Image.LANCZOS).save(picture, optimize=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
