var image: texture_2d<f32>;
var image_sampler: sampler;

/// The value times the image's colour (linear after the sampler has decoded it) and alpha.
fn modulate(value: vec4f, at: Fragment) -> vec4f {
    return value * textureSample(image, image_sampler, at.uv);
}
