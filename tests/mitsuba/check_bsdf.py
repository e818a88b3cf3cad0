"""Checks irradia_bsdf.py against itself and against numbers known otherwise. Ends with status 1 if a check fails.

- sample(), pdf() and eval() belong together: Pearson's chi-square test of sample() against pdf(), and the mean of sample()'s
  weights against a quadrature of eval().
- A smooth glass border reflects Schlick's share, and refracts by Snell's law with radiance scaled by the index squared.
- A thin wall and a white metal of little roughness lose no light beyond their Fresnel terms.
- eval() agrees with numpy arithmetic from glTF 2.0's appendix B written out once more.
- The diffuse lobe is Mitsuba's own `diffuse`.
"""

import sys

import mitsuba as mi

mi.set_variant("llvm_ad_rgb")

import drjit as dr
import numpy as np
from mitsuba.chi2 import ChiSquareTest, SphericalDomain

import irradia_bsdf
from gltf_reader import Material

MATTE = Material("matte", (0.6, 0.5, 0.4, 1), 0, 1, specular=0)
PLASTIC = Material("plastic", (0.6, 0.5, 0.4, 1), 0, 0.5)
GOLD = Material("gold", (1, 0.78, 0.34, 1), 1, 0.4)
THIN = Material("thin wall", (0.9, 0.8, 0.7, 1), 0, 0.45, transmission=0.8)
SOLID = Material("frosted glass", (1, 1, 1, 1), 0, 0.5, transmission=1, thickness=1)
MIXED = Material("half glass", (0.8, 0.9, 1, 1), 0.3, 0.6, ior=1.4, transmission=0.5, thickness=1)
GLASS = Material("glass", (1, 1, 1, 1), 0, 0, transmission=1, thickness=1)
# Radiance may grow by the square of the index where it leaves a solid.
INDEX_SQUARED = 1.5**2
failures = []


def check(name, holds, detail=""):
    print(f"{'ok  ' if holds else 'FAIL'} {name} {detail}")
    if not holds:
        failures.append(name)


def interaction(cosine, count=1):
    si = dr.zeros(mi.SurfaceInteraction3f, count)
    si.n = mi.Normal3f(0, 0, 1)
    si.sh_frame = mi.Frame3f(si.n)
    si.wi = mi.Vector3f(float(np.sqrt(1 - cosine**2)), 0, cosine)
    return si


def quadrature(bsdf, si, count=1 << 21):
    """∫ f |cos| over the sphere and ∫ pdf, by stratified uniform directions."""
    side = int(np.sqrt(count))
    at = dr.arange(mi.UInt32, side * side)
    rng = mi.PCG32(side * side)
    u = mi.Point2f((mi.Float(at % side) + rng.next_float32()) / side, (mi.Float(at // side) + rng.next_float32()) / side)
    wo = mi.warp.square_to_uniform_sphere(u)
    value, pdf = bsdf.eval_pdf(mi.BSDFContext(), si, wo)
    area = 4 * np.pi / (side * side)
    return np.array([dr.sum(channel)[0] * area for channel in (value.x, value.y, value.z)]), dr.sum(pdf)[0] * area


def sampled(bsdf, si, count=1 << 21):
    rng = mi.PCG32(count)
    bs, weight = bsdf.sample(mi.BSDFContext(), si, rng.next_float32(), mi.Point2f(rng.next_float32(), rng.next_float32()))
    return bs, weight


def sampler_of(bsdf, si):
    def sample(u):
        bs, weight = bsdf.sample(mi.BSDFContext(), si, u[0], mi.Point2f(u[1], u[2]))
        return bs.wo, dr.select(bs.pdf > 0, 1.0, 0.0)

    return sample


def density_of(bsdf, si):
    return lambda wo: bsdf.pdf(mi.BSDFContext(), si, wo)


def mean(weight):
    return np.array([dr.mean(channel)[0] for channel in (weight.x, weight.y, weight.z)])


for material in (MATTE, PLASTIC, GOLD, THIN, SOLID, MIXED):
    bsdf = mi.load_dict(irradia_bsdf.register(material))
    for cosine in (0.9, 0.3, -0.6):
        si = interaction(cosine)
        albedo, integral = quadrature(bsdf, si)
        by_sampling = mean(sampled(bsdf, si)[1])
        error = np.max(np.abs(albedo - by_sampling) / albedo)
        check(f"{material.name}, cos {cosine}: eval's integral is the mean of sample's weights", error < 0.01,
              f"{albedo.round(4)} {by_sampling.round(4)}")
        # What falls below the horizon after reflection is a sample without a direction.
        check(f"{material.name}, cos {cosine}: pdf integrates to at most 1", 0.85 < integral < 1.005, f"{integral:.4f}")
        check(f"{material.name}, cos {cosine}: no more light than came", albedo.max() < 1.01 * INDEX_SQUARED)
    si = interaction(0.6)
    test = ChiSquareTest(domain=SphericalDomain(), sample_func=sampler_of(bsdf, si), pdf_func=density_of(bsdf, si),
                         sample_dim=3, sample_count=1_000_000, res=101, ires=16, seed=1)
    accepted, total = test.run(), float(dr.sum(test.histogram)[0]) / test.sample_count
    check(f"{material.name}: chi-square", accepted and total > 0.8, f"p-value {float(test.p_value):.3f}, sampled {total:.4f}")


def schlick(f0, cosine):
    return f0 + (1 - f0) * (1 - cosine) ** 5


bsdf = mi.load_dict(irradia_bsdf.register(GLASS))
f0 = (0.5 / 2.5) ** 2
for cosine, name in ((0.7, "into glass"), (-0.9, "out of glass"), (-0.5, "out of glass beyond the critical angle")):
    bs, weight = sampled(bsdf, interaction(cosine))
    eta = 1.5 if cosine > 0 else 1 / 1.5
    sine = np.sqrt(1 - cosine**2) / eta
    through = np.array(bs.wo.z) * cosine < 0
    weights = np.array(weight.x)
    if sine < 1:
        beyond = np.sqrt(1 - sine**2)
        expected = schlick(f0, cosine if cosine > 0 else beyond)
        direction = np.abs(np.array(bs.wo.z)[through]).mean()
        check(f"{name}: Snell", abs(direction - beyond) < 1e-3, f"{direction:.5f} {beyond:.5f}")
        transmitted = weights[through].sum() / len(weights)
        check(f"{name}: transmitted radiance", abs(transmitted / ((1 - expected) / eta**2) - 1) < 0.01, f"{transmitted:.4f}")
    else:
        expected = 1
        check(f"{name}: nothing goes through", weights[through].sum() == 0)
    reflected = weights[~through].sum() / len(weights)
    check(f"{name}: reflected share", abs(reflected / expected - 1) < 0.01, f"{reflected:.4f} {expected:.4f}")

for material, name in (
    (Material("pane", (1, 1, 1, 1), 0, 0, transmission=1), "white pane, smooth"),
    (Material("silver", (1, 1, 1, 1), 1, 0.1), "white metal, smooth"),
):
    albedo = mean(sampled(mi.load_dict(irradia_bsdf.register(material)), interaction(0.8))[1])
    check(f"{name}: all light comes back", np.abs(albedo - 1).max() < 0.01, str(albedo.round(4)))

# glTF 2.0, appendix B, in numpy, with D in its usual form.
bsdf = mi.load_dict(irradia_bsdf.register(PLASTIC))
rng = np.random.default_rng(1)
for _ in range(4):
    v, l = (lambda w: w / np.linalg.norm(w))(rng.uniform(0.1, 1, 3)), (lambda w: w / np.linalg.norm(w))(rng.uniform(0.1, 1, 3))
    h = (v + l) / np.linalg.norm(v + l)
    a2 = 0.5**4
    d = a2 / (np.pi * (h[2] ** 2 * (a2 - 1) + 1) ** 2)
    g = 2 * l[2] * v[2] / (l[2] * np.sqrt(a2 + (1 - a2) * v[2] ** 2) + v[2] * np.sqrt(a2 + (1 - a2) * l[2] ** 2))
    f = schlick(0.04, v @ h)
    expected = np.array(PLASTIC.base_color[:3]) / np.pi * (1 - f) + f * d * g / (4 * l[2] * v[2])
    si = interaction(1.0)
    si.wi = mi.Vector3f(*v.tolist())
    value = bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(*l.tolist()))
    value = np.array([value.x[0], value.y[0], value.z[0]]) / l[2]
    check("eval is glTF's formula", np.abs(value / expected - 1).max() < 1e-4, f"{value.round(5)}")

own = mi.load_dict({"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.6, 0.5, 0.4]}})
ours = mi.load_dict(irradia_bsdf.register(MATTE))
si, wo = interaction(0.7), mi.Vector3f(0.36, 0.48, 0.8)
difference = dr.max(dr.abs(own.eval(mi.BSDFContext(), si, wo) - ours.eval(mi.BSDFContext(), si, wo)), axis=None)
check("matte is Mitsuba's diffuse", difference[0] < 1e-6 if hasattr(difference, "__len__") else difference < 1e-6)

sys.exit(f"{len(failures)} checks failed" if failures else 0)
