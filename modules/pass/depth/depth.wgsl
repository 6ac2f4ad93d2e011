struct VertexIn {
    /// Which of `objects` is drawn.
    @builtin(instance_index) object: u32,
    /// Object space, m.
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    /// w is the sign of the bitangent.
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
}

struct VertexOut {
    @builtin(position) clip: vec4f,
}

/// Deforms the vertex in object space and projects it; the rasteriser writes the depth.
@vertex
fn vertex_main(in: VertexIn) -> VertexOut {
    var v: Vertex;
    v.position = in.position;
    v.normal = in.normal;
    v.tangent = in.tangent;
    v.uv = in.uv;
    v = deform(v);

    var out: VertexOut;
    out.clip = frame.view_projection * (objects[in.object].model * vec4f(v.position, 1.0));
    return out;
}
