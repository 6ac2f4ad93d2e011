/// atan(x) / x for x in [-1, 1], relative error 2e-8 before rounding. Fitted at Chebyshev's nodes: WGSL allows the built-in
/// function 4096 ULP.
fn arctan_ratio(x: f32) -> f32 {
    let y = x * x;
    let high = 0.106367541 + y * (-0.07495445443 + y * (0.04258760746 + y * (-0.0160050305 + y * 0.002834064298)));
    return 0.9999999842 + y * (-0.3333306678 + y * (0.1999248358 + y * (-0.1420257051 + y * high)));
}

/// Angle in [0, pi] of which sine and cosine are in the ratio `sine` to `cosine`, sine >= 0, divided by `sine`. Both have the unit of a square,
/// and the result that of its inverse. The floors keep 0 / 0 away; 1e-30 is the square of a length that no scene has.
fn angle_over_sine(sine: f32, cosine: f32) -> f32 {
    if cosine >= sine {
        let c = max(cosine, 1e-30);
        return arctan_ratio(sine / c) / c;
    }
    let s = max(sine, 1e-30);
    if cosine > -sine {
        let x = cosine / s;
        return (1.57079632679490 - x * arctan_ratio(x)) / s;
    }
    let x = sine / cosine;
    return (3.14159265358979 + x * arctan_ratio(x)) / s;
}

/// Angle in [0, pi] with this sine >= 0 and cosine, which may share any factor.
fn angle_of(sine: f32, cosine: f32) -> f32 {
    return sine * angle_over_sine(sine, cosine);
}

/// artanh(x) / x for x in [0, 1). Near 1 the logarithm of a clamped argument: the weights of what it stands for vanish there.
fn artanh_ratio(x: f32) -> f32 {
    let y = x * x;
    if x < 0.3 {
        return 1.0 + y * (0.333333333 + y * (0.2 + y * (0.142857143 + y * (0.111111111 + y * 0.0909090909))));
    }
    return 0.5 * log((1.0 + x) / max(1.0 - x, 6e-8)) / x;
}

/// Area of the segment that a chord cuts off the unit disk: w - sin(w) cos(w) of half the angle w in [0, pi] that it subtends. For small
/// w the difference has no digits left, so its series in the sine stands in; the first term left out is 2e-7 of the sum at 0.3.
fn disk_segment(sine: f32, cosine: f32) -> f32 {
    if sine < 0.3 && cosine > 0.0 {
        let y = sine * sine;
        return sine * y * (0.666666667 + y * (0.2 + y * (0.107142857 + y * (0.0694444444 + y * 0.0497159091))));
    }
    return angle_of(sine, cosine) - sine * cosine;
}
