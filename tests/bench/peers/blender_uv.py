# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Smart UV Project beside kiln-atlas, on the same low meshes; prints Markdown rows.

    python3 tests/bench/peers/blender_uv.py BENCH_ATLAS LOW.obj... [--size 1024] [--gutter 4] [--repeat 3]

BENCH_ATLAS is the program bench_atlas, which measures the results. Runs Blender (package blender) as
`blender -b --python` with this same file. Its time is that of bpy.ops.uv.smart_project (angle limit 66 degrees), the
best of the repeats. The island margin is the least, in halves of a texel, that leaves the gutter between two islands
and at the border, so that Blender has as many texels as it can.
"""

import os
import subprocess
import sys
import tempfile
import time


def inside_blender(arguments):
    import math

    import bpy

    low_file, uv_file, margin, repeat = arguments[0], arguments[1], float(arguments[2]), int(arguments[3])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.obj_import(filepath=low_file, forward_axis="Y", up_axis="Z")
    low = bpy.context.selected_objects[0]
    bpy.context.view_layer.objects.active = low
    best, best_cpu = 1e9, 1e9
    for _ in range(repeat):
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        start, cpu = time.perf_counter(), time.process_time()
        bpy.ops.uv.smart_project(angle_limit=math.radians(66), island_margin=margin, area_weight=0,
                                 correct_aspect=True, scale_to_bounds=False)
        best, best_cpu = min(best, time.perf_counter() - start), min(best_cpu, time.process_time() - cpu)
        bpy.ops.object.mode_set(mode="OBJECT")
    with open(uv_file, "w") as file:
        for vertex in low.data.vertices:
            file.write("v %.9g %.9g %.9g\n" % tuple(vertex.co))
        for corner in low.data.uv_layers.active.data:
            file.write("vt %.9g %.9g\n" % tuple(corner.uv))
        for polygon in low.data.polygons:
            corners = zip(polygon.vertices, polygon.loop_indices)
            file.write("f " + " ".join("%d/%d" % (v + 1, c + 1) for v, c in corners) + "\n")
    print(f"SECONDS {best:.3f} {best_cpu:.3f}")


def main():
    arguments = sys.argv[1:]
    options = {"--size": "1024", "--gutter": "4", "--repeat": "3"}
    plain = []
    while arguments:
        argument = arguments.pop(0)
        if argument in options:
            options[argument] = arguments.pop(0)
        else:
            plain.append(argument)
    bench, lows = plain[0], plain[1:]
    with tempfile.TemporaryDirectory() as folder:
        for low in lows:
            unwrapped = os.path.join(folder, "unwrapped.obj")
            for halves in range(2 * int(options["--gutter"]), 40):
                margin = halves / 2 / float(options["--size"])
                output = subprocess.run(["blender", "-b", "--python", __file__, "--", os.path.abspath(low), unwrapped,
                                         str(margin), options["--repeat"]], check=True, capture_output=True, text=True)
                seconds = next(line.split()[1:] for line in output.stdout.splitlines() if line.startswith("SECONDS"))
                row = subprocess.run([bench, "--measure", unwrapped, "--size", options["--size"], "--name",
                                      f"Blender Smart UV, margin {margin:.5f}", "--seconds", seconds[0],
                                      "--cpu-seconds", seconds[1]], check=True, capture_output=True, text=True).stdout
                if int(row.split("|")[-3]) >= int(options["--gutter"]):
                    break
            print(row.replace("unwrapped.obj", low), end="")


if "--" in sys.argv:
    inside_blender(sys.argv[sys.argv.index("--") + 1:])
else:
    main()
