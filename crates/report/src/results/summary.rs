//! `summary.json`: what went in, how it was used, what came out.

use frfit_formats::{FormatError, Position};
use serde_json::Value;

/// The summary; what is asked for by name is there, or an error says that it is missing.
#[derive(Debug)]
pub(crate) struct Summary(pub(crate) Value);

impl Summary {
    pub(crate) fn read(bytes: &[u8]) -> Result<Self, FormatError> {
        let value: Value = serde_json::from_slice(bytes).map_err(|error| FormatError {
            position: Position::Line { line: error.line(), column: Some(error.column().max(1)) },
            ..FormatError::whole("JSON", error.to_string())
        })?;
        let summary = Self(value);
        // What every page needs: the rest may be null or missing.
        summary.text("/title")?;
        summary.text("/frfit")?;
        summary.text("/identify/method")?;
        summary.text("/identify/selection")?;
        Ok(summary)
    }

    /// Text at a JSON pointer.
    pub(crate) fn text(&self, pointer: &str) -> Result<&str, FormatError> {
        self.0.pointer(pointer).and_then(Value::as_str).ok_or_else(|| self.missing(pointer, "text"))
    }

    /// Text that may be missing.
    pub(crate) fn word(&self, pointer: &str) -> &str {
        self.0.pointer(pointer).and_then(Value::as_str).unwrap_or("")
    }

    /// A number that may be missing.
    pub(crate) fn number(&self, pointer: &str) -> Option<f64> {
        self.0.pointer(pointer).and_then(Value::as_f64)
    }

    /// Elements of an array that may be missing.
    pub(crate) fn array(&self, pointer: &str) -> &[Value] {
        self.0.pointer(pointer).and_then(Value::as_array).map_or(&[], Vec::as_slice)
    }

    /// Whether the data decide for one of the findings.
    fn is_decided(&self) -> bool {
        let has_evidence = |finding: &Value| finding.get("evidence").is_some_and(Value::is_object);
        self.array("/findings").iter().any(has_evidence)
    }

    /// Explanations of the data between which they do not decide.
    pub(crate) fn undecided(&self) -> &[Value] {
        if self.is_decided() { &[] } else { self.array("/other_explanations") }
    }

    /// The tables that this run has written.
    pub(crate) fn tables(&self) -> Result<Vec<String>, FormatError> {
        self.texts("/tables", |value| value.as_str())
    }

    /// The labels of the sensors.
    pub(crate) fn sensors(&self) -> Result<Vec<String>, FormatError> {
        self.texts("/sensors", |value| value.get("label")?.as_str())
    }

    /// `stiffness`, `mass` or `viscous`: what a matrix is.
    pub(crate) fn role(&self, matrix: &str) -> String {
        let mut matrices = self.array("/model/matrices").iter();
        let role = matrices.find(|one| one["name"] == matrix).and_then(|one| one["role"].as_str());
        role.unwrap_or("stiffness").to_owned()
    }

    /// Elements of an array.
    pub(super) fn list(&self, pointer: &str) -> Result<&[Value], FormatError> {
        let list = self.0.pointer(pointer).and_then(Value::as_array);
        list.map(Vec::as_slice).ok_or_else(|| self.missing(pointer, "a list"))
    }

    pub(super) fn texts<'v>(
        &'v self,
        pointer: &str,
        text: impl Fn(&'v Value) -> Option<&'v str>,
    ) -> Result<Vec<String>, FormatError> {
        let one = |value| text(value).map(str::to_owned).ok_or_else(|| self.missing(pointer, "text"));
        self.list(pointer)?.iter().map(one).collect()
    }

    pub(super) fn missing(&self, pointer: &str, what: &str) -> FormatError {
        let key = pointer[1..].replace('/', ".");
        let found = self.0.pointer(pointer).map_or("none".to_owned(), |value| {
            let text = value.to_string();
            text.chars().take(40).collect()
        });
        FormatError::whole(format!("{what} in {key}, as frfit identify of this version writes it"), found)
    }
}
