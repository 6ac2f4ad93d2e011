const PI: f32 = 3.14159265358979;
const INV_PI: f32 = 0.318309886183791;

/// Luminance of a linear Rec.709 colour (ITU-R BT.709, Y row).
fn luminance(c: vec3f) -> f32 {
    return dot(c, vec3f(0.2126, 0.7152, 0.0722));
}

/// v at unit length; `fallback` where v is so short that its direction is noise. 1e-15 is far below any length in
/// metres that a scene has, and its square is still a normal f32.
fn unit_or(v: vec3f, fallback: vec3f) -> vec3f {
    let square = dot(v, v);
    return select(fallback, v * inverseSqrt(max(square, 1e-30)), square > 1e-30);
}

/// Columns tangent, bitangent and n of a right-handed orthonormal frame around the unit vector n. Duff et al. 2017, listing 3.
fn frame_of(n: vec3f) -> mat3x3f {
    let side = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (side + n.z);
    let b = n.x * n.y * a;
    return mat3x3f(vec3f(1.0 + side * n.x * n.x * a, side * b, -side * n.x), vec3f(b, side + n.y * n.y * a, -n.y), n);
}

/// A direction around the unit vector n with the density cos / pi, for u uniform in [0, 1)^2. Malley's method (Shirley and Wang 1992).
fn cosine_sample(n: vec3f, u: vec2f) -> vec3f {
    let radius = sqrt(u.x);
    // Of angles beyond pi WGSL promises no sine.
    let turn = PI * (2.0 * u.y - 1.0);
    return frame_of(n) * vec3f(radius * cos(turn), radius * sin(turn), sqrt(max(1.0 - u.x, 0.0)));
}

/// Density of `cosine_sample`, 1/sr; 0 below the horizon.
fn cosine_pdf(n: vec3f, l: vec3f) -> f32 {
    return max(dot(n, l), 0.0) * INV_PI;
}

/// The angle from the x axis to a point with y not below 0, in [0, pi], rad; 0 at the origin. A polynomial of ours: relative error 2e-7, where
/// WGSL promises 4096 units in the last place of its own.
fn polar_angle(y: f32, x: f32) -> f32 {
    let most = max(y, abs(x));
    // The floor keeps 0 / 0 from the origin alone: squares of anything smaller are 0 in f32.
    let t = min(y, abs(x)) / max(most, 1e-30);
    let t2 = t * t;
    var p = 0.0028498882;
    p = p * t2 - 0.0160686234;
    p = p * t2 + 0.0426915103;
    p = p * t2 - 0.0750429378;
    p = p * t2 + 0.1064093367;
    p = p * t2 - 0.1420364438;
    p = p * t2 + 0.1999261938;
    p = p * t2 - 0.3333307334;
    p = (p * t2 + 0.9999999848) * t;
    let acute = select(p, 0.5 * PI - p, y > abs(x));
    return select(acute, PI - acute, x < 0.0);
}
