//! Tests of the module around.

use super::*;

const SHADER: &str = "
        struct Params { colour: vec3f, weight: f32 }
        struct Io { @builtin(position) place: vec4f, @location(0) @interpolate(linear) uv: vec2f }
        @group(0) @binding(0) var<uniform> params: Params;
        @group(0) @binding(1) var picture: texture_2d<f32>;
        @group(0) @binding(2) var picker: sampler;
        @group(1) @binding(0) var<storage, read_write> data: array<u32>;
        @group(1) @binding(1) var target_image: texture_storage_2d<rgba16float, write>;
        var<workgroup> shared_sum: atomic<u32>;
        var<private> state: i32 = 3;
        const LIMIT: u32 = 4u;
        override gain: f32 = 1.5;
        fn helper(x: f32, y: f32) -> f32 { let z = x - y; return clamp(z * gain, 0.25, 0.75); }
        fn other(a: ptr<function, u32>) -> bool { *a = *a + 1u; return *a > LIMIT; }
        @vertex fn vs(@location(1) at: vec3f) -> Io { return Io(vec4f(at, 1.0), at.xy); }
        @fragment fn fs(in: Io) -> @location(0) vec4f {
            var sum = vec4f(0.0);
            for (var i = 0u; i < LIMIT; i++) {
                if (in.uv.x > 0.5) { continue; }
                sum += textureSample(picture, picker, in.uv) * params.weight;
            }
            switch (i32(in.place.x)) { case 1, 2: { sum.x = 1.0; } default: { discard; } }
            return vec4f(params.colour * helper(sum.x, sum.y), 1.0);
        }
        @compute @workgroup_size(8, 2) fn cs(@builtin(global_invocation_id) id: vec3u) {
            var n = id.x;
            if (other(&n)) { atomicAdd(&shared_sum, n); }
            workgroupBarrier();
            data[id.x] = atomicLoad(&shared_sum) + u32(state);
            textureStore(target_image, id.xy, vec4f(f32(n)));
        }
    ";

fn parse(source: &str) -> naga::Module {
    naga::front::wgsl::parse_str(source).unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)))
}

fn hash(source: &str) -> u128 {
    structural_hash(&parse(source))
}

/// Catches a name, comment or span that finds its way into the hash.
#[test]
fn names_do_not_count() {
    let mut renamed = SHADER.to_owned();
    for name in [
        "Params",
        "colour",
        "weight",
        "Io",
        "place",
        "uv",
        "params",
        "picture",
        "picker",
        "data",
        "target_image",
        "shared_sum",
        "state",
        "LIMIT",
        "helper",
        "other",
        "at",
        "sum",
        "in",
        "id",
    ] {
        let word = |c: char| c.is_alphanumeric() || c == '_';
        let mut text = String::new();
        let mut rest = renamed.as_str();
        while let Some(at) = rest.find(name) {
            let before = rest[..at].chars().next_back().or(text.chars().next_back());
            let whole = !before.is_some_and(word) && !rest[at + name.len()..].starts_with(word);
            text.push_str(&rest[..at]);
            text.push_str(name);
            text.push_str(if whole { "_renamed" } else { "" });
            rest = &rest[at + name.len()..];
        }
        renamed = text + rest;
    }
    renamed = renamed.replace(
        "let z = x - y; return clamp(z",
        "/* comment */\n let named = x - y; return clamp(named",
    );
    assert!(renamed.matches("_renamed").count() > 50 && renamed.contains("named = x"));
    assert_eq!(hash(&renamed), hash(SHADER));
    let documented = format!("/// Words.\n{}", SHADER.trim_start());
    assert_eq!(hash(&documented), hash(SHADER));
    let lenient = format!("diagnostic(off, derivative_uniformity);\n{SHADER}");
    assert_eq!(hash(&lenient), hash(SHADER));
}

/// Catches a part of the meaning that the hash misses.
#[test]
fn every_change_of_meaning_counts() {
    let changes = [
        ("x - y", "y - x"),
        ("x - y", "x + y"),
        ("clamp(z * gain, 0.25", "clamp(z * gain, 0.26"),
        ("0.25, 0.75", "-0.25, 0.75"),
        ("clamp(z", "smoothstep(z"),
        ("LIMIT: u32 = 4u", "LIMIT: u32 = 5u"),
        ("gain: f32 = 1.5", "gain: f32 = 1.25"),
        ("override gain", "@id(7) override gain"),
        ("override gain", "override amount"),
        ("state: i32 = 3", "state: i32 = 4"),
        ("var<private> state", "var<workgroup> other_state: u32; var<private> state"),
        ("@binding(1) var picture", "@binding(7) var picture"),
        ("@group(1) @binding(0)", "@group(2) @binding(0)"),
        ("storage, read_write> data: array<u32>", "storage, read_write> data: array<u32, 9>"),
        ("rgba16float, write", "rgba32float, write"),
        ("texture_2d<f32>", "texture_2d_array<f32>"),
        (
            "textureSample(picture, picker, in.uv)",
            "textureSampleLevel(picture, picker, in.uv, 0.0)",
        ),
        ("in.uv) *", "in.uv.yx) *"),
        ("@location(0) @interpolate(linear)", "@location(0) @interpolate(perspective)"),
        ("@location(0) @interpolate", "@location(3) @interpolate"),
        ("@location(1) at", "@location(2) at"),
        ("@builtin(global_invocation_id)", "@builtin(local_invocation_id)"),
        ("@workgroup_size(8, 2)", "@workgroup_size(8, 4)"),
        ("fn cs(", "fn compute_main("),
        (
            "struct Params { colour: vec3f, weight: f32 }",
            "struct Params { colour: vec3f, @align(16) weight: f32 }",
        ),
        ("i < LIMIT", "i <= LIMIT"),
        ("i++", "i += 2u"),
        ("continue;", "break;"),
        ("in.uv.x > 0.5", "in.uv.y > 0.5"),
        ("case 1, 2:", "case 1, 3:"),
        ("default: { discard; }", "default: { }"),
        ("helper(sum.x, sum.y)", "helper(sum.y, sum.x)"),
        ("params.colour * helper", "-params.colour * helper"),
        ("atomicAdd(", "atomicMax("),
        ("workgroupBarrier();", "storageBarrier();"),
        ("workgroupBarrier();", ""),
        (
            "if (other(&n)) { atomicAdd(&shared_sum, n); }\n            workgroupBarrier();",
            "workgroupBarrier();\n if (other(&n)) { atomicAdd(&shared_sum, n); }",
        ),
        ("u32(state)", "bitcast<u32>(state)"),
        ("*a > LIMIT", "*a > LIMIT + 0u * *a"),
        ("textureSample(picture", "textureSampleBias(picture"),
    ];
    let original = hash(SHADER);
    let mut seen = std::collections::HashMap::from([(original, "nothing")]);
    for (from, to) in changes {
        assert!(SHADER.contains(from), "{from}");
        let mut changed = SHADER.replacen(from, to, 1);
        for (from, to) in [
            ("texture_2d_array<f32>", ("in.uv) *", "in.uv, 0) *")),
            ("textureSampleBias(picture", ("in.uv) *", "in.uv, 1.0) *")),
        ] {
            if changed.contains(from) {
                changed = changed.replacen(to.0, to.1, 1);
            }
        }
        if to == "override amount" {
            changed = changed.replace("z * gain", "z * amount");
        }
        if let Some(same) = seen.insert(hash(&changed), to) {
            panic!("`{from}` -> `{to}` has the hash of `{same}`");
        }
    }
}

/// Catches a hash that depends on the run, the machine or the order of a hash map. The value belongs to this release of naga.
#[test]
fn stable() {
    assert_eq!(hash(SHADER), hash(SHADER));
    assert_eq!(
        format!("{:032x}", hash("@compute @workgroup_size(1) fn main() {}")),
        "3ca8ee42b05bd1f367d39da54c0456ff"
    );
}

/// Catches lists whose ends run into each other, and variants that are taken for each other.
#[test]
fn lists_are_delimited() {
    let feed = |value: &dyn Fn(&mut Feed)| {
        let mut feed = Feed(SipHasher13::new());
        value(&mut feed);
        feed.finish()
    };
    let lists: [Vec<Vec<u8>>; 4] = [vec![vec![1], vec![]], vec![vec![], vec![1]], vec![vec![1]], vec![vec![0, 1]]];
    let hashes: std::collections::HashSet<u128> = lists.iter().map(|list| feed(&|feed| list.serialize(feed).unwrap())).collect();
    assert_eq!(hashes.len(), 4);
    let (ok, err): (Result<u8, u8>, Result<u8, u8>) = (Ok(1), Err(1));
    assert_ne!(
        feed(&|feed| ok.serialize(feed).unwrap()),
        feed(&|feed| err.serialize(feed).unwrap())
    );
}
