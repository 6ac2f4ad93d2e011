//! `show`: everything that a module says of itself.

use clap::Args;
use indexmap::IndexMap;
use serde_json::json;
use shadewright::compiler::Module;
use shadewright::compiler::manifest::{Among, Arity, Dispatch, Filling, Node, Param, ParamMode, PassDecl, Rule, ViewKind};

use super::failure::Failure;
use super::output::{say, say_json};
use super::text::{columns, value};
use super::{Context, Format};

/// Options of `show`.
#[derive(Args)]
pub struct Options {
    /// Name, or CATEGORY/NAME
    module: String,
}

/// # Errors
/// There is no such module.
pub fn run(context: &Context, options: &Options) -> Result<(), Failure> {
    let module = context.catalog.module(&options.module)?;
    let readme = format!("{}/{}/README.md", module.category, module.name);
    let readme = context
        .library
        .read(&readme)
        .map_err(|why| Failure::message(format!("{readme}: {why}")))?;
    match context.format {
        Format::Json => say_json(&json!({
            "name": module.name,
            "category": module.category,
            "manifest": &module.manifest,
            "readme": readme,
        })),
        Format::Text => {
            let mut text = describe(module);
            if let Some(readme) = readme {
                text.push_str(&format!("\n{}", readme.trim_end()));
            }
            say(&text)
        }
    }
}

fn describe(module: &Module) -> String {
    let manifest = &module.manifest;
    let mut text = format!("{}/{}: {}\n", module.category, module.name, manifest.summary);
    let mut section = |title: &str, body: String| {
        if !body.is_empty() {
            text.push_str(&format!("\n{title}\n{body}"));
        }
    };
    section("Source", list(&manifest.source));
    section("Slots", slots(module));
    section("Parameters", params(&manifest.params));
    section("Fields of each instance", params(&manifest.instances));
    section("Resources", resources(module));
    section("Capabilities", list(&manifest.capabilities));
    section("Rules", list(&manifest.rules.iter().map(rule).collect::<Vec<_>>()));
    section("Properties", list(&manifest.properties));
    section("Passes", passes(&manifest.passes));
    section("Stands for", list(&manifest.represents));
    text
}

fn list(items: &[String]) -> String {
    items.iter().map(|item| format!("  {item}\n")).collect()
}

fn slots(module: &Module) -> String {
    let mut lines = Vec::new();
    for (name, slot) in &module.manifest.slots {
        let arity = match slot.arity {
            Arity::Single => "one",
            Arity::Optional => "at most one",
            Arity::List => "any number of",
        };
        let default = match &slot.default {
            Some(filling) => format!("default {}", filling_text(filling)),
            None => "no default".to_owned(),
        };
        let prefix = if slot.prefix.is_empty() {
            String::new()
        } else {
            format!(" (called {}...)", slot.prefix)
        };
        lines.push(vec![
            name.clone(),
            format!("{arity} {}{prefix}", slot.interface),
            default,
            slot.doc.clone(),
        ]);
        for (foreign, fitting) in &slot.represents {
            lines.push(vec![String::new(), format!("{foreign} -> {fitting}")]);
        }
    }
    columns(&lines, "  ")
}

fn filling_text(filling: &Filling) -> String {
    match filling {
        Filling::One(node) => node_text(node),
        Filling::Many(nodes) => format!("[{}]", nodes.iter().map(node_text).collect::<Vec<_>>().join(", ")),
    }
}

/// A node in the shortest form in which a recipe can say it.
fn node_text(node: &Node) -> String {
    let mut parts = Vec::new();
    if !node.fill.is_empty() {
        let fill: Vec<String> = node.fill.iter().map(|(slot, f)| format!("{slot}: {}", filling_text(f))).collect();
        parts.push(fill.join(", "));
    }
    parts.extend(node.freeze.iter().map(|(name, v)| format!("{name} = {}", value(v))));
    match parts.is_empty() {
        true => node.module.clone(),
        false => format!("{} ({})", node.module, parts.join("; ")),
    }
}

fn params(params: &IndexMap<String, Param>) -> String {
    let mut lines = Vec::new();
    for (name, param) in params {
        let range = match param.range {
            Some((low, high)) => format!("{low} to {high}"),
            None => String::new(),
        };
        let mode = match param.mode {
            ParamMode::Uniform => "uniform",
            ParamMode::Override => "override",
            ParamMode::Constant => "constant",
        };
        let role = param.role.as_ref().map(|role| format!(" [{role}]")).unwrap_or_default();
        lines.push(vec![
            name.clone(),
            format!("{:?}", param.ty).to_lowercase(),
            param.unit.clone(),
            format!("default {}", value(&param.default)),
            range,
            mode.to_owned(),
            format!("{}{role}", param.doc),
        ]);
        for (unit, factor) in &param.also {
            lines.push(vec![String::new(), format!("1 {unit} = {factor} {}", param.unit)]);
        }
    }
    columns(&lines, "  ")
}

fn resources(module: &Module) -> String {
    let lines: Vec<Vec<String>> = module
        .manifest
        .resources
        .iter()
        .map(|(name, resource)| vec![name.clone(), format!("{:?}", resource.kind), resource.doc.clone()])
        .collect();
    columns(&lines, "  ")
}

fn rule(rule: &Rule) -> String {
    let place = |among: &Among| match among {
        Among::Parent => "its parent",
        Among::Children => "its children",
        Among::Tree => "the tree",
    };
    match rule {
        Rule::Requires { tag, among, because } => format!("needs `{tag}` in {}: {because}", place(among)),
        Rule::Excludes { tag, among, because } => format!("takes no `{tag}` in {}: {because}", place(among)),
    }
}

fn passes(passes: &IndexMap<String, PassDecl>) -> String {
    let mut lines = Vec::new();
    for (name, pass) in passes {
        let what = match pass {
            PassDecl::Draw {
                root, view, resolution, ..
            } => {
                let view = match view {
                    ViewKind::Cube => "six views",
                    ViewKind::Projected => "one view",
                };
                format!("draws {} into {view} of `{resolution}` texels", node_text(root))
            }
            PassDecl::Compute { entry, over } => {
                let over = match over {
                    Dispatch::Once => "one workgroup",
                    Dispatch::Frame => "every texel of the frame",
                };
                format!("runs `{entry}` over {over}")
            }
        };
        lines.push(vec![name.clone(), what]);
    }
    columns(&lines, "  ")
}
