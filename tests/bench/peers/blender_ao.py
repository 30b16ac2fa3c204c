# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's selected-to-active bake of ambient occlusion beside kiln-bake, same atlas and size; prints Markdown.

    python3 tests/bench/peers/blender_ao.py BENCH_AO KILN_BAKE HIGH ASSET [--samples 16 64 256] [--directions 64 256 1024]

BENCH_AO is the program bench_ao, KILN_BAKE kiln-bake; ASSET is a folder of `kiln build` of HIGH (atlas.drc, normals/).
Runs Blender (package blender) as `blender -b --python` with this same file. A baker's seconds are those of the whole
command as a user runs it, from the start of the program to the file, the least of --repeat; CPU seconds are of all
threads. Cycles' own time, that of bpy.ops.object.bake alone, stands beside.

Errors are root mean squares over the covered texels, relative to the reference's: against kiln-bake's Embree backend of
--reference directions, and against Cycles' own bake of --blender-reference samples, so that the reference is nobody's
own. How far these two are apart is printed too: it is what the bakers do not agree on, whatever the samples. Cycles
shoots its receivers along the low mesh's normals, with a margin that fills the gutter; Kiln's are those of
kiln-normals. --seams keep and --buried keep leave kiln-bake's texels as they were integrated, as Cycles' are.
At equal error: a baker's error goes with a power of its samples, fitted to those measured against its own reference,
and time is linear in them; from both follows the time that an error takes.
"""

import json
import math
import os
import resource
import subprocess
import sys
import tempfile
import time


def inside_blender(arguments):
    import bpy

    folder, size, samples, cage, name = arguments[0], int(arguments[1]), int(arguments[2]), float(arguments[3]), arguments[4]
    seed = 1 if name == "reference" else 0  # the samples of a map must differ from the reference's
    bpy.ops.wm.read_factory_settings(use_empty=True)

    def load(file):
        # Keeps the axes: object space is that of the file. Normals are the file's.
        bpy.ops.wm.obj_import(filepath=os.path.join(folder, file), forward_axis="Y", up_axis="Z")
        return bpy.context.selected_objects[0]

    high, low = load("high.obj"), load("low.obj")
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("world")
    scene.world.light_settings.distance = 1000 * max(high.dimensions)  # practically unlimited
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.seed = seed
    scene.cycles.use_denoising = False
    scene.cycles.use_adaptive_sampling = False
    image = bpy.data.images.new("ao", size, size, float_buffer=True, is_data=True)
    material = bpy.data.materials.new("baked")
    material.use_nodes = True
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    material.node_tree.nodes.active = node
    low.data.materials.clear()
    low.data.materials.append(material)
    # Hides the low mesh from rays: it would cover the high one.
    for kind in ("visible_diffuse", "visible_shadow", "visible_transmission", "visible_glossy"):
        setattr(low, kind, False)
    bpy.ops.object.select_all(action="DESELECT")
    high.select_set(True)
    low.select_set(True)
    bpy.context.view_layer.objects.active = low
    start = time.perf_counter()
    bpy.ops.object.bake(type="AO", use_selected_to_active=True, cage_extrusion=cage, margin=4, use_clear=True)
    seconds = time.perf_counter() - start
    image.file_format = "OPEN_EXR"
    image.filepath_raw = os.path.join(folder, name + ".exr")
    image.save()
    with open(os.path.join(folder, name + ".json"), "w") as out:
        json.dump({"bake_seconds": seconds, "version": bpy.app.version_string}, out)


def timed(command):
    """Wall and CPU seconds of a command."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{command[0]} ended with status {done.returncode}:\n{done.stderr[-2000:]}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.perf_counter() - start, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def fitted_line(xs, ys):
    """Slope and constant of the line of least squares."""
    mean_x, mean_y = sum(xs) / len(xs), sum(ys) / len(ys)
    slope = sum((x - mean_x) * (y - mean_y) for x, y in zip(xs, ys)) / sum((x - mean_x) ** 2 for x in xs)
    return slope, mean_y - slope * mean_x


def seconds_at(error, rows):
    """Wall and CPU seconds in which a baker comes to an error, and its samples. Rows: samples, error, wall, CPU."""
    power, constant = fitted_line([math.log(r[0]) for r in rows], [math.log(r[1]) for r in rows])
    samples = math.exp((math.log(error) - constant) / power)
    times = []
    for column in (2, 3):
        each, start = fitted_line([r[0] for r in rows], [r[column] for r in rows])
        times.append(max(start + each * samples, 0))
    return samples, times[0], times[1]


def main(arguments):
    import argparse

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench")
    parser.add_argument("kiln_bake")
    parser.add_argument("high")
    parser.add_argument("asset")
    parser.add_argument("--samples", type=int, nargs="+", default=[16, 64, 256], help="of Cycles")
    parser.add_argument("--directions", type=int, nargs="+", default=[64, 256, 1024], help="of kiln-bake")
    parser.add_argument("--backend", default="beams", help="of kiln-bake")
    parser.add_argument("--reference", type=int, default=16384, help="directions by Embree")
    parser.add_argument("--reference-folder", help="one that was baked before, in place of that")
    parser.add_argument("--blender-reference", type=int, default=1024, help="samples by Cycles")
    parser.add_argument("--at", type=float, default=0.005, help="the error to compare times at")
    parser.add_argument("--repeat", type=int, default=1)
    options = parser.parse_args(arguments)

    atlas, normals = os.path.join(options.asset, "atlas.drc"), os.path.join(options.asset, "normals")
    with open(os.path.join(normals, "normals.json")) as record:
        normals_record = json.load(record)
    size, cage = normals_record["width"], normals_record["cage_distance"]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([options.bench, "export", options.high, atlas, folder], check=True)

        def kiln(directions, name, backend):
            output = os.path.join(folder, name)
            times = [timed([options.kiln_bake, atlas, "--detail", normals, "--occluder", options.high, "-o", output,
                            "--bands", "1", "--bits", "16", "--directions", str(directions), "--seams", "keep",
                            "--buried", "keep", "--backend", backend, "--quiet"]) for _ in range(options.repeat)]
            with open(os.path.join(output, "bake.json")) as record:
                return output, min(times), json.load(record)["seconds"]

        def blender(samples, name):
            times = [timed(["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python", __file__, "--",
                            folder, str(size), str(samples), str(cage), name]) for _ in range(options.repeat)]
            with open(os.path.join(folder, name + ".json")) as result:
                return os.path.join(folder, name + ".exr"), min(times), json.load(result)

        def errors(reference, maps):
            lines = subprocess.run([options.bench, "compare", reference, *maps], check=True, capture_output=True,
                                   text=True).stdout.splitlines()
            return [json.loads(line) for line in lines]

        cycles_reference, cycles_times, information = blender(options.blender_reference, "reference")
        reference = options.reference_folder or kiln(options.reference, "reference", "embree")[0]
        between = errors(reference, [cycles_reference])[0]
        print(f"{between['texels']} covered texels of {size} x {size}; Blender {information['version']}. Between the "
              f"references: {100 * between['error']:.2f} %, {100 * between['error_of_99']:.2f} % without the worst "
              f"hundredth of the texels; on average Cycles sees {100 * between['mean_difference']:+.2f} % of the sky more.")
        print()
        print("| baker | samples | seconds | CPU s | bake alone | error, Embree's reference | Cycles' reference |")
        print("| --- | --- | --- | --- | --- | --- | --- |")
        own = {}
        for name, counts in (("kiln-bake", options.directions), ("Blender", options.samples)):
            own[name] = []
            for count in counts:
                if name == "Blender":
                    file, (wall, cpu), result = blender(count, "map")
                    alone = result["bake_seconds"]
                else:
                    file, (wall, cpu), alone = kiln(count, "map", options.backend)
                by_embree = errors(reference, [file])[0]["error"]
                by_cycles = errors(reference, [file, "--against", cycles_reference])[0]["error"]
                own[name].append((count, by_cycles if name == "Blender" else by_embree, wall, cpu))
                print(f"| {name} | {count} | {wall:.2f} | {cpu:.2f} | {alone:.2f} | {100 * by_embree:.2f} % | "
                      f"{100 * by_cycles:.2f} % |", flush=True)
        print()
        if min(len(options.samples), len(options.directions)) < 2:
            return
        at = {name: seconds_at(options.at, rows) for name, rows in own.items()}
        for name, (samples, wall, cpu) in at.items():
            print(f"{name} comes within {100 * options.at:g} % of its own reference with {samples:.0f} samples, in "
                  f"{wall:.2f} s ({cpu:.2f} CPU s).")
        ratio = at["Blender"][1] / at["kiln-bake"][1]
        print(f"At {100 * options.at:g} % kiln-bake is {ratio:.1f} times as fast ({at['Blender'][2] / at['kiln-bake'][2]:.1f} "
              f"in CPU seconds); 100 times would take a bake of {at['Blender'][1] / 100:.2f} s.")


if "--" in sys.argv:
    inside_blender(sys.argv[sys.argv.index("--") + 1:])
else:
    main(sys.argv[1:])
