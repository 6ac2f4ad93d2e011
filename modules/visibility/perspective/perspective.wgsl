var shadow_map: texture_depth_2d_array;
var shadow_compare_sampler: sampler_comparison;
var shadow_depth_sampler: sampler;
/// One for each light.
var<storage, read> views: array<View>;

/// Place in the map, moved by texels.
fn map_offset(at: Receiver, offset: vec2f) -> vec2f {
    return at.place.xy + offset / vec2f(textureDimensions(shadow_map));
}

/// 1 where nothing is nearer to the light than the receiver, 0 where something is.
fn shadow_compare(at: Receiver, offset: vec2f) -> f32 {
    return textureSampleCompareLevel(shadow_map, shadow_compare_sampler, map_offset(at, offset), at.layer, at.depth);
}

/// Stored depth.
fn shadow_depth(at: Receiver, offset: vec2f) -> f32 {
    return textureSampleLevel(shadow_map, shadow_depth_sampler, map_offset(at, offset), at.layer, 0);
}

/// Side of a texel at the receiver, m.
fn shadow_texel(at: Receiver) -> f32 {
    return views[at.layer].texel * mix(1.0, at.place.z, views[at.layer].perspective);
}

/// Share of the light that arrives, in [0, 1]. What the map does not see is lit: outside its square, behind the light,
/// beyond its far plane.
///
/// A texel is flat where the surface is not: along a grazing ray the surface leaves it by the sine of the angle between
/// ray and normal. The receiver is lifted off the surface by as much, and moved toward the light by the bias.
fn visible(ray: Ray, s: Surface) -> f32 {
    let projection = views[ray.light].view_projection;
    var at: Receiver;
    at.layer = ray.light;
    at.place.z = (projection * vec4f(s.position, 1.0)).w;
    let lift = params.normal_offset * shadow_texel(at) * length(cross(s.geometric_normal, ray.direction));
    let lifted = s.position + s.geometric_normal * lift + ray.direction * params.bias;

    let clip = projection * vec4f(lifted, 1.0);
    // Not only w > 0: the quotient of a point in the plane of the light would overflow. Nothing is lit from 1e-6 m.
    if clip.w <= 1e-6 || any(abs(clip.xy) > vec2f(clip.w)) || clip.z > clip.w {
        return 1.0;
    }
    at.place = vec3f(clip.xy / clip.w * vec2f(0.5, -0.5) + 0.5, clip.w);
    at.depth = clip.z / clip.w;
    return filter_shadow(at);
}
