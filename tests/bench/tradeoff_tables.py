#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""tradeoff_tables.py SWEEP.json DOCS: makes docs/tradeoffs.csv and tradeoffs.png of a sweep, and prints its tables.
Needs Debian's python3-matplotlib.

The sweep is that of samples/tradeoffs.yaml. Costs are CPU seconds of simplify, atlas, normals and bake, without the
report that measures, and bytes of prt/."""
import csv, json, math, pathlib, sys
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as pyplot
import matplotlib.ticker

results = json.loads(pathlib.Path(sys.argv[1]).read_text())["results"]
docs = pathlib.Path(sys.argv[2])
SETTINGS = ["simplify.faces", "atlas.size", "bake.bands", "bake.directions"]
CAUSES = ["geometry", "texels", "seams", "bands", "directions", "bits", "visibility"]
STAGES = ["simplify", "atlas", "normals", "bake"]

points = []
for result in results:
    if result["status"] != 0:
        continue
    metrics = result["metrics"]
    point = {"asset": result["asset"], "point": result["point"]}
    point.update({name: result["settings"].get(name, "") for name in SETTINGS})
    point["cpu_seconds"] = sum(metrics[stage + ".cpu_seconds"] for stage in STAGES)
    point["bytes"] = result["bytes"]
    point["error"] = metrics.get("report.error.total")
    point.update({cause: metrics.get("report.error.causes." + cause) for cause in CAUSES})
    points.append(point)

with (docs / "tradeoffs.csv").open("w", newline="") as file:
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(points[0].keys())
    for point in points:
        writer.writerow([f"{value:.5g}" if isinstance(value, float) else "" if value is None else value
                         for value in point.values()])


def front(asset, cost):
    own = [p for p in points if p["asset"] == asset and p["error"] is not None]
    return sorted((p for p in own if not any(
        q["error"] <= p["error"] and q[cost] <= p[cost] and (q["error"] < p["error"] or q[cost] < p[cost]) for q in own)),
        key=lambda p: p[cost])


assets = list(dict.fromkeys(point["asset"] for point in points))
figure, axes = pyplot.subplots(1, 2, figsize=(11, 4.6), sharey=True)
colors = {asset: color for asset, color in zip(assets, ["#2a6f97", "#c8553d", "#588157"])}
for axis, (cost, scale, label) in zip(axes, [("cpu_seconds", 1, "CPU seconds"), ("bytes", 1e6, "MB of prt/")]):
    for asset in assets:
        own = [p for p in points if p["asset"] == asset and p["error"] is not None and p["point"] == ""]
        axis.scatter([p[cost] / scale for p in own], [100 * p["error"] for p in own], s=9, alpha=0.35, color=colors[asset])
        best = front(asset, cost)
        axis.plot([p[cost] / scale for p in best], [100 * p["error"] for p in best], color=colors[asset], label=asset)
        for p in points:
            if p["asset"] == asset and p["point"] and p["error"] is not None:
                axis.scatter([p[cost] / scale], [100 * p["error"]], marker="*", s=90, color=colors[asset],
                             edgecolors="black", linewidths=0.5)
    axis.set_xscale("log"), axis.set_yscale("log")
    for side, ticks in ((axis.xaxis, [0.3, 0.5, 1, 2, 3, 5, 7, 10, 15, 20]), (axis.yaxis, [3, 4, 5, 6, 8, 10, 12, 15])):
        low, high = side.get_view_interval()
        side.set_minor_locator(matplotlib.ticker.NullLocator())
        side.set_major_locator(matplotlib.ticker.FixedLocator([tick for tick in ticks if low <= tick <= high]))
        side.set_major_formatter(matplotlib.ticker.FormatStrFormatter("%g"))
    axis.set_xlabel(label)
    axis.grid(True, which="both", alpha=0.2)
axes[0].set_ylabel("E, %")
axes[0].scatter([], [], marker="*", s=90, color="white", edgecolors="black", linewidths=0.5, label="defaults")
axes[0].legend(frameon=False)
figure.tight_layout()
figure.savefig(docs / "tradeoffs.png", dpi=110)

print(f"{len(points)} points")
for asset in assets:
    for cost in ("cpu_seconds", "bytes"):
        print(f"\n{asset}, front of {cost}\n")
        print("| triangles | atlas | bands | directions | CPU s | MB | E % | " + " | ".join(CAUSES[:5]) + " |")
        print("|" + " --- |" * 12)
        for p in front(asset, cost):
            print(f"| {p['simplify.faces'] or p['point']} | {p['atlas.size']} | {p['bake.bands']} | {p['bake.directions']} "
                  f"| {p['cpu_seconds']:.1f} | {p['bytes'] / 1e6:.2f} | {100 * p['error']:.2f} | "
                  + " | ".join(f"{100 * p[c]:.2f}" for c in CAUSES[:5]) + " |")
for p in points:
    if p["point"]:
        print(p["asset"], p["point"], f"{p['cpu_seconds']:.1f} CPU s, {p['bytes'] / 1e6:.2f} MB",
              "" if p["error"] is None else f"{100 * p['error']:.2f} %")


def slope(cause, setting):
    """Returns the exponent of a cause's fall, by least squares of logarithms over pairs that differ in one setting."""
    logs = []
    grid = {tuple([p["asset"]] + [p[s] for s in SETTINGS]): p for p in points if p["point"] == ""}
    values = sorted({p[setting] for p in grid.values()}, key=float)
    for key, p in grid.items():
        k = 1 + SETTINGS.index(setting)
        at = values.index(key[k])
        if at + 1 < len(values):
            other = grid.get(key[:k] + (values[at + 1],) + key[k + 1:])
            if other and p[cause] and other[cause]:
                logs.append(math.log(other[cause] / p[cause]) / math.log(float(values[at + 1]) / float(values[at])))
    return sum(logs) / len(logs), min(logs), max(logs)


for cause, setting in [("geometry", "simplify.faces"), ("texels", "atlas.size"), ("seams", "atlas.size"),
                       ("bands", "bake.bands"), ("directions", "bake.directions")]:
    mean, least, most = slope(cause, setting)
    print(f"{cause} falls with {setting} to the power {mean:.2f} ({least:.2f} to {most:.2f})")
