/// f0 + (f90 - f0) (1 - cosine)^5. The power is multiplied out: `pow` of a base that rounding made negative is undefined.
fn fresnel(s: Surface, cosine: f32) -> vec3f {
    let x = clamp(1.0 - cosine, 0.0, 1.0);
    let x2 = x * x;
    return s.f0 + (s.f90 - s.f0) * (x2 * x2 * x);
}
