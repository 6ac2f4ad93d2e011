//! `render --timings`: what each pass of a frame costs.

use std::time::Duration;

use serde::Serialize;
use shadewright::runtime::frame::{CpuTimes, Frame, FrameTimes, Renderer, Targets};
use shadewright::runtime::gpu::Gpu;

use super::Format;
use super::failure::Failure;
use super::output;
use super::text::columns;

/// Draws a frame once to warm up and then so often, and returns the first picture: modules that remember earlier frames change the later ones.
///
/// # Errors
/// The device cannot tell times, or the frame cannot be drawn.
pub fn take(renderer: &mut Renderer, frame: &Frame, frames: u16) -> Result<(Targets, Vec<FrameTimes>), Failure> {
    renderer.time_passes(true)?;
    let targets = renderer.render(frame)?;
    let mut times = Vec::new();
    times.extend(renderer.wait_for_times()?);
    for _ in 0..frames {
        renderer.render(frame)?;
        times.extend(renderer.wait_for_times()?);
    }
    Ok((targets, times))
}

/// What is said.
#[derive(Serialize)]
struct Said {
    device: String,
    /// The device is a CPU that runs a driver in software.
    is_software: bool,
    size: [u32; 2],
    /// Frames measured, the first not among them.
    frames: usize,
    /// Nanoseconds on the GPU.
    passes: Vec<Pass>,
    frame: Statistics,
    /// Milliseconds on the CPU, of the first frame, and the medians of those after it.
    cpu: [Cpu; 2],
}

#[derive(Serialize)]
struct Pass {
    name: String,
    /// Of the sum of all passes' medians.
    share: f64,
    #[serde(flatten)]
    time: Statistics,
}

#[derive(Serialize)]
struct Statistics {
    median: f64,
    p10: f64,
    p90: f64,
}

impl Statistics {
    fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let at = |part: f64| quantile(&values, part);
        Self {
            median: at(0.5),
            p10: at(0.1),
            p90: at(0.9),
        }
    }
}

/// Between the two sorted values around it; 0 of none.
fn quantile(sorted: &[f64], part: f64) -> f64 {
    let place = part * sorted.len().saturating_sub(1) as f64;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // between 0 and the length
    let low = place.floor() as usize;
    match (sorted.get(low), sorted.get(low + 1)) {
        (Some(a), Some(b)) => a + (b - a) * place.fract(),
        (Some(a), None) => *a,
        _ => 0.0,
    }
}

#[derive(Serialize)]
struct Cpu {
    link: f64,
    pipelines: f64,
    record: f64,
}

impl Cpu {
    fn of(times: &[CpuTimes]) -> Self {
        let median = |which: fn(&CpuTimes) -> Duration| {
            let mut values: Vec<f64> = times.iter().map(|time| which(time).as_secs_f64() * 1e3).collect();
            values.sort_by(f64::total_cmp);
            quantile(&values, 0.5)
        };
        Self {
            link: median(|t| t.link),
            pipelines: median(|t| t.pipelines),
            record: median(|t| t.record),
        }
    }
}

/// Says what the passes cost; the first of the times is the one that warmed up.
///
/// # Errors
/// Nobody reads any more.
pub fn say(gpu: &Gpu, frame: &Frame, times: &[FrameTimes], format: Format) -> Result<(), Failure> {
    let said = said(gpu, frame, times);
    match format {
        Format::Json => output::say_json(&said),
        Format::Text => output::say(&text(&said)),
    }
}

fn said(gpu: &Gpu, frame: &Frame, times: &[FrameTimes]) -> Said {
    let (first, rest) = times.split_at(times.len().min(1));
    // All frames are the same one, and have the same passes.
    let names = rest.first().map_or(&[][..], |times| &times.passes);
    let mut passes: Vec<Pass> = names
        .iter()
        .enumerate()
        .map(|(i, pass)| Pass {
            name: pass.name.clone(),
            share: 0.0,
            time: Statistics::of(rest.iter().filter_map(|times| Some(times.passes.get(i)?.nanoseconds)).collect()),
        })
        .collect();
    let sum: f64 = passes.iter().map(|pass| pass.time.median).sum();
    if sum > 0.0 {
        passes.iter_mut().for_each(|pass| pass.share = pass.time.median / sum);
    }
    let all = rest.iter().map(|times| times.passes.iter().map(|pass| pass.nanoseconds).sum());
    let cpu = |times: &[FrameTimes]| Cpu::of(&times.iter().map(|times| times.cpu).collect::<Vec<_>>());
    Said {
        device: gpu.name(),
        is_software: gpu.is_software(),
        size: frame.size,
        frames: rest.len(),
        frame: Statistics::of(all.collect()),
        passes,
        cpu: [cpu(first), cpu(rest)],
    }
}

fn text(said: &Said) -> String {
    let milliseconds = |nanoseconds: f64| format!("{:.3}", nanoseconds / 1e6);
    let row = |name: &str, share: f64, time: &Statistics| {
        vec![
            name.to_owned(),
            milliseconds(time.median),
            format!("{} to {}", milliseconds(time.p10), milliseconds(time.p90)),
            format!("{:.1} %", share * 100.0),
        ]
    };
    let mut lines = vec![["pass", "median ms", "10 % to 90 %", "share"].map(str::to_owned).to_vec()];
    lines.extend(said.passes.iter().map(|pass| row(&pass.name, pass.share, &pass.time)));
    lines.push(row("all passes", 1.0, &said.frame));
    let [first, rest] = &said.cpu;
    let cpu = |of: &Cpu| format!("link {:.2}, pipelines {:.2}, record {:.2}", of.link, of.pipelines, of.record);
    let software = match said.is_software {
        true => "\nThis device is a CPU that runs a driver in software: these are not a GPU's times; compare ratios only.",
        false => "",
    };
    format!(
        "{}, {}x{}, {} frames after the first\n\n{}\nCPU ms of the first frame: {}\n         of those after it: {}{software}",
        said.device,
        said.size[0],
        said.size[1],
        said.frames,
        columns(&lines, ""),
        cpu(first),
        cpu(rest),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches quantiles of values that stand in no order, or that are off by one place.
    #[test]
    fn statistics_lie_between_the_values() {
        let of = |values: &[f64]| {
            let Statistics { median, p10, p90 } = Statistics::of(values.to_vec());
            [median, p10, p90]
        };
        assert_eq!(of(&[30.0, 10.0, 20.0]), [20.0, 12.0, 28.0]);
        assert_eq!(of(&[4.0, 2.0]), [3.0, 2.2, 3.8]);
        assert_eq!(of(&[7.0]), [7.0; 3]);
        assert_eq!(of(&[]), [0.0; 3]);
    }
}
