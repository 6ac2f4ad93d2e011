/// Factor of the luminance by channel about a place of a luminous surface: (0, 0) is its top left, (1, 1) its bottom right, seen from the front.
/// The mean over a Gaussian around there with this standard deviation along width and height; beyond an edge is what is on it. Neutral: 1.
fn picture(at: vec2f, deviation: vec2f) -> vec3f {
    return vec3f(1.0);
}

/// The mean over the whole surface. Neutral: 1.
fn picture_mean() -> vec3f {
    return vec3f(1.0);
}
