/// Fresnel's equations for unpolarised light that meets a metal of the complex index eta + i k, by channel.
///
/// a + i b is the root of (eta + i k)^2 - sin^2. The larger of a and b is a sum of numbers of one sign, the smaller eta k over it; taken
/// as a difference it has lost four digits for silver. All that follows are sums of squares.
fn fresnel(s: Surface, cosine: f32) -> vec3f {
    let c = clamp(cosine, 0.0, 1.0);
    let sine2 = (1.0 - c) * (1.0 + c);
    let real = (params.eta - params.k) * (params.eta + params.k) - sine2;
    let half_imaginary = params.eta * params.k;
    let modulus = sqrt(real * real + 4.0 * half_imaginary * half_imaginary);
    let larger = sqrt(0.5 * (modulus + abs(real)));
    // 0 only for a boundary without contrast, seen along it; the floor keeps that from 0 / 0.
    let smaller = half_imaginary / max(larger, vec3f(1e-18));
    let a = select(smaller, larger, real >= vec3f(0.0));
    let b = select(larger, smaller, real >= vec3f(0.0));

    let across = square(a - c, b) / max(square(a + c, b), vec3f(1e-30));
    let ratio = square(a * c - sine2, b * c) / max(square(a * c + sine2, b * c), vec3f(1e-30));
    return min(0.5 * across * (1.0 + ratio), vec3f(1.0));
}

/// Squared modulus of x + i y.
fn square(x: vec3f, y: vec3f) -> vec3f {
    return x * x + y * y;
}
