"""Builds a Mitsuba 3 scene of a glTF file as irradia understands it, and renders it.

    python gltf_to_mitsuba.py SCENE -o FILE.exr [--size WxH] [--spp N] [--bounces N] [--camera NAME|INDEX] [--sky R,G,B]
                              [--seed N] [--integrator auto|path|light]
"""

import argparse
import os
import sys
import tempfile
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np

if mi.variant() is None:
    mi.set_variant(os.environ.get("MITSUBA_VARIANT", "llvm_ad_rgb"))

import gltf_reader
import irradia_bsdf

# Coincident sides of a double-sided emitter are drawn apart by this share of the scene's size.
EMITTER_SIDES_APART = 1e-6


class LoadedScene:
    """A Mitsuba scene and what an integrator must know of it."""

    def __init__(self, scene, source, has_deltas, mirrors):
        self.scene = scene
        self.source = source
        self.has_deltas = has_deltas
        self.mirrors = mirrors  # indices of the shapes that are metal mirrors


def opacity_of(material):
    """Whether a masked material is there: True or False; an error if some of it is."""
    if material.cutoff is None:
        return True
    texture = material.textures.get("base_color")
    alphas = np.array([1.0]) if texture is None else texture.texels[..., 3]
    there = alphas * material.base_color[3] >= material.cutoff
    if there.all() or not there.any():
        return bool(there.all())
    raise ValueError(f"the material {material.name!r} is cut out by a texture, which is not supported here")


def write_ply(path, positions, triangles, normals, texcoords):
    columns = [positions]
    names = ["x", "y", "z"]
    if normals is not None:
        columns.append(normals)
        names += ["nx", "ny", "nz"]
    if texcoords is not None:
        columns.append(texcoords)
        names += ["u", "v"]
    vertices = np.concatenate(columns, axis=1).astype("<f4")
    faces = np.zeros(len(triangles), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"] = 3
    faces["corners"] = triangles
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property float {name}" for name in names]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    with open(path, "wb") as file:
        file.write("\n".join(header).encode())
        file.write(vertices.tobytes())
        file.write(faces.tobytes())


def joined(primitives):
    """Primitives of one material and one set of attributes as one."""
    first = np.cumsum([0] + [len(primitive.positions) for primitive in primitives])
    stack = lambda values: None if values[0] is None else np.concatenate(values)
    return gltf_reader.Primitive(
        primitives[0].material,
        np.concatenate([primitive.positions for primitive in primitives]),
        np.concatenate([primitive.triangles + at for primitive, at in zip(primitives, first)]),
        stack([primitive.normals for primitive in primitives]),
        tuple(stack([primitive.texcoords[set] for primitive in primitives]) for set in (0, 1)),
        stack([primitive.colors for primitive in primitives]),
    )


def two_sided_emitter(primitive, distance):
    """Both sides as one-sided triangles, a little apart."""
    corners = primitive.positions[primitive.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal *= distance / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    sides = np.concatenate([corners + normal[:, None], (corners - normal[:, None])[:, ::-1]])
    return gltf_reader.Primitive(primitive.material, sides.reshape(-1, 3), np.arange(len(sides) * 3).reshape(-1, 3))


def bsdf_of(material, has_colors, own_diffuse, replace):
    other = replace(material) if replace else None
    if other is not None:
        return other
    is_plain = material.specular == 0 and material.metallic == 0 and material.transmission == 0
    if own_diffuse and is_plain and not material.textures and not has_colors:
        color = {"type": "rgb", "value": list(material.base_color[:3])}
        return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": color}}
    return irradia_bsdf.register(material, has_colors)


def shape_of(primitive, number, folder, size, bsdf):
    material = primitive.material
    if material.emits and "emissive" in material.textures:
        raise ValueError(f"the material {material.name!r} has an emissive texture, which is not supported here")
    # Light is emitted by the triangles, not by the surface that their normals pretend.
    if material.emits and material.double_sided:
        primitive = two_sided_emitter(primitive, EMITTER_SIDES_APART * size)
    normals = None if material.emits else primitive.normals
    path = str(Path(folder) / f"{number}.ply")
    write_ply(path, primitive.positions, primitive.triangles, normals, primitive.texcoords[0])
    shape = {
        "type": "ply",
        "filename": path,
        "face_normals": normals is None,
        "bsdf": bsdf(material, primitive.colors is not None),
    }
    if material.emits:
        shape["emitter"] = {"type": "area", "radiance": {"type": "rgb", "value": list(material.emissive)}}
    shape = mi.load_dict(shape)
    for name, values in (("vertex_color", primitive.colors), ("vertex_texcoord1", primitive.texcoords[1])):
        if values is not None:
            padded = np.zeros((len(values), 3), np.float32)
            padded[:, : values.shape[1]] = values
            shape.add_attribute(name, 3, padded.ravel())
    return shape


def light_dict(light):
    intensity = {"type": "rgb", "value": [float(channel) for channel in light.intensity]}
    vector = lambda values: [float(value) for value in values]
    if light.kind == "point":
        return {"type": "point", "position": vector(light.position), "intensity": intensity}
    if light.kind == "directional":
        return {"type": "directional", "direction": vector(light.direction), "irradiance": intensity}
    if light.kind == "spot":
        return {
            "type": "gltf_spot",
            "position": mi.ScalarPoint3f(vector(light.position)),
            "direction": mi.ScalarVector3f(vector(light.direction)),
            "intensity": mi.ScalarVector3f(vector(light.intensity)),
            "cos_inner": float(np.cos(light.inner)),
            "cos_outer": float(np.cos(light.outer)),
        }
    raise ValueError(f"the light kind {light.kind!r} is not known")


def sensor_dict(camera, width, height):
    return {
        "type": "perspective",
        "fov": float(np.degrees(camera.yfov)),
        "fov_axis": "y",
        "near_clip": 1e-3,
        "far_clip": 1e7,
        "to_world": mi.ScalarTransform4f().look_at(
            origin=camera.position.tolist(),
            target=(camera.position + camera.forward / np.linalg.norm(camera.forward)).tolist(),
            up=camera.up.tolist(),
        ),
        "film": {
            "type": "hdrfilm",
            "width": width,
            "height": height,
            "pixel_format": "rgb",
            "component_format": "float32",
            "rfilter": {"type": "box"},
        },
        "sampler": {"type": "independent"},
    }


def load(path, size, camera=None, sky=None, own_diffuse=False, replace=None):
    """Reads a glTF file into a `LoadedScene`.

    `own_diffuse` takes Mitsuba's diffuse BSDF where it is the same model; `replace` may give any material another BSDF's dict.
    """
    bsdf = lambda material, has_colors: bsdf_of(material, has_colors, own_diffuse, replace)
    source = gltf_reader.read(path)
    for warning in dict.fromkeys(source.warnings):
        print(f"warning: {path}: {warning}", file=sys.stderr)
    groups = {}
    for primitive in source.primitives:
        if opacity_of(primitive.material):
            attributes = (primitive.normals, *primitive.texcoords, primitive.colors)
            key = (id(primitive.material), *(values is not None for values in attributes))
            groups.setdefault(key, []).append(primitive)
    groups = [joined(primitives) for primitives in groups.values()]
    low = np.min([group.positions.min(axis=0) for group in groups], axis=0)
    high = np.max([group.positions.max(axis=0) for group in groups], axis=0)
    description = {"type": "scene", "sensor": sensor_dict(source.camera(camera), *size)}
    with tempfile.TemporaryDirectory() as folder:
        for number, group in enumerate(groups):
            extent = float(np.linalg.norm(high - low))
            description[f"shape{number}"] = shape_of(group, number, folder, extent, bsdf)
    for number, light in enumerate(source.lights):
        description[f"light{number}"] = light_dict(light)
    if sky is not None:
        description["sky"] = {"type": "constant", "radiance": {"type": "rgb", "value": list(sky)}}
    scene = mi.load_dict(description)
    shapes = [description[f"shape{number}"] for number in range(len(groups))]
    mirrors = [shape for shape, group in zip(shapes, groups) if irradia_bsdf.is_mirror(group.material)]
    return LoadedScene(scene, source, bool(source.lights), mirrors)


def depth_of_bounces(bounces):
    """Mitsuba's max_depth counts segments: eye to x to the light are 2. irradia's bounces are those between."""
    return -1 if bounces is None else bounces + 2


class FirstHit(mi.SamplingIntegrator):
    """Path tracing of those pixels' samples whose first surface is a mirror, black elsewhere."""

    shapes = []

    def __init__(self, props):
        mi.SamplingIntegrator.__init__(self, props)
        self.inner = mi.load_dict({"type": "path", "max_depth": props["depth"], "rr_depth": 8})

    def sample(self, scene, sampler, ray, medium=None, active=True):
        hit = scene.ray_intersect_preliminary(ray, coherent=True, active=active)
        mirror = mi.Bool(False)
        for shape in FirstHit.shapes:
            mirror |= hit.shape == mi.ShapePtr(shape)
        color, _, aovs = self.inner.sample(scene, sampler, mi.RayDifferential3f(ray), medium, active & hit.is_valid() & mirror)
        return dr.select(mirror, color, 0), active, aovs


mi.register_integrator("first_hit", FirstHit)


# Samples of all pixels that are in flight at once: a wavefront holds every sample of a pass.
SAMPLES_A_PASS = 4e6


def passes(loaded, integrator, spp, seed=0):
    """Mean of so many samples of every layer, (height, width, layers) float64."""
    width, height = loaded.scene.sensors()[0].film().crop_size()
    chunk = max(1, int(SAMPLES_A_PASS // (width * height)))
    total, done = 0.0, 0
    while done < spp:
        count = min(chunk, spp - done)
        image = mi.render(loaded.scene, integrator=integrator, spp=count, seed=seed * 100003 + done)
        total = total + count * np.array(image, dtype=np.float64)
        done += count
    return total / spp


def render(loaded, spp, seed=0, bounces=None, integrator="auto"):
    """Linear RGB, (height, width, 3) float64.

    `path` is path tracing. `light` traces light from the sources to the diffuse surfaces that the camera sees, which finds
    caustics of small lights, and paths from the camera where it sees a mirror first: together all light paths, each once.
    """
    depth = depth_of_bounces(bounces)
    if integrator == "auto":
        integrator = "light" if loaded.has_deltas and loaded.mirrors else "path"
    path = {"type": "path", "max_depth": depth, "rr_depth": 8}

    if integrator == "path":
        return passes(loaded, mi.load_dict(path), spp, seed)
    FirstHit.shapes = loaded.mirrors
    seen = passes(loaded, mi.load_dict({"type": "first_hit", "depth": depth}), spp, seed)
    irradia_bsdf.IrradiaBsdf.mirrors_hide_from_camera = True
    try:
        traced = passes(loaded, mi.load_dict({"type": "ptracer", "max_depth": depth, "rr_depth": 8}), spp, seed)
    finally:
        irradia_bsdf.IrradiaBsdf.mirrors_hide_from_camera = False
    return seen + traced


def size_of(text):
    width, height = text.split("x")
    return int(width), int(height)


def rgb_of(text):
    return [float(value) for value in text.split(",")]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--size", type=size_of, default=(192, 144))
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--bounces", type=int)
    parser.add_argument("--camera")
    parser.add_argument("--sky", type=rgb_of)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--integrator", choices=["auto", "path", "light"], default="auto")
    parser.add_argument("--own-diffuse", action="store_true", help="Mitsuba's own diffuse BSDF where it is the same model")
    options = parser.parse_args()
    loaded = load(options.scene, options.size, options.camera, options.sky, options.own_diffuse)
    image = render(loaded, options.spp, options.seed, options.bounces, options.integrator)
    mi.Bitmap(image.astype(np.float32)).write(options.output)


if __name__ == "__main__":
    main()
