"""The materials that the converted scenes had before they became glTF (see "How converted scenes were made" in their README):
plastics and dielectrics with exact Fresnel terms and, for plastics, light that is reflected back inside the layer."""

import mitsuba as mi
import numpy as np


def bsdf_of(material):
    """The dict of Mitsuba's own BSDF; None where the glTF material is the source's."""
    alpha = material.roughness**2
    rough = {} if material.roughness == 0 else {"alpha": alpha, "distribution": "ggx"}
    prefix = "rough" if rough else ""
    if material.transmission > 0 and material.thickness > 0:
        return {"type": f"{prefix}dielectric", "int_ior": material.ior, **rough}
    if material.metallic == 0 and material.specular > 0 and material.transmission == 0:
        color = {"type": "rgb", "value": list(material.base_color[:3])}
        if "base_color" in material.textures:
            texels = np.ascontiguousarray(material.textures["base_color"].texels[..., :3])
            color = {"type": "bitmap", "bitmap": mi.Bitmap(texels), "raw": True}
        plastic = {"type": f"{prefix}plastic", "diffuse_reflectance": color, "int_ior": material.ior, **rough}
        return {"type": "twosided", "bsdf": plastic}
    return None
