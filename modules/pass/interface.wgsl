/// The view that a pass draws: the camera's, or a shadow map's.
struct Frame {
    /// World space to clip space, depth 0 (near) to 1 (far).
    view_projection: mat4x4f,
    /// Position of the eye in world space, m.
    eye: vec3f,
    /// 1 where the eye is a point; 0 for an orthographic view, which looks along `forward` everywhere.
    perspective: f32,
    /// Direction of view, unit length.
    forward: vec3f,
    /// Seconds since the first frame.
    time: f32,
    /// Size of the target in texels.
    size: vec2f,
}

/// One object of a draw.
struct Object {
    /// Object space to world space.
    model: mat4x4f,
    /// Transposed inverse of the model matrix's upper 3x3 part, for normals.
    normal: mat3x3f,
}

/// One layer of a shadow map.
struct View {
    /// World space to clip space, depth 0 (near) to 1 (far).
    view_projection: mat4x4f,
    /// Position of the light in world space, m.
    position: vec3f,
    /// Distance of the near plane, m.
    near: f32,
    /// Distance of the far plane, m.
    far: f32,
    /// Side of a texel at distance 1 m (perspective) or anywhere (orthographic), m.
    texel: f32,
    /// 1 for a perspective view, 0 for an orthographic one.
    perspective: f32,
}

var<uniform> frame: Frame;
var<storage, read> objects: array<Object>;
