//! Resources stand in the WGSL and in the manifest.

use naga::{AddressSpace, GlobalVariable, Handle, StorageAccess};

use super::Place;
use crate::catalog::Module;
use crate::data::{fits, shape};
use crate::diagnostics::{Diagnostic, Report, codes};
use crate::manifest::ResourceKind;
use crate::parse::scan::ItemKind;
use crate::parse::{Origin, Unit};
use crate::reflect::Layouts;

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
    for (handle, global) in unit.ir.global_variables.iter() {
        let name = global.name.as_deref().unwrap_or_default();
        if unit.origin(name) == Some(&Origin::Own)
            && let Some(index) = declared.get_index_of(name)
        {
            check_data(module, index, unit, handle)?;
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

/// Checks that a resource of kind `Data`, by its number in the manifest, is a buffer that a file of numbers can fill, and that the module's own
/// file fills it. Others are passed over.
///
/// # Errors
/// The variable has another type, or the file another size.
pub fn check_data(module: &Module, index: usize, unit: &Unit, handle: Handle<GlobalVariable>) -> Result<(), Report> {
    let Some((name, resource)) = module.manifest.resources.get_index(index) else {
        return Ok(());
    };
    let ResourceKind::Data { file, format } = &resource.kind else {
        return Ok(());
    };
    let global = &unit.ir.global_variables[handle];
    let own = global.name.as_deref().unwrap_or_default();
    let span = unit.scan.item(own).map_or(0..0, |item| item.name_span.clone());
    let layout = Layouts::new(&unit.ir).ok().map(|layouts| layouts.of(global.ty));
    let read_only = matches!(global.space, AddressSpace::Storage { access } if !access.contains(StorageAccess::STORE));
    let Some(layout) = layout.filter(|layout| read_only && shape(layout).is_some()) else {
        return Err(
            Diagnostic::new(codes::BAD_DATA_TYPE, format!("`{name}` cannot be filled with numbers from a file"))
                .at(&unit.file, span, "no `var<storage>` that is an array of `f32`, `vec2f` or `vec4f`")
                .into(),
        );
    };
    let (Some(file), None, Some(bytes)) = (file, format, module.data.get(name)) else {
        return Ok(());
    };
    if let Err(why) = fits(&layout, bytes.len() / 4) {
        let place = Place::new(&module.source).keys(&["resources", name, "kind", "file"]);
        return Err(Diagnostic::new(codes::BAD_DATA, format!("`{file}` does not fill `{name}`"))
            .at(&module.source, place.span(), why)
            .at(&unit.file, span, "the buffer")
            .into());
    }
    Ok(())
}
