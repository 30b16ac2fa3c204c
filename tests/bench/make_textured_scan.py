# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes a scan with a texture of a mesh without one: scan.obj, scan.mtl and scan.png (2,048 x 2,048) in FOLDER.

    python3 tests/bench/make_textured_scan.py BIN MESH FOLDER

BIN is the folder of Kiln's programs: kiln-atlas cuts and packs the charts of all triangles, kiln-normals says which
point of the surface each texel stands for. The texture is a pattern in space (checks and waves of several lengths), so
it has no seams of its own. Needs Debian's draco (draco_decoder), openimageio-tools, python3-numpy and python3-pil.
"""

import subprocess
import sys

import numpy
from PIL import Image


def main():
    programs, mesh, folder = sys.argv[1:]

    def run(*command):
        subprocess.run(command, check=True)

    run(f"{programs}/kiln-simplify", mesh, "-o", f"{folder}/low.drc", "--faces", "100000000", "--drop-components", "0")
    run(f"{programs}/kiln-atlas", f"{folder}/low.drc", "-o", f"{folder}/atlas.drc", "--size", "2048", "--gutter", "8")
    run(f"{programs}/kiln-normals", mesh, f"{folder}/atlas.drc", "-o", f"{folder}/normals")
    run("draco_decoder", "-i", f"{folder}/atlas.drc", "-o", f"{folder}/scan.obj")
    axes = []
    for axis in "012":  # into the range that a PNG has
        picture = f"{folder}/axis.png"
        run("oiiotool", f"{folder}/normals/position.exr", "--ch", axis, "--mulc", "0.25", "--addc", "0.5", "-d", "uint16",
            "-o", picture)
        axes.append(4 * (numpy.asarray(Image.open(picture)) / 65535 - 0.5))
    x, y, z = axes / numpy.abs(axes).max()
    red = 0.5 + 0.25 * numpy.sin(40 * x) + 0.25 * numpy.sin(97 * y + 3 * numpy.sin(11 * z))
    green = 0.2 + 0.6 * ((numpy.floor(20 * x) + numpy.floor(20 * y) + numpy.floor(20 * z)) % 2)
    blue = 0.5 + 0.5 * numpy.sin(60 * (x + 0.7 * y + 0.4 * z))
    colors = numpy.clip(numpy.stack([red, green, blue], -1), 0, 1)
    Image.fromarray((255 * colors).astype("u1")).save(f"{folder}/scan.png")
    with open(f"{folder}/scan.mtl", "w") as materials:
        materials.write("newmtl scan\nKd 1 1 1\nmap_Kd scan.png\n")
    with open(f"{folder}/scan.obj") as scan:
        text = scan.read()
    with open(f"{folder}/scan.obj", "w") as scan:
        scan.write("mtllib scan.mtl\nusemtl scan\n" + text)


if __name__ == "__main__":
    main()
