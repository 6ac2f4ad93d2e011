//! Linked text, cut into the modules that it was linked from.
//!
//! A piece is one module of the tree, or one category's interface. The peers forbid modules that import each other in a circle, which a
//! slot that offers functions to its filling makes: a shadow filter calls back into the shadow map that calls it. There a module becomes
//! two pieces, what is called back being the lower one.

use std::collections::{BTreeMap, BTreeSet};

use shadewright_compiler::Program;

/// A function, struct, constant or variable with its comments and attributes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    /// Name.
    pub name: String,
    /// Whole text.
    pub text: String,
    /// Stage attribute or not.
    pub is_entry: bool,
    /// Whether it is a struct.
    pub is_struct: bool,
    /// Identifiers in its text that may be other items' names: none after a dot, none in comments.
    words: BTreeSet<String>,
}

/// Items that stand in one module, in their order in the linked text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Piece {
    /// Unique; a WGSL identifier.
    pub name: String,
    /// Items.
    pub items: Vec<Item>,
    /// Names of other pieces with the names that are imported from them.
    pub imports: BTreeMap<String, BTreeSet<String>>,
}

impl Piece {
    /// The text of all items.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for item in &self.items {
            text.push_str(&item.text);
            text.push_str("\n\n");
        }
        text
    }
}

/// Cuts a program's text into pieces, imported ones first. The last holds the entry points.
///
/// # Errors
/// Pieces import each other in a circle, or there is no entry point.
pub fn pieces(program: &Program) -> Result<Vec<Piece>, String> {
    let items = items(program.wgsl());
    let index: BTreeMap<&str, usize> = items.iter().enumerate().map(|(i, item)| (item.name.as_str(), i)).collect();
    let uses: Vec<Vec<usize>> = items
        .iter()
        .enumerate()
        .map(|(own, item)| {
            let named = item.words.iter().filter_map(|word| index.get(word.as_str()).copied());
            named.filter(|&i| i != own).collect()
        })
        .collect();
    let homes = homes(program, &items, &uses);
    let below: Vec<BTreeSet<usize>> = (0..items.len()).map(|i| reached(i, &uses)).collect();
    let mut memo = vec![None; items.len()];
    let mut levels: Vec<usize> = (0..items.len()).map(|i| level(i, &uses, &homes, &below, &mut memo)).collect();
    // Entry points stand together, above all else of their module.
    let top = (0..items.len()).filter(|&i| items[i].is_entry).map(|i| levels[i]).max();
    let top = top.ok_or("the program has no entry point")?;
    for i in (0..items.len()).filter(|&i| items[i].is_entry) {
        levels[i] = top;
    }
    let name = |i: usize| match levels[i] {
        0 => homes[i].clone(),
        n => format!("{}_{}", homes[i], ["upper", "third", "fourth"].get(n - 1).unwrap_or(&"top")),
    };
    let mut found: Vec<Piece> = Vec::new();
    for (i, item) in items.iter().enumerate() {
        let position = found.iter().position(|p| p.name == name(i)).unwrap_or_else(|| {
            found.push(Piece {
                name: name(i),
                items: Vec::new(),
                imports: BTreeMap::new(),
            });
            found.len() - 1
        });
        found[position].items.push(item.clone());
        for &used in uses[i].iter().filter(|&&used| name(used) != name(i)) {
            let imported = found[position].imports.entry(name(used)).or_default();
            imported.insert(items[used].name.clone());
        }
    }
    ordered(found)
}

/// Sorts so that every piece comes after what it imports, and the entry points come last.
fn ordered(mut left: Vec<Piece>) -> Result<Vec<Piece>, String> {
    let mut done: Vec<Piece> = Vec::new();
    while !left.is_empty() {
        let is_root = |piece: &Piece| piece.items.iter().any(|item| item.is_entry);
        let ready = |piece: &Piece| piece.imports.keys().all(|name| done.iter().any(|d| &d.name == name));
        let next = left
            .iter()
            .position(|piece| ready(piece) && (left.len() == 1 || !is_root(piece)))
            .ok_or_else(|| {
                let names: Vec<&str> = left.iter().map(|piece| piece.name.as_str()).collect();
                format!("these pieces import each other in a circle: {}", names.join(", "))
            })?;
        done.push(left.remove(next));
    }
    Ok(done)
}

/// The module that each item belongs to.
fn homes(program: &Program, items: &[Item], uses: &[Vec<usize>]) -> Vec<String> {
    let mut homes: Vec<Option<String>> = items
        .iter()
        .map(|item| {
            let why = program.why(&item.name).into_iter().find(|why| why.name == item.name)?;
            // A block of parameters holds those of many modules.
            let is_block = why.kind == "binding" && item.is_struct;
            (!is_block).then(|| home(&why.module, &why.place))
        })
        .collect();
    let blocks: Vec<usize> = (0..items.len()).filter(|&i| items[i].is_struct && homes[i].is_none()).collect();
    for i in 0..items.len() {
        if blocks.contains(&i) || !items[i].text.contains("fn ") && uses[i].iter().any(|used| blocks.contains(used)) {
            homes[i] = Some("params".to_owned());
        }
    }
    // A frozen parameter belongs to whoever reads it first.
    (0..items.len())
        .map(|i| {
            let user = || (0..items.len()).find(|&user| uses[user].contains(&i) && homes[user].is_some());
            homes[i]
                .clone()
                .or_else(|| homes[user()?].clone())
                .unwrap_or_else(|| "params".to_owned())
        })
        .collect()
}

fn home(module: &str, place: &str) -> String {
    let path = if place.is_empty() {
        format!("{module}_interface")
    } else {
        place.to_owned()
    };
    let words = path.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    // No digit at an end: naga appends `_` to such names, which the peers' name mangling does not expect.
    words.map(digits_as_letters).collect::<Vec<_>>().join("_")
}

fn digits_as_letters(word: &str) -> String {
    word.chars()
        .map(|c| c.to_digit(10).map_or(c, |digit| char::from(b'a' + digit as u8)))
        .collect()
}

/// All that an item uses, through others.
fn reached(from: usize, uses: &[Vec<usize>]) -> BTreeSet<usize> {
    let mut seen = BTreeSet::new();
    let mut open = uses[from].clone();
    while let Some(i) = open.pop() {
        if seen.insert(i) {
            open.extend(&uses[i]);
        }
    }
    seen
}

/// How often a chain of uses leaves an item's home and comes back to it.
fn level(i: usize, uses: &[Vec<usize>], homes: &[String], below: &[BTreeSet<usize>], memo: &mut Vec<Option<usize>>) -> usize {
    if let Some(known) = memo[i] {
        return known;
    }
    let mut highest = 0;
    for &used in &uses[i] {
        if homes[used] == homes[i] {
            highest = highest.max(level(used, uses, homes, below, memo));
        } else {
            for &back in below[used].iter().filter(|&&back| homes[back] == homes[i]) {
                highest = highest.max(1 + level(back, uses, homes, below, memo));
            }
        }
    }
    memo[i] = Some(highest);
    highest
}

/// Cuts WGSL into its items. Every one has its comments and attributes before it.
fn items(text: &str) -> Vec<Item> {
    let mut found = Vec::new();
    let (mut start, mut depth) = (0, 0usize);
    let code = without_comments(text);
    for (at, c) in code.char_indices() {
        match c {
            '{' | '(' | '[' => depth += 1,
            '}' | ')' | ']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 && (c == ';' || c == '}') {
            found.push(item(&text[start..=at], &code[start..=at]));
            start = at + 1;
        }
    }
    found
}

/// The text with blanks for comments, byte for byte.
fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let (code, comment) = line.split_at(line.find("//").unwrap_or(line.len()));
        out.push_str(code);
        out.extend(comment.bytes().map(|b| if b == b'\n' { '\n' } else { ' ' }));
    }
    out
}

fn item(text: &str, code: &str) -> Item {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut words = Vec::new();
    let mut at = 0;
    while at < code.len() {
        let rest = &code[at..];
        let Some(begin) = rest.find(is_word) else { break };
        let length = rest[begin..].find(|c| !is_word(c)).unwrap_or(rest.len() - begin);
        let is_member = rest[..begin].ends_with('.');
        if !is_member {
            words.push(&rest[begin..begin + length]);
        }
        at += begin + length;
    }
    let keyword = words
        .iter()
        .position(|word| ["fn", "struct", "const", "var", "override", "alias"].contains(word));
    let is_template = ["uniform", "storage", "read", "read_write", "write", "private", "workgroup"];
    let name = words
        .iter()
        .skip(keyword.map_or(0, |k| k + 1))
        .find(|word| !is_template.contains(word));
    Item {
        name: name.copied().unwrap_or_default().to_owned(),
        text: text.trim().to_owned(),
        is_entry: ["@vertex", "@fragment", "@compute"].iter().any(|stage| code.contains(stage)),
        is_struct: keyword.is_some_and(|k| words[k] == "struct"),
        words: words.into_iter().map(str::to_owned).collect(),
    }
}
