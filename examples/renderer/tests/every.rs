//! Pipelines of everything that the build script wrote.

use renderer::gpu::{COLOR, Gpu, depth_state};
use renderer::recipes::*;

/// Makes the render pipeline of a pass; what is in brackets it has, or not.
macro_rules! render {
    ($gpu:ident, $pass:ident, [$($buffers:expr)?], [$($target:expr)?], $depth:expr) => {
        $gpu.checked(|device| {
            let state = $pass::RenderState {
                label: Some(stringify!($pass)),
                $(buffers: $buffers,)?
                $(targets: [Some($target)],)?
                depth_stencil: $depth,
                primitive: wgpu::PrimitiveState::default(),
                multisample: wgpu::MultisampleState::default(),
                cache: None,
            };
            $pass::render_pipeline(device, &$pass::Layout::new(device), &$pass::shader(device), &state)
        })
        .unwrap_or_else(|error| panic!("{}: {error}", stringify!($pass)))
    };
}

/// Catches layouts that do not fit the shader: a wrong type, size, visibility, dimension or location of any binding or vertex input, in
/// any pass of the example recipes. These are, as another test has it, all that the first scene is drawn with.
#[test]
fn every_pass_becomes_a_pipeline() {
    let gpu = Gpu::new().unwrap();
    let (depth, screen) = (depth_state(), wgpu::TextureFormat::Rgba8Unorm);
    render!(
        gpu,
        matte,
        [&[Some(matte::VertexInput::LAYOUT)]],
        [COLOR.into()],
        Some(depth.clone())
    );
    render!(
        gpu,
        glossy,
        [&[Some(glossy::VertexInput::LAYOUT)]],
        [COLOR.into()],
        Some(depth.clone())
    );
    render!(
        gpu,
        forward,
        [&[Some(forward::VertexInput::LAYOUT)]],
        [COLOR.into()],
        Some(depth.clone())
    );
    render!(
        gpu,
        unshadowed,
        [&[Some(unshadowed::VertexInput::LAYOUT)]],
        [COLOR.into()],
        Some(depth.clone())
    );
    render!(
        gpu,
        forward_perspective_shadow,
        [&[Some(forward_perspective_shadow::VertexInput::LAYOUT)]],
        [],
        Some(depth.clone())
    );
    render!(
        gpu,
        forward_cube_map_shadow,
        [&[Some(forward_cube_map_shadow::VertexInput::LAYOUT)]],
        [],
        Some(depth.clone())
    );
    render!(
        gpu,
        double_sided,
        [&[Some(double_sided::VertexInput::LAYOUT)]],
        [COLOR.into()],
        Some(depth.clone())
    );
    // The host's own buffers: one for each attribute.
    let attributes = depth::VertexInput::ATTRIBUTES;
    let own = attributes.map(|attribute| wgpu::VertexAttribute { offset: 0, ..attribute });
    let own = own.each_ref().map(|attribute| {
        Some(wgpu::VertexBufferLayout {
            array_stride: attribute.format.size(),
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: std::slice::from_ref(attribute),
        })
    });
    render!(gpu, depth, [&own], [], Some(depth));
    render!(gpu, display, [], [screen.into()], None);
    render!(gpu, auto_exposure, [], [screen.into()], None);
    let compute = gpu.checked(|device| {
        use {auto_exposure_log_average_mean as mean, auto_exposure_log_average_sum as sum};
        sum::log_average_sum_texels_pipeline(device, &sum::Layout::new(device), &sum::shader(device), None);
        mean::log_average_finish_mean_pipeline(device, &mean::Layout::new(device), &mean::shader(device), None);
    });
    compute.unwrap();
}

/// Catches a layout's descriptor that is not what its entries say, and defaults and hashes that went astray.
#[test]
fn constants_are_what_they_say() {
    assert_eq!(forward::BindGroup1::LAYOUT.entries, forward::BindGroup1::ENTRIES);
    assert_eq!(forward::BindGroup1::ENTRIES.len(), 10);
    assert_eq!(matte::DirectionalInstance::default().illuminance, 10000.0);
    assert_eq!(matte::PointInstance::default().size, 0.01);
    assert_eq!(
        corners::Constants::default().entries(),
        [
            ("corners_gain", 1.5),
            ("corners_turns", 3.0),
            ("corners_offset", -2.0),
            ("corners_mirrored", 1.0),
        ]
    );
    assert_ne!(matte::HASH, glossy::HASH);
    assert!(matte::WGSL.contains("fn lambert_brdf(") && !matte::WGSL.contains("microfacet"));
}
