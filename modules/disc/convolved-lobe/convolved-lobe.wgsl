/// Mean of GGX over a small disc in the plane of slopes, over its value in the middle. `slope` is the squared distance of the middle from the
/// peak, `reach` the squared distance of the rim from the middle in the peak's direction, `area` the disc's area over pi.
///
/// alpha^2 / (pi (alpha^2 + d^2)^2) is how a plane at the distance alpha sees an element of a parallel plane, so the mean over a round disc is a
/// form factor over the area. Of an ellipse the area counts where the peak is inside, the reach where it is outside.
fn mean_over_disc(alpha: f32, slope: f32, reach: f32, area: f32) -> f32 {
    let square = alpha * alpha;
    let here = square + slope;
    let excess = here - reach;
    let product = 4.0 * square * reach;
    let root = sqrt(excess * excess + product);
    // (1 - excess / root) / 2; where excess is positive without the cancellation.
    let inside = select(0.5 * (root - excess) / root, 0.5 * product / (root * (root + abs(excess))), excess > 0.0);
    // Times pi here^2 / square, which undoes the value in the middle; as quotients, so that nothing leaves f32.
    return inside * (here / mix(reach, area, inside)) * (here / square);
}

/// The highlight is that of a point, times what the disc does to GGX; the diffuse part is that of a point.
fn disc(s: Surface, v: vec3f, l: vec3f, radius: f32) -> vec3f {
    let cosine = dot(s.normal, l);
    if cosine <= 0.0 {
        return vec3f(0.0);
    }
    // The half vectors of the disc fill an ellipse: half as wide as the disc in the plane of v and l, half over v.h across it.
    // |v + l| = 2 v.h; 1e-2 bounds it where v and l oppose each other. A disc below 1e-5 rad is a point: what is smaller vanishes against 1.
    let sum = v + l;
    let flat = max(0.5 * length(sum), 1e-2);
    let square = max(0.25 * radius * radius, 1e-10);
    // Squared distance of h from the normal in that plane and across it; 1e-20 is for v = l and h = n, where no direction is meant.
    let difference = l - v;
    let along = pow2(dot(s.normal, difference)) / max(dot(difference, difference), 1e-12);
    let across = pow2(dot(s.normal, cross(sum, difference))) / max(4.0 * flat * flat * dot(difference, difference), 1e-12);
    let reach = square * (along + across + 1e-20 / flat) / (along + flat * flat * across + 1e-20);
    // tan^2 of the angle between h and the normal; within 1e-3 of the horizon there is no highlight to widen.
    let aside = cross(s.normal, sum);
    let upward = max(dot(s.normal, sum), 1e-3);
    let factor = mean_over_disc(max(s.alpha, 1e-5), dot(aside, aside) / (upward * upward), reach, square / flat);

    var shiny = s;
    shiny.diffuse = vec3f(0.0);
    let highlight = brdf(shiny, v, l);
    let diffuse = max(brdf(s, v, l) - highlight, vec3f(0.0));
    return (diffuse + highlight * factor) * cosine;
}

fn pow2(x: f32) -> f32 {
    return x * x;
}
