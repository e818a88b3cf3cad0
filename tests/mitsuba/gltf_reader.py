"""Reads the part of glTF 2.0 that irradia renders, independently of irradia's own loader: numpy arrays in world space.

Geometry is transformed in float64 and handed on as float32. A primitive keeps its winding's front: a mirroring transform
swaps two corners, so that the counter-clockwise side stays the material's front side (glTF 2.0, 3.7.4).
"""

import base64
import io
import json
import struct
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import unquote

import numpy as np
from PIL import Image

COMPONENTS = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}


@dataclass
class Texture:
    """Linear RGBA texels, float32, top row first, and how to sample them."""

    texels: np.ndarray
    wrap: tuple
    nearest: bool
    texcoord: int
    rows: np.ndarray  # 2x3: u' is the first row times (u, v, 1)


@dataclass
class Material:
    """The fields of irradia's src/scene/material.rs."""

    name: str = ""
    base_color: tuple = (1.0, 1.0, 1.0, 1.0)
    metallic: float = 1.0
    roughness: float = 1.0
    emissive: tuple = (0.0, 0.0, 0.0)
    ior: float = 1.5
    specular: float = 1.0
    specular_color: tuple = (1.0, 1.0, 1.0)
    transmission: float = 0.0
    thickness: float = 0.0
    cutoff: float = None  # None: opaque
    double_sided: bool = False
    textures: dict = field(default_factory=dict)

    @property
    def emits(self):
        return any(channel > 0 for channel in self.emissive)


@dataclass
class Primitive:
    """Triangles of one material in world space."""

    material: Material
    positions: np.ndarray  # (n, 3) float64
    triangles: np.ndarray  # (m, 3)
    normals: np.ndarray = None
    texcoords: tuple = (None, None)
    colors: np.ndarray = None


@dataclass
class Light:
    """A punctual light: W/sr, or W/m² for a directional one."""

    kind: str
    intensity: np.ndarray
    position: np.ndarray
    direction: np.ndarray
    inner: float = 0.0
    outer: float = np.pi / 4


@dataclass
class Camera:
    """A perspective camera: full vertical angle in radians, and a rigid frame."""

    name: str
    yfov: float
    position: np.ndarray
    forward: np.ndarray
    up: np.ndarray


@dataclass
class Scene:
    primitives: list
    lights: list
    cameras: list
    warnings: list

    def camera(self, select=None):
        """The camera of that name or index; the first without one."""
        if not self.cameras:
            raise ValueError("the scene has no camera; irradia's automatic view is not known here")
        for camera in self.cameras:
            if camera.name == select:
                return camera
        return self.cameras[int(select or 0)]


class Reader:
    def __init__(self, path):
        self.path = Path(path)
        content = self.path.read_bytes()
        self.binary = None
        if content[:4] == b"glTF":
            at = 12
            while at + 8 <= len(content):
                size, kind = struct.unpack_from("<II", content, at)
                chunk = content[at + 8 : at + 8 + size]
                if kind == 0x4E4F534A:
                    self.json = json.loads(chunk)
                elif kind == 0x004E4942:
                    self.binary = chunk
                at += 8 + size
        else:
            self.json = json.loads(content)
        self.buffers = {}
        self.images = {}
        self.warnings = []

    def uri(self, uri):
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        return (self.path.parent / unquote(uri)).read_bytes()

    def buffer(self, index):
        if index not in self.buffers:
            uri = self.json["buffers"][index].get("uri")
            self.buffers[index] = self.binary if uri is None else self.uri(uri)
        return self.buffers[index]

    def view(self, index):
        view = self.json["bufferViews"][index]
        start = view.get("byteOffset", 0)
        return self.buffer(view["buffer"])[start : start + view["byteLength"]]

    def strided(self, view, offset, count, dtype, width):
        """`count` rows of `width` components that may lie apart."""
        row = np.dtype(dtype).itemsize * width
        stride = self.json["bufferViews"][view].get("byteStride", row)
        data = np.frombuffer(self.view(view), np.uint8)
        rows = np.lib.stride_tricks.as_strided(data[offset:], (count, row), (stride, 1))
        return np.ascontiguousarray(rows).view(dtype).reshape(count, width)

    def accessor(self, index, normalized=None):
        """The accessor as (count, width): floats, or integers when it is not normalised."""
        accessor = self.json["accessors"][index]
        dtype, width, count = COMPONENTS[accessor["componentType"]], WIDTHS[accessor["type"]], accessor["count"]
        if "bufferView" in accessor:
            values = self.strided(accessor["bufferView"], accessor.get("byteOffset", 0), count, dtype, width)
        else:
            values = np.zeros((count, width), dtype)
        if "sparse" in accessor:
            sparse = accessor["sparse"]
            where, what = sparse["indices"], sparse["values"]
            at = self.strided(
                where["bufferView"], where.get("byteOffset", 0), sparse["count"], COMPONENTS[where["componentType"]], 1
            )
            values = values.copy()
            values[at[:, 0]] = self.strided(what["bufferView"], what.get("byteOffset", 0), sparse["count"], dtype, width)
        if accessor.get("normalized", False) if normalized is None else normalized:
            if dtype != np.float32:
                values = np.maximum(values.astype(np.float64) / np.iinfo(dtype).max, -1.0)
        return values

    def image(self, index):
        if index not in self.images:
            image = self.json["images"][index]
            content = self.view(image["bufferView"]) if "bufferView" in image else self.uri(image["uri"])
            picture = Image.open(io.BytesIO(content))
            if picture.mode.startswith("I"):
                values = np.asarray(picture).astype(np.float64) / 257.0
                picture = Image.fromarray(np.round(values).astype(np.uint8))
            self.images[index] = np.asarray(picture.convert("RGBA"))
        return self.images[index]

    def texture(self, info, is_color):
        """A use of a texture, decoded to linear floats; None if there is none."""
        if info is None:
            return None
        texture = self.json["textures"][info["index"]]
        sampler = self.json["samplers"][texture["sampler"]] if "sampler" in texture else {}
        texels = self.image(texture["source"]).astype(np.float32) / 255.0
        if is_color:
            rgb = texels[..., :3]
            texels[..., :3] = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
        transform = info.get("extensions", {}).get("KHR_texture_transform", {})
        offset, scale = transform.get("offset", [0, 0]), transform.get("scale", [1, 1])
        sine, cosine = np.sin(transform.get("rotation", 0.0)), np.cos(transform.get("rotation", 0.0))
        rows = np.array(
            [[cosine * scale[0], sine * scale[1], offset[0]], [-sine * scale[0], cosine * scale[1], offset[1]]]
        )
        return Texture(
            texels,
            (sampler.get("wrapS", 10497), sampler.get("wrapT", 10497)),
            sampler.get("magFilter") == 9728,
            transform.get("texCoord", info.get("texCoord", 0)),
            rows,
        )

    def material(self, index):
        if index is None:
            return Material()
        source = self.json["materials"][index]
        base = source.get("pbrMetallicRoughness", {})
        extensions = source.get("extensions", {})
        specular = extensions.get("KHR_materials_specular", {})
        volume = extensions.get("KHR_materials_volume", {})
        transmission = extensions.get("KHR_materials_transmission", {})
        name = source.get("name", str(index))
        if "KHR_materials_unlit" in extensions:
            raise ValueError(f"the material {name!r} is unlit, which no physical renderer can show")
        if "attenuationDistance" in volume:
            self.warnings.append(f"material {name!r}: attenuation inside the volume is left out")
        if "normalTexture" in source:
            self.warnings.append(f"material {name!r}: the normal map is left out")
        strength = extensions.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1.0)
        mode = source.get("alphaMode", "OPAQUE")
        ior = extensions.get("KHR_materials_ior", {}).get("ior", 1.5)
        uses = {
            "base_color": self.texture(base.get("baseColorTexture"), True),
            "metallic_roughness": self.texture(base.get("metallicRoughnessTexture"), False),
            "emissive": self.texture(source.get("emissiveTexture"), True),
            "transmission": self.texture(transmission.get("transmissionTexture"), False),
            "specular": self.texture(specular.get("specularTexture"), False),
            "specular_color": self.texture(specular.get("specularColorTexture"), True),
        }
        return Material(
            name=name,
            base_color=tuple(base.get("baseColorFactor", [1.0] * 4)),
            metallic=base.get("metallicFactor", 1.0),
            roughness=base.get("roughnessFactor", 1.0),
            emissive=tuple(strength * factor for factor in source.get("emissiveFactor", [0.0] * 3)),
            ior=ior if ior == 0 else max(ior, 1.0),
            specular=specular.get("specularFactor", 1.0),
            specular_color=tuple(specular.get("specularColorFactor", [1.0] * 3)),
            transmission=transmission.get("transmissionFactor", 0.0),
            thickness=volume.get("thicknessFactor", 0.0),
            cutoff={"MASK": source.get("alphaCutoff", 0.5), "BLEND": 0.5}.get(mode),
            double_sided=source.get("doubleSided", False),
            textures={use: texture for use, texture in uses.items() if texture is not None},
        )

    def nodes(self):
        """(node, world matrix) of every node of the active scene, depth first."""
        nodes = self.json.get("nodes", [])
        scenes = self.json.get("scenes")
        if scenes:
            roots = scenes[self.json.get("scene", 0)].get("nodes", [])
        else:
            children = {child for node in nodes for child in node.get("children", [])}
            roots = [index for index in range(len(nodes)) if index not in children]
        pending = [(index, np.eye(4)) for index in reversed(roots)]
        while pending:
            index, parent = pending.pop()
            node = nodes[index]
            world = parent @ local_matrix(node)
            yield node, world
            pending.extend((child, world) for child in reversed(node.get("children", [])))

    def primitive(self, primitive, world, materials):
        attributes = primitive["attributes"]
        mode = primitive.get("mode", 4)
        if mode not in (4, 5, 6) or "POSITION" not in attributes:
            return None
        positions = self.accessor(attributes["POSITION"]).astype(np.float64)
        if "indices" in primitive:
            order = self.accessor(primitive["indices"], normalized=False)[:, 0].astype(np.int64)
        else:
            order = np.arange(len(positions))
        triangles = triangle_list(order, mode)
        linear = world[:3, :3]
        if np.linalg.det(linear) < 0:
            triangles = triangles[:, [0, 2, 1]]
        normals = None
        if "NORMAL" in attributes:
            cofactors = np.stack([np.cross(linear[:, (i + 1) % 3], linear[:, (i + 2) % 3]) for i in range(3)], axis=1)
            normals = self.accessor(attributes["NORMAL"], normalized=True).astype(np.float64) @ cofactors.T
            normals *= np.sign(np.linalg.det(linear))
            normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
        texcoords = tuple(
            self.accessor(attributes[name]).astype(np.float64) if name in attributes else None
            for name in ("TEXCOORD_0", "TEXCOORD_1")
        )
        colors = self.accessor(attributes["COLOR_0"], normalized=True)[:, :3] if "COLOR_0" in attributes else None
        index = primitive.get("material")
        if index not in materials:
            materials[index] = self.material(index)
        return Primitive(
            materials[index], positions @ linear.T + world[:3, 3], triangles, normals, texcoords, colors
        )

    def light(self, index, world):
        light = self.json["extensions"]["KHR_lights_punctual"]["lights"][index]
        if "range" in light:
            self.warnings.append(f"light {index}: its range is a hint and is left out")
        spot = light.get("spot", {})
        outer = min(spot.get("outerConeAngle", np.pi / 4), np.pi / 2)
        axis = -world[:3, 2]
        return Light(
            light["type"],
            np.array(light.get("color", [1.0] * 3)) * light.get("intensity", 1.0),
            world[:3, 3],
            axis / np.linalg.norm(axis),
            min(spot.get("innerConeAngle", 0.0), outer),
            outer,
        )

    def camera(self, node, world):
        camera = self.json["cameras"][node["camera"]]
        if camera["type"] != "perspective":
            self.warnings.append("an orthographic camera is left out")
            return None
        name = camera.get("name") or node.get("name", "")
        return Camera(name, camera["perspective"]["yfov"], world[:3, 3], -world[:3, 2], world[:3, 1])

    def read(self):
        primitives, lights, cameras, materials = [], [], [], {}
        if self.json.get("animations"):
            self.warnings.append("animations are left out: the scene is shown in its rest pose")
        for node, world in self.nodes():
            if "mesh" in node:
                for primitive in self.json["meshes"][node["mesh"]]["primitives"]:
                    primitives.append(self.primitive(primitive, world, materials))
            if "camera" in node:
                cameras.append(self.camera(node, world))
            light = node.get("extensions", {}).get("KHR_lights_punctual")
            if light:
                lights.append(self.light(light["light"], world))
        present = lambda items: [item for item in items if item is not None]
        return Scene(present(primitives), lights, present(cameras), self.warnings)


def local_matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], np.float64).reshape(4, 4).T
    x, y, z, w = np.array(node.get("rotation", [0, 0, 0, 1]), np.float64) / np.linalg.norm(
        node.get("rotation", [0, 0, 0, 1])
    )
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    matrix = np.eye(4)
    matrix[:3, :3] = rotation * np.array(node.get("scale", [1, 1, 1]), np.float64)
    matrix[:3, 3] = node.get("translation", [0, 0, 0])
    return matrix


def triangle_list(order, mode):
    if mode == 4:
        return order[: len(order) // 3 * 3].reshape(-1, 3)
    if mode == 6:
        return np.stack([order[1:-1], order[2:], np.full(len(order) - 2, order[0])], axis=1)
    strip = np.stack([order[:-2], order[1:-1], order[2:]], axis=1)
    strip[1::2] = strip[1::2][:, [0, 2, 1]]
    return strip


def read(path):
    """The scene in a .gltf or .glb file."""
    return Reader(path).read()
