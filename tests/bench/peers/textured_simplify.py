# SPDX-License-Identifier: GPL-3.0-or-later
"""kiln-simplify --keep uv beside gltfpack and Blender's Decimate, of a scan with a texture; prints Markdown rows.

    python3 tests/bench/peers/textured_simplify.py BIN SCAN.obj TEXTURE.png GLTFPACK [--faces 10000 5000 2500]

BIN is the folder of Kiln's programs, GLTFPACK the cli.js of npm's gltfpack. Needs Debian's blender, draco
(draco_decoder), python3-numpy and python3-pil. Each tool is asked for the same number of triangles and runs as its
users run it: gltfpack with `-si` and no limit of error, plain and with attributes (`-sv`); Blender's modifier by
collapse. Distances are those that kiln-simplify --low measures. The error of the picture is that of Cycles renders of
the textured mesh without light (emission), orthographic, from six sides: the root mean square of differences over the
pixels that the scan covers, of 255. CPU seconds are those of the whole command, Blender's of the modifier alone.
"""

import json
import math
import os
import resource
import subprocess
import sys
import tempfile

SIDES = [(0, 0), (90, 0), (180, 0), (270, 0), (0, 90), (45, 30)]  # azimuth and elevation, degrees
PIXELS = 512


def import_mesh(bpy, file):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if file.endswith(".glb"):
        import numpy

        numpy.bool = bool  # Debian's Blender 3.4 asks for the name that NumPy 1.24 took away
        bpy.ops.import_scene.gltf(filepath=file)
    else:
        bpy.ops.wm.obj_import(filepath=file, forward_axis="Y", up_axis="Z")
    return [o for o in bpy.data.objects if o.type == "MESH"][0]


def write_obj(mesh, file, turn):
    """Writes positions and uvs; `turn` maps Blender's axes to the file's."""
    uvs = mesh.uv_layers[0].data
    with open(file, "w") as out:
        for vertex in mesh.vertices:
            out.write("v %.9g %.9g %.9g\n" % turn(vertex.co))
        for uv in uvs:
            out.write("vt %.9g %.9g\n" % tuple(uv.uv))
        mesh.calc_loop_triangles()
        for triangle in mesh.loop_triangles:
            out.write("f " + " ".join(f"{v + 1}/{c + 1}" for v, c in zip(triangle.vertices, triangle.loops)) + "\n")


def decimate(bpy, scan, faces, file):
    import time

    mesh = import_mesh(bpy, scan)
    modifier = mesh.modifiers.new("decimate", "DECIMATE")
    modifier.ratio = faces / len(mesh.data.polygons)
    start = time.process_time()
    bpy.context.view_layer.update()
    low = mesh.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    print(f"SECONDS {time.process_time() - start:.3f}")
    write_obj(low, file, lambda p: tuple(p))


def convert(bpy, glb, file):
    mesh = import_mesh(bpy, glb)
    place = mesh.matrix_world

    def turn(point):
        world = place @ point  # glTF's importer turns +Y up to +Z up
        return (world.x, world.z, -world.y)

    write_obj(mesh.data, file, turn)


def render(bpy, texture, size, centre, jobs):
    """Renders each mesh of `jobs`, pairs of an OBJ file and the stem of its pictures."""
    from mathutils import Matrix, Vector

    for file, stem in jobs:
        mesh = import_mesh(bpy, file)
        material = bpy.data.materials.new("texture")
        material.use_nodes = True
        nodes, links = material.node_tree.nodes, material.node_tree.links
        nodes.clear()
        image = nodes.new("ShaderNodeTexImage")
        image.image = bpy.data.images.load(texture)
        image.image.colorspace_settings.name = "Non-Color"
        emission, output = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
        links.new(image.outputs["Color"], emission.inputs["Color"])
        links.new(emission.outputs["Emission"], output.inputs["Surface"])
        mesh.data.materials.clear()
        mesh.data.materials.append(material)
        scene = bpy.context.scene
        scene.render.engine = "CYCLES"
        scene.cycles.samples = 16
        scene.cycles.use_denoising = False
        scene.render.threads_mode, scene.render.threads = "FIXED", 2
        scene.render.resolution_x = scene.render.resolution_y = PIXELS
        scene.render.film_transparent = True
        scene.view_settings.view_transform = "Raw"
        scene.render.image_settings.color_mode = "RGBA"
        camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        camera.data.type, camera.data.ortho_scale = "ORTHO", size
        camera.data.clip_end = 10 * size
        scene.collection.objects.link(camera)
        scene.camera = camera
        for k, (azimuth, elevation) in enumerate(SIDES):
            a, e = math.radians(azimuth), math.radians(elevation)
            back = Vector((math.cos(e) * math.sin(a), math.sin(e), math.cos(e) * math.cos(a)))
            right = Vector((math.cos(a), 0, -math.sin(a)))
            up = back.cross(right)
            camera.matrix_world = Matrix.Translation(Vector(centre) + 2 * size * back) @ Matrix(
                (right, up, back)).transposed().to_4x4()
            scene.render.filepath = f"{stem}_{k}.png"
            bpy.ops.render.render(write_still=True)


def inside_blender(arguments):
    import bpy

    task = json.loads(arguments[0])
    globals()[task.pop("do")](bpy, **task)


def blender(**task):
    command = ["blender", "-b", "--python-exit-code", "1", "--python", __file__, "--", json.dumps(task)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def cpu_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def picture_error(stem, reference):
    import numpy
    from PIL import Image

    total = count = 0
    for k in range(len(SIDES)):
        seen, true = (numpy.asarray(Image.open(f"{s}_{k}.png"), dtype=float) for s in (stem, reference))
        shown = true[..., 3] > 0
        difference = (seen[..., :3] * seen[..., 3:] - true[..., :3] * true[..., 3:]) / 255
        total += (difference[shown] ** 2).sum()
        count += 3 * shown.sum()
    return math.sqrt(total / count)


def main():
    arguments = sys.argv[1:]
    at = arguments.index("--faces") if "--faces" in arguments else len(arguments)
    programs, scan, texture, gltfpack = (os.path.abspath(a) for a in arguments[:4])
    faces = [int(n) for n in arguments[at + 1:]] or [10000, 5000, 2500]
    points = [list(map(float, line.split()[1:4])) for line in open(scan) if line.startswith("v ")]
    lowest, highest = [min(c) for c in zip(*points)], [max(c) for c in zip(*points)]
    centre = [(a + b) / 2 for a, b in zip(lowest, highest)]
    size = 1.05 * max(b - a for a, b in zip(lowest, highest))
    triangles = sum(1 for line in open(scan) if line.startswith("f "))
    with tempfile.TemporaryDirectory() as folder:
        rows, jobs = [], [(scan, f"{folder}/scan")]
        for n in faces:
            ways = {
                "Kiln": ["--quality", "standard"],
                "Kiln, `--quality draft`": ["--quality", "draft"],
                "gltfpack": [],
                "gltfpack `-sv`": ["-sv"],
                "Blender": [],
            }
            for k, (name, options) in enumerate(ways.items()):
                mesh = f"{folder}/{n}_{k}.obj"
                if name.startswith("Kiln"):
                    drc = f"{folder}/{n}_{k}/low.drc"
                    os.mkdir(os.path.dirname(drc))
                    seconds = cpu_seconds([f"{programs}/kiln-simplify", scan, "-o", drc, "--keep", "uv", "--faces",
                                           str(n)] + options)
                    subprocess.run(["draco_decoder", "-i", drc, "-o", mesh], check=True, capture_output=True)
                elif name.startswith("gltfpack"):
                    glb = mesh.replace(".obj", ".glb")
                    seconds = cpu_seconds(["node", gltfpack, "-i", scan, "-o", glb, "-noq", "-se", "1", "-si",
                                           str(n / triangles)] + options)
                    blender(do="convert", glb=glb, file=mesh)
                else:
                    printed = blender(do="decimate", scan=scan, faces=n, file=mesh)
                    seconds = float(printed.split("SECONDS ")[1].split()[0])
                measured = f"{folder}/{n}_{k}_measured/low.drc"
                os.mkdir(os.path.dirname(measured))
                subprocess.run([f"{programs}/kiln-simplify", scan, "--low", mesh, "-o", measured], check=True,
                               capture_output=True)
                record = json.load(open(measured.replace("low.drc", "simplify.json")))
                rows.append([n, name, record["triangles"], seconds, record["rms"], record["hausdorff"]])
                jobs.append((mesh, f"{folder}/{n}_{k}"))
        blender(do="render", texture=texture, size=size, centre=centre, jobs=jobs)
        print("| triangles | tool | kept | CPU s | RMS % | Hausdorff % | picture, of 255 |")
        print("| --- | --- | --- | --- | --- | --- | --- |")
        for (n, name, kept, seconds, rms, hausdorff), (_, stem) in zip(rows, jobs[1:]):
            error = picture_error(stem, jobs[0][1])
            print(f"| {n} | {name} | {kept} | {seconds:.1f} | {100 * rms:.3f} | {100 * hausdorff:.2f} | {error:.1f} |")
        if os.environ.get("KEEP_PICTURES"):
            subprocess.run(f"cp {folder}/*.png {folder}/*.obj {os.environ['KEEP_PICTURES']}", shell=True, check=True)


if __name__ == "__main__":
    if "bpy" in sys.modules or "--" in sys.argv:
        inside_blender(sys.argv[sys.argv.index("--") + 1:])
    else:
        main()
