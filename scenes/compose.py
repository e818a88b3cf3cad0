#!/usr/bin/env python3
"""Makes two of Quyen's scenes (2014, 4.1.3 and 4.3) out of models that are not part of this project.

    scenes/compose.py bunnies stanford-bunny.glb -o bunnies.glb
    scenes/compose.py sponza crytek-sponza-geometry.glb -o sponza-pools.glb

`bunnies`: three bunnies about the metal ring of the scene `ring`. `sponza`: pools of wavy water on the floor of the atrium, a
spot light in its open roof. The thesis shows both but does not state where things stand.
"""

import argparse
import json
import math
import struct
import sys
from pathlib import Path

from make import SAND, WHITE, Mesh, Scene, height_field, metal_band, ring_room

COMPONENTS = {5126: "f", 5123: "H", 5125: "I"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}


def read_model(path):
    """Positions and triangles of all primitives of a binary glTF file, which has them in its first buffer."""
    data = Path(path).read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    document, binary = json.loads(data[20:20 + length]), data[28 + length:]

    def values(index):
        accessor = document["accessors"][index]
        view = document["bufferViews"][accessor["bufferView"]]
        letter, width = COMPONENTS[accessor["componentType"]], WIDTHS[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", struct.calcsize(letter) * width)
        return [struct.unpack_from(f"<{width}{letter}", binary, start + i * stride) for i in range(accessor["count"])]

    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            indices = [i for (i,) in values(primitive["indices"])]
            yield values(primitive["attributes"]["POSITION"]), list(zip(*[iter(indices)] * 3))


def model(path, scale, turned=0.0, at=(0, 0, 0)):
    """The model as a Mesh: scaled, turned about y by degrees, moved."""
    mesh = Mesh()
    c, s = math.cos(math.radians(turned)), math.sin(math.radians(turned))
    for positions, triangles in read_model(path):
        placed = [mesh.vertex((scale * (c * x + s * z) + at[0], scale * y + at[1], scale * (c * z - s * x) + at[2]))
                  for x, y, z in positions]
        for triangle in triangles:
            corners = tuple(placed[i] for i in triangle)
            if len(set(corners)) == 3:
                mesh.triangles.append(corners)
    return mesh


def bunnies(path):
    """Three bunnies of half a metre round the ring, with the ring's own light."""
    s = Scene("bunnies", "Three bunnies and a metal ring, after Quyen 4.1.3")
    _, gold = ring_room(s)
    clay = s.diffuse("clay", SAND)
    s.add("ring", metal_band(0.55, 0.6, 0.27, 96), gold)
    scale = 3.2
    for i, (x, z, turned) in enumerate([(0.95, -0.75, 20), (1.15, 0.35, 70), (-0.25, -1.15, -10)]):
        s.add(f"bunny {i + 1}", model(path, scale, turned, (x, -0.032987 * scale, z)), clay)
    s.light("spot", "spot", (-1.75, 1.25, -0.75), (0.15, 0, 0.05), intensity=14.0, cone=(24, 32))
    s.camera("camera", (-0.5, 1.9, 2.0), (0.35, 0.1, -0.25), 50)
    return s


def ripples(x, z):
    """Two plane waves of 1 cm about y = 0.12 m; height and slopes."""
    height, slope_x, slope_z = 0.12, 0.0, 0.0
    for amplitude, length, degrees in [(0.01, 0.7, 25), (0.008, 0.53, -50)]:
        k = 2 * math.pi / length
        kx, kz = k * math.cos(math.radians(degrees)), k * math.sin(math.radians(degrees))
        height += amplitude * math.sin(kx * x + kz * z)
        slope_x += amplitude * kx * math.cos(kx * x + kz * z)
        slope_z += amplitude * kz * math.cos(kx * x + kz * z)
    return height, slope_x, slope_z


def sponza(path):
    """The atrium with three pools in the nave; the floor is at y = 0."""
    s = Scene("sponza-pools", "Crytek's Sponza with pools of water, after Quyen 4.3")
    s.add("sponza", model(path, 0.008), s.diffuse("stone", WHITE, doubleSided=True))
    water = s.material("water", roughness=0, doubleSided=True, extensions={
        "KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_ior": {"ior": 1.33},
        "KHR_materials_volume": {"thicknessFactor": 1},
    })
    for i, x in enumerate((-6.5, -0.5, 5.5)):
        s.add(f"pool {i + 1}", height_field((x - 2, -1.4), (x + 2, 1.0), (48, 32), ripples), water)
    s.light("spot", "spot", (1.5, 10.5, -0.6), (-0.8, 0, -0.2), intensity=2500.0, cone=(26, 34))
    s.camera("along", (8.5, 2.2, -0.3), (-1.0, 1.4, -0.2), 60)
    s.camera("pool", (3.2, 1.9, 0.7), (-0.8, 0.4, -0.6), 62)
    return s


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", choices=["bunnies", "sponza"])
    parser.add_argument("model", help="the .glb file of the model")
    parser.add_argument("-o", "--output", required=True, type=Path)
    arguments = parser.parse_args()
    s = {"bunnies": bunnies, "sponza": sponza}[arguments.scene](arguments.model)
    arguments.output.write_bytes(s.glb())
    print(f"{arguments.output}: {s.triangle_count:,} triangles", file=sys.stderr)


if __name__ == "__main__":
    main()
