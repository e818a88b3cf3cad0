"""Compares irradia's reference with Mitsuba 3, scene by scene. Ends with status 1 if a scene differs.

    python compare.py [SCENE…] [--spp N] [--size WxH] [--bounces N] [--sky R,G,B] [--irradia PATH] [--images FOLDER]
    python compare.py --direct [SCENE…]       irradia's shadow-mapped direct light against Mitsuba's, for lights without area
    python compare.py --published [SCENE…]    Mitsuba against the pictures published with the shared scenes

SCENE: the name of a built-in or of a shared scene. Shared ones are looked for in $IRRADIA_SHARED_SCENES.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import gltf_to_mitsuba
import mitsuba as mi
import source_materials

REPOSITORY = Path(__file__).resolve().parents[2]
SHARED = Path(os.environ.get("IRRADIA_SHARED_SCENES", REPOSITORY.parent / "shared" / "scenes"))
SCENES = ["cornell-empty", "cornell-point", "cornell-panel", "ring"]
SHARED_SCENES = ["cornell-original", "cornell-mirror", "veach-mis", "white-room"]
PUBLISHED = ["veach-mis", "white-room", "veach-bidir", "modern-hall"]
DIRECT = ["cornell-empty", "cornell-point", "cornell-spot", "ring"]

# A scene agrees if its mean does to this share and its error is at most this multiple of what noise explains.
MEAN_TOLERANCE = 0.01
NOISE_FACTOR = 1.3
# The share of values, the largest ones, that the robust columns leave out: a few bright samples may outweigh all others.
OUTLIERS = 0.01
# Blocks of pixels whose difference is this many times its standard error are counted.
BLOCK_SIDE = 8
BLOCK_SIGMAS = 4.0
BLOCKS_BEYOND = 0.01


def path_of(name):
    for path in (REPOSITORY / "scenes" / f"{name}.glb", SHARED / name / f"{name}.glb", SHARED / name / f"{name}.gltf", Path(name)):
        if path.is_file():
            return path
    sys.exit(f"there is no scene {name!r} in scenes/ and in {SHARED}; set IRRADIA_SHARED_SCENES to the shared scenes' folder")


def read_exr(path):
    bitmap = mi.Bitmap(str(path))
    names = [field.name for field in bitmap.struct_()]
    values = np.array(bitmap, dtype=np.float64).reshape(bitmap.height(), bitmap.width(), -1)
    return np.stack([values[..., names.index(channel)] for channel in "RGB"], axis=-1)


class Irradia:
    """The command under test."""

    def __init__(self, command):
        self.command = command

    def render(self, path, size, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            output = Path(folder) / "image.exr"
            command = [self.command, "render", str(path), "-q", "--size", f"{size[0]}x{size[1]}", *arguments, "-o", str(output)]
            done = subprocess.run(command, capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"{' '.join(command)}\n{done.stderr.strip()}")
            return read_exr(output)


class Estimate:
    """An image in two independent halves."""

    def __init__(self, first, second):
        self.first, self.second = first, second
        self.image = (first + second) / 2
        # The variance of the image, estimated with one degree of freedom a value.
        self.variance = (first - second) ** 2 / 4


def rms(values):
    return float(np.sqrt(np.mean(values)))


def blocks(values):
    height, width = (extent // BLOCK_SIDE * BLOCK_SIDE for extent in values.shape[:2])
    grid = values[:height, :width].reshape(height // BLOCK_SIDE, BLOCK_SIDE, width // BLOCK_SIDE, BLOCK_SIDE, 3)
    return grid.mean(axis=(1, 3))


def trimmed(squares):
    """The root of the mean without the largest values."""
    return rms(np.sort(squares, axis=None)[: int(squares.size * (1 - OUTLIERS))])


def compare(irradia, mitsuba):
    """The row of a table: a dict of numbers, and the verdict."""
    difference = irradia.image - mitsuba.image
    # If both are the same light, this has the same distribution as the difference: it is one half of each against the others.
    noise = (irradia.first - irradia.second + mitsuba.first - mitsuba.second) / 2
    variance = irradia.variance + mitsuba.variance
    mean = mitsuba.image.mean()
    unlikely = np.maximum(difference**2, noise**2).sum(axis=2)
    kept = unlikely <= np.quantile(unlikely, 1 - OUTLIERS)
    robust_mean = mitsuba.image[kept].mean()
    block_difference = blocks(difference).mean(axis=2)
    block_error = np.sqrt(blocks(variance).mean(axis=2) / BLOCK_SIDE**2)
    row = {
        "mean ratio": irradia.image.mean() / mean,
        "± of it": rms(variance) / mean / np.sqrt(variance[..., 0].size),
        "rrmse": rms(difference**2) / mean,
        "noise of irradia": rms(irradia.variance) / mean,
        "noise of Mitsuba": rms(mitsuba.variance) / mean,
        "expected rrmse": rms(variance) / mean,
        "robust mean ratio": irradia.image[kept].mean() / robust_mean,
        "robust rrmse": trimmed(difference**2) / mean,
        "robust expected": trimmed(noise**2) / mean,
        "blocks beyond 4 σ": float((np.abs(block_difference) > BLOCK_SIGMAS * np.maximum(block_error, 1e-9)).mean()),
    }
    agrees = abs(row["robust mean ratio"] - 1) <= MEAN_TOLERANCE
    agrees &= row["robust rrmse"] <= NOISE_FACTOR * row["robust expected"]
    agrees &= row["blocks beyond 4 σ"] <= BLOCKS_BEYOND
    return row, bool(agrees)


def write_images(folder, name, irradia, mitsuba):
    """irradia, Mitsuba, and their difference in units of its standard error: grey is none, white and black 5."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    shown = lambda image: np.clip(image, 0, 1) ** (1 / 2.2)
    error = np.sqrt(blocks(irradia.variance + mitsuba.variance) / BLOCK_SIDE**2)
    z = blocks(irradia.image - mitsuba.image) / np.maximum(error, 1e-9)
    z = np.kron(np.clip(0.5 + z / 10, 0, 1), np.ones((BLOCK_SIDE, BLOCK_SIDE, 1)))
    height, width = z.shape[:2]
    pictures = [shown(irradia.image)[:height, :width], shown(mitsuba.image)[:height, :width], z]
    mi.Bitmap((np.concatenate(pictures, axis=1) * 255).astype(np.uint8)).write(str(Path(folder) / f"{name}.png"))


class Table:
    """A table that appears line by line."""

    def __init__(self):
        self.has_head = False

    def add(self, scene, row):
        if not self.has_head:
            print("| scene | " + " | ".join(row) + " |")
            print("|---|" + "---:|" * len(row))
            self.has_head = True
        cells = [value if isinstance(value, str) else f"{value:.4f}" for value in row.values()]
        print(f"| {scene} | " + " | ".join(cells) + " |", flush=True)


def compare_references(options):
    rows, all_agree = Table(), True
    irradia = Irradia(options.irradia)
    same = [] if options.bounces is None else ["--bounces", str(options.bounces)]
    same += [] if options.sky is None else ["--sky", ",".join(map(str, options.sky))]
    for name in options.scenes or SCENES + SHARED_SCENES:
        path = path_of(name)
        half = max(1, options.spp // 2)
        ours = Estimate(*(
            irradia.render(path, options.size, "--technique", "path", "--filter", "box", "--spp", str(half), "--seed", str(seed), *same)
            for seed in (1, 2)
        ))
        loaded = gltf_to_mitsuba.load(path, options.size, sky=options.sky)
        mitsuba_half = max(1, (options.mitsuba_spp or options.spp) // 2)
        theirs = Estimate(*(gltf_to_mitsuba.render(loaded, mitsuba_half, seed, options.bounces) for seed in (1, 2)))
        row, agrees = compare(ours, theirs)
        rows.add(name, {**row, "verdict": "agrees" if agrees else "DIFFERS"})
        all_agree &= agrees
        if options.images:
            write_images(options.images, name, ours, theirs)
    return all_agree


def compare_direct(options):
    """Shadow edges differ, so the lit pixels' ratios count: their median and quartiles."""
    rows, all_agree = Table(), True
    irradia = Irradia(options.irradia)
    for name in options.scenes or DIRECT:
        path = path_of(name)
        ours = irradia.render(path, options.size, "--technique", "direct")
        loaded = gltf_to_mitsuba.load(path, options.size)
        theirs = gltf_to_mitsuba.render(loaded, options.spp, bounces=0, integrator="path")
        lit = (np.minimum(ours, theirs) > 0.01).all(axis=2)
        ratios = (ours[lit] / theirs[lit]).mean(axis=1)
        low, median, high = np.quantile(ratios, [0.05, 0.5, 0.95])
        agrees = abs(median - 1) < 0.002 and low > 0.98 and high < 1.02
        all_agree &= agrees
        row = {
            "mean ratio": ours.mean() / theirs.mean(),
            "5 % of lit pixels below": low,
            "median": median,
            "5 % above": high,
            "verdict": "agrees" if agrees else "DIFFERS",
        }
        rows.add(name, row)
    return all_agree


def compare_published(options):
    rows = Table()
    for name in options.scenes or PUBLISHED:
        path = path_of(name)
        published = read_exr(path.parent / "reference.exr")
        height, width = published.shape[:2]
        scale = max(1, round(height / options.size[1]))
        while height % scale or width % scale:
            scale += 1
        size = (width // scale, height // scale)
        published = published.reshape(size[1], scale, size[0], scale, 3).mean(axis=(1, 3))
        row = {"size": f"{size[0]}x{size[1]}"}
        for model, replace in (("glTF", None), ("source", source_materials.bsdf_of)):
            loaded = gltf_to_mitsuba.load(path, size, replace=replace)
            for label, bounces in (("direct", 0), ("depth 8", 6), ("all", None)):
                image = gltf_to_mitsuba.render(loaded, options.spp, bounces=bounces)
                lit = published > 1e-4
                row[f"{model}, {label}: mean"] = image.mean() / published.mean()
                row[f"{model}, {label}: median"] = float(np.median(image[lit] / published[lit]))
        rows.add(name, row)
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*")
    parser.add_argument("--spp", type=int, default=256, help="samples a pixel, both halves together")
    parser.add_argument("--mitsuba-spp", type=int, help="samples a pixel of Mitsuba, if other")
    parser.add_argument("--size", type=gltf_to_mitsuba.size_of, default=(128, 96))
    parser.add_argument("--bounces", type=int, help="at most so many scatterings between the light and the first visible surface")
    parser.add_argument("--sky", type=gltf_to_mitsuba.rgb_of, help="radiance of a constant sky")
    parser.add_argument("--irradia", default=str(REPOSITORY / "target" / "release" / "irradia"))
    parser.add_argument("--images", help="a folder for pictures of both and of the difference")
    modes = parser.add_mutually_exclusive_group()
    modes.add_argument("--direct", dest="mode", action="store_const", const=compare_direct, default=compare_references)
    modes.add_argument("--published", dest="mode", action="store_const", const=compare_published)
    options = parser.parse_args()
    sys.exit(0 if options.mode(options) else 1)


if __name__ == "__main__":
    main()
