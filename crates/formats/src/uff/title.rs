//! The line with the number of a dataset.

use super::entry::BinaryForm;
use super::lines::is_blank;

/// The line with the number of a dataset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Title {
    /// Dataset number.
    pub(super) dataset: u32,
    byte_order: u8,
    float_format: u8,
    /// Bytes of the data, for a binary dataset; 0 where the line does not say.
    pub(super) binary_length: Option<u64>,
}

impl Title {
    /// FORMAT(I6,1A1,I6,I6,I12,I12,I6,I6,I12,I12): number, `b`, byte order, floating point format, lines of
    /// text, bytes of data. `None` where the line does not begin with a number, or goes on without `b`.
    pub(super) fn read(line: &[u8]) -> Option<Self> {
        let line = line.trim_ascii_start();
        let digits = line.iter().take_while(|byte| byte.is_ascii_digit()).count();
        let (number, rest) = line.split_at_checked(digits)?;
        let dataset: u32 = std::str::from_utf8(number).ok()?.parse().ok()?;
        match rest.first() {
            Some(b'b' | b'B') => {}
            _ if rest.iter().copied().all(is_blank) => {
                return Some(Self { dataset, byte_order: 0, float_format: 0, binary_length: None });
            }
            _ => return None,
        }
        let field = |from: usize, width: usize| {
            let end = rest.len().min(from + width);
            std::str::from_utf8(rest.get(from..end)?).ok()?.trim().parse::<u64>().ok()
        };
        let code = |from| field(from, 6).and_then(|value| u8::try_from(value).ok()).unwrap_or(0);
        Some(Self {
            dataset,
            byte_order: code(1),
            float_format: code(7),
            binary_length: Some(field(25, 12).unwrap_or(0)),
        })
    }

    /// How the data are stored, for a binary dataset.
    pub(super) fn binary_form(self) -> Option<BinaryForm> {
        let Self { byte_order, float_format, .. } = self;
        self.binary_length.map(|_| BinaryForm { byte_order, float_format })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_title_of_binary_data() {
        let title = Title::read(b"    58b     2     2          11        2000     0     0").expect("a title");
        assert_eq!(title, Title { dataset: 58, byte_order: 2, float_format: 2, binary_length: Some(2000) });
        assert_eq!(Title::read(b"    58b").and_then(|title| title.binary_length), Some(0));
        assert_eq!(Title::read(b"  2411 \r").map(|title| title.dataset), Some(2411));
        assert_eq!(Title::read(b"    58 12"), None);
        assert_eq!(Title::read(b"  1.5"), None);
    }
}
