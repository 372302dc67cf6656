//! What can be checked of the texts by a machine: links lead somewhere, paths exist, lines and the README stay short, and
//! the map of the crates is that of their manifests.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as the tests do")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Longest line of prose, in characters.
const LINE: usize = 120;

/// Words that a visitor reads in three minutes.
const README_WORDS: usize = 900;

/// Documents that `bolted-joint reproduce` writes.
const GENERATED: &str =
    "docs/kavi.md docs/pirdayr.md docs/tian.md docs/tol-friction.md docs/tol.md docs/zhao.md";

/// Folders that are no part of the sources.
const PASSED_OVER: [&str; 4] = ["target", "node_modules", "artifacts", "bolted-joint-demo"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A text in Markdown.
struct Document {
    /// Path from the project's root, with `/`.
    name: String,
    text: String,
}

impl Document {
    fn read(path: &Path) -> Self {
        let name = path.strip_prefix(root()).unwrap().to_str().unwrap();
        Self {
            name: name.replace('\\', "/"),
            text: fs::read_to_string(path).unwrap(),
        }
    }

    /// Lines outside of fenced code, with their numbers.
    fn prose(&self) -> impl Iterator<Item = (usize, &str)> {
        let mut fenced = false;
        self.text.lines().enumerate().filter_map(move |(i, line)| {
            let fence = line.trim_start().starts_with("```");
            fenced ^= fence;
            (!fenced && !fence).then_some((i + 1, line))
        })
    }

    /// Targets of links and images, with the numbers of their lines.
    fn targets(&self) -> Vec<(usize, String)> {
        let mut targets = Vec::new();
        for (number, line) in self.prose() {
            let line = without_code(line);
            for (at, _) in line.match_indices("](") {
                let (target, _) = line[at + 2..].split_once(')').unwrap();
                targets.push((number, target.to_owned()));
            }
            if let Some((label, target)) = line.split_once("]: ")
                && label.starts_with('[')
            {
                targets.push((number, target.to_owned()));
            }
        }
        targets
    }

    /// Anchors that GitHub makes of the headings.
    fn anchors(&self) -> BTreeSet<String> {
        let mut anchors = BTreeSet::new();
        for (_, line) in self.prose().filter(|(_, line)| line.starts_with('#')) {
            let heading = line.trim_start_matches('#').trim();
            let anchor: String = heading
                .to_lowercase()
                .chars()
                .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'))
                .map(|c| if c == ' ' { '-' } else { c })
                .collect();
            let mut unique = anchor.clone();
            for count in 1.. {
                if anchors.insert(unique) {
                    break;
                }
                unique = format!("{anchor}-{count}");
            }
        }
        anchors
    }

    fn folder(&self) -> PathBuf {
        root().join(&self.name).parent().unwrap().to_owned()
    }
}

/// The line with what stands in code font blanked, for a link there is none.
fn without_code(line: &str) -> String {
    line.split('`')
        .enumerate()
        .map(|(i, part)| if i % 2 == 0 { part } else { "code" })
        .collect()
}

/// All Markdown of the project.
fn documents() -> Vec<Document> {
    let mut found = Vec::new();
    let mut folders = vec![root().to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            if path.is_dir() {
                if !name.starts_with('.') && !PASSED_OVER.contains(&name) {
                    folders.push(path);
                }
            } else if name.ends_with(".md") {
                found.push(Document::read(&path));
            }
        }
    }
    assert!(found.len() > 20, "{} documents", found.len());
    found
}

#[test]
fn links_lead_to_files_and_headings_that_exist() {
    let mut broken = Vec::new();
    for document in documents() {
        for (line, target) in document.targets() {
            if target.contains("://") || target.starts_with("mailto:") {
                continue;
            }
            let (path, anchor) = target.split_once('#').unwrap_or((&target, ""));
            let file = if path.is_empty() {
                root().join(&document.name)
            } else {
                document.folder().join(path)
            };
            let leads = file.canonicalize().is_ok_and(|file| {
                anchor.is_empty() || Document::read(&file).anchors().contains(anchor)
            });
            if !leads {
                broken.push(format!("{}:{line}: {target}", document.name));
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}

/// Paths in code font that begin with a folder of the project, such as `src/main.rs`, name something that is there.
#[test]
fn paths_in_code_font_exist() {
    let folders = "src/ crates/ tests/ benches/ examples/ docs/ platforms/ .ci/";
    let mut missing = Vec::new();
    for document in documents() {
        for (line, text) in document.prose() {
            for code in text.split('`').skip(1).step_by(2) {
                let path = code.trim_end_matches('/');
                let of_the_project = folders.split(' ').any(|folder| code.starts_with(folder));
                let is_plain = |c: char| c.is_alphanumeric() || "/._-".contains(c);
                let plain = path.chars().all(is_plain);
                // NAME stands for a name that somebody is to choose
                if of_the_project && plain && !path.contains("NAME") && !root().join(path).exists()
                {
                    missing.push(format!("{}:{line}: {code}", document.name));
                }
            }
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
}

/// Tables, formulas, commands and addresses cannot be broken; generated documents are as their program writes them.
#[test]
fn lines_of_prose_are_short() {
    let mut long = Vec::new();
    for document in documents() {
        if GENERATED.split(' ').any(|name| name == document.name) {
            continue;
        }
        let mut formula = false;
        for (number, line) in document.prose() {
            let begins_or_ends = line.matches("$$").count() % 2 == 1;
            let unbreakable = formula
                || line.starts_with("    ")
                || line.contains("$$")
                || line.starts_with('|')
                || !line.trim().contains(' ');
            formula ^= begins_or_ends;
            let length = line.chars().count();
            if length > LINE && !unbreakable {
                long.push(format!("{}:{number}: {length} characters", document.name));
            }
        }
    }
    assert!(long.is_empty(), "{long:#?}");
}

/// What stands for a number or a name that is still to come is written in capitals, or between signs.
#[test]
fn nothing_is_left_to_be_filled_in() {
    let is_open = |word: &str| {
        let is_name = |word: &str| {
            let is_long =
                |part: &str| part.len() > 2 && part.chars().all(|c| c.is_ascii_uppercase());
            word.contains('_') && word.split('_').all(is_long)
        };
        word.contains("@@") || ["TODO", "TBD", "FIXME", "XXX"].contains(&word) || is_name(word)
    };
    let mut found = Vec::new();
    for document in documents() {
        for (number, line) in document.prose() {
            let line = without_code(line);
            let words = line.split(|c: char| !c.is_alphanumeric() && c != '_' && c != '@');
            for word in words.filter(|word| is_open(word)) {
                found.push(format!("{}:{number}: {word}", document.name));
            }
        }
    }
    assert_eq!(found, [""; 0]);
}

#[test]
fn the_readme_is_read_in_three_minutes() {
    let readme = Document::read(&root().join("README.md"));
    let words = readme.prose().flat_map(|(_, line)| line.split_whitespace());
    let words = words.count();
    assert!(words <= README_WORDS, "{words} words");
    for (number, line) in readme.text.lines().enumerate() {
        let length = line.chars().count();
        assert!(length <= LINE, "line {}: {length} characters", number + 1);
    }
}

/// Crates of the project among the dependencies that a manifest states, by the names of their folders.
fn uses(manifest: &str) -> BTreeSet<String> {
    manifest
        .lines()
        .skip_while(|line| *line != "[dependencies]")
        .skip(1)
        .take_while(|line| !line.starts_with('['))
        .filter_map(|line| line.strip_prefix("bolted-joint-"))
        .filter_map(|rest| rest.split(['.', ' ', '=']).next())
        .map(|name| name.replace('-', "_"))
        .collect()
}

#[test]
fn the_map_of_the_crates_is_that_of_their_manifests() {
    let mut expected = BTreeSet::new();
    for entry in fs::read_dir(root().join("crates")).unwrap() {
        let folder = entry.unwrap();
        let name = folder.file_name().into_string().unwrap();
        let manifest = fs::read_to_string(folder.path().join("Cargo.toml")).unwrap();
        expected.insert((name, uses(&manifest)));
    }
    let text = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let stated: BTreeSet<_> = text
        .lines()
        .skip_while(|line| *line != "| crate | what it is for | uses |")
        .skip(2)
        .take_while(|line| line.starts_with('|'))
        .map(|line| {
            let mut code = line.split('`').skip(1).step_by(2).map(str::to_owned);
            // other words in code font belong to what the crate is for
            let name = code.next().unwrap();
            let uses = line.rsplit('|').nth(1).unwrap();
            let uses = uses.split('`').skip(1).step_by(2).map(str::to_owned);
            (name, uses.collect::<BTreeSet<_>>())
        })
        .collect();
    let missing: Vec<_> = expected.difference(&stated).collect();
    let surplus: Vec<_> = stated.difference(&expected).collect();
    assert!(missing.is_empty(), "by the manifests {missing:#?}");
    assert!(surplus.is_empty(), "by ARCHITECTURE.md {surplus:#?}");
}

/// Texts of all Rust sources, with lines that a string continues put together.
fn sources() -> String {
    let mut folders = vec![root().join("crates"), root().join("src")];
    let mut text = String::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let source = fs::read_to_string(path).unwrap();
                let lines = source.lines().map(|line| match line.strip_suffix('\\') {
                    Some(continued) => continued.trim_start().to_owned(),
                    None => format!("{}\n", line.trim_start()),
                });
                text.extend(lines);
            }
        }
    }
    text
}

#[test]
fn messages_that_are_explained_are_messages_of_the_program() {
    let page = fs::read_to_string(root().join("docs/troubleshooting.md")).unwrap();
    let sources = sources();
    let quoted: Vec<&str> = page
        .lines()
        .filter_map(|line| line.strip_prefix("| `")?.split('`').next())
        .collect();
    assert!(quoted.len() > 15, "{quoted:?}");
    for message in quoted {
        assert!(sources.contains(message), "{message}");
    }
}
