// What fragments with textures get of a vertex besides.

layout(location = 3) in vec2 texcoord0;
layout(location = 4) in vec2 texcoord1;

layout(location = 4) out vec4 texcoord_sets;
layout(location = 6) flat out vec4 corner_texcoords;

void write_texcoords() {
    texcoord_sets = vec4(texcoord0, texcoord1);
    corner_texcoords = texcoord_sets;
}
