#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""test_plan.py PROGRAMS SOURCES: `kiln plan` chooses settings that keep an error, `kiln build --plan` builds them, and the
report sets what was predicted beside what it measures."""
import functools, json, pathlib, sys, tempfile
import yaml
from run_kiln import kiln

sources = pathlib.Path(sys.argv[2]).resolve()
# A soft sky, so that few bands serve.
PIPELINE = """
output: out
defaults:
  atlas: {gutter: 2}
  report:
    error-lights: 'hemisphere:0,90,1,1,1,0.3,0.3,0.3'
    error-samples: 1024
    picture-size: 64
    directions: 32
    lights: ['45,30']
assets:
  post: {mesh: post.obj}
  jade: {mesh: post.obj, bake: {subsurface: marble}}
  sharp: {mesh: post.obj, bake: {bands: 9}}
  dots: {mesh: post.obj, bake: {per-vertex: true}}
  dust: {mesh: dust.obj, atlas: {gutter: 6}, budgets: {atlas.utilisation: {min: 0.01}}}
"""


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    run = functools.partial(kiln, folder=folder)
    (folder / "post.obj").write_text((sources / "examples" / "post.obj").read_text())
    (folder / "pipeline.yaml").write_text(PIPELINE)
    # More charts than an atlas of 64 x 64 texels has room for.
    (folder / "dust.obj").write_text("".join(
        "".join(f"v {3 * k + x} {y} {z}\n" for x, y, z in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)))
        + "".join(f"f {' '.join(str(4 * k + c) for c in face)}\n" for face in ((1, 3, 2), (1, 2, 4), (1, 4, 3), (2, 3, 4)))
        for k in range(40)))

    # Without an error there is nothing to plan for; what cannot be kept has no plan.
    assert "--error" in run("plan", status=2).stderr
    refused = run("plan", "post", "--error", "0.0001", status=4)
    assert "post" in refused.stderr and "least" in refused.stderr, refused.stderr
    assert not (folder / "plan.yaml").exists()
    assert "keep" in run("plan", "post", "--error", "0.1", "--keep", "atlas.gutter", status=2).stderr

    texels = ("--keep", "bake.per-vertex")
    said = json.loads(run("plan", "post", "jade", "--error", "0.08", "--json", "--keep", "bake.bits", *texels).stdout)
    post, jade = said["assets"]
    assert post["name"] == "post" and post["kept"] and post["predicted"]["total"] < 0.08, post
    assert "bake.bits" not in post["settings"]
    # A hemisphere has two bands, and the surface keeps no more of it than three.
    assert int(post["settings"]["bake.bands"]) <= 3, post
    assert "subsurface" in jade["left_alone"], jade
    plan = yaml.safe_load((folder / "plan.yaml").read_text())
    assert plan["pipeline"] == "pipeline.yaml" and list(plan["assets"]) == ["post"]
    assert str(plan["assets"]["post"]["bake"]["bands"]) == post["settings"]["bake.bands"]

    # The build needs no pipeline beside the plan, and keeps the error as a budget.
    run("build", "--plan", "plan.yaml", "post", "--quiet")
    error = json.loads((folder / "out" / "post" / "metrics.json").read_text())["error"]
    assert error["predicted"]["asked"] == 0.08 and error["total"] <= 0.08, error
    page = (folder / "out" / "post" / "report.html").read_text()
    assert "Asked" in page and "predicted" in page

    # A plan that people change is built as changed: too few texels miss the budget.
    text = (folder / "plan.yaml").read_text()
    size = f"size: {plan['assets']['post']['atlas']['size']}"
    assert size in text
    (folder / "plan.yaml").write_text(text.replace(size, "size: 16"))
    missed = run("build", "--plan", "plan.yaml", "post", "--quiet", status=4)
    assert "report.error.total" in missed.stderr, missed.stderr

    # A loose error is kept at the vertices, where the pipeline allows that or asks for it; a budget for the atlas does
    # not.
    loose = run("plan", "post", "dots", "dust", "--error", "0.3", "--json", "-o", "loose.yaml")
    post, dots, dust = json.loads(loose.stdout)["assets"]
    for asset in post, dots:
        assert asset["settings"]["bake.per-vertex"] == "true" and asset["predicted"]["vertices"] > 0, asset
    assert "bake.per-vertex" not in dust["settings"] and "texels" in dust["predicted"], dust
    assert "'dust': its pilots take atlases" in loose.stderr and int(dust["settings"]["atlas.size"]) > 64, loose.stderr
    run("build", "--plan", "loose.yaml", "post", "dots", "--quiet")
    error = json.loads((folder / "out" / "dots" / "metrics.json").read_text())["error"]
    assert error["total"] <= 0.3 and abs(error["total"] / dots["predicted"]["total"] - 1) < 0.2, (error, dots)

    # More bands than pilots have, kept, are those of its pilots; directions follow, so that they keep them apart.
    kept = json.loads(run("plan", "sharp", "--error", "0.2", "--json", "--keep", "bake.bands", "-o", "sharp.yaml").stdout)
    assert kept["assets"][0]["kept"] and "bake.bands" not in kept["assets"][0]["settings"], kept
    bake = json.loads((folder / "out" / ".pilots" / "coarse" / "sharp" / "prt" / "bake.json").read_text())
    assert bake["coefficients"] == 81 and bake["directions"] == 324, bake

    # The pilots are kept: a second plan builds nothing.
    record = folder / "out" / ".pilots" / "fine" / "post" / "prt" / "bake.json"
    before = record.stat().st_mtime_ns
    run("plan", "post", "--error", "0.1", "-o", "other.yaml", "--quiet")
    assert record.stat().st_mtime_ns == before, "the second plan baked"
    run("clean", "--quiet")
    assert not (folder / "out").exists()
