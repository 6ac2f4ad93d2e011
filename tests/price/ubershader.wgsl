// The monolith with everything that the standard library offers in these places behind switches in a uniform buffer: Lambert's BRDF or the
// microfacet one, hard or filtered shadows with any radius, maps or none for each of the three lists of lights, a spot light's perspective
// in the flat maps. One pipeline for all of it.

const INV_PI = 0.318309886183791;
const MIN_ALPHA = 1e-4;

const BRDF_LAMBERT = 0u;
const FILTERING_HARD = 0u;
const VISIBILITY_NONE = 0u;

struct Switches {
    // 0 Lambert, 1 microfacet
    brdf: u32,
    // 0 hard, 1 filtered
    filtering: u32,
    radius: u32,
    // 0 none, 1 a map
    directional_visibility: u32,
    point_visibility: u32,
    fill_visibility: u32,
}

struct Frame {
    view_projection: mat4x4f,
    eye: vec3f,
    perspective: f32,
    forward: vec3f,
    time: f32,
    size: vec2f,
}

struct Object {
    model: mat4x4f,
    normal: mat3x3f,
}

struct ShadowView {
    view_projection: mat4x4f,
    position: vec3f,
    near: f32,
    far: f32,
    texel: f32,
    perspective: f32,
}

struct DirectionalLight {
    direction: vec3f,
    color: vec3f,
    illuminance: f32,
}

struct PointLight {
    position: vec3f,
    color: vec3f,
    intensity: f32,
    range: f32,
    size: f32,
}

struct ShadowSettings {
    directional_normal_offset: f32,
    directional_bias: f32,
    point_normal_offset: f32,
    point_bias: f32,
}

struct Material {
    base_color: vec3f,
    opacity: f32,
    metalness: f32,
    roughness: f32,
    reflectance: f32,
    emission_color: vec3f,
    emission: f32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(1) @binding(0) var<uniform> shadows: ShadowSettings;
@group(1) @binding(1) var<storage, read> directional_lights: array<DirectionalLight>;
@group(1) @binding(2) var directional_map: texture_depth_2d_array;
@group(1) @binding(3) var directional_sampler: sampler_comparison;
@group(1) @binding(4) var<storage, read> directional_views: array<ShadowView>;
@group(1) @binding(5) var<storage, read> point_lights: array<PointLight>;
@group(1) @binding(6) var cube_map: texture_depth_cube_array;
@group(1) @binding(7) var cube_sampler: sampler_comparison;
@group(1) @binding(8) var<storage, read> cube_views: array<ShadowView>;
@group(1) @binding(9) var<storage, read> fill_lights: array<PointLight>;
@group(2) @binding(0) var<uniform> material: Material;
@group(2) @binding(1) var<uniform> switches: Switches;
@group(3) @binding(0) var<storage, read> objects: array<Object>;

struct VertexIn {
    @builtin(instance_index) object: u32,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
}

struct VertexOut {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
}

@vertex
fn vertex_main(in: VertexIn) -> VertexOut {
    let world = objects[in.object].model * vec4f(in.position, 1.0);
    return VertexOut(frame.view_projection * world, world.xyz, objects[in.object].normal * in.normal);
}

struct Shading {
    position: vec3f,
    n: vec3f,
    v: vec3f,
    n_dot_v: f32,
    diffuse: vec3f,
    f0: vec3f,
    alpha: f32,
}

fn unit_or(v: vec3f, fallback: vec3f) -> vec3f {
    let square = dot(v, v);
    return select(fallback, v * inverseSqrt(max(square, 1e-30)), square > 1e-30);
}

// GGX, height-correlated Smith, Schlick, Lambert. n_dot_l is above 0.
fn brdf(s: Shading, l: vec3f, n_dot_l: f32) -> vec3f {
    if s.n_dot_v <= 0.0 {
        return vec3f(0.0);
    }
    if switches.brdf == BRDF_LAMBERT {
        return s.diffuse * INV_PI;
    }
    let h = unit_or(s.v + l, s.n);
    let n_dot_h = dot(s.n, h);
    let across = cross(s.n, h);
    let along = s.alpha * n_dot_h;
    let k = s.alpha / max(along * along + dot(across, across), 1e-24);
    let d = select(0.0, k * k * INV_PI, n_dot_h > 0.0);
    let a2 = s.alpha * s.alpha;
    let toward_v = n_dot_l * sqrt(a2 + (1.0 - a2) * s.n_dot_v * s.n_dot_v);
    let toward_l = s.n_dot_v * sqrt(a2 + (1.0 - a2) * n_dot_l * n_dot_l);
    let vis = 0.5 / max(toward_v + toward_l, 1e-12);
    let x = clamp(1.0 - dot(s.v, h), 0.0, 1.0);
    let x2 = x * x;
    let f = s.f0 + (1.0 - s.f0) * (x2 * x2 * x);
    return f * (d * vis) + s.diffuse * INV_PI;
}

fn directional_shadow(light: u32, s: Shading, l: vec3f) -> f32 {
    if switches.directional_visibility == VISIBILITY_NONE {
        return 1.0;
    }
    let projection = directional_views[light].view_projection;
    let w = (projection * vec4f(s.position, 1.0)).w;
    let texel = directional_views[light].texel * mix(1.0, w, directional_views[light].perspective);
    let lift = shadows.directional_normal_offset * texel * length(cross(s.n, l));
    let lifted = s.position + s.n * lift + l * shadows.directional_bias;
    let clip = projection * vec4f(lifted, 1.0);
    if clip.w <= 1e-6 || any(abs(clip.xy) > vec2f(clip.w)) || clip.z > clip.w {
        return 1.0;
    }
    let place = clip.xyz / clip.w;
    let uv = place.xy * vec2f(0.5, -0.5) + 0.5;
    if switches.filtering == FILTERING_HARD {
        return textureSampleCompareLevel(directional_map, directional_sampler, uv, light, place.z);
    }
    let reach = i32(switches.radius) + 1;
    let size = vec2f(textureDimensions(directional_map));
    var lit = 0.0;
    for (var y = 1 - reach; y < reach; y++) {
        for (var x = 1 - reach; x < reach; x++) {
            let weight = f32((reach - abs(x)) * (reach - abs(y)));
            let at = uv + vec2f(f32(x), f32(y)) / size;
            lit += weight * textureSampleCompareLevel(directional_map, directional_sampler, at, light, place.z);
        }
    }
    return lit / f32(reach * reach * reach * reach);
}

fn axis_distance(direction: vec3f) -> f32 {
    let a = abs(direction);
    return max(a.x, max(a.y, a.z));
}

fn point_shadow(light: u32, s: Shading, l: vec3f, visibility: u32) -> f32 {
    if visibility == VISIBILITY_NONE {
        return 1.0;
    }
    let near = cube_views[6u * light].near;
    let far = cube_views[6u * light].far;
    let texel = cube_views[6u * light].texel;
    var place = s.position - cube_views[6u * light].position;
    let lift = shadows.point_normal_offset * (texel * axis_distance(place)) * length(cross(s.n, l));
    place += s.n * lift + l * shadows.point_bias;
    if switches.filtering == FILTERING_HARD {
        let z = clamp(axis_distance(place), near, far);
        return textureSampleCompareLevel(cube_map, cube_sampler, place, light, far * (z - near) / (z * (far - near)));
    }
    let reach = i32(switches.radius) + 1;
    // The plane of the face that is looked at, and a texel's side there.
    let a = abs(place);
    let step = texel * max(a.x, max(a.y, a.z));
    var right = vec3f(step, 0.0, 0.0);
    var up = vec3f(0.0, step, 0.0);
    if a.x >= a.y && a.x >= a.z {
        right = vec3f(0.0, step, 0.0);
        up = vec3f(0.0, 0.0, step);
    } else if a.y >= a.z {
        up = vec3f(0.0, 0.0, step);
    }
    var lit = 0.0;
    for (var y = 1 - reach; y < reach; y++) {
        for (var x = 1 - reach; x < reach; x++) {
            let weight = f32((reach - abs(x)) * (reach - abs(y)));
            let direction = place + right * f32(x) + up * f32(y);
            // An offset may lead to another face, where depth is measured along another axis.
            let z = clamp(axis_distance(direction), near, far);
            let depth = far * (z - near) / (z * (far - near));
            lit += weight * textureSampleCompareLevel(cube_map, cube_sampler, direction, light, depth);
        }
    }
    return lit / f32(reach * reach * reach * reach);
}

// Unit vector to the light, and the illuminance of a perpendicular surface.
fn point_incidence(light: PointLight, position: vec3f) -> vec4f {
    let to_light = light.position - position;
    let square = dot(to_light, to_light);
    let per_distance = inverseSqrt(max(square, 1e-30));
    let distance = square * per_distance;
    let nearest = max(distance, light.size);
    let x = min(distance, light.range) / max(light.range, 1e-15);
    let window = 1.0 - x * x * x * x;
    return vec4f(to_light * per_distance, light.intensity * (window * window / (nearest * nearest)));
}

@fragment
fn fragment_main(in: VertexOut) -> @location(0) vec4f {
    var s: Shading;
    s.position = in.position;
    s.v = -frame.forward;
    if frame.perspective > 0.5 {
        s.v = unit_or(frame.eye - in.position, s.v);
    }
    s.n = unit_or(in.normal, s.v);
    s.n_dot_v = dot(s.n, s.v);
    s.diffuse = material.base_color * (1.0 - material.metalness);
    s.f0 = mix(vec3f(material.reflectance), material.base_color, material.metalness);
    s.alpha = max(material.roughness * material.roughness, MIN_ALPHA);

    var sum = material.emission_color * material.emission;
    for (var i = 0u; i < arrayLength(&directional_lights); i++) {
        let l = unit_or(-directional_lights[i].direction, vec3f(0.0));
        let n_dot_l = dot(s.n, l);
        let illuminance = directional_lights[i].illuminance * n_dot_l;
        if illuminance > 0.0 {
            sum += directional_lights[i].color * (illuminance * directional_shadow(i, s, l)) * brdf(s, l, n_dot_l);
        }
    }
    for (var i = 0u; i < arrayLength(&point_lights); i++) {
        let incidence = point_incidence(point_lights[i], s.position);
        let n_dot_l = dot(s.n, incidence.xyz);
        let illuminance = incidence.w * n_dot_l;
        if illuminance > 0.0 {
            sum += point_lights[i].color * (illuminance * point_shadow(i, s, incidence.xyz, switches.point_visibility)) * brdf(s, incidence.xyz, n_dot_l);
        }
    }
    for (var i = 0u; i < arrayLength(&fill_lights); i++) {
        let incidence = point_incidence(fill_lights[i], s.position);
        let n_dot_l = dot(s.n, incidence.xyz);
        let illuminance = incidence.w * n_dot_l;
        if illuminance > 0.0 {
            sum += fill_lights[i].color * (illuminance * point_shadow(i, s, incidence.xyz, switches.fill_visibility)) * brdf(s, incidence.xyz, n_dot_l);
        }
    }
    return vec4f(sum, material.opacity);
}
