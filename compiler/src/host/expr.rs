//! Expressions, broken into lines where `rustfmt` breaks them.

use super::text::{Text, WIDTH};

/// An expression.
#[derive(Clone, Debug)]
pub enum Expr {
    /// In one line.
    Atom(String),
    /// A struct: what stands before the brace, and the fields. Without a name the value is the shorthand for both.
    Struct(String, Vec<(String, Expr)>),
    /// An array.
    Array(Vec<Expr>),
    /// Something before an expression: `&`, `Some(`, a call of one argument; and what ends it.
    Around(String, Box<Expr>, &'static str),
}

/// Widest body of a struct in one line.
const STRUCT_WIDTH: usize = 18;
/// Widest contents of an array in one line.
const LIST_WIDTH: usize = 60;

impl Expr {
    /// An expression in one line.
    pub fn atom(text: impl Into<String>) -> Self {
        Self::Atom(text.into())
    }

    /// `before(inner)`
    pub fn call(before: &str, inner: Self) -> Self {
        Self::Around(format!("{before}("), Box::new(inner), ")")
    }

    /// In one line, where it is allowed to be in one.
    fn flat(&self) -> Option<String> {
        match self {
            Self::Atom(text) => Some(text.clone()),
            Self::Struct(head, fields) => {
                let body = flat_list(fields.iter().map(flat_field))?;
                match body.len() {
                    0 => Some(format!("{head} {{}}")),
                    1..=STRUCT_WIDTH => Some(format!("{head} {{ {body} }}")),
                    _ => None,
                }
            }
            Self::Array(items) => {
                let body = flat_list(items.iter().map(Self::flat))?;
                (body.len() <= LIST_WIDTH).then(|| format!("[{body}]"))
            }
            Self::Around(before, inner, after) => Some(format!("{before}{}{after}", inner.flat()?)),
        }
    }

    /// In lines, where `used` columns before it and `after` columns behind it are taken. Lines after the first are indented by `indent`.
    fn lines(&self, indent: usize, used: usize, after: usize) -> String {
        if let Some(flat) = self.flat()
            && used + flat.len() + after <= WIDTH
        {
            return flat;
        }
        let inner = " ".repeat(indent + 4);
        let outer = " ".repeat(indent);
        match self {
            Self::Atom(text) => text.clone(),
            Self::Struct(head, fields) => {
                let mut out = format!("{head} {{\n");
                for (name, value) in fields {
                    let before = if name.is_empty() { String::new() } else { format!("{name}: ") };
                    let value = value.lines(indent + 4, indent + 4 + before.len(), 1);
                    out.push_str(&format!("{inner}{before}{value},\n"));
                }
                out + &outer + "}"
            }
            // The only element's braces stand for those of the array.
            Self::Array(items) if items.len() == 1 => format!("[{}]", items[0].lines(indent, used + 1, after + 1)),
            Self::Array(items) => {
                let mut out = "[\n".to_owned();
                for item in items {
                    out.push_str(&format!("{inner}{},\n", item.lines(indent + 4, indent + 4, 1)));
                }
                out + &outer + "]"
            }
            Self::Around(before, value, end) => {
                if before.ends_with('(')
                    && let Self::Atom(text) = value.as_ref()
                {
                    let comma = if before.ends_with("!(") { "" } else { "," };
                    return format!("{before}\n{inner}{text}{comma}\n{outer}{end}");
                }
                format!("{before}{}{end}", value.lines(indent, used + before.len(), after + end.len()))
            }
        }
    }
}

fn flat_field((name, value): &(String, Expr)) -> Option<String> {
    let value = value.flat()?;
    Some(if name.is_empty() { value } else { format!("{name}: {value}") })
}

fn flat_list(items: impl Iterator<Item = Option<String>>) -> Option<String> {
    let items: Option<Vec<String>> = items.collect();
    Some(items?.join(", "))
}

/// Writes `before`, the expression, and `after` on lines of their own.
pub fn put(text: &mut Text, before: &str, expr: &Expr, after: &str) {
    let indent = text.indent();
    let lines = expr.lines(indent, indent + before.len(), after.len());
    // The expression's later lines are indented already.
    let mut lines = lines.split('\n');
    text.line(&format!(
        "{before}{}{}",
        lines.next().unwrap_or_default(),
        if lines.clone().next().is_none() { after } else { "" }
    ));
    while let Some(line) = lines.next() {
        let end = if lines.clone().next().is_none() { after } else { "" };
        text.line(&format!("{}{end}", line.get(indent..).unwrap_or_default()));
    }
}

/// Writes a public constant.
pub fn constant(text: &mut Text, name: &str, ty: &str, value: &Expr) {
    put(text, &format!("pub const {name}: {ty} = "), value, ";");
}
