struct VertexIn {
    @builtin(vertex_index) vertex: u32,
}

struct VertexOut {
    @builtin(position) clip: vec4f,
}

struct FragmentIn {
    @builtin(position) position: vec4f,
}

struct FragmentOut {
    /// sRGB-encoded, in [0, 1], opaque.
    @location(0) color: vec4f,
}

/// A triangle that covers the target: corners (-1, -1), (3, -1) and (-1, 3), drawn as three vertices without buffers.
@vertex
fn vertex_main(in: VertexIn) -> VertexOut {
    let corner = vec2f(f32((in.vertex & 1u) << 2u), f32((in.vertex & 2u) << 1u));
    var out: VertexOut;
    out.clip = vec4f(corner - 1.0, 0.0, 1.0);
    return out;
}

/// Encodes linear values in [0, 1] as sRGB (IEC 61966-2-1). The power is never taken below the knee, so its base is positive.
fn srgb_encode(linear: vec3f) -> vec3f {
    let low = linear * 12.92;
    let high = 1.055 * pow(max(linear, vec3f(0.0031308)), vec3f(1.0 / 2.4)) - 0.055;
    return select(high, low, linear <= vec3f(0.0031308));
}

/// One texel of the frame, through the post chain, encoded once.
@fragment
fn fragment_main(in: FragmentIn) -> FragmentOut {
    let at = vec2u(in.position.xy);
    let linear = post(textureLoad(hdr, at, 0).rgb, at);
    var out: FragmentOut;
    out.color = vec4f(srgb_encode(clamp(linear, vec3f(0.0), vec3f(1.0))), 1.0);
    return out;
}
