//! One row of a report.

use std::sync::atomic::{AtomicBool, Ordering};

use std::hash::Hash as _;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;
use shadewright_compiler::Recipe;
use shadewright_evaluate::Allowed;
use shadewright_modules::oracles;
use shadewright_runtime::gpu::Gpu;
use shadewright_runtime::gpu::pipeline::Pipelines;
use shadewright_runtime::probe::Evaluated;
use siphasher::sip128::{Hasher128 as _, SipHasher13};

use super::agree::agree;
use super::errors::{difference, largest, statistics};
use super::executed::executed;
use super::jumps::{self, jumps};
use super::sample::{Random, latin};
use super::search::search;
use super::slice::slice;
use super::subject::Subject;
use super::verdict::{note, verdict};
use super::{MeasureError, Of, widened, worst_of};
use crate::data::{Agreement, Errors, Provenance, Row, Verdict};
use crate::experiment::Range;
use crate::write::dominated;

/// How much is done for a row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Most configurations drawn.
    pub configurations: usize,
    /// Different sets of parameters among them: each is a dispatch of its own.
    pub param_sets: usize,
    /// How hard to look for the worst input.
    pub search: super::search::Effort,
    /// Segments along which jumps are looked for.
    pub segments: usize,
    /// Side of the picture in points; 0 for none.
    pub picture: usize,
    /// Most that a search, looking for jumps, or a picture may execute; of a formula that executes much they do less. An addition is 1.
    pub work: f64,
}

impl Effort {
    /// What a report is worth.
    pub const FULL: Self = Self {
        configurations: usize::MAX,
        param_sets: 24,
        search: super::search::Effort {
            parents: 8,
            children: 16,
            generations: 24,
        },
        segments: 384,
        picture: 64,
        work: 5e7,
    };
    /// What a test has time for. Equal on every machine.
    pub const QUICK: Self = Self {
        configurations: 256,
        param_sets: 8,
        search: super::search::Effort {
            parents: 4,
            children: 8,
            generations: 10,
        },
        segments: 96,
        picture: 0,
        work: 2e7,
    };
}

impl Effort {
    /// What of it can be done for a formula that executes so much.
    fn within(&self, executed: f64) -> Self {
        let share = |evaluations: f64| (self.work / (evaluations * executed.max(1.0))).min(1.0);
        let of_segments = share(self.segments as f64 * jumps::EVALUATIONS);
        let search = self.search;
        // In one number: of parents and of children its root.
        let of_search = share(search.parents as f64 * search.children as f64 * f64::from(search.generations)).sqrt();
        let part = |whole: usize, share: f64| (whole as f64 * share).ceil() as usize;
        let of_picture = share((self.picture * self.picture).max(1) as f64).sqrt();
        Self {
            picture: part(self.picture, of_picture),
            segments: part(self.segments, of_segments),
            search: super::search::Effort {
                parents: part(search.parents, of_search),
                children: part(search.children, of_search),
                ..search
            },
            ..*self
        }
    }
}

/// Points of the cube for an experiment's configurations. Parameters take few different values, so that rows share what is bound.
fn points(subject: &Subject, effort: &Effort) -> Vec<Vec<f64>> {
    let declared = &subject.experiment.declared;
    let count = declared.configurations.min(effort.configurations);
    let mut random = Random::new(declared.seed, 0);
    let mut points = latin(subject.domain.dimensions(), count, &mut random);
    let of_params = subject.domain.of_params();
    let sets = latin(of_params.len(), effort.param_sets.min(count), &mut random);
    for (point, set) in points.iter_mut().zip(sets.iter().cycle()) {
        point[of_params.clone()].copy_from_slice(set);
    }
    points
}

/// The hard configurations of an experiment.
fn hard(subject: &Subject) -> Vec<Json> {
    let mut rows = Vec::new();
    for block in &subject.experiment.declared.hard {
        let lists: Vec<(&str, Vec<Range>)> = block.iter().map(|(name, values)| (name.as_str(), values.ranges())).collect();
        let count: usize = lists.iter().map(|(_, ranges)| ranges.len()).product();
        for number in 0..count {
            let mut rest = number;
            let mut given = IndexMap::new();
            for (name, ranges) in &lists {
                given.insert(*name, &ranges[rest % ranges.len()]);
                rest /= ranges.len();
            }
            rows.push(subject.domain.row_with(&given));
        }
    }
    rows.dedup();
    rows
}

/// The rows that an alternative is measured with: those drawn, then the hard ones, whose number is the second part.
pub(crate) fn configurations(subject: &Subject, effort: &Effort) -> (Vec<Json>, usize) {
    let mut rows: Vec<Json> = points(subject, effort).iter().map(|p| subject.domain.row(p)).collect();
    let hard = hard(subject);
    let count = hard.len();
    rows.extend(hard);
    (rows, count)
}

/// An alternative, measured.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Measured {
    /// Its row.
    pub row: Row,
    /// Device against evaluator; none without a device.
    pub agreement: Option<Agreement>,
    /// Error of each configuration against a truth that is sampled; none against others.
    #[serde(default)]
    pub errors: Vec<Option<f64>>,
}

/// A device to measure on, with its pipelines.
#[derive(Clone, Copy)]
pub(crate) struct OnDevice<'a> {
    pub gpu: &'a Gpu,
    pub pipelines: &'a Pipelines,
}

/// Measures an alternative: everything but its time.
pub(crate) fn measure(subject: &Subject, device: Option<OnDevice>, effort: &Effort, cancel: &AtomicBool) -> Result<Measured, MeasureError> {
    let check = || {
        if cancel.load(Ordering::Relaxed) {
            Err(MeasureError::Interrupted)
        } else {
            Ok(())
        }
    };
    let metric = subject.metric();
    let points = points(subject, effort);
    let (rows, _) = configurations(subject, effort);
    let table = subject.table(&rows)?;
    let evaluated = subject.probe.on_cpu::<f64>(&table)?;
    let precise = &evaluated.values;
    let effort = &effort.within(executed(&evaluated.executed).mean);
    check()?;
    let single: Vec<Vec<f64>> = subject.probe.on_cpu::<f32>(&table)?.values.into_iter().map(widened).collect();
    check()?;
    let truth = subject.truth(&rows)?;
    let on_device = match device {
        Some(device) => Some(subject.probe.on_gpu(device.pipelines, device.gpu, &table)?),
        None => None,
    };
    check()?;

    let with_worst = |(errors, worst): (Errors, Option<usize>), got: &[Vec<f64>], truth: &[Vec<f64>]| match worst {
        None => errors,
        Some(at) => Errors {
            worst: worst_of(subject, &rows[at], &got[at], &truth[at]),
            ..errors
        },
    };
    let mut model = truth
        .as_ref()
        .map(|truth| with_worst(statistics(metric, precise, truth), precise, truth));
    let mut rounding_cpu = with_worst(statistics(metric, &single, precise), &single, precise);
    let mut rounding = on_device
        .as_ref()
        .map(|got| with_worst(statistics(metric, got, precise), got, precise));
    let expected = truth.as_ref().unwrap_or(precise);
    let mut verdict = verdict(subject, &rows, on_device.as_ref().unwrap_or(&single), expected);

    let mut worst = [None, None];
    for (place, of) in [Of::Model, Of::Rounding].into_iter().enumerate() {
        // A search would find where samples are too few.
        if of == Of::Model && (truth.is_none() || subject.is_sampled()) {
            continue;
        }
        let (got, wanted) = match of {
            Of::Model => (precise, expected),
            Of::Rounding => (&single, precise),
        };
        let sizes = got.iter().zip(wanted).map(|(got, wanted)| largest(metric, got, wanted).0);
        let start: Vec<_> = points.iter().cloned().zip(sizes).collect();
        let mut random = Random::new(subject.experiment.declared.seed, 1 + place as u64);
        let found = search(&start, effort.search, &mut random, |points| {
            check()?;
            let rows: Vec<Json> = points.iter().map(|p| subject.domain.row(p)).collect();
            let [got, wanted] = of.values(subject, &rows)?;
            Ok(got
                .iter()
                .zip(&wanted)
                .map(|(got, wanted)| largest(metric, got, wanted).0)
                .collect())
        })?;
        let Some((point, size)) = found else { continue };
        let searched = Searched { subject, device, of };
        let errors = match of {
            Of::Model => model.iter_mut().collect::<Vec<_>>(),
            Of::Rounding => vec![&mut rounding_cpu],
        };
        searched.take(&point, size, errors, rounding.as_mut().filter(|_| of == Of::Rounding), &mut verdict)?;
        worst[place] = Some((point, size));
    }
    let mut random = Random::new(subject.experiment.declared.seed, 3);
    // Where the error is large a jump is likely; the others are for jumps where it is small on both sides.
    let mut by_error: Vec<(f64, &Vec<f64>)> = points
        .iter()
        .zip(precise.iter().zip(expected))
        .map(|(point, (got, truth))| (largest(metric, got, truth).0, point))
        .collect();
    by_error.sort_by(|a, b| b.0.total_cmp(&a.0));
    let worst_first = by_error.iter().take(effort.segments / 2).map(|(_, point)| *point);
    let segments: Vec<_> = worst_first.chain(points.iter().take(effort.segments / 2)).cloned().collect();
    verdict.discontinuous = jumps(subject, &segments, &mut random)?;
    check()?;

    // The picture is of the larger error: of the model's, unless that is as small as the rounding.
    let bounds = subject.probe.on_cpu::<Allowed>(&table)?;
    let agreement = on_device.as_ref().map(|got| agree(subject, &rows, got, &bounds));
    let size = |place: usize| worst[place].as_ref().map_or(0.0, |(_, size)| *size);
    let shown = if size(0) > size(1) { Of::Model } else { Of::Rounding };
    let picture = match &worst[usize::from(shown == Of::Rounding)] {
        Some((point, _)) => slice(subject, point, shown, effort.picture)?,
        None => None,
    };
    let row = Row {
        label: subject.alternative.label.clone(),
        recipe: recipe_text(subject),
        summary: subject.alternative.root.manifest.summary.clone(),
        model,
        rounding,
        rounding_cpu,
        allowed: allowed(subject, &bounds, precise),
        verdict,
        cost: subject.probe.cost().cost,
        executed: executed(&evaluated.executed),
        time: None,
        dominated: false,
        picture,
    };
    let sizes = precise.iter().zip(expected).map(|(got, truth)| largest(metric, got, truth).0);
    let errors = match subject.is_sampled() {
        true => sizes.map(|size| Some(size).filter(|size| size.is_finite())).collect(),
        false => Vec::new(),
    };
    Ok(Measured { row, agreement, errors })
}

/// What a row's results depend on, in one word: the linked function, its tables, the inputs, what they should give, the device, the effort.
pub(crate) fn key(subject: &Subject, rows: &[Json], effort: &Effort, provenance: &Provenance) -> Result<String, MeasureError> {
    let mut hasher = SipHasher13::new();
    let Provenance {
        device, driver, version, ..
    } = provenance;
    (device, driver, version, format!("{effort:?}"), subject.probe.program().hash()).hash(&mut hasher);
    (oracles::DIGEST, format!("{:?}", subject.metric())).hash(&mut hasher);
    for number in subject.probe.tables().into_iter().flatten() {
        number.to_bits().hash(&mut hasher);
    }
    for row in rows {
        row.to_string().hash(&mut hasher);
    }
    for value in subject.truth(rows)?.iter().flatten().flatten() {
        value.to_bits().hash(&mut hasher);
    }
    let name: String = format!("{}-{}", subject.experiment.name, subject.alternative.label)
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
        .collect();
    Ok(format!("{name}-{:032x}", hasher.finish128().as_u128()))
}

/// The recipe as a person would type it: the bare name, or RON.
pub(super) fn recipe_text(subject: &Subject) -> String {
    one_line(&subject.alternative.recipe)
}

/// A recipe on one line, the module's name alone where that is all.
pub(crate) fn one_line(recipe: &Recipe) -> String {
    let node = &recipe.root;
    if node.fill.is_empty() && node.freeze.is_empty() && node.files.is_empty() {
        return node.module.clone();
    }
    recipe.source.text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// What a search found, on its way into the row.
struct Searched<'s, 'a> {
    subject: &'s Subject<'a>,
    device: Option<OnDevice<'s>>,
    of: Of,
}

impl Searched<'_, '_> {
    fn take(
        &self,
        point: &[f64],
        size: f64,
        errors: Vec<&mut Errors>,
        on_device: Option<&mut Errors>,
        verdict: &mut Verdict,
    ) -> Result<(), MeasureError> {
        let subject = self.subject;
        let row = [subject.domain.row(point)];
        let [got, wanted] = self.of.values(subject, &row)?;
        let worst = worst_of(subject, &row[0], &got[0], &wanted[0]);
        for errors in errors {
            if size.is_finite() && size > errors.searched {
                errors.searched = size;
                errors.worst = worst.clone();
            }
        }
        let mut checked = got;
        if let Some(device) = self.device {
            checked = subject.probe.on_gpu(device.pipelines, device.gpu, &subject.table(&row)?)?;
            if let Some(errors) = on_device {
                let (size, _) = largest(subject.metric(), &checked[0], &wanted[0]);
                if size.is_finite() && size > errors.searched {
                    errors.searched = size;
                    errors.worst = worst_of(subject, &row[0], &checked[0], &wanted[0]);
                }
            }
        }
        // A fault that the samples missed is one all the same.
        let truth = subject.truth(&row)?.unwrap_or(wanted);
        note(subject, verdict, &row[0], &checked[0], &truth[0]);
        Ok(())
    }
}

/// The error that the rules for floating-point numbers allow, not exceeded by 95 % of the numbers; none where they allow anything.
fn allowed(subject: &Subject, bounds: &Evaluated<Allowed>, precise: &[Vec<f64>]) -> Option<f64> {
    let rows = bounds.values.iter().zip(precise).zip(&bounds.undecided);
    let mut sizes: Vec<f64> = rows
        .filter(|(_, undecided)| !**undecided)
        .flat_map(|((values, precise), _)| values.iter().zip(precise))
        .map(|(value, precise)| {
            let size = |end| difference(subject.metric(), end, *precise).abs();
            size(value.low()).max(size(value.high()))
        })
        .collect();
    sizes.sort_by(f64::total_cmp);
    let at = (sizes.len() * 95).div_ceil(100).checked_sub(1)?;
    Some(sizes[at]).filter(|size| size.is_finite())
}

/// Marks the rows that another one beats: no worse in the result's error and in work, and better in one.
pub(crate) fn mark_dominated(rows: &mut [Row]) {
    let places: Vec<[f64; 2]> = rows.iter().map(|row| [row.executed.mean, row.error()]).collect();
    for (row, dominated) in rows.iter_mut().zip(dominated(&places)) {
        row.dominated = dominated;
    }
}
