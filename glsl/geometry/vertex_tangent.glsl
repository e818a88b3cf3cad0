// What fragments with a normal map get of a vertex besides.

layout(location = 2) in vec4 tangent;

layout(location = 3) out vec4 vertex_tangent;

void write_tangent() {
    vertex_tangent = tangent;
}
