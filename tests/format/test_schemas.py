#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""test_schemas.py PROGRAMS SOURCES: what a run writes fits docs/schema, and what is broken does not.

Needs python3-jsonschema and python3-yaml. Each broken variant is one change to what was written, and must be refused.
"""
import copy, json, os, pathlib, subprocess, sys, tempfile
import jsonschema, yaml

programs, sources = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
faults = []
schemas = {}
for file in sorted((sources / "docs" / "schema").glob("*.schema.json")):
    schema = json.loads(file.read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    schemas[file.name.split(".")[0]] = jsonschema.Draft202012Validator(schema)

PIPELINE = """
output: out
defaults:
  simplify: {faces: 24}
  atlas: {size: 32, gutter: 2}
  bake: {bands: 2, directions: 64, backend: embree}
  compress: {max-error: 0.2}
  probes: {grid: 2x1x2, bands: 2, directions: 64}
  report: {picture-size: 64, directions: 32, error-samples: 64, lights: ['45,30', 'ambient:1']}
budgets:
  bake.texels: {min: 1}
assets:
  post: {mesh: post.obj, material: {albedo: [0.8, 0.5, 0.2]}}
"""


def run(*command, status=0):
    result = subprocess.run([programs / command[0], *command[1:]], capture_output=True, text=True)
    if result.returncode != status:
        sys.exit(f"{command} ended with {result.returncode}:\n{result.stderr}")
    return result.stdout


def fits(name, value, what):
    for error in schemas[name].iter_errors(value):
        faults.append(f"{what}: {error.json_path}: {error.message[:200]}")


def refuses(name, value, changes):
    """`changes`: (path, new value); a path ends in a key or index, and DROP removes it."""
    for path, new in changes:
        broken = copy.deepcopy(value)
        inner = broken
        for step in path[:-1]:
            inner = inner[step]
        if new is DROP:
            del inner[path[-1]]
        else:
            inner[path[-1]] = new
        if schemas[name].is_valid(broken):
            faults.append(f"{name}: {path} as {new!r} is not refused")


DROP = object()

# The committed schema of pipeline.yaml is the one that the option tables make.
made = json.loads(run("kiln", "schema"))
if made != schemas["pipeline"].schema:
    faults.append("docs/schema/pipeline.schema.json is old; make it by: kiln schema > docs/schema/pipeline.schema.json")

# So is that of scene.yaml, which fits samples/strike.yaml and a scene with a bit of everything.
if json.loads(run("kiln", "schema", "scene")) != schemas["scene"].schema:
    faults.append("docs/schema/scene.schema.json is old; make it by: kiln schema scene > docs/schema/scene.schema.json")
SCENE = """
nodes:
  - {name: still, asset: a, static: true, shader: wood, set: {gloss: 0.5, paint: [1, 0, 0.5]}}
  - name: pair
    translate: [0, 0.4, 0]
    nodes:
      - {name: mover, asset: a, scale: 0.2, animate: {keyframes: [{time: 0, translate: [-6, 1.6, 0]}, {time: 1, scale: 2}], ends: mirror}}
      - {name: moon, asset: a, rotate: {axis: [1, 0, 0], degrees: 9}, animate: {orbit: {axis: [0, 1, 0], radius: 2, period: 4, turns: true}}}
  - {name: floor, mesh: m.obj, casts-shadow: false, mirror: true}
lights:
  - {directional: [0, 80], radiance: 1, radius: 6, animate: {orbit: {axis: [0, 0, 1], period: 3}}}
  - {sphere: [0, 1, 2], radius: 0.1, radiance: [1, 2, 3], animate: {keyframes: [{time: 0, sphere: [0, 1, 2]}]}}
  - {hemisphere: [0, 90], radiance: 0.5, ground: 0.1}
  - {ambient: 0.1}
window: dering
background: 0.5
shaders: looks
camera: {azimuth: 30, elevation: 20, target: [0, 1, 0], zoom: 2}
tree: auto
duration: 3
"""
scene = yaml.safe_load(SCENE)
fits("scene", scene, "a scene")
for name in ("strike", "bowling"):
    fits("scene", yaml.safe_load((sources / "samples" / f"{name}.yaml").read_text()), f"samples/{name}.yaml")
refuses("scene", scene, [
    (["nodes"], []), (["nodes", 0, "nodes"], [{"name": "x", "asset": "a"}]), (["nodes", 0, "asset"], DROP),
    (["nodes", 0, "name"], DROP), (["nodes", 0, "scale"], [1, 2, 1]), (["nodes", 0, "scale"], 0), (["nodes", 0, "color"], "red"),
    (["nodes", 0, "mesh"], "m.obj"), (["nodes", 0, "shader"], DROP), (["nodes", 0, "set", "paint"], [1, 2, 3, 4, 5]),
    (["nodes", 0, "set", "paint"], "red"), (["nodes", 1, "shader"], "wood"), (["nodes", 2, "mirror"], 1), (["background"], [1, 2]),
    (["nodes", 1, "nodes", 0, "animate", "keyframes"], []), (["nodes", 1, "nodes", 0, "animate", "keyframes", 0, "time"], DROP),
    (["nodes", 1, "nodes", 0, "animate", "ends"], "stop"), (["nodes", 1, "nodes", 1, "animate", "orbit", "radius"], DROP),
    (["nodes", 1, "nodes", 1, "rotate", "axis"], [0, 1]), (["lights"], []), (["lights", 0, "directional"], [0]),
    (["lights", 1, "radius"], DROP), (["lights", 3, "animate"], {}), (["window"], "oval"), (["tree"], "oak"), (["duration"], 0)])

with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    pathlib.Path("post.obj").write_text((sources / "examples" / "post.obj").read_text())
    pathlib.Path("pipeline.yaml").write_text(PIPELINE)
    run("kiln", "build", "--quiet")
    run("kiln-bake", "post.obj", "--per-vertex", "-o", "vertices", "--bands", "2", "--directions", "64", "--quiet")
    run("kiln-normals", "post.obj", "out/post/atlas.drc", "-o", "tangent", "--space", "tangent", "--quiet")
    run("kiln-bake", "out/post/atlas.drc", "--detail", "tangent", "--occluder", "post.obj", "-o", "hollow", "--bands", "2",
        "--directions", "64", "--quiet")
    run("kiln-compress", "out/post/prt", "-o", "pca", "--clusters", "2", "--pca", "2", "--quiet")
    run("kiln-probes", "post.obj", "-o", "probes", "--grid", "2x1x2", "--bands", "2", "--directions", "64", "--quiet")
    side = 9  # a bumpy sheet, which has levels of detail
    sheet = [f"v {i} {(i * j) % 3 * 0.2} {-j}" for j in range(side) for i in range(side)]
    for j in range(side - 1):
        for i in range(side - 1):
            a = j * side + i + 1
            sheet += [f"f {a} {a + 1} {a + side + 1}", f"f {a} {a + side + 1} {a + side}"]
    pathlib.Path("sheet.obj").write_text("\n".join(sheet) + "\n")
    run("kiln-atlas", "sheet.obj", "-o", "fine/atlas.drc", "--size", "64", "--gutter", "2", "--density", "even", "--quiet")
    run("kiln-lod", "fine/atlas.drc", "-o", "fine/lod", "--levels", "0.7", "--quiet")
    run("kiln-bake", "fine/atlas.drc", "--receiver", "low", "--levels", "fine/lod", "-o", "levels", "--bands", "2",
        "--directions", "64", "--quiet")
    for asset in ("out/post/prt", "vertices", "pca"):
        run("kiln-export", asset, "-o", asset.split("/")[-1] + ".glb", "--quiet")
    run("kiln-spectrum", "--lights", "D65,F11", "-o", "basis.json", "--size", "4", "--quiet")
    read = lambda name: json.loads(pathlib.Path(name).read_text())

    def extension(name):
        """Returns KILN_prt of the only material of a glb."""
        data = pathlib.Path(name).read_bytes()
        return json.loads(data[20:20 + int.from_bytes(data[12:16], "little")])["materials"][0]["extensions"]["KILN_prt"]

    # Written files conform to the schemas.
    for name, files in {
        "ranges": ["out/post/prt/ranges.json", "vertices/ranges.json", "hollow/ranges.json", "levels/ranges.json"],
        "pca": ["pca/pca.json"],
        "matrices": ["probes/matrices.json"],
        "record": ["out/post/simplify.json", "out/post/atlas.json", "out/post/normals/normals.json", "out/post/prt/bake.json",
                   "out/post/small/compress.json", "out/post/probes/probes.json", "out/post/report.json", "vertices/bake.json", "probes/probes.json",
                   "fine/lod/lod.json"],
        "metrics": ["out/post/metrics.json"],
        "spectrum": ["basis.json"],
    }.items():
        for file in files:
            fits(name, read(file), file)
    for form in ("textured", "tangent", "vertices"):
        fits("ranges", json.loads((sources / f"tests/data/version1/{form}/ranges.json").read_text()), f"version 1, {form}")
    for file in ("prt.glb", "vertices.glb", "pca.glb"):
        fits("KILN_prt", extension(file), file)
        fits("pca" if file == "pca.glb" else "ranges", extension(file)["manifest"], f"manifest of {file}")
    fits("check", json.loads(run("kiln", "check", "--json", "out/post", "vertices", "hollow", "pca", "probes")), "kiln check")
    pathlib.Path("pca/weight_00.png").unlink()
    told = json.loads(run("kiln", "check", "--json", "pca", "nowhere", status=3))
    fits("check", told, "kiln check of a broken folder")
    if [len(entry["faults"]) for entry in told["folders"]] != [1, 1]:
        faults.append(f"kiln check tells {told['folders']}")
    for file in ("pipeline.yaml", "samples/scene.yaml"):
        fits("pipeline", yaml.safe_load((sources / file).read_text()), file)
    fits("pipeline", yaml.safe_load(PIPELINE), "the pipeline of this test")

    # A basis has what its size says: white under D65 is white, read by its numbers alone.
    basis = read("basis.json")
    if [len(basis["functions"]), len(basis["lights"][0]["vector"]), len(basis["surfaces"][0]["matrix"])] != [4, 4, 4]:
        faults.append("basis.json does not have four functions everywhere")
    seen = [sum(a * b for a, b in zip(row, basis["lights"][0]["vector"])) for row in basis["sensors"][0]["matrix"]]
    if max(abs(channel - 1) for channel in seen) > 1e-9:
        faults.append(f"basis.json shows white under D65 as {seen}")

    # Damaged files do not.
    refuses("ranges", read("out/post/prt/ranges.json"), [
        (("format",), "kiln-prt-pca"), (("version",), 3), (("requires",), DROP), (("requires",), []), (("requires",), ["holograms"]),
        (("basis",), "complex"), (("bands",), 0), (("bits",), 12), (("width",), DROP), (("mesh",), "../atlas.drc"),
        (("mesh",), "/atlas.drc"), (("albedo",), [1, 2, 1]), (("planes",), []), (("planes", 1, "file"), DROP),
        (("planes", 1, "min"), "0"), (("origin",), [1, 2])])
    refuses("ranges", read("vertices/ranges.json"), [
        (("requires",), []), (("planes", 0, "attribute"), DROP), (("planes", 0, "component"), 4), (("albedo",), "albedo.png")])
    refuses("ranges", read("levels/ranges.json"), [
        (("levels", 0, "mesh"), "../lod_1.drc"), (("levels", 0, "triangles"), 0), (("levels", 0, "error"), -1),
        (("levels", 0, "distance"), DROP), (("levels",), {})])
    refuses("ranges", read("hollow/ranges.json"), [(("requires",), []), (("normal_space",), "world")])
    refuses("KILN_prt", extension("prt.glb"), [
        (("version",), 2), (("manifest",), DROP), (("manifest",), "ranges.json"), (("manifest", "format"), "kiln-probes"),
        (("pictures",), DROP), (("pictures",), {}), (("pictures", "coeff_0_00.png"), 3), (("pictures", "coeff_0_00.png", "index"), -1),
        (("attributes",), {"kiln-prt-0-0": "_KILN_PRT_0_0"}), (("manifest", "vertices"), 8)])
    refuses("KILN_prt", extension("vertices.glb"), [(("attributes",), DROP), (("attributes", "kiln-prt-0-0"), "COLOR_0")])
    refuses("pca", read("pca/pca.json"), [
        (("requires",), ["vertices"]), (("clusters",), 257), (("cluster_ids",), DROP), (("planes", 0, "bits"), 9),
        (("vector_ranges", 0, "max"), None)])
    refuses("matrices", read("probes/matrices.json"), [
        (("requires",), ["albedo"]), (("channels",), 2), (("grid",), DROP), (("grid", "size"), [2, 2]), (("bands",), 9)])
    refuses("record", read("out/post/prt/bake.json"), [
        (("stage",), "stir"), (("seconds",), -1), (("directions",), DROP), (("outputs", "atlas.drc"), "abc"), (("warnings",), "none")])
    refuses("metrics", read("out/post/metrics.json"), [
        (("bake",), DROP), (("bake", "stage"), "atlas"), (("report", "budgets", 0, "met"), 1), (("more",), {})])
    refuses("spectrum", basis, [
        (("channels", "wavelengths_nm", 0), 900),
        (("format",), "kiln-prt"), (("size",), 0), (("duals",), DROP), (("kind",), "red"), (("lights",), []),
        (("sensors", 0, "matrix"), DROP), (("surfaces", 0, "matrix", 0), []), (("more",), 1)])
    refuses("check", told, [(("folders",), []), (("folders", 0, "faults", 0, "remedy"), DROP)])
    pipeline = yaml.safe_load(PIPELINE)
    for levels in ([1, 0.5], True, {"levels": [0.5, 0.25]}, {"pixels": "1, 4"}):
        pipeline["defaults"]["lod"] = levels
        fits("pipeline", pipeline, f"lod: {levels}")
    refuses("pipeline", pipeline, [
        (("assets",), DROP), (("asets",), {}), (("defaults", "bake", "bands"), 25), (("defaults", "bake", "bands"), "five"),
        (("defaults", "bake", "backend"), "cuda"), (("defaults", "bake", "refine"), True), (("defaults", "stir"), {}),
        (("defaults", "lod"), 0.5), (("defaults", "bake"), [5]),
        (("defaults", "simplify", "face"), 7), (("budgets", "bake.texels"), {}), (("budgets", "bake.texels"), {"most": 1}),
        (("assets", "post", "mesh"), {"archive": "a.tar"}), (("assets", "post", "default"), "yes"),
        (("assets", "post", "material"), {"albedo": 1, "texture": "a.png"}),
        (("assets", "post", "material"), {"albedo": 1, "reflectance": "TCS05"})])

print("\n".join(faults) if faults else "what a run writes fits its schemas")
sys.exit(bool(faults))
