"""irradia's material model (glsl/lib/brdf.glsl) as a Mitsuba BSDF, written from the formulas and not from the shaders.

    f = diffuse_albedo/π · (1 − max F) + F·D·V + transmission_albedo · (1 − max F) · f_t         [1/sr]

with F = Schlick(v·h), D = GGX of α = max(roughness², 1e-3), V = height-correlated Smith over 4 n·l n·v. f_t is
- thin wall (thickness 0): D·V of the direction mirrored through the surface;
- border of a solid: Walter et al. 2007, equation 21 with G = G1(v)·G1(l), without its (1 − F). F then takes the cosine on the
  less dense side, and is 1 under total internal reflection.

The surface is shaded from both sides: the shading normal is turned to the triangle's side that faces the viewer. A direction
that is on different sides of the triangle and of the shading normal carries no light.
"""

import drjit as dr
import mitsuba as mi

import gltf_reader

MINIMUM_ALPHA = 1e-3
MINIMUM_COSINE = 1e-4
# A metal at most this rough makes caustics that paths from the camera hardly find.
MIRROR_ROUGHNESS = 0.25

# What a plugin is told is a number: the place of its material here.
MATERIALS = []


def register(material, has_colors=False):
    """The dict of a BSDF for the material."""
    MATERIALS.append((material, has_colors))
    return {"type": "irradia_bsdf", "material": len(MATERIALS) - 1}


def is_mirror(material):
    """Nothing but a specular lobe that is nearly sharp."""
    return material.metallic == 1 and material.roughness <= MIRROR_ROUGHNESS


def max3(color):
    return dr.maximum(color.x, dr.maximum(color.y, color.z))


def mean3(color):
    return (color.x + color.y + color.z) / 3


def luminance_or_zero(color):
    return dr.maximum(mean3(color), 0)


def schlick(f0, f90, cosine):
    weight = dr.clip(1 - cosine, 0, 1)
    return f0 + (mi.Color3f(f90) - f0) * (dr.square(dr.square(weight)) * weight)


def ggx(half, alpha):
    spread = dr.square(alpha * half.z) + dr.square(half.x) + dr.square(half.y)
    return dr.square(alpha) / (dr.pi * dr.square(spread))


def smith_visibility(cos_l, cos_v, alpha):
    alpha2 = dr.square(alpha)
    lambda_v = cos_l * dr.sqrt(dr.square(cos_v) * (1 - alpha2) + alpha2)
    lambda_l = cos_v * dr.sqrt(dr.square(cos_l) * (1 - alpha2) + alpha2)
    return 0.5 / (lambda_v + lambda_l)


def smith_masking(cosine, alpha):
    return 2 * cosine / (cosine + dr.sqrt(dr.square(cosine) * (1 - dr.square(alpha)) + dr.square(alpha)))


def visible_normal(v, alpha, sample):
    """A half vector with density D·G1·(v·h)/v.z. Heitz 2018, listing 1."""
    stretched = dr.normalize(mi.Vector3f(alpha * v.x, alpha * v.y, v.z))
    length2 = dr.square(stretched.x) + dr.square(stretched.y)
    t1 = dr.select(
        length2 > 0, mi.Vector3f(-stretched.y, stretched.x, 0) * dr.rsqrt(dr.maximum(length2, 1e-30)), mi.Vector3f(1, 0, 0)
    )
    t2 = dr.cross(stretched, t1)
    radius, angle = dr.sqrt(sample.x), dr.two_pi * sample.y
    p1, p2 = radius * dr.cos(angle), radius * dr.sin(angle)
    s = 0.5 * (1 + stretched.z)
    p2 = (1 - s) * dr.safe_sqrt(1 - dr.square(p1)) + s * p2
    h = p1 * t1 + p2 * t2 + dr.safe_sqrt(1 - dr.square(p1) - dr.square(p2)) * stretched
    return dr.normalize(mi.Vector3f(alpha * h.x, alpha * h.y, dr.maximum(h.z, 0)))


def visible_normal_pdf(v, h, alpha):
    return ggx(h, alpha) * smith_masking(v.z, alpha) * dr.maximum(dr.dot(v, h), 0) / v.z


class Sampler:
    """A texture as a function of the surface interaction."""

    WRAPS = {10497: dr.WrapMode.Repeat, 33648: dr.WrapMode.Mirror, 33071: dr.WrapMode.Clamp}

    def __init__(self, texture: gltf_reader.Texture):
        if texture.wrap[0] != texture.wrap[1]:
            raise ValueError("a texture that wraps differently along u and v is not supported")
        mode = dr.FilterMode.Nearest if texture.nearest else dr.FilterMode.Linear
        texels = mi.TensorXf(texture.texels)
        self.texture = mi.Texture2f(texels, filter_mode=mode, wrap_mode=self.WRAPS[texture.wrap[0]])
        self.rows = [[float(value) for value in row] for row in texture.rows]
        self.texcoord = texture.texcoord

    def __call__(self, si, active):
        if self.texcoord == 0:
            uv = si.uv
        else:
            uv = si.shape.eval_attribute_3("vertex_texcoord1", si, active)
        (a, b, c), (d, e, f) = self.rows
        return self.texture.eval(mi.Point2f(a * uv.x + b * uv.y + c, d * uv.x + e * uv.y + f), active)


class Point:
    """The lobes at one surface point, and the frame turned to the viewer."""


class IrradiaBsdf(mi.BSDF):
    # Light tracing asks eval() only for the way to the camera. Mirrors are left out of it where paths from the camera see them.
    mirrors_hide_from_camera = False

    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        self.material, self.has_colors = MATERIALS[props["material"]]
        material = self.material
        self.samplers = {use: Sampler(texture) for use, texture in material.textures.items()}
        number = lambda value: dr.opaque(mi.Float, float(value))
        color = lambda value: mi.Color3f(*[number(channel) for channel in value[:3]])
        self.base_color = color(material.base_color)
        self.specular_color = color(material.specular_color)
        self.metallic = number(material.metallic)
        self.specular = number(material.specular)
        self.transmission = number(material.transmission)
        self.roughness = number(material.roughness)
        self.ior = number(material.ior)
        # Lobes that a material cannot have cost nothing.
        self.is_specular = material.specular > 0 or material.metallic > 0
        self.is_transmissive = material.transmission > 0 and material.metallic < 1
        self.is_solid = self.is_transmissive and material.thickness > 0
        flags = mi.BSDFFlags.DiffuseReflection | mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
        if self.is_specular:
            flags = flags | mi.BSDFFlags.GlossyReflection
        if self.is_transmissive:
            flags = flags | mi.BSDFFlags.GlossyTransmission | mi.BSDFFlags.NonSymmetric
        self.m_components = [flags]
        self.m_flags = flags

    def texel(self, use, si, active):
        return self.samplers[use](si, active) if use in self.samplers else None

    def point(self, si, active):
        point = Point()
        base, metallic, roughness = mi.Color3f(self.base_color), self.metallic, self.roughness
        specular, specular_color, transmission = self.specular, self.specular_color, self.transmission
        if (texel := self.texel("base_color", si, active)) is not None:
            base *= mi.Color3f(texel[0], texel[1], texel[2])
        if (texel := self.texel("metallic_roughness", si, active)) is not None:
            roughness, metallic = roughness * texel[1], metallic * texel[2]
        if (texel := self.texel("specular", si, active)) is not None:
            specular = specular * texel[3]
        if (texel := self.texel("specular_color", si, active)) is not None:
            specular_color = specular_color * mi.Color3f(texel[0], texel[1], texel[2])
        if (texel := self.texel("transmission", si, active)) is not None:
            transmission = transmission * texel[0]
        if self.has_colors:
            base *= si.shape.eval_attribute_3("vertex_color", si, active)

        root = (self.ior - 1) / (self.ior + 1)
        dielectric = dr.minimum(specular_color * dr.square(root), 1) * specular
        point.f0 = dr.lerp(dielectric, base, metallic)
        point.f90 = dr.lerp(specular, 1, metallic)
        point.alpha = dr.maximum(dr.square(roughness), MINIMUM_ALPHA)
        point.diffuse = base * ((1 - metallic) * (1 - transmission))
        point.transmission = base * ((1 - metallic) * transmission)

        front = dr.dot(si.to_world(si.wi), si.n) >= 0
        point.front = front
        normals_agree = dr.dot(si.sh_frame.n, si.n) >= 0
        point.sign = dr.select(front == normals_agree, mi.Float(1), mi.Float(-1))
        # Index beyond the surface over the index on the viewer's side.
        point.eta = dr.select(front, self.ior, 1 / self.ior) if self.is_solid else mi.Float(1)
        v = mi.Vector3f(si.wi.x, si.wi.y, dr.maximum(si.wi.z * point.sign, MINIMUM_COSINE))
        point.v = dr.normalize(v)
        return point

    def sides_agree(self, si, point, wo):
        """Whether the triangle and the shading normal have `wo` on the same side; the viewer is above both."""
        above_triangle = dr.dot(si.to_world(wo), si.n) * dr.select(point.front, 1.0, -1.0)
        return above_triangle * wo.z * point.sign > 0

    def fresnel(self, point, cosine):
        if not self.is_solid:
            return schlick(point.f0, point.f90, cosine)
        beyond2 = 1 - (1 - dr.square(cosine)) / dr.square(point.eta)
        less_dense = dr.select(point.eta < 1, dr.safe_sqrt(beyond2), cosine)
        return dr.select(beyond2 <= 0, mi.Color3f(1), schlick(point.f0, point.f90, less_dense))

    def lobe_weights(self, point):
        """Probabilities of specular reflection and transmission; the rest is the diffuse lobe's."""
        fresnel = self.fresnel(point, point.v.z)
        specular = luminance_or_zero(fresnel) if self.is_specular else mi.Float(0)
        transmitted = mi.Float(0)
        if self.is_transmissive:
            transmitted = luminance_or_zero(point.transmission) * dr.maximum(1 - max3(fresnel), 0.05)
        diffuse = luminance_or_zero(point.diffuse)
        total = specular + transmitted + diffuse
        scale = dr.select(total > 0, 1 / dr.maximum(total, 1e-20), 0)
        return specular * scale, transmitted * scale, diffuse * scale

    def eval_pdf_at(self, ctx, point, l):
        """f·|cos| and the density of sample() for a direction in the turned frame."""
        v, alpha = point.v, point.alpha
        specular_weight, transmitted_weight, diffuse_weight = self.lobe_weights(point)
        reflects = l.z > 0
        cos_l = dr.maximum(dr.abs(l.z), MINIMUM_COSINE)

        half = dr.normalize(v + l)
        fresnel = self.fresnel(point, dr.dot(v, half))
        below_layer = 1 - max3(schlick(point.f0, point.f90, dr.dot(v, half)))
        value = point.diffuse * (dr.inv_pi * below_layer)
        pdf = diffuse_weight * dr.inv_pi * l.z
        if self.is_specular:
            value += fresnel * (ggx(half, alpha) * smith_visibility(cos_l, v.z, alpha))
            pdf += specular_weight * visible_normal_pdf(v, half, alpha) / (4 * dr.maximum(dr.dot(v, half), 1e-12))
        value = dr.select(reflects, value * l.z, 0)
        pdf = dr.select(reflects, pdf, 0)
        if not self.is_transmissive:
            return value, pdf

        if not self.is_solid:
            mirrored = mi.Vector3f(l.x, l.y, -l.z)
            half = dr.normalize(v + mirrored)
            v_dot_h = dr.dot(v, half)
            share = 1 - max3(self.fresnel(point, v_dot_h))
            through = point.transmission * (share * ggx(half, alpha) * smith_visibility(cos_l, v.z, alpha) * -l.z)
            through_pdf = visible_normal_pdf(v, half, alpha) / (4 * dr.maximum(v_dot_h, 1e-12))
        else:
            half = v + l * point.eta
            half = dr.normalize(half * dr.select(half.z < 0, -1, 1))
            v_dot_h, l_dot_h = dr.dot(v, half), dr.dot(l, half)
            possible = (v_dot_h > 0) & (l_dot_h < 0) & (dr.abs(point.eta - 1) > 1e-6)
            denominator = dr.square(v_dot_h + point.eta * l_dot_h)
            share = 1 - max3(self.fresnel(point, v_dot_h))
            # Radiance grows with the square of the index; importance, which light carries, does not.
            jacobian = dr.abs(v_dot_h * l_dot_h) / dr.maximum(denominator, 1e-20)
            scale = 1.0 if ctx.mode == mi.TransportMode.Radiance else dr.square(point.eta)
            g_over_cosines = smith_masking(v.z, alpha) * smith_masking(cos_l, alpha) / (v.z * cos_l)
            through = point.transmission * (share * ggx(half, alpha) * g_over_cosines * jacobian * scale * -l.z)
            through_pdf = (
                visible_normal_pdf(v, half, alpha) * dr.square(point.eta) * dr.abs(l_dot_h) / dr.maximum(denominator, 1e-20)
            )
            through = dr.select(possible, through, 0)
            through_pdf = dr.select(possible, through_pdf, 0)
        transmits = l.z < 0
        value = dr.select(transmits, through, value)
        pdf = dr.select(transmits, transmitted_weight * through_pdf, pdf)
        return value, pdf

    def eval_pdf(self, ctx, si, wo, active=True):
        point = self.point(si, active)
        value, pdf = self.eval_pdf_at(ctx, point, mi.Vector3f(wo.x, wo.y, wo.z * point.sign))
        active = mi.Bool(active) & self.sides_agree(si, point, wo)
        return dr.select(active, value, 0), dr.select(active, pdf, 0)

    def eval(self, ctx, si, wo, active=True):
        if self.mirrors_hide_from_camera and is_mirror(self.material):
            return mi.Color3f(0)
        return self.eval_pdf(ctx, si, wo, active)[0]

    def pdf(self, ctx, si, wo, active=True):
        return self.eval_pdf(ctx, si, wo, active)[1]

    def sample(self, ctx, si, sample1, sample2, active=True):
        point = self.point(si, active)
        specular_weight, transmitted_weight, _ = self.lobe_weights(point)
        l = mi.warp.square_to_cosine_hemisphere(sample2)
        if self.is_specular or self.is_transmissive:
            half = visible_normal(point.v, point.alpha, sample2)
            v_dot_h = dr.dot(point.v, half)
            reflected = 2 * v_dot_h * half - point.v
            l = dr.select(sample1 < specular_weight, reflected, l)
            valid = (sample1 >= specular_weight) | (reflected.z > 0)
        else:
            valid = mi.Bool(True)
        eta = mi.Float(1)
        if self.is_transmissive:
            if self.is_solid:
                beyond2 = 1 - (1 - dr.square(v_dot_h)) / dr.square(point.eta)
                beyond = dr.safe_sqrt(beyond2)
                through = half * (v_dot_h / point.eta - beyond) - point.v / point.eta
                possible = (beyond2 > 0) & (through.z < 0)
            else:
                through = mi.Vector3f(reflected.x, reflected.y, -reflected.z)
                possible = through.z < 0
            chosen = (sample1 >= specular_weight) & (sample1 < specular_weight + transmitted_weight)
            l = dr.select(chosen, through, l)
            valid &= ~chosen | possible
            eta = dr.select(chosen, point.eta, 1)
        l = dr.normalize(l)
        value, pdf = self.eval_pdf_at(ctx, point, l)
        bs = mi.BSDFSample3f()
        bs.wo = mi.Vector3f(l.x, l.y, l.z * point.sign)
        valid &= (pdf > 0) & active & self.sides_agree(si, point, bs.wo)
        bs.pdf = dr.select(valid, pdf, 0)
        bs.eta = eta
        bs.sampled_type = mi.UInt32(+self.m_flags)
        bs.sampled_component = mi.UInt32(0)
        return bs, dr.select(valid, value / dr.maximum(pdf, 1e-30), 0)

    def to_string(self):
        return f"IrradiaBsdf[{self.material.name}]"


class GltfSpot(mi.Emitter):
    """A spot light with glTF's falloff, clamp(cosθ·scale + offset, 0, 1)²; Mitsuba's own is linear in the angle."""

    def __init__(self, props):
        mi.Emitter.__init__(self, props)
        number = lambda name: float(props[name])
        vector = lambda name: [float(value) for value in props[name]]
        self.m_flags = +mi.EmitterFlags.DeltaPosition
        self.m_needs_sample_2 = False
        self.m_needs_sample_3 = True
        self.position = mi.Point3f(vector("position"))
        self.frame = mi.Frame3f(dr.normalize(mi.Vector3f(vector("direction"))))
        self.intensity = mi.Color3f(vector("intensity"))
        cos_inner, self.cos_outer = number("cos_inner"), number("cos_outer")
        self.scale = 1 / max(1e-9, cos_inner - self.cos_outer)
        self.offset = -self.cos_outer * self.scale

    def radiant_intensity(self, away):
        attenuation = dr.clip(dr.dot(self.frame.n, away) * self.scale + self.offset, 0, 1)
        return self.intensity * dr.square(attenuation)

    def sample_ray(self, time, sample1, sample2, sample3, active=True):
        local = mi.warp.square_to_uniform_cone(sample3, self.cos_outer)
        away = self.frame.to_world(local)
        ray = mi.Ray3f(self.position, away, time, mi.Color0f())
        return ray, dr.select(active, self.radiant_intensity(away) * (dr.two_pi * (1 - self.cos_outer)), 0)

    def sample_direction(self, it, sample, active=True):
        ds = dr.zeros(mi.DirectionSample3f)
        ds.p = self.position
        ds.n = self.frame.n
        ds.time = it.time
        ds.pdf = 1
        ds.delta = True
        ds.emitter = mi.EmitterPtr(self)
        difference = self.position - it.p
        distance2 = dr.squared_norm(difference)
        ds.dist = dr.sqrt(distance2)
        ds.d = difference / ds.dist
        return ds, dr.select(active, self.radiant_intensity(-ds.d) / distance2, 0)

    def pdf_direction(self, it, ds, active=True):
        return mi.Float(0)

    def eval_direction(self, it, ds, active=True):
        return dr.select(active, self.radiant_intensity(-ds.d) / dr.square(ds.dist), 0)

    def sample_position(self, time, sample, active=True):
        ps = dr.zeros(mi.PositionSample3f)
        ps.p = self.position
        ps.n = self.frame.n
        ps.time = time
        ps.pdf = 1
        ps.delta = True
        return ps, mi.Float(1)

    def sample_wavelengths(self, si, sample, active=True):
        return mi.Color0f(), self.intensity

    def eval(self, si, active=True):
        return mi.Color3f(0)

    def bbox(self):
        return mi.ScalarBoundingBox3f()

    def to_string(self):
        return "GltfSpot[]"


mi.register_bsdf("irradia_bsdf", IrradiaBsdf)
mi.register_emitter("gltf_spot", GltfSpot)
