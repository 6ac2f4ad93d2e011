//! What the generated Rust draws and reads, against closed forms.
#![allow(clippy::expect_used, clippy::unwrap_used)]

use std::f32::consts::PI;

use renderer::built::Shaders;
use renderer::gpu::{Draw, Gpu, Target};
use renderer::mesh::Mesh;
use renderer::world::{Finish, World};

/// The middle of a square seen from 1 m fills the picture; the square faces the camera.
fn square_world(finish: Finish) -> World {
    World {
        eye: [0.0, 0.0, 1.0],
        model: [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ],
        // 90 degrees: the picture's edges are the square's.
        view_projection: [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, -0.5, -1.0],
            [0.0, 0.0, 0.5, 1.0],
        ],
        sun_direction: [0.0, -3.0, -4.0],
        sun_lux: 1000.0,
        lamp_position: [0.3, -0.2, 0.5],
        lamp_candela: 50.0,
        base_color: [0.8, 0.4, 0.2],
        ..World::at(0.0, finish)
    }
}

/// Radiance of the square at a pixel's centre: Lambert's law under a sun at n.l = 0.8 and a lamp.
fn radiance(world: &World, x: u32, y: u32, size: u32) -> f32 {
    let at = |i: u32| (i as f32 + 0.5) / size as f32 * 2.0 - 1.0;
    let [lx, ly, lz] = world.lamp_position;
    let (dx, dy) = (lx - at(x), ly + at(y));
    let squared = dx * dx + dy * dy + lz * lz;
    let lux = world.sun_lux * 0.8 + world.lamp_candela / squared * (lz / squared.sqrt());
    lux / PI
}

/// Catches structs whose numbers are not where the shader looks for them, lights bound to each other's places, and defaults that are
/// not the manifests': any of them moves the radiance.
#[test]
fn a_matte_square_has_the_radiance_of_lamberts_law() {
    let gpu = Gpu::new().unwrap();
    let target = Target::new(&gpu, 32, 32);
    let world = square_world(Finish::Matte);
    let pixels = gpu.draw(&target, &Mesh::square(), &Shaders::new(&gpu).draw(&world)).unwrap();
    assert_eq!(pixels.len(), 32 * 32);
    for (index, pixel) in pixels.iter().enumerate() {
        let expected = radiance(&world, index as u32 % 32, index as u32 / 32, 32);
        for (value, albedo) in pixel.iter().zip(world.base_color) {
            let error = (value / (expected * albedo) - 1.0).abs();
            assert!(error < 1e-5, "pixel {index}: {value}, not {}", expected * albedo);
        }
        assert_eq!(pixel[3], 1.0, "the default of the opacity");
    }
}

/// Catches a program that draws otherwise when it links its shaders itself than when the build script did, and linking that gives
/// another shader for the same choice.
#[cfg(feature = "live")]
#[test]
fn both_ways_draw_the_same() {
    use renderer::live::Linker;
    use renderer::recipes::{glossy, matte};

    let gpu = Gpu::new().unwrap();
    let target = Target::new(&gpu, 64, 64);
    let mesh = Mesh::ring(48, 24);
    let (mut built, mut live) = (Shaders::new(&gpu), Linker::new(&gpu).unwrap());
    let mut seen = Vec::new();
    for (turn, finish, hash) in [
        (0.0, Finish::Matte, matte::HASH),
        (0.3, Finish::Glossy, glossy::HASH),
        (0.6, Finish::Matte, matte::HASH),
    ] {
        let world = World::at(turn, finish);
        let draw = |draw: &Draw| gpu.draw(&target, &mesh, draw).unwrap();
        let (a, b) = (draw(&built.draw(&world)), draw(&live.draw(&world).unwrap()));
        assert_eq!(live.program(finish.module()).unwrap().hash(), hash);
        assert!(a.iter().filter(|pixel| pixel[0] > 1.0).count() > 500, "there is something to see");
        assert!(a == b, "{finish:?}: the pictures differ");
        seen.push(a);
    }
    assert!(seen[0] != seen[1], "the choice is not to be seen");
}

mod layouts {
    use renderer::gpu::Gpu;
    use renderer::recipes::corners;

    /// Catches wrong offsets, strides and gaps of all that WGSL lays out otherwise than C does: the device reads every number of the
    /// structs in its order, and so do wrong constants of the pipeline, wrong defaults, and a hole between bind groups.
    #[test]
    fn the_device_reads_what_the_structs_hold() {
        let gpu = Gpu::new().unwrap();
        let mut n = 0.0;
        let mut next = || {
            n += 1.0;
            n
        };
        let mut expected = Vec::new();
        let mut three = |expected: &mut Vec<f32>| {
            let v = [next(), next(), next()];
            expected.extend(v);
            v
        };
        let padded = |v: [f32; 3]| [v[0], v[1], v[2], -1.0];
        let mut one = 1000.0;
        let mut number = |expected: &mut Vec<f32>| {
            one += 1.0;
            expected.push(one);
            one
        };
        let e = &mut expected;
        let pad_4 = number(e);
        let r#in = three(e);
        e.push(77.0);
        let m33 = [padded(three(e)), padded(three(e)), padded(three(e))];
        let m23 = [padded(three(e)), padded(three(e))];
        let m32 = [[number(e), number(e)], [number(e), number(e)], [number(e), number(e)]];
        let m42 = [
            [number(e), number(e)],
            [number(e), number(e)],
            [number(e), number(e)],
            [number(e), number(e)],
        ];
        let list = [padded(three(e)), padded(three(e))];
        let mut inner = |e: &mut Vec<f32>| corners::CornersInner {
            a: number(e),
            b: three(e),
            c: number(e),
            ..Default::default()
        };
        let (single, pair) = (inner(e), [inner(e), inner(e)]);
        e.extend([-5.0, 6.0, 3.0]);
        let tail = [padded(three(e)), padded(three(e)), padded(three(e))];
        let threes = [padded(three(e)), padded(three(e))];
        e.extend([1.0, 2.0, 3.0, 4.0, 5.0, 0.25, 0.5, 0.75, 1e20, 4000.0, -7.0]);
        e.extend([2.5, 3.0, -2.0, 0.0, 41.0, 9.0]);

        let state = corners::CornersLayout {
            pad_4,
            r#in,
            Upper: 77,
            m33,
            m23,
            m32,
            m42,
            list,
            inner: single,
            pair,
            signed: [-5, 6],
            ..Default::default()
        };
        let counter = corners::CornersCounter {
            count: 41,
            runs: [7, 8, 9],
        };
        let constants = corners::Constants {
            corners_gain: 2.5,
            corners_mirrored: false,
            ..Default::default()
        };
        let found = run(&gpu, &state.bytes(&tail), &threes, &counter, &constants, expected.len());
        assert_eq!(found, expected);
    }

    fn run(
        gpu: &Gpu,
        state: &[u8],
        threes: &[[f32; 4]],
        counter: &corners::CornersCounter,
        constants: &corners::Constants,
        count: usize,
    ) -> Vec<f32> {
        use wgpu::BufferUsages as U;
        let params = gpu.buffer(bytemuck::bytes_of(&corners::PassParams::default()), U::UNIFORM);
        let state = gpu.buffer(state, U::STORAGE);
        let threes = gpu.buffer(bytemuck::cast_slice(threes), U::STORAGE);
        assert_eq!(corners::BYTES_CORNERS_COUNTER, size_of_val(counter) as u64);
        let counter = gpu.buffer(bytemuck::bytes_of(counter), U::STORAGE);
        let result = gpu.buffer(&vec![0; count * 4], U::STORAGE | U::COPY_SRC);
        let staging = gpu.buffer(&vec![0; count * 4], U::MAP_READ);
        let texture = |format, usage| {
            let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d {
                    width: 4,
                    height: 2,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let picture = texture(wgpu::TextureFormat::Rgba32Float, wgpu::TextureUsages::STORAGE_BINDING);
        let image = texture(wgpu::TextureFormat::Rgba8UnormSrgb, wgpu::TextureUsages::TEXTURE_BINDING);
        let drawn = gpu.checked(|device| {
            let layout = corners::Layout::new(device);
            let shader = corners::shader(device);
            let pipeline = corners::read_all_pipeline(device, &layout, &shader, constants, None);
            let paint = corners::render_compute_pipeline(device, &layout, &shader, constants, None);
            let groups = [
                corners::BindGroup0 {
                    corners_state: state.as_entire_buffer_binding(),
                }
                .bind(device, &layout.group_0),
                corners::BindGroup3 {
                    pass_params: params.as_entire_buffer_binding(),
                    corners_result: result.as_entire_buffer_binding(),
                    corners_threes: threes.as_entire_buffer_binding(),
                    corners_counter: counter.as_entire_buffer_binding(),
                    corners_picture: &picture,
                    corners_image: &image,
                    corners_image_sampler: &corners::create_corners_image_sampler(device),
                }
                .bind(device, &layout.group_3),
            ];
            let mut commands = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut pass = commands.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_bind_group(corners::BindGroup0::INDEX, &groups[0], &[]);
            pass.set_bind_group(corners::BindGroup3::INDEX, &groups[1], &[]);
            for pipeline in [&pipeline, &paint] {
                pass.set_pipeline(pipeline);
                pass.dispatch_workgroups(1, 1, 1);
            }
            drop(pass);
            commands.copy_buffer_to_buffer(&result, 0, &staging, 0, (count * 4) as u64);
            gpu.queue.submit([commands.finish()]);
        });
        drawn.unwrap();
        assert_eq!(corners::WORKGROUP_SIZE_RENDER, [4, 2, 1]);
        bytemuck::pod_collect_to_vec(&gpu.read(&staging).unwrap())
    }
}
