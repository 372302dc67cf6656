//! Elements of an XML text whose every content is in attributes, found without an XML library.

use std::collections::BTreeMap;

/// An element: its name and its attributes.
#[derive(Debug)]
pub(crate) struct Element {
    pub(crate) name: String,
    pub(crate) attributes: BTreeMap<String, String>,
}

impl Element {
    pub(crate) fn get(&self, attribute: &str) -> Option<&str> {
        self.attributes.get(attribute).map(String::as_str)
    }

    pub(crate) fn number(&self, attribute: &str) -> Option<f64> {
        self.get(attribute).map(|text| text.parse().unwrap())
    }

    /// A list of whole numbers; `None` if the attribute is missing.
    pub(crate) fn list(&self, attribute: &str) -> Option<Vec<usize>> {
        let words = self.get(attribute)?.split_whitespace();
        Some(words.map(|word| word.parse().unwrap()).collect())
    }
}

/// All elements, in the order of their start tags.
pub(crate) fn elements(xml: &str) -> Vec<Element> {
    xml.split('<')
        .skip(1)
        .filter(|tag| !tag.starts_with(['?', '!', '/']))
        .map(|tag| {
            let tag = tag.split('>').next().unwrap().trim_end_matches('/');
            let (name, mut rest) = tag.split_once(' ').unwrap_or((tag, ""));
            let mut attributes = BTreeMap::new();
            while let Some((attribute, after)) = rest.split_once("=\"") {
                let (value, after) = after.split_once('"').unwrap();
                attributes.insert(attribute.trim().to_owned(), value.replace("&apos;", "'"));
                rest = after;
            }
            Element {
                name: name.to_owned(),
                attributes,
            }
        })
        .collect()
}

/// Those of one name.
pub(crate) fn named(xml: &str, name: &str) -> Vec<Element> {
    let mut found = elements(xml);
    found.retain(|element| element.name == name);
    found
}
