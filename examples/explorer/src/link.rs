//! A scene as the fragment of a page's address: an example by its name, and where it was changed with all of its text. So a link means the same when
//! the example is another one day.
//!
//! `scene=first&at=materials.copper&tab=Pareto&show=error&state=...`: the last part is JSON, compressed (RFC 1951), in the alphabet for addresses (RFC 4648, 5).

use std::path::PathBuf;
use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use serde::{Deserialize, Serialize};
use shadewright_compiler::limits;
use shadewright_runtime::scene::Files;

use crate::compare::Mode;
use crate::document::{Document, Parked, State};
use crate::panels::Tab;
use crate::scenes;

/// Largest JSON that is unpacked, bytes: a text of the largest size with all of it escaped.
const MOST: usize = 2 * limits::FILE_SIZE + (1 << 16);
/// How hard it tries to make the text small; more takes longer for a few bytes.
const EFFORT: u8 = 9;

/// What an address says.
#[derive(Debug)]
pub struct Linked {
    /// The scene.
    pub document: Document,
    /// What of it is looked at.
    pub look: Look,
}

/// What of a scene is looked at.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Look {
    /// Path of the row that is selected; empty if none is named.
    pub selected: String,
    /// The tab that is shown.
    pub tab: Tab,
    /// What the viewport shows. A pin is in no link: it is the reference that the scene is compared with.
    pub mode: Mode,
}

/// What is changed of a scene.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Changed {
    text: Arc<str>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    parked: Vec<Parked>,
}

/// The fragment, without its `#`.
pub fn write(state: &State, look: &Look) -> String {
    let mut fragment = format!("scene={}", escaped(&state.name));
    if !look.selected.is_empty() {
        fragment += &format!("&at={}", escaped(&look.selected));
    }
    if look.tab != Tab::default() {
        fragment += &format!("&tab={}", escaped(look.tab.name()));
    }
    if look.mode != Mode::default() {
        fragment += &format!("&show={}", look.mode.name().to_lowercase());
    }
    let is_example = scenes::find(&state.name).is_some_and(|example| *example.text == *state.text);
    if !is_example || !state.parked.is_empty() {
        let changed = Changed {
            text: Arc::clone(&state.text),
            parked: state.parked.clone(),
        };
        // Texts and numbers always have a JSON form.
        let json = serde_json::to_vec(&changed).unwrap_or_default();
        let packed = miniz_oxide::deflate::compress_to_vec(&json, EFFORT);
        fragment += &format!("&state={}", URL_SAFE_NO_PAD.encode(packed));
    }
    fragment
}

/// Reads a fragment, with or without its `#`. Other fields than those above are passed over. `None`: it names no scene.
///
/// # Errors
/// The scene is no example, or the text is damaged or no scene.
pub fn read(fragment: &str, files: &Files) -> Result<Option<Linked>, String> {
    let fields = fragment
        .trim_start_matches('#')
        .split('&')
        .filter_map(|field| field.split_once('='));
    let (mut name, mut look, mut packed) = (None, Look::default(), None);
    for (key, value) in fields {
        match key {
            "scene" => name = Some(unescaped(value)),
            "at" => look.selected = unescaped(value),
            "tab" => {
                let named = unescaped(value);
                look.tab = Tab::ALL.into_iter().find(|tab| tab.name() == named).unwrap_or_default();
            }
            "show" => {
                let is_named = |mode: &Mode| mode.name().eq_ignore_ascii_case(value);
                look.mode = Mode::ALL.into_iter().find(is_named).unwrap_or_default();
            }
            "state" => packed = Some(value),
            _ => {}
        }
    }
    let Some(name) = name else { return Ok(None) };
    let example = scenes::find(&name);
    let changed = match (packed, example) {
        (Some(packed), _) => unpacked(packed)?,
        (None, Some(example)) => Changed {
            text: example.text.into(),
            parked: Vec::new(),
        },
        (None, None) => return Err(format!("there is no example `{name}`")),
    };
    let saved = example.map_or_else(|| Arc::clone(&changed.text), |example| example.text.into());
    let state = State {
        name,
        folder: PathBuf::new(),
        text: changed.text,
        parked: changed.parked,
    };
    let document = Document::restored(state, saved, files).map_err(|report| crate::work::reason(&report))?;
    Ok(Some(Linked { document, look }))
}

fn unpacked(packed: &str) -> Result<Changed, String> {
    let damaged = "the link is damaged: some of it may be missing";
    let packed = URL_SAFE_NO_PAD.decode(packed).map_err(|_| damaged)?;
    let json = miniz_oxide::inflate::decompress_to_vec_with_limit(&packed, MOST).map_err(|_| damaged)?;
    Ok(serde_json::from_slice(&json).map_err(|_| damaged)?)
}

/// The text with `%20` and its like for all but letters, digits and what means nothing in a fragment.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for byte in text.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => out.push(char::from(byte)),
            _ => out += &format!("%{byte:02X}"),
        }
    }
    out
}

/// The text of an escaped one. What is no escape stands for itself.
fn unescaped(text: &str) -> String {
    let bytes = text.as_bytes();
    let mut out = Vec::new();
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        let digits = text.get(at + 1..at + 3).filter(|_| byte == b'%');
        match digits.and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            Some(meant) => {
                out.push(meant);
                at += 3;
            }
            None => {
                out.push(byte);
                at += 1;
            }
        }
    }
    String::from_utf8_lossy(&out).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(name: &str) -> Document {
        Document::new(scenes::find(name).unwrap().scene().unwrap())
    }

    fn again(document: &Document, look: &Look) -> Linked {
        let fragment = write(document.state(), look);
        let usual = |c: char| c.is_ascii_alphanumeric() || "-._~/=&%".contains(c);
        assert!(fragment.chars().all(usual), "a browser would write it otherwise: {fragment}");
        read(&format!("#{fragment}"), &scenes::files()).unwrap().unwrap()
    }

    /// Catches an edit, a switched-off element or a selection that a link loses, and a link of kilobytes where nothing was changed.
    #[test]
    fn links_bring_everything_back() {
        for example in scenes::ALL {
            let plain = document(example.name);
            assert_eq!(write(plain.state(), &Look::default()), format!("scene={}", example.name));
            for (tab, mode) in Tab::ALL.into_iter().zip(Mode::ALL.into_iter().cycle()) {
                let selected = "materials[\"red glaze\"].brdf & more % 100".to_owned();
                let look = Look { selected, tab, mode };
                let read = again(&plain, &look);
                assert_eq!(read.document.state(), plain.state());
                assert_eq!(read.look, look);
            }
            let read = again(&plain, &Look::default());
            assert!(!read.document.is_changed());
        }
        let mut changed = document("first");
        changed
            .edit("test", |draft| draft.set(&[], "background", "(0.0, 1.0, 2.0)"))
            .unwrap();
        changed.edit("test", |draft| draft.remove(&[], "lights", 1, true)).unwrap();
        assert_eq!(changed.state().parked.len(), 1);
        let read = again(&changed, &Look::default());
        assert_eq!((read.document.state(), read.look), (changed.state(), Look::default()));
        assert!(read.document.is_changed());
        let length = write(changed.state(), &Look::default()).len();
        assert!(length < changed.state().text.len() / 2, "{length} letters");

        let own =
            shadewright_runtime::scene::SceneFile::parse("Füße/mine.scene.ron", scenes::ALL[1].text, std::path::Path::new("")).unwrap();
        let own = Document::new(own);
        assert_eq!(again(&own, &Look::default()).document.state(), own.state());
        assert!(read_error("scene=nonsense").contains("no example `nonsense`"));
        assert!(super::read("", &scenes::files()).unwrap().is_none());
        assert!(super::read("#utm_source=x&nonsense", &scenes::files()).unwrap().is_none());
    }

    fn read_error(fragment: &str) -> String {
        read(fragment, &scenes::files()).unwrap_err()
    }

    /// Catches a link cut short by a mail program, or by malice, that ends the program or takes all memory.
    #[test]
    fn damage_is_an_error() {
        let mut changed = document("sphere");
        changed
            .edit("test", |draft| draft.set(&[], "background", "(0.0, 1.0, 2.0)"))
            .unwrap();
        let whole = write(changed.state(), &Look::default());
        let begin = whole.find("state=").unwrap() + "state=".len();
        for end in begin..whole.len() {
            assert!(read_error(&whole[..end]).contains("damaged"), "{end}");
        }
        for at in begin..whole.len() {
            let mut bad = whole.clone().into_bytes();
            bad[at] = if bad[at] == b'A' { b'B' } else { b'A' };
            // It may come out as another text, but not as a panic.
            drop(read(std::str::from_utf8(&bad).unwrap(), &scenes::files()));
        }
        for odd in ["scene=%", "scene=%f", "scene=%ff", "scene=%e2%28", "scene=first&at=%zz", "scene=ü%"] {
            drop(read(odd, &scenes::files()));
        }
        let bomb = miniz_oxide::deflate::compress_to_vec(&vec![b' '; 10 * MOST], 9);
        let bomb = URL_SAFE_NO_PAD.encode(bomb);
        assert!(read_error(&format!("scene=first&state={bomb}")).contains("damaged"));
    }
}
