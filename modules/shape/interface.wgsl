// What an area light offers to the modules in its slot `area`. i is the light's index, `origin` the shaded point in world space, m. The neutral
// shape, for whoever is probed alone: a sphere of 0.5 m around (0, 0, 2) with 1 cd/m2.

/// A unit direction toward the shape with the density `shape_pdf`, for u uniform in [0, 1)^2. It may miss a shape with a ragged rim: such a
/// sample counts, with the radiance 0.
fn shape_sample(i: u32, origin: vec3f, u: vec2f) -> vec3f {
    return sphere_sample(shape_centre(i) - origin, shape_radius(i), u);
}

/// Density over solid angle with which `shape_sample` draws the unit direction l, 1/sr; 0 where it never does.
fn shape_pdf(i: u32, origin: vec3f, l: vec3f) -> f32 {
    return sphere_pdf(shape_centre(i) - origin, shape_radius(i), l);
}

/// Luminance of the shape from the origin along l, cd/m2 per channel: 0 where l misses it, or meets a side that is dark.
fn shape_radiance(i: u32, origin: vec3f, l: vec3f) -> vec3f {
    return vec3f(select(0.0, 1.0, shape_pdf(i, origin, l) > 0.0));
}

/// Luminance of the shape toward the origin where it is seen at all, cd/m2 per channel. Where it is not alike all over: the mean over the lobe
/// that GGX facets of the width alpha on a surface with the unit normal n have around `along`, the direction in which they mirror the eye. The cosine's
/// lobe has `along` = n and an alpha of 0.5, and one of 0 is a ray.
fn shape_luminance(i: u32, origin: vec3f, n: vec3f, along: vec3f, alpha: f32) -> vec3f {
    return vec3f(1.0);
}

/// Illuminance over pi times luminance of a small plane at the origin with the unit normal n: 1 where the shape covers its whole sky. What
/// is below the plane's horizon does not count.
fn shape_configuration_factor(i: u32, origin: vec3f, n: vec3f) -> f32 {
    let c = shape_centre(i) - origin;
    let per_distance = inverseSqrt(max(dot(c, c), 1e-30));
    return sphere_factor(shape_radius(i) * per_distance, dot(c, n) * per_distance, length(cross(c, n)) * per_distance);
}

/// The same of the plane z = 0, after the linear map `local` of all offsets from the origin: with the rotation to a surface's frame it is the
/// configuration factor, with a further map the integral of a linearly transformed cosine (Heitz et al. 2016).
fn shape_form_factor(i: u32, origin: vec3f, local: mat3x3f) -> f32 {
    return mapped_sphere_factor(shape_centre(i) - origin, shape_radius(i), local);
}

/// Offset from the origin to the point of the shape that is nearest to the ray from there along the unit direction `along`, m.
fn shape_toward(i: u32, origin: vec3f, along: vec3f) -> vec3f {
    return sphere_toward(shape_centre(i) - origin, shape_radius(i), along);
}

/// How many corners the shape's outline has, seen from the origin; 0 where nothing of it shines there. Round outlines have enough of them.
fn shape_corners(i: u32, origin: vec3f) -> u32 {
    return CIRCLE_CORNERS;
}

/// Offset from the origin to the corner k of that outline, in the order around it, m. The edges are great circles in the origin's sky, shorter
/// than half of one.
fn shape_corner(i: u32, origin: vec3f, k: u32) -> vec3f {
    return sphere_corner(shape_centre(i) - origin, shape_radius(i), k);
}

/// Middle of the shape, m.
fn shape_centre(i: u32) -> vec3f {
    return vec3f(0.0, 0.0, 2.0);
}

/// Radius of the disk or sphere of about its size, m.
fn shape_radius(i: u32) -> f32 {
    return 0.5;
}

/// Area that the shape shows in the direction of the origin, m2: times the luminance it is the luminous intensity of the light as a point.
/// 0 from behind.
fn shape_projected_area(i: u32, origin: vec3f) -> f32 {
    return PI * shape_radius(i) * shape_radius(i);
}

// A circle as a polygon of the same area.

const CIRCLE_CORNERS: u32 = 24u;

/// Corner k of the regular polygon with the area of the unit disk.
fn circle_corner(k: u32) -> vec2f {
    // Of angles beyond pi WGSL promises no sine.
    let turn = PI * (f32(k) / 12.0 - 1.0);
    return 1.005741237 * vec2f(cos(turn), sin(turn));
}

/// Direction at the angle 2 atan(t) from the first column toward the second.
fn out_at(frame: mat3x3f, t: f32) -> vec3f {
    return (frame[0] * (1.0 - t * t) + frame[1] * (2.0 * t)) / (1.0 + t * t);
}

// A sphere by its centre's offset c from the origin and its radius, m. A point inside sees what one on the sphere sees.

/// Squared sine of the angle that the sphere's rim makes with its middle.
fn sphere_sine_squared(c: vec3f, radius: f32) -> f32 {
    return min(radius * radius / max(dot(c, c), 1e-30), 1.0);
}

/// 1 - cos of that angle, without subtracting.
fn sphere_cap(c: vec3f, radius: f32) -> f32 {
    let sine2 = sphere_sine_squared(c, radius);
    return sine2 / (1.0 + sqrt(1.0 - sine2));
}

/// A direction in the sphere's cone, by solid angle.
fn sphere_sample(c: vec3f, radius: f32, u: vec2f) -> vec3f {
    let fall = u.x * sphere_cap(c, radius);
    let across = sqrt(fall * (2.0 - fall));
    // Of angles beyond pi WGSL promises no sine.
    let turn = PI * (2.0 * u.y - 1.0);
    return frame_of(unit_or(c, vec3f(0.0, 0.0, 1.0))) * vec3f(across * cos(turn), across * sin(turn), 1.0 - fall);
}

/// 1 over the cone's solid angle in it, 0 elsewhere, 1/sr. The sine tells in a narrow cone what the cosine cannot.
fn sphere_pdf(c: vec3f, radius: f32, l: vec3f) -> f32 {
    let middle = unit_or(c, vec3f(0.0, 0.0, 1.0));
    let across = cross(middle, l);
    let is_in = dot(middle, l) >= 0.0 && dot(across, across) <= sphere_sine_squared(c, radius);
    return select(0.0, 0.5 * INV_PI / max(sphere_cap(c, radius), 1e-30), is_in);
}

/// Form factor of the sphere after the linear map `local`: of the ellipse that its rim becomes.
fn mapped_sphere_factor(c: vec3f, radius: f32, local: mat3x3f) -> f32 {
    // Nearer than 1e-6 of the radius the rim would leave for infinity.
    let sine2 = min(sphere_sine_squared(c, radius), 0.999998);
    let frame = frame_of(unit_or(c, vec3f(0.0, 0.0, 1.0)));
    let rim = sqrt(sine2 / (1.0 - sine2));
    return ellipse_factor(local * frame[2], local * (frame[0] * rim), local * (frame[1] * rim));
}

/// The sphere's rim, in the plane through its centre. That of a point on the sphere would be infinitely far away.
fn sphere_corner(c: vec3f, radius: f32, k: u32) -> vec3f {
    let sine2 = min(sphere_sine_squared(c, radius), 0.999998);
    let frame = frame_of(unit_or(c, vec3f(0.0, 0.0, 1.0)));
    let at = circle_corner(k) * sqrt(sine2 / (1.0 - sine2));
    return (frame[2] + frame[0] * at.x + frame[1] * at.y) * max(length(c), 1e-15);
}

/// The point of the sphere nearest to the ray along the unit direction `along` (Karis 2013, eqs. 11 and 12); the centre's own depth where the ray hits.
fn sphere_toward(c: vec3f, radius: f32, along: vec3f) -> vec3f {
    let to_ray = dot(c, along) * along - c;
    let distance = length(to_ray);
    return c + to_ray * min(radius / max(distance, 1e-15), 1.0);
}

/// The point between c - half and c + half that is nearest to the ray along the unit direction `along`; where the ray leaves all of them behind, the end whose
/// direction is nearer to its own.
fn segment_toward(c: vec3f, half: vec3f, along: vec3f) -> vec3f {
    let reach = unit_or(half, vec3f(0.0));
    let slope = dot(along, reach);
    // Both lines parallel: any point is as near.
    let x = (slope * dot(along, c) - dot(c, reach)) / max(1.0 - slope * slope, 1e-6);
    let limit = length(half);
    let near = c + reach * clamp(x, -limit, limit);
    let end = c + half * sign(slope);
    return select(end, near, dot(unit_or(near, -along), along) >= dot(unit_or(end, -along), along));
}

// A flat shape.

/// Columns: the directions of width and height in the plane, and its normal. What of `right` is along the normal does not count; where nothing is
/// left any direction will do.
fn plane_axes(direction: vec3f, right: vec3f) -> mat3x3f {
    let normal = unit_or(direction, vec3f(0.0, 0.0, 1.0));
    let width = unit_or(right - normal * dot(normal, right), frame_of(normal)[0]);
    return mat3x3f(width, cross(normal, width), normal);
}

/// 1 where the triangle a, b, c goes counterclockwise around the origin, -1 where clockwise, 0 where the origin is outside. Of a fan of triangles that
/// begin with its first corner the common sides belong to the one before them.
fn triangle_turn(a: vec2f, b: vec2f, c: vec2f) -> i32 {
    let sides = vec3f(a.x * b.y - a.y * b.x, b.x * c.y - b.y * c.x, c.x * a.y - c.y * a.x);
    if sides.x > 0.0 && sides.y >= 0.0 && sides.z >= 0.0 {
        return 1;
    }
    return select(0, -1, sides.x < 0.0 && sides.y <= 0.0 && sides.z <= 0.0);
}

/// A point of a plane by its coordinates there, from the offset of their origin.
fn plane_point(c: vec3f, frame: mat3x3f, at: vec2f) -> vec3f {
    return c + frame[0] * at.x + frame[1] * at.y;
}

/// 1 where the side that is seen shines: the front, seen by a positive cosine, or either.
fn plane_shines(cosine: f32, two_sided: bool) -> f32 {
    return select(0.0, 1.0, select(cosine, abs(cosine), two_sided) > 0.0);
}

/// Distance along l to the plane with the offset c, both in the plane's axes; 0 where l never meets it.
fn plane_distance(c: vec3f, l: vec3f) -> f32 {
    return select(0.0, c.z / l.z, c.z * l.z > 0.0);
}

/// Where the ray along `along` meets the plane with the offset c, both in the plane's axes, from its middle. A ray that leaves the plane behind meets
/// it nowhere: it is taken to go along the plane then, and to meet it far away.
fn plane_track(c: vec3f, along: vec3f) -> vec2f {
    return along.xy * (abs(c.z) / max(along.z * sign(c.z), 1e-6)) - c.xy;
}

/// What a lobe (see `shape_luminance`, n and a for its normal and middle) lights of a rectangle with half the sides `half` and the offset c, all in
/// the plane's axes: the middle, from the rectangle's own, and the standard deviation along both sides.
///
/// The lobe is a cosine stretched along a. Times the cosine at the plane and over the squared distance it is greatest in closed form, and its middle is
/// about twice as far from the nearest point of the plane, as the lobe sees it. Along a side it is taken for (r^2 + x^2)^(-3/2), that of a lobe toward
/// the plane, r being the distance that the lobe sees. Factors are fitted to means of pictures.
fn plane_footprint(c: vec3f, n: vec3f, a: vec3f, alpha: f32, half: vec2f) -> vec4f {
    // The map to the lobe from the cosine's: by 2 alpha across a, and across the plane of incidence by less, since facets turn about the eye's direction.
    let s = min(2.0 * alpha, 1.0);
    let aside = cross(n, a);
    let less = s / ((1.0 + alpha) * (1.0 + max(dot(n, a), 0.0)));
    let lobe = mat3x3f(
        vec3f(s, 0.0, 0.0) + ((1.0 - s) * a.x) * a - (less * aside.x) * aside,
        vec3f(0.0, s, 0.0) + ((1.0 - s) * a.y) * a - (less * aside.y) * aside,
        vec3f(0.0, 0.0, s) + ((1.0 - s) * a.z) * a - (less * aside.z) * aside,
    );
    // The plane's normal away from the origin, and its distance, as the lobe sees them.
    let mapped = lobe[2] * select(-1.0, 1.0, c.z >= 0.0);
    let per_length = 1.0 / max(length(mapped), 1e-6);
    let normal = mapped * per_length;
    let distance = abs(c.z) * per_length;
    let cosine = dot(normal, a);
    // A lobe that leaves the plane behind meets it far away; from there a rectangle looks alike all over.
    let place = normal + (a - cosine * normal) / max(cosine + 0.5 * sqrt(3.0 + cosine * cosine), 0.01);
    let middle = clamp(distance * (lobe * place).xy - c.xy, -1000.0 * half, 1000.0 * half);
    let across = length(lobe[0] - dot(lobe[0], normal) * normal);
    let up = length(lobe[1] - dot(lobe[1], normal) * normal);
    let radius = (0.975 - 0.325 * cosine) * distance * vec2f(across, up);
    // Beside the rectangle the tail is wide.
    let beside = max(abs(middle) - half, vec2f(0.0)).yx;
    let r = sqrt(radius * radius + beside * beside);
    let low = -half - middle;
    let high = half - middle;
    let to_low = max(sqrt(r * r + low * low), vec2f(1e-12));
    let to_high = max(sqrt(r * r + high * high), vec2f(1e-12));
    let mean = middle + (high * to_low + low * to_high) / (to_low + to_high);
    // Twice the integral over the greatest value, at the peak or at the nearer end; of a tail more.
    let inside = 2.0 * r * (high / to_high - low / to_low);
    let near = min(abs(low), abs(high));
    let far = max(abs(low), abs(high));
    let to_near = min(to_low, to_high);
    let to_far = max(to_low, to_high);
    let tail = (far - near) * (far + near) / max(far * to_near + near * to_far, vec2f(1e-30)) * (to_near / to_far);
    let outside = (2.0 * to_near + 3.0 * near) * tail;
    let width = min(select(outside, inside, low * high < vec2f(0.0)), 2.0 * half);
    return vec4f(clamp(mean, -half, half), 0.288675135 * width);
}
