//! What a composed permutation costs at run time: `cargo bench --bench price -- --write spec/price.md`.
//!
//! GPU time of one frame by timestamp queries, the shaders in turn, and the counts of their SPIR-V. `tests/price` asserts that they draw one
//! picture. Options: `--size WIDTHxHEIGHT`, `--repetitions N`, `--write FILE`, which puts the tables between the file's markers.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout)]

#[path = "../tests/price/count.rs"]
mod count;
#[path = "../tests/price/stage.rs"]
mod stage;

use std::fmt::Write as _;

use count::{Count, count, optimised, spirv};
use shadewright::compiler::validate::Validated;
use shadewright::runtime::gpu::Gpu;
use shadewright::runtime::wgpu;
use stage::{ALL_ON, MONOLITH, PLAIN, PLAIN_SWITCHES, RECIPE, Stage, UBERSHADER, checked, composed};

const BEGIN: &str = "<!-- measured: begin -->";
const END: &str = "<!-- measured: end -->";

/// What is drawn with what.
struct Case<'a> {
    name: &'static str,
    shader: &'a Validated,
    stage: &'a Stage,
    pipeline: wgpu::RenderPipeline,
    /// Microseconds.
    times: Vec<f64>,
}

fn main() {
    let mut size = [960, 540];
    let mut repetitions = 31;
    let mut write = None;
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--size" => {
                let value = arguments.next().expect("--size WIDTHxHEIGHT");
                let (width, height) = value.split_once('x').expect("--size WIDTHxHEIGHT");
                size = [width.parse().expect("a width"), height.parse().expect("a height")];
            }
            "--repetitions" => repetitions = arguments.next().and_then(|n| n.parse().ok()).expect("--repetitions N"),
            "--write" => write = Some(arguments.next().expect("--write FILE")),
            // Cargo's own.
            "--bench" => {}
            other => panic!("{other}: options are --size, --repetitions and --write"),
        }
    }

    let gpu = Gpu::headless().unwrap_or_else(|error| panic!("{error}"));
    let (full, plain) = (composed(RECIPE), composed(PLAIN));
    let (hand, uber) = (checked("monolith.wgsl", MONOLITH), checked("ubershader.wgsl", UBERSHADER));
    let on = Stage::new(gpu.clone(), &full, size, ALL_ON);
    let off = Stage::new(gpu.clone(), &full, size, PLAIN_SWITCHES);
    let small = Stage::new(gpu.clone(), &plain, size, PLAIN_SWITCHES);
    let case = |name, shader, stage: &'_ Stage| (name, shader, stage.pipeline(shader));
    let made = [
        (case("by hand", &hand, &on), &on),
        (case("composed", full.validated(), &on), &on),
        (case("ubershader", &uber, &on), &on),
        (case("composed, plain", plain.validated(), &small), &small),
        (case("ubershader, all off", &uber, &off), &off),
    ];
    let mut cases: Vec<Case> = made
        .into_iter()
        .map(|((name, shader, pipeline), stage)| Case {
            name,
            shader,
            stage,
            pipeline,
            times: Vec::new(),
        })
        .collect();
    let queries = measure(&gpu, &mut cases, repetitions);

    let mut text = format!(
        "Device: {}{}. {} x {} pixels, {repetitions} repetitions in turn, {}.\n\n",
        gpu.name(),
        if gpu.is_software() {
            ", a CPU: its times say how much work there is, not how a GPU does it"
        } else {
            ""
        },
        size[0],
        size[1],
        if queries {
            "by timestamp queries"
        } else {
            "by the clock, since the device has no timestamp queries"
        },
    );
    text += &times(&cases);
    text += "\n";
    text += &counts(&cases);
    println!("{text}");
    if let Some(path) = write {
        let page = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        let (head, rest) = page.split_once(BEGIN).unwrap_or_else(|| panic!("{path} has no `{BEGIN}`"));
        let (_, tail) = rest.split_once(END).unwrap_or_else(|| panic!("{path} has no `{END}`"));
        std::fs::write(&path, format!("{head}{BEGIN}\n\n{text}\n{END}{tail}")).unwrap_or_else(|error| panic!("{path}: {error}"));
    }
}

/// Takes the times, the cases in turn; whether the device told them itself.
fn measure(gpu: &Gpu, cases: &mut [Case], repetitions: usize) -> bool {
    let device = gpu.device();
    let queries = device.features().contains(wgpu::Features::TIMESTAMP_QUERY).then(|| {
        device.create_query_set(&wgpu::QuerySetDescriptor {
            label: None,
            ty: wgpu::QueryType::Timestamp,
            count: 2,
        })
    });
    let usage = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
    let resolved = gpu.buffer("times", usage, &[], 16).expect("a buffer");
    let period = f64::from(gpu.queue().get_timestamp_period());
    // The first frames pay for compilation.
    for repetition in 0..repetitions + 2 {
        for case in cases.iter_mut() {
            let mut commands = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            case.stage
                .frame(&case.pipeline, &mut commands, queries.as_ref().map(|queries| (queries, 0)));
            let start = std::time::Instant::now();
            let time = if let Some(queries) = &queries {
                commands.resolve_query_set(queries, 0..2, &resolved, 0);
                let bytes = gpu.read("times", commands, &resolved, 16).unwrap_or_else(|error| panic!("{error}"));
                let ticks: Vec<u64> = bytes.chunks_exact(8).map(|b| u64::from_le_bytes(b.try_into().unwrap())).collect();
                ticks[1].saturating_sub(ticks[0]) as f64 * period / 1000.0
            } else {
                gpu.queue().submit([commands.finish()]);
                gpu.wait().unwrap_or_else(|error| panic!("{error}"));
                start.elapsed().as_secs_f64() * 1e6
            };
            if repetition >= 2 {
                case.times.push(time);
            }
        }
    }
    for case in cases {
        case.times.sort_by(f64::total_cmp);
    }
    queries.is_some()
}

/// Of sorted numbers the one at this share.
fn at(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * share).round() as usize]
}

fn times(cases: &[Case]) -> String {
    let mut text = String::from("| shader | GPU time, median | middle half | ratio |\n|---|---|---|---|\n");
    for (index, case) in cases.iter().enumerate() {
        // The last two draw a scene of their own.
        let base = &cases[if index < 3 { 0 } else { 3 }];
        let ratio = at(&case.times, 0.5) / at(&base.times, 0.5);
        let ms = |share| at(&case.times, share) / 1000.0;
        let _ = writeln!(
            text,
            "| {} | {:.2} ms | {:.2} to {:.2} ms | {ratio:.2} |",
            case.name,
            ms(0.5),
            ms(0.25),
            ms(0.75)
        );
    }
    text
}

fn counts(cases: &[Case]) -> String {
    let mut text = String::from(
        "| SPIR-V | functions | instructions | ratio | arithmetic | memory | texture | calls | structure |\n|---|---|---|---|---|---|---|---|---|\n",
    );
    let raw: Vec<Vec<u8>> = cases.iter().take(4).map(|case| spirv(case.shader)).collect();
    let mut rows = |what: &str, counts: &[Count]| {
        for (index, (case, count)) in cases.iter().zip(counts).enumerate() {
            let ratio = if index < 3 {
                format!("{:.2}", count.all as f64 / counts[0].all as f64)
            } else {
                String::new()
            };
            let Count {
                functions,
                all,
                arithmetic,
                memory,
                texture,
                calls,
                structure,
            } = count;
            let _ = writeln!(
                text,
                "| {}{what} | {functions} | {all} | {ratio} | {arithmetic} | {memory} | {texture} | {calls} | {structure} |",
                case.name
            );
        }
    };
    rows("", &raw.iter().map(|bytes| count(bytes)).collect::<Vec<_>>());
    if let Some(small) = raw.iter().map(|bytes| optimised(bytes)).collect::<Option<Vec<_>>>() {
        rows(", optimised", &small.iter().map(|bytes| count(bytes)).collect::<Vec<_>>());
    }
    text
}
