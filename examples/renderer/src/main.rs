//! `renderer [built|live] FILE.png [FRAMES]`: turns a ring through its frames, and writes them side by side.

use std::path::Path;
use std::process::ExitCode;

use renderer::built;
use renderer::gpu::{Draw, Error, Gpu, Target};
use renderer::mesh::Mesh;
use renderer::picture;
use renderer::world::{Finish, World};

const SIZE: u32 = 256;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let (mode, file, frames) = match arguments[..] {
        [mode, file] => (mode, file, Some(4)),
        [mode, file, frames] => (mode, file, frames.parse().ok().filter(|n| (1..=64).contains(n))),
        _ => ("", "", None),
    };
    let Some(frames) = frames.filter(|_| matches!(mode, "built" | "live")) else {
        return complain("usage: renderer built|live FILE.png [FRAMES, 1 to 64]", 2);
    };
    match run(mode, Path::new(file), frames) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => complain(&error.to_string(), 1),
    }
}

fn complain(text: &str, status: u8) -> ExitCode {
    use std::io::Write;
    // Where standard error is closed there is nobody left to tell.
    let _ = writeln!(std::io::stderr(), "{text}");
    ExitCode::from(status)
}

/// The loop: half of the frames are matte, then somebody turns a knob and the ring is glossy.
fn run(mode: &str, file: &Path, frames: u32) -> Result<(), Error> {
    let gpu = Gpu::new()?;
    let mesh = Mesh::ring(96, 48);
    let target = Target::new(&gpu, SIZE, SIZE);
    let mut shading = shading(mode, &gpu)?;
    let mut strip = Vec::new();
    for frame in 0..frames {
        let finish = if frame * 2 < frames { Finish::Matte } else { Finish::Glossy };
        let world = World::at(frame as f32 / frames as f32, finish);
        let draw = shading(&world)?;
        strip.push(gpu.draw(&target, &mesh, &draw)?);
    }
    picture::save(file, &strip, SIZE, SIZE)
}

/// Makes what a frame is drawn with.
type Shading<'g> = Box<dyn FnMut(&World) -> Result<Draw, Error> + 'g>;

fn shading<'g>(mode: &str, gpu: &'g Gpu) -> Result<Shading<'g>, Error> {
    #[cfg(feature = "live")]
    if mode == "live" {
        let mut linker = renderer::live::Linker::new(gpu)?;
        return Ok(Box::new(move |world| linker.draw(world)));
    }
    if mode == "live" {
        return Err(Error::Unlinked);
    }
    let mut built = built::Shaders::new(gpu);
    Ok(Box::new(move |world| Ok(built.draw(world))))
}
