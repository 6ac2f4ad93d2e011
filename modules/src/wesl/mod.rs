//! Modules written in WESL.
//!
//! The crate `wesl` follows the imports and decides the conditions; what it finds is carried out on the author's own text, so that names,
//! comments and places stay: text that falls away is cut out, and imported declarations stand behind the module's own. Each declaration is
//! parsed again and compared with what `wesl` itself would write ([`splice`]).

mod conditions;
mod errors;
mod files;
mod names;
mod splice;
mod tokens;

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Deserialize;
use shadewright_compiler::diagnostics::{Diagnostic, Position, Report, SourceFile, codes};
use shadewright_compiler::{Library, limits, upstream};
use wesl::{CompileOptions, CompileResult, Feature, Features, ModulePath, syntax::PathOrigin};

use files::Files;
use names::Names;

/// A library of which modules may be written in WESL: where a module's folder has `NAME.wesl` in place of `NAME.wgsl`, the latter is what
/// comes of resolving the former. Everything else is the library's as it stands.
///
/// `package::` is the library's root; each file is named by its path without the ending. `spec/wesl.md` has the rest.
#[derive(Clone)]
pub struct Wesl<L>(pub L);

/// What `wesl.ron` beside a module's WESL declares.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Declared {
    /// Features by name, on or off. Others are unknown.
    #[serde(default)]
    features: BTreeMap<String, bool>,
}

impl<L: Library> Library for Wesl<L> {
    fn folders(&self, folder: &str) -> Vec<String> {
        self.0.folders(folder)
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        match module(path) {
            Some(_) => match self.file(path) {
                Ok(file) => Ok(file.map(|file| file.text.clone())),
                Err(report) => Err(report.render()),
            },
            None => self.0.read(path),
        }
    }

    fn bytes(&self, path: &str) -> Result<Option<Vec<u8>>, String> {
        self.0.bytes(path)
    }

    fn file(&self, path: &str) -> Result<Option<Arc<SourceFile>>, Report> {
        let plain = self.0.file(path)?;
        let Some(module) = module(path) else {
            return Ok(plain);
        };
        let own = format!("{}.wesl", module.join("/"));
        let Some(file) = self.0.file(&own)? else {
            return Ok(plain);
        };
        if plain.is_some() {
            return Err(
                Diagnostic::new(codes::WESL_AND_WGSL, format!("`{path}` and `{}` are both there", file.name))
                    .note("a module's code is in one of them: remove the other")
                    .into(),
            );
        }
        limits::check_wgsl(&file)?;
        let features = self.features(&module)?;
        let path = path.to_owned();
        let name = file.name.clone();
        let work = || resolve(&self.0, path, file, &module, &features);
        upstream::guarded_in("wesl", codes::WESL_PANIC, &format!("resolving `{name}`"), work)?.map(Some)
    }
}

impl<L: Library> Wesl<L> {
    /// The features that the module's folder declares.
    fn features(&self, module: &[String]) -> Result<BTreeMap<String, bool>, Report> {
        let folder = module.split_last().map(|(_, folder)| folder.join("/")).unwrap_or_default();
        let path = format!("{folder}/wesl.ron");
        let Some(file) = self.0.file(&path)? else {
            return Ok(BTreeMap::new());
        };
        limits::check_size(&file)?;
        let declared: Declared = ron::from_str(&file.text).map_err(|error| {
            let place = |p: ron::error::Position| {
                file.byte_at(Position {
                    line: p.line,
                    column: p.col,
                })
            };
            let span = place(error.span.start)..place(error.span.end);
            Diagnostic::new(codes::WESL_DECLARATION, "this declares no features")
                .at(&file, span, error.code.to_string())
                .note("expected is `(features: {\"name\": true})`")
        })?;
        Ok(declared.features)
    }
}

/// The parts of a path `CATEGORY/NAME/NAME.wgsl`, without the ending; `None` for other paths.
fn module(path: &str) -> Option<Vec<String>> {
    let parts: Vec<String> = path.strip_suffix(".wgsl")?.split('/').map(str::to_owned).collect();
    (parts.len() == 3 && parts[1] == parts[2]).then_some(parts)
}

/// The plain WGSL of a module.
fn resolve(
    library: &dyn Library,
    path: String,
    root: Arc<SourceFile>,
    module: &[String],
    features: &BTreeMap<String, bool>,
) -> Result<Arc<SourceFile>, Report> {
    let at = ModulePath::new(PathOrigin::Absolute, module.to_vec());
    // Names may clash with others for which only the whole text tells; then longer ones are tried, the same for the same input.
    for attempt in 0..names::ATTEMPTS {
        let files = Files::new(library, at.clone(), Arc::clone(&root));
        let names = Names::new(attempt);
        let result = match compile(&at, &files, &names, features, None) {
            Ok(result) => result,
            Err(report) => return Err(first(&at, &files, &names, features).unwrap_or(report)),
        };
        if !names.clash(&files) {
            return Ok(splice::splice(path, &files, &names, &result, features));
        }
    }
    Err(
        Diagnostic::new(codes::WESL_IMPORT, format!("what `{}` imports cannot be named", root.name))
            .note("every name that would do is taken: rename what is called like a file and its declaration")
            .into(),
    )
}

/// What wesl makes of a module: all of it, or what these declarations need.
fn compile(
    at: &ModulePath,
    files: &Files,
    names: &Names,
    features: &BTreeMap<String, bool>,
    keep: Option<&[String]>,
) -> Result<CompileResult, Report> {
    let options = CompileOptions {
        validate: false,
        keep_root: keep.is_none(),
        keep: keep.map(<[String]>::to_vec),
        features: Features {
            default: Feature::Error,
            flags: features.iter().map(|(name, on)| (name.clone(), Feature::from(*on))).collect(),
        },
        ..CompileOptions::default()
    };
    let result = wesl::compile(at, files, names, &options);
    match files.take_refusal() {
        Some(refused) => Err(refused),
        None => result.map_err(|error| errors::told(error, files)),
    }
}

/// The error of the first declaration that has one: wesl looks at them in an order that differs from run to run.
fn first(at: &ModulePath, files: &Files, names: &Names, features: &BTreeMap<String, bool>) -> Option<Report> {
    let (_, root) = files.seen().into_iter().next()?;
    let all = errors::declared(&root);
    let error = |keep: &[String]| compile(at, files, names, features, Some(keep)).err();
    if let Some(of_all) = error(&[]) {
        return Some(of_all);
    }
    // With `good` of them there is no error yet, with `bad` there is one.
    let (mut good, mut bad) = (0, all.len());
    while bad > good + 1 {
        let middle = usize::midpoint(good, bad);
        match error(&all[..middle]) {
            Some(_) => bad = middle,
            None => good = middle,
        }
    }
    error(all.get(good..bad)?)
}

#[cfg(test)]
mod tests;
