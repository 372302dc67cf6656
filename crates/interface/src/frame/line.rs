//! A line of a frame that is one empty XML element. The frames have one for each variable and each unknown, so that no XML
//! parser is needed to fill them, and comments and spaces stay as they are.

use std::fmt;

/// `<Tag name="value" …/>` on a line of its own.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Line {
    indent: String,
    pub(super) tag: String,
    /// Names and values, as they are written.
    pub(super) attributes: Vec<(String, String)>,
}

impl Line {
    /// `None` if the line is anything else.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let element = text.trim_start();
        let indent = text[..text.len() - element.len()].to_owned();
        let inside = element.trim_end().strip_prefix('<')?.strip_suffix("/>")?;
        let (tag, mut rest) = inside.split_once(' ').unwrap_or((inside, ""));
        let mut attributes = Vec::new();
        while !rest.trim().is_empty() {
            let (name, after) = rest.split_once("=\"")?;
            let (value, after) = after.split_once('"')?;
            attributes.push((name.trim().to_owned(), value.to_owned()));
            rest = after;
        }
        let is_tag = !tag.is_empty() && tag.chars().all(|c| c.is_ascii_alphanumeric());
        is_tag.then(|| Self {
            indent,
            tag: tag.to_owned(),
            attributes,
        })
    }

    /// An element without attributes, indented as the entries of a frame's lists are.
    pub(super) fn new(tag: &str) -> Self {
        Self {
            indent: "    ".to_owned(),
            tag: tag.to_owned(),
            attributes: Vec::new(),
        }
    }

    pub(super) fn get(&self, name: &str) -> Option<&str> {
        self.attributes
            .iter()
            .find(|(attribute, _)| attribute == name)
            .map(|(_, value)| value.as_str())
    }

    /// Takes an attribute out.
    pub(super) fn take(&mut self, name: &str) -> Option<String> {
        let place = self
            .attributes
            .iter()
            .position(|(attribute, _)| attribute == name)?;
        Some(self.attributes.remove(place).1)
    }

    pub(super) fn push(&mut self, name: &str, value: String) {
        self.attributes.push((name.to_owned(), value));
    }
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}<{}", self.indent, self.tag)?;
        for (name, value) in &self.attributes {
            write!(f, " {name}=\"{value}\"")?;
        }
        f.write_str("/>")
    }
}

#[cfg(test)]
mod tests {
    use super::Line;

    #[test]
    fn an_element_is_written_as_it_was_read() {
        for text in [
            r#"    <Output name="a.{load}" dependent="a.{displacement}"/>"#,
            "<A/>",
        ] {
            assert_eq!(Line::parse(text).unwrap().to_string(), text);
        }
    }

    #[test]
    fn other_lines_are_none() {
        for text in [
            "",
            "  <A>",
            "</A>",
            "<!-- <A/> -->",
            "<?xml version=\"1.0\"?>",
            "<A b=c/>",
        ] {
            assert_eq!(Line::parse(text), None, "{text}");
        }
    }
}
