//! What manifests say of each other and of the WGSL beside them.

use std::sync::Arc;

use naga::{ScalarKind, TypeInner};

use crate::catalog::{Catalog, Category, Module};
use crate::diagnostics::{Diagnostic, Report, SourceFile, codes};
use crate::manifest::{Filling, Node, PassDecl, Value};
use crate::parse::scan::ItemKind;
use crate::parse::{Interface, Unit};
use crate::resolve::{Place, Way, resolve_root};

/// Interfaces that the manifests name, but the library does not have.
pub fn unknown_interfaces(catalog: &Catalog) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let mut look = |file: &Arc<SourceFile>, name: &str, path: &[Way]| {
        if catalog.category(name).is_none() {
            let place = path.iter().cloned().fold(Place::new(file), |place, way| place.then(way));
            found.push(
                Diagnostic::new(codes::UNKNOWN_INTERFACE, format!("there is no category `{name}`"))
                    .at(file, place.span(), "named here")
                    .suggest(name, "categories", catalog.categories().map(|c| c.name.as_str())),
            );
        }
    };
    let key = |name: &str| Way::Key(name.to_owned());
    for category in catalog.categories() {
        for (index, name) in category.manifest.uses.iter().enumerate() {
            look(&category.source, name, &[key("uses"), Way::Index(index)]);
        }
    }
    for module in catalog.modules() {
        for (index, name) in module.manifest.uses.iter().enumerate() {
            look(&module.source, name, &[key("uses"), Way::Index(index)]);
        }
        for (slot, declared) in &module.manifest.slots {
            look(&module.source, &declared.interface, &[key("slots"), key(slot), key("interface")]);
        }
    }
    found
}

/// Functions that `category.ron` names are in its interface; those it offers may be in an interface that it uses.
///
/// # Errors
/// One is not.
pub fn named_functions(interface: &Interface, used: &[Interface]) -> Result<(), Report> {
    let category = &interface.category;
    let functions = |i: &Interface| {
        let all = i.scan.items.iter().filter(|item| item.kind == ItemKind::Function);
        all.map(|item| item.name.clone()).collect::<Vec<_>>()
    };
    let own = functions(interface);
    let any: Vec<String> = own.iter().cloned().chain(used.iter().flat_map(functions)).collect();
    let place = Place::new(&category.source);
    let combined = category
        .manifest
        .combine
        .keys()
        .map(|name| (name, &own, place.keys(&["combine", name]).key_span()));
    let offered = category.manifest.offers.iter().enumerate();
    let offered = offered.map(|(at, name)| (name, &any, place.keys(&["offers"]).then(Way::Index(at)).span()));
    let optional = category.manifest.optional.iter().enumerate();
    let optional = optional.flat_map(|(at, group)| group.iter().enumerate().map(move |(within, name)| (at, within, name)));
    let optional = optional.map(|(at, within, name)| {
        let place = place.keys(&["optional"]).then(Way::Index(at)).then(Way::Index(within));
        (name, &own, place.span())
    });
    for (name, known, span) in combined.chain(offered).chain(optional) {
        if !known.contains(name) {
            return Err(Diagnostic::new(
                codes::UNKNOWN_FUNCTION,
                format!("the interface `{}` has no function `{name}`", category.name),
            )
            .at(&category.source, span, "named here")
            .suggest(name, "functions", known.iter().map(String::as_str))
            .into());
        }
    }
    Ok(())
}

/// Defaults of struct members and resources that `category.ron` declares fit the interface's WGSL.
///
/// # Errors
/// A struct, member or variable is not there, or a default is of another type.
pub fn interface_unit(category: &Category, unit: &Unit) -> Result<(), Report> {
    for (name, members) in &category.manifest.defaults {
        let place = Place::new(&category.source).keys(&["defaults", name]);
        let declared = unit.ir.types.iter().find_map(|(handle, ty)| match &ty.inner {
            TypeInner::Struct { members, .. } if ty.name.as_deref() == Some(name) => unit.structs.contains_key(&handle).then_some(members),
            _ => None,
        });
        let Some(declared) = declared else {
            let structs = unit.structs.values().map(|key| key.name.as_str());
            let mut known: Vec<&str> = structs.collect();
            known.sort_unstable();
            let message = format!("the interface `{}` has no struct `{name}`", category.name);
            let diagnostic = Diagnostic::new(codes::BAD_INTERFACE_DEFAULT, message);
            return Err(diagnostic
                .at(&place.file, place.key_span(), "no such struct")
                .suggest(name, "structs", known)
                .into());
        };
        for (member, value) in members {
            let place = place.keys(&[member]);
            let found = declared.iter().find(|m| m.name.as_deref() == Some(member));
            let Some(found) = found else {
                let known = declared.iter().filter_map(|m| m.name.as_deref());
                let diagnostic = Diagnostic::new(codes::BAD_INTERFACE_DEFAULT, format!("`{name}` has no member `{member}`"));
                let diagnostic = diagnostic.at(&place.file, place.key_span(), "no such member");
                return Err(diagnostic.suggest(member, "members", known).into());
            };
            if let Some(expected) = mismatch(&unit.ir.types[found.ty].inner, value) {
                let diagnostic = Diagnostic::new(
                    codes::BAD_INTERFACE_DEFAULT,
                    format!("the default of `{name}.{member}` is of another type"),
                );
                return Err(diagnostic.at(&place.file, place.span(), format!("expected {expected}")).into());
            }
        }
    }
    for name in category.manifest.resources.keys() {
        if !unit.scan.item(name).is_some_and(|i| i.kind == ItemKind::Variable) {
            let place = Place::new(&category.source).keys(&["resources", name]);
            return Err(Diagnostic::new(
                codes::UNDECLARED_RESOURCE,
                format!("the interface does not declare the resource `{name}`"),
            )
            .at(&place.file, place.key_span(), "declared here")
            .at(&unit.file, 0..0, "but there is no such variable in this file")
            .into());
        }
    }
    Ok(())
}

/// What a type takes where the value is something else.
fn mismatch(ty: &TypeInner, value: &Value) -> Option<String> {
    match (ty, value) {
        (TypeInner::Scalar(scalar), _) => match (scalar.kind, value) {
            (ScalarKind::Bool, Value::Bool(_)) => None,
            (ScalarKind::Bool, _) => Some("true or false".to_owned()),
            (_, Value::Number(_)) => None,
            _ => Some("a number".to_owned()),
        },
        (TypeInner::Vector { size, .. }, Value::List(list)) if list.len() == *size as usize => None,
        (TypeInner::Vector { size, .. }, _) => Some(format!("{} numbers in parentheses", *size as usize)),
        _ => Some("no default: only numbers, booleans and vectors have one".to_owned()),
    }
}

/// What a module's manifest says can be resolved: the defaults of its slots, the roots and entry points of its passes.
///
/// # Errors
/// It cannot, whatever a recipe says.
pub fn module_references(catalog: &Catalog, module: &Module, unit: &Unit) -> Result<(), Report> {
    let here = Place::new(&module.source);
    for (name, slot) in &module.manifest.slots {
        let place = here.keys(&["slots", name, "default"]);
        match &slot.default {
            Some(Filling::One(node)) => subtree(catalog, node, Some((&slot.interface, name)), &place)?,
            Some(Filling::Many(nodes)) => {
                for (index, node) in nodes.iter().enumerate() {
                    subtree(catalog, node, Some((&slot.interface, name)), &place.then(Way::Index(index)))?;
                }
            }
            None => {}
        }
    }
    for (name, pass) in &module.manifest.passes {
        match pass {
            PassDecl::Draw { root, .. } => subtree(catalog, root, None, &here.keys(&["passes", name, "root"]))?,
            PassDecl::Compute { entry, .. } => compute_entry(module, unit, name, entry)?,
        }
    }
    Ok(())
}

/// A tree that stands in a manifest. A recipe may fill what it leaves open, and stands around it.
fn subtree(catalog: &Catalog, node: &Node, slot: Option<(&str, &str)>, place: &Place) -> Result<(), Report> {
    let module = catalog.module_at(&node.module, slot, || place.clone())?;
    match resolve_root(catalog, module, node, place.clone()) {
        Err(report) if !matches!(report.diagnostics[0].code, codes::MISSING_FILLING | codes::RULE_BROKEN) => Err(report),
        _ => Ok(()),
    }
}

/// The entry point that a compute pass runs is there.
///
/// # Errors
/// It is not.
pub fn compute_entry(module: &Module, unit: &Unit, pass: &str, entry: &str) -> Result<(), Report> {
    let compute = || unit.ir.entry_points.iter().filter(|e| e.stage == naga::ShaderStage::Compute);
    if compute().any(|e| e.name == entry) {
        return Ok(());
    }
    let place = Place::new(&module.source).keys(&["passes", pass, "entry"]);
    let known: Vec<&str> = compute().map(|e| e.name.as_str()).collect();
    Err(Diagnostic::new(
        codes::BAD_DISPATCH,
        format!("`{}` has no compute entry point `{entry}`", module.name),
    )
    .at(&module.source, place.span(), "named here")
    .at(&unit.file, 0..0, "not in this file")
    .suggest(entry, "compute entry points", known)
    .into())
}
