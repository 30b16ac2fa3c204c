#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""plan_scenes.py PROGRAMS FOLDER: whether plans keep their errors, and how near they are to the cheapest settings that a
sweep knows to keep them (docs/tradeoffs.md, "Plans").

Three scenes: a convex body under a soft sky, a crowd of small assets, a hero seen from near. Each asset is planned,
built by its plan and measured; then a sweep over triangles, texels, bands and directions looks for cheaper settings.
Cost is the product of CPU seconds and bytes. Needs the meshes of glmark2-data and libcgal-demo."""
import argparse, functools, json, math, pathlib, subprocess

print = functools.partial(print, flush=True)  # a scene takes minutes

parser = argparse.ArgumentParser()
parser.add_argument("programs", type=pathlib.Path)
parser.add_argument("folder", type=pathlib.Path)
parser.add_argument("--scenes", nargs="*", default=["convex", "crowd", "hero"])
arguments = parser.parse_args()

ARCHIVE = "/usr/share/doc/libcgal-dev/data.tar.gz"
REPORT = "picture-size: 64, directions: 16, cameras: 1, lights: 'ambient:1'"
SCENES = {
    "convex": (0.02, f"""
defaults:
  report: {{{REPORT}, error-lights: 'hemisphere:0,90,1,1,1,0.3,0.3,0.3'}}
assets:
  body: {{mesh: body.obj}}
""", ["simplify.faces=500,2000", "atlas.size=32,64,128", "bake.bands=3,4", "bake.directions=64,256"]),
    "crowd": (0.08, f"""
defaults:
  report: {{{REPORT}, error-pixels: 40}}
assets:
  hand: {{mesh: {{archive: {ARCHIVE}, member: data/meshes/hand.off}}}}
  fandisk: {{mesh: {{archive: {ARCHIVE}, member: data/meshes/fandisk.off}}}}
  elephant: {{mesh: {{archive: {ARCHIVE}, member: data/meshes/elephant.off}}}}
""", ["simplify.faces=250,1000", "atlas.size=32,64", "bake.bands=5,6", "bake.directions=256"]),
    "hero": (0.06, f"""
defaults:
  report: {{{REPORT}}}
assets:
  lion-head: {{mesh: {{archive: {ARCHIVE}, member: data/meshes/lion-head.off}}}}
""", ["simplify.faces=2000,8000", "atlas.size=128,256,512", "bake.bands=7,8", "bake.directions=256"]),
}


def write_body(file, rings=96):
    """Writes a convex body: a sphere whose axes are 1, 0.8 and 0.6."""
    lines, quads = [], []
    for i in range(rings + 1):
        for j in range(2 * rings):
            up, turn = math.pi * i / rings, math.pi * j / rings
            lines.append(f"v {math.sin(up) * math.cos(turn):.7g} {0.8 * math.cos(up):.7g} "
                         f"{0.6 * math.sin(up) * math.sin(turn):.7g}")
    at = lambda i, j: i * 2 * rings + j % (2 * rings) + 1
    for i in range(rings):
        for j in range(2 * rings):
            if i > 0:
                quads.append(f"f {at(i, j)} {at(i, j + 1)} {at(i + 1, j)}")
            if i < rings - 1:
                quads.append(f"f {at(i, j + 1)} {at(i + 1, j + 1)} {at(i + 1, j)}")
    file.write_text("\n".join(lines + quads) + "\n")


def kiln(folder, *words):
    return subprocess.run([arguments.programs.resolve() / "kiln", *words], cwd=folder, capture_output=True, text=True)


def cost_of(asset):
    """Returns CPU seconds and bytes of an asset's folder."""
    records = [asset / name for name in ("simplify.json", "atlas.json", "normals/normals.json", "prt/bake.json")]
    seconds = sum(json.loads(file.read_text())["cpu_seconds"] for file in records if file.exists())
    return seconds, sum(file.stat().st_size for file in (asset / "prt").iterdir() if file.name != "bake.json")


for name in arguments.scenes:
    error, text, axes = SCENES[name]
    folder = arguments.folder / name
    folder.mkdir(parents=True, exist_ok=True)
    if name == "convex":
        write_body(folder / "body.obj")
    (folder / "pipeline.yaml").write_text("output: out\n" + text)
    planned = kiln(folder, "plan", "--error", str(error), "--quiet", "--json")
    assert planned.returncode == 0, planned.stderr
    pilots = json.loads(planned.stdout)["pilot_cpu_seconds"]
    built = kiln(folder, "build", "--plan", "plan.yaml", "--quiet")
    assert built.returncode in (0, 4), built.stderr
    sweep = ["sweep", "--until", "report", "--quiet", "--json", *(word for axis in axes for word in ("--set", axis))]
    results = json.loads(kiln(folder, *sweep).stdout)["results"]
    for asset in json.loads(planned.stdout)["assets"]:
        measured = json.loads((folder / "out" / asset["name"] / "metrics.json").read_text())["error"]
        seconds, size = cost_of(folder / "out" / asset["name"])
        keeping = []
        for point in results:
            if point["asset"] == asset["name"] and point["status"] == 0 and point["error"] <= error:
                own = sum(point["metrics"][stage + ".cpu_seconds"] for stage in ("simplify", "atlas", "normals", "bake"))
                keeping.append((own * point["bytes"], own, point["bytes"], point["settings"]))
        best = min(keeping, key=lambda each: each[0], default=None)
        print(f"{name} {asset['name']}: asked {100 * error:.3g} %, predicted {100 * asset['predicted']['total']:.3g} %, "
              f"measured {100 * measured['total']:.3g} +- {100 * measured['uncertainty']:.2g} %; {seconds:.2f} CPU s "
              f"(predicted {asset['cpu_seconds']:.2f}), {size / 1000:.0f} kB (predicted {asset['bytes'] / 1000:.0f}); "
              f"all pilots {pilots:.0f} CPU s")
        print("  " + ", ".join(f"{key} {value}" for key, value in asset["settings"].items()))
        if best:
            print(f"  cost over the sweep's cheapest that keeps it: {seconds * size / best[0]:.2f} "
                  f"({best[1]:.2f} CPU s, {best[2] / 1000:.0f} kB: {best[3]})")
        else:
            print("  no point of the sweep keeps it")
