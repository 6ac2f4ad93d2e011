//! Rules for modules and interfaces beyond WGSL's own.

use std::ops::Range;
use std::sync::Arc;

use naga::{Handle, TypeInner};

use super::compose::{Composed, Interface, Needs, Origin, param_uses};
use super::lex::Kind;
use super::scan::{Item, ItemKind, Scan};
use super::unit::Unit;
use crate::diagnostics::{Diagnostic, Report, SourceFile, codes, nearest};

/// What can be said of the text before naga sees it.
pub fn before_parsing(file: &Arc<SourceFile>, scan: &Scan, interface: bool) -> Result<(), Report> {
    for item in &scan.items {
        if interface && item.kind == ItemKind::Constant && !item.typed {
            return Err(Diagnostic::new(
                codes::UNTYPED_CONSTANT,
                format!("the interface's constant `{}` has no type", item.name),
            )
            .at(file, item.name_span.clone(), "a type is missing behind this name")
            .note("an untyped constant is folded away where it is parsed, so modules could not share it: write `const NAME: f32 = ...`")
            .into());
        }
        if item.kind == ItemKind::Variable {
            explicit_binding(file, scan, item)?;
        }
    }
    Ok(())
}

/// Every bracket that the text opens it also closes: else the parser would read on into what the linker adds.
pub fn brackets(file: &Arc<SourceFile>, scan: &Scan) -> Result<(), Report> {
    let mut open = Vec::new();
    for token in &scan.tokens {
        match token.kind {
            Kind::Mark(mark @ (b'{' | b'(' | b'[')) => open.push((mark, token.range())),
            Kind::Mark(mark @ (b'}' | b')' | b']')) => {
                let partner = match mark {
                    b'}' => b'{',
                    b')' => b'(',
                    _ => b'[',
                };
                // Of brackets that do not fit together the parser tells more.
                if open.pop().is_none_or(|(found, _)| found != partner) {
                    return Ok(());
                }
            }
            _ => {}
        }
    }
    let Some((_, first)) = open.into_iter().next() else { return Ok(()) };
    let end = file.text.trim_end().len();
    Err(Diagnostic::new(codes::WGSL_SYNTAX, "a bracket is never closed")
        .at(file, first, "opened here")
        .at(file, end..end, "the file ends here")
        .into())
}

/// What is read of `params` is declared.
pub fn known_params(file: &Arc<SourceFile>, scan: &Scan, composed: &Composed, needs: &Needs) -> Result<(), Report> {
    let Some(manifest) = needs
        .manifest
        .as_ref()
        .filter(|_| composed.names.get("params") != Some(&Origin::Own))
    else {
        return Ok(());
    };
    for (name, span) in param_uses(&file.text, scan) {
        if needs.uniforms.contains_key(name) || needs.overrides.contains_key(name) || needs.constants.contains_key(name) {
            continue;
        }
        let known = needs.uniforms.keys().chain(needs.overrides.keys()).chain(needs.constants.keys());
        return Err(
            Diagnostic::new(codes::UNKNOWN_PARAM, format!("the module has no parameter `{name}`"))
                .at(file, span, format!("not under `params` of `{}`", manifest.name))
                .suggest(name, "parameters", known.map(String::as_str))
                .into(),
        );
    }
    Ok(())
}

fn explicit_binding(file: &Arc<SourceFile>, scan: &Scan, item: &Item) -> Result<(), Report> {
    for pair in scan.tokens[item.tokens.clone()].windows(2) {
        let word = &file.text[pair[1].range()];
        if pair[0].is(b'@') && matches!(word, "group" | "binding") {
            return Err(
                Diagnostic::new(codes::EXPLICIT_BINDING, format!("`{}` has a fixed @{word}", item.name))
                    .at(file, pair[0].start as usize..pair[1].end as usize, "the linker numbers bindings")
                    .note("leave @group and @binding out; `group` of the resource in module.ron chooses the bind group")
                    .into(),
            );
        }
    }
    Ok(())
}

/// What can be said of the IR.
pub fn after_parsing(unit: &Unit) -> Result<(), Report> {
    for (_, function) in unit.ir.functions.iter() {
        params_by_member(unit, function)?;
    }
    for entry in &unit.ir.entry_points {
        params_by_member(unit, &entry.function)?;
        locations_in_structs(unit, entry)?;
    }
    Ok(())
}

/// The uniform block is laid out by the linker, so no function may see `params` as a whole.
fn params_by_member(unit: &Unit, function: &naga::Function) -> Result<(), Report> {
    let expressions = &function.expressions;
    let is_params = |h: Handle<naga::Expression>| match expressions[h] {
        naga::Expression::GlobalVariable(g) => unit.ir.global_variables[g].name.as_deref() == Some("params") && is_params_origin(unit),
        _ => false,
    };
    for (handle, expression) in expressions.iter() {
        let whole = match *expression {
            naga::Expression::Load { pointer } => is_params(pointer),
            naga::Expression::Access { base, .. } => is_params(base),
            _ => false,
        };
        if whole {
            let mut diagnostic = Diagnostic::new(codes::PARAMS_MISUSED, "`params` is used as a whole");
            if let Some((file, span)) = unit.locate(expressions.get_span(handle)) {
                diagnostic = diagnostic.at(file, span, "only members can be read: `params.name`");
            }
            return Err(diagnostic.into());
        }
    }
    Ok(())
}

fn is_params_origin(unit: &Unit) -> bool {
    matches!(unit.origin("params"), Some(Origin::Params))
}

/// Locations outside a struct could not be trimmed.
fn locations_in_structs(unit: &Unit, entry: &naga::EntryPoint) -> Result<(), Report> {
    let located = |binding: &Option<naga::Binding>| matches!(binding, Some(naga::Binding::Location { .. }));
    let argument = entry.function.arguments.iter().find(|a| located(&a.binding));
    let vertex_result = entry.stage == naga::ShaderStage::Vertex && entry.function.result.as_ref().is_some_and(|r| located(&r.binding));
    if argument.is_none() && !vertex_result {
        return Ok(());
    }
    let item = unit.scan.item(&entry.name);
    let located = |i: &Item| {
        let inputs = i.fields.iter().map(|field| &field.tokens);
        let has = |tokens: &&Range<usize>| {
            unit.scan.tokens[(*tokens).clone()]
                .iter()
                .any(|t| &unit.file.text[t.range()] == "location")
        };
        inputs.chain([&i.result]).find(has).map(|tokens| unit.scan.bytes(tokens))
    };
    let span = item.map_or(0..0, |i| located(i).unwrap_or_else(|| i.name_span.clone()));
    Err(Diagnostic::new(
        codes::ENTRY_POINT_IO,
        format!("the entry point `{}` has a @location outside a struct", entry.name),
    )
    .at(&unit.file, span, "this could not be left out")
    .note("put inputs and outputs with @location into a struct, so that those nobody reads can be left out")
    .into())
}

/// Every function of the interface is there, with the interface's signature; of an optional group all or none.
pub fn against_interface(unit: &Unit, interface: &Interface, declared: &Unit) -> Result<(), Report> {
    let offers = &interface.category.manifest.offers;
    for item in interface
        .scan
        .items
        .iter()
        .filter(|i| i.kind == ItemKind::Function && !offers.contains(&i.name))
    {
        let Some(&expected) = declared.functions.get(&item.name) else {
            continue;
        };
        let group = interface.category.manifest.optional_with(&item.name);
        let must = group.is_none_or(|group| group.iter().any(|name| unit.functions.contains_key(name)));
        require(unit, interface, item, declared, expected, must)?;
    }
    Ok(())
}

/// A function of the unit, if there is one, has the signature that an interface gives; if it must be there, it is.
pub fn require(
    unit: &Unit,
    interface: &Interface,
    item: &Item,
    declared: &Unit,
    expected: Handle<naga::Function>,
    must: bool,
) -> Result<(), Report> {
    let own = unit.scan.item(&item.name).filter(|i| i.kind == ItemKind::Function);
    let (Some(found), Some(own)) = (unit.functions.get(&item.name), own) else {
        if !must {
            return Ok(());
        }
        let mut diagnostic = Diagnostic::new(
            codes::MISSING_FUNCTION,
            format!(
                "the module does not define `{}` of the interface `{}`",
                item.name, interface.category.name
            ),
        )
        .at(&unit.file, 0..0, "in this file")
        .at(&interface.file, header(interface, item), "declared here");
        let own = unit
            .scan
            .items
            .iter()
            .filter(|i| i.kind == ItemKind::Function)
            .map(|i| i.name.as_str());
        if let Some(near) = nearest(&item.name, own) {
            diagnostic = diagnostic.note(format!("`{near}` has nearly this name"));
        }
        return Err(diagnostic
            .note(format!(
                "add `{} {{ ... }}`",
                one_line(&interface.file.text[header(interface, item)])
            ))
            .into());
    };
    if equal_signatures(unit, &unit.ir.functions[*found], declared, &declared.ir.functions[expected]) {
        return Ok(());
    }
    let found_text = one_line(&unit.file.text[own.span.start..body_start(&unit.scan, own)]);
    let expected_text = one_line(&interface.file.text[header(interface, item)]);
    Err(Diagnostic::new(
        codes::SIGNATURE_MISMATCH,
        format!(
            "`{}` has another signature than the interface `{}` says",
            item.name, interface.category.name
        ),
    )
    .at(
        &unit.file,
        own.span.start..body_start(&unit.scan, own),
        format!("found `{found_text}`"),
    )
    .at(&interface.file, header(interface, item), format!("expected `{expected_text}`"))
    .into())
}

fn header(interface: &Interface, item: &Item) -> Range<usize> {
    item.span.start..body_start(&interface.scan, item)
}

fn body_start(scan: &Scan, item: &Item) -> usize {
    // The token before the body's opening brace ends the header.
    let last = item.body.start.checked_sub(1).and_then(|t| scan.tokens.get(t));
    last.map_or(item.span.end, |t| (t.end as usize).max(item.span.start))
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A function that one module offers has the signature with which another calls it.
pub fn same_signature(
    unit: &Unit,
    offered: Handle<naga::Function>,
    caller: &Unit,
    expected: Handle<naga::Function>,
    name: &str,
) -> Result<(), Report> {
    if equal_signatures(unit, &unit.ir.functions[offered], caller, &caller.ir.functions[expected]) {
        return Ok(());
    }
    let place = |unit: &Unit, handle| unit.locate(unit.ir.functions.get_span(handle)).map(|(f, s)| (Arc::clone(f), s));
    let mut diagnostic = Diagnostic::new(
        codes::SIGNATURE_MISMATCH,
        format!("`{name}` is offered with another signature than it is called with"),
    );
    if let Some((file, span)) = place(unit, offered) {
        diagnostic = diagnostic.at(&file, span.start..header_end(&file.text, &span), "found this");
    }
    if let Some((file, span)) = place(caller, expected) {
        diagnostic = diagnostic.at(&file, span.start..header_end(&file.text, &span), "expected this");
    }
    Err(diagnostic.into())
}

/// Where the header of a function's text ends.
pub fn header_end(text: &str, span: &Range<usize>) -> usize {
    text.get(span.clone())
        .and_then(|t| t.find('{'))
        .map_or(span.end, |brace| span.start + text[span.start..span.start + brace].trim_end().len())
}

fn equal_signatures(a_unit: &Unit, a: &naga::Function, b_unit: &Unit, b: &naga::Function) -> bool {
    a.arguments.len() == b.arguments.len()
        && a.arguments
            .iter()
            .zip(&b.arguments)
            .all(|(x, y)| same_type(a_unit, x.ty, b_unit, y.ty))
        && match (&a.result, &b.result) {
            (Some(x), Some(y)) => same_type(a_unit, x.ty, b_unit, y.ty),
            (None, None) => true,
            _ => false,
        }
}

/// Equal types, where structs are equal by who declares them, never by what is in them.
pub fn same_type(a_unit: &Unit, a: Handle<naga::Type>, b_unit: &Unit, b: Handle<naga::Type>) -> bool {
    let (x, y) = (&a_unit.ir.types[a].inner, &b_unit.ir.types[b].inner);
    match (x, y) {
        (TypeInner::Struct { .. }, TypeInner::Struct { .. }) => match (a_unit.structs.get(&a), b_unit.structs.get(&b)) {
            (Some(p), Some(q)) => p.name == q.name && home(a_unit, p) == home(b_unit, q),
            (None, None) => a_unit.ir.types[a].name == b_unit.ir.types[b].name,
            _ => false,
        },
        (
            TypeInner::Array {
                base: p,
                size: s,
                stride: t,
            },
            TypeInner::Array {
                base: q,
                size: u,
                stride: v,
            },
        ) => s == u && t == v && same_type(a_unit, *p, b_unit, *q),
        (TypeInner::Pointer { base: p, space: s }, TypeInner::Pointer { base: q, space: u }) => s == u && same_type(a_unit, *p, b_unit, *q),
        (TypeInner::Array { .. } | TypeInner::Pointer { .. } | TypeInner::Struct { .. }, _) => false,
        _ => x == y,
    }
}

/// The category that declares a struct, also seen from that interface's own unit.
fn home<'u>(unit: &'u Unit, key: &'u super::StructKey) -> Option<&'u str> {
    key.interface.as_deref().or(unit.interface.as_deref())
}
