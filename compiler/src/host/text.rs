//! Lines with their indentation.

/// Rust source that grows.
#[derive(Debug, Default)]
pub struct Text {
    out: String,
    depth: usize,
}

/// Longest line.
pub const WIDTH: usize = 100;

impl Text {
    /// Columns that the indentation takes.
    pub fn indent(&self) -> usize {
        self.depth * 4
    }

    /// A line; may be several, each of which is indented.
    pub fn line(&mut self, lines: &str) {
        for line in lines.split('\n') {
            if !line.is_empty() {
                self.out.extend(std::iter::repeat_n(' ', self.depth * 4));
                self.out.push_str(line);
            }
            self.out.push('\n');
        }
    }

    /// An empty line; not at the start of a block.
    pub fn blank(&mut self) {
        if !self.out.ends_with("{\n") {
            self.out.push('\n');
        }
    }

    /// A line behind which the text is indented.
    pub fn open(&mut self, line: &str) {
        self.line(line);
        self.depth += 1;
    }

    /// The line that ends what [`Text::open`] began.
    pub fn close(&mut self, line: &str) {
        self.depth = self.depth.saturating_sub(1);
        self.line(line);
    }

    /// A documentation comment; lines stay lines.
    pub fn doc(&mut self, text: &str) {
        for line in text.split('\n') {
            self.line(format!("/// {line}").trim_end());
        }
    }

    /// A text as a raw string between `before` and `after`. Its own lines are not indented.
    pub fn string(&mut self, before: &str, text: &str, after: &str) {
        let mut marks = 1;
        while text.contains(&format!("\"{}", "#".repeat(marks))) {
            marks += 1;
        }
        let marks = "#".repeat(marks);
        self.out.extend(std::iter::repeat_n(' ', self.depth * 4));
        self.out.push_str(&format!("{before}r{marks}\"{text}\"{marks}{after}\n"));
    }

    /// A public field of a struct.
    pub fn field(&mut self, name: &str, ty: &str) {
        let one = format!("pub {name}: {ty},");
        if self.indent() + one.len() <= WIDTH {
            self.line(&one);
        } else {
            self.line(&format!("pub {name}:\n    {ty},"));
        }
    }

    /// A function's head, with its arguments in one line or one a line.
    pub fn function(&mut self, name: &str, arguments: &[&str], result: &str) {
        let one = format!("pub fn {name}({}) -> {result} {{", arguments.join(", "));
        if self.indent() + one.len() <= WIDTH {
            self.open(&one);
            return;
        }
        self.open(&format!("pub fn {name}("));
        for argument in arguments {
            self.line(&format!("{argument},"));
        }
        self.close(&format!(") -> {result} {{"));
        self.depth += 1;
    }

    /// All of it.
    pub fn finish(self) -> String {
        self.out
    }
}
