use super::*;

const SHADER: &str = "
struct Frame { view: mat4x4f, exposure: f32 }
struct Light { position: vec3f, flux: f32 }
@group(0) @binding(0) var<uniform> frame: Frame;
@group(1) @binding(2) var<storage, read> lights: array<Light>;
@group(2) @binding(1) var colour: texture_2d<f32>;
@group(2) @binding(4) var colour_sampler: sampler;
@group(3) @binding(0) var<storage, read_write> result: array<f32>;
@group(3) @binding(1) var map: texture_storage_2d<rgba16float, write>;
override gain: f32 = 2.0;

struct Out { @builtin(position) position: vec4f, @location(0) uv: vec2f }

@vertex fn vertex_main(@location(0) position: vec3f, @builtin(instance_index) index: u32) -> Out {
    return Out(frame.view * vec4f(position + f32(index), 1.0), position.xy);
}
@fragment fn fragment_main(in: Out) -> @location(0) vec4f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < arrayLength(&lights); i++) { sum += lights[i].position * lights[i].flux; }
    return textureSample(colour, colour_sampler, in.uv) * vec4f(sum * gain * frame.exposure, 1.0);
}
@compute @workgroup_size(64) fn reduce(@builtin(global_invocation_id) id: vec3u) {
    result[id.x] = result[id.x] * gain;
    textureStore(map, id.xy, vec4f(gain));
}
";

fn validated(source: &str) -> Validated {
    let module = naga::front::wgsl::parse_str(source).unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)));
    validate(module).unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)))
}

fn text(source: &str, target: Target, entry_point: Option<&str>) -> String {
    let bytes = emit(&validated(source), target, entry_point).unwrap_or_else(|report| panic!("{report}"));
    String::from_utf8(bytes).unwrap()
}

fn error(source: &str, target: Target, entry_point: Option<&str>) -> String {
    emit(&validated(source), target, entry_point).expect_err("should fail").render()
}

/// Catches a target that is not written, or whose bindings do not follow the group and number.
#[test]
fn all_targets() {
    let wgsl = text(SHADER, Target::WgslFromIr, None);
    assert!(
        wgsl.contains("override gain: f32 = 2f;") && wgsl.contains("@group(3) @binding(1)"),
        "{wgsl}"
    );
    let spirv = emit(&validated(SHADER), Target::SpirV, None).unwrap();
    assert_eq!(spirv[..8], [0x03, 0x02, 0x23, 0x07, 0, 3, 1, 0]);
    assert!(spirv.windows(8).any(|bytes| bytes == b"exposure"), "no debug names");
    let hlsl = text(SHADER, Target::Hlsl, None);
    for part in [
        "lights : register(t2, space1)",
        "colour : register(t1, space2)",
        "result : register(u0, space3)",
        "float exposure",
    ] {
        assert!(hlsl.contains(part), "{part}:\n{hlsl}");
    }
    let msl = text(SHADER, Target::Msl, None);
    for part in [
        "[[buffer(0)]]",
        "const& lights [[buffer(1)]]",
        "& result [[buffer(2)]]",
        "colour [[texture(0)]]",
        "[[sampler(0)]]",
        "[[buffer(3)]]",
        "map [[texture(1)]]",
    ] {
        assert!(msl.contains(part), "{part}:\n{msl}");
    }
    assert!(!msl.contains("fake") && !msl.contains("const& result"), "{msl}");
    let glsl = text(SHADER, Target::Glsl, Some("fragment_main"));
    for part in [
        "#version 450",
        "layout(std140, binding = 0) uniform",
        "layout(std430, binding = 0) readonly buffer",
        "layout(binding = 0) uniform",
    ] {
        assert!(glsl.contains(part), "{part}:\n{glsl}");
    }
    let glsl = text(SHADER, Target::Glsl, Some("reduce"));
    for part in ["layout(std430, binding = 1) buffer", "layout(binding = 0,rgba16f) writeonly"] {
        assert!(glsl.contains(part), "{part}:\n{glsl}");
    }
}

/// Catches an entry point that brings in what only another one needs.
#[test]
fn one_entry_point() {
    for target in [Target::WgslFromIr, Target::Hlsl, Target::Msl, Target::Glsl] {
        let text = text(SHADER, target, Some("reduce"));
        assert!(
            (text.contains("result") || text.contains("_group_3_binding_0"))
                && !text.contains("exposure")
                && !text.contains("fragment_main"),
            "{target:?}\n{text}"
        );
    }
    let spirv = emit(&validated(SHADER), Target::SpirV, Some("reduce")).unwrap();
    assert!(!spirv.windows(8).any(|bytes| bytes == b"exposure"));
}

/// Catches output that depends on hash seeds or on what was written before.
#[test]
fn deterministic() {
    for target in Target::ALL {
        let entry_point = (target == Target::Glsl).then_some("fragment_main");
        let first = emit(&validated(SHADER), target, entry_point);
        for _ in 0..3 {
            assert_eq!(emit(&validated(SHADER), target, entry_point), first);
        }
    }
}

/// Catches an unknown entry point that is ignored, and GLSL of an arbitrary one.
#[test]
fn entry_points_are_checked() {
    let expected = "\
error[SW0603]: there is no entry point `redce`
 = did you mean `reduce`?
 = entry points: vertex_main, fragment_main, reduce
";
    for target in Target::ALL {
        assert_eq!(error(SHADER, target, Some("redce")), expected);
    }
    let expected = "\
error[SW0603]: a file of GLSL holds one entry point: name it
 = entry points: vertex_main, fragment_main, reduce
";
    assert_eq!(error(SHADER, Target::Glsl, None), expected);
    assert_eq!(error("", Target::Glsl, None), "error[SW0603]: the shader has no entry point\n");
    assert!(text("@compute @workgroup_size(1) fn only() {}", Target::Glsl, None).contains("void main()"));
}

/// Catches a capability that the target lacks and that comes out as broken text.
#[test]
fn missing_capability() {
    let double = "@compute @workgroup_size(1) fn main() { var x = 1.0lf; x += 1.0lf; }";
    let expected = "\
error[SW0601]: MSL cannot express this shader
 = Type is invalid: Using `f64` values requires the `naga::valid::Capabilities::FLOAT64` flag
 = it lacks `FLOAT64`: leave out the modules that declare this
";
    assert_eq!(error(double, Target::Msl, None), expected);
    let half = "enable f16; @compute @workgroup_size(1) fn main() { var x = 1.0h; x += 1.0h; }";
    let expected = "\
error[SW0601]: GLSL cannot express this shader
 = it has no floating-point numbers of 16 bits
";
    assert_eq!(error(half, Target::Glsl, None), expected);
    assert!(text(half, Target::Msl, None).contains("half"));
}

/// Catches a panic of naga's WGSL writer (override expressions) or of override processing (an anonymous one before a named one)
/// that comes through.
#[test]
fn writers_that_panic() {
    let derived = "override a: f32 = 1.0; override b: f32 = a * 2.0; @compute @workgroup_size(1) fn main() { var x = b; x += 1.0; }";
    let expected = "\
error[SW0602]: naga gave up while writing WGSL
 = internal error: entered unreachable code
 = this is an error of naga, which reads and writes shaders for us; a simpler formulation may avoid it
";
    assert_eq!(error(derived, Target::WgslFromIr, None), expected);
    let anonymous = "var<workgroup> m: array<f32, a + 1u>; override a: u32 = 3u; override b: f32 = 1.0;
        @compute @workgroup_size(1) fn main() { m[0] = b; }";
    for target in Target::ALL {
        assert!(error(anonymous, target, None).starts_with("error[SW0602]: naga gave up while writing"));
    }
    let missing = "override a: f32; @compute @workgroup_size(1) fn main() { var x = a; x += 1.0; }";
    let expected = "\
error[SW0602]: the shader cannot be written as HLSL
 = Missing value for pipeline-overridable constant with identifier string: 'a'
";
    assert_eq!(error(missing, Target::Hlsl, None), expected);
}
