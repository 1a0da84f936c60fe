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

/// A colour as `#rrggbb`, in figures and on pages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shades {
    /// In figures, which are white.
    pub figure: &'static str,
    /// On a page with a light ground.
    pub light: &'static str,
    /// On a page with a dark ground.
    pub dark: &'static str,
}

impl Color {
    /// The colour in figures and on pages.
    pub fn shades(self) -> Shades {
        let [figure, light, dark] = match self {
            Self::Black => ["#000000", "#3b4651", "#5d6a78"],
            Self::Blue => ["#0072b2", "#0072b2", "#5fb8f0"],
            Self::Vermilion => ["#d55e00", "#d55e00", "#ff8f52"],
            Self::Green => ["#009e73", "#008a65", "#2fc195"],
            Self::Orange => ["#e69f00", "#b07800", "#b5893a"],
            Self::SkyBlue => ["#56b4e9", "#56b4e9", "#a8e0ff"],
            Self::Purple => ["#cc79a7", "#b0509a", "#d98bc6"],
            Self::Yellow => ["#f0e442", "#e0a100", "#f0b93a"],
            Self::Grey => ["#808080", "#8a94a0", "#8f9ba8"],
        };
        Shades { figure, light, dark }
    }

    /// The colour as SVG writes it.
    pub(crate) fn hex(self) -> &'static str {
        self.shades().figure
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
