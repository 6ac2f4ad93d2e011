//! One text, parsed and checked alone.

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};
use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

use naga::valid::Capabilities;
use naga::{Handle, TypeInner};

use super::checks;
use super::compose::{Composed, Interface, Needs, Origin, compose};
use super::cuts::{Cuts, cuts};
use super::facts::{Facts, facts};
use super::filter::word_hash;
use super::joined::JoinedNames;
use super::mentions::{Mention, mentions};
use super::pure::droppable;
use super::scan::{Item, Scan};
use super::templates::Templates;
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
    /// Categories whose interfaces it names.
    pub interfaces: BTreeSet<String>,
    /// Functions by name.
    pub functions: HashMap<String, Handle<naga::Function>>,
    /// Whether a function depends on more than its text: on slots, parameters, resources. By handle.
    pub dependent: Vec<bool>,
    /// Structs by type handle, where the type is a named struct that somebody declared.
    pub structs: HashMap<Handle<naga::Type>, StructKey>,
    /// Structs whose layout a host or the language sees: never trimmed.
    pub fixed_structs: HashSet<StructKey>,
    /// Linked names of its items.
    pub joined: JoinedNames,
    /// Words that linked names must not be: locals, and words of the language that the text uses.
    pub words: HashSet<String>,
    /// Their hashes.
    pub word_hashes: Vec<u64>,
    /// Facts of the functions: by function handle, then by entry point.
    pub facts: Vec<Facts>,
    /// What has been linked of them: by function handle, then by entry point.
    pub templates: Vec<Templates>,
    /// Their text, as far as it may go: by function handle, then by entry point.
    pub cuts: Vec<Cuts>,
    /// What each item of the author's file mentions.
    pub mentions: Vec<Vec<Mention>>,
    /// Whether a call of a function, if it is pure, may go when nobody reads its result. By handle.
    pub droppable: Vec<bool>,
    /// The variable `params`, where there are uniform parameters.
    pub params: Option<Handle<naga::GlobalVariable>>,
    /// The variable `instances`, where there are fields of instances.
    pub instances: Option<Handle<naga::GlobalVariable>>,
    /// Deepest nesting of blocks, longest chain of calls: how deep a walk over it may recurse.
    pub depth: (usize, usize),
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
    checks::known_params(&file, &scan, &composed, &needs)?;
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
    let needs = Needs {
        capabilities: Capabilities::all(),
        ..Needs::default()
    };
    let composed = compose(&file, &scan, &needs, &|_| {
        Err(Diagnostic::new(codes::UNKNOWN_INTERFACE, "none here").into())
    })?;
    index(file, scan, composed, needs, None)
}

fn index(file: Arc<SourceFile>, scan: Scan, composed: Composed, needs: Needs, interface: Option<String>) -> Result<Unit, Report> {
    let (ir, info) = parse_and_validate(&file, &composed, &needs)?;
    let functions: HashMap<_, _> = ir.functions.iter().filter_map(|(h, f)| Some((f.name.clone()?, h))).collect();
    let structs = named_structs(&ir, &composed);
    let mut unit = Unit {
        fixed_structs: HashSet::default(),
        joined: JoinedNames::default(),
        words: HashSet::default(),
        word_hashes: Vec::new(),
        interfaces: BTreeSet::new(),
        facts: Vec::new(),
        templates: Vec::new(),
        cuts: Vec::new(),
        mentions: Vec::new(),
        droppable: Vec::new(),
        params: None,
        instances: None,
        dependent: Vec::new(),
        depth: depth(&ir),
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
    unit.word_hashes = unit.words.iter().map(|word| word_hash(word)).collect();
    unit.interfaces = interfaces(&unit);
    unit.cuts = functions_of(&unit)
        .map(|(f, item)| item.map_or_else(Cuts::default, |item| cuts(&unit, f, item)))
        .collect();
    unit.params = variable(&unit, "params", &Origin::Params);
    unit.facts = facts(&unit);
    unit.templates.resize_with(unit.facts.len(), Templates::default);
    unit.mentions = unit.scan.items.iter().map(|item| mentions(&unit, item)).collect();
    unit.droppable = unit.ir.functions.iter().map(|(_, f)| droppable(&unit.ir, f)).collect();
    unit.instances = variable(&unit, "instances", &Origin::Instances);
    Ok(unit)
}

/// Compares a module's functions with what its interface says.
///
/// # Errors
/// A function is missing or has another signature.
pub fn check_interface(unit: &Unit, interface: &Interface, interface_unit: &Unit) -> Result<(), Report> {
    checks::against_interface(unit, interface, interface_unit)
}

fn parse_and_validate(
    file: &Arc<SourceFile>,
    composed: &Composed,
    needs: &Needs,
) -> Result<(naga::Module, naga::valid::ModuleInfo), Report> {
    let work = || {
        let mut frontend = naga::front::wgsl::Frontend::new();
        let module = frontend.parse(&composed.text).map_err(|e| parse_error(file, composed, &e))?;
        let place = |span| composed.locate(span);
        super::capabilities::linkable(&module, file, &place)?;
        let allowed = super::capabilities::CORE | needs.capabilities;
        let info = validate(&module, allowed).or_else(|error| {
            // An error of the text itself, whatever a device can do, comes first.
            validate(&module, Capabilities::all()).map_err(|e| validation_error(file, composed, &module, &e))?;
            let missing = super::capabilities::missing(allowed, |set| validate(&module, set).is_ok());
            let diagnostic = super::capabilities::undeclared(missing, needs.manifest.as_ref());
            Err(Report::from(labelled(diagnostic, &error, &|range| composed.locate(range))))
        })?;
        Ok((module, info))
    };
    guarded(codes::UPSTREAM_PANIC, "parsing a module", work).map_err(|d| d.at(file, 0..0, "in this file"))?
}

/// Validates a unit alone; bindings are numbered when linking.
#[allow(clippy::result_large_err, reason = "naga's own error, once a unit")]
fn validate(
    module: &naga::Module,
    capabilities: Capabilities,
) -> Result<naga::valid::ModuleInfo, naga::WithSpan<naga::valid::ValidationError>> {
    let flags = naga::valid::ValidationFlags::all() - naga::valid::ValidationFlags::BINDINGS;
    naga::valid::Validator::new(flags, capabilities).validate(module)
}

fn parse_error(file: &Arc<SourceFile>, composed: &Composed, error: &naga::front::wgsl::ParseError) -> Report {
    // naga has one error type for both; its syntax errors all speak of what the parser expected.
    let syntax =
        (error.message().starts_with("expected") && error.message().contains("found")) || error.message().starts_with("unterminated");
    let code = if syntax { codes::WGSL_SYNTAX } else { codes::WGSL_TYPE };
    let mut diagnostic = Diagnostic::new(code, error.message());
    for (span, text) in error.labels() {
        if let Some((place, range)) = span.to_range().and_then(|range| composed.locate(range)) {
            diagnostic = diagnostic.at(place, range, text);
        }
    }
    if diagnostic.labels.is_empty() {
        diagnostic = diagnostic.at(file, 0..0, "in what is linked to this file");
    }
    for note in error.notes() {
        diagnostic = diagnostic.note(note);
    }
    diagnostic.into()
}

fn validation_error(
    file: &Arc<SourceFile>,
    composed: &Composed,
    module: &naga::Module,
    error: &naga::WithSpan<naga::valid::ValidationError>,
) -> Report {
    let message = chain(error.as_inner());
    let mut diagnostic = Diagnostic::new(codes::WGSL_TYPE, readable(&message, module));
    diagnostic = labelled(diagnostic, error, &|range| composed.locate(range));
    // A call that does not fit: what is called stands elsewhere, often in an interface.
    if let Some(called) = called(&message, module) {
        let place = module
            .functions
            .get_span(called)
            .to_range()
            .and_then(|range| composed.locate(range));
        if let Some((place, span)) = place {
            diagnostic = diagnostic.at(place, header(place, span), "called like this");
        }
    }
    if diagnostic.labels.is_empty() {
        diagnostic = diagnostic.at(file, 0..0, "in what is linked to this file");
    }
    if message.contains("doesn't match the type") && composed.text.contains("alias ") {
        diagnostic = diagnostic
            .note("naga takes an array of an alias for another type than an array of what the alias stands for: spell both alike");
    }
    diagnostic.into()
}

/// Adds the places of naga's error, the innermost first, in words for people.
pub fn labelled<'a>(
    mut diagnostic: Diagnostic,
    error: &naga::WithSpan<naga::valid::ValidationError>,
    locate: &super::capabilities::Locate<'a>,
) -> Diagnostic {
    let mut spans: Vec<_> = error.spans().collect();
    spans.sort_by_key(|(span, _)| span.to_range().map_or(0, |range| range.len()));
    for (span, text) in spans {
        let Some((file, range)) = span.to_range().and_then(locate) else {
            continue;
        };
        let kind = text.strip_prefix("naga::ir::").and_then(|t| t.split(' ').next());
        diagnostic = match kind {
            Some("Function") => diagnostic.at(file, header(file, range), "in this function"),
            Some(kind) => diagnostic.at(file, range, format!("this {}", in_words(kind))),
            None => diagnostic.at(file, range, text.as_str()),
        };
    }
    diagnostic
}

/// `GlobalVariable` as `global variable`.
fn in_words(kind: &str) -> String {
    let mut words = String::new();
    for c in kind.chars() {
        if c.is_ascii_uppercase() && !words.is_empty() {
            words.push(' ');
        }
        words.push(c.to_ascii_lowercase());
    }
    words
}

/// A function's text up to its body.
fn header(file: &SourceFile, span: Range<usize>) -> Range<usize> {
    // The span may end early, where a slot's prefix was written into the name.
    span.start..super::checks::header_end(&file.text, &(span.start..file.text.len()))
}

/// The function that naga's message about a call means.
fn called(message: &str, module: &naga::Module) -> Option<Handle<naga::Function>> {
    let number: usize = message.split_once("Call to [")?.1.split_once(']')?.0.parse().ok()?;
    module.functions.iter().nth(number).map(|(handle, _)| handle)
}

/// naga's message without the numbers that it has for functions, types and expressions.
pub fn readable(message: &str, module: &naga::Module) -> String {
    let name = called(message, module).and_then(|f| module.functions[f].name.as_deref());
    let mut text = String::new();
    let mut rest = message;
    while let Some(open) = rest.find('[') {
        let Some(close) = rest[open..].find(']').map(|c| open + c) else {
            break;
        };
        let number = &rest[open + 1..close];
        if number.is_empty() || !number.bytes().all(|b| b.is_ascii_digit()) {
            text.push_str(&rest[..=open]);
            rest = &rest[open + 1..];
            continue;
        }
        let before = &rest[..open];
        match (name, before.strip_suffix("Some(")) {
            (Some(name), _) if before.ends_with("Call to ") => {
                text.push_str(before);
                text.push_str(&format!("`{name}`"));
                rest = &rest[close + 1..];
            }
            (_, Some(before)) if rest[close + 1..].starts_with(')') => {
                text.push_str(before.trim_end());
                rest = &rest[close + 2..];
            }
            _ => {
                text.push_str(before.trim_end());
                rest = &rest[close + 1..];
            }
        }
    }
    // Of what has no name naga writes an empty one.
    (text + rest).replace(" '' is", " is")
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

fn interfaces(unit: &Unit) -> BTreeSet<String> {
    let named = unit.composed.names.values().filter_map(|origin| match origin {
        Origin::Interface(category) | Origin::Offered { interface: category, .. } => Some(category),
        _ => None,
    });
    let slots = unit.needs.slots.iter().map(|slot| &slot.interface);
    named.chain(slots).chain(&unit.needs.implements).cloned().collect()
}

/// Functions by handle, then entry points, with their items in the author's text.
fn functions_of(unit: &Unit) -> impl Iterator<Item = (&naga::Function, Option<&Item>)> {
    let functions = unit.ir.functions.iter();
    let functions = functions.map(|(_, f)| (f, f.name.as_deref().unwrap_or_default()));
    let entries = unit.ir.entry_points.iter().map(|e| (&e.function, e.name.as_str()));
    functions.chain(entries).map(|(f, name)| (f, unit.scan.item(name)))
}

fn variable(unit: &Unit, name: &str, origin: &Origin) -> Option<Handle<naga::GlobalVariable>> {
    let mut variables = unit.ir.global_variables.iter();
    let (handle, _) = variables.find(|(_, global)| global.name.as_deref() == Some(name))?;
    (unit.origin(name) == Some(origin)).then_some(handle)
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
    for ty in shared {
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

/// Deepest nesting of blocks and longest chain of calls. Callees precede callers in the arena.
fn depth(ir: &naga::Module) -> (usize, usize) {
    let mut chains: Vec<usize> = Vec::with_capacity(ir.functions.len());
    let mut deepest = (0, 0);
    let entries = ir.entry_points.iter().map(|e| &e.function);
    for function in ir.functions.iter().map(|(_, f)| f).chain(entries) {
        let mut chain = 0;
        let blocks = block_depth(&function.body, &mut |callee| chain = chain.max(chains[callee.index()]));
        chains.push(chain + 1);
        deepest = (deepest.0.max(blocks), deepest.1.max(chain + 1));
    }
    deepest
}

fn block_depth(block: &naga::Block, called: &mut dyn FnMut(Handle<naga::Function>)) -> usize {
    let mut deepest = 0;
    for statement in block {
        let inner = match statement {
            naga::Statement::Call { function, .. } => {
                called(*function);
                0
            }
            naga::Statement::Block(inner) => block_depth(inner, called),
            naga::Statement::If { accept, reject, .. } => block_depth(accept, called).max(block_depth(reject, called)),
            naga::Statement::Switch { cases, .. } => cases.iter().map(|c| block_depth(&c.body, called)).max().unwrap_or(0),
            naga::Statement::Loop { body, continuing, .. } => block_depth(body, called).max(block_depth(continuing, called)),
            _ => 0,
        };
        deepest = deepest.max(inner + 1);
    }
    deepest
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
