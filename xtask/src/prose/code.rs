//! The prose in source code: doc comments and string literals. All else becomes `|`, so that no words join across it.

/// Stands for code.
const CODE: char = '|';

/// Doc comments and string literals of Rust, on the lines where they stand.
pub(super) fn of_rust(text: &str) -> String {
    let mut prose = Prose::of(text);
    while let Some(next) = prose.peek(0) {
        let is_doc = prose.is_at("///") && prose.peek(3) != Some('/') || prose.is_at("//!");
        if is_doc {
            prose.blank(3);
            prose.keep_line();
        } else if prose.is_at("//") {
            prose.skip_line();
        } else if prose.is_at("/*") {
            prose.skip(2);
            prose.skip_past("*/");
        } else if let Some(hashes) = prose.raw_string() {
            prose.keep_past(&format!("\"{}", "#".repeat(hashes)), false);
        } else if next == '"' {
            prose.skip(1);
            prose.keep_past("\"", true);
        } else if next == '\'' {
            // A character, or the name of a lifetime.
            let count = match (prose.peek(1), prose.peek(2)) {
                (Some('\\'), _) => 3,
                (_, Some('\'')) => 2,
                _ => 1,
            };
            prose.skip(count);
            if count > 1 {
                prose.skip_past("'");
            }
        } else {
            prose.pass();
        }
    }
    without_code(&prose.out)
}

/// String literals of Python, doc strings among them.
pub(super) fn of_python(text: &str) -> String {
    let mut prose = Prose::of(text);
    while let Some(next) = prose.peek(0) {
        if next == '#' {
            prose.skip_line();
        } else if let Some(quotes) =
            ["\"\"\"", "'''", "\"", "'"].into_iter().find(|quotes| prose.is_at(quotes))
        {
            prose.skip(quotes.len());
            prose.keep_past(quotes, true);
        } else {
            prose.pass();
        }
    }
    without_code(&prose.out)
}

/// Pieces between backticks are code there too.
fn without_code(prose: &str) -> String {
    let line = |line: &str| {
        let mut is_code = false;
        let keep = |c: char| {
            is_code ^= c == '`';
            if is_code || c == '`' { CODE } else { c }
        };
        line.chars().map(keep).collect::<String>()
    };
    prose.lines().map(line).collect::<Vec<_>>().join("\n")
}

/// What is read, how far, and what it became.
struct Prose {
    text: Vec<char>,
    at: usize,
    out: String,
}

impl Prose {
    fn of(text: &str) -> Self {
        Self { text: text.chars().collect(), at: 0, out: String::with_capacity(text.len()) }
    }

    fn peek(&self, ahead: usize) -> Option<char> {
        self.text.get(self.at + ahead).copied()
    }

    fn is_at(&self, what: &str) -> bool {
        what.chars().enumerate().all(|(k, c)| self.peek(k) == Some(c))
    }

    /// One character becomes another one; the end of a line stays.
    fn put(&mut self, other: impl Fn(char) -> char) {
        if let Some(c) = self.peek(0) {
            self.out.push(if c == '\n' { c } else { other(c) });
            self.at += 1;
        }
    }

    /// A character of code. Spaces stay: doc comments of two lines belong together.
    fn pass(&mut self) {
        self.put(|c| if c.is_whitespace() { c } else { CODE });
    }

    fn skip(&mut self, count: usize) {
        (0..count).for_each(|_| self.put(|_| CODE));
    }

    fn blank(&mut self, count: usize) {
        (0..count).for_each(|_| self.put(|_| ' '));
    }

    fn skip_line(&mut self) {
        while self.peek(0).is_some_and(|c| c != '\n') {
            self.skip(1);
        }
    }

    fn keep_line(&mut self) {
        while self.peek(0).is_some_and(|c| c != '\n') {
            self.put(|c| c);
        }
    }

    fn skip_past(&mut self, end: &str) {
        while self.peek(0).is_some() && !self.is_at(end) {
            self.skip(1);
        }
        self.skip(end.chars().count());
    }

    /// Keeps a literal up to its end. A backslash at the end of a line joins two lines, any other is an escape.
    fn keep_past(&mut self, end: &str, has_escapes: bool) {
        while self.peek(0).is_some() && !self.is_at(end) {
            match (has_escapes && self.is_at("\\"), self.peek(1)) {
                (true, Some('\n')) => self.blank(2),
                (true, _) => self.skip(2),
                (false, _) => self.put(|c| c),
            }
        }
        self.skip(end.chars().count());
    }

    /// Passes the begin of a raw string, and says how many hashes it has.
    fn raw_string(&mut self) -> Option<usize> {
        let is_of_name = |c: char| c.is_alphanumeric() || c == '_';
        let prefix = if self.is_at("br") { 2 } else { usize::from(self.is_at("r")) };
        let before = self.at.checked_sub(1).and_then(|at| self.text.get(at));
        if prefix == 0 || before.is_some_and(|c| is_of_name(*c)) {
            return None;
        }
        let hashes = (0..).take_while(|k| self.peek(prefix + k) == Some('#')).count();
        (self.peek(prefix + hashes) == Some('"')).then(|| {
            self.skip(prefix + hashes + 1);
            hashes
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The words of a text without its code.
    fn words(prose: &str) -> Vec<&str> {
        prose.split(|c: char| c == CODE || c.is_whitespace()).filter(|word| !word.is_empty()).collect()
    }

    #[test]
    fn doc_comments_and_strings_of_rust_are_kept() {
        let text = "//! Head.\n/// Of `this` item,\n    /// in two lines.\nfn f<'a>(x: &'a str) -> char {\n    // why\n    //// rule\n\
                    /* block */ g(\"one \\\"two\\\" \\\n three\", 'x', '\\'', '\"', r\"raw\", r#\"a \"b\" c\"#, b\"bytes\");\n    for_r\n}\n";
        let prose = of_rust(text);
        assert_eq!(
            words(&prose),
            [
                "Head.", "Of", "item,", "in", "two", "lines.", "one", "two", "three", "raw", "a", "\"b\"",
                "c", "bytes"
            ]
        );
        assert_eq!(prose.lines().count(), text.lines().count());
        assert_eq!(prose.lines().nth(1).unwrap().trim(), "Of |||||| item,");
    }

    #[test]
    fn nothing_of_rust_is_lost_after_a_literal_that_looks_like_another() {
        for before in [
            "'\"'",
            "b'\"'",
            "'\\\\'",
            "'\\u{41}'",
            "\"\\\\\"",
            "r\"\\\"",
            "&'static str",
            "r#\"\"#",
            "var\"\"",
        ] {
            let prose = of_rust(&format!("{before} code \"kept\" code"));
            assert!(prose.ends_with(" |||| |kept| ||||"), "{before}: {prose}");
        }
    }

    #[test]
    fn strings_of_python_are_kept() {
        let text = "\"\"\"Head.\n\nText with 'quotes'.\"\"\"\ndef f(x):  # why\n    r'''doc \"string\"'''\n    return 'it\\'s', \"b\", x\n";
        let prose = of_python(text);
        assert_eq!(
            words(&prose),
            ["Head.", "Text", "with", "'quotes'.", "doc", "\"string\"", "it", "s", "b"]
        );
        assert_eq!(prose.lines().count(), text.lines().count());
    }
}
