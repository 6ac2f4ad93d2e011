//! A made-up report with everything that is hard to write: zeros, infinities, NaN, names that would be code, and the largest and smallest numbers.
#![allow(dead_code)]

use indexmap::IndexMap;
use serde_json::json;
use shadewright_report::data::{Agreement, Cost, Errors, Executed, Fault, Picture, Provenance, Report, Results, Row, Time, Verdict, Worst};
use shadewright_report::write::dominated;

/// Text that is code in HTML, XML, SVG, shells, Markdown and CSV at once.
pub const HOSTILE: &str = "<script>alert(1)</script> \"it's\" & </svg>]]> $(rm -rf /) `id` {{ 7*7 }} | \\ *x* \u{0}\u{1b}é";

pub fn errors(rms: f64) -> Errors {
    Errors {
        rms,
        p95: rms * 2.0,
        max: rms * 5.0,
        bias: -rms / 3.0,
        searched: rms * 7.5,
        worst: worst(0.3),
    }
}

pub fn worst(n_dot_v: f64) -> Worst {
    Worst {
        input: json!({"s": {"alpha": 0.0625, "f0": [0.04, 0.04, 0.04]}, "n_dot_v": n_dot_v, "params": {"k": 2}}),
        component: String::new(),
        got: json!(0.375),
        expected: json!(0.31),
    }
}

/// Errors that grow to the lower right, by a factor of a million; the worst is in column 50 and row 40 of 64 by 48.
pub fn picture(of: &str) -> Picture {
    let (width, height) = (64, 48);
    let field = |index: usize| {
        let (x, y) = ((index % width) as f64 - 50.0, (index / width) as f64 - 40.0);
        1e-2 * (-(x * x + 2.0 * y * y).sqrt() / 5.0).exp() * (1.2 + (x / 4.0).sin())
    };
    Picture {
        axes: ["alpha 1e-4 to 1 (log)".to_owned(), "n_dot_v 0 to 1".to_owned()],
        width,
        height,
        errors: (0..width * height).map(|index| Some(field(index))).collect(),
        worst: [50.0, 40.0],
        of: of.to_owned(),
    }
}

pub fn row(label: &str, cost: f64, model: Option<f64>, rounding: f64) -> Row {
    Row {
        label: label.to_owned(),
        recipe: format!("(module: \"microfacet\", fill: {{\"masking\": \"{label}\"}})"),
        summary: format!("Masking by {label}, after a paper of some year"),
        model: model.map(errors),
        rounding: Some(errors(rounding)),
        rounding_cpu: errors(rounding * 0.8),
        allowed: Some(rounding * 60.0 + 1e-7),
        verdict: Verdict::default(),
        cost: Cost {
            add: (cost * 0.3) as u32,
            multiply: (cost * 0.4) as u32,
            divide: 2,
            root: 1,
            bindings: 1,
            uniform_bytes: 16,
            ..Cost::default()
        },
        executed: Executed {
            mean: cost,
            max: cost * 1.5,
            ..Executed::default()
        },
        time: Some(Time {
            median: cost / 40.0,
            p10: cost / 42.0,
            p90: cost / 37.0,
            nanoseconds: cost * 0.11,
        }),
        dominated: false,
        picture: None,
    }
}

/// Says which rows are dominated, as whoever fills a report does.
pub fn decide(results: &mut Results) {
    let places: Vec<[f64; 2]> = results.rows.iter().map(|row| [row.executed.mean, row.error()]).collect();
    for (row, dominated) in results.rows.iter_mut().zip(dominated(&places)) {
        row.dominated = dominated;
    }
}

fn experiment(name: &str, title: &str, rows: Vec<Row>) -> Results {
    let mut results = Results {
        name: name.to_owned(),
        title: title.to_owned(),
        doc:
            "How well the approximations of *height-correlated* masking hold, and what they cost. The integral over the hemisphere is `1` \
              where a microsurface [loses no light](https://example.org)."
                .to_owned(),
        category: name.split('/').next().unwrap_or_default().to_owned(),
        function: "brdf".to_owned(),
        truth: "Heitz 2014, eq. 99, in double precision".to_owned(),
        metric: "relative, floor 1e-6".to_owned(),
        configurations: 4096,
        hard: 32,
        seed: 7,
        comparable: true,
        baseline: rows.first().map(|row| row.label.clone()).unwrap_or_default(),
        rows,
        samples: None,
    };
    decide(&mut results);
    results
}

/// Ordinary: twelve alternatives, two of them exact, one with NaN, close neighbours, and pictures.
pub fn masking() -> Results {
    let mut rows = vec![
        row("smith-correlated", 74.0, Some(0.0), 2.1e-7),
        row("smith-hammon", 31.0, Some(7.4e-3), 1.4e-7),
        row("smith-separable", 62.0, Some(4.2e-2), 1.9e-7),
        row("schlick", 24.0, Some(6.3e-2), 1.2e-7),
        row("schlick-disney", 28.0, Some(8.1e-2), 1.2e-7),
        row("kelemen", 12.0, Some(0.21), 6e-8),
        row("neumann", 11.0, Some(0.34), 6e-8),
        row("implicit", 4.0, Some(0.58), 0.0),
        row("cook-torrance", 19.0, Some(0.19), 1e-6),
        row("beckmann-rational", 36.0, Some(6.8e-3), 2.0e-7),
        row("table-64", 33.0, Some(6.9e-3), 3.1e-4),
        row("reference", 2210.0, None, 8.7e-7),
    ];
    rows[8].verdict.nan = Fault {
        count: 3,
        worst: Some(Worst {
            got: json!("NaN"),
            expected: json!(0.25),
            ..worst(0.0)
        }),
    };
    rows[10].cost.texture = 1;
    rows[10].executed.texture = 1.0;
    rows[10].verdict.discontinuous = Fault {
        count: 211,
        worst: Some(worst(0.7)),
    };
    rows[1].picture = Some(picture("model"));
    let mut holes = picture("rounding");
    holes.errors.iter_mut().take(64 * 6).for_each(|error| *error = None);
    holes
        .errors
        .iter_mut()
        .skip(64 * 6)
        .take(64 * 6)
        .for_each(|error| *error = Some(0.0));
    rows[8].picture = Some(holes);
    rows[3].picture = Some(picture("model"));
    experiment("brdf/masking", "Masking and shadowing", rows)
}

/// One row with nothing but what must be there.
pub fn lonely() -> Results {
    let only = Row {
        rounding: None,
        allowed: None,
        time: None,
        ..row("exact", 0.0, None, 0.0)
    };
    let mut results = experiment("curve/exposure/manual", "Exposure by hand", vec![only]);
    results.doc = String::new();
    results
}

/// Names that are code, and numbers at the ends of what there is.
pub fn hostile() -> Results {
    let mut huge = row(HOSTILE, 1e300, Some(f64::INFINITY), 1e308);
    huge.recipe = format!("(module: \"{}\")", HOSTILE.replace(['\\', '"', '\u{0}', '\u{1b}'], "'"));
    huge.rounding_cpu.worst.input = json!({"it's": HOSTILE, "x": [5e-324, -1.5e300]});
    huge.rounding_cpu.worst.component = HOSTILE.to_owned();
    huge.verdict.infinite = Fault {
        count: 1,
        worst: Some(Worst {
            input: json!({"s": "it's \"quoted\" $HOME\nline"}),
            component: HOSTILE.to_owned(),
            got: json!("-Infinity"),
            expected: json!(HOSTILE),
        }),
    };
    let mut nan = row("nan", 10.0, Some(f64::NAN), f64::NAN);
    nan.executed.max = f64::INFINITY;
    nan.picture = Some(Picture {
        errors: vec![None, Some(f64::NAN), Some(0.0), Some(5e-324), Some(1e300), Some(f64::INFINITY)],
        width: 3,
        height: 2,
        worst: [f64::NAN, 1e9],
        axes: [HOSTILE.to_owned(), HOSTILE.to_owned()],
        of: "rounding".to_owned(),
    });
    let rows = vec![
        huge,
        nan,
        row("tiny", 1e-300, Some(5e-324), 5e-324),
        row("one", 1.0, Some(1.0), 1.0),
        row("one again", 1.0, Some(1.0), 1.0),
        row("nothing", 0.0, Some(0.0), 0.0),
    ];
    let mut results = experiment("<b>evil</b>/../x", HOSTILE, rows);
    results.doc = format!("{HOSTILE}\n\n<iframe src=x>\n\n[click](javascript:alert(1)) ![pixel](https://example.org/x.png)");
    results.function = "it's".to_owned();
    results.truth = HOSTILE.to_owned();
    results.metric = format!("relative {HOSTILE}");
    results
}

/// All of it.
pub fn report() -> Report {
    let agreement = |module: &str, outside: usize| Agreement {
        module: module.to_owned(),
        recipe: module.to_owned(),
        function: "brdf".to_owned(),
        results: 12_288,
        equal: 12_287,
        outside,
        undecided: 4,
        ulps: 2.5,
        worst: Some(worst(0.5)),
    };
    let mut without = IndexMap::new();
    without.insert("pass/forward".to_owned(), "a pass has no function to call".to_owned());
    without.insert(HOSTILE.to_owned(), HOSTILE.to_owned());
    Report {
        provenance: Provenance {
            device: "llvmpipe (LLVM 15.0.6, 256 bits)".to_owned(),
            driver: "llvmpipe, Mesa 22.3.6".to_owned(),
            is_software: true,
            version: "0.1.0".to_owned(),
            commit: "0123456789abcdef+".to_owned(),
            date: "2026-01-02T03:04:05Z".to_owned(),
        },
        experiments: vec![masking(), lonely(), hostile()],
        agreement: vec![
            agreement("brdf/lambert", 0),
            agreement("brdf/microfacet", 17),
            agreement(HOSTILE, 1),
        ],
        without,
        fits: Vec::new(),
    }
}
