/// Workgroups that share the texels; each leaves one partial sum.
const GROUPS: u32 = 256u;
/// Invocations of a workgroup.
const LANES: u32 = 256u;
/// Added to the luminance inside the logarithm so that a black texel counts as very dark, not as minus infinity, cd/m2.
const DELTA: f32 = 1e-4;

struct Reduction {
    /// Sum of logarithms and number of texels, by workgroup.
    partial: array<vec2f, GROUPS>,
    /// Logarithmic mean of the luminance, cd/m2.
    mean: f32,
}

/// What is equal for all invocations of a workgroup. A struct of its own: a compiler that checks uniform control flow
/// takes a struct to be as non-uniform as its most non-uniform member.
struct GroupIn {
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
}

struct LaneIn {
    @builtin(local_invocation_index) lane: u32,
}

var<storage, read_write> reduction: Reduction;
var<workgroup> sums: array<vec2f, LANES>;

/// Whether no component is NaN or infinite, by the exponent's bits: comparisons may be optimised as if there were no NaN.
fn finite(c: vec3f) -> bool {
    return all((bitcast<vec3u>(c) & vec3u(0x7f800000u)) != vec3u(0x7f800000u));
}

/// Adds what all lanes have put into `sums`, in a fixed order, so that equal frames give equal bits. The result is in `sums[0]`.
fn add_lanes(lane: u32) {
    for (var half = LANES / 2u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if lane < half {
            sums[lane] += sums[lane + half];
        }
    }
}

/// Dispatched with one invocation for each texel of the frame; the first GROUPS workgroups walk over all of them.
@compute @workgroup_size(16, 16)
fn sum_texels(whole: GroupIn, in: LaneIn) {
    let group = whole.group.y * whole.groups.x + whole.group.x;
    if group >= GROUPS {
        return;
    }
    let size = textureDimensions(hdr);
    let stride = min(whole.groups.x * whole.groups.y, GROUPS) * LANES;
    var sum = vec2f(0.0);
    for (var i = group * LANES + in.lane; i < size.x * size.y; i += stride) {
        let color = textureLoad(hdr, vec2u(i % size.x, i / size.x), 0).rgb;
        if finite(color) {
            sum += vec2f(log(max(luminance(color), 0.0) + DELTA), 1.0);
        }
    }
    sums[in.lane] = sum;
    add_lanes(in.lane);
    if in.lane == 0u {
        reduction.partial[group] = sums[0];
    }
}

/// Dispatched as a single workgroup after `sum_texels`.
@compute @workgroup_size(256)
fn finish_mean(in: LaneIn) {
    // A smaller frame than before leaves old sums behind the ones it wrote.
    let size = textureDimensions(hdr);
    let written = ((size.x + 15u) / 16u) * ((size.y + 15u) / 16u);
    sums[in.lane] = select(vec2f(0.0), reduction.partial[in.lane], in.lane < written);
    add_lanes(in.lane);
    if in.lane == 0u {
        reduction.mean = exp(sums[0].x / max(sums[0].y, 1.0));
    }
}

/// Key / mean, m2/cd.
fn exposure() -> f32 {
    return params.key / clamp(reduction.mean, params.darkest, max(params.darkest, params.brightest));
}
