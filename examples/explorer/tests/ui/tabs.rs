//! The tabs below the picture.

use std::path::Path;

use eframe::egui::{Key, Modifiers, Theme};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use explorer::App;
use explorer::panels::Tab;
use explorer::work::{Language, Made};

use crate::harness::{click, fill, open, open_sized, settle};

/// A tab of an example.
fn tab(example: &str, tab: Tab) -> Harness<'static, App> {
    let mut explorer = open(example);
    explorer.state_mut().tabs.shown = tab;
    settle(&mut explorer);
    explorer
}

/// Looks at what the tab shows.
fn made<T>(explorer: &Harness<App>, look: impl FnOnce(&Made) -> T) -> T {
    let shown = explorer.state().tabs.inspect.shown.clone().unwrap();
    look(shown.made.as_ref().unwrap())
}

/// Number of the first line with this text, from 0.
fn line(explorer: &Harness<App>, text: &str) -> usize {
    made(explorer, |made| {
        let listing = made.listing.as_ref().unwrap();
        let found = listing.find(text);
        found.first().unwrap_or_else(|| panic!("no {text} in {}", listing.text)).0
    })
}

/// Scrolls to a line and clicks it.
fn ask(explorer: &mut Harness<App>, line: usize) {
    explorer.state_mut().tabs.code.scroll_to = Some(line);
    explorer.run_steps(3);
    let name = format!("Line {}: ", line + 1);
    let node = explorer.get_all_by(|node| node.label().is_some_and(|label| label.starts_with(&name)));
    node.last().unwrap().click();
    explorer.run_steps(3);
}

fn has(explorer: &Harness<App>, text: &str) -> bool {
    explorer.query_all_by_label_contains(text).next().is_some()
}

/// Catches code of another material than the one that is selected, and a pass, language or entry point that does nothing.
#[test]
fn code_is_that_of_the_selection() {
    let mut explorer = tab("first", Tab::Code);
    explorer.state_mut().selected = "materials.gold".into();
    settle(&mut explorer);
    assert_eq!(made(&explorer, |made| made.subject().name.clone()), "gold");
    explorer.state_mut().selected = "lights[0]".into();
    settle(&mut explorer);
    assert_eq!(made(&explorer, |made| made.subject().name.clone()), "gold", "a light is in all");
    explorer.state_mut().selected = "post[0]".into();
    settle(&mut explorer);
    assert_eq!(made(&explorer, |made| made.subject().key.clone()), "display");
    click(&mut explorer, "Recipe");
    click(&mut explorer, "Recipe: copper");
    settle(&mut explorer);
    let main = made(&explorer, |made| made.listing.as_ref().unwrap().text.clone());
    assert!(main.contains("fn fragment_main"), "{main}");
    let pass = made(&explorer, |made| made.passes[1].clone());
    click(&mut explorer, "Pass");
    click(&mut explorer, &format!("Pass: {pass}"));
    settle(&mut explorer);
    assert_eq!(made(&explorer, |made| made.view.pass.clone()), pass);
    assert_ne!(made(&explorer, |made| made.listing.as_ref().unwrap().text.clone()), main);
    click(&mut explorer, "Pass");
    click(&mut explorer, "Pass: main");
    // The choices move with the width of their names.
    settle(&mut explorer);
    for language in Language::ALL {
        click(&mut explorer, "Language");
        click(&mut explorer, &format!("Language: {}", language.name()));
        settle(&mut explorer);
        let text = made(&explorer, |made| {
            made.listing.as_ref().unwrap_or_else(|report| panic!("{report}")).text.clone()
        });
        assert!(text.lines().count() > 20, "{text}");
        assert_eq!(text == main, language == Language::Source);
        if language.takes_entry() {
            click(&mut explorer, "Entry point");
            let last = made(&explorer, |made| {
                made.program.reflection().entry_points.last().unwrap().name.clone()
            });
            click(&mut explorer, &format!("Entry point: {last}"));
            settle(&mut explorer);
            assert_ne!(made(&explorer, |made| made.listing.as_ref().unwrap().text.clone()), text);
        }
    }
}

/// Catches a line that leads to the wrong module or file, and a search that goes nowhere or in the wrong direction.
#[test]
fn a_line_says_where_it_comes_from() {
    let mut explorer = tab("first", Tab::Code);
    click(&mut explorer, "copper");
    settle(&mut explorer);
    let at = line(&explorer, "fn ggx_distribution").max(1);
    ask(&mut explorer, at);
    assert_eq!(explorer.state().selected, "materials.copper.brdf.fill.ndf");
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../modules/ndf/ggx/ggx.wgsl");
    let text = std::fs::read_to_string(file).unwrap();
    let declared = text.lines().position(|line| line.starts_with("fn distribution")).unwrap() + 1;
    // The listing has comments that name the file, too.
    let file = format!("ndf/ggx/ggx.wgsl:{declared}");
    assert!(explorer.query_by_label(&file).is_some(), "no {file}");
    assert!(has(&explorer, "fragment_main > "), "the calls");
    let shadow = line(&explorer, "fn cube_map_visible");
    ask(&mut explorer, shadow);
    let selected = explorer.state().selected.clone();
    assert!(selected.starts_with("lights[") && selected.ends_with(".visibility"), "{selected}");
    assert_eq!(
        made(&explorer, |made| made.subject().name.clone()),
        "copper",
        "a light is not of another recipe"
    );
    explorer.key_press_modifiers(Modifiers::COMMAND, Key::G);
    explorer.run_steps(2);
    explorer.get_by_label("Find in the code").type_text("return");
    explorer.run_steps(3);
    let count = explorer.state().tabs.code.found.len();
    assert!(count > 5 && has(&explorer, &format!("1 of {count}")));
    click(&mut explorer, "Next match");
    assert!(has(&explorer, &format!("2 of {count}")));
    click(&mut explorer, "Previous match");
    click(&mut explorer, "Previous match");
    assert!(has(&explorer, &format!("{count} of {count}")));
    let found = explorer.state().tabs.code.found[count - 1].0;
    assert!(has(&explorer, &format!("Line {}: ", found + 1)), "it is scrolled to");
    explorer.key_press(Key::F3);
    explorer.run_steps(2);
    assert!(has(&explorer, &format!("1 of {count}")));
}

/// Catches a copy or a file that is not the whole code, and a failure to save that is not told.
#[test]
fn code_is_copied_and_saved() {
    let mut explorer = tab("sphere", Tab::Code);
    let text = made(&explorer, |made| made.listing.as_ref().unwrap().text.clone());
    explorer.get_by_label("Copy the code").click();
    explorer.step();
    let copied = explorer.output().platform_output.commands.iter().any(|command| match command {
        eframe::egui::OutputCommand::CopyText(copied) => *copied == text,
        _ => false,
    });
    assert!(copied);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("code.wgsl");
    for path in [&file, &folder.path().join("none/code.wgsl")] {
        click(&mut explorer, "Save the code");
        let dialog = explorer.state().dialog.as_ref().unwrap();
        assert!(dialog.path.ends_with("main.wgsl"), "{}", dialog.path);
        fill(&mut explorer, "Path", &path.display().to_string());
        click(&mut explorer, "OK");
    }
    assert_eq!(std::fs::read_to_string(&file).unwrap(), text);
    let message = &explorer.state().message;
    assert!(message.contains("is not saved"), "{message}");
}

/// Catches a choice after which the old code stays, and work for a tab that nobody sees.
#[test]
fn code_follows_choices_while_it_is_seen() {
    let mut explorer = tab("first", Tab::Code);
    click(&mut explorer, "copper");
    click(&mut explorer, "materials.copper.brdf: microfacet");
    click(&mut explorer, "materials.copper.brdf = lambert");
    settle(&mut explorer);
    let version = explorer.state().version;
    assert!(made(&explorer, |made| !made.listing.as_ref().unwrap().text.contains("ggx")));
    explorer.state_mut().tabs.shown = Tab::Timing;
    settle(&mut explorer);
    click(&mut explorer, "Edit");
    click(&mut explorer, "Undo Choose lambert for materials.copper.brdf Ctrl+Z");
    settle(&mut explorer);
    assert!(explorer.state().version > version);
    assert_eq!(explorer.state().tabs.inspect.shown.as_ref().unwrap().version, version);
}

/// Catches members at the wrong place, a parameter whose place is another's, counts that are not there, and a click that selects another module.
#[test]
fn bindings_say_what_a_host_must_know() {
    let mut explorer = tab("first", Tab::Bindings);
    click(&mut explorer, "copper");
    settle(&mut explorer);
    for text in ["host: frame", "vertex, fragment", "uniform"] {
        assert!(has(&explorer, text), "{text}");
    }
    click(&mut explorer, "Table: Parameters");
    settle(&mut explorer);
    assert!(has(&explorer, "group "));
    let node = explorer.get_all_by_label_contains("Select the module of roughness").next().unwrap();
    node.click();
    explorer.run_steps(3);
    assert_eq!(explorer.state().selected, "materials.copper.material");
    click(&mut explorer, "Table: Stages");
    assert!(has(&explorer, "fragment_main"));
    click(&mut explorer, "Table: Cost");
    assert!(has(&explorer, "transcendental") && has(&explorer, "loop in"));
}

/// Catches a module that is not drawn, one that is drawn for each of its places, and a box that selects another row.
#[test]
fn the_graph_has_every_module_once() {
    let mut explorer = tab("first", Tab::Graph);
    click(&mut explorer, "copper");
    settle(&mut explorer);
    let instances = made(&explorer, |made| made.program.reflection().instances.clone());
    for instance in &instances {
        let name = format!("Graph {}: {}", instance.paths.join(", "), instance.module);
        assert!(explorer.query_by_label(&name).is_some(), "{name}");
    }
    assert!(
        instances.iter().any(|instance| instance.paths.len() > 1),
        "nothing is shared in this scene"
    );
    explorer.get_by_label("Graph main.brdf.fresnel: schlick").click();
    explorer.run_steps(3);
    assert_eq!(explorer.state().selected, "materials.copper.brdf.fill.fresnel");
}

/// Catches times that are not remembered, a measurement that stops early, and a button that forgets nothing.
#[test]
fn times_are_measured() {
    let mut explorer = tab("sphere", Tab::Timing);
    let count = |explorer: &Harness<App>| {
        explorer
            .state()
            .tabs
            .timing
            .history()
            .get("GPU")
            .map_or(0, |series| series.values().count())
    };
    assert!(count(&explorer) >= 1);
    assert!(has(&explorer, &explorer.state().gpu.name()));
    assert_eq!(has(&explorer, "software on the CPU"), explorer.state().gpu.is_software());
    click(&mut explorer, "Clear the times");
    assert_eq!(count(&explorer), 0);
    click(&mut explorer, "Measure the picture");
    settle(&mut explorer);
    assert_eq!(count(&explorer), 16);
    for name in ["derive", "link", "pipelines", "record", "choice to picture", "scene (forward)"] {
        assert!(has(&explorer, name), "{name}");
    }
}

/// Catches a problem whose place in the tree is not told, a mark that stays, and a copy that lacks one.
#[test]
fn a_problem_leads_to_its_row() {
    let mut explorer = tab("first", Tab::Problems);
    assert!(has(&explorer, "Nothing is wrong."));
    explorer
        .state_mut()
        .edit("break", |draft| draft.set(&[], "materials.copper.brdf", "\"lambrt\""));
    settle(&mut explorer);
    assert!(has(&explorer, "did you mean `lambert`?"), "{:?}", explorer.state().problems);
    assert!(explorer.query_by_label("Problem in materials.copper.brdf").is_some());
    click(&mut explorer, "Problem 1: select materials.copper.brdf");
    assert_eq!(explorer.state().selected, "materials.copper.brdf");
    explorer.get_by_label("Copy the problems").click();
    explorer.step();
    let copied = explorer.output().platform_output.commands.iter().any(|command| match command {
        eframe::egui::OutputCommand::CopyText(copied) => copied.contains("lambrt"),
        _ => false,
    });
    assert!(copied);
    explorer.state_mut().tabs.shown = Tab::Code;
    settle(&mut explorer);
    assert!(has(&explorer, "It does not link:"));
    explorer.state_mut().document.undo();
    settle(&mut explorer);
    assert!(explorer.query_by_label("Problem in materials.copper.brdf").is_none());
}

/// Catches a rule between modules that is broken but leads nowhere: such errors are told in recipes, which have no text of their own.
#[test]
fn a_problem_of_a_recipe_leads_to_its_row() {
    let mut explorer = tab("first", Tab::Problems);
    explorer.state_mut().edit("break", |draft| {
        draft.set(&[], "materials.copper.brdf", "(module: \"microfacet\", freeze: {\"no\": 1})")
    });
    settle(&mut explorer);
    let app = explorer.state();
    assert!(!app.problems.is_empty());
    assert!(
        app.tabs.problems.concerned.has("materials.copper.brdf"),
        "{:?}",
        app.tabs.problems.concerned
    );
}

/// Takes a picture of a tab.
fn picture(name: &str, shown: Tab, theme: Theme, width: f32) {
    let mut explorer = open_sized("first", [width, 800.0], 1.0);
    explorer.ctx.set_theme(theme);
    explorer.state_mut().tabs.shown = shown;
    explorer.state_mut().selected = "materials.copper.brdf".into();
    settle(&mut explorer);
    if shown == Tab::Code {
        let at = line(&explorer, "fn ggx_distribution");
        ask(&mut explorer, at + 3);
    }
    settle(&mut explorer);
    explorer.snapshot(name);
}

/// Catches columns on top of each other, and colours that cannot be read on a dark ground.
#[test]
fn code_looks_right() {
    picture("code-dark", Tab::Code, Theme::Dark, 1280.0);
}

/// Catches code that does not fit a narrow window, and colours that cannot be read on a light ground.
#[test]
fn code_looks_right_in_a_narrow_window() {
    picture("code-light", Tab::Code, Theme::Light, 900.0);
}

/// Catches boxes and lines at the wrong places.
#[test]
fn the_graph_looks_right() {
    picture("graph-dark", Tab::Graph, Theme::Dark, 1280.0);
}

/// Catches a graph that does not fit a narrow window.
#[test]
fn the_graph_looks_right_in_a_narrow_window() {
    picture("graph-light", Tab::Graph, Theme::Light, 900.0);
}
