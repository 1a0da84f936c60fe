//! What is said to a person about a result, line by line.

/// Lines for a person, and those of them that must not be missed.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Words {
    /// All lines, each ended by a line feed.
    pub all: String,
    /// Of them warnings and findings.
    pub warnings: String,
}

impl Words {
    /// Adds lines, each ended by a line feed.
    pub fn say(&mut self, lines: &str) {
        self.all += lines;
    }

    /// Adds lines that must not be missed.
    pub fn warn(&mut self, lines: &str) {
        self.all += lines;
        self.warnings += lines;
    }

    /// Adds lines, which must not be missed where `is_warning`.
    pub fn add(&mut self, is_warning: bool, lines: &str) {
        if is_warning { self.warn(lines) } else { self.say(lines) }
    }
}
