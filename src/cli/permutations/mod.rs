//! `permutations`: counts, lists, checks or writes the permutations of a space.

mod store;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::Args;
use serde_json::{Value as Json, json};
use shadewright::compiler::Report;
use shadewright::compiler::space::{Chosen, Passes, Permutation, Space, Work, compile_all};

use super::emit::Language;
use super::failure::Failure;
use super::output::{json, say, say_json, write_stdout};
use super::watch::Watch;
use super::{Context, Format, input};

/// Permutations that are compiled before their results are put in order and written.
const CHUNK: usize = 256;

/// Most random permutations: their numbers are drawn before the first is compiled.
const MOST_RANDOM: usize = 10_000_000;

/// Options of `permutations`.
#[derive(Args)]
pub struct Options {
    /// Space (*.space.ron), inline RON tree, module name, or - for standard input
    space: String,
    /// Only say how many there are
    #[arg(long, conflicts_with_all = ["check", "emit"])]
    count: bool,
    /// Compile all, write nothing
    #[arg(long, conflicts_with = "emit")]
    check: bool,
    /// Compile all, and write each distinct program once, with a manifest; what is there already is kept
    #[arg(long, value_name = "DIR")]
    emit: Option<PathBuf>,
    /// Which ones: all, pairwise, or random:N
    #[arg(long, default_value = "all")]
    sample: Sample,
    /// Another one gives other random permutations
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Which pass of each: the root's own, INSTANCE.PASS, or all
    #[arg(long, default_value = "main")]
    pass: String,
    /// Threads that compile; 0 for one a core
    #[arg(long, default_value_t = 0)]
    threads: usize,
    /// Which language `--emit` writes
    #[arg(long, value_enum, default_value_t = Language::Wgsl)]
    target: Language,
}

impl Options {
    fn passes(&self) -> Passes {
        match self.pass.as_str() {
            "all" => Passes::All,
            one => Passes::One(one.to_owned()),
        }
    }
}

/// Which permutations of a space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sample {
    All,
    Pairwise,
    Random(usize),
}

impl FromStr for Sample {
    type Err = String;

    fn from_str(typed: &str) -> Result<Self, String> {
        match typed {
            "all" => Ok(Self::All),
            "pairwise" => Ok(Self::Pairwise),
            _ => {
                let number = typed.strip_prefix("random:").and_then(|number| number.parse().ok());
                let number = number.filter(|number| *number <= MOST_RANDOM);
                number
                    .map(Self::Random)
                    .ok_or_else(|| format!("all, pairwise, or random:N with N up to {MOST_RANDOM}"))
            }
        }
    }
}

/// Permutations of a space, in order, and how many of them there are.
struct Drawn<'s> {
    iter: Box<dyn Iterator<Item = Permutation> + 's>,
    number: u128,
}

fn sampled<'s>(space: &'s Space, options: &Options) -> Result<Drawn<'s>, Failure> {
    Ok(match options.sample {
        Sample::All => Drawn {
            number: space.count()?,
            iter: Box::new(space.iter()?),
        },
        Sample::Pairwise => {
            let cover = space.pairwise()?;
            Drawn {
                number: cover.len() as u128,
                iter: Box::new(cover.into_iter()),
            }
        }
        Sample::Random(number) => {
            let drawn = space.random(number, options.seed)?;
            Drawn {
                number: drawn.len() as u128,
                iter: Box::new(drawn.into_iter().filter_map(|index| space.get(index))),
            }
        }
    })
}

/// # Errors
/// The space is wrong or has no legal permutation, one of them does not compile, or a file cannot be written.
pub fn run(context: &Context, options: &Options) -> Result<(), Failure> {
    let (name, text) = input::tree(&options.space, "space")?;
    let space = Space::parse(&context.catalog, &name, &text)?;
    if options.count {
        return count(context, &space, options);
    }
    space.not_empty()?;
    match &options.emit {
        Some(folder) => store::emit(context, &space, options, folder),
        None if options.check => check(context, &space, options),
        None => list(context, &space, options),
    }
}

fn count(context: &Context, space: &Space, options: &Options) -> Result<(), Failure> {
    let sample = match options.sample {
        Sample::All => None,
        _ => Some(sampled(space, options)?.number),
    };
    // A space that is too large to be numbered can still be covered.
    let count = match (space.count(), sample) {
        (Ok(count), _) => count.to_string(),
        (Err(_), Some(_)) => format!("more than {}", u128::MAX - 1),
        (Err(report), None) => return Err(report.into()),
    };
    let never = space.never();
    if context.format == Format::Json {
        return say_json(&json!({
            "permutations": count,
            "sample": sample.map(|number| number.to_string()),
            "choices": space.choices(),
            "never": never,
        }));
    }
    let mut text = match sample {
        Some(sample) => format!("{sample} of {count} permutations"),
        None => format!("{count} permutations"),
    };
    text.push_str(&format!(", {} choices\n", space.choices()));
    for option in &never {
        text.push_str(&format!("never {}\n", shown(option)));
    }
    say(&text)
}

fn shown(chosen: &Chosen) -> String {
    format!("{}={}", chosen.place, chosen.chosen)
}

fn title(permutation: &Permutation) -> String {
    let index = permutation.index.map_or_else(|| "-".to_owned(), |index| index.to_string());
    let choices: Vec<String> = permutation.choices.iter().map(shown).collect();
    format!("{index}: {}", choices.join(" ")).trim_end().to_owned()
}

fn index(permutation: &Permutation) -> Option<String> {
    permutation.index.map(|index| index.to_string())
}

fn list(context: &Context, space: &Space, options: &Options) -> Result<(), Failure> {
    let mut first = true;
    for permutation in sampled(space, options)?.iter {
        match context.format {
            Format::Text => say(&title(&permutation))?,
            Format::Json => {
                let object = json!({
                    "index": index(&permutation),
                    "choices": permutation.choices,
                    "recipe": permutation.recipe.source.text,
                });
                write_stdout(format!("{}{}", if first { "[\n" } else { ",\n" }, json(&object)?).as_bytes())?;
            }
        }
        first = false;
    }
    match context.format {
        Format::Text => Ok(()),
        Format::Json => say(if first { "[]" } else { "\n]" }),
    }
}

/// What became of one permutation's pass.
struct Outcome {
    pass: String,
    hash: Result<u128, Report>,
}

fn check(context: &Context, space: &Space, options: &Options) -> Result<(), Failure> {
    let chosen = sampled(space, options)?;
    let watch = Watch::new(chosen.number, "permutations");
    let mut tally = Tally::default();
    let mut iter = chosen.iter;
    loop {
        let chunk: Vec<Permutation> = iter.by_ref().take(CHUNK).collect();
        if chunk.is_empty() {
            break;
        }
        let work = Work {
            passes: options.passes(),
            threads: options.threads,
            cancel: watch.cancel(),
            progress: &|_| watch.step(),
        };
        let outcomes = compile_all(&context.catalog, &chunk, &work, |_, compiled| {
            let outcome = |(pass, result): (String, Result<shadewright::compiler::Program, Report>)| Outcome {
                pass,
                hash: result.map(|program| program.hash()),
            };
            compiled.into_iter().map(outcome).collect::<Vec<_>>()
        });
        for (permutation, outcomes) in chunk.iter().zip(outcomes) {
            let Some(outcomes) = outcomes else {
                return Err(Failure::Interrupted(format!(
                    "{} of {} permutations were compiled",
                    tally.permutations, chosen.number
                )));
            };
            tally.add(permutation, outcomes);
        }
    }
    watch.finish();
    tally.not_empty(&options.pass)?;
    tally.say(context.format)
}

/// What compiling many permutations came to.
#[derive(Default)]
struct Tally {
    permutations: u128,
    programs: usize,
    distinct: BTreeSet<u128>,
    failed: Vec<Json>,
    texts: Vec<String>,
}

impl Tally {
    fn add(&mut self, permutation: &Permutation, outcomes: Vec<Outcome>) {
        self.permutations += 1;
        for Outcome { pass, hash } in outcomes {
            match hash {
                Ok(hash) => {
                    self.programs += 1;
                    self.distinct.insert(hash);
                }
                Err(report) => self.fail(permutation, &pass, &report),
            }
        }
    }

    fn fail(&mut self, permutation: &Permutation, pass: &str, report: &Report) {
        self.texts.push(format!("{}\npass {pass}: {}", title(permutation), report.render()));
        self.failed.push(json!({
            "index": index(permutation),
            "choices": permutation.choices,
            "recipe": permutation.recipe.source.text,
            "pass": pass,
            "diagnostics": report.to_json(),
        }));
    }

    /// A pass that no permutation has is a slip of the pen.
    fn not_empty(&self, pass: &str) -> Result<(), Failure> {
        if self.permutations > 0 && self.programs == 0 && self.failed.is_empty() {
            let text = format!("none of the {} permutations has a pass `{pass}`", self.permutations);
            return Err(Failure::message(text));
        }
        Ok(())
    }

    /// Programs for each distinct one.
    fn ratio(&self) -> f64 {
        self.programs as f64 / self.distinct.len().max(1) as f64
    }

    fn text(&self) -> String {
        let failed = match self.failed.len() {
            0 => String::new(),
            failed => format!(", {failed} do not compile"),
        };
        format!(
            "{} permutations, {} programs, {} distinct ({:.2} to one){failed}",
            self.permutations,
            self.programs,
            self.distinct.len(),
            self.ratio()
        )
    }

    fn say(self, format: Format) -> Result<(), Failure> {
        match format {
            Format::Json => say_json(&json!({
                "permutations": self.permutations.to_string(),
                "programs": self.programs,
                "distinct": self.distinct.len(),
                "ratio": self.ratio(),
                "failed": self.failed,
            }))?,
            Format::Text => {
                for text in &self.texts {
                    say(text)?;
                }
                say(&self.text())?;
            }
        }
        if self.failed.is_empty() { Ok(()) } else { Err(Failure::Said) }
    }
}

/// Checks a space: that it opens, that something is legal, and that each two options that may stand together do link.
///
/// # Errors
/// Not so.
pub fn check_space(context: &Context, path: &Path) -> Result<(), Failure> {
    let space = Space::parse(&context.catalog, &path.to_string_lossy(), &input::text(path)?)?;
    space.not_empty()?;
    // What `check` asks of a recipe it asks of each: every pass of a root, every function of another module.
    let cover = space.pairwise()?;
    cover
        .iter()
        .try_for_each(|permutation| super::check::tree(context, &permutation.recipe))
}
