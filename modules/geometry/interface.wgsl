/// A vertex in object space.
struct Vertex {
    /// m
    position: vec3f,
    /// Unit length.
    normal: vec3f,
    /// Direction of growing u, unit length; w is the sign of the bitangent, cross(normal, tangent) * w.
    tangent: vec4f,
    uv: vec2f,
}

/// Moves a vertex. The neutral deformation leaves it where it is.
fn deform(v: Vertex) -> Vertex {
    return v;
}
