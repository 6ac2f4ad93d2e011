//! The page: what it says, and that what it quotes can do nothing.

#![allow(clippy::expect_used)]

mod sample;

use std::collections::BTreeSet;

use roxmltree::{Document, Node, ParsingOptions};
use sample::HOSTILE;
use shadewright_report::data::{Report, Worst};
use shadewright_report::write::{Kind, faults, files, replay};

fn page_of(report: &Report) -> String {
    let files = files(report).expect("files");
    let (_, bytes) = files.into_iter().find(|(name, _)| name == "report.html").expect("a page");
    String::from_utf8(bytes).expect("UTF-8")
}

fn parse(page: &str) -> Document<'_> {
    let options = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(page, options).unwrap_or_else(|error| panic!("the page is not well-formed: {error}"))
}

fn text_of(node: Node<'_, '_>) -> String {
    node.descendants()
        .filter_map(|child| if child.is_text() { child.text() } else { None })
        .collect()
}

fn elements<'a>(document: &'a Document<'a>, name: &'static str) -> Vec<Node<'a, 'a>> {
    document
        .descendants()
        .filter(|node| node.has_tag_name(("http://www.w3.org/1999/xhtml", name)))
        .collect()
}

/// As the page shows a text: no control characters.
fn shown(text: &str) -> String {
    text.chars()
        .map(|letter| if letter.is_control() { char::REPLACEMENT_CHARACTER } else { letter })
        .collect()
}

/// Catches text of a manifest that becomes markup: a script, an element, an attribute, a request to another machine.
#[test]
fn quoted_text_can_do_nothing() {
    let page = page_of(&sample::report());
    let document = parse(&page);
    assert_eq!(elements(&document, "script").len(), 1, "one script, which is ours");
    assert!(elements(&document, "img").is_empty() && elements(&document, "iframe").is_empty());
    for node in document.descendants().filter(Node::is_element) {
        for attribute in node.attributes() {
            assert!(!attribute.name().starts_with("on"), "{node:?}");
            let leads_out = attribute.name() == "src" || attribute.name() == "href" && !attribute.value().starts_with(['#']);
            let is_data = attribute.value().starts_with("data:");
            let is_link = node.tag_name().name() == "a" && attribute.value() == "https://example.org";
            assert!(!leads_out || is_data || is_link, "{attribute:?}");
        }
    }
    // It is all there, as text.
    let hostile = document
        .descendants()
        .filter(|node| node.is_text() && node.text().is_some_and(|text| text.contains(&shown(HOSTILE))));
    assert!(hostile.count() > 10);
}

/// Catches a command that the shell reads otherwise than it was meant: each is split by a crate, and run by a shell in which `shadewright` tells
/// its arguments and its input.
#[test]
fn commands_are_read_back() {
    let report = sample::report();
    let page = page_of(&report);
    let document = parse(&page);
    let commands: BTreeSet<String> = elements(&document, "pre")
        .into_iter()
        .filter(|node| node.attribute("class") == Some("command"))
        .map(text_of)
        .collect();
    let mut expected = BTreeSet::new();
    let mut expect = |recipe: &str, function: &str, worst: &Worst| {
        expected.insert([shown(&format!("[{}]", worst.input)), shown(recipe), function.to_owned()]);
    };
    for results in &report.experiments {
        for row in &results.rows {
            let verdict = &row.verdict;
            let faults = [&verdict.nan, &verdict.infinite, &verdict.negative, &verdict.discontinuous];
            let errors = [row.model.as_ref(), row.rounding.as_ref(), Some(&row.rounding_cpu)];
            let worsts = faults.iter().filter_map(|fault| fault.worst.as_ref());
            worsts
                .chain(errors.into_iter().flatten().map(|errors| &errors.worst))
                .for_each(|worst| expect(&row.recipe, &results.function, worst));
        }
    }
    for one in &report.agreement {
        one.worst.iter().for_each(|worst| expect(&one.module, &one.function, worst));
    }
    assert!(expected.len() > 15);
    let mut found = BTreeSet::new();
    for command in &commands {
        let words = shell_words::split(command).unwrap_or_else(|error| panic!("{command}: {error}"));
        let [printf, format, row, pipe, program, probe, recipe, function, inputs, dash] =
            words.try_into().unwrap_or_else(|words| panic!("{words:?}"));
        assert_eq!(
            [printf, format, pipe, program, probe, inputs, dash],
            ["printf", "%s\\n", "|", "shadewright", "probe", "--inputs", "-"]
        );
        assert!(
            serde_json::from_str::<serde_json::Value>(&row).is_ok_and(|rows| rows.as_array().is_some_and(|rows| rows.len() == 1)),
            "{row}"
        );
        assert_eq!(
            run(command),
            format!("probe\u{1}{recipe}\u{1}{function}\u{1}--inputs\u{1}-\u{1}{row}\n")
        );
        found.insert([row, recipe, function]);
    }
    assert_eq!(found, expected);
}

/// What a shell makes of a command, with a `shadewright` that tells its arguments, each ended by a byte 1, and its input.
#[cfg(unix)]
fn run(command: &str) -> String {
    let script = format!("shadewright() {{ printf '%s\\001' \"$@\"; cat; }}\n{command}");
    let output = std::process::Command::new("sh").args(["-c", &script]).output().expect("a shell");
    assert!(
        output.status.success() && output.stderr.is_empty(),
        "{command}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// Catches quotes that a shell takes for its own, in the plainest cases.
#[test]
fn replays() {
    let command = replay("lambert", "brdf", &serde_json::json!({"v": [0, 0, 1]}));
    assert_eq!(
        command,
        r#"printf '%s\n' '[{"v":[0,0,1]}]' | shadewright probe lambert brdf --inputs -"#
    );
    let command = replay("(module: \"it's\")", "f", &serde_json::json!("it's"));
    assert_eq!(
        command,
        r#"printf '%s\n' '["it'\''s"]' | shadewright probe '(module: "it'\''s")' f --inputs -"#
    );
}

/// Catches links within the page that lead nowhere, and two elements of one name.
#[test]
fn anchors_are_there_once() {
    let page = page_of(&sample::report());
    let document = parse(&page);
    let ids: Vec<&str> = document.descendants().filter_map(|node| node.attribute("id")).collect();
    let unique: BTreeSet<&str> = ids.iter().copied().collect();
    assert_eq!(unique.len(), ids.len(), "{ids:?}");
    for id in [
        "faults",
        "overview",
        "x-brdf-masking",
        "x-curve-exposure-manual",
        "x-b-evil-b-x",
        "agreement",
        "without",
        "software",
    ] {
        assert!(unique.contains(id), "{id} is not in {ids:?}");
    }
    let links: Vec<&str> = elements(&document, "a")
        .iter()
        .filter_map(|node| node.attribute("href")?.strip_prefix('#'))
        .collect();
    assert!(links.len() >= 9, "{links:?}");
    assert!(links.iter().all(|link| unique.contains(link)), "{links:?}");
}

/// Catches a fault that is left out or that stands behind a lesser one; also NaN that shows in no count but in the figures.
#[test]
fn faults_come_first_and_the_worst_first() {
    let report = sample::report();
    let kinds: Vec<(Kind, Option<&str>, usize)> = faults(&report).iter().map(|fault| (fault.kind, fault.row, fault.count)).collect();
    assert_eq!(
        kinds,
        [
            (Kind::Nan, Some("cook-torrance"), 3),
            (Kind::Nan, Some("nan"), 0),
            (Kind::Infinite, Some(HOSTILE), 1),
            (Kind::Outside, None, 17),
            (Kind::Outside, None, 1),
            (Kind::Discontinuous, Some("table-64"), 211),
        ]
    );
    let page = page_of(&report);
    let document = parse(&page);
    let lines: Vec<String> = elements(&document, "li")
        .iter()
        .filter(|node| node.has_attribute("id"))
        .map(|node| text_of(*node))
        .collect();
    assert_eq!(lines.len(), kinds.len());
    let first = "NaN, not a number: brdf/masking, row cook-torrance, brdf, 3 of 4128 configurations; gives NaN, should be 0.25";
    assert!(lines[0].starts_with(first), "{}", lines[0]);
    assert!(lines[3].starts_with(
        "Outside WGSL's allowance, rounded worse than WGSL's accuracy table allows: brdf/microfacet, brdf, 17 of 12288 results"
    ));
    assert!(page.find("id=\"faults\"") < page.find("id=\"overview\""));
}

/// Catches a CPU that is passed off as a GPU, a GPU that is called a CPU, and a report without a device that does not say so.
#[test]
fn the_device_is_named_as_what_it_is() {
    let callouts = |device: &str, is_software: bool| -> Vec<String> {
        let mut report = sample::report();
        device.clone_into(&mut report.provenance.device);
        report.provenance.is_software = is_software;
        let page = page_of(&report);
        let document = parse(&page);
        let is_callout = |node: &Node<'_, '_>| node.attribute("class").is_some_and(|class| class.starts_with("callout"));
        document.descendants().filter(is_callout).map(text_of).collect()
    };
    assert_eq!(callouts("llvmpipe", true), ["This device is a CPU: its times are no GPU's."]);
    assert_eq!(callouts("A GPU", false), Vec::<String>::new());
    assert_eq!(
        callouts("", false),
        ["No device was used: there are no times, and rounding is the evaluator's alone."]
    );
}

/// Catches cells under the wrong column, missing values drawn as 0, infinities that look like numbers, and dominated rows that look like others.
#[test]
fn tables_say_what_the_data_says() {
    let page = page_of(&sample::report());
    let document = parse(&page);
    let tables = elements(&document, "table");
    let line = |caption: &str, row: usize| -> (Vec<String>, Option<String>) {
        let of = |node: &&Node<'_, '_>| {
            node.children()
                .any(|child| child.tag_name().name() == "caption" && text_of(child).starts_with(caption))
        };
        let table = tables.iter().find(of).unwrap_or_else(|| panic!("no table {caption}"));
        let body = table.children().find(|node| node.tag_name().name() == "tbody").expect("a body");
        let line = body.children().filter(Node::is_element).nth(row).expect("a row");
        (
            line.children().filter(Node::is_element).map(text_of).collect(),
            line.attribute("class").map(str::to_owned),
        )
    };
    let (cells, class) = line("Errors of brdf/masking", 2);
    assert_eq!(
        cells,
        [
            "smith-separable dominated",
            "0.0420",
            "0.0840",
            "0.210",
            "-0.0140",
            "0.315",
            "1.90e-7",
            "9.50e-7",
            "1.52e-7",
            "7.60e-7",
            "1.15e-5",
            "ok"
        ]
    );
    assert_eq!(class.as_deref(), Some("dominated"));
    let (cells, class) = line("Errors of brdf/masking", 8);
    assert_eq!(cells.last().map(String::as_str), Some("NaN 3"));
    assert_eq!(class, None);
    let (cells, _) = line("Errors of curve/exposure/manual", 0);
    assert_eq!(cells, ["exact baseline", "–", "–", "–", "–", "–", "–", "–", "0", "0", "–", "ok"]);
    let (cells, _) = line("Errors of <b>evil", 0);
    assert_eq!(cells[1..6], ["∞", "∞", "∞", "-∞", "∞"]);
    let (cells, _) = line("Errors of <b>evil", 1);
    assert_eq!(cells[1..6], ["NaN", "NaN", "NaN", "NaN", "NaN"]);
    let (cells, _) = line("Cost of brdf/masking; the time of smith-correlated is 1", 10);
    assert_eq!(
        cells,
        [
            "table-64",
            "33.0",
            "49.5",
            "0",
            "1.00",
            "0.825",
            "0.786 to 0.892",
            "3.63",
            "9",
            "13",
            "2",
            "1",
            "1",
            "16",
            "1"
        ]
    );
    let (cells, _) = line("36864 results in 3 functions", 1);
    assert_eq!(cells, ["brdf/microfacet", "brdf", "12288", "99.99 %", "17", "4", "2.50"]);
    let (cells, _) = line("3 experiments", 0);
    assert_eq!(cells, ["brdf/masking", "Masking and shadowing", "12", "9", "0 to 0.580", "2"]);
    let (cells, _) = line("In no experiment, and why", 0);
    assert_eq!(cells, ["pass/forward", "a pass has no function to call"]);
}

/// Catches a page that breaks where there is nothing to say.
#[test]
fn an_empty_report_has_a_page() {
    let mut empty = sample::lonely();
    empty.rows.clear();
    for experiments in [vec![], vec![empty]] {
        let report = Report {
            experiments,
            ..Report::default()
        };
        let page = page_of(&report);
        let text = text_of(parse(&page).root());
        for sentence in [
            "None: no NaN",
            "Nothing was compared: there was no device.",
            "None: every module has one.",
        ] {
            assert!(text.contains(sentence), "{sentence}");
        }
        assert!(text.contains("There are no rows.") || text.contains("There are none."));
    }
}
