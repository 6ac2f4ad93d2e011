/// All of the disc's light comes from its centre.
fn disc(s: Surface, v: vec3f, l: vec3f, radius: f32) -> vec3f {
    let cosine = dot(s.normal, l);
    if cosine <= 0.0 {
        return vec3f(0.0);
    }
    return brdf(s, v, l) * cosine;
}
