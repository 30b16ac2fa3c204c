#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""test_loader.py SOURCES: the loader of examples/ prints the worked numbers of docs/format.md, and refuses what it does not know."""
import json, pathlib, shutil, subprocess, sys, tempfile

sources = pathlib.Path(sys.argv[1])
loader = [sys.executable, sources / "examples" / "load_asset.py"]
page = (sources / "docs" / "format.md").read_text().splitlines()
worked = [line for line in page if line.startswith("| (")]
printed = subprocess.run([*loader, sources / "examples" / "post"], capture_output=True, text=True, check=True).stdout.splitlines()
if printed != worked or len(worked) != 6:
    sys.exit("docs/format.md has\n" + "\n".join(worked) + "\nthe loader prints\n" + "\n".join(printed))
lines = len((sources / "examples" / "load_asset.py").read_text().splitlines())
if lines > 60:
    sys.exit(f"the loader has {lines} lines; it is to be one of 60 at most")
with tempfile.TemporaryDirectory() as folder:
    copy = pathlib.Path(folder) / "post"
    shutil.copytree(sources / "examples" / "post", copy)
    ranges = json.loads((copy / "ranges.json").read_text())
    ranges["requires"].append("holograms")
    (copy / "ranges.json").write_text(json.dumps(ranges))
    refused = subprocess.run([*loader, copy], capture_output=True, text=True)
    if refused.returncode == 0 or "holograms" not in refused.stderr:
        sys.exit(f"holograms were taken: {refused}")
print("the loader prints the worked numbers")
