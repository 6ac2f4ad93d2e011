var image: texture_2d<f32>;
var image_sampler: sampler;

/// The map's vector in the frame of normal and tangent. The tangent is made orthogonal first, because interpolation tilts it.
/// Without a usable tangent the normal stays.
fn perturb(normal: vec3f, at: Fragment) -> vec3f {
    let stored = textureSample(image, image_sampler, at.uv).xyz * 2.0 - 1.0;
    let t = unit_or(at.tangent.xyz - normal * dot(normal, at.tangent.xyz), vec3f(0.0));
    let b = cross(normal, t) * at.tangent.w;
    return unit_or((t * stored.x + b * stored.y) * params.scale + normal * stored.z, normal);
}
