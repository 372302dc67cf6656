//! How a curve is drawn: its colour, its width, and whether it is a line or dots.

use super::svg::{PathData, Svg};

/// The look of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// As SVG writes it.
    pub colour: &'static str,
    /// Pixels.
    pub width: f64,
    /// As SVG writes them; none for a line without gaps.
    pub dashes: Option<&'static str>,
    /// Whether only the values themselves are drawn and nothing between them.
    pub is_dots: bool,
}

impl Look {
    /// A line without gaps.
    #[must_use]
    pub const fn line(colour: &'static str, width: f64) -> Self {
        Self {
            colour,
            width,
            dashes: None,
            is_dots: false,
        }
    }

    /// A line of dashes.
    #[must_use]
    pub const fn dashed(colour: &'static str, width: f64, dashes: &'static str) -> Self {
        Self {
            dashes: Some(dashes),
            ..Self::line(colour, width)
        }
    }

    /// Dots and no line.
    #[must_use]
    pub const fn dots(colour: &'static str, width: f64) -> Self {
        Self {
            is_dots: true,
            ..Self::line(colour, width)
        }
    }

    /// Draws `path`; nothing if it is empty.
    pub fn draw(self, path: &PathData, svg: &mut Svg) {
        if path.is_empty() {
            return;
        }
        let element = svg
            .element("path")
            .word("d", path.as_str())
            .word("fill", "none")
            .word("stroke", self.colour)
            .number("stroke-width", self.width)
            .word("stroke-linejoin", "round");
        match self.dashes {
            Some(dashes) => element.word("stroke-dasharray", dashes),
            None => element.word("stroke-linecap", "round"),
        }
        .empty();
    }
}
