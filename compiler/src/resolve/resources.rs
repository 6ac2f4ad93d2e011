//! Resources stand in the WGSL and in the manifest.

use naga::AddressSpace;

use super::Place;
use crate::catalog::Module;
use crate::diagnostics::{Diagnostic, Report, codes};
use crate::parse::scan::ItemKind;
use crate::parse::{Origin, Unit};

/// Checks that a module's manifest declares the resources of its text, and no others.
///
/// # Errors
/// One side lacks what the other has.
pub fn check_resources(module: &Module, unit: &Unit) -> Result<(), Report> {
    let declared = &module.manifest.resources;
    for (_, global) in unit.ir.global_variables.iter() {
        let name = global.name.as_deref().unwrap_or_default();
        let bound = !matches!(global.space, AddressSpace::Private | AddressSpace::WorkGroup);
        if bound && unit.origin(name) == Some(&Origin::Own) && !declared.contains_key(name) {
            let span = unit.scan.item(name).map_or(0..0, |i| i.name_span.clone());
            return Err(Diagnostic::new(
                codes::UNDECLARED_RESOURCE,
                format!("the manifest does not declare the resource `{name}`"),
            )
            .at(&unit.file, span, "declared here, but not under `resources`")
            .note("the host must know how to fill it: add it to `resources` of module.ron")
            .into());
        }
    }
    for name in declared.keys() {
        if !unit.scan.item(name).is_some_and(|i| i.kind == ItemKind::Variable) {
            let place = Place::new(&module.source).keys(&["resources", name]);
            return Err(Diagnostic::new(
                codes::UNDECLARED_RESOURCE,
                format!("the WGSL does not declare the resource `{name}`"),
            )
            .at(&module.source, place.key_span(), "declared here")
            .at(&unit.file, 0..0, "but there is no such variable in this file")
            .into());
        }
    }
    Ok(())
}
