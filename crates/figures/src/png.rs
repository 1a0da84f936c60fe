//! The SVG drawing as pixels.

use std::fmt::{Display, Formatter};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{self, Options, Tree};

use crate::Figure;

/// Longest side of a picture in pixels.
const LONGEST: f64 = 16384.0;

/// Why a figure could not be rasterised.
#[derive(Debug)]
#[non_exhaustive]
pub enum PngError {
    /// The resolution is not a positive number, or gives a picture without pixels or with a side beyond
    /// 16384 pixels. Holds width and height asked for, in pixels.
    Size {
        /// Width in pixels.
        width: f64,
        /// Height in pixels.
        height: f64,
    },
    /// The rasteriser refused the drawing.
    Svg(usvg::Error),
    /// The PNG encoder failed.
    Encode(Box<dyn std::error::Error + Send + Sync>),
}

impl Display for PngError {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Size { width, height } => {
                write!(f, "a picture of {width} × {height} pixels: expected sides of 1 to {LONGEST}")
            }
            Self::Svg(_) => write!(f, "the drawing could not be rasterised"),
            Self::Encode(_) => write!(f, "the picture could not be encoded"),
        }
    }
}

impl std::error::Error for PngError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Size { .. } => None,
            Self::Svg(cause) => Some(cause),
            Self::Encode(cause) => Some(cause.as_ref()),
        }
    }
}

impl Figure {
    /// The drawing of [`Figure::outlined_svg`] as a PNG with `pixels_per_unit` pixels to an SVG unit (1.25 makes
    /// the default size 900 pixels wide).
    ///
    /// # Errors
    /// [`PngError::Size`] if the resolution does not give a picture of usual size; the others are faults
    /// of the rasteriser.
    pub fn png(&self, pixels_per_unit: f64) -> Result<Vec<u8>, PngError> {
        let tree = Tree::from_str(&self.outlined_svg(), &Options::default()).map_err(PngError::Svg)?;
        let [width, height] = [tree.size().width(), tree.size().height()]
            .map(|side| (f64::from(side) * pixels_per_unit).round());
        let usual = |side: f64| (1.0..=LONGEST).contains(&side);
        let pixmap =
            if usual(width) && usual(height) { Pixmap::new(width as u32, height as u32) } else { None };
        let mut pixmap = pixmap.ok_or(PngError::Size { width, height })?;
        let scale = pixels_per_unit as f32;
        resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixmap.as_mut());
        pixmap.encode_png().map_err(|cause| PngError::Encode(Box::new(cause)))
    }
}
