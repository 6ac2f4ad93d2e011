/// Width, height and number of the levels; of each level its width, its height and the place of its first texel; the texels, rows from the top.
var<storage> image: array<vec4f>;

/// A level between its texels; beyond the outermost middles is what is there.
fn between(level: u32, at: vec2f) -> vec3f {
    let head = image[1u + level];
    let place = clamp(at * head.xy - 0.5, vec2f(0.0), head.xy - 1.0);
    let corner = min(floor(place), max(head.xy - 2.0, vec2f(0.0)));
    let share = place - corner;
    let low = vec2u(corner);
    let high = min(low + 1u, vec2u(head.xy) - 1u);
    let width = u32(head.x);
    let row = u32(head.z) + low.y * width;
    let next = u32(head.z) + high.y * width;
    let above = mix(image[row + low.x].rgb, image[row + high.x].rgb, share.x);
    let below = mix(image[next + low.x].rgb, image[next + high.x].rgb, share.x);
    return mix(above, below, share.y);
}

/// A level whose texels have a width of 2^`level` of the largest's: between its neighbours.
fn smoothed(level: f32, at: vec2f) -> vec3f {
    let last = image[0].z - 1.0;
    let lower = clamp(floor(level), 0.0, max(last - 1.0, 0.0));
    let index = u32(lower);
    let share = clamp(level - lower, 0.0, 1.0);
    return mix(between(index, at), between(min(index + 1u, u32(last)), at), share);
}

/// Texels of a width of 1, averaged and interpolated, have a standard deviation of 1/2. Where the deviation is larger along one side, lookups in a row
/// along that side make up for it.
fn picture(at: vec2f, deviation: vec2f) -> vec3f {
    let size = image[0].xy;
    let wide = max(2.0 * deviation * size, vec2f(1.0));
    let major = max(wide.x, wide.y);
    let minor = max(min(wide.x, wide.y), major / f32(params.lookups));
    let level = log2(minor);
    // n of them a step apart add (n^2 - 1) / 12 steps^2 to the variance.
    let count = f32(params.lookups);
    let stride = sqrt(3.0 * (major * major - minor * minor) / max(count * count - 1.0, 1.0));
    let pace = select(vec2f(0.0, stride / size.y), vec2f(stride / size.x, 0.0), wide.x >= wide.y);
    var sum = vec3f(0.0);
    for (var k = 0u; k < params.lookups; k++) {
        sum += smoothed(level, at + (f32(k) - 0.5 * (count - 1.0)) * pace);
    }
    return sum / count;
}

/// The single texel of the last level.
fn picture_mean() -> vec3f {
    return image[arrayLength(&image) - 1u].rgb;
}
