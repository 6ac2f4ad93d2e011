var shadow_map: texture_depth_cube_array;
var shadow_compare_sampler: sampler_comparison;
var shadow_depth_sampler: sampler;
/// Six for each light, one for each face; they differ only in their matrices.
var<storage, read> views: array<View>;

/// Distance along the axis of the face that the direction points at, m.
fn axis_distance(direction: vec3f) -> f32 {
    let a = abs(direction);
    return max(a.x, max(a.y, a.z));
}

/// Depth in the map of a point at this offset from the light: a perspective from near (0) to far (1) along the axis of a face.
fn face_depth(layer: u32, direction: vec3f) -> f32 {
    let near = views[6u * layer].near;
    let far = views[6u * layer].far;
    let z = clamp(axis_distance(direction), near, far);
    return far * (z - near) / (z * (far - near));
}

/// The receiver's direction, moved by texels in the plane of its face.
fn face_offset(at: Receiver, offset: vec2f) -> vec3f {
    let a = abs(at.place);
    let step = offset * shadow_texel(at);
    if a.x >= a.y && a.x >= a.z {
        return at.place + vec3f(0.0, step);
    }
    if a.y >= a.z {
        return at.place + vec3f(step.x, 0.0, step.y);
    }
    return at.place + vec3f(step, 0.0);
}

/// 1 where nothing is nearer to the light than the receiver, 0 where something is. An offset may lead across an edge
/// of the cube, where depth is measured along another axis, so the depth to compare with is found anew.
fn shadow_compare(at: Receiver, offset: vec2f) -> f32 {
    let direction = face_offset(at, offset);
    return textureSampleCompareLevel(shadow_map, shadow_compare_sampler, direction, at.layer, face_depth(at.layer, direction));
}

/// Stored depth.
fn shadow_depth(at: Receiver, offset: vec2f) -> f32 {
    return textureSampleLevel(shadow_map, shadow_depth_sampler, face_offset(at, offset), at.layer, 0);
}

/// Side of a texel at the receiver, m.
fn shadow_texel(at: Receiver) -> f32 {
    return views[6u * at.layer].texel * axis_distance(at.place);
}

/// Share of the light that arrives, in [0, 1].
///
/// A texel is flat where the surface is not: along a grazing ray the surface leaves it by the sine of the angle between
/// ray and normal. The receiver is lifted off the surface by as much, and moved toward the light by the bias.
fn visible(ray: Ray, s: Surface) -> f32 {
    var at: Receiver;
    at.layer = ray.light;
    at.place = s.position - views[6u * ray.light].position;
    let lift = params.normal_offset * shadow_texel(at) * length(cross(s.geometric_normal, ray.direction));
    at.place += s.geometric_normal * lift + ray.direction * params.bias;
    at.depth = face_depth(at.layer, at.place);
    return filter_shadow(at);
}
