//! Reads of textures.

#![allow(clippy::float_cmp)] // exact values

mod common;

use std::sync::Arc;

use common::program;
use shadewright_evaluate::{Allowed, EvaluateError, Invocation, Machine, Number, Program, Sampler, Texture, Value};

const SOURCE: &str = "
    @group(0) @binding(0) var<storage, read_write> out: array<f32, 8>;
    @group(0) @binding(1) var t: texture_2d_array<f32>;
    @group(0) @binding(2) var s: sampler;
    @group(0) @binding(3) var d: texture_depth_2d;
    @group(0) @binding(4) var c: sampler_comparison;
    @group(0) @binding(5) var<storage, read_write> at: vec2f;
    @compute @workgroup_size(1) fn main() {
        out[0] = textureLoad(t, vec2i(1, 0), 1, 0).x;
        out[1] = textureSampleLevel(t, s, at, 0, 0.0).x;
        out[2] = textureSampleLevel(t, s, at, 1, 1.0).y;
        out[3] = textureSampleCompareLevel(d, c, at, 0.5);
        out[4] = f32(textureDimensions(t).x * 10u + textureDimensions(t).y) + 0.5 * f32(textureNumLayers(t)) + f32(textureNumLevels(t)) * 0.125;
        out[5] = textureGather(1, t, s, at, 0).z;
        out[6] = textureSampleLevel(d, s, at, 0);
        out[7] = textureLoad(t, vec2i(70, -3), 9, 0).x;
    }";

/// A machine with a texture of two layers, 2 x 1 texels of two channels, and a depth texture of 2 x 1.
fn machine<N: Number>(program: &Program, linear: bool, repeat: bool, at: [f32; 2]) -> Machine<'_, N> {
    let mut machine = Machine::new(program).unwrap();
    let levels = vec![vec![1.0, 10.0, 2.0, 20.0, 3.0, 30.0, 4.0, 40.0], vec![5.0, 50.0, 6.0, 60.0]];
    machine
        .bind_texture(0, 1, Arc::new(Texture::new(2, 1, 2, 2, levels).unwrap()))
        .unwrap();
    machine.bind_sampler(0, 2, Sampler { linear, repeat }).unwrap();
    machine
        .bind_texture(0, 3, Arc::new(Texture::new(2, 1, 1, 1, vec![vec![0.25, 0.75]]).unwrap()))
        .unwrap();
    machine.bind_sampler(0, 4, Sampler { linear, repeat }).unwrap();
    let bytes: Vec<u8> = at.iter().flat_map(|x| x.to_le_bytes()).collect();
    machine.bind_buffer(0, 5, &bytes).unwrap();
    machine.run(&Invocation::default()).unwrap();
    machine
}

fn read(linear: bool, repeat: bool, at: [f32; 2]) -> Vec<f32> {
    let program = program(SOURCE);
    let machine = machine::<f32>(&program, linear, repeat, at);
    machine.values(0, 0).unwrap().into_iter().map(Value::number).collect()
}

/// Catches layers, levels and channels that are mixed up, centres of texels at whole coordinates, edges that are not clamped, a comparison
/// that is turned round, and interpolation before the comparison instead of after.
#[test]
fn texels_and_what_is_between_them() {
    assert_eq!(read(false, false, [0.9, 0.5]), [4.0, 2.0, 60.0, 1.0, 22.25, 20.0, 0.75, 4.0]);
    assert_eq!(read(true, false, [0.5, 0.5]), [4.0, 1.5, 60.0, 0.5, 22.25, 20.0, 0.5, 4.0]);
    assert_eq!(read(true, false, [-9.0, 0.5])[1], 1.0);
    assert_eq!(read(true, true, [1.0, 0.5])[1], 1.5);
    assert_eq!(read(false, true, [1.1, 0.5])[1], 1.0);
    assert_eq!(read(true, false, [0.625, 0.5])[1], 1.75);
}

/// Catches a stand-in that is not white, or whose depth is not the far plane.
#[test]
fn nothing_bound_is_white() {
    let program = program(SOURCE);
    let mut machine = Machine::<f32>::new(&program).unwrap();
    machine.run(&Invocation::default()).unwrap();
    let values: Vec<f32> = machine.values(0, 0).unwrap().into_iter().map(Value::number).collect();
    assert_eq!(values, [1.0, 1.0, 1.0, 1.0, 11.625, 1.0, 1.0, 1.0]);
}

/// Catches bounds that leave out a texel that a driver's weights may bring in, and bounds that hold them all everywhere.
#[test]
fn bounds_hold_the_texels_around() {
    let program = program(SOURCE);
    let bounds = |linear, at| {
        let values = machine::<Allowed>(&program, linear, false, at).values(0, 0).unwrap();
        match values[1] {
            Value::Float(x) => (x.low(), x.high()),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(bounds(true, [0.6, 0.5]), (1.0, 2.0));
    assert_eq!(bounds(true, [0.01, 0.5]), (1.0, 1.0));
    assert_eq!(bounds(false, [0.6, 0.5]), (2.0, 2.0));
    assert_eq!(bounds(false, [0.5, 0.5]), (1.0, 2.0), "at the edge of a texel");
}

/// Catches textures whose numbers do not fit their size, which would be read beyond their end.
#[test]
fn sizes_are_checked() {
    let error = Texture::new(2, 2, 1, 4, vec![vec![0.0; 15]]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "a texture of 2 x 2 texels in 1 layers needs 16 numbers for its levels, found 15"
    );
    for (width, layers, channels) in [(0, 1, 1), (1, 0, 1), (1, 1, 5), (u32::MAX, u32::MAX, 4)] {
        assert!(matches!(
            Texture::new(width, 1, layers, channels, vec![vec![]]),
            Err(EvaluateError::TextureSize { .. })
        ));
    }
    assert!(Texture::new(1, 1, 1, 1, vec![]).is_err());
}
