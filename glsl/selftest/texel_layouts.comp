#version 460
#include "lib/prelude.glsl"
#include "lib/lights.glsl"
#include "lib/scene.glsl"

// The lists that shading reads as texel buffers, read as structs too: counts the elements that differ. Whoever changes one side of
// a layout and not the other finds a count above 0. The host's side of these structs is generated from the blocks below.

layout(local_size_x = 1) in;

layout(set = 0, binding = 0) readonly buffer Instances { Instance instances[]; };
layout(set = 0, binding = 1) readonly buffer Materials { Material materials[]; };
layout(set = 0, binding = 2) readonly buffer Uses { MaterialTextures uses[]; };
layout(set = 0, binding = 3) readonly buffer Lights { Light lights[]; };
layout(set = 0, binding = 4) readonly buffer Views { LightView views[]; };
layout(set = 0, binding = 5) uniform usamplerBuffer instance_texels;
layout(set = 0, binding = 6) uniform usamplerBuffer material_texels;
layout(set = 0, binding = 7) uniform usamplerBuffer use_texels;
layout(set = 0, binding = 8) uniform usamplerBuffer light_texels;
layout(set = 0, binding = 9) uniform usamplerBuffer view_texels;
layout(set = 0, binding = 10) writeonly buffer Differences { uint differences[]; };

bool differ(TextureUse a, TextureUse b) {
    return a != b;
}

void main() {
    uint i = gl_WorkGroupID.x;

    Instance instance = instances[i];
    instance.reserved = uvec3(0u);
    Material material = materials[i];
    MaterialTextures textures = uses[i];
    LightView view = views[i];
    view.view_projection = mat4(0.0);
    view.reserved = 0u;

    bool uses_differ = differ(textures.base_color, load_texture_use(use_texels, i, USE_BASE_COLOR))
                       || differ(textures.metallic_roughness, load_texture_use(use_texels, i, USE_METALLIC_ROUGHNESS))
                       || differ(textures.normal, load_texture_use(use_texels, i, USE_NORMAL))
                       || differ(textures.emissive, load_texture_use(use_texels, i, USE_EMISSIVE))
                       || differ(textures.specular, load_texture_use(use_texels, i, USE_SPECULAR))
                       || differ(textures.specular_color, load_texture_use(use_texels, i, USE_SPECULAR_COLOR))
                       || differ(textures.transmission, load_texture_use(use_texels, i, USE_TRANSMISSION));

    differences[5u * i] = instance != load_instance(instance_texels, i) ? 1u : 0u;
    differences[5u * i + 1u] = material != load_material(material_texels, i) ? 1u : 0u;
    differences[5u * i + 2u] = uses_differ ? 1u : 0u;
    differences[5u * i + 3u] = lights[i] != load_light(light_texels, i) ? 1u : 0u;
    differences[5u * i + 4u] = view != load_view(view_texels, i) ? 1u : 0u;
}
