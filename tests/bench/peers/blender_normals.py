# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's selected-to-active normal bake beside kiln-normals, same atlas, size and samples; prints Markdown rows.

    python3 tests/bench/peers/blender_normals.py BENCH_NORMALS HIGH ATLAS.drc [--size 512] [--samples 1 64]

BENCH_NORMALS is the program bench_normals; ATLAS.drc lies in an asset's folder, beside simplify.json. Runs Blender
(package blender) as `blender -b --python` with this same file. Blender's time is that of bpy.ops.object.bake alone, the
best of the repeats; so is ours, that of make_normals without metrics. Both maps are measured by `bench_normals measure`.
CPU seconds are of all threads.
"""

import json
import os
import resource
import subprocess
import sys
import tempfile
import time


def inside_blender(arguments):
    import bpy

    folder, size, samples, cage, repeat = arguments[0], int(arguments[1]), int(arguments[2]), float(arguments[3]), int(arguments[4])
    bpy.ops.wm.read_factory_settings(use_empty=True)

    def load(name):
        # Keeps the axes: object space is that of the file.
        bpy.ops.wm.obj_import(filepath=os.path.join(folder, name), forward_axis="Y", up_axis="Z")
        loaded = bpy.context.selected_objects[0]
        for polygon in loaded.data.polygons:
            polygon.use_smooth = True
        return loaded

    high, low = load("high.obj"), load("low.obj")
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_denoising = False
    scene.cycles.use_adaptive_sampling = False
    image = bpy.data.images.new("normal", size, size, float_buffer=True, is_data=True)
    material = bpy.data.materials.new("baked")
    material.use_nodes = True
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    material.node_tree.nodes.active = node
    low.data.materials.clear()
    low.data.materials.append(material)
    bpy.ops.object.select_all(action="DESELECT")
    high.select_set(True)
    low.select_set(True)
    bpy.context.view_layer.objects.active = low

    best, best_cpu = 1e9, 1e9
    for _ in range(repeat):
        start, cpu = time.perf_counter(), time.process_time()
        bpy.ops.object.bake(type="NORMAL", normal_space="OBJECT", normal_r="POS_X", normal_g="POS_Y", normal_b="POS_Z",
                            use_selected_to_active=True, cage_extrusion=cage, margin=4, use_clear=True)
        best, best_cpu = min(best, time.perf_counter() - start), min(best_cpu, time.process_time() - cpu)
    image.file_format = "OPEN_EXR"
    image.filepath_raw = os.path.join(folder, "blender.exr")
    image.save()
    with open(os.path.join(folder, "blender.json"), "w") as out:
        json.dump({"seconds": best, "cpu": best_cpu, "version": bpy.app.version_string}, out)


def run(command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def main(arguments):
    import argparse

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench")
    parser.add_argument("high")
    parser.add_argument("atlas")
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--samples", type=int, nargs="+", default=[1, 64])
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--fit", action="store_true", help="kiln-normals --fit")
    parser.add_argument("--cage", type=float, help="Blender's extrusion, object units (default: Kiln's cage)")
    options = parser.parse_args(arguments)
    print("| samples | baker | seconds | CPU seconds | mean, degrees | 95 % | seams, mean | seams, largest |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        run([options.bench, "export", options.high, options.atlas, folder])
        for samples in options.samples:
            ours = os.path.join(folder, "kiln.png")
            bake = [options.bench, "bake", options.high, options.atlas, ours, "--size", str(options.size), "--samples",
                    str(samples), "--repeat", str(options.repeat), *(["--fit"] if options.fit else [])]
            kiln = json.loads(run(bake))
            cage = options.cage or kiln["cage_distance"]
            subprocess.run(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python", __file__, "--",
                            folder, str(options.size), str(samples), str(cage), str(options.repeat)], check=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            with open(os.path.join(folder, "blender.json")) as result:
                blender = json.load(result)
            for name, seconds, cpu, file in [
                    ("kiln-normals", kiln["seconds"], kiln["cpu_seconds"], ours),
                    ("Blender " + blender["version"], blender["seconds"], blender["cpu"], os.path.join(folder, "blender.exr"))]:
                error = json.loads(run([options.bench, "measure", options.high, options.atlas, file]))
                print(f"| {samples} | {name} | {seconds:.3f} | {cpu:.3f} | {error['mean']:.3f} | {error['p95']:.3f} | "
                      f"{error['seam_mean']:.3f} | {error['seam_max']:.2f} |")


if "--" in sys.argv:
    inside_blender(sys.argv[sys.argv.index("--") + 1:])
else:
    main(sys.argv[1:])
