//! Small libraries and the device that the unit tests of this crate share.

use std::sync::Arc;

use shadewright_compiler::catalog::Catalog;
use shadewright_compiler::program::{Program, Recipe};
use shadewright_compiler::reflect::{Layout, Layouts};
use shadewright_compiler::{Library, naga};

use super::Gpu;

/// One device for all tests of the binary: opening one costs more than most tests.
pub fn gpu() -> Gpu {
    static GPU: std::sync::OnceLock<Gpu> = std::sync::OnceLock::new();
    GPU.get_or_init(|| Gpu::headless().unwrap()).clone()
}

/// Layout of a global variable's type.
pub fn layout_of(source: &str, global: &str) -> Layout {
    let module = naga::front::wgsl::parse_str(source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    let (_, var) = module
        .global_variables
        .iter()
        .find(|(_, v)| v.name.as_deref() == Some(global))
        .unwrap();
    Layouts::new(&module).unwrap().of(var.ty)
}

/// Files by path, from memory.
struct Texts(Vec<(String, String)>);

impl Library for Texts {
    fn folders(&self, folder: &str) -> Vec<String> {
        let prefix = if folder.is_empty() { String::new() } else { format!("{folder}/") };
        let inside = self.0.iter().filter_map(|(path, _)| path.strip_prefix(&prefix)?.split_once('/'));
        let mut folders: Vec<_> = inside.map(|(name, _)| name.to_owned()).collect();
        folders.dedup();
        folders
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        Ok(self.0.iter().find(|(p, _)| p == path).map(|(_, text)| text.clone()))
    }
}

/// The standard library with these files before it.
pub fn catalog(files: &[(&str, &str)]) -> Arc<Catalog> {
    let texts = files.iter().map(|(path, text)| ((*path).to_owned(), (*text).to_owned())).collect();
    let library = shadewright_modules::Overlay(vec![Arc::new(Texts(texts)), shadewright_modules::library()]);
    Arc::new(Catalog::load(Arc::new(library)).unwrap_or_else(|e| panic!("{e}")))
}

/// Links a pass of which the WGSL is given, without slots.
pub fn pass(wgsl: &str) -> Program {
    let catalog = catalog(&[
        ("pass/tested/module.ron", "(summary: \"tested\")"),
        ("pass/tested/tested.wgsl", wgsl),
    ]);
    let recipe = Recipe::parse("test", "\"tested\"").unwrap();
    catalog.compile(&recipe, "main").unwrap_or_else(|e| panic!("{e}"))
}

/// The same device as the tests', made without any optional feature.
pub fn plain_gpu() -> Gpu {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    let adapter = adapters.into_iter().find(|adapter| adapter.get_info() == *gpu().info()).unwrap();
    let request = adapter.request_device(&wgpu::DeviceDescriptor {
        required_limits: adapter.limits(),
        ..Default::default()
    });
    let (device, queue) = pollster::block_on(request).unwrap();
    Gpu::from_parts(device, queue)
}
