#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""predict_pictures.py PROGRAMS FOLDER [-o CSV]: how well E predicts pictures (docs/error.md, "Does it predict pictures?").

A cell is an asset, its settings and a kind of light: one predicted error, from the report's squares by band and the
light's own moments, and one rendered error, the relative L2 of pictures over six turns of the light and eight
cameras around the asset.
Two judges that are not Kiln's look at some of the pictures as well: butteraugli, and OpenImageIO's `idiff -p` after Yee.
Needs Debian's butteraugli, openimageio-tools and python3-matplotlib, and the meshes of glmark2-data and libcgal-demo. Takes about half
an hour on two cores."""
import argparse, base64, csv, io, itertools, json, math, pathlib, re, subprocess, sys
import numpy
from PIL import Image

parser = argparse.ArgumentParser()
parser.add_argument("programs", type=pathlib.Path)
parser.add_argument("folder", type=pathlib.Path, help="for the assets that are built")
parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("docs/predicted-pictures.csv"))
parser.add_argument("--summary", action="store_true", help="measure nothing, tell of the CSV that is there")
arguments = parser.parse_args()
arguments.programs, arguments.folder = arguments.programs.resolve(), arguments.folder.resolve()

BUNNY = pathlib.Path("/usr/share/glmark2/models/bunny.obj")
ARCHIVE = "/usr/share/doc/libcgal-dev/data.tar.gz"
TUNED = ["bunny", "armadillo", "lion-head"]  # seen while anything was tuned
UNSEEN = ["elephant", "nefertiti", "fandisk", "hand"]
SETTINGS = {"coarse": (500, 96, 128, 4), "middle": (2000, 192, 512, 5), "fine": (8000, 384, 1536, 6)}
VIEWS = 8
# Azimuth and elevation, evenly over the sphere, as the points that E is measured at are seen.
CAMERAS = [((20 + k * 137.50776) % 360, math.degrees(math.asin(1 - (2 * k + 1) / VIEWS))) for k in range(VIEWS)]
PIXELS = 160
TURNS = 6
JUDGED = 2  # turns of a kind that the judges look at, from the first camera
KINDS = ["cone 10", "cone 45", "cone 90", "hemisphere"]


def turned(kind, random):
    """Returns lights of a kind towards six directions, those of an octahedron that is turned at random: so few stand for
    all turns better than six that are drawn one by one."""
    axes = numpy.linalg.qr(random.normal(size=(3, 3)))[0]
    lights = []
    for x, y, z in numpy.concatenate([axes, -axes]):
        azimuth, elevation = math.degrees(math.atan2(x, z)), math.degrees(math.asin(y))
        lights.append(f"hemisphere:{azimuth:.3f},{elevation:.3f},1,1,1,0.2,0.2,0.2" if kind == "hemisphere"
                      else f"cone:{azimuth:.3f},{elevation:.3f},{kind.split()[1]}")
    return lights


def legendre(bands, x):
    values = [1.0, x]
    for l in range(1, bands + 1):
        values.append(((2 * l + 1) * x * values[l] - l * values[l - 1]) / (l + 1))
    return values


def moments(kind, bands):
    """Returns the light's second moments by band as pictures have it: through the Hann window, except in hemispheres."""
    if kind == "hemisphere":  # (1 + c) / 2 sky + (1 - c) / 2 ground of 1 and 0.2
        return [4 * math.pi * 0.6**2, 4 * math.pi / 9 * 0.4**2] + [0.0] * (bands - 2)
    p = legendre(bands, math.cos(math.radians(float(kind.split()[1]))))
    coefficient = lambda l: 2 * math.pi * ((1 if l == 0 else p[l - 1]) - p[l + 1]) / (2 * l + 1)
    window = lambda l: (1 + math.cos(math.pi * l / bands)) / 2
    return [(coefficient(l) * window(l)) ** 2 / (4 * math.pi) for l in range(bands)]


def vertices_of(mesh):
    """Returns the positions of a high mesh: of the bunny's OBJ, or of an OFF file that the build unpacked."""
    if mesh == "bunny":
        return numpy.array([line.split()[1:4] for line in BUNNY.open() if line.startswith("v ")], float)
    words = next((arguments.folder / f"{mesh}-coarse" / "high").glob("*.off")).read_text().split()
    count = int(words[1])
    return numpy.array(words[4:4 + 3 * count], float).reshape(count, 3)


def size_in_pixels(mesh):
    """Returns how many pixels the largest side of a mesh's box takes, in the mean over the cameras, which fit the
    silhouette: an elongated mesh that is seen end-on is drawn larger."""
    positions = vertices_of(mesh)
    side, sizes = (positions.max(0) - positions.min(0)).max(), []
    for azimuth, elevation in CAMERAS:
        command = [arguments.programs / "kiln-render", arguments.folder / f"{mesh}-coarse" / "prt", "-o",
                   arguments.folder / "a.png", "--light", "ambient:1", f"--camera={azimuth:.3f},{elevation:.3f}",
                   "--field-of-view", "30", "--width", str(PIXELS), "--height", str(PIXELS), "--quiet", "--json"]
        camera = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)["camera"]
        pixel = 2 * math.dist(camera["position"], camera["target"]) * camera["half_width"] / PIXELS
        sizes.append(side / pixel)
    return numpy.mean(sizes)


def report(folder, number, lights, samples, pixels):
    """Reports on an asset from the camera of a number, with reference directions of its own."""
    camera = CAMERAS[number]
    command = [arguments.programs / "kiln-report", folder, "-o", arguments.folder / "report" / "report.html", "--json",
               "--quiet", f"--lights={';'.join(lights)}", f"--camera-azimuth={camera[0]:.3f}",
               f"--camera-elevation={camera[1]:.3f}", "--cameras", "1", "--directions", "512", "--seed", str(10 + number), f"--picture-size={PIXELS}", "--error-samples", str(samples),
               "--error-pixels", f"{pixels:.1f}"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=arguments.folder)
    if done.returncode != 0:
        sys.exit(f"{folder}: {done.stderr}")
    return json.loads(done.stdout), (arguments.folder / "report" / "report.html").read_text()


def on_grey(data):
    picture = Image.open(io.BytesIO(base64.b64decode(data))).convert("RGBA")
    grey = Image.new("RGBA", picture.size, (119, 119, 119, 255))
    return Image.alpha_composite(grey, picture).convert("RGB")


def judged(page):
    """Returns both judges' scores of some lights of a page, by the light's number."""
    scores = {}
    pictures = re.findall(r"<div class=light>.*?</div>\s*<", page, re.S)
    for index in range(len(KINDS) * TURNS):
        if index % TURNS >= JUDGED:
            continue
        trio = pictures[index]
        ours, theirs = (on_grey(data) for data in re.findall(r"data:image/png;base64,([^']*)'", trio)[:2])
        a, b = arguments.folder / "a.png", arguments.folder / "b.png"
        ours.save(a), theirs.save(b)
        distance = float(subprocess.run(["butteraugli", a, b], capture_output=True, text=True).stdout.split()[0])
        said = subprocess.run(["idiff", "-p", a, b], capture_output=True, text=True).stdout
        fail = re.search(r"(\d+) pixels \([^)]*\) failed the perceptual test", said)
        scores[index] = (distance, float(fail.group(1)) if fail else 0.0)
    return scores


def ranks(values):
    order = numpy.argsort(numpy.argsort(values, kind="stable"), kind="stable").astype(float)
    for value in set(values):  # ties share their mean rank
        same = [k for k, other in enumerate(values) if other == value]
        order[same] = order[same].mean()
    return order


def rank_correlation(a, b):
    return float(numpy.corrcoef(ranks(list(a)), ranks(list(b)))[0, 1])


def build():
    lines = ["output: .", "defaults:", "  report: {picture-size: 64, directions: 16, error-samples: 64}", "assets:"]
    for mesh, (setting, (faces, size, directions, bands)) in itertools.product(TUNED + UNSEEN, SETTINGS.items()):
        source = (BUNNY if mesh == "bunny"
                  else f"{{archive: {ARCHIVE}, member: data/meshes/{mesh}.off}}")
        lines.append(f"  {mesh}-{setting}: {{mesh: {source}, simplify: {{faces: {faces}}}, atlas: {{size: {size}}}, "
                     f"bake: {{directions: {directions}, bands: {bands}}}}}")
    (arguments.folder / "report").mkdir(parents=True, exist_ok=True)
    (arguments.folder / "pipeline.yaml").write_text("\n".join(lines) + "\n")
    subprocess.run([arguments.programs / "kiln", "build", arguments.folder / "pipeline.yaml", "--quiet"], check=True)


def cells_of(mesh, setting, prior, pixels):
    bands = SETTINGS[setting][3]
    random = numpy.random.default_rng(hash_of(mesh + setting))
    lights = [light for kind in KINDS for light in turned(kind, random)]
    differences, references = numpy.zeros(len(KINDS)), numpy.zeros(len(KINDS))
    for number in range(len(CAMERAS)):
        said, page = report(arguments.folder / f"{mesh}-{setting}", number, lights, 8192 if number == 0 else 64, pixels)
        if number == 0:
            squares = said["error"]["squares_by_band"]
            scores = judged(page)
        for index, light in enumerate(said["lights"][:len(lights)]):  # those of this camera
            difference = light["root_mean_square"] ** 2
            if difference == 0:  # less than the reference's noise
                continue
            differences[index // TURNS] += difference
            references[index // TURNS] += difference / light["relative_l2"] ** 2
    for k, kind in enumerate(KINDS):
        weights = numpy.array(moments(kind, bands)) / prior[:bands]
        predicted = math.sqrt((weights * squares["total"]).sum() / (weights * squares["seen"][:bands]).sum())
        own = [score for index, score in scores.items() if index // TURNS == k]
        yield {"mesh": mesh, "seen_before": mesh in TUNED, "setting": setting, "light": kind,
               "predicted": f"{predicted:.5f}", "rendered": f"{math.sqrt(differences[k] / references[k]):.5f}",
               "butteraugli": f"{numpy.mean([score[0] for score in own]):.4f}",
               "idiff_pixels": f"{numpy.mean([score[1] for score in own]):.1f}"}


def hash_of(text):
    return sum(ord(c) * 31**k for k, c in enumerate(text)) % 2**32


def measure():
    root = pathlib.Path(__file__).resolve().parents[2]
    rows = list(csv.DictReader((root / "docs" / "light-prior.csv").open()))
    prior = numpy.array([float(row["prior"]) for row in rows if row["prior"]])
    build()
    pixels = {mesh: size_in_pixels(mesh) for mesh in TUNED + UNSEEN}
    cells = [cell for mesh, setting in itertools.product(TUNED + UNSEEN, SETTINGS)
             for cell in cells_of(mesh, setting, prior, pixels[mesh])]
    with arguments.output.open("w", newline="") as file:
        writer = csv.DictWriter(file, cells[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(cells)


def plot(cells):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot
    figure, axis = pyplot.subplots(figsize=(5.6, 5.2))
    for setting, color in zip(SETTINGS, ["#c8553d", "#588157", "#2a6f97"]):
        for seen, marker in (("True", "o"), ("False", "^")):
            own = [c for c in cells if c["setting"] == setting and c["seen_before"] == seen]
            axis.scatter([100 * float(c["predicted"]) for c in own], [100 * float(c["rendered"]) for c in own], s=22,
                         color=color, marker=marker, alpha=0.7,
                         label=f"{setting}, {'tuned on' if seen == 'True' else 'unseen'}")
    ends = numpy.array([0.15, 25])
    axis.plot(ends, ends, color="black", linewidth=0.8)
    axis.fill_between(ends, ends / 1.2, ends / 0.8, color="black", alpha=0.08, linewidth=0)
    axis.set_xscale("log"), axis.set_yscale("log"), axis.set_xlim(*ends), axis.set_ylim(*ends)
    for side in (axis.xaxis, axis.yaxis):
        side.set_major_formatter("{x:g}")
    axis.set_xlabel("predicted, %"), axis.set_ylabel("rendered, %")
    axis.legend(frameon=False, fontsize=8)
    figure.tight_layout()
    figure.savefig(arguments.output.with_suffix(".png"), dpi=110)


def main():
    if not arguments.summary:
        measure()
    cells = list(csv.DictReader(arguments.output.open()))
    ratios = numpy.array([float(cell["predicted"]) / float(cell["rendered"]) for cell in cells])
    within = numpy.mean(abs(ratios - 1) <= 0.2)
    print(f"{len(cells)} cells: predicted over rendered {ratios.mean():.3f} in the mean, {ratios.std():.3f} standard "
          f"deviation, {ratios.min():.2f} to {ratios.max():.2f}; within 20 %: {100 * within:.0f} %")
    predicted = [float(cell["predicted"]) for cell in cells]
    for judge in ("rendered", "butteraugli", "idiff_pixels"):
        theirs = [float(cell[judge]) for cell in cells]
        told = f"{rank_correlation(predicted, theirs):.3f}" if len(set(theirs)) > 1 else "none: all scores are alike"
        print(f"rank correlation with {judge}: {told}")
    plot(cells)


main()
