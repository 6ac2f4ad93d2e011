//! The authors' comments, found in the source form.

use std::collections::HashMap;

use crate::parse::scan::{ItemKind, Scan, scan};

/// Comments of structs and their members.
pub struct Docs<'t> {
    text: &'t str,
    scan: Scan,
    structs: HashMap<String, String>,
    members: HashMap<(String, String), String>,
}

impl<'t> Docs<'t> {
    /// Reads the comments of a text.
    pub fn new(text: &'t str) -> Self {
        let scan = scan(text);
        let (mut structs, mut members) = (HashMap::new(), HashMap::new());
        for item in scan.items.iter().filter(|item| item.kind == ItemKind::Struct) {
            structs.insert(item.name.clone(), comment(&text[item.doc_start..item.span.start]));
            for field in &item.fields {
                let start = scan.bytes(&field.tokens).start;
                members.insert(
                    (item.name.clone(), field.name.clone()),
                    comment_above(&text[item.span.start..start]),
                );
            }
        }
        Self {
            text,
            scan,
            structs,
            members,
        }
    }

    /// Comment of a struct; empty without one.
    pub fn of_struct(&self, name: &str) -> &str {
        self.structs.get(name).map_or("", String::as_str)
    }

    /// Comment of a member; empty without one.
    pub fn of_member(&self, name: &str, member: &str) -> &str {
        self.members.get(&(name.to_owned(), member.to_owned())).map_or("", String::as_str)
    }

    /// Comment of an input of an entry point: that of the argument's struct's member.
    pub fn of_input(&self, entry: &str, input: &str) -> &str {
        let structs = self.scan.item(entry).into_iter().flat_map(|item| &item.fields);
        structs
            .map(|argument| self.of_member(&self.text[self.scan.bytes(&argument.ty)], input))
            .find(|found| !found.is_empty())
            .unwrap_or_default()
    }
}

/// The comment in lines that hold nothing else.
fn comment(lines: &str) -> String {
    let lines = lines.lines().filter_map(|line| line.trim().strip_prefix("//"));
    let lines: Vec<String> = lines.map(|line| escape(line.trim_start_matches('/').trim())).collect();
    lines.join("\n")
}

/// The comment lines that stand directly above what follows the text.
fn comment_above(before: &str) -> String {
    let own = before.rfind('\n').map_or("", |end| &before[..end]);
    let count = own.lines().rev().take_while(|line| line.trim().starts_with("//")).count();
    let all: Vec<&str> = own.lines().collect();
    comment(&all[all.len() - count..].join("\n"))
}

/// Text in which rustdoc sees no links and no tags. What stands between backticks is left alone.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut code = false;
    for c in text.chars() {
        match c {
            '`' => code = !code,
            '[' | ']' | '<' | '>' if !code => out.push('\\'),
            // rustc refuses a lone one in a documentation comment.
            '\r' => continue,
            _ => {}
        }
        out.push(c);
    }
    out
}
