/// Stands in another struct.
struct Inner {
    a: f32,
    b: vec3f,
    c: f32,
}

/// A name that the written Rust has for itself, and gaps of every kind [in brackets].
struct Layout {
    /// The first of many.
    pad_4: f32,
    /// 12 bytes are between these.
    in: vec3f,
    Upper: u32,
    m33: mat3x3f,
    m23: mat2x3f,
    m32: mat3x2f,
    m42: mat4x2f,
    list: array<vec3f, 2>,
    inner: Inner,
    pair: array<Inner, 2>,
    signed: vec2i,
    /// Any number of them.
    tail: array<vec3f>,
}

struct Counter {
    count: atomic<u32>,
    runs: array<u32, 3>,
}

var<storage, read> state: Layout;
var<storage, read_write> result: array<f32>;
var<storage, read> threes: array<vec3f>;
var<storage, read_write> counter: Counter;
var picture: texture_storage_2d<rgba32float, write>;
var image: texture_2d<f32>;
var image_sampler: sampler;

var<private> next: u32;

fn put(x: f32) {
    result[next] = x;
    next += 1u;
}

fn put2(v: vec2f) {
    put(v.x);
    put(v.y);
}

fn put3(v: vec3f) {
    put2(v.xy);
    put(v.z);
}

/// Reads everything, in its order.
@compute @workgroup_size(1, 1, 1)
fn read_all() {
    put(state.pad_4);
    put3(state.in);
    put(f32(state.Upper));
    for (var i = 0u; i < 3u; i++) { put3(state.m33[i]); }
    for (var i = 0u; i < 2u; i++) { put3(state.m23[i]); }
    for (var i = 0u; i < 3u; i++) { put2(state.m32[i]); }
    for (var i = 0u; i < 4u; i++) { put2(state.m42[i]); }
    for (var i = 0u; i < 2u; i++) { put3(state.list[i]); }
    put(state.inner.a);
    put3(state.inner.b);
    put(state.inner.c);
    for (var i = 0u; i < 2u; i++) {
        put(state.pair[i].a);
        put3(state.pair[i].b);
        put(state.pair[i].c);
    }
    put2(vec2f(state.signed));
    put(f32(arrayLength(&state.tail)));
    for (var i = 0u; i < arrayLength(&state.tail); i++) { put3(state.tail[i]); }
    for (var i = 0u; i < arrayLength(&threes); i++) { put3(threes[i]); }
    put3(params.direction);
    put2(params.place);
    put3(params.tint);
    put(params.level);
    put(f32(params.steps / 1000000u));
    put(f32(params.below));
    put(params.gain);
    put(f32(params.turns));
    put(f32(params.offset));
    put(f32(params.mirrored));
    put(f32(atomicAdd(&counter.count, 1u)));
    put(f32(counter.runs[2]));
}

/// Paints, so that textures are bound as well.
@compute @workgroup_size(4, 2)
fn render(@builtin(global_invocation_id) id: vec3u) {
    let color = textureSampleLevel(image, image_sampler, vec2f(1.5, 0.5), 0.0);
    textureStore(picture, id.xy, color * params.gain);
}
