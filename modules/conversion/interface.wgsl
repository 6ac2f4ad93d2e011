/// Smallest alpha. A narrower lobe is not resolved by unit vectors of 32-bit floats: their rounding, 6e-8, is already 1/1700 of this width
/// and an error of 5e-4 in the lobe.
const MIN_ALPHA: f32 = 1e-4;

/// Width of a microfacet lobe, in [1e-4, 1], from perceptual roughness in [0, 1]: its square (Burley 2012, section 5.4).
fn alpha_of_roughness(roughness: f32) -> f32 {
    return max(roughness * roughness, MIN_ALPHA);
}

/// Perceptual roughness, from the width of a lobe: its root.
fn roughness_of_alpha(alpha: f32) -> f32 {
    return sqrt(alpha);
}

/// Perceptual roughness from glossiness: 1 - glossiness (Khronos Group 2017, KHR_materials_pbrSpecularGlossiness).
fn roughness_of_glossiness(glossiness: f32) -> f32 {
    return 1.0 - glossiness;
}

/// Exponent of the power of a cosine that is as wide as facets of this alpha: 2 / alpha^2 - 2 (Walter et al. 2007, section 5.2), without the
/// difference of two numbers near each other. The floor is far below what a surface has, and its square is still a normal f32.
fn exponent_of_alpha(alpha: f32) -> f32 {
    let a = max(alpha, 1e-12);
    return max(2.0 * (1.0 - a) * (1.0 + a) / (a * a), 0.0);
}

/// Widths along the tangent and across it, from roughness and a strength in [0, 1] that widens the lobe along the tangent up to 1
/// (Khronos Group 2023, KHR_materials_anisotropy).
fn widths_of_strength(roughness: f32, strength: f32) -> vec2f {
    let alpha = alpha_of_roughness(roughness);
    return vec2f(mix(alpha, 1.0, strength * strength), alpha);
}

/// Widths along the tangent and across it, from roughness and an anisotropy in [0, 1]: their ratio is 1 - anisotropy, the mean of their
/// squares that of roughness^4 (OpenPBR 1.1, section Microfacet model).
fn widths_of_anisotropy(roughness: f32, anisotropy: f32) -> vec2f {
    let ratio = 1.0 - anisotropy;
    let along = roughness * roughness * sqrt(2.0 / (1.0 + ratio * ratio));
    return max(vec2f(along, ratio * along), vec2f(MIN_ALPHA));
}

/// Reflectance at normal incidence of a boundary with this relative index of refraction: ((n - 1) / (n + 1))^2 (Fresnel 1823).
fn f0_of_ior(ior: f32) -> f32 {
    let root = (ior - 1.0) / (ior + 1.0);
    return root * root;
}

/// Roughness of a base as it appears through a coat of this weight, whose own facets spread the light on its way in and out
/// (OpenPBR 1.1, section Coat, roughening).
fn roughness_under_coat(base: f32, coat: f32, weight: f32) -> f32 {
    let b2 = base * base;
    let c2 = coat * coat;
    return mix(base, sqrt(sqrt(min(b2 * b2 + 2.0 * c2 * c2, 1.0))), weight);
}

/// Share of light from all sides within a medium of this index of refraction, 1 and more, that its boundary to air reflects back: 1 - (1 - E) / n^2 with E the
/// mean reflectance from outside (Saunderson 1942). E is the fit of OpenPBR 1.1, section Coat, within 1.9e-3.
fn inner_reflectance_of_ior(ior: f32) -> f32 {
    let outside = log((10893.0 * ior - 1438.2) / (1.0 + ior * (10212.0 - 774.4 * ior)));
    return 1.0 - (1.0 - outside) / (ior * ior);
}

/// Sine of the standard deviation of the angle of a rough surface's grooves: their slopes have the root mean square roughness^2 / sqrt(2), which is
/// that of Beckmann's facets of this roughness.
fn grooves_of_roughness(roughness: f32) -> f32 {
    let alpha = roughness * roughness;
    return alpha * inverseSqrt(2.0 + alpha * alpha);
}
