#!/usr/bin/env python3
"""Makes the built-in scenes: `scenes/<name>.glb` and `scenes/README.md`.

    scenes/make.py            writes every file
    scenes/make.py --check    writes nothing; fails if a file differs by one byte from what would be written

Every scene is a function near the end of this file, marked `@scene(name, what it tests)`. The helpers before them make
meshes, pictures and glTF. Nothing here is random or depends on the machine: numbers are rounded before they are
written, and pictures are stored without compression.

Conventions:
- metres, y up; points and directions are (x, y, z).
- Radiometric: point and spot lights in W/sr, directional lights in W/m², emission in W/(m² sr), taken 1:1 from glTF.
- Front faces (counter-clockwise) look into the free space; emission leaves front faces alone; every surface blocks
  light from both sides.
- A mesh without normals is flat-shaded. "Diffuse" is metallic 0, roughness 1, specularFactor 0: Lambert alone.
- Colours are linear reflectances; light powers put lit surfaces at a radiance of about 0.1 to 2.
"""

import json
import math
import struct
import sys
import zlib
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).resolve().parent

# ---------------------------------------------------------------------------------------------- vectors


def tidy(value):
    """Rounds to 7 decimals, so that the last bits of a platform's sine do not reach a file; never -0."""
    return round(value, 7) + 0.0


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def normalize(a):
    length = math.sqrt(sum(x * x for x in a))
    return tuple(x / length for x in a)


def turn(axis, degrees):
    """The quaternion (x, y, z, w) of a rotation about an axis."""
    half = math.radians(degrees) / 2
    return (*(math.sin(half) * x for x in normalize(axis)), math.cos(half))


def look(eye, target):
    """The quaternion that turns -z, along which glTF cameras and lights look, from eye to target, with +y upwards."""
    z = normalize(sub(eye, target))
    up = (0, 1, 0) if abs(z[1]) < 0.999 else (0, 0, -1)
    x = normalize(cross(up, z))
    y = cross(z, x)
    m = (x, y, z)  # m[column][row]
    trace = m[0][0] + m[1][1] + m[2][2]
    if trace > 0:
        s = 2 * math.sqrt(1 + trace)
        return ((m[1][2] - m[2][1]) / s, (m[2][0] - m[0][2]) / s, (m[0][1] - m[1][0]) / s, s / 4)
    i = max(range(3), key=lambda axis: m[axis][axis])
    j, k = (i + 1) % 3, (i + 2) % 3
    s = 2 * math.sqrt(1 + m[i][i] - m[j][j] - m[k][k])
    q = [0, 0, 0, (m[j][k] - m[k][j]) / s]
    q[i], q[j], q[k] = s / 4, (m[i][j] + m[j][i]) / s, (m[i][k] + m[k][i]) / s
    return tuple(q)


# ---------------------------------------------------------------------------------------------- meshes


class Mesh:
    """Triangles with optional normals, texture coordinates and colours. Equal vertices are stored once."""

    def __init__(self):
        self.vertices = {}  # (position, normal, uv, colour) -> index
        self.triangles = []

    def vertex(self, position, normal=None, uv=None, colour=None):
        key = tuple(None if a is None else tuple(tidy(x) for x in a) for a in (position, normal, uv, colour))
        return self.vertices.setdefault(key, len(self.vertices))

    def quad(self, a, b, c, d):
        """Two triangles over four vertices (indices), counter-clockwise seen from the front."""
        for triangle in ((a, b, c), (a, c, d)):
            if len(set(triangle)) == 3:
                self.triangles.append(triangle)

    def attribute(self, which):
        """The values of one attribute in vertex order; empty if this mesh has none."""
        return [v[which] for v in self.vertices if v[which] is not None]


SIDES = {"-x": (0, -1), "+x": (0, 1), "-y": (1, -1), "+y": (1, 1), "-z": (2, -1), "+z": (2, 1)}


def face(lo, hi, side, inwards=False):
    """The corners of one side of a box, counter-clockwise seen from outside the box, or from inside it."""
    axis, sign = SIDES[side]
    b, c = (axis + 1) % 3, (axis + 2) % 3
    corners = []
    for from_b, from_c in ((lo, lo), (hi, lo), (hi, hi), (lo, hi)):
        corner = list(hi if sign > 0 else lo)
        corner[b], corner[c] = from_b[b], from_c[c]
        corners.append(tuple(corner))
    return corners if (sign > 0) != inwards else corners[::-1]


def box(lo, hi, without=()):
    """A box seen from outside; `without` names sides to leave out, such as the one it stands on."""
    mesh = Mesh()
    for side in SIDES:
        if side not in without:
            mesh.quad(*(mesh.vertex(p) for p in face(lo, hi, side)))
    return mesh


def sheet(origin, u, v, textured=True):
    """A flat rectangle that faces u × v; u points to the right of its picture, v upwards in it."""
    mesh = Mesh()
    corners = []
    for s, t in ((0, 0), (1, 0), (1, 1), (0, 1)):
        position = tuple(o + s * a + t * b for o, a, b in zip(origin, u, v))
        corners.append(mesh.vertex(position, uv=(s, 1 - t) if textured else None))
    mesh.quad(*corners)
    return mesh


class Cell(NamedTuple):
    """A cell of the grid that `cave` works on: its indices and its centre."""

    i: int
    j: int
    k: int
    x: float
    y: float
    z: float


def cave(xs, ys, zs, paint, solid=lambda cell: False):
    """Free space hollowed out of a solid: the surface between the cells of a grid that are free and those that are not.

    The grid lines are xs, ys, zs; all outside them is solid. `paint(side, cell)` gives the material of the surface on
    that side of a free cell ("-y" is its floor), or None for an opening. Edges meet vertex to vertex: no cracks.
    Returns {material: Mesh}, facing into the free space.
    """
    lines, counts = (xs, ys, zs), (len(xs) - 1, len(ys) - 1, len(zs) - 1)

    def cell(index):
        return Cell(*index, *((lines[a][index[a]] + lines[a][index[a] + 1]) / 2 for a in range(3)))

    def is_free(index):
        return all(0 <= index[a] < counts[a] for a in range(3)) and not solid(cell(index))

    parts = {}
    for index in ((i, j, k) for i in range(counts[0]) for j in range(counts[1]) for k in range(counts[2])):
        if not is_free(index):
            continue
        lo = tuple(lines[a][index[a]] for a in range(3))
        hi = tuple(lines[a][index[a] + 1] for a in range(3))
        for side, (axis, sign) in SIDES.items():
            neighbour = tuple(index[a] + (sign if a == axis else 0) for a in range(3))
            material = None if is_free(neighbour) else paint(side, cell(index))
            if material is not None:
                mesh = parts.setdefault(material, Mesh())
                mesh.quad(*(mesh.vertex(p) for p in face(lo, hi, side, inwards=True)))
    return parts


def lathe(runs, segments, colour=None):
    """A surface of revolution about y. Each run is a profile of (radius, height, normal's radius, normal's height);
    a run that goes up faces outwards, one that goes down faces the axis. Between runs the edge is sharp.
    `colour(angle, height)` gives vertex colours."""
    mesh = Mesh()
    for run in runs:
        rows = []
        for radius, y, normal_r, normal_y in run:
            row = []
            for segment in range(segments if radius else 1):
                angle = 2 * math.pi * segment / segments
                s, c = math.sin(angle), math.cos(angle)
                row.append(mesh.vertex((radius * s, y, radius * c), (normal_r * s, normal_y, normal_r * c),
                                       colour=colour(angle, y) if colour else None))
            rows.append(row)
        for low, high in zip(rows, rows[1:]):
            for s in range(segments):
                mesh.quad(*(row[at % len(row)] for row, at in ((low, s), (low, s + 1), (high, s + 1), (high, s))))
    return mesh


def arc(centre_r, centre_y, radius, start, end, steps):
    """A profile for `lathe`: a circular arc from one elevation to another, in degrees."""
    run = []
    for step in range(steps + 1):
        angle = math.radians(start + (end - start) * step / steps)
        c, s = tidy(math.cos(angle)), tidy(math.sin(angle))
        run.append((centre_r + radius * c, centre_y + radius * s, c, s))
    return run


def sphere(radius, segments, colour=None):
    return lathe([arc(0, 0, radius, -90, 90, segments // 2)], segments, colour)


def torus(ring_radius, tube_radius, segments, tube_segments):
    return lathe([arc(ring_radius, 0, tube_radius, -180, 180, tube_segments)], segments)


def metal_band(inner, outer, height, segments):
    """An upright ring, open at the bottom on which it stands: outer wall, flat rim, inner wall."""
    return lathe([
        [(outer, 0, 1, 0), (outer, height, 1, 0)],
        [(outer, height, 0, 1), (inner, height, 0, 1)],
        [(inner, height, -1, 0), (inner, 0, -1, 0)],
    ], segments)


def height_field(lo, hi, counts, height):
    """A surface y = height(x, z) that faces up, with exact normals; height returns (y, dy/dx, dy/dz)."""
    mesh = Mesh()
    rows = []
    for k in range(counts[1] + 1):
        z = lo[1] + (hi[1] - lo[1]) * k / counts[1]
        row = []
        for i in range(counts[0] + 1):
            x = lo[0] + (hi[0] - lo[0]) * i / counts[0]
            y, slope_x, slope_z = height(x, z)
            row.append(mesh.vertex((x, y, z), normalize((-slope_x, 1, -slope_z))))
        rows.append(row)
    for far, near in zip(rows, rows[1:]):
        for i in range(counts[0]):
            mesh.quad(near[i], near[i + 1], far[i + 1], far[i])
    return mesh


# ---------------------------------------------------------------------------------------------- pictures


def png(width, height, channels, pixel):
    """A PNG of 8-bit RGB (3 channels) or RGBA (4); pixel(column, row) gives bytes. Deflate "stored" blocks only,
    because compressors differ between versions."""
    rows = b"".join(b"\0" + bytes(v for x in range(width) for v in pixel(x, y)) for y in range(height))
    blocks = [rows[at:at + 65535] for at in range(0, len(rows), 65535)]
    stream = b"\x78\x01"
    for block in blocks:
        stream += struct.pack("<BHH", block is blocks[-1], len(block), len(block) ^ 0xFFFF) + block
    stream += struct.pack(">I", zlib.adler32(rows))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, {3: 2, 4: 6}[channels], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", stream) + chunk(b"IEND", b"")


def tiles(size=128):
    """A floor of 4 x 4 tiles in two tones (sRGB), each a little different, with dark joints."""
    def pixel(x, y):
        tile = size // 4
        column, row = x // tile, y // tile
        if x % tile in (0, tile - 1) or y % tile in (0, tile - 1):
            return (96, 90, 84)
        shade = (column * 37 + row * 59) % 24
        light, dark = (226, 214, 190), (150, 88, 66)
        return tuple(v - shade for v in (light if (column + row) % 2 else dark))
    return png(size, size, 3, pixel)


def brick_normals(size=128):
    """A tangent-space normal map of four courses of bricks with bevelled edges (+x right, +y up in the picture)."""
    course, length, bevel = size // 4, size // 2, 5

    def height(x, y):
        row = (y % size) // course
        inside_x = (x + (row % 2) * length // 2) % length
        inside_y = y % course
        edge = min(inside_x, length - 1 - inside_x, inside_y, course - 1 - inside_y)
        return 0.5 * min(edge, bevel)

    def pixel(x, y):
        right = (height(x + 1, y) - height(x - 1, y)) / 2
        up = (height(x, y - 1) - height(x, y + 1)) / 2
        return tuple(int(127.5 + 127.5 * v + 0.5) for v in normalize((-right, -up, 1)))
    return png(size, size, 3, pixel)


def lattice(size=64):
    """A lattice of diagonal slats with a solid frame; alpha 0 in the openings."""
    def pixel(x, y):
        pitch, slat, frame = size // 4, 4, 3
        on_slat = (x + y) % pitch < slat or (x - y) % pitch < slat
        on_frame = min(x, y, size - 1 - x, size - 1 - y) < frame
        return (120, 84, 52, 255 if on_slat or on_frame else 0)
    return png(size, size, 4, pixel)


# ---------------------------------------------------------------------------------------------- glTF

FLOAT, UNSIGNED_BYTE, UNSIGNED_SHORT, UNSIGNED_INT = 5126, 5121, 5123, 5125
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


class Scene:
    """A glTF document in the making. Methods that add something return its index."""

    def __init__(self, name, tests):
        self.name, self.tests = name, tests
        self.binary = b""
        self.triangle_count = 0
        self.used = set()
        self.document = {
            "asset": {"version": "2.0", "generator": "irradia scenes/make.py", "extras": {"description": tests}},
            "extensionsUsed": [], "extensions": {}, "scene": 0, "scenes": [{"name": name, "nodes": []}],
        }

    def put(self, what, value):
        values = self.document.setdefault(what, [])
        values.append(value)
        return len(values) - 1

    def dark(self, *cameras):
        """Says that these cameras stand in rooms that no light gets into."""
        self.document["asset"]["extras"]["dark"] = cameras

    def extension(self, name, value):
        self.used.add(name)
        return {name: value}

    # -- materials

    def material(self, name, colour=(1, 1, 1), metallic=0, roughness=1, **more):
        """A material; `more` are glTF members, with extensions under `extensions`."""
        self.used.update(more.get("extensions", {}))
        surface = {"baseColorFactor": [*colour, 1], "metallicFactor": metallic, "roughnessFactor": roughness}
        surface.update(more.pop("pbrMetallicRoughness", {}))
        return self.put("materials", {"name": name, "pbrMetallicRoughness": surface, **more})

    def diffuse(self, name, colour, emission=0, **more):
        """Lambert alone; `emission` is its own radiance in W/(m² sr)."""
        extensions = {"KHR_materials_specular": {"specularFactor": 0}}
        if emission:
            more["emissiveFactor"] = [1, 1, 1]
            extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": emission}
        return self.material(name, colour, extensions=extensions, **more)

    def texture(self, name, picture):
        view = self.view(picture)
        if "samplers" not in self.document:
            self.put("samplers", {"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497})
        image = self.put("images", {"name": name, "mimeType": "image/png", "bufferView": view})
        return self.put("textures", {"name": name, "sampler": 0, "source": image})

    # -- buffers

    def view(self, data, **more):
        self.binary += b"\0" * (-len(self.binary) % 4)
        offset = len(self.binary)
        self.binary += data
        return self.put("bufferViews", {"buffer": 0, "byteOffset": offset, "byteLength": len(data), **more})

    def accessor(self, values, kind, component=FLOAT, bounds=False, **more):
        letter = {FLOAT: "f", UNSIGNED_BYTE: "B", UNSIGNED_SHORT: "H", UNSIGNED_INT: "I"}[component]
        flat = [x for value in values for x in value]
        packed = struct.pack(f"<{len(flat)}{letter}", *flat)
        target = more.pop("target", None)
        out = {"bufferView": self.view(packed, **({"target": target} if target else {})),
               "componentType": component, "count": len(values), "type": kind, **more}
        if bounds:  # of the numbers as stored
            width = len(values[0])
            stored = struct.unpack(f"<{len(flat)}{letter}", packed)
            out["min"] = [min(stored[i::width]) for i in range(width)]
            out["max"] = [max(stored[i::width]) for i in range(width)]
        return self.put("accessors", out)

    def primitive(self, mesh, material):
        count = len(mesh.vertices)
        positions, normals, uvs, colours = (mesh.attribute(which) for which in range(4))
        attributes = {"POSITION": self.accessor(positions, "VEC3", bounds=True, target=ARRAY_BUFFER)}
        if normals:
            attributes["NORMAL"] = self.accessor(normals, "VEC3", target=ARRAY_BUFFER)
        if uvs:
            attributes["TEXCOORD_0"] = self.accessor(uvs, "VEC2", target=ARRAY_BUFFER)
        if colours:
            attributes["COLOR_0"] = self.accessor([[int(255 * x + 0.5) for x in (*c, 1)] for c in colours], "VEC4",
                                                  UNSIGNED_BYTE, normalized=True, target=ARRAY_BUFFER)
        component = UNSIGNED_SHORT if count < 65535 else UNSIGNED_INT
        indices = self.accessor([(i,) for t in mesh.triangles for i in t], "SCALAR", component,
                                target=ELEMENT_ARRAY_BUFFER)
        self.triangle_count += len(mesh.triangles)
        return {"attributes": attributes, "indices": indices, "material": material}

    # -- nodes

    def node(self, name, parent=None, at=None, rotation=None, **more):
        node = {"name": name, **more}
        if at is not None:
            node["translation"] = [tidy(x) for x in at]
        if rotation is not None:
            node["rotation"] = [tidy(x) for x in rotation]
        index = self.put("nodes", node)
        siblings = self.document["scenes"][0] if parent is None else self.document["nodes"][parent]
        siblings.setdefault("nodes" if parent is None else "children", []).append(index)
        return index

    def add(self, name, parts, material=None, **placed):
        """A node with a mesh: one Mesh and its material, or {material: Mesh}."""
        if material is not None:
            parts = {material: parts}
        primitives = [self.primitive(mesh, which) for which, mesh in parts.items()]
        return self.node(name, mesh=self.put("meshes", {"name": name, "primitives": primitives}), **placed)

    def camera(self, name, eye, target, degrees):
        """A camera with a vertical field of view and no far plane; the aspect is the picture's."""
        lens = {"yfov": tidy(math.radians(degrees)), "znear": 0.01}
        camera = self.put("cameras", {"name": name, "type": "perspective", "perspective": lens})
        return self.node(name, at=eye, rotation=look(eye, target), camera=camera)

    def light(self, name, kind, at, target=None, intensity=1.0, colour=(1, 1, 1), cone=None):
        """A light of W/sr (point, spot) or W/m² (directional); `cone` is the inner and outer half angle in degrees."""
        light = {"name": name, "type": kind, "color": list(colour), "intensity": intensity}
        if cone:
            light["spot"] = {f"{which}ConeAngle": tidy(math.radians(a)) for which, a in zip(("inner", "outer"), cone)}
        lights = self.document["extensions"].setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append(light)
        return self.node(name, at=at, rotation=look(at, target) if target else None,
                         extensions=self.extension("KHR_lights_punctual", {"light": len(lights) - 1}))

    def animate(self, name, seconds, channels):
        """One animation; `channels` are (node, what, values at those seconds): "translation" and "rotation", linear between, or
        "intensity" of the light that the node places, which steps."""
        times = self.accessor([(s,) for s in seconds], "SCALAR", bounds=True)
        samplers, targets = [], []
        for node, path, values in channels:
            if path == "intensity":
                light = self.document["nodes"][node]["extensions"]["KHR_lights_punctual"]["light"]
                pointer = f"/extensions/KHR_lights_punctual/lights/{light}/intensity"
                target = {"path": "pointer", "extensions": self.extension("KHR_animation_pointer", {"pointer": pointer})}
                samplers.append({"input": times, "interpolation": "STEP",
                                 "output": self.accessor([(value,) for value in values], "SCALAR")})
            else:
                target = {"node": node, "path": path}
                rows = [tuple(tidy(x) for x in value) for value in values]
                samplers.append({"input": times, "interpolation": "LINEAR",
                                 "output": self.accessor(rows, "VEC4" if path == "rotation" else "VEC3")})
            targets.append({"sampler": len(samplers) - 1, "target": target})
        return self.put("animations", {"name": name, "samplers": samplers, "channels": targets})

    # -- output

    def glb(self):
        document = dict(self.document, extensionsUsed=sorted(self.used), buffers=[{"byteLength": len(self.binary)}])
        if not document["extensions"]:
            del document["extensions"]
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        binary = self.binary + b"\0" * (-len(self.binary) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks

    def lights_in_words(self):
        words = []
        for light in self.document["extensions"].get("KHR_lights_punctual", {"lights": []})["lights"]:
            unit = "W/m²" if light["type"] == "directional" else "W/sr"
            cone = ""
            if "spot" in light:
                angles = (light["spot"][f"{which}ConeAngle"] for which in ("inner", "outer"))
                cone = " " + "/".join(f"{math.degrees(a):.0f}°" for a in angles)
            words.append(f"{light['type']}{cone} {light['intensity']:g} {unit}")
        for material in self.document["materials"]:
            strength = material.get("extensions", {}).get("KHR_materials_emissive_strength")
            if strength:
                words.append(f"emission of `{material['name']}` {strength['emissiveStrength']:g} W/(m² sr)")
        return ", ".join(f"{words.count(w)} × {w}" if words.count(w) > 1 else w for w in dict.fromkeys(words))


SCENES = {}


def scene(name, tests):
    """Marks a function that fills a Scene."""
    def register(fill):
        def build():
            s = Scene(name, tests)
            fill(s)
            return s
        SCENES[name] = build
        return fill
    return register


# ---------------------------------------------------------------------------------------------- the scenes

WHITE, GREY, RED, GREEN = (0.73, 0.73, 0.73), (0.5, 0.5, 0.5), (0.63, 0.065, 0.05), (0.14, 0.45, 0.09)
BLUE, OCHRE, SAND = (0.12, 0.2, 0.5), (0.7, 0.42, 0.12), (0.7, 0.62, 0.5)
GOLD = (1.0, 0.78, 0.34)


def cornell(s, blocks=True, panel=None, floor=None, metals=None, bottom=True):
    """A Cornell box, 2 x 2 m and 3.6 m deep: closed, its camera inside before the front wall. Without its bottom
    something else has to close it."""
    white, red, green = s.diffuse("white", WHITE), s.diffuse("red", RED), s.diffuse("green", GREEN)

    def paint(side, cell):
        if panel is not None and side == "+y" and (cell.i, cell.k) == (1, 1):
            return panel
        if side == "-y" and not bottom:
            return None
        return {"-x": red, "+x": green, "-y": white if floor is None else floor}.get(side, white)

    hole_x, hole_z = ([-0.3, 0.3], [-0.25, 0.25]) if panel is not None else ([], [])
    s.add("room", cave([-1, *hole_x, 1], [0, 2], [-1, *hole_z, 2.6], paint))
    if blocks:
        tall, short = metals or (white, white)
        s.add("tall block", box((-0.3, 0, -0.3), (0.3, 1.2, 0.3), without=["-y"]), tall,
              at=(-0.35, 0, -0.4), rotation=turn((0, 1, 0), 17))
        s.add("short block", box((-0.3, 0, -0.3), (0.3, 0.6, 0.3), without=["-y"]), short,
              at=(0.37, 0, 0.2), rotation=turn((0, 1, 0), -17))
    s.camera("camera", (0, 1, 2.5), (0, 0.97, 0), 50)


@scene("cornell-point", "Cornell box, closed and diffuse, under a point light: direct light, shadows, colour bleeding")
def cornell_point(s):
    cornell(s)
    s.light("lamp", "point", (0, 1.45, 0.1), intensity=3.0)


@scene("cornell-empty", "The closed Cornell box without its blocks: sums over virtual point lights have no occluder")
def cornell_empty(s):
    cornell(s, blocks=False)
    s.light("lamp", "point", (0, 1.45, 0.1), intensity=3.0)


@scene("cornell-spot", "Cornell box with a spot light on the floor by the red wall: most of the picture is indirect")
def cornell_spot(s):
    cornell(s)
    s.light("spot", "spot", (0.3, 1.9, 0.95), (-0.75, 0.1, 0.85), intensity=22.0, cone=(25, 35))


@scene("cornell-panel", "Cornell box lit by an emissive ceiling panel alone: emission as a light")
def cornell_panel(s):
    cornell(s, panel=s.diffuse("panel", (0, 0, 0), emission=16.0))


@scene("cornell-glossy", "Cornell box with a varnished floor and blocks of rough metal: glossy reflections of diffuse light")
def cornell_glossy(s):
    varnish = s.material("varnish", GREY, roughness=0.3)
    cornell(s, floor=varnish, metals=(s.material("gold", GOLD, metallic=1, roughness=0.4),
                                      s.material("steel", (0.6, 0.6, 0.62), metallic=1, roughness=0.25)))
    s.light("lamp", "point", (0, 1.45, 0.1), intensity=3.0)


@scene("furnace", "Closed white furnace, albedo 0.5 and emission 1: the radiance is 1/(1 - 0.5) = 2 everywhere")
def furnace(s):
    wall = s.diffuse("wall", GREY, emission=1.0)
    s.add("furnace", cave([-1, 1], [0, 2], [-1, 1], lambda side, cell: wall))
    s.camera("camera", (0.3, 0.8, 0.8), (-0.2, 1.1, -0.6), 60)


def ring_room(s):
    """The closed room of both ring scenes, and its metals."""
    white, left, right = s.diffuse("white", WHITE), s.diffuse("ochre", OCHRE), s.diffuse("sand", SAND)
    s.add("room", cave([-2, 2], [0, 2.6], [-2, 2], lambda side, cell: {"-x": left, "+x": right}.get(side, white)))
    return white, s.material("gold", GOLD, metallic=1, roughness=0.05)


@scene("ring", "Metal ring on a diffuse floor under a spot light, after Quyen 4.1.1: the caustic inside the ring")
def ring(s):
    _, gold = ring_room(s)
    s.add("ring", metal_band(0.55, 0.6, 0.27, 96), gold)
    s.light("spot", "spot", (-1.75, 1.25, -0.75), (0.15, 0, 0.05), intensity=14.0, cone=(24, 32))
    s.camera("camera", (0.35, 1.85, 1.55), (0.03, 0.05, -0.02), 42)


@scene("ring-occluded", "The ring on two platforms behind four screens, after Quyen 4.1.2: more surfaces lie over each "
       "other than four depth layers hold")
def ring_occluded(s):
    white, gold = ring_room(s)
    s.add("lower platform", box((-0.95, 0, -0.95), (0.95, 0.15, 0.95), without=["-y"]), white)
    s.add("upper platform", box((-0.75, 0.15, -0.75), (0.75, 0.3, 0.75), without=["-y"]), white)
    s.add("ring", metal_band(0.55, 0.6, 0.27, 96), gold, at=(0, 0.3, 0))
    colours = [RED, GREEN, SAND, BLUE]
    for i, colour in enumerate(colours):
        z = 1.02 + 0.14 * i
        s.add(f"screen {i + 1}", box((-1.0 + 0.1 * i, 0, z), (0.12 + 0.1 * i, 1.12 + 0.06 * i, z + 0.03), without=["-y"]),
              s.diffuse(f"screen {i + 1}", colour))
    s.light("spot", "spot", (-1.75, 1.55, -0.75), (0.15, 0.3, 0.05), intensity=14.0, cone=(24, 32))
    s.camera("camera", (0.35, 2.15, 1.8), (0.0, 0.4, 0.05), 44)


def rippled(level, waves):
    """A plane at a height in metres with waves on it: a function that returns height and slopes."""
    def height(x, z):
        y, slope_x, slope_z = level, 0.0, 0.0
        for amplitude, length, degrees, phase in waves:
            k = 2 * math.pi / length
            kx, kz = k * math.cos(math.radians(degrees)), k * math.sin(math.radians(degrees))
            angle = kx * x + kz * z + phase
            y += amplitude * math.sin(angle)
            slope_x += amplitude * kx * math.cos(angle)
            slope_z += amplitude * kz * math.cos(angle)
        return y, slope_x, slope_z
    return height


# amplitude in m, wavelength in m, direction in degrees, phase
WAVES = [(0.0075, 0.9, 12, 0.3), (0.006, 0.72, 71, 1.9), (0.0045, 0.61, -48, 4.1), (0.003, 0.47, 128, 2.6),
         (0.002, 0.39, 30, 5.2)]
HILLS = [(0.026, 1.3, 20, 0.4), (0.018, 0.9, 103, 2.2), (0.012, 0.61, -37, 4.4), (0.008, 0.43, 66, 1.1),
         (0.005, 0.31, -80, 3.3), (0.003, 0.22, 5, 5.6)]


@scene("water", "Room with a metre of wavy water (one double-sided sheet that reaches into the walls), after Quyen 4.2: "
       "reflected caustics on the far wall, refracted ones under water")
def water(s):
    white, left, right = s.diffuse("white", WHITE), s.diffuse("ochre", OCHRE), s.diffuse("green", GREEN)
    s.add("room", cave([-2, 2], [0, 2.8], [-1.5, 1.5], lambda side, cell: {"-z": left, "+z": right}.get(side, white)))
    sheet_of_water = s.material("water", roughness=0, doubleSided=True, extensions={
        "KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_ior": {"ior": 1.33},
        "KHR_materials_volume": {"thicknessFactor": 1},
    })
    s.add("water", height_field((-2.02, -1.52), (2.02, 1.52), (64, 64), rippled(1.0, WAVES)), sheet_of_water)
    s.light("low spot", "spot", (-1.85, 1.6, 0), (-0.5, 1.0, 0), intensity=38.0, cone=(13, 15))
    s.light("ceiling lamp", "point", (-0.3, 2.4, 0.1), intensity=1.5)
    s.camera("above", (-1.7, 2.3, 1.1), (1.3, 0.95, -0.35), 62)
    s.camera("under", (-1.0, 0.8, 1.3), (0.6, 0.0, -0.35), 68)


@scene("bumpy", "Cornell box with a bumpy floor, after Larsen & Christensen 2004, figures 1 and 6: what many triangles cost")
def bumpy(s):
    cornell(s, bottom=False)
    s.add("floor", height_field((-1.02, -1.02), (1.02, 2.62), (72, 90), rippled(0.08, HILLS)), s.diffuse("floor", WHITE))
    s.light("lamp", "point", (0, 1.45, 0.1), intensity=3.0)


@scene("corridor", "L-shaped corridor lit from the end of its other leg: light that comes round the corner")
def corridor(s):
    white, orange, floor = s.diffuse("white", WHITE), s.diffuse("ochre", OCHRE), s.diffuse("floor", (0.45, 0.43, 0.4))

    def paint(side, cell):
        if side == "-z" and cell.x > 0.8:
            return orange
        return floor if side == "-y" else white

    s.add("corridor", cave([-0.8, 0.8, 3.8], [0, 2.4], [-0.8, 0.8, 4.4], paint,
                           solid=lambda cell: cell.x > 0.8 and cell.z > 0.8))
    s.add("crate", box((-0.25, 0, -0.25), (0.25, 0.5, 0.25), without=["-y"]), s.diffuse("blue", BLUE),
          at=(-0.4, 0, 1.9), rotation=turn((0, 1, 0), 25))
    s.light("lamp", "point", (2.9, 1.5, 0), intensity=15.0)
    s.camera("camera", (0.15, 1.45, 4.2), (-0.02, 1.1, 0), 58)


@scene("two-rooms", "Two rooms and a half-open door with the lamp in the far room: light through a gap")
def two_rooms(s):
    white, warm, cool = s.diffuse("white", WHITE), s.diffuse("ochre", OCHRE), s.diffuse("blue", BLUE)
    floor = s.diffuse("floor", (0.5, 0.46, 0.42))

    def paint(side, cell):
        if side == "-y":
            return floor
        if side == "+x" and cell.x > 0.05:
            return warm
        return cool if side == "-z" and cell.x < -0.05 else white

    s.add("rooms", cave([-3.05, -0.05, 0.05, 3.05], [0, 2, 2.5], [-1.5, -0.45, 0.45, 1.5], paint,
                        solid=lambda cell: abs(cell.x) < 0.05 and (cell.y > 2 or abs(cell.z) > 0.45)))
    s.add("door", box((-0.02, 0.01, 0.0), (0.02, 1.99, 0.88)), s.diffuse("door", (0.55, 0.33, 0.16)),
          at=(-0.06, 0, -0.44), rotation=turn((0, 1, 0), -58))
    s.add("block", box((-0.25, 0, -0.25), (0.25, 0.5, 0.25), without=["-y"]), white,
          at=(-1.75, 0, 0.75), rotation=turn((0, 1, 0), 30))
    s.light("lamp", "point", (1.55, 1.8, 0.55), intensity=12.0)
    s.camera("camera", (-2.9, 1.5, 1.2), (-0.3, 1.0, -0.2), 60)


@scene("leak", "A bright hall beside dark rooms, behind 5 mm of wall, behind 0.4 m, and sealed within it: "
       "the dark rooms' radiance is zero")
def leak(s):
    white, red = s.diffuse("white", WHITE), s.diffuse("red", RED)
    hall, bay = ((-3, 0, -3.4), (0, 2.6, 4.2)), ((0, 0, 1.4), (2.4, 2.6, 4.2))
    cell_outside, cell_inside = ((0.4, 0, 1.8), (2.0, 2.2, 3.8)), ((0.5, 0.1, 1.9), (1.9, 2.1, 3.7))
    behind_thin, behind_thick = ((0.005, 0, -3.4), (2.4, 2.6, -1.4)), ((0.4, 0, -1), (2.4, 2.6, 1))

    def within(cell, *boxes):
        return any(all(a < v < b for a, v, b in zip(lo, cell[3:], hi)) for lo, hi in boxes)

    def is_solid(cell):
        if within(cell, cell_outside):
            return not within(cell, cell_inside)
        return not within(cell, hall, bay, behind_thin, behind_thick)

    s.add("building", cave([-3, 0, 0.005, 0.4, 0.5, 1.9, 2.0, 2.4], [0, 0.1, 2.1, 2.2, 2.6],
                           [-3.4, -1.4, -1, 1, 1.4, 1.8, 1.9, 3.7, 3.8, 4.2],
                           lambda side, cell: red if side == "-x" and cell.x < 0 else white, is_solid))
    block = s.diffuse("block", SAND)
    for name, at in (("thin", (0.9, 0, -2.7)), ("thick", (1.2, 0, -0.4)), ("sealed", (1.0, 0.1, 2.5)),
                     ("hall", (-1.4, 0, 0.6))):
        s.add(f"block {name}", box((-0.22, 0, -0.22), (0.22, 0.7, 0.22), without=["-y"]), block,
              at=at, rotation=turn((0, 1, 0), 20))
    s.light("lamp 1", "point", (-1.5, 1.7, -1.9), intensity=4.5)
    s.light("lamp 2", "point", (-0.9, 1.7, 2.6), intensity=4.5)
    s.camera("thin", (2.2, 1.6, -1.6), (0.1, 1.0, -2.6), 70)
    s.camera("thick", (2.2, 1.6, 0.8), (0.5, 1.0, -0.3), 70)
    s.camera("sealed", (1.75, 1.7, 3.5), (0.7, 0.8, 2.2), 75)
    s.camera("lit", (-2.7, 1.9, -3.1), (0.2, 0.8, 2.4), 65)
    s.dark("thin", "thick", "sealed")


def maze_walls(size):
    """A perfect maze of size x size cells, by depth-first search with a fixed generator: the set of wall squares in a
    grid of 2 size + 1, in which even rows and columns are walls and odd ones are cells."""
    state = 2015

    def draw(count):
        nonlocal state
        state = (state * 1103515245 + 12345) % 2 ** 31
        return (state >> 16) % count

    walls = {(i, k) for i in range(2 * size + 1) for k in range(2 * size + 1) if i % 2 == 0 or k % 2 == 0}
    path, seen = [(1, 1)], {(1, 1)}
    while path:
        i, k = path[-1]
        steps = [(di, dk) for di, dk in ((2, 0), (-2, 0), (0, 2), (0, -2))
                 if 0 < i + di < 2 * size and 0 < k + dk < 2 * size and (i + di, k + dk) not in seen]
        if not steps:
            path.pop()
            continue
        di, dk = steps[draw(len(steps))]
        walls.remove((i + di // 2, k + dk // 2))
        path.append((i + di, k + dk))
        seen.add(path[-1])
    return walls


@scene("maze", "A maze of coloured walls with two lamps and two people, after Chang et al. figure 1: "
       "many bounces of diffuse light")
def maze(s):
    size, cell_size, half_wall, height = 8, 1.5, 0.08, 1.2
    walls = maze_walls(size)
    lines = [c * cell_size - size * cell_size / 2 + side * half_wall for c in range(size + 1) for side in (-1, 1)]
    hall = [-10, *lines, 10]
    white, floor = s.diffuse("white", WHITE), s.diffuse("floor", (0.6, 0.58, 0.54))
    colours = [s.diffuse(name, colour) for name, colour in
               (("red", RED), ("ochre", OCHRE), ("green", GREEN), ("blue", BLUE))]

    def is_wall(i, j, k):
        return j == 0 and (i - 1, k - 1) in walls

    def paint(side, cell):
        axis, sign = SIDES[side]
        i, j, k = (v + (sign if a == axis else 0) for a, v in enumerate(cell[:3]))
        if is_wall(i, j, k):
            return colours[2 * (i > size) + (k > size)] if 1 < i < 2 * size + 1 and 1 < k < 2 * size + 1 else white
        return floor if side == "-y" else white

    s.add("maze", cave(hall, [0, height, 12], hall, paint, solid=lambda cell: is_wall(*cell[:3])))
    body = [[(0.2, 0, 1, 0), (0.2, 1.1, 1, 0)], arc(0, 1.1, 0.2, 0, 90, 4)]
    skin = s.diffuse("skin", (0.75, 0.55, 0.42))
    for name, colour, (x, z) in (("first", (0.75, 0.3, 0.1), (-2.25, 2.25)),
                                 ("second", (0.1, 0.35, 0.6), (3.75, -0.75))):
        person = s.node(f"{name} person", at=(x, 0, z))
        s.add(f"{name} body", lathe(body, 16), s.diffuse(f"{name} clothes", colour), parent=person)
        s.add(f"{name} head", sphere(0.14, 16), skin, parent=person, at=(0, 1.46, 0))
    s.light("warm lamp", "point", (-2.25, 2.6, 0.75), intensity=30.0, colour=(1, 0.8, 0.55))
    s.light("cool lamp", "point", (3.75, 2.6, -2.25), intensity=30.0, colour=(0.65, 0.82, 1))
    s.camera("camera", (0, 10.6, 8.6), (0, 0, 0.55), 52)


@scene("animated", "Two seconds of motion (60 frames): a moving light, a turning and a hopping object, a moving camera")
def animated(s):
    white, left, right = s.diffuse("white", WHITE), s.diffuse("red", RED), s.diffuse("green", GREEN)
    s.add("room", cave([-1.5, 1.5], [0, 2.4], [-1.5, 2], lambda side, cell: {"-x": left, "+x": right}.get(side, white)))
    steps = 16
    seconds = [2 * i / steps for i in range(steps + 1)]
    angles = [2 * math.pi * i / steps for i in range(steps + 1)]

    carousel = s.node("carousel", at=(0, 0.3, -0.2))
    s.add("bar", box((-0.75, -0.05, -0.12), (0.75, 0.05, 0.12)), s.diffuse("ochre", OCHRE), parent=carousel)
    s.add("post", box((-0.1, 0, -0.1), (0.1, 0.8, 0.1)), s.diffuse("blue", BLUE), parent=carousel, at=(0.55, 0.05, 0))
    ball = s.add("ball", sphere(0.2, 24), white, at=(0.0, 0.9, -0.2))
    torus_node = s.add("torus", torus(0.28, 0.08, 32, 12), s.diffuse("sand", SAND), at=(-0.85, 1.3, -0.9))
    lamp = s.light("lamp", "point", (0.7, 1.9, 0.2), intensity=5.0)
    eyes = [(0.5 * math.sin(a), 1.35 + 0.1 * math.sin(a), 1.8) for a in angles]
    camera = s.camera("camera", eyes[0], (0, 0.85, -0.3), 58)
    s.animate("two seconds", seconds, [
        (carousel, "rotation", [turn((0, 1, 0), math.degrees(a)) for a in angles]),
        (ball, "translation", [(0, 0.9 + 0.3 * abs(math.sin(a)), -0.2) for a in angles]),
        (torus_node, "rotation", [turn((1, 0, 0.3), math.degrees(a)) for a in angles]),
        (lamp, "translation", [(0.7 * math.cos(a), 1.9, 0.2 + 0.7 * math.sin(a)) for a in angles]),
        (camera, "translation", eyes),
        (camera, "rotation", [look(eye, (0, 0.85, -0.3)) for eye in eyes]),
    ])


def two_seconds(steps=16):
    """The times of a loop of two seconds, and as many angles of one turn, in radians."""
    return [2 * i / steps for i in range(steps + 1)], [2 * math.pi * i / steps for i in range(steps + 1)]


@scene("cube-and-sphere", "Two seconds of a turning cube and a circling glass ball whose caustic crosses it, after Larsen & Christensen figure 4")
def cube_and_sphere(s):
    white, left, right = s.diffuse("white", WHITE), s.diffuse("red", RED), s.diffuse("green", GREEN)
    s.add("room", cave([-1.5, 1.5], [0, 2.4], [-1.5, 2], lambda side, cell: {"-x": left, "+x": right}.get(side, white)))
    glass = s.material("glass", roughness=0, extensions={
        "KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_ior": {"ior": 1.5},
        "KHR_materials_volume": {"thicknessFactor": 0.6},
    })
    seconds, angles = two_seconds()
    cube = s.add("cube", box((-0.3, -0.3, -0.3), (0.3, 0.3, 0.3)), s.diffuse("sand", SAND), at=(-0.55, 0.32, -0.5))
    ways = [(0.1 + 0.4 * math.sin(a), 0.75 + 0.2 * math.cos(a), 0.1 - 0.35 * math.cos(a)) for a in angles]
    ball = s.add("ball", sphere(0.3, 32), glass, at=ways[0])
    s.light("lamp", "point", (0.9, 2.1, 0.6), intensity=5.0)
    s.camera("camera", (0, 1.3, 1.85), (-0.05, 0.75, -0.5), 58)
    s.animate("two seconds", seconds, [
        (cube, "rotation", [turn((0, 1, 0), math.degrees(a)) for a in angles]),
        (ball, "translation", ways),
    ])


def two_lit_rooms(s, door=True, right_lit=True, moving=True, cameras=("left", "right")):
    """Two rooms side by side, two lamps in each, the wall between them with or without an opening; in the left one a bar turns and
    a cube glides. Returns the nodes of the right room's lamps."""
    white, warm, cool = s.diffuse("white", WHITE), s.diffuse("ochre", OCHRE), s.diffuse("blue", BLUE)
    floor = s.diffuse("floor", (0.5, 0.46, 0.42))

    def paint(side, cell):
        if side == "-y":
            return floor
        if side == "+x" and cell.x > 0.05:
            return warm
        return cool if side == "-x" and cell.x < -0.05 else white

    def is_wall(cell):
        return abs(cell.x) < 0.05 and not (door and cell.y < 2 and abs(cell.z) < 0.6)

    s.add("rooms", cave([-3.05, -0.05, 0.05, 3.05], [0, 2, 2.5], [-1.5, -0.6, 0.6, 1.5], paint, solid=is_wall))
    seconds, angles = two_seconds()
    bar = s.add("bar", box((-0.6, -0.06, -0.1), (0.6, 0.06, 0.1)), s.diffuse("red", RED), at=(-1.75, 0.8, -0.3))
    ways = [(-1.2 - 0.7 * math.sin(a / 2) ** 2, 0.22, 0.7) for a in angles]
    cube = s.add("cube", box((-0.2, -0.2, -0.2), (0.2, 0.2, 0.2)), s.diffuse("green", GREEN), at=ways[0])
    s.add("block", box((-0.25, 0, -0.25), (0.25, 0.7, 0.25), without=["-y"]), s.diffuse("sand", SAND),
          at=(1.9, 0, -0.5), rotation=turn((0, 1, 0), 25))
    lamps = []
    for name, x in (("left", -1.6), ("right", 1.6)):
        if name == "left" or right_lit:
            lamps += [s.light(f"{name} lamp {i + 1}", "point", (x, 2.1, z), intensity=3.0) for i, z in enumerate((-0.9, 0.9))]
    views = {"left": ((-2.85, 1.6, 1.25), (-0.6, 0.9, -0.25)), "right": ((2.85, 1.6, 1.25), (0.6, 0.9, -0.25))}
    for name in cameras:
        s.camera(name, *views[name], 64)
    if moving:
        s.animate("two seconds", seconds, [
            (bar, "rotation", [turn((0, 1, 0), math.degrees(a)) for a in angles]),
            (cube, "translation", ways),
        ])
    return lamps[2:]


@scene("rooms-divided", "Two seconds of motion in one of two rooms that no light passes between, after Larsen & Christensen figure 5, top: "
       "nothing changes in the other room")
def rooms_divided(s):
    two_lit_rooms(s, door=False)


@scene("rooms-connected", "The same with an opening between the rooms, after Larsen & Christensen figure 5, middle: what moves changes the light in both")
def rooms_connected(s):
    two_lit_rooms(s)


@scene("rooms-dimmed", "The same with the right room's lamps off, after Larsen & Christensen figure 5, bottom: it has the light of the left room alone")
def rooms_dimmed(s):
    two_lit_rooms(s, right_lit=False, cameras=("right", "left"))


@scene("rooms-switched", "From figure 5's middle to its bottom and back: nothing moves, the right room's lamps go off after half a second and on "
       "again after one and a half")
def rooms_switched(s):
    lamps = two_lit_rooms(s, moving=False, cameras=("right", "left"))
    s.animate("two seconds", [0, 0.5, 1.5, 2], [(lamp, "intensity", [3, 0, 3, 3]) for lamp in lamps])


@scene("textured", "Textures: tiles through a texture transform, a normal map without tangents, an alpha-masked lattice "
       "before the spot light, vertex colours")
def textured(s):
    white = s.diffuse("white", WHITE)
    s.add("room", cave([-1.5, 1.5], [0, 2.4], [-1.5, 1.7], lambda side, cell: None if side in ("-y", "-z") else white))
    transform = {"KHR_texture_transform": {"offset": [0.1, 0.05], "rotation": tidy(math.pi / 4), "scale": [2, 2]}}
    s.used.update(transform)
    tile_texture = {"index": s.texture("tiles", tiles()), "extensions": transform}
    s.add("floor", sheet((-1.5, 0, 1.7), (3, 0, 0), (0, 0, -3.2)),
          s.diffuse("tiles", (1, 1, 1), pbrMetallicRoughness={"baseColorTexture": tile_texture}))
    bricks = {"index": s.texture("brick normals", brick_normals()), "scale": 1}
    wall = sheet((-1.5, 0, -1.5), (3, 0, 0), (0, 2.4, 0))
    s.add("brick wall", wall, s.diffuse("bricks", (0.62, 0.4, 0.3), normalTexture=bricks))
    slats = {"index": s.texture("lattice", lattice())}
    s.add("lattice", sheet((-0.35, -0.35, 0), (0.7, 0, 0), (0, 0.7, 0)),
          s.diffuse("lattice", (1, 1, 1), pbrMetallicRoughness={"baseColorTexture": slats}, alphaMode="MASK",
                    alphaCutoff=0.5, doubleSided=True),
          at=(0.75, 1.62, 0.35), rotation=look((1.3, 2.2, 0.9), (-0.35, 0.45, -0.75)))
    hue = lambda angle, y: tuple(0.5 + 0.35 * math.cos(angle - turn_by) + 0.4 * y for turn_by in (0, 2.1, 4.2))
    s.add("ball", sphere(0.35, 32, hue), s.diffuse("vertex colours", (1, 1, 1)), at=(-0.35, 0.35, -0.65))
    s.light("spot", "spot", (1.3, 2.2, 0.9), (-0.35, 0.45, -0.75), intensity=36.0, cone=(22, 30))
    s.light("fill", "point", (-1.0, 1.7, 0.9), intensity=1.2)
    s.camera("camera", (-0.55, 1.45, 1.6), (0.05, 0.85, -0.8), 62)


@scene("lights", "Every kind of light in one room: point, spot, sun through a skylight, emissive sphere; "
       "how their flux shares the virtual point lights")
def lights(s):
    white, left, right = s.diffuse("white", WHITE), s.diffuse("red", RED), s.diffuse("blue", BLUE)
    floor = s.diffuse("floor", (0.55, 0.52, 0.48))

    def paint(side, cell):
        if cell.y > 2.6:
            return None if side == "+y" else white
        return {"-x": left, "+x": right, "-y": floor}.get(side, white)

    s.add("room with a skylight", cave([-2, -1.3, -0.3, 2], [0, 2.6, 2.9], [-2, -1.0, 0.0, 2], paint,
                                       solid=lambda cell: cell.y > 2.6 and (cell.i, cell.k) != (1, 1)))
    s.add("column", box((-0.2, 0, -0.2), (0.2, 1.5, 0.2), without=["-y"]), white, at=(-1.2, 0, -1.1),
          rotation=turn((0, 1, 0), 35))
    s.add("block", box((-0.3, 0, -0.3), (0.3, 0.6, 0.3), without=["-y"]), s.diffuse("sand", SAND),
          at=(1.15, 0, -0.75), rotation=turn((0, 1, 0), 15))
    s.add("globe", sphere(0.16, 24), s.diffuse("globe", (0, 0, 0), emission=5.0), at=(1.15, 0.76, -0.75))
    s.light("lamp", "point", (0.4, 1.8, -0.9), intensity=1.5, colour=(1, 0.9, 0.75))
    s.light("spot", "spot", (1.6, 2.3, 0.8), (-0.8, 1.15, -2.0), intensity=24.0, cone=(16, 24))
    s.light("sun", "directional", (0, 6, 0), (2.0, 0, 0.5), intensity=8.0, colour=(1, 0.95, 0.85))
    s.camera("camera", (0.3, 1.6, 1.9), (-0.05, 0.9, -1.0), 66)


@scene("plane", "Point light of 2 pi W/sr 1 m above a plane of albedo 0.5: the radiance is cos(angle)/distance²")
def plane(s):
    s.add("plane", sheet((-100, 0, 100), (200, 0, 0), (0, 0, -200), textured=False), s.diffuse("plane", GREY))
    s.light("lamp", "point", (0, 1, 0), intensity=tidy(2 * math.pi))
    s.camera("camera", (0, 2.4, 2.4), (0, 0, 0.1), 45)


# ---------------------------------------------------------------------------------------------- files

README = """\
# Built-in scenes

Small glTF 2.0 files made by [`make.py`](make.py), which also writes this page. `make.py --check` fails if a file
differs from what it would write. Their names work wherever the command line takes a scene: `irradia render ring -o ring.exr`.

Metres, y up. Radiometric units 1:1 from glTF: point and spot W/sr, directional W/m², emission W/(m² sr). Front faces look
into the free space, emission leaves front faces alone, every surface blocks light from both sides. Diffuse surfaces have
`specularFactor` 0. Meshes without normals are flat-shaded. All rooms are closed except the skylight of `lights`; `plane` is open.

| name | tests | triangles | light | cameras | kB |
| --- | --- | ---: | --- | --- | ---: |
"""


def outputs():
    """{file name: content}"""
    files, page = {}, README
    for name, build in SCENES.items():
        s = build()
        files[f"{name}.glb"] = content = s.glb()
        cameras = ", ".join(f"`{camera['name']}`" for camera in s.document["cameras"])
        page += (f"| `{name}` | {s.tests} | {s.triangle_count:,} | {s.lights_in_words()} | {cameras} "
                 f"| {len(content) / 1000:.1f} |\n")
    return {**files, "README.md": page.encode()}


def main(arguments):
    if arguments not in ([], ["--check"]):
        print(__doc__, file=sys.stderr)
        return 2
    files = outputs()
    if not arguments:
        for name, content in files.items():
            (HERE / name).write_bytes(content)
        return 0
    stale = [name for name, content in files.items()
             if not (HERE / name).is_file() or (HERE / name).read_bytes() != content]
    stale += [path.name for path in sorted(HERE.glob("*.glb")) if path.name not in files]
    for name in stale:
        print(f"scenes/{name} is not what scenes/make.py writes; run scenes/make.py", file=sys.stderr)
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
