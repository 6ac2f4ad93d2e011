//! The text that naga parses for one module: the author's own, then what the linker adds.
//!
//! What a module names but does not declare (its interface's structs, the functions of its slots, its parameters) is
//! appended after its own text, so that every line of the author stays where it is. WGSL does not care for order.

use rustc_hash::FxHashMap as HashMap;
use std::fmt::Write as _;
use std::ops::Range;
use std::sync::Arc;

use indexmap::{IndexMap, IndexSet};
use naga::valid::Capabilities;

use super::lex::Kind;
use super::scan::{ItemKind, Scan};
use crate::catalog::Category;
use crate::diagnostics::codes;
use crate::diagnostics::{Diagnostic, Report, SourceFile};
use crate::manifest::{Locator, Param, ParamType, Step, Typed};

/// A category's interface, scanned.
#[derive(Debug)]
pub struct Interface {
    /// The category.
    pub category: Arc<Category>,
    /// `interface.wgsl`.
    pub file: Arc<SourceFile>,
    /// Its items.
    pub scan: Scan,
}

/// What a name of a parsed unit stands for.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Origin {
    /// Declared by the author in this text.
    Own,
    /// Declared in another category's interface under the same name.
    Interface(String),
    /// A function of a slot, under the interface's name.
    Slot {
        /// The slot.
        slot: String,
        /// The function.
        function: String,
    },
    /// A function that the owner of the slot offers.
    Offered {
        /// Category of the interface that declares it.
        interface: String,
        /// The function.
        function: String,
    },
    /// The uniform parameters: the variable `params` and its struct.
    Params,
    /// A parameter that is a constant or an override here.
    Param(String),
    /// The variable `instances` and its struct.
    Instances,
}

/// A slot as far as composing needs it.
#[derive(Clone, Debug)]
pub struct SlotNeed {
    /// Its name.
    pub name: String,
    /// Category of what fills it.
    pub interface: String,
    /// Before the function names.
    pub prefix: String,
}

/// All that a unit's text depends on beside the author's file.
#[derive(Clone, Debug, Default)]
pub struct Needs {
    /// The category whose functions the text implements; none for an interface's own unit.
    pub implements: Option<String>,
    /// Its slots.
    pub slots: Vec<SlotNeed>,
    /// Interfaces that it uses as they stand.
    pub uses: Vec<String>,
    /// Parameters in a uniform block.
    pub uniforms: IndexMap<String, Param>,
    /// Parameters that are overrides, with their defaults.
    pub overrides: IndexMap<String, (Param, Typed)>,
    /// Parameters that are constants, with their values.
    pub constants: IndexMap<String, Typed>,
    /// Fields of `instances[i]`.
    pub instances: IndexMap<String, Param>,
    /// `module.ron`, where there is one.
    pub manifest: Option<Arc<SourceFile>>,
    /// What the text may ask of a device.
    pub capabilities: Capabilities,
}

/// A stretch of composed text that was copied from a file.
#[derive(Debug)]
pub struct Segment {
    range: Range<usize>,
    file: Arc<SourceFile>,
    start: usize,
}

/// The text to parse and the meaning of its names.
#[derive(Debug)]
pub struct Composed {
    /// The author's text, constants spelled in, then the additions.
    pub text: String,
    /// Length of the author's part.
    pub own: usize,
    /// Every module-scope name.
    pub names: HashMap<String, Origin>,
    segments: Vec<Segment>,
}

impl Composed {
    /// Finds the author's place of a span of the composed text. Text that the linker made has none.
    pub fn locate(&self, span: Range<usize>) -> Option<(&Arc<SourceFile>, Range<usize>)> {
        let segment = self.segments.iter().find(|s| s.range.contains(&span.start))?;
        let start = segment.start + span.start - segment.range.start;
        let end = start + span.end.min(segment.range.end).saturating_sub(span.start);
        // The author's segment also holds the line end that was put behind it.
        let last = segment.file.text.len();
        Some((&segment.file, start.min(last)..end.min(last)))
    }
}

/// WGSL name of a parameter's type.
pub fn wgsl_type(ty: ParamType) -> &'static str {
    match ty {
        ParamType::F32 => "f32",
        ParamType::U32 => "u32",
        ParamType::I32 => "i32",
        ParamType::Bool => "bool",
        ParamType::Vec2 => "vec2f",
        ParamType::Vec3 | ParamType::Color => "vec3f",
        ParamType::Vec4 => "vec4f",
    }
}

/// WGSL name of a value's type.
pub fn typed_wgsl(value: &Typed) -> &'static str {
    match value {
        Typed::F32(_) => "f32",
        Typed::U32(_) => "u32",
        Typed::I32(_) => "i32",
        Typed::Bool(_) => "bool",
        Typed::Vec2(_) => "vec2f",
        Typed::Vec3(_) => "vec3f",
        Typed::Vec4(_) => "vec4f",
    }
}

/// The struct that holds parameters or instance fields.
pub fn fields_struct(name: &str, fields: &IndexMap<String, Param>) -> String {
    let mut text = format!("struct {name} {{\n");
    for (field, param) in fields {
        let unit = if param.unit.is_empty() || param.unit == "1" {
            String::new()
        } else {
            format!(" [{}]", param.unit)
        };
        if !param.doc.is_empty() || !unit.is_empty() {
            // Infallible: writing to a string.
            let _ = writeln!(text, "    /// {}{unit}", param.doc.replace('\n', " "));
        }
        let _ = writeln!(text, "    {field}: {},", wgsl_type(param.ty));
    }
    text.push_str("}\n");
    text
}

struct Composer<'a> {
    out: Composed,
    author: &'a Arc<SourceFile>,
    scan: &'a Scan,
    needs: &'a Needs,
    interfaces: &'a dyn Fn(&str) -> Result<Arc<Interface>, Report>,
}

/// Puts together the text of a unit.
///
/// # Errors
/// An interface does not exist, or two things have one name.
pub fn compose(
    author: &Arc<SourceFile>,
    scan: &Scan,
    needs: &Needs,
    interfaces: &dyn Fn(&str) -> Result<Arc<Interface>, Report>,
) -> Result<Composed, Report> {
    let own = author.text.len();
    let mut out = Composed {
        text: author.text.clone(),
        own,
        names: HashMap::default(),
        segments: Vec::new(),
    };
    out.segments.push(Segment {
        range: 0..own + 1,
        file: Arc::clone(author),
        start: 0,
    });
    out.text.push('\n');
    let mut composer = Composer {
        out,
        author,
        scan,
        needs,
        interfaces,
    };
    composer.own_names()?;
    composer.params(needs)?;
    composer.interfaces(needs)?;
    Ok(composer.out)
}

impl Composer<'_> {
    fn own_names(&mut self) -> Result<(), Report> {
        for item in self.scan.items.iter().filter(|i| !i.name.is_empty()) {
            if self.out.names.insert(item.name.clone(), Origin::Own).is_some() {
                let first = self.scan.item(&item.name).map_or(0..0, |i| i.name_span.clone());
                return Err(
                    Diagnostic::new(codes::DUPLICATE_SYMBOL, format!("`{}` is declared twice", item.name))
                        .at(self.author, item.name_span.clone(), "declared again here")
                        .at(self.author, first, "first declared here")
                        .into(),
                );
            }
        }
        Ok(())
    }

    fn claim(&mut self, name: &str, origin: Origin, what: &str) -> Result<(), Report> {
        if let Some(item) = self.scan.item(name) {
            let generated = matches!(origin, Origin::Params | Origin::Param(_) | Origin::Instances);
            let (code, advice) = match origin {
                _ if generated => (codes::RESERVED_NAME, "give it another name"),
                Origin::Slot { .. } => (
                    codes::DUPLICATE_SYMBOL,
                    "give it another name, or the slot a `prefix` in module.ron",
                ),
                _ => (
                    codes::DUPLICATE_SYMBOL,
                    "give it another name; what an interface declares is there without being declared again",
                ),
            };
            let message = if generated {
                format!("`{name}` is a name that the linker gives to {what}")
            } else {
                format!("`{name}` is declared here and is also {what}")
            };
            let mut diagnostic = Diagnostic::new(code, message).at(self.author, item.name_span.clone(), "declared here");
            if let Some((file, span)) = self.declaration(name, &origin) {
                diagnostic = diagnostic.at(&file, span, "and here");
            }
            return Err(diagnostic.note(advice).into());
        }
        match self.out.names.insert(name.to_owned(), origin.clone()) {
            Some(other) if other != origin => Err(self.clash(name, &other, &origin)),
            _ => Ok(()),
        }
    }

    /// Two things from elsewhere that this text would call by one name.
    fn clash(&self, name: &str, first: &Origin, second: &Origin) -> Report {
        let mut diagnostic = Diagnostic::new(codes::DUPLICATE_SYMBOL, format!("`{name}` would mean two things in this module"));
        if let Some(manifest) = &self.needs.manifest {
            let places = Locator::new(&manifest.text);
            let place = match second {
                Origin::Slot { slot, .. } => places.find_key(&[Step::Key("slots"), Step::Key(slot)]),
                _ => places.find(&[Step::Key("uses")]),
            };
            diagnostic = diagnostic.at(manifest, place.unwrap_or_default(), format!("this brings in a second `{name}`"));
        }
        for origin in [second, first] {
            if let Some((file, span)) = self.declaration(name, origin) {
                diagnostic = diagnostic.at(&file, span, "declared here");
            }
        }
        if diagnostic.labels.is_empty() {
            diagnostic = diagnostic.at(self.author, 0..0, "in what this file is given");
        }
        let advice = match (first, second) {
            (Origin::Slot { .. }, _) | (_, Origin::Slot { .. }) => "give one of the slots a `prefix` in module.ron",
            _ => "use one of the two interfaces only",
        };
        diagnostic.note(advice).into()
    }

    /// Where an interface declares what a name stands for.
    fn declaration(&self, name: &str, origin: &Origin) -> Option<(Arc<SourceFile>, Range<usize>)> {
        let (category, declared) = match origin {
            Origin::Interface(category) => (category, name),
            Origin::Offered { interface, function } => (interface, function.as_str()),
            Origin::Slot { slot, function } => {
                let slot = self.needs.slots.iter().find(|s| s.name == *slot)?;
                (&slot.interface, function.as_str())
            }
            _ => return None,
        };
        let interface = (self.interfaces)(category).ok()?;
        let span = interface.scan.item(declared)?.name_span.clone();
        Some((Arc::clone(&interface.file), span))
    }

    fn params(&mut self, needs: &Needs) -> Result<(), Report> {
        for (name, value) in &needs.constants {
            self.claim(&constant_name(name), Origin::Param(name.clone()), "a parameter's constant")?;
            self.add(&format!(
                "const {}: {} = {};\n",
                constant_name(name),
                typed_wgsl(value),
                value.wgsl()
            ));
        }
        for (name, (param, default)) in &needs.overrides {
            self.claim(&constant_name(name), Origin::Param(name.clone()), "a parameter's override")?;
            self.add(&format!(
                "override {}: {} = {};\n",
                constant_name(name),
                wgsl_type(param.ty),
                default.wgsl()
            ));
        }
        if !needs.uniforms.is_empty() {
            self.claim("Params", Origin::Params, "the struct of the parameters")?;
            self.claim("params", Origin::Params, "the variable of the parameters")?;
            self.add(&fields_struct("Params", &needs.uniforms));
            self.add("var<uniform> params: Params;\n");
        }
        if !needs.instances.is_empty() {
            self.claim("Instance", Origin::Instances, "the struct of the instances")?;
            self.claim("instances", Origin::Instances, "the variable of the instances")?;
            self.add(&fields_struct("Instance", &needs.instances));
            self.add("var<storage, read> instances: array<Instance>;\n");
        }
        self.spell_constants(needs);
        Ok(())
    }

    /// Writes `params_x` over `params.x` where x is no uniform: of the same length, so that nothing moves.
    fn spell_constants(&mut self, needs: &Needs) {
        let text = &self.author.text;
        let mut bytes = std::mem::take(&mut self.out.text).into_bytes();
        for (name, range) in param_uses(text, self.scan) {
            if needs.constants.contains_key(name) || needs.overrides.contains_key(name) {
                let spelled = constant_name(name);
                // A blank or comment inside `params . x` becomes blanks; line ends stay, so that lines stay.
                for (offset, byte) in bytes[range.clone()].iter_mut().enumerate() {
                    *byte = match spelled.as_bytes().get(offset) {
                        Some(&letter) => letter,
                        None if *byte == b'\n' => b'\n',
                        None => b' ',
                    };
                }
            }
        }
        // Only whole runs of characters were overwritten by ASCII, so this cannot fail; an empty text would be caught by the parser.
        self.out.text = String::from_utf8(bytes).unwrap_or_default();
    }

    fn interfaces(&mut self, needs: &Needs) -> Result<(), Report> {
        // Every interface whose structs may be named, nearest first.
        let mut closure: IndexSet<String> = IndexSet::new();
        let mut queue: Vec<String> = needs.implements.iter().cloned().collect();
        queue.extend(needs.slots.iter().map(|s| s.interface.clone()));
        queue.extend(needs.uses.iter().cloned());
        let mut next = 0;
        while next < queue.len() {
            let name = queue[next].clone();
            next += 1;
            if closure.insert(name.clone()) {
                queue.extend((self.interfaces)(&name)?.category.manifest.uses.iter().cloned());
            }
        }
        for name in &closure {
            let interface = (self.interfaces)(name)?;
            for item in &interface.scan.items {
                if item.kind != ItemKind::Function && !item.name.is_empty() {
                    self.claim(
                        &item.name,
                        Origin::Interface(name.clone()),
                        &format!("declared by the interface `{name}`"),
                    )?;
                    self.copy(&interface.file, item.span.clone());
                }
            }
        }
        for slot in &needs.slots {
            self.slot(slot)?;
        }
        self.offered(needs, &closure)?;
        // Functions of used interfaces, unless something nearer has the name.
        for name in &closure {
            if needs.implements.as_ref() == Some(name) {
                continue;
            }
            let interface = (self.interfaces)(name)?;
            for item in interface.scan.items.iter().filter(|i| i.kind == ItemKind::Function) {
                if !self.out.names.contains_key(&item.name) {
                    self.claim(&item.name, Origin::Interface(name.clone()), "a function of an interface")?;
                    self.copy(&interface.file, item.span.clone());
                }
            }
        }
        Ok(())
    }

    fn slot(&mut self, slot: &SlotNeed) -> Result<(), Report> {
        let interface = (self.interfaces)(&slot.interface)?;
        let offers = &interface.category.manifest.offers;
        for item in interface
            .scan
            .items
            .iter()
            .filter(|i| i.kind == ItemKind::Function && !offers.contains(&i.name))
        {
            let origin = Origin::Slot {
                slot: slot.name.clone(),
                function: item.name.clone(),
            };
            self.claim(
                &format!("{}{}", slot.prefix, item.name),
                origin,
                &format!("a function of the slot `{}`", slot.name),
            )?;
            self.copy(&interface.file, item.span.start..item.name_span.start);
            self.add(&slot.prefix);
            self.copy(&interface.file, item.name_span.start..item.span.end);
        }
        Ok(())
    }

    /// Stubs of the functions that this module's own interface says it is offered.
    fn offered(&mut self, needs: &Needs, closure: &IndexSet<String>) -> Result<(), Report> {
        let Some(implements) = &needs.implements else { return Ok(()) };
        let category = (self.interfaces)(implements)?;
        for name in &category.category.manifest.offers {
            if self.out.names.contains_key(name) {
                continue;
            }
            for used in closure {
                let interface = (self.interfaces)(used)?;
                if let Some(item) = interface.scan.item(name).filter(|i| i.kind == ItemKind::Function) {
                    let origin = Origin::Offered {
                        interface: used.clone(),
                        function: name.clone(),
                    };
                    self.claim(name, origin, "a function that the owner of the slot offers")?;
                    self.copy(&interface.file, item.span.clone());
                    break;
                }
            }
        }
        Ok(())
    }

    fn add(&mut self, text: &str) {
        self.out.text.push_str(text);
    }

    fn copy(&mut self, file: &Arc<SourceFile>, span: Range<usize>) {
        let start = self.out.text.len();
        let Some(text) = file.text.get(span.clone()) else { return };
        self.out.text.push_str(text);
        self.out.text.push('\n');
        self.out.segments.push(Segment {
            range: start..start + text.len(),
            file: Arc::clone(file),
            start: span.start,
        });
    }
}

/// Name of a parameter's constant, as long as `params.x`.
pub fn constant_name(param: &str) -> String {
    format!("params_{param}")
}

/// All `params.x` of a text: the parameter's name and the bytes of the three tokens.
pub fn param_uses<'t>(text: &'t str, scan: &Scan) -> Vec<(&'t str, Range<usize>)> {
    let references = scan.items.iter().flat_map(|item| &item.references);
    references.filter_map(|reference| param_use(text, scan, reference.token)).collect()
}

/// The same of one token.
pub fn param_use<'t>(text: &'t str, scan: &Scan, token: usize) -> Option<(&'t str, Range<usize>)> {
    let &[params, dot, name] = scan.tokens.get(token..token + 3)? else {
        return None;
    };
    let is_param = &text[params.range()] == "params" && dot.is(b'.') && name.kind == Kind::Word;
    is_param.then(|| (&text[name.range()], params.start as usize..name.end as usize))
}
