//! Changing values of a scene's text, by their path: `lights[0].fields.intensity`, `objects[pot].translate`, `lights[*].casts_shadow`.

use std::ops::Range;

use shadewright_compiler::diagnostics::{Diagnostic, SourceFile, codes};
use shadewright_compiler::manifest::{Locator, Step, ron_options};

/// Keys whose values are maps, which are written in braces and may be made where they are missing.
const MAPS: [&str; 10] = [
    "params",
    "fields",
    "freeze",
    "fill",
    "textures",
    "files",
    "visibility",
    "materials",
    "meshes",
    "modules",
];

/// A step as written.
#[derive(Clone, Debug, PartialEq)]
enum Part {
    /// `.name`
    Key(String),
    /// `[3]`
    Index(usize),
    /// `[name]`: the element with this name, or the map's key.
    Named(String),
    /// `[*]`: each element.
    Every,
}

/// Steps with their places in the path.
type Parts = Vec<(Part, Range<usize>)>;

/// The text with the value at the path replaced, or added where a field or a map's entry is not there yet.
///
/// The value is RON; a text that is none is taken as a string, so that quotes are not needed: `900 lm`, `"900 lm"`.
/// Everything else stays as it is, comments and lines included, so that errors still point into the author's text.
///
/// # Errors
/// The path leads nowhere.
pub fn set(name: &str, text: &str, path: &str, value: &str) -> Result<String, Diagnostic> {
    let wrong = |at: Range<usize>, message: String, label: &str| {
        // Said about the path itself: it is what is wrong.
        Diagnostic::new(codes::BAD_OVERRIDE_PATH, message).at(&SourceFile::new("--set", format!("{path}={value}")), at, label)
    };
    let parts = parse(path).map_err(|(at, why)| wrong(at..path.len().max(at), format!("`{path}` is no path"), why))?;
    if let Some((_, every)) = parts.iter().find(|(part, _)| *part == Part::Every) {
        let (before, after) = (&path[..every.start], &path[every.end..]);
        let mut changed = text.to_owned();
        let mut index = 0;
        while is_there(&changed, &format!("{before}[{index}]")) {
            changed = set(name, &changed, &format!("{before}[{index}]{after}"), value)?;
            index += 1;
        }
        if index > 0 {
            return Ok(changed);
        }
        let message = format!("`{path}` leads nowhere in `{name}`");
        return Err(wrong(every.clone(), message, "what is before this is no list, or an empty one"));
    }
    let value = as_ron(value);
    let places = Locator::new(text);

    let mut steps: Vec<Step> = Vec::new();
    for (i, (part, span)) in parts.iter().enumerate() {
        steps.push(step(text, &places, &steps, part));
        if places.find(&steps).is_some() {
            continue;
        }
        // Not there: a key can be added, an element cannot.
        steps.pop();
        let around = places.find(&steps).unwrap_or(0..text.len());
        let Part::Key(key) = part else {
            return Err(wrong(
                span.clone(),
                format!("`{path}` leads nowhere in `{name}`"),
                "there is no such element",
            ));
        };
        let Some(rest) = nested(&parts[i + 1..], key, &value) else {
            return Err(wrong(
                span.clone(),
                format!("`{path}` leads nowhere in `{name}`"),
                "there is no such field or entry",
            ));
        };
        return insert(text, around, key, &rest).ok_or_else(|| {
            wrong(
                span.clone(),
                format!("`{path}` leads nowhere in `{name}`"),
                "what is before this has no fields",
            )
        });
    }
    let Some(span) = places.find(&steps) else {
        return Err(wrong(
            0..path.len(),
            format!("`{path}` leads nowhere in `{name}`"),
            "nothing is there",
        ));
    };
    Ok(format!("{}{value}{}", &text[..span.start], &text[span.end..]))
}

/// Whether something stands at the path.
fn is_there(text: &str, path: &str) -> bool {
    find(text, path).is_some()
}

/// Where in the text stands what the path leads to; `None` where nothing does.
pub fn find(text: &str, path: &str) -> Option<Range<usize>> {
    let parts = parse(path).ok()?;
    let places = Locator::new(text);
    places.find(&steps_of(text, &places, &parts))
}

fn steps_of<'a>(text: &str, places: &Locator, parts: &'a Parts) -> Vec<Step<'a>> {
    let mut steps = Vec::new();
    for (part, _) in parts {
        steps.push(step(text, places, &steps, part));
    }
    steps
}

/// The text without the field, entry or element at the path and the comma that follows it.
///
/// # Errors
/// Nothing stands there.
pub fn unset(name: &str, text: &str, path: &str) -> Result<String, Diagnostic> {
    let wrong = |label: &str| {
        let message = format!("`{path}` leads nowhere in `{name}`");
        Diagnostic::new(codes::BAD_OVERRIDE_PATH, message).at(&SourceFile::new("--unset", path), 0..path.len(), label)
    };
    let parts = parse(path).map_err(|(_, why)| wrong(why))?;
    let places = Locator::new(text);
    let steps = steps_of(text, &places, &parts);
    let value = places.find(&steps).ok_or_else(|| wrong("nothing is there"))?;
    let start = places.find_key(&steps).map_or(value.start, |key| key.start);
    let rest = &text[value.end..];
    let comma = rest.trim_start().strip_prefix(',').map(|after| text.len() - after.len());
    let end = comma.unwrap_or(value.end);
    // A line of its own goes as a whole.
    let before = text[..start].trim_end_matches([' ', '\t']);
    let (start, end) = match (before.ends_with('\n'), text[end..].find('\n')) {
        (true, Some(line)) if text[end..end + line].trim().is_empty() => (before.len(), end + line + 1),
        _ => (start, end + text[end..].len() - text[end..].trim_start_matches(' ').len()),
    };
    Ok(format!("{}{}", &text[..start], &text[end..]))
}

/// The step that a part means after those before it.
fn step<'a>(text: &str, places: &Locator, before: &[Step<'a>], part: &'a Part) -> Step<'a> {
    match part {
        Part::Index(index) => Step::Index(*index),
        Part::Key(key) => Step::Key(key),
        Part::Named(wanted) => named(text, places, before, wanted).unwrap_or(Step::Key(wanted)),
        // Taken apart before.
        Part::Every => Step::Key("*"),
    }
}

/// The element of a list whose `name` is this.
fn named<'a>(text: &str, places: &Locator, steps: &[Step<'a>], wanted: &str) -> Option<Step<'a>> {
    for index in 0.. {
        let mut path = steps.to_vec();
        path.push(Step::Index(index));
        places.find(&path)?;
        path.push(Step::Key("name"));
        let found = places.find(&path).and_then(|at| text.get(at));
        if found.is_some_and(|found| found.trim_matches('"') == wanted) {
            return Some(Step::Index(index));
        }
    }
    None
}

/// `a.b[3]["c d"]` as steps, each with its place in the path.
fn parse(path: &str) -> Result<Parts, (usize, &'static str)> {
    let mut parts = Vec::new();
    let mut at = 0;
    while at < path.len() {
        let rest = &path[at..];
        if let Some(inside) = rest.strip_prefix('[') {
            let Some(end) = inside.find(']') else {
                return Err((at, "never closed"));
            };
            let inner = inside[..end].trim().trim_matches('"');
            if inner.is_empty() {
                return Err((at, "a number or a name is missing"));
            }
            let part = match inner {
                "*" => Part::Every,
                _ => inner.parse().map_or_else(|_| Part::Named(inner.to_owned()), Part::Index),
            };
            parts.push((part, at..at + end + 2));
            at += end + 2;
            continue;
        }
        let rest = if parts.is_empty() {
            rest
        } else {
            let Some(rest) = rest.strip_prefix('.') else {
                return Err((at, "a dot is missing"));
            };
            at += 1;
            rest
        };
        let end = rest.find(['.', '[']).unwrap_or(rest.len());
        if end == 0 {
            return Err((at, "a name is missing"));
        }
        parts.push((Part::Key(rest[..end].to_owned()), at..at + end));
        at += end;
    }
    if parts.is_empty() { Err((0, "it is empty")) } else { Ok(parts) }
}

/// RON that stands as it is, or a string of it. A bare word is a string, too: nothing in a scene is written as one.
fn as_ron(value: &str) -> String {
    let text = value.trim();
    let bare = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
    let word = !matches!(text, "true" | "false") && text.starts_with(char::is_alphabetic) && text.chars().all(bare);
    if !word && ron_options().from_str::<ron::Value>(text).is_ok() {
        return text.to_owned();
    }
    format!("\"{}\"", text.escape_default())
}

/// What the missing key gets: the value, or maps around it.
fn nested(rest: &[(Part, Range<usize>)], key: &str, value: &str) -> Option<String> {
    let Some(((next, _), rest)) = rest.split_first() else {
        return Some(value.to_owned());
    };
    let (Part::Key(next) | Part::Named(next)) = next else {
        return None;
    };
    let inner = nested(rest, next, value)?;
    MAPS.contains(&key).then(|| format!("{{{}: {inner}}}", quoted(next)))
}

fn quoted(key: &str) -> String {
    format!("\"{}\"", key.escape_default())
}

/// The text with an entry added to what stands at `around`: a struct, a map, or a module's name alone, which becomes a struct.
fn insert(text: &str, around: Range<usize>, key: &str, value: &str) -> Option<String> {
    let inside = &text[around.clone()];
    if inside.starts_with('"') {
        return Some(format!(
            "{}(module: {inside}, {key}: {value}){}",
            &text[..around.start],
            &text[around.end..]
        ));
    }
    let open = around.start + inside.find(['(', '{', '['])?;
    let entry = match text.as_bytes()[open] {
        b'(' => format!("{key}: {value}, "),
        b'{' => format!("{}: {value}, ", quoted(key)),
        _ => return None,
    };
    Some(format!("{}{entry}{}", &text[..=open], &text[open + 1..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "(
    // (a comment: with brackets)
    size: (4, 3),
    post: [(module: \"tonemap\", fill: {\"curve\": \"reinhard\"})],
    lights: [
        (name: \"sun\", module: \"directional\"),
        (name: \"lamp\", module: \"point\", fields: {\"intensity\": \"800 lm\"}), // warm
    ],
)";

    fn changed(path: &str, value: &str) -> String {
        let text = set("a.scene.ron", TEXT, path, value).unwrap();
        assert!(ron_options().from_str::<ron::Value>(&text).is_ok(), "{text}");
        // What is new in the line that changed.
        let mut lines = text.lines().zip(TEXT.lines()).filter(|(a, b)| a != b);
        let line = lines.next().map_or("", |(a, _)| a.trim()).to_owned();
        assert_eq!(lines.next(), None);
        line
    }

    /// Catches the wrong element, lost neighbours or comments, quotes left out or doubled, and entries put into the wrong bracket.
    #[test]
    fn values_are_replaced_and_added() {
        assert_eq!(changed("size", "(8, 6)"), "size: (8, 6),");
        assert_eq!(changed("size[1]", "7"), "size: (4, 7),");
        let lamp = "(name: \"lamp\", module: \"point\", fields: {\"intensity\": \"900 lm\"}), // warm";
        assert_eq!(changed("lights[1].fields.intensity", "900 lm"), lamp);
        assert_eq!(changed("lights[lamp].fields.intensity", "\"900 lm\""), lamp);
        assert_eq!(changed("lights[1].fields.intensity", "900"), lamp.replace("\"900 lm\"", "900"));
        assert_eq!(
            changed("lights[lamp].fields.position", "(0, 1, 2)"),
            lamp.replace("900", "800").replace("{", "{\"position\": (0, 1, 2), ")
        );
        assert_eq!(
            changed("lights[sun].fields.color", "5000 K"),
            "(fields: {\"color\": \"5000 K\"}, name: \"sun\", module: \"directional\"),"
        );
        assert_eq!(
            changed("post[0].fill.curve.params.white", "4"),
            "post: [(module: \"tonemap\", fill: {\"curve\": (module: \"reinhard\", params: {\"white\": 4})})],"
        );
        assert_eq!(
            changed("lights[0].casts_shadow", "false"),
            "(casts_shadow: false, name: \"sun\", module: \"directional\"),"
        );
        assert_eq!(changed("lights[0].module", "point"), "(name: \"sun\", module: \"point\"),");
    }

    /// Catches an element that is left out, set twice, or found in the text as it was before its neighbour changed.
    #[test]
    fn every_element_changes() {
        let both = set("a.scene.ron", TEXT, "lights[*].fields.color", "5000 K").unwrap();
        let one = set("a.scene.ron", TEXT, "lights[1].fields.color", "5000 K").unwrap();
        assert_eq!(both, set("a.scene.ron", &one, "lights[0].fields.color", "5000 K").unwrap());
        assert_eq!(both.matches("5000 K").count(), 2);
        assert_eq!(set("a.scene.ron", TEXT, "size[*]", "7").unwrap(), TEXT.replace("(4, 3)", "(7, 7)"));
        let error = set("a.scene.ron", TEXT, "post[*].fill.curve[*]", "7").unwrap_err();
        assert_eq!(
            (error.message.as_str(), error.labels[0].span.clone()),
            ("`post[0].fill.curve[*]` leads nowhere in `a.scene.ron`", 18..21)
        );
    }

    /// Catches a neighbour that goes along, a comma that stays without its element, and an element that is found under another's path.
    #[test]
    fn values_are_found_and_removed() {
        let found = find(TEXT, "lights[lamp].fields.intensity").unwrap();
        assert_eq!(&TEXT[found], "\"800 lm\"");
        assert_eq!(find(TEXT, "lights[2]"), None);
        assert_eq!(find(TEXT, "["), None);
        let without = |path: &str| {
            let text = unset("a.scene.ron", TEXT, path).unwrap();
            assert!(ron_options().from_str::<ron::Value>(&text).is_ok(), "{text}");
            text
        };
        assert_eq!(without("size"), TEXT.replace("    size: (4, 3),\n", ""));
        assert_eq!(without("size[1]"), TEXT.replace("(4, 3)", "(4, )"));
        assert_eq!(
            without("lights[0]"),
            TEXT.replace("        (name: \"sun\", module: \"directional\"),\n", "")
        );
        assert_eq!(
            without("lights[lamp].fields.intensity"),
            TEXT.replace("\"intensity\": \"800 lm\"", "")
        );
        assert_eq!(without("lights[sun].name"), TEXT.replace("name: \"sun\", ", ""));
        assert_eq!(unset("a.scene.ron", TEXT, "lights[3]").unwrap_err().code, codes::BAD_OVERRIDE_PATH);
        assert_eq!(unset("a.scene.ron", TEXT, "lights[").unwrap_err().code, codes::BAD_OVERRIDE_PATH);
    }

    /// Catches a path that is quietly ignored.
    #[test]
    fn paths_to_nowhere_are_errors() {
        for path in [
            "",
            "a..b",
            "lights[",
            "lights[7].fields.x",
            "lights[moon]",
            "size.x.y",
            "lights[0]x",
            "lights[]",
            "lights[*",
            "nothing[*]",
            "size[*][*]",
            "[*]",
            "nothing.at.all",
            "[0",
        ] {
            let error = set("a.scene.ron", TEXT, path, "1").unwrap_err();
            assert_eq!(error.code, codes::BAD_OVERRIDE_PATH, "{path}");
        }
        let error = set("a.scene.ron", TEXT, "lights[7].fields.x", "1").unwrap_err();
        assert_eq!(error.message, "`lights[7].fields.x` leads nowhere in `a.scene.ron`");
        assert_eq!(error.labels[0].span, 6..9);
    }
}
