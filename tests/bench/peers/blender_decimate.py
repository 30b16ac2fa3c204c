# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Decimate modifier (collapse) beside kiln-simplify; prints Markdown rows.

    python3 tests/bench/peers/blender_decimate.py BENCH_SIMPLIFY HIGH.obj [--faces 5000 1000 500] [--repeat 3]

BENCH_SIMPLIFY is the program bench_simplify, which measures the results. Runs Blender (package blender) as
`blender -b --python` with this same file. Its time is that of evaluating the modifier, the best of the repeats.
"""

import os
import subprocess
import sys
import tempfile
import time


def inside_blender(arguments):
    import bpy

    high_file, folder, repeat = arguments[0], arguments[1], int(arguments[2])
    for faces in map(int, arguments[3:]):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.wm.obj_import(filepath=high_file, forward_axis="Y", up_axis="Z")
        high = bpy.context.selected_objects[0]
        best = 1e9
        for _ in range(repeat):
            high.modifiers.clear()
            decimate = high.modifiers.new("decimate", "DECIMATE")
            decimate.ratio = faces / len(high.data.polygons)
            start = time.process_time()
            bpy.context.view_layer.update()
            evaluated = high.evaluated_get(bpy.context.evaluated_depsgraph_get())
            low = evaluated.to_mesh()
            best = min(best, time.process_time() - start)
            with open(os.path.join(folder, f"{faces}.obj"), "w") as file:
                for vertex in low.vertices:
                    file.write("v %.9g %.9g %.9g\n" % tuple(vertex.co))
                for polygon in low.polygons:
                    file.write("f %d %d %d\n" % tuple(v + 1 for v in polygon.vertices))
            evaluated.to_mesh_clear()
        print(f"SECONDS {faces} {best:.3f}")


def main():
    arguments = sys.argv[1:]
    options = {"--faces": ["5000", "1000", "500"], "--repeat": ["3"]}
    plain, current = [], None
    for argument in arguments:
        if argument in options:
            current = options[argument] = []
        elif current is not None:
            current.append(argument)
        else:
            plain.append(argument)
    bench, high = plain
    with tempfile.TemporaryDirectory() as folder:
        command = ["blender", "-b", "--python", __file__, "--", os.path.abspath(high), folder, options["--repeat"][0]]
        output = subprocess.run(command + options["--faces"], check=True, capture_output=True, text=True).stdout
        for line in output.splitlines():
            if not line.startswith("SECONDS"):
                continue
            _, faces, seconds = line.split()
            row = subprocess.run([bench, "--measure", high, os.path.join(folder, faces + ".obj")], check=True,
                                 capture_output=True, text=True).stdout
            print("| Blender Decimate |" + row.split("|", 2)[2].replace(" 0.000 | 0.000 |", f" {seconds} | |"), end="")


if "--" in sys.argv:
    inside_blender(sys.argv[sys.argv.index("--") + 1:])
else:
    main()
