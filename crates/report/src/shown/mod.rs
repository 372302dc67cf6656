//! Pictures of what is in a file: functions over frequency, and curves of a joint. On a page they can be zoomed; as one SVG
//! they stand below one another.

mod functions;

use bolted_joint_figures::html::{cell, escaped, figure};
use bolted_joint_figures::{LineFigure, ResponseCurve, ResponseFigure, ResponsePanel};
use bolted_joint_files::Timestamp;

pub use functions::{DrawnFunction, FunctionGroup};

/// What is drawn of a file.
#[derive(Debug)]
pub enum ShownPicture {
    /// Functions over frequency.
    Functions(FunctionGroup),
    /// Curves in one strip, and what they show, in HTML.
    Curves(LineFigure<'static>, String),
}

/// A file on a page.
#[derive(Debug, Clone, Copy)]
pub struct ShownFile<'a> {
    /// Its name.
    pub name: &'a str,
    /// What is in it: labels and texts, of one line or several.
    pub facts: &'a [(String, String)],
    /// Its pictures.
    pub pictures: &'a [ShownPicture],
}

/// A page with a section for each file.
#[must_use]
pub fn shown_page(title: &str, files: &[ShownFile<'_>], written: Timestamp) -> String {
    let mut sections = String::new();
    for (
        number,
        &ShownFile {
            name,
            facts,
            pictures,
        },
    ) in files.iter().enumerate()
    {
        sections += &format!("<h2>{}</h2>\n", escaped(name));
        let rows = facts.iter().map(|(label, text)| {
            let lines: Vec<String> = text.lines().map(escaped).collect();
            format!(
                "<tr><th scope=\"row\">{}</th>{}</tr>\n",
                escaped(label),
                cell(&lines.join("<br>"))
            )
        });
        let rows: String = rows.collect();
        sections +=
            &format!("<div class=\"scroll\"><table><tbody>\n{rows}</tbody></table></div>\n");
        for (place, picture) in pictures.iter().enumerate() {
            sections += &match picture {
                ShownPicture::Functions(group) => group.charts(&format!("shown-{number}-{place}")),
                ShownPicture::Curves(drawing, caption) => {
                    let id = format!("shown-{number}-{place}");
                    let drawn = drawing.drawn();
                    drawn.map_or_else(String::new, |drawn| figure(&id, caption, &drawn))
                }
            };
        }
    }
    crate::page::page(title, "what is in these files", written, &sections)
}

/// All pictures as one SVG document; `None` if there is nothing that can be drawn.
#[must_use]
pub fn shown_svg(title: &str, pictures: &[ShownPicture]) -> Option<String> {
    let panels = pictures.iter().flat_map(|picture| match picture {
        ShownPicture::Functions(group) => group.panels(),
        ShownPicture::Curves(figure, caption) => vec![panel(figure, caption)],
    });
    ResponseFigure {
        title,
        note: None,
        panels: panels.collect(),
    }
    .to_svg()
}

/// The same curves as a panel among others.
fn panel(figure: &LineFigure<'_>, caption: &str) -> ResponsePanel {
    let named = |(name, scale): (&str, _)| (name.to_owned(), scale);
    ResponsePanel {
        title: match first_sentence(caption) {
            none if none.is_empty() => figure.title.to_owned(),
            sentence => sentence,
        },
        across: named(figure.across),
        up: named(figure.up),
        curves: figure
            .lines
            .iter()
            .map(|line| ResponseCurve {
                name: line.name.clone(),
                points: line.points.clone(),
                is_dashed: Vec::new(),
            })
            .collect(),
    }
}

/// The first sentence of finished HTML, without its tags.
fn first_sentence(html: &str) -> String {
    let mut text = String::new();
    let mut is_tag = false;
    for c in html.chars() {
        match c {
            '<' => is_tag = true,
            '>' => is_tag = false,
            c if !is_tag => text.push(c),
            _ => {}
        }
    }
    let end = [". ", "; "].iter().filter_map(|end| text.find(end)).min();
    let end = end.unwrap_or_else(|| text.trim_end_matches('.').len());
    text[..end].to_owned()
}

#[cfg(test)]
mod tests {
    use bolted_joint_figures::{Line, Scale};
    use num_complex::Complex64;

    use super::*;

    fn group() -> ShownPicture {
        let frequency_hz: Vec<f64> = (1..=50).map(f64::from).collect();
        let values = |natural: f64| {
            let value =
                |&hz: &f64| 1.0 / Complex64::new(natural.powi(2) - hz * hz, 0.02 * natural * hz);
            frequency_hz.iter().map(value).collect::<Vec<_>>()
        };
        ShownPicture::Functions(FunctionGroup {
            title: "load at 1:+Y".to_owned(),
            unit: "m/N",
            functions: [20.0, 30.0]
                .map(|natural| DrawnFunction {
                    label: format!("{natural}:+Y <1>"),
                    values: values(natural),
                    coherence: (natural < 25.0).then(|| vec![0.9; frequency_hz.len()]),
                })
                .into(),
            frequency_hz,
        })
    }

    #[test]
    fn a_page_has_a_chart_with_magnitude_phase_and_coherence_and_the_facts() {
        let facts = [("lines".to_owned(), "50\nfrom <1> Hz".to_owned())];
        let written = Timestamp::from_environment().unwrap();
        let file = ShownFile {
            name: "a.uff",
            facts: &facts,
            pictures: &[group()],
        };
        let page = shown_page("x", &[file], written);
        for expected in [
            "50<br>from &lt;1&gt; Hz",
            "id=\"shown-0-0-1\"",
            ">magnitude, m/N</text>",
            ">phase, °</text>",
            ">coherence γ²</text>",
            "20:+Y &lt;1&gt;",
        ] {
            assert!(page.contains(expected), "{expected}");
        }
    }

    #[test]
    fn pictures_of_all_kinds_stand_in_one_svg() {
        let curves = LineFigure {
            title: "load",
            across: ("mm", Scale::Linear),
            up: ("force, N", Scale::Linear),
            lines: vec![Line::curve("spring", [(0.0, 0.0), (1.0, 2.0)])],
        };
        let pictures = [group(), ShownPicture::Curves(curves, String::new())];
        let svg = shown_svg("both", &pictures).unwrap();
        for expected in [
            "load at 1:+Y: magnitude",
            ">coherence γ²</text>",
            ">force, N</text>",
        ] {
            assert!(svg.contains(expected), "{expected}");
        }
        assert!(shown_svg("none", &[]).is_none());
    }
}
