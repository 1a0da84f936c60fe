//! `summary.json`: what went in, how it was used, what came out.

use frfit_formats::{FormatError, Position};
use serde_json::Value;

/// The summary; what is asked for by name is there or is told to be missing.
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
        if !summary.is_several() {
            summary.text("/identify/method")?;
            summary.text("/identify/selection")?;
            summary.text("/identify/varies")?;
        }
        Ok(summary)
    }

    /// Whether several things were unknown, or one that does not vary.
    pub(crate) fn is_several(&self) -> bool {
        self.0.get("unknowns").is_some_and(Value::is_array)
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

    /// The tables that this run has written.
    pub(crate) fn tables(&self) -> Result<Vec<String>, FormatError> {
        self.texts("/tables", |value| value.as_str())
    }

    /// The labels of the sensors.
    pub(crate) fn sensors(&self) -> Result<Vec<String>, FormatError> {
        self.texts("/sensors", |value| value.get("label")?.as_str())
    }

    /// Whether the factor is real.
    pub(crate) fn real(&self) -> bool {
        self.0.pointer("/identify/real").and_then(Value::as_bool).unwrap_or(false)
    }

    /// The names of the matrices that share the factor, or of the unknowns.
    pub(crate) fn names(&self) -> String {
        if self.is_several() {
            let name = |one: &Value| Some(one.get("name")?.as_str()?.to_owned());
            return self.array("/unknowns").iter().filter_map(name).collect::<Vec<_>>().join(", ");
        }
        self.array("/identify/matrix").iter().filter_map(Value::as_str).collect::<Vec<_>>().join(", ")
    }

    /// `stiffness`, `mass` or `viscous`: what the first of them is.
    pub(crate) fn role(&self) -> &str {
        let first = self.0.pointer("/identify/matrix/0");
        let matrices = self.array("/model/matrices").iter();
        let role = matrices
            .filter(|matrix| matrix.get("name") == first)
            .find_map(|matrix| matrix.get("role")?.as_str());
        role.unwrap_or("stiffness")
    }

    pub(super) fn texts<'v>(
        &'v self,
        pointer: &str,
        text: impl Fn(&'v Value) -> Option<&'v str>,
    ) -> Result<Vec<String>, FormatError> {
        let all = self
            .0
            .pointer(pointer)
            .and_then(Value::as_array)
            .ok_or_else(|| self.missing(pointer, "a list"))?;
        let one = |value| text(value).map(str::to_owned).ok_or_else(|| self.missing(pointer, "text"));
        all.iter().map(one).collect()
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
