"""Time and error of Mitsuba 3 with Open Image Denoise, what a renderer without particles would do, beside those of irradia's techniques.

    python denoised.py [SCENE…] [--size WxH] [--spp N,N…] [--reference N] [--rounds N] [--irradia PATH] [--set KEY=VALUE…]

One table a scene, errors of the whole image against irradia's own reference. Ends with status 1 if a Mitsuba image of many samples has not
the reference's mean within 1 %: then the two do not show the same light. --rounds 0 leaves out all times.

Mitsuba's pixels are means over the pixel and irradia's are samples at its centre, so that each is compared with a reference of its own kind.
Mitsuba's time is that of rendering the image and its guides and of denoising; scene, kernels and the denoiser's weights are there before.
irradia's times are GPU times of `irradia bench`: of all that a frame takes, and without the geometry stage, which stands while the geometry does.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pyoidn

import compare
import gltf_to_mitsuba
import mitsuba as mi

SCENES = ["cornell-point", "corridor"]
# What is made of the geometry alone.
GEOMETRY = ("diffuse/particles/place/", "diffuse/particles/measure/", "diffuse/particles/link/", "diffuse/particles/lists/")
# Techniques and settings: the counts of particles and the sides of their squares of links, and `hybrid` in two presets.
OURS = [("particles", "default", {"particles.count": count, "particles.gather": gather}) for count in (20000, 50000, 100000) for gather in (8, 16)]
OURS += [("hybrid", preset, {}) for preset in ("default", "high")]


def integrator():
    path = {"type": "path", "max_depth": -1, "rr_depth": 8}
    return mi.load_dict({"type": "aov", "aovs": "albedo:albedo,normal:sh_normal", "image": path})


def denoised(layers):
    image, albedo, normal = (np.ascontiguousarray(layers[..., first : first + 3], dtype=np.float32) for first in (0, 3, 6))
    return pyoidn.denoise(image, albedo=albedo, normal=normal, hdr=True)


def errors(image, reference):
    """rrmse of pixels and of 8×8 blocks, and the ratio of the means."""
    mean = reference.mean()
    relative = lambda difference: compare.rms(difference**2) / mean
    return {
        "pixels %": 100 * relative(image - reference),
        "8×8 %": 100 * relative(compare.blocks(image - reference)),
        "mean": image.mean() / mean,
    }


def run(command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stderr.strip()}")
    return done.stdout


def command(options, what, path, *arguments):
    return [options.irradia, what, str(path), "-q", "--size", "{}x{}".format(*options.size), *arguments]


def reference_of(options, path, pixel_filter):
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "reference.exr"
        said = run(command(options, "reference", path, "--spp", str(options.reference), "--filter", pixel_filter, "-o", str(output)))
        noise = [line.split()[3] for line in said.splitlines() if line.split()[:1] == ["image"]]
        return compare.read_exr(output), float(noise[0])


def timed(rounds, work):
    """The last result and the median time, after a first one in which kernels are compiled; no time without rounds."""
    result, times = work(0), []
    for index in range(rounds):
        start = time.perf_counter()
        result = work(index + 1)
        times.append(1e3 * (time.perf_counter() - start))
    return result, np.median(times) if times else None


def row(name, frame_ms, further_ms, found):
    shown = lambda ms: "" if ms is None else f"{ms:.0f}"
    return name, {"ms": shown(frame_ms), "of it": shown(further_ms), **found}


def by_mitsuba(options, path, reference):
    loaded = gltf_to_mitsuba.load(path, options.size, own_diffuse=True)
    tracer = integrator()
    many = gltf_to_mitsuba.passes(loaded, tracer, options.check, 77)[..., :3]
    ratio = many.mean() / reference.mean()
    if abs(ratio - 1) > compare.MEAN_TOLERANCE:
        sys.exit(f"{path}: the mean of Mitsuba's image over irradia's is {ratio:.4f}: not the same light, nothing to compare")
    yield row(f"Mitsuba, {options.check} spp, not denoised", None, None, errors(many, reference))
    for spp in options.spp:
        layers, render_ms = timed(options.rounds, lambda seed: gltf_to_mitsuba.passes(loaded, tracer, spp, seed))
        image, denoise_ms = timed(options.rounds, lambda _: denoised(layers))
        yield row(f"Mitsuba, {spp} spp, not denoised", render_ms, None, errors(layers[..., :3], reference))
        whole = None if render_ms is None else render_ms + denoise_ms
        yield row(f"Mitsuba, {spp} spp, denoised", whole, denoise_ms, errors(image, reference))


def times_of(options, path, arguments):
    """Of a whole frame and of one that keeps the geometry stage."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "bench.json"
        run(command(options, "bench", path, *arguments, "--frames", str(options.rounds), "--warmup", "1", "--json", str(report)))
        measured = json.loads(report.read_text())["runs"][0]
    full_name = lambda entry: f"{entry['piece']}/{entry['pass']}"
    kept = sum(entry["ms"]["median"] for entry in measured["passes"] if full_name(entry).startswith(GEOMETRY))
    return measured["frame_ms"]["median"], measured["serialised_ms"]["median"] - kept


def by_irradia(options, path, reference):
    for technique, preset, settings in OURS:
        arguments = ["--technique", technique, "--preset", preset]
        for setting in [f"{key}={value}" for key, value in settings.items()] + options.set:
            arguments += ["--set", setting]
        with tempfile.TemporaryDirectory() as folder:
            output = Path(folder) / "image.exr"
            run(command(options, "render", path, *arguments, "-o", str(output)))
            image = compare.read_exr(output)
        frame_ms, relit_ms = times_of(options, path, arguments) if options.rounds else (None, None)
        words = ", ".join(f"{key.split('.')[1]} {value}" for key, value in settings.items()) or preset
        yield row(f"{technique}, {words}", frame_ms, relit_ms, errors(image, reference))


def main():
    numbers = lambda text: [int(part) for part in text.split(",")]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", default=SCENES)
    parser.add_argument("--size", type=gltf_to_mitsuba.size_of, default=(512, 512))
    parser.add_argument("--spp", type=numbers, default=[1, 4, 16, 64], help="samples a pixel of Mitsuba, a list")
    parser.add_argument("--check", type=int, default=256, help="samples a pixel of the image whose mean is checked")
    parser.add_argument("--reference", type=int, default=1024, help="samples a pixel of irradia's references")
    parser.add_argument("--rounds", type=int, default=5, help="the medians of so many count")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a setting of irradia's techniques")
    parser.add_argument("--irradia", default=str(compare.REPOSITORY / "target" / "release" / "irradia"))
    options = parser.parse_args()
    for scene in options.scenes:
        path = compare.path_of(scene)
        print(f"{scene}, {options.size[0]}×{options.size[1]}; \"of it\": denoising, or a frame without the geometry stage\n")
        rows, noises = compare.Table(), []
        for by, pixel_filter in ((by_mitsuba, "box"), (by_irradia, "center")):
            reference, noise = reference_of(options, path, pixel_filter)
            noises.append(noise)
            for name, cells in by(options, path, reference):
                rows.add(name, cells)
        print("\nnoise of the references, of which the errors of pixels hold the squares: {} and {} %\n".format(*noises))


if __name__ == "__main__":
    main()
