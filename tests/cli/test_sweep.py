#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""test_sweep.py PROGRAMS SOURCES: `kiln sweep` measures a grid, reuses what a setting does not touch, and a second
sweep builds nothing."""
import csv, json, pathlib, sys, tempfile
import jsonschema
from run_kiln import kiln

sources = pathlib.Path(sys.argv[2]).resolve()
PIPELINE = """
output: out
defaults:
  simplify: {faces: 24}
  atlas: {size: 32, gutter: 2}
  bake: {bands: 2, directions: 64, backend: embree, verify-directions: 512}
  report: {picture-size: 64, directions: 32, error-samples: 64, cameras: 1, lights: ['45,30']}
budgets:
  simplify.hausdorff: {max: 0}   # a sweep is not judged
assets:
  post: {mesh: post.obj}
"""


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    (folder / "post.obj").write_text((sources / "examples" / "post.obj").read_text())
    (folder / "pipeline.yaml").write_text(PIPELINE)
    pipeline = str(folder / "pipeline.yaml")
    sweep = ["sweep", pipeline, "--until", "bake", "--set", "bake.directions=16,256", "--set", "atlas.size=16,32"]
    first = kiln(*sweep, "--json")
    results = json.loads(first.stdout)
    jsonschema.validate(results, json.loads((sources / "docs/schema/sweep.schema.json").read_text()))
    points = results["results"]
    assert [point["point"] for point in points] == ["today", "", "", "", ""]
    grid = {(p["settings"]["atlas.size"], p["settings"]["bake.directions"]): p for p in points[1:]}
    assert len(grid) == 4
    for point in points:
        assert point["status"] == 0 and point["error"] > 0 and point["cpu_seconds"] > 0 and point["bytes"] > 0, (point, first.stderr)
    for size in ("16", "32"):
        assert grid[size, "256"]["error"] < grid[size, "16"]["error"], "more directions, more error"
    assert grid["32", "16"]["bytes"] > grid["16", "16"]["bytes"]
    # The atlas of a size was made once: both points have its one time.
    for stage in ("simplify", "atlas"):
        name = stage + ".seconds"
        assert grid["32", "16"]["metrics"][name] == grid["32", "256"]["metrics"][name], name
    out = folder / "out" / "sweep"
    rows = list(csv.DictReader((out / "sweep.csv").open(newline="")))
    assert len(rows) == 5 and rows[1]["set atlas.size"] == "16" and float(rows[1]["error"]) == points[1]["error"]
    assert "<svg" in (out / "sweep.html").read_text()

    # A second sweep bakes nothing and says the same.
    bake = out / "build" / "post" / "prt" / "bake.json"
    before = bake.stat().st_mtime_ns
    second = kiln(*sweep, "--json")
    assert bake.stat().st_mtime_ns == before, "the second sweep baked"
    assert json.loads(second.stdout) == results
    assert "5 measured earlier" in second.stderr, second.stderr

    # What an earlier sweep has left of later stages is not of these points.
    whole = json.loads(kiln("sweep", pipeline, "--set", "bake.directions=32", "--json").stdout)["results"]
    assert "report.relative_l2" in whole[-1]["metrics"]
    again = json.loads(kiln("sweep", pipeline, "--until", "bake", "--set", "bake.directions=24", "--json").stdout)["results"]
    assert not [name for name in again[-1]["metrics"] if name.startswith("report.")], again[-1]

    # A point that cannot be built is noted, and the others are measured.
    result = kiln("sweep", pipeline, "--until", "bake", "--set", "atlas.size=32", "--set", "atlas.gutter=2,64", "--json")
    statuses = [point["status"] for point in json.loads(result.stdout)["results"]]
    assert statuses[:2] == [0, 0] and statuses[2] != 0, statuses
    failed = json.loads(result.stdout)["results"][2]
    assert failed["error"] is None and not failed["metrics"] and not failed["on_time_front"], failed

    for words, said in ((["--set", "bake.direction=3"], "directions"), (["--set", "bake.bits=9"], "bits"),
                        (["--set", "bake.bits=8", "--set", "bake.bits=16"], "twice"), (["--until", "cook"], "stage")):
        result = kiln("sweep", pipeline, *words, status=2)
        assert said in result.stderr, result.stderr
