//! Writing of SVG text: elements that close, attributes and texts that are escaped, paths that stay short.

use std::fmt::Write;

use super::strip::TEXT;

/// An SVG document in the making. Elements opened and not closed are closed at the end.
#[derive(Debug)]
pub struct Svg {
    text: String,
    open: Vec<&'static str>,
}

/// An element whose attributes are being written.
#[must_use = "an element needs an end: `empty`, `containing` or `open`"]
#[derive(Debug)]
pub struct Element<'svg> {
    svg: &'svg mut Svg,
    name: &'static str,
}

/// How a line of text stands at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Manner {
    /// It begins there.
    Plain,
    /// It begins there, in bold.
    Bold,
    /// Its middle is there.
    Middle,
    /// It ends there.
    End,
}

/// How a line of text looks, and how it stands at its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lettering {
    font: f64,
    manner: Manner,
    fill: &'static str,
}

impl Lettering {
    /// Of a size in pixels, in the colour of text.
    pub const fn new(font: f64, manner: Manner) -> Self {
        Self {
            font,
            manner,
            fill: TEXT,
        }
    }

    /// In another colour.
    #[must_use]
    pub const fn in_colour(self, fill: &'static str) -> Self {
        Self { fill, ..self }
    }
}

impl Svg {
    /// A document of the given size in pixels. `title` is read out to those who cannot see the picture.
    pub fn new(width: f64, height: f64, title: &str) -> Self {
        let mut svg = Self {
            text: String::new(),
            open: Vec::new(),
        };
        svg.element("svg")
            .word("xmlns", "http://www.w3.org/2000/svg")
            .word(
                "viewBox",
                &format!("0 0 {} {}", Decimal(width), Decimal(height)),
            )
            .number("width", width)
            .number("height", height)
            .word("role", "img")
            .open();
        svg.element("title").containing(title);
        svg
    }

    /// Starts an element inside the one that is open.
    pub fn element(&mut self, name: &'static str) -> Element<'_> {
        let _ = write!(self.text, "<{name}");
        Element { svg: self, name }
    }

    /// White paper, with round corners of a radius if they are, and the fonts of everything on it.
    pub fn paper(&mut self, width: f64, height: f64, radius: Option<f64>, fonts: &str) {
        let sheet = self.element("rect").number("width", width);
        let sheet = sheet.number("height", height);
        let sheet = match radius {
            Some(radius) => sheet.number("rx", radius),
            None => sheet,
        };
        sheet.word("fill", "#ffffff").empty();
        self.element("g").word("font-family", fonts).open();
    }

    /// A line of text at a place.
    pub fn text(&mut self, (x, y): (f64, f64), lettering: Lettering, text: &str) {
        let line = self.element("text").number("x", x).number("y", y);
        let line = line.number("font-size", lettering.font);
        let line = match lettering.manner {
            Manner::Plain => line,
            Manner::Bold => line.word("font-weight", "600"),
            Manner::Middle => line.word("text-anchor", "middle"),
            Manner::End => line.word("text-anchor", "end"),
        };
        line.word("fill", lettering.fill).containing(text);
    }

    /// Escaped text inside the element that is open.
    pub fn characters(&mut self, text: &str) {
        escape(text, &mut self.text);
    }

    /// Closes the element opened last.
    pub fn close(&mut self) {
        if let Some(name) = self.open.pop() {
            let _ = writeln!(self.text, "</{name}>");
        }
    }

    /// The finished document.
    pub fn finish(mut self) -> String {
        while !self.open.is_empty() {
            self.close();
        }
        self.text
    }
}

impl Element<'_> {
    /// An attribute that is a number, in pixels.
    pub fn number(self, name: &str, value: f64) -> Self {
        let _ = write!(self.svg.text, " {name}=\"{}\"", Decimal(value));
        self
    }

    /// An attribute that is a text.
    pub fn word(self, name: &str, value: &str) -> Self {
        let _ = write!(self.svg.text, " {name}=\"");
        escape(value, &mut self.svg.text);
        self.svg.text.push('"');
        self
    }

    /// Ends an element without content.
    pub fn empty(self) {
        self.svg.text.push_str("/>\n");
    }

    /// Ends an element that contains `text` alone.
    pub fn containing(self, text: &str) {
        let Self { svg, name } = self;
        svg.text.push('>');
        svg.characters(text);
        let _ = writeln!(svg.text, "</{name}>");
    }

    /// The same without a line break after it, for use within a text, where white space counts.
    pub fn containing_inline(self, text: &str) {
        let Self { svg, name } = self;
        svg.text.push('>');
        svg.characters(text);
        let _ = write!(svg.text, "</{name}>");
    }

    /// Leaves the element open for others, until [`Svg::close`].
    pub fn open(self) {
        self.svg.text.push('>');
        self.svg.open.push(self.name);
    }
}

/// Appends `text` with the five characters replaced that XML reserves, and those that it forbids.
fn escape(text: &str, into: &mut String) {
    for character in text.chars() {
        match character {
            '&' => into.push_str("&amp;"),
            '<' => into.push_str("&lt;"),
            '>' => into.push_str("&gt;"),
            '"' => into.push_str("&quot;"),
            '\'' => into.push_str("&#39;"),
            '\t' | '\n' | '\r' => into.push(' '),
            '\u{0}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => into.push('\u{fffd}'),
            other => into.push(other),
        }
    }
}

/// A length in pixels, written with two decimals at most and no zeros to spare.
struct Decimal(f64);

impl std::fmt::Display for Decimal {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write_hundredths(hundredths(self.0), formatter)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "lengths on a page are small; `as` saturates for any other"
)]
fn hundredths(length: f64) -> i64 {
    (100.0 * length).round() as i64
}

fn write_hundredths(value: i64, into: &mut impl Write) -> std::fmt::Result {
    let sign = if value < 0 { "-" } else { "" };
    let (whole, rest) = (value.unsigned_abs() / 100, value.unsigned_abs() % 100);
    match (whole, rest) {
        (_, 0) => write!(into, "{sign}{whole}"),
        (0, _) if rest % 10 == 0 => write!(into, "{sign}.{}", rest / 10),
        (0, _) => write!(into, "{sign}.{rest:02}"),
        (_, _) if rest % 10 == 0 => write!(into, "{sign}{whole}.{}", rest / 10),
        (_, _) => write!(into, "{sign}{whole}.{rest:02}"),
    }
}

/// A point on the page, pixels, y downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// To the right.
    pub x: f64,
    /// Downwards.
    pub y: f64,
}

/// The `d` attribute of a path. Points are rounded to hundredths first and written as differences of the rounded
/// ones, so that rounding does not add up along the path.
#[derive(Debug, Default)]
pub struct PathData {
    text: String,
    pen: (i64, i64),
}

impl PathData {
    /// Lifts the pen and sets it down at `point`.
    pub fn move_to(&mut self, point: Point) {
        self.advance('m', point);
    }

    /// Draws a straight line to `point`.
    pub fn line_to(&mut self, point: Point) {
        self.advance('l', point);
    }

    /// Draws a line through `points`; through a single one, a dot.
    pub fn polyline(&mut self, points: &[Point]) {
        let Some((&first, rest)) = points.split_first() else {
            return;
        };
        self.move_to(first);
        for &point in rest {
            self.line_to(point);
        }
        if rest.is_empty() {
            self.dot();
        }
    }

    /// A dot where the pen is, visible if the line's ends are round.
    pub fn dot(&mut self) {
        self.text.push_str("h0");
    }

    fn advance(&mut self, command: char, point: Point) {
        let target = (hundredths(point.x), hundredths(point.y));
        let (dx, dy) = (target.0 - self.pen.0, target.1 - self.pen.1);
        self.pen = target;
        self.text.push(command);
        let _ = write_hundredths(dx, &mut self.text);
        if dy >= 0 {
            self.text.push(' ');
        }
        let _ = write_hundredths(dy, &mut self.text);
    }

    /// Whether nothing has been drawn.
    pub fn is_empty(&self) -> bool {
        self.text.is_empty()
    }

    /// The attribute's text.
    pub fn as_str(&self) -> &str {
        &self.text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_and_attributes_are_escaped() {
        let mut svg = Svg::new(10.0, 20.0, "a < b & \"c\" > 'd'");
        svg.element("text")
            .word("id", "\"<&\u{1}\n")
            .containing("x\u{0}<y>");
        let text = svg.finish();
        assert!(text.contains("<title>a &lt; b &amp; &quot;c&quot; &gt; &#39;d&#39;</title>"));
        assert!(text.contains("<text id=\"&quot;&lt;&amp;\u{fffd} \">x\u{fffd}&lt;y&gt;</text>"));
    }

    #[test]
    fn open_elements_are_closed_in_order() {
        let mut svg = Svg::new(1.0, 1.5, "");
        svg.element("g").open();
        svg.element("g").number("x", -0.25).open();
        svg.close();
        svg.element("text").open();
        let text: String = svg.finish().split('\n').collect();
        assert!(text.ends_with("<title></title><g><g x=\"-.25\"></g><text></text></g></svg>"));
        assert!(text.contains("viewBox=\"0 0 1 1.5\""));
    }

    #[test]
    fn lengths_have_two_decimals_at_most() {
        let written = [
            0.0, -0.001, 0.5, -0.5, 0.05, 12.0, 12.3, -12.345, 1e3, 99.999,
        ]
        .map(|length| Decimal(length).to_string());
        let expected = [
            "0", "0", ".5", "-.5", ".05", "12", "12.3", "-12.35", "1000", "100",
        ];
        assert_eq!(written, expected);
    }

    #[test]
    fn a_path_does_not_drift() {
        let mut path = PathData::default();
        let points: Vec<Point> = (0..1000_u32)
            .map(|k| Point {
                x: 0.004 * f64::from(k),
                y: 1.0,
            })
            .collect();
        path.polyline(&points);
        let dx =
            |step: &str| -> f64 { step.split(' ').next().expect("dx").parse().expect("number") };
        let end: f64 = path.as_str()[1..].split('l').map(dx).sum();
        assert!((end - 0.004 * 999.0).abs() <= 0.005);
    }

    #[test]
    fn differences_are_separated_by_a_space_or_a_sign() {
        let mut path = PathData::default();
        path.polyline(&[Point { x: 1.0, y: 2.5 }, Point { x: 1.5, y: 2.0 }]);
        path.polyline(&[Point { x: 0.0, y: 3.0 }]);
        assert_eq!(path.as_str(), "m1 2.5l.5-.5m-1.5 1h0");
    }
}
