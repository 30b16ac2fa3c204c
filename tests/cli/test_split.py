#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""test_split.py PROGRAMS SOURCES: the report splits the error of every kind of asset; squares of the causes add up."""
import functools, json, pathlib, sys, tempfile
from run_kiln import kiln

sources = pathlib.Path(sys.argv[2]).resolve()
PIPELINE = """
output: out
defaults:
  atlas: {size: 48, gutter: 2}
  bake: {directions: 256}
  report: {error-samples: 512, picture-size: 64, directions: 32, cameras: 1, lights: ['ambient:1']}
budgets:
  report.error.total: {max: 0.5}
assets:
  plain: {mesh: post.obj}
  low: {mesh: post.obj, bake: {receiver: low}, budgets: {report.error.causes.receivers: {max: 0.2}}}
  within: {mesh: post.obj, normals: {albedo: '0.8,0.5,0.2'}, bake: {bake-albedo: true}}
  painted: {mesh: post.obj, bake: {albedo: '0.5'}}
  free: {mesh: post.obj, bake: {shadows: none}, budgets: {report.error.causes.shadows: {max: 0.9}}}
  dots: {mesh: post.obj, bake: {per-vertex: true}, budgets: {report.error.causes.vertices: {max: 0.9}}}
  jade: {mesh: post.obj, bake: {subsurface: marble, subsurface-scale: 50}, budgets: {report.error.causes.subsurface: {max: 0.2}}}
"""

with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    run = functools.partial(kiln, folder=folder)
    (folder / "post.obj").write_text((sources / "examples" / "post.obj").read_text())
    (folder / "pipeline.yaml").write_text(PIPELINE)
    run("build", "--quiet")

    def report_of(asset):
        return json.loads((folder / "out" / asset / "metrics.json").read_text())["report"]

    common = {"geometry", "albedo", "bits", "seams", "bands"}
    direct = {"texels", "directions", "visibility"}
    causes = {"plain": direct, "free": direct | {"shadows"}, "low": direct | {"receivers"}, "within": direct, "painted": direct,
              "jade": {"texels", "subsurface"}, "dots": {"vertices", "directions", "visibility"}}
    for asset, own in causes.items():
        error = report_of(asset)["error"]
        assert set(error["causes"]) == common | own, (asset, error["causes"])
        root = error["root_sum_of_causes"]
        assert abs(root - error["total"]) <= 0.1 * error["total"] + error["uncertainty"], (asset, error)

    # One colour changes no share: neither of the transfer that has it within, nor of what is drawn by it.
    plain = report_of("plain")
    for asset in ("within", "painted"):
        own = report_of(asset)
        assert abs(own["error"]["total"] - plain["error"]["total"]) < 0.01 * plain["error"]["total"], (asset, own["error"])
        assert abs(own["relative_l2"] - plain["relative_l2"]) < 0.01, (asset, own["relative_l2"], plain["relative_l2"])

    # Without shadows no direction is taken, and what that leaves out is measured.
    free = report_of("free")["error"]["causes"]
    assert free["directions"] == 0 and free["shadows"] > 10 * free["visibility"], free
    page = (folder / "out" / "jade" / "report.html").read_text()
    assert "do not tell them apart" in page

    # An asset baked per vertex has neither atlas nor maps, and its report neither seams nor texels.
    assert not (folder / "out" / "dots" / "atlas.drc").exists() and not (folder / "out" / "dots" / "normals").exists()
    # Causes that an asset has not are no metrics of it.
    (folder / "pipeline.yaml").write_text(PIPELINE.replace("report.error.causes.receivers", "report.error.causes.subsurface"))
    assert "subsurface" in run("build", "low", status=3).stderr
