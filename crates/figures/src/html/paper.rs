//! How large the letters of a table may be on paper, where it cannot scroll and its words and numbers are to stay whole.

use super::LONGEST_WORD;

/// Widths in heights of letters: of A4 within its margins at the page's size of print (182 mm at 9.5 pt), of a letter, and of
/// the space around a cell's text.
const PAPER: f64 = 54.3;
const LETTER: f64 = 0.6;
const SPACE: f64 = 1.15;
const SMALLEST: f64 = 0.5;
/// Letters of a check sum, which may break anywhere, in one line.
const PART_OF_SUM: usize = 12;

/// The attribute that makes a table of these headings and rows fit; empty where it does so anyway.
pub(super) fn style(headings: &str, rows: &[String]) -> String {
    let mut widths: Vec<usize> = Vec::new();
    for row in std::iter::once(headings).chain(rows.iter().map(String::as_str)) {
        // The cells after one that spans several columns stand further right; too narrow a column is no harm there.
        for (column, width) in cells(row).map(width).enumerate() {
            match widths.get_mut(column) {
                Some(widest) => *widest = width.max(*widest),
                None => widths.push(width),
            }
        }
    }
    let needed: f64 = widths
        .iter()
        .map(|&letters| LETTER * letters as f64 + SPACE)
        .sum();
    match PAPER / needed {
        fit if fit < 1.0 => format!(" style=\"--fit: {:.2}\"", fit.max(SMALLEST)),
        _ => String::new(),
    }
}

/// Attributes and content of each cell.
fn cells(row: &str) -> impl Iterator<Item = (&str, &str)> {
    row.split("<t").filter_map(|piece| {
        let (attributes, rest) = piece.split_once('>')?;
        let is_cell = attributes.starts_with(['d', 'h']);
        is_cell.then_some((attributes, rest.split("</t").next().unwrap_or_default()))
    })
}

/// Letters of the longest piece of a cell that does not break.
fn width((attributes, html): (&str, &str)) -> usize {
    let mut text = String::new();
    for (number, piece) in html.replace("<br>", "\n").split('<').enumerate() {
        // Behind `<` a tag ends first.
        text += match number {
            0 => piece,
            _ => piece.split_once('>').map_or("", |(_, behind)| behind),
        };
    }
    let breaks: &[char] = match attributes.contains("\"number\"") {
        true => &['\n'],
        false => &[' ', '\n'],
    };
    let longest = text.split(breaks).map(|piece| piece.chars().count()).max();
    let most = match () {
        () if attributes.contains("\"hash\"") => PART_OF_SUM,
        () if attributes.contains("\"long\"") => LONGEST_WORD,
        () if attributes.contains("colspan") => 0,
        () => usize::MAX,
    };
    longest.unwrap_or(0).min(most)
}

#[cfg(test)]
mod tests {
    use super::super::{cell, number_cell};
    use super::*;

    #[test]
    fn a_number_is_one_piece_and_a_text_is_its_longest_word() {
        for (html, expected) in [
            (number_cell("1.5 … 2.5 × 10<sup>3</sup>"), 15),
            (number_cell("1.5<br><small>± 0.25</small>"), 6),
            (cell("of the joint"), 5),
            (cell(&"x".repeat(40)), LONGEST_WORD),
            ("<th><i>k</i><sub>yy</sub></th>".to_owned(), 3),
            (
                "<td class=\"open\" colspan=\"2\">not identified</td>".to_owned(),
                0,
            ),
        ] {
            assert_eq!(cells(&html).map(width).collect::<Vec<_>>(), [expected]);
        }
    }

    #[test]
    fn only_a_wide_table_gets_small_letters() {
        let row = |columns: usize| vec![number_cell("123456.7890").repeat(columns)];
        assert_eq!(style("<th>a</th>", &row(6)), "");
        // 9·(11·0.6 + 1.15) = 69.75
        assert_eq!(style("<th>a</th>", &row(9)), " style=\"--fit: 0.78\"");
        assert_eq!(style("<th>a</th>", &row(40)), " style=\"--fit: 0.50\"");
    }
}
