//! The compute passes of `log-average`, run over frames made of numbers, against the oracle in double precision.

// A helper that fails is a test that fails.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod common;

use common::{catalog, gpu};
use glam::DVec3;
use shadewright::compiler::{Program, Recipe};
use shadewright::modules::oracles::display::{log_average, luminance};
use shadewright::runtime::wgpu::{self, util::DeviceExt};

/// Bytes of the module's buffer; the mean is behind 256 partial sums.
const BYTES: u64 = 2056;
const MEAN: usize = 2048;

fn program(pass: &str) -> Program {
    let text = r#"(module: "display", fill: {"post": [(module: "tonemap", fill: {"exposure": "log-average"})]})"#;
    let recipe = Recipe::parse("test", text).unwrap_or_else(|report| panic!("{report}"));
    catalog()
        .compile(&recipe, &format!("log_average.{pass}"))
        .unwrap_or_else(|report| panic!("{report}"))
}

/// A pass over a frame of this size and the module's buffer.
fn dispatch(encoder: &mut wgpu::CommandEncoder, pass: &str, hdr: &wgpu::TextureView, buffer: &wgpu::Buffer, groups: [u32; 2]) {
    let program = program(pass);
    let gpu = gpu();
    let device = gpu.device();
    let source = wgpu::ShaderSource::Wgsl(program.wgsl().to_owned().into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: None,
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let entry = |b: &shadewright::compiler::reflect::Binding| wgpu::BindGroupEntry {
        binding: b.binding,
        resource: if b.name == "hdr" {
            wgpu::BindingResource::TextureView(hdr)
        } else {
            buffer.as_entire_binding()
        },
    };
    let entries: Vec<_> = program.reflection().bindings.iter().map(entry).collect();
    assert!(program.reflection().bindings.iter().all(|b| b.group == 3));
    let layout = pipeline.get_bind_group_layout(3);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &entries,
    });
    let mut compute = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    compute.set_pipeline(&pipeline);
    compute.set_bind_group(3, &group, &[]);
    compute.dispatch_workgroups(groups[0], groups[1], 1);
}

/// The mean of a frame, computed with a buffer that may hold an earlier frame's sums.
fn mean(width: u32, colors: &[[f32; 3]], buffer: &wgpu::Buffer) -> f32 {
    let gpu = gpu();
    let height = u32::try_from(colors.len()).unwrap() / width;
    let bytes: Vec<u8> = colors
        .iter()
        .flat_map(|c| [c[0], c[1], c[2], 1.0])
        .flat_map(f32::to_le_bytes)
        .collect();
    let descriptor = wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let texture = gpu
        .device()
        .create_texture_with_data(gpu.queue(), &descriptor, wgpu::util::TextureDataOrder::LayerMajor, &bytes);
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    dispatch(&mut encoder, "sum", &view, buffer, [width.div_ceil(16), height.div_ceil(16)]);
    dispatch(&mut encoder, "mean", &view, buffer, [1, 1]);
    let read = gpu.read("mean", encoder, buffer, BYTES).unwrap();
    f32::from_le_bytes(read[MEAN..MEAN + 4].try_into().unwrap())
}

fn buffer() -> wgpu::Buffer {
    gpu().device().create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: BYTES,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    })
}

fn grey(levels: &[f32]) -> Vec<[f32; 3]> {
    levels.iter().map(|l| [*l; 3]).collect()
}

#[track_caller]
fn near(got: f32, expected: f64) {
    assert!((f64::from(got) - expected).abs() <= 2e-5 * expected, "{got} {expected}");
}

/// Catches an arithmetic mean, a delta that is added elsewhere, and counting lanes without a texel.
#[test]
fn published_values() {
    near(mean(5, &grey(&[0.01, 0.1, 1.0, 10.0, 100.0]), &buffer()), 1.002_214_61);
    near(
        mean(4, &grey(&[0.0, 0.0, 0.0, 1.0]), &buffer()),
        log_average(&[0.0, 0.0, 0.0, 1.0], 1e-4),
    );
    near(mean(2, &grey(&[0.0, 65504.0]), &buffer()), log_average(&[0.0, 65504.0], 1e-4));
}

/// Catches a NaN or an infinity that spoils the frame, and texels that are left out of the sum but counted.
#[test]
fn what_is_no_number_does_not_count() {
    let mut frame = grey(&[2.0, 8.0]);
    frame.extend([[f32::NAN, 1.0, 1.0], [1.0, f32::INFINITY, 1.0], [1.0, 1.0, f32::NEG_INFINITY]]);
    near(mean(5, &frame, &buffer()), log_average(&[2.0, 8.0], 1e-4));
    near(mean(1, &[[f32::NAN; 3]], &buffer()), 1.0);
    near(
        mean(2, &[[-5.0, -5.0, -5.0], [1.0, 1.0, 1.0]], &buffer()),
        log_average(&[0.0, 1.0], 1e-4),
    );
}

/// A frame of more texels than the workgroups take in one round, in colours, then a smaller one with the same buffer. Catches texels
/// that are skipped or counted twice, sums of an earlier frame that are added, and an order of addition that changes.
#[test]
fn large_and_then_small() {
    let (width, height) = (613u32, 331u32);
    let color = |i: u32| [(i % 7) as f32 * 0.5, ((i / width) % 11) as f32, (i % width) as f32 * 0.01 + 0.001];
    let frame: Vec<[f32; 3]> = (0..width * height).map(color).collect();
    let levels: Vec<f64> = frame
        .iter()
        .map(|c| luminance(DVec3::new(f64::from(c[0]), f64::from(c[1]), f64::from(c[2]))))
        .collect();
    let shared = buffer();
    let first = mean(width, &frame, &shared);
    near(first, log_average(&levels, 1e-4));
    assert_eq!(first.to_bits(), mean(width, &frame, &buffer()).to_bits());
    near(mean(20, &grey(&[3.0; 400]), &shared), 3.0 + 1e-4);
}
