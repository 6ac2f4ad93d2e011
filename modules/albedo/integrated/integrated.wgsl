/// The albedo of one facet that v sees, over its density: V 4 v.h D n.l / density, and that times (1 - v.h)^5.
fn seen(s: Surface, v: vec3f, u: vec2f) -> vec2f {
    let h = facet_sample(s, v, u);
    let l = reflect(-v, h);
    let n_dot_l = dot(s.normal, l);
    let v_dot_h = dot(v, h);
    if n_dot_l <= 0.0 || v_dot_h <= 0.0 {
        return vec2f(0.0);
    }
    // The floor is below any density that a drawn facet has.
    let weight = distribution(s, h) / max(facet_pdf(s, v, h), 1e-30) * (4.0 * v_dot_h * n_dot_l) * masking(s, v, l, h);
    let c = clamp(1.0 - v_dot_h, 0.0, 1.0);
    return weight * vec2f(1.0, c * c * c * c * c);
}

/// Point of a lattice of irrational steps: the plastic number's powers spread evenly in two dimensions.
fn lattice(i: u32) -> vec2f {
    return fract(0.5 + vec2f(0.7548776662, 0.5698402910) * f32(i));
}

/// A, B and the lost share from the lost share and B.
fn parts(found: vec2f) -> vec3f {
    return vec3f(1.0 - found.x - found.y, found.y, found.x);
}

/// The direction at this cosine to the normal. 1e-6 is nearer to the horizon than unit vectors can be told from it.
fn toward(s: Surface, cosine: f32) -> vec3f {
    let m = clamp(cosine, 1e-6, 1.0);
    return frame_of(s.normal) * vec3f(sqrt(max(1.0 - m * m, 0.0)), 0.0, m);
}

/// What each facet loses is summed, not what it sends out: that is 1 but for little where the surface is smooth.
fn facet_albedo(s: Surface, cosine: f32) -> vec3f {
    let v = toward(s, cosine);
    var sum = vec2f(0.0);
    for (var i = 0u; i < params.samples; i++) {
        let sent = seen(s, v, lattice(i));
        sum += vec2f(1.0 - sent.x, sent.y);
    }
    return parts(sum / f32(params.samples));
}

/// Cosines are the fourth powers of even steps, so that all decades count: smooth facets lose most where the cosine is about alpha. The weight is 2 m dm.
fn facet_albedo_mean(s: Surface) -> vec3f {
    var sum = vec2f(0.0);
    for (var i = 0u; i < params.samples; i++) {
        let x = (f32(i) + 0.5) / f32(params.samples);
        let x2 = x * x;
        let sent = seen(s, toward(s, x2 * x2), lattice(i));
        sum += vec2f(1.0 - sent.x, sent.y) * (8.0 * x2 * x2 * x2 * x);
    }
    return parts(sum / f32(params.samples));
}
