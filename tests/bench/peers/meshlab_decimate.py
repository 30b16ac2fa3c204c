# SPDX-License-Identifier: GPL-3.0-or-later
"""MeshLab's quadric edge collapse beside kiln-simplify; prints Markdown rows.

    xvfb-run -a python3 tests/bench/peers/meshlab_decimate.py BENCH_SIMPLIFY HIGH.obj [--faces 5000 1000 500]

BENCH_SIMPLIFY is the program bench_simplify, which measures the results. Runs meshlabserver (package meshlab) with the
filter's defaults. Its time is CPU seconds of the whole command less those of one that only reads and writes HIGH.
"""

import os
import resource
import subprocess
import sys
import tempfile

SCRIPT = """<!DOCTYPE FilterScript>
<FilterScript>
 <filter name="Simplification: Quadric Edge Collapse Decimation">
  <Param type="RichInt" name="TargetFaceNum" value="{faces}"/>
  <Param type="RichFloat" name="TargetPerc" value="0"/>
  <Param type="RichFloat" name="QualityThr" value="0.3"/>
  <Param type="RichBool" name="PreserveBoundary" value="false"/>
  <Param type="RichFloat" name="BoundaryWeight" value="1"/>
  <Param type="RichBool" name="PreserveNormal" value="false"/>
  <Param type="RichBool" name="PreserveTopology" value="false"/>
  <Param type="RichBool" name="OptimalPlacement" value="true"/>
  <Param type="RichBool" name="PlanarQuadric" value="false"/>
  <Param type="RichFloat" name="PlanarWeight" value="0.001"/>
  <Param type="RichBool" name="QualityWeight" value="false"/>
  <Param type="RichBool" name="AutoClean" value="true"/>
  <Param type="RichBool" name="Selected" value="false"/>
 </filter>
</FilterScript>
"""


def write_ply(obj, ply):
    """MeshLab's reader of OBJ files stops at an assertion on some."""
    with open(obj) as file:
        lines = [line.split() for line in file]
    vertices = [line[1:4] for line in lines if line and line[0] == "v"]
    triangles = [[int(word.split("/")[0]) - 1 for word in line[1:]] for line in lines if line and line[0] == "f"]
    with open(ply, "w") as file:
        file.write(f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\n"
                   f"property float z\nelement face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
        file.writelines(" ".join(vertex) + "\n" for vertex in vertices)
        file.writelines("3 %d %d %d\n" % tuple(triangle) for triangle in triangles)


def run(high, low, script):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = ["meshlabserver", "-i", high, "-o", low] + (["-s", script] if script else [])
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    plain, faces = sys.argv[1:], ["5000", "1000", "500"]
    if "--faces" in plain:
        at = plain.index("--faces")
        plain, faces = plain[:at], plain[at + 1:]
    bench, high = plain
    with tempfile.TemporaryDirectory() as folder:
        ply = os.path.join(folder, "high.ply")
        write_ply(high, ply)
        base = run(ply, os.path.join(folder, "same.obj"), None)
        for count in faces:
            script, low = os.path.join(folder, "script.mlx"), os.path.join(folder, "low.obj")
            with open(script, "w") as file:
                file.write(SCRIPT.format(faces=count))
            seconds = run(ply, low, script) - base
            row = subprocess.run([bench, "--measure", high, low], check=True, capture_output=True, text=True).stdout
            print("| MeshLab quadrics |" + row.split("|", 2)[2].replace(" 0.000 | 0.000 |", f" {seconds:.3f} | |"), end="")


main()
