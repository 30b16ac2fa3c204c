#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""test_presets.py PROGRAMS: presets keep what they promise on meshes that their sweep (docs/tradeoffs.md) did not use."""
import json, pathlib, tempfile
from run_kiln import kiln

ARCHIVE = "/usr/share/doc/libcgal-dev/data.tar.gz"
MESHES = {"hand": ["draft", "standard", "final"], "elephant": ["draft", "standard"]}

promised = {preset["name"]: preset["error"] for preset in json.loads(kiln("presets", "--json").stdout)["presets"]}
assert list(promised) == ["draft", "standard", "final"], promised
assert promised["draft"] > promised["standard"] > promised["final"], promised
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    # Pictures are not what is tested.
    lines = ["output: out", "defaults:",
             "  report: {picture-size: 64, directions: 16, lights: 'ambient:1', error-samples: 1024}", "assets:"]
    for mesh, presets in MESHES.items():
        for preset in presets:
            lines.append(f"  {mesh}-{preset}: {{preset: {preset}, "
                         f"mesh: {{archive: {ARCHIVE}, member: data/meshes/{mesh}.off}}}}")
    (folder / "pipeline.yaml").write_text("\n".join(lines) + "\n")
    kiln("build", str(folder / "pipeline.yaml"), "--quiet")
    for mesh, presets in MESHES.items():
        totals = []
        for preset in presets:
            error = json.loads((folder / "out" / f"{mesh}-{preset}" / "metrics.json").read_text())["error"]
            assert error["total"] <= promised[preset], f"{mesh}, {preset}: {error['total']}, promised {promised[preset]}"
            totals.append(error["total"])
        assert totals == sorted(totals, reverse=True), f"{mesh}: {totals}"
