//! One text, parsed and checked alone.

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};
use std::ops::Range;
use std::sync::Arc;

use naga::{Handle, TypeInner};

use super::checks;
use super::compose::{Composed, Interface, Needs, Origin, compose};
use super::scan::Scan;
use crate::diagnostics::{Diagnostic, Report, SourceFile, codes};
use crate::upstream::guarded;

/// A struct across units: whose it is, and its name there.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct StructKey {
    /// Category of the interface that declares it; `None` where the unit itself does.
    pub interface: Option<String>,
    /// Its name.
    pub name: String,
}

/// A module's or interface's text, parsed, typed and indexed.
#[derive(Debug)]
pub struct Unit {
    /// The author's file.
    pub file: Arc<SourceFile>,
    /// Items of the author's file.
    pub scan: Scan,
    /// What was parsed.
    pub composed: Composed,
    /// What the text was composed from.
    pub needs: Needs,
    /// The IR.
    pub ir: naga::Module,
    /// Types of all expressions.
    pub info: naga::valid::ModuleInfo,
    /// The category whose interface this unit is; `None` for a module's unit.
    pub interface: Option<String>,
    /// Functions by name.
    pub functions: HashMap<String, Handle<naga::Function>>,
    /// Whether a function depends on more than its text: on slots, parameters, resources. By handle.
    pub dependent: Vec<bool>,
    /// Structs by type handle, where the type is a named struct that somebody declared.
    pub structs: HashMap<Handle<naga::Type>, StructKey>,
    /// Structs whose layout a host or the language sees: never trimmed.
    pub fixed_structs: HashSet<StructKey>,
    /// Words that linked names must not be: locals, and words of the language that the text uses.
    pub words: HashSet<String>,
    /// Results of calls and other statements, with their places: by function handle, then by entry point.
    pub results: Vec<Vec<(Handle<naga::Expression>, Range<usize>)>>,
}

impl Unit {
    /// What a module-scope name stands for.
    pub fn origin(&self, name: &str) -> Option<&Origin> {
        self.composed.names.get(name)
    }

    /// The author's place of a span of the IR.
    pub fn locate(&self, span: naga::Span) -> Option<(&Arc<SourceFile>, Range<usize>)> {
        self.composed.locate(span.to_range()?)
    }
}

/// Parses composed text and checks it alone.
///
/// # Errors
/// The text is no WGSL, has a type error, or breaks a rule for modules.
pub fn parse_unit(file: Arc<SourceFile>, scan: Scan, composed: Composed, needs: Needs, interface: Option<String>) -> Result<Unit, Report> {
    checks::before_parsing(&file, &scan, interface.is_some())?;
    let unit = index(file, scan, composed, needs, interface)?;
    checks::after_parsing(&unit)?;
    Ok(unit)
}

/// Parses WGSL that is complete in itself, such as a linked shader: every name is its own.
///
/// # Errors
/// The text is no WGSL, or has a type error.
pub fn parse_whole(file: Arc<SourceFile>) -> Result<Unit, Report> {
    let scan = super::scan::scan(&file.text);
    let composed = compose(&file, &scan, &Needs::default(), &|_| {
        Err(Diagnostic::new(codes::UNKNOWN_INTERFACE, "none here").into())
    })?;
    index(file, scan, composed, Needs::default(), None)
}

fn index(file: Arc<SourceFile>, scan: Scan, composed: Composed, needs: Needs, interface: Option<String>) -> Result<Unit, Report> {
    let (ir, info) = parse_and_validate(&file, &composed)?;
    let functions: HashMap<_, _> = ir.functions.iter().filter_map(|(h, f)| Some((f.name.clone()?, h))).collect();
    let structs = named_structs(&ir, &composed);
    let mut unit = Unit {
        fixed_structs: HashSet::default(),
        words: HashSet::default(),
        results: Vec::new(),
        dependent: Vec::new(),
        file,
        scan,
        composed,
        needs,
        ir,
        info,
        interface,
        functions,
        structs,
    };
    unit.fixed_structs = fixed_structs(&unit);
    unit.dependent = dependents(&unit);
    unit.words = words(&unit);
    let functions = unit
        .ir
        .functions
        .iter()
        .map(|(_, f)| f)
        .chain(unit.ir.entry_points.iter().map(|e| &e.function));
    unit.results = functions.map(results).collect();
    Ok(unit)
}

/// Compares a module's functions with what its interface says.
///
/// # Errors
/// A function is missing or has another signature.
pub fn check_interface(unit: &Unit, interface: &Interface, interface_unit: &Unit) -> Result<(), Report> {
    checks::against_interface(unit, interface, interface_unit)
}

fn parse_and_validate(file: &Arc<SourceFile>, composed: &Composed) -> Result<(naga::Module, naga::valid::ModuleInfo), Report> {
    let work = || {
        let mut frontend = naga::front::wgsl::Frontend::new();
        let module = frontend.parse(&composed.text).map_err(|e| parse_error(file, composed, &e))?;
        // Bindings are numbered when linking.
        let flags = naga::valid::ValidationFlags::all() - naga::valid::ValidationFlags::BINDINGS;
        let mut validator = naga::valid::Validator::new(flags, naga::valid::Capabilities::all());
        let info = validator.validate(&module).map_err(|e| validation_error(file, composed, &e))?;
        Ok((module, info))
    };
    guarded(codes::UPSTREAM_PANIC, "parsing a module", work).map_err(|d| d.at(file, 0..0, "in this file"))?
}

fn parse_error(file: &Arc<SourceFile>, composed: &Composed, error: &naga::front::wgsl::ParseError) -> Report {
    // naga has one error type for both; its syntax errors all speak of what the parser expected.
    let syntax = error.message().starts_with("expected") && error.message().contains("found");
    let code = if syntax { codes::WGSL_SYNTAX } else { codes::WGSL_TYPE };
    let mut diagnostic = Diagnostic::new(code, error.message());
    for (span, text) in error.labels() {
        diagnostic = label(diagnostic, file, composed, span, text);
    }
    for note in error.notes() {
        diagnostic = diagnostic.note(note);
    }
    diagnostic.into()
}

fn label(diagnostic: Diagnostic, file: &Arc<SourceFile>, composed: &Composed, span: naga::Span, text: &str) -> Diagnostic {
    match span.to_range().and_then(|range| composed.locate(range)) {
        Some((place, range)) => diagnostic.at(place, range, text),
        None if diagnostic.labels.is_empty() => diagnostic.at(file, 0..0, "in what was linked to this file"),
        None => diagnostic,
    }
}

fn validation_error(file: &Arc<SourceFile>, composed: &Composed, error: &naga::WithSpan<naga::valid::ValidationError>) -> Report {
    let message = chain(error.as_inner());
    let types_differ = message.contains("doesn't match the type");
    let mut diagnostic = Diagnostic::new(codes::WGSL_TYPE, message);
    for (span, text) in error.spans() {
        diagnostic = label(diagnostic, file, composed, *span, text);
    }
    if types_differ && composed.text.contains("alias ") {
        diagnostic = diagnostic
            .note("naga takes an array of an alias for another type than an array of what the alias stands for: spell both alike");
    }
    diagnostic.into()
}

/// An error and what caused it, in one line.
pub fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(cause) = source {
        text.push_str(": ");
        text.push_str(&cause.to_string());
        source = cause.source();
    }
    text
}

fn words(unit: &Unit) -> HashSet<String> {
    let mut words = HashSet::default();
    for item in &unit.scan.items {
        words.extend(item.locals.iter().cloned());
        let text = &unit.file.text;
        let mentioned = item.references.iter().map(|r| &text[unit.scan.tokens[r.token].range()]);
        words.extend(mentioned.filter(|w| unit.origin(w).is_none()).map(str::to_owned));
    }
    words
}

fn results(function: &naga::Function) -> Vec<(Handle<naga::Expression>, Range<usize>)> {
    use naga::Expression as E;
    let is_result = |e: &E| {
        matches!(
            e,
            E::CallResult(_)
                | E::AtomicResult { .. }
                | E::WorkGroupUniformLoadResult { .. }
                | E::RayQueryProceedResult
                | E::SubgroupBallotResult
                | E::SubgroupOperationResult { .. }
        )
    };
    let found = function.expressions.iter().filter(|(_, e)| is_result(e));
    found
        .map(|(h, _)| (h, function.expressions.get_span(h).to_range().unwrap_or_default()))
        .collect()
}

fn named_structs(ir: &naga::Module, composed: &Composed) -> HashMap<Handle<naga::Type>, StructKey> {
    let mut structs = HashMap::default();
    for (handle, ty) in ir.types.iter() {
        let (TypeInner::Struct { .. }, Some(name)) = (&ty.inner, &ty.name) else {
            continue;
        };
        let interface = match composed.names.get(name) {
            Some(Origin::Interface(category)) => Some(category.clone()),
            Some(_) => None,
            // Predeclared by the language.
            None => continue,
        };
        structs.insert(
            handle,
            StructKey {
                interface,
                name: name.clone(),
            },
        );
    }
    structs
}

fn fixed_structs(unit: &Unit) -> HashSet<StructKey> {
    let mut fixed = HashSet::default();
    let shared = unit
        .ir
        .global_variables
        .iter()
        .filter(|(_, g)| g.space != naga::AddressSpace::Private)
        .map(|(_, g)| g.ty);
    // A constant of a struct type is composed at module scope, where nothing is trimmed.
    let composed = unit.ir.global_expressions.iter().filter_map(|(_, e)| match *e {
        naga::Expression::Compose { ty, .. } | naga::Expression::ZeroValue(ty) => Some(ty),
        _ => None,
    });
    for ty in shared.chain(composed) {
        collect_structs(unit, ty, &mut fixed);
    }
    fixed
}

fn collect_structs(unit: &Unit, ty: Handle<naga::Type>, into: &mut HashSet<StructKey>) {
    match &unit.ir.types[ty].inner {
        TypeInner::Struct { members, .. } => {
            if let Some(key) = unit.structs.get(&ty) {
                into.insert(key.clone());
            }
            for member in members {
                collect_structs(unit, member.ty, into);
            }
        }
        TypeInner::Array { base, .. } | TypeInner::BindingArray { base, .. } | TypeInner::Pointer { base, .. } => {
            collect_structs(unit, *base, into);
        }
        _ => {}
    }
}

/// Which functions depend on where the module stands in a tree. Callees precede callers in the arena.
fn dependents(unit: &Unit) -> Vec<bool> {
    let mut dependent: Vec<bool> = Vec::with_capacity(unit.ir.functions.len());
    for (_, function) in unit.ir.functions.iter() {
        let stub = !matches!(
            function.name.as_deref().and_then(|n| unit.origin(n)),
            Some(Origin::Own | Origin::Interface(_))
        );
        let touches = function.expressions.iter().any(|(_, e)| match e {
            naga::Expression::GlobalVariable(_) | naga::Expression::Override(_) => true,
            naga::Expression::Constant(c) => constant_is_param(unit, *c),
            naga::Expression::CallResult(f) => dependent[f.index()],
            _ => false,
        });
        dependent.push(stub || touches || calls_dependent(&function.body, &dependent));
    }
    dependent
}

fn constant_is_param(unit: &Unit, constant: Handle<naga::Constant>) -> bool {
    let name = unit.ir.constants[constant].name.as_deref();
    matches!(name.and_then(|n| unit.origin(n)), Some(Origin::Param(_)))
}

fn calls_dependent(block: &naga::Block, dependent: &[bool]) -> bool {
    block.iter().any(|statement| match statement {
        naga::Statement::Call { function, .. } => dependent[function.index()],
        naga::Statement::Block(inner) => calls_dependent(inner, dependent),
        naga::Statement::If { accept, reject, .. } => calls_dependent(accept, dependent) || calls_dependent(reject, dependent),
        naga::Statement::Switch { cases, .. } => cases.iter().any(|c| calls_dependent(&c.body, dependent)),
        naga::Statement::Loop { body, continuing, .. } => calls_dependent(body, dependent) || calls_dependent(continuing, dependent),
        _ => false,
    })
}
