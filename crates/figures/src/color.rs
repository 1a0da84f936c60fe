//! Colours that stay apart for colour-blind readers and in grey print.

/// The palette for curves, markers, bands and classes.
///
/// # Source
/// M. Okabe, K. Ito, *Color Universal Design*, 2008; `Grey` is added for what stands back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs)] // the names say it
pub enum Color {
    #[default]
    Black,
    Blue,
    Vermilion,
    Green,
    Orange,
    SkyBlue,
    Purple,
    Yellow,
    Grey,
}

impl Color {
    /// The colour as SVG writes it.
    pub(crate) fn hex(self) -> &'static str {
        match self {
            Self::Black => "#000000",
            Self::Blue => "#0072b2",
            Self::Vermilion => "#d55e00",
            Self::Green => "#009e73",
            Self::Orange => "#e69f00",
            Self::SkyBlue => "#56b4e9",
            Self::Purple => "#cc79a7",
            Self::Yellow => "#f0e442",
            Self::Grey => "#808080",
        }
    }
}

/// Fill of a cell without a value: on no place of the colour map.
pub(crate) const MISSING: &str = "#c8c8c8";

/// The perceptually uniform map viridis at `level` of 0..=255.
pub(crate) fn viridis(level: u8) -> String {
    format!("#{:x}", colorous::VIRIDIS.eval_rational(level.into(), 256))
}

#[cfg(test)]
mod tests {
    use super::viridis;

    #[test]
    fn viridis_runs_from_dark_violet_to_yellow() {
        assert_eq!(viridis(0), "#440154");
        assert_eq!(viridis(255), "#fde725");
    }
}
