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
    /// World space, m.
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
}

struct FragmentIn {
    @builtin(front_facing) front: bool,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
}

struct FragmentOut {
    /// Radiance toward the eye, cd/m2 per channel, and coverage (colour not multiplied by it).
    @location(0) color: vec4f,
}

/// Deforms the vertex in object space and carries it to world space.
@vertex
fn vertex_main(in: VertexIn) -> VertexOut {
    var v: Vertex;
    v.position = in.position;
    v.normal = in.normal;
    v.tangent = in.tangent;
    v.uv = in.uv;
    v = deform(v);

    let model = objects[in.object].model;
    let world = model * vec4f(v.position, 1.0);
    let linear = mat3x3f(model[0].xyz, model[1].xyz, model[2].xyz);
    var out: VertexOut;
    out.clip = frame.view_projection * world;
    out.position = world.xyz;
    out.normal = objects[in.object].normal * v.normal;
    // A mirroring transform turns cross(normal, tangent) around.
    out.tangent = vec4f(linear * v.tangent.xyz, v.tangent.w * sign(determinant(linear)));
    out.uv = v.uv;
    return out;
}

/// What the surface emits, and what it reflects of all lights.
@fragment
fn fragment_main(in: FragmentIn) -> FragmentOut {
    var v = -frame.forward;
    if frame.perspective > 0.5 {
        v = unit_or(frame.eye - in.position, v);
    }

    var at: Fragment;
    at.position = in.position;
    at.normal = unit_or(in.normal, v);
    at.tangent = in.tangent;
    at.uv = in.uv;
    if params.double_sided {
        // All three axes turn around, w being the third's: a map's normal is reversed as a whole, as glTF 2.0 has it (section 3.9.6).
        at.normal = select(-at.normal, at.normal, in.front);
        at.tangent = select(-at.tangent, at.tangent, in.front);
    }

    let s = surface(at);
    var out: FragmentOut;
    out.color = vec4f(s.emission + light(s, v), s.opacity);
    return out;
}
