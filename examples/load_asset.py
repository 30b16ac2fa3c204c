#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""load_asset.py FOLDER: relights three texels of a baked folder under two lights, the worked numbers of docs/format.md.

Written from that page alone: version 2, planes in pictures, one channel. Needs Pillow.
"""
import json, math, pathlib, sys
from PIL import Image
folder = pathlib.Path(sys.argv[1])
asset = json.loads((folder / "ranges.json").read_text())
unknown = set(asset.get("requires", [])) - {"albedo"}
if (asset["format"], asset["version"], asset["channels"], unknown) != ("kiln-prt", 2, 1, set()):
    sys.exit(f"cannot read {asset['format']} {asset['version']} of {asset['channels']} channels that requires {unknown}")
bands, top = asset["bands"], 2 ** asset["bits"] - 1

def basis(x, y, z):
    values, start, cosine, sine = [0.0] * bands**2, math.sqrt(1 / (4 * math.pi)), 1.0, 0.0
    for m in range(bands):
        if m > 0:
            start *= math.sqrt((2 if m == 1 else 1) * (2 * m + 1) / (2 * m))
            cosine, sine = x * cosine - y * sine, x * sine + y * cosine
        before, value = 0.0, start
        for l in range(m, bands):
            if l > m:
                a = math.sqrt((4 * l * l - 1) / (l * l - m * m))
                b = math.sqrt(((l - 1) ** 2 - m * m) / (4 * (l - 1) ** 2 - 1))
                before, value = value, a * (z * value - b * before)
            values[l * (l + 1) - m] = value * sine  # replaced by the next line where m is 0
            values[l * (l + 1) + m] = value * cosine
    return values

def directional(azimuth, elevation, colour):
    a, e = math.radians(azimuth), math.radians(elevation)
    values = basis(math.cos(e) * math.sin(a), math.sin(e), math.cos(e) * math.cos(a))
    clamped_cosine = [math.pi, 2 * math.pi / 3, math.pi / 4, 0, -math.pi / 24][:bands]
    window = [(1 + math.cos(math.pi * l / bands)) / 2 for l in range(bands)]
    facing = sum(w * c * (2 * l + 1) / (4 * math.pi) for l, (w, c) in enumerate(zip(window, clamped_cosine)))
    return [[level * math.pi * window[math.isqrt(i)] / facing * v for i, v in enumerate(values)] for level in colour]

def hemisphere(sky, ground):  # from +Y, whose coefficient of band 1 has index 1
    even, slope = math.sqrt(4 * math.pi), math.sqrt(4 * math.pi / 3)
    return [[(s + g) / 2 * even, (s - g) / 2 * slope] + [0.0] * (bands**2 - 2) for s, g in zip(sky, ground)]

def transfer(i, j):  # row j counts from the bottom, Pillow's from the top
    for plane in asset["planes"]:
        stored = Image.open(folder / plane["file"]).getpixel((i, asset["height"] - 1 - j))
        yield plane["min"] + stored / top * (plane["max"] - plane["min"])

def albedo(i, j):
    known = asset.get("albedo", [0.8, 0.8, 0.8])  # where it is left out, a grey of our choice
    encoded = Image.open(folder / known).getpixel((i, asset["height"] - 1 - j)) if isinstance(known, str) else ()
    return [((v / 255 + 0.055) / 1.055) ** 2.4 if v > 10 else v / 255 / 12.92 for v in encoded] or known

lights = {"directional:45,30,1,1,1": directional(45, 30, (1, 1, 1)),
          "hemisphere:0,90,0.4,0.6,1,0.2,0.1,0.05": hemisphere((0.4, 0.6, 1), (0.2, 0.1, 0.05))}
for texel in ((15, 13), (22, 13), (7, 20)):
    t = list(transfer(*texel))
    for name, light in lights.items():
        colour = [a * sum(map(lambda l, v: l * v, L, t)) for a, L in zip(albedo(*texel), light)]
        print(f"| {texel} | `{name}` | " + " | ".join(f"{value:.6f}" for value in colour) + " |")
