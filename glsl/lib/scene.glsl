// What the host knows of a scene: camera, instances, materials.
//
// Spaces, by suffix: `_rs` render space, the world's axes in metres minus the scene's fixed origin; no suffix on a vector of an
// instance: its object space. Depth is reversed: 1 at the near plane, 0 at infinity (perspective) or at the far
// plane (orthographic), and 0 where there is no surface.
#ifndef LIB_SCENE
#define LIB_SCENE

struct Camera {
    mat4 view_projection;  // render space to clip space, y down
    vec3 position_rs;
    float near;            // metres along `forward`
    vec3 forward;          // unit
    float depth_range;     // orthographic: far − near; perspective, which is infinite: 0
    vec3 right_scaled;     // from the image's centre to its right edge: at distance 1 (perspective) or in metres (orthographic)
    vec3 down_scaled;      // likewise to its lower edge
};

// The point of render space behind a pixel. It takes the depth's float precision along the ray and no matrix inverse.
vec3 position_of_pixel(Camera camera, vec2 ndc, float depth) {
    vec3 across = ndc.x * camera.right_scaled + ndc.y * camera.down_scaled;
    return camera.depth_range > 0.0
        ? camera.position_rs + across + camera.forward * (camera.near + (1.0 - depth) * camera.depth_range)
        : camera.position_rs + (camera.forward + across) * (camera.near / depth);
}

vec3 direction_to_eye(Camera camera, vec3 position_rs) {
    return camera.depth_range > 0.0 ? -camera.forward : normalize(camera.position_rs - position_rs);
}

const uint INSTANCE_FLAT_NORMALS = 1u;  // the primitive has no vertex normals
const uint INSTANCE_FLIPPED = 2u;       // the transform mirrors
const uint INSTANCE_HAS_COLORS = 4u;
const uint INSTANCE_HAS_TANGENTS = 8u;

struct Instance {
    mat3x4 object_to_render;  // its columns are the affine transform's rows: vec4(p, 1) * object_to_render
    vec3 cofactor_x;          // the columns of the linear part's cofactor matrix, (b×c, c×a, a×b) of its columns a, b, c,
    uint material;            // times any positive factor. It maps the cross product of two edges to that of the mapped edges:
    vec3 cofactor_y;          // normals stay perpendicular under any scale and follow the winding under a mirror.
    uint flags;
    vec3 cofactor_z;
    uint first_index;         // of the primitive in the scene's index buffer
    int vertex_offset;        // added to every index
    uvec3 reserved;           // fills the last of seven vec4
};

// The lists of instances, materials and texture uses are read as texel buffers (rgba32ui): a CPU driver gathers these several times
// faster than it loads structs from storage buffers. A field that nobody uses costs no fetch.
mat3x4 load_transform(usamplerBuffer instances, uint index) {
    int first = 7 * int(index);
    return mat3x4(
        uintBitsToFloat(texelFetch(instances, first)), uintBitsToFloat(texelFetch(instances, first + 1)),
        uintBitsToFloat(texelFetch(instances, first + 2)));
}

Instance load_instance(usamplerBuffer instances, uint index) {
    int first = 7 * int(index);
    uvec4 x = texelFetch(instances, first + 3);
    uvec4 y = texelFetch(instances, first + 4);
    uvec4 z = texelFetch(instances, first + 5);
    uint vertex_offset = texelFetch(instances, first + 6).x;
    return Instance(
        load_transform(instances, index), uintBitsToFloat(x.xyz), x.w, uintBitsToFloat(y.xyz), y.w, uintBitsToFloat(z.xyz), z.w,
        int(vertex_offset), uvec3(0u));
}

vec3 transform_normal(Instance instance, vec3 normal) {
    return normal.x * instance.cofactor_x + normal.y * instance.cofactor_y + normal.z * instance.cofactor_z;
}

vec3 transform_direction(Instance instance, vec3 direction) {
    return vec4(direction, 0.0) * instance.object_to_render;
}

const uint MATERIAL_DOUBLE_SIDED = 1u;
const uint MATERIAL_UNLIT = 2u;
const uint MATERIAL_BASE_COLOR_TEXTURE = 4u;
const uint MATERIAL_METALLIC_ROUGHNESS_TEXTURE = 8u;
const uint MATERIAL_NORMAL_TEXTURE = 16u;
const uint MATERIAL_EMISSIVE_TEXTURE = 32u;
const uint MATERIAL_SPECULAR_TEXTURE = 64u;
const uint MATERIAL_SPECULAR_COLOR_TEXTURE = 128u;
const uint MATERIAL_TRANSMISSION_TEXTURE = 256u;
const uint MATERIAL_ALL_TEXTURES = 0x1FCu;

// glTF 2.0 metallic-roughness with KHR_materials_{ior, specular, transmission, emissive_strength, unlit}: the factors.
struct Material {
    vec4 base_color;
    vec3 emissive;          // radiance, W/(m²·sr): factor times strength
    float metallic;
    vec3 specular_color;
    float specular;
    float roughness;        // perceptual; α is its square
    float ior;
    float transmission;
    float normal_scale;
    float alpha_cutoff;     // below 0: opaque
    uint flags;
    uvec2 medium;           // what it bounds, packed: medium_of()
};

Material load_material(usamplerBuffer materials, uint index) {
    int first = 5 * int(index);
    vec4 base_color = uintBitsToFloat(texelFetch(materials, first));
    vec4 emissive = uintBitsToFloat(texelFetch(materials, first + 1));
    vec4 specular = uintBitsToFloat(texelFetch(materials, first + 2));
    vec4 factors = uintBitsToFloat(texelFetch(materials, first + 3));
    uvec4 last = texelFetch(materials, first + 4);
    return Material(
        base_color, emissive.xyz, emissive.w, specular.xyz, specular.w, factors.x, factors.y, factors.z, factors.w,
        uintBitsToFloat(last.x), last.y, last.zw);
}

// What lies behind a surface that bounds a closed solid (KHR_materials_volume); a thin wall has nothing behind it.
struct Medium {
    bool is_closed;
    vec3 absorption;  // 1/m
};

// Three positive floats without their ten lowest bits, and one bit for the kind.
Medium medium_of(Material material) {
    uvec2 bits = material.medium;
    uvec3 channels = uvec3(bits.x & 0x1FFFFFu, bits.x >> 21 | (bits.y & 0x3FFu) << 11, bits.y >> 10 & 0x1FFFFFu);
    return Medium(bits.y >> 31 != 0u, uintBitsToFloat(channels << 10));
}

// How a material reads one texture: uv' = (u_row·(uv,1), v_row·(uv,1)) in `layer` of the array that is bound for it.
struct TextureUse {
    vec3 u_row;
    uint layer;
    vec3 v_row;
    uint texcoord;  // 0 or 1
};

// The order of a material's texture uses.
const uint USE_BASE_COLOR = 0u;
const uint USE_METALLIC_ROUGHNESS = 1u;
const uint USE_NORMAL = 2u;
const uint USE_EMISSIVE = 3u;
const uint USE_SPECULAR = 4u;
const uint USE_SPECULAR_COLOR = 5u;
const uint USE_TRANSMISSION = 6u;

TextureUse load_texture_use(usamplerBuffer material_textures, uint material, uint use) {
    int first = 14 * int(material) + 2 * int(use);
    uvec4 u = texelFetch(material_textures, first);
    uvec4 v = texelFetch(material_textures, first + 1);
    return TextureUse(uintBitsToFloat(u.xyz), u.w, uintBitsToFloat(v.xyz), v.w);
}

// One a material, in the materials' order; only programs that read textures bind it.
struct MaterialTextures {
    TextureUse base_color;
    TextureUse metallic_roughness;
    TextureUse normal;
    TextureUse emissive;
    TextureUse specular;
    TextureUse specular_color;
    TextureUse transmission;
};

#endif
