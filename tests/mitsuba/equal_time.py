"""Compares how noisy irradia's reference and Mitsuba 3 are after the same time. Ends with status 1 if irradia is the noisier one.

    python equal_time.py [--size WxH] [--spp N] [--rounds N] [--irradia PATH] [--clock wall|cpu]

Both render the same pictures in turn: `ring` without what is seen in the metal, by irradia's paths from both ends and by Mitsuba's
`ptracer`; the Cornell box with a panel by both path tracers.
"""

import argparse
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import compare
import gltf_to_mitsuba
import irradia_bsdf
import mitsuba as mi

# Scene, irradia's slots that are left out, Mitsuba's integrator.
CASES = [("ring", ["specular"], "ptracer"), ("cornell-panel", [], "path")]


class Clock:
    """Seconds since it was made: on the wall, or of all cores of this process or of those that it waited for."""

    def __init__(self, kind, who):
        self.kind, self.who = kind, who
        self.start = self.now()

    def now(self):
        if self.kind == "wall":
            return time.perf_counter()
        usage = resource.getrusage(self.who)
        return usage.ru_utime + usage.ru_stime

    def passed(self):
        return self.now() - self.start


def by_irradia(options, path, without, seed):
    """The image without some slots, and how long it took, from the start of the program to the end of the file."""
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "image.exr"
        command = [options.irradia, "render", str(path), "-q", "--technique", "path", "--filter", "box", "--size", "{}x{}".format(*options.size)]
        command += ["--spp", str(options.spp), "--seed", str(seed), "--slots", "all", "-o", str(output)]
        clock = Clock(options.clock, resource.RUSAGE_CHILDREN)
        done = subprocess.run(command, capture_output=True, text=True)
        seconds = clock.passed()
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)}\n{done.stderr.strip()}")
        bitmap = mi.Bitmap(str(output))
    names = [field.name for field in bitmap.struct_()]
    values = np.array(bitmap, dtype=np.float64).reshape(bitmap.height(), bitmap.width(), -1)
    layer = lambda prefix: np.stack([values[..., names.index(prefix + channel)] for channel in "RGB"], axis=-1)
    return layer("") - sum((layer(slot + ".") for slot in without), np.zeros(3)), seconds


def by_mitsuba(options, loaded, integrator, seed):
    """The image, and how long the scene, which is there and compiled, took to be rendered."""
    description = {"type": integrator, "max_depth": -1, "rr_depth": 8}
    irradia_bsdf.IrradiaBsdf.mirrors_hide_from_camera = integrator == "ptracer"
    try:
        clock = Clock(options.clock, resource.RUSAGE_SELF)
        image = np.array(mi.render(loaded.scene, integrator=mi.load_dict(description), spp=options.spp, seed=seed), dtype=np.float64)
        return image, clock.passed()
    finally:
        irradia_bsdf.IrradiaBsdf.mirrors_hide_from_camera = False


def noise_and_time(render):
    """Of one image, from two: half the difference of two has the noise of their mean."""
    (first, time_first), (second, time_second) = render(1), render(2)
    mean = (first + second).mean() / 2
    return compare.rms((first - second) ** 2 / 2) / mean, (time_first + time_second) / 2, mean


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", type=gltf_to_mitsuba.size_of, default=(512, 512))
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--rounds", type=int, default=3, help="the medians of so many count")
    parser.add_argument("--clock", choices=["wall", "cpu"], default="wall", help="cpu: seconds of all cores, for a busy machine")
    parser.add_argument("--irradia", default=str(compare.REPOSITORY / "target" / "release" / "irradia"))
    options = parser.parse_args()
    rows, holds = compare.Table(), True
    for name, without, integrator in CASES:
        path = compare.path_of(name)
        loaded = gltf_to_mitsuba.load(path, options.size)
        ours = lambda seed: by_irradia(options, path, without, seed)
        theirs = lambda seed: by_mitsuba(options, loaded, integrator, seed)
        # Drivers compile and caches fill.
        ours(0), theirs(0)
        rounds = [(noise_and_time(ours), noise_and_time(theirs)) for _ in range(options.rounds)]
        (noise, seconds, mean), (their_noise, their_seconds, their_mean) = np.median(np.array(rounds), axis=0)
        # Noise falls with the root of the time.
        ratio = noise / their_noise * np.sqrt(seconds / their_seconds)
        holds &= bool(ratio <= 1.0)
        rows.add(name, {
            "mean ratio": mean / their_mean,
            "irradia, s": seconds,
            "noise": noise,
            f"Mitsuba's {integrator}, s": their_seconds,
            "its noise": their_noise,
            "noise at equal time, irradia over Mitsuba": ratio,
        })
    sys.exit(0 if holds else 1)


if __name__ == "__main__":
    main()
