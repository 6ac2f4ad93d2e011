//! What the forward recipe of the first scene costs: ours step by step, and the same shader through the other ways to compose it.
#![allow(clippy::print_stderr, reason = "a failing bench says so")]

use std::cell::RefCell;
use std::fmt::Write as _;
use std::process::ExitCode;
use std::sync::Arc;

use shadewright_benchmark::edited::Edited;
use shadewright_benchmark::measure::{Candidate, Times, rounds};
use shadewright_benchmark::peers::{concatenation::concatenate, oil, parse, parse_and_validate, validate, wesl};
use shadewright_benchmark::pieces::{Piece, pieces};
use shadewright_benchmark::table::{Arguments, digits, table, time};
use shadewright_benchmark::{RECIPE, Subject, process, version};
use shadewright_compiler::canonical::canonical_hash;
use shadewright_compiler::naga::{Module, compact};
use shadewright_compiler::{Catalog, Recipe, Report, Target, emit, hash, validate as gate};

const WARM: &str = "ours, modules parsed: linked and validated";
const WARM_TEXT: &str = "ours, modules parsed: WGSL text alone";
const COLD: &str = "ours from nothing: manifests, parse what is reached, link, validate";
const COLD_TEXT: &str = "ours from nothing: WGSL text alone";
const VALIDATION: &str = "naga's validation alone";
const CONCATENATION: &str = "concatenation: naga parses and validates";
const OIL_WARM: &str = "naga_oil, modules built: as it comes, validating";
const OIL_WARM_LEAN: &str = "naga_oil, modules built: not validating, then naga's validation once";
const OIL_COLD: &str = "naga_oil from nothing: composer, all modules, shader, validating";
const OIL_COLD_LEAN: &str = "naga_oil from nothing: not validating, then naga's validation once";
const WESL: &str = "wesl: WGSL text, as it comes, validating";
const WESL_LEAN: &str = "wesl: WGSL text, no validation, no source map";
const WESL_NAGA: &str = "and then, for wesl's text: naga parses and validates";

const PEERS: [&str; 13] = [
    VALIDATION,
    WARM,
    OIL_WARM,
    OIL_WARM_LEAN,
    CONCATENATION,
    COLD,
    OIL_COLD,
    OIL_COLD_LEAN,
    WARM_TEXT,
    COLD_TEXT,
    WESL,
    WESL_LEAN,
    WESL_NAGA,
];

const EDIT: &str = "after an edit of one leaf: reload, parse it, link, validate";
const REFLECTION: &str = "reflection of a program";
const FINISH: &str = "finish a plan: IR, validation";

const STEPS: [&str; 18] = [
    "load the library's manifests",
    "plan: resolve, reach, find what is alive, bind, name",
    "write the plan as IR",
    "canonical hash",
    VALIDATION,
    FINISH,
    WARM,
    "write the plan as source",
    "reflection as JSON",
    "naga's compaction, which the linker does without",
    "naga writes WGSL",
    "naga writes SPIR-V",
    "naga writes HLSL",
    "naga writes MSL",
    "naga parses the emitted text",
    EDIT,
    COLD,
    REFLECTION,
];

/// Something that is asked for.
struct Question {
    what: &'static str,
    /// The row that answers it here.
    ours: &'static str,
    /// Who else answers it, each with the rows whose sum it takes.
    others: &'static [(&'static str, &'static [&'static str])],
}

const MODULE_FROM_TEXT: (&str, &[&str]) = ("wesl and naga", &[WESL_LEAN, WESL_NAGA]);
const UNCOMPOSED: (&str, &[&str]) = ("concatenation", &[CONCATENATION]);

const QUESTIONS: [Question; 4] = [
    Question {
        what: "a validated module, one more of many",
        ours: WARM,
        others: &[
            ("naga_oil", &[OIL_WARM]),
            ("naga_oil, validating once", &[OIL_WARM_LEAN]),
            MODULE_FROM_TEXT,
            UNCOMPOSED,
        ],
    },
    Question {
        what: "a validated module, from nothing",
        ours: COLD,
        others: &[
            ("naga_oil", &[OIL_COLD]),
            ("naga_oil, validating once", &[OIL_COLD_LEAN]),
            MODULE_FROM_TEXT,
            UNCOMPOSED,
        ],
    },
    Question {
        what: "WGSL text, one more of many",
        ours: WARM_TEXT,
        others: &[("wesl", &[WESL]), ("wesl, no checks", &[WESL_LEAN])],
    },
    Question {
        what: "WGSL text, from nothing",
        ours: COLD_TEXT,
        others: &[("wesl", &[WESL]), ("wesl, no checks", &[WESL_LEAN])],
    },
];

fn main() -> ExitCode {
    match process::steadily().and_then(|done| done.map_or_else(|| run().map(|()| true), Ok)) {
        Ok(true) => ExitCode::SUCCESS,
        // It has said why.
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), String> {
    let arguments = Arguments::read()?;
    let count = if arguments.quick { 30 } else { 80 };
    let subject = Subject::load()?;
    let pieces = pieces(&subject.program)?;
    let times = measured(&subject, &pieces, count)?;
    let head = format!(
        "{count} rounds in one process on {} processors; release profile; naga {}, naga_oil {}, wesl {}.\n",
        process::processors(),
        version("naga"),
        version("naga_oil"),
        version("wesl"),
    );
    let peers = format!(
        "{head}\n{}\n{}\n{}\n{}",
        times_table(&times, &PEERS, WARM)?,
        answers(&times)?,
        ahead(&times)?,
        outputs(&subject, &pieces)?
    );
    arguments.publish("peers", &peers)?;
    arguments.publish("steps", &format!("{head}\n{}", times_table(&times, &STEPS, VALIDATION)?))
}

fn said<T>(result: Result<T, Report>) -> Result<T, String> {
    result.map_err(|report| report.render())
}

fn measured(subject: &Subject, pieces: &[Piece], count: usize) -> Result<Vec<Times>, String> {
    let Subject { catalog, recipe, program } = subject;
    let sources = oil::Sources::new(pieces);
    let validating = RefCell::new(sources.composer(true)?);
    let lean = RefCell::new(sources.composer(false)?);
    let checked_wesl = wesl::Compiler::new(pieces, true)?;
    let lean_wesl = wesl::Compiler::new(pieces, false)?;
    let wesl_text = lean_wesl.text()?;
    let plan = said(catalog.plan(recipe, "main"))?;
    let linked = said(plan.link())?;
    let library = Arc::new(Edited::new("ndf/ggx/ggx.wgsl"));
    let open = RefCell::new(said(Catalog::load(library.clone()))?);
    said(open.borrow().compile(recipe, "main"))?;
    let both = |module: Result<Module, String>| {
        let module = module?;
        let info = validate(&module)?;
        Ok((module, info))
    };
    let load = || -> Result<(Catalog, Recipe), String> {
        let catalog = said(Catalog::load(shadewright_modules::library()))?;
        Ok((catalog, said(Recipe::parse("forward.recipe.ron", RECIPE))?))
    };
    let writes = |name: &str, target: Target| Candidate::new(name, move || said(emit(program.validated(), target, None)));
    let candidates = vec![
        Candidate::new(WARM, || said(catalog.compile(recipe, "main"))),
        Candidate::new(WARM_TEXT, || said(catalog.plan(recipe, "main").and_then(|plan| plan.source()))),
        Candidate::new(COLD, || {
            let (catalog, recipe) = load()?;
            let program = said(catalog.compile(&recipe, "main"))?;
            Ok((catalog, program))
        }),
        Candidate::new(COLD_TEXT, || {
            let (catalog, recipe) = load()?;
            let text = said(catalog.plan(&recipe, "main").and_then(|plan| plan.source()))?;
            Ok((catalog, text))
        }),
        Candidate::with_input(
            VALIDATION,
            || linked.clone(),
            |module| gate::validate(module).map_err(|e| e.to_string()),
        ),
        Candidate::new(CONCATENATION, || parse_and_validate(&concatenate(pieces))),
        Candidate::new(OIL_WARM, || sources.make(&mut validating.borrow_mut())),
        Candidate::new(OIL_WARM_LEAN, || both(sources.make(&mut lean.borrow_mut()))),
        Candidate::new(OIL_COLD, || {
            let mut composer = sources.composer(true)?;
            let module = sources.make(&mut composer)?;
            Ok((composer, module))
        }),
        Candidate::new(OIL_COLD_LEAN, || {
            let mut composer = sources.composer(false)?;
            let module = both(sources.make(&mut composer))?;
            Ok((composer, module))
        }),
        Candidate::new(WESL, || checked_wesl.text()),
        Candidate::new(WESL_LEAN, || lean_wesl.text()),
        Candidate::new(WESL_NAGA, || parse_and_validate(&wesl_text)),
        Candidate::new(STEPS[0], || said(Catalog::load(shadewright_modules::library()))),
        Candidate::new(STEPS[1], || said(catalog.plan(recipe, "main"))),
        Candidate::new(STEPS[2], || said(plan.link())),
        Candidate::new(STEPS[3], || Ok(hash::structural_hash(&linked))),
        Candidate::with_input(
            FINISH,
            || catalog.plan(recipe, "main"),
            |plan| said(plan.and_then(|plan| catalog.finish(plan))),
        ),
        Candidate::new(STEPS[7], || said(plan.source())),
        Candidate::new(EDIT, || {
            library.edit();
            let catalog = said(open.borrow().reload())?;
            let program = said(catalog.compile(recipe, "main"))?;
            // Of all modules one is parsed again: else this measures something else.
            if catalog.parsed() != 1 {
                return Err(format!("{} modules were parsed", catalog.parsed()));
            }
            Ok((open.replace(catalog), program))
        }),
        Candidate::with_input(
            REFLECTION,
            || catalog.compile(recipe, "main"),
            |program| {
                let program = said(program)?;
                program.reflection();
                Ok(program)
            },
        ),
        Candidate::new(STEPS[8], || serde_json::to_string(program.reflection()).map_err(|e| e.to_string())),
        Candidate::with_input(
            STEPS[9],
            || linked.clone(),
            |mut module| {
                compact::compact(&mut module, compact::KeepUnused::No);
                Ok(module)
            },
        ),
        writes(STEPS[10], Target::WgslFromIr),
        writes(STEPS[11], Target::SpirV),
        writes(STEPS[12], Target::Hlsl),
        writes(STEPS[13], Target::Msl),
        Candidate::new(STEPS[14], || parse(program.wgsl())),
    ];
    rounds(candidates, count)
}

fn of<'t>(times: &'t [Times], name: &str) -> Result<&'t Times, String> {
    times
        .iter()
        .find(|t| t.name == name)
        .ok_or_else(|| format!("{name} was not measured"))
}

fn times_table(times: &[Times], names: &[&str], base: &str) -> Result<String, String> {
    let base = of(times, base)?;
    let row = |name: &&str| {
        let times = of(times, name)?;
        Ok(vec![
            times.name.clone(),
            time(times.percentile(0.5)),
            format!("{} to {}", time(times.percentile(0.1)), time(times.percentile(0.9))),
            digits(times.percentile(0.5) / base.percentile(0.5)),
            digits(times.ratio_to(base)),
        ])
    };
    let rows: Result<Vec<_>, String> = names.iter().map(row).collect();
    let header = ["what", "median", "p10 to p90", "ratio of medians", "median of ratios"];
    Ok(format!("Ratios are to: {}.\n\n{}", base.name, table(&header, &rows?)))
}

/// Times of work that is done one after the other.
fn sum(times: &[Times], names: &[&str]) -> Result<Times, String> {
    let parts: Result<Vec<&Times>, String> = names.iter().map(|name| of(times, name)).collect();
    let parts = parts?;
    let rounds = parts.iter().map(|part| part.seconds.len()).min().unwrap_or(0);
    Ok(Times {
        name: names.join(", "),
        seconds: (0..rounds)
            .map(|round| parts.iter().map(|part| part.seconds[round]).sum())
            .collect(),
    })
}

fn answers(times: &[Times]) -> Result<String, String> {
    let mut rows = Vec::new();
    for Question { what, ours, others } in QUESTIONS {
        let ours = of(times, ours)?;
        for (name, parts) in others {
            let theirs = sum(times, parts)?;
            rows.push(vec![
                what.to_owned(),
                (*name).to_owned(),
                time(ours.percentile(0.5)),
                time(theirs.percentile(0.5)),
                digits(theirs.ratio_to(ours)),
            ]);
        }
    }
    Ok(table(
        &["asked for", "held against", "ours", "theirs", "theirs in ours (median of ratios)"],
        &rows,
    ))
}

/// Says where somebody else is faster.
fn ahead(times: &[Times]) -> Result<String, String> {
    let mut found = Vec::new();
    for Question { what, ours, others } in QUESTIONS {
        let ours = of(times, ours)?;
        for (name, parts) in others {
            let ratio = sum(times, parts)?.ratio_to(ours);
            if ratio < 1.0 {
                found.push(format!("{name} for {what} ({} of our time)", digits(ratio)));
            }
        }
    }
    Ok(match found.is_empty() {
        true => "In this run none of them is ahead of ours.\n".to_owned(),
        false => format!("Ahead of ours in this run: {}.\n", found.join("; ")),
    })
}

fn outputs(subject: &Subject, pieces: &[Piece]) -> Result<String, String> {
    let program = &subject.program;
    let concatenated = concatenate(pieces);
    let wesl = wesl::Compiler::new(pieces, true)?.text()?;
    let sources = oil::Sources::new(pieces);
    let oil = sources.make(&mut sources.composer(true)?)?;
    let mut rows = Vec::new();
    for (name, text, module) in [
        ("ours", Some(program.wgsl()), program.validated().module()),
        ("concatenation", Some(concatenated.as_str()), &parse(&concatenated)?),
        ("wesl", Some(wesl.as_str()), &parse(&wesl)?),
        ("naga_oil", None, &oil),
    ] {
        let own = module.functions.iter().map(|(_, function)| function);
        let functions: Vec<_> = own.chain(module.entry_points.iter().map(|entry| &entry.function)).collect();
        let same = text.map(|text| canonical_hash(name, text).is_ok_and(|hash| hash == program.hash()));
        rows.push(vec![
            name.to_owned(),
            text.map_or("-".to_owned(), |text| text.lines().count().to_string()),
            functions.len().to_string(),
            functions.iter().map(|f| f.expressions.len()).sum::<usize>().to_string(),
            module.types.len().to_string(),
            module.global_variables.len().to_string(),
            same.map_or("-", |same| if same { "yes" } else { "no" }).to_owned(),
        ]);
    }
    let header = [
        "output",
        "lines of text",
        "functions",
        "expressions",
        "types",
        "variables",
        "canonical hash is ours",
    ];
    let mut out = String::new();
    // Infallible: writing to a string.
    let _ = write!(
        out,
        "{} module instances, {} pieces of source for the others.\n\n{}",
        program.reflection().instances.len(),
        pieces.len(),
        table(&header, &rows)
    );
    Ok(out)
}
