//! `render --needs`: what a scene must have before its first frame.

use std::collections::HashSet;
use std::fmt::Write;
use std::sync::Arc;

use shadewright::compiler::Catalog;
use shadewright::runtime::frame::{Frame, Need, PipelineState, Stage, needs};

use super::Format;
use super::failure::Failure;
use super::output;

/// Lists what a frame needs.
///
/// # Errors
/// A recipe is wrong, or nobody reads any more.
pub fn say(catalog: &Arc<Catalog>, frame: &Frame, format: Format) -> Result<(), Failure> {
    let needs = needs(catalog, frame)?;
    match format {
        Format::Json => output::say_json(&needs),
        Format::Text => output::say(&text(&needs)?),
    }
}

fn text(needs: &[Need]) -> Result<String, Failure> {
    let mut text = String::new();
    for need in needs {
        let stage = match need.stage {
            Stage::ShadowMap => "shadow map",
            Stage::Before => "before",
            Stage::Scene => "scene",
            Stage::After => "after",
            Stage::Display => "display",
        };
        let later = if need.in_view { "" } else { ", out of view" };
        let recipe = ron::to_string(&need.recipe).map_err(|error| Failure::message(format!("a recipe has no RON form: {error}")))?;
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{stage:<10}  {:032x}  {}  {}{later}", need.hash, need.pass, state(need));
        let _ = writeln!(text, "    {}\n    {recipe}", need.modules.join(" "));
    }
    let pipelines: HashSet<_> = needs.iter().map(|n| (n.hash, &n.state, format!("{:?}", n.constants))).collect();
    let programs: HashSet<_> = needs.iter().map(|n| n.hash).collect();
    let _ = write!(
        text,
        "{} needs, {} programs, {} pipelines",
        needs.len(),
        programs.len(),
        pipelines.len()
    );
    Ok(text)
}

fn state(need: &Need) -> String {
    let mut words = Vec::new();
    match &need.state {
        PipelineState::Compute(entry) => words.push(format!("compute {entry}")),
        PipelineState::Render(state) => {
            words.push("render".to_owned());
            words.extend(
                [state.color, state.depth]
                    .into_iter()
                    .flatten()
                    .map(|f| format!("{f:?}").to_lowercase()),
            );
            let flags = [(state.blend, "blend"), (state.cull_back, "cull_back"), (state.mirrored, "mirrored")];
            words.extend(flags.iter().filter(|(set, _)| *set).map(|(_, name)| (*name).to_owned()));
        }
    }
    words.extend(need.constants.iter().map(|(name, value)| format!("{name}={value}")));
    words.join(" ")
}
