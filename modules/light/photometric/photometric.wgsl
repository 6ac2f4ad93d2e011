/// What was measured: 0, 1 or 2 for the pole, the number of polar angles and of azimuths, the flux in lm; the polar angles, the azimuths, both
/// in rad and increasing; for each azimuth the intensities at the polar angles, cd.
var<storage> profile: array<f32>;

const TAU: f32 = 6.28318530717959;

/// Angle of the point (x, y) to the x axis, in [-pi, pi]; 0 at the origin. By a polynomial for the arc tangent on [0, 1] with a relative error of
/// 7e-8: of its own WGSL promises 4096 ulp.
fn angle_of(y: f32, x: f32) -> f32 {
    let a = abs(vec2f(x, y));
    let t = min(a.x, a.y) / max(max(a.x, a.y), 1e-30);
    let u = t * t;
    let tail = 0.10865759 + u * (-0.080096819 + u * (0.048914321 + u * (-0.020026747 + u * 3.8667389e-3)));
    var angle = t + t * u * (-0.33333322 + u * (0.19998682 + u * (-0.14257045 + u * tail)));
    angle = select(angle, 0.5 * PI - angle, a.y > a.x);
    angle = select(angle, PI - angle, x < 0.0);
    return select(angle, -angle, y < 0.0);
}

/// Index of the last of `count` increasing numbers from `first` on that is not above x, but not the last of all.
fn interval(first: u32, count: u32, x: f32) -> u32 {
    var low = 0u;
    var high = count - 1u;
    // 2^12 is more than a file's angles.
    for (var halvings = 0u; halvings < 12u; halvings++) {
        let middle = (low + high) / 2u;
        if high - low > 1u {
            if profile[first + middle] <= x {
                low = middle;
            } else {
                high = middle;
            }
        }
    }
    return low;
}

/// Intensity toward a direction given by its parts along `across`, `up` and the luminaire's direction, cd. Bilinear in the angles; beyond those
/// that were measured there is no light.
fn intensity_toward(along: vec3f) -> f32 {
    let pole = u32(profile[0]);
    // Types A and B look along the direction, their poles are below and to the left.
    var turned = along;
    if pole == 1u {
        turned = vec3f(along.z, along.x, -along.y);
    } else if pole == 2u {
        turned = vec3f(along.z, along.y, -along.x);
    }
    let polar = angle_of(length(turned.xy), turned.z);
    let polar_count = u32(profile[1]);
    let azimuth_count = u32(profile[2]);
    let azimuths = 4u + polar_count;

    let start = profile[azimuths];
    let span = profile[azimuths + azimuth_count - 1u] - start;
    let turns = (angle_of(turned.y, turned.x) - start) / TAU;
    let turn = TAU * (turns - floor(turns));
    let outside = polar < profile[4] || polar > profile[azimuths - 1u];
    // A whole turn has no gap, whatever rounding makes of its end.
    if outside || (turn > span && span < 6.283) {
        return 0.0;
    }
    let azimuth = start + min(turn, span);

    let p = interval(4u, polar_count, polar);
    let a = interval(azimuths, azimuth_count, azimuth);
    let polar_below = profile[4u + p];
    let azimuth_below = profile[azimuths + a];
    let s = clamp((polar - polar_below) / max(profile[5u + p] - polar_below, 1e-9), 0.0, 1.0);
    let t = clamp((azimuth - azimuth_below) / max(profile[azimuths + a + 1u] - azimuth_below, 1e-9), 0.0, 1.0);
    let row = azimuths + azimuth_count + a * polar_count + p;
    let low = mix(profile[row], profile[row + 1u], s);
    let high = mix(profile[row + polar_count], profile[row + polar_count + 1u], s);
    return mix(low, high, t);
}

/// Radiance toward v because of all luminaires of this measurement, cd/m2.
fn light(s: Surface, v: vec3f) -> vec3f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < arrayLength(&instances); i++) {
        let to_light = instances[i].position - s.position;
        let square = dot(to_light, to_light);
        // A surface within 1e-15 m of the light has no direction to it: l and with it n.l vanish.
        let per_distance = inverseSqrt(max(square, 1e-30));
        let l = to_light * per_distance;
        let distance = square * per_distance;
        let cosine = dot(s.normal, l);
        let axis = unit_or(instances[i].direction, vec3f(0.0));
        if cosine > 0.0 && dot(axis, axis) > 0.5 {
            // Where `across` is along the direction, any other does.
            let across = unit_or(instances[i].across - dot(instances[i].across, axis) * axis, frame_of(axis)[0]);
            let up = cross(across, axis);
            let candela = intensity_toward(-vec3f(dot(l, across), dot(l, up), dot(l, axis)));
            // Of a measurement without light the flux is 0; 1e-9 lm keeps the quotient finite.
            let scaled = select(1.0, instances[i].flux / max(profile[3], 1e-9), instances[i].flux > 0.0);
            let intensity = candela * scaled * instances[i].multiplier;
            let illuminance = intensity * falloff(distance, instances[i].range, instances[i].size) * cosine;
            if illuminance > 0.0 {
                var ray: Ray;
                ray.light = i;
                ray.direction = l;
                ray.distance = distance;
                sum += instances[i].color * (illuminance * visible(ray, s)) * brdf(s, v, l);
            }
        }
    }
    return sum;
}
